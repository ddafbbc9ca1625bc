//! Convergence is measured on these motions. Each has one figure that is measured, and most have
//! its exact value.

use std::sync::Arc;

use cable_core::model::Stepping;
use cable_core::model::mass_spring::{MassSpringModel, Tuning};
use cable_core::scene::{Motion as Path, Obstacle, STANDARD_GRAVITY as G, Scene, Shape, Support, SupportKind, catalog};
use cable_core::state::State;
use cable_core::{Error, Model, Settings, Simulation, SolveError, Vec2};

use crate::machine::{Clock, Spent};

/// A motion and the figure that is measured in it.
#[derive(Clone, Copy)]
pub struct Motion {
    /// Short name, as in files.
    pub id: &'static str,
    /// The event, and the figure that is measured.
    pub about: &'static str,
    /// Numbers of elements of the series of meshes, from coarse to fine.
    pub meshes: &'static [usize],
    /// Runs the motion and returns the figure.
    run: fn(&mut Run) -> Result<Vec2, SolveError>,
    scene: fn(usize) -> Scene,
    /// The exact figure; `None` if that of the finest run of `fem` takes its place.
    pub exact: Option<fn() -> Vec2>,
}

/// The figures that a run measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The figure, a place (m) or a number with 0 beside it.
    pub figure: Vec2,
    /// Positions of [`SHAPE_PLACES`] even places of the cable at the end, m.
    pub shape: Vec<Vec2>,
    /// Length of the cable, m.
    pub length_m: f64,
    /// The computing time of the motion alone.
    pub spent: Spent,
}

/// Number of places of the cable whose positions at the end of a motion are compared.
pub const SHAPE_PLACES: usize = 33;

/// A simulation at its start, and its time step.
struct Run {
    sim: Simulation,
    step_s: f64,
}

/// A tolerance so large that no model takes shorter steps than it is told.
const ANY_TOLERANCE: f64 = 1e9;

impl Motion {
    /// Runs the motion by a model with this number of elements and this time step, s.
    ///
    /// # Errors
    /// The model cannot follow it.
    pub fn measure(&self, model: Model, elements: usize, step_s: f64) -> Result<Measured, Error> {
        let sim = Simulation::with_settings(self.meshed(elements), model, settings(step_s))?;
        self.follow(sim, step_s)
    }

    /// Runs the motion by `mass-spring` in sub-steps that are a fraction of the longest stable one.
    ///
    /// # Errors
    /// The model cannot follow it.
    pub fn measure_in_sub_steps(&self, elements: usize, step_s: f64, stable_fraction: f64) -> Result<Measured, Error> {
        let mut tuning = Tuning::default();
        tuning.sub_step.stable_fraction = stable_fraction;
        let tuning = Arc::new(tuning);
        let sim = Simulation::with_mechanics(self.meshed(elements), settings(step_s), move |problem, settings| {
            Ok(Box::new(MassSpringModel::with_tuning(problem, settings, Arc::clone(&tuning))?))
        })?;
        self.follow(sim, step_s)
    }

    fn meshed(&self, elements: usize) -> Scene {
        let mut scene = (self.scene)(elements);
        for cable in &mut scene.cables {
            cable.segments = Some(elements);
        }
        scene
    }

    fn follow(&self, mut sim: Simulation, step_s: f64) -> Result<Measured, Error> {
        sim.settle()?;
        let mut run = Run { sim, step_s };
        let clock = Clock::start();
        let figure = (self.run)(&mut run)?;
        let spent = clock.spent();
        let length_m = run.sim.scene().cables.first().map_or(0.0, |c| c.length_m);
        Ok(Measured { figure, shape: shape(&run.sim, length_m), length_m, spent })
    }
}

fn settings(step_s: f64) -> Settings {
    Settings {
        tolerance: ANY_TOLERANCE,
        stepping: Stepping::Explicit,
        inner_step_s: Some(step_s),
        histories: false,
        ..Settings::default()
    }
}

impl Run {
    /// Starts the motion from another shape, at rest.
    fn begin(&mut self, shape: impl FnOnce(&mut State)) -> Result<(), SolveError> {
        let mut states = self.sim.states();
        if let Some(state) = states.first_mut() {
            shape(state);
            state.velocity_m_per_s = vec![Vec2::zeros(); state.position_m.len()];
            state.in_motion = true;
        }
        self.sim.set_states(&states)
    }

    /// Runs the motion until `end_s` (s) and calls `look` after each step.
    fn follow(&mut self, end_s: f64, mut look: impl FnMut(&Simulation, f64)) -> Result<(), SolveError> {
        for _ in 0..(end_s / self.step_s).round() as usize {
            self.sim.step(self.step_s)?;
            look(&self.sim, self.step_s);
        }
        Ok(())
    }
}

/// The force on a support of the only cable, N.
fn force_on(sim: &Simulation, support: usize) -> Vec2 {
    let answer = sim.solution();
    let found = answer.cables.first().and_then(|c| c.supports.get(support));
    found.map_or_else(Vec2::zeros, |s| Vec2::new(s.reaction_x_n, s.reaction_y_n))
}

/// Positions of even places of the only cable, m.
fn shape(sim: &Simulation, length_m: f64) -> Vec<Vec2> {
    let answer = sim.solution();
    let places = (0..SHAPE_PLACES).map(|k| length_m * k as f64 / (SHAPE_PLACES - 1) as f64);
    answer.cables.first().map_or_else(Vec::new, |cable| places.filter_map(|s| cable.position_at(s)).collect())
}

/// The position of the last node of the only cable, m.
fn tip(sim: &Simulation) -> Vec2 {
    sim.states().first().and_then(|s| s.position_m.last().copied()).unwrap_or_default()
}

fn floor(points_m: Vec<[f64; 2]>) -> Obstacle {
    Obstacle { name: "floor".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.5) }
}

/// All motions.
#[must_use]
pub fn motions() -> [Motion; 10] {
    [
        Motion {
            id: "swing",
            about: "a chain of 10 m, level and held at one end, is let go: place of its tip after 1 s (m)",
            meshes: &[5, 10, 20, 40, 80, 160],
            scene: |_| hung_by_one_end(1e7),
            run: |run| {
                run.begin(|s| s.position_m = s.arc_length_m.iter().map(|&s| Vec2::new(s, 0.0)).collect())?;
                run.follow(1.0, |_, _| ())?;
                Ok(tip(&run.sim))
            },
            exact: None,
        },
        Motion {
            id: "fold",
            about: "a folded chain of 10 m, one end let go beside the other: time in which it falls 6 m (s), against energy \
                    that is kept (M. G. Calkin, R. H. March, Am. J. Phys. 57, 1989), of a fold without width",
            meshes: &[5, 11, 21, 41, 81, 161],
            scene: |_| hung_by_one_end(1e7),
            run: |run| {
                run.begin(fold)?;
                let (mut last, mut found) = ([0.0; 2], None);
                run.follow(1.2, |sim, step_s| {
                    let now = [last[0] + step_s, -tip(sim).y];
                    if found.is_none() && now[1] >= FALLEN_M {
                        found = Some(now[0] - step_s * (now[1] - FALLEN_M) / (now[1] - last[1]));
                    }
                    last = now;
                })?;
                Ok(Vec2::new(found.unwrap_or(f64::NAN), 0.0))
            },
            exact: Some(|| Vec2::new(calkin_march_s(10.0, FALLEN_M), 0.0)),
        },
        Motion {
            id: "free-fall",
            about: "a cable of 10 m hung by both ends is let go: depth by which its middle of mass falls in 0.5 s (m)",
            meshes: &[10, 20, 40, 80],
            scene: |_| let_go(None),
            run: |run| {
                let before = middle_of_mass(&run.sim);
                run.follow(0.5, |_, _| ())?;
                Ok(before - middle_of_mass(&run.sim))
            },
            exact: Some(|| Vec2::new(0.0, 0.5 * G * (0.5 - LET_GO_S).powi(2))),
        },
        Motion {
            id: "drop",
            about: "the same 1 m above a floor, on which it lies after 0.9 s: impulse of floor and supports as the model accounts for it, over its weight times 0.9 s",
            meshes: &[42, 84, 168, 336],
            scene: |_| let_go(Some(floor(vec![[-5.0, 0.0], [15.0, 0.0]]))),
            run: |run| {
                let weight = weight(&run.sim);
                let mut impulse = 0.0;
                run.follow(0.9, |sim, _| {
                    let answer = sim.solution();
                    let accounts = answer.cables.iter().filter_map(|c| c.momentum);
                    impulse += accounts.map(|a| a.contacts_n_s[1] + a.supports_n_s[1]).sum::<f64>();
                })?;
                Ok(Vec2::new(impulse / (0.9 * weight), 0.0))
            },
            exact: Some(|| Vec2::new(1.0, 0.0)),
        },
        Motion {
            id: "drag",
            about: "a tail of 6.6 m is dragged along a floor by a hand that is fastest after 5 s: mean pull from 4 s to 6 s (N)",
            meshes: &[30, 60, 120],
            scene: |_| catalog::floor_drag(),
            run: |run| {
                let mut pulls = Vec::new();
                run.follow(6.0, |sim, _| {
                    if sim.time_s() > 4.0 {
                        pulls.push(force_on(sim, 1).norm());
                    }
                })?;
                Ok(Vec2::new(mean_and_ripple(&pulls).x, 0.0))
            },
            exact: None,
        },
        capstan(
            "capstan-half",
            "a cord wound half a turn round a rod is drawn on, a weight on its other end: mean pull over the weight, against \
             Euler's e^(μφ), and its ripple",
            |n| wound(std::f64::consts::PI, n),
            || euler(std::f64::consts::PI),
        ),
        capstan(
            "capstan-one-and-a-half",
            "the same with one and a half turns",
            |n| wound(3.0 * std::f64::consts::PI, n),
            || euler(3.0 * std::f64::consts::PI),
        ),
        Motion {
            id: "wave",
            about: "the end of a taut bar of 20 m is moved by 0.05 m within 0.2 s, before its wave is back: impulse beyond the pull at \
                    rest over √(EA ρ) times the move",
            meshes: &[20, 40, 80, 160],
            scene: |_| pulled_bar(),
            run: |run| {
                let rest = force_on(&run.sim, 1).x;
                let mut impulse = 0.0;
                run.follow(0.35, |sim, step_s| impulse += step_s * (force_on(sim, 1).x - rest))?;
                Ok(Vec2::new(impulse.abs() / ((BAR_EA_N * 1.0f64).sqrt() * MOVED_M), 0.0))
            },
            exact: Some(|| Vec2::new(1.0, 0.0)),
        },
        Motion {
            id: "wall",
            about: "a bar of 20 m hung from a wall runs against it at 1 m/s: mean pull beyond that at rest, from 0.2 to 0.8 of the \
                    time 2L/c after which its wave is back, over √(EA ρ) v",
            meshes: &[20, 40, 80, 160],
            scene: |_| running_bar(),
            run: |run| {
                let rest = force_on(&run.sim, 0).norm();
                let mut states = run.sim.states();
                if let Some(state) = states.first_mut() {
                    let speeds = state.velocity_m_per_s.iter_mut().skip(1);
                    speeds.for_each(|v| *v = Vec2::new(0.0, -RUN_M_PER_S));
                    state.in_motion = true;
                }
                run.sim.set_states(&states)?;
                let back_s = 2.0 * 20.0 / BAR_EA_N.sqrt();
                let (mut impulse, mut time_s) = (0.0, 0.0);
                run.follow(0.8 * back_s, |sim, step_s| {
                    if sim.time_s() > 0.2 * back_s {
                        impulse += step_s * (force_on(sim, 0).norm() - rest);
                        time_s += step_s;
                    }
                })?;
                Ok(Vec2::new(impulse / (time_s * BAR_EA_N.sqrt() * RUN_M_PER_S), 0.0))
            },
            exact: Some(|| Vec2::new(1.0, 0.0)),
        },
        Motion {
            id: "snap",
            about: "a mass of 100 kg snaps a rope of no weight and 10 m taut at 6.26 m/s: greatest pull (kN), against \
                    W + √(W² + EA m v²/L)",
            meshes: &[1, 2, 4, 8, 16],
            scene: |_| snapped(),
            run: |run| {
                let speed = (2.0 * G * FALL_M).sqrt();
                let mut states = run.sim.states();
                if let Some(state) = states.first_mut() {
                    for (k, s) in state.arc_length_m.iter().enumerate() {
                        state.position_m[k] = Vec2::new(0.0, -s);
                        state.velocity_m_per_s[k] = Vec2::new(0.0, -speed * s / 10.0);
                    }
                }
                run.sim.set_states(&states)?;
                let (mut last, mut greatest) = ([0.0; 3], 0.0f64);
                run.follow(1.0, |sim, _| {
                    // The greatest force lies between two steps: it is the maximum of a parabola
                    // through three of them.
                    last = [last[1], last[2], SNAP_EA_N * (-tip(sim).y / 10.0 - 1.0)];
                    let [a, b, c] = last;
                    if b > a && b > c {
                        greatest = greatest.max(b + 0.125 * (c - a).powi(2) / (2.0 * b - a - c));
                    }
                })?;
                Ok(Vec2::new(1e-3 * greatest, 0.0))
            },
            exact: Some(|| {
                let weight = 100.0 * G;
                Vec2::new(1e-3 * weight * (1.0 + (1.0 + 2.0 * FALL_M * SNAP_EA_N / (weight * 10.0)).sqrt()), 0.0)
            }),
        },
    ]
}

fn capstan(id: &'static str, about: &'static str, scene: fn(usize) -> Scene, exact: fn() -> Vec2) -> Motion {
    Motion {
        id,
        about,
        meshes: &[30, 60, 120],
        scene,
        run: |run| {
            let mut pulls = Vec::new();
            run.follow(1.5, |sim, _| {
                if sim.time_s() > 0.75 {
                    pulls.push(force_on(sim, 1).norm() / HUNG_N);
                }
            })?;
            Ok(mean_and_ripple(&pulls))
        },
        exact: Some(exact),
    }
}

fn mean_and_ripple(pulls: &[f64]) -> Vec2 {
    let mean = pulls.iter().sum::<f64>() / pulls.len() as f64;
    let [low, high] = pulls.iter().fold([f64::INFINITY, 0.0], |[a, b], p| [a.min(*p), b.max(*p)]);
    Vec2::new(mean, high - low)
}

/// A chain of 10 m and 1 kg/m, held at one end.
fn hung_by_one_end(ea: f64) -> Scene {
    let supports = vec![Support::fixed("hook", [0.0, 0.0]), Support::new("tip", SupportKind::Free)];
    catalog::cable_alone([10.0, 1.0, ea], supports)
}

/// Height by which a folded chain falls, m.
const FALLEN_M: f64 = 6.0;

/// Folds the chain: half of it downwards, one link across, half of it upwards.
fn fold(state: &mut State) {
    let n = state.position_m.len().saturating_sub(1);
    let (down, mut at) = (n.saturating_sub(1) / 2, Vec2::zeros());
    for (j, p) in state.position_m.iter_mut().skip(1).enumerate() {
        at += match j.cmp(&down) {
            std::cmp::Ordering::Less => -Vec2::y(),
            std::cmp::Ordering::Equal => Vec2::x(),
            std::cmp::Ordering::Greater => Vec2::y(),
        } * (10.0 / n as f64);
        *p = at;
    }
}

/// Time (s) to fall by `x` (m) with v² = g x (2L − x)/(L − x): ∫dx/v with x = u², so that the root
/// is gone.
fn calkin_march_s(length: f64, x: f64) -> f64 {
    let n = 2000;
    let h = x.sqrt() / f64::from(n);
    let slope = |u: f64| 2.0 * ((length - u * u) / (G * (2.0 * length - u * u))).sqrt();
    (0..n).map(|k| h * slope((f64::from(k) + 0.5) * h)).sum()
}

/// The time at which an end is released, s.
const LET_GO_S: f64 = 0.01;

/// A cable of 10 m that is released at both ends, 1 m above the obstacle, if there is one.
fn let_go(below: Option<Obstacle>) -> Scene {
    let hook = |name: &str, x: f64| Support { release_s: Some(LET_GO_S), ..Support::fixed(name, [x, 1.0]) };
    let mut scene = catalog::cable_alone([10.0, 1.246, 2e6], vec![hook("A", 0.0), hook("B", 9.95)]);
    scene.obstacles = below.into_iter().collect();
    scene
}

fn weight(sim: &Simulation) -> f64 {
    sim.scene().cables.iter().map(|c| c.length_m * c.linear_density_kg_per_m * G).sum()
}

fn middle_of_mass(sim: &Simulation) -> Vec2 {
    let Some(state) = sim.states().into_iter().next() else { return Vec2::zeros() };
    let pieces = state.arc_length_m.windows(2).zip(state.position_m.windows(2));
    let moments: Vec2 = pieces.map(|(s, x)| (x[0] + x[1]) * (0.5 * (s[1] - s[0]))).sum();
    moments / state.arc_length_m.last().copied().unwrap_or(1.0)
}

/// Weight on the end of a cord, N.
const HUNG_N: f64 = 5.4;
/// Friction coefficient between the cord and the rod.
const RUBS: f64 = 0.2;

fn euler(angle: f64) -> Vec2 {
    Vec2::new((RUBS * angle).exp(), 0.0)
}

/// A cord without weight that is wound by an angle (rad) round a rod, with a weight on one end and
/// a hand that draws the other end.
fn wound(angle: f64, elements: usize) -> Scene {
    use std::f64::consts::PI;
    let (radius, free, cord) = (0.1, 0.3, 0.001);
    let on = |back: f64| [(radius + cord) * (PI - back).cos(), (radius + cord) * (PI - back).sin()];
    let beyond = |by: f64| {
        let [x, y] = on(angle);
        [x + by * (PI - angle).sin(), y - by * (PI - angle).cos()]
    };
    let weight = Support { force_n: Some([0.0, -HUNG_N]), ..Support::new("weight", SupportKind::Load) };
    let motion = Path { times_s: vec![0.0, 2.0], points_m: vec![beyond(free), beyond(free + 0.05)] };
    let hand = Support { motion: Some(motion), ..Support::fixed("hand", beyond(free)) };
    let length = 2.0 * free + (radius + cord) * angle;
    let mut scene = catalog::cable_alone([length, 1e-5, 1e4], vec![weight, hand]);
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: radius };
    scene.obstacles = vec![Obstacle { name: "rod".into(), shape, friction: Some(RUBS) }];
    for cable in &mut scene.cables {
        (cable.diameter_m, cable.segments) = (2.0 * cord, Some(elements));
        let round = (0..=24).map(|k| on(angle * f64::from(k) / 24.0));
        cable.route_m = std::iter::once([-radius - cord, -free]).chain(round).chain([beyond(free)]).collect();
    }
    scene
}

/// Axial stiffness EA of a bar of 1 kg/m, N.
const BAR_EA_N: f64 = 1e4;
/// Displacement of the end of the bar, m.
const MOVED_M: f64 = 0.05;

/// A bar of 20 m under a tension of 200 N whose end is moved.
fn pulled_bar() -> Scene {
    let at = [20.4, 0.0];
    let motion = Path { times_s: vec![0.0, 0.2], points_m: vec![at, [at[0] + MOVED_M, 0.0]] };
    let end = Support { motion: Some(motion), ..Support::fixed("end", at) };
    let mut scene = catalog::cable_alone([20.0, 1.0, BAR_EA_N], vec![Support::fixed("wall", [0.0, 0.0]), end]);
    scene.environment.gravity_m_per_s2 = 0.0;
    scene
}

/// Speed at which a bar hits a wall, m/s.
const RUN_M_PER_S: f64 = 1.0;

/// A bar of 20 m that hangs, so that it stays taut while it moves.
fn running_bar() -> Scene {
    let supports = vec![Support::fixed("wall", [0.0, 0.0]), Support::new("end", SupportKind::Free)];
    catalog::cable_alone([20.0, 1.0, BAR_EA_N], supports)
}

/// Height by which a mass falls before its rope is taut, m.
const FALL_M: f64 = 2.0;
/// Axial stiffness EA of the rope, N.
const SNAP_EA_N: f64 = 2e4;

/// A mass of 100 kg on a rope without weight.
fn snapped() -> Scene {
    let mass = Support { mass_kg: Some(100.0), force_n: Some([0.0, 0.0]), ..Support::new("mass", SupportKind::Load) };
    catalog::cable_alone([10.0, 1e-6, SNAP_EA_N], vec![Support::fixed("top", [0.0, 0.0]), mass])
}
