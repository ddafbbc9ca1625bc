//! These tests compare spans and chains of the elastic catenary with its equations, over wide
//! ranges of slack and stiffness.

use super::closed_form::ChainPiece;
use super::*;
use crate::math::Vec2;
use proptest::prelude::*;

fn span(x: f64, z: f64, length: f64, w: f64, ea: f64) -> Span {
    Span { chord: Vec2::new(x, z), length, weight: Vec2::new(0.0, -w), axial_stiffness: ea, thermal_stretch: 1.0 }
}

/// The widest grid of the method notes: shapes × L/chord × EA, weight 10 N/m.
fn grid() -> Vec<Span> {
    let mut out = Vec::new();
    for (x, z) in [(100.0, 0.0), (100.0, 50.0), (1.0, 100.0), (0.0, 100.0), (100.0, -50.0), (-30.0, 40.0)] {
        for ratio in [0.9, 0.999, 1.0, 1.0001, 1.01, 1.1, 1.5, 3.0, 10.0, 100.0] {
            for ea in [1e3, 1e4, 1e6, 1e7, 1e9] {
                let chord = f64::hypot(x, z);
                out.push(span(x, z, ratio * chord, 10.0, ea));
            }
        }
    }
    out
}

#[test]
fn grid_closes_in_few_iterations() {
    let (mut total, mut worst) = (0, 0);
    for s in grid() {
        let c = Catenary::solve(&s).unwrap_or_else(|e| panic!("{s:?}: {e}"));
        let gap = (c.position_at(s.length) - s.chord).norm();
        let scale = s.length + s.chord.norm();
        assert!(gap <= 1e-14 * scale, "{s:?} closes to {gap:e}");
        total += c.iterations();
        worst = worst.max(c.iterations());
    }
    println!("worst {worst}, mean {}", total as f64 / grid().len() as f64);
    assert!(worst <= 14, "{worst} iterations");
    assert!(total <= 6 * grid().len(), "{} iterations on average", total as f64 / grid().len() as f64);
}

#[test]
fn hessian_is_the_derivative_of_the_gradient_and_gradient_of_the_energy() {
    // Both branches and their borders; central differences.
    for (h, v) in
        [(5.0, -0.5), (0.7, 0.3), (0.3, -0.5), (0.05, -0.2), (0.2, 0.8), (0.2, -1.9), (-0.3, -0.4), (50.0, 9.0)]
    {
        for (w, eps) in [(1.0, 1e-3), (1.0, 0.5), (0.0, 0.1), (0.5, 0.0)] {
            let p = ChainPiece { w, l: 1.3, eps };
            let (e, d) = (p.energy(h, v), 1e-5);
            let (r, l) = (p.energy(h + d, v), p.energy(h - d, v));
            let (u, b) = (p.energy(h, v + d), p.energy(h, v - d));
            let near = |a: f64, b: f64, what: &str| {
                assert!((a - b).abs() < 2e-7 * (1.0 + a.abs()), "{what} {a} {b} at {h} {v} {w}")
            };
            near(e.x, (r.phi - l.phi) / (2.0 * d), "x");
            near(e.z, (u.phi - b.phi) / (2.0 * d), "z");
            near(e.k11, (r.x - l.x) / (2.0 * d), "k11");
            near(e.k12, (u.x - b.x) / (2.0 * d), "k12");
            near(e.k12, (r.z - l.z) / (2.0 * d), "k21");
            near(e.k22, (u.z - b.z) / (2.0 * d), "k22");
        }
    }
}

#[test]
fn folded_and_hanging_closed_forms() {
    // Coincident ends: V_b = w s₂, s₂ = (Z + L + wL²/2EA)/(2 + wL/EA).
    for (z, ea) in [(0.0, 1e6), (20.0, 1e6), (-35.0, 2e4), (99.0, 1e3)] {
        let (l, w) = (100.0, 20.0);
        let c = Catenary::solve(&span(0.0, z, l, w, ea)).expect("folded");
        let s2 = (z + l + w * l * l / (2.0 * ea)) / (2.0 + w * l / ea);
        assert!((c.end_force().y - w * s2).abs() < 1e-11 * w * l, "{} {}", c.end_force().y, w * s2);
        assert!((c.position_at(l) - Vec2::new(0.0, z)).norm() < 1e-12 * l);
    }
    // Hanging free: elongation w L²/2EA.
    let s = span(0.0, 0.0, 100.0, 20.0, 2e4);
    let c = Catenary::from_start_force(&s, Vec2::new(0.0, -2000.0));
    assert!((c.position_at(100.0) - Vec2::new(0.0, -105.0)).norm() < 1e-12);
}

#[test]
fn weightless_spans_are_bars_or_refused() {
    let c = Catenary::solve(&span(3.0, 4.0, 4.0, 0.0, 1e4)).expect("bar");
    assert!((c.tension_at(1.0) - 2500.0).abs() < 1e-9);
    assert!((c.position_at(4.0) - Vec2::new(3.0, 4.0)).norm() < 1e-14);
    assert!(matches!(Catenary::solve(&span(3.0, 4.0, 6.0, 0.0, 1e4)), Err(SpanError::Slack { .. })));
    assert!(matches!(Catenary::solve(&span(3.0, 4.0, 5.0, 1.0, f64::INFINITY)), Err(SpanError::TooShort { .. })));
    assert!(matches!(Catenary::solve(&span(f64::NAN, 4.0, 5.0, 1.0, 1e4)), Err(SpanError::NotANumber)));
}

#[test]
fn a_chain_of_one_piece_is_the_catenary_and_splitting_changes_nothing() {
    for s in grid().into_iter().step_by(7) {
        let c = Catenary::solve(&s).expect("span");
        let zero = [PointForce { arc_length: 0.3 * s.length, force: Vec2::zeros() }];
        for loads in [&zero[..], &[]] {
            let chain = Chain {
                from: 0.0,
                to: s.length,
                weight: s.weight,
                axial_stiffness: s.axial_stiffness,
                thermal_stretch: 1.0,
                loads,
            };
            let f = chain.solve(s.chord, None).unwrap_or_else(|e| panic!("{s:?} {e}"));
            let gap = (f.start - c.start_force()).norm();
            // Round-off of the closure over the smallest compliance.
            let bound = 1e-13 * s.length / f.compliance.symmetric_eigenvalues().min() + 1e-9 * c.max_tension();
            assert!(gap <= bound, "{s:?}: {gap:e} N");
        }
    }
}

fn wide() -> impl Strategy<Value = (Span, f64)> {
    let signed = prop_oneof![Just(0.0), -3.0..3.0f64]
        .prop_map(|e: f64| if e == 0.0 { 0.0 } else { e.signum() * 10f64.powf(e.abs() - 1.0) });
    (signed.clone(), signed, -0.045..2.0f64, 3.0..9.0f64, -6.0..4.0f64, 0.0..1.0f64).prop_filter_map(
        "coincident ends have no chord to scale by",
        |(x, z, ratio, ea, w, turn)| {
            let chord = f64::hypot(x, z);
            (chord > 0.0).then(|| {
                let weight = if turn < 0.5 { 0.0 } else { turn * 6.0 };
                let mut s = span(x, z, 10f64.powf(ratio) * chord, 0.0, 10f64.powf(ea));
                s.weight = Vec2::new(weight.sin(), -weight.cos()) * 10f64.powf(w);
                (s, turn)
            })
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, ..ProptestConfig::default() })]

    #[test]
    fn every_span_closes_and_balances((s, at) in wide()) {
        let c = Catenary::solve(&s).map_err(|e| TestCaseError::fail(format!("{s:?}: {e}")))?;
        // Closure, from the position formula itself.
        let gap = (c.position_at(s.length) - s.chord).norm();
        let scale = s.length + s.chord.norm();
        prop_assert!(gap <= 1e-12 * scale, "closes to {gap:e} of {scale}");
        // Equilibrium: the end forces carry the load.
        let sum = c.end_force() - c.start_force() + s.weight * s.length;
        prop_assert!(sum.norm() <= 1e-14 * (c.max_tension() + s.weight.norm() * s.length));
        // Tangent: the cable leaves along its force, stretched by 1 + T/EA (central difference).
        let (m, d) = (s.length * (0.1 + 0.8 * at), s.length * 1e-6);
        let slope = (c.position_at(m + d) - c.position_at(m - d)) / (2.0 * d);
        let (f, t) = (c.force_at(m), c.tension_at(m));
        let expected = f / t * (1.0 + t / s.axial_stiffness);
        // The difference errs by (w d/T)², which is large only at a fold: skip those.
        if t > 1e3 * s.weight.norm() * d {
            prop_assert!((slope - expected).norm() < 2e-6 * expected.norm(), "{slope:?} {expected:?}");
        }
        // Stretched length identity, Simpson over T against the closed form.
        let n = 200;
        let step = s.length / f64::from(n);
        let simpson: f64 = (0..=n)
            .map(|i| {
                let k = if i == 0 || i == n { 1.0 } else if i % 2 == 1 { 4.0 } else { 2.0 };
                k * c.tension_at(f64::from(i) * step)
            })
            .sum::<f64>() * step / 3.0;
        let stretched = s.length + simpson / s.axial_stiffness;
        prop_assert!((c.stretched_to(s.length) - stretched).abs() < 1e-4 * stretched);
    }

    #[test]
    fn chains_with_loads_close_and_balance(
        (s, _) in wide(),
        at in prop::collection::vec(0.01..0.99f64, 1..5),
        force in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 5),
    ) {
        let mut at = at;
        at.sort_by(f64::total_cmp);
        let size = s.weight.norm() * s.length;
        let loads: Vec<PointForce> = at.iter().zip(&force)
            .map(|(a, f)| PointForce { arc_length: a * s.length, force: Vec2::new(f.0, f.1) * size })
            .collect();
        let chain = Chain { from: 0.0, to: s.length, weight: s.weight, axial_stiffness: s.axial_stiffness, thermal_stretch: 1.0, loads: &loads };
        let f = chain.solve(s.chord, None).map_err(|e| TestCaseError::fail(format!("{s:?} {loads:?}: {e}")))?;
        let (mut end, mut force_end) = (Vec2::zeros(), Vec2::zeros());
        for (_, at, c) in chain.spans(f.start, Vec2::zeros()) {
            end = at + c.span().chord;
            force_end = c.end_force();
        }
        prop_assert!((end - s.chord).norm() <= 1e-11 * (s.length + s.chord.norm()), "closes to {:e}", (end - s.chord).norm());
        prop_assert!((force_end - f.end).norm() <= 1e-11 * (size * 6.0 + f.start.norm()));
    }
}

#[test]
fn nearly_vertical_and_nearly_taut_spans_close() {
    // At the places where the cable's own stretch alone closes the span, the upper part carries H ≪
    // wL and the energy is flat to the last digit.
    for aside in [1e-8, 1e-6, 1e-5, 4.1e-5, 1e-4, 1e-3, 1e-2] {
        for excess in [-1e-3, -1e-6, -1e-9, 0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3] {
            for eps in [1e-12, 1e-9, 1e-7, 1e-6, 8.65e-6, 1e-4, 1e-3, 1e-2] {
                for up in [1.0, -1.0] {
                    let s = span(aside, up, f64::hypot(aside, 1.0) * (1.0 + excess), 1.0, 1.0 / eps);
                    let c = Catenary::solve(&s).unwrap_or_else(|e| panic!("{s:?}: {e}"));
                    let gap = (c.position_at(s.length) - s.chord).norm();
                    assert!(gap <= 1e-12 && c.iterations() <= 14, "{s:?}: {gap:e} m in {}", c.iterations());
                }
            }
        }
    }
}
