//! A cable slides along one piece of a boundary, which is an edge, a sharp corner or an arc.

use crate::math::exp;
use crate::model::spans::boundary::capstan::arc::ArcPath;
use crate::model::spans::boundary::capstan::cable_law::{CableLaw, LocalLoad, SlideResult};

/// The result of sliding by a distance `way` along the piece of a place, from the tension `t`.
pub(in crate::model::spans) fn slide_on_piece(
    law: &CableLaw,
    from: &LocalLoad,
    way: f64,
    t: f64,
    m: f64,
) -> SlideResult {
    if !from.turns {
        return slide_on_edge(law, law.edge_rate(from, m), way, t);
    }
    if from.stretch == 0.0 {
        let grown = exp(m * way);
        return SlideResult { tension: t * grown, material: 0.0, by_tension: grown, material_by_tension: 0.0 };
    }
    ArcPath::new(from, way).slide(law, t, m).0
}

/// The slide over a distance `x` (m) of an edge from a tension `t` (N), which changes by `rate` per
/// metre.
fn slide_on_edge(law: &CableLaw, rate: f64, x: f64, t: f64) -> SlideResult {
    let tension = law.tension(law.theta(t) + rate * x);
    let (a, b) = (1.0 + t * law.compliance, 1.0 + tension * law.compliance);
    let by_tension = a / b;
    let mean = 0.5 * (a + b);
    let material = x / (law.thermal * mean);
    let material_by_tension = -material / mean * (1.0 + by_tension) * (0.5 * law.compliance);
    SlideResult { tension, material, by_tension, material_by_tension }
}
