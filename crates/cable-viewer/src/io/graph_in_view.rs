//! The part of a graph that is in view is what goes to a file.

use crate::record::series::Series;

/// Part of a graph that is in view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GraphInView {
    /// Its title.
    pub title: String,
    /// Quantity along the axis to the right: name with unit for people, and for a column.
    pub across: [String; 2],
    /// Quantity along the axis upwards, the same, and how many SI units its unit holds.
    pub up: [String; 2],
    /// SI units in one unit shown, across and up.
    pub si: [f64; 2],
    /// Left, bottom, right, top in the units shown.
    pub bounds: [f64; 4],
    /// The lines, every sample, SI.
    pub lines: Vec<Series>,
    /// Place, least and greatest with less and more friction, SI; empty: nobody asked.
    pub ribbon: Vec<[f64; 3]>,
    /// Service and breaking limit, SI; those that are not finite or not in view are left out.
    pub limits: [f64; 2],
}

/// The name of the ribbon.
pub const RIBBON: &str = "with less and more friction";

impl GraphInView {
    /// The places of the ribbon in the units shown, as far as they are known; none of fewer than
    /// two.
    pub(crate) fn known_ribbon(&self) -> Vec<[f64; 3]> {
        let [across, up] = self.si;
        let shown = self.ribbon.iter().map(|r| [r[0] / across, r[1] / up, r[2] / up]);
        let known: Vec<[f64; 3]> = shown.filter(|r| r.iter().all(|v| v.is_finite())).collect();
        if known.len() < 2 { Vec::new() } else { known }
    }
}

/// Points of a line in view.
pub(crate) fn visible<'a>(line: &'a Series, graph: &GraphInView) -> &'a [[f64; 2]] {
    let [left, right] = [graph.bounds[0], graph.bounds[2]].map(|x| x * graph.si[0]);
    let from = line.points.partition_point(|p| p[0] < left);
    let to = line.points.partition_point(|p| p[0] <= right).max(from);
    line.points.get(from..to).unwrap_or_default()
}

/// A graph for tests: two lines, one of them with a pole.
#[cfg(test)]
pub(crate) fn sample() -> GraphInView {
    let line = |name: &str, f: fn(f64) -> f64| Series {
        name: name.to_owned(),
        points: (0..100).map(|k| f64::from(k) / 10.0).map(|x| [x, f(x)]).collect(),
        ..Series::default()
    };
    GraphInView {
        title: "Over <time>".to_owned(),
        across: ["Time, s".to_owned(), "time_s".to_owned()],
        up: ["Tension, kN".to_owned(), "tension_n".to_owned()],
        si: [1.0, 1e3],
        bounds: [2.0, 0.0, 5.0, 1.0],
        limits: [800.0, 10e3],
        ribbon: Vec::new(),
        lines: vec![line("Maximum", |x| 100.0 * x.sin() + 0.1), line("At left, end", |x| 1.0 / (x - 3.0))],
    }
}
