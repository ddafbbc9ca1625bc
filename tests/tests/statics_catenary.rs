//! These tests compare the free-span families of `data/statics.json` (catenary, degenerate, point
//! loads, thermal, wind) with the core, each with an identity that does not use the solver.
//!
//! Tolerance: 1e-9 of the case's largest force or length; 1e-8 for stiff spans within 0.1 % of
//! taut, whose digits double precision loses to L − chord: 4 to 5 of them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::Vec2;
use cable_core::catenary::{Catenary, Chain, PointForce, Span};
use serde_json::Value;

const TOLERANCE: f64 = 1e-9;
const NEAR_TAUT_TOLERANCE: f64 = 1e-8;

fn family(name: &str) -> Vec<(String, Value, Value)> {
    let all: Value = serde_json::from_str(include_str!("../data/statics.json")).expect("statics.json");
    let cases = all["cases"][name].as_object().expect("a family");
    cases.iter().map(|(k, c)| (format!("{name} {k}"), c["in"].clone(), c["out"].clone())).collect()
}

fn number(v: &Value, key: &str) -> f64 {
    v[key].as_f64().unwrap_or_else(|| panic!("no {key} in {v}"))
}

fn span(x: f64, z: f64, length: f64, weight: Vec2, ea: f64) -> Span {
    Span { chord: Vec2::new(x, z), length, weight, axial_stiffness: ea, thermal_stretch: 1.0 }
}

fn stiffness(input: &Value) -> f64 {
    input["EA"].as_f64().unwrap_or(f64::INFINITY)
}

#[track_caller]
fn near(case: &str, what: &str, got: f64, expected: f64, bound: f64) {
    assert!(
        (got - expected).abs() <= bound,
        "{case}: {what} = {got:e}, expected {expected:e}, off by {:e}",
        got - expected
    );
}

/// Equilibrium of the whole, closure, and the moment of the load about the start, by Simpson.
fn identities(case: &str, c: &Catenary) {
    let s = c.span();
    let force = c.max_tension() + s.weight.norm() * s.length;
    let length = s.length + s.chord.norm();
    let sum = c.end_force() - c.start_force() + s.weight * s.length;
    assert!(sum.norm() <= 1e-13 * force, "{case}: forces do not balance by {sum:?}");
    let gap = (c.position_at(s.length) - s.chord).norm();
    assert!(gap <= 1e-13 * length, "{case}: closes to {gap:e} m");
    // Moments about the start: chord × F_b + ∫ r × b ds = 0.
    let n = 4000;
    let step = s.length / f64::from(n);
    let mut first = Vec2::zeros();
    for i in 0..=n {
        let k = if i == 0 || i == n { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
        first += c.position_at(f64::from(i) * step) * (k * step / 3.0);
    }
    let cross = |a: Vec2, b: Vec2| a.x * b.y - a.y * b.x;
    let moment = cross(s.chord, c.end_force()) + cross(first, s.weight);
    assert!(moment.abs() <= 1e-6 * force * length, "{case}: moment {moment:e}");
}

#[test]
fn catenary_family() {
    let cases = family("catenary");
    assert!(cases.len() >= 72);
    for (case, input, out) in cases {
        let (x, z, l, w, ea) =
            (number(&input, "X"), number(&input, "Z"), number(&input, "L"), number(&input, "w"), stiffness(&input));
        let c = Catenary::solve(&span(x, z, l, Vec2::new(0.0, -w), ea)).unwrap_or_else(|e| panic!("{case}: {e}"));
        let ratio = l / x.hypot(z);
        let tolerance = if ratio <= 1.001 && ea >= 1e8 { NEAR_TAUT_TOLERANCE } else { TOLERANCE };
        let (force, length) = (number(&out, "Tmax") * tolerance, (l + x.hypot(z)) * tolerance);
        for (key, got) in [
            ("H", c.start_force().x * x.signum()),
            ("VA", c.start_force().y),
            ("VB", c.end_force().y),
            ("TA", c.tension_at(0.0)),
            ("TB", c.tension_at(l)),
            ("Tmax", c.max_tension()),
        ] {
            near(&case, key, got, number(&out, key), force);
        }
        near(&case, "L_stretched", c.stretched_to(l), number(&out, "L_stretched"), length);
        near(&case, "sag", c.sag(), number(&out, "sag"), length);
        for (key, got) in [("x_low", c.lowest().x), ("z_low", c.lowest().y)] {
            if out[key].is_number() && c.lowest_s() > 0.0 && c.lowest_s() < l {
                near(&case, key, got, number(&out, key), length);
            }
        }
        for p in out["shape"].as_array().into_iter().flatten() {
            let [s, px, pz] = [0, 1, 2].map(|k| p[k].as_f64().expect("a shape number"));
            let at = c.position_at(s);
            near(&case, "x", at.x, px, length);
            near(&case, "z", at.y, pz, length);
        }
        identities(&case, &c);
        if ea.is_infinite() && x > 0.0 {
            // √(L² − Z²) = 2a sinh(X/2a)
            let a = c.start_force().x / w;
            let chord = ((l - z) * (l + z)).sqrt();
            near(&case, "length identity", 2.0 * a * (x / (2.0 * a)).sinh(), chord, 1e-10 * l);
        }
    }
}

#[test]
fn degenerate_family() {
    for (case, input, out) in family("degenerate") {
        let (l, w, ea) = (number(&input, "L"), number(&input, "w"), stiffness(&input));
        let weight = Vec2::new(0.0, -w);
        if out["Ttop"].is_number() {
            // Hanging free: the top carries everything.
            let c = Catenary::from_start_force(&span(0.0, 0.0, l, weight, ea), weight * l);
            near(&case, "Ttop", c.tension_at(0.0), number(&out, "Ttop"), TOLERANCE * w * l);
            near(&case, "elongation", -c.position_at(l).y - l, number(&out, "elong"), TOLERANCE * l);
            near(&case, "quarter", c.position_at(l / 4.0).y, number(&out, "z_quarter_from_top"), TOLERANCE * l);
            near(&case, "elongation identity", -c.position_at(l).y - l, w * l * l / (2.0 * ea), 1e-12 * l);
            continue;
        }
        let (x, z) = (number(&input, "X"), number(&input, "Z"));
        let c = Catenary::solve(&span(x, z, l, weight, ea)).unwrap_or_else(|e| panic!("{case}: {e}"));
        let force = TOLERANCE * (c.max_tension() + w * l);
        near(&case, "H", c.start_force().x, number(&out, "H"), force);
        // A vanishing H is small, not lost: it keeps its own digits.
        near(&case, "H (relative)", c.start_force().x, number(&out, "H"), 1e-7 * number(&out, "H"));
        near(&case, "VA", c.start_force().y, number(&out, "VA"), force);
        near(&case, "VB", c.end_force().y, number(&out, "VB"), force);
        if out["s_low"].is_number() {
            near(&case, "s_low", c.lowest_s(), number(&out, "s_low"), TOLERANCE * l);
        }
        near(&case, "z_low", c.lowest().y, number(&out, "z_low"), TOLERANCE * l);
        for key in ["sag", "Tmax", "L_stretched"] {
            if out[key].is_number() {
                let got = match key {
                    "sag" => c.sag(),
                    "Tmax" => c.max_tension(),
                    _ => c.stretched_to(l),
                };
                near(&case, key, got, number(&out, key), TOLERANCE * number(&out, "Tmax").max(l));
            }
        }
        for p in out["shape"].as_array().into_iter().flatten() {
            let [s, px, pz] = [0, 1, 2].map(|k| p[k].as_f64().expect("a shape number"));
            near(&case, "x", c.position_at(s).x, px, TOLERANCE * l);
            near(&case, "z", c.position_at(s).y, pz, TOLERANCE * l);
        }
        identities(&case, &c);
    }
}

fn chain(input: &Value, lengths: [f64; 2], loads: &[PointForce]) -> (Vec2, Vec2, Vec2) {
    let chain = Chain {
        from: 0.0,
        to: lengths[0] + lengths[1],
        weight: Vec2::new(0.0, -number(input, "w")),
        axial_stiffness: stiffness(input),
        thermal_stretch: 1.0,
        loads,
    };
    let f = chain.solve(Vec2::new(number(input, "X"), input["Z"].as_f64().unwrap_or(0.0)), None).expect("chain");
    let (_, node, _) = chain.spans(f.start, Vec2::zeros()).nth(1).expect("two pieces");
    (f.start, f.end, node)
}

#[test]
fn point_load_family() {
    for (case, input, out) in family("point_load") {
        let lengths = if input["L1"].is_number() {
            [number(&input, "L1"), number(&input, "L2")]
        } else {
            [number(&out, "L1"), number(&out, "L2")]
        };
        let load = |p: f64| [PointForce { arc_length: lengths[0], force: Vec2::new(0.0, -p) }];
        let p = number(&input, "P");
        let (start, end, node) = chain(&input, lengths, &load(p));
        let (dead, _, dead_node) = chain(&input, lengths, &load(0.0));
        let (force, length) = (TOLERANCE * start.norm().max(end.norm()), TOLERANCE * (lengths[0] + lengths[1]));
        near(&case, "H", start.x, number(&out, "H"), force);
        near(&case, "VA", start.y, number(&out, "VA"), force);
        near(&case, "H_dead", dead.x, number(&out, "H_dead"), force);
        near(&case, "ux", node.x - dead_node.x, number(&out, "ux"), length);
        near(&case, "uz", node.y - dead_node.y, number(&out, "uz"), length);
        for (key, got) in [("VB", end.y), ("TA", start.norm()), ("TB", end.norm())] {
            if out[key].is_number() {
                near(&case, key, got, number(&out, key), force);
            }
        }
        for (key, got) in [("x", node.x), ("z", node.y), ("x_dead", dead_node.x), ("z_dead", dead_node.y)] {
            if out[key].is_number() {
                near(&case, key, got, number(&out, key), length);
            }
        }
        if input["x_node"].is_number() {
            near(&case, "x_node", dead_node.x, number(&input, "x_node"), length);
            near(&case, "sag_node", -dead_node.y, number(&input, "sag_node"), length);
        }
        // Equilibrium: the ends carry weight and load, H is the same on both sides.
        near(
            &case,
            "vertical balance",
            end.y - start.y,
            number(&input, "w") * (lengths[0] + lengths[1]) + p,
            1e-13 * start.norm(),
        );
        near(&case, "horizontal balance", end.x, start.x, 1e-13 * start.norm());
    }
}

#[test]
fn thermal_family() {
    for (case, input, out) in family("thermal") {
        let w = number(&input, "w0");
        let s = Span {
            thermal_stretch: 1.0 + number(&input, "alpha") * number(&input, "dT"),
            ..span(
                number(&input, "X"),
                number(&input, "Z"),
                number(&input, "L0"),
                Vec2::new(0.0, -w),
                stiffness(&input),
            )
        };
        let c = Catenary::solve(&s).unwrap_or_else(|e| panic!("{case}: {e}"));
        let force = TOLERANCE * c.max_tension();
        near(&case, "H", c.start_force().x, number(&out, "H"), force);
        near(&case, "VA", c.start_force().y, number(&out, "VA"), force);
        near(&case, "TB", c.tension_at(s.length), number(&out, "TB"), force);
        near(&case, "sag", c.sag(), number(&out, "sag"), TOLERANCE * s.length);
        // Total weight is conserved.
        near(&case, "weight", c.end_force().y - c.start_force().y, w * s.length, 1e-13 * w * s.length);
        identities(&case, &c);
    }
}

#[test]
fn wind_family() {
    for (case, input, out) in family("wind") {
        let x = number(&input, "X");
        if input["p_per_horizontal"].is_number() {
            // Load per horizontal metre: the parabola, whose length the case states. The catenary's
            // weight per metre of cable cannot give it; checked is that the numbers are those of
            // H = pX²/8f.
            let (p, f) = (number(&input, "p_per_horizontal"), number(&input, "sag"));
            near(&case, "H", p * x * x / (8.0 * f), number(&out, "H"), TOLERANCE * number(&out, "H"));
            continue;
        }
        let (w, q, l) = (number(&input, "w"), number(&input, "q"), number(&input, "L"));
        let s = span(x, input["Z"].as_f64().unwrap_or(0.0), l, Vec2::new(q, -w), stiffness(&input));
        let c = Catenary::solve(&s).unwrap_or_else(|e| panic!("{case}: {e}"));
        let force = TOLERANCE * c.max_tension();
        for (key, got) in [
            ("TAx", c.start_force().x),
            ("TAz", c.start_force().y),
            ("TBx", c.end_force().x),
            ("TBz", c.end_force().y),
            ("TA", c.tension_at(0.0)),
            ("TB", c.tension_at(l)),
        ] {
            near(&case, key, got, number(&out, key), force);
        }
        let mid = c.position_at(l / 2.0);
        near(&case, "x_mid", mid.x, number(&out, "x_mid"), TOLERANCE * l);
        near(&case, "z_mid", mid.y, number(&out, "z_mid"), TOLERANCE * l);
        identities(&case, &c);
    }
}
