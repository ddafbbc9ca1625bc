//! A problem is made of a scene in steps: numbers in place of words, supports and routes clear of
//! what is solid, posts in place of wheels, and a similar copy.

use std::sync::Arc;

use super::definition::{CableWheels, Departure, MovingPost, PointLoad, Problem, SupportPoint, WheelsLeft};
use super::robot_outline::robot_outline;
use super::time_series::TimeSeries;
use super::wheels_as_posts::{StandIn, WithPosts, stands_still, wheels, with_posts};
use super::{ground_route, route_check, support_clearance};
use crate::contact::World;
use crate::error::SceneError;
use crate::math::{Vec2, vec2};
use crate::scene::froude_scaling::Similarity;
use crate::scene::{Cable, FrictionMobilised, Scene, SupportKind, View};
use crate::solution::Warning;

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
        let mut problem = placed(scene, index, cable)?;
        route_check::check_route(&problem)?;
        problem.leave_out_unreachable();
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
    this.wheels = CableWheels::of(scene, index);
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
            copy.wheels = CableWheels::of(&scaled, index);
            this.similar = Some((by, Arc::new(copy)));
        }
    }
    Ok(this)
}

impl CableWheels {
    /// The wheels of a cable; None where it has none.
    fn of(scene: &Scene, cable_index: usize) -> Option<Arc<Self>> {
        let cable = scene.cables.get(cable_index)?;
        let wheels = wheels(cable);
        let standing = cable.supports.iter().zip(&wheels).map(|(s, is_wheel)| *is_wheel && stands_still(s)).collect();
        wheels.contains(&true).then(|| Arc::new(Self { scene: scene.clone(), cable_index, wheels, standing }))
    }

    /// The cable without the wheels that something stands in for, at the places given for its
    /// supports, m (None: where the scene has it). None where that is no wheel, or the cable cannot
    /// be laid round the posts.
    pub(crate) fn left(&self, stand_ins: &[StandIn], places: &[Option<Vec2>]) -> Option<Arc<WheelsLeft>> {
        let mut cable = self.scene.cables.get(self.cable_index)?.clone();
        for (support, place) in cable.supports.iter_mut().zip(places) {
            support.at_m = place.map(Into::into).or(support.at_m);
        }
        let WithPosts { scene, cables, wheels } = with_posts(&self.scene, &cable, stand_ins)?;
        let lay = |cable: &Cable| -> Result<Problem, SceneError> {
            let mut this = problem(&scene, self.cable_index, cable)?;
            support_clearance::clear_supports(&mut this)?;
            ground_route::lift_route(&mut this);
            route_check::check_route(&this)?;
            Ok(this)
        };
        let mut problem = cables.iter().find_map(|cable| lay(cable).ok())?;
        for wheel in &wheels {
            let motion = cable.supports[wheel.support].motion.clone();
            let obstacle = scene.obstacles.iter().position(|o| wheel.post.as_ref() == Some(&o.name));
            if let (Some(motion), Some(obstacle)) = (motion, obstacle) {
                Arc::make_mut(&mut problem.world).let_move(obstacle);
                problem.moving_posts.push(MovingPost { obstacle, motion });
            }
        }
        let problem = Arc::new(problem);
        let replaced = stand_ins.iter().map(|s| *s != StandIn::Wheel).collect();
        Some(Arc::new(WheelsLeft { problem, wheels, replaced }))
    }

    /// The cable with a post in place of each wheel that stands still; None as [`Self::left`].
    pub(crate) fn all_as_posts(&self) -> Option<Arc<WheelsLeft>> {
        let post = |stands: &bool| if *stands { StandIn::Post } else { StandIn::Wheel };
        if !self.standing.contains(&true) {
            return None;
        }
        self.left(&self.standing.iter().map(post).collect::<Vec<_>>(), &[])
    }
}

/// The problem of one cable.
fn problem(scene: &Scene, cable_index: usize, cable: &Cable) -> Result<Problem, SceneError> {
    let env = &scene.environment;
    let radius = cable.diameter_m / 2.0;
    let weight_per_m = cable.linear_density_kg_per_m * env.gravity_m_per_s2;
    let (weight, floor_friction) = match scene.view {
        View::Elevation => (Vec2::new(0.0, -weight_per_m), None),
        // A floor that does not rub does nothing to the cable.
        View::Plan => (Vec2::zeros(), Some((cable.friction, weight_per_m)).filter(|(mu, weight)| mu * weight > 0.0)),
    };
    let supports: Vec<SupportPoint> = (0..cable.supports.len()).map(|k| support_point(scene, cable, k)).collect();
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
        || floor_friction.is_some();
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
        unreachable: None,
        outline: robot_outline(scene, cable.friction).map(Arc::new),
        floor_friction,
        route: cable.route_m.iter().map(|p| vec2(*p)).collect(),
        moving_posts: Vec::new(),
        notes: Vec::new(),
        similar: None,
        wheels: None,
        cable,
    })
}

/// Support `k` of a cable as the models have it.
fn support_point(scene: &Scene, cable: &Cable, k: usize) -> SupportPoint {
    let (s, radius, last) = (&cable.supports[k], cable.diameter_m / 2.0, cable.supports.len().saturating_sub(1));
    SupportPoint {
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
        departure: match s.kind == SupportKind::Pulley && k > 0 && k < last && s.radius_m.is_some_and(|r| r > 0.0) {
            true => Departure::Possible,
            false => Departure::Never,
        },
    }
}

fn force_series(force: Option<[f64; 2]>, times: &[f64], forces: &[[f64; 2]]) -> TimeSeries {
    if times.is_empty() {
        force.map_or_else(TimeSeries::default, |f| TimeSeries::constant(vec2(f)))
    } else {
        TimeSeries::new(times, forces)
    }
}
