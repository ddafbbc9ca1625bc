//! The core computes with these scalars, vectors and rigid bodies: f64 everywhere, x to the right,
//! y up.

mod rigid_pose;

pub use rigid_pose::RigidPose;

/// A plane vector or point, in the unit the field says.
pub type Vec2 = nalgebra::Vector2<f64>;
/// A 2×2 matrix.
pub(crate) type Mat2 = nalgebra::Matrix2<f64>;
/// A point as a scene file writes it: `[x, y]`.
pub type Point = [f64; 2];

/// Half the distance of the two nodes of 2-point Gauss–Legendre quadrature on an interval of length
/// 1.
pub(crate) const GAUSS_2_HALF_DISTANCE: f64 = 0.288_675_134_594_812_9;
/// Nodes and weights of 3-point Gauss–Legendre quadrature on [0, 1].
pub(crate) const GAUSS_3: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// The same of 5-point quadrature.
pub(crate) const GAUSS_5: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// A file's point as a vector.
#[must_use]
pub fn vec2(p: Point) -> Vec2 {
    Vec2::new(p[0], p[1])
}

/// The vector turned by +90° (counter-clockwise).
#[inline]
#[must_use]
pub(crate) fn perp(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// The z component of the cross product `a × b`.
#[inline]
#[must_use]
pub(crate) fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Tangent of the angles whose series of [`angle`] is as exact as numbers are: the next term is
/// r¹¹/11.
const MAX_SERIES_TANGENT: f64 = 0.05;

/// The value brought between two bounds, whatever they are: unlike [`f64::clamp`] it does not panic
/// where they are exchanged or no numbers, as bounds that a solver works out may be. The upper one
/// wins.
#[inline]
#[must_use]
pub(crate) fn bounded(value: f64, low: f64, high: f64) -> f64 {
    let above = if value < low { low } else { value };
    if above > high { high } else { above }
}

/// The angle from `a` to `b`, rad in (−π, π]. Neighbouring elements turn little: there a series, as
/// arctangents are dear.
#[must_use]
pub(crate) fn angle(a: Vec2, b: Vec2) -> f64 {
    let (sin, cos) = (cross(a, b), a.dot(&b));
    if !(sin.abs() < MAX_SERIES_TANGENT * cos) {
        return sin.atan2(cos);
    }
    let r = sin / cos;
    let s = r * r;
    r * (1.0 - s * (1.0 / 3.0 - s * (1.0 / 5.0 - s * (1.0 / 7.0 - s / 9.0))))
}

/// Angles whose sine and cosine [`sin_cos`] takes from a short series, rad: the next terms are
/// 9e-17 and 6e-19 of them.
const MAX_SHORT_SERIES_ANGLE: f64 = 0.3;
/// … and from a longer one: just over an eighth of a turn, and terms of 1e-18.
const MAX_SERIES_ANGLE: f64 = 0.8;
/// Quarters of a turn that are taken off in two parts without losing a digit.
const MAX_QUARTER_TURNS: f64 = 64.0;
/// π/2 as a number of few digits and the rest.
const QUARTER_TURN: [f64; 2] = [1.570_796_325_802_803, 9.920_935_796_805_404e-10];

/// Sine and cosine of an angle, rad. Corners turn little: there by the series, as a call of the
/// library is dear.
#[must_use]
#[inline]
pub(crate) fn sin_cos(angle: f64) -> (f64, f64) {
    if !(angle.abs() <= MAX_SHORT_SERIES_ANGLE) {
        return sin_cos_beyond_short_series(angle);
    }
    let s = angle * angle;
    let sin = 1.0 / 362_880.0 - s / 39_916_800.0;
    let sin = 1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s * (1.0 / 5040.0 - s * sin)));
    let cos = 1.0 / 40_320.0 - s * (1.0 / 3_628_800.0 - s / 479_001_600.0);
    let cos = 1.0 - s * (0.5 - s * (1.0 / 24.0 - s * (1.0 / 720.0 - s * cos)));
    (angle * sin, cos)
}

/// Sine and cosine of an angle (rad) beyond the short series, reduced to an eighth of a turn if it
/// is longer.
fn sin_cos_beyond_short_series(angle: f64) -> (f64, f64) {
    if angle.abs() <= MAX_SERIES_ANGLE {
        return long_series(angle);
    }
    let quarters = (angle / std::f64::consts::FRAC_PI_2).round();
    if !(quarters.abs() <= MAX_QUARTER_TURNS) {
        return angle.sin_cos();
    }
    let (sin, cos) = long_series((angle - quarters * QUARTER_TURN[0]) - quarters * QUARTER_TURN[1]);
    match (quarters as i64).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Sine and cosine of an angle (rad) by the first eight and nine terms of their Taylor series; the
/// divisors are factorials.
fn long_series(angle: f64) -> (f64, f64) {
    let s = angle * angle;
    let sin = 1.0 / 6_227_020_800.0 - s * (1.0 / 1_307_674_368_000.0 - s / 355_687_428_096_000.0);
    let sin = 1.0 / 5040.0 - s * (1.0 / 362_880.0 - s * (1.0 / 39_916_800.0 - s * sin));
    let cos = 1.0 / 479_001_600.0 - s * (1.0 / 87_178_291_200.0 - s / 20_922_789_888_000.0);
    let cos = 1.0 / 720.0 - s * (1.0 / 40_320.0 - s * (1.0 / 3_628_800.0 - s * cos));
    let sin = 1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s * sin));
    let cos = 1.0 - s * (0.5 - s * (1.0 / 24.0 - s * cos));
    (angle * sin, cos)
}

/// Exponents whose power [`exp`] takes from the series: the next term is 3e-17.
const MAX_SERIES_EXPONENT: f64 = 0.1;

/// e to the power of x. Friction on small turns multiplies by little: there by the series, as a
/// call of the library is dear.
#[must_use]
#[inline]
pub(crate) fn exp(x: f64) -> f64 {
    if !(x.abs() <= MAX_SERIES_EXPONENT) {
        return x.exp();
    }
    let high = 1.0 / 120.0 + x * (1.0 / 720.0 + x * (1.0 / 5040.0 + x * (1.0 / 40_320.0 + x / 362_880.0)));
    1.0 + x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * high))))
}

/// The larger of two numbers; NaN once one of them is, unlike `f64::max`.
#[inline]
#[must_use]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b <= a || a.is_nan() { a } else { b }
}

/// The smaller of two numbers; NaN once one of them is, unlike `f64::min`.
#[inline]
#[must_use]
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if b >= a || a.is_nan() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_is_the_arctangent() {
        let a = Vec2::new(0.3, -1.2);
        for k in -400_i32..=400 {
            let by = 1e-2 * f64::from(k) * (f64::from(k.abs()) / 400.0);
            let (sin, cos) = by.sin_cos();
            let b = Vec2::new(cos * a.x - sin * a.y, sin * a.x + cos * a.y) * 2.5;
            let expected = cross(a, b).atan2(a.dot(&b));
            assert!((angle(a, b) - expected).abs() <= 2e-14 * expected.abs(), "{by}");
        }
        assert!(angle(a, Vec2::new(f64::NAN, 1.0)).is_nan() && angle(a, Vec2::zeros()) == 0.0);
        assert_eq!(angle(Vec2::x(), -Vec2::x()), std::f64::consts::PI);
    }

    #[test]
    fn sine_and_cosine_of_small_angles_are_those_of_the_library() {
        for k in -1000_i32..=1000 {
            let angle = 4e-4 * f64::from(k);
            let ((sin, cos), (s, c)) = (sin_cos(angle), angle.sin_cos());
            assert!((sin - s).abs() <= 3e-16 * s.abs() && (cos - c).abs() <= 3e-16, "{angle}");
        }
        for k in -20_000_i32..=20_000 {
            let angle = 0.006 * f64::from(k);
            let ((sin, cos), (s, c)) = (sin_cos(angle), angle.sin_cos());
            assert!((sin - s).abs() <= 3e-16 && (cos - c).abs() <= 3e-16, "{angle}");
        }
        assert!(sin_cos(f64::NAN).0.is_nan());
    }

    #[test]
    fn a_power_of_e_is_that_of_the_library() {
        for k in -1000_i32..=1000 {
            let x = 2e-4 * f64::from(k);
            assert!((exp(x) - x.exp()).abs() <= 3e-16 * x.exp(), "{x}");
        }
        assert!(exp(f64::NAN).is_nan());
    }

    #[test]
    fn a_number_that_is_none_is_never_lost() {
        for list in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
            assert!(list.into_iter().fold(0.0, larger).is_nan());
            assert!(list.into_iter().fold(9.0, smaller).is_nan());
        }
        assert_eq!([1.0, 3.0, 2.0].into_iter().fold(0.0, larger), 3.0);
        assert_eq!([1.0, 3.0, 2.0].into_iter().fold(9.0, smaller), 1.0);
    }
}
