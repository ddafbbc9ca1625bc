//! Lines are cut at their sharp corners: the painter joins the two sides of a corner of 90° and
//! more by a slanted piece several times as thick as the line, which reads as a spike or a slope.
//! Points on a straight stretch are left out first: each takes four to six triangles, and the same
//! pixels are drawn without them.

use egui::{Pos2, Vec2};

/// A point may lie so far above or below the line that is drawn without it, points. Larger: smooth
/// lines are seen to have corners; smaller: more triangles, which without a GPU take most of a
/// frame.
const STRAIGHT_TOLERANCE: f32 = 0.1;

/// Least cosine of a turn that is joined. Smaller: the steps of tension at contacts are slanted;
/// larger: smooth lines fall into pieces.
const MIN_JOINED_COSINE: f32 = 0.5;
/// Most pieces of a line that is cut at each of its sharp corners. More: a line that goes up and
/// down in each column takes longer to draw, and has no corners that are told apart. Such a line is
/// cut beside its wide sides alone.
const MAX_PIECES: usize = 64;

/// Width of such a side, points. The slanted piece of a corner is as long as its sides: beside a
/// stretch of 90 points it was seen as a wedge under the line. Smaller: more pieces; larger: wedges
/// are seen.
const WIDE_SIDE: f32 = 6.0;

/// The points of a line in pieces that begin where the one before ends; `to_screen` is where a
/// point stands, points of the screen.
pub(super) fn pieces(points: &[[f64; 2]], to_screen: impl Fn([f64; 2]) -> Pos2) -> Vec<&[[f64; 2]]> {
    let all = cut_at_corners(points, &to_screen, 0.0);
    if all.len() <= MAX_PIECES { all } else { cut_at_corners(points, &to_screen, WIDE_SIDE) }
}

/// The same, cut at sharp corners of which one side is at least so wide, points.
fn cut_at_corners(points: &[[f64; 2]], to_screen: impl Fn([f64; 2]) -> Pos2, wide: f32) -> Vec<&[[f64; 2]]> {
    let mut pieces = Vec::new();
    let mut first = 0;
    let mut before: Option<Vec2> = None;
    for k in 1..points.len() {
        let step = to_screen(points[k]) - to_screen(points[k - 1]);
        if step.length_sq() <= 0.0 || !step.is_finite() {
            continue;
        }
        let is_cut = |before: Vec2| {
            before.normalized().dot(step.normalized()) < MIN_JOINED_COSINE && before.x.abs().max(step.x.abs()) >= wide
        };
        if before.is_some_and(is_cut) {
            pieces.push(&points[first..k]);
            first = k - 1;
        }
        before = Some(step);
    }
    pieces.push(&points[first..]);
    pieces
}

/// The straight stretch of a line that has been followed so far.
#[derive(Clone, Copy)]
struct StraightStretch {
    /// Its first point, on the screen.
    from: Pos2,
    /// Its last point, as the line has it.
    last: [f64; 2],
    /// Least and greatest slope of the lines from the first point that pass by all others within
    /// the tolerance.
    slopes: [f32; 2],
}

/// The points of a line without those that lie on the straight stretch between others, as seen on
/// the screen; `to_screen` is where a point stands there.
pub(super) fn without_straight_points(points: &[[f64; 2]], to_screen: impl Fn([f64; 2]) -> Pos2) -> Vec<[f64; 2]> {
    let mut corners: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    let mut stretch: Option<StraightStretch> = None;
    for &point in points {
        let at = to_screen(point);
        let slopes_by =
            |from: Pos2| [-STRAIGHT_TOLERANCE, STRAIGHT_TOLERANCE].map(|off| (at.y + off - from.y) / (at.x - from.x));
        let Some(StraightStretch { from, last, slopes }) = stretch.filter(|_| at.is_finite()) else {
            corners.extend(stretch.map(|s| s.last));
            corners.push(point);
            let slopes = [f32::NEG_INFINITY, f32::INFINITY];
            stretch = at.is_finite().then_some(StraightStretch { from: at, last: point, slopes });
            continue;
        };
        let slope = (at.y - from.y) / (at.x - from.x);
        stretch = if at.x > from.x && (slopes[0]..=slopes[1]).contains(&slope) {
            let [low, high] = slopes_by(from);
            Some(StraightStretch { from, last: point, slopes: [slopes[0].max(low), slopes[1].min(high)] })
        } else {
            corners.push(last);
            let from = to_screen(last);
            let slopes = if at.x > from.x { slopes_by(from) } else { [f32::INFINITY, f32::NEG_INFINITY] };
            Some(StraightStretch { from, last: point, slopes })
        };
    }
    corners.extend(stretch.map(|s| s.last));
    corners.dedup();
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(points: &[[f64; 2]]) -> Vec<&[[f64; 2]]> {
        pieces(points, |[x, y]| Pos2::new(x as f32, y as f32))
    }

    #[test]
    fn a_step_is_three_pieces_that_meet_and_a_curve_is_one() {
        let step = [[0.0, 0.0], [5.0, 0.0], [5.0, 0.0], [5.0, 4.0], [5.01, 9.0], [12.0, 9.0]];
        assert_eq!(of(&step), [&step[..3], &step[2..5], &step[4..]]);
        let curve: Vec<[f64; 2]> = (0..90).map(f64::from).map(|x| [x, 20.0 * (0.1 * x).sin()]).collect();
        assert_eq!(of(&curve).len(), 1);
        let noise: Vec<[f64; 2]> = (0..900).map(f64::from).map(|x| [x, 30.0 * (x % 2.0)]).collect();
        assert_eq!(of(&noise), [&noise[..]]);
        // Issue 20: a wedge was drawn under a long level stretch before it, whose end was joined to
        // it.
        let mut after_rest = vec![[-90.0, 0.0]];
        after_rest.extend_from_slice(&noise);
        assert_eq!(of(&after_rest), [&after_rest[..2], &after_rest[1..]]);
        assert_eq!((of(&[]), of(&[[1.0, 1.0]])), (vec![&[][..]], vec![&[[1.0, 1.0]][..]]));
    }

    #[test]
    fn a_line_without_its_straight_points_passes_by_all_of_them() {
        let screen = |[x, y]: [f64; 2]| Pos2::new(x as f32, y as f32);
        let thin = |points: &[[f64; 2]]| without_straight_points(points, screen);
        let straight: Vec<[f64; 2]> = (0..90).map(f64::from).map(|x| [x, 3.0 - 0.5 * x]).collect();
        assert_eq!(thin(&straight), [straight[0], straight[89]]);
        let step = [[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [5.0, 9.0], [12.0, 9.0]];
        assert_eq!(thin(&step), step, "what stands upright is kept");
        let gap = [[0.0, 1.0], [1.0, 1.0], [2.0, f64::NAN], [3.0, 1.0], [4.0, 1.0], [5.0, 1.0]];
        let left: Vec<_> = thin(&gap).iter().map(|p| p[0]).collect();
        assert_eq!(left, [0.0, 1.0, 2.0, 3.0, 5.0], "a gap stays one");
        assert_eq!((thin(&[]), thin(&[[1.0, 1.0]])), (vec![], vec![[1.0, 1.0]]));
        for waves in [0.02, 0.1, 0.7, 3.0] {
            let wave: Vec<[f64; 2]> = (0..400)
                .map(f64::from)
                .map(|x| [0.5 * x, 20.0 * (0.5 * waves * x).sin() + 5.0 * (0.01 * x).cos()])
                .collect();
            let corners = thin(&wave);
            assert!(
                (corners[0], corners[corners.len() - 1]) == (wave[0], wave[399]) && corners.len() < 400 || waves > 1.0
            );
            for p in &wave {
                let k = corners.partition_point(|q| q[0] < p[0]).clamp(1, corners.len() - 1);
                let ([a, b], [c, d]) = (corners[k - 1], corners[k]);
                let there = b + (d - b) * (p[0] - a) / (c - a);
                assert!((there - p[1]).abs() < 1.05 * f64::from(STRAIGHT_TOLERANCE), "{waves}: {p:?} beside {there}");
            }
        }
        let smooth: Vec<[f64; 2]> = (0..230).map(f64::from).map(|x| [2.0 * x, 40.0 * (0.01 * x).sin()]).collect();
        assert!(thin(&smooth).len() < 60, "{}", thin(&smooth).len());
    }
}
