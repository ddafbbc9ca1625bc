//! The manifest of a run, `run.toml`, says what was asked, how far it came, and which files are its
//! own.

use serde::{Deserialize, Serialize};

use super::fingerprint::Fingerprint;
use super::node_choice::{NodeChoice, NodeInterval};
use crate::model_id::Model;

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

/// A file of a run, as it was when the run closed it.
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
    /// The models that answered its instants, in the order in which they first did; empty where it
    /// does not say.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub solved_by: Vec<String>,
    /// Wall time that its answers took, s; None where it does not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall_time_s: Option<f64>,
    /// The folder in this one that holds the new files until they replace the old ones.
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
    /// The manifest of a run that begins.
    #[must_use]
    pub fn new(request: RunRequest, nodes: NodeChoice, scene: FileRecord) -> Self {
        Self {
            version: VERSION,
            status: RunStatus::Partial,
            ended: None,
            reached_s: None,
            solved_by: Vec::new(),
            wall_time_s: None,
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

    /// Reads a manifest from text; `None` if the text is no manifest.
    #[must_use]
    pub fn from_toml(text: &str) -> Option<Self> {
        let manifest: Self = toml::from_str(text.strip_prefix(MANIFEST_HEAD)?).ok()?;
        (manifest.version == VERSION).then_some(manifest)
    }

    /// The model that answered all instants; `None` if several did or the manifest does not say.
    #[must_use]
    pub fn model(&self) -> Option<Model> {
        let [only] = self.solved_by.as_slice() else { return None };
        Model::from_name(only)
    }

    /// The record of a file.
    #[must_use]
    pub fn file(&self, name: &str) -> Option<&FileRecord> {
        self.files.iter().find(|f| f.name == name)
    }
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
