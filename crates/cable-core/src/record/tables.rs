//! This file writes and reads the three tables of a run.

use std::io::{Read, Write};

use serde::{Deserialize, Serialize};

use super::choice::{NodeChoice, NodeColumns, NodeInterval, node_of, node_values};
use super::whole::WholeRecords;
use crate::scene::Scene;
use crate::solution::{Solution, Warning, WarningCause, WarningKind};

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

/// The columns of `history.csv` on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotColumns {
    /// The scene has a robot that can move.
    Written,
    /// It has none.
    LeftOut,
}

impl RobotColumns {
    /// Those of a run that has this answer.
    #[must_use]
    pub fn of(solution: &Solution) -> Self {
        if solution.robot.is_some() { Self::Written } else { Self::LeftOut }
    }
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

/// Most rows read of a table: 1e7 node rows are 1 GB of memory. Fewer would refuse an hour at 60 Hz
/// of 40 nodes; more would let a hostile file exhaust the machine.
const MAX_ROWS: usize = 10_000_000;

pub(super) const HISTORY: &str = "history.csv";
pub(super) const NODES: &str = "nodes.csv";
pub(super) const EVENTS: &str = "events.csv";

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

/// Writes a run's tables as it goes, in whole instants: the rows of an instant go out as one write
/// a table, `history.csv` last. So an instant with a row there is whole in the other tables too,
/// and what was cut off anywhere is whole up to the last such row (`super::read_run`).
pub struct RunWriter<W: Write> {
    history: W,
    nodes: W,
    events: W,
    node_choice: NodeChoice,
    /// The interval of `node_choice` in which node rows were last written.
    node_interval: Option<f64>,
    /// Columns of `history.csv`; none before the headers are written.
    columns: Vec<String>,
    active: Vec<LastingWarning>,
}

/// Kind, cable and the time since when, in bits, of a warning that lasts.
type LastingWarning = (WarningKind, String, Option<u64>);

impl<W: Write> RunWriter<W> {
    /// Over three places to write to.
    pub fn new(history: W, nodes: W, events: W) -> Self {
        Self {
            history,
            nodes,
            events,
            node_choice: NodeChoice::default(),
            node_interval: None,
            columns: Vec::new(),
            active: Vec::new(),
        }
    }

    /// With a choice of what goes into `nodes.csv`.
    #[must_use]
    pub(crate) fn with_nodes(self, node_choice: NodeChoice) -> Self {
        Self { node_choice, ..self }
    }

    /// Appends one time. A warning becomes an event when it begins, with the time it began at, not
    /// again while it lasts.
    ///
    /// # Errors
    /// When a number is not finite (nothing is written) or the place refuses. A place that takes
    /// back what it was given of this time can be written on.
    pub fn push(&mut self, solution: &Solution) -> Result<(), WriteError> {
        let due = self.node_choice.due(solution.time_s, self.node_interval);
        self.append(solution, due.is_some())?;
        self.node_interval = due.or(self.node_interval);
        Ok(())
    }

    /// As [`Self::push`], for the last time of a run: its nodes are written whatever the interval,
    /// unless they never are.
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn push_last(&mut self, solution: &Solution) -> Result<(), WriteError> {
        self.append(solution, self.node_choice.interval != NodeInterval::Never)
    }

    /// Writes the headers alone, so that a run which ends before its first instant has tables: of a
    /// scene, whose robot is reported or not.
    ///
    /// # Errors
    /// When the place refuses.
    pub fn begin(&mut self, scene: &Scene, robot: RobotColumns) -> Result<(), WriteError> {
        let supports = scene.cables.iter().map(|c| (c.name.as_str(), c.supports.iter().map(|s| s.name.as_str())));
        let columns = history_columns(supports, scene.cables.len(), robot);
        let mut rows = [HISTORY, NODES, EVENTS].map(Rows::new);
        self.headers(&mut rows, &columns)?;
        self.write(rows)?;
        self.columns = columns;
        Ok(())
    }

    fn headers(&self, [history, nodes, events]: &mut [Rows; 3], columns: &[String]) -> Result<(), WriteError> {
        history.record(columns)?;
        nodes.record(&self.node_choice.header())?;
        events.record(&EVENT_COLUMNS)
    }

    fn append(&mut self, solution: &Solution, with_nodes: bool) -> Result<(), WriteError> {
        check_finite(solution)?;
        let mut rows = [HISTORY, NODES, EVENTS].map(Rows::new);
        let supports = solution.cables.iter().map(|c| (c.name.as_str(), c.supports.iter().map(|s| s.name.as_str())));
        let columns = history_columns(supports, solution.cables.len(), RobotColumns::of(solution));
        if self.columns.is_empty() {
            self.headers(&mut rows, &columns)?;
        } else if self.columns != columns {
            return Err(WriteError::Columns { table: HISTORY, time_s: solution.time_s });
        }
        let [history, nodes, events] = &mut rows;
        history_row(history, solution)?;
        if with_nodes {
            node_rows(nodes, solution, self.node_choice.columns)?;
        }
        for w in began(solution, &self.active) {
            // A warning that began later than its own instant did so by round-off: that instant's
            // time is a multiple of an interval.
            event_row(events, w.since_s.map_or(solution.time_s, |t| t.min(solution.time_s)), w)?;
        }
        self.write(rows)?;
        self.columns = columns;
        self.active = solution.warnings.iter().map(active).collect();
        Ok(())
    }

    fn write(&mut self, [history, nodes, events]: [Rows; 3]) -> Result<(), WriteError> {
        nodes.write(&mut self.nodes)?;
        events.write(&mut self.events)?;
        history.write(&mut self.history)
    }

    /// The places written to: of `history.csv`, `nodes.csv` and `events.csv`.
    pub fn places(&mut self) -> [&mut W; 3] {
        [&mut self.history, &mut self.nodes, &mut self.events]
    }

    /// Hands everything to the system.
    ///
    /// # Errors
    /// When the place refuses (behind a buffer a full disk shows only here).
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.history.flush().map_err(|source| WriteError::Io { table: HISTORY, source })?;
        self.nodes.flush().map_err(|source| WriteError::Io { table: NODES, source })?;
        self.events.flush().map_err(|source| WriteError::Io { table: EVENTS, source })
    }
}

/// The rows that one instant adds to a table.
struct Rows {
    table: &'static str,
    csv: csv::Writer<Vec<u8>>,
    number: String,
}

impl Rows {
    fn new(table: &'static str) -> Self {
        Self { table, csv: csv::Writer::from_writer(Vec::new()), number: String::new() }
    }

    fn record<T: AsRef<[u8]>>(&mut self, fields: &[T]) -> Result<(), WriteError> {
        self.csv.write_record(fields).map_err(|e| io_error(self.table, e))
    }

    fn text(&mut self, text: &str) -> Result<(), WriteError> {
        self.csv.write_field(text).map_err(|e| io_error(self.table, e))
    }

    /// Rust prints the fewest digits that read back to the same f64.
    fn number(&mut self, value: f64) -> Result<(), WriteError> {
        use std::fmt::Write as _;
        self.number.clear();
        // Writing to a String cannot fail.
        let _ = write!(self.number, "{value:?}");
        self.csv.write_field(self.number.as_bytes()).map_err(|e| io_error(self.table, e))
    }

    fn end(&mut self) -> Result<(), WriteError> {
        self.csv.write_record(None::<&[u8]>).map_err(|e| io_error(self.table, e))
    }

    /// Hands them over at once, so that no row is cut where a buffer ends.
    fn write(self, to: &mut impl Write) -> Result<(), WriteError> {
        let failed = |source| WriteError::Io { table: self.table, source };
        let bytes = self.csv.into_inner().map_err(|e| failed(e.into_error()))?;
        if bytes.is_empty() { Ok(()) } else { to.write_all(&bytes).map_err(failed) }
    }
}

/// Columns of `history.csv`, from the names of the cables, and of their supports.
fn history_columns<'a>(
    cables: impl Iterator<Item = (&'a str, impl Iterator<Item = &'a str>)>,
    count: usize,
    robot: RobotColumns,
) -> Vec<String> {
    let mut columns: Vec<String> = HISTORY_COLUMNS.map(String::from).to_vec();
    for (cable, supports) in cables {
        for support in supports {
            let name = if count > 1 { format!("{cable}.{support}") } else { support.to_owned() };
            columns.push(format!("{name}.reaction_x_n"));
            columns.push(format!("{name}.reaction_y_n"));
        }
    }
    columns.extend(ENERGY_COLUMNS.into_iter().chain(PEAK_COLUMNS).map(String::from));
    columns.extend(ROBOT_COLUMNS.map(String::from).into_iter().filter(|_| robot == RobotColumns::Written));
    columns
}

fn history_row(rows: &mut Rows, solution: &Solution) -> Result<(), WriteError> {
    let top = solution.max_tension();
    for value in [solution.time_s, top.tension_n, top.arc_length_m] {
        rows.number(value)?;
    }
    for s in solution.cables.iter().flat_map(|c| &c.supports) {
        rows.number(s.reaction_x_n)?;
        rows.number(s.reaction_y_n)?;
    }
    for (_, value) in extras(solution) {
        rows.number(value)?;
    }
    rows.end()
}

fn node_rows(rows: &mut Rows, solution: &Solution, columns: NodeColumns) -> Result<(), WriteError> {
    for c in &solution.cables {
        for n in &c.nodes {
            rows.number(solution.time_s)?;
            rows.text(&c.name)?;
            for value in columns.pick(node_values(n)) {
                rows.number(value)?;
            }
            rows.end()?;
        }
    }
    Ok(())
}

fn active(w: &Warning) -> LastingWarning {
    (w.kind, w.cable.clone(), w.since_s.map(f64::to_bits))
}

/// Warnings of an instant that did not last already.
fn began<'a>(solution: &'a Solution, lasting: &'a [LastingWarning]) -> impl Iterator<Item = &'a Warning> {
    solution.warnings.iter().filter(move |w| {
        let since = w.since_s.map(f64::to_bits);
        !lasting.iter().any(|(kind, cable, began)| (*kind, *began) == (w.kind, since) && *cable == w.cable)
    })
}

fn event_row(rows: &mut Rows, time_s: f64, w: &Warning) -> Result<(), WriteError> {
    rows.number(time_s)?;
    rows.text(w.kind.name())?;
    rows.text(&w.cable)?;
    for value in [w.arc_length_m, w.value, w.limit] {
        rows.number(value)?;
    }
    rows.text(&w.to_string())?;
    // Figures of the cause are numbers, and keys are strings: this cannot fail.
    rows.text(&serde_json::to_string(&w.cause).unwrap_or_default())?;
    rows.end()
}

/// Columns of `history.csv` before those of the supports.
const HISTORY_COLUMNS: [&str; 3] = ["time_s", "max_tension_n", "max_tension_arc_length_m"];

/// Columns of `history.csv` that are of no support.
const ENERGY_COLUMNS: [&str; 4] = ["kinetic_energy_j", "gravity_energy_j", "stretch_energy_j", "bending_energy_j"];
/// The greatest tension of any inner step since the row before, and the greatest mean over the
/// breaking time; at rest and without inertia that of the instant.
const PEAK_COLUMNS: [&str; 2] = ["peak_tension_n", "held_tension_n"];
const ROBOT_COLUMNS: [&str; 5] = ["robot_x_m", "robot_y_m", "robot_pitch_deg", "robot_speed_m_per_s", "robot_thrust_n"];

fn extras(s: &Solution) -> impl Iterator<Item = (&'static str, f64)> {
    let e = s.energy;
    let energies = [e.kinetic_j, e.gravity_j, e.stretch_j, e.bending_j];
    let robot = s.robot.map(|r| [r.x_m, r.y_m, r.pitch_deg, r.speed_m_per_s, r.thrust_n]);
    let peaks = s.peaks();
    let peaks = [peaks.greatest.tension_n, peaks.held.tension_n];
    let always = ENERGY_COLUMNS.into_iter().zip(energies).chain(PEAK_COLUMNS.into_iter().zip(peaks));
    always.chain(ROBOT_COLUMNS.into_iter().zip(robot.into_iter().flatten()))
}

const EVENT_COLUMNS: [&str; 8] = ["time_s", "kind", "cable", "arc_length_m", "value", "limit", "message", "cause"];
/// Columns of tables that were written before causes were.
const OLD_EVENT_COLUMNS: usize = 7;

fn io_error(table: &'static str, e: csv::Error) -> WriteError {
    let source = match e.into_kind() {
        csv::ErrorKind::Io(source) => source,
        other => std::io::Error::other(format!("{other:?}")),
    };
    WriteError::Io { table, source }
}

fn check_finite(s: &Solution) -> Result<(), WriteError> {
    let bad = |table, number| WriteError::NonFinite { table, number: Box::new(number), time_s: s.time_s };
    for c in &s.cables {
        for (i, n) in c.nodes.iter().enumerate() {
            if let Some(k) = node_values(n).iter().position(|v| !v.is_finite()) {
                let column = NodeColumns::NAMES.get(k).copied().unwrap_or_default();
                return Err(bad(NODES, WrittenNumber::Node { column, node: i, cable: c.name.clone() }));
            }
        }
        for r in &c.supports {
            if !(r.reaction_x_n.is_finite() && r.reaction_y_n.is_finite()) {
                return Err(bad(HISTORY, WrittenNumber::Reaction { support: r.name.clone() }));
            }
        }
    }
    if let Some((column, _)) = extras(s).find(|(_, value)| !value.is_finite()) {
        return Err(bad(HISTORY, WrittenNumber::Column(column)));
    }
    for w in &s.warnings {
        if ![w.arc_length_m, w.value, w.limit].iter().all(|v| v.is_finite()) {
            return Err(bad(EVENTS, WrittenNumber::Warning(w.clone())));
        }
    }
    if s.time_s.is_finite() { Ok(()) } else { Err(bad(HISTORY, WrittenNumber::Column("time_s"))) }
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
/// ([`NodeChoice`]) are NaN.
///
/// # Errors
/// Where it is not such a table.
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
/// Where it is not such a table.
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
/// Where it is not such a table.
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
        if let Some(known) = ENERGY_COLUMNS.into_iter().chain(PEAK_COLUMNS).chain(ROBOT_COLUMNS).find(|c| *c == name) {
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

#[cfg(test)]
#[path = "tables_tests.rs"]
mod tests;
