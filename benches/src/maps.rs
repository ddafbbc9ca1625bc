//! Maps of stability show what a model does over two parameters, cell by cell, against a closed
//! form.
//!
//! A cell is right, refused with a cause, says that it is uncertain, or is wrong in silence. A
//! refusal where another model is right counts against the model, and is told apart.

use std::f64::consts::PI;
use std::sync::Arc;

use cable_core::catenary::{Catenary, Span};
use cable_core::model::mass_spring::{MassSpringModel, PreviewTuning, Tuning};
use cable_core::model::{Inertia, Mechanics};
use cable_core::scene::{Motion as Path, Obstacle, STANDARD_GRAVITY as G, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::{Warning, WarningKind};
use cable_core::timeline::RunMonitor;
use cable_core::{Error, Model, Settings, Simulation, Solution, SolveError, Vec2};

use crate::explicit::Bar;

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
    /// The error that the answer states of that figure, relative to the same; 0 where it states
    /// none.
    said: f64,
    /// True if a warning on the way said that it is uncertain.
    warned: bool,
}

impl Asked {
    /// Of a force, known as the answer says of its forces.
    fn of_force(error: f64, answer: &Solution, warned: bool) -> Self {
        let said = answer.cables.iter().filter_map(|c| c.error_estimate).fold(0.0, f64::max);
        Self { error, said, warned: warned || uncertain(&answer.warnings) }
    }

    /// Of a place, as the answer says of its places over a scale (m).
    fn of_place(error: f64, answer: &Solution, scale_m: f64, warned: bool) -> Self {
        let said = answer.cables.iter().filter_map(|c| c.errors.position_m).fold(0.0, f64::max) / scale_m;
        Self { error, said, warned: warned || uncertain(&answer.warnings) }
    }
}

/// A map.
#[derive(Clone, Copy)]
pub struct Map {
    /// Short name, as in files.
    pub id: &'static str,
    /// The question.
    pub about: &'static str,
    /// The model that is asked.
    pub model: Model,
    /// Both parameters.
    pub axes: [Axis; 2],
    /// Relative error up to which an answer is right.
    pub tolerance: f64,
    /// The models that are asked where this one refuses.
    others: &'static [Model],
    ask: fn(Model, [f64; 2]) -> Result<Asked, Error>,
}

impl Map {
    /// Returns what the model does at two values; with the error, where there is an answer.
    #[must_use]
    pub fn cell(&self, at: [f64; 2]) -> (Verdict, Option<f64>) {
        match (self.ask)(self.model, at) {
            Ok(asked) => {
                let verdict = if asked.error <= self.tolerance {
                    Verdict::Right
                } else if asked.warned || asked.error <= asked.said {
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
    // `mass-spring` ends sooner, and each of its cells takes longer.
    let wide = ([5.0, 1080.0], [0.1, 1e14]);
    for (id, model, (angles, stiffness)) in [
        ("round-spans", Model::Spans, wide),
        ("round-fem", Model::Fem, wide),
        ("round-mass-spring", Model::MassSpring, ([5.0, 535.0], [100.0, 1e8])),
    ] {
        out.push(Map {
            id,
            about: "a cord of hardly any weight drawn slowly round a rod of 0.1 m, a load on its other end: pull over \
                    load, against e^(μφ)",
            model,
            axes: [even("angle round the rod, degrees", angles), logarithmic("EA over load", stiffness)],
            tolerance: 1e-2,
            others: &[Model::Spans, Model::Fem],
            ask: round,
        });
    }
    let wide = ([2.0, 160.0], [0.0, 10.0]);
    for (id, model, (angles, friction)) in [
        ("corner-spans", Model::Spans, wide),
        ("corner-fem", Model::Fem, wide),
        ("corner-mass-spring", Model::MassSpring, ([2.0, 150.0], [0.0, 1.2])),
    ] {
        out.push(Map {
            id,
            about: "the same over a sharp corner: angle and friction",
            model,
            axes: [even("angle at the corner, degrees", angles), even("friction", friction)],
            tolerance: 1e-2,
            others: &[Model::Spans, Model::Fem],
            ask: corner,
        });
    }
    out.push(Map {
        id: "corners-spans",
        about: "the same over a body whose corners turn the cord by 150° in all: number of corners and stiffness",
        model: Model::Spans,
        axes: [logarithmic("corners", [1.0, 64.0]), logarithmic("EA over load", [0.1, 1e14])],
        tolerance: 1e-2,
        others: &[Model::Fem],
        ask: corners,
    });
    for (id, model) in [("stiff-corner-fem", Model::Fem), ("stiff-corner-mass-spring", Model::MassSpring)] {
        out.push(Map {
            id,
            about: "a stiff cable over the tip of a needle, without friction, 100 elements: its sharpest bend, against \
                    2 √(T/EI) sin(φ/4)",
            model,
            axes: [even("angle at the tip, degrees", [5.0, 150.0]), logarithmic("T/EI, 1/m²", [1e2, 1e7])],
            tolerance: 5e-2,
            others: &[Model::Fem],
            ask: stiff_corner,
        });
    }
    for (id, model, fastest) in [("drag-fem", Model::Fem, 1000.0), ("drag-mass-spring", Model::MassSpring, 60.0)] {
        out.push(Map {
            id,
            about: "a cable on a floor drawn along it in motion, 20 elements: impulse of the pull, less what momentum it makes, once all of it slides, against μ w L t",
            model,
            axes: [logarithmic("speed, m/s", [0.02, fastest]), even("friction", [0.05, 3.0])],
            tolerance: 3e-2,
            others: &[Model::Fem],
            ask: drag,
        });
    }
    out.push(Map {
        id: "pendulum-fem",
        about: "implicit steps of a mass of 10 kg on 2 m of cable, let go at 0.1 rad: its place after a period, \
                against the pendulum's, over its swing",
        model: Model::Fem,
        axes: [logarithmic("step, s", [1e-3, 1.0]), logarithmic("EA, N", [1e4, 1e12])],
        tolerance: 1e-3,
        others: &[Model::MassSpring],
        ask: pendulum,
    });
    out.push(Map {
        id: "preview-mass-spring",
        about: "sub-steps of the preview of the same, on a cable of 0.1 kg/m",
        model: Model::MassSpring,
        axes: [logarithmic("longest sub-step, s", [1e-4, 0.3]), logarithmic("EA, N", [1e8, 1e13])],
        tolerance: 2e-2,
        others: &[Model::Fem],
        ask: preview,
    });
    out.push(Map {
        id: "explicit-mass-spring",
        about: "a taut bar that swings along itself, in explicit steps: place of its nodes after a period, over its \
                swing; theory has the limit dt·ω = 2/√M, M the stiffening by the loss",
        model: Model::MassSpring,
        axes: [even("dt·ω of the fastest mode", [0.1, 3.0]), even("damping ratio of the material", [0.0, 0.02])],
        tolerance: 5e-2,
        others: &[Model::Fem],
        ask: explicit,
    });
    for (id, model) in [("bending-fem", Model::Fem), ("bending-mass-spring", Model::MassSpring)] {
        out.push(Map {
            id,
            about: "a clamped bar, a small load across its end: its deflection, against P L³/3EI",
            model,
            axes: [logarithmic("EI, N m²", [1e-6, 1e8]), logarithmic("elements", [1.0, 200.0])],
            tolerance: 2e-2,
            others: &[Model::Fem],
            ask: bending,
        });
    }
    out
}

/// Returns whether warnings say that an answer is uncertain.
fn uncertain<'w>(warnings: impl IntoIterator<Item = &'w Warning>) -> bool {
    let kinds = [WarningKind::Accuracy, WarningKind::Stabilised, WarningKind::EnergyGrows];
    warnings.into_iter().any(|w| kinds.contains(&w.kind))
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
    Ok(Asked::of_force(error, &answer, false))
}

/// Load on the end of a cord, N.
const LOAD_N: f64 = 10.0;

/// Steps of the second half of a way, in which everything slides.
const COUNTED_STEPS: u32 = 6;

/// Draws the last support on, and compares its mean pull over the load in the second half of the
/// way.
fn drawn(scene: Scene, model: Model, ratio: f64) -> Result<Asked, Error> {
    let (mut simulation, answer) = settled(scene, model, 40)?;
    let mut warned = uncertain(&answer.warnings);
    let (mut sum, mut count) = (0.0, 0);
    for k in 0..2 * COUNTED_STEPS {
        simulation.step_quasi_static(0.5 / f64::from(COUNTED_STEPS))?;
        let answer = simulation.solution();
        warned |= uncertain(&answer.warnings);
        if k >= COUNTED_STEPS {
            sum += force(&answer, 1).norm();
            count += 1;
        }
    }
    let error = (sum / f64::from(count) / LOAD_N / ratio - 1.0).abs();
    Ok(Asked::of_force(error, &simulation.solution(), warned))
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

/// The middle line of a cord where it lies on something: from where it comes to it, plumb from
/// below, to where it leaves it.
struct Way {
    /// Points, m.
    points: Vec<Vec2>,
    /// Length, m, and angle by which it turns, rad.
    length: f64,
    turn: f64,
}

/// Points of a round on a way.
const ROUND_POINTS: u32 = 48;

impl Way {
    /// Round circles of one radius (m) one after the other, by as much at each (rad), their middles
    /// as far apart (m).
    fn round(radius: f64, turn: f64, corners: u32, apart: f64) -> Self {
        let part = turn / f64::from(corners);
        let (mut points, mut middle) = (Vec::new(), Vec2::zeros());
        for k in 0..corners {
            let begun = part * f64::from(k);
            let count = (ROUND_POINTS / corners).max(1);
            let angles = (0..=count).map(|j| PI - begun - part * f64::from(j) / f64::from(count));
            points.extend(angles.map(|a| middle + Vec2::new(a.cos(), a.sin()) * radius));
            middle += heading(begun + part) * apart;
        }
        Self { points, length: radius * turn + apart * f64::from(corners - 1), turn }
    }
}

/// Direction of what went up and has turned by an angle (rad) to the right.
fn heading(turned: f64) -> Vec2 {
    Vec2::new(turned.sin(), turned.cos())
}

/// A convex body with so many corners, at each of which a way turns by as much: its faces go down
/// at the first and on straight at the last.
fn cornered(turn: f64, corners: u32, apart: f64) -> Shape {
    let part = turn / f64::from(corners);
    let mut at = Vec2::zeros();
    let mut points = vec![Vec2::new(0.0, -0.2), at];
    for k in 1..corners {
        at += heading(part * f64::from(k)) * apart;
        points.push(at);
    }
    points.push(at + heading(turn) * 0.2);
    // Counter-clockwise.
    Shape::Polygon { points_m: points.iter().rev().map(|p| [p.x, p.y]).collect() }
}

/// A cord from a load plumb below a shape along a way over it, and on to a hand, which draws it
/// until all of it slides and on.
fn over(shape: Shape, way: &Way, friction: f64, stiffness: f64) -> Scene {
    let (free, draw) = (0.4, 0.06);
    // The cord beyond is stretched by that before all of it slides.
    let ratio = (friction * way.turn).exp();
    let stretch = (free * (ratio - 1.0) + way.length * ratio) / stiffness;
    let below = free + stretch + draw;
    let [first, last] = [way.points.first(), way.points.last()].map(|p| p.copied().unwrap_or_default());
    let beyond = |by: f64| Into::<[f64; 2]>::into(last + heading(way.turn) * by);
    let load = Support { force_n: Some([0.0, -LOAD_N]), ..Support::new("load", SupportKind::Load) };
    let hand = moving("hand", beyond(free), beyond(free + draw + 2.0 * stretch), 1.0);
    let length = below + way.length + free;
    let mut scene = catalog::cable_alone([length, 1e-5, LOAD_N * stiffness], vec![load, hand]);
    // A leg that is stretched to a kilometre weighs no more than one of a metre.
    scene.environment.gravity_m_per_s2 /= below.max(1.0);
    scene.obstacles = vec![Obstacle { name: "round".into(), shape, friction: Some(friction) }];
    for cable in &mut scene.cables {
        cable.diameter_m = 2.0 * CORD_RADIUS;
        let on = way.points.iter().map(|p| [p.x, p.y]);
        cable.route_m = std::iter::once([first.x, first.y - below]).chain(on).chain([beyond(free)]).collect();
    }
    scene
}

/// Radius of a cord, m.
const CORD_RADIUS: f64 = 0.001;

fn round(model: Model, [degrees, stiffness]: [f64; 2]) -> Result<Asked, Error> {
    let (rod, friction, angle) = (0.1, 0.2, degrees.to_radians());
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: rod };
    let way = Way::round(rod + CORD_RADIUS, angle, 1, 0.0);
    drawn(over(shape, &way, friction, stiffness), model, (friction * angle).exp())
}

/// Over a sharp corner: a wedge at whose faces the cord comes and goes.
fn corner(model: Model, [degrees, friction]: [f64; 2]) -> Result<Asked, Error> {
    over_corners(model, 1, degrees.to_radians(), friction, 1e5)
}

/// Over as many corners as there are, half a turn less a little in all.
fn corners(model: Model, [count, stiffness]: [f64; 2]) -> Result<Asked, Error> {
    over_corners(model, count.round() as u32, 150f64.to_radians(), 0.2, stiffness)
}

fn over_corners(model: Model, count: u32, angle: f64, friction: f64, stiffness: f64) -> Result<Asked, Error> {
    let apart = 0.3 / f64::from(count);
    let way = Way::round(CORD_RADIUS, angle, count, apart);
    drawn(over(cornered(angle, count, apart), &way, friction, stiffness), model, (friction * angle).exp())
}

/// Pull on a stiff cable over a corner, N; its radius and the length of its legs, m.
const STIFF_PULL_N: f64 = 10.0;
const STIFF_RADIUS: f64 = 1e-4;
const LEG_M: f64 = 1.0;

/// A stiff cable over the tip of a needle, held at one end and drawn at the other: where it touches
/// it bends by 2 √(T/EI) sin(φ/4), as EI κ²/2 + T cos θ is the same all along a leg that is long
/// beside √(EI/T). T and φ are those of its ends.
fn stiff_corner(model: Model, [degrees, pull_over_stiffness]: [f64; 2]) -> Result<Asked, Error> {
    let half = 0.5 * degrees.to_radians();
    let leg = Vec2::new(half.cos(), -half.sin());
    let pull = leg * STIFF_PULL_N;
    let top = STIFF_RADIUS;
    let hold = Support::fixed("hold", [-LEG_M * leg.x, top + LEG_M * leg.y]);
    let drawn = Support { force_n: Some([pull.x, pull.y]), ..Support::new("pull", SupportKind::Load) };
    let mut scene = catalog::cable_alone([2.0 * LEG_M, 1e-6, 1e5], vec![hold, drawn]);
    scene.environment.gravity_m_per_s2 = 0.0;
    let needle = Shape::Polygon { points_m: vec![[-0.05, -1.2], [0.05, -1.2], [0.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "needle".into(), shape: needle, friction: Some(0.0) }];
    for cable in &mut scene.cables {
        cable.diameter_m = 2.0 * STIFF_RADIUS;
        cable.bending_stiffness_n_m2 = STIFF_PULL_N / pull_over_stiffness;
        cable.route_m = vec![[-LEG_M * leg.x, top + LEG_M * leg.y], [0.0, top], [LEG_M * leg.x, top + LEG_M * leg.y]];
    }
    let (_, answer) = settled(scene, model, 100)?;
    // The cable draws the support towards the needle.
    let held = force(&answer, 0);
    let turn = (held.x * pull.y - held.y * pull.x).atan2(held.dot(&pull)).abs();
    let right = 2.0 * (pull_over_stiffness * held.norm() / STIFF_PULL_N).sqrt() * (0.25 * turn).sin();
    let bend = answer.cables.first().and_then(|c| c.tightest_bend).map_or(0.0, |b| 1.0 / b.radius_m);
    Ok(Asked { error: (bend / right - 1.0).abs(), said: 0.0, warned: uncertain(&answer.warnings) })
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
    let floor = Shape::Terrain { points_m: vec![[-20.0, 0.0], [40.0 + speed * seconds, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".into(), shape: floor, friction: Some(friction) }];
    for cable in &mut scene.cables {
        (cable.diameter_m, cable.damping_ratio) = (2.0 * lies, 0.05);
        cable.route_m = vec![[0.0, lies], [length, lies]];
    }
    let (mut simulation, answer) = settled(scene, model, 20)?;
    let mut warned = uncertain(&answer.warnings);
    let (mut sum, mut began) = (0.0, None);
    while simulation.time_s() < seconds - 1e-9 {
        simulation.step(DRAG_STEP_S)?;
        let answer = simulation.solution();
        warned |= uncertain(&answer.warnings);
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
    Ok(Asked::of_force((given / right - 1.0).abs(), &answer, warned))
}

/// Length of a pendulum, m; its bob, kg; the angle at which it is let go, rad; its elements.
const PENDULUM_M: f64 = 2.0;
const BOB_KG: f64 = 10.0;
const SWING: f64 = 0.1;
const PENDULUM_ELEMENTS: usize = 12;

/// A bob on a cable of some density (kg/m) and stiffness (N), hanging.
fn hanging_bob(density: f64, stiffness: f64) -> Scene {
    let bob = Support { mass_kg: Some(BOB_KG), force_n: Some([0.0, 0.0]), ..Support::new("bob", SupportKind::Load) };
    catalog::cable_alone([PENDULUM_M, density, stiffness], vec![Support::fixed("top", [0.0, 0.0]), bob])
}

/// Lets a hanging bob go aside, and compares its place after a period with that of a rigid
/// pendulum. Coarser runs beside it say how wrong it may be, as they do for every run.
fn let_swing(mut simulation: Simulation, step_s: f64) -> Result<Asked, Error> {
    let answer = simulation.settle()?;
    let mut warned = uncertain(&answer.warnings);
    let hung = simulation.states().first().and_then(|s| s.position_m.last()).map_or(f64::NAN, |p| -p.y);
    let density = simulation.scene().cables.first().map_or(0.0, |c| c.linear_density_kg_per_m);
    let aside = |simulation: &mut Simulation| {
        let mut states = simulation.states();
        for state in &mut states {
            for at in &mut state.position_m {
                *at = Vec2::new(SWING.sin(), -SWING.cos()) * at.norm();
            }
            state.in_motion = true;
        }
        simulation.set_states(&states)
    };
    let mut monitor = RunMonitor::with_errors(&mut simulation, Inertia::Dynamic);
    aside(&mut simulation)?;
    let mut steered = Ok(());
    monitor.steer(|coarse| steered = steered.clone().and(aside(coarse)));
    steered?;
    let cable_kg = density * PENDULUM_M;
    let stiffness = (BOB_KG + 0.5 * cable_kg) * G * hung;
    let omega = (stiffness / ((BOB_KG + cable_kg / 3.0) * hung * hung)).sqrt() * (1.0 - SWING * SWING / 16.0);
    // A period; six steps at least, as coarser runs take twice and three times as long.
    let steps = (2.0 * PI / omega / step_s).ceil().max(6.0) as usize;
    for _ in 0..steps {
        simulation.step(step_s)?;
        monitor.follow(&mut simulation);
        warned |= uncertain(simulation.warnings());
    }
    let turned = SWING * (omega * simulation.time_s()).cos();
    let right = Vec2::new(turned.sin(), -turned.cos()) * hung;
    let at = simulation.states().first().and_then(|s| s.position_m.last().copied());
    let scale = hung * SWING;
    let error = at.map_or(f64::INFINITY, |at| (at - right).norm() / scale);
    let error = if error.is_nan() { f64::INFINITY } else { error };
    Ok(Asked::of_place(error, &simulation.solution(), scale, warned))
}

/// Implicit steps of `fem`, of a bob on hardly any cable.
fn pendulum(model: Model, [step_s, stiffness]: [f64; 2]) -> Result<Asked, Error> {
    let settings = Settings {
        segments: Some(PENDULUM_ELEMENTS),
        inner_step_s: Some(step_s),
        histories: false,
        ..Settings::default()
    };
    let_swing(Simulation::with_settings(hanging_bob(1e-4, stiffness), model, settings)?, step_s)
}

/// Sub-steps of the preview of `mass-spring`, which its stiffness makes it take.
fn preview(model: Model, [sub_step_s, stiffness]: [f64; 2]) -> Result<Asked, Error> {
    let settings = Settings { segments: Some(PENDULUM_ELEMENTS), histories: false, ..Settings::default() };
    let scene = hanging_bob(0.1, stiffness);
    if model != Model::MassSpring {
        return let_swing(Simulation::with_settings(scene, model, settings)?, FRAME_S);
    }
    let preview = PreviewTuning { max_sub_step_s: sub_step_s, ..PreviewTuning::default() };
    let tuning = Arc::new(Tuning { preview, ..Tuning::default() });
    let build = move |problem, settings| -> Result<Box<dyn Mechanics>, SolveError> {
        Ok(Box::new(MassSpringModel::with_tuning(problem, settings, tuning.clone())?))
    };
    let_swing(Simulation::with_mechanics(scene, settings, build)?, FRAME_S)
}

/// A display frame, s.
const FRAME_S: f64 = 1.0 / 60.0;

/// Explicit steps of `mass-spring` below and beyond their limit.
fn explicit(model: Model, [dt_omega, damping]: [f64; 2]) -> Result<Asked, Error> {
    let mut bar = Bar::new(model, dt_omega, damping)?;
    let mut warned = false;
    let error = bar.swing(|simulation| warned |= uncertain(simulation.warnings()))?;
    let error = if error.is_nan() { f64::INFINITY } else { error };
    Ok(Asked { error, said: 0.0, warned })
}

fn bending(model: Model, [stiffness, elements]: [f64; 2]) -> Result<Asked, Error> {
    let length = 1.0;
    // A load that deflects it by a hundredth.
    let load = 0.03 * stiffness / (length * length);
    let clamp = Support { at_m: Some([0.0, 0.0]), angle_deg: Some(0.0), ..Support::new("wall", SupportKind::Clamped) };
    let end = Support { force_n: Some([0.0, -load]), ..Support::new("end", SupportKind::Load) };
    let mut scene = catalog::cable_alone([length, 1e-6, 1e8], vec![clamp, end]);
    scene.environment.gravity_m_per_s2 = 0.0;
    for cable in &mut scene.cables {
        cable.bending_stiffness_n_m2 = stiffness;
    }
    let (_, answer) = settled(scene, model, elements.round() as usize)?;
    let tip = answer.cables.first().and_then(|c| c.nodes.last()).map_or(f64::NAN, |n| -n.y_m);
    let right = load * length.powi(3) / (3.0 * stiffness);
    Ok(Asked::of_place((tip / right - 1.0).abs(), &answer, right, false))
}
