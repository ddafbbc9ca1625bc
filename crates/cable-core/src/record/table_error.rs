//! Faults of the tables of a run, in writing and in reading.

use crate::solution::Warning;

/// The reason why a table was not written: the path or device is named by the caller, who knows it.
#[derive(Debug)]
pub enum WriteError {
    /// The row could not be written, or not flushed.
    Io {
        /// The table.
        table: &'static str,
        /// The system's error.
        source: std::io::Error,
    },
    /// The answer has other supports, or another robot, than the table; nothing of this time was
    /// written.
    Columns {
        /// The table.
        table: &'static str,
        /// Time, s.
        time_s: f64,
    },
    /// A number is not finite; nothing of this time was written.
    NonFinite {
        /// The table.
        table: &'static str,
        /// The number.
        number: Box<WrittenNumber>,
        /// Time, s.
        time_s: f64,
    },
}

/// A number of an answer that goes into a table.
#[derive(Clone, Debug, PartialEq)]
pub enum WrittenNumber {
    /// A column of `history.csv`.
    Column(&'static str),
    /// A column of a node.
    Node {
        /// The column.
        column: &'static str,
        /// The node's index.
        node: usize,
        /// Name of its cable.
        cable: String,
    },
    /// The reaction of a support.
    Reaction {
        /// Name of the support.
        support: String,
    },
    /// A number of a warning.
    Warning(Warning),
}

/// The reason why a table was not read.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// It is not the table it should be.
    Row {
        /// The table.
        table: &'static str,
        /// Line, from 1.
        line: u64,
        /// The fault.
        fault: RowFault,
    },
    /// More rows than a run may have.
    TooLong {
        /// The table.
        table: &'static str,
        /// The most rows read.
        limit: usize,
    },
}

/// The fault of a row, or of the header.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RowFault {
    /// It is no row of a table of comma-separated values.
    Unreadable {
        /// The reader's own words.
        message: String,
    },
    /// A column is missing.
    MissingColumn {
        /// The column.
        column: String,
    },
    /// A field holds no finite number.
    NotANumber {
        /// The column.
        column: String,
        /// The text of the field.
        text: String,
    },
    /// Another column stands in the place of one.
    OtherColumn {
        /// Its number, from 1.
        number: usize,
        /// The column that must stand there.
        expected: String,
    },
    /// A column that the table does not know.
    UnknownColumn {
        /// Its name.
        column: String,
    },
    /// A kind of event that is not known.
    UnknownKind {
        /// Its name.
        kind: String,
    },
    /// A column that is not a support's reaction stands where one must.
    NotAReaction {
        /// Its number, from 1.
        number: usize,
    },
}
