//! The table `scenes.csv`, one line an answer, is written by the measurement and read again to draw
//! it.

use std::error::Error;
use std::path::Path;

use crate::chart::{Panel, Series};
use crate::compare::{Question, Reference, Row};
use crate::dots::{Dot, Line, Plot};
use cable_core::Model;

/// Colours and marks of the models.
pub const MARKS: [(Model, &str, u32); 3] =
    [(Model::Fem, "#0072B2", 0), (Model::MassSpring, "#D55E00", 4), (Model::Spans, "#009E73", 3)];

/// Elements in the dot plot.
const DOT_SEGMENTS: &str = "100";

/// Errors below this are drawn at it.
const LEAST_ERROR: f64 = 1e-12;

const HEADER: [&str; 9] =
    ["scene", "question", "model", "segments", "error", "cost_s", "stated_error", "reference", "reference_uncertainty"];

/// One line of the table, as text: what is drawn is what is in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Record([String; 9]);

impl Record {
    /// A measured answer.
    #[must_use]
    pub fn of(row: &Row, question: Question, reference: &Reference) -> Self {
        Self([
            row.scene.to_owned(),
            question.name().to_owned(),
            row.model.to_string(),
            row.segments.map(|n| n.to_string()).unwrap_or_default(),
            format!("{:.3e}", row.error),
            format!("{:.3e}", row.cost_s),
            row.said.map(|e| format!("{e:.3e}")).unwrap_or_default(),
            reference.by.clone(),
            format!("{:.1e}", reference.uncertainty),
        ])
    }

    fn scene(&self) -> &str {
        &self.0[0]
    }

    fn is_of(&self, model: Model) -> bool {
        self.0[2] == model.name()
    }

    /// Returns whether it is the very answer that it would be compared with.
    fn is_its_reference(&self) -> bool {
        self.0[7] == self.0[2] || self.0[7] == format!("{}, {} elements", self.0[2], self.0[3])
    }

    /// Returns whether it is in the dot plot.
    fn is_shown(&self) -> bool {
        self.0[3] == DOT_SEGMENTS || self.0[3].is_empty()
    }

    fn figure(&self, column: usize) -> f64 {
        self.0[column].parse().unwrap_or(f64::NAN)
    }

    /// Error, not below what is drawn.
    fn error(&self) -> f64 {
        let error = self.figure(4);
        if error < LEAST_ERROR { LEAST_ERROR } else { error }
    }

    fn cost_s(&self) -> f64 {
        self.figure(5)
    }
}

/// Writes the table.
///
/// # Errors
/// When the file cannot be written.
pub fn write(path: &Path, records: &[Record]) -> Result<(), Box<dyn Error>> {
    let mut csv = csv::Writer::from_path(path)?;
    csv.write_record(HEADER)?;
    for r in records {
        csv.write_record(&r.0)?;
    }
    csv.flush()?;
    Ok(())
}

/// Reads the table.
///
/// # Errors
/// When the file cannot be read or has other columns.
pub fn read(path: &Path) -> Result<Vec<Record>, Box<dyn Error>> {
    let mut csv = csv::Reader::from_path(path)?;
    if csv.headers()? != HEADER.as_slice() {
        return Err(format!("{} has other columns", path.display()).into());
    }
    let record = |line: csv::StringRecord| Record(std::array::from_fn(|k| line.get(k).unwrap_or_default().to_owned()));
    csv.records().map(|line| Ok(record(line?))).collect()
}

/// The dot plot: every scene with 100 elements.
#[must_use]
pub fn plot(records: &[Record]) -> Plot {
    Plot {
        title: "Every scene, with 100 elements where a model has any: error and cost (further left is better)"
            .to_owned(),
        legend: MARKS.map(|(m, colour, corners)| (m.to_string(), colour, corners)).into(),
        columns: [("error of forces (relative)", (-10, 0)), ("cost of an answer, wall time (s)", (-5, 1))],
        lines: scenes(records).iter().filter_map(|rows| line(rows)).collect(),
    }
}

/// A panel of error over cost for each scene.
#[must_use]
pub fn ladders(records: &[Record]) -> Vec<Panel> {
    scenes(records).iter().filter_map(|rows| ladder(rows)).collect()
}

/// The lines of each scene, which stand together.
fn scenes(records: &[Record]) -> Vec<&[Record]> {
    records.chunk_by(|a, b| a.scene() == b.scene()).collect()
}

fn line(rows: &[Record]) -> Option<Line> {
    let first = rows.first()?;
    let pick = |read: fn(&Record) -> f64, costs: bool| {
        rows.iter()
            .filter(|r| r.is_shown() && (costs || !r.is_its_reference()))
            .filter_map(|r| MARKS.iter().find(|m| r.is_of(m.0)).map(|m| (r, m)))
            .map(|(r, m)| Dot { value: read(r), colour: m.1, corners: m.2 })
            .collect()
    };
    Some(Line {
        name: first.scene().to_owned(),
        note: format!("{}, against {}", first.0[1], first.0[7]),
        blind_to: first.figure(8),
        dots: [pick(Record::error, false), pick(Record::cost_s, true)],
    })
}

fn ladder(rows: &[Record]) -> Option<Panel> {
    let series = MARKS.map(|(model, colour, corners)| Series {
        name: if model == Model::Spans { model.to_string() } else { format!("{model}, 25 to 400 elements") },
        colour,
        corners,
        joined: true,
        points: rows
            .iter()
            .filter(|r| r.is_of(model) && r.error().is_finite() && !r.is_its_reference())
            .map(|r| (r.cost_s(), r.error()))
            .collect(),
    });
    Some(Panel {
        title: rows.first()?.scene().to_owned(),
        x_label: "cost of an answer, wall time (s)",
        y_label: "error of forces (relative)",
        x_decades: (-6, 2),
        y_decades: (-12, 0),
        series: series.into(),
    })
}
