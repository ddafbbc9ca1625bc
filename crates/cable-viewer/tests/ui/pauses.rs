//! These tests edit the scene in a pause, when time has run: what the edit concerns changes, the
//! rest of the motion stays as it is, and what cannot go on is another run.

use cable_core::scene::{Heading, catalog};
use cable_core::wording::Sentence;
use cable_core::{Robot, Solution, UnitSystem};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, SceneCommand};
use cable_viewer::state::{AppState, Item};
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open, select};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn answer(harness: &Harness<'_, ViewerApp>) -> Solution {
    state(harness).live.snapshot.solution.as_deref().expect("an answer").clone()
}

/// Lets time run for a number of frames, and pauses.
fn run(harness: &mut Harness<'_, ViewerApp>, frames: usize) {
    harness.key_press(Key::Space);
    harness.run_steps(frames);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert!(state(harness).live.playback.paused);
}

fn undo(harness: &mut Harness<'_, ViewerApp>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(4);
}

/// Returns time, places, tensions and velocities of all nodes.
fn motion(answer: &Solution) -> impl PartialEq + std::fmt::Debug + use<> {
    let nodes = answer.cables.iter().flat_map(|c| &c.nodes);
    let nodes = nodes.map(|n| [n.arc_length_m, n.x_m, n.y_m, n.tension_n, n.vx_m_per_s, n.vy_m_per_s]);
    (answer.time_s, nodes.collect::<Vec<_>>())
}

fn edit_cable(harness: &mut Harness<'_, ViewerApp>, change: impl FnOnce(&mut cable_core::Cable)) {
    let mut cable = state(harness).document.scene.cables[0].clone();
    change(&mut cable);
    apply(harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    apply(harness, Command::Scene(SceneCommand::EditDone));
}

/// Issue 20: after four seconds of play the start of the robot was typed 4 m from where it had
/// been. Time stayed at 4.05 s, the robot stood at its new start and the cable over it, the sign of
/// the hitch beside both, and undo did not lead back.
#[test]
fn issue_020_a_far_start_of_the_robot_is_another_run_and_not_a_splice() {
    let scene = catalog::tank_robot();
    let robot = scene.robot.clone().unwrap();
    let far = Robot { at_m: [1.6, robot.at_m[1]], ..robot.clone() };
    let turned = Robot { at_m: [2.6, robot.at_m[1]], heading: Heading::Left, ..robot };
    for robot in [far, turned] {
        let mut harness = open(scene.clone());
        run(&mut harness, 240);
        let end = answer(&harness);
        assert!(end.time_s > 3.9);
        apply(&mut harness, Command::Scene(SceneCommand::SetRobot(Some(robot.clone()))));
        apply(&mut harness, Command::Scene(SceneCommand::EditDone));
        let now = answer(&harness);
        assert_eq!(now.time_s, 0.0, "{robot:?}: another start is another run");
        let said: Vec<String> = now.warnings.iter().map(|w| w.sentence(UnitSystem::Si)).collect();
        assert!(!said.iter().any(|w| w.contains("cannot reach")), "{said:?}");
        let hitch = state(&harness).document.scene.hitch_m().unwrap();
        let end_of_cable = now.cables[0].nodes.last().unwrap();
        assert!((end_of_cable.x_m - hitch[0]).hypot(end_of_cable.y_m - hitch[1]) < 1e-3);
        undo(&mut harness);
        assert_eq!(state(&harness).document.scene, scene);
        assert_eq!(motion(&answer(&harness)), motion(&end), "undo leads back to the end of the first run");
    }
}

/// Issue 20: a robot that was dragged at the start, and whose drag was taken back after some time,
/// was put into the motion of the other run.
#[test]
fn issue_020_the_undo_of_a_robots_start_is_the_start_of_that_scene() {
    let scene = catalog::tank_robot();
    let mut harness = open(scene.clone());
    let first = answer(&harness);
    let at = scene.robot.as_ref().unwrap().at_m;
    apply(&mut harness, Command::Scene(SceneCommand::Move { item: Item::Robot, to_m: [at[0] - 1.0, at[1]] }));
    apply(&mut harness, Command::Scene(SceneCommand::EditDone));
    run(&mut harness, 120);
    let recorded = state(&harness).live.recording.span_s();
    undo(&mut harness);
    assert_eq!(state(&harness).document.scene, scene);
    assert_eq!(motion(&answer(&harness)), motion(&first));
    // What has run is kept.
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.run_steps(4);
    assert_eq!(state(&harness).live.recording.span_s(), recorded);
}

/// Issue 20: in a pause a service tension was typed, and the cable was at rest without a word:
/// 211.4 for 212.3 N, which undo did not bring back.
#[test]
fn issue_020_a_limit_or_a_name_typed_in_a_pause_leaves_the_motion_to_the_bit() {
    let mut harness = open(catalog::tank_robot());
    run(&mut harness, 180);
    let before = answer(&harness);
    let figures = motion(&before);
    let service_n = 0.5 * before.max_tension().tension_n;
    edit_cable(&mut harness, |c| c.service_tension_n = service_n);
    let now = answer(&harness);
    assert_eq!(motion(&now), figures);
    let said: Vec<String> = now.warnings.iter().map(|w| w.sentence(UnitSystem::Si)).collect();
    assert!(said.iter().any(|w| w.contains("service")), "it is judged anew: {said:?}");
    edit_cable(&mut harness, |c| c.breaking_tension_n *= 2.0);
    edit_cable(&mut harness, |c| c.min_bend_radius_m *= 2.0);
    edit_cable(&mut harness, |c| c.supports[0].name = "entry".to_owned());
    apply(&mut harness, Command::Scene(SceneCommand::SetName("Another name".to_owned())));
    assert_eq!(motion(&answer(&harness)), figures);
    for _ in 0..5 {
        undo(&mut harness);
        assert_eq!(motion(&answer(&harness)), figures);
    }
    assert!(harness.query_by_label_contains("Brought to rest").is_none());
    assert!(!state(&harness).live.snapshot.peaks.is_empty(), "the greatest of the run is known on");
}

/// Issue 20: what changes the motion brings the cable to rest in a pause, and nothing said so.
#[test]
fn issue_020_an_edit_that_brings_the_cable_to_rest_says_so() {
    let mut harness = open(catalog::tank_robot());
    run(&mut harness, 60);
    edit_cable(&mut harness, |c| c.linear_density_kg_per_m *= 1.1);
    assert!(answer(&harness).time_s > 0.9);
    harness.get_by_label("Brought to rest by the edit");
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert!(harness.query_by_label("Brought to rest by the edit").is_none());
}

/// Issue 20: another name for a cable, typed in a pause, ended the run.
#[test]
fn issue_020_a_cable_that_gets_another_name_in_a_pause_goes_on() {
    for frames in [0, 60] {
        let mut harness = open(catalog::tank_robot());
        if frames > 0 {
            run(&mut harness, frames);
        }
        let before = answer(&harness);
        edit_cable(&mut harness, |c| c.name = "tether".to_owned());
        let now = answer(&harness);
        assert_eq!(motion(&now), motion(&before));
        assert_eq!(now.cables[0].name, "tether");
    }
}

/// Issue 20: “Greatest tension so far 573 N” stood beside an earlier picture, and was that of the
/// end of the recording.
#[test]
fn issue_020_the_greatest_tension_of_a_run_names_its_span_beside_an_earlier_picture() {
    let mut harness = open(catalog::tank_robot());
    run(&mut harness, 120);
    harness.get_by_label("Greatest tension of the run");
    let end_s = answer(&harness).time_s;
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.5))));
    assert!(harness.query_by_label("Greatest tension of the run").is_none());
    harness.get_by_label(&format!("Greatest of 0 to {end_s:.1} s"));
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(None)));
    harness.get_by_label("Greatest tension of the run");
}

/// Issue 20: the undo of a waypoint left the next support selected, which Delete then took off the
/// robot.
#[test]
fn issue_020_an_undo_leaves_no_other_thing_selected() {
    let scene = catalog::tank_robot();
    let mut harness = open(scene.clone());
    let node = answer(&harness).cables[0].nodes[20];
    let (arc_length_m, at_m) = (node.arc_length_m, [node.x_m, node.y_m + 0.1]);
    apply(&mut harness, Command::Scene(SceneCommand::AddWaypoint { cable: 0, arc_length_m, at_m }));
    assert_eq!(state(&harness).selection.selected, Some(Item::Support { cable: 0, support: 1 }));
    undo(&mut harness);
    assert_eq!(state(&harness).selection.selected, None);
    harness.key_press(Key::Delete);
    harness.run_steps(3);
    assert_eq!(state(&harness).document.scene, scene);
    // By redo as well; what stays the same thing stays selected.
    select(&mut harness, Item::Support { cable: 0, support: 1 });
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.run_steps(4);
    assert_eq!(state(&harness).selection.selected, None);
    select(&mut harness, Item::Support { cable: 0, support: 0 });
    undo(&mut harness);
    assert_eq!(state(&harness).selection.selected, Some(Item::Support { cable: 0, support: 0 }));
}

/// Issue 20: after further edits and another run “Undo restart” exchanged two runs.
#[test]
fn issue_020_another_run_is_called_the_previous_one_after_further_edits() {
    let mut harness = open(catalog::tank_robot());
    run(&mut harness, 40);
    let at = state(&harness).document.scene.robot.as_ref().unwrap().at_m;
    apply(&mut harness, Command::Scene(SceneCommand::Move { item: Item::Robot, to_m: [at[0] - 0.5, at[1]] }));
    apply(&mut harness, Command::Scene(SceneCommand::EditDone));
    harness.get_by_label("Undo restart");
    edit_cable(&mut harness, |c| c.linear_density_kg_per_m *= 1.1);
    assert!(harness.query_by_label("Undo restart").is_none());
    harness.get_by_label("Previous run");
    run(&mut harness, 10);
    harness.get_by_label("Previous run");
    // A reset is undone as such until something else is done.
    let mut harness = open(catalog::tank_robot());
    run(&mut harness, 40);
    apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
    harness.get_by_label("Undo restart");
    edit_cable(&mut harness, |c| c.linear_density_kg_per_m *= 1.1);
    harness.get_by_label("Previous run");
}
