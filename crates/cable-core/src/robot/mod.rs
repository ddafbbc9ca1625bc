//! The tracked vehicle in motion: how fast it goes against slope, ground and cable, and why it does not.
//!
//! It is a rigid body on the ground, moved along it by its tracks:
//! ```text
//! N = m g cos θ − H·n                     from the ground; H: force of the cable on the hitch, n: normal
//! m dv/dt = F − c N sign v + S,           S = H·t − m g sin θ
//! |F| ≤ P (1 − |v|/v₀)                    the drive: its pull P at a stand, none at its top speed v₀
//! |F| ≤ μ N                               the tracks: beyond, they slip
//! ```
//! with t along the ground to the right. The governor asks for the F that reaches the commanded speed u. So on even ground the
//! speed is the lesser of u and v₀ (1 − R/P), R = c N − S sign u; with R > P it stalls, with R > μN it slips. A drive that
//! stalls holds what its tracks can hold: hydraulic track motors have brakes. The pull that falls linearly with speed is the
//! common picture of such a drive; makers publish no curves.
//!
//! The cable is felt with the delay of one [`STEP_S`]; its own hitch follows the vehicle as a support dragged by hand does.

use serde::{Deserialize, Serialize};

use crate::contact::outline::Placement;
use crate::math::{Vec2, vec2};
use crate::model::drive::TRAILING_S;
use crate::scene::ground::Ground;
use crate::scene::preset::{RobotPreset, robot_preset};
use crate::scene::robot::{Pose, ROLLING_RESISTANCE, TRACK_FRICTION};
use crate::scene::{Robot, RobotTask, Scene, View};

/// Longest step of the vehicle and of its exchange with the cable, s. Longer: a cable that snaps taut against a light vehicle
/// is felt too late and shakes it; shorter: as many steps of the cable. The taut spring of 10 m of a 2 MN cable and 1 t swing at
/// 14 rad/s, 400 times slower.
pub const STEP_S: f64 = 1.0 / 120.0;

/// Steepest slope it climbs, rad: 35°. Makers allow 30° for such machines (remembered; estimated).
const STEEPEST: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// A leg of its path is driven when it is this near to its end, m.
const ARRIVED_M: f64 = 1e-3;

/// Near the end of a leg it brakes with half of [`RAMP`], and over the last centimetres its speed is the way left over this
/// time, s: shorter stops with a jerk, longer creeps.
const APPROACH_S: f64 = 0.3;

/// Greatest change of speed the governor asks for, m/s²: more, and the tracks slip at every start; less feels dead by hand.
const RAMP: f64 = 1.0;

/// Fastest it tips over an edge, rad/s: a machine of a metre's length that falls by a hand's breadth takes a fifth of a second.
/// Faster: its hitch jerks the cable where the ground has a corner; slower: it hangs in the air behind its middle.
const TIP_RAD_PER_S: f64 = 1.0;

/// Over this time a robot that is held feels the pull of its cable, s, before it starts again. Shorter: it creeps on with every
/// swing of a taut cable, lets none of it die down, and the pull stays a third off its mean; longer: it starts late by hand.
const FELT_S: f64 = 0.3;

/// Slower than this it stands, m/s.
const STANDS_M_PER_S: f64 = 1e-4;

/// What its motion is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Going {
    /// Nothing is asked of it and it stands.
    #[default]
    Standing,
    /// As fast as commanded, or on the way there.
    Driving,
    /// Slower than commanded: what it pulls costs it speed.
    Slowed,
    /// What it would have to pull is more than its drive can.
    Stalled,
    /// What it would have to pull is more than its tracks can hold on the ground.
    Slipping,
    /// The cable draws it over the ground against its will.
    Dragged,
    /// The ground ends or is too steep.
    Blocked,
    /// Its own cable is in its way and cannot get out of it.
    Jammed,
}

impl Going {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Standing => "standing",
            Self::Driving => "driving",
            Self::Slowed => "slowed by its load",
            Self::Stalled => "stalled: the drive is too weak",
            Self::Slipping => "slipping: the tracks find no hold",
            Self::Dragged => "dragged by the cable",
            Self::Blocked => "blocked: too steep, or the ground ends",
            Self::Jammed => "jammed: the cable is in its way",
        }
    }
}

/// How it is at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotReport {
    /// Middle of its tracks on the ground, m.
    pub x_m: f64,
    /// Middle of its tracks on the ground, m.
    pub y_m: f64,
    /// Slope it stands on, °, positive where it climbs to the right.
    pub pitch_deg: f64,
    /// Speed along the ground, positive to the right, m/s.
    pub speed_m_per_s: f64,
    /// Speed it is asked for, m/s.
    pub commanded_m_per_s: f64,
    /// Force of its tracks along the ground, N.
    pub thrust_n: f64,
    /// Force of the ground on it, across it, N.
    pub normal_n: f64,
    /// Most force its tracks could transmit now, N.
    pub traction_n: f64,
    /// Force of the cable on its hitch, N.
    pub hitch_x_n: f64,
    /// Force of the cable on its hitch, N.
    pub hitch_y_n: f64,
    /// Force of the cable on its outline, N.
    #[serde(default)]
    pub push_x_n: f64,
    /// Force of the cable on its outline, N.
    #[serde(default)]
    pub push_y_n: f64,
    /// Why it is as fast as it is.
    pub going: Going,
    /// The leg of its path it is on; None by hand or at the end.
    pub leg: Option<usize>,
}

/// The vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Vehicle {
    robot: Robot,
    preset: &'static RobotPreset,
    ground: Ground,
    /// m g, N.
    weight: f64,
    track_friction: f64,
    rolling: f64,
    pose: Pose,
    /// Along the ground, positive to the right, m/s.
    speed: f64,
    /// Speed by hand, m/s; None: the path.
    by_hand: Option<f64>,
    leg: usize,
    /// Time spent waiting on this leg, s.
    waited: f64,
    /// Force along the ground as it is felt: its mean over the last [`FELT_S`], N.
    felt: f64,
    report: RobotReport,
}

impl Vehicle {
    /// That of a scene, standing; None where there is none, in a plan view, and where there is no ground.
    #[must_use]
    pub fn of(scene: &Scene) -> Option<Self> {
        let robot = scene.robot.as_ref()?;
        let preset = robot_preset(&robot.preset)?;
        let ground = Ground::of(scene);
        if scene.view == View::Plan {
            return None;
        }
        let pose = robot.pose_on(&ground, preset, robot.at_m[0])?;
        let mut vehicle = Self {
            weight: preset.mass_kg.value * scene.environment.gravity_m_per_s2,
            track_friction: robot.track_friction.unwrap_or(TRACK_FRICTION),
            rolling: robot.rolling_resistance.unwrap_or(ROLLING_RESISTANCE),
            robot: robot.clone(),
            preset,
            ground,
            pose,
            speed: 0.0,
            by_hand: None,
            leg: 0,
            waited: 0.0,
            felt: 0.0,
            report: RobotReport::default(),
        };
        let (sin, cos) = pose.pitch.sin_cos();
        let forces = Forces { normal: vehicle.weight * cos, thrust: vehicle.weight * sin };
        vehicle.tell([Vec2::zeros(); 2], forces, (0.0, Going::Standing));
        Some(vehicle)
    }

    /// From now on it goes at this speed (m/s, positive to the right); None: on along its path.
    pub fn command(&mut self, speed_m_per_s: Option<f64>) {
        self.by_hand = speed_m_per_s.filter(|v| v.is_finite());
    }

    /// Goes on as `old`, the same robot before an edit, does.
    pub fn carry(&mut self, old: &Self) {
        if old.robot.at_m == self.robot.at_m
            && old.robot.heading == self.robot.heading
            && let Some(pose) = self.robot.pose_on(&self.ground, self.preset, old.pose.at_m[0])
        {
            let legs = self.robot.path.len();
            (self.pose, self.speed, self.by_hand) = (pose, old.speed, old.by_hand);
            (self.leg, self.waited, self.felt) = (old.leg.min(legs), old.waited, old.felt);
            let forces = Forces { normal: old.report.normal_n, thrust: old.report.thrust_n };
            let hitch = Vec2::new(old.report.hitch_x_n, old.report.hitch_y_n);
            let push = Vec2::new(old.report.push_x_n, old.report.push_y_n);
            self.tell([hitch, push], forces, (old.report.commanded_m_per_s, old.report.going));
        }
    }

    /// Goes on from how it was at an earlier instant; a wait begins anew.
    pub fn resume(&mut self, then: &RobotReport) {
        if let Some(pose) = self.robot.pose_on(&self.ground, self.preset, then.x_m) {
            (self.pose, self.speed) = (pose, then.speed_m_per_s);
            (self.leg, self.waited) = (then.leg.unwrap_or(self.robot.path.len()), 0.0);
            let forces = Forces { normal: then.normal_n, thrust: then.thrust_n };
            let hitch = Vec2::new(then.hitch_x_n, then.hitch_y_n);
            let push = Vec2::new(then.push_x_n, then.push_y_n);
            self.tell([hitch, push], forces, (then.commanded_m_per_s, then.going));
        }
    }

    /// Puts it with its tracks' middle at `x_m`, standing; where its hitch is then, m. None where it cannot stand.
    pub fn put(&mut self, x_m: f64) -> Option<Vec2> {
        self.pose = self.robot.pose_on(&self.ground, self.preset, x_m)?;
        self.speed = 0.0;
        (self.report.x_m, self.report.y_m) = (self.pose.at_m[0], self.pose.at_m[1]);
        (self.report.pitch_deg, self.report.speed_m_per_s) = (self.pose.pitch.to_degrees(), 0.0);
        Some(vec2(self.pose.hitch_m(self.preset)))
    }

    /// How it stands.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// How it is.
    #[must_use]
    pub fn report(&self) -> RobotReport {
        self.report
    }

    /// Where its hitch is to be sent so that a follower that trails by [`TRAILING_S`] is where the hitch is, m.
    #[must_use]
    pub fn hitch_target(&self) -> Vec2 {
        let along = Vec2::new(self.pose.pitch.cos(), self.pose.pitch.sin());
        vec2(self.pose.hitch_m(self.preset)) + along * (self.speed * TRAILING_S)
    }

    /// It came only there in its last step: the cable was in its way.
    pub fn hold_back(&mut self, placement: Placement) {
        self.pose = Pose { at_m: [placement.at.x, placement.at.y], pitch: placement.angle, ..self.pose };
        self.speed = 0.0;
        (self.report.x_m, self.report.y_m) = (placement.at.x, placement.at.y);
        self.report.pitch_deg = placement.angle.to_degrees();
        (self.report.speed_m_per_s, self.report.going) = (0.0, Going::Jammed);
    }

    /// Moves on by `dt` (s, at most [`STEP_S`] for accuracy) under the forces of the cable on its hitch and on its outline, N.
    pub fn advance(&mut self, dt: f64, hitch: Vec2, outline: Vec2) {
        let wanted = self.wanted(dt);
        let (sin, cos) = self.pose.pitch.sin_cos();
        let felt = hitch + self.bearable(outline, dt);
        let lift = felt.y * cos - felt.x * sin;
        let normal = self.weight * cos - lift;
        // Lifted off the ground its tracks find no hold at all.
        let normal = if normal > 0.0 { normal } else { 0.0 };
        let pull = felt.x * cos + felt.y * sin - self.weight * sin;
        self.felt += (pull - self.felt) * (dt / FELT_S).min(1.0);
        // Held, it starts again when the cable lets it on the whole, not at every swing.
        let held = self.speed == 0.0 && wanted != 0.0 && self.felt * wanted < pull * wanted;
        let pull = if held { self.felt } else { pull };
        let (speed, thrust, going) = self.balance(wanted, (normal, pull), dt);
        let x = self.pose.at_m[0] + speed * cos * dt;
        let (speed, going) = match self.robot.pose_on(&self.ground, self.preset, x) {
            Some(pose) if pose.pitch * speed.signum() <= STEEPEST || speed == 0.0 => {
                let tips = (pose.pitch - self.pose.pitch).clamp(-TIP_RAD_PER_S * dt, TIP_RAD_PER_S * dt);
                self.pose = Pose { pitch: self.pose.pitch + tips, ..pose };
                (speed, going)
            }
            _ => (0.0, Going::Blocked),
        };
        self.speed = speed;
        self.tell([hitch, outline], Forces { normal, thrust }, (wanted, going));
    }

    /// The force on its outline that it feels, N: at most what stops it in this step against its full drive. What is squeezed
    /// between it and a wall presses as hard as the stiffness of the squeeze, a step late, and would throw it back.
    fn bearable(&self, outline: Vec2, dt: f64) -> Vec2 {
        let most = self.preset.mass_kg.value * self.speed.abs() / dt + self.preset.drive_pull_n.value;
        let size = outline.norm();
        if size > most { outline * (most / size) } else { outline }
    }

    /// New speed (m/s), force of the tracks (N) and why, from the speed wanted and the forces across and along the ground.
    fn balance(&self, wanted: f64, (normal, pull): (f64, f64), dt: f64) -> (f64, f64, Going) {
        let (mass, v) = (self.preset.mass_kg.value, self.speed);
        let (hold, rolling) = (self.track_friction * normal, self.rolling * normal);
        let at_rest = v == 0.0;
        if at_rest && wanted == 0.0 && pull.abs() <= hold + rolling {
            return (0.0, -pull, Going::Standing);
        }
        let way = if wanted == 0.0 { v } else { wanted };
        let way = if way == 0.0 { -pull.signum() } else { way.signum() };
        // Against its way it moves only where the pull exceeds friction and rolling together.
        let stays = pull.abs() <= hold + rolling;
        let rolls = rolling
            * match (at_rest, stays) {
                (false, _) => v.signum(),
                (true, true) => way,
                (true, false) => pull.signum(),
            };
        let asked = v + (wanted - v).clamp(-RAMP * dt, RAMP * dt);
        let (drive, top) = (self.preset.drive_pull_n.value, self.preset.speed_m_per_s.value);
        // What the full drive would reach: m (v' − v)/dt = P (1 − v'/v₀) + S − R, implicit in v'.
        let full = (mass * v + dt * (way * drive + pull - rolls)) / (mass + dt * drive / top);
        let weak = way * full < way * asked;
        // Brakes hold where the drive would be pushed back.
        let reached = if weak { way * (way * full).max(0.0) } else { asked };
        let needed = mass * (reached - v) / dt - pull + rolls;
        if needed.abs() <= hold {
            let going = match (wanted == 0.0, weak) {
                (true, _) if reached.abs() < STANDS_M_PER_S => Going::Standing,
                (false, true) if reached.abs() < STANDS_M_PER_S => Going::Stalled,
                // While it gains speed with its full drive it is on its way.
                (false, true) if way * (reached - v) < STANDS_M_PER_S => Going::Slowed,
                _ => Going::Driving,
            };
            return (reached, needed, going);
        }
        // The tracks slide: Coulomb friction in the sense asked for, whatever the drive does.
        let thrust = needed.signum() * hold;
        let slid = v + dt * (thrust + pull - rolls) / mass;
        let speed = if stays && (way * slid < 0.0 || v * slid < 0.0) { 0.0 } else { slid };
        let against = if wanted == 0.0 { speed.abs() } else { -way * speed };
        (speed, thrust, if against > STANDS_M_PER_S { Going::Dragged } else { Going::Slipping })
    }

    /// The speed asked for now, m/s, by hand or by its path, on which it moves on.
    fn wanted(&mut self, dt: f64) -> f64 {
        let top = self.preset.speed_m_per_s.value;
        if let Some(speed) = self.by_hand {
            return speed.clamp(-top, top);
        }
        // At most once round the path: one of nothing but legs that are done must not go on for ever.
        for _ in 0..=self.robot.path.len() {
            if self.leg >= self.robot.path.len() && self.robot.repeat {
                self.leg = 0;
            }
            match self.robot.path.get(self.leg) {
                Some(RobotTask::Drive { to_x_m, speed_m_per_s }) => {
                    let left = to_x_m - self.pose.at_m[0];
                    if left.abs() > ARRIVED_M {
                        let brakes = (RAMP * left.abs()).sqrt();
                        let speed = (left.abs() / APPROACH_S).min(brakes).min(*speed_m_per_s).min(top);
                        return speed * left.signum();
                    }
                }
                Some(RobotTask::Wait { wait_s }) => {
                    if self.waited < *wait_s {
                        self.waited += dt;
                        return 0.0;
                    }
                }
                None => return 0.0,
            }
            self.leg += 1;
            self.waited = 0.0;
        }
        0.0
    }

    fn tell(&mut self, [hitch, push]: [Vec2; 2], forces: Forces, (commanded, going): (f64, Going)) {
        self.report = RobotReport {
            x_m: self.pose.at_m[0],
            y_m: self.pose.at_m[1],
            pitch_deg: self.pose.pitch.to_degrees(),
            speed_m_per_s: self.speed,
            commanded_m_per_s: commanded,
            thrust_n: forces.thrust,
            normal_n: forces.normal,
            traction_n: self.track_friction * forces.normal,
            hitch_x_n: hitch.x,
            hitch_y_n: hitch.y,
            push_x_n: push.x,
            push_y_n: push.y,
            going,
            leg: (self.by_hand.is_none() && self.leg < self.robot.path.len()).then_some(self.leg),
        };
    }
}

/// What the ground does to it, N.
#[derive(Clone, Copy, Debug)]
struct Forces {
    normal: f64,
    thrust: f64,
}

#[cfg(test)]
mod tests;
