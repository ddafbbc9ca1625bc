//! One playhead: the timeline, the graphs over time, the graph along the cable and the canvas show
//! the same instant.

use cable_core::scene::catalog;
use cable_core::solution::WarningKind;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, ViewCommand};
use cable_viewer::plot;
use cable_viewer::state::dialog::Dialog;
use egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, drag, open, open_span};

fn shown_s(harness: &Harness<'_, ViewerApp>) -> Option<f64> {
    harness.state().state.live.recording.shown_s
}

fn in_view(harness: &Harness<'_, ViewerApp>) -> [f64; 2] {
    let id = egui::Id::unique(("in view", "Over time"));
    harness.ctx.data(|d| d.get_temp(id)).expect("a graph over time")
}

fn played(seconds: u32) -> Harness<'static, ViewerApp> {
    let mut harness = open_span();
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(60 * seconds as usize);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    harness
}

/// The format of an export had to be typed as an ending, and nothing said that a file was written.
#[test]
fn an_export_has_formats_to_choose_and_is_said_once_written() {
    let mut harness = played(1);
    let folder = std::env::temp_dir().join(format!("cable-viewer-export-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let typed = |h: &Harness<'_, ViewerApp>| match &h.state().state.ui.dialog {
        Some(Dialog::Export { path, .. }) => path.clone(),
        other => panic!("{other:?}"),
    };
    // The palette leads there as well as the button beside the graph.
    apply(&mut harness, Command::View(ViewCommand::ExportGraph("Along the cable")));
    harness.run_steps(3);
    assert_eq!(typed(&harness), "along-the-cable.csv");
    harness.get_by_label("SVG").click();
    harness.run_steps(2);
    assert_eq!(typed(&harness), "along-the-cable.svg");
    for (format, ending) in [("PNG", "png"), ("CSV", "csv"), ("SVG", "svg")] {
        let file = folder.join(format!("along.{ending}"));
        if let Some(Dialog::Export { path, .. }) = &mut harness.state_mut().state.ui.dialog {
            *path = folder.join("along.txt").display().to_string();
        }
        harness.run_steps(2);
        harness.get_by_label(format).click();
        harness.run_steps(2);
        harness.get_by_label("Save").click();
        harness.run_steps(3);
        assert!(file.exists(), "{}", file.display());
        harness.get_by_label(&format!("Saved along.{ending}"));
        harness.get_by_label("Export Along the cable").click();
        harness.run_steps(3);
        assert_eq!(typed(&harness), "along-the-cable.csv");
        assert!(harness.query_by_label_contains("Saved along").is_none());
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_drag_in_the_graph_over_time_moves_the_playhead_of_all() {
    let mut harness = played(2);
    let graph =
        harness.get_all_by_label("Over time").map(|n| n.rect()).max_by(|a, b| a.height().total_cmp(&b.height()));
    let graph = graph.unwrap();
    let from = graph.center() + Vec2::new(100.0, 0.0);
    // From where nothing is recorded yet to within the first two of ten seconds.
    drag(&mut harness, from, Vec2::new(graph.left() + 0.18 * graph.width() - from.x, 0.0));
    let shown = shown_s(&harness).expect("an earlier time is shown");
    let solution = harness.state().state.live.snapshot.solution.clone().unwrap();
    assert!((solution.time_s - shown).abs() < 1.0 / 60.0 && shown < 1.9, "{shown} {}", solution.time_s);
    harness.get_by_label_contains(&format!("{:.2} of ", solution.time_s));
    assert!(harness.state().state.live.playback.paused);
    assert_eq!(plot::hovered(&harness.ctx, "along"), None);
}

/// D10.10: the graph showed 20 to 30 s while 3 s were shown. One that was zoomed goes there too.
#[test]
fn a_zoomed_graph_goes_to_the_time_that_is_scrubbed_to() {
    let mut harness = played(4);
    let graph =
        harness.get_all_by_label("Over time").map(|n| n.rect()).max_by(|a, b| a.height().total_cmp(&b.height()));
    let right = graph.unwrap().center();
    harness.hover_at(right);
    harness.step();
    for _ in 0..12 {
        harness.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: Vec2::new(0.0, 120.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: egui::Modifiers::NONE,
        });
        harness.run_steps(3);
    }
    // The wheel is smoothed over some frames.
    harness.hover_at(egui::Pos2::new(640.0, 300.0));
    harness.run_steps(60);
    let [left, right] = in_view(&harness);
    assert!(right - left < 2.0 && left > 0.5, "{left} to {right}");
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.3))));
    harness.run_steps(3);
    let [left, right] = in_view(&harness);
    assert!(left < 0.3 && 0.3 < right, "{left} to {right}");
    assert!(right - left < 2.0, "it stays zoomed");
}

/// The knob of the timeline stands between two frames; the frame before it is shown, and its time
/// was said once as its own and once as that of the knob.
#[test]
fn the_timeline_tells_the_time_of_the_frame_that_is_shown() {
    let mut harness = played(1);
    for knob_s in [0.345, 0.5, 0.6649] {
        apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(knob_s))));
        let shown_s = harness.state().state.live.snapshot.solution.as_ref().unwrap().time_s;
        harness.get_by_label_contains(&format!("{shown_s:.2} of "));
    }
}

/// A jerk between two frames was warned of with more than the graph had at either.
#[test]
fn no_warning_names_a_tension_that_the_graph_does_not_show() {
    let mut scene = catalog::rubble_drop();
    // The drop is violent enough to be warned of.
    (scene.cables[0].service_tension_n, scene.cables[0].breaking_tension_n) = (200.0, 1e5);
    let mut harness = open(scene);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    let mut warned = 0;
    for _ in 0..90 {
        harness.step();
        let live = &harness.state().state.live;
        let most_n = live.history.samples.iter().map(|s| s.max_tension_n).fold(0.0, f64::max);
        let answer = live.snapshot.solution.clone().unwrap();
        let kinds = [WarningKind::ServiceTension, WarningKind::MayBreak, WarningKind::BreakingTension];
        for warning in answer.warnings.iter().filter(|w| kinds.contains(&w.kind)) {
            assert!(most_n >= warning.value, "{} s: {most_n} N, warned of {} N", answer.time_s, warning.value);
            warned += 1;
        }
    }
    assert!(warned > 0, "nothing is warned of");
}

/// The legend above a graph had named limits, each in the other's way and one of them cut.
#[test]
fn limits_are_named_at_their_lines_and_hide_each_other_nowhere() {
    for [service, breaking] in [[80.0, 93.5], [92.0, 93.5], [60.0, 160.0]] {
        let mut scene = catalog::hanging_span();
        (scene.cables[0].service_tension_n, scene.cables[0].breaking_tension_n) = (service, breaking);
        let harness = open(scene);
        let graph = harness.get_by_role_and_label(egui::accesskit::Role::Figure, "Along the cable").rect();
        let mut found = Vec::new();
        harness.output().shapes.iter().for_each(|s| crate::warnings::galleys(&s.shape, &mut found));
        let names = found.iter().filter(|(text, ..)| text.starts_with("Service ") || text.starts_with("Breaking "));
        let inside: Vec<egui::Rect> = names.map(|(_, r, _)| *r).filter(|r| graph.contains_rect(*r)).collect();
        let over_each_other = |k: usize| inside[..k].iter().any(|r| r.intersects(inside[k]));
        assert!((1..inside.len()).all(|k| !over_each_other(k)), "{service}, {breaking}: {inside:?}");
        // A limit that is twice as far as the tension is out of view.
        let in_view = [service, breaking].iter().filter(|limit| 92.0 > 0.5 * *limit).count();
        assert_eq!(inside.len(), in_view, "{service}, {breaking}: {found:?}");
    }
}
