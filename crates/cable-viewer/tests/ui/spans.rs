//! The window shows the `spans` model: contacts as stretches, slip fronts, where a tension comes
//! from, drags without a sawtooth.

use cable_core::analysis::tension_budget::{Cause, StartEnd, tension_budget};
use cable_core::scene::{Obstacle, Shape, Support, SupportKind, catalog};
use cable_core::solution::ContactState;
use cable_core::{Model, Scene};
use cable_viewer::command::{Command, PlaybackCommand, SceneCommand};
use cable_viewer::state::Item;
use egui::{Key, Role, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};

use crate::rows::{answer, click, play, state};
use crate::{apply, open, press};

/// A hand to the left above a beam, tilted by 10° so that a weight hangs free of its right side.
fn corner() -> Scene {
    let mut scene = catalog::cable_alone([6.0, 0.5, 1e6], Vec::new());
    let mut weight = Support::fixed("weight", [0.0; 2]);
    (weight.kind, weight.at_m, weight.force_n) = (SupportKind::Load, None, Some([0.0, -100.0]));
    scene.cables[0].supports = vec![Support::fixed("hand", [-2.0, 0.8]), weight];
    scene.cables[0].route_m = vec![[-2.0, 0.8], [0.0, 0.02], [0.02, -3.8]];
    scene.cables[0].diameter_m = 0.02;
    let (sin, cos) = (-10.0_f64).to_radians().sin_cos();
    let corners = [[0.0, 0.0], [-2.0, 0.0], [-2.0, -2.0], [0.0, -2.0]];
    scene.obstacles.push(Obstacle {
        name: "beam".to_owned(),
        shape: Shape::Polygon {
            points_m: corners.map(|[x, y]: [f64; 2]| [x * cos - y * sin, x * sin + y * cos]).to_vec(),
        },
        friction: Some(0.3),
    });
    scene
}

#[test]
fn spans_is_offered_wherever_models_are() {
    let mut harness = open(catalog::round_post());
    harness.set_size(Vec2::new(1280.0, 1800.0));
    harness.run_steps(3);
    crate::select(&mut harness, Item::Solver);
    click(&mut harness, "Spans");
    assert_eq!(state(&harness).solver.model, Model::Spans);
    assert_eq!(state(&harness).live.snapshot.error, None);
    assert_eq!(answer(&harness).model, Model::Spans);
    harness.get_by_label_contains("Time runs without inertia");
    // By keys alone.
    apply(&mut harness, Command::SetModel(Model::Fem));
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::P);
    harness.run_steps(2);
    harness.get_by_label("Command").type_text("solve spans");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(state(&harness).solver.model, Model::Spans);
}

#[test]
fn stretches_of_contact_and_slip_fronts_are_named_on_the_canvas_and_move() {
    let mut harness = open(catalog::draped_slipping());
    apply(&mut harness, Command::SetModel(Model::Spans));
    assert_eq!(state(&harness).live.snapshot.error, None);
    harness.get_all_by_label_contains("Contact of cable with pipe: ").next().expect("a stretch");
    harness.get_all_by_label_contains("Slip front of cable at ").next().expect("a front on the canvas");
    play(&mut harness, 120);
    assert_eq!(state(&harness).live.snapshot.error, None);
    let contacts = state(&harness).live.recording.answers().iter().filter_map(|a| a.cables[0].contacts.first());
    let seen: Vec<f64> = contacts.flat_map(|c| c.parts.windows(2).map(|p| p[1].begins_m)).collect();
    assert!(seen.windows(2).any(|w| (w[1] - w[0]).abs() > 1e-6), "a front moves: {seen:?}");
    let slides = answer(&harness).cables[0].contacts.iter().any(|c| c.state == ContactState::Slip);
    assert!(slides, "in the end all of it slides");
    harness.get_all_by_label_contains("with pipe: slides").next().expect("said so");
}

#[test]
fn a_click_on_the_cable_shows_where_its_tension_comes_from() {
    let mut harness = open(corner());
    apply(&mut harness, Command::SetModel(Model::Spans));
    assert_eq!(state(&harness).live.snapshot.error, None);
    harness.set_size(Vec2::new(1280.0, 1800.0));
    harness.run_steps(5);
    apply(&mut harness, Command::View(cable_viewer::command::ViewCommand::Fit));
    let nodes = answer(&harness).cables[0].nodes.clone();
    let near_hand = nodes.iter().find(|n| n.arc_length_m > 0.7).unwrap();
    let canvas = harness.get_by_label("Canvas").rect();
    let at = state(&harness).view.camera.to_screen(canvas, [near_hand.x_m, near_hand.y_m]);
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false] {
        press(&harness, at, pressed);
        harness.step();
    }
    // The panel scrolls to the answer.
    harness.run_steps(4);
    let probe = state(&harness).analysis.tension_marker.expect("a place");
    assert!((probe.arc_length_m - near_hand.arc_length_m).abs() < 0.1, "{probe:?}");
    let found =
        tension_budget(&state(&harness).document.scene, &answer(&harness), 0, probe.arc_length_m, probe.from).unwrap();
    let sum: f64 = found.contributions.iter().map(|t| t.tension_n).sum();
    assert!((sum - found.tension_n).abs() < 1e-6);
    let contact =
        found.contributions.iter().find(|t| matches!(t.cause, Cause::Contact(_))).expect("the beam's friction");
    assert!(contact.tension_n.abs() > 1.0 && contact.factor.is_some(), "{contact:?}");
    let words = |h: &egui_kittest::Harness<'_, cable_viewer::ViewerApp>| {
        let figure = h.get_by_role_and_label(Role::Figure, "Where the tension comes from");
        figure.accesskit_node().description().unwrap_or_default()
    };
    let said = words(&harness);
    assert!(said.starts_with(&cable_viewer::units::format::force(found.tension_n)), "{said}");
    assert!(said.contains("Friction on beam") && said.contains("Weight") && said.contains("Pull at the end"), "{said}");
    harness.get_by_label("Friction on beam");
    // The other end, and another place, without the pointer on the canvas.
    click(&mut harness, "From hand");
    assert_eq!(state(&harness).analysis.tension_marker.map(|p| p.from), Some(StartEnd::Start));
    assert!(!words(&harness).contains("Friction on beam"), "the beam is not between the hand and the place");
    // A list that is scrolled to its end moves where it becomes shorter.
    harness.run_steps(2);
    click(&mut harness, "At the greatest tension");
    let most = answer(&harness).max_tension();
    assert_eq!(state(&harness).analysis.tension_marker.map(|p| p.arc_length_m), Some(most.arc_length_m));
    harness.run_steps(2);
    click(&mut harness, "Unmark");
    assert!(state(&harness).analysis.tension_marker.is_none());
}

/// Greatest fourth difference of evenly spaced values over their size: what is smooth has next to
/// none, a sawtooth 16 of its height.
fn ripple(values: &[f64]) -> f64 {
    let size = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let fourth = values.windows(5).map(|w| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs());
    fourth.fold(0.0, f64::max) / (16.0 * size)
}

#[test]
fn a_recorded_drag_over_a_right_angle_has_no_sawtooth() {
    let mut harness = open(corner());
    apply(&mut harness, Command::SetModel(Model::Spans));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    for k in 1..=160 {
        let to_m = [-2.0 - 0.005 * f64::from(k), 0.8];
        let item = Item::Support { cable: 0, support: 0 };
        let ctx = harness.ctx.clone();
        harness.state_mut().apply(&ctx, vec![Command::Scene(SceneCommand::Move { item, to_m })]);
        harness.step();
        assert_eq!(state(&harness).live.snapshot.error, None, "at {to_m:?}");
    }
    let recorded = state(&harness).live.recording.answers();
    let wrap = |a: &cable_core::Solution| a.cables[0].contacts.first().cloned().unwrap();
    let sliding: Vec<_> = recorded.iter().map(wrap).filter(|c| c.state == ContactState::Slip).collect();
    assert!(sliding.len() > 100, "{} of {}", sliding.len(), recorded.len());
    // The last hundred: every frame of the drag slides by then.
    let pulls: Vec<f64> = sliding[sliding.len() - 100..].iter().map(|c| c.tension_before_n).collect();
    let most = ripple(&pulls);
    println!("ripple of the pull over a right angle: {most:.1e}");
    assert!(most < 1e-6, "{most}");
    // The measure would see one of a hundred-thousandth.
    let sawn: Vec<f64> = pulls.iter().enumerate().map(|(k, p)| p * (1.0 + 1e-5 * (k % 2) as f64)).collect();
    assert!(ripple(&sawn) > 1e-6);
    // It follows the capstan: a heavy cable on a round of its own radius, to what its weight there
    // can do.
    let last = sliding.last().unwrap();
    let exact = (0.3 * last.turn_deg.abs().to_radians()).exp();
    let found = last.tension_before_n / last.tension_after_n;
    assert!((found / exact - 1.0).abs() < 2e-3, "{found} against {exact}");
}

/// The ribbon, once it is there.
fn ribbon(
    harness: &mut egui_kittest::Harness<'_, cable_viewer::ViewerApp>,
) -> std::sync::Arc<cable_core::analysis::friction_range::FrictionRange> {
    use cable_viewer::jobs::background::Progress;
    for _ in 0..6000 {
        harness.run_steps(1);
        match &state(harness).analysis.friction_range.progress {
            Progress::Done((found, _)) => return found.clone(),
            Progress::Failed(why) => panic!("{why}"),
            _ => std::thread::sleep(std::time::Duration::from_millis(5)),
        }
    }
    panic!("no ribbon in half a minute");
}

/// A hand draws the cable down while time runs: the ribbon is of that run, its middle one what is
/// on screen.
#[test]
fn s19_the_ribbon_of_friction_repeats_what_a_hand_did() {
    let mut scene = catalog::draped_slipping();
    let from = scene.cables[0].supports[1].at_m.unwrap();
    scene.cables[0].supports[1].motion = None;
    let mut harness = open(scene);
    apply(&mut harness, Command::SetModel(Model::Spans));
    harness.set_size(Vec2::new(1400.0, 1800.0));
    let still = answer(&harness).max_tension().tension_n;
    play(&mut harness, 5);
    for k in 1..=15 {
        let item = cable_viewer::state::Item::Support { cable: 0, support: 1 };
        let to_m = [from[0], from[1] - 0.04 * f64::from(k)];
        apply(&mut harness, Command::Scene(cable_viewer::command::SceneCommand::Move { item, to_m }));
    }
    harness.run_steps(20);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let now = answer(&harness).max_tension().tension_n;
    assert!(now > 1.05 * still, "{now} N of {still} N: it was drawn");
    click(&mut harness, "Show friction range");
    let found = ribbon(&mut harness);
    let [low, likely, high] = found.most_n;
    assert!((likely / now - 1.0).abs() < 1e-6, "{likely} N for {now} N");
    assert!(low < 0.9 * likely && high > 1.1 * likely, "{:?}", found.most_n);
}

/// Least, likely and most friction: a ribbon in both graphs, which the answer lies in, and figures.
#[test]
fn friction_that_is_not_known_well_is_a_ribbon_of_tension() {
    let mut harness = open(catalog::draped_slipping());
    apply(&mut harness, Command::SetModel(Model::Spans));
    harness.set_size(Vec2::new(1400.0, 1800.0));
    play(&mut harness, 110);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    click(&mut harness, "Show friction range");
    let found = ribbon(&mut harness);
    harness.run_steps(2);
    let [low, likely, high] = found.most_n;
    assert!(
        (likely / answer(&harness).max_tension().tension_n - 1.0).abs() < 1e-9,
        "the middle one is what is on screen"
    );
    assert!(low < 0.9 * likely && high > 1.1 * likely, "{:?}", found.most_n);
    for (title, [low, high]) in [
        ("Over time", [low, high]),
        ("Along the cable", {
            let last = found.along[0].last().unwrap();
            [last.low_n, last.high_n]
        }),
    ] {
        let figure = harness.get_by_role_and_label(Role::Figure, title);
        let said = figure.accesskit_node().description().unwrap_or_default();
        let figures = [low, high].map(|v| cable_viewer::units::format::significant(v, 4));
        let expected = format!("with less and more friction {} to {} N", figures[0], figures[1]);
        assert!(said.contains(&expected), "{title}: {said}, not {expected}");
    }
    harness.get_by_label(&cable_viewer::units::format::force(high));
    // It follows what is edited, and goes.
    apply(
        &mut harness,
        Command::View(cable_viewer::command::ViewCommand::SetFrictionRange { shown: true, factors: [1.0, 1.0] }),
    );
    let found = ribbon(&mut harness);
    assert!((found.most_n[0] / found.most_n[2] - 1.0).abs() < 1e-12, "{:?}", found.most_n);
    click(&mut harness, "Show friction range");
    let figure = harness.get_by_role_and_label(Role::Figure, "Over time");
    assert!(!figure.accesskit_node().description().unwrap_or_default().contains("friction"));
}

/// The effect of neglected bending stiffness is computed on request, for the answer on screen only.
#[test]
fn a_flexible_answer_is_compared_with_a_stiff_one() {
    use cable_viewer::jobs::background::Progress;
    let mut harness = open(catalog::round_post());
    harness.set_size(Vec2::new(1400.0, 1800.0));
    harness.run_steps(3);
    let flexible = answer(&harness).max_tension().tension_n;
    click(&mut harness, "Compare with the likely bending stiffness");
    let begun = std::time::Instant::now();
    let found = loop {
        harness.run_steps(1);
        match &state(&harness).analysis.neglected_bending.progress {
            Progress::Done(found) => break found.clone(),
            Progress::Failed(why) => panic!("{why}"),
            _ => assert!(begun.elapsed().as_secs() < 60, "no answer in a minute"),
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    };
    harness.run_steps(2);
    let with = found[0].greatest_tension_n.unwrap();
    assert!(with < 0.99 * flexible, "{with} N of {flexible} N");
    let said = format!("{:+.2} % with it", 100.0 * (with / flexible - 1.0));
    harness.get_by_label(&said);
    // The stiffness can be taken, and that be undone: it is one edit.
    click(&mut harness, "Take 1.400 N·m²");
    harness.run_steps(3);
    assert_eq!(state(&harness).document.scene.cables[0].bending_stiffness_n_m2, 1.4);
    assert_eq!(answer(&harness).cables[0].assumptions.bending_stiffness_n_m2, 1.4);
    assert!((answer(&harness).max_tension().tension_n / with - 1.0).abs() < 1e-6);
    apply(&mut harness, Command::Scene(cable_viewer::command::SceneCommand::Undo));
    harness.run_steps(3);
    assert_eq!(state(&harness).document.scene, catalog::round_post());
    assert_eq!(answer(&harness).max_tension().tension_n, flexible);
    // It is of this answer: another one has not been compared.
    let item = cable_viewer::state::Item::Support { cable: 0, support: 1 };
    let [x, y] = state(&harness).document.scene.cables[0].supports[1].at_m.unwrap();
    let edit = cable_viewer::command::SceneCommand::Move { item, to_m: [x - 0.1, y] };
    apply(&mut harness, Command::Scene(edit));
    harness.run_steps(3);
    harness.get_by_label("Compare with the likely bending stiffness");
}
