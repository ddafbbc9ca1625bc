//! A run folder takes the place of another wherever the run stops, and one that is refused is not
//! touched.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::path::Path;

use cable_core::files::{FileError, RunEnd, RunFolder, RunFolderFault, SavedRun, load_run};
use cable_core::record::{NodeChoice, RobotColumns, RunRequest, RunStop};
use cable_core::scene::catalog;
use cable_core::{Model, Scene, Simulation, Solution};

/// A scene and its answer, told apart by its length.
fn answer(length_m: f64) -> (Scene, Solution) {
    let mut scene = catalog::hanging_span();
    scene.cables[0].length_m = length_m;
    let solution = Simulation::new(scene.clone(), Model::Auto).unwrap().settle().unwrap();
    (scene, solution)
}

fn begin(folder: &Path, scene: &Scene) -> Result<RunFolder, FileError> {
    RunFolder::create(folder, scene, RunRequest::default(), NodeChoice::default())
}

fn write(folder: &Path, (scene, solution): &(Scene, Solution), end: RunEnd) -> std::path::PathBuf {
    let mut run = begin(folder, scene).unwrap();
    run.begin(scene, RobotColumns::LeftOut).unwrap();
    run.push_last(solution).unwrap();
    run.finish(end).unwrap()
}

fn read(folder: &Path) -> SavedRun {
    load_run(folder, 1 << 20).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

const WHOLE: [&str; 6] = ["events.csv", "history.csv", "nodes.csv", "run.lock", "run.toml", "scene.toml"];

#[test]
fn a_run_is_replaced_by_a_complete_one_only() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let [first, second, third] = [12.0, 13.0, 14.0].map(answer);
    assert_eq!(write(&out, &first, RunEnd::Complete), out);
    assert_eq!(names(&out), WHOLE);
    for k in 1..=3 {
        let place = write(&out, &second, RunEnd::Partial(RunStop::Failed { message: "a test".to_owned() }));
        assert_eq!(place, out.join(format!("unfinished-{k}")), "none of them is lost");
        assert_eq!((read(&out).scene, read(&out).is_complete()), (first.0.clone(), Some(true)));
        let partial = read(&place);
        assert_eq!((&partial.scene, partial.is_complete()), (&second.0, Some(false)));
        assert!(partial.remarks()[0].to_string().contains("a test"), "{:?}", partial.remarks());
    }
    // One of them holds something that no run wrote.
    std::fs::write(out.join("unfinished-2/scene.toml"), "mine").unwrap();
    std::fs::write(out.join("unfinished-3/notes"), "mine").unwrap();
    assert_eq!(write(&out, &third, RunEnd::Complete), out);
    assert_eq!((read(&out).scene, read(&out).is_complete()), (third.0, Some(true)));
    assert_eq!(std::fs::read_to_string(out.join("unfinished-2/scene.toml")).unwrap(), "mine");
    assert_eq!(names(&out.join("unfinished-3")), ["notes"]);
    assert!(!out.join("unfinished-1").exists() && !out.join("unfinished-4").exists());
}

/// The models of its instants and the time that they took stand in a run, and a run of before there
/// were such keys is read without them.
#[test]
fn a_run_says_who_solved_it_and_how_long_that_took() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let (scene, first) = answer(12.0);
    let mut run = begin(&out, &scene).unwrap();
    run.begin(&scene, RobotColumns::LeftOut).unwrap();
    for (k, wall_s) in [0.25, 0.5, f64::NAN].into_iter().enumerate() {
        run.push(&Solution { time_s: k as f64, ..first.clone() }).unwrap();
        run.add_wall_time(wall_s);
    }
    run.finish(RunEnd::Complete).unwrap();
    let manifest = read(&out).manifest.unwrap();
    assert_eq!((manifest.model(), manifest.wall_time_s), (Some(Model::Catenary), Some(0.75)));
    // Two models answered: none of them answered the run.
    let mut run = begin(&out, &scene).unwrap();
    run.begin(&scene, RobotColumns::LeftOut).unwrap();
    for (time_s, model) in [(0.0, Model::Catenary), (1.0, Model::Fem), (2.0, Model::Fem), (3.0, Model::Auto)] {
        run.push(&Solution { time_s, model, ..first.clone() }).unwrap();
    }
    run.finish(RunEnd::Complete).unwrap();
    let manifest = read(&out).manifest.unwrap();
    assert_eq!(
        (manifest.solved_by.as_slice(), manifest.model()),
        (&["catenary".to_owned(), "fem".to_owned()][..], None)
    );
    let text = std::fs::read_to_string(out.join("run.toml")).unwrap();
    let older: String = text.lines().filter(|l| !l.starts_with("solved_by")).map(|l| format!("{l}\n")).collect();
    assert!(older.len() < text.len() && !text.contains("wall_time_s"), "{text}");
    std::fs::write(out.join("run.toml"), older).unwrap();
    let manifest = read(&out).manifest.unwrap();
    assert_eq!((manifest.model(), manifest.wall_time_s), (None, None));
}

/// Stopped after any of its renamings, a replacement reads as the new run, and the next run goes on
/// with it.
#[test]
fn a_replacement_that_stops_anywhere_is_gone_on_with() {
    let [first, second, third] = [12.0, 13.0, 14.0].map(answer);
    let order = ["scene.toml", "history.csv", "nodes.csv", "events.csv", "run.toml"];
    for moved in 0..=order.len() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        write(&out, &first, RunEnd::Complete);
        let from = write(&out, &second, RunEnd::Partial(RunStop::Failed { message: "replaced".to_owned() }));
        let edit = |path: &Path, from: &str, to: &str| {
            let text = std::fs::read_to_string(path).unwrap();
            assert!(text.contains(from), "{text}");
            std::fs::write(path, text.replace(from, to)).unwrap();
        };
        edit(&from.join("run.toml"), "status = \"partial\"", "status = \"complete\"");
        let replacing = "status = \"replacing\"\nsuccessor = \"unfinished-1\"";
        edit(&out.join("run.toml"), "status = \"complete\"", replacing);
        for name in &order[..moved] {
            std::fs::rename(from.join(name), out.join(name)).unwrap();
        }
        let run = read(&out);
        assert_eq!(
            (run.scene, run.manifest.unwrap().status),
            (second.0.clone(), cable_core::record::RunStatus::Complete)
        );
        assert_eq!(run.tables.nodes[0].node.tension_n, second.1.cables[0].nodes[0].tension_n, "{moved} moved");
        let next = begin(&out, &third.0).unwrap();
        assert_eq!(read(&out).scene, second.0);
        assert_eq!(next.place().parent(), Some(out.as_path()));
        drop(next);
        assert_eq!(write(&out, &third, RunEnd::Complete), out);
        assert_eq!(read(&out).scene, third.0);
        assert_eq!(names(&out), WHOLE, "{moved} moved");
    }
}

/// The file that a manifest names as its replacement is one of the folder's own, even in a hostile
/// manifest.
#[test]
fn a_successor_elsewhere_is_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let [first, second] = [12.0, 13.0].map(answer);
    write(&out, &first, RunEnd::Complete);
    write(&folder.path().join("other"), &second, RunEnd::Complete);
    let text = std::fs::read_to_string(out.join("run.toml")).unwrap();
    for name in ["../other", "/", "", "unfinished-", "unfinished-1/../../other"] {
        let to = format!("status = \"replacing\"\nsuccessor = \"{name}\"");
        std::fs::write(out.join("run.toml"), text.replace("status = \"complete\"", &to)).unwrap();
        assert_eq!(read(&out).scene, first.0, "{name}");
        drop(begin(&out, &first.0).unwrap());
        assert_eq!(read(&folder.path().join("other")).scene, second.0);
    }
}

#[test]
fn a_run_that_is_changed_meanwhile_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let [first, second] = [12.0, 13.0].map(answer);
    write(&out, &first, RunEnd::Complete);
    let mut run = begin(&out, &second.0).unwrap();
    run.push(&second.1).unwrap();
    std::fs::write(out.join("scene.toml"), "mine").unwrap();
    let error = run.finish(RunEnd::Complete).unwrap_err();
    assert!(matches!(&error, FileError::RunFolder { fault: RunFolderFault::Changed { .. }, .. }), "{error}");
    assert_eq!(std::fs::read_to_string(out.join("scene.toml")).unwrap(), "mine");
    assert_eq!(read(&out.join("unfinished-1")).is_complete(), Some(true), "and the new one is not lost");
}

#[test]
fn a_folder_is_one_runs_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let (scene, solution) = answer(12.0);
    let mut run = begin(&out, &scene).unwrap();
    let refused = || matches!(begin(&out, &scene), Err(FileError::RunFolder { fault: RunFolderFault::InUse, .. }));
    assert!(refused());
    run.push(&solution).unwrap();
    assert!(refused());
    run.finish(RunEnd::Complete).unwrap();
    let second = begin(&out, &scene).unwrap();
    assert!(refused());
    let inner = begin(second.place(), &scene);
    assert!(matches!(inner, Err(FileError::RunFolder { fault: RunFolderFault::InUse, .. })));
    drop(second);
    assert!(begin(&out, &scene).is_ok());
}

/// Runs of before there was a `run.toml` are read, and not run into.
#[test]
fn older_runs_are_read_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let first = answer(12.0);
    write(&out, &first, RunEnd::Complete);
    std::fs::remove_file(out.join("run.toml")).unwrap();
    std::fs::remove_file(out.join("run.lock")).unwrap();
    assert_eq!((read(&out).scene, read(&out).is_complete()), (first.0.clone(), None));
    assert!(matches!(begin(&out, &first.0), Err(FileError::RunFolder { fault: RunFolderFault::Foreign { .. }, .. })));
}
