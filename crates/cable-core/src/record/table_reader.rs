//! The three tables of a run are read up to their last whole row.

use std::io::Read;

use serde::{Deserialize, Serialize};

use super::columns::{EVENT_COLUMNS, EVENTS, HISTORY, HISTORY_COLUMNS, NODES, OLD_EVENT_COLUMNS, known_extra};
use super::csv_records::WholeRecords;
use super::node_choice::{NodeColumns, node_of};
use super::table_error::{ReadError, RowFault};
use crate::solution::{WarningCause, WarningKind};

/// Most rows read of a table: 1e7 node rows are 1 GB of memory. Fewer would refuse an hour at 60 Hz
/// of 40 nodes; more would let a hostile file exhaust the machine.
const MAX_ROWS: usize = 10_000_000;

/// A row of `nodes.csv`: a node and when.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeRow {
    /// Time, s.
    pub time_s: f64,
    /// The cable's name.
    pub cable: String,
    /// The node.
    pub node: crate::solution::Node,
}

/// A row of `events.csv`: a warning that began.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Time, s.
    pub time_s: f64,
    /// The kind.
    pub kind: WarningKind,
    /// The cable's name.
    pub cable: String,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// The quantity's value, in its own unit.
    pub value: f64,
    /// Its limit, same unit.
    pub limit: f64,
    /// The cause; of tables without causes, or with one that is not known, the sentence.
    pub cause: WarningCause,
}

/// `history.csv` in memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryTable {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Greatest tension at each time, N.
    pub max_tension_n: Vec<f64>,
    /// Its place, m.
    pub max_tension_arc_length_m: Vec<f64>,
    /// Reactions of each support.
    pub supports: Vec<SupportColumn>,
    /// Energies, and the figures of a robot.
    pub extras: Vec<Extra>,
}

/// A column of `history.csv` that is of no support.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extra {
    /// Its name, which ends in its unit.
    pub name: &'static str,
    /// Its value at each time.
    pub values: Vec<f64>,
}

/// Reactions of one support over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SupportColumn {
    /// `NAME`, or `CABLE.NAME` where there are several cables.
    pub name: String,
    /// Force of the cable on it at each time, N.
    pub reaction_x_n: Vec<f64>,
    /// Force of the cable on it at each time, N.
    pub reaction_y_n: Vec<f64>,
}

/// A table that was cut off ends with its last whole record.
fn reader<R: Read>(from: R) -> csv::Reader<WholeRecords<R>> {
    csv::ReaderBuilder::new().from_reader(WholeRecords::new(from))
}

/// Returns whether a table has any rows; one that cannot be read has some.
pub(crate) fn has_rows(from: impl Read) -> bool {
    reader(from).records().next().is_some()
}

fn row_error(table: &'static str, line: u64, fault: RowFault) -> ReadError {
    ReadError::Row { table, line, fault }
}

fn unreadable(table: &'static str, line: u64, error: &csv::Error) -> ReadError {
    row_error(table, line, RowFault::Unreadable { message: error.to_string() })
}

/// The finite number in column `k` of a record.
fn parse(table: &'static str, record: &csv::StringRecord, k: usize, column: &str) -> Result<f64, ReadError> {
    let line = record.position().map_or(1, csv::Position::line);
    let column = || column.to_owned();
    let text = record.get(k).ok_or_else(|| row_error(table, line, RowFault::MissingColumn { column: column() }))?;
    match text.trim().parse::<f64>() {
        Ok(v) if v.is_finite() => Ok(v),
        _ => Err(row_error(table, line, RowFault::NotANumber { column: column(), text: text.to_owned() })),
    }
}

/// Calls `f` for each row, with a limit on how many.
fn rows<R: Read>(
    table: &'static str,
    from: &mut csv::Reader<R>,
    mut f: impl FnMut(&csv::StringRecord) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let mut record = csv::StringRecord::new();
    for count in 0.. {
        let line = from.position().line();
        match from.read_record(&mut record) {
            Ok(false) => return Ok(()),
            Ok(true) if count >= MAX_ROWS => return Err(ReadError::TooLong { table, limit: MAX_ROWS }),
            Ok(true) => f(&record)?,
            Err(e) => return Err(unreadable(table, line, &e)),
        }
    }
    Ok(())
}

/// Returns whether the columns begin with those expected; false where nothing was written yet, not
/// even a header.
fn expect_columns<R: Read>(
    table: &'static str,
    from: &mut csv::Reader<R>,
    expected: &[&str],
) -> Result<bool, ReadError> {
    let found = from.headers().map_err(|e| unreadable(table, 1, &e))?;
    if found.is_empty() {
        return Ok(false);
    }
    match expected.iter().enumerate().find(|(k, name)| found.get(*k) != Some(**name)) {
        None => Ok(true),
        Some((k, name)) => {
            Err(row_error(table, 1, RowFault::OtherColumn { number: k + 1, expected: (*name).to_owned() }))
        }
    }
}

/// Reads `nodes.csv` up to its last whole row. Values whose columns were not chosen
/// ([`super::NodeChoice`]) are NaN.
///
/// # Errors
/// If it is not such a table.
pub fn read_nodes(from: impl Read) -> Result<Vec<NodeRow>, ReadError> {
    let mut from = reader(from);
    let mut out = Vec::new();
    if !expect_columns(NODES, &mut from, &["time_s", "cable"])? {
        return Ok(out);
    }
    let header = from.headers().map_err(|e| unreadable(NODES, 1, &e))?;
    let place = |name| header.iter().position(|c| c == name);
    let places = NodeColumns::NAMES.map(place);
    if let Some(name) = header.iter().skip(2).find(|c| !NodeColumns::NAMES.contains(c)) {
        return Err(row_error(NODES, 1, RowFault::UnknownColumn { column: name.to_owned() }));
    }
    rows(NODES, &mut from, |r| {
        let mut v = [f64::NAN; NodeColumns::COUNT];
        for ((v, place), name) in v.iter_mut().zip(places).zip(NodeColumns::NAMES) {
            if let Some(k) = place {
                *v = parse(NODES, r, k, name)?;
            }
        }
        out.push(NodeRow {
            time_s: parse(NODES, r, 0, "time_s")?,
            cable: r.get(1).unwrap_or_default().to_owned(),
            node: node_of(v),
        });
        Ok(())
    })?;
    Ok(out)
}

/// Reads `events.csv` up to its last whole row.
///
/// # Errors
/// If it is not such a table.
pub fn read_events(from: impl Read) -> Result<Vec<Event>, ReadError> {
    let mut from = reader(from);
    let mut out = Vec::new();
    if !expect_columns(EVENTS, &mut from, &EVENT_COLUMNS[..OLD_EVENT_COLUMNS])? {
        return Ok(out);
    }
    rows(EVENTS, &mut from, |r| {
        let line = r.position().map_or(1, csv::Position::line);
        let name = r.get(1).unwrap_or_default();
        let kind = WarningKind::from_name(name)
            .ok_or_else(|| row_error(EVENTS, line, RowFault::UnknownKind { kind: name.to_owned() }))?;
        let cause =
            r.get(7).and_then(|text| serde_json::from_str(text).ok()).filter(|c: &WarningCause| c.kind() == kind);
        let message = r.get(6).unwrap_or_default().to_owned();
        out.push(Event {
            time_s: parse(EVENTS, r, 0, "time_s")?,
            kind,
            cable: r.get(2).unwrap_or_default().to_owned(),
            arc_length_m: parse(EVENTS, r, 3, "arc_length_m")?,
            value: parse(EVENTS, r, 4, "value")?,
            limit: parse(EVENTS, r, 5, "limit")?,
            cause: cause.unwrap_or(WarningCause::Recorded { kind, message }),
        });
        Ok(())
    })?;
    Ok(out)
}

/// Reads `history.csv` up to its last whole row.
///
/// # Errors
/// If it is not such a table.
pub fn read_history(from: impl Read) -> Result<HistoryTable, ReadError> {
    let mut from = reader(from);
    let mut table = HistoryTable::default();
    if !expect_columns(HISTORY, &mut from, &HISTORY_COLUMNS)? {
        return Ok(table);
    }
    let header = from.headers().map_err(|e| unreadable(HISTORY, 1, &e))?.clone();
    // Reactions come in pairs of columns: x, y of each support. Then the extras, which older tables
    // lack.
    let mut k = 3;
    while k < header.len() {
        let name = header.get(k).unwrap_or_default();
        if let Some(known) = known_extra(name) {
            table.extras.push(Extra { name: known, values: Vec::new() });
            k += 1;
            continue;
        }
        let x = name.strip_suffix(".reaction_x_n");
        let y = header.get(k + 1).and_then(|c| c.strip_suffix(".reaction_y_n"));
        match (x, y) {
            (Some(x), Some(y)) if x == y && table.extras.is_empty() => {
                table.supports.push(SupportColumn { name: x.to_owned(), ..SupportColumn::default() });
            }
            _ => return Err(row_error(HISTORY, 1, RowFault::NotAReaction { number: k + 1 })),
        }
        k += 2;
    }
    rows(HISTORY, &mut from, |r| {
        table.time_s.push(parse(HISTORY, r, 0, "time_s")?);
        table.max_tension_n.push(parse(HISTORY, r, 1, "max_tension_n")?);
        table.max_tension_arc_length_m.push(parse(HISTORY, r, 2, "max_tension_arc_length_m")?);
        for (i, s) in table.supports.iter_mut().enumerate() {
            s.reaction_x_n.push(parse(HISTORY, r, 3 + 2 * i, "reaction_x_n")?);
            s.reaction_y_n.push(parse(HISTORY, r, 4 + 2 * i, "reaction_y_n")?);
        }
        let first = 3 + 2 * table.supports.len();
        for (i, extra) in table.extras.iter_mut().enumerate() {
            extra.values.push(parse(HISTORY, r, first + i, extra.name)?);
        }
        Ok(())
    })?;
    Ok(table)
}
