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
/// Part of an axis at its end in which a number with its unit would be cut.
const UNIT_MARGIN: f64 = 0.03;

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

/// As [`checkbox_and_radio`]; the last number that is not cut by the end of its axis has the unit,
/// so that no line of the graph is spent on it.
pub(super) fn tick_with_unit(mark: GridMark, shown: &RangeInclusive<f64>, symbol: &str) -> String {
    let end = shown.end() - UNIT_MARGIN * (shown.end() - shown.start());
    let last = mark.value <= end && mark.value + mark.step_size > end;
    if last { format!("{} {symbol}", tick(mark)) } else { tick(mark) }
}

/// As [`tick_with_unit`] on the horizontal axis, whose end cuts a number that stands there.
pub(super) fn tick_across(mark: GridMark, shown: &RangeInclusive<f64>, symbol: &str) -> String {
    let end = shown.end() - UNIT_MARGIN * (shown.end() - shown.start());
    if mark.value > end { String::new() } else { tick_with_unit(mark, shown, symbol) }
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

    /// The 3.0 at the end of a cable of 3 m was cut in half by the edge of its graph.
    #[test]
    fn no_number_stands_where_the_end_of_its_axis_cuts_it() {
        let texts = [2.0, 2.5, 3.0].map(|value| tick_across(GridMark { value, step_size: 0.5 }, &(0.0..=3.0), "m"));
        assert_eq!(texts, ["2.0", "2.5 m", ""]);
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
