//! The runaway guard holds back a motion that runs away, and says so.
//!
//! Steps are stable by construction, so nothing here acts in a sound run. It is there for what
//! construction does not cover (a stiff contact, a support thrown about): the picture stays finite
//! and the answer says that it was held back, where and when.

use crate::math::Vec2;
use crate::model::MAX_SPEED;
use crate::model::mass_spring::dynamics::supports::SupportDrives;
use crate::model::mass_spring::mesh::Mesh;
use crate::problem::Problem;
use crate::solution::{Warning, WarningCause};

/// A speed or an energy that was held back.
#[derive(Clone, Copy, Debug, Default)]
struct Excess {
    value: f64,
    limit: f64,
    time_s: f64,
    arc_length_m: f64,
    at: Vec2,
}

/// The runaway guard of a step: its limits, and the worst that it held back.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct RunawayGuard {
    speed: Option<Excess>,
    energy: Option<Excess>,
    /// Energy that supports at rest, loads and stretch can give in the step, J.
    work: f64,
}

impl RunawayGuard {
    /// The guard of a step that begins now.
    pub(in crate::model::mass_spring) fn new(p: &Problem, time_s: f64) -> Self {
        let g = if p.linear_density > 0.0 { p.weight.norm() / p.linear_density } else { 0.0 };
        let lumps: f64 = p.supports.iter().map(|s| s.mass * g + s.force.at(time_s).norm()).sum();
        let loads: f64 = p.loads.iter().map(|l| l.force.at(time_s).norm()).sum();
        let pull = p.body_force(time_s).norm() * p.length + lumps + loads;
        // Falling and being pulled the whole length twice, from the top of its swing to the bottom;
        // and what it can hold in stretch until it breaks.
        let strain = (p.cable.breaking_tension_n / p.axial_stiffness).min(1.0);
        let stretch = 0.5 * p.axial_stiffness * strain * strain * p.length;
        Self { work: 2.0 * pull * p.length + stretch, ..Self::default() }
    }

    /// Cuts velocities and brakes a motion that has more energy than anything gave it. Returns the
    /// greatest speed, m/s.
    pub(in crate::model::mass_spring) fn limit(
        &mut self,
        mesh: &mut Mesh,
        drives: &mut SupportDrives,
        time_s: f64,
    ) -> f64 {
        let tuning = mesh.tuning.runaway;
        let (mut energy, mut mass, mut momentum) = (0.0, 0.0, Vec2::zeros());
        let (mut fastest, mut node, mut support) = (0.0, 0, 0.0);
        for i in 0..mesh.position.len() {
            let square = mesh.velocity[i].norm_squared();
            if mesh.supported[i] {
                support = if square > support { square } else { support };
                continue;
            }
            if square > fastest || square.is_nan() {
                (fastest, node) = (square, i);
            }
            mass += mesh.mass[i];
            momentum += mesh.velocity[i] * mesh.mass[i];
            energy += 0.5 * mesh.mass[i] * square;
        }
        let support = f64::sqrt(support);
        if support > drives.max_speed {
            drives.max_speed = support;
        }
        let limit = tuning.max_energy_ratio * (self.work + 2.0 * mass * drives.max_speed * drives.max_speed);
        if energy > limit && !mesh.supported.contains(&true) {
            // A cable that flies freely may fall as fast as it likes; only its own motion counts.
            energy -= 0.5 * momentum.norm_squared() / mass;
        }
        let found = |value, limit| Excess {
            value,
            limit,
            time_s,
            arc_length_m: mesh.arc_length[node],
            at: mesh.position[node],
        };
        let mut speed = f64::sqrt(fastest);
        let brake = energy > limit;
        if brake && self.energy.is_none_or(|e| energy > e.value) {
            self.energy = Some(found(energy, limit));
        }
        let cut = speed > MAX_SPEED;
        if cut && self.speed.is_none_or(|s| speed > s.value) {
            self.speed = Some(found(speed, MAX_SPEED));
        }
        if cut || brake {
            speed = reduce_speeds(mesh, if brake { tuning.brake_factor } else { 1.0 });
        }
        if support > speed { support } else { speed }
    }

    /// Cuts the velocity of node `i` to the limit before the node moves with it: a huge force gives
    /// it any speed within one sub-step.
    pub(in crate::model::mass_spring) fn cut_speed(&mut self, mesh: &mut Mesh, time_s: f64, i: usize) {
        let square = mesh.velocity[i].norm_squared();
        if square > MAX_SPEED * MAX_SPEED {
            let value = square.sqrt();
            if self.speed.is_none_or(|s| value > s.value) {
                let (arc_length_m, at) = (mesh.arc_length[i], mesh.position[i]);
                self.speed = Some(Excess { value, limit: MAX_SPEED, time_s, arc_length_m, at });
            }
            mesh.velocity[i] *= MAX_SPEED / value;
        }
    }

    /// Warnings of what was held back.
    pub(in crate::model::mass_spring) fn warnings(&self, cable: &str) -> Vec<Warning> {
        let fast = self.speed.map(|e| (e, WarningCause::SpeedCut));
        let violent = self.energy.map(|e| (e, WarningCause::EnergyCut));
        let warning = |(e, cause): (Excess, WarningCause)| {
            let w = Warning::new(cause, cable, e.arc_length_m, [e.value, e.limit]).at(e.at.into());
            Warning { since_s: Some(e.time_s), ..w }
        };
        fast.into_iter().chain(violent).map(warning).collect()
    }
}

/// Brakes all free nodes and cuts their speeds; returns the greatest speed left, m/s.
fn reduce_speeds(mesh: &mut Mesh, brake: f64) -> f64 {
    let limit = MAX_SPEED;
    let mut fastest = 0.0;
    for i in (0..mesh.position.len()).filter(|&i| !mesh.supported[i]) {
        mesh.velocity[i] *= brake;
        let speed = mesh.velocity[i].norm();
        if speed > limit {
            mesh.velocity[i] *= limit / speed;
        }
        let left = if speed > limit { limit } else { speed };
        fastest = if left > fastest || left.is_nan() { left } else { fastest };
    }
    fastest
}
