//! These tests ask that files are limited before they are read, and that a save leaves the old file
//! or the new one.

use std::fs;
use std::io::{self, BufRead};

use cable_core::FileError;
use cable_core::files::{load_scene, read_limited, save_scene, write_atomic, write_atomic_with};
use cable_core::scene::catalog;

#[test]
fn a_saved_scene_loads_again_and_replaces_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    save_scene(&path, &catalog::hanging_span()).unwrap();
    save_scene(&path, &catalog::tank()).unwrap();
    assert_eq!(load_scene(&path).unwrap(), catalog::tank());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file was left");
}

#[test]
fn what_cannot_be_read_is_said_with_path_and_reason() {
    let folder = tempfile::tempdir().unwrap();
    let missing = load_scene(folder.path().join("none.toml")).unwrap_err();
    assert!(
        matches!(&missing, FileError::Read { kind: io::ErrorKind::NotFound, path, .. } if path.contains("none.toml"))
    );
    assert!(matches!(load_scene(folder.path()).unwrap_err(), FileError::NotAFile { .. }));
    let path = folder.path().join("scene.toml");
    fs::write(&path, b"version = 1\nname = \"\xff\"").unwrap();
    let error = load_scene(&path).unwrap_err();
    assert!(error.to_string().contains("line 2") && error.to_string().contains("scene.toml"), "{error}");
    // Four GiB that take no room on the disk: refused by its size.
    fs::File::create(&path).unwrap().set_len(4 << 30).unwrap();
    assert!(matches!(load_scene(&path).unwrap_err(), FileError::TooLarge { .. }));
    fs::write(&path, [b'x'; 10]).unwrap();
    assert_eq!(read_limited(&path, 10).unwrap().len(), 10);
    assert!(matches!(read_limited(&path, 9), Err(FileError::TooLarge { limit_bytes: 9, .. })));
}

#[test]
fn a_save_that_fails_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    write_atomic(&path, b"old").unwrap();
    // The n-th write failing, for every n.
    for n in 0..6 {
        let error = write_atomic_with(&path, |out| {
            for i in 0..6 {
                if i == n {
                    return Err(io::Error::from(io::ErrorKind::StorageFull));
                }
                out.write_all(&[b'x'; 5000])?;
            }
            Ok(())
        })
        .unwrap_err();
        assert!(matches!(error, FileError::Write { kind: io::ErrorKind::StorageFull, .. }), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file was left");
    }
    // The folder is gone, is a file, or the target is a folder.
    for bad in [folder.path().join("gone/scene.toml"), path.join("scene.toml"), folder.path().to_path_buf()] {
        let error = write_atomic(&bad, b"new").unwrap_err();
        assert!(error.to_string().contains(&bad.display().to_string()), "{error}");
    }
    assert_eq!(fs::read(&path).unwrap(), b"old");
}

#[cfg(unix)]
#[test]
fn a_folder_that_may_not_be_written_keeps_its_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    write_atomic(&path, b"old").unwrap();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser may write everywhere.
    let forbidden = fs::File::create(folder.path().join("probe")).is_err();
    if forbidden {
        assert!(matches!(
            write_atomic(&path, b"new"),
            Err(FileError::Write { kind: io::ErrorKind::PermissionDenied, .. })
        ));
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
}

/// The place where [`a_child_saves_for_ever`] saves to.
const SAVE_TO: &str = "CABLE_TEST_SAVE_TO";

/// Two scenes of very different length, so that a file half of each could not be read.
fn two_scenes() -> [cable_core::Scene; 2] {
    let mut long = catalog::tank();
    long.cables[0].route_m = (0..5000).map(|k| [f64::from(k) * 1e-3, 5.0]).collect();
    [catalog::hanging_span(), long]
}

/// Not a test by itself: the child that [`kills`] kills.
#[test]
#[ignore = "the child of the tests below, which saves until it is killed"]
fn a_child_saves_for_ever() {
    let path = std::env::var(SAVE_TO).expect("a path in CABLE_TEST_SAVE_TO");
    let scenes = two_scenes();
    loop {
        for scene in scenes.iter().rev() {
            save_scene(&path, scene).unwrap();
            println!("\nsaved");
        }
    }
}

/// Kills a saving process `count` times with SIGKILL at changing moments: the file is always one of
/// the two scenes.
fn kills(count: u64) {
    use std::process::{Command, Stdio};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let scenes = two_scenes();
    save_scene(&path, &scenes[0]).unwrap();
    let mut found = [0; 2];
    for k in 0..count {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "files::a_child_saves_for_ever", "--ignored", "--nocapture"])
            .env(SAVE_TO, &path)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // From its first save to some saves later, however slow the disk, and then a time in steps
        // that never repeat (the golden ratio's).
        let saves = io::BufReader::new(child.stdout.take().unwrap())
            .lines()
            .filter(|l| l.as_ref().is_ok_and(|l| l == "saved"))
            .take(1 + k as usize % 4)
            .count();
        assert_eq!(saves, 1 + k as usize % 4, "the child ended by itself");
        let part = (k as f64 * 0.618_033_988_749_895).fract();
        std::thread::sleep(std::time::Duration::from_secs_f64(0.02 * part));
        child.kill().unwrap();
        child.wait().unwrap();
        let read = load_scene(&path).unwrap_or_else(|e| panic!("after {k} kills: {e}"));
        let which = scenes.iter().position(|s| *s == read).unwrap_or_else(|| panic!("after {k} kills: another scene"));
        found[which] += 1;
    }
    println!("{count} kills: old and new found {found:?} times");
    assert!(found.iter().all(|n| *n > 0), "a child never came to save: {found:?}");
}

#[test]
fn fifty_kills_during_saves_leave_a_whole_file() {
    kills(50);
}

#[test]
#[ignore = "a minute: cargo test -p cable-core --test scenes thousand_kills -- --ignored --nocapture"]
fn a_thousand_kills_during_saves_leave_a_whole_file() {
    kills(1000);
}
