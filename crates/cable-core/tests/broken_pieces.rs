//! These tests break cables and let the pieces fall upon each other: with self-contact they meet,
//! as two parts of an unbroken cable do. Crossings are looked for by the signs of areas, without
//! code of the models.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod segments;

use cable_core::math::Vec2;
use cable_core::scene::{Motion, Scene, Support, catalog};
use cable_core::solution::CableSolution;
use cable_core::{Model, Settings, Simulation};
use segments::cross_properly;

/// Inner steps a second.
const RATE: f64 = 240.0;

/// A taut span from a middle support to an end that is drawn away until the cable breaks beside the
/// middle support; a slack span hangs below it, into which the end of the broken one falls.
fn span_over_span() -> Scene {
    let mut scene = catalog::hanging_span();
    let c = &mut scene.cables[0];
    c.self_contact = true;
    c.diameter_m = 0.02;
    c.axial_stiffness_n = 1e5;
    c.bending_stiffness_n_m2 = 0.0;
    (c.breaking_tension_n, c.service_tension_n) = (400.0, 300.0);
    c.breaking_time_s = 0.0;
    c.segments = Some(60);
    c.length_m = 5.735;
    let drawn = Motion { times_s: vec![0.0, 0.5], points_m: vec![[2.5, 2.6], [2.56, 2.6]] };
    c.supports = vec![
        Support::fixed("low", [2.5, 1.6]),
        Support { arc_length_m: Some(3.2), ..Support::fixed("middle", [0.0, 3.0]) },
        Support { motion: Some(drawn), ..Support::fixed("drawn", [2.5, 2.6]) },
    ];
    scene
}

/// The bars of a cable: the first node of each, and its ends.
fn bars(cable: &CableSolution) -> Vec<(usize, Vec2, Vec2)> {
    let at = |k: usize| Vec2::new(cable.nodes[k].x_m, cable.nodes[k].y_m);
    let joined = |k: &usize| !cable.breaks.contains(&(k + 1));
    (0..cable.nodes.len() - 1).filter(joined).map(|k| (k, at(k), at(k + 1))).collect()
}

/// Number of crossings of bars that are no neighbours.
fn crossings(cable: &CableSolution) -> usize {
    let bars = bars(cable);
    let meets = |(i, a, b): &(usize, Vec2, Vec2)| {
        bars.iter().filter(|(j, p, q)| *j > i + 1 && cross_properly(*a, *b, *p, *q)).count()
    };
    bars.iter().map(meets).sum()
}

/// Smallest distance of the surfaces of two pieces, of bars farther than `beside` (m) along the
/// cable, m.
fn gap_of_pieces(cable: &CableSolution, diameter: f64, beside: f64) -> f64 {
    let bars = bars(cable);
    let piece = |k: usize| cable.breaks.iter().filter(|b| **b <= k).count();
    let arc = |k: usize| cable.nodes[k].arc_length_m;
    let to_bar = |p: Vec2, a: Vec2, b: Vec2| {
        let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        (p - a - (b - a) * t).norm()
    };
    let mut least = f64::INFINITY;
    for &(i, a, b) in &bars {
        for &(j, p, q) in bars.iter().filter(|(j, ..)| *j > i && piece(*j) != piece(i) && arc(*j) - arc(i + 1) > beside)
        {
            assert!(j > i);
            let all = [to_bar(a, p, q), to_bar(b, p, q), to_bar(p, a, b), to_bar(q, a, b)];
            least = all.into_iter().fold(least, f64::min);
        }
    }
    least - diameter
}

/// What was seen in a run.
#[derive(Debug, Default)]
struct Seen {
    crossed: usize,
    least_m: f64,
    /// Instants at which two pieces were nearer to each other than a tenth of a diameter.
    touching: usize,
    breaks: usize,
    halved: usize,
    stopped: Option<String>,
    /// Greatest rise of the whole energy over a step after the last motion of a support, J.
    risen_j: f64,
    energy_j: f64,
}

fn run(scene: &Scene, model: Model, seconds: f64, still_from_s: f64) -> Seen {
    let mut sim = Simulation::with_settings(scene.clone(), model, Settings::default()).unwrap();
    sim.settle().unwrap();
    let mut seen = Seen { least_m: f64::INFINITY, ..Seen::default() };
    let (diameter, mut before) = (scene.cables[0].diameter_m, f64::NAN);
    for _ in 0..(seconds * RATE) as usize {
        if let Err(e) = sim.step(1.0 / RATE) {
            seen.stopped = Some(format!("{} s: {e}", sim.time_s()));
            break;
        }
        let answer = sim.solution();
        let cable = &answer.cables[0];
        seen.halved += answer.cost.halved_steps;
        if cable.breaks.len() > seen.breaks {
            before = f64::NAN;
        }
        seen.breaks = cable.breaks.len();
        seen.crossed += usize::from(crossings(cable) > 0);
        let gap = gap_of_pieces(cable, diameter, 6.0 * diameter);
        seen.least_m = seen.least_m.min(gap);
        seen.touching += usize::from(gap < 0.1 * diameter);
        let energy = answer.energy.total_j();
        if sim.time_s() > still_from_s && energy - before > seen.risen_j {
            seen.risen_j = energy - before;
        }
        (before, seen.energy_j) = (energy, energy);
    }
    println!("{seen:?}");
    seen
}

#[test]
fn a_broken_span_falls_upon_the_span_below_it() {
    for model in [Model::Fem, Model::Auto] {
        let seen = run(&span_over_span(), model, 3.0, 0.6);
        assert!(seen.breaks == 1 && seen.stopped.is_none(), "{seen:?}");
        assert!(seen.crossed == 0 && seen.least_m > 0.0 && seen.touching > 100, "{seen:?}");
    }
}
