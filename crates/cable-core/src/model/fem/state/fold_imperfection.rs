//! A fold whose two limbs lie in one line is a bifurcation point. This module adds a tiny
//! imperfection, so that the fold can open to one side when a motion begins.

use crate::math::{Vec2, cross, perp};
use crate::model::fem::mesh::Mesh;

/// Distance by which the middle of a fold is moved aside, as a fraction of a bar. Smaller: the fold
/// opens later than it would; larger: its bars are stretched by half of the square of it.
const FOLD_OFFSET_BARS: f64 = 1e-4;

/// Sine of the angle between the limbs below which a fold counts as collinear.
const FOLD_LINE_SINE: f64 = 1e-6;

/// Moves the middle of each collinear fold a little aside; `x` are the positions of the nodes, m.
/// Within the line a bar would have to shrink to length zero to turn over: a weight that fell
/// beside its slack cable stayed hanging in the fold.
pub(in crate::model::fem) fn open_collinear_folds(mesh: &Mesh, x: &mut [Vec2]) {
    for k in 1..x.len().saturating_sub(1) {
        let (a, b) = (x[k] - x[k - 1], x[k + 1] - x[k]);
        let size = a.norm() * b.norm();
        if mesh.is_free(k) && a.dot(&b) < 0.0 && cross(a, b).abs() <= FOLD_LINE_SINE * size {
            x[k] += perp(a) * FOLD_OFFSET_BARS;
        }
    }
}
