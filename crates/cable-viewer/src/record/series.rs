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
    /// It is of this held run, and drawn in its colour and dashed.
    pub reference: Option<usize>,
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
        Some(held) => (LINES[held % LINES.len()], LineStyle::dashed_loose()),
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
