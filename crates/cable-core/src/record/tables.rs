//! The three tables of a run, written and read.

use std::io::{Read, Write};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::solution::{Node, Solution, Warning, WarningKind};

/// Why a table was not written: the path or device is named by the caller, who knows it.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The row could not be written, or not flushed.
    #[error("{table}: {source}")]
    Io {
        /// Which table.
        table: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// A number is not finite; nothing of this time was written.
    #[error("{table}: {column} is not finite at {time_s} s")]
    NonFinite {
        /// Which table.
        table: &'static str,
        /// Which column.
        column: String,
        /// Time, s.
        time_s: f64,
    },
}

/// Why a table was not read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// It is not the table it should be.
    #[error("{table}, line {line}: {what}")]
    Row {
        /// Which table.
        table: &'static str,
        /// Line, from 1.
        line: u64,
        /// What is wrong.
        what: String,
    },
    /// More rows than a run may have.
    #[error("{table} has more than {limit} rows")]
    TooLong {
        /// Which table.
        table: &'static str,
        /// The most rows read.
        limit: usize,
    },
}

/// Most rows read of a table: 1e7 node rows are 1 GB of memory. Fewer would refuse an hour at 60 Hz of 40 nodes;
/// more would let a hostile file exhaust the machine.
const MAX_ROWS: usize = 10_000_000;

const HISTORY: &str = "history.csv";
const NODES: &str = "nodes.csv";
const EVENTS: &str = "events.csv";

/// A row of `nodes.csv`: a node and when.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeRow {
    /// Time, s.
    pub time_s: f64,
    /// The cable's name.
    pub cable: String,
    /// The node.
    pub node: Node,
}

/// A row of `events.csv`: a warning that began.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Time, s.
    pub time_s: f64,
    /// What kind.
    pub kind: WarningKind,
    /// The cable's name.
    pub cable: String,
    /// Where on the cable, m.
    pub arc_length_m: f64,
    /// The quantity's value, in its own unit.
    pub value: f64,
    /// Its limit, same unit.
    pub limit: f64,
    /// What, where and why.
    pub message: String,
}

/// `history.csv` in memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryTable {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Greatest tension at each time, N.
    pub max_tension_n: Vec<f64>,
    /// Where it was, m.
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

/// Writes a run's tables as it goes. Call [`Self::flush`] at the end (a full disk shows only there).
pub struct RunWriter<W: Write> {
    history: csv::Writer<W>,
    nodes: csv::Writer<W>,
    events: csv::Writer<W>,
    header_done: bool,
    active: Vec<(WarningKind, String, Option<u64>)>,
    number: String,
}

impl<W: Write> RunWriter<W> {
    /// Over three places to write to.
    pub fn new(history: W, nodes: W, events: W) -> Self {
        Self {
            history: csv::Writer::from_writer(history),
            nodes: csv::Writer::from_writer(nodes),
            events: csv::Writer::from_writer(events),
            header_done: false,
            active: Vec::new(),
            number: String::new(),
        }
    }

    /// Appends one time. A warning becomes an event when it begins, with the time it began at, not again while it lasts.
    ///
    /// # Errors
    /// When a number is not finite (nothing is written) or the place refuses.
    pub fn push(&mut self, solution: &Solution) -> Result<(), WriteError> {
        check_finite(solution)?;
        if !self.header_done {
            self.headers(solution)?;
            self.header_done = true;
        }
        self.history_row(solution)?;
        self.node_rows(solution)?;
        self.event_rows(solution)
    }

    fn headers(&mut self, solution: &Solution) -> Result<(), WriteError> {
        let mut columns: Vec<String> =
            ["time_s", "max_tension_n", "max_tension_arc_length_m"].map(String::from).to_vec();
        let several = solution.cables.len() > 1;
        for c in &solution.cables {
            for s in &c.supports {
                let name = if several { format!("{}.{}", c.name, s.name) } else { s.name.clone() };
                columns.push(format!("{name}.reaction_x_n"));
                columns.push(format!("{name}.reaction_y_n"));
            }
        }
        columns.extend(extras(solution).map(|(name, _)| name.to_owned()));
        self.history.write_record(&columns).map_err(|e| io_error(HISTORY, e))?;
        self.nodes.write_record(NODE_COLUMNS).map_err(|e| io_error(NODES, e))?;
        self.events.write_record(EVENT_COLUMNS).map_err(|e| io_error(EVENTS, e))
    }

    fn history_row(&mut self, solution: &Solution) -> Result<(), WriteError> {
        let top = solution.max_tension();
        let text = &mut self.number;
        let to = &mut self.history;
        for value in [solution.time_s, top.tension_n, top.arc_length_m] {
            number(to, text, value).map_err(|e| io_error(HISTORY, e))?;
        }
        for s in solution.cables.iter().flat_map(|c| &c.supports) {
            number(to, text, s.reaction_x_n).map_err(|e| io_error(HISTORY, e))?;
            number(to, text, s.reaction_y_n).map_err(|e| io_error(HISTORY, e))?;
        }
        for (_, value) in extras(solution) {
            number(to, text, value).map_err(|e| io_error(HISTORY, e))?;
        }
        end_row(to).map_err(|e| io_error(HISTORY, e))
    }

    fn node_rows(&mut self, solution: &Solution) -> Result<(), WriteError> {
        let text = &mut self.number;
        let to = &mut self.nodes;
        let mut row = |cable: &str, n: &Node| -> csv::Result<()> {
            number(to, text, solution.time_s)?;
            to.write_field(cable)?;
            for value in node_values(n) {
                number(to, text, value)?;
            }
            end_row(to)
        };
        for c in &solution.cables {
            for n in &c.nodes {
                row(&c.name, n).map_err(|e| io_error(NODES, e))?;
            }
        }
        Ok(())
    }

    fn event_rows(&mut self, solution: &Solution) -> Result<(), WriteError> {
        for w in &solution.warnings {
            let since = w.since_s.map(f64::to_bits);
            if !self.active.iter().any(|(kind, cable, began)| (*kind, began) == (w.kind, &since) && *cable == w.cable) {
                self.event(w.since_s.unwrap_or(solution.time_s), w)?;
            }
        }
        self.active =
            solution.warnings.iter().map(|w| (w.kind, w.cable.clone(), w.since_s.map(f64::to_bits))).collect();
        Ok(())
    }

    fn event(&mut self, time_s: f64, w: &Warning) -> Result<(), WriteError> {
        let text = &mut self.number;
        let to = &mut self.events;
        let mut row = || -> csv::Result<()> {
            number(to, text, time_s)?;
            to.write_field(w.kind.name())?;
            to.write_field(&w.cable)?;
            for value in [w.arc_length_m, w.value, w.limit] {
                number(to, text, value)?;
            }
            to.write_field(&w.message)?;
            end_row(to)
        };
        row().map_err(|e| io_error(EVENTS, e))
    }

    /// Hands everything to the system.
    ///
    /// # Errors
    /// When the place refuses (a full disk shows only here).
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.history.flush().map_err(|source| WriteError::Io { table: HISTORY, source })?;
        self.nodes.flush().map_err(|source| WriteError::Io { table: NODES, source })?;
        self.events.flush().map_err(|source| WriteError::Io { table: EVENTS, source })
    }
}

/// Columns of `history.csv` that are of no support.
const ENERGY_COLUMNS: [&str; 4] = ["kinetic_energy_j", "gravity_energy_j", "stretch_energy_j", "bending_energy_j"];
const ROBOT_COLUMNS: [&str; 5] = ["robot_x_m", "robot_y_m", "robot_pitch_deg", "robot_speed_m_per_s", "robot_thrust_n"];

fn extras(s: &Solution) -> impl Iterator<Item = (&'static str, f64)> {
    let e = s.energy;
    let energies = [e.kinetic_j, e.gravity_j, e.stretch_j, e.bending_j];
    let robot = s.robot.map(|r| [r.x_m, r.y_m, r.pitch_deg, r.speed_m_per_s, r.thrust_n]);
    ENERGY_COLUMNS.into_iter().zip(energies).chain(ROBOT_COLUMNS.into_iter().zip(robot.into_iter().flatten()))
}

const NODE_COLUMNS: [&str; 11] = [
    "time_s",
    "cable",
    "arc_length_m",
    "x_m",
    "y_m",
    "vx_m_per_s",
    "vy_m_per_s",
    "tension_n",
    "strain",
    "stress_pa",
    "curvature_per_m",
];
const EVENT_COLUMNS: [&str; 7] = ["time_s", "kind", "cable", "arc_length_m", "value", "limit", "message"];

fn node_values(n: &Node) -> [f64; 9] {
    [n.arc_length_m, n.x_m, n.y_m, n.vx_m_per_s, n.vy_m_per_s, n.tension_n, n.strain, n.stress_pa, n.curvature_per_m]
}

/// Rust prints the fewest digits that read back to the same f64.
fn number<W: Write>(to: &mut csv::Writer<W>, text: &mut String, value: f64) -> csv::Result<()> {
    use std::fmt::Write as _;
    text.clear();
    // Writing to a String cannot fail.
    let _ = write!(text, "{value:?}");
    to.write_field(text.as_bytes())
}

fn end_row<W: Write>(to: &mut csv::Writer<W>) -> csv::Result<()> {
    to.write_record(None::<&[u8]>)
}

fn io_error(table: &'static str, e: csv::Error) -> WriteError {
    let source = match e.into_kind() {
        csv::ErrorKind::Io(source) => source,
        other => std::io::Error::other(format!("{other:?}")),
    };
    WriteError::Io { table, source }
}

fn check_finite(s: &Solution) -> Result<(), WriteError> {
    let bad = |table, column: String| WriteError::NonFinite { table, column, time_s: s.time_s };
    for c in &s.cables {
        for (i, n) in c.nodes.iter().enumerate() {
            if let Some(k) = node_values(n).iter().position(|v| !v.is_finite()) {
                return Err(bad(NODES, format!("{} of node {i} of cable `{}`", NODE_COLUMNS[k + 2], c.name)));
            }
        }
        for r in &c.supports {
            if !(r.reaction_x_n.is_finite() && r.reaction_y_n.is_finite()) {
                return Err(bad(HISTORY, format!("the reaction of support `{}`", r.name)));
            }
        }
    }
    if let Some((column, _)) = extras(s).find(|(_, value)| !value.is_finite()) {
        return Err(bad(HISTORY, column.to_owned()));
    }
    for w in &s.warnings {
        if ![w.arc_length_m, w.value, w.limit].iter().all(|v| v.is_finite()) {
            return Err(bad(EVENTS, format!("a number of the warning `{}`", w.message)));
        }
    }
    if s.time_s.is_finite() { Ok(()) } else { Err(bad(HISTORY, "time_s".to_owned())) }
}

fn reader<R: Read>(from: R) -> csv::Reader<R> {
    csv::ReaderBuilder::new().from_reader(from)
}

fn row_error(table: &'static str, line: u64, what: impl ToString) -> ReadError {
    ReadError::Row { table, line, what: what.to_string() }
}

fn parse(table: &'static str, record: &csv::StringRecord, k: usize, column: &str) -> Result<f64, ReadError> {
    let line = record.position().map_or(1, csv::Position::line);
    let text = record.get(k).ok_or_else(|| row_error(table, line, format!("column {column} is missing")))?;
    match text.trim().parse::<f64>() {
        Ok(v) if v.is_finite() => Ok(v),
        _ => Err(row_error(table, line, format!("{column} is `{text}`, not a finite number"))),
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
            Err(e) => return Err(row_error(table, line, e)),
        }
    }
    Ok(())
}

fn expect_columns<R: Read>(table: &'static str, from: &mut csv::Reader<R>, expected: &[&str]) -> Result<(), ReadError> {
    let found = from.headers().map_err(|e| row_error(table, 1, e))?;
    match expected.iter().enumerate().find(|(k, name)| found.get(*k) != Some(**name)) {
        None => Ok(()),
        Some((k, name)) => Err(row_error(table, 1, format!("column {} must be `{name}`", k + 1))),
    }
}

/// Reads `nodes.csv`.
///
/// # Errors
/// Where it is not such a table.
pub fn read_nodes(from: impl Read) -> Result<Vec<NodeRow>, ReadError> {
    let mut from = reader(from);
    expect_columns(NODES, &mut from, &NODE_COLUMNS)?;
    let mut out = Vec::new();
    rows(NODES, &mut from, |r| {
        let mut v = [0.0; 9];
        for (k, v) in v.iter_mut().enumerate() {
            *v = parse(NODES, r, k + 2, NODE_COLUMNS[k + 2])?;
        }
        let [arc_length_m, x_m, y_m, vx_m_per_s, vy_m_per_s, tension_n, strain, stress_pa, curvature_per_m] = v;
        out.push(NodeRow {
            time_s: parse(NODES, r, 0, "time_s")?,
            cable: r.get(1).unwrap_or_default().to_owned(),
            node: Node {
                arc_length_m,
                x_m,
                y_m,
                vx_m_per_s,
                vy_m_per_s,
                tension_n,
                strain,
                stress_pa,
                curvature_per_m,
                ..Node::default()
            },
        });
        Ok(())
    })?;
    Ok(out)
}

/// Reads `events.csv`.
///
/// # Errors
/// Where it is not such a table.
pub fn read_events(from: impl Read) -> Result<Vec<Event>, ReadError> {
    let mut from = reader(from);
    expect_columns(EVENTS, &mut from, &EVENT_COLUMNS)?;
    let mut out = Vec::new();
    rows(EVENTS, &mut from, |r| {
        let line = r.position().map_or(1, csv::Position::line);
        out.push(Event {
            time_s: parse(EVENTS, r, 0, "time_s")?,
            kind: r
                .get(1)
                .and_then(WarningKind::from_name)
                .ok_or_else(|| row_error(EVENTS, line, format!("unknown kind `{}`", r.get(1).unwrap_or_default())))?,
            cable: r.get(2).unwrap_or_default().to_owned(),
            arc_length_m: parse(EVENTS, r, 3, "arc_length_m")?,
            value: parse(EVENTS, r, 4, "value")?,
            limit: parse(EVENTS, r, 5, "limit")?,
            message: r.get(6).unwrap_or_default().to_owned(),
        });
        Ok(())
    })?;
    Ok(out)
}

/// Reads `history.csv`.
///
/// # Errors
/// Where it is not such a table.
pub fn read_history(from: impl Read) -> Result<HistoryTable, ReadError> {
    let mut from = reader(from);
    expect_columns(HISTORY, &mut from, &["time_s", "max_tension_n", "max_tension_arc_length_m"])?;
    let header = from.headers().map_err(|e| row_error(HISTORY, 1, e))?.clone();
    let mut table = HistoryTable::default();
    // Reactions come in pairs of columns: x, y of each support. Then the extras, which older tables lack.
    let mut k = 3;
    while k < header.len() {
        let name = header.get(k).unwrap_or_default();
        if let Some(known) = ENERGY_COLUMNS.into_iter().chain(ROBOT_COLUMNS).find(|c| *c == name) {
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
            _ => return Err(row_error(HISTORY, 1, format!("column {} is not a support's reaction", k + 1))),
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

#[cfg(test)]
#[path = "tables_tests.rs"]
mod tests;
