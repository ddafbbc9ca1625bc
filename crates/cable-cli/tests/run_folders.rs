//! These tests make run folders from outside: whatever ends a run, its tables read back, and
//! nothing that was there before is lost.
//!
//! The full campaign (200 kills, 50 interrupts and 50 terminations, and a disk of 2 MiB, which
//! needs root to be mounted):
//! `cargo test -p cable-cli --test run_folders -- --ignored --nocapture`.

#![cfg(unix)] // signals, pipes and symbolic links
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use cable_core::files;
use cable_core::scene::catalog;

const TABLES: [&str; 3] = ["history.csv", "nodes.csv", "events.csv"];

/// The catalogue's hanging span in a file.
fn span(folder: &Path) -> PathBuf {
    let file = folder.join("span.toml");
    std::fs::write(&file, catalog::hanging_span().to_toml()).unwrap();
    file
}

fn cable(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cable"));
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// A run that takes minutes and writes all the time: 320 kB for each of its instants a millisecond
/// or so apart.
fn long_run(scene: &Path, out: &Path) -> Command {
    let mut command = cable(&["run", "--for", "10000s", "--every", "0.01s", "--quasi-static"]);
    command.arg(scene).arg("--out").arg(out);
    command
}

/// A run of 11 instants.
fn short_run(scene: &Path, out: &Path) -> Command {
    let mut command = cable(&["run", "--for", "1s", "--every", "0.1s", "--quasi-static"]);
    command.arg(scene).arg("--out").arg(out);
    command
}

fn said(o: &Output) -> String {
    String::from_utf8_lossy(&o.stderr).into_owned()
}

/// Ends when done or, with a test that fails, after a minute.
fn wait(mut child: Child) -> Output {
    let began = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if began.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            let o = child.wait_with_output().unwrap();
            panic!("it did not end: {}", said(&o));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    child.wait_with_output().unwrap()
}

/// Sends a signal by its name.
fn signal(child: &Child, name: &str) {
    let done = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status().unwrap();
    assert!(done.success());
}

/// Reads a table as another program would: every line ends, every record has a field for each
/// column, every number is one; returns the number of rows.
fn foreign_rows(path: &Path) -> Result<usize, String> {
    let bytes = std::fs::read(path).map_err(|e| e.to_string())?;
    if bytes.last().is_some_and(|b| *b != b'\n') {
        return Err("the last line has no end".to_owned());
    }
    let mut table = csv::Reader::from_reader(bytes.as_slice());
    let columns = table.headers().map_err(|e| e.to_string())?.clone();
    if columns.get(0) != Some("time_s") {
        return Err("it has no header".to_owned());
    }
    let mut rows = 0;
    for record in table.records() {
        let record = record.map_err(|e| e.to_string())?;
        for (name, text) in columns.iter().zip(&record) {
            if !["cable", "kind", "message"].contains(&name) && text.parse::<f64>().is_err() {
                return Err(format!("row {rows}: {name} is `{text}`"));
            }
        }
        rows += 1;
    }
    Ok(rows)
}

/// Files of a folder that another program, or this one, cannot read; a run that was killed before
/// it came to its tables has none.
fn unreadable(folder: &Path) -> Vec<String> {
    let there = TABLES.iter().filter(|name| folder.join(name).exists());
    let mut out: Vec<String> =
        there.filter_map(|name| foreign_rows(&folder.join(name)).err().map(|e| format!("{name}: {e}"))).collect();
    if let Err(e) = files::load_run(folder, 4 << 30) {
        out.push(e.to_string());
    }
    out
}

/// Every file below a folder with its bytes; a link with where it leads.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut out = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let about = std::fs::symlink_metadata(&path).unwrap();
        if about.is_dir() {
            out.extend(contents(&path));
        } else if about.is_file() {
            out.insert(path.clone(), std::fs::read(&path).unwrap());
        } else {
            let to = std::fs::read_link(&path).unwrap_or_default();
            out.insert(path, to.into_os_string().into_encoded_bytes());
        }
    }
    out
}

/// Until a file is there and has some bytes.
fn until(path: &Path, bytes: u64) {
    let began = Instant::now();
    while std::fs::metadata(path).map_or(0, |m| m.len()) < bytes {
        assert!(began.elapsed() < Duration::from_secs(60), "{} does not grow", path.display());
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Runs that are ended by a signal some milliseconds after they began: how many tables cannot be
/// read, of how many runs with tables.
fn interrupted(count: u32, name: &str) -> (usize, usize) {
    let folder = tempfile::tempdir().unwrap();
    let scene = span(folder.path());
    let (mut bad, mut with_tables) = (0, 0);
    let mut cut = 0;
    for k in 0..count {
        let out = folder.path().join(format!("run-{k}"));
        let child = long_run(&scene, &out).spawn().unwrap();
        until(&out.join("nodes.csv"), 1000);
        // 7 and 41 have nothing in common: moments all over the first 41 ms.
        std::thread::sleep(Duration::from_micros(u64::from(k * 7919 % 41_000)));
        signal(&child, name);
        let o = wait(child);
        let code = match name {
            "INT" => Some(130),
            "TERM" => Some(143),
            _ => None,
        };
        assert_eq!(o.status.code(), code, "{}", said(&o));
        with_tables += 1;
        let faults = unreadable(&out);
        let run = files::load_run(&out, 4 << 30).unwrap();
        assert_eq!(run.is_complete(), Some(false), "{name} {k} is not marked as partial");
        assert!(run.remarks().iter().any(|r| r.to_string().contains("partial")), "{:?}", run.remarks());
        if let Some(code) = code {
            assert_eq!(run.remarks().len(), 1, "what ends in order leaves nothing out: {:?}", run.remarks());
            assert!(run.remarks()[0].to_string().contains(&format!("SIG{name}")), "{code}: {:?}", run.remarks());
            assert!(said(&o).contains(&format!("SIG{name}")), "{}", said(&o));
        }
        if !faults.is_empty() {
            println!("{name} {k}: {faults:?}");
        }
        bad += usize::from(!faults.is_empty());
        cut += usize::from(!run.tables.left_out.is_empty());
        std::fs::remove_dir_all(&out).unwrap();
    }
    println!("{name}: {cut} of {count} runs end within an instant, which is left out");
    (bad, with_tables)
}

/// Runs killed at any moment from their first, their folders begun again: how many folders cannot
/// be read or be run into.
fn killed_at_once(count: u32) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let scene = span(folder.path());
    let mut bad = 0;
    for k in 0..count {
        let out = folder.path().join(format!("run-{k}"));
        let child = long_run(&scene, &out).spawn().unwrap();
        std::thread::sleep(Duration::from_micros(u64::from(k * 7919 % 41_000)));
        signal(&child, "KILL");
        wait(child);
        if files::is_run(&out) && out.join("scene.toml").exists() && !unreadable(&out).is_empty() {
            println!("{k}: {:?}", unreadable(&out));
            bad += 1;
        }
        let o = wait(short_run(&scene, &out).spawn().unwrap());
        let read = files::load_run(&out, 4 << 30);
        if o.status.code() != Some(0) || !read.is_ok_and(|r| r.is_complete() == Some(true)) {
            println!("{k}: {}", said(&o));
            bad += 1;
        }
        std::fs::remove_dir_all(&out).unwrap();
    }
    bad
}

#[test]
fn killed_runs_have_readable_tables() {
    assert_eq!(interrupted(20, "KILL").0, 0);
}

#[test]
fn a_folder_whose_run_was_killed_takes_another() {
    assert_eq!(killed_at_once(12), 0);
}

/// A step that takes minutes does not keep a signal waiting.
#[test]
fn a_run_within_a_long_step_ends_when_it_is_told_to() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("fine.toml"), folder.path().join("run"));
    let mut scene = catalog::hanging_span();
    scene.cables[0].segments = Some(4000);
    std::fs::write(&file, scene.to_toml()).unwrap();
    for (name, code) in [("TERM", 143), ("INT", 130)] {
        let mut command = cable(&["run", "--for", "60s", "--every", "60s", "--model", "mass-spring", "--json"]);
        command.args(["--stepping", "explicit"]);
        // Once nobody reads what is printed, which is more than a pipe holds; once it goes to a
        // file.
        let printed = folder.path().join("printed");
        if name == "INT" {
            command.stdout(std::fs::File::create(&printed).unwrap());
        }
        let child = command.arg(&file).arg("--out").arg(&out).spawn().unwrap();
        until(&out.join("history.csv"), 1);
        std::thread::sleep(Duration::from_millis(500));
        let began = Instant::now();
        signal(&child, name);
        let o = wait(child);
        assert!(began.elapsed() < Duration::from_secs(5), "{:?}", began.elapsed());
        assert_eq!(o.status.code(), Some(code), "{}", said(&o));
        assert_eq!(unreadable(&out), [""; 0]);
        let text = std::fs::read_to_string(&printed).unwrap_or_default();
        assert!(text.is_empty() || text.ends_with('\n'), "no line is cut");
    }
}

#[test]
fn interrupted_runs_end_with_readable_tables() {
    assert_eq!(interrupted(5, "INT").0, 0);
    assert_eq!(interrupted(5, "TERM").0, 0);
}

#[test]
fn a_killed_rerun_leaves_the_earlier_run_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (span(folder.path()), folder.path().join("run"));
    let o = short_run(&scene, &out).output().unwrap();
    assert_eq!(o.status.code(), Some(0), "{}", said(&o));
    let before = contents(&out);
    for name in ["KILL", "INT", "TERM", "KILL"] {
        let child = long_run(&scene, &out).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(300));
        signal(&child, name);
        wait(child);
        let after = contents(&out);
        for (path, bytes) in &before {
            assert_eq!(after.get(path), Some(bytes), "{} after {name}", path.display());
        }
    }
    // A run that comes to its end takes the place of the earlier one.
    let mut command = cable(&["run", "--for", "2s", "--every", "0.1s", "--quasi-static", "--out"]);
    let o = command.arg(&out).arg(&scene).output().unwrap();
    assert_eq!(o.status.code(), Some(0), "{}", said(&o));
    assert_eq!(foreign_rows(&out.join("history.csv")), Ok(21));
}

#[test]
fn what_no_run_wrote_is_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    let scene = span(folder.path());
    let text = std::fs::read_to_string(&scene).unwrap() + "# a user's own words\n";
    type Lay<'a> = &'a dyn Fn(&Path);
    let cases: [(&str, Lay<'_>); 7] = [
        ("a user's scene", &|out| std::fs::write(out.join("scene.toml"), &text).unwrap()),
        ("a user's table", &|out| std::fs::write(out.join("history.csv"), "mine").unwrap()),
        ("something else", &|out| std::fs::write(out.join("thesis.tex"), "mine").unwrap()),
        ("a link to a file", &|out| {
            std::fs::write(folder.path().join("precious"), "mine").unwrap();
            std::os::unix::fs::symlink(folder.path().join("precious"), out.join("nodes.csv")).unwrap();
        }),
        ("a link to nothing", &|out| {
            std::os::unix::fs::symlink(folder.path().join("nowhere"), out.join("nodes.csv")).unwrap();
        }),
        ("a pipe", &|out| {
            assert!(Command::new("mkfifo").arg(out.join("nodes.csv")).status().unwrap().success());
        }),
        ("a folder", &|out| std::fs::create_dir(out.join("events.csv")).unwrap()),
    ];
    for (k, (what, lay)) in cases.iter().enumerate() {
        let out = folder.path().join(format!("out-{k}"));
        std::fs::create_dir(&out).unwrap();
        lay(&out);
        let before = contents(folder.path());
        let o = wait(short_run(&scene, &out).spawn().unwrap());
        assert_eq!(o.status.code(), Some(74), "{what}: {}", said(&o));
        assert_eq!(contents(folder.path()), before, "{what}");
        assert!(said(&o).contains(&format!("out-{k}")), "{what}: {}", said(&o));
    }
}

#[test]
fn a_folder_that_is_a_link_is_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let scene = span(folder.path());
    let (real, link) = (folder.path().join("real"), folder.path().join("link"));
    std::fs::create_dir(&real).unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    let o = short_run(&scene, &link).output().unwrap();
    assert_eq!(o.status.code(), Some(74), "{}", said(&o));
    assert!(contents(&real).is_empty());
    // The way to the folder may lead over links.
    let o = short_run(&scene, &link.join("run")).output().unwrap();
    assert_eq!(o.status.code(), Some(0), "{}", said(&o));
    assert_eq!(unreadable(&real.join("run")), [""; 0]);
    // An empty folder is as good as a new one.
    let empty = folder.path().join("empty");
    std::fs::create_dir(&empty).unwrap();
    let o = short_run(&scene, &empty).output().unwrap();
    assert_eq!(o.status.code(), Some(0), "{}", said(&o));
}

/// Each file of a finished run in turn is replaced by what its user might lay there.
#[test]
fn what_a_user_laid_into_an_own_folder_is_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    let scene = span(folder.path());
    let names = ["scene.toml", "history.csv", "nodes.csv", "events.csv"];
    for (k, name) in names.iter().enumerate() {
        for what in ["edited", "link", "pipe"] {
            let out = folder.path().join(format!("{what}-{k}"));
            let o = short_run(&scene, &out).output().unwrap();
            assert_eq!(o.status.code(), Some(0), "{}", said(&o));
            let file = out.join(name);
            let text = std::fs::read_to_string(&file).unwrap();
            std::fs::remove_file(&file).unwrap();
            match what {
                "edited" => std::fs::write(&file, text + "# mine\n").unwrap(),
                "link" => {
                    std::fs::write(folder.path().join("precious"), text).unwrap();
                    std::os::unix::fs::symlink(folder.path().join("precious"), &file).unwrap();
                }
                _ => assert!(Command::new("mkfifo").arg(&file).status().unwrap().success()),
            }
            let before = contents(folder.path());
            let o = wait(short_run(&scene, &out).spawn().unwrap());
            assert_eq!(o.status.code(), Some(74), "{name} {what}: {}", said(&o));
            assert!(said(&o).contains(name), "{name} {what}: {}", said(&o));
            assert_eq!(contents(folder.path()), before, "{name} {what}");
        }
    }
    // Files beside the run's own are left where they are.
    let out = folder.path().join("notes");
    assert_eq!(short_run(&scene, &out).output().unwrap().status.code(), Some(0));
    std::fs::write(out.join("notes.txt"), "mine").unwrap();
    assert_eq!(short_run(&scene, &out).output().unwrap().status.code(), Some(0));
    assert_eq!(std::fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
}

#[test]
fn two_runs_at_once_into_a_folder_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (span(folder.path()), folder.path().join("run"));
    for round in ["new", "own"] {
        let first = long_run(&scene, &out).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(300));
        let o = wait(short_run(&scene, &out).spawn().unwrap());
        assert_eq!(o.status.code(), Some(74), "{round}: {}", said(&o));
        signal(&first, "TERM");
        wait(first);
        assert_eq!(unreadable(&out), [""; 0], "{round}");
    }
    // A killed run holds nothing.
    let first = long_run(&scene, &out).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(300));
    signal(&first, "KILL");
    wait(first);
    let o = wait(short_run(&scene, &out).spawn().unwrap());
    assert_eq!(o.status.code(), Some(0), "{}", said(&o));
}

/// The same, with files that may not grow beyond so many blocks of 512 bytes: as a full disk, but
/// for the name of the error.
fn with_short_files(command: &Command, blocks: u32) -> Output {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let mut limited = Command::new("sh");
    limited.arg("-c").arg(script).arg(command.get_program()).args(command.get_args());
    limited.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    wait(limited.spawn().unwrap())
}

#[test]
fn a_run_that_fills_the_disk_leaves_readable_tables_and_the_earlier_run() {
    let folder = tempfile::tempdir().unwrap();
    let scene = span(folder.path());
    for blocks in [700, 1001, 2003] {
        let out = folder.path().join(format!("run-{blocks}"));
        let o = with_short_files(&long_run(&scene, &out), blocks);
        assert_eq!(o.status.code(), Some(74), "{}", said(&o));
        assert!(said(&o).contains("nodes.csv"), "{}", said(&o));
        assert_eq!(unreadable(&out), [""; 0], "{blocks} blocks");
    }
    let out = folder.path().join("run");
    assert_eq!(short_run(&scene, &out).output().unwrap().status.code(), Some(0));
    let before = contents(&out);
    let o = with_short_files(&long_run(&scene, &out), 1500);
    assert_eq!(o.status.code(), Some(74), "{}", said(&o));
    let after = contents(&out);
    for (path, bytes) in &before {
        assert_eq!(after.get(path), Some(bytes), "{}", path.display());
    }
}

/// A line that lies on two pages of its file is cut where a run is killed between them, once in
/// some hundred times.
#[test]
fn no_line_lies_on_two_pages() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (span(folder.path()), folder.path().join("run"));
    let mut command = cable(&["run", "--for", "10s", "--every", "0.01s", "--quasi-static"]);
    let o = command.arg(&scene).arg("--out").arg(&out).output().unwrap();
    assert_eq!(o.status.code(), Some(0), "{}", said(&o));
    for name in TABLES {
        let bytes = std::fs::read(out.join(name)).unwrap();
        let pages = bytes.chunks_exact(4096).count();
        assert_eq!(bytes.chunks_exact(4096).filter(|page| page.last() == Some(&b'\n')).count(), pages, "{name}");
        assert!(name == "events.csv" || pages > 10);
    }
    assert_eq!(foreign_rows(&out.join("history.csv")), Ok(1001));
}

#[test]
fn columns_and_interval_of_nodes_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (span(folder.path()), folder.path().join("run"));
    let run = |more: &[&str]| {
        let _ = std::fs::remove_dir_all(&out);
        let o = short_run(&scene, &out).args(more).output().unwrap();
        (o.status.code(), said(&o), std::fs::read_to_string(out.join("nodes.csv")).unwrap_or_default())
    };
    let (_, _, all) = run(&[]);
    let (code, said, chosen) = run(&["--nodes-every", "0.4s", "--node-columns", "x_m, y_m,tension_n"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(chosen.starts_with("time_s,cable,x_m,y_m,tension_n\n"), "{chosen}");
    let times = |text: &str| {
        let mut times: Vec<f64> = text.lines().skip(1).map(|l| l.split(',').next().unwrap().parse().unwrap()).collect();
        times.dedup();
        times
    };
    assert_eq!(times(&chosen), [0.0, 0.4, 0.8, 1.0]);
    assert_eq!(times(&all).len(), 11);
    assert!(5 * chosen.len() < all.len(), "{} bytes of {}", chosen.len(), all.len());
    assert_eq!(foreign_rows(&out.join("history.csv")), Ok(11));
    let read = files::load_run(&out, 1 << 30).unwrap();
    assert!(read.tables.nodes.iter().all(|n| n.node.tension_n > 0.0 && n.node.strain.is_nan()));
    assert_eq!(run(&["--nodes-every", "never"]).2.lines().count(), 1);
    let (code, said, _) = run(&["--node-columns", "tension"]);
    assert!(code == Some(2) && said.contains("tension_n"), "{said}");
    let (code, said, _) = run(&["--nodes-every", "0.01s"]);
    assert!(code == Some(2) && said.contains("--every"), "{said}");
}

#[test]
fn a_run_keeps_its_model_and_compute_time() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (span(folder.path()), folder.path().join("run"));
    assert_eq!(short_run(&scene, &out).args(["--model", "mass-spring"]).output().unwrap().status.code(), Some(0));
    let manifest = cable_core::files::load_run(&out, 1 << 20).unwrap().manifest.unwrap();
    assert_eq!(manifest.model(), Some(cable_core::Model::MassSpring));
    assert!(manifest.wall_time_s.is_some_and(|s| s > 0.0 && s < 600.0), "{:?}", manifest.wall_time_s);
}

#[test]
fn check_says_how_far_a_run_came() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (span(folder.path()), folder.path().join("run"));
    assert_eq!(short_run(&scene, &out).output().unwrap().status.code(), Some(0));
    let check = || {
        let o = cable(&["check"]).arg(&out).output().unwrap();
        assert_eq!(o.status.code(), Some(0), "{}", said(&o));
        String::from_utf8(o.stdout).unwrap()
    };
    assert!(check().contains("a complete run, 11 instants to 1 s"), "{}", check());
    // Cut as by a machine that lost its power: within a line, and the tables not at the same place.
    let manifest = std::fs::read_to_string(out.join("run.toml")).unwrap();
    std::fs::write(out.join("run.toml"), manifest.replace("\"complete\"", "\"partial\"")).unwrap();
    let history = std::fs::read(out.join("history.csv")).unwrap();
    std::fs::write(out.join("history.csv"), &history[..history.len() - 20]).unwrap();
    let text = check();
    assert!(text.contains("a partial run, 10 instants to 0.9 s"), "{text}");
    assert!(text.contains("history.csv ends within a line") && text.contains("nodes.csv has"), "{text}");
}

/// A disk of 2 MiB; None where none can be mounted.
fn small_disk(at: &Path) -> Option<()> {
    std::fs::create_dir(at).unwrap();
    let mount = Command::new("mount").args(["-t", "tmpfs", "-o", "size=2m", "tmpfs"]).arg(at).output().ok()?;
    mount.status.success().then_some(())
}

#[test]
#[ignore = "needs root for a small disk"]
fn a_full_disk_leaves_readable_tables_and_the_earlier_run() {
    let folder = tempfile::tempdir().unwrap();
    let disk = folder.path().join("disk");
    small_disk(&disk).expect("a small disk");
    let scene = span(folder.path());
    let (first, second) = (disk.join("first"), disk.join("second"));
    let o = short_run(&scene, &first).output().unwrap();
    let before = contents(&first);
    let full = [wait(long_run(&scene, &first).spawn().unwrap()), wait(long_run(&scene, &second).spawn().unwrap())];
    let after = contents(&first);
    let unfinished = unreadable(&first.join("unfinished-1"));
    let written = std::fs::metadata(first.join("unfinished-1/nodes.csv")).map(|m| m.len());
    assert!(Command::new("umount").arg(&disk).status().unwrap().success());
    assert_eq!(o.status.code(), Some(0), "{}", said(&o));
    for o in full {
        assert_eq!(o.status.code(), Some(74), "{}", said(&o));
        println!("{}", said(&o));
    }
    assert_eq!(unfinished, [""; 0]);
    println!("{written:?} bytes of nodes.csv on a full disk");
    for (path, bytes) in &before {
        assert_eq!(after.get(path), Some(bytes), "{}", path.display());
    }
}

#[test]
#[ignore = "minutes"]
fn campaign() {
    let bad = killed_at_once(200);
    println!("KILL: {bad} of 200 folders whose run was killed at any moment cannot be read or run into");
    assert_eq!(bad, 0);
    for (name, count) in [("KILL", 200), ("INT", 50), ("TERM", 50)] {
        let (bad, runs) = interrupted(count, name);
        println!("{name}: {bad} of {runs} runs have a table that cannot be read");
        assert_eq!(bad, 0);
    }
}
