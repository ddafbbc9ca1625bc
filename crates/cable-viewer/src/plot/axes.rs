//! The axes of a graph have a range that its data fill, and numbers that are neither cut nor too
//! many.

use std::ops::RangeInclusive;

use egui_plot::{GridInput, GridMark};

use crate::record::series::Series;
use crate::units::format::round_step;

/// A limit is kept in view once the data reach this share of it; before, it would press the data
/// flat.
const LIMIT_IN_VIEW_FROM: f64 = 0.5;
/// Free room above the data, as a share of their range.
const HEADROOM: f64 = 0.12;
/// Room (points) that half of a number with its unit takes on the horizontal axis: nearer to the
/// end it would be cut there, so it is drawn before the end instead.
const HALF_LABEL_WIDTH: f32 = 18.0;
/// Room (points) at the start of that axis in which a number would lie on the lowest one of the
/// vertical axis.
const LEFT_END_WIDTH: f32 = 5.0;

/// The unit of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisUnit {
    /// The symbol behind its numbers.
    pub symbol: &'static str,
    /// SI units in one of it.
    pub si: f64,
}

/// Lowest and highest value in view, SI.
pub(super) fn vertical_range(lines: &[Series], ribbon: &[[f64; 3]], limits: [f64; 2]) -> [f64; 2] {
    let values = || {
        let bands = lines.iter().flat_map(|l| &l.band).flat_map(|b| [b[1], b[2]]);
        let lines = lines.iter().flat_map(|l| &l.points).map(|p| p[1]);
        lines.chain(bands).chain(ribbon.iter().flat_map(|r| [r[1], r[2]])).filter(|v| v.is_finite())
    };
    let low = values().fold(0.0, f64::min);
    let greatest = values().fold(0.0, f64::max);
    let high = limits.into_iter().filter(|limit| greatest > LIMIT_IN_VIEW_FROM * limit).fold(greatest, f64::max);
    let height = if high > low { high - low } else { 1.0 };
    [if low < 0.0 { low - HEADROOM * height } else { 0.0 }, low + (1.0 + HEADROOM) * height]
}

/// Grid lines at round values, at most about `parts` of them.
pub(super) fn grid_marks(input: GridInput, parts: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let step = round_step(high - low, parts);
    // Counted, not summed up: a sum drifts, and never ends where the step is lost in the number.
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first).clamp(0.0, 100.0) as u32;
    (0..=count).map(|k| GridMark { value: (first + f64::from(k)) * step, step_size: step }).collect()
}

/// A number on an axis, with the decimals its step needs.
fn tick(mark: GridMark) -> String {
    let decimals = (-mark.step_size.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{:.decimals$}", mark.value + 0.0).replace('-', "−")
}

/// As [`tick`]; the last number of an axis has the unit, so that no line of the graph is spent on
/// it.
pub(super) fn tick_with_unit(mark: GridMark, shown: &RangeInclusive<f64>, symbol: &str) -> String {
    let last = mark.value + mark.step_size > *shown.end();
    if last { format!("{} {symbol}", tick(mark)) } else { tick(mark) }
}

/// As [`tick_with_unit`] on a horizontal axis of so many points; [`ends_across`] stand in the place
/// of numbers at its ends.
pub(super) fn tick_across(mark: GridMark, shown: &RangeInclusive<f64>, symbol: &str, width: f32) -> String {
    if end_at(mark.value, shown, width).is_some() { String::new() } else { tick_with_unit(mark, shown, symbol) }
}

/// The numbers at the ends of a horizontal axis, to be written inside of the ends: the right one
/// would be cut there, and the left one would lie on the lowest number of the other axis. `parts`:
/// as of its [`grid_marks`].
pub(super) fn ends_across(shown: RangeInclusive<f64>, parts: f64, symbol: &str, width: f32) -> [Option<String>; 2] {
    let input = GridInput { bounds: (*shown.start(), *shown.end()), base_step_size: 1.0 };
    let marks = grid_marks(input, parts);
    [(AxisEnd::Left, marks.first()), (AxisEnd::Right, marks.last())].map(|(end, mark)| {
        let mark = mark.filter(|m| end_at(m.value, &shown, width) == Some(end))?;
        Some(tick_with_unit(*mark, &shown, symbol))
    })
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum AxisEnd {
    Left,
    Right,
}

/// The end of the axis at which a label at `value` would be cut off, if any.
fn end_at(value: f64, shown: &RangeInclusive<f64>, width: f32) -> Option<AxisEnd> {
    let (start, end) = (*shown.start(), *shown.end());
    let per_point = (end - start) / f64::from(width.max(1.0));
    if value > end - f64::from(HALF_LABEL_WIDTH) * per_point {
        Some(AxisEnd::Right)
    } else {
        (value < start + f64::from(LEFT_END_WIDTH) * per_point).then_some(AxisEnd::Left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::tests::line;

    #[test]
    fn far_limits_do_not_press_the_data_flat() {
        let far = vertical_range(&[line(&[10.0, 80.0])], &[], [800.0, 10_000.0]);
        assert_eq!(far[0], 0.0);
        assert!(far[1] > 80.0 && far[1] < 100.0, "{far:?}");
        let near = vertical_range(&[line(&[10.0, 500.0])], &[], [800.0, 10_000.0]);
        assert!(near[1] > 800.0 && near[1] < 1000.0, "{near:?}");
        let wide = vertical_range(&[line(&[10.0, 80.0])], &[[0.0, 5.0, 200.0]], [800.0, 10_000.0]);
        assert!(wide[1] > 200.0, "the ribbon is in view: {wide:?}");
    }

    /// The 3.0 at the end of a cable of 3 m was cut in half by the edge of its graph; then it was
    /// left out, and the unit stood at the 2.5. The 0 at its start lay on that of the other axis.
    #[test]
    fn the_last_number_of_an_axis_is_whole_and_has_the_unit() {
        let across = |end: f64| {
            let text = |value| tick_across(GridMark { value, step_size: 0.5 }, &(0.0..=end), "m", 300.0);
            ([0.0, 2.5, 3.0].map(text), ends_across(0.0..=end, 7.0, "m", 300.0))
        };
        let three = |a: &str, b: &str, c: &str| [a.to_owned(), b.to_owned(), c.to_owned()];
        let (first, last) = (Some("0.0".to_owned()), Some("3.0 m".to_owned()));
        assert_eq!(across(3.0), (three("", "2.5", ""), [first.clone(), last]));
        assert_eq!(across(3.4), (three("", "2.5", "3.0 m"), [first, None]));
        let up = |value| tick_with_unit(GridMark { value, step_size: 50.0 }, &(0.0..=101.0), "N");
        assert_eq!([50.0, 100.0].map(up), ["50", "100 N"]);
    }

    #[test]
    fn steps_are_round_and_few() {
        for (range, parts, step) in [(10.0, 5.0, 2.0), (780.0, 4.0, 200.0), (0.003, 3.0, 0.001), (1.0, 1.0, 1.0)] {
            assert!((round_step(range, parts) / step - 1.0).abs() < 1e-9, "{range} in {parts}");
        }
        assert_eq!(round_step(f64::NAN, 3.0), 1.0);
        assert_eq!(tick(GridMark { value: 0.25, step_size: 0.05 }), "0.25");
        assert_eq!(tick(GridMark { value: -200.0, step_size: 100.0 }), "−200");
    }

    #[test]
    fn nothing_and_nonsense_still_give_a_range() {
        for lines in [vec![], vec![line(&[])], vec![line(&[f64::NAN, f64::INFINITY])], vec![line(&[0.0])]] {
            let [low, high] = vertical_range(&lines, &[], [800.0, 1e4]);
            assert!(low.is_finite() && high > low);
        }
    }
}
