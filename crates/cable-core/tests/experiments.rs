//! These tests compare the models with measurements on real chains, ropes and cords: the table is
//! docs/experiments.md.
//!
//! `cargo test --locked -p cable-core --test experiments -- --nocapture` prints it. Where a
//! coefficient is not known it is found from one part of a record and asked of the other. How far
//! off we are is held, both ways.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::f64::consts::{FRAC_PI_4, PI};

use cable_core::model::Stepping;
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::{Model, Settings, Simulation};

const G: f64 = cable_core::scene::STANDARD_GRAVITY;

/// The scene at rest; its steps are those asked for.
fn settled(scene: &Scene, model: Model) -> Simulation {
    let settings = Settings { tolerance: 1e9, stepping: Stepping::Explicit, ..Settings::default() };
    let mut sim = Simulation::with_settings(scene.clone(), model, settings).unwrap();
    sim.settle().unwrap();
    sim
}

/// The force on a support of the only cable, N.
fn force_on(sim: &Simulation, support: usize) -> f64 {
    let s = &sim.solution().cables[0].supports[support];
    s.reaction_x_n.hypot(s.reaction_y_n)
}

/// The time when the end of the folded chain is let go, s.
const LET_GO: f64 = 0.01;

/// A chain of 1 m and 1 kg hung by both ends, a link apart, one of which is let go.
fn folded_chain(links: usize) -> Scene {
    let end = Support { release_s: Some(LET_GO), ..Support::fixed("let go", [1.0 / links as f64, 0.0]) };
    let mut scene = catalog::cable_alone([1.0, 1.0, 1e5], vec![Support::fixed("hook", [0.0, 0.0]), end]);
    scene.cables[0].segments = Some(links);
    scene
}

/// Damping ratio of a rope or chain whose loss is not known: `fem` has none; `mass-spring`, whose
/// waves nothing else damps, has a little.
fn loss(model: Model) -> f64 {
    if model == Model::MassSpring { 0.02 } else { 0.0 }
}

/// Returns how far the end has fallen (m) and the pull on the hook (in weights of the chain) after
/// each step `h` (s).
fn fall(links: usize, model: Model, h: f64) -> Vec<[f64; 2]> {
    let mut scene = folded_chain(links);
    scene.cables[0].damping_ratio = loss(model);
    let mut sim = settled(&scene, model);
    while sim.time_s() < LET_GO - 0.5 * h {
        sim.step(h).unwrap();
    }
    let after = |sim: &mut Simulation| {
        sim.step(h).unwrap();
        [-sim.states()[0].position_m[links].y, -sim.solution().cables[0].supports[0].reaction_y_n / G]
    };
    (0..(0.44 / h).round() as usize).map(|_| after(&mut sim)).collect()
}

/// The mean pull over some steps, weights.
fn mean(steps: &[[f64; 2]]) -> f64 {
    steps.iter().map(|[_, pull]| pull).sum::<f64>() / steps.len() as f64
}

/// Depths (in lengths of the chain) between which the pull is averaged.
const DEPTHS: [f64; 5] = [0.3, 0.5, 0.7, 0.8, 0.9];

/// The mean pull (weights) from one depth to another as energy kept says: v² = g y (2L − y)/(L −
/// y), T = ½(L + y)ρg + ¼ρv².
fn energy_kept(from: f64, to: f64) -> f64 {
    let (n, start) = (2000, from.sqrt());
    let h = (to.sqrt() - start) / f64::from(n);
    let [mut time, mut impulse] = [0.0; 2];
    for k in 0..n {
        let y = (start + h * (f64::from(k) + 0.5)).powi(2);
        let dt = h * 2.0 * ((1.0 - y) / (G * (2.0 - y))).sqrt();
        time += dt;
        impulse += dt * (0.5 * (1.0 + y) + 0.25 * y * (2.0 - y) / (1.0 - y));
    }
    impulse / time
}

/// Calkin and March let a chain, folded and hung by its ends side by side, fall from one of them,
/// and measured the pull on the other: it grew with the depth of the end as energy kept says (as in
/// [`energy_kept`]), to about 25 weights, where an end that falls as a stone would give 2.
///
/// M. G. Calkin, R. H. March, "The dynamics of a falling chain: I", Am. J. Phys. 57, 154,
/// 1989, **as told** by D. Cline, "Variational Principles in Classical Mechanics", the section on
/// variable mass (the paper itself was not at hand: its figures, the length and number of the
/// links, the errors and how fast the gauge was are not known here; 81 links is from memory,
/// unconfirmed). That energy is kept whatever the chain was found again by C. A. de Sousa, P. M.
/// Gordo, P. Costa, "Falling chains as variable mass systems", arXiv:1110.6035, 2012 (abstract).
///
/// Left out: the width and play of links, bending, air, the spring of hook and gauge. Our bars bear
/// no push: the leg that falls rattles, and the pull at an instant says nothing (0.1 to 2.6 weights
/// at 0.3 of the length). So impulses are compared: mean pulls from depth to depth. No error is
/// known of the authors, so ours is held to what we found: with 321 bars, on two steps, and 161
/// springs, off by up to 2 % to 0.7 of the length, 6.1 % to 0.8, 8.4 % to 0.9, nearly always to the
/// low side, and less than with 81 links. It is what a fold as wide as a link costs (see
/// `dynamics/folded_chain.rs`).
#[test]
fn a_folded_chain_pulls_with_its_depth_as_measured() {
    let off = |links, model, h| {
        let record = fall(links, model, h);
        let at = DEPTHS.map(|depth| record.iter().position(|[y, _]| *y >= depth).unwrap());
        let offs = [0, 1, 2, 3].map(|k| {
            let pull = mean(&record[at[k]..at[k + 1]]);
            pull / energy_kept(DEPTHS[k], DEPTHS[k + 1]) - 1.0
        });
        println!("{links} links, {model:?} at {h:.1e} s: mean pulls off by {offs:.3?}");
        // From 0.8 on the end has left the stone behind: that would pull with less than 1.85
        // weights.
        assert!(mean(&record[at[3]..at[4]]) > if links < 100 { 1.85 } else { 2.2 }, "{links} links fall as a stone");
        offs
    };
    let coarse = off(81, Model::Fem, 2.5e-4);
    for (links, model, h) in [(321, Model::Fem, 2.5e-4), (321, Model::Fem, 1.25e-4), (161, Model::MassSpring, 2.5e-4)] {
        let fine = off(links, model, h);
        for (k, most) in [0.02, 0.02, 0.07, 0.11].into_iter().enumerate() {
            assert!(fine[k].abs() < most, "{model:?}, from {}: off by {}", DEPTHS[k], fine[k]);
        }
        assert!(fine[3].abs() < coarse[3].abs(), "more links, further off: {} and {}", fine[3], coarse[3]);
    }
}

/// The same chain's greatest pull, measured: about 25 weights. At an instant we have none: 1-ms
/// means are 60, 71 and 65 weights with 41, 81 and 161 links, as energy that ends in ever less
/// chain must give. Over 5 ms (of a fall of 0.39 s) they are 27, 27 and 21, ten times what a stone
/// gives. Over 10 ms they are 14 to 17. Over which time Calkin and March measured is not known
/// here, and 5 ms was picked after all four were seen: no agreement is claimed, 20 to 30 weights
/// holds us where we are.
#[test]
fn a_folded_chain_cracks_with_some_twenty_five_weights() {
    let h = 1.25e-4;
    for (links, model) in
        [(41, Model::Fem), (81, Model::Fem), (161, Model::Fem), (41, Model::MassSpring), (81, Model::MassSpring)]
    {
        let record = fall(links, model, h);
        let most = |ms: f64| record.windows((ms * 1e-3 / h).round() as usize).map(mean).fold(0.0, f64::max);
        let means = [1.0, 2.0, 5.0, 10.0].map(most);
        println!("{links} links, {model:?}: greatest pull over 1, 2, 5, 10 ms {means:.1?} weights");
        assert!((20.0..30.0).contains(&means[2]), "{links} links, {model:?}: {means:?}");
    }
}

/// The pull (N) measured to draw a cord over a rod, wound by eighths of a turn: none to two turns.
const PULLS: [f64; 17] =
    [5.40, 6.18, 7.06, 8.04, 8.83, 10.69, 12.65, 13.24, 16.19, 17.17, 18.25, 21.68, 22.96, 25.70, 31.10, 35.51, 43.16];

/// A cord of no weight wound by an angle (rad) over a rod, a weight on one end, a hand on the other
/// that draws it on.
fn wound(angle: f64, friction: f64, segments: usize) -> Scene {
    let (radius, free, cord) = (0.1, 0.3, 0.001);
    let on = |back: f64| [(radius + cord) * (PI - back).cos(), (radius + cord) * (PI - back).sin()];
    let beyond = |by: f64| {
        let [x, y] = on(angle);
        [x + by * (PI - angle).sin(), y - by * (PI - angle).cos()]
    };
    let weight = Support { force_n: Some([0.0, -PULLS[0]]), ..Support::new("weight", SupportKind::Load) };
    let motion = Motion { times_s: vec![0.0, 2.0], points_m: vec![beyond(free), beyond(free + 0.05)] };
    let hand = Support { motion: Some(motion), ..Support::fixed("hand", beyond(free)) };
    let length = 2.0 * free + (radius + cord) * angle;
    let mut scene = catalog::cable_alone([length, 1e-5, 1e4], vec![weight, hand]);
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: radius };
    scene.obstacles = vec![Obstacle { name: "rod".into(), shape, friction: Some(friction) }];
    let cable = &mut scene.cables[0];
    (cable.diameter_m, cable.segments) = (2.0 * cord, Some(segments));
    let round = (0..=24).map(|k| on(angle * f64::from(k) / 24.0));
    cable.route_m = std::iter::once([-radius - cord, -free]).chain(round).chain([beyond(free)]).collect();
    scene
}

/// The pull (N) with which it is drawn half way through its motion.
fn drawn(angle: f64, friction: f64, segments: usize) -> f64 {
    let mut sim = settled(&wound(angle, friction, segments), Model::Fem);
    for _ in 0..50 {
        sim.step(0.02).unwrap();
    }
    force_on(&sim, 1)
}

/// A student's record of a cord drawn slowly over a rod at 17 angles, each the mean of three trials
/// (kinetic friction, "Data Table 2"): a worked question, "Data Table 1: Coefficient of Static
/// Friction" (…/questions-and-answers/…/ce32c4ea-5755-4e24-8d0a-0ad733fc6c0f, the form of an
/// address of bartleby.com), no date, no author. The page was read as text, in which some cells are
/// garbled; the pulls in newtons are used, which agree with the means of the trials. Nothing is
/// told of cord and rod.
///
/// The first turn gives the friction, 0.171 (least squares of ln T against the angle); the second
/// is then ours to foretell. Trials scatter by up to 6 % about their mean (270°: 1.21, 1.32, 1.35
/// kg): that is the tolerance of the first turn. In the second we pull by 5 to 21 % too hard: both
/// turns together give 0.161, and e^(4π·0.010) is 14 %, with the scatter 21 %. One Coulomb
/// coefficient, all that the model knows, does not hold better for this cord. Left out: the cord's
/// weight and stiffness, how its friction falls with pressure and speed, turns that lie on each
/// other.
#[test]
fn a_second_turn_rubs_by_what_the_first_tells() {
    let rise = |k: usize| (PULLS[k] / PULLS[0]).ln();
    let [up, down] = (1..=8).fold([0.0; 2], |[a, b], k| [a + k as f64 * rise(k), b + (k * k) as f64]);
    let friction = up / down / FRAC_PI_4;
    for (k, most) in [(1, 0.06), (4, 0.06), (6, 0.06), (8, 0.06), (10, 0.21), (13, 0.21), (16, 0.21)] {
        let angle = k as f64 * FRAC_PI_4;
        let ours = drawn(angle, friction, 60);
        let off = ours / PULLS[k] - 1.0;
        println!("{} degrees: {ours:.3} N, measured {:.2}, off by {off:.3}", 45 * k, PULLS[k]);
        assert!(off.abs() < most, "{} degrees: {ours} N, measured {}", 45 * k, PULLS[k]);
        assert!(k <= 8 || off > 0.05, "{} degrees: {ours} N, where the record falls behind one coefficient", 45 * k);
        if k == 8 {
            let fine = drawn(angle, friction, 120);
            assert!((ours / fine - 1.0).abs() < 1e-4, "the mesh decides: {ours} and {fine} N");
        }
    }
}

/// The fall of the standard for climbing ropes, without its edge: a mass held 2 m above the anchor
/// falls past it by 4.6 m on 2.6 m of rope (factor 1.77). The greatest pull on the anchor, N, of
/// the mass held so far aside, m.
fn caught([mass, strands, stiffness]: [f64; 3], aside: f64, (segments, h): (usize, f64), model: Model) -> f64 {
    let (length, tail) = (2.6, 2e-3);
    let weight = Support {
        mass_kg: Some(mass),
        force_n: Some([0.0, 0.0]),
        arc_length_m: Some(length),
        ..Support::new("mass", SupportKind::Load)
    };
    let hold = Support { release_s: Some(0.02), ..Support::fixed("hold", [0.05 + aside, 2.0]) };
    let rope = [length + tail, 0.053 * strands, stiffness * strands];
    let mut scene = catalog::cable_alone(rope, vec![Support::fixed("anchor", [0.0, 0.0]), weight, hold]);
    scene.cables[0].segments = Some(segments);
    scene.cables[0].damping_ratio = loss(model);
    let mut sim = settled(&scene, model);
    let mut most = 0.0;
    for _ in 0..(1.4 / h).round() as usize {
        sim.step(h).unwrap();
        let pull = force_on(&sim, 0);
        most = if pull > most { pull } else { most };
    }
    most
}

/// The mean of twelve starts that are tens of nanometres apart: the slack rope whips beside the
/// mass, and what of that is left in the pull differs by 0.1 to 0.2 % (standard deviation) from
/// start to start, on every mesh.
fn caught_on_average(given: [f64; 3], way: (usize, f64)) -> f64 {
    let starts = 12;
    (0..starts).map(|k| caught(given, f64::from(k) * 3e-8, way, Model::Fem)).sum::<f64>() / f64::from(starts)
}

/// One rope, three tests: the Beal Joker, 9.1 mm and 53 g/m, was caught with 8.2 kN as a single
/// rope (80 kg), 6.0 kN as a half rope (55 kg), 9.5 kN as twin rope (80 kg on two strands), all
/// falls of factor 1.77.
///
/// Sources: the maker's figures as given in "Corda: BEAL Joker", rampachetipassa.blogspot.com,
/// 2018, the first also in "Beal Sport Ropes", ukclimbing.com; the masses and the factor of EN 892,
/// and that the greatest of three samples is declared, in "Dynamic ropes",
/// argawana-triarga.blogspot.com, 2009; fall and length (2 · 2.3 m on 2.6 m) in "Fall factor",
/// Wikipedia.
///
/// The first gives the stiffness, EA = 19.6 kN (as `dynamics/dropped_mass.rs` has it), the others
/// are then ours to foretell: 11 % too hard with less mass, 18 % with two strands. Left out: what
/// the rope loses (nylon takes up much of the fall), that it is not linear, the knot, the slip of
/// 0.3 m over the edge, air. Tolerances: declared to 0.1 kN, half of that is 0.6 % of 8.2 and 0.8 %
/// of 6.0 kN, together 1.5 %. `mass-spring` keeps the rope's own waves, and has a loss of two
/// hundredths: 2.8 to 3.9 % more than `fem` with 52 springs (without it 14 %). Steps of 1 and 2 ms
/// take them in `fem`, as nylon does; of 0.5 ms they leave some, 1 to 2 % of the pull.
#[test]
fn a_climbing_rope_catches_a_mass() {
    let (weight, factor) = (80.0 * G, 4.6 / 2.6);
    let stiffness = ((8200.0 / weight - 1.0f64).powi(2) - 1.0) * weight / (2.0 * factor);
    for (mass, strands, declared, due) in
        [(80.0, 1.0, 8200.0, 0.0), (55.0, 1.0, 6000.0, 0.113), (80.0, 2.0, 9500.0, 0.184)]
    {
        let given = [mass, strands, stiffness];
        let ours = caught_on_average(given, (52, 1e-3));
        let others = [(26, 1e-3), (52, 2e-3)].map(|way| caught_on_average(given, way));
        let springs = caught(given, 0.0, (52, 5e-4), Model::MassSpring);
        let off = ours / declared - 1.0;
        println!(
            "{mass} kg on {strands}: {ours:.0} N, declared {declared}, off by {off:.3}; {others:.0?}, springs {springs:.0} N"
        );
        assert!(others.iter().all(|o| (o / ours - 1.0).abs() < 5e-3), "mesh or step decide: {ours} and {others:?} N");
        assert!((off - due).abs() < 0.015, "{mass} kg on {strands}: off by {off}, not {due}");
        assert!((springs / ours - 1.0).abs() < 0.09, "mass-spring: {springs} N beside {ours} N");
    }
}
