//! A scene describes the tracked vehicle: its preset, where it stands, and its path.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::environment::View;
use super::ground::Ground;
use super::library::preset::{RobotPreset, robot_preset};
use crate::math::{Point, RigidPose, vec2};

/// A tracked vehicle that stands on the terrain, or on level ground where a scene has none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Robot {
    /// Preset its numbers come from.
    pub preset: String,
    /// Point at which its tracks' middle touches the ground, m. In a side view it stands on the
    /// highest terrain at this x; its height is that of level ground in a scene without terrain. In
    /// a plan view it drives along x on the floor, and y is its place across that way.
    pub at_m: Point,
    /// Its heading.
    #[serde(default)]
    pub heading: Heading,
    /// Coulomb friction between tracks and ground; left out: [`TRACK_FRICTION`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub track_friction: Option<f64>,
    /// Rolling resistance over normal force; left out: [`ROLLING_RESISTANCE`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rolling_resistance: Option<f64>,
    /// Begins its path anew after the last leg.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub repeat: bool,
    /// Its driving program, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<RobotTask>,
}

/// Friction of tracks where a scene does not say: the middle of 0.3 (wet, smooth) to 0.6 (rough),
/// estimated.
pub const TRACK_FRICTION: f64 = 0.45;

/// Rolling resistance of tracks where a scene does not say. Books on terramechanics have 0.03 on
/// concrete to 0.1 on soft ground (after J. Y. Wong, "Theory of Ground Vehicles", Wiley, 4th ed.
/// 2008; remembered, to be taken as estimated).
pub const ROLLING_RESISTANCE: f64 = 0.06;

/// Direction in which a robot looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Heading {
    /// Towards +x.
    #[default]
    Right,
    /// Towards −x.
    Left,
}

/// One leg of a scripted path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, try_from = "TaskKeys")]
#[schemars(!try_from, deny_unknown_fields)]
pub enum RobotTask {
    /// Drive until the tracks' middle is at x.
    Drive {
        /// Goal, m.
        to_x_m: f64,
        /// Speed, m/s.
        speed_m_per_s: f64,
    },
    /// Stand still.
    Wait {
        /// Duration, s.
        wait_s: f64,
    },
}

/// The keys of a leg as they stand in a file: flat, so that a fault keeps its place.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TaskKeys {
    to_x_m: Option<f64>,
    speed_m_per_s: Option<f64>,
    wait_s: Option<f64>,
}

impl TryFrom<TaskKeys> for RobotTask {
    type Error = &'static str;

    fn try_from(keys: TaskKeys) -> Result<Self, Self::Error> {
        match (keys.to_x_m, keys.speed_m_per_s, keys.wait_s) {
            (Some(to_x_m), Some(speed_m_per_s), None) => Ok(Self::Drive { to_x_m, speed_m_per_s }),
            (None, None, Some(wait_s)) => Ok(Self::Wait { wait_s }),
            _ => Err("a leg has either `to_x_m` and `speed_m_per_s`, or `wait_s`"),
        }
    }
}

impl Robot {
    /// Returns the position of the hitch on level ground in a side view, m; `None` for an unknown
    /// preset. [`Scene::robot_pose`](crate::scene::Scene::robot_pose) takes the ground of a scene
    /// into account.
    #[must_use]
    pub fn hitch_m(&self) -> Option<Point> {
        let pose = Pose { at_m: self.at_m, pitch: 0.0, heading: self.heading };
        Some(pose.hitch_m(robot_preset(&self.preset)?, View::Elevation))
    }

    /// Returns the pose of the robot with the middle of its tracks at `x_m` (m); `None` if the
    /// ground ends below its tracks.
    #[must_use]
    pub(crate) fn pose_on(&self, ground: &Ground, preset: &RobotPreset, x_m: f64) -> Option<Pose> {
        let stand = ground.stand(x_m, preset.track_half_length_m())?;
        Some(Pose { at_m: [x_m, stand.height], pitch: stand.pitch, heading: self.heading })
    }
}

/// Position and lean of a vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Middle of its tracks on the ground, m.
    pub at_m: Point,
    /// Slope it stands on, rad, positive where it climbs to the right.
    pub pitch: f64,
    /// Its heading.
    pub heading: Heading,
}

impl Pose {
    /// From the vehicle's own axes (looking right, from the middle of its tracks on the ground) to
    /// the plane, m.
    #[must_use]
    pub fn place(&self, p: Point) -> Point {
        let x = if self.heading == Heading::Left { -p[0] } else { p[0] };
        let (sin, cos) = self.pitch.sin_cos();
        // On level ground exactly where it was put: cos 0 = 1, sin 0 = 0.
        [self.at_m[0] + x * cos - p[1] * sin, self.at_m[1] + x * sin + p[1] * cos]
    }

    /// Returns the position of the hitch, m; seen from above it is in the middle of the rear.
    #[must_use]
    pub fn hitch_m(&self, preset: &RobotPreset, view: View) -> Point {
        let up_m = match view {
            View::Elevation => preset.hitch_up_m.value,
            View::Plan => 0.0,
        };
        self.place([-preset.hitch_back_m.value, up_m])
    }
}

impl Pose {
    /// The same as a place and a turn.
    #[must_use]
    pub fn placement(&self) -> RigidPose {
        RigidPose { at: vec2(self.at_m), angle: self.pitch }
    }
}
