//! Coulomb friction as a potential measured from a stored anchor.
//!
//! With y the sliding since the anchor, R = μN the largest friction force and ε the sliding at which it is
//! reached (the smoothing of Li et al., "Incremental Potential Contact", ACM TOG 2020, but in displacement from
//! a stored anchor instead of displacement in the step: a held contact then does not creep):
//! ```text
//! |y| < ε:  D = R (y²/ε − |y|³/3ε²),   D' = R (2y/ε − y|y|/ε²),   D'' = R (2/ε)(1 − |y|/ε)
//! |y| ≥ ε:  D = R (|y| − ε/3),         D' = R sign(y),             D'' = 0
//! ```
//! After each accepted step the anchor follows: y ← clamp(y, ±ε) ([`return_map`]).

use crate::math::{Mat2, Vec2};

/// Value, first and second derivative of D: J, N, N/m.
#[must_use]
pub fn at(y: f64, limit_force: f64, epsilon: f64) -> (f64, f64, f64) {
    let u = y.abs() / epsilon;
    if u >= 1.0 {
        (limit_force * (y.abs() - epsilon / 3.0), limit_force * y.signum(), 0.0)
    } else {
        (
            limit_force * epsilon * u * u * (1.0 - u / 3.0),
            limit_force * (y / epsilon) * (2.0 - u),
            limit_force * (2.0 / epsilon) * (1.0 - u),
        )
    }
}

/// The same in the plane, isotropic: value, gradient, Hessian by the sliding vector.
#[must_use]
pub fn at_plane(y: Vec2, limit_force: f64, epsilon: f64) -> (f64, Vec2, Mat2) {
    let r = y.norm();
    let (value, slope, curvature) = at(r, limit_force, epsilon);
    if r == 0.0 {
        return (0.0, Vec2::zeros(), Mat2::identity() * curvature);
    }
    let n = y / r;
    let along = n * n.transpose();
    (value, n * slope, along * curvature + (Mat2::identity() - along) * (slope / r))
}

/// Sliding kept after an accepted step.
#[must_use]
pub fn return_map(y: f64, epsilon: f64) -> f64 {
    y.clamp(-epsilon, epsilon)
}

/// Sliding vector kept after an accepted step.
#[must_use]
pub fn return_map_plane(y: Vec2, epsilon: f64) -> Vec2 {
    let r = y.norm();
    if r > epsilon { y * (epsilon / r) } else { y }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_differences() {
        let (limit, epsilon, h) = (3.0, 1e-5, 1e-10);
        for k in -30..=30 {
            let y = 0.07e-5 * f64::from(k) + 1e-8;
            let (c, p, m) = (at(y, limit, epsilon), at(y + h, limit, epsilon), at(y - h, limit, epsilon));
            assert!(((p.0 - m.0) / (2.0 * h) - c.1).abs() < 1e-5 * limit);
            assert!(((p.1 - m.1) / (2.0 * h) - c.2).abs() < 1e-4 * limit / epsilon);
            let v = Vec2::new(y, 0.4e-5);
            let (_, g, hess) = at_plane(v, limit, epsilon);
            for axis in 0..2 {
                let mut d = Vec2::zeros();
                d[axis] = h;
                let (p, m) = (at_plane(v + d, limit, epsilon), at_plane(v - d, limit, epsilon));
                assert!(((p.0 - m.0) / (2.0 * h) - g[axis]).abs() < 1e-5 * limit);
                assert!(((p.1 - m.1) / (2.0 * h) - hess.column(axis)).norm() < 1e-4 * limit / epsilon);
            }
        }
    }

    #[test]
    fn a_held_contact_keeps_its_force_and_a_sliding_one_is_at_its_limit() {
        let epsilon = 1e-5;
        assert_eq!(return_map(0.3e-5, epsilon), 0.3e-5);
        assert_eq!(return_map(-1.0, epsilon), -epsilon);
        assert_eq!(at(return_map(1.0, epsilon), 3.0, epsilon).1, 3.0);
        assert!((return_map_plane(Vec2::new(3.0, 4.0), epsilon) - Vec2::new(0.6e-5, 0.8e-5)).norm() < 1e-20);
        assert!(at(f64::NAN, 1.0, epsilon).1.is_nan());
    }
}
