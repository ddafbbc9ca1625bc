//! Names of the files of a run folder.

/// Name of the file in which a run folder describes itself.
pub(in crate::files) const MANIFEST_NAME: &str = "run.toml";
/// The scene of a run.
pub(in crate::files) const SCENE_NAME: &str = "scene.toml";
/// The tables of a run, in the order of [`RunWriter::places`].
pub(in crate::files) const TABLE_NAMES: [&str; 3] = ["history.csv", "nodes.csv", "events.csv"];
/// Files of a run beside its manifest.
pub(in crate::files) const RUN_FILES: [&str; 4] = [SCENE_NAME, "history.csv", "nodes.csv", "events.csv"];
/// Held while a run is written; an empty file, which stays, since a lock on a file that is removed
/// excludes nobody.
pub(in crate::files) const LOCK_NAME: &str = "run.lock";
