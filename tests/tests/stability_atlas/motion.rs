//! These cells are motions that make integrators blow up, gain energy or pass through walls.

use cable_core::scene::{Motion, Obstacle, Shape, Support, SupportKind};
use cable_core::{Model, Simulation, SolveError, Vec2};

use super::{G, ON_FLOOR, Regime, Verdict, cable, on_a_floor, simulation};

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime {
            name: "EA 1e9 swung in steps of 0.1 s",
            figure: "energy gained, of mgL",
            judge: |m| swing(m, 1e9, 0.1, 20),
        },
        Regime {
            name: "EA 1e4 swung in steps of 1/60 s",
            figure: "energy gained, of mgL",
            judge: |m| swing(m, 1e4, 1.0 / 60.0, 120),
        },
        Regime {
            name: "let go from the horizontal for 10 s",
            figure: "energy gained, of mgL",
            judge: |m| swing(m, 1e6, 0.05, 200),
        },
        Regime { name: "dropped slack until it snaps taut", figure: "energy gained, of mgL", judge: snap },
        Regime { name: "an end thrown 10 m in a frame", figure: "depth in a beam, of the cable", judge: thrown },
        Regime { name: "dropped on rubble for 2 s", figure: "depth in the ground, of the cable", judge: rubble },
        Regime { name: "support moved 1 m/s, knots at 60 Hz", figure: "pull of a drag, mean", judge: knots },
        Regime { name: "a step of 0, −1 s, NaN or without end", figure: "refused, nothing changes", judge: no_step },
    ]
}

/// Motion, height and stretch, J.
fn energy(sim: &Simulation) -> f64 {
    let (scene, state) = (sim.scene(), &sim.states()[0]);
    let c = &scene.cables[0];
    let (x, v, s) = (&state.position_m, &state.velocity_m_per_s, &state.arc_length_m);
    let mut out = 0.0;
    for k in 1..s.len() {
        let rest = s[k] - s[k - 1];
        let mass = 0.5 * c.linear_density_kg_per_m * rest;
        let stretch = (x[k] - x[k - 1]).norm() / rest - 1.0;
        out += 0.5 * c.axial_stiffness_n * rest * stretch.max(0.0).powi(2);
        out += [k - 1, k].iter().map(|&i| mass * (0.5 * v[i].norm_squared() + G * x[i].y)).sum::<f64>();
    }
    out
}

/// A chain of 10 m let go from the horizontal: the most energy it ever has more than at the start,
/// over mgL.
fn swing(model: Model, ea: f64, dt: f64, steps: usize) -> Result<Verdict, SolveError> {
    let scene =
        cable([10.0, 1.0, ea], vec![Support::fixed("wall", [0.0, 0.0]), Support::new("tip", SupportKind::Free)]);
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    let mut states = sim.states();
    let straight = states[0].arc_length_m.iter().map(|s| Vec2::new(*s, 0.0)).collect();
    states[0].position_m = straight;
    sim.set_states(&states)?;
    gained(sim, dt, steps)
}

fn gained(mut sim: Simulation, dt: f64, steps: usize) -> Result<Verdict, SolveError> {
    let start = energy(&sim);
    let mut most = 0.0;
    for _ in 0..steps {
        sim.step(dt)?;
        let gain = (energy(&sim) - start) / (10.0 * 10.0 * G);
        most = if gain > most || gain.is_nan() { gain } else { most };
    }
    Ok(Verdict::of(most, 1e-2, &sim.solution()))
}

/// 10 m of cable between two ends 9 m apart, lifted by half a metre and dropped.
fn snap(model: Model) -> Result<Verdict, SolveError> {
    let scene = cable([10.0, 1.0, 1e6], vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [9.0, 0.0])]);
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    let mut states = sim.states();
    for p in &mut states[0].position_m {
        p.y = -p.y;
    }
    sim.set_states(&states)?;
    gained(sim, 1.0 / 60.0, 240)
}

/// Returns how deep nodes are in what is there, over the cable's radius.
fn deepest(sim: &Simulation, depth: impl Fn(Vec2) -> f64) -> f64 {
    let radius = 0.5 * sim.scene().cables[0].diameter_m;
    let deep = sim.states()[0]
        .position_m
        .iter()
        .map(|p| depth(*p))
        .fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a });
    deep / radius
}

fn thrown(model: Model) -> Result<Verdict, SolveError> {
    let mut scene = cable([12.0, 1.0, 1e5], vec![Support::fixed("A", [0.0, 5.0]), Support::fixed("B", [9.0, 4.0])]);
    scene.cables[0].segments = Some(60);
    scene.obstacles = vec![Obstacle {
        name: "beam".to_owned(),
        shape: Shape::Polygon { points_m: vec![[4.0, -3.0], [4.1, -3.0], [4.1, -1.0], [4.0, -1.0]] },
        friction: Some(0.3),
    }];
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    sim.drag_support(0, 1, Vec2::new(0.5, -2.0));
    let mut most = 0.0f64;
    for _ in 0..60 {
        sim.step(1.0 / 60.0)?;
        // Depth of the centre line in the beam grown by the cable's radius less a tenth of it.
        most = most.max(deepest(&sim, |p| (p.x - 3.991).min(4.109 - p.x).min(p.y + 3.009).min(-0.991 - p.y)));
    }
    Ok(Verdict::of(most, 0.05, &sim.solution()))
}

fn rubble(model: Model) -> Result<Verdict, SolveError> {
    let scene = cable_core::scene::catalog::rubble_drop();
    let Shape::Terrain { points_m } = scene.obstacles[0].shape.clone() else { panic!("no ground") };
    let ground = move |p: Vec2| {
        let k = points_m.partition_point(|q| q[0] <= p.x).clamp(1, points_m.len() - 1);
        let (a, b) = (points_m[k - 1], points_m[k]);
        a[1] + (b[1] - a[1]) * (p.x - a[0]) / (b[0] - a[0]) - p.y
    };
    let mut sim = simulation(scene, model)?;
    let mut most = 0.0f64;
    for _ in 0..120 {
        sim.step(1.0 / 60.0)?;
        // The centre line may come to the ground itself where a node lies between two stones, not
        // below.
        most = most.max(deepest(&sim, &ground));
    }
    Ok(Verdict::of(most, 0.05, &sim.solution()))
}

/// A tail drawn over a floor by a support whose motion is given in knots of 1/60 s.
fn knots(model: Model) -> Result<Verdict, SolveError> {
    let times_s: Vec<f64> = (0..=120).map(|k| f64::from(k) / 60.0).collect();
    let points_m = times_s.iter().map(|t| [5.0 + t, ON_FLOOR]).collect();
    let hitch = Support { motion: Some(Motion { times_s, points_m }), ..Support::fixed("hitch", [5.0, ON_FLOOR]) };
    let scene = on_a_floor(2e4, vec![Support::free("tail"), hitch]);
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    let mut sum = 0.0;
    for k in 0..114 {
        sim.step(1.0 / 60.0)?;
        if k >= 54 {
            sum += -sim.solution().cables[0].supports[1].reaction_x_n / 60.0;
        }
    }
    Ok(Verdict::of((sum / (0.5 * 5.0 * G) - 1.0).abs(), 2e-2, &sim.solution()))
}

fn no_step(model: Model) -> Result<Verdict, SolveError> {
    let scene = cable([10.0, 1.0, 1e6], vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [9.0, 0.0])]);
    let mut sim = simulation(scene, model)?;
    sim.settle()?;
    let before = sim.states();
    let mut last = None;
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        last = sim.step(dt).err();
        if last.is_none() || sim.states() != before {
            return Ok(Verdict::Wrong(dt));
        }
    }
    last.map_or(Ok(Verdict::Wrong(0.0)), Err)
}
