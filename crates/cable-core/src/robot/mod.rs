//! The vehicle is the tracked robot in motion: how fast it goes against slope, ground and cable,
//! and why not faster.
//!
//! | room | content |
//! |---|---|
//! | `governor.rs` | planned speed of the vehicle, limited in acceleration and jerk |
//! | `speed_balance.rs` | speed at the end of a step: drive, slip of the tracks, resistance, cable pull |
//!
//! It is a rigid body on the ground, moved along it by its tracks:
//! ```text
//! N = m g cos θ − H·n                     from the ground; H: force of the cable on the hitch, n: normal
//! m dv/dt = F − c N sign v + S,           S = H·t − m g sin θ
//! |F| ≤ P (1 − |v|/v₀)                    the drive: its pull P at a stand, none at its top speed v₀
//! |F| ≤ μ N                               the tracks: beyond, they slip
//! ```
//! with t along the ground to the right. The governor asks for the F that reaches the commanded
//! speed u. So on even ground the speed is the lesser of u and v₀ (1 − R/P), R = c N − S sign u;
//! with R > P it stalls, with R > μN it slips. A drive that stalls holds what its tracks can hold:
//! hydraulic track motors have brakes. The pull that falls linearly with speed is the common
//! picture of such a drive; makers publish no curves.
//!
//! A step of h goes from v to v' so that the change of motion is the work of the forces, each times
//! the way of the step:
//! ```text
//! m (v' − v)/h = F + R + S̄,   way = h (v + v')/2
//! ```
//! S̄ is the mean of the cable's pull at both ends of the step (trapezoidal rule), the drive's
//! limit that of the mean speed. Where a force may jump (brakes, tracks that slip, rolling
//! resistance), its law is that of the speed v' at the end of the step (J. J. Moreau, "Unilateral
//! contact and dry friction in finite freedom dynamics", in: Nonsmooth Mechanics and Applications,
//! CISM 302, 1988): all of them fall as v' grows, m v'/h grows, so there is one v'. What the cable
//! does to the outline is that of the end of the step.
//!
//! Seen from above (plan view) it drives along x on the level floor: N = m g, because the cable
//! pulls level, and its tracks hold any pull across its way.
//!
//! The work of the ground where it tips the vehicle over a corner does not change its speed: on
//! such ground its weight and the force on the hitch do work that is not along the way, and
//! `RobotWork::ground_j` holds that work.
//!
//! The speed that the governor asks for is planned in `governor.rs`, with limits on acceleration
//! and jerk; `speed_balance.rs` solves for the speed that drive, tracks and cable leave of it.
//!
//! Robot and cable are one system: how their steps are brought together stands in
//! `simulation/robot_coupling.rs`.

mod governor;
mod speed_balance;

use std::sync::Arc;

use self::governor::{MAX_ACCELERATION, PlannedMotion, SpeedOrder};
pub use self::speed_balance::SpeedBalance;
use self::speed_balance::{StepForces, TrackGrip};
use crate::math::{RigidPose, Vec2, bounded, larger, smaller, vec2};
use crate::scene::ground::Ground;
use crate::scene::preset::{RobotPreset, robot_preset};
use crate::scene::robot::{Pose, ROLLING_RESISTANCE, TRACK_FRICTION};
use crate::scene::{Robot, RobotTask, Scene, View};
use crate::solution::robot_report::{DriveState, RobotReport};

/// Longest step of the vehicle, s: that of the cable. The taut spring of 10 m of a 2 MN cable and 1
/// t swing at 14 rad/s, 17 times slower.
pub const STEP_S: f64 = 1.0 / 240.0;

/// Steepest slope it climbs, rad: 35°. Makers allow 30° for such machines (remembered; estimated).
const MAX_SLOPE: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// A leg of its path is driven when it is this near to its end, m.
const ARRIVAL_DISTANCE_M: f64 = 1e-3;

/// Largest rate at which the vehicle tips over an edge, rad/s: a machine of one metre that falls by
/// a hand's breadth takes a fifth of a second. If it were faster, the hitch would pull the cable
/// along at a corner of the ground; if it were slower, the part behind the middle would hang in the
/// air.
const MAX_TIP_RAD_PER_S: f64 = 1.0;

/// Greatest change of that, rad/s²: the end of a machine of two metres' length that falls freely.
/// More: its hitch jerks the cable at every corner, by 1.3 kN where it tips at once; less: it tips
/// late.
const MAX_TIP_RAD_PER_S2: f64 = 10.0;

/// Part of the forces on vehicle and cable by which a trial of a step may be off. The speed is that
/// of the balance; what is off is the place of the hitch, by less than a millionth of a metre where
/// a machine of a tonne is off by 100 N. Less: more trials; more: the hitch lags behind the
/// vehicle.
const BALANCE_TOLERANCE: f64 = 5e-3;

/// The vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Vehicle {
    robot: Arc<Robot>,
    preset: &'static RobotPreset,
    ground: Arc<Ground>,
    view: View,
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
    /// Forces of the cable on hitch and outline, N, and how fast that on the hitch changes, N/s.
    pulls: Pulls,
    rate: Vec2,
    /// Motion that the governor asked for in the last step.
    set: PlannedMotion,
    /// Tipping speed, rad/s.
    tipping_speed: f64,
    report: RobotReport,
}

impl Vehicle {
    /// The robot of a scene, at rest; `None` if the scene has no robot, or its terrain ends below
    /// the robot's tracks.
    #[must_use]
    pub fn of(scene: &Scene) -> Option<Self> {
        let robot = scene.robot.as_ref()?;
        let preset = robot_preset(&robot.preset)?;
        let ground = Arc::new(scene.robot_ground());
        let pose = robot.pose_on(&ground, preset, robot.at_m[0])?;
        let mut vehicle = Self {
            weight: preset.mass_kg.value * scene.environment.gravity_m_per_s2,
            track_friction: robot.track_friction.unwrap_or(TRACK_FRICTION),
            rolling: robot.rolling_resistance.unwrap_or(ROLLING_RESISTANCE),
            robot: Arc::new(robot.clone()),
            preset,
            ground,
            view: scene.view,
            pose,
            speed: 0.0,
            by_hand: None,
            leg: 0,
            waited: 0.0,
            pulls: Pulls::default(),
            rate: Vec2::zeros(),
            set: PlannedMotion::default(),
            tipping_speed: 0.0,
            report: RobotReport::default(),
        };
        let (sin, cos) = pose.pitch.sin_cos();
        let forces = Forces { normal: vehicle.weight * cos, thrust: vehicle.weight * sin };
        vehicle.update_report(Pulls::default(), forces, 0.0, DriveState::Standing);
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
            (self.leg, self.waited) = (old.leg.min(legs), old.waited);
            (self.report.work, self.set) = (old.report.work, old.set);
            let forces = Forces { normal: old.report.normal_n, thrust: old.report.thrust_n };
            let hitch = Vec2::new(old.report.hitch_x_n, old.report.hitch_y_n);
            let push = Vec2::new(old.report.push_x_n, old.report.push_y_n);
            self.update_report(Pulls { hitch, outline: push }, forces, old.report.commanded_m_per_s, old.report.going);
        }
    }

    /// Goes on from how it was at an earlier instant; a wait begins anew.
    pub fn resume(&mut self, then: &RobotReport) {
        if let Some(pose) = self.robot.pose_on(&self.ground, self.preset, then.x_m) {
            (self.pose, self.speed) = (pose, then.speed_m_per_s);
            (self.leg, self.waited) = (then.leg.unwrap_or(self.robot.path.len()), 0.0);
            self.report.work = then.work;
            let acceleration = bounded(then.governor_m_per_s2, -MAX_ACCELERATION, MAX_ACCELERATION);
            self.set = PlannedMotion { speed: then.speed_m_per_s, acceleration };
            let forces = Forces { normal: then.normal_n, thrust: then.thrust_n };
            let hitch = Vec2::new(then.hitch_x_n, then.hitch_y_n);
            let push = Vec2::new(then.push_x_n, then.push_y_n);
            self.update_report(Pulls { hitch, outline: push }, forces, then.commanded_m_per_s, then.going);
        }
    }

    /// Puts the robot at rest with the middle of its tracks at `x_m` (m), and returns the position
    /// of its hitch, m; `None` if it cannot stand there.
    pub fn put(&mut self, x_m: f64) -> Option<Vec2> {
        self.pose = self.robot.pose_on(&self.ground, self.preset, x_m)?;
        (self.speed, self.tipping_speed, self.rate) = (0.0, 0.0, Vec2::zeros());
        self.set = PlannedMotion::default();
        (self.report.x_m, self.report.y_m) = (self.pose.at_m[0], self.pose.at_m[1]);
        self.report.pitch_deg = self.pose.pitch.to_degrees();
        (self.report.speed_m_per_s, self.report.governor_m_per_s2) = (0.0, 0.0);
        Some(self.hitch())
    }

    /// Returns how it stands.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Returns how it is.
    #[must_use]
    pub fn report(&self) -> RobotReport {
        self.report
    }

    /// Returns where its hitch is, m.
    #[must_use]
    pub fn hitch(&self) -> Vec2 {
        self.hitch_at(self.pose)
    }

    /// Returns where its hitch is when it stands so, m.
    #[must_use]
    pub(crate) fn hitch_at(&self, pose: Pose) -> Vec2 {
        vec2(pose.hitch_m(self.preset, self.view))
    }

    /// The robot came only this far in its last step, because the cable was in its way.
    pub(crate) fn hold_back(&mut self, placement: RigidPose) {
        self.pose = Pose { at_m: [placement.at.x, placement.at.y], pitch: placement.angle, ..self.pose };
        self.report.work.impact_j -= self.kinetic_j();
        (self.speed, self.tipping_speed, self.set) = (0.0, 0.0, PlannedMotion::default());
        (self.report.x_m, self.report.y_m) = (placement.at.x, placement.at.y);
        self.report.pitch_deg = placement.angle.to_degrees();
        (self.report.speed_m_per_s, self.report.governor_m_per_s2) = (0.0, 0.0);
        self.report.going = DriveState::Jammed;
    }

    /// Kinetic energy, J.
    #[must_use]
    pub fn kinetic_j(&self) -> f64 {
        0.5 * self.preset.mass_kg.value * self.speed * self.speed
    }

    /// Begins a step of `h` (s).
    pub fn begin(&mut self, h: f64, pulls: Pulls) -> Drive {
        self.pulls = pulls;
        let order = self.order(h);
        Drive { wanted: order.speed, asked: self.governed_motion().next(order, h), step_s: h }
    }

    /// The speed (m/s) that the robot would have at the end of a step if the force on its hitch
    /// continued to change at the same rate.
    #[must_use]
    pub fn foreseen(&self, drive: Drive) -> f64 {
        let pulls = Pulls { hitch: self.pulls.hitch + self.rate * drive.step_s, ..self.pulls };
        self.balance(drive, pulls).speed
    }

    /// Returns the pose of the robot at the end of a step in which it reaches this speed (m/s);
    /// `None` if it cannot stand there.
    #[must_use]
    pub(crate) fn pose_at_speed(&self, drive: Drive, speed: f64) -> Option<Pose> {
        let way = 0.5 * drive.step_s * (self.speed + speed);
        if way == 0.0 && self.speed == 0.0 {
            return self.tipped_pose(self.pose.at_m[0], drive.step_s);
        }
        let x_m = self.pose.at_m[0] + way * self.pose.pitch.cos();
        let ground = self.robot.pose_on(&self.ground, self.preset, x_m)?;
        if ground.pitch * way.signum() <= MAX_SLOPE { self.tipped_pose(x_m, drive.step_s) } else { None }
    }

    /// The pose of the robot at a place, tipped towards the ground as far as is possible in a step
    /// of `h` (s).
    fn tipped_pose(&self, x_m: f64, h: f64) -> Option<Pose> {
        let pose = self.robot.pose_on(&self.ground, self.preset, x_m)?;
        let left = pose.pitch - self.pose.pitch;
        // It comes to rest on the ground: no faster than it can still be slowed down, and than it
        // is there.
        let most = [(2.0 * MAX_TIP_RAD_PER_S2 * left.abs()).sqrt(), left.abs() / h]
            .into_iter()
            .fold(MAX_TIP_RAD_PER_S, smaller);
        let change = MAX_TIP_RAD_PER_S2 * h;
        let tipping_speed = bounded(most.copysign(left), self.tipping_speed - change, self.tipping_speed + change);
        Some(Pose { pitch: self.pose.pitch + tipping_speed * h, ..pose })
    }

    /// Returns the balance of a step that ends with these forces of the cable.
    #[must_use]
    pub fn balance(&self, drive: Drive, pulls: Pulls) -> SpeedBalance {
        let (sin, cos) = self.pose.pitch.sin_cos();
        let felt = self.mean(pulls) + pulls.outline;
        let lift = match self.view {
            View::Elevation => felt.y * cos - felt.x * sin,
            View::Plan => 0.0,
        };
        let normal = self.weight * cos - lift;
        // Tracks that are lifted off the ground have no grip.
        let normal = if normal > 0.0 { normal } else { 0.0 };
        let (pull, weight) = (felt.x * cos + felt.y * sin, -self.weight * sin);
        let force = pull + weight;
        let sense = [drive.wanted, self.speed, -force].into_iter().find(|s| *s != 0.0).map_or(1.0, f64::signum);
        let step = StepForces {
            mass: self.preset.mass_kg.value,
            step_s: drive.step_s,
            speed: self.speed * sense,
            force: force * sense,
        };
        let along = self.grip(drive, normal, sense).balance(step);
        let [speed, tracks, rolling] = [along.speed, along.tracks, along.rolling].map(|x| x * sense);
        SpeedBalance { speed, tracks, rolling, normal, pull, weight, ..along }
    }

    /// Mean pull on its hitch in a step that ends with `pulls`, N.
    fn mean(&self, pulls: Pulls) -> Vec2 {
        (self.pulls.hitch + pulls.hitch) * 0.5
    }

    /// Ends a step at a place with a speed (m/s) that a balance gave, or that it was given beside
    /// one.
    pub(crate) fn arrive(&mut self, drive: Drive, to: Pose, led: f64, balance: SpeedBalance, speed: f64, pulls: Pulls) {
        let way = 0.5 * drive.step_s * (self.speed + led);
        let SpeedBalance { tracks, rolling, pull, weight, slips, .. } = balance;
        let along = Vec2::new(self.pose.pitch.cos(), self.pose.pitch.sin());
        let cable = self.mean(pulls).dot(&(self.hitch_at(to) - self.hitch())) + pulls.outline.dot(&along) * way;
        let lifted = -self.weight * (to.at_m[1] - self.pose.at_m[1]);
        let work = &mut self.report.work;
        *(if slips { &mut work.slip_j } else { &mut work.drive_j }) += tracks * way;
        work.rolling_j += rolling * way;
        work.weight_j += lifted;
        work.cable_j += cable;
        work.ground_j += (weight + pull) * way - lifted - cable;
        // The energy of a stop is none of those.
        work.impact_j += self.preset.mass_kg.value * (speed - balance.speed) / drive.step_s * way;
        self.tipping_speed = (to.pitch - self.pose.pitch) / drive.step_s;
        self.set = drive.asked.after_hindrance(drive.step_s, [self.speed, speed]);
        (self.pose, self.speed) = (to, speed);
        self.rate = (pulls.hitch - self.pulls.hitch) / drive.step_s;
        self.pulls = pulls;
        let forces = Forces { normal: balance.normal, thrust: tracks };
        self.update_report(pulls, forces, drive.wanted, balance.going);
    }

    /// Ends a step in which the robot cannot advance: it stays in its place.
    pub fn stop(&mut self, drive: Drive, pulls: Pulls, going: DriveState) {
        let balance = self.balance(drive, pulls);
        self.report.work.impact_j -= self.kinetic_j();
        self.speed = 0.0;
        self.arrive(drive, self.pose, 0.0, SpeedBalance { going, ..balance }, 0.0, pulls);
    }

    /// Unbalanced impulse over time (N) that counts as none beside forces of the cable.
    #[must_use]
    pub fn tolerance(&self, pulls: Pulls) -> f64 {
        BALANCE_TOLERANCE * self.forces(pulls)
    }

    /// An unbalanced force (N) in parts of the forces on it, and the part that counts as none.
    pub(crate) fn imbalance(&self, left_n: f64, pulls: Pulls) -> [f64; 2] {
        [left_n / self.forces(pulls), BALANCE_TOLERANCE]
    }

    /// Its weight and the forces of the cable, N.
    fn forces(&self, pulls: Pulls) -> f64 {
        self.weight + pulls.hitch.norm() + pulls.outline.norm()
    }

    /// Mass, kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.preset.mass_kg.value
    }

    /// Returns the forces that tracks and rolling resistance can exert in a step, in the commanded
    /// direction `sense`.
    fn grip(&self, drive: Drive, normal: f64, sense: f64) -> TrackGrip {
        let goes = larger(self.speed * sense, 0.0);
        let (most, top) = (self.preset.drive_pull_n.value, self.preset.speed_m_per_s.value);
        TrackGrip {
            asked: drive.asked.speed * sense,
            drives: drive.wanted * sense > 0.0,
            hold: self.track_friction * normal,
            rolling: self.rolling * normal,
            drive: larger(most * (1.0 - 0.5 * goes / top), 0.0),
            drive_slope: 0.5 * most / top,
        }
    }

    /// Returns the motion from which the governor continues, which is the one that it has
    /// commanded. The commanded motion of a vehicle that its cable drags is zero.
    fn governed_motion(&self) -> PlannedMotion {
        let v = self.speed;
        if self.set.speed * v > 0.0 {
            PlannedMotion { speed: v.signum() * smaller(self.set.speed.abs(), v.abs()), ..self.set }
        } else {
            PlannedMotion::default()
        }
    }

    /// Returns the order of now, by hand or by its path, on which it moves on.
    fn order(&mut self, dt: f64) -> SpeedOrder {
        let top = self.preset.speed_m_per_s.value;
        if let Some(speed) = self.by_hand {
            return SpeedOrder { speed: speed.clamp(-top, top), left: None };
        }
        // At most once round the path: one of nothing but legs that are done must not go on for
        // ever.
        for _ in 0..=self.robot.path.len() {
            if self.leg >= self.robot.path.len() && self.robot.repeat {
                self.leg = 0;
            }
            match self.robot.path.get(self.leg) {
                Some(RobotTask::Drive { to_x_m, speed_m_per_s }) => {
                    let left = to_x_m - self.pose.at_m[0];
                    if left.abs() > ARRIVAL_DISTANCE_M {
                        return SpeedOrder { speed: smaller(*speed_m_per_s, top) * left.signum(), left: Some(left) };
                    }
                }
                Some(RobotTask::Wait { wait_s }) => {
                    if self.waited < *wait_s {
                        self.waited += dt;
                        return SpeedOrder::default();
                    }
                }
                None => return SpeedOrder::default(),
            }
            self.leg += 1;
            self.waited = 0.0;
        }
        SpeedOrder::default()
    }

    /// Renews the report of the vehicle.
    fn update_report(&mut self, pulls: Pulls, forces: Forces, commanded: f64, going: DriveState) {
        let Pulls { hitch, outline: push } = pulls;
        self.report = RobotReport {
            x_m: self.pose.at_m[0],
            y_m: self.pose.at_m[1],
            pitch_deg: self.pose.pitch.to_degrees(),
            speed_m_per_s: self.speed,
            governor_m_per_s2: self.set.acceleration,
            commanded_m_per_s: commanded,
            thrust_n: forces.thrust,
            normal_n: forces.normal,
            traction_n: self.track_friction * forces.normal,
            hitch_x_n: hitch.x,
            hitch_y_n: hitch.y,
            push_x_n: push.x,
            push_y_n: push.y,
            work: self.report.work,
            going,
            leg: (self.by_hand.is_none() && self.leg < self.robot.path.len()).then_some(self.leg),
        };
    }
}

/// Forces of the cable on the vehicle, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pulls {
    /// On its hitch.
    pub hitch: Vec2,
    /// On its outline.
    pub outline: Vec2,
}

/// The task of a step.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Commanded speed, m/s.
    wanted: f64,
    /// Motion that the governor asks for at its end.
    asked: PlannedMotion,
    /// Its length, s.
    step_s: f64,
}

/// The force of the ground on it, N.
#[derive(Clone, Copy, Debug)]
struct Forces {
    normal: f64,
    thrust: f64,
}

#[cfg(test)]
mod tests;
