//! The relaxation branches of a cable's loss take part in a step and remember it.

use crate::math::Vec2;
use crate::model::fem::state::cable::CableState;

/// Engineering strain of bar `e` at places `x` (m).
fn strain(d: &CableState, e: usize, x: &[Vec2]) -> f64 {
    (x[e + 1] - x[e]).norm() / d.mesh.rest_length[e] - 1.0
}

impl CableState {
    /// True if the bars have branches: those of a cable that can touch nothing and slides over
    /// nothing.
    ///
    /// In contact, with the viscous loss in slack bars and those beside sliding nodes only, the
    /// tank of the catalogue costs 1.14 times as much, but the greatest tension of a drop on rubble
    /// is 555 and 771 N with 84 and 168 bars at 1/960 s and 1105 N with 168 at 1/3840 s, where the
    /// viscous loss of 1 ms in all bars has 409, 455 and 479 N.
    pub(in crate::model::fem) fn has_branches(&self) -> bool {
        !self.loss.branches.is_empty() && !self.mesh.spread.is_lumped()
    }

    /// True if a bar so strained at the start of a step has the loss of its branches in it.
    fn relaxes(&self, strain: f64) -> bool {
        strain >= 0.0 || !self.mesh.is_flexible()
    }

    /// The branches after a step of `h` (s) to places `x` (m), before the motion is there.
    pub(in crate::model::fem) fn relax_branches(&mut self, h: f64, x: &[Vec2]) {
        if !self.has_branches() {
            return;
        }
        let (count, bars, ea) = (self.loss.branches.len(), self.mesh.rest_length.len(), self.problem.axial_stiffness);
        let mut memory = std::mem::take(&mut self.motion.branch);
        if memory.len() != count * bars {
            memory.clear();
            memory.resize(count * bars, 0.0);
        }
        for (k, b) in self.loss.branches.iter().enumerate() {
            let [decay, part] = b.in_step(h);
            for e in 0..bars {
                let before = strain(self, e, &self.motion.x);
                let change = if self.relaxes(before) {
                    let now = strain(self, e, x);
                    if self.relaxes(now) { now - before } else { -before }
                } else {
                    0.0
                };
                let q = &mut memory[e * count + k];
                *q = *q * decay + ea * part * change;
            }
        }
        self.motion.branch = memory;
    }

    /// The force of the branches of bar `e`, N.
    pub(in crate::model::fem) fn held_by_branches(&self, e: usize) -> f64 {
        let count = self.loss.branches.len();
        if !self.has_branches() || self.motion.branch.len() != count * self.mesh.rest_length.len() {
            return 0.0;
        }
        self.motion.branch[e * count..][..count].iter().sum()
    }

    /// Puts the loss of the branches in the place of the viscous one in a step of `h` (s), whose
    /// rates are `rate` (1/s) times differences.
    pub(in crate::model::fem) fn add_branches(&mut self, h: f64, rate: f64, decay: &mut Vec<f64>) {
        if !self.has_branches() {
            return;
        }
        let (count, bars, ea) = (self.loss.branches.len(), self.mesh.rest_length.len(), self.problem.axial_stiffness);
        let viscous = ea * self.loss.viscous * rate;
        let mut stiffness = viscous;
        decay.clear();
        decay.extend(self.loss.branches.iter().map(|b| b.in_step(h)[0]));
        stiffness += self.loss.branches.iter().map(|b| ea * b.in_step(h)[1]).sum::<f64>();
        let has_memory = self.motion.branch.len() == count * bars;
        for e in 0..bars {
            let before = strain(self, e, &self.motion.x);
            if !self.relaxes(before) {
                continue;
            }
            let kept = if has_memory {
                self.motion.branch[e * count..][..count].iter().zip(&*decay).map(|(q, d)| q * d).sum()
            } else {
                0.0
            };
            let l = self.mesh.rest_length[e];
            let late = self.input.predicted_length[e];
            let part = viscous / stiffness;
            self.input.predicted_length[e] = part * late + (1.0 - part) * l * (1.0 + before) - l * kept / stiffness;
            self.input.loss[e][0] = stiffness;
        }
    }
}
