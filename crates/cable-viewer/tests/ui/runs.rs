//! These tests take whole runs: kept, read again, overlaid, compared; long ones at the speed of the
//! screen.

use std::sync::Arc;
use std::time::Instant;

use cable_core::scene::catalog;
use cable_core::solution::Node;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::record::kept_run::KeptRun;
use cable_viewer::record::plotted_quantity::Measure;
use cable_viewer::record::sample::Sample;
use cable_viewer::state::AppState;
use cable_viewer::state::dialog::SceneReplacement;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{apply, open, open_span};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn play(harness: &mut Harness<'_, ViewerApp>, frames: usize) {
    apply(harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(frames);
    apply(harness, Command::Playback(PlaybackCommand::SetPaused(true)));
}

#[test]
fn s11_a_run_is_opened_again_and_nothing_is_lost() {
    let mut harness = open(catalog::robot_drive());
    play(&mut harness, 30);
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    apply(&mut harness, Command::File(FileCommand::SaveRun(run.clone())));
    let saved: Vec<_> = state(&harness).live.recording.answers().to_vec();
    let scene = state(&harness).document.scene.clone();

    let mut harness = open_span();
    apply(&mut harness, Command::File(FileCommand::Discard(SceneReplacement::OpenRun(run))));
    harness.run_steps(3);
    assert_eq!(state(&harness).ui.dialog, None);
    assert_eq!(state(&harness).document.scene, scene);
    let read = state(&harness).live.recording.answers();
    assert_eq!(read.len(), saved.len());
    for (a, b) in read.iter().zip(&saved) {
        assert_eq!(a.time_s.to_bits(), b.time_s.to_bits());
        // Tables hold what is read of nodes, not the direction of the force there.
        let written: Vec<_> = b.cables[0].nodes.iter().map(|n| Node { force_n: [0.0; 2], ..*n }).collect();
        assert_eq!(*a.cables[0].nodes, written, "{} s", a.time_s);
        assert_eq!(a.robot.unwrap().x_m, b.robot.unwrap().x_m);
        assert_eq!(a.robot.unwrap().work, b.robot.unwrap().work, "{} s", a.time_s);
        assert_eq!(a.energy, b.energy);
    }
    let last = saved.last().unwrap();
    assert!(last.robot.unwrap().work.drive_j > 0.0, "{:?}", last.robot);
    assert_eq!(state(&harness).live.recording.shown_s, Some(last.time_s));
    assert_eq!(state(&harness).live.snapshot.solution.as_ref().unwrap().time_s, last.time_s);
    // Time can be taken up where it ended.
    harness.get_by_label("Resume from here").click();
    harness.run_steps(2);
    assert_eq!(state(&harness).live.snapshot.error, None);
    play(&mut harness, 5);
    assert!(state(&harness).live.snapshot.solution.as_ref().unwrap().time_s > last.time_s);
}

/// A run that was saved keeps its model and what it cost, through another window and its own file,
/// and Compare shows them.
#[test]
fn s16_a_saved_run_is_compared_with_its_model_and_its_cost() {
    let mut harness = open_span();
    play(&mut harness, 10);
    let took_s = state(&harness).live.recording.solve_wall_s.unwrap();
    assert!(took_s > 0.0);
    let folder = tempfile::tempdir().unwrap();
    let [first, again] = ["first", "again"].map(|name| folder.path().join(name));
    apply(&mut harness, Command::File(FileCommand::SaveRun(first.clone())));
    // Opened, it is what it was, and saved again as well.
    apply(&mut harness, Command::File(FileCommand::Discard(SceneReplacement::OpenRun(first))));
    harness.run_steps(3);
    assert_eq!(state(&harness).live.recording.solve_wall_s, Some(took_s));
    apply(&mut harness, Command::File(FileCommand::SaveRun(again.clone())));
    apply(&mut harness, Command::File(FileCommand::AddReferenceRun(again)));
    harness.run_steps(2);
    let [held] = state(&harness).analysis.references.as_slice() else { panic!("it is held") };
    assert_eq!(held.wall_s, took_s);
    assert_eq!(held.solution.model, cable_core::Model::Fem);
    let name = &cable_viewer::panels::pin_names::pin_names(state(&harness))[0].full;
    assert!(name.ends_with("read from “again”"), "{name}");
    let cost = cable_viewer::units::format::rough_duration(took_s);
    assert!(harness.query_all_by_label(&cost).next().is_some(), "{cost}");
}

#[test]
fn a_folder_that_is_no_run_changes_nothing_and_is_named() {
    let mut harness = open_span();
    let before = state(&harness).document.scene.clone();
    let folder = tempfile::tempdir().unwrap();
    apply(&mut harness, Command::File(FileCommand::OpenRun(folder.path().to_owned())));
    let Some(cable_viewer::state::dialog::Dialog::Message { text, .. }) = &state(&harness).ui.dialog else { panic!() };
    assert!(text.contains("scene.toml"), "{text}");
    assert_eq!(state(&harness).document.scene, before);
}

#[test]
fn s16_whole_runs_are_overlaid_and_compared() {
    let mut harness = open_span();
    play(&mut harness, 30);
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    apply(&mut harness, Command::File(FileCommand::SaveRun(path.clone())));
    let mut cable = state(&harness).document.scene.cables[0].clone();
    cable.linear_density_kg_per_m *= 2.0;
    apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    play(&mut harness, 30);
    apply(&mut harness, Command::File(FileCommand::AddReferenceRun(path)));
    harness.run_steps(2);
    let [own, read] = [0, 1].map(|k| state(&harness).analysis.references[k].run.clone().expect("a run"));
    let tension = Measure::ALL[0];
    assert_eq!(own.span_s(), read.span_s());
    assert_eq!(own.line(tension).unwrap().points(), read.line(tension).unwrap().points());
    let now = state(&harness).live.history.samples.iter().map(|s| s.max_tension_n).fold(0.0, f64::max);
    assert!(now > 1.8 * own.peak(tension).unwrap().value);
    // The table is no wider than its panel at any width of window: it would have to be scrolled.
    for size in [[1024.0, 640.0], [1280.0, 800.0]] {
        harness.set_size(egui::Vec2::from(size));
        harness.run_steps(3);
        let right = harness.get_by_label("Events").rect().right();
        assert!(right <= size[0] - 5.0, "the last column ends at {right} of {}", size[0]);
    }
    harness.get_by_label("Whole runs");
    let spoken = harness.get_by_label("Over time").accesskit_node().description().unwrap_or_default();
    let names = ["Pinned: Hanging span", "Pinned: read from “run”"];
    assert!(names.iter().all(|name| spoken.contains(name)), "{spoken}");
    // The picture of a held run is that of the time shown.
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.2))));
    let time_s = state(&harness).live.snapshot.solution.as_ref().unwrap().time_s;
    assert!((state(&harness).analysis.references[0].picture(time_s).time_s - time_s).abs() < 0.02);
    let told =
        cable_viewer::panels::analysis::compare::differences(&state(&harness).analysis.references[0], state(&harness));
    assert!(told.iter().any(|l| l.starts_with("Linear density ")), "{told:?}");
}

/// A million samples in the time graph: milliseconds of a frame, printed and not asserted.
/// `cargo test --workspace --test ui speed -- --nocapture --test-threads 1`.
#[test]
fn speed_of_a_million_samples() {
    let mut harness = open_span();
    play(&mut harness, 3);
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    let frame = |harness: &mut Harness<'_, ViewerApp>| {
        let began = Instant::now();
        harness.run_steps(30);
        began.elapsed().as_secs_f64() / 30.0 * 1e3
    };
    let short = frame(&mut harness);
    let samples: Vec<Sample> = (0..1_000_000)
        .map(|k| {
            let time_s = f64::from(k) * 1e-3;
            Sample {
                time_s,
                max_tension_n: 500.0 + 100.0 * (0.1 * time_s).sin() + 20.0 * (7.0 * time_s).sin(),
                energy_j: [0.0; 4],
                robot: None,
                reactions_n: Vec::new(),
            }
        })
        .collect();
    let began = Instant::now();
    let answers = state(&harness).live.recording.answers().to_vec();
    let run = KeptRun::of(samples.iter(), &answers, 0).map(Arc::new);
    let built = began.elapsed().as_secs_f64() * 1e3;
    harness.state_mut().state.analysis.references[0].run = run.clone();
    // All of it in view.
    let all = cable_viewer::plot::GraphView { window_s: None, ..cable_viewer::plot::GraphView::default() };
    harness.ctx.data_mut(|d| d.insert_temp(egui::Id::unique("plot view"), all));
    harness.state_mut().state.live.history.samples.push_back(Sample { time_s: 1000.0, ..samples[0].clone() });
    let long = frame(&mut harness);
    let line = run.as_ref().unwrap().line(Measure::ALL[0]).unwrap().clone();
    let began = Instant::now();
    let seen = (0..100).map(|_| line.view([0.0, 1000.0], 600).len()).max().unwrap();
    let view = began.elapsed().as_secs_f64() * 1e4;
    println!(
        "1e6 samples: frame of the whole window {long:.1} ms (3 samples: {short:.1} ms), \
         thinned to {seen} in {view:.0} µs, built once in {built:.0} ms"
    );
}

#[test]
fn s12_two_graphs_over_time_have_their_cursors_linked() {
    let mut harness = open(catalog::robot_drive());
    play(&mut harness, 40);
    harness.get_by_label("Energy").click_modifiers(egui::Modifiers::SHIFT);
    harness.run_steps(3);
    let plot = harness.get_by_label("Energy over time").rect();
    let at = plot.left_center() + egui::vec2(80.0, 0.0);
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false] {
        crate::press(&harness, at, pressed);
        harness.step();
    }
    harness.run_steps(30);
    let spoken = |h: &Harness<'_, ViewerApp>, label: &str| {
        h.get_by_label(label).accesskit_node().description().unwrap_or_default()
    };
    let (first, second) = (spoken(&harness, "Over time"), spoken(&harness, "Energy over time"));
    let place = |text: &str| {
        text.split("; ").find_map(|t| t.strip_prefix("A ")).map(|t| t.split(':').next().unwrap_or_default().to_owned())
    };
    assert!(place(&first).is_some() && place(&first) == place(&second), "{first} / {second}");
    // Alone again.
    harness.get_by_label("Energy").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Energy over time").is_none());
}
