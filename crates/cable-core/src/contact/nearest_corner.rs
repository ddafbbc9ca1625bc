//! This search finds the body, by its nearest corner or circle, that a few nodes of a cable wrap.

use super::distance::from_segment;
use super::geometry::{Body, Geometry};
use crate::math::{Vec2, smaller};

/// The body whose convex corner or circle is nearest to a chain of nodes; `None` if the gap is not
/// below `reach` (m).
#[must_use]
pub(crate) fn nearest_wrap_body<'a>(geometry: &'a Geometry, chain: &[Vec2], reach: f64) -> Option<&'a Body> {
    let first = *chain.first()?;
    let (low, high) = chain.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    let distance = |v: Vec2| match chain {
        [p] => (v - p).norm(),
        _ => chain.windows(2).map(|w| from_segment(v, w[0], w[1]).norm()).fold(f64::INFINITY, smaller),
    };
    let mut best: Option<(f64, &Body)> = None;
    for body in geometry.bodies() {
        let mut look = |v: Vec2| {
            let gap = distance(v) - body.offset;
            if gap < reach && best.is_none_or(|b| gap < b.0) {
                best = Some((gap, body));
            }
        };
        if let Some(center) = body.center {
            look(center);
            continue;
        }
        let r = Vec2::repeat(reach + body.offset);
        let ([x0, y0], [x1, y1]): ([f64; 2], [f64; 2]) = ((low - r).into(), (high + r).into());
        for k in body.candidates(low - r, high + r) {
            for corner in body.corners_of(k).filter(|c| body.is_exposed(c)) {
                let v = corner.at;
                if v.x >= x0 && v.x <= x1 && v.y >= y0 && v.y <= y1 {
                    look(v);
                }
            }
        }
    }
    best.map(|b| b.1)
}
