//! Pictures of the canvas compared with those in `tests/snapshots`. After an intended change:
//! `UPDATE_SNAPSHOTS=1 cargo test -p cable-viewer --test ui`.

use cable_core::Model;
use cable_core::scene::catalog;
use cable_viewer::command::Command;
use cable_viewer::state::{AppState, Item};
use cable_viewer::{canvas, screenshot, theme};
use egui::{Theme, Vec2};
use egui_kittest::Harness;

/// Compares the canvas of a state with its picture. Skips with a notice where nothing can draw, except in CI.
fn compare(name: &str, state: AppState, theme: Theme) {
    let renderer = match screenshot::renderer() {
        Ok(renderer) => renderer,
        Err(why) if std::env::var("CI").is_ok_and(|v| v == "true") => panic!("{why}"),
        Err(why) => return eprintln!("{name}: skipped, {why}"),
    };
    let mut harness = Harness::builder()
        .with_size(Vec2::new(720.0, 480.0))
        .with_theme(theme)
        .with_context_setup(theme::install)
        .with_render_cursor(false)
        .renderer(renderer)
        .build_ui_state(|ui, state| canvas::ui(ui, state, &mut Vec::new()), state);
    harness.run_steps(2);
    harness.snapshot(name);
}

fn solved(scene: cable_core::Scene) -> AppState {
    let mut harness = crate::open(scene);
    crate::apply(&mut harness, Command::SetModel(Model::Fem));
    let mut state = harness.into_state().state;
    assert_eq!(state.snapshot.error, None);
    state.camera.fit_wanted = true;
    state
}

#[test]
fn waypoints_dark() {
    let mut state = solved(catalog::pulley_waypoints());
    state.selected = Some(Item::Support { cable: 0, support: 1 });
    compare("waypoints_dark", state, Theme::Dark);
}

#[test]
fn loads_and_wind_light() {
    compare("loads_and_wind_light", solved(catalog::loads_wind_heat()), Theme::Light);
}

#[test]
fn over_service_tension_dark() {
    let mut state = solved(catalog::hanging_span());
    let scene = state.snapshot.scene.as_deref().expect("a scene");
    let mut scene = scene.clone();
    let most = state.snapshot.solution.as_ref().expect("an answer").max_tension().tension_n;
    scene.cables[0].service_tension_n = 0.93 * most;
    state.snapshot.scene = Some(scene.into());
    compare("over_service_tension_dark", state, Theme::Dark);
}

#[test]
fn no_answer_dark() {
    let mut state = solved(catalog::hanging_span());
    state.snapshot.error = Some("fem did not converge in 60 iterations: unbalanced force 3.2 N at node 7".to_owned());
    state.snapshot.stale = true;
    compare("no_answer_dark", state, Theme::Dark);
}

#[test]
fn obstacles_light() {
    let mut state = AppState::new(catalog::tank(), None);
    state.snapshot.error = Some("nothing was solved for this picture".to_owned());
    state.selected = Some(Item::Obstacle(0));
    compare("obstacles_light", state, Theme::Light);
}
