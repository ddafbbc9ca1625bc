//! The runaway guard holds back a motion that runs away, and says so.
//!
//! Steps are stable by construction, so nothing here acts in a sound run. It is there for what
//! construction does not cover (a stiff contact, a support thrown about): the picture stays finite
//! and the answer says that it was held back, where and when.

use crate::math::Vec2;
use crate::model::mass_spring::MassSpringModel;
use crate::solution::{Warning, WarningCause};

/// Fastest a node may move, m/s. Recoil of a broken rope stays below it (breaking strain times wave
/// speed: 20 m/s for steel, 300 m/s for nylon); a lower limit cuts that, a higher one lets thin
/// obstacles cost ever shorter sub-steps.
const NODE_SPEED_LIMIT: f64 = 300.0;
/// Kinetic energy over what supports, loads and stretch can have given beyond which the motion is
/// not believed. Less damps real whips, more shows the explosion first.
const MOST_ENERGY: f64 = 10.0;
/// What is left of velocities in such a sub-step: 0.7 takes a tenfold energy back in seven of them.
const BRAKE: f64 = 0.7;

/// Something that was held back.
#[derive(Clone, Copy, Debug, Default)]
struct Excess {
    value: f64,
    limit: f64,
    time_s: f64,
    arc_length_m: f64,
    at: Vec2,
}

/// The worst of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct Trouble {
    speed: Option<Excess>,
    energy: Option<Excess>,
    /// Energy limit of the step, J, but for what supports give.
    work: f64,
}

impl MassSpringModel {
    /// Trouble to be filled in a step that begins now.
    pub(in crate::model::mass_spring) fn no_trouble(&self) -> Trouble {
        let p = &self.problem;
        let g = if p.linear_density > 0.0 { p.weight.norm() / p.linear_density } else { 0.0 };
        let lumps: f64 = p.supports.iter().map(|s| s.mass * g + s.force.at(self.clock.time_s).norm()).sum();
        let loads: f64 = p.loads.iter().map(|l| l.force.at(self.clock.time_s).norm()).sum();
        let pull = p.body_force(self.clock.time_s).norm() * p.length + lumps + loads;
        // Falling and being pulled the whole length twice, from the top of its swing to the bottom;
        // and what it can hold in stretch until it breaks.
        let strain = (p.cable.breaking_tension_n / p.axial_stiffness).min(1.0);
        let stretch = 0.5 * p.axial_stiffness * strain * strain * p.length;
        Trouble { work: 2.0 * pull * p.length + stretch, ..Trouble::default() }
    }

    /// Cuts velocities and brakes a motion that has more energy than anything gave it. Returns the
    /// greatest speed, m/s.
    pub(in crate::model::mass_spring) fn calm(&mut self, trouble: &mut Trouble) -> f64 {
        let (mut energy, mut mass, mut momentum) = (0.0, 0.0, Vec2::zeros());
        let (mut fastest, mut node, mut support) = (0.0, 0, 0.0);
        for i in 0..self.chain.x.len() {
            let square = self.chain.v[i].norm_squared();
            if self.drives.held[i] {
                support = if square > support { square } else { support };
                continue;
            }
            if square > fastest || square.is_nan() {
                (fastest, node) = (square, i);
            }
            mass += self.chain.mass[i];
            momentum += self.chain.v[i] * self.chain.mass[i];
            energy += 0.5 * self.chain.mass[i] * square;
        }
        let support = f64::sqrt(support);
        if support > self.drives.driven {
            self.drives.driven = support;
        }
        let limit = MOST_ENERGY * (trouble.work + 2.0 * mass * self.drives.driven * self.drives.driven);
        if energy > limit && !self.drives.held.contains(&true) {
            // What flies freely may fall as fast as it likes; only its own motion counts.
            energy -= 0.5 * momentum.norm_squared() / mass;
        }
        let found = |value, limit| Excess {
            value,
            limit,
            time_s: self.clock.time_s,
            arc_length_m: self.chain.s[node],
            at: self.chain.x[node],
        };
        let mut speed = f64::sqrt(fastest);
        let brake = energy > limit;
        if brake && trouble.energy.is_none_or(|e| energy > e.value) {
            trouble.energy = Some(found(energy, limit));
        }
        let cut = speed > NODE_SPEED_LIMIT;
        if cut && trouble.speed.is_none_or(|s| speed > s.value) {
            trouble.speed = Some(found(speed, NODE_SPEED_LIMIT));
        }
        if cut || brake {
            speed = self.hold_back(if brake { BRAKE } else { 1.0 });
        }
        if support > speed { support } else { speed }
    }

    /// Brakes and cuts; returns the greatest speed left, m/s.
    fn hold_back(&mut self, brake: f64) -> f64 {
        let mut fastest = 0.0;
        for i in (0..self.chain.x.len()).filter(|&i| !self.drives.held[i]) {
            self.chain.v[i] *= brake;
            let speed = self.chain.v[i].norm();
            if speed > NODE_SPEED_LIMIT {
                self.chain.v[i] *= NODE_SPEED_LIMIT / speed;
            }
            let left = if speed > NODE_SPEED_LIMIT { NODE_SPEED_LIMIT } else { speed };
            fastest = if left > fastest || left.is_nan() { left } else { fastest };
        }
        fastest
    }

    /// Says what was held back.
    pub(in crate::model::mass_spring) fn warn_of(&mut self, trouble: &Trouble) {
        let name = &self.problem.cable.name;
        let fast = trouble.speed.map(|e| (e, WarningCause::SpeedCut));
        let violent = trouble.energy.map(|e| (e, WarningCause::EnergyCut));
        for (e, cause) in fast.into_iter().chain(violent) {
            let w = Warning::new(cause, name, e.arc_length_m, [e.value, e.limit]).at(e.at.into());
            self.report.warnings.push(Warning { since_s: Some(e.time_s), ..w });
        }
    }
}
