//! The path of a bar is straight between two points, or tangent to the rounds at its ends.
//!
//! A round is a circle (centre C, radius r) passed in a sense σ (+1 counter-clockwise, −1
//! clockwise); a point is a round of radius 0. The outward normal where a tangent of direction t
//! touches it is n = −σ perp(t), so that with D = C₂ − C₁, ρ = σ₂r₂ − σ₁r₁ and the straight length
//! l
//! ```text
//! D = l t + ρ perp(t),   l = √(D² − ρ²),   angle(t) = angle(D) − atan2(ρ, l)
//! P = r₁β₁ + l + r₂β₂,   β₁ = σ₁(angle(n₁) − α₁),   β₂ = σ₂(α₂ − angle(n₂))
//! ```
//! where α is the angle of a round's mark. For any rounds ∂P/∂(end point) = ∓t and ∂²P/∂(end
//! point)² = (I − t tᵀ)/l: the arc pays out what the straight part takes up.

use crate::math::{Vec2, cross, perp};

/// Distance of the centres of two rounds below which they are the same round, as a fraction of
/// their radius.
const COINCIDENT_CENTRE_FRACTION: f64 = 1e-9;

/// One end of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarEnd {
    /// Centre, m.
    pub center: Vec2,
    /// Radius, m; 0 = a point.
    pub radius: f64,
    /// Direction from the centre to the mark, at which material is counted; a unit vector.
    pub mark: Vec2,
    /// +1 where the cable runs counter-clockwise, −1 clockwise.
    pub sense: f64,
}

impl BarEnd {
    /// An end without a radius.
    #[inline]
    #[must_use]
    pub fn point(at: Vec2) -> Self {
        Self { center: at, radius: 0.0, mark: Vec2::x(), sense: 1.0 }
    }

    /// ∫r ds (m²) over the arc from the mark through an angle (rad; negative: backwards), with r
    /// measured from the centre. The integral is negative for negative angles.
    #[must_use]
    pub fn arc(&self, angle: f64) -> Vec2 {
        let (sin, cos) = (0.5 * self.sense * angle).sin_cos();
        let middle = Vec2::new(cos * self.mark.x - sin * self.mark.y, sin * self.mark.x + cos * self.mark.y);
        self.center * (self.radius * angle) + middle * (2.0 * self.radius * self.radius * (0.5 * angle).sin())
    }
}

/// The path from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentPath {
    /// Whole length P, m.
    pub length: f64,
    /// Length l of the straight part, m.
    pub straight: f64,
    /// Direction t of the straight part; a unit vector.
    pub direction: Vec2,
    /// Ends of the straight part, m.
    pub ends: [Vec2; 2],
    /// Angles β₁, β₂ of the arcs, rad; negative where the tangent leaves before the mark.
    pub arcs: [f64; 2],
}

/// The angle from `a` to `b`, rad in (−π, π].
#[must_use]
pub fn angle_between(a: Vec2, b: Vec2) -> f64 {
    cross(a, b).atan2(a.dot(&b))
}

impl TangentPath {
    /// The path between two points.
    #[inline]
    #[must_use]
    pub fn line(a: Vec2, b: Vec2) -> Self {
        let length = (b - a).norm();
        let direction = if length > 0.0 { (b - a) / length } else { Vec2::x() };
        Self { length, straight: length, direction, ends: [a, b], arcs: [0.0; 2] }
    }

    /// The path between two ends.
    #[must_use]
    pub fn between(a: &BarEnd, b: &BarEnd) -> Self {
        let straight = match StraightPart::between(a, b) {
            Some(straight) => straight,
            None => return Self::round(a, b),
        };
        let normal = |end: &BarEnd| perp(straight.direction) * -end.sense;
        let arc = |end: &BarEnd| if end.radius > 0.0 { end.sense * angle_between(normal(end), end.mark) } else { 0.0 };
        let arcs = [-arc(a), arc(b)];
        let StraightPart { length: straight, direction, ends } = straight;
        let length = straight + a.radius * arcs[0] + b.radius * arcs[1];
        Self { length, straight, direction, ends, arcs }
    }

    /// The path along one round, from mark to mark.
    fn round(a: &BarEnd, b: &BarEnd) -> Self {
        let turn = a.sense * angle_between(a.mark, b.mark);
        let turn = if turn < 0.0 { turn + std::f64::consts::TAU } else { turn };
        let (sin, cos) = (0.5 * a.sense * turn).sin_cos();
        let middle = Vec2::new(cos * a.mark.x - sin * a.mark.y, sin * a.mark.x + cos * a.mark.y);
        let at = a.center + middle * a.radius;
        Self {
            length: a.radius * turn,
            straight: 0.0,
            direction: perp(middle) * a.sense,
            ends: [at, at],
            arcs: [0.5 * turn, 0.5 * turn],
        }
    }
}

/// The straight part of a path without the angles of its arcs, each of which takes an atan2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightPart {
    /// Length l, m.
    pub length: f64,
    /// Direction t; a unit vector.
    pub direction: Vec2,
    /// Its ends, m.
    pub ends: [Vec2; 2],
}

impl StraightPart {
    /// The straight part between two ends; None where both lie on one round.
    fn between(a: &BarEnd, b: &BarEnd) -> Option<Self> {
        let d = b.center - a.center;
        if a.radius > 0.0
            && b.radius > 0.0
            && d.norm() <= COINCIDENT_CENTRE_FRACTION * a.radius
            && a.sense * b.sense > 0.0
        {
            return None;
        }
        let rho = b.sense * b.radius - a.sense * a.radius;
        let square = d.norm_squared() - rho * rho;
        let length = if square > 0.0 { square.sqrt() } else { 0.0 };
        let far = d.norm();
        let direction = if far > 0.0 {
            // t = (l D − ρ perp(D))/D² has unit length even if the straight part has vanished.
            let t = d * length - perp(d) * rho;
            let size = t.norm();
            if size > 0.0 { t / size } else { Vec2::x() }
        } else {
            Vec2::x()
        };
        let normal = |end: &BarEnd| perp(direction) * -end.sense;
        let ends = [a.center + normal(a) * a.radius, b.center + normal(b) * b.radius];
        Some(Self { length, direction, ends })
    }

    /// That of [`TangentPath::between`].
    #[must_use]
    pub fn of(a: &BarEnd, b: &BarEnd) -> Self {
        Self::between(a, b).unwrap_or_else(|| {
            let TangentPath { straight: length, direction, ends, .. } = TangentPath::round(a, b);
            Self { length, direction, ends }
        })
    }
}

/// A vector turned by an angle (rad), counter-clockwise.
pub(in crate::model::fem) fn rotate(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn unit(angle: f64) -> Vec2 {
        Vec2::new(angle.cos(), angle.sin())
    }

    #[test]
    fn over_a_wheel_the_way_is_two_tangents_and_an_arc() {
        // A wheel of radius 1 at the origin, passed clockwise over its top, from (−2, 0) to (2, 0):
        // the tangents are √3 long and meet it 60° before and after the top... of 120° in all, 60°
        // wrapped.
        let wheel = BarEnd { center: Vec2::zeros(), radius: 1.0, mark: Vec2::y(), sense: -1.0 };
        let first = TangentPath::between(&BarEnd::point(Vec2::new(-2.0, 0.0)), &wheel);
        let last = TangentPath::between(&wheel, &BarEnd::point(Vec2::new(2.0, 0.0)));
        let sixth = std::f64::consts::FRAC_PI_6;
        for (path, arc) in [(first, first.arcs[1]), (last, last.arcs[0])] {
            assert!((path.straight - 3f64.sqrt()).abs() < 1e-14);
            assert!((arc - sixth).abs() < 1e-14, "{arc}");
            assert!((path.length - 3f64.sqrt() - sixth).abs() < 1e-14);
        }
        assert!((first.ends[1] - unit(std::f64::consts::FRAC_PI_2 + sixth)).norm() < 1e-14);
    }

    #[test]
    fn a_whole_turn_is_the_sum_of_its_marks() {
        let mark = |angle: f64| BarEnd { center: Vec2::zeros(), radius: 0.5, mark: unit(angle), sense: 1.0 };
        let path = TangentPath::between(&mark(3.0), &mark(5.0));
        assert!((path.length - 1.0).abs() < 1e-14);
        assert!(
            (TangentPath::between(&mark(5.0), &mark(3.0)).length - 0.5 * (std::f64::consts::TAU - 2.0)).abs() < 1e-14
        );
    }

    proptest! {
        #[test]
        fn moving_an_end_changes_the_way_by_its_share_along_the_tangent(
            from in (-3.0f64..-1.5, -1.0f64..1.0), r in 0.0f64..0.9, over in any::<bool>(), step in (-1.0f64..1.0, -1.0f64..1.0),
        ) {
            let sense = if over { -1.0 } else { 1.0 };
            let mark = Vec2::new(0.0, -sense);
            let wheel = BarEnd { center: Vec2::zeros(), radius: r, mark, sense };
            let (p, h) = (Vec2::new(from.0, from.1), 1e-5);
            let d = Vec2::new(step.0, step.1) * h;
            let at = |p: Vec2| TangentPath::between(&BarEnd::point(p), &wheel);
            let (path, plus, minus) = (at(p), at(p + d), at(p - d));
            let slope = plus.length - minus.length;
            prop_assert!((slope + 2.0 * path.direction.dot(&d)).abs() < 1e-9 * h.sqrt());
            let bend = plus.length + minus.length - 2.0 * path.length;
            let across = perp(path.direction).dot(&d);
            prop_assert!((bend - across * across / path.straight).abs() < 1e-13);
        }

        #[test]
        fn two_rounds_are_touched_tangentially(
            to in (2.0f64..4.0, -1.0f64..1.0), r in (0.1f64..0.9, 0.1f64..0.9), senses in (any::<bool>(), any::<bool>()),
        ) {
            let sense = |over: bool| if over { -1.0 } else { 1.0 };
            let a = BarEnd { center: Vec2::zeros(), radius: r.0, mark: Vec2::y(), sense: sense(senses.0) };
            let b = BarEnd { center: Vec2::new(to.0, to.1), radius: r.1, mark: Vec2::y(), sense: sense(senses.1) };
            let path = TangentPath::between(&a, &b);
            for (end, at) in [(a, path.ends[0]), (b, path.ends[1])] {
                let n = (at - end.center) / end.radius;
                prop_assert!((n.norm() - 1.0).abs() < 1e-12);
                prop_assert!((perp(n) * end.sense - path.direction).norm() < 1e-12);
            }
            prop_assert!((path.ends[1] - path.ends[0] - path.direction * path.straight).norm() < 1e-12);
        }
    }
}
