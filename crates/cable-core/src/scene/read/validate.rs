//! A scene is valid if every number is finite and in range, every name known, and every key where
//! it belongs.
//!
//! The ranges are wide: they keep out what is surely a slip or would hurt the program, not what is
//! unusual.

use super::key_path::Path;
use super::number_and_name_checks::{
    CheckResult, MAX_KNOTS, MAX_POINTS_ON_CABLE, at_most, distinct_neighbours, force, number, point, points, series,
    unique,
};
use super::range;
use super::self_touch::{LineSelfTouch, first_self_touch};
use super::{length_check, support_rules};
use crate::error::{DocumentFault, SceneError, SceneFault};
use crate::math::Point;
use crate::scene::{Cable, Environment, LineEnds, Load, Obstacle, Robot, RobotTask, Scene, Shape, VERSION, preset};

/// Most cables. More would be solved, slowly; a file with more is surely a slip.
const MAX_CABLES: usize = 1000;
/// Most corner points of all obstacles together: more than the longest text can hold.
const MAX_OBSTACLE_POINTS: usize = 1_000_000;
/// Longest name of a scene, bytes.
const MAX_TITLE: usize = 1000;

impl Scene {
    /// Checks every number and name.
    ///
    /// # Errors
    /// The first thing wrong.
    pub fn validate(&self) -> Result<(), SceneError> {
        let root = Path::Root;
        if self.version != VERSION {
            return Err(root.key("version").fault(SceneFault::Version { value: f64::from(self.version) }));
        }
        if self.name.len() > MAX_TITLE {
            return Err(root.key("name").document_fault(DocumentFault::LongName { most: MAX_TITLE }));
        }
        check_environment(&self.environment)?;
        let at = root.key("cables");
        if self.cables.is_empty() {
            return Err(at.document_fault(DocumentFault::NoCable));
        }
        at_most(&at, self.cables.len(), MAX_CABLES)?;
        unique(&at, self.cables.iter().map(|c| c.name.as_str()))?;
        for (i, cable) in self.cables.iter().enumerate() {
            check_cable(self, cable, &at.index(i))?;
        }
        let at = root.key("obstacles");
        unique(&at, self.obstacles.iter().map(|o| o.name.as_str()))?;
        let mut points = 0;
        for (i, obstacle) in self.obstacles.iter().enumerate() {
            points += check_obstacle(obstacle, &at.index(i))?;
        }
        at_most(&at, points, MAX_OBSTACLE_POINTS)?;
        let at = root.key("loads");
        at_most(&at, self.loads.len(), MAX_POINTS_ON_CABLE)?;
        for (i, load) in self.loads.iter().enumerate() {
            check_load(self, load, &at.index(i))?;
        }
        if let Some(robot) = &self.robot {
            check_robot(robot, &root.key("robot"))?;
        }
        for (i, cable) in self.cables.iter().enumerate() {
            length_check::check_tangents_exist(self, cable, &root.key("cables").index(i))?;
            length_check::check_length(self, cable, &root.key("cables").index(i).key("length_m"))?;
        }
        Ok(())
    }
}

fn check_environment(env: &Environment) -> CheckResult {
    let at = Path::Root.key("environment");
    number(&at.key("gravity_m_per_s2"), env.gravity_m_per_s2, range::GRAVITY)?;
    number(&at.key("temperature_change_k"), env.temperature_change_k, range::TEMPERATURE)?;
    point(&at.key("wind_n_per_m"), env.wind_n_per_m, range::WIND)?;
    if env.wind_times_s.is_empty() && env.winds_n_per_m.is_empty() {
        return Ok(());
    }
    series(&at.key("wind_times_s"), &at.key("winds_n_per_m"), &env.wind_times_s, &env.winds_n_per_m, range::WIND)
}

fn check_cable(scene: &Scene, cable: &Cable, at: &Path<'_>) -> CheckResult {
    let numbers = [
        ("length_m", cable.length_m, range::LENGTH),
        ("linear_density_kg_per_m", cable.linear_density_kg_per_m, range::DENSITY),
        ("axial_stiffness_n", cable.axial_stiffness_n, range::AXIAL_STIFFNESS),
        ("bending_stiffness_n_m2", cable.bending_stiffness_n_m2, range::BENDING_STIFFNESS),
        ("diameter_m", cable.diameter_m, range::DIAMETER),
        ("damping_ratio", cable.damping_ratio, range::DAMPING),
        ("thermal_expansion_per_k", cable.thermal_expansion_per_k, range::THERMAL),
        ("service_tension_n", cable.service_tension_n, range::TENSION),
        ("breaking_tension_n", cable.breaking_tension_n, range::TENSION),
        ("breaking_time_s", cable.breaking_time_s, range::BREAKING_TIME),
        ("min_bend_radius_m", cable.min_bend_radius_m, range::BEND_RADIUS),
        ("friction", cable.friction, range::FRICTION),
    ];
    for (key, value, range) in numbers {
        number(&at.key(key), value, range)?;
    }
    if let Some(limit) = cable.sidewall_limit_n_per_m {
        number(&at.key("sidewall_limit_n_per_m"), limit, range::SIDEWALL)?;
    }
    if let Some(ratio) = cable.bending_damping_ratio {
        number(&at.key("bending_damping_ratio"), ratio, range::DAMPING)?;
    }
    if let Some(id) = &cable.preset
        && preset::cable_preset(id).is_none()
    {
        let known = preset::cable_presets().iter().map(|p| p.id);
        return Err(at.key("preset").fault(preset::unknown("cable preset", id, known)));
    }
    if cable.service_tension_n > cable.breaking_tension_n {
        return Err(at.key("service_tension_n").fault(SceneFault::ServiceAboveBreaking {
            service_n: cable.service_tension_n,
            breaking_n: cable.breaking_tension_n,
        }));
    }
    let factor = 1.0 + cable.thermal_expansion_per_k * scene.environment.temperature_change_k;
    let allowed = range::THERMAL_FACTOR;
    if !(allowed[0]..=allowed[1]).contains(&factor) {
        return Err(at.key("thermal_expansion_per_k").fault(SceneFault::ThermalFactor { factor, allowed }));
    }
    if let Some(n) = cable.segments {
        #[expect(clippy::cast_precision_loss, reason = "only shown")]
        number(&at.key("segments"), n as f64, range::SEGMENTS)?;
    }
    let route = at.key("route_m");
    at_most(&route, cable.route_m.len(), MAX_KNOTS)?;
    if cable.route_m.len() == 1 {
        return Err(route.document_fault(DocumentFault::ShortRoute));
    }
    points(&route, &cable.route_m, range::COORDINATE)?;
    distinct_neighbours(&route, &cable.route_m)?;
    support_rules::check(scene, cable, at)
}

fn check_load(scene: &Scene, load: &Load, at: &Path<'_>) -> CheckResult {
    let Some(cable) = scene.cables.iter().find(|c| c.name == load.cable) else {
        let known = scene.cables.iter().map(|c| c.name.as_str());
        return Err(at.key("cable").fault(preset::unknown("cable", &load.cable, known)));
    };
    number(&at.key("arc_length_m"), load.arc_length_m, range::ARC_LENGTH)?;
    if load.arc_length_m > cable.length_m {
        let fault = SceneFault::BeyondEnd { arc_length_m: load.arc_length_m, length_m: cable.length_m };
        return Err(at.key("arc_length_m").fault(fault));
    }
    force(at, load.force_n, &load.times_s, &load.forces_n)
}

fn check_obstacle(obstacle: &Obstacle, at: &Path<'_>) -> Result<usize, SceneError> {
    if let Some(mu) = obstacle.friction {
        number(&at.key("friction"), mu, range::FRICTION)?;
    }
    let line = at.key("points_m");
    let (corners, least) = match &obstacle.shape {
        Shape::Terrain { points_m } => (points_m, 2),
        Shape::Polygon { points_m } => (points_m, 3),
        Shape::Polyline { points_m, thickness_m } => {
            number(&at.key("thickness_m"), *thickness_m, range::THICKNESS)?;
            (points_m, 2)
        }
        Shape::Circle { center_m, radius_m } => {
            point(&at.key("center_m"), *center_m, range::COORDINATE)?;
            number(&at.key("radius_m"), *radius_m, range::RADIUS)?;
            return Ok(1);
        }
    };
    at_most(&line, corners.len(), MAX_OBSTACLE_POINTS)?;
    if corners.len() < least {
        return Err(line.fault(SceneFault::TooFewPoints { count: corners.len(), least }));
    }
    points(&line, corners, range::COORDINATE)?;
    distinct_neighbours(&line, corners)?;
    match (&obstacle.shape, corners.first(), corners.last()) {
        (Shape::Terrain { .. }, Some(first), Some(last)) if !(last[0] > first[0]) => {
            Err(line.document_fault(DocumentFault::TerrainLeftwards))
        }
        (Shape::Polygon { .. }, Some(first), Some(last)) if first == last => {
            Err(line.index(corners.len() - 1).document_fault(DocumentFault::PolygonClosedTwice))
        }
        (Shape::Polygon { .. }, _, _) if !(area(corners).abs() > 0.0) => {
            Err(line.document_fault(DocumentFault::PolygonWithoutArea))
        }
        (Shape::Terrain { .. }, _, _) => check_not_self_crossing(&line, corners, LineEnds::Open),
        (Shape::Polygon { .. }, _, _) => check_not_self_crossing(&line, corners, LineEnds::Joined),
        _ => Ok(()),
    }?;
    Ok(corners.len())
}

/// A line with an inside must not cross or touch itself.
fn check_not_self_crossing(at: &Path<'_>, line: &[Point], ends: LineEnds) -> CheckResult {
    match first_self_touch(line, ends) {
        None => Ok(()),
        Some(LineSelfTouch::Edges(i, j)) => {
            let end = |k: usize| line.get(k + 1).or(line.first()).copied().unwrap_or_default();
            let edges_m = Box::new([j, i].map(|k| [line[k], end(k)]));
            Err(at.index(j).fault(SceneFault::EdgesCross { other: i, edges_m }))
        }
        Some(LineSelfTouch::Tangled) => Err(at.document_fault(DocumentFault::Tangled)),
    }
}

/// Signed area by the shoelace formula about the first point, m².
fn area(corners: &[Point]) -> f64 {
    let Some(o) = corners.first() else { return 0.0 };
    corners.windows(2).map(|w| ((w[0][0] - o[0]) * (w[1][1] - o[1]) - (w[1][0] - o[0]) * (w[0][1] - o[1])) / 2.0).sum()
}

fn check_robot(robot: &Robot, at: &Path<'_>) -> CheckResult {
    if preset::robot_preset(&robot.preset).is_none() {
        let known = preset::robot_presets().iter().map(|p| p.id);
        return Err(at.key("preset").fault(preset::unknown("robot preset", &robot.preset, known)));
    }
    point(&at.key("at_m"), robot.at_m, range::COORDINATE)?;
    if let Some(friction) = robot.track_friction {
        number(&at.key("track_friction"), friction, range::FRICTION)?;
    }
    if let Some(rolling) = robot.rolling_resistance {
        number(&at.key("rolling_resistance"), rolling, range::ROLLING)?;
    }
    let path = at.key("path");
    at_most(&path, robot.path.len(), MAX_KNOTS)?;
    for (i, task) in robot.path.iter().enumerate() {
        let leg = path.index(i);
        match *task {
            RobotTask::Drive { to_x_m, speed_m_per_s } => {
                number(&leg.key("to_x_m"), to_x_m, range::COORDINATE)?;
                number(&leg.key("speed_m_per_s"), speed_m_per_s, range::ROBOT_SPEED)?;
            }
            RobotTask::Wait { wait_s } => number(&leg.key("wait_s"), wait_s, range::DURATION)?,
        }
    }
    Ok(())
}
