//! The theme sets colours and spacing of the window, light and dark.

use egui::{Color32, Context, CornerRadius, FontFamily, FontId, Stroke, TextStyle, Theme, Visuals};

/// The colours of the canvas.
#[derive(Clone, Copy, Debug)]
pub struct Palette {
    /// Behind everything.
    pub background: Color32,
    /// Thin grid lines.
    pub grid_minor: Color32,
    /// Numbered grid lines.
    pub grid_major: Color32,
    /// x = 0 and y = 0.
    pub grid_zero: Color32,
    /// Numbers, titles, labels.
    pub text: Color32,
    /// Less important text.
    pub weak_text: Color32,
    /// Behind labels, legend and banners.
    pub plate: Color32,
    /// Round plates.
    pub plate_line: Color32,
    /// Inside solids and below the terrain.
    pub solid: Color32,
    /// Hatching of solids.
    pub hatch: Color32,
    /// Surfaces.
    pub surface: Color32,
    /// The robot's body.
    pub robot: Color32,
    /// Round the cable, so that every colour of the map stands off the background.
    pub casing: Color32,
    /// Round the cable where it is above its service tension.
    pub risk: Color32,
    /// Contact normals.
    pub normal: Color32,
    /// Friction.
    pub friction: Color32,
    /// Loads and wind.
    pub load: Color32,
    /// Forces on supports.
    pub reaction: Color32,
    /// Supports.
    pub support: Color32,
    /// Picked and hovered things, and nothing else.
    pub accent: Color32,
    /// Warnings, and nothing else.
    pub warn: Color32,
    /// The light of an answer whose laws were all asked and hold: told from red by its brightness
    /// too.
    pub sound: Color32,
    /// A share of a limit as a bar with text on it: below the limit, above service, above break.
    pub bars: [Color32; 3],
}

const DARK: Palette = Palette {
    background: Color32::from_rgb(21, 24, 29),
    grid_minor: Color32::from_rgb(29, 33, 39),
    grid_major: Color32::from_rgb(41, 46, 54),
    grid_zero: Color32::from_rgb(66, 74, 86),
    text: Color32::from_rgb(222, 227, 233),
    weak_text: Color32::from_rgb(146, 156, 168),
    plate: Color32::from_rgba_premultiplied(24, 27, 32, 226),
    plate_line: Color32::from_rgb(58, 65, 75),
    solid: Color32::from_rgb(47, 50, 55),
    hatch: Color32::from_rgb(70, 74, 80),
    surface: Color32::from_rgb(150, 155, 163),
    robot: Color32::from_rgb(92, 100, 112),
    casing: Color32::from_rgb(205, 212, 220),
    risk: Color32::from_rgb(255, 77, 77),
    normal: Color32::from_rgb(255, 130, 200),
    friction: Color32::from_rgb(184, 160, 255),
    load: Color32::from_rgb(196, 214, 90),
    reaction: Color32::from_rgb(92, 219, 194),
    support: Color32::from_rgb(240, 243, 247),
    accent: Color32::from_rgb(79, 163, 255),
    warn: Color32::from_rgb(255, 159, 64),
    sound: Color32::from_rgb(64, 170, 110),
    bars: [Color32::from_rgb(52, 92, 78), Color32::from_rgb(130, 82, 0), Color32::from_rgb(160, 40, 40)],
};

const LIGHT: Palette = Palette {
    background: Color32::from_rgb(252, 252, 253),
    grid_minor: Color32::from_rgb(240, 242, 245),
    grid_major: Color32::from_rgb(222, 226, 231),
    grid_zero: Color32::from_rgb(176, 184, 194),
    text: Color32::from_rgb(28, 33, 40),
    weak_text: Color32::from_rgb(92, 101, 112),
    plate: Color32::from_rgba_premultiplied(242, 243, 245, 245),
    plate_line: Color32::from_rgb(205, 210, 217),
    solid: Color32::from_rgb(226, 224, 219),
    hatch: Color32::from_rgb(190, 187, 180),
    surface: Color32::from_rgb(92, 88, 80),
    robot: Color32::from_rgb(186, 194, 204),
    casing: Color32::from_rgb(52, 58, 66),
    risk: Color32::from_rgb(206, 20, 32),
    normal: Color32::from_rgb(178, 20, 120),
    friction: Color32::from_rgb(104, 64, 190),
    load: Color32::from_rgb(94, 104, 0),
    reaction: Color32::from_rgb(0, 124, 104),
    support: Color32::from_rgb(28, 33, 40),
    accent: Color32::from_rgb(0, 100, 208),
    warn: Color32::from_rgb(168, 76, 0),
    sound: Color32::from_rgb(18, 114, 62),
    bars: [Color32::from_rgb(160, 205, 180), Color32::from_rgb(226, 160, 60), Color32::from_rgb(238, 120, 112)],
};

/// The colours of the theme in use.
#[must_use]
pub fn palette(visuals: &Visuals) -> &'static Palette {
    if visuals.dark_mode { &DARK } else { &LIGHT }
}

/// Sets up both themes.
pub fn install(ctx: &Context) {
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(8.0, 5.0);
        style.spacing.button_padding = egui::vec2(7.0, 3.0);
        style.spacing.slider_width = 120.0;
        for (name, size, family) in [
            (TextStyle::Small, 10.5, FontFamily::Proportional),
            (TextStyle::Body, 13.0, FontFamily::Proportional),
            (TextStyle::Button, 13.0, FontFamily::Proportional),
            (TextStyle::Heading, 17.0, FontFamily::Proportional),
            (TextStyle::Monospace, 12.0, FontFamily::Monospace),
        ] {
            style.text_styles.insert(name, FontId::new(size, family));
        }
        // Figures are read off, not dragged over by accident.
        style.interaction.selectable_labels = true;
    });
    for (theme, palette) in [(Theme::Dark, &DARK), (Theme::Light, &LIGHT)] {
        ctx.style_mut_of(theme, |style| visuals(&mut style.visuals, palette));
    }
}

/// Sets the colours of widgets.
fn visuals(visuals: &mut Visuals, palette: &Palette) {
    let dark = visuals.dark_mode;
    visuals.panel_fill = if dark { Color32::from_rgb(28, 31, 37) } else { Color32::from_rgb(244, 245, 247) };
    // Light fields stand off it: a dialog asks for something to be typed.
    visuals.window_fill = if dark { Color32::from_rgb(34, 38, 45) } else { Color32::from_rgb(240, 242, 245) };
    visuals.extreme_bg_color = if dark { Color32::from_rgb(17, 19, 23) } else { Color32::WHITE };
    visuals.faint_bg_color = if dark { Color32::from_rgb(34, 38, 44) } else { Color32::from_rgb(236, 238, 241) };
    visuals.selection.bg_fill = palette.accent.gamma_multiply(0.45);
    visuals.selection.stroke = Stroke::new(1.0, palette.text);
    visuals.hyperlink_color = palette.sound;
    visuals.warn_fg_color = palette.warn;
    visuals.error_fg_color = palette.risk;
    visuals.weak_text_color = Some(palette.weak_text);
    let radius = CornerRadius::same(4);
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.fg_stroke.color = palette.text;
    widgets.noninteractive.bg_stroke.color = palette.plate_line;
    widgets.inactive.fg_stroke.color = palette.text;
    // Rails of sliders and boxes to tick: the default is hardly told from the panel.
    widgets.inactive.bg_fill = if dark { Color32::from_rgb(110, 113, 118) } else { Color32::from_rgb(132, 138, 146) };
    for w in [&mut widgets.noninteractive, &mut widgets.inactive, &mut widgets.hovered, &mut widgets.active] {
        w.corner_radius = radius;
    }
}
