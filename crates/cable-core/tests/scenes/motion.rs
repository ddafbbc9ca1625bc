//! A support follows a C² curve.

use cable_core::Vec2;
use cable_core::scene::Motion;
use proptest::prelude::*;

fn motions() -> impl Strategy<Value = Motion> {
    proptest::collection::vec((0.05..5.0f64, -5.0..5.0f64, prop_oneof![Just(0.0), -5.0..5.0f64]), 2..9).prop_map(
        |knots| {
            let (mut t, mut p) = (0.0, [0.0, 0.0]);
            let (mut times_s, mut points_m) = (Vec::new(), Vec::new());
            for (dt, dx, dy) in knots {
                times_s.push(t);
                points_m.push(p);
                t += dt;
                p = [p[0] + dx, p[1] + dy];
            }
            Motion { times_s, points_m }
        },
    )
}

#[test]
fn two_knots_are_the_quintic_smoothstep() {
    let m = Motion { times_s: vec![1.0, 3.0], points_m: vec![[1.0, -2.0], [5.0, 4.0]] };
    for i in 0..=64 {
        let u = f64::from(i) / 64.0;
        let s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        let ds = 30.0 * u * u * (1.0 - u) * (1.0 - u) / 2.0;
        let (p, v) = m.at(1.0 + 2.0 * u);
        assert!((p - Vec2::new(1.0 + 4.0 * s, -2.0 + 6.0 * s)).norm() < 1e-14, "{u}");
        assert!((v - Vec2::new(4.0 * ds, 6.0 * ds)).norm() < 1e-13, "{u}");
    }
}

#[test]
fn equal_steps_are_passed_at_constant_speed() {
    let m =
        Motion { times_s: (0..6).map(f64::from).collect(), points_m: (0..6).map(|i| [f64::from(i), 0.0]).collect() };
    for i in 0..=30 {
        let t = 1.0 + f64::from(i) * 0.1;
        let (p, v) = m.at(t);
        assert!((p.x - t).abs() < 1e-14 && (v.x - 1.0).abs() < 1e-13);
    }
}

#[test]
fn a_time_that_is_no_number_gives_no_place() {
    let m = Motion { times_s: vec![0.0, 1.0], points_m: vec![[0.0, 0.0], [1.0, 0.0]] };
    assert!(m.at(f64::NAN).0.x.is_nan());
    assert_eq!(m.at(f64::INFINITY).0, Vec2::new(1.0, 0.0));
    let uneven = Motion { times_s: vec![0.0], points_m: vec![] };
    assert_eq!(uneven.at(1.0).0, Vec2::zeros());
}

proptest! {
    #[test]
    fn stays_between_its_knots_and_passes_through_them(m in motions()) {
        for k in 0..m.times_s.len() {
            let (p, _) = m.at(m.times_s[k]);
            prop_assert_eq!([p.x, p.y], m.points_m[k]);
        }
        for k in 1..m.times_s.len() {
            let mut before = m.points_m[k - 1];
            for i in 0..=200 {
                let t = m.times_s[k - 1] + (m.times_s[k] - m.times_s[k - 1]) * f64::from(i) / 200.0;
                let t = t.min(m.times_s[k]); // round-off may step past the knot
                let p = m.at(t).0;
                for (axis, &x) in [p.x, p.y].iter().enumerate() {
                    let (a, b) = (m.points_m[k - 1][axis], m.points_m[k][axis]);
                    prop_assert!(x >= a.min(b) && x <= a.max(b));
                    prop_assert!((x - before[axis]) * (b - a).signum() >= -1e-13, "goes back");
                    before[axis] = x;
                }
            }
        }
    }

    #[test]
    fn velocity_and_acceleration_are_continuous_and_velocity_is_the_derivative(m in motions()) {
        let h = 1e-6;
        // Jerk of a quintic with zero end accelerations is at most 60·(4 + 4·1.25)·step/dt³ < 600
        // step/dt³.
        let jerk = (1..m.times_s.len()).map(|k| {
            let (a, b) = (m.points_m[k - 1], m.points_m[k]);
            600.0 * (b[0] - a[0]).hypot(b[1] - a[1]) / (m.times_s[k] - m.times_s[k - 1]).powi(3)
        }).fold(0.0, f64::max);
        for i in 0..=100 {
            let t = m.end_s() * f64::from(i) / 100.0;
            let difference = (m.at(t + h).0 - m.at(t - h).0) / (2.0 * h);
            prop_assert!((difference - m.at(t).1).norm() < 1e-7 + jerk * h * h, "{}", t);
        }
        for &t in &m.times_s {
            let (left, right) = ((m.at(t).1 - m.at(t - h).1) / h, (m.at(t + h).1 - m.at(t).1) / h);
            prop_assert!((left - right).norm() <= 1e-5 + jerk * h, "acceleration jumps by {:?} at {}", left - right, t);
        }
    }

    #[test]
    fn rests_where_it_turns_before_it_starts_and_after_it_ends(m in motions()) {
        let n = m.times_s.len();
        for k in 0..n {
            let v = m.at(m.times_s[k]).1;
            for axis in 0..2 {
                let turns = k == 0 || k + 1 == n || {
                    let (a, b, c) = (m.points_m[k - 1], m.points_m[k], m.points_m[k + 1]);
                    (b[axis] - a[axis]) * (c[axis] - b[axis]) <= 0.0
                };
                prop_assert_eq!(turns, v[axis] == 0.0, "at knot {} axis {}: {}", k, axis, v[axis]);
            }
        }
        let (p, v) = m.at(m.end_s() + 3.0);
        prop_assert_eq!([p.x, p.y], m.points_m[n - 1]);
        prop_assert_eq!(v, Vec2::zeros());
        prop_assert_eq!(m.at(-1.0).1, Vec2::zeros());
    }
}
