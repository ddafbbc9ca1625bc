//! The speed of the vehicle at the end of a step balances inertia, drive, tracks, rolling
//! resistance and the pull of the cable: this is where the cable holds the vehicle back.

use crate::math::{bounded, larger, smaller};
use crate::solution::robot_report::DriveState;

/// Slower than this it stands, m/s.
const STANDSTILL_M_PER_S: f64 = 1e-4;

/// The balance of forces of a step; along the ground to the right.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpeedBalance {
    /// Speed at the end, m/s.
    pub speed: f64,
    /// Force of the tracks, N.
    pub(super) tracks: f64,
    /// Rolling resistance, N.
    pub(super) rolling: f64,
    /// Of the cable, N.
    pub(super) pull: f64,
    /// Of its weight, N.
    pub(super) weight: f64,
    /// Across the ground, N.
    pub(super) normal: f64,
    /// True if the tracks slip.
    pub(super) slips: bool,
    /// The state of the drive, and the reason why the vehicle is not faster.
    pub(super) going: DriveState,
}

/// The forces on a vehicle in a step other than those of its tracks, positive in the commanded
/// direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepForces {
    /// Mass, kg.
    pub(super) mass: f64,
    /// Length of the step, s.
    pub(super) step_s: f64,
    /// Speed at its start, m/s.
    pub(super) speed: f64,
    /// Pull of the cable and weight, N.
    pub(super) force: f64,
}

impl StepForces {
    /// The force that tracks and rolling resistance have to give for a speed at the end, N.
    fn needed(&self, speed: f64) -> f64 {
        self.mass * (speed - self.speed) / self.step_s - self.force
    }
}

/// State of the tracks on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Traction {
    Holds,
    Slips,
}

/// Tracks and rolling resistance in a step, as functions of the speed at its end. Below a speed of
/// 0 the tracks give all their hold (brakes), up to the speed asked for the pull of the drive, and
/// beyond that they brake with all their hold. Where that jumps it may be anything between.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrackGrip {
    /// Speed that the governor asks for at the end, m/s.
    pub(super) asked: f64,
    /// True if the vehicle is commanded to move; otherwise it stops.
    pub(super) drives: bool,
    /// Most that the tracks can transmit, N.
    pub(super) hold: f64,
    /// Rolling resistance, N.
    pub(super) rolling: f64,
    /// Pull of the drive in the mean of the step at a last speed of 0, N, and how much it falls by
    /// that speed, N s/m.
    pub(super) drive: f64,
    pub(super) drive_slope: f64,
}

/// The side from which a speed is approached where forces jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SpeedLimit {
    Below,
    Above,
}

impl TrackGrip {
    /// The balance of a step: the speed v' at which m (v' − v)/h is what acts.
    pub(super) fn balance(&self, step: StepForces) -> SpeedBalance {
        let (near, edge) = self.speed_range(step);
        let (balance, traction) = match edge {
            Some(q) => self.balance_at_edge(step, q),
            None => self.balance_beside(step, near),
        };
        let going = self.going(step.speed, balance.speed, traction);
        SpeedBalance { slips: traction == Traction::Slips, going, ..balance }
    }

    /// A speed of the range in which the balance lies, and that speed where a force jumps over what
    /// is needed there.
    fn speed_range(&self, step: StepForces) -> (f64, Option<f64>) {
        let edges = if self.asked < 0.0 { [self.asked, 0.0] } else { [0.0, self.asked] };
        let middle = 0.5 * (edges[0] + edges[1]);
        for (edge, before) in edges.into_iter().zip([edges[0] - 1.0, middle]) {
            if step.needed(edge) > self.total(edge, SpeedLimit::Below) {
                return (before, None);
            }
            if step.needed(edge) >= self.total(edge, SpeedLimit::Above) {
                return (edge, Some(edge));
            }
        }
        (edges[1] + 1.0, None)
    }

    /// The balance at a speed `q` (m/s) where a force jumps, and the state of the tracks.
    fn balance_at_edge(&self, step: StepForces, q: f64) -> (SpeedBalance, Traction) {
        let total = step.needed(q);
        let tracks = self.share(q, total);
        let slips = q == 0.0 && self.drives && self.drive >= self.hold;
        let balance = SpeedBalance { speed: q, tracks, rolling: total - tracks, ..SpeedBalance::default() };
        (balance, if slips { Traction::Slips } else { Traction::Holds })
    }

    /// The balance in the range of the speed `near` (m/s), where no force jumps, and the state of
    /// the tracks. The force of the drive falls with the speed by its slope.
    fn balance_beside(&self, step: StepForces, near: f64) -> (SpeedBalance, Traction) {
        let StepForces { mass, step_s: h, speed: v, force: pull } = step;
        let rolling = self.rolls(near, SpeedLimit::Above);
        let reached = |force: f64, slope: f64| (mass * v / h + pull + rolling + force) / (mass / h + slope);
        let slipping = if self.tracks(near, SpeedLimit::Above) < 0.0 { -self.hold } else { self.hold };
        let slid = reached(slipping, 0.0);
        let driven = reached(self.drive, self.drive_slope);
        let rolls = SpeedBalance { rolling, ..SpeedBalance::default() };
        if self.is_driven(near, SpeedLimit::Above) && driven <= slid {
            (SpeedBalance { speed: driven, tracks: self.tracks(driven, SpeedLimit::Above), ..rolls }, Traction::Holds)
        } else {
            (SpeedBalance { speed: slid, tracks: slipping, ..rolls }, Traction::Slips)
        }
    }

    /// Returns whether a speed is beyond an edge, in the limit from below or above.
    fn is_beyond(q: f64, edge: f64, limit: SpeedLimit) -> bool {
        q > edge || (q == edge && limit == SpeedLimit::Above)
    }

    fn is_driven(&self, q: f64, limit: SpeedLimit) -> bool {
        self.drives && Self::is_beyond(q, 0.0, limit) && !Self::is_beyond(q, self.asked, limit)
    }

    /// Force of the tracks, N.
    fn tracks(&self, q: f64, limit: SpeedLimit) -> f64 {
        if Self::is_beyond(q, self.asked, limit) {
            -self.hold
        } else if self.is_driven(q, limit) {
            smaller(larger(self.drive - self.drive_slope * q, 0.0), self.hold)
        } else {
            self.hold
        }
    }

    /// Rolling resistance, N.
    fn rolls(&self, q: f64, limit: SpeedLimit) -> f64 {
        if Self::is_beyond(q, 0.0, limit) { -self.rolling } else { self.rolling }
    }

    fn total(&self, q: f64, limit: SpeedLimit) -> f64 {
        self.tracks(q, limit) + self.rolls(q, limit)
    }

    /// Returns what the tracks give of a `total` (N) at a speed where forces jump: rolling
    /// resistance is against the drive.
    fn share(&self, q: f64, total: f64) -> f64 {
        let own = if q == 0.0 && !self.drives { total } else { total - self.rolls(q, SpeedLimit::Above) };
        bounded(own, self.tracks(q, SpeedLimit::Above), self.tracks(q, SpeedLimit::Below))
    }

    /// Returns what a vehicle does that comes from one speed to another (m/s), and why it goes no
    /// faster.
    fn going(&self, from: f64, to: f64, traction: Traction) -> DriveState {
        let against = if self.drives { -to } else { to.abs() };
        match (self.drives, traction) {
            (_, Traction::Slips) if against > STANDSTILL_M_PER_S => DriveState::Dragged,
            (_, Traction::Slips) => DriveState::Slipping,
            (false, _) if to.abs() < STANDSTILL_M_PER_S => DriveState::Standing,
            (true, _) if to < self.asked && to < STANDSTILL_M_PER_S => DriveState::Stalled,
            // A vehicle that still accelerates with its full drive counts as driving.
            (true, _) if to < self.asked && to - from < STANDSTILL_M_PER_S => DriveState::Slowed,
            _ => DriveState::Driving,
        }
    }
}
