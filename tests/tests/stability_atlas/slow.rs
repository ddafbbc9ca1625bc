//! These cells are slow motions with friction: lagged and penalty methods lose tension, creep away
//! or lock.

use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support};
use cable_core::{Model, SolveError};

use super::{G, ON_FLOOR, Regime, Verdict, cable, load, on_a_floor, simulation};

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime { name: "tail drawn over a floor", figure: "μwL", judge: |m| drag(m, 1e6, 50) },
        Regime { name: "the same in one step of 0.5 m, EA 1e8", figure: "μwL", judge: |m| drag(m, 1e8, 1) },
        Regime { name: "pull over a floor turned round", figure: "P − μwL", judge: reversal },
        Regime {
            name: "drawn over a sharp corner of 40°", figure: "e^{μφ}, worst frame", judge: |m| drawn(m, None)
        },
        Regime {
            name: "drawn over a round of 40°, R 0.3 m",
            figure: "e^{μφ}, worst frame",
            judge: |m| drawn(m, Some(0.3)),
        },
        Regime { name: "held over a round for 60 s", figure: "tension lost", judge: hold },
    ]
}

/// A cable on a floor, pulled by its end.
fn on_the_floor(ea: f64, tail: Support, way: Vec<[f64; 2]>) -> Scene {
    let times_s = (0..way.len()).map(|k| k as f64).collect();
    let at = [5.0, ON_FLOOR];
    let hitch = Support { motion: Some(Motion { times_s, points_m: way }), ..Support::fixed("hitch", at) };
    on_a_floor(ea, vec![tail, hitch])
}

fn drag(model: Model, ea: f64, steps: u32) -> Result<Verdict, SolveError> {
    let scene = on_the_floor(ea, Support::free("tail"), vec![[5.0, 0.01], [5.5, 0.01]]);
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    for _ in 0..steps {
        sim.step_quasi_static(1.0 / f64::from(steps))?;
    }
    let answer = sim.solution();
    let off = -answer.cables[0].supports[1].reaction_x_n / (0.5 * 5.0 * G) - 1.0;
    Ok(Verdict::of(off.abs(), 1e-2, &answer))
}

fn reversal(model: Model) -> Result<Verdict, SolveError> {
    let scene = on_the_floor(1e6, load("tail", [-100.0, 0.0]), vec![[5.0, 0.01], [5.3, 0.01], [5.0, 0.01]]);
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    for _ in 0..40 {
        sim.step_quasi_static(0.05)?;
    }
    let answer = sim.solution();
    let off = -answer.cables[0].supports[1].reaction_x_n / (100.0 - 0.5 * 5.0 * G) - 1.0;
    Ok(Verdict::of(off.abs(), 1e-2, &answer))
}

/// Light for its pull (its weight changes tension by 5e-4), over a beam that turns it by 40°, a
/// dead load on one end and a hand on the other.
fn over_a_beam(radius_m: Option<f64>) -> Scene {
    let half = 20f64.to_radians();
    let (sin, cos) = half.sin_cos();
    let (near, far) = ([2.6 * cos, -2.6 * sin], [2.9 * cos, -2.9 * sin]);
    let motion = Some(Motion { times_s: vec![0.0, 3.0], points_m: vec![near, far] });
    let ends = vec![load("load", [-100.0 * cos, -100.0 * sin]), Support { motion, ..Support::fixed("hand", near) }];
    let mut scene = cable([6.0, 5e-3, 1e6], ends);
    scene.cables[0].route_m = vec![[-3.4 * cos, -3.4 * sin], [0.0, 0.01 / cos + 1e-4], near];
    let (x, y) = (3.0 * (half + 0.35).cos(), -3.0 * (half + 0.35).sin());
    let shape = match radius_m {
        Some(radius_m) => Shape::Circle { center_m: [0.0, -radius_m], radius_m },
        None => Shape::Polygon { points_m: vec![[0.0, 0.0], [-x, y], [x, y]] },
    };
    scene.obstacles = vec![Obstacle { name: "beam".to_owned(), shape, friction: Some(0.3) }];
    scene
}

/// Pull of the hand: the load, turned from its direction to the tangent from the hand to the round,
/// and what the cable weighs between (N/m) up and down.
fn exact(radius: f64, hand: [f64; 2], load: [f64; 2]) -> f64 {
    let (round, weight) = (radius + 0.01, 5e-3 * G);
    let (x, y) = (hand[0], hand[1] + radius);
    let down = (-y).atan2(x) + (round / x.hypot(y)).asin();
    let turn = 20f64.to_radians() + down;
    (100.0 + weight * (0.01 - load[1])) * (0.3 * turn).exp() - weight * (0.01 - hand[1])
}

fn drawn(model: Model, radius_m: Option<f64>) -> Result<Verdict, SolveError> {
    let mut sim = simulation(over_a_beam(radius_m), model)?;
    sim.settle()?;
    let radius = radius_m.unwrap_or(0.0);
    let exact = |hand: [f64; 2], load: [f64; 2]| exact(radius, hand, load);
    let mut worst = Verdict::Right(0.0);
    let mut most = 0.0;
    for k in 0..100 {
        sim.step_quasi_static(0.03)?;
        let answer = sim.solution();
        let hand = &answer.cables[0].supports[1];
        let tail = &answer.cables[0].nodes[0];
        let off = hand.reaction_x_n.hypot(hand.reaction_y_n) / exact([hand.x_m, hand.y_m], [tail.x_m, tail.y_m]) - 1.0;
        let off = off.abs();
        // It slides everywhere after a while.
        if k >= 40 && off >= most {
            (most, worst) = (off, Verdict::of(off, 2e-3, &answer));
            if matches!(worst, Verdict::Wrong(_)) {
                break;
            }
        }
    }
    Ok(worst)
}

fn hold(model: Model) -> Result<Verdict, SolveError> {
    let mut scene = over_a_beam(Some(0.3));
    scene.cables[0].segments = Some(30);
    // Soft, for the sake of explicit steps: it would creep as well.
    scene.cables[0].axial_stiffness_n = 2e4;
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    for _ in 0..20 {
        sim.step_quasi_static(0.15)?;
    }
    let tension = |s: &cable_core::Solution| {
        let hand = &s.cables[0].supports[1];
        hand.reaction_x_n.hypot(hand.reaction_y_n)
    };
    let before = tension(&sim.solution());
    // The hand rests after its motion.
    for _ in 0..3600 {
        sim.step(1.0 / 60.0)?;
    }
    let answer = sim.solution();
    let mut verdict = Verdict::of((tension(&answer) / before - 1.0).abs(), 1e-3, &answer);
    if let Verdict::Said(e, _) = verdict {
        // The verdict is about the corner, not about a support.
        verdict = Verdict::Wrong(e);
    }
    Ok(verdict)
}
