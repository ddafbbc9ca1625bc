//! The worker runs on its own thread: printed is how long an edit takes to be on screen, asserted
//! that a flood of edits ends at the last one.
//!
//! The figures: `cargo test --workspace --test ui timed -- --nocapture --test-threads 1`.

use std::sync::Arc;
use std::time::{Duration, Instant};

use cable_core::math::Point;
use cable_core::scene::catalog;
use cable_core::solution::Histories;
use cable_core::{Model, Scene};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand};
use cable_viewer::state::Item;
use egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::open;

/// Longer than any answer takes on a loaded machine; only a dead worker reaches it.
const PATIENCE: Duration = Duration::from_secs(30);
/// Edits in a measured drag.
const EDITS: usize = 100;

fn threaded(mut scene: Scene, segments: usize) -> Harness<'static, ViewerApp> {
    scene.cables[0].segments = Some(segments);
    let mut harness =
        Harness::builder().with_size(Vec2::new(1280.0, 800.0)).with_step_dt(1.0 / 60.0).build_eframe(|cc| {
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
        assert!(began.elapsed() < PATIENCE, "{:?}", harness.state().state.solver.status);
        harness.step();
    }
}

fn submit(harness: &mut Harness<'_, ViewerApp>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().apply(&ctx, vec![command]);
}

fn set_length(harness: &mut Harness<'_, ViewerApp>, length_m: f64) {
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.length_m = length_m;
    submit(harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
}

/// Milliseconds in order, with the figures a reader asks for.
fn print(what: &str, mut ms: Vec<f64>) {
    ms.sort_by(f64::total_cmp);
    let at = |share: f64| ms[((ms.len() - 1) as f64 * share).round() as usize];
    println!(
        "{what}: min {:.1} ms, median {:.1} ms, 95 % {:.1} ms, worst {:.1} ms",
        at(0.0),
        at(0.5),
        at(0.95),
        at(1.0)
    );
}

/// Drags the last support of a scene's first cable round a small circle: from each edit to the end
/// of the first frame that shows it, frames being a 60th of a second apart as on a screen.
fn timed_drag(name: &str, (scene, segments): (Scene, usize), how: (bool, f64)) {
    timed(name, (threaded(scene, segments), segments), how);
}

fn timed(name: &str, (mut harness, segments): (Harness<'static, ViewerApp>, usize), (playing, radius_m): (bool, f64)) {
    let last = harness.state().state.document.scene.cables[0].supports.len() - 1;
    let item = Item::Support { cable: 0, support: last };
    let at: Point = harness.state().state.document.scene.cables[0].supports[last].at_m.expect("held");
    if playing {
        submit(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    }
    let (mut delays, mut solves, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    for k in 1..=EDITS {
        let angle = k as f64 / EDITS as f64 * std::f64::consts::TAU;
        let to_m = [at[0] - radius_m * (1.0 - angle.cos()), at[1] + radius_m * (0.5 * angle).sin()];
        let began = Instant::now();
        submit(&mut harness, Command::Scene(SceneCommand::Move { item, to_m }));
        loop {
            let frame = Instant::now();
            harness.step();
            frames.push(frame.elapsed().as_secs_f64() * 1e3);
            if harness.state().settled() {
                break;
            }
            assert!(began.elapsed() < PATIENCE, "{:?}", harness.state().state.solver.status);
            std::thread::sleep(Duration::from_secs_f64(1.0 / 60.0).saturating_sub(frame.elapsed()));
        }
        delays.push(began.elapsed().as_secs_f64() * 1e3);
        solves.push(harness.state().state.live.snapshot.solve_wall_s * 1e3);
        let error = &harness.state().state.live.snapshot.error;
        assert_eq!(*error, None, "{name}, edit {k}");
    }
    print(&format!("{name}, {segments} segments, edit to picture"), delays);
    print(&format!("{name}, {segments} segments, solve           "), solves);
    print(&format!("{name}, {segments} segments, frame of the ui "), frames);
}

#[test]
fn timed_edits_at_200_segments() {
    for (name, scene) in [("tank", catalog::tank()), ("hanging span", catalog::hanging_span())] {
        timed_drag(name, (scene, 200), (false, 0.4));
    }
}

/// Without a mesh: each edit lays the cable anew.
#[test]
fn timed_edits_of_spans() {
    for (name, scene) in [("tank, spans", catalog::tank()), ("over a beam, spans", catalog::over_beam())] {
        let mut harness = threaded(scene, 200);
        submit(&mut harness, Command::SetModel(cable_core::Model::Spans));
        wait(&mut harness);
        timed(name, (harness, 200), (false, 0.05));
    }
}

#[test]
fn timed_edits_at_1000_segments() {
    for (name, scene) in [("tank", catalog::tank()), ("hanging span", catalog::hanging_span())] {
        timed_drag(name, (scene, 1000), (false, 0.4));
    }
}

/// Eight centimetres an edit: what a quick hand does in a frame.
#[test]
fn timed_edits_by_a_quick_hand() {
    timed_drag("tank, quick", (catalog::tank(), 200), (false, 1.2));
}

#[test]
fn timed_edits_at_200_segments_while_time_runs() {
    for (name, scene) in [("tank, playing", catalog::tank()), ("hanging span, playing", catalog::hanging_span())] {
        timed_drag(name, (scene, 200), (true, 0.4));
    }
}

#[test]
fn a_flood_of_edits_ends_at_the_last() {
    let mut harness = threaded(catalog::hanging_span(), 60);
    for k in 0..600 {
        set_length(&mut harness, 12.0 + 0.001 * f64::from(k));
        if k % 20 == 0 {
            harness.step();
        }
    }
    wait(&mut harness);
    let state = &harness.state().state;
    let solved = state.live.snapshot.scene.as_ref().expect("a scene");
    assert_eq!(**solved, state.document.scene);
    let length = state.live.snapshot.solution.as_ref().unwrap().cables[0].nodes.last().unwrap().arc_length_m;
    assert!((length - 12.599).abs() < 1e-9, "{length}");
}

#[test]
fn a_drag_of_a_slow_scene_ends_at_the_answer_and_not_at_a_draft() {
    for model in [Model::Fem, Model::Spans] {
        let mut harness = threaded(catalog::tank(), 200);
        submit(&mut harness, Command::SetModel(model));
        wait(&mut harness);
        let item = Item::Support { cable: 0, support: 1 };
        let at: Point = harness.state().state.document.scene.cables[0].supports[1].at_m.expect("held");
        for k in 1..=10 {
            let to_m = [at[0] - 0.02 * f64::from(k), at[1]];
            submit(&mut harness, Command::Scene(SceneCommand::Move { item, to_m }));
            wait(&mut harness);
        }
        let began = Instant::now();
        while harness.state().state.live.snapshot.draft {
            assert!(began.elapsed() < PATIENCE, "the draft stays");
            harness.step();
        }
        let state = &harness.state().state;
        assert_eq!(state.live.snapshot.error, None);
        let answer = state.live.snapshot.solution.as_ref().unwrap();
        assert_eq!(answer.model, model);
        assert!(answer.cables[0].nodes.len() > if model == Model::Fem { 150 } else { 1 });
        assert_eq!(state.live.snapshot.scene.as_deref(), Some(&state.document.scene));
    }
}

/// From an edit to the first frame whose figures are those of the edited scene, and so not dimmed,
/// with the model that `auto` chooses: median, 95 % and worst of twenty edits a scene, printed.
/// `SCENE=tank` asks for one scene, `SEGMENTS=200` for finite elements with so many segments.
///
/// The last support that stands somewhere is moved; in the opening scene the robot holds the last
/// one, so the first is moved, and the robot as well.
#[test]
fn timed_edits_to_undimmed_figures() {
    let only = std::env::var("SCENE").ok();
    let segments: Option<usize> = std::env::var("SEGMENTS").ok().and_then(|n| n.parse().ok());
    for (id, mut scene) in catalog::all().into_iter().filter(|(id, _)| only.as_deref().is_none_or(|o| o == *id)) {
        if segments.is_some() {
            scene.cables.iter_mut().for_each(|cable| cable.segments = segments);
        }
        let supports = &scene.cables[0].supports;
        let held = supports.iter().rposition(|s| s.at_m.is_some()).expect("a support that stands somewhere");
        let mut moved = vec![("a support", Item::Support { cable: 0, support: held }, supports[held].at_m.unwrap())];
        if let Some(robot) = &scene.robot {
            moved.push(("the robot", Item::Robot, robot.at_m));
        }
        for (what, item, at) in moved {
            undimmed(&format!("{id}, {what}"), scene.clone(), item, at);
        }
    }
}

/// The rest is shown as soon as it is known; what other histories would have left in it is sought
/// afterwards, said to be sought meanwhile, and changes no figure.
#[test]
fn a_rest_is_shown_before_other_histories_of_it_are_sought() {
    let build = |scene: Scene| {
        Harness::builder()
            .with_size(Vec2::new(1280.0, 800.0))
            .with_step_dt(1.0 / 60.0)
            .build_eframe(|cc| ViewerApp::new(&cc.egui_ctx, scene, None))
    };
    let sought = |h: &Harness<'_, ViewerApp>| {
        let warnings = &h.state().state.live.snapshot.solution.as_ref().unwrap().warnings;
        warnings.iter().filter_map(|w| w.cause.histories()).cloned().collect::<Vec<Histories>>()
    };
    let figures = |h: &Harness<'_, ViewerApp>| {
        let cables = &h.state().state.live.snapshot.solution.as_ref().unwrap().cables;
        format!("{:?}", cables.iter().map(|c| (&c.nodes, &c.supports, &c.contacts)).collect::<Vec<_>>())
    };
    let wait_for_histories = |h: &mut Harness<'_, ViewerApp>| {
        let began = Instant::now();
        while !h.state().settled() || h.state().state.live.snapshot.seeks_histories {
            assert!(began.elapsed() < PATIENCE, "other histories are sought for ever");
            h.step();
        }
    };
    // Without a mesh and with one.
    for scene in [catalog::tank(), catalog::plan_posts()] {
        let name = scene.name.clone();
        let mut harness = build(scene);
        wait_for_histories(&mut harness);
        let support = harness.state().state.document.scene.cables[0].supports.len() - 1;
        let at: Point = harness.state().state.document.scene.cables[0].supports[support].at_m.expect("held");
        let item = Item::Support { cable: 0, support };
        submit(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: [at[0] - 0.05, at[1]] }));
        // The first frame with the answer; the search begins 60 ms later.
        while !harness.state().settled() {
            harness.step();
        }
        let state = &harness.state().state;
        assert!(state.live.snapshot.seeks_histories && state.is_current() && !state.live.snapshot.draft, "{name}");
        assert!(sought(&harness).is_empty(), "{name}: what is not known yet is not said");
        let first = figures(&harness);
        wait_for_histories(&mut harness);
        assert_eq!(first, figures(&harness), "{name}");
        let then = sought(&harness);
        assert!(!then.is_empty() && !then.contains(&Histories::NotSought), "{name}: {then:?}");
        // The scene as it is, with everything asked at once, says the same.
        let scene = harness.state().state.document.scene.clone();
        let anew = open(scene);
        assert_eq!((figures(&harness), then), (figures(&anew), sought(&anew)), "{name}");
    }
}

/// While it is being sought whether the rest is the only one, the window neither says that there
/// are no warnings nor that there are others. A cable that touches nothing has no other history.
#[test]
fn while_other_histories_are_sought_the_window_says_so() {
    let said = |scene: Scene, seeks: bool| {
        let mut harness = threaded(scene, 60);
        // The worker's own histories would replace what is set here.
        let began = Instant::now();
        while harness.state().state.live.snapshot.seeks_histories {
            assert!(began.elapsed() < PATIENCE);
            harness.step();
        }
        let snapshot = &mut harness.state_mut().state.live.snapshot;
        snapshot.seeks_histories = seeks;
        let mut solution = (**snapshot.solution.as_ref().unwrap()).clone();
        solution.warnings.clear();
        snapshot.solution = Some(Arc::new(solution));
        harness.step();
        ["Looking for other resting places…", "No warnings"].map(|text| harness.query_by_label(text).is_some())
    };
    assert_eq!(said(catalog::over_beam(), true), [true, false]);
    assert_eq!(said(catalog::over_beam(), false), [false, true]);
    assert_eq!(said(catalog::hanging_span(), true), [false, true]);
}

/// A scene that was opened was fitted to the cable of the one before, which was still on screen.
#[test]
fn a_scene_that_is_opened_is_fitted_to_its_own_cable() {
    let mut harness = threaded(catalog::hanging_span(), 60);
    harness.run_steps(3);
    let hand = harness.state().state.view.camera;
    submit(&mut harness, Command::File(FileCommand::OpenCatalogue("pile".to_owned())));
    harness.step();
    wait(&mut harness);
    harness.run_steps(2);
    let camera = harness.state().state.view.camera;
    assert!(camera != hand && !camera.fit_wanted);
    let nodes = &harness.state().state.live.snapshot.solution.as_ref().unwrap().cables[0].nodes;
    let (least, most) = nodes.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), n| (a.min(n.x_m), b.max(n.x_m)));
    let canvas = harness.get_by_label("Canvas").rect();
    let x = camera.to_screen(canvas, [0.5 * (least + most), 0.0]).x;
    assert!((x - canvas.center().x).abs() < 0.1 * canvas.width(), "{x} in {canvas:?}");
}

fn undimmed(what: &str, scene: Scene, item: Item, at: Point) {
    const EDITS: usize = 20;
    let mut harness = Harness::builder()
        .with_size(Vec2::new(1280.0, 800.0))
        .with_step_dt(1.0 / 60.0)
        .build_eframe(|cc| ViewerApp::new(&cc.egui_ctx, scene, None));
    if std::env::var("SEGMENTS").is_ok() {
        submit(&mut harness, Command::SetModel(Model::Fem));
    }
    wait(&mut harness);
    let (mut times, mut solves) = (Vec::new(), Vec::new());
    for k in 1..=EDITS {
        // Out and back again: each edit is one of 2 cm.
        let far = EDITS.div_ceil(2).abs_diff(k).abs_diff(EDITS.div_ceil(2)) as f64;
        let to_m = [at[0] - 0.02 * far, at[1] + 0.01 * far];
        let began = Instant::now();
        submit(&mut harness, Command::Scene(SceneCommand::Move { item, to_m }));
        while !harness.state().settled() || harness.state().state.live.snapshot.draft {
            assert!(began.elapsed() < PATIENCE, "{what}");
            harness.step();
            std::thread::sleep(Duration::from_millis(1));
        }
        times.push(began.elapsed().as_secs_f64() * 1e3);
        solves.push(harness.state().state.live.snapshot.solve_wall_s * 1e3);
        assert_eq!(harness.state().state.live.snapshot.error, None, "{what}, edit {k}");
    }
    print(&format!("{what}, edit to undimmed figures"), times);
    print(&format!("{what}, of that the solve       "), solves);
}
