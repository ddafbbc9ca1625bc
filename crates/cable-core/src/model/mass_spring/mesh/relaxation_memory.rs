//! The memory of material loss: the forces in the relaxation branches of the springs of a chain, or
//! the moments in those of its bends (`model/material_loss.rs`).
//!
//! From one sub-step to the next, h apart, strain is linear in time, and the branches have an exact
//! solution:
//! ```text
//! q = d q₀ + K y g (ε − ε₀),   σ = K ε + Σ d q₀ + C (ε − ε₀),   C = K (Σ y g + τ/h)
//! ```
//! with K = EA and the strain, or EI and the curvature, and τ the time constant of a viscous part.
//!
//! A spring of a cable without bending stiffness cannot push. Where σ would be negative it is
//! slack, and its material has the strain at which its tension ends, σ = 0, from which it recovers
//! with the times of the branches. In the sub-step in which it becomes taut it has a viscous loss
//! beside (see [`MeshTuning::impact_damping`]).

use std::sync::Arc;

use crate::math::{larger, smaller};
use crate::model::mass_spring::settings::MeshTuning;
use crate::model::material_loss::{Loss, MaterialLoss, Rubbing};
use crate::problem::Problem;

part! {
    /// The branches of all springs or of all bends.
    RelaxationMemory {
        /// The law of the loss.
        loss: Arc<MaterialLoss>,
        /// EA, N, or EI, N·m².
        stiffness: f64,
        /// True if a spring can push, as that of a cable with bending stiffness.
        pushes: bool,
        /// Time constant of the viscous loss of a spring in the step in which it becomes taut, s.
        impact_time_s: f64,
        /// The step of which the factors below are, s.
        step_s: f64,
        /// The factor d by which each branch decays in the step.
        decay: Vec<f64>,
        /// The stiffness K y g of each branch in the step.
        rise: Vec<f64>,
        /// The stiffness C of all branches and of the viscous part in the step.
        damping_stiffness: f64,
        /// That of the viscous loss of a spring that becomes taut.
        impact_stiffness: f64,
        /// Strain or curvature of the material in each slot in the last sub-step; NaN where that of
        /// the next one begins it.
        strain: Vec<f64>,
        /// Forces or moments in the branches, all slots of the first branch before those of the
        /// second.
        forces: Vec<f64>,
        /// Sum in each slot of what is left of them in the step.
        remaining_force: Vec<f64>,
        /// Change of the strain of each slot in the step.
        change: Vec<f64>,
    }
}

/// The memory of the springs and of the bends of a cable of even springs of length `spring` (m)
/// between so many nodes, with a bending stiffness (N·m²) that may yet become that of the problem.
pub(super) fn memories(
    problem: &Problem,
    tuning: &MeshTuning,
    spring: f64,
    bending_stiffness: f64,
    nodes: usize,
) -> [RelaxationMemory; 2] {
    let Loss { mut stretching, mut bending } = Loss::of(problem, spring, Rubbing::Never);
    // Time constants whose damping of the fastest modes, 2√(EA/ρ)/l and 4√(EI/ρ)/l², is critical.
    let critical = spring / (problem.axial_stiffness / problem.linear_density).sqrt();
    let greater = larger(bending_stiffness, problem.bending_stiffness);
    let critical_in_bending = 0.5 * spring * spring / (greater / problem.linear_density).sqrt();
    stretching.viscous = smaller(stretching.viscous, tuning.max_mode_damping * critical);
    bending.viscous = smaller(bending.viscous, tuning.max_mode_damping * critical_in_bending);
    let slots = if greater > 0.0 { 2 * nodes } else { 0 };
    let springs = RelaxationMemory::new(stretching, problem.axial_stiffness, nodes - 1);
    let impact_time_s = tuning.impact_damping * critical;
    let pushes = greater > 0.0;
    [RelaxationMemory { impact_time_s, pushes, ..springs }, RelaxationMemory::new(bending, bending_stiffness, slots)]
}

impl RelaxationMemory {
    /// Nothing is remembered in so many slots.
    fn new(loss: MaterialLoss, stiffness: f64, slots: usize) -> Self {
        let branches = loss.branches.len();
        Self {
            loss: Arc::new(loss),
            stiffness,
            pushes: false,
            impact_time_s: 0.0,
            step_s: 0.0,
            decay: vec![1.0; branches],
            rise: vec![0.0; branches],
            damping_stiffness: 0.0,
            impact_stiffness: 0.0,
            strain: vec![f64::NAN; slots],
            forces: vec![0.0; branches * slots],
            remaining_force: vec![0.0; slots],
            change: vec![0.0; slots],
        }
    }

    /// Lets springs push, or not.
    pub(in crate::model::mass_spring) fn let_push(&mut self, pushes: bool) {
        self.pushes = pushes;
    }

    /// Changes the stiffness, N or N·m².
    pub(in crate::model::mass_spring) fn set_stiffness(&mut self, stiffness: f64) {
        self.stiffness = stiffness;
        self.set_step(self.step_s);
    }

    /// Begins a step of `h` (s). With none a motion begins, and the branches are at rest.
    pub(in crate::model::mass_spring) fn begin_step(&mut self, h: f64) {
        if !(h > 0.0) {
            self.forces.fill(0.0);
            self.strain.fill(f64::NAN);
        }
        if h != self.step_s {
            self.set_step(h);
        }
        self.remaining_force.fill(0.0);
        self.change.fill(0.0);
        for (forces, decay) in self.forces.chunks_exact_mut(self.strain.len().max(1)).zip(&self.decay) {
            for (force, remaining) in forces.iter_mut().zip(&mut self.remaining_force) {
                *force *= decay;
                *remaining += *force;
            }
        }
    }

    /// Takes the factors of a step of `h` (s).
    fn set_step(&mut self, h: f64) {
        self.step_s = h;
        let viscous = |time_s: f64| if h > 0.0 { self.stiffness * time_s / h } else { 0.0 };
        (self.damping_stiffness, self.impact_stiffness) = (viscous(self.loss.viscous), viscous(self.impact_time_s));
        for ((decay, rise), branch) in self.decay.iter_mut().zip(&mut self.rise).zip(&self.loss.branches) {
            let [d, part] = if h > 0.0 { branch.in_step(h) } else { [1.0, 0.0] };
            (*decay, *rise) = (d, self.stiffness * part);
            self.damping_stiffness += *rise;
        }
    }

    /// The tension of the spring in a slot with a strain, N, after `last` (N) in the sub-step
    /// before. The branches take note of it.
    #[inline]
    pub(in crate::model::mass_spring) fn tension(&mut self, slot: usize, strain: f64, last: f64) -> f64 {
        let known = self.strain[slot];
        let before = if !known.is_nan() {
            known
        } else if strain < 0.0 && !self.pushes {
            0.0
        } else {
            strain
        };
        let impact = if last > 0.0 || self.pushes { 0.0 } else { self.impact_stiffness };
        let damping = self.damping_stiffness + impact;
        let pull = self.stiffness * strain + self.remaining_force[slot] + damping * (strain - before);
        // NaN passes on, and is detected later.
        let (material, tension) =
            if pull < 0.0 && !self.pushes { (strain - pull / (self.stiffness + damping), 0.0) } else { (strain, pull) };
        self.change[slot] = material - before;
        self.strain[slot] = material;
        tension
    }

    /// The moment of the bend in a slot with a curvature (1/m), N·m, of which the branches take
    /// note.
    #[inline]
    pub(in crate::model::mass_spring) fn moment(&mut self, slot: usize, curvature: f64) -> f64 {
        let known = self.strain[slot];
        let change = if known.is_nan() { 0.0 } else { curvature - known };
        self.change[slot] = change;
        self.strain[slot] = curvature;
        self.stiffness * curvature + self.remaining_force[slot] + self.damping_stiffness * change
    }

    /// Ends the step: the branches take up the changes of strain in it.
    pub(in crate::model::mass_spring) fn end_step(&mut self) {
        for (forces, rise) in self.forces.chunks_exact_mut(self.strain.len().max(1)).zip(&self.rise) {
            for (force, change) in forces.iter_mut().zip(&self.change) {
                *force += rise * change;
            }
        }
    }

    /// The sum of the forces or moments in the branches of a slot, N or N·m.
    pub(in crate::model::mass_spring) fn branch_force(&self, slot: usize) -> f64 {
        let count = self.strain.len().max(1);
        self.forces.iter().skip(slot).step_by(count).sum()
    }

    /// Stiffness of the fastest motion, in which no branch relaxes, N or N·m².
    pub(in crate::model::mass_spring) fn unrelaxed_stiffness(&self) -> f64 {
        self.stiffness * self.loss.unrelaxed_ratio()
    }

    /// Viscous stiffness times its time constant, N·s or N·m²·s.
    pub(in crate::model::mass_spring) fn viscosity(&self) -> f64 {
        self.stiffness * self.loss.viscous
    }

    /// Inserts a copy of a slot after it.
    pub(super) fn divide(&mut self, slot: usize) {
        let count = self.strain.len();
        for branch in (0..self.decay.len()).rev() {
            let at = branch * count + slot;
            self.forces.insert(at + 1, self.forces[at]);
        }
        for list in [&mut self.strain, &mut self.remaining_force, &mut self.change] {
            list.insert(slot + 1, list[slot]);
        }
    }

    /// Puts one slot in the place of a slot and the next, of which the first has a fraction `part`
    /// of the length.
    pub(super) fn merge(&mut self, slot: usize, part: f64) {
        let mean = |list: &[f64], at: usize| part * list[at] + (1.0 - part) * list[at + 1];
        let count = self.strain.len();
        for branch in (0..self.decay.len()).rev() {
            let at = branch * count + slot;
            self.forces[at] = mean(&self.forces, at);
            self.forces.remove(at + 1);
        }
        for list in [&mut self.strain, &mut self.remaining_force, &mut self.change] {
            list[slot] = mean(list, slot);
            list.remove(slot + 1);
        }
    }

    /// Inserts node `n` with two slots, of bends, that have the moments of the material between its
    /// neighbours.
    pub(super) fn insert_node(&mut self, n: usize) {
        let count = self.strain.len();
        if count == 0 {
            return;
        }
        for branch in (0..self.decay.len()).rev() {
            let at = branch * count + 2 * n;
            let between = 0.5 * (self.forces[at - 2] + self.forces[at]);
            self.forces.splice(at..at, [between; 2]);
        }
        for list in [&mut self.strain, &mut self.remaining_force, &mut self.change] {
            list.splice(2 * n..2 * n, [0.0; 2]);
        }
        self.begin_curvature(n - 1..n + 2);
    }

    /// Removes node `n` with its two slots, of bends.
    pub(super) fn remove_node(&mut self, n: usize) {
        let count = self.strain.len();
        if count == 0 {
            return;
        }
        for branch in (0..self.decay.len()).rev() {
            let at = branch * count + 2 * n;
            self.forces.drain(at..at + 2);
        }
        for list in [&mut self.strain, &mut self.remaining_force, &mut self.change] {
            list.drain(2 * n..2 * n + 2);
        }
        self.begin_curvature(n - 1..n + 1);
    }

    /// Lets the curvature of nodes be measured from that of the next sub-step, as their bent
    /// lengths have changed.
    fn begin_curvature(&mut self, nodes: std::ops::Range<usize>) {
        self.strain[2 * nodes.start..2 * nodes.end].fill(f64::NAN);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::problems;
    use crate::scene::catalog;

    fn springs(count: usize) -> RelaxationMemory {
        let mut scene = catalog::hanging_span();
        scene.cables[0].damping_ratio = 0.05;
        let problem = problems(&scene).unwrap().remove(0);
        let [springs, _] = memories(&problem, &MeshTuning::default(), 0.1, problem.bending_stiffness, count + 1);
        springs
    }

    /// Stretches every spring of a memory in a step of `h` (s).
    fn stretch(memory: &mut RelaxationMemory, h: f64, strains: &[f64]) -> Vec<f64> {
        memory.begin_step(h);
        let tensions = strains.iter().enumerate().map(|(e, strain)| memory.tension(e, *strain, 1.0)).collect();
        memory.end_step();
        tensions
    }

    #[test]
    fn parts_of_a_spring_have_its_forces_and_a_merged_spring_has_their_mean() {
        let mut memory = springs(2);
        stretch(&mut memory, 0.0, &[1e-3, 1e-3]);
        stretch(&mut memory, 1e-4, &[1e-3, 3e-3]);
        let [first, second] = [memory.branch_force(0), memory.branch_force(1)];
        assert!(first == 0.0 && second > 0.0, "{first} {second}");
        memory.divide(1);
        assert_eq!([memory.branch_force(0), memory.branch_force(1), memory.branch_force(2)], [first, second, second]);
        memory.merge(0, 0.75);
        assert!((memory.branch_force(0) / second - 0.25).abs() < 1e-12 && memory.branch_force(1) == second);
        assert_eq!(memory.strain, [1.5e-3, 3e-3]);
    }

    /// A spring that is let go at once after a long stretch is slack while it is longer than at
    /// rest, and recovers; held still it loses nothing.
    #[test]
    fn a_slack_spring_has_the_strain_at_which_its_tension_ended() {
        let mut memory = springs(1);
        let ea = memory.stiffness;
        stretch(&mut memory, 0.0, &[1e-2]);
        assert_eq!(stretch(&mut memory, 1e3, &[1e-2]), [ea * 1e-2]);
        assert_eq!(stretch(&mut memory, 1e-6, &[0.0]), [0.0]);
        let left = memory.strain[0];
        assert!(left > 1e-4 && (ea * left + memory.branch_force(0)).abs() < 1e-9 * ea, "{left}");
        let mut last = left;
        for _ in 0..20 {
            stretch(&mut memory, 0.1, &[0.0]);
            assert!(memory.strain[0] >= 0.0 && memory.strain[0] < last, "{} after {last}", memory.strain[0]);
            last = memory.strain[0];
        }
        assert_eq!(stretch(&mut memory, 1e-6, &[0.9 * last]), [0.0]);
    }
}
