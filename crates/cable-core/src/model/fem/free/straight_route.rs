//! This module lays a cable straight from support to support before its first answer.

use crate::math::Vec2;
use crate::model::fem::free::results::SolutionPoint;
use crate::model::fem::free::stations::StationLayout;
use crate::problem::Problem;

/// The points of the straight way through the supports at time 0, in so many segments; `slid` is
/// the arc length at each support that slides, m. Hanging ends point down.
pub(super) fn straight_points(problem: &Problem, segments: usize, slid: &[Option<f64>]) -> Vec<SolutionPoint> {
    let mut layout = StationLayout::new(problem, 0.0, &[], slid);
    layout.cut(segments);
    let Some((first, last)) = layout.anchored() else { return Vec::new() };
    let down = problem.body_force(0.0);
    let down = if down.norm() > 0.0 { down / down.norm() } else { Vec2::new(0.0, -1.0) };
    let stations = &layout.stations;
    let at = |k: usize| -> Vec2 {
        let anchor = |j: usize| stations[j].point(0).unwrap_or_default();
        let (a, b) = (
            (0..=k).rev().find(|&j| stations[j].anchors()).unwrap_or(first),
            (k..stations.len()).find(|&j| stations[j].anchors()).unwrap_or(last),
        );
        if k < first || k > last {
            return anchor(a.max(first).min(last))
                + down * (stations[k].arc_length - stations[a.max(first).min(last)].arc_length).abs();
        }
        let width = stations[b].arc_length - stations[a].arc_length;
        let f = if width > 0.0 { (stations[k].arc_length - stations[a].arc_length) / width } else { 0.0 };
        anchor(a) + (anchor(b) - anchor(a)) * f
    };
    let point = |arc_length: f64, at: Vec2| SolutionPoint { arc_length, at, ..SolutionPoint::default() };
    let mut points = Vec::new();
    for k in 0..stations.len() - 1 {
        let (a, b, s, d) =
            (at(k), at(k + 1), stations[k].arc_length, stations[k + 1].arc_length - stations[k].arc_length);
        for e in 0..stations[k].element_count {
            let f = e as f64 / stations[k].element_count as f64;
            points.push(point(s + d * f, a + (b - a) * f));
        }
    }
    points.push(point(layout.length, at(stations.len() - 1)));
    points
}
