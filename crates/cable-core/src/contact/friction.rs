//! Coulomb friction is a potential here, measured from a stored anchor.
//!
//! With y the sliding since the anchor, R = μN the largest friction force and ε the sliding at
//! which it is reached (the smoothing of Li et al., "Incremental Potential Contact", ACM TOG 2020,
//! but in displacement from a stored anchor instead of displacement in the step: a held contact
//! then does not creep):
//! ```text
//! |y| < ε:  D = R (y²/ε − |y|³/3ε²),   D' = R (2y/ε − y|y|/ε²),   D'' = R (2/ε)(1 − |y|/ε)
//! |y| ≥ ε:  D = R (|y| − ε/3),         D' = R sign(y),             D'' = 0
//! ```
//! After each accepted step the anchor follows: y ← clamp(y, ±ε) ([`return_map`]).

use crate::math::{Mat2, Vec2, bounded};

/// The value (J) of D and its first (N) and second (N/m) derivative.
#[inline]
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

/// The branch of the law that a contact is assumed to follow while an iteration searches for the
/// right one, whatever its sliding is meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Branch {
    /// It sticks.
    Stick,
    /// It slides forwards.
    Forwards,
    /// It slides backwards.
    Backwards,
}

impl Branch {
    /// The branch at a sliding y.
    #[inline]
    #[must_use]
    pub fn at(y: f64, epsilon: f64) -> Self {
        match y {
            y if y >= epsilon => Self::Forwards,
            y if y <= -epsilon => Self::Backwards,
            _ => Self::Stick,
        }
    }

    /// The branch to try next if this one led from one sliding y to another. A change from sliding
    /// one way to sliding the other way passes through sticking. So does a step from one side of
    /// sticking to beyond the other side, where the law is nearly flat: otherwise a contact that
    /// sticks would jump from one side to the other for ever, each time by its whole force.
    #[inline]
    #[must_use]
    pub fn next(self, [from, to]: [f64; 2], epsilon: f64) -> Self {
        let across = from.abs() < epsilon && from * to < 0.0;
        match (self, Self::at(to, epsilon)) {
            (Self::Forwards, Self::Backwards) | (Self::Backwards, Self::Forwards) => Self::Stick,
            (Self::Stick, _) if across => Self::Stick,
            (_, now) => now,
        }
    }

    /// D' (N) and D'' (N/m) of this branch, extrapolated beyond its end: a sticking contact by a
    /// spring of R/ε.
    #[inline]
    #[must_use]
    pub fn force(self, y: f64, limit_force: f64, epsilon: f64) -> (f64, f64) {
        match self {
            Self::Forwards => (limit_force, 0.0),
            Self::Backwards => (-limit_force, 0.0),
            Self::Stick if y.abs() < epsilon => {
                let (_, slope, bend) = at(y, limit_force, epsilon);
                (slope, bend)
            }
            Self::Stick => (limit_force * y / epsilon, limit_force / epsilon),
        }
    }
}

/// The isotropic law in the plane: value (J), gradient (N) and Hessian (N/m) with respect to the
/// sliding vector.
#[must_use]
pub(crate) fn at_plane(y: Vec2, limit_force: f64, epsilon: f64) -> (f64, Vec2, Mat2) {
    let r = y.norm();
    let (value, slope, curvature) = at(r, limit_force, epsilon);
    if r == 0.0 {
        return (0.0, Vec2::zeros(), Mat2::identity() * curvature);
    }
    let n = y / r;
    let along = n * n.transpose();
    (value, n * slope, along * curvature + (Mat2::identity() - along) * (slope / r))
}

/// The sliding that is kept after an accepted step, m.
#[must_use]
pub(crate) fn return_map(y: f64, epsilon: f64) -> f64 {
    bounded(y, -epsilon, epsilon)
}

/// The sliding vector that is kept after an accepted step, m.
#[must_use]
pub(crate) fn return_map_plane(y: Vec2, epsilon: f64) -> Vec2 {
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

    #[test]
    fn branches_are_the_law_where_they_hold_and_never_jump_from_one_side_to_the_other() {
        let (limit, epsilon) = (3.0, 1e-5);
        let all = [Branch::Stick, Branch::Forwards, Branch::Backwards];
        for k in -30..=30 {
            let y = 0.1e-5 * f64::from(k);
            let (slope, bend) = Branch::at(y, epsilon).force(y, limit, epsilon);
            let (_, expected, curvature) = at(y, limit, epsilon);
            assert!((slope - expected).abs() < 1e-12 && (bend - curvature).abs() < 1e-9 * limit / epsilon);
            for branch in all {
                let next = branch.next([0.0, y], epsilon);
                assert!(branch == Branch::Stick || next == branch || next == Branch::Stick);
            }
        }
        assert!(Branch::Stick.force(f64::NAN, limit, epsilon).0.is_nan());
    }

    /// A spring k draws a contact to f/k. Newton's method on the law itself would jump from side to
    /// side.
    #[test]
    fn one_contact_on_a_spring_is_found_in_a_few_iterations() {
        let (limit, epsilon) = (3.0, 1e-5);
        for (stiffness, force) in
            [(1.0, 0.5), (1e3, -2.9), (1e3, 3.1), (1e4, 40.0), (10.0, -1e3), (1e5, 0.0), (4.35e4, -2.6)]
        {
            for start in [-0.02, -1e-6, 0.0, 9.28e-6, 3e-5, 0.5] {
                let (mut y, mut branch) = (start, Branch::at(start, epsilon));
                let residual = |y: f64| stiffness * y + at(y, limit, epsilon).1 - force;
                let mut iterations = 0;
                while residual(y).abs() > 1e-9 {
                    let (slope, bend) = branch.force(y, limit, epsilon);
                    let from = y;
                    y -= (stiffness * y + slope - force) / (stiffness + bend);
                    branch = branch.next([from, y], epsilon);
                    iterations += 1;
                    assert!(iterations <= 8, "{stiffness} {force} {start}: {y} {branch:?}");
                }
            }
        }
    }
}
