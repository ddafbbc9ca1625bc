//! These sentences say why files, run folders and tables are not read or written, and what the
//! reader of a run should know.

use std::error::Error;

use super::figures::Figures;
use super::{Sentence, display_in_si};
use crate::files::{FileError, RunFolderFault, RunRemark};
use crate::record::{LeftOut, NodeColumns, ReadError, RowFault, UnknownColumn, WriteError, WrittenNumber};
use crate::units::{Quantity, UnitSystem};

display_in_si!(FileError, RunFolderFault, ReadError, WriteError, UnknownColumn, RunRemark);

impl Error for FileError {}
impl Error for RunFolderFault {}
impl Error for ReadError {}
impl Error for UnknownColumn {}

impl Error for WriteError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            Self::Columns { .. } | Self::NonFinite { .. } => None,
        }
    }
}

impl Sentence for FileError {
    fn sentence(&self, units: UnitSystem) -> String {
        match self {
            Self::Read { path, reason, .. } => format!("cannot read {path}: {reason}"),
            Self::NotAFile { path } => format!("cannot read {path}: it is not a file"),
            Self::TooLarge { path, limit_bytes } => {
                format!("cannot read {path}: it has more than the {limit_bytes} bytes allowed")
            }
            Self::Scene { path, fault } => format!("{path}: {}", fault.sentence(units)),
            Self::Table { path, fault } => format!("{path}: {}", fault.sentence(units)),
            Self::RunFolder { path, fault } => format!("no run is written into {path}: {}", fault.sentence(units)),
            Self::Write { path, reason, .. } => format!("cannot write {path}: {reason}"),
        }
    }
}

impl Sentence for RunFolderFault {
    fn sentence(&self, _: UnitSystem) -> String {
        match self {
            Self::Foreign { found } => format!(
                "it holds `{found}`, and no run of this program; choose a folder that is new or empty, or that of an earlier run"
            ),
            Self::Link => "it is a symbolic link, which is not followed; name the folder itself".to_owned(),
            Self::NotAFolder => "it is not a folder".to_owned(),
            Self::NotAFile { name } => format!("`{name}` in it is a link, a folder or a device, not a file"),
            Self::Changed { name } => format!(
                "`{name}` in it was changed since its run wrote it, and would be lost; move it away, or choose another folder"
            ),
            Self::InUse => "another run is being written there".to_owned(),
            Self::Full { count } => format!("it holds {count} unfinished runs; remove those that are not needed"),
        }
    }
}

impl Sentence for WriteError {
    fn sentence(&self, units: UnitSystem) -> String {
        match self {
            Self::Io { table, source } => format!("{table}: {source}"),
            Self::Columns { table, time_s } => {
                format!("{table}: the answer at {time_s} s has other columns than the table")
            }
            Self::NonFinite { table, number, time_s } => {
                format!("{table}: {} is not finite at {time_s} s", number.sentence(units))
            }
        }
    }
}

impl Sentence for WrittenNumber {
    fn sentence(&self, units: UnitSystem) -> String {
        match self {
            Self::Column(column) => (*column).to_owned(),
            Self::Node { column, node, cable } => format!("{column} of node {node} of cable `{cable}`"),
            Self::Reaction { support } => format!("the reaction of support `{support}`"),
            Self::Warning(warning) => format!("a number of the warning `{}`", warning.sentence(units)),
        }
    }
}

impl Sentence for ReadError {
    fn sentence(&self, units: UnitSystem) -> String {
        match self {
            Self::Row { table, line, fault } => format!("{table}, line {line}: {}", fault.sentence(units)),
            Self::TooLong { table, limit } => format!("{table} has more than {limit} rows"),
        }
    }
}

impl Sentence for RowFault {
    fn sentence(&self, _: UnitSystem) -> String {
        match self {
            Self::Unreadable { message } => message.clone(),
            Self::MissingColumn { column } => format!("column {column} is missing"),
            Self::NotANumber { column, text } => format!("{column} is `{text}`, not a finite number"),
            Self::OtherColumn { number, expected } => format!("column {number} must be `{expected}`"),
            Self::UnknownColumn { column } => format!("unknown column `{column}`"),
            Self::UnknownKind { kind } => format!("unknown kind `{kind}`"),
            Self::NotAReaction { number } => format!("column {number} is not a support's reaction"),
        }
    }
}

impl Sentence for UnknownColumn {
    fn sentence(&self, _: UnitSystem) -> String {
        let known = NodeColumns::NAMES.join(", ");
        format!("nodes.csv has no column `{}`: its columns are {known}", self.name)
    }
}

impl Sentence for RunRemark {
    fn sentence(&self, units: UnitSystem) -> String {
        match self {
            Self::Partial { reached_s, stop } => {
                let reached = reached_s.map_or_else(
                    || "no results written".to_owned(),
                    |t| format!("up to {}", Figures(units).given(Quantity::Time, t)),
                );
                let stop =
                    stop.clone().map_or_else(|| "it was cut off, or is still being written".to_owned(), String::from);
                format!("The run is partial ({reached}): {stop}")
            }
            Self::LeftOut(LeftOut::IncompleteLine { table, bytes }) => {
                format!("{table} ends within a line, of which {bytes} bytes were left out")
            }
            Self::LeftOut(LeftOut::BeyondHistory { table, rows }) => {
                format!("{table} has {rows} rows later than the end of history.csv, which were left out")
            }
        }
    }
}
