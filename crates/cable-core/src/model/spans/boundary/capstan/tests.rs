//! These tests compare the capstan law along boundaries with closed forms.

use crate::contact::World;
use crate::math::Vec2;
use crate::model::spans::boundary::capstan::*;
use crate::model::spans::boundary::{ChainRange, Curve};
use crate::scene::obstacle::{Obstacle, Shape};
use proptest::prelude::*;

fn law(stiffness: f64) -> CableLaw {
    CableLaw::new(Vec2::new(0.7, -9.0), 1.001, stiffness)
}

const ROUND: ChainRange = ChainRange { first: 0, last: 0 };

fn on(curve: &Curve, chain_range: ChainRange, law: CableLaw, friction: f64) -> ContactPath<'_> {
    ContactPath {
        curve,
        chain_range,
        law,
        friction,
        drag: 0.0,
        floored: false,
        friction_of_loose: friction,
        cached_piece: None,
    }
}

/// dT/dψ = mT − (c/λ)(b·t + m b·n) and ds/dψ = c/λ by 4th-order Runge–Kutta.
fn stepped(contact_path: &ContactPath<'_>, from: f64, to: f64, t: f64, m: f64) -> (f64, f64) {
    const STEPS: usize = 4000;
    let rate = |p: f64, t: f64| {
        let place = contact_path.place(p);
        (contact_path.law.slope(&place, t, m), place.stretch / contact_path.law.stretch(t))
    };
    let h = (to - from) / STEPS as f64;
    let (mut t, mut s) = (t, 0.0);
    for k in 0..STEPS {
        let p = from + k as f64 * h;
        let a = rate(p, t);
        let b = rate(p + 0.5 * h, t + 0.5 * h * a.0);
        let c = rate(p + 0.5 * h, t + 0.5 * h * b.0);
        let d = rate(p + h, t + h * c.0);
        t += h / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + d.0);
        s += h / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + d.1);
    }
    (t, s)
}

/// Terms that the closed form neglects, N and m. With δT of the order of ε = cb/EA times T, the
/// tension is corrected for it, the material is not: ε² T and c ψ ε T/EA.
fn left_out(contact_path: &ContactPath<'_>, radius: f64, turn: f64, t: f64) -> [f64; 2] {
    let stiffness = contact_path.law.stiffness;
    let part = 9.0 * radius / stiffness;
    [4.0 * part * part * t, radius * turn.abs() * part * t / stiffness]
}

#[test]
fn a_sharp_corner_multiplies() {
    let corner = Curve::wheel(0.0, 0.3, 1.0);
    let contact_path = on(&corner, ROUND, law(1e5), 0.3);
    for (m, angle) in [(0.3f64, 2.0f64), (-0.3, 1.0), (0.0, 3.0), (0.3, 20.0)] {
        let way = contact_path.slide(0.1, 0.1 + angle, 100.0, m);
        assert!((way.tension / (100.0 * (m * angle).exp()) - 1.0).abs() < 1e-14);
        assert_eq!(way.material, 0.0);
    }
}

/// Θ = T + T²/2EA grows by −(b·t + m b·n)/τ per metre, and the material is ΔT over τ times that.
#[test]
fn on_a_slope_theta_is_linear() {
    let shape = Shape::Terrain { points_m: vec![[0.0, 0.0], [10.0, 3.0]] };
    let world = World::new(&[Obstacle { name: "slope".to_owned(), shape, friction: None }], 0.4, 0.01);
    let [curve, _] = Curve::both(&world.geometry().bodies()[0]);
    let law = law(1e4);
    let edge = (0..3).find(|&i| curve.place_on(i, 0.0).turn == 0.0).unwrap();
    let (_, chain_range) = curve.chain(edge, law.load).unwrap();
    let contact_path = on(&curve, chain_range, law, 0.4);
    let p = curve.origin(edge) + 1.0;
    let (sin, cos) = (3.0f64 / 109.0f64.sqrt(), 10.0 / 109.0f64.sqrt());
    let (bt, bn) = (0.7 * cos - 9.0 * sin, -0.7 * sin - 9.0 * cos);
    for m in [0.4, -0.4, 0.0] {
        let way = contact_path.slide(p, p + 6.0, 50.0, m);
        let grown = law.theta(way.tension) - law.theta(50.0);
        assert!((grown - -(bt + m * bn) / law.thermal * 6.0).abs() < 1e-12 * 50.0, "{grown}");
        let (t, s) = stepped(&contact_path, p, p + 6.0, 50.0, m);
        assert!((way.tension - t).abs() < 1e-9 && (way.material - s).abs() < 1e-11, "{way:?} {t} {s}");
    }
}

proptest! {
    /// Compares the heavy capstan with its differential equation, in both directions.
    #[test]
    fn a_heavy_capstan_follows_its_equation(
        radius in 0.01f64..2.0, m in -0.8f64..0.8, from in -3.0f64..3.0, turn in -5.0f64..5.0,
        sense in prop_oneof![Just(1.0), Just(-1.0)], log_t in 1.5f64..4.0, log_ea in 4.5f64..8.0,
    ) {
        let (wheel, t) = (Curve::wheel(radius, m.abs(), sense), 10f64.powf(log_t));
        let contact_path = on(&wheel, ROUND, law(10f64.powf(log_ea)), m.abs());
        let way = contact_path.slide(from, from + turn, t, m);
        let (stepped_t, stepped_s) = stepped(&contact_path, from, from + turn, t, m);
        prop_assume!(stepped_t > 1.0);
        let size = stepped_t + t + 9.0 * radius;
        let left = left_out(&contact_path, radius, turn, size);
        prop_assert!((way.tension - stepped_t).abs() <= 1e-9 * size + left[0], "{} {stepped_t}", way.tension);
        prop_assert!((way.material - stepped_s).abs() <= 1e-9 * (1.0 + radius * turn.abs()) + left[1], "{} {stepped_s}", way.material);
    }

    /// Compares ∂T and ∂s by the tension at the start with differences, and one path with two
    /// successive parts of it.
    #[test]
    fn a_way_has_its_derivatives_and_may_be_taken_in_parts(
        radius in 0.0f64..1.0, m in -0.8f64..0.8, turn in 0.1f64..4.0, part in 0.1f64..0.9, log_ea in 4.0f64..8.0,
    ) {
        let wheel = Curve::wheel(radius, 0.8, 1.0);
        let contact_path = on(&wheel, ROUND, law(10f64.powf(log_ea)), 0.8);
        let (t, h) = (200.0, 0.01);
        let way = contact_path.slide(0.0, turn, t, m);
        let (up, down) = (contact_path.slide(0.0, turn, t + h, m), contact_path.slide(0.0, turn, t - h, m));
        let by = (up.tension - down.tension) / (2.0 * h);
        prop_assert!((way.by_tension - by).abs() <= 2e-3 * by.abs(), "{} {by}", way.by_tension);
        let by = (up.material - down.material) / (2.0 * h);
        prop_assert!((way.material_by_tension - by).abs() <= 1e-2 * by.abs() + 1e-12, "{} {by}", way.material_by_tension);
        let first = contact_path.slide(0.0, part * turn, t, m);
        let both = first.then(contact_path.slide(part * turn, turn, first.tension, m));
        let left = left_out(&contact_path, radius, turn, way.tension.abs() + t);
        prop_assert!((both.tension - way.tension).abs() <= 1e-9 * way.tension.abs() + left[0]);
        prop_assert!((both.material - way.material).abs() <= 1e-9 + left[1]);
    }
}
