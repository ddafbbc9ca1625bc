//! Maps of stability show what a model does over two parameters, cell by cell, against a closed
//! form.
//!
//! A cell is right, refused with a cause, says that it is uncertain, or is wrong in silence. A
//! refusal where another model is right counts against the model, and is told apart.

use cable_core::catenary::{Catenary, Span};
use cable_core::scene::{Motion as Path, Obstacle, STANDARD_GRAVITY as G, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::WarningKind;
use cable_core::{Error, Model, Settings, Simulation, Solution, Vec2};

/// The outcome of a model in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within the tolerance of the map.
    Right,
    /// Off by more, and it says so by its error estimate or a warning.
    Uncertain,
    /// A typed error, and no other model is right there.
    Refused,
    /// A typed error where another model is right.
    OthersAnswer,
    /// Off by more, and nothing says so.
    Wrong,
}

impl Verdict {
    /// All of them, as tables and legends have them.
    pub const ALL: [Self; 5] = [Self::Right, Self::Uncertain, Self::Refused, Self::OthersAnswer, Self::Wrong];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Uncertain => "says how uncertain",
            Self::Refused => "refused",
            Self::OthersAnswer => "refused, another model is right",
            Self::Wrong => "wrong in silence",
        }
    }

    /// Its colour, of the palette of M. Okabe and K. Ito (2008).
    #[must_use]
    pub fn colour(self) -> &'static str {
        match self {
            Self::Right => "#009E73",
            Self::Uncertain => "#F0E442",
            Self::Refused => "#BBBBBB",
            Self::OthersAnswer => "#56B4E9",
            Self::Wrong => "#D55E00",
        }
    }
}

/// One of the two parameters of a map.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Quantity and unit.
    pub label: &'static str,
    /// First and last value.
    pub range: [f64; 2],
    /// True if its values are evenly spaced in their logarithm.
    pub logarithmic: bool,
}

impl Axis {
    /// The value in the middle of cell `k` of `cells`.
    #[must_use]
    pub fn value(&self, k: usize, cells: usize) -> f64 {
        let part = (k as f64 + 0.5) / cells as f64;
        let [a, b] = self.range;
        if self.logarithmic { a * (b / a).powf(part) } else { a + (b - a) * part }
    }
}

/// A figure asked of a model and what it should be; what else the answer says.
pub struct Asked {
    /// Relative error.
    error: f64,
    /// The last answer.
    answer: Solution,
    /// True if a warning on the way said that it is uncertain.
    warned: bool,
}

/// A map.
#[derive(Clone, Copy)]
pub struct Map {
    /// Short name, as in files.
    pub id: &'static str,
    /// The question.
    pub about: &'static str,
    /// Who is asked.
    pub model: Model,
    /// Both parameters.
    pub axes: [Axis; 2],
    /// Relative error up to which an answer is right.
    pub tolerance: f64,
    /// Who else is asked where the model refuses.
    others: &'static [Model],
    ask: fn(Model, [f64; 2]) -> Result<Asked, Error>,
}

impl Map {
    /// Returns what the model does at two values; with the error, where there is an answer.
    #[must_use]
    pub fn cell(&self, at: [f64; 2]) -> (Verdict, Option<f64>) {
        match (self.ask)(self.model, at) {
            Ok(asked) => {
                let said = asked.answer.cables.iter().filter_map(|c| c.error_estimate).fold(0.0, f64::max);
                let verdict = if asked.error <= self.tolerance {
                    Verdict::Right
                } else if asked.warned || asked.error <= said {
                    Verdict::Uncertain
                } else {
                    Verdict::Wrong
                };
                (verdict, Some(asked.error))
            }
            Err(_) => {
                let right = |m: &Model| (self.ask)(*m, at).is_ok_and(|a| a.error <= self.tolerance);
                let others = self.others.iter().any(right);
                (if others { Verdict::OthersAnswer } else { Verdict::Refused }, None)
            }
        }
    }
}

const fn logarithmic(label: &'static str, range: [f64; 2]) -> Axis {
    Axis { label, range, logarithmic: true }
}

const fn even(label: &'static str, range: [f64; 2]) -> Axis {
    Axis { label, range, logarithmic: false }
}

/// All maps.
#[must_use]
pub fn maps() -> Vec<Map> {
    let mut out = Vec::new();
    for (id, model) in [("span-fem", Model::Fem), ("span-mass-spring", Model::MassSpring), ("span-spans", Model::Spans)]
    {
        out.push(Map {
            id,
            about: "a span between supports at one height, from its route: force at the start, against the catenary",
            model,
            axes: [logarithmic("length over chord", [0.95, 30.0]), logarithmic("EA over weight", [2.0, 1e9])],
            tolerance: 1e-2,
            others: &[Model::Catenary, Model::Fem],
            ask: span,
        });
    }
    for (id, model) in
        [("round-spans", Model::Spans), ("round-fem", Model::Fem), ("round-mass-spring", Model::MassSpring)]
    {
        out.push(Map {
            id,
            about: "a cord of hardly any weight drawn slowly round a rod of 0.1 m, a load on its other end: pull over \
                    load, against e^(μφ)",
            model,
            axes: [even("angle round the rod, degrees", [5.0, 535.0]), logarithmic("EA over load", [100.0, 1e8])],
            tolerance: 1e-2,
            others: &[Model::Spans, Model::Fem],
            ask: round,
        });
    }
    for (id, model) in
        [("corner-spans", Model::Spans), ("corner-fem", Model::Fem), ("corner-mass-spring", Model::MassSpring)]
    {
        out.push(Map {
            id,
            about: "the same over a sharp corner: angle and friction",
            model,
            axes: [even("angle at the corner, degrees", [2.0, 150.0]), even("friction", [0.0, 1.2])],
            tolerance: 1e-2,
            others: &[Model::Spans, Model::Fem],
            ask: corner,
        });
    }
    for (id, model) in [("drag-fem", Model::Fem), ("drag-mass-spring", Model::MassSpring)] {
        out.push(Map {
            id,
            about: "a cable on a floor drawn along it in motion, 20 elements: impulse of the pull, less what momentum it makes, once all of it slides, against μ w L t",
            model,
            axes: [logarithmic("speed, m/s", [0.02, 8.0]), even("friction", [0.05, 1.2])],
            tolerance: 3e-2,
            others: &[Model::Fem],
            ask: drag,
        });
    }
    for (id, model) in [("pendulum-fem", Model::Fem), ("pendulum-mass-spring", Model::MassSpring)] {
        out.push(Map {
            id,
            about: "a mass of 10 kg on 2 m of cable, let go at 0.1 rad: time of its first crossing, against the pendulum's",
            model,
            axes: [logarithmic("time between two steps asked for, s", [1e-3, 0.3]), logarithmic("EA, N", [1e4, 1e9])],
            tolerance: 1e-2,
            others: &[Model::Fem],
            ask: pendulum,
        });
    }
    for (id, model) in [("bending-fem", Model::Fem), ("bending-mass-spring", Model::MassSpring)] {
        out.push(Map {
            id,
            about: "a clamped bar, a small load across its end: its deflection, against (P/3 + w L/8) L³/EI",
            model,
            axes: [logarithmic("EI, N m²", [1e-3, 1e4]), logarithmic("elements", [3.0, 200.0])],
            tolerance: 2e-2,
            others: &[Model::Fem],
            ask: bending,
        });
    }
    out
}

/// Returns whether warnings say that an answer is uncertain.
fn warned(answer: &Solution) -> bool {
    let kinds = [WarningKind::Accuracy, WarningKind::Stabilised];
    answer.warnings.iter().any(|w| kinds.contains(&w.kind))
}

fn force(answer: &Solution, support: usize) -> Vec2 {
    let found = answer.cables.first().and_then(|c| c.supports.get(support));
    found.map_or_else(|| Vec2::repeat(f64::NAN), |s| Vec2::new(s.reaction_x_n, s.reaction_y_n))
}

fn settled(scene: Scene, model: Model, segments: usize) -> Result<(Simulation, Solution), Error> {
    let settings = Settings { segments: Some(segments), histories: false, ..Settings::default() };
    let mut simulation = Simulation::with_settings(scene, model, settings)?;
    let answer = simulation.settle()?;
    Ok((simulation, answer))
}

fn span(model: Model, [ratio, stiffness]: [f64; 2]) -> Result<Asked, Error> {
    let (chord, weight_n_per_m) = (10.0, G);
    let length = ratio * chord;
    let axial_stiffness = stiffness * weight_n_per_m * length;
    let supports = vec![Support::fixed("a", [0.0, 0.0]), Support::fixed("b", [chord, 0.0])];
    let scene = catalog::cable_alone([length, 1.0, axial_stiffness], supports);
    let (_, answer) = settled(scene, model, 100)?;
    let weight = Vec2::new(0.0, -weight_n_per_m);
    let span = Span { chord: Vec2::new(chord, 0.0), length, weight, axial_stiffness, thermal_stretch: 1.0 };
    let right = Catenary::solve(&span).map_or(Vec2::repeat(f64::NAN), |c| c.start_force());
    let error = (force(&answer, 0) - right).norm() / right.norm();
    let warned = warned(&answer);
    Ok(Asked { error, answer, warned })
}

/// Load on the end of a cord, N.
const LOAD_N: f64 = 10.0;

/// Steps of the second half of a way, in which everything slides.
const COUNTED_STEPS: u32 = 6;

/// Draws the last support on, and compares its mean pull over the load in the second half of the
/// way.
fn drawn(scene: Scene, model: Model, ratio: f64) -> Result<Asked, Error> {
    let (mut simulation, answer) = settled(scene, model, 40)?;
    let mut warned = warned(&answer);
    let (mut sum, mut count) = (0.0, 0);
    for k in 0..2 * COUNTED_STEPS {
        simulation.step_quasi_static(0.5 / f64::from(COUNTED_STEPS))?;
        let answer = simulation.solution();
        warned |= self::warned(&answer);
        if k >= COUNTED_STEPS {
            sum += force(&answer, 1).norm();
            count += 1;
        }
    }
    let error = (sum / f64::from(count) / LOAD_N / ratio - 1.0).abs();
    Ok(Asked { error, answer: simulation.solution(), warned })
}

fn moving(name: &str, from: [f64; 2], to: [f64; 2], seconds: f64) -> Support {
    let motion = Path { times_s: vec![0.0, seconds], points_m: vec![from, to] };
    Support { motion: Some(motion), ..Support::fixed(name, from) }
}

/// Knots of the ramp of a hand's speed, and parts of its time in which it is over.
const RAMP_KNOTS: u32 = 8;
const RAMP_PART: f64 = 0.2;

/// An end that gets to a velocity (m/s) evenly in a fifth of a time (s), and keeps it to the end of
/// that time.
fn moving_evenly(name: &str, from: [f64; 2], velocity: f64, seconds: f64) -> Support {
    let step = RAMP_PART * seconds / f64::from(RAMP_KNOTS);
    // The last knot, at which it stops, is not reached.
    let count = (1.2 * seconds / step).ceil() as u32;
    let times_s: Vec<f64> = (0..=count).map(|k| step * f64::from(k)).collect();
    let ramp = RAMP_PART * seconds;
    let way = |t: f64| velocity * if t < ramp { 0.5 * t * t / ramp } else { t - 0.5 * ramp };
    let points_m = times_s.iter().map(|t| [from[0] + way(*t), from[1]]).collect();
    Support { motion: Some(Path { times_s, points_m }), ..Support::fixed(name, from) }
}

/// A cord from a load plumb below a round's left side, over it by an angle (rad), and on to a hand.
fn over(shape: Shape, [radius, friction, angle]: [f64; 3], stiffness: f64) -> Scene {
    use std::f64::consts::PI;
    let (free, draw) = (0.4, 0.06);
    let on = |turned: f64| [radius * (PI - turned).cos(), radius * (PI - turned).sin()];
    let beyond = |by: f64| {
        let [x, y] = on(angle);
        [x + by * (PI - angle).sin(), y - by * (PI - angle).cos()]
    };
    let load = Support { force_n: Some([0.0, -LOAD_N]), ..Support::new("load", SupportKind::Load) };
    let length = 2.0 * free + radius * angle;
    let hand = moving("hand", beyond(free), beyond(free + draw + 2.0 * length / stiffness), 1.0);
    let mut scene = catalog::cable_alone([length, 1e-5, LOAD_N * stiffness], vec![load, hand]);
    scene.obstacles = vec![Obstacle { name: "round".into(), shape, friction: Some(friction) }];
    for cable in &mut scene.cables {
        cable.diameter_m = 2.0 * CORD_RADIUS;
        let round = (0..=24).map(|k| on(angle * f64::from(k) / 24.0));
        cable.route_m = std::iter::once([-radius, -free]).chain(round).chain([beyond(free)]).collect();
    }
    scene
}

/// Radius of a cord, m.
const CORD_RADIUS: f64 = 0.001;

fn round(model: Model, [degrees, stiffness]: [f64; 2]) -> Result<Asked, Error> {
    let (rod, friction, angle) = (0.1, 0.2, degrees.to_radians());
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: rod };
    drawn(over(shape, [rod + CORD_RADIUS, friction, angle], stiffness), model, (friction * angle).exp())
}

fn corner(model: Model, [degrees, friction]: [f64; 2]) -> Result<Asked, Error> {
    let angle = degrees.to_radians();
    // A wedge at whose faces the cord comes and goes.
    let (sin, cos) = angle.sin_cos();
    let shape = Shape::Polygon { points_m: vec![[0.0, 0.0], [0.0, -0.2], [0.2 * sin, 0.2 * cos]] };
    drawn(over(shape, [CORD_RADIUS, friction, angle], 1e5), model, (friction * angle).exp())
}

/// Step of a drag in motion, s.
const DRAG_STEP_S: f64 = 1.0 / 240.0;

/// Momentum of the first cable to the right, kg m/s.
fn momentum(answer: &Solution, density: f64) -> f64 {
    let nodes = answer.cables.first().map_or(&[][..], |c| &c.nodes);
    let pieces = nodes.windows(2);
    pieces.map(|w| 0.5 * (w[0].vx_m_per_s + w[1].vx_m_per_s) * (w[1].arc_length_m - w[0].arc_length_m) * density).sum()
}

fn drag(model: Model, [speed, friction]: [f64; 2]) -> Result<Asked, Error> {
    let (length, density, lies) = (5.0, 1.0, 0.01);
    // All of it slides evenly once the hand is at its speed, and has gone a tenth of the length.
    let seconds = 0.5 + 1.0 / speed;
    let supports = vec![Support::new("tail", SupportKind::Free), moving_evenly("hand", [length, lies], speed, seconds)];
    let mut scene = catalog::cable_alone([length, density, 1e5], supports);
    let floor = Shape::Terrain { points_m: vec![[-20.0, 0.0], [40.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".into(), shape: floor, friction: Some(friction) }];
    for cable in &mut scene.cables {
        (cable.diameter_m, cable.damping_ratio) = (2.0 * lies, 0.05);
        cable.route_m = vec![[0.0, lies], [length, lies]];
    }
    let (mut simulation, answer) = settled(scene, model, 20)?;
    let mut warned = warned(&answer);
    let (mut sum, mut began) = (0.0, None);
    while simulation.time_s() < seconds - 1e-9 {
        simulation.step(DRAG_STEP_S)?;
        let answer = simulation.solution();
        warned |= self::warned(&answer);
        if began.is_some() {
            // The hand's impulse over the whole step: its force at the end of it trembles.
            sum += answer.cables[0].momentum.map_or(f64::NAN, |account| account.supports_n_s[0]);
        } else if simulation.time_s() > 0.6 * seconds {
            began = Some((simulation.time_s(), momentum(&answer, density)));
        }
    }
    let answer = simulation.solution();
    let (from_s, before) = began.unwrap_or((f64::NAN, f64::NAN));
    // The remainder of its start, and of slack that comes and goes, is the cable's momentum.
    let given = sum - (momentum(&answer, density) - before);
    let right = friction * density * G * length * (simulation.time_s() - from_s);
    Ok(Asked { error: (given / right - 1.0).abs(), answer, warned })
}

fn pendulum(model: Model, [step_s, stiffness]: [f64; 2]) -> Result<Asked, Error> {
    let (length, mass, swing) = (2.0, 10.0, 0.1f64);
    let bob = Support { mass_kg: Some(mass), force_n: Some([0.0, 0.0]), ..Support::new("bob", SupportKind::Load) };
    let scene = catalog::cable_alone([length, 1e-4, stiffness], vec![Support::fixed("top", [0.0, 0.0]), bob]);
    let (mut simulation, answer) = settled(scene, model, 4)?;
    let mut warned = warned(&answer);
    let hung = length * (1.0 + mass * G / stiffness);
    let mut states = simulation.states();
    for state in &mut states {
        for (at, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            *at = Vec2::new(swing.sin(), -swing.cos()) * (hung * s / length);
        }
        state.in_motion = true;
    }
    simulation.set_states(&states)?;
    let x = |s: &Simulation| s.states().first().and_then(|s| s.position_m.last().map(|p| p.x)).unwrap_or(f64::NAN);
    let (mut before, mut crossing) = (x(&simulation), f64::NAN);
    while simulation.time_s() < 3.0 {
        simulation.step(step_s)?;
        warned |= self::warned(&simulation.solution());
        let now = x(&simulation);
        if before > 0.0 && now <= 0.0 {
            // A sine through both places, as a straight line is off by the square of the step.
            let [a, b] = [before, now].map(|x| (x / (hung * swing)).clamp(-1.0, 1.0).asin());
            crossing = simulation.time_s() - step_s * b / (b - a);
            break;
        }
        before = now;
    }
    let quarter = 0.5 * std::f64::consts::PI * (hung / G).sqrt() * (1.0 + swing * swing / 16.0);
    let error = (crossing / quarter - 1.0).abs();
    let error = if error.is_nan() { f64::INFINITY } else { error };
    Ok(Asked { error, answer: simulation.solution(), warned })
}

fn bending(model: Model, [stiffness, elements]: [f64; 2]) -> Result<Asked, Error> {
    let length = 1.0;
    // A load that deflects it by a hundredth.
    let load = 0.03 * stiffness / (length * length);
    let clamp = Support { at_m: Some([0.0, 0.0]), angle_deg: Some(0.0), ..Support::new("wall", SupportKind::Clamped) };
    let end = Support { force_n: Some([0.0, -load]), ..Support::new("end", SupportKind::Load) };
    // No scene has a lighter cable.
    let density = (1e-6 * load / G).max(1e-6);
    let mut scene = catalog::cable_alone([length, density, 1e8], vec![clamp, end]);
    for cable in &mut scene.cables {
        cable.bending_stiffness_n_m2 = stiffness;
    }
    let (_, answer) = settled(scene, model, elements.round() as usize)?;
    let tip = answer.cables.first().and_then(|c| c.nodes.last()).map_or(f64::NAN, |n| -n.y_m);
    let right = (load / 3.0 + density * G * length / 8.0) * length.powi(3) / stiffness;
    let warned = warned(&answer);
    Ok(Asked { error: (tip / right - 1.0).abs(), answer, warned })
}
