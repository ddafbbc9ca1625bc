//! This module holds the outline of a robot and the path along which it is moved in an `advance`.

use std::sync::Arc;

use crate::contact::moving_outline::Outline;
use crate::math::RigidPose;
use crate::problem::Problem;

/// Remaining time below which the path is done, as a fraction of its whole time.
const ARRIVAL_TOLERANCE: f64 = 1e-9;

/// The outline of a robot as an obstacle of a cable.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct MovingOutline {
    pub(in crate::model::fem) shape: Arc<Outline>,
    /// Its index among the obstacles.
    pub(in crate::model::fem) obstacle: usize,
    /// Poses at the start and the end of its path, with times in s.
    pub(in crate::model::fem) from: (f64, RigidPose),
    pub(in crate::model::fem) to: (f64, RigidPose),
    /// The target pose of the path before.
    pub(in crate::model::fem) led_before: RigidPose,
    /// True if it stays where it is until the end of this `advance`.
    pub(in crate::model::fem) waits: bool,
}

/// The problem with the outline of the robot among its obstacles.
pub(in crate::model::fem) fn with_outline(problem: Arc<Problem>) -> Arc<Problem> {
    MovingOutline::of(problem).1
}

impl MovingOutline {
    /// The outline of a problem, and the problem with it among its obstacles.
    pub(in crate::model::fem) fn of(problem: Arc<Problem>) -> (Option<Self>, Arc<Problem>) {
        let Some(shape) = problem.outline.clone() else { return (None, problem) };
        let world = Arc::new(problem.world.with_outline(&shape, problem.radius));
        let obstacle = world.geometry().bodies().last().map_or(0, |b| b.obstacle);
        let at = (0.0, shape.placement);
        let with_it = Problem { world, ..Problem::clone(&problem) };
        (Some(Self { shape, obstacle, from: at, to: at, led_before: at.1, waits: false }), Arc::new(with_it))
    }

    /// Its pose at a time (s).
    pub(in crate::model::fem) fn goal(&self, time: f64) -> RigidPose {
        let (whole, left) = (self.to.0 - self.from.0, self.to.0 - time);
        // A sum of steps reaches its end only up to round-off.
        if left > ARRIVAL_TOLERANCE * whole { self.from.1.towards(&self.to.1, 1.0 - left / whole) } else { self.to.1 }
    }

    /// The least number of steps without inertia for its path, each with a displacement of at most
    /// `max_way_m`.
    pub(in crate::model::fem) fn pieces(&self, max_way_m: f64) -> f64 {
        self.shape.max_displacement(&self.from.1, &self.to.1) / max_way_m
    }

    /// Sets its target: it moves there in the next `advance`.
    pub(in crate::model::fem) fn lead_to(&mut self, to: RigidPose) {
        if to.at.iter().all(|c| c.is_finite()) && to.angle.is_finite() {
            self.led_before = std::mem::replace(&mut self.to.1, to);
        }
    }

    /// Begins its path for an `advance` from the time `now` (s) and the pose `at` to the time `end`
    /// (s).
    pub(in crate::model::fem) fn begin_way(&mut self, now: f64, at: RigidPose, end: f64) {
        self.from = (now, at);
        self.to.0 = end;
        self.waits = false;
    }

    /// True if it has still to move.
    pub(in crate::model::fem) fn moves(&self) -> bool {
        self.led_before != self.to.1
    }

    /// Lets it wait at its present pose until the end of this `advance`; returns whether it was
    /// moving.
    pub(in crate::model::fem) fn wait_at(&mut self, at: Option<RigidPose>) -> bool {
        let was_moving = !self.waits && at != Some(self.to.1);
        self.waits |= was_moving;
        was_moving
    }
}
