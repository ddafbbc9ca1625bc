//! A series is a line of points, thinned to what a screen can show and read between its points.

use egui::Color32;
use egui_plot::LineStyle;

use crate::render::colour::LINES;

/// A named line; x ascending, SI values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// In the legend.
    pub name: String,
    /// x and value.
    pub points: Vec<[f64; 2]>,
    /// If samples are denser than columns of the screen: x with the least and greatest of each
    /// column, and the points are its means. Else empty.
    pub band: Vec<[f64; 3]>,
    /// It is of this held run, and drawn in its colour and dashed.
    pub reference: Option<usize>,
}

impl Series {
    /// Least and greatest value of the column at x; None where the line has no band.
    #[must_use]
    pub fn range_at(&self, x: f64) -> Option<[f64; 2]> {
        let k = self.band.partition_point(|b| b[0] <= x).checked_sub(1)?;
        self.band.get(k).map(|b| [b[1], b[2]])
    }
}

/// Thins points to at most two a column, keeping each column's least and greatest value, so that no
/// peak is lost.
#[must_use]
pub fn thin(points: impl ExactSizeIterator<Item = [f64; 2]>, columns: usize) -> Vec<[f64; 2]> {
    let per_column = points.len().div_ceil(columns.max(1));
    if per_column <= 2 {
        return points.collect();
    }
    let mut out = Vec::with_capacity(2 * columns);
    let mut column: Option<[[f64; 2]; 2]> = None;
    for (k, p) in points.enumerate() {
        column = Some(match column {
            None => [p, p],
            Some([low, high]) => [if p[1] < low[1] { p } else { low }, if p[1] > high[1] { p } else { high }],
        });
        if (k + 1) % per_column == 0 {
            push(&mut out, column.take());
        }
    }
    push(&mut out, column);
    out
}

/// The means of columns of equal width, and x with the least and greatest of each. `extremes` and
/// `samples` are in order of x; columns that have none of either are left out.
#[must_use]
pub fn envelope(
    extremes: impl Iterator<Item = [f64; 2]>,
    samples: impl Iterator<Item = [f64; 2]>,
    [left, right]: [f64; 2],
    columns: usize,
) -> (Vec<[f64; 2]>, Vec<[f64; 3]>) {
    /// The bounds and sums of a column.
    #[derive(Clone, Copy)]
    struct ColumnSums {
        low: f64,
        high: f64,
        sum: [f64; 2],
        count: f64,
    }
    let empty = ColumnSums { low: f64::INFINITY, high: f64::NEG_INFINITY, sum: [0.0; 2], count: 0.0 };
    let mut all = vec![empty; columns.max(1) + 1];
    let width = (right - left) / columns.max(1) as f64;
    let last = all.len() - 1;
    // Columns stay where they are while the part in view moves on: bands do not flicker.
    let left = if width > 0.0 { (left / width).floor() * width } else { left };
    let column = |x: f64| if width > 0.0 { (((x - left) / width).max(0.0) as usize).min(last) } else { 0 };
    for [x, y] in extremes.filter(|p| p[1].is_finite()) {
        let c = &mut all[column(x)];
        (c.low, c.high) = (c.low.min(y), c.high.max(y));
    }
    for [x, y] in samples.filter(|p| p[1].is_finite()) {
        let c = &mut all[column(x)];
        (c.sum, c.count) = ([c.sum[0] + x, c.sum[1] + y], c.count + 1.0);
    }
    let known = all.into_iter().filter(|c| c.count > 0.0 && c.low <= c.high);
    known.map(|c| (c.sum.map(|s| s / c.count), c)).map(|(mean, c)| (mean, [mean[0], c.low, c.high])).unzip()
}

/// Appends the extremes of a column, in the order of time.
fn push(out: &mut Vec<[f64; 2]>, column: Option<[[f64; 2]; 2]>) {
    let Some([low, high]) = column else { return };
    let (first, second) = if low[0] <= high[0] { (low, high) } else { (high, low) };
    out.push(first);
    if second != first {
        out.push(second);
    }
}

/// The value at x, linear between points; None outside them.
#[must_use]
pub fn value_at(points: &[[f64; 2]], x: f64) -> Option<f64> {
    let k = points.partition_point(|p| p[0] <= x);
    let a = points.get(k.checked_sub(1)?)?;
    match points.get(k) {
        Some(b) => Some(a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0])),
        None => (a[0] == x).then_some(a[1]),
    }
}

/// Colour and style of the `k`-th line of a graph.
pub fn line_style(line: &Series, k: usize) -> (Color32, LineStyle) {
    match line.reference {
        Some(reference) => (LINES[reference % LINES.len()], LineStyle::dashed_loose()),
        None => (LINES[k % LINES.len()], LineStyle::Solid),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_every_peak_and_the_order() {
        let wave: Vec<[f64; 2]> = (0..18_000)
            .map(|i| {
                let x = f64::from(i);
                [x, if i == 7_777 { 1e3 } else { (x * 0.01).sin() }]
            })
            .collect();
        let thinned = thin(wave.iter().copied(), 600);
        assert!(thinned.len() <= 1200, "{}", thinned.len());
        assert!(thinned.contains(&[7_777.0, 1e3]));
        assert!(thinned.windows(2).all(|w| w[0][0] < w[1][0]));
        assert_eq!(thin(wave[..500].iter().copied(), 600).len(), 500);
        assert!(thin([].into_iter(), 0).is_empty());
    }

    #[test]
    fn an_envelope_holds_every_peak_and_the_means_of_its_columns() {
        let wave: Vec<[f64; 2]> =
            (0..18_000).map(f64::from).map(|x| [x, if x == 7_777.0 { 1e3 } else { (x * 0.7).sin() }]).collect();
        let ends = [0.0, 18_000.0];
        let (means, band) = envelope(wave.iter().copied(), wave.iter().copied(), ends, 300);
        assert_eq!((means.len(), band.len()), (300, 300));
        assert!(band.iter().any(|b| b[2] == 1e3) && band.windows(2).all(|w| w[0][0] < w[1][0]));
        for (k, (mean, b)) in means.iter().zip(&band).enumerate() {
            let column = &wave[60 * k..60 * k + 60];
            let expected = column.iter().map(|p| p[1]).sum::<f64>() / 60.0;
            assert!((mean[1] - expected).abs() < 1e-9 && b[1] <= mean[1] && mean[1] <= b[2], "column {k}");
        }
        let none = envelope([].into_iter(), [].into_iter(), [0.0; 2], 0);
        assert!(none.0.is_empty() && none.1.is_empty());
    }

    #[test]
    fn values_are_read_between_points_only() {
        let points = [[0.0, 1.0], [2.0, 5.0], [3.0, 0.0]];
        assert_eq!(value_at(&points, 0.0), Some(1.0));
        assert_eq!(value_at(&points, 1.0), Some(3.0));
        assert_eq!(value_at(&points, 3.0), Some(0.0));
        assert_eq!(value_at(&points, 3.1), None);
        assert_eq!(value_at(&points, -0.1), None);
        assert_eq!(value_at(&[], 0.0), None);
    }
}
