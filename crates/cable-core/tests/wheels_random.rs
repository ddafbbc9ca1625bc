//! These tests move cables slowly to and fro over wheels that rub: the friction of `fem` beside
//! that of `spans`, which has no mesh.
//!
//! One to four pulleys, most of them wheels, friction 0 to 1, EA 3e3 to 1e8 N, ends held or drawn
//! by a dead load, supports and loads that go and come back, taut to a tenth longer than the taut
//! way. `WHEELS_CASES=300 cargo test --locked -p cable-core --test wheels_random -- --nocapture`
//! prints what came of more of them; `WHEELS_FIRST` says from which, `WHEELS_SHOW=1` writes the
//! scenes that differ.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use cable_core::scene::{Motion, PulleySide, Scene, Support, SupportKind, catalog};
use cable_core::solution::CableSolution;
use cable_core::{Load, Model, Simulation};

use self::dice::Dice;

fn number(name: &str, other: u64) -> u64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(other)
}

const CABLE_DIAMETER: f64 = 0.002;
/// Times at which answers are compared, s, and the longest step asked of the models between them.
const LOOKS: [f64; 8] = [0.0, 0.4, 0.8, 1.2, 1.5, 2.0, 2.5, 3.0];

/// A corner of the way: centre, radius of the centre line, +1 where it is passed clockwise.
#[derive(Clone, Copy)]
struct Corner {
    at: [f64; 2],
    radius: f64,
    facing: f64,
}

/// Direction and length of the straight way that touches both.
fn tangent(a: Corner, b: Corner) -> (f64, f64) {
    let d = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
    let apart = d[0].hypot(d[1]);
    let aside = (b.facing * b.radius - a.facing * a.radius) / apart;
    (d[1].atan2(d[0]) + aside.clamp(-1.0, 1.0).asin(), apart * (1.0 - aside * aside).max(0.0).sqrt())
}

/// The taut way through corners: its length, and points along it.
fn taut(corners: &[Corner]) -> (f64, Vec<[f64; 2]>) {
    let (mut length, mut route) = (0.0, vec![corners[0].at]);
    let ways: Vec<(f64, f64)> = corners.windows(2).map(|w| tangent(w[0], w[1])).collect();
    length += ways.iter().map(|w| w.1).sum::<f64>();
    for (k, w) in ways.windows(2).enumerate() {
        let c = corners[k + 1];
        let turn = (c.facing * (w[0].0 - w[1].0)).max(0.0);
        length += c.radius * turn;
        for i in 0..=4 {
            let angle = w[0].0 - c.facing * turn * f64::from(i) / 4.0;
            let out = [-angle.sin() * c.facing, angle.cos() * c.facing];
            route.push([c.at[0] + out[0] * c.radius, c.at[1] + out[1] * c.radius]);
            if c.radius == 0.0 {
                break;
            }
        }
    }
    route.push(corners[corners.len() - 1].at);
    (length, route)
}

/// There, back, and perhaps there again.
fn motion(dice: &mut Dice, at: [f64; 2], size: f64) -> Motion {
    let angle = dice.within(0.0, std::f64::consts::TAU);
    let way = |f: f64| [at[0] + f * size * f64::cos(angle), at[1] + f * size * f64::sin(angle)];
    let (back, again) = (dice.within(-0.5, 0.9), dice.within(0.0, 1.2));
    match (dice.unit() * 3.0) as usize {
        0 => Motion { times_s: vec![0.0, 0.1, 1.1], points_m: vec![at, at, way(1.0)] },
        1 => Motion { times_s: vec![0.0, 1.0, 2.0], points_m: vec![at, way(1.0), way(back)] },
        _ => Motion { times_s: vec![0.0, 0.9, 1.8, 2.7], points_m: vec![at, way(1.0), way(back), way(again)] },
    }
}

fn scene(case: u64) -> Scene {
    let mut dice = Dice(0x0003_e100 + 7919 * case);
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 9.80665;
    scene.environment.temperature_change_k = 0.0;
    scene.loads.clear();
    let count = 1 + (dice.unit() * 4.0) as usize;
    let mut corners = vec![Corner { at: [0.0, 0.0], radius: 0.0, facing: 1.0 }];
    let (mut x, mut y) = (0.0, 0.0);
    let mut up = dice.chance(0.7);
    for _ in 0..count {
        x += dice.log(1.0, 6.0);
        y += dice.within(0.4, 2.0) * if up { 1.0 } else { -1.0 };
        let radius = if dice.chance(0.2) { 0.0 } else { dice.log(0.02, 0.5) + 0.5 * CABLE_DIAMETER };
        corners.push(Corner { at: [x, y], radius, facing: if up { 1.0 } else { -1.0 } });
        up = !up;
    }
    x += dice.log(1.0, 6.0);
    y += dice.within(0.4, 2.0) * if up { 1.0 } else { -1.0 };
    corners.push(Corner { at: [x, y], radius: 0.0, facing: 1.0 });
    let (length, route) = taut(&corners);
    let density = dice.log(0.05, 2.0);
    let ea = dice.log(3e3, 1e8);
    let drawn = dice.chance(0.4);
    let slack = if drawn || dice.chance(0.4) { -dice.log(1e-5, 3e-3) } else { dice.log(1e-4, 0.1) };
    let weight = density * 9.80665 * length;
    let c = &mut scene.cables[0];
    c.length_m = length * (1.0 + slack);
    (c.linear_density_kg_per_m, c.axial_stiffness_n) = (density, ea);
    (c.bending_stiffness_n_m2, c.thermal_expansion_per_k) = (0.0, 0.0);
    (c.service_tension_n, c.breaking_tension_n, c.segments) = (1e15, 1e15, None);
    (c.diameter_m, c.friction) = (CABLE_DIAMETER, 0.3);
    let name = c.name.clone();
    let last = corners.len() - 1;
    c.supports = corners
        .iter()
        .enumerate()
        .map(|(k, corner)| match k {
            0 if drawn => {
                let to = corners[1].at;
                let angle = f64::atan2(-to[1], -to[0]) + dice.within(-0.1, 0.1);
                let force = dice.within(0.5, 5.0) * weight;
                let force_n = [force * angle.cos(), force * angle.sin()];
                let mut end = Support::new("A", SupportKind::Load);
                if dice.chance(0.3) {
                    let f = dice.within(0.6, 1.6);
                    (end.times_s, end.forces_n) = (vec![0.0, 1.0, 2.0], vec![force_n, force_n.map(|v| v * f), force_n]);
                } else {
                    end.force_n = Some(force_n);
                }
                end
            }
            k if k == 0 || k == last => Support::fixed(if k == 0 { "A" } else { "B" }, corner.at),
            k => {
                let mut wheel = Support::new(format!("o{k}"), SupportKind::Pulley);
                wheel.at_m = Some(corner.at);
                wheel.radius_m = Some((corner.radius - 0.5 * CABLE_DIAMETER).max(0.0));
                wheel.side = Some(if corner.facing > 0.0 { PulleySide::Over } else { PulleySide::Under });
                wheel.friction = Some(if dice.chance(0.15) { 0.0 } else { dice.within(0.02, 1.0) });
                wheel
            }
        })
        .collect();
    c.route_m = if dice.chance(0.7) { route } else { Vec::new() };
    let size = dice.log(1e-4, 0.05) * length;
    c.supports[last].motion = Some(motion(&mut dice, corners[last].at, size));
    if dice.chance(0.3) {
        let k = 1 + (dice.unit() * count as f64) as usize;
        c.supports[k].motion = Some(motion(&mut dice, corners[k].at, 0.3 * size));
    }
    if dice.chance(0.3) {
        let arc_length_m = c.length_m * (1.0 - 0.3 / (count as f64 + 1.0) * dice.within(0.5, 1.5));
        let force = [0.0, -dice.within(0.05, 0.5) * weight];
        let (times_s, forces_n) = (vec![0.0, 1.2, 2.4], vec![[0.0, 0.0], force, [0.0, 0.0]]);
        scene.loads.push(Load { cable: name, arc_length_m, force_n: None, times_s, forces_n });
    }
    scene
}

/// Answers at all looks, as far as there are any, and why there are no more.
fn history(scene: &Scene, model: Model) -> (Vec<CableSolution>, Option<String>) {
    let mut out = Vec::new();
    let mut sim = match Simulation::new(scene.clone(), model) {
        Ok(sim) => sim,
        Err(e) => return (out, Some(e.to_string())),
    };
    let mut before = 0.0;
    for at in LOOKS {
        let parts = number("WHEELS_PARTS", 1);
        let mut go = || (0..parts).try_for_each(|_| sim.step_quasi_static((at - before) / parts as f64));
        let found = if at == 0.0 { sim.settle().map(|_| ()) } else { go() };
        before = at;
        match found {
            Ok(()) => out.push(sim.solution().cables[0].clone()),
            Err(e) => return (out, Some(e.to_string())),
        }
    }
    (out, None)
}

/// Greatest difference of a force on a support, in parts of the greatest tension.
fn difference(found: &CableSolution, exact: &CableSolution) -> f64 {
    let most = exact.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max);
    let off = found
        .supports
        .iter()
        .zip(&exact.supports)
        .map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
    off.fold(0.0, f64::max) / most
}

/// The results of a campaign.
#[derive(Debug, Default)]
struct Came {
    compared: usize,
    /// Scene, time, difference, what it said.
    wrong: Vec<(u64, f64, f64, f64)>,
    refused: Vec<(u64, String)>,
    worst: f64,
    most_said: f64,
}

fn campaign(model: Model, first: u64, cases: u64) -> Came {
    let mut came = Came::default();
    for case in first..first + cases {
        let scene = scene(case);
        let (exact, ended) = history(&scene, Model::Spans);
        let (found, why) = history(&scene, model);
        if found.len() < exact.len() {
            came.refused.push((case, format!("{} of {}: {}", found.len(), exact.len(), why.unwrap_or_default())));
        }
        if exact.is_empty() {
            println!("{case}: no answer of spans: {}", ended.unwrap_or_default());
            continue;
        }
        came.compared += 1;
        let mut bad = None;
        for ((a, b), at) in found.iter().zip(&exact).zip(LOOKS) {
            let (off, said) = (difference(a, b), a.error_estimate.unwrap_or(f64::NAN));
            came.worst = came.worst.max(off);
            came.most_said = came.most_said.max(said);
            if !(off <= said) && bad.is_none() {
                bad = Some((case, at, off, said));
            }
        }
        if let Some(bad) = bad {
            came.wrong.push(bad);
            if std::env::var("WHEELS_SHOW").is_ok() {
                std::fs::write(std::env::temp_dir().join(format!("wheels_{model}_{case}.toml")), scene.to_toml())
                    .unwrap();
            }
        }
    }
    println!(
        "{model}: {} compared, worst {:.1e}, said up to {:.1e}; {} not within what it says, {} refused",
        came.compared,
        came.worst,
        came.most_said,
        came.wrong.len(),
        came.refused.len()
    );
    came.wrong.iter().for_each(|(case, at, off, said)| println!("  {case} at {at} s: {off:.2e}, says {said:.1e}"));
    came.refused.iter().for_each(|(case, why)| println!("  {case} refused: {why}"));
    came
}

#[test]
fn fem_is_within_what_it_says_of_spans() {
    let came = campaign(Model::Fem, number("WHEELS_FIRST", 0), number("WHEELS_CASES", 35));
    assert!(came.wrong.is_empty(), "{:?}", came.wrong);
    assert!(came.refused.len() * 50 <= came.compared, "{:?}", came.refused);
}

/// The same for many more scenes:
/// `cargo test --locked -p cable-core --test wheels_random -- --ignored --nocapture`. What remains
/// (5 of 285: four by 1.3e-7 at most, one by 1.4e-2 for a cause that was not found) is less than 2
/// %.
#[test]
#[ignore = "300 histories, some seconds"]
fn fem_is_within_what_it_says_of_spans_in_300_scenes() {
    let came = campaign(Model::Fem, 1000, 300);
    assert!(came.wrong.len() * 50 <= came.compared, "{:?}", came.wrong);
    assert!(came.refused.len() * 50 <= came.compared, "{:?}", came.refused);
}

/// A cable with a dead load on one end goes over a wheel that rubs and is drawn at the other, with
/// looks every 1/60 s: where the cable meets the wheel wandered, that was taken for sliding, and
/// friction came out the other way round in every other step (29.0 N at B).
#[test]
fn friction_of_a_wheel_stays_on_its_side() {
    let mut scene = catalog::hanging_span();
    scene.environment.temperature_change_k = 0.0;
    scene.loads.clear();
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m) = (4.5604174137050695, 0.3762420449247834);
    (c.axial_stiffness_n, c.bending_stiffness_n_m2) = (525_053.841_295_094_2, 0.0);
    (c.diameter_m, c.thermal_expansion_per_k, c.segments) = (CABLE_DIAMETER, 0.0, None);
    (c.service_tension_n, c.breaking_tension_n) = (1e15, 1e15);
    c.route_m.clear();
    let mut load = Support::new("A", SupportKind::Load);
    load.force_n = Some([-42.798_397_531_889_65, 13.837_628_129_883_733]);
    let mut wheel = Support::new("o0", SupportKind::Pulley);
    wheel.at_m = Some([3.0713385901373744, -1.3063035944685173]);
    (wheel.radius_m, wheel.friction) = (Some(0.7294691177953251), Some(0.9611657543789922));
    let mut hand = Support::fixed("B", [4.174107003751589, -0.9462101876301872]);
    let at = hand.at_m.unwrap();
    hand.motion = Some(Motion {
        times_s: vec![0.0, 0.1, 1.1],
        points_m: vec![at, at, [4.419_890_996_563_62, -1.0281653206841306]],
    });
    c.supports = vec![load, wheel, hand];
    let [mut fem, mut spans] = [Model::Fem, Model::Spans].map(|m| Simulation::new(scene.clone(), m).unwrap());
    fem.settle().unwrap();
    spans.settle().unwrap();
    for _ in 0..72 {
        fem.step_quasi_static(1.0 / 60.0).unwrap();
        spans.step_quasi_static(1.0 / 60.0).unwrap();
        let (found, exact) = (fem.solution().cables[0].clone(), spans.solution().cables[0].clone());
        let (off, said) = (difference(&found, &exact), found.error_estimate.unwrap());
        assert!(off <= said && said < 1e-3, "{off:.1e} {said:.1e}");
    }
}
