//! This program shows the effect of the tuned constants of `spans` and `catenary`: each is halved and doubled over the scenes of the catalogue and random ones, and
//! compared with the answers by the constants as they are.
//!
//! `cargo run --release -p cable-benches --bin tuned-settings-spans` prints a table; `-- 50` takes so many random scenes, and
//! `-- 50 newton.max_turn drag` only settings whose name holds one of the words.

use std::sync::Arc;

use cable_core::model::catenary::CatenaryModel;
use cable_core::model::catenary::settings::CatenarySettings;
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

/// A model with its tuned constants.
#[expect(clippy::large_enum_variant)] // There are a handful of them, copied once a measurement.
#[derive(Clone, Copy)]
enum Model {
    Spans(SpansSettings),
    Catenary(CatenarySettings),
}

impl Model {
    fn build(self, problem: &Arc<Problem>) -> Option<Box<dyn Mechanics>> {
        let problem = problem.clone();
        Some(match self {
            Self::Spans(tuned) => {
                Box::new(SpansModel::with_settings(problem, Settings::default(), Arc::new(tuned)).ok()?)
            }
            Self::Catenary(tuned) => Box::new(CatenaryModel::with_settings(problem, tuned).ok()?),
        })
    }
}

/// A setting: its name, and its model with the setting scaled.
type Tuned = (&'static str, fn(f64) -> Model);

macro_rules! tuned {
    ($($model:ident $settings:ident { $($($part:ident).+),+ $(,)? })+) => {
        vec![$($((
            stringify!($($part).+),
            (|factor| {
                let mut settings = $settings::default();
                settings.$($part).+.scale(factor);
                Model::$model(settings)
            }) as fn(f64) -> Model,
        )),+),+]
    };
}

fn tuned() -> Vec<Tuned> {
    tuned! {
        Spans SpansSettings {
            newton.max_iterations, newton.max_stalled, newton.max_halvings, newton.residual,
            newton.refined_residual_factor, newton.stalled_residual_factor, newton.max_turn,
            newton.kept_material_fraction, newton.mode_residual, newton.mode_stalled_iterations,
            newton.cycle_rounding_factor, newton.max_mode_changes, newton.slip.extra_rounds,
            newton.slip.newton_rounds, newton.slip.round_tolerance, newton.slip.accepted_tension_change,
            newton.slip.max_tension_factor, newton.slip.max_followed_angle, continuation.max_move_fraction,
            continuation.max_halvings, continuation.first_step, continuation.grown_step,
            continuation.runaway_step_fraction, continuation.drag_factor, continuation.rest_drag_fraction,
            continuation.max_drag_steps, continuation.max_drag_raises, continuation.missing_friction_fraction,
            continuation.landing_step_fraction, continuation.max_pockets, continuation.first_tension_weights,
            continuation.second_tension_weights, continuation.first_load_fraction,
            continuation.adopted_cone_fractions, continuation.first_missing_part, continuation.max_missing_part,
            continuation.mobilised_fraction, initial.lying_end_radii, initial.falling_end_radii,
            initial.route_contact_radii, initial.laid_tension_weights, initial.route_excess_fraction,
            initial.post_approach_radii, initial.wheel_route_radii, initial.end_fit_rounds,
            initial.max_extended_corners, initial.contact_spacing_fraction, initial.adopted_contact_distance_m,
            changes.max_changes, changes.max_load_releases, changes.shed_length_fraction,
            changes.catch_distance_fraction, changes.depth_fraction, changes.max_depth_m, changes.release_overlap,
            changes.corner_search_points, changes.lying_fraction, changes.pocket_tension_fraction,
            changes.kink_span_fraction, verify.fold_force_fraction, verify.tunnelling_points, verify.unchecked_move,
        }
        Catenary CatenarySettings {
            max_move_fraction, max_step_halvings, max_iterations, max_halvings, max_wheel_rounds,
            kept_stretch_fraction, joint_mode_rounds, max_friction_rises, least_touch_gain,
        }
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

fn answers(case: &Case, model: Model) -> Answers {
    let mut out = Answers { tension_n: Vec::new(), iterations: 0 };
    let Some(mut model) = model.build(&case.problem) else { return out };
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

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let random = arguments.first().and_then(|a| a.parse().ok());
    if random.is_some() {
        arguments.remove(0);
    }
    let cases = cases(random.unwrap_or(RANDOM_SCENES));
    let models = [Model::Spans(SpansSettings::default()), Model::Catenary(CatenarySettings::default())];
    let usual = models.map(|model| cases.iter().map(|c| answers(c, model)).collect::<Vec<_>>());
    for (name, usual) in ["spans", "catenary"].into_iter().zip(&usual) {
        let instants: usize = usual.iter().map(|a| a.tension_n.len()).sum();
        let work: usize = usual.iter().map(|a| a.iterations).sum();
        println!("{name}: {} cables, {instants} instants answered, {work} iterations", cases.len());
    }
    println!("| setting | factor | instants answered | cables changed | greatest change of tension | iterations |");
    println!("|---|---|---|---|---|---|");
    for (name, scaled) in tuned().into_iter().filter(|(name, _)| asked(&arguments, name)) {
        for factor in [0.5, 2.0] {
            let model = scaled(factor);
            let (prefix, usual) = match model {
                Model::Spans(_) => ("", &usual[0]),
                Model::Catenary(_) => ("catenary.", &usual[1]),
            };
            println!("| {prefix}{name} | {factor} | {} |", compared(&cases, usual, model));
        }
    }
}

fn asked(words: &[String], name: &str) -> bool {
    words.is_empty() || words.iter().any(|w| name.contains(w.as_str()))
}

/// The changes, as the cells of a row.
fn compared(cases: &[Case], usual: &[Answers], model: Model) -> String {
    let (mut answered, mut changed, mut greatest, mut work) = (0i64, 0, 0.0, 0i64);
    for (case, usual) in cases.iter().zip(usual) {
        let now = answers(case, model);
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
