//! A fold whose two limbs lie in one line is a bifurcation point: a tiny imperfection lets it open
//! to one side as a motion begins.

use crate::math::{Vec2, cross, perp};
use crate::model::fem::mesh::Mesh;

/// Distance (parts of a bar) by which the middle of a fold is moved aside. Less: the fold opens
/// later than it would; more: its bars are stretched by half of the square of it.
const ASIDE: f64 = 1e-4;

/// Sine of the turn off a line below which a fold lies in it.
const FOLD_LINE_SINE: f64 = 1e-6;

/// Moves the middle of each fold that lies in one line a little aside; `x` are the positions of the
/// nodes, m. In the line itself a bar would have to pass through no length to turn over: a weight
/// that fell beside its slack cable hung in the fold.
pub(in crate::model::fem) fn open_collinear_folds(mesh: &Mesh, x: &mut [Vec2]) {
    for k in 1..x.len().saturating_sub(1) {
        let (a, b) = (x[k] - x[k - 1], x[k + 1] - x[k]);
        let size = a.norm() * b.norm();
        if mesh.is_free(k) && a.dot(&b) < 0.0 && cross(a, b).abs() <= FOLD_LINE_SINE * size {
            x[k] += perp(a) * ASIDE;
        }
    }
}
