//! A run is read as a whole: what its folder says about itself, and its three tables together.

use std::io::Read;

use serde::{Deserialize, Serialize};

use super::choice::{NodeChoice, NodeInterval};
use super::columns::{EVENTS, HISTORY, NODES};
use super::csv_records::WholeRecords;
use super::fingerprint::Fingerprint;
use super::table_error::ReadError;
use super::table_reader::{Event, HistoryTable, NodeRow, read_events, read_history, read_nodes};

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunStatus {
    /// Not to its end, or not yet: every run is partial until it is complete, so that a run that
    /// ends without a word is marked.
    Partial,
    /// To its end.
    Complete,
    /// A complete successor, which lies in a folder in this one, is being put in its place.
    Replacing,
}

/// The reason why a run ended before its end. `run.toml` holds it as a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum RunStop {
    /// A signal interrupted it.
    Interrupted {
        /// Name of the signal.
        signal: String,
    },
    /// The solver panicked.
    Panicked,
    /// It failed.
    Failed {
        /// The sentence that the program said about it.
        message: String,
    },
}

const INTERRUPTED: &str = "interrupted by ";
const PANICKED: &str = "the solver panicked";

impl From<RunStop> for String {
    fn from(stop: RunStop) -> Self {
        match stop {
            RunStop::Interrupted { signal } => format!("{INTERRUPTED}{signal}"),
            RunStop::Panicked => PANICKED.to_owned(),
            RunStop::Failed { message } => message,
        }
    }
}

impl From<String> for RunStop {
    fn from(text: String) -> Self {
        match text.strip_prefix(INTERRUPTED).filter(|signal| !signal.contains(' ')) {
            Some(signal) => Self::Interrupted { signal: signal.to_owned() },
            None if text == PANICKED => Self::Panicked,
            None => Self::Failed { message: text },
        }
    }
}

/// The request for a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunRequest {
    /// The program and its version.
    pub program: String,
    /// The model that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<String>,
    /// Without inertia.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quasi_static: Option<bool>,
    /// Duration, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_s: Option<f64>,
    /// Time between outputs, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub every_s: Option<f64>,
    /// Time between steps, s; none: the usual one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_s: Option<f64>,
}

/// The part of the nodes that is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeSummary {
    /// Time between their outputs, s; none where they are written at each output, or never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub every_s: Option<f64>,
    /// Columns of `nodes.csv` beside `time_s` and `cable`; none where nodes are never written.
    pub columns: Vec<String>,
}

impl From<NodeChoice> for NodeSummary {
    fn from(choice: NodeChoice) -> Self {
        let never = choice.interval == NodeInterval::Never;
        Self {
            every_s: if let NodeInterval::Seconds(s) = choice.interval { Some(s) } else { None },
            columns: choice.columns.names().filter(|_| !never).map(str::to_owned).collect(),
        }
    }
}

/// A file of a run, as it was when the run let go of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Its name.
    pub name: String,
    /// Its length, bytes.
    pub bytes: u64,
    /// FNV-1a hash of its bytes, hexadecimal. It tells a file that somebody changed from the run's
    /// own.
    pub fnv1a: String,
}

impl FileRecord {
    /// Of a file.
    #[must_use]
    pub fn new(name: &str, bytes: u64, hash: Fingerprint) -> Self {
        Self { name: name.to_owned(), bytes, fnv1a: format!("{:016x}", hash.0) }
    }
}

/// `run.toml`: what a run folder says about itself, and proof that the folder is a run's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Of this format.
    pub version: u32,
    /// Its progress.
    pub status: RunStatus,
    /// The reason why a partial run ended, where it ended with a word.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ended: Option<RunStop>,
    /// Time of its last instant, s, where it ended with a word.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reached_s: Option<f64>,
    /// The folder in this one that holds what is being put in its place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub successor: Option<String>,
    /// The request.
    pub request: RunRequest,
    /// The part of the nodes that is written.
    pub nodes: NodeSummary,
    /// Its files; those of the tables once it ended with a word.
    #[serde(default)]
    pub files: Vec<FileRecord>,
}

/// The version of the format that is written.
const VERSION: u32 = 1;

/// First line of every `run.toml`: what begins otherwise was written by somebody else.
pub(crate) const MANIFEST_HEAD: &str =
    "# What `cable` says about this run; written by the program, not to be edited.\n";

impl Manifest {
    /// That of a run which begins.
    #[must_use]
    pub fn new(request: RunRequest, nodes: NodeChoice, scene: FileRecord) -> Self {
        Self {
            version: VERSION,
            status: RunStatus::Partial,
            ended: None,
            reached_s: None,
            successor: None,
            request,
            nodes: nodes.into(),
            files: vec![scene],
        }
    }

    /// As text.
    #[must_use]
    pub fn to_toml(&self) -> String {
        // It has no type that TOML could not hold.
        format!("{MANIFEST_HEAD}{}", toml::to_string(self).unwrap_or_default())
    }

    /// From text; None where it is no such text.
    #[must_use]
    pub fn from_toml(text: &str) -> Option<Self> {
        let manifest: Self = toml::from_str(text.strip_prefix(MANIFEST_HEAD)?).ok()?;
        (manifest.version == VERSION).then_some(manifest)
    }

    /// The record of a file.
    #[must_use]
    pub fn file(&self, name: &str) -> Option<&FileRecord> {
        self.files.iter().find(|f| f.name == name)
    }
}

/// The tables of a run, up to the last instant that is whole in all of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunTables {
    /// A row per time.
    pub history: HistoryTable,
    /// A row per node and time.
    pub nodes: Vec<NodeRow>,
    /// A row per event.
    pub events: Vec<Event>,
    /// Content of the tables that is not here.
    pub left_out: Vec<LeftOut>,
}

/// Part of a table that was not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// The last line has no end.
    IncompleteLine {
        /// The table.
        table: &'static str,
        /// Its length, bytes.
        bytes: usize,
    },
    /// Rows of an instant that has no row in `history.csv`.
    BeyondHistory {
        /// The table.
        table: &'static str,
        /// Their number.
        rows: usize,
    },
}

/// Reads the tables of a run together, wherever they were cut off. Of tables that are still written
/// to, `history` must have been opened and read first: what has a row there is in the others
/// already.
///
/// # Errors
/// Where one is not such a table.
pub(crate) fn read_run(history: impl Read, nodes: impl Read, events: impl Read) -> Result<RunTables, ReadError> {
    let mut left_out = Vec::new();
    let mut history = WholeRecords::new(history);
    let mut out = RunTables { history: read_history(&mut history)?, ..RunTables::default() };
    let (mut nodes, mut events) = (WholeRecords::new(nodes), WholeRecords::new(events));
    out.nodes = read_nodes(&mut nodes)?;
    out.events = read_events(&mut events)?;
    let cut = [(HISTORY, history.left_out_bytes()), (NODES, nodes.left_out_bytes()), (EVENTS, events.left_out_bytes())];
    left_out.extend(
        cut.into_iter().filter(|(_, bytes)| *bytes > 0).map(|(table, bytes)| LeftOut::IncompleteLine { table, bytes }),
    );
    // Events carry the time at which they began, which is not later than their instant's.
    let last_s = out.history.time_s.last().copied().unwrap_or(f64::NEG_INFINITY);
    let mut beyond = |table, rows: usize| {
        if rows > 0 {
            left_out.push(LeftOut::BeyondHistory { table, rows });
        }
    };
    let count = out.nodes.len();
    out.nodes.retain(|n| n.time_s <= last_s);
    beyond(NODES, count - out.nodes.len());
    let count = out.events.len();
    out.events.retain(|e| e.time_s <= last_s);
    beyond(EVENTS, count - out.events.len());
    out.left_out = left_out;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_is_read_back_from_its_sentence() {
        let failed = "interrupted by a wish, or so".to_owned();
        for stop in [
            RunStop::Interrupted { signal: "SIGINT".to_owned() },
            RunStop::Panicked,
            RunStop::Failed { message: failed },
        ] {
            assert_eq!(RunStop::from(String::from(stop.clone())), stop);
        }
    }
}
