//! A problem is one cable of a scene in numerical form: all models read it.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | [`Problem`], resolved from a scene |
//! | `support_clearance.rs` | supports on a surface are moved off it by a cable radius |
//! | `ground_route.rs`, `route_check.rs` | routes below the ground are lifted; routes through a beam are refused |
//! | `robot_outline.rs` | the robot as an obstacle |
//! | `wheels_as_posts.rs` | wheels that stand still as rounds which the cable may leave |
//! | `describe_place.rs`, `rounding_error.rs` | places in words; what rounding leaves of an answer |
//!
//! Arc lengths are unstretched at rest temperature; temperature enters as the factor
//! `thermal_stretch` on unstretched lengths: strain = length/(thermal_stretch·ds) − 1. Weight and
//! wind are per metre of arc length.

mod describe_place;
pub(crate) mod ground_route;
pub(crate) mod robot_outline;
mod rounding_error;
mod route_check;
mod support_clearance;
pub(crate) mod wheels_as_posts;

use std::sync::Arc;

use self::wheels_as_posts::{WheelPost, WithPosts};
use crate::contact::World;
use crate::contact::outline::Outline;
use crate::error::SceneError;
use crate::math::{Vec2, vec2};
use crate::scene::scaled::Similarity;
use crate::scene::{Cable, FrictionMobilised, Motion, PulleySide, Scene, SupportKind, View};
use crate::solution::{CableSolution, Warning};

/// One cable, resolved and validated.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The scene's cable.
    pub cable: Cable,
    /// Index of the cable in the scene.
    pub cable_index: usize,
    /// Unstretched length at rest temperature, m.
    pub length: f64,
    /// Length of the whole cable, m, of whose first axial mode the damping ratio is where loss is
    /// viscous.
    pub damped_length: f64,
    /// Times of this problem in parts of those of the scene (see `similar`).
    pub time_scale: f64,
    /// 1 + αΔT.
    pub thermal_stretch: f64,
    /// Mass per metre of arc length, kg/m.
    pub linear_density: f64,
    /// Weight per metre, N/m, a vector (zero in plan view).
    pub weight: Vec2,
    /// Wind per metre as a function of time, N/m.
    pub wind: Series,
    /// EA, N.
    pub axial_stiffness: f64,
    /// EI, N·m².
    pub bending_stiffness: f64,
    /// Cable radius, m.
    pub radius: f64,
    /// Supports in order along the cable.
    pub supports: Vec<SupportPoint>,
    /// Point loads in order along the cable (those of load supports are in `supports`).
    pub loads: Vec<PointLoad>,
    /// Obstacles that it can touch and that stay where they are.
    pub world: Arc<World>,
    /// The moving obstacle that it can touch: the robot.
    pub outline: Option<Arc<Outline>>,
    /// Plan view: friction coefficient with the floor and normal force per metre, N/m.
    pub floor_friction: Option<(f64, f64)>,
    /// The way it is first laid, m (empty: straight from support to support, lifted over what is in
    /// the way).
    pub route: Vec<Vec2>,
    /// Notes on places that differ from the scene: supports on a surface, routes below the ground.
    pub notes: Vec<Warning>,
    /// The same cable at the scale solvers are made for, where this one is much shorter, longer or
    /// farther away.
    pub similar: Option<(Similarity, Arc<Problem>)>,
    /// The same cable with posts in place of its wheels, where it has wheels that stand still.
    pub(crate) wheels_as_posts: Option<Arc<WheelsAsPosts>>,
}

/// Times nearer than this are the same, s: sums of steps come as near to a time as rounding lets
/// them.
const TIME_TOLERANCE_S: f64 = 1e-9;

/// A support, resolved.
#[derive(Clone, Debug)]
pub struct SupportPoint {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: SupportKind,
    /// Place on the cable, m; 0 and length at the ends; None = slides (pulley).
    pub arc_length: Option<f64>,
    /// Position at t = 0, m (a pulley's centre); None for load and free.
    pub at: Option<Vec2>,
    /// Its motion.
    pub motion: Option<Motion>,
    /// Clamp direction of growing arc length, rad.
    pub angle: Option<f64>,
    /// Pulley: radius of the cable's centre line round its wheel, m (0 for a point).
    pub wheel_radius: f64,
    /// Pulley: on which side.
    pub side: PulleySide,
    /// Pulley friction.
    pub friction: f64,
    /// Load: force as a function of time, N.
    pub force: Series,
    /// Lumped mass, kg.
    pub mass: f64,
    /// When it lets go, s.
    pub release: Option<f64>,
}

impl SupportPoint {
    /// Position and velocity at a time, m and m/s; None if it does not hold the cable then.
    #[must_use]
    pub fn position_at(&self, time_s: f64) -> Option<(Vec2, Vec2)> {
        if self.release.is_some_and(|r| time_s >= r) {
            return None;
        }
        self.place_at(time_s)
    }

    /// Returns whether it holds the cable in a step that begins at a time, s.
    #[must_use]
    pub fn holds_from(&self, time_s: f64) -> bool {
        self.release.is_none_or(|r| time_s < r - TIME_TOLERANCE_S)
    }

    /// Returns whether it lets go after `from` and before `to` (s), and when.
    #[must_use]
    pub fn release_between(&self, from: f64, to: f64) -> Option<f64> {
        self.release.filter(|&r| r > from + TIME_TOLERANCE_S && r < to - TIME_TOLERANCE_S)
    }

    /// Position and velocity at a time, m and m/s, whether it holds the cable then or not.
    #[must_use]
    pub fn place_at(&self, time_s: f64) -> Option<(Vec2, Vec2)> {
        match (&self.motion, self.at) {
            (Some(m), Some(_)) => Some(m.at(time_s)),
            (None, Some(p)) => Some((p, Vec2::zeros())),
            _ => None,
        }
    }
}

/// A dead point load.
#[derive(Clone, Debug)]
pub struct PointLoad {
    /// Place on the cable, m.
    pub arc_length: f64,
    /// Force as a function of time, N.
    pub force: Series,
}

/// A vector as a function of time: linear between knots, constant outside them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    times: Vec<f64>,
    values: Vec<Vec2>,
}

impl Series {
    /// The same value at all times.
    #[must_use]
    pub fn constant(value: Vec2) -> Self {
        Self { times: vec![0.0], values: vec![value] }
    }

    /// Knots; times must increase.
    #[must_use]
    pub fn new(times: &[f64], values: &[[f64; 2]]) -> Self {
        Self { times: times.to_vec(), values: values.iter().map(|v| vec2(*v)).collect() }
    }

    /// The value at a time (s).
    #[must_use]
    pub fn at(&self, time_s: f64) -> Vec2 {
        let k = self.times.partition_point(|&t| t <= time_s);
        match (k.checked_sub(1).and_then(|i| self.values.get(i)), self.values.get(k)) {
            (Some(&a), Some(&b)) => {
                let f = (time_s - self.times[k - 1]) / (self.times[k] - self.times[k - 1]);
                a + (b - a) * f
            }
            (Some(&a), None) => a,
            (None, Some(&b)) => b,
            (None, None) => Vec2::zeros(),
        }
    }
}

/// The first of `times` between two others (s, not either of them) at which what goes through
/// `values` turns back or stops.
fn turn_between<V>(times: &[f64], values: &[V], from: f64, to: f64, of: impl Fn(&V) -> Vec2) -> Option<f64> {
    let first = times.partition_point(|&t| t <= from + TIME_TOLERANCE_S);
    let last = times.partition_point(|&t| t < to - TIME_TOLERANCE_S);
    (first.max(1)..last).find_map(|k| {
        let [a, b, c] = [values.get(k - 1)?, values.get(k)?, values.get(k + 1)?].map(&of);
        (!((b - a).dot(&(c - b)) > 0.0)).then_some(times[k])
    })
}

impl Problem {
    /// The first time after `from` and before `to` (s) at which a support, a load or the wind turns
    /// back or stops. Friction remembers it, so a step may not pass it.
    #[must_use]
    pub fn turn_between(&self, from: f64, to: f64) -> Option<f64> {
        let series = |s: &Series| turn_between(&s.times, &s.values, from, to, |v| *v);
        let moves = |s: &SupportPoint| {
            let m = s.motion.as_ref()?;
            turn_between(&m.times_s, &m.points_m, from, to, |p| vec2(*p))
        };
        let supports = self.supports.iter().flat_map(|s| [moves(s), series(&s.force)]);
        let all = supports.chain(self.loads.iter().map(|l| series(&l.force))).chain([series(&self.wind)]);
        all.flatten().fold(None, |least: Option<f64>, t| Some(least.map_or(t, |l| if t < l { t } else { l })))
    }
}

/// Checks a scene as [`crate::Simulation::new`] does, without a model: what is put elsewhere than
/// the scene says is handed back.
///
/// # Errors
/// The first thing wrong with the scene.
pub fn check(scene: &Scene) -> Result<Vec<Warning>, SceneError> {
    Ok(problems(scene)?.iter().flat_map(|p| p.notes.iter().cloned()).collect())
}

/// Resolves every cable of a scene. The scene is validated first.
///
/// # Errors
/// The first thing wrong with the scene.
pub fn problems(scene: &Scene) -> Result<Vec<Arc<Problem>>, SceneError> {
    scene.validate()?;
    let mut out = Vec::with_capacity(scene.cables.len());
    for (index, cable) in scene.cables.iter().enumerate() {
        let problem = placed(scene, index, cable)?;
        route_check::check_route(&problem)?;
        out.push(Arc::new(problem));
    }
    Ok(out)
}

/// A cable with its supports and route clear of what is solid, and its similar copy where it needs
/// one.
fn placed(scene: &Scene, index: usize, cable: &Cable) -> Result<Problem, SceneError> {
    let mut this = problem(scene, index, cable)?;
    support_clearance::clear_supports(&mut this)?;
    ground_route::lift_route(&mut this);
    this.wheels_as_posts = with_posts(scene, index, cable);
    let origin = this.supports.iter().find_map(|s| s.at).or(this.route.first().copied()).unwrap_or_else(Vec2::zeros);
    if scene.robot.is_none()
        && let Some(by) = Similarity::to_natural(cable.length_m, origin)
    {
        let scaled = by.scaled(scene);
        if let Some(cable) = scaled.cables.get(index) {
            let mut copy = problem(&scaled, index, cable)?;
            copy.time_scale = by.time;
            support_clearance::clear_supports(&mut copy)?;
            ground_route::lift_route(&mut copy);
            copy.wheels_as_posts = with_posts(&scaled, index, cable);
            this.similar = Some((by, Arc::new(copy)));
        }
    }
    Ok(this)
}

/// A cable with posts in place of its wheels.
#[derive(Clone, Debug)]
pub(crate) struct WheelsAsPosts {
    /// The cable without those supports.
    pub problem: Arc<Problem>,
    /// The wheels.
    pub wheels: Vec<WheelPost>,
    /// For each support of the scene, true if it is one of them.
    pub replaced: Vec<bool>,
    /// The scene with wheels, and the cable in it.
    source: Arc<(Scene, usize, Cable)>,
}

impl WheelsAsPosts {
    /// The same with wheels elsewhere: for each support its new place, m, or None where it stays;
    /// None where the cable cannot be laid round the posts there.
    pub(crate) fn moved(&self, places: impl IntoIterator<Item = Option<Vec2>>) -> Option<Arc<Self>> {
        let (scene, index, mut cable) = self.source.as_ref().clone();
        for (support, place) in cable.supports.iter_mut().zip(places) {
            support.at_m = place.map(Into::into).or(support.at_m);
        }
        with_posts(&scene, index, &cable)
    }
}

/// A cable with posts in place of its wheels; None where it has none that stand still, or cannot be
/// laid round the posts.
fn with_posts(scene: &Scene, index: usize, cable: &Cable) -> Option<Arc<WheelsAsPosts>> {
    let source = || Arc::new((scene.clone(), index, cable.clone()));
    let WithPosts { scene: with_posts, cables, wheels, replaced } = wheels_as_posts::with_posts(scene, cable)?;
    let lay = |cable: &Cable| -> Result<Problem, SceneError> {
        let mut this = problem(&with_posts, index, cable)?;
        support_clearance::clear_supports(&mut this)?;
        ground_route::lift_route(&mut this);
        route_check::check_route(&this)?;
        Ok(this)
    };
    let problem = Arc::new(cables.iter().find_map(|cable| lay(cable).ok())?);
    Some(Arc::new(WheelsAsPosts { problem, wheels, replaced, source: source() }))
}

fn problem(scene: &Scene, cable_index: usize, cable: &Cable) -> Result<Problem, SceneError> {
    let env = &scene.environment;
    let radius = cable.diameter_m / 2.0;
    let weight_per_m = cable.linear_density_kg_per_m * env.gravity_m_per_s2;
    let (weight, floor_friction) = match scene.view {
        View::Elevation => (Vec2::new(0.0, -weight_per_m), None),
        View::Plan => (Vec2::zeros(), Some((cable.friction, weight_per_m))),
    };
    let last = cable.supports.len().saturating_sub(1);
    let supports: Vec<SupportPoint> = cable
        .supports
        .iter()
        .enumerate()
        .map(|(k, s)| SupportPoint {
            name: s.name.clone(),
            kind: s.kind,
            arc_length: match (k, s.kind) {
                (0, _) => Some(0.0),
                (k, _) if k == last => Some(cable.length_m),
                (_, SupportKind::Pulley) => None,
                _ => s.arc_length_m,
            },
            at: match s.kind {
                SupportKind::Load | SupportKind::Free => None,
                SupportKind::Robot => scene.hitch_m().map(vec2),
                _ => s.at_m.map(vec2),
            },
            motion: s.motion.clone(),
            angle: s.angle_deg.map(f64::to_radians),
            wheel_radius: match s.radius_m {
                Some(r) if r > 0.0 => r + radius,
                _ => 0.0,
            },
            side: s.side.unwrap_or_default(),
            friction: s.friction.unwrap_or(0.0),
            force: force_series(s.force_n, &s.times_s, &s.forces_n),
            mass: s.mass_kg.unwrap_or(0.0),
            release: s.release_s,
        })
        .collect();
    let mut loads: Vec<PointLoad> = scene
        .loads
        .iter()
        .filter(|l| l.cable == cable.name)
        .map(|l| PointLoad { arc_length: l.arc_length_m, force: force_series(l.force_n, &l.times_s, &l.forces_n) })
        .collect();
    loads.sort_by(|a, b| a.arc_length.total_cmp(&b.arc_length));
    let world = World::new(&scene.obstacles, cable.friction, radius);
    let mut cable = cable.clone();
    let rubs = world.geometry().bodies().iter().any(|b| b.friction > 0.0)
        || supports.iter().any(|s| s.friction > 0.0)
        || floor_friction.is_some_and(|(friction, _)| friction > 0.0);
    // Of friction that is not there nothing can be mobilised.
    if !rubs {
        cable.friction_mobilised = FrictionMobilised::default();
    }
    Ok(Problem {
        cable_index,
        length: cable.length_m,
        damped_length: cable.length_m,
        time_scale: 1.0,
        thermal_stretch: 1.0 + cable.thermal_expansion_per_k * env.temperature_change_k,
        linear_density: cable.linear_density_kg_per_m,
        weight,
        wind: force_series(Some(env.wind_n_per_m), &env.wind_times_s, &env.winds_n_per_m),
        axial_stiffness: cable.axial_stiffness_n,
        bending_stiffness: cable.bending_stiffness_n_m2,
        radius,
        supports,
        loads,
        world: Arc::new(world),
        outline: scene.robot_outline(cable.friction).map(Arc::new),
        floor_friction,
        route: cable.route_m.iter().map(|p| vec2(*p)).collect(),
        notes: Vec::new(),
        similar: None,
        wheels_as_posts: None,
        cable,
    })
}

fn force_series(force: Option<[f64; 2]>, times: &[f64], forces: &[[f64; 2]]) -> Series {
    if times.is_empty() {
        force.map_or_else(Series::default, |f| Series::constant(vec2(f)))
    } else {
        Series::new(times, forces)
    }
}

impl Problem {
    /// The same for a model that knows nothing of obstacles that move.
    #[must_use]
    pub fn without_outline(this: Arc<Self>) -> Arc<Self> {
        if this.outline.is_none() {
            return this;
        }
        Arc::new(Self { outline: None, ..Self::clone(&this) })
    }

    /// Distributed force per metre of arc length at a time, N/m: weight + wind.
    #[must_use]
    pub fn body_force(&self, time_s: f64) -> Vec2 {
        self.weight + self.wind.at(time_s)
    }

    /// Returns whether friction takes part in where an answer of this cable rests, and the scene
    /// does not say how much of it.
    #[must_use]
    pub fn rubs(&self, answer: &CableSolution) -> bool {
        let bodies = self.world.geometry().bodies();
        let touches =
            |name: &str| bodies.iter().any(|b| b.friction > 0.0 && self.world.obstacle_name(b.obstacle) == name);
        let given = self.cable.friction_mobilised.is_default();
        given
            && (self.floor_friction.is_some_and(|(friction, _)| friction > 0.0)
                || self.supports.iter().any(|s| s.friction > 0.0)
                || answer.contacts.iter().any(|c| touches(&c.obstacle)))
    }

    /// Returns what hangs on a free support at a time, N: its load, the weight of its lump, point
    /// loads at the same place. At rest the tension just inside a free end is the size of it, and
    /// the cable pulls at it with the opposite of it.
    #[must_use]
    pub fn hung_on(&self, support: usize, time_s: f64) -> Vec2 {
        let Some(s) = self.supports.get(support) else { return Vec2::zeros() };
        let gravity = if self.linear_density > 0.0 { self.weight / self.linear_density } else { Vec2::zeros() };
        let here = |l: &&PointLoad| s.arc_length.is_some_and(|a| (l.arc_length - a).abs() <= 1e-9 * self.length);
        let points: Vec2 = self.loads.iter().filter(here).map(|l| l.force.at(time_s)).sum();
        s.force.at(time_s) + gravity * s.mass + points
    }

    /// A force that says how large forces are here, N: the whole distributed load, point loads and
    /// the weight of lumps, or EA·1e-6 without one.
    #[must_use]
    pub fn force_scale(&self) -> f64 {
        let loads: f64 = self.loads.iter().map(|l| l.force.at(0.0).norm()).sum::<f64>()
            + self.supports.iter().map(|s| s.force.at(0.0).norm()).sum::<f64>();
        let gravity = if self.linear_density > 0.0 { self.weight.norm() / self.linear_density } else { 0.0 };
        let lumps: f64 = self.supports.iter().map(|s| s.mass * gravity).sum();
        (self.body_force(0.0).norm() * self.length + loads + lumps).max(1e-6 * self.axial_stiffness)
    }
}
