//! These cells are spans at rest that solvers are known to miss. The answer is judged by Irvine's
//! formula alone: the force a model gives at the start, integrated along the unstretched length,
//! must end at the other support (H. M. Irvine, "Cable structures", 1981).

use cable_core::scene::Support;
use cable_core::{Model, SolveError};

use super::{G, Regime, Verdict, cable, load, simulation};

/// Returns where a cable of weight `w` (N/m) ends that leaves the origin with tension components
/// `h`, `v` (N).
fn end([h, v]: [f64; 2], w: f64, length: f64, ea: f64) -> [f64; 2] {
    let top = v + w * length;
    let hung = if h.abs() < 1e-9 * w * length { 0.0 } else { h / w * ((top / h).asinh() - (v / h).asinh()) };
    let x = h * length / ea + hung;
    // The difference of the roots, without cancellation.
    let roots = length * (2.0 * v + w * length) / (h.hypot(top) + h.hypot(v));
    [x, length / ea * (v + 0.5 * w * length) + roots]
}

/// A span of length over chord `ratio` between the origin and `to`, judged by where its start force
/// leads: the miss, over what that force would have to change by, as part of the largest tension.
fn span(model: Model, to: [f64; 2], length: f64, ea: f64, most: f64) -> Result<Verdict, SolveError> {
    let density = 1.0;
    let scene = cable([length, density, ea], vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", to)]);
    let answer = simulation(scene, model)?.settle()?;
    let a = &answer.cables[0].supports[0];
    // The cable pulls support A with what it leaves A with.
    let force = [a.reaction_x_n, a.reaction_y_n];
    let w = density * G;
    let miss = |f: [f64; 2]| {
        let e = end(f, w, length, ea);
        [e[0] - to[0], e[1] - to[1]]
    };
    // One Newton step of the formula, its derivatives by differences, tells how far the force is
    // off.
    let top = answer.max_tension().tension_n;
    let d = 1e-6 * top;
    let m = miss(force);
    let (mx, my) = (miss([force[0] + d, force[1]]), miss([force[0], force[1] + d]));
    let j = [[(mx[0] - m[0]) / d, (my[0] - m[0]) / d], [(mx[1] - m[1]) / d, (my[1] - m[1]) / d]];
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    let change = [(j[1][1] * m[0] - j[0][1] * m[1]) / det, (j[0][0] * m[1] - j[1][0] * m[0]) / det];
    Ok(Verdict::of(change[0].hypot(change[1]) / top, bound(model, most), &answer))
}

/// Straight springs are second order: at 100 of them what a slack or stiff span allows; others as
/// asked.
fn bound(model: Model, most: f64) -> f64 {
    match model {
        Model::MassSpring => 2e-2,
        _ => most,
    }
}

pub fn regimes() -> Vec<Regime> {
    let force = "force at the start";
    vec![
        Regime {
            name: "as long as its chord, EA 1e9",
            figure: force,
            judge: |m| span(m, [100.0, 0.0], 100.0, 1e9, 1e-3),
        },
        Regime {
            name: "0.1 % shorter than its chord, EA 1e9",
            figure: force,
            judge: |m| span(m, [100.0, 0.0], 99.9, 1e9, 1e-3),
        },
        Regime {
            name: "0.1 % longer than its chord, EA 1e6",
            figure: force,
            judge: |m| span(m, [100.0, 30.0], 104.507, 1e6, 1e-3),
        },
        Regime {
            name: "0.01 % longer than its chord, EA 1e4",
            figure: force,
            judge: |m| span(m, [100.0, 0.0], 100.01, 1e4, 1e-3),
        },
        Regime {
            name: "half longer than its chord, EA 1e9",
            figure: force,
            judge: |m| span(m, [100.0, 20.0], 153.0, 1e9, 1e-3),
        },
        Regime { name: "100 times its chord", figure: force, judge: |m| span(m, [1.0, 0.5], 112.0, 1e7, 1e-2) },
        Regime { name: "ends one above the other", figure: force, judge: |m| span(m, [1e-6, 20.0], 25.0, 1e7, 1e-2) },
        Regime { name: "ends at one point", figure: "weight held", judge: coincident },
        Regime {
            name: "as soft as rubber, EA 20 times its weight",
            figure: force,
            judge: |m| span(m, [10.0, 2.0], 11.0, 2e3, 1e-3),
        },
        Regime { name: "two dead loads and nothing that holds", figure: "refused", judge: nothing_holds },
    ]
}

/// Each half hangs straight down: the supports share the weight.
fn coincident(model: Model) -> Result<Verdict, SolveError> {
    let scene = cable([20.0, 1.0, 1e7], vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [0.0, 0.0])]);
    let answer = simulation(scene, model)?.settle()?;
    let off = answer.cables[0].supports.iter().map(|s| (s.reaction_x_n.hypot(s.reaction_y_n + 10.0 * G)) / (10.0 * G));
    Ok(Verdict::of(off.fold(0.0, f64::max), 1e-3, &answer))
}

fn nothing_holds(model: Model) -> Result<Verdict, SolveError> {
    let scene = cable([10.0, 1.0, 1e6], vec![load("A", [-10.0, 0.0]), load("B", [10.0, 0.0])]);
    let answer = simulation(scene, model)?.settle()?;
    Ok(Verdict::of(f64::INFINITY, 0.0, &answer))
}
