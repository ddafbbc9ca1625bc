//! A problem is one cable, resolved and validated: all that a model needs to know of a scene.

use std::sync::Arc;

use super::time_series::{TIME_TOLERANCE_S, TimeSeries, turn_between};
use super::wheels_as_posts::WheelLeft;
use crate::contact::World;
use crate::contact::geometry::Body;
use crate::contact::moving_outline::Outline;
use crate::math::{Vec2, vec2};
use crate::scene::froude_scaling::Similarity;
use crate::scene::{Cable, Motion, PulleySide, Scene, SupportKind};
use crate::solution::{CableSolution, Warning};

/// Distance within which a load hangs on a support, as a fraction of the cable's length: round-off.
/// Smaller: the support does not feel it; larger: nor does the cable beside it.
const SAME_POINT_FRACTION: f64 = 1e-9;
/// Strain whose force says how large forces are where no load does. Smaller: tolerances near
/// rounding; larger: forces of interest lie within them.
const UNLOADED_STRAIN: f64 = 1e-6;

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
    pub wind: TimeSeries,
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
    /// All obstacles that stay where they are, if it can come to none of them (see
    /// `unreachable_obstacles.rs`).
    pub(crate) unreachable: Option<Arc<World>>,
    /// The moving obstacle that it can touch: the robot.
    pub outline: Option<Arc<Outline>>,
    /// The posts among its obstacles that move: they stand in for wheels.
    pub(crate) moving_posts: Vec<MovingPost>,
    /// Plan view: friction coefficient with the floor and normal force per metre, N/m; None where
    /// there is no friction.
    pub floor_friction: Option<(f64, f64)>,
    /// The way it is first laid, m (empty: straight from support to support, lifted over what is in
    /// the way).
    pub route: Vec<Vec2>,
    /// Notes on places that differ from the scene: supports on a surface, routes below the ground.
    pub notes: Vec<Warning>,
    /// The same cable at the scale solvers are made for, where this one is much shorter, longer or
    /// farther away.
    pub similar: Option<(Similarity, Arc<Problem>)>,
    /// Its wheels, where it has any.
    pub(crate) wheels: Option<Arc<CableWheels>>,
}

/// A post that moves as the wheel did in whose place it is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MovingPost {
    /// Its index among the obstacles.
    pub obstacle: usize,
    /// The motion of its centre.
    pub motion: Motion,
}

impl MovingPost {
    /// Its centre at a time (s), m.
    #[must_use]
    pub fn center_at(&self, time_s: f64) -> Vec2 {
        self.motion.at(time_s).0
    }
}

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
    pub force: TimeSeries,
    /// Lumped mass, kg.
    pub mass: f64,
    /// The time when it lets go, s.
    pub release: Option<f64>,
    /// For a wheel, whether the cable may leave it, or has done so.
    pub departure: Departure,
}

/// The departure of a cable from a wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Departure {
    /// The cable stays on it: it is no wheel, or the cable is a piece of a broken one.
    #[default]
    Never,
    /// A model reports that the wheel would have to pull, for the cable to leave it.
    Possible,
    /// The cable has left it, and goes on without it.
    Done,
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
    pub force: TimeSeries,
}

/// The wheels of a cable, any of which it may leave.
#[derive(Clone, Debug)]
pub(crate) struct CableWheels {
    /// The scene with the wheels.
    pub(super) scene: Scene,
    /// The cable in it.
    pub(super) cable_index: usize,
    /// For each support of the cable, true if it is a wheel.
    pub wheels: Vec<bool>,
    /// For each support of the cable, true if it is a wheel that stands still.
    pub standing: Vec<bool>,
}

/// A cable without some of its wheels: in their place are posts, which stand or move, or nothing.
#[derive(Clone, Debug)]
pub(crate) struct WheelsLeft {
    /// The cable without those supports.
    pub problem: Arc<Problem>,
    /// The wheels.
    pub wheels: Vec<WheelLeft>,
    /// For each support of the scene, true if it is one of them.
    pub replaced: Vec<bool>,
}

impl WheelsLeft {
    /// The problem with which a model of `present` goes on: with the supports of the scene, of
    /// which the wheels that were left let go from a time (s) on and the others stand at their
    /// places (m, where they were led), and with the posts. None if another obstacle would have a
    /// new place in the list.
    #[must_use]
    pub(crate) fn going_on(
        &self,
        present: &Problem,
        scene: &Problem,
        places: &[Option<Vec2>],
        time_s: f64,
    ) -> Option<Arc<Problem>> {
        let [before, after] = [present, &*self.problem].map(|p| p.world.geometry().bodies());
        let same = |(a, b): (&Body, &Body)| a.obstacle == b.obstacle && a.first == b.first && a.name == b.name;
        if !before.iter().zip(after).all(same) {
            return None;
        }
        let (world, moving_posts) = (self.problem.world.clone(), self.problem.moving_posts.clone());
        let mut this = Problem { world, moving_posts, unreachable: None, ..present.clone() };
        for (k, support) in this.supports.iter_mut().enumerate() {
            match (self.replaced.get(k) == Some(&true), support.departure == Departure::Done) {
                (true, false) => (support.release, support.departure) = (Some(time_s), Departure::Done),
                (false, true) => {
                    let own = scene.supports.get(k)?.clone();
                    let at = places.get(k).copied().flatten().or(own.at);
                    *support = SupportPoint { at, ..own };
                }
                _ => {}
            }
        }
        Some(Arc::new(this))
    }
}

impl Problem {
    /// The first time after `from` and before `to` (s) at which a support, a load or the wind turns
    /// back or stops. Friction remembers it, so a step may not pass it.
    #[must_use]
    pub fn turn_between(&self, from: f64, to: f64) -> Option<f64> {
        let series = |s: &TimeSeries| turn_between(&s.times, &s.values, from, to, |v| *v);
        let way = |m: &Motion| turn_between(&m.times_s, &m.points_m, from, to, |p| vec2(*p));
        let moves = |s: &SupportPoint| s.motion.as_ref().and_then(way);
        let supports = self.supports.iter().flat_map(|s| [moves(s), series(&s.force)]);
        let posts = self.moving_posts.iter().map(|post| way(&post.motion));
        let loads = self.loads.iter().map(|l| series(&l.force));
        let all = supports.chain(posts).chain(loads).chain([series(&self.wind)]);
        all.flatten().fold(None, |least: Option<f64>, t| Some(least.map_or(t, |l| if t < l { t } else { l })))
    }

    /// Returns whether obstacles move: the outline of a robot, or posts in place of wheels.
    #[must_use]
    pub(crate) fn has_moving_bodies(&self) -> bool {
        self.outline.is_some() || !self.moving_posts.is_empty()
    }

    /// Returns whether the posts of its world are where they are at a time (s).
    #[must_use]
    pub(crate) fn posts_are_at(&self, time_s: f64) -> bool {
        let bodies = self.world.geometry().bodies();
        let is_there = |post: &MovingPost| {
            bodies.iter().any(|body| body.obstacle == post.obstacle && body.center == Some(post.center_at(time_s)))
        };
        self.moving_posts.iter().all(is_there)
    }

    /// Returns whether all obstacles of its world are where they are at a time (s), and there is no
    /// outline beside them.
    #[must_use]
    pub(crate) fn knows_obstacles_at(&self, time_s: f64) -> bool {
        self.outline.is_none() && self.posts_are_at(time_s)
    }

    /// The same for a model that knows nothing of outlines.
    #[must_use]
    pub(crate) fn without_outline(this: Arc<Self>) -> Arc<Self> {
        if this.outline.is_none() {
            return this;
        }
        Arc::new(Self { outline: None, ..Self::clone(&this) })
    }

    /// The same for a model in which the cable can pass itself.
    #[must_use]
    pub(crate) fn without_self_contact(this: Arc<Self>) -> Arc<Self> {
        if !this.cable.self_contact {
            return this;
        }
        let mut passing = Self::clone(&this);
        passing.cable.self_contact = false;
        Arc::new(passing)
    }

    /// Distributed force per metre of arc length at a time, N/m: weight + wind.
    #[must_use]
    pub fn body_force(&self, time_s: f64) -> Vec2 {
        self.weight + self.wind.at(time_s)
    }

    /// The greatest friction (N) of the floor of a plan view on a length of cable (m) and a lumped
    /// mass (kg), which rubs as cable of its mass does; 0 without such a floor.
    #[must_use]
    pub(crate) fn max_floor_friction(&self, length: f64, mass: f64) -> f64 {
        self.floor_friction
            .map_or(0.0, |(friction, weight_per_m)| friction * weight_per_m * (length + mass / self.linear_density))
    }

    /// The greatest friction of the floor of a plan view on the cable and its lumped masses, N.
    #[must_use]
    pub(crate) fn max_whole_floor_friction(&self) -> f64 {
        self.max_floor_friction(self.length, self.supports.iter().map(|s| s.mass).sum())
    }

    /// Acceleration of gravity, m/s²; 0 of a cable without mass.
    #[must_use]
    pub(crate) fn gravity(&self) -> Vec2 {
        if self.linear_density > 0.0 { self.weight / self.linear_density } else { Vec2::zeros() }
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
            && (self.floor_friction.is_some()
                || self.supports.iter().any(|s| s.friction > 0.0)
                || answer.contacts.iter().any(|c| touches(&c.obstacle)))
    }

    /// Returns what hangs on a free support at a time, N: its load, the weight of its lump, point
    /// loads at the same place. At rest the tension just inside a free end is the size of it, and
    /// the cable pulls at it with the opposite of it.
    #[must_use]
    pub(crate) fn hung_on(&self, support: usize, time_s: f64) -> Vec2 {
        let Some(s) = self.supports.get(support) else { return Vec2::zeros() };
        let gravity = if self.linear_density > 0.0 { self.weight / self.linear_density } else { Vec2::zeros() };
        let here = |l: &&PointLoad| {
            s.arc_length.is_some_and(|a| (l.arc_length - a).abs() <= SAME_POINT_FRACTION * self.length)
        };
        let points: Vec2 = self.loads.iter().filter(here).map(|l| l.force.at(time_s)).sum();
        s.force.at(time_s) + gravity * s.mass + points
    }

    /// A force that says how large forces are here, N: the whole distributed load, point loads and
    /// the weight of lumps, or EA·1e-6 without one.
    #[must_use]
    pub(crate) fn force_scale(&self) -> f64 {
        self.whole_load().max(UNLOADED_STRAIN * self.axial_stiffness)
    }

    /// The whole distributed load, point loads and the weight of lumps, N.
    #[must_use]
    pub(crate) fn whole_load(&self) -> f64 {
        let loads: f64 = self.loads.iter().map(|l| l.force.at(0.0).norm()).sum::<f64>()
            + self.supports.iter().map(|s| s.force.at(0.0).norm()).sum::<f64>();
        let gravity = if self.linear_density > 0.0 { self.weight.norm() / self.linear_density } else { 0.0 };
        let lumps: f64 = self.supports.iter().map(|s| s.mass * gravity).sum();
        self.body_force(0.0).norm() * self.length + loads + lumps
    }
}
