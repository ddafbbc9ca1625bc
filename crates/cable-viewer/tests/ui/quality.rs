//! These tests show how far an answer can be relied on, and the motion of any point of the cable.

use cable_core::scene::catalog;
use cable_core::{Model, Settings};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::TensionMarker;
use cable_viewer::units::unit::Unit;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open, open_span};

/// The form of the solver in a window that shows the whole of it.
fn tall(harness: &mut Harness<'_, ViewerApp>) {
    crate::select(harness, cable_viewer::state::Item::Solver);
    harness.set_size(egui::Vec2::new(1600.0, 2400.0));
    harness.run_steps(3);
}

/// Makes the first cable ten thousand times as stiff, and asks for a part in a million.
fn make_too_stiff(harness: &mut Harness<'_, ViewerApp>) {
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.axial_stiffness_n *= 1e4;
    apply(harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    let settings = Settings { tolerance: 1e-6, ..harness.state().state.solver.settings };
    apply(harness, Command::SetSettings(settings));
    harness.run_steps(3);
}

#[test]
fn t06_residual_displacement_and_condition_stand_in_the_solver_panel() {
    let mut harness = open_span();
    tall(&mut harness);
    for row in ["Residual", "Greatest displacement", "Condition estimate", "Kinetic energy"] {
        harness.get_by_label(row);
    }
    // EA = 2 MN under some 70 N in 100 elements: ten million and more.
    let read = |h: &Harness<'_, ViewerApp>| {
        let found = h.get_by_label_contains("≈ ");
        use egui_kittest::kittest::NodeT;
        found.accesskit_node().value().or(found.accesskit_node().label()).unwrap_or_default()
    };
    assert!(read(&harness).contains("×10^"), "{}", read(&harness));
    // Too stiff: said before anybody believes the figures.
    make_too_stiff(&mut harness);
    let told = read(&harness);
    assert!(told.ends_with("10^11"), "{told} with {:?}", harness.state().state.live.snapshot.error);
    // A model without a mesh has none.
    let mut harness = open(catalog::hanging_span());
    apply(&mut harness, Command::SetModel(Model::Catenary));
    tall(&mut harness);
    harness.get_by_label("no mesh");
}

#[test]
fn t08_the_motion_of_any_point_is_shown_live() {
    let mut harness = open_span();
    tall(&mut harness);
    let from = cable_core::analysis::tension_budget::StartEnd::Start;
    let marker = TensionMarker { cable: 0, arc_length_m: 6.0, from };
    apply(&mut harness, Command::View(ViewCommand::SetTensionMarker(Some(marker))));
    for row in ["Displacement", "Velocity", "Acceleration"] {
        harness.get_by_label(row);
    }
    // Something to swing about: an end moves at once.
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(4);
    let item = cable_viewer::state::Item::Support { cable: 0, support: 1 };
    apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: [9.6, 5.2] }));
    harness.run_steps(40);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    harness.run_steps(2);
    let answer = harness.state().state.live.snapshot.solution.clone().unwrap();
    let node = answer.cables[0].nodes.iter().min_by_key(|n| ((n.arc_length_m - 6.0).abs() * 1e9) as i64).unwrap();
    assert!((node.arc_length_m - 6.0).abs() < 1e-6, "a node stands there: {}", node.arc_length_m);
    for (unit, [x, y]) in [
        (Unit::M, node.displacement_m),
        (Unit::M_PER_S, [node.vx_m_per_s, node.vy_m_per_s]),
        (Unit::M_PER_S2, node.acceleration_m_per_s2),
    ] {
        assert!(x.hypot(y) > 0.0, "{}", unit.symbol);
        assert!(harness.get_all_by_label(&unit.text(x.hypot(y))).count() > 0, "{}", unit.text(x.hypot(y)));
    }
    harness.get_by_label("Show greatest displacement").click();
    harness.run_steps(2);
}

/// They were marked in the form of the solver only, which is shown once it is selected.
#[test]
fn what_makes_figures_doubtful_is_in_the_list_of_warnings() {
    let listed = |harness: &Harness<'_, ViewerApp>, title: &str| {
        let mut texts = Vec::new();
        harness.output().shapes.iter().for_each(|s| crate::warnings::galleys(&s.shape, &mut texts));
        texts.iter().any(|(text, ..)| text.starts_with(title))
    };
    let mut harness = open_span();
    for title in ["Residual above tolerance", "Ill-conditioned equations", "Kinetic energy grows"] {
        assert!(!listed(&harness, title), "{title} of a sound answer");
    }
    // Too stiff for the accuracy asked for.
    make_too_stiff(&mut harness);
    assert!(listed(&harness, "Ill-conditioned equations"));
    harness.get_by_label_contains("Ill-conditioned equations: ").click();
    harness.run_steps(3);
    assert_eq!(harness.state().state.selection.selected, Some(cable_viewer::state::Item::Solver));
    // An answer with a force left, as of a solve that was ended early.
    let mut harness = open_span();
    let mut answer = (*harness.state().state.live.snapshot.solution.clone().unwrap()).clone();
    answer.cost.residual_n = 0.1 * answer.max_tension().tension_n;
    harness.state_mut().state.live.snapshot.solution = Some(std::sync::Arc::new(answer));
    harness.step();
    assert!(listed(&harness, "Residual above tolerance"));
    // A motion that doubles its energy every second.
    let mut harness = open_span();
    let first = harness.state().state.live.history.samples.back().unwrap().clone();
    for k in 1..=360 {
        let time_s = f64::from(k) / 60.0;
        let sample =
            cable_viewer::record::sample::Sample { time_s, energy_j: [time_s.exp2(), 0.0, 0.0, 0.0], ..first.clone() };
        harness.state_mut().state.live.history.push(sample);
    }
    harness.step();
    assert!(listed(&harness, "Kinetic energy grows"));
    // A hand, a schedule or the robot may give it, and a cable that falls has it from its height.
    let samples = harness.state().state.live.history.samples.clone();
    for mut sample in samples {
        sample.energy_j[1] = 100.0 - sample.energy_j[0];
        harness.state_mut().state.live.history.push(sample);
    }
    harness.step();
    assert!(!listed(&harness, "Kinetic energy grows"));
}
