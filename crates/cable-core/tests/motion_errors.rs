//! These tests compare the errors that a run in motion states with the same run on four times as
//! many elements in a quarter of its steps: random swings, drags over rough ground, drops,
//! slackenings, throws beside a post, and cables let go at an end.
//!
//! All: `cargo test --locked -p cable-core --test motion_errors -- --ignored --nocapture`;
//! `FROM=60 TO=80` takes others of each family, `MODEL=mass-spring` another model. Of each figure
//! (greatest tension, supports, contacts, shape) it prints how many were said, the share that what
//! was said covers, and the share that is between half and ten times the error. Ranges of the
//! greatest tension should leave open for a tenth of the runs at most whether a cable of usual
//! strength breaks.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use std::collections::VecDeque;

use cable_core::model::Inertia;
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, catalog};
use cable_core::timeline::{Instant, Timeline};
use cable_core::{ErrorEstimates, Model, Settings, Simulation};

use self::dice::Dice;

const FAMILIES: [&str; 6] = ["swung", "dragged", "dropped", "slackened", "thrown", "let go"];

fn scene(family: usize, number: u64) -> Scene {
    let mut dice = Dice(number.wrapping_mul(0x2000_0003) + 11 + family as u64);
    let mut scene = catalog::hanging_span();
    let rough = if family == 0 { 0.0 } else { dice.within(0.0, 0.4) };
    let points_m = (0..=80).map(|k| [-20.0 + 0.5 * f64::from(k), dice.within(-rough, rough)]).collect();
    let ground = Obstacle {
        name: "ground".to_owned(),
        shape: Shape::Terrain { points_m },
        friction: Some(dice.within(0.1, 0.9)),
    };
    scene.obstacles = if family == 0 { vec![] } else { vec![ground] };
    if family >= 4 {
        let at = [dice.within(-2.5, 2.5), dice.within(0.9, 1.5)];
        scene.obstacles.push(Obstacle {
            name: "post".to_owned(),
            shape: Shape::Circle { center_m: at, radius_m: dice.within(0.05, 0.3) },
            friction: Some(dice.within(0.0, 0.8)),
        });
    }
    let c = &mut scene.cables[0];
    c.axial_stiffness_n = 10f64.powf(dice.within(4.0, 7.0));
    c.linear_density_kg_per_m = dice.within(0.1, 2.0);
    c.segments = Some(dice.within(40.0, 100.0) as usize);
    (c.breaking_tension_n, c.service_tension_n) = (1e12, 1e12);
    let mut ends = [Support::fixed("left", [-4.0, 3.0]), Support::fixed("right", [4.0, 3.0])];
    c.length_m = dice.within(8.3, 12.0);
    let way = |dice: &mut Dice, knots: usize, quick: f64, low: f64, reach: f64| {
        let home = [4.0, 3.0];
        let mut points_m = vec![home];
        points_m.extend((1..knots).map(|_| [home[0] + dice.within(-reach, reach), dice.within(low, 4.0)]));
        Some(Motion { times_s: (0..knots).map(|k| quick * k as f64).collect(), points_m })
    };
    match family {
        0 => ends[1].motion = way(&mut dice, 4, 0.7, 2.0, 1.0),
        1 => {
            c.length_m = dice.within(9.5, 13.0);
            ends[1].at_m = Some([4.0, 1.0]);
            let speed = dice.within(0.2, 1.5);
            ends[1].motion =
                Some(Motion { times_s: vec![0.0, 2.0], points_m: vec![[4.0, 1.0], [4.0 + 2.0 * speed, 1.2]] });
            ends[0] = Support::fixed("left", [-4.0, 0.5]);
        }
        2 => {
            for end in &mut ends {
                end.release_s = Some(0.01);
            }
        }
        3 => {
            let speed = dice.within(0.3, 2.0);
            ends[1].motion =
                Some(Motion { times_s: vec![0.0, 1.5], points_m: vec![[4.0, 3.0], [4.0 - 1.5 * speed, 3.0]] });
        }
        4 => {
            let quick = dice.within(0.15, 0.6);
            ends[1].motion = way(&mut dice, 5, quick, 2.2, 1.5);
        }
        _ => ends[1].release_s = Some(dice.within(0.05, 0.3)),
    }
    c.supports = ends.into();
    scene
}

/// Counts of errors that were stated, that were large enough, and that were between half of and ten
/// times the true error.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    all: usize,
    covered: usize,
    apt: usize,
}

impl Tally {
    fn note(&mut self, said: Option<f64>, is: Option<f64>, least: f64) {
        let (Some(said), Some(is)) = (said, is) else { return };
        self.all += 1;
        self.covered += usize::from(said >= is || is <= least);
        self.apt += usize::from((0.5 * is <= said && said <= 10.0 * is) || (is <= least && said <= 10.0 * least));
    }

    fn tell(&self) -> String {
        let part = |n: usize| 100.0 * n as f64 / self.all.max(1) as f64;
        format!("{:4}: {:3.0} / {:3.0}", self.all, part(self.covered), part(self.apt))
    }
}

/// Greatest tension of a run, and whether its range holds that of the fine one.
#[derive(Debug, Default)]
struct Peaks {
    all: usize,
    inside: usize,
    /// Ends of a range that are more than 1.5 times each other.
    wide: usize,
    /// Of those that are not: whose range holds that of the fine one.
    narrow_inside: usize,
    above: usize,
    below: usize,
    /// Runs of which it would be open whether a cable of usual strength breaks.
    may_break: usize,
    /// Runs that call themselves resolved to a part of [`RESOLVED_TO`] of their greatest tension.
    resolved: [usize; 2],
    /// Of those: whose fine one differs by no more.
    resolved_rightly: [usize; 2],
}

/// Tolerances at which runs may be resolved.
const RESOLVED_TO: [f64; 2] = [1e-2, 1e-3];

/// Breaking tension for each kg/m of a weak power cable, N·m/kg (presets have 3e3 to 1e6).
const SPECIFIC_STRENGTH: f64 = 1e4;

const SECONDS: f64 = 2.0;
const LOOKS_PER_S: f64 = 50.0;
const STEP_S: f64 = 1.0 / 240.0;
/// The fine run has so many times as many elements and steps.
const FINE: usize = 4;

fn timeline(scene: &Scene, model: Model, times: usize) -> Option<Timeline> {
    let mut scene = scene.clone();
    let cable = &mut scene.cables[0];
    cable.segments = cable.segments.map(|n| n * times);
    let step_s = STEP_S / times as f64;
    let settings = Settings { inner_step_s: Some(step_s), ..Settings::default() };
    let mut sim = Simulation::with_settings(scene, model, settings).ok()?;
    sim.settle().ok()?;
    Timeline::new(sim, Inertia::Dynamic, Some(step_s)).ok()
}

fn larger(a: ErrorEstimates, b: &ErrorEstimates) -> ErrorEstimates {
    let larger = |a: Option<f64>, b: Option<f64>| a.map_or(b, |a| b.map_or(Some(a), |b| Some(a.max(b))));
    ErrorEstimates {
        max_tension_n: larger(a.max_tension_n, b.max_tension_n),
        support_force_n: larger(a.support_force_n, b.support_force_n),
        contact_force_n: larger(a.contact_force_n, b.contact_force_n),
        position_m: larger(a.position_m, b.position_m),
    }
}

/// Compares a run of a scene with a fine one; None where one of them stops.
fn compare(scene: &Scene, model: Model, tallies: &mut [Tally; 4], peaks: &mut Peaks) -> Option<()> {
    let mut run = timeline(scene, model, 1)?.with_errors();
    let mut fine = timeline(scene, model, FINE)?;
    // Two swings that part are equal wherever they cross: what an answer is off by is the most of a
    // tenth of a second.
    let mut lately: VecDeque<ErrorEstimates> = VecDeque::new();
    for look in 1..=(LOOKS_PER_S * SECONDS) as u64 {
        let instant = Instant::nearest(look as f64 / LOOKS_PER_S);
        let (answer, better) = (run.at(instant, |_| ()).ok()?, fine.at(instant, |_| ()).ok()?);
        let (answer, better) = (&answer.cables[0], &better.cables[0]);
        lately.push_back(ErrorEstimates::between(answer, better));
        lately.drain(..lately.len().saturating_sub(5));
        if look % 5 != 0 {
            continue;
        }
        let (said, is) = (answer.errors, lately.iter().fold(ErrorEstimates::default(), larger));
        // Differences that are too small to matter: a millionth of the weight, and of the length.
        let cable = &scene.cables[0];
        let (force, length) = (1e-6 * 9.81 * cable.linear_density_kg_per_m * cable.length_m, 1e-6 * cable.length_m);
        tallies[0].note(said.max_tension_n, is.max_tension_n, force);
        tallies[1].note(said.support_force_n, is.support_force_n, force);
        tallies[2].note(said.contact_force_n, is.contact_force_n, force);
        tallies[3].note(said.position_m, is.position_m, length);
    }
    let (peaks_of, which) = (&run.monitor().peaks()[0], std::env::var("HELD").is_ok());
    let ranges = peaks_of.ranges?;
    let [from, to] = if which { ranges.held_n } else { ranges.greatest_n };
    let better = fine.monitor().peaks()[0].peaks;
    let truth = if which { better.held.tension_n } else { better.greatest.tension_n };
    peaks.all += 1;
    peaks.below += usize::from(truth < from * (1.0 - 1e-9));
    peaks.above += usize::from(truth > to * (1.0 + 1e-9));
    let inside = (from * (1.0 - 1e-9)..=to * (1.0 + 1e-9)).contains(&truth);
    let wide = to > 1.5 * from;
    assert!(!wide || ranges.depend_on_small_differences(), "a range that is wide says why: {ranges:?}");
    peaks.inside += usize::from(inside);
    let (held, strength) = (ranges.held_n, SPECIFIC_STRENGTH * scene.cables[0].linear_density_kg_per_m);
    peaks.may_break += usize::from(held[0] < strength && strength <= held[1]);
    peaks.wide += usize::from(wide);
    peaks.narrow_inside += usize::from(inside && !wide);
    let own = peaks_of.peaks;
    let change = |a: f64, b: f64| (a - b).abs() / a;
    let changes = change(own.greatest.tension_n, better.greatest.tension_n)
        .max(change(own.held.tension_n, better.held.tension_n));
    for (k, tolerance) in RESOLVED_TO.into_iter().enumerate() {
        let resolved = ranges.are_resolved(tolerance);
        peaks.resolved[k] += usize::from(resolved);
        peaks.resolved_rightly[k] += usize::from(resolved && changes <= tolerance);
    }
    if std::env::var("TELL").is_ok() {
        println!("    {:.3} N, {from:.3} to {to:.3} N, fine {truth:.3} N", peaks_of.peaks.greatest.tension_n);
    }
    Some(())
}

fn number(name: &str, or: u64) -> u64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(or)
}

fn model() -> Model {
    std::env::var("MODEL").map_or(Model::Fem, |name| Model::from_name(&name).expect("a name of a model"))
}

fn campaign(model: Model, numbers: std::ops::Range<u64>) -> ([Tally; 4], Peaks) {
    let (mut all, mut peaks, mut stopped) = ([Tally::default(); 4], Peaks::default(), 0);
    for (family, name) in FAMILIES.iter().enumerate() {
        let (mut own, mut own_peaks) = ([Tally::default(); 4], Peaks::default());
        for k in numbers.clone() {
            let done = compare(&scene(family, k), model, &mut own, &mut own_peaks);
            if done.is_none() {
                println!("{name} {k} stops");
            }
            stopped += usize::from(done.is_none());
        }
        println!("{name:10} {} | {own_peaks:?}", own.map(|t| t.tell()).join(" | "));
        for (a, b) in all.iter_mut().zip(own) {
            (a.all, a.covered, a.apt) = (a.all + b.all, a.covered + b.covered, a.apt + b.apt);
        }
        (peaks.all, peaks.inside) = (peaks.all + own_peaks.all, peaks.inside + own_peaks.inside);
        (peaks.above, peaks.below) = (peaks.above + own_peaks.above, peaks.below + own_peaks.below);
        peaks.wide += own_peaks.wide;
        peaks.narrow_inside += own_peaks.narrow_inside;
        peaks.may_break += own_peaks.may_break;
        for k in 0..RESOLVED_TO.len() {
            peaks.resolved[k] += own_peaks.resolved[k];
            peaks.resolved_rightly[k] += own_peaks.resolved_rightly[k];
        }
    }
    println!("all        {} | {peaks:?}, {stopped} stopped", all.map(|t| t.tell()).join(" | "));
    (all, peaks)
}

#[test]
fn errors_of_twelve_motions_are_covered() {
    let (figures, peaks) = campaign(Model::Fem, 0..2);
    assert!(figures.iter().all(|t| t.covered * 100 >= t.all * 90), "{figures:?}");
    assert!(peaks.inside * 4 >= peaks.all * 3, "{peaks:?}");
}

#[test]
#[ignore = "minutes: 120 random motions, each on four times as many elements, too"]
fn errors_in_motion_are_covered() {
    let (figures, peaks) = campaign(model(), number("FROM", 0)..number("TO", 20));
    assert!(figures.iter().all(|t| t.covered * 100 >= t.all * 92), "{figures:?}");
    assert!(peaks.inside * 100 >= peaks.all * 90, "{peaks:?}");
    assert!(peaks.may_break * 10 <= peaks.all, "{peaks:?}");
}

/// Slackens a cable at no more than 2 m/s: the greatest tension with the step of the program, and
/// the one with a quarter of it, N.
fn slackened(number: u64) -> Option<[f64; 2]> {
    let greatest = |times: usize| {
        let step_s = STEP_S / times as f64;
        let settings = Settings { inner_step_s: Some(step_s), ..Settings::default() };
        let mut sim = Simulation::with_settings(scene(3, number), Model::Fem, settings).ok()?;
        sim.settle().ok()?;
        let mut run = Timeline::new(sim, Inertia::Dynamic, Some(step_s)).ok()?;
        run.at(Instant::nearest(SECONDS), |_| ()).ok()?;
        Some(run.monitor().peaks()[0].peaks.greatest.tension_n)
    };
    Some([greatest(1)?, greatest(4)?])
}

#[test]
fn a_cable_that_is_slackened_pulls_about_as_hard_as_with_a_quarter_of_the_step() {
    let first = number("FROM", 0);
    let mut worst = 0.0_f64;
    for k in first..number("TO", first + 12) {
        let [coarse, fine] = slackened(k).unwrap_or_else(|| panic!("{k} stops"));
        println!("{k}: {coarse:.3} N, with a quarter of the step {fine:.3} N, {:.4}", coarse / fine);
        worst = worst.max(coarse / fine);
    }
    // A cable falls on rough ground and strikes it by chance: of 20 scenes 3 pull 7 to 12 % harder,
    // 10 less.
    assert!(worst < 1.25, "{worst} times the tension with a quarter of the step");
}
