//! The steps of a run are those of the core, at whatever speed and in whatever frames it is
//! watched.

use cable_core::math::Point;
use cable_core::model::{Inertia, Question};
use cable_core::scene::catalog;
use cable_core::timeline::{Instant, RunPeaks, Timeline};
use cable_core::{Model, Scene, Settings, Simulation, Solution};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand};
use cable_viewer::state::Playback;
use cable_viewer::worker::engine::Engine;
use cable_viewer::worker::request::{Drag, Edit, EditStart, Request};
use egui_kittest::Harness;

use crate::{apply, open};

/// Every bit of what a model answers. Peaks are of as long as there was no look, and displacements
/// and errors follow from the nodes of this and of other runs.
fn bits(solution: &Solution) -> String {
    let of = |c: &cable_core::solution::CableSolution| {
        let nodes: Vec<_> = c.nodes.iter().map(|n| (n.at(), n.vx_m_per_s, n.vy_m_per_s, n.tension_n)).collect();
        format!("{:?}", (nodes, &c.supports, &c.contacts, &c.errors, &c.breaks))
    };
    solution.cables.iter().map(of).collect()
}

/// The bits at a time (s) of a scene, and the peaks until then, as the program has them.
fn of_the_core(scene: Scene, time_s: f64) -> (String, Vec<RunPeaks>) {
    let mut simulation = Simulation::for_question(scene, Model::Fem, Settings::default(), Question::Rest).unwrap();
    simulation.settle().unwrap();
    let mut run = Timeline::new(simulation, Inertia::Dynamic, None).unwrap().with_errors();
    let answer = run.at(Instant::nearest(time_s), |_| ()).unwrap();
    (bits(&answer), run.monitor().peaks().to_vec())
}

fn engine(scene: Scene, speed: f64) -> Engine {
    let mut engine = Engine::default();
    let (model, settings, start) = (Model::Fem, Settings::default(), EditStart::NewScene);
    let edit = Some(Edit { scene, model, settings, start });
    let playback = Some(Playback { paused: true, speed });
    engine.handle(Request { edit, playback, ..Request::default() });
    engine.handle(Request { playback: Some(Playback { paused: false, speed }), ..Request::default() });
    engine
}

/// Lets frames of these shares in turn pass until a second is over; time (s), bits and peaks of the
/// last answer.
fn after_a_second(engine: &mut Engine, shares: &[f64]) -> (f64, (String, Vec<RunPeaks>)) {
    let mut greatest_n = 0.0_f64;
    for share in shares.iter().cycle().take(10_000) {
        let report = engine.advance_part_of_frame(*share);
        assert_eq!(report.snapshot.error, None);
        for answer in &report.answers {
            greatest_n = greatest_n.max(answer.peaks().greatest.tension_n);
        }
        let Some(answer) = report.answers.last().filter(|a| a.time_s > 1.0 - 1e-9) else { continue };
        // The history shows the greatest tension of any inner step.
        assert_eq!(greatest_n, report.snapshot.peaks[0].peaks.greatest.tension_n);
        return (answer.time_s, (bits(answer), report.snapshot.peaks));
    }
    panic!("no answer after one second");
}

/// The greatest tension of a chaotic scene depended on how fast it was watched: steps were as long
/// as the speed made them.
#[test]
fn the_window_makes_the_steps_of_the_program_at_every_speed() {
    for scene in [catalog::draped_slipping(), catalog::floor_drag()] {
        let expected = of_the_core(scene.clone(), 1.0);
        for speed in [0.1, 0.3, 1.0, 4.0] {
            let (time_s, found) = after_a_second(&mut engine(scene.clone(), speed), &[1.0]);
            assert!((time_s - 1.0).abs() < 1e-9, "{time_s} s at {speed}×");
            assert!(found == expected, "{} at {speed}×", scene.name);
        }
    }
}

/// While a hand draws, frames last as long as the clock says.
#[test]
fn frames_of_any_length_make_the_same_steps() {
    let scene = catalog::draped_slipping();
    // 10 and 500 ms in turn, and parts of a frame that are no whole steps.
    for shares in [[0.6, 30.0], [0.41, 0.77]] {
        let (time_s, found) = after_a_second(&mut engine(scene.clone(), 1.0), &shares);
        assert!(found == of_the_core(scene.clone(), time_s), "{shares:?}");
    }
}

/// Below a step a frame the picture goes on between steps, which history and run do not notice.
#[test]
fn slow_motion_is_shown_between_steps() {
    let mut engine = engine(catalog::draped_slipping(), 0.01);
    let mut shown_s = vec![0.0];
    let mut kept_s: Vec<f64> = Vec::new();
    for _ in 0..60 {
        let report = engine.advance_frame();
        shown_s.push(report.snapshot.solution.unwrap().time_s);
        kept_s.extend(report.answers.iter().map(|a| a.time_s));
    }
    let frame_s = 0.01 / 60.0;
    assert!(shown_s.windows(2).all(|w| (w[1] - w[0] - frame_s).abs() < 1e-9), "{shown_s:?}");
    assert_eq!(kept_s.len(), 2, "{kept_s:?}");
    assert!((kept_s[1] - 2.0 / 240.0).abs() < 1e-12, "{kept_s:?}");
}

/// Frames of 10 and 500 ms in turn show what even ones do.
#[test]
fn t09_erratic_frames_change_nothing() {
    let scene = catalog::draped_slipping();
    let run = |erratic: bool| {
        let mut harness: Harness<'_, ViewerApp> = open(scene.clone());
        apply(&mut harness, Command::SetModel(Model::Fem));
        apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
        let mut clock_s = 10.0;
        for frame in 0..30 {
            if erratic {
                clock_s += if frame % 2 == 0 { 0.01 } else { 0.5 };
                harness.input_mut().time = Some(clock_s);
            }
            harness.step();
        }
        let live = &harness.state().state.live;
        (format!("{:?}", live.history.samples), bits(live.snapshot.solution.as_ref().unwrap()))
    };
    assert!(run(true) == run(false));
}

/// The mesh that follows a hand where frames are slow is a draft: its greatest tensions went into
/// the history as those of the cable.
#[test]
fn a_coarse_mesh_under_a_hand_leaves_no_peaks_in_the_history() {
    let mut scene = catalog::tank();
    // So many that a frame is slow on every machine.
    scene.cables[0].segments = Some(1000);
    let mut engine = Engine::with_drafts();
    let (model, settings, start) = (Model::Fem, Settings::default(), EditStart::NewScene);
    let edit = Some(Edit { scene: scene.clone(), model, settings, start });
    engine.handle(Request { edit, ..Request::default() });
    engine.handle(Request { playback: Some(Playback { paused: false, speed: 1.0 }), ..Request::default() });
    engine.advance_frame();
    let at: Point = scene.cables[0].supports[1].at_m.expect("held");
    let mut drafts = 0;
    for k in 1..=10 {
        let to_m = [at[0] - 0.02 * f64::from(k), at[1]];
        let drag = Some(Drag { cable: 0, support: 1, to_m, by_spring: false, scene: scene.clone() });
        engine.handle(Request { drag, ..Request::default() });
        let report = engine.advance_frame();
        drafts += usize::from(report.snapshot.draft);
        let coarse = report.answers.iter().filter(|a| a.cables[0].nodes.len() < 500).count();
        assert_eq!(coarse, 0, "a draft is in the history");
    }
    assert!(drafts > 0, "the hand is followed by a coarse mesh");
}
