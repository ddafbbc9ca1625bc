//! A quasi-static step moves the supports a little; the chain comes to rest there, and friction
//! remembers.

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::mass_spring::Anchors;
use crate::model::mass_spring::MassSpringModel;

/// Longest way of a support between two resting places, of the even length (friction is measured
/// from where the material was, and a longer way leaves that element) and of the cable's radius
/// where there is something to hit (a longer one stretches the end so far that Newton's first steps
/// draw a node in under a corner, where it locks).
const SUPPORT_WAY_LENGTHS: f64 = 0.5;
/// Most resting places in a step, and the shortest part of one that is tried after a failure.
const MOST_PARTS: f64 = 1e4;
const SHORTEST_PART: f64 = 1.0 / 1024.0;

impl MassSpringModel {
    pub(in crate::model::mass_spring) fn creep(&mut self, dt_s: f64) -> Result<(), SolveError> {
        let (begin, end) = (self.clock.time_s, self.clock.time_s + dt_s);
        let from = self.chain.x.clone();
        let nodes: Vec<(usize, usize)> = self.chain.node_of.iter().copied().enumerate().collect();
        let mut way: f64 = 0.0;
        for &(k, node) in &nodes {
            let support = &self.problem.supports[k];
            // The way of a motion within the step may be longer than the distance.
            let mut last = from[node];
            for j in 1..=WAY_SAMPLES {
                let time = begin + dt_s * f64::from(j) / f64::from(WAY_SAMPLES);
                let Some((at, _)) = support.position_at(time) else { break };
                let at = self.drives.drag[k].unwrap_or(at);
                way += (at - last).norm();
                last = at;
            }
        }
        let within =
            if self.problem.world.is_empty() { self.chain.even } else { self.chain.even.min(self.problem.radius) };
        let parts = if self.touches_something() || !self.wheels.pulleys.is_empty() {
            (way / (SUPPORT_WAY_LENGTHS * within)).ceil().clamp(1.0, MOST_PARTS)
        } else {
            1.0
        };
        let targets = self.drives.drag.clone();
        let starts: Vec<Vec2> = nodes.iter().map(|&(_, n)| from[n]).collect();
        let (mut done, mut part, mut iterations) = (0.0, 1.0 / parts, 0);
        while done < 1.0 {
            let kept = self.clone();
            let next = if done + part > 1.0 - 0.5 * part { 1.0 } else { done + part };
            self.clock.time_s = begin + (end - begin) * next;
            for (k, target) in targets.iter().enumerate() {
                // A hand goes straight.
                self.drives.drag[k] = target.map(|t| starts[k] + (t - starts[k]) * next);
            }
            match self.equilibrium(Anchors::Kept) {
                Ok(()) => {
                    iterations += self.report.cost.iterations;
                    done = next;
                }
                Err(e) => {
                    *self = kept;
                    part *= 0.5;
                    if part * parts < SHORTEST_PART {
                        return Err(e);
                    }
                }
            }
        }
        self.report.cost.iterations = iterations;
        // What rubs on a held node asks which way it goes.
        for &(k, node) in &nodes {
            let now = self.chain.node_of[k];
            if self.drives.held[now] {
                self.chain.v[now] = (self.chain.x[now] - from[node]) / dt_s;
            }
        }
        self.drives.drag = targets;
        Ok(())
    }
}

/// Points at which a motion is looked at to measure its way.
const WAY_SAMPLES: u32 = 8;
