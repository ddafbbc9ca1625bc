//! The coupling advances robot and cables together.
//!
//! In a step of h the robot comes from its speed v to v', and its hitch and outline with it; the
//! cables, from copies that can be gone back to, are advanced to where they then are, and pull with
//! S(v'). The balance of the robot makes of that a speed V(S(v')). Both are of one system where
//! ```text
//! v' = V(S(v'))
//! ```
//! There is exactly one such speed, and `speed_search.rs` finds it.
//!
//! The step is that of the cable where that is shorter: then both see each other at every instant
//! that either of them knows.

use std::mem::discriminant;

use super::speed_search::{SpeedSearch, SpeedTrial};
use super::{RunPhase, Simulation};
use crate::error::SolveError;
use crate::math::RigidPose;
use crate::math::{Vec2, larger, smaller};
use crate::model::Inertia;
use crate::robot::{self, Drive, Pulls, Vehicle};
use crate::scene::{Cable, SupportKind};
use crate::simulated_cable::SimulatedCable;
use crate::solution::{Cost, DriveState, Warning, WarningCause};

/// Part of a step by which a time may exceed a whole number of steps: round-off. Smaller: one more
/// step of nearly no length; larger: steps longer than the longest.
const STEP_COUNT_ROUNDING: f64 = 1e-9;

/// Longest step of a robot whose cables have no inertia, s: they pull evenly.
const QUASI_STATIC_STEP_S: f64 = 1.0 / 120.0;

/// A support that hangs on the robot.
#[derive(Clone, Copy, Debug)]
struct Hitch {
    /// Index of its cable.
    cable: usize,
    /// Index of the support on that cable.
    support: usize,
}

/// A step of robot and cables.
#[derive(Clone, Copy, Debug)]
struct CoupledStep<'a> {
    /// Its length, s.
    step_s: f64,
    inertia: Inertia,
    /// Everything that hangs on the robot.
    hitches: &'a [Hitch],
}

/// Outcome of a trial.
enum TrialOutcome {
    /// The robot at the end of the step, and the force by which it is out of balance with its
    /// cables, N, where no speed balances them.
    Ends(Box<Vehicle>, Option<f64>),
    /// The speed to try next, m/s.
    Again(f64),
    /// It cannot go on, and why.
    Stuck(DriveState),
}

impl Simulation {
    /// Advances robot and cables together.
    pub(super) fn advance_with_robot(&mut self, dt_s: f64, inertia: Inertia) -> Result<(), SolveError> {
        let (mut cost, mut warnings) = (Cost::default(), Vec::new());
        let hitches = self.hitches();
        let mut left = dt_s;
        while left > 0.0 {
            let longest = match inertia {
                Inertia::Dynamic => self.cables.iter().map(SimulatedCable::inner_step_s).fold(robot::STEP_S, smaller),
                Inertia::QuasiStatic => QUASI_STATIC_STEP_S,
            };
            let pieces = (left / longest - STEP_COUNT_ROUNDING).ceil().max(1.0);
            let h = left / pieces;
            let iterations = self.couple(&CoupledStep { step_s: h, inertia, hitches: &hitches })?;
            left = if pieces > 1.0 { left - h } else { 0.0 };
            cost = Cost {
                iterations: cost.iterations + iterations,
                halved_steps: cost.halved_steps + self.cost.halved_steps,
                ..self.cost
            };
            warnings.append(&mut self.warnings);
        }
        warnings.dedup_by(|a, b| discriminant(&a.cause) == discriminant(&b.cause) && a.cable == b.cable);
        (self.cost, self.warnings) = (cost, warnings);
        Ok(())
    }

    /// A step of robot and cables; returns the iterations that it took.
    fn couple(&mut self, step: &CoupledStep<'_>) -> Result<usize, SolveError> {
        let begun = self.pulls(step.hitches);
        let Some(vehicle) = &mut self.vehicle else { return Ok(0) };
        let drive = vehicle.begin(step.step_s, begun);
        let start = vehicle.clone();
        let before: Vec<SimulatedCable> = self.cables.iter().map(SimulatedCable::checkpoint).collect();
        let (mut speed, mut search, mut iterations) = (start.foreseen(drive), SpeedSearch::new(), 0);
        loop {
            self.cost = Cost::default();
            let tried = self.try_speed(step, &start, drive, speed, &mut search);
            iterations += self.cost.iterations;
            match tried {
                TrialOutcome::Ends(vehicle, left_n) => {
                    self.vehicle = Some(*vehicle);
                    self.hold_vehicle();
                    self.warn_out_of_balance(left_n, step.hitches);
                    return Ok(iterations);
                }
                TrialOutcome::Again(next) => {
                    self.go_back(&before);
                    speed = next;
                }
                TrialOutcome::Stuck(going) => {
                    self.go_back(&before);
                    let mut vehicle = start;
                    vehicle.stop(drive, begun, going);
                    self.send_robot_pose(vehicle.hitch(), vehicle.pose().placement(), step.hitches);
                    self.vehicle = Some(vehicle);
                    self.for_each_cable(|c| c.advance(step.step_s, step.inertia))?;
                    return Ok(iterations + self.cost.iterations);
                }
            }
        }
    }

    /// The step with the robot at this speed (m/s) at its end.
    fn try_speed(
        &mut self,
        step: &CoupledStep<'_>,
        start: &Vehicle,
        drive: Drive,
        speed: f64,
        search: &mut SpeedSearch,
    ) -> TrialOutcome {
        let Some(to) = start.pose_at_speed(drive, speed) else { return TrialOutcome::Stuck(DriveState::Blocked) };
        self.send_robot_pose(start.hitch_at(to), to.placement(), step.hitches);
        let breaks = self.breaks();
        if self.for_each_cable(|c| c.advance(step.step_s, step.inertia)).is_err() {
            // The cable cannot move out of the robot's way.
            return TrialOutcome::Stuck(DriveState::Jammed);
        }
        let pulls = self.pulls(step.hitches);
        let balance = start.balance(drive, pulls);
        let excess_speed = balance.speed - speed;
        // A break is no force that a speed could be found for.
        let excess_n = (excess_speed * start.mass() / step.step_s).abs();
        let even = excess_n <= start.tolerance(pulls) || self.breaks() > breaks;
        let mut left_n = None;
        if !even && !(self.left_m() > 0.0) {
            match search.next(SpeedTrial { speed, excess_speed }) {
                Some(next) => return TrialOutcome::Again(next),
                None => left_n = Some(excess_n),
            }
        }
        let mut vehicle = start.clone();
        // If the forces jump at a speed, the robot has the speed at which they do.
        let ends = if even { balance.speed } else { speed };
        vehicle.arrive(drive, to, speed, balance, ends, pulls);
        TrialOutcome::Ends(Box::new(vehicle), left_n)
    }

    /// Warns of a step that ends with this force left between robot and cables, N.
    fn warn_out_of_balance(&mut self, left_n: Option<f64>, hitches: &[Hitch]) {
        let (Some(left_n), Some(vehicle)) = (left_n, &self.vehicle) else { return };
        let [value, limit] = vehicle.imbalance(left_n, self.pulls(hitches));
        let Some(problem) = hitches.first().and_then(|hitch| self.cables.get(hitch.cable)).map(SimulatedCable::problem)
        else {
            return;
        };
        let at = vehicle.hitch();
        let warning = Warning::new(
            WarningCause::RobotOutOfBalance { left_n },
            &problem.cable.name,
            problem.length,
            [value, limit],
        );
        self.warnings.push(warning.at([at.x, at.y]));
    }

    /// Returns how many times the cables have broken.
    fn breaks(&self) -> usize {
        self.cables.iter().map(|c| c.breaks().len()).sum()
    }

    /// The cables are as they were before.
    fn go_back(&mut self, before: &[SimulatedCable]) {
        for (cable, before) in self.cables.iter_mut().zip(before) {
            cable.restore(before);
        }
    }

    /// Tells the cables where the hitch of the robot, and its outline, will be.
    fn send_robot_pose(&mut self, hitch: Vec2, to: RigidPose, hitches: &[Hitch]) {
        for &Hitch { cable, support } in hitches {
            self.drag_support(cable, support, hitch);
        }
        for cable in &mut self.cables {
            cable.set_robot_pose(to);
        }
    }

    /// Returns what the cables do to the robot now.
    fn pulls(&self, hitches: &[Hitch]) -> Pulls {
        let pull = |&Hitch { cable, support }: &Hitch| {
            self.cables.get(cable).map_or_else(Vec2::zeros, |c| c.force_on_support(support))
        };
        Pulls {
            hitch: hitches.iter().map(pull).sum(),
            outline: self.cables.iter().filter_map(SimulatedCable::robot_contact).map(|o| o.force_n).sum(),
        }
    }

    /// Tells the cables where the robot stands.
    pub(super) fn set_robot_pose(&mut self) {
        let Some(to) = self.vehicle.as_ref().map(|v| v.pose().placement()) else { return };
        for cable in &mut self.cables {
            cable.set_robot_pose(to);
        }
    }

    /// Everything that hangs on the robot.
    fn hitches(&self) -> Vec<Hitch> {
        let of = |(cable, c): (usize, &Cable)| {
            let supports = c.supports.iter().enumerate().filter(|(_, s)| s.kind == SupportKind::Robot);
            supports.map(move |(support, _)| Hitch { cable, support }).collect::<Vec<_>>()
        };
        self.scene.cables.iter().enumerate().flat_map(of).collect()
    }

    /// From now on the robot goes at this speed (m/s, positive to the right); None: on along its
    /// path.
    pub fn command_robot(&mut self, speed_m_per_s: Option<f64>) {
        if let Some(vehicle) = &mut self.vehicle {
            vehicle.command(speed_m_per_s);
        }
    }

    /// Puts the middle of the robot's tracks at `x_m` (m) whatever that takes, in one step of
    /// `dt_s` (s): no drive and no traction limits it, its outline pushes the cable. Returns how
    /// far from there the cable stopped it, m; None where it cannot stand there, and nothing has
    /// moved then.
    ///
    /// # Errors
    /// See [`Mechanics::advance`](crate::model::Mechanics::advance).
    pub(crate) fn place_robot(&mut self, x_m: f64, dt_s: f64, inertia: Inertia) -> Result<Option<f64>, SolveError> {
        let Some(vehicle) = &mut self.vehicle else { return Ok(None) };
        let Some(hitch) = vehicle.put(x_m) else { return Ok(None) };
        let to = vehicle.pose().placement();
        self.send_robot_pose(hitch, to, &self.hitches());
        self.cables.iter_mut().for_each(SimulatedCable::begin_step);
        let done = self.for_each_cable(|c| c.advance(dt_s, inertia));
        let left_m = self.hold_vehicle();
        self.refresh(RunPhase::InMotion);
        done.map(|()| Some(left_m))
    }

    /// Returns how far the outline that came least far is from where it was led, m.
    fn left_m(&self) -> f64 {
        self.cables.iter().filter_map(SimulatedCable::robot_contact).map(|o| o.left_m).fold(0.0, larger)
    }

    /// The vehicle is where the outline came that came least far; how far that is from where it was
    /// led, m.
    fn hold_vehicle(&mut self) -> f64 {
        let outlines = self.cables.iter().filter_map(SimulatedCable::robot_contact);
        let last = outlines.reduce(|a, b| if b.left_m > a.left_m { b } else { a }).filter(|o| o.left_m > 0.0);
        if let (Some(vehicle), Some(last)) = (&mut self.vehicle, last) {
            vehicle.hold_back(last.placement);
        }
        last.map_or(0.0, |o| o.left_m)
    }
}
