//! The worker on its own thread: how long an edit takes to be on screen (printed, never asserted), and that a
//! flood of edits ends at the last one.

use std::time::{Duration, Instant};

use cable_core::Model;
use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, SceneCommand};
use egui::Vec2;
use egui_kittest::Harness;

/// Longer than any answer takes on a loaded machine; only a dead worker reaches it.
const PATIENCE: Duration = Duration::from_secs(30);

fn threaded(segments: usize) -> Harness<'static, ViewerApp> {
    let mut scene = catalog::hanging_span();
    scene.cables[0].segments = Some(segments);
    let mut harness = Harness::builder()
        .with_size(Vec2::new(1280.0, 800.0))
        .with_step_dt(1.0 / 60.0)
        .allow_missing_glyphs()
        .build_eframe(|cc| {
            let mut app = ViewerApp::new(&cc.egui_ctx, scene, None);
            app.apply(&cc.egui_ctx, vec![Command::SetModel(Model::Fem)]);
            app
        });
    wait(&mut harness);
    harness
}

fn wait(harness: &mut Harness<'_, ViewerApp>) {
    let began = Instant::now();
    while !harness.state().settled() {
        assert!(began.elapsed() < PATIENCE, "{:?}", harness.state().state.worker);
        harness.step();
    }
}

fn set_length(harness: &mut Harness<'_, ViewerApp>, length_m: f64) {
    let mut cable = harness.state().state.scene.cables[0].clone();
    cable.length_m = length_m;
    let ctx = harness.ctx.clone();
    let edit = SceneCommand::SetCable { cable: 0, value: Box::new(cable) };
    harness.state_mut().apply(&ctx, vec![Command::Scene(edit)]);
}

#[test]
fn edits_at_200_nodes_are_timed() {
    let mut harness = threaded(200);
    let mut delays: Vec<f64> = Vec::new();
    for k in 0..40 {
        set_length(&mut harness, 12.0 + 0.01 * f64::from(k));
        wait(&mut harness);
        assert_eq!(harness.state().state.snapshot.error, None);
        delays.push(harness.state().state.edit_latency_s.expect("an answer") * 1e3);
    }
    delays.sort_by(f64::total_cmp);
    println!(
        "edit to first frame that shows it, 200 elements: median {:.1} ms, worst {:.1} ms",
        delays[20], delays[39]
    );
}

#[test]
fn a_flood_of_edits_ends_at_the_last() {
    let mut harness = threaded(60);
    for k in 0..600 {
        set_length(&mut harness, 12.0 + 0.001 * f64::from(k));
        if k % 20 == 0 {
            harness.step();
        }
    }
    wait(&mut harness);
    let state = &harness.state().state;
    let solved = state.snapshot.scene.as_ref().expect("a scene");
    assert_eq!(**solved, state.scene);
    let length = state.snapshot.solution.as_ref().unwrap().cables[0].nodes.last().unwrap().arc_length_m;
    assert!((length - 12.599).abs() < 1e-9, "{length}");
}
