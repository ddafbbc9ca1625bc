//! These tests compare a picture of each panel, at the width that it has in the window. They need a
//! graphics adapter (software will do): without one they are skipped with a notice, where CI=true
//! they fail.

use cable_core::SolveError;
use cable_core::error::Unsupported;
use cable_viewer::jobs::{friction_range, model_comparison, safe_reach};
use cable_viewer::panels;
use cable_viewer::plot::GraphView;
use cable_viewer::state::{AppState, Item};
use egui_kittest::{SnapshotOptions, SnapshotResults};

use crate::fixture::{PanelUi, bench, compared, driven, recorded, state, warn, with_pulley, wrapped};

/// Differences of a rounding here and there between drivers are let pass.
const MAX_DIFFERENT_PIXELS: usize = 80;

fn picture(name: &str, state: impl Fn() -> AppState, panel: PanelUi, size: [f32; 2]) {
    let mut results = SnapshotResults::new();
    for (theme, suffix) in [(egui::Theme::Light, "light"), (egui::Theme::Dark, "dark")] {
        let mut harness = bench(state(), panel, size);
        harness.ctx.set_theme(theme);
        harness.run();
        if let Err(reason) = harness.render() {
            assert!(std::env::var("CI").as_deref() != Ok("true"), "no picture of {name}: {reason}");
            eprintln!("skipped the picture of {name}: {reason}");
            return;
        }
        let options = SnapshotOptions::new().max_failed_pixels(MAX_DIFFERENT_PIXELS);
        results.add(harness.try_snapshot_options(format!("panel_{name}_{suffix}"), &options));
    }
}

#[test]
fn cable() {
    picture("cable", state, panels::cable::ui, [320.0, 420.0]);
}

#[test]
fn cable_too_short() {
    let short = || {
        let mut state = state();
        state.document.scene.cables[0].length_m = 9.0;
        state.document.scene.cables[0].segments = Some(64);
        state.document.fault = state.document.scene.validate().err();
        state
    };
    picture("cable_too_short", short, panels::cable::ui, [320.0, 540.0]);
}

#[test]
fn environment() {
    picture("environment", state, panels::environment::ui, [320.0, 160.0]);
}

#[test]
fn solver() {
    picture("solver", state, panels::solver::ui, [320.0, 376.0]);
}

#[test]
fn selected_support() {
    let selected = || {
        let mut state = state();
        with_pulley(&mut state);
        state.selection.selected = Some(Item::Support { cable: 0, support: 1 });
        state
    };
    picture("selected_support", selected, panels::selected_item::ui, [320.0, 420.0]);
}

/// As narrow as it is in a window of 1280 points.
#[test]
fn selected_obstacle() {
    let selected = || {
        let mut state = state();
        state.selection.selected = Some(Item::Obstacle(0));
        state
    };
    picture("selected_obstacle", selected, panels::selected_item::ui, [250.0, 420.0]);
}

#[test]
fn scene() {
    picture("scene", state, panels::scene::ui, [320.0, 140.0]);
}

#[test]
fn outline() {
    let listed = || {
        let mut state = state();
        with_pulley(&mut state);
        warn(&mut state);
        state.selection.selected = Some(Item::Support { cable: 0, support: 1 });
        state
    };
    picture("outline", listed, panels::scene::outline::ui, [268.0, 440.0]);
}

#[test]
fn playback() {
    let running = || {
        let mut state = state();
        state.live.playback.paused = false;
        state
    };
    picture("playback", running, panels::playback::ui, [900.0, 44.0]);
}

#[test]
fn timeline() {
    picture("timeline", recorded, panels::timeline::ui, [900.0, 44.0]);
}

#[test]
fn robot() {
    picture("robot", driven, panels::robot::ui, [320.0, 520.0]);
}

#[test]
fn compare() {
    picture("compare", compared, panels::analysis::compare::ui, [320.0, 240.0]);
}

/// After every model was asked, with one that has no answer.
#[test]
fn compare_models() {
    let asked = || {
        let mut state = compared();
        let (model, feature) = (cable_core::Model::Catenary, Unsupported::Obstacle { arc_length_m: 4.894 });
        let why = SolveError::Unsupported { model, feature }.into();
        let answers = vec![model_comparison::ModelAnswer { model, result: Err(why) }];
        let scene = std::sync::Arc::new(state.document.scene.clone());
        state.analysis.models = model_comparison::Progress::Done(model_comparison::ModelComparison { scene, answers });
        state
    };
    picture("compare_models", asked, panels::analysis::compare::ui, [320.0, 280.0]);
}

/// On its way: progress, and how to end it.
#[test]
fn reach() {
    let searching = || {
        let mut state = state();
        state.analysis.safe_reach.progress = safe_reach::Progress::Running(0.4, None);
        state
    };
    picture("reach", searching, panels::analysis::safe_reach::ui, [320.0, 130.0]);
}

#[test]
fn friction_range() {
    let computing = || {
        let mut state = state();
        state.analysis.friction_range.on = true;
        state.analysis.friction_range.progress = friction_range::Progress::Running(0.3, None);
        state
    };
    picture("friction_range", computing, panels::analysis::friction_range::ui, [320.0, 130.0]);
}

/// Every panel of the window has a picture here.
#[test]
fn every_panel_has_a_picture() {
    let here = concat!(include_str!("pictures.rs"), include_str!("fixture.rs"));
    let layout = include_str!("../../src/app/layout.rs");
    let mut missing = Vec::new();
    for part in layout.split("panels::").skip(1) {
        let Some(name) = part.split("::ui").next().filter(|n| n.chars().all(|c| c.is_ascii_lowercase() || c == '_'))
        else {
            continue;
        };
        if !here.contains(&format!("panels::{name}::ui")) {
            missing.push(name);
        }
    }
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn readouts() {
    picture("readouts", state, panels::readouts::ui, [320.0, 460.0]);
}

#[test]
fn warnings() {
    let warned = || {
        let mut state = state();
        warn(&mut state);
        state.document.scene.cables[0].length_m = 9.0;
        state.document.fault = state.document.scene.validate().err();
        state
    };
    // Tall: they take two fifths of a window.
    picture("warnings", warned, crate::fixture::warnings, [320.0, 520.0]);
}

#[test]
fn origin() {
    let probed = || {
        let mut state = wrapped();
        let from = cable_core::analysis::tension_budget::StartEnd::Start;
        state.analysis.tension_marker = Some(cable_viewer::state::TensionMarker { cable: 0, arc_length_m: 12.0, from });
        state
    };
    picture("origin", probed, panels::analysis::tension_budget::ui, [320.0, 330.0]);
}

/// More samples than columns: a band from the least to the greatest, and the mean.
#[test]
fn plots_dense() {
    let long = || {
        let mut state = state();
        let sample = state.live.history.samples[0].clone();
        state.live.history.clear();
        for k in 0..20_000 {
            let time_s = f64::from(k) / 240.0;
            let (swing, chatter) = ((0.2 * time_s).sin(), (37.0 * time_s).sin());
            let peak = if k == 9_001 { 500.0 } else { 0.0 };
            let mut next = sample.clone();
            (next.time_s, next.max_tension_n) = (time_s, 500.0 + 120.0 * swing + 60.0 * chatter + peak);
            state.live.history.push(next);
        }
        state
    };
    let all: PanelUi = |ui, state, commands| {
        let view = GraphView { window_s: None, ..GraphView::default() };
        ui.data_mut(|d| d.insert_temp(egui::Id::unique("plot view"), view));
        panels::plots::ui(ui, state, commands);
    };
    picture("plots_dense", long, all, [960.0, 240.0]);
}

#[test]
fn plots() {
    picture("plots", state, panels::plots::ui, [960.0, 240.0]);
}
