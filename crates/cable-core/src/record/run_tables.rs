//! The three tables of a run are read together.

use std::io::Read;

use super::columns::{EVENTS, HISTORY, NODES};
use super::csv_records::WholeRecords;
use super::table_error::ReadError;
use super::table_reader::{Event, HistoryTable, NodeRow, read_events, read_history, read_nodes};

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
/// If one of them is not such a table.
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
