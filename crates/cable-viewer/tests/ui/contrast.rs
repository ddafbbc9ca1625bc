//! Both themes pass WCAG 2.2 AA: 4.5 : 1 for text (1.4.3), 3 : 1 for what graphics and controls are
//! known by (1.4.11).

use cable_viewer::canvas::layers::safe_reach;
use cable_viewer::plot;
use cable_viewer::render::colour::LINES;
use cable_viewer::render::theme;
use egui::{Color32, Theme};

/// Relative luminance of an opaque colour (WCAG 2.2).
fn luminance(c: Color32) -> f64 {
    let linear = |v: u8| {
        let v = f64::from(v) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(c.r()) + 0.7152 * linear(c.g()) + 0.0722 * linear(c.b())
}

/// A colour that may let through what is behind it, over that.
fn over(c: Color32, behind: Color32) -> Color32 {
    behind.blend(c)
}

fn ratio(a: Color32, b: Color32) -> f64 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[test]
fn ratios_are_those_of_the_standard() {
    assert!((ratio(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-9);
    // The grey that the standard's authors name as the darkest that fails on white.
    assert!(ratio(Color32::from_gray(0x77), Color32::WHITE) < 4.5);
    assert!(ratio(Color32::from_gray(0x76), Color32::WHITE) > 4.5);
}

#[test]
fn text_and_graphics_stand_off_what_is_behind_them_in_both_themes() {
    let ctx = egui::Context::default();
    theme::install(&ctx);
    let mut failed = Vec::new();
    let mut count = 0;
    for shown in [Theme::Dark, Theme::Light] {
        let visuals = &ctx.style_of(shown).visuals;
        let p = theme::palette(visuals);
        let mut ask = |what: &str, colour: Color32, behind: Color32, least: f64| {
            let found = ratio(over(colour, behind), behind);
            count += 1;
            if found < least {
                failed.push(format!("{shown:?}: {what} has {found:.2} : 1 of {least}"));
            }
        };
        let plate = over(p.plate, p.background);
        let panels = [
            ("panel", visuals.panel_fill),
            ("dialog", visuals.window_fill),
            ("field", visuals.extreme_bg_color),
            ("striped row", over(visuals.faint_bg_color, visuals.panel_fill)),
        ];
        let words = [
            ("text", visuals.text_color()),
            ("strong text", visuals.strong_text_color()),
            ("weak text", visuals.weak_text_color()),
            ("warning", visuals.warn_fg_color),
            ("error", visuals.error_fg_color),
            ("link", visuals.hyperlink_color),
        ];
        for (where_, behind) in panels {
            words.iter().for_each(|(what, colour)| ask(&format!("{what} on {where_}"), *colour, behind, 4.5));
        }
        for (state, widget) in [
            ("resting", &visuals.widgets.inactive),
            ("hovered", &visuals.widgets.hovered),
            ("pressed", &visuals.widgets.active),
            ("open", &visuals.widgets.open),
        ] {
            let button = over(widget.weak_bg_fill, visuals.panel_fill);
            ask(&format!("text of a {state} button"), widget.text_color(), button, 4.5);
            ask(&format!("tick of a {state} box"), widget.text_color(), over(widget.bg_fill, visuals.panel_fill), 3.0);
        }
        let selected = over(visuals.selection.bg_fill, visuals.panel_fill);
        ask("text that is selected", visuals.selection.stroke.color, selected, 4.5);
        for (k, bar) in p.bars.into_iter().enumerate() {
            ask(&format!("text on bar {k}"), p.text, bar, 4.5);
        }
        ask("text of a bar beyond its fill", p.text, visuals.extreme_bg_color, 4.5);
        for (what, colour) in [("text", p.text), ("weak text", p.weak_text), ("risk", p.risk)] {
            for (where_, behind) in [("canvas", p.background), ("plate", plate)] {
                ask(&format!("{what} on {where_}"), colour, behind, 4.5);
            }
        }
        // Figures of forces are written in the colour of their arrows, on plates.
        for (what, colour) in
            [("normal", p.normal), ("friction", p.friction), ("load", p.load), ("reaction", p.reaction)]
        {
            ask(&format!("figure of {what} on plate"), colour, plate, 4.5);
            ask(&format!("arrow of {what} on canvas"), colour, p.background, 3.0);
            ask(&format!("arrow of {what} on a solid"), colour, p.solid, 3.0);
        }
        for (what, colour) in [
            ("surface", p.surface),
            ("edge of the cable", p.casing),
            ("risk", p.risk),
            ("support", p.support),
            ("selection", p.accent),
        ] {
            ask(&format!("{what} on canvas"), colour, p.background, 3.0);
            ask(&format!("{what} on a solid"), colour, p.solid, 3.0);
        }
        for (k, line) in LINES.into_iter().enumerate() {
            ask(&format!("line {k} of a graph"), line, visuals.extreme_bg_color, 3.0);
        }
        for (what, colour) in
            [("service", plot::SERVICE), ("breaking", plot::BREAKING), ("tolerance", plot::TOLERANCE_MARK)]
        {
            ask(&format!("mark of {what} in a graph"), colour, visuals.extreme_bg_color, 3.0);
        }
        // Lines of risk lie on the safe-reach map from the service tension on, each over one of the
        // background: either the line or what it lies on stands off the map.
        for share in [0.9, 1.0, 2.0, 12.5] {
            let map = over(safe_reach::colour(share), p.background);
            let better = if ratio(p.risk, map) > ratio(p.background, map) { p.risk } else { p.background };
            ask(&format!("line of risk on the map at {share} of service"), better, map, 3.0);
        }
        ask("line of risk on what it lies on", p.risk, p.background, 3.0);
        // The end of the map is drawn in the colour of surfaces: its darkest colours are near the
        // background's.
        ask("end of the map", p.surface, p.background, 3.0);
        let [least, most] = [0.0, 1.0].map(|share| over(safe_reach::colour(share), p.background));
        ask("nothing beside the service tension on the map", least, most, 3.0);
        ask("light of a sound answer", p.sound, visuals.panel_fill, 3.0);
        ask("rail of a slider, box to tick", visuals.widgets.inactive.bg_fill, visuals.panel_fill, 3.0);
        ask("frame that a guide points with", visuals.hyperlink_color, visuals.panel_fill, 3.0);
    }
    println!("{count} pairs");
    assert!(failed.is_empty(), "{} of {count}:\n{}", failed.len(), failed.join("\n"));
}

/// Hue in degrees; None of a grey, in which nobody sees one.
fn hue(c: Color32) -> Option<f64> {
    let [r, g, b] = [c.r(), c.g(), c.b()].map(f64::from);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let range = most - least;
    if range < 0.2 * most {
        return None;
    }
    let turn = if most == r {
        (g - b) / range
    } else if most == g {
        2.0 + (b - r) / range
    } else {
        4.0 + (r - g) / range
    };
    Some((60.0 * turn).rem_euclid(360.0))
}

/// Blue was what is selected, a contact that holds, the first line of a graph and a calm bar;
/// orange was a warning and a contact that slides.
#[test]
fn nothing_has_the_colours_of_what_is_selected_and_of_what_warns() {
    let ctx = egui::Context::default();
    theme::install(&ctx);
    for shown in [Theme::Dark, Theme::Light] {
        let visuals = &ctx.style_of(shown).visuals;
        let p = theme::palette(visuals);
        assert_eq!((visuals.warn_fg_color, visuals.hyperlink_color), (p.warn, p.sound));
        let others = [
            ("normal", p.normal),
            ("friction", p.friction),
            ("load", p.load),
            ("reaction", p.reaction),
            ("robot", p.robot),
            ("solid", p.solid),
            ("surface", p.surface),
            ("sound", p.sound),
            ("risk", p.risk),
            ("calm bar", p.bars[0]),
            ("tolerance", plot::TOLERANCE_MARK),
            ("line 1", LINES[0]),
            ("line 2", LINES[1]),
            ("line 3", LINES[2]),
            ("line 4", LINES[3]),
        ];
        for (own, meaning) in [(p.accent, "selected"), (p.warn, "warns")] {
            let own = hue(own).unwrap();
            for (what, other) in others.iter().filter_map(|(what, colour)| Some((what, hue(*colour)?))) {
                let apart = (own - other).rem_euclid(360.0);
                let apart = apart.min(360.0 - apart);
                assert!(apart > 24.0, "{shown:?}: {what} is {apart:.0}° from what {meaning}");
            }
        }
    }
}
