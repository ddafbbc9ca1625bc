//! These tests ask for one truth on the screen: figures, warnings and verdicts belong to the scene
//! as it is, and the same scene has the same answer however it was come by. D1 to D10 are defects
//! that a first user found by hand.

use std::time::{Duration, Instant};

use cable_core::scene::{Obstacle, RobotTask, Shape, catalog};
use cable_core::{Model, Scene, Solution};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::{AppState, Freshness, Item};
use egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{apply, open};

/// Longer than any answer takes on a loaded machine; only a dead worker reaches it.
const PATIENCE: Duration = Duration::from_secs(120);

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn answer(harness: &Harness<'_, ViewerApp>) -> Solution {
    state(harness).live.snapshot.solution.as_deref().expect("an answer").clone()
}

/// The window with its worker on its own thread.
fn threaded(scene: Scene, model: Model) -> Harness<'static, ViewerApp> {
    let mut harness =
        Harness::builder().with_size(Vec2::new(1280.0, 800.0)).with_step_dt(1.0 / 60.0).build_eframe(|cc| {
            let mut app = ViewerApp::new(&cc.egui_ctx, scene, None);
            app.apply(&cc.egui_ctx, vec![Command::SetModel(model)]);
            app
        });
    wait(&mut harness, |h| h.state().settled() && !state(h).live.snapshot.draft);
    harness
}

fn wait(harness: &mut Harness<'_, ViewerApp>, done: impl Fn(&Harness<'_, ViewerApp>) -> bool) -> Duration {
    let began = Instant::now();
    while !done(harness) {
        assert!(began.elapsed() < PATIENCE, "{:?} {:?}", state(harness).solver, state(harness).live.snapshot.error);
        harness.step();
        std::thread::sleep(Duration::from_millis(2));
    }
    began.elapsed()
}

fn submit(harness: &mut Harness<'_, ViewerApp>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().apply(&ctx, vec![command]);
}

fn set_length(harness: &mut Harness<'_, ViewerApp>, length_m: f64) {
    let mut cable = state(harness).document.scene.cables[0].clone();
    cable.length_m = length_m;
    submit(harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
}

fn move_hitch(harness: &mut Harness<'_, ViewerApp>, to_m: [f64; 2]) {
    let item = Item::Support { cable: 0, support: 1 };
    submit(harness, Command::Scene(SceneCommand::Move { item, to_m }));
}

fn settled(harness: &Harness<'_, ViewerApp>) -> bool {
    harness.state().settled() && !state(harness).live.snapshot.draft
}

/// Returns what does not depend on how long it took.
fn figures(answer: &Solution) -> impl PartialEq + std::fmt::Debug + use<> {
    (
        answer.time_s,
        answer.model,
        answer.cables.iter().map(|c| (c.nodes.clone(), c.supports.clone())).collect::<Vec<_>>(),
    )
}

/// A hitch that is dragged beyond the cable's length left the figures of a draft on screen for
/// ever, labelled as those of the last scene that was solved.
#[test]
fn a_scene_without_an_answer_shows_no_figure_of_a_draft() {
    let mut harness = threaded(catalog::tank(), Model::Fem);
    let good = answer(&harness);
    let at = state(&harness).document.scene.cables[0].supports[1].at_m.unwrap();
    for k in 1..=40 {
        move_hitch(&mut harness, [at[0] + 0.25 * f64::from(k), at[1] + 0.1 * f64::from(k)]);
        wait(&mut harness, |h| h.state().settled());
    }
    wait(&mut harness, settled);
    let shown = &state(&harness).live.snapshot;
    assert!(shown.error.is_some() && shown.stale && !shown.draft, "{:?}", shown.error);
    assert_eq!(state(&harness).freshness(), Freshness::Outdated);
    // The figures are those of a scene that was answered, in full.
    let solved = shown.scene.as_deref().expect("the scene that the figures are of").clone();
    assert_ne!(solved, state(&harness).document.scene);
    let alone = answer(&threaded(solved, Model::Fem));
    assert_eq!(figures(shown.solution.as_ref().unwrap()), figures(&alone));
    harness.run_steps(3);
    harness.get_by_label("Last valid result, not this scene");
    assert!(harness.query_by_label_contains("Breaks here").is_none());
    // Taken back, it is the answer of before, bit for bit.
    submit(&mut harness, Command::Scene(SceneCommand::Undo));
    wait(&mut harness, settled);
    assert_eq!(figures(&answer(&harness)), figures(&good));
}

/// Longest that a solve may go on which nobody waits for any more.
const GIVES_UP_WITHIN: Duration = Duration::from_millis(100);

/// Draws frames when the window asks for them, as a screen would, until the solve that runs is
/// given up. Returns how long that took.
fn given_up(harness: &mut Harness<'_, ViewerApp>, before: u64) -> Duration {
    let began = Instant::now();
    while harness.state().abandoned_solves() == before {
        assert!(began.elapsed() < PATIENCE, "{:?}", state(harness).solver);
        harness.step();
        let asked = harness.output().viewport_output.values().map(|v| v.repaint_delay).min();
        std::thread::sleep(asked.unwrap_or_default().clamp(Duration::from_millis(16), Duration::from_secs(1)));
    }
    began.elapsed()
}

/// D5b: an undo waited for the solve that it makes worthless. Edits before had made the window wait
/// longer and longer.
#[test]
fn undo_and_cancel_give_up_the_solve_before_within_a_tenth_of_a_second() {
    let mut harness = threaded(catalog::tank(), Model::Fem);
    let good = answer(&harness);
    for cancels in [false, true] {
        // A length typed again and again while none is answered.
        for length_m in [300.0, 310.0, 320.0, 330.0] {
            set_length(&mut harness, length_m);
            submit(&mut harness, Command::Scene(SceneCommand::EditDone));
            let began = Instant::now();
            wait(&mut harness, |_| began.elapsed() > Duration::from_millis(250));
        }
        // Until one is solved that is neither a draft nor given up.
        wait(&mut harness, |h| h.state().solves_for(Duration::from_millis(100)));
        let before = harness.state().abandoned_solves();
        let command =
            if cancels { Command::Playback(PlaybackCommand::CancelSolve) } else { Command::Scene(SceneCommand::Undo) };
        submit(&mut harness, command);
        let took = given_up(&mut harness, before);
        println!("cancelled: {cancels}; given up within {took:?}");
        assert!(took < GIVES_UP_WITHIN, "{took:?}");
        // Back to the start of the round.
        while state(&harness).document.undo.can_undo_and_redo().0 {
            submit(&mut harness, Command::Scene(SceneCommand::Undo));
        }
        wait(&mut harness, settled);
        assert_eq!(figures(&answer(&harness)), figures(&good));
        assert_eq!(state(&harness).live.snapshot.scene.as_deref(), Some(&state(&harness).document.scene));
    }
}

/// The user may give up a solve: the scene stays, without an answer, and can be solved after all.
#[test]
fn a_solve_can_be_cancelled_and_asked_for_again() {
    let mut harness = threaded(catalog::tank(), Model::Fem);
    let good = answer(&harness);
    set_length(&mut harness, 19.4);
    submit(&mut harness, Command::Playback(PlaybackCommand::CancelSolve));
    wait(&mut harness, settled);
    harness.run_steps(3);
    assert_eq!(state(&harness).freshness(), Freshness::Outdated);
    assert_eq!(state(&harness).document.scene.cables[0].length_m, 19.4);
    assert_eq!(figures(&answer(&harness)), figures(&good));
    harness.get_by_label("Solve").click();
    harness.run_steps(2);
    wait(&mut harness, settled);
    assert_eq!(state(&harness).freshness(), Freshness::Current);
    assert_eq!(answer(&harness).cables[0].nodes.last().unwrap().arc_length_m, 19.4);
}

/// D4: a draft's figures were shown as results.
#[test]
fn a_draft_warns_of_nothing_and_its_figures_are_dimmed() {
    let mut harness = open(catalog::hanging_span());
    let mut cable = state(&harness).document.scene.cables[0].clone();
    (cable.service_tension_n, cable.breaking_tension_n) = (1.0, 2.0);
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    assert!(harness.query_all_by_label_contains("Breaks here").next().is_some(), "as an answer it warns");
    harness.state_mut().state.live.snapshot.draft = true;
    harness.run_steps(2);
    assert_eq!(state(&harness).freshness(), Freshness::Draft);
    assert!(harness.query_all_by_label_contains("Breaks here").next().is_none());
    harness.get_by_label("Draft, not at rest yet");
    let words = harness.get_by_label("Canvas").accesskit_node().description().unwrap_or_default();
    assert!(!words.contains("greatest tension"), "{words}");
}

/// D6b: the hitch dragged and the drag undone gave 123.9 N where the same scene had 104.5 N.
#[test]
fn undo_reset_load_and_typing_give_the_same_answer_bit_for_bit() {
    for scene in [catalog::tank(), catalog::over_beam(), catalog::floor_drag()] {
        let mut harness = open(scene);
        let start = figures(&answer(&harness));
        let last = state(&harness).document.scene.cables[0].supports.len() - 1;
        let at = state(&harness).document.scene.cables[0].supports[last].at_m.unwrap();
        let item = Item::Support { cable: 0, support: last };
        for k in 1..=6 {
            let to_m = [at[0] - 0.12 * f64::from(k), at[1] + 0.02 * f64::from(k)];
            apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m }));
        }
        let moved = state(&harness).document.scene.clone();
        let there = figures(&answer(&harness));
        apply(&mut harness, Command::Scene(SceneCommand::Undo));
        assert_eq!(figures(&answer(&harness)), start, "undone");
        apply(&mut harness, Command::Scene(SceneCommand::Redo));
        assert_eq!(figures(&answer(&harness)), there, "redone");
        apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
        assert_eq!(figures(&answer(&harness)), there, "reset");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("moved.toml");
        apply(&mut harness, Command::File(FileCommand::SaveAs(path.clone())));
        apply(&mut harness, Command::File(FileCommand::Open(path)));
        assert_eq!(state(&harness).document.scene, moved);
        assert_eq!(figures(&answer(&harness)), there, "loaded");
        // Typed there at once, from elsewhere.
        apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: at }));
        apply(&mut harness, Command::Scene(SceneCommand::EditDone));
        let value = Box::new(moved.cables[0].supports[last].clone());
        apply(&mut harness, Command::Scene(SceneCommand::SetSupport { cable: 0, support: last, value }));
        assert_eq!(figures(&answer(&harness)), there, "typed");
    }
}

/// D6a: after a length of 300 m and an undo the fixed hitch stood elsewhere.
#[test]
fn a_fixed_support_is_where_it_is_fixed() {
    let mut harness = open(catalog::tank());
    let start = answer(&harness);
    set_length(&mut harness, 60.0);
    harness.run_steps(2);
    submit(&mut harness, Command::Scene(SceneCommand::Undo));
    harness.run_steps(2);
    let end = answer(&harness).cables[0].supports.last().unwrap().clone();
    let at = state(&harness).document.scene.cables[0].supports[1].at_m.unwrap();
    assert_eq!([end.x_m, end.y_m], at);
    assert_eq!(figures(&answer(&harness)), figures(&start));
}

/// D8: an edit elsewhere moved the cable from below a beam to above it.
#[test]
fn an_edit_elsewhere_does_not_move_the_cable_through_a_beam() {
    let mut scene = catalog::hanging_span();
    let beam = |y: f64| Obstacle {
        name: "beam".to_owned(),
        shape: Shape::Polygon { points_m: vec![[4.0, y], [6.0, y], [6.0, y + 0.4], [4.0, y + 0.4]] },
        friction: None,
    };
    scene.obstacles.push(beam(6.0));
    let mut harness = open(scene);
    let low = |h: &Harness<'_, ViewerApp>| {
        answer(h).cables[0]
            .nodes
            .iter()
            .filter(|n| (n.x_m - 5.0).abs() < 0.6)
            .map(|n| n.y_m)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    assert!(low(&harness) < 6.0, "it hangs below");
    // The ends come down with the beam above the cable: it stays below, then a waypoint is added
    // far from the beam.
    for (k, y) in [(0, 9.0), (1, 9.0)] {
        let x = state(&harness).document.scene.cables[0].supports[k].at_m.unwrap()[0];
        let item = Item::Support { cable: 0, support: k };
        apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: [x, y] }));
    }
    let held = low(&harness);
    assert!(held < 6.0, "lifted against the beam from below: {held}");
    let before = state(&harness).document.scene.clone();
    let near = answer(&harness).cables[0].nodes[4];
    let command = SceneCommand::AddWaypoint { cable: 0, arc_length_m: near.arc_length_m, at_m: [near.x_m, near.y_m] };
    apply(&mut harness, Command::Scene(command));
    assert!(
        low(&harness) < 6.0,
        "a waypoint at ({}, {}) moved it over the beam: {}",
        near.x_m,
        near.y_m,
        low(&harness)
    );
    apply(&mut harness, Command::Scene(SceneCommand::Undo));
    assert_eq!(state(&harness).document.scene, before);
    assert!((low(&harness) - held).abs() < 1e-9);
}

/// D1: a hitch dragged into the floor was stored inside the ground.
#[test]
fn an_end_dragged_into_the_ground_stands_on_it_and_nothing_breaks() {
    let mut harness = open(catalog::tank());
    for depth in [0.3, 1.0, 2.0, 3.0] {
        let item = Item::Support { cable: 0, support: 1 };
        apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: [3.2, 0.2 - depth] }));
        let stored = state(&harness).document.scene.cables[0].supports[1].at_m.unwrap();
        let end = answer(&harness).cables[0].supports.last().unwrap().clone();
        assert_eq!(state(&harness).live.snapshot.error, None);
        assert!((end.x_m - stored[0]).hypot(end.y_m - stored[1]) < 1e-9, "{stored:?} ({}, {})", end.x_m, end.y_m);
        assert!(stored[1] > 0.1, "{stored:?}");
        let most = answer(&harness).max_tension().tension_n;
        assert!(most < 400.0, "{depth} m deep: {most} N");
    }
}

/// D9: Reset wiped the recording without a way back, and the robot stood still after it.
#[test]
fn a_reset_can_be_undone_and_starts_the_robots_task_again() {
    let mut scene = catalog::robot_drive();
    scene.robot.as_mut().unwrap().path = vec![RobotTask::Drive { to_x_m: 12.0, speed_m_per_s: 0.3 }];
    let mut harness = open(scene);
    apply(&mut harness, Command::Playback(PlaybackCommand::DriveRobot(Some(0.2))));
    harness.run_steps(40);
    apply(&mut harness, Command::Playback(PlaybackCommand::DriveRobot(Some(0.0))));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let (recorded, end) = (state(&harness).live.recording.span_s().unwrap(), answer(&harness).time_s);
    harness.key_press(Key::R);
    harness.run_steps(3);
    assert_eq!(answer(&harness).time_s, 0.0);
    assert_eq!(state(&harness).live.robot_speed_command, None, "the task, not the hand");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(answer(&harness).time_s, end);
    assert_eq!(state(&harness).live.recording.span_s().unwrap(), recorded);
    // Reset again: by itself the robot drives.
    harness.key_press(Key::R);
    harness.run_steps(3);
    let from = answer(&harness).robot.unwrap().x_m;
    harness.key_press(Key::Space);
    harness.run_steps(60);
    assert!(answer(&harness).robot.unwrap().x_m > from + 0.05);
}

/// A support that was moved after a pause began the run anew: the cable was laid on another mesh,
/// and came to rest no more. It goes on from where it is.
#[test]
fn a_support_that_is_moved_after_a_pause_goes_on_with_the_run() {
    let scene = catalog::tank();
    let riser = scene.cables[0].supports[0].at_m.unwrap();
    let item = Item::Support { cable: 0, support: 0 };
    let mut harness = open(scene);
    harness.key_press(Key::Space);
    harness.run_steps(60);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let end = answer(&harness);
    for k in 1..=5 {
        let to_m = [riser[0] - 0.04 * f64::from(k), riser[1]];
        apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m }));
    }
    apply(&mut harness, Command::Scene(SceneCommand::EditDone));
    let moved = answer(&harness);
    assert!((moved.time_s - end.time_s).abs() < 0.02, "{} and {} s", end.time_s, moved.time_s);
    assert!(harness.query_by_label("Undo restart").is_none());
    assert!((moved.cables[0].supports[0].x_m - (riser[0] - 0.2)).abs() < 1e-9);
    let [before, after] = [end, moved].map(|answer| answer.max_tension().tension_n);
    assert!((after / before - 1.0).abs() < 0.1, "{before} and {after} N");
}

/// A pipe that was drawn into its cable by more than the cable's radius in a frame began the run
/// anew while time ran, with a cable that fell on it.
#[test]
fn issue_020_an_obstacle_drawn_into_its_cable_while_time_runs_takes_it_along() {
    let scene = catalog::draped_slipping();
    let pipe = scene.obstacles.iter().position(|o| matches!(o.shape, Shape::Circle { .. })).unwrap();
    let Shape::Circle { center_m, .. } = scene.obstacles[pipe].shape else { panic!("a pipe") };
    let radius_m = 0.5 * scene.cables[0].diameter_m;
    let mut harness = open(scene);
    harness.key_press(Key::Space);
    harness.run_steps(150);
    let before = answer(&harness);
    for k in 1..=8 {
        let far = 2.0 * radius_m * f64::from(k);
        let item = Item::Obstacle(pipe);
        apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: [center_m[0], center_m[1] + far] }));
        harness.run_steps(3);
        let after = answer(&harness);
        assert!(after.time_s > before.time_s, "move {k}: {} s", after.time_s);
        let [before, after] = [&before, &after].map(|answer| answer.max_tension().tension_n);
        assert!(after < 4.0 * before, "move {k}: {after} N for {before} N");
    }
    assert!(harness.query_by_label("Undo restart").is_none());
}

/// A robot that was moved after a pause began the run anew, and what had been recorded was gone
/// without a word.
#[test]
fn an_edit_that_begins_the_run_anew_keeps_what_was_recorded() {
    let (scene, item) = (catalog::tank_robot(), Item::Robot);
    let at = scene.robot.as_ref().unwrap().at_m;
    let mut harness = open(scene.clone());
    harness.key_press(Key::Space);
    harness.run_steps(60);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let (recorded, end) = (state(&harness).live.recording.span_s().unwrap(), answer(&harness));
    assert!(recorded[1] > 0.9);
    let graph = harness.get_by_label("Over time").rect();
    // A drag: many moves, one entry to undo.
    for k in 1..=5 {
        let to_m = [at[0] - 0.04 * f64::from(k), at[1]];
        apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m }));
    }
    apply(&mut harness, Command::Scene(SceneCommand::EditDone));
    assert_eq!(answer(&harness).time_s, 0.0, "{item:?}: another start is another run");
    harness.get_by_label("Undo restart");
    assert_eq!(harness.get_by_label("Over time").rect(), graph, "the graphs stay where they are");
    // The wheel of the mouse and pins are no edits.
    harness.key_press(Key::F);
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(state(&harness).document.scene, scene);
    let span = state(&harness).live.recording.span_s().expect("the run is there again");
    assert!(span[0] == recorded[0] && recorded[1] - span[1] < 0.02, "{span:?} of {recorded:?}");
    assert!((answer(&harness).time_s - end.time_s).abs() < 0.02 && state(&harness).live.playback.paused);
    assert!(harness.query_by_label("Undo restart").is_none());
    // Any of it can be looked at, and time goes on from its end.
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.5))));
    assert!((answer(&harness).time_s - 0.5).abs() < 0.02);
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(None)));
    harness.key_press(Key::Space);
    harness.run_steps(10);
    assert!(answer(&harness).time_s > end.time_s, "{} s", answer(&harness).time_s);
}

/// Issue 20: to take back an edit that had begun the run anew dropped what had run since.
#[test]
fn issue_020_the_run_since_an_edit_that_began_another_is_kept_when_it_is_taken_back() {
    let scene = catalog::tank_robot();
    let mut harness = open(scene.clone());
    let run = |harness: &mut Harness<'_, ViewerApp>, frames: usize| {
        harness.key_press(Key::Space);
        harness.run_steps(frames);
        harness.key_press(Key::Space);
        harness.run_steps(2);
        (state(harness).document.scene.clone(), state(harness).live.recording.span_s(), answer(harness).time_s)
    };
    let first = run(&mut harness, 60);
    let start = scene.robot.as_ref().unwrap().at_m;
    apply(&mut harness, Command::Scene(SceneCommand::Move { item: Item::Robot, to_m: [start[0] - 0.2, start[1]] }));
    apply(&mut harness, Command::Scene(SceneCommand::EditDone));
    assert_eq!(answer(&harness).time_s, 0.0, "another start is another run");
    let second = run(&mut harness, 20);
    assert!(first.0 != second.0 && first.1 != second.1);
    let shown = |harness: &Harness<'_, ViewerApp>| {
        (state(harness).document.scene.clone(), state(harness).live.recording.span_s(), answer(harness).time_s)
    };
    // By the button, and by the keys of undo and redo.
    for (button, then) in [("Undo restart", &first), ("Redo restart", &second), ("Undo restart", &first)] {
        harness.get_by_label(button).click();
        harness.run_steps(4);
        assert_eq!(&shown(&harness), then, "{button}");
    }
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.run_steps(4);
    assert_eq!(shown(&harness), second);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(4);
    assert_eq!(shown(&harness), first);
    // Time goes on from its end.
    harness.key_press(Key::Space);
    harness.run_steps(10);
    assert!(answer(&harness).time_s > first.2);
}

/// The button does the same, also after further edits; a new run takes the place of the old one.
#[test]
fn a_restart_is_undone_by_its_button_whatever_was_edited_since() {
    let scene = catalog::tank_robot();
    let mut harness = open(scene.clone());
    harness.key_press(Key::Space);
    harness.run_steps(90);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let end_s = answer(&harness).time_s;
    for dx in [0.1, 0.2] {
        let start = scene.robot.as_ref().unwrap().at_m;
        let to_m = [start[0] + dx, start[1]];
        apply(&mut harness, Command::Scene(SceneCommand::Move { item: Item::Robot, to_m }));
        apply(&mut harness, Command::Scene(SceneCommand::EditDone));
    }
    harness.get_by_label("Previous run").click();
    harness.run_steps(4);
    assert_eq!(state(&harness).document.scene, scene);
    assert_eq!(answer(&harness).time_s, end_s);
    apply(&mut harness, Command::File(FileCommand::OpenCatalogue("over-beam".to_owned())));
    assert!(harness.query_by_label("Undo restart").is_none());
}

/// D10.1: what held the cable was gone after going on from an earlier time.
#[test]
fn resuming_keeps_the_forces_on_supports() {
    let mut harness = open(catalog::swinging_span());
    harness.key_press(Key::Space);
    harness.run_steps(40);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.3))));
    let then = answer(&harness);
    apply(&mut harness, Command::Playback(PlaybackCommand::ResumeFromShown));
    let now = answer(&harness);
    assert_eq!(now.time_s, then.time_s);
    let pull = |a: &Solution| a.cables[0].supports[0].reaction_x_n.hypot(a.cables[0].supports[0].reaction_y_n);
    assert!(pull(&then) > 1.0 && pull(&now) == pull(&then), "{} {}", pull(&then), pull(&now));
}

/// Two files may have scenes of one name; pins of one had stayed in the other.
#[test]
fn pins_belong_to_the_file_that_they_were_made_in() {
    let folder = std::env::temp_dir().join(format!("cable-viewer-pins-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let [first, second] = ["first.toml", "second.toml"].map(|name| folder.join(name));
    for path in [&first, &second] {
        cable_core::files::save_scene(path, &catalog::hanging_span()).unwrap();
    }
    let mut harness = open(catalog::hanging_span());
    let pins = |h: &Harness<'_, ViewerApp>| state(h).analysis.references.len();
    let mut after = |command: FileCommand| {
        apply(&mut harness, Command::View(ViewCommand::AddReference));
        assert!(pins(&harness) > 0);
        apply(&mut harness, Command::File(command));
        harness.run_steps(3);
        pins(&harness)
    };
    assert_eq!(after(FileCommand::Open(first.clone())), 0, "a file is not the scene of the catalogue");
    assert_eq!(after(FileCommand::Open(first)), 1, "the same file again");
    assert_eq!(after(FileCommand::Open(second)), 0, "another file of the same name");
    assert_eq!(after(FileCommand::New), 0);
    assert_eq!(after(FileCommand::New), 0, "another new scene");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// D10.6: pinned results followed into other scenes.
#[test]
fn pins_belong_to_their_scene() {
    let mut harness = open(catalog::hanging_span());
    apply(&mut harness, Command::View(cable_viewer::command::ViewCommand::AddReference));
    apply(&mut harness, Command::File(FileCommand::OpenCatalogue("hanging-span".to_owned())));
    assert_eq!(state(&harness).analysis.references.len(), 1, "the same scene again");
    apply(&mut harness, Command::File(FileCommand::OpenCatalogue("over-beam".to_owned())));
    assert!(state(&harness).analysis.references.is_empty());
}

/// D10.9: an end dragged beyond the length while time runs stopped time, and the window went on
/// saying that it starts.
#[test]
fn time_that_is_stopped_by_an_impossible_edit_is_said_to_stand() {
    let mut harness = open(catalog::hanging_span());
    harness.key_press(Key::Space);
    harness.run_steps(10);
    set_length(&mut harness, 5.0);
    harness.run_steps(3);
    assert!(state(&harness).live.snapshot.error.is_some());
    assert!(state(&harness).live.playback.paused);
    harness.get_by_label("Paused");
    harness.get_by_label("Play");
}

/// D10.13: after a failed save the path had to be typed again.
#[test]
fn a_failed_save_asks_again_with_the_path_that_was_typed() {
    let mut harness = open(catalog::hanging_span());
    let path = std::path::PathBuf::from("/no such folder/scene.toml");
    apply(&mut harness, Command::File(FileCommand::SaveAs(path.clone())));
    harness.get_by_label("Close").click();
    harness.run_steps(2);
    let dialog = &state(&harness).ui.dialog;
    let cable_viewer::state::dialog::Dialog::SaveAs { path: typed } = dialog.as_ref().expect("asked again") else {
        panic!("{dialog:?}");
    };
    assert_eq!(std::path::Path::new(typed), path);
}

/// "Save…" dropped what was pending: the other scene was not opened, the window not closed.
#[test]
fn what_was_pending_goes_on_once_the_scene_is_saved() {
    let changed = || {
        let mut harness = open(catalog::hanging_span());
        apply(&mut harness, Command::Scene(SceneCommand::SetName("Changed".to_owned())));
        apply(&mut harness, Command::File(FileCommand::OpenCatalogue("over-beam".to_owned())));
        harness.get_by_label("Save…").click();
        harness.run_steps(3);
        harness
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.toml");
    let mut harness = changed();
    assert_eq!(state(&harness).document.scene.name, "Changed", "not before it is saved");
    // A place that cannot be written to: asked again, and then it goes on.
    apply(&mut harness, Command::File(FileCommand::SaveAs("/no such folder/scene.toml".into())));
    harness.get_by_label("Close").click();
    harness.run_steps(3);
    apply(&mut harness, Command::File(FileCommand::SaveAs(path.clone())));
    assert_eq!(cable_viewer::io::scene_file::load(&path).unwrap().name, "Changed");
    assert_eq!(state(&harness).document.scene.name, catalog::over_beam().name);
    assert!(!state(&harness).document.unsaved() && state(&harness).ui.dialog.is_none());
    // Called off, it does not follow a later save.
    let mut harness = changed();
    harness.get_by_label("Cancel").click();
    harness.run_steps(3);
    apply(&mut harness, Command::File(FileCommand::SaveAs(path)));
    assert_eq!(state(&harness).document.scene.name, "Changed");
    // A file that is known is saved at once, and the window closes.
    apply(&mut harness, Command::Scene(SceneCommand::SetName("Changed again".to_owned())));
    apply(&mut harness, Command::File(FileCommand::Quit));
    harness.get_by_label("Save…").click();
    harness.run_steps(3);
    assert!(state(&harness).ui.closing && !state(&harness).document.unsaved());
}

/// A new scene asks first, has a name and an answer, and the window's title tells the file.
#[test]
fn a_new_scene_and_the_name_of_its_file() {
    let mut harness = open(catalog::over_beam());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::N);
    harness.run_steps(3);
    assert_eq!(state(&harness).document.scene.name, "New scene");
    assert_eq!(state(&harness).freshness(), Freshness::Current);
    let folder = tempfile::tempdir().unwrap();
    apply(&mut harness, Command::File(FileCommand::SaveAs(folder.path().join("mine.toml"))));
    harness.get_by_label("New scene – mine.toml");
    assert_eq!(state(&harness).ui.recent.len(), 1);
}

/// Returns how opaque every text of a picture is.
fn opacities(harness: &Harness<'_, ViewerApp>) -> Vec<(String, u8)> {
    fn add(shape: &egui::Shape, out: &mut Vec<(String, u8)>) {
        match shape {
            egui::Shape::Text(text) => {
                let vertices = text.galley.rows.iter().flat_map(|r| &r.visuals.mesh.vertices);
                let known = vertices.map(|v| v.color).find(|c| *c != egui::Color32::PLACEHOLDER);
                let ink = text.override_text_color.or(known).unwrap_or(text.fallback_color);
                out.push((text.galley.text().to_owned(), ink.a()));
            }
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|s| add(s, out)),
            _ => {}
        }
    }
    let mut out = Vec::new();
    harness.output().shapes.iter().for_each(|s| add(&s.shape, &mut out));
    out
}

fn opacity(harness: &Harness<'_, ViewerApp>, text: &str) -> f32 {
    let all = opacities(harness);
    let found = all.iter().find(|(t, _)| t == text).unwrap_or_else(|| panic!("no text {text}: {all:?}"));
    f32::from(found.1)
}

/// Figures of the robot, of the marked place, of the quality of the answer, of the pinned results
/// and of the graph over time looked valid while the picture was older than the scene or a draft.
#[test]
fn figures_of_an_older_scene_are_dimmed_in_every_panel() {
    let mut harness = open(catalog::tank_robot());
    harness.set_size(Vec2::new(1600.0, 3000.0));
    let marker = cable_viewer::state::TensionMarker {
        cable: 0,
        arc_length_m: 4.0,
        from: cable_core::analysis::tension_budget::StartEnd::Start,
    };
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    apply(&mut harness, Command::View(ViewCommand::SetTensionMarker(Some(marker))));
    for (item, told) in [
        (Item::Robot, ["Normal force", "Tension there", "Acceleration", "Now", "Maximum"]),
        (Item::Solver, ["Residual", "Condition estimate", "Kinetic energy", "Now", "Maximum"]),
    ] {
        apply(&mut harness, Command::View(ViewCommand::Select(Some(item))));
        harness.run_steps(3);
        let before = told.map(|text| opacity(&harness, text));
        harness.state_mut().state.live.snapshot.draft = true;
        harness.run_steps(2);
        for (text, before) in told.iter().zip(before) {
            let now = opacity(&harness, text);
            assert!(now < 0.6 * before, "{text}: {now} of {before}");
        }
        harness.state_mut().state.live.snapshot.draft = false;
        harness.run_steps(2);
        assert_eq!(told.map(|text| opacity(&harness, text)), before);
    }
}

/// The row of the present answer had the sag of the old shape between the supports of the new
/// scene.
#[test]
fn the_present_row_of_pinned_results_is_of_the_scene_that_was_solved() {
    let mut harness = open(catalog::hanging_span());
    harness.set_size(Vec2::new(1600.0, 3000.0));
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    let row = |h: &Harness<'_, ViewerApp>| {
        let height = h.get_by_label("Now").rect().center().y;
        let all = h.query_all_by_label_contains(" m").filter(|n| {
            let at = n.rect().center();
            at.x > 1280.0 && (at.y - height).abs() < 8.0
        });
        // The cost is in ms on a loaded machine.
        let texts = all.map(|n| n.accesskit_node().value().unwrap_or_default());
        texts.filter(|text| text.ends_with(" m")).collect::<Vec<_>>()
    };
    let before = row(&harness);
    assert!(!before.is_empty());
    // An end that is free, and a stiffness that cannot be solved.
    let mut scene = state(&harness).document.scene.clone();
    scene.cables[0].supports[1].kind = cable_core::scene::SupportKind::Free;
    scene.cables[0].supports[1].at_m = None;
    scene.cables[0].axial_stiffness_n = f64::NAN;
    apply(&mut harness, Command::Scene(SceneCommand::SetScene(Box::new(scene))));
    assert!(!state(&harness).is_current());
    assert_eq!(row(&harness), before);
}

/// Issue 20: a slack cable, made by a drag that was taken back, left its warnings on the timeline
/// of the scene that has none.
#[test]
fn issue_020_events_of_a_scene_that_was_taken_back_are_on_no_timeline() {
    let scene = catalog::tank_robot();
    let mut harness = open(scene.clone());
    assert_eq!(state(&harness).live.recording.events(), []);
    let start = scene.robot.as_ref().unwrap().at_m;
    apply(&mut harness, Command::Scene(SceneCommand::Move { item: Item::Robot, to_m: [start[0] - 4.5, start[1]] }));
    apply(&mut harness, Command::Scene(SceneCommand::EditDone));
    harness.run_steps(3);
    assert!(!state(&harness).live.recording.events().is_empty(), "slack cable is an event");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(state(&harness).document.scene, scene);
    assert_eq!(state(&harness).live.recording.events(), []);
}
