//! What the tuned constants of `spans` move: each is halved and doubled over the scenes of the catalogue and random ones, and
//! compared with the answers by the constants as they are.
//!
//! `cargo run --release -p cable-benches --bin tuned-settings-spans` prints a table; `-- 50` takes so many random scenes, and
//! `-- 50 newton.max_turn drag` only settings whose name holds one of the words.

use std::error::Error;
use std::sync::Arc;

use cable_core::model::spans::SpansModel;
use cable_core::model::spans::settings::SpansSettings;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::{Problem, problems};
use cable_core::scene::{Shape, Support, SupportKind, catalog};
use cable_core::{Obstacle, Scene, Vec2};

/// Random scenes unless told otherwise.
const RANDOM_SCENES: u64 = 100;
/// Instants of a scene after its rest, and the time between them, s.
const INSTANTS: usize = 20;
const INTERVAL_S: f64 = 0.1;
/// A change of tension below this, relative, is rounding.
const SEEN: f64 = 1e-6;

/// A number that can be scaled.
trait Scale {
    fn scale(&mut self, factor: f64);
}

impl Scale for f64 {
    fn scale(&mut self, factor: f64) {
        *self *= factor;
    }
}

impl Scale for usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "small and positive"
    )]
    fn scale(&mut self, factor: f64) {
        *self = ((*self as f64 * factor).round() as Self).max(1);
    }
}

impl Scale for u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and positive")]
    fn scale(&mut self, factor: f64) {
        *self = ((f64::from(*self) * factor).round() as Self).max(1);
    }
}

/// Parts of a cone: what they leave of it is scaled.
impl Scale for [f64; 3] {
    fn scale(&mut self, factor: f64) {
        self.iter_mut().for_each(|part| *part = 1.0 - factor * (1.0 - *part));
    }
}

/// A setting: its name, and the function that scales it.
type Tuned = (&'static str, fn(&mut SpansSettings, f64));

macro_rules! tuned {
    ($($group:ident { $($field:ident $(. $inner:ident)?),+ $(,)? })+) => {
        vec![$($((
            concat!(stringify!($group), ".", stringify!($field) $(, ".", stringify!($inner))?),
            (|s: &mut SpansSettings, factor| s.$group.$field$(.$inner)?.scale(factor)) as fn(&mut SpansSettings, f64),
        )),+),+]
    };
}

fn tuned() -> Vec<Tuned> {
    tuned! {
        newton {
            max_iterations, max_stalled, max_halvings, residual, refined_residual_factor, stalled_residual_factor, max_turn,
            kept_material_fraction, mode_residual, mode_stalled_iterations, cycle_rounding_factor, max_mode_changes,
            slip.extra_rounds, slip.newton_rounds, slip.round_tolerance, slip.accepted_tension_change,
            slip.max_tension_factor, slip.max_followed_angle,
        }
        continuation {
            max_move_fraction, max_halvings, first_step, grown_step, runaway_step_fraction, drag_factor, rest_drag_fraction,
            max_drag_steps, max_drag_raises, missing_friction_fraction, landing_step_fraction, max_pockets,
            first_tension_weights, second_tension_weights, first_load_fraction, adopted_cone_fractions, first_missing_part,
            max_missing_part, mobilised_fraction,
        }
        initial {
            lying_end_radii, falling_end_radii, route_contact_radii, laid_tension_weights, route_excess_fraction,
            post_approach_radii, wheel_route_radii, end_fit_rounds, max_extended_corners, contact_spacing_fraction,
            adopted_contact_distance_m,
        }
        changes {
            max_changes, max_load_releases, shed_length_fraction, catch_distance_fraction, depth_fraction, max_depth_m,
            release_overlap, corner_search_points, lying_fraction, pocket_tension_fraction, kink_span_fraction,
        }
        verify { fold_force_fraction, tunnelling_points, unchecked_move }
    }
}

/// Random numbers: splitmix64.
struct Dice(u64);

impl Dice {
    #[expect(clippy::cast_precision_loss, reason = "53 bits are exact")]
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A cable and where a hand takes its end.
struct Case {
    problem: Arc<Problem>,
    hand: Option<Vec2>,
}

/// The catalogue as it is, and a cable over hills and posts whose end a hand moves.
fn cases(random: u64) -> Vec<Case> {
    let alone =
        |scene: &Scene| problems(scene).unwrap_or_default().into_iter().map(|problem| Case { problem, hand: None });
    let mut all: Vec<Case> = catalog::all().iter().flat_map(|(_, scene)| alone(scene).collect::<Vec<_>>()).collect();
    for seed in 0..random {
        let mut dice = Dice(seed);
        let width = dice.between(5.0, 30.0);
        let support = |name: &str, at_m| Support { at_m: Some(at_m), ..Support::new(name, SupportKind::Fixed) };
        let ends = [[0.0, dice.between(0.5, 6.0)], [width, dice.between(0.5, 6.0)]];
        let length = width * dice.between(1.02, 1.4) + (ends[0][1] - ends[1][1]).abs();
        let stiffness = 10f64.powf(dice.between(4.0, 6.5));
        let mut scene = catalog::cable_alone(
            [length, dice.between(0.1, 2.0), stiffness],
            vec![support("left", ends[0]), support("right", ends[1])],
        );
        scene.cables[0].friction = if dice.between(0.0, 1.0) < 0.3 { 0.0 } else { dice.between(0.05, 0.6) };
        let mut points_m = Vec::new();
        for k in 0..=8 {
            points_m.push([width * f64::from(k - 1) / 6.0, dice.between(-3.0, 0.3)]);
        }
        scene.obstacles.push(Obstacle {
            name: "ground".to_owned(),
            shape: Shape::Terrain { points_m },
            friction: None,
        });
        for k in 0..3 {
            let center_m = [width * (0.2 + 0.3 * f64::from(k)), dice.between(0.5, 3.0)];
            let shape = Shape::Circle { center_m, radius_m: dice.between(0.05, 0.4) };
            scene.obstacles.push(Obstacle { name: format!("post {k}"), shape, friction: None });
        }
        let hand = Vec2::new(width + dice.between(-3.0, 1.0), ends[1][1] + dice.between(-1.0, 2.0));
        all.extend(alone(&scene).map(|case| Case { hand: Some(hand), ..case }));
    }
    all
}

/// The answers to a case: the greatest tension at each instant, N, up to a refusal, and the iterations.
struct Answers {
    tension_n: Vec<f64>,
    iterations: usize,
}

fn answers(case: &Case, tuned: &Arc<SpansSettings>) -> Answers {
    let mut out = Answers { tension_n: Vec::new(), iterations: 0 };
    let Ok(mut model) = SpansModel::with_settings(case.problem.clone(), Settings::default(), tuned.clone()) else {
        return out;
    };
    let start = case.problem.supports.last().and_then(|s| s.at);
    for k in 0..=INSTANTS {
        let done = if k == 0 { model.settle() } else { model.advance(INTERVAL_S, Inertia::QuasiStatic) };
        let Ok(report) = done else { return out };
        out.iterations += report.cost.iterations;
        let tensions = model.solution();
        out.tension_n.push(tensions.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max));
        if let (Some(hand), Some(start)) = (case.hand, start) {
            #[expect(clippy::cast_precision_loss, reason = "few instants")]
            let part = (k + 1) as f64 / INSTANTS as f64;
            model.drag_support(case.problem.supports.len() - 1, start + (hand - start) * part);
        }
    }
    out
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let random = arguments.first().and_then(|a| a.parse().ok());
    if random.is_some() {
        arguments.remove(0);
    }
    let cases = cases(random.unwrap_or(RANDOM_SCENES));
    let usual: Vec<Answers> = cases.iter().map(|c| answers(c, &Arc::default())).collect();
    let instants: usize = usual.iter().map(|a| a.tension_n.len()).sum();
    let work: usize = usual.iter().map(|a| a.iterations).sum();
    println!("{} cables, {instants} instants answered, {work} iterations", cases.len());
    println!("| setting | factor | instants answered | cables changed | greatest change of tension | iterations |");
    println!("|---|---|---|---|---|---|");
    for (name, scale) in tuned().into_iter().filter(|(name, _)| asked(&arguments, name)) {
        for factor in [0.5, 2.0] {
            let mut settings = SpansSettings::default();
            scale(&mut settings, factor);
            let row = compared(&cases, &usual, &Arc::new(settings));
            println!("| {name} | {factor} | {row} |");
        }
    }
    Ok(())
}

fn asked(words: &[String], name: &str) -> bool {
    words.is_empty() || words.iter().any(|w| name.contains(w.as_str()))
}

/// What changes, as the cells of a row.
fn compared(cases: &[Case], usual: &[Answers], settings: &Arc<SpansSettings>) -> String {
    let (mut answered, mut changed, mut greatest, mut work) = (0i64, 0, 0.0, 0i64);
    for (case, usual) in cases.iter().zip(usual) {
        let now = answers(case, settings);
        answered += difference(now.tension_n.len(), usual.tension_n.len());
        work += difference(now.iterations, usual.iterations);
        let change = now.tension_n.iter().zip(&usual.tension_n).map(|(a, b)| (a - b).abs() / b.max(f64::MIN_POSITIVE));
        let change = change.fold(0.0, f64::max);
        greatest = f64::max(greatest, change);
        changed += u32::from(change > SEEN || now.tension_n.len() != usual.tension_n.len());
    }
    let greatest = if greatest > SEEN { format!("{greatest:.1e}") } else { "none".to_owned() };
    format!("{answered:+} | {changed} | {greatest} | {work:+}")
}

fn difference(now: usize, before: usize) -> i64 {
    i64::try_from(now).unwrap_or(i64::MAX) - i64::try_from(before).unwrap_or(i64::MAX)
}
