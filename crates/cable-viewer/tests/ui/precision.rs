//! These tests draw the chart of error over cost: every model and mesh, on demand, with progress
//! and an end on request.

use std::time::{Duration, Instant};

use cable_core::scene::catalog;
use cable_core::{Model, Settings};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::jobs::background::Progress;
use cable_viewer::state::Item;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::rows::{click, set_cable, state};
use crate::{apply, open, select};

/// Longer than it takes on a loaded machine.
const PATIENCE: Duration = Duration::from_secs(120);

fn charted(harness: &mut Harness<'_, ViewerApp>) {
    let began = Instant::now();
    while matches!(state(harness).analysis.work_precision, Progress::Running(..)) {
        assert!(began.elapsed() < PATIENCE);
        std::thread::sleep(Duration::from_millis(10));
        harness.step();
    }
    harness.run_steps(2);
}

#[test]
fn every_model_and_mesh_is_charted_with_the_choice_and_its_reason() {
    let mut harness = open(catalog::over_beam());
    select(&mut harness, Item::Solver);
    harness.set_size(egui::Vec2::new(1280.0, 1800.0));
    harness.run_steps(3);
    click(&mut harness, "Plot error against cost");
    harness.get_by_label("Progress of the chart");
    charted(&mut harness);
    let Progress::Done(found) = state(&harness).analysis.work_precision.clone() else { panic!("no chart") };
    assert_eq!(found.given.0.model, Model::Spans);
    let errors = |model| {
        let own = found.entries.iter().filter(|e| e.setting.model == model);
        own.map(|e| e.result.as_ref().map(|(c, _)| c.force_difference)).collect::<Vec<_>>()
    };
    // The same model has the same answer, finer meshes come nearer, and a model that cannot says
    // why.
    assert!(errors(Model::Spans)[0].is_ok_and(|e| e < 1e-6));
    let fem: Vec<f64> = errors(Model::Fem).into_iter().map(|e| e.unwrap()).collect();
    assert!(fem.len() == 5 && fem[4] < fem[0], "{fem:?}");
    assert!(errors(Model::Catenary)[0].is_err());
    let figure = harness.get_by_role_and_label(egui::accesskit::Role::Figure, "Error over cost");
    let spoken = figure.accesskit_node().description().unwrap_or_default();
    assert!(spoken.contains("Spans: ") && spoken.contains("FEM with 400 segments: "), "{spoken}");
    harness.get_by_label_contains("In use: Spans");
    assert!(harness.get_all_by_label_contains("solved without a mesh and so without mesh error").count() > 0);
    harness.get_by_label_contains("Catenary: ");
    // The tolerance is a line in it, and moves what is quickest.
    let quickest = |h: &Harness<'_, ViewerApp>| {
        let found = h.get_by_label_contains("Fastest within");
        found.accesskit_node().value().or(found.accesskit_node().label()).unwrap_or_default()
    };
    for tolerance in [1e-6, 0.3] {
        let settings = Settings { tolerance, ..state(&harness).solver.settings };
        apply(&mut harness, Command::SetSettings(settings));
        harness.run_steps(3);
        let told = quickest(&harness);
        let (setting, _) = found.quickest(tolerance).unwrap();
        assert!(told.contains(if setting.model == Model::Spans { "Spans" } else { " of " }), "{told}: {setting:?}");
    }
    set_cable(&mut harness, |c| c.length_m += 0.1);
    harness.run_steps(2);
    harness.get_by_label("Out of date: edited since");
}

#[test]
fn a_chart_that_is_cancelled_keeps_its_part() {
    let mut harness = open(catalog::tank());
    select(&mut harness, Item::Solver);
    harness.set_size(egui::Vec2::new(1280.0, 1800.0));
    apply(&mut harness, Command::View(ViewCommand::ChartWorkPrecision));
    let began = Instant::now();
    let part = |h: &Harness<'_, ViewerApp>| match &state(h).analysis.work_precision {
        Progress::Running(_, Some(found)) | Progress::Done(found) => found.entries.len(),
        _ => 0,
    };
    while part(&harness) < 2 {
        assert!(began.elapsed() < PATIENCE);
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
    if matches!(state(&harness).analysis.work_precision, Progress::Running(..)) {
        click(&mut harness, "Cancel chart");
    }
    let kept = part(&harness);
    assert!(matches!(state(&harness).analysis.work_precision, Progress::Done(..)) && kept >= 2);
    std::thread::sleep(Duration::from_millis(100));
    harness.run_steps(3);
    assert_eq!(part(&harness), kept, "nothing is added once it was ended");
    harness.get_by_label("Plot error against cost");
}
