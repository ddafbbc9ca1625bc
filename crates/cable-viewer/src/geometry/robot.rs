//! The robot has an outline in the world, and its path a flag where each leg ends.

use cable_core::math::Point;
use cable_core::scene::preset::{RobotPreset, robot_preset};
use cable_core::scene::{Pose, RobotTask, View};

use crate::state::AppState;
use crate::units::labels;

/// Returns how it stands: while time runs where the answer has it, else where it is being put.
pub fn robot_pose(state: &AppState) -> Option<(Pose, &'static RobotPreset)> {
    let robot = state.document.scene.robot.as_ref()?;
    let preset = robot_preset(&robot.preset)?;
    let moved = state.live.snapshot.solution.as_ref().filter(|s| s.time_s > 0.0).and_then(|s| s.robot);
    let pose = match moved {
        Some(r) => Pose { at_m: [r.x_m, r.y_m], pitch: r.pitch_deg.to_radians(), heading: robot.heading },
        None => state.document.scene.robot_pose()?,
    };
    Some((pose, preset))
}

/// Its outline in the world, m; empty where there is no robot or no such preset. Seen from above it
/// is a box as wide as its tracks are apart.
#[must_use]
pub fn robot_outline(state: &AppState) -> Vec<Point> {
    let Some((pose, preset)) = robot_pose(state) else { return Vec::new() };
    match state.document.scene.view {
        View::Elevation => preset.outline_m.iter().map(|&p| pose.place(p)).collect(),
        View::Plan => {
            let along = extent(preset.outline_m.iter().map(|p| p[0]));
            let half = 0.5 * preset.width_m.value;
            let [rear, front] = along;
            [[rear, -half], [front, -half], [front, half], [rear, half]].map(|p| pose.place(p)).into()
        }
    }
}

/// The least and the greatest of some numbers.
pub fn extent(of: impl Iterator<Item = f64>) -> [f64; 2] {
    of.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// The legs that lead to a place: index, where, m, and what it says.
#[must_use]
pub fn path_flags(state: &AppState) -> Vec<(usize, Point, String)> {
    let Some(robot) = state.document.scene.robot.as_ref().filter(|r| !r.path.is_empty()) else { return Vec::new() };
    let ground = state.document.scene.robot_ground();
    let mut out: Vec<(usize, Point, String)> = Vec::new();
    for (k, task) in robot.path.iter().enumerate() {
        match (task, out.last_mut()) {
            (RobotTask::Drive { to_x_m, speed_m_per_s }, _) => {
                let y = ground.height(*to_x_m).unwrap_or(robot.at_m[1]);
                out.push((k, [*to_x_m, y], format!("leg {}: {}", k + 1, labels::speed(*speed_m_per_s))));
            }
            (RobotTask::Wait { wait_s }, Some((_, _, text))) => {
                *text += &format!(", then waits {} s", labels::digits(*wait_s));
            }
            (RobotTask::Wait { .. }, None) => {}
        }
    }
    out
}
