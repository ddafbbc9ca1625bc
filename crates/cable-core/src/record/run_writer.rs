//! The three tables of a run are written in whole instants, `history.csv` last.

use std::io::Write;

use super::columns::{EVENT_COLUMNS, EVENTS, HISTORY, NODES, RobotColumns, extras, history_columns};
use super::node_choice::{NodeChoice, NodeColumns, NodeInterval, node_values};
use super::table_error::{WriteError, WrittenNumber};
use crate::scene::Scene;
use crate::solution::{Solution, Warning, WarningKind};

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

/// Tells whether an instant has rows in the table of nodes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum NodeRows {
    Written,
    LeftOut,
}

/// Kind, cable and the time since when, in bits, of a warning that lasts.
type LastingWarning = (WarningKind, String, Option<u64>);

impl<W: Write> std::fmt::Debug for RunWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RunWriter").field("node_choice", &self.node_choice).finish_non_exhaustive()
    }
}

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
        let nodes = if due.is_some() { NodeRows::Written } else { NodeRows::LeftOut };
        self.append(solution, nodes)?;
        self.node_interval = due.or(self.node_interval);
        Ok(())
    }

    /// Does the same as [`Self::push`] for the last time of a run: its nodes are written whatever
    /// the interval, unless nodes are never written.
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn push_last(&mut self, solution: &Solution) -> Result<(), WriteError> {
        let never = self.node_choice.interval == NodeInterval::Never;
        self.append(solution, if never { NodeRows::LeftOut } else { NodeRows::Written })
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

    /// Writes the rows of an instant; nothing is written if a number is not finite.
    fn append(&mut self, solution: &Solution, node_rows_due: NodeRows) -> Result<(), WriteError> {
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
        if node_rows_due == NodeRows::Written {
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

fn io_error(table: &'static str, e: csv::Error) -> WriteError {
    let source = match e.into_kind() {
        csv::ErrorKind::Io(source) => source,
        other => std::io::Error::other(format!("{other:?}")),
    };
    WriteError::Io { table, source }
}

/// Returns an error if the answer has a number that is not finite.
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
