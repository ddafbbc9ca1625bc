//! This module holds the motion of a cable: its present positions and velocities, and those of
//! earlier steps that the time integrator uses.

use crate::math::{RigidPose, Vec2};
use crate::model::bending_change::BendingChange;
use crate::model::fem::mesh::Mesh;
use crate::model::fem::state::energy_account::Energies;
use crate::model::fem::state::momentum_account::MomentumSums;
use crate::model::hand::Hand;
use crate::model::length_change::LengthChange;
use crate::model::smoothed_target::SmoothedTarget;

/// Relative difference of step lengths up to which steps count as even.
const EVEN_STEP_TOLERANCE: f64 = 1e-9;

/// Number of even steps with all bars in tension before the BDF3 term is used: its differences of
/// velocities reach back so far. With fewer, the snap of a bar enters them, and chains whose bars
/// rattle gain energy, half of mgL in a fold of 41 bars.
const STEPS_BEFORE_BDF3: usize = 3;

/// Number of steps without a history after a break. With one, BDF2 continues in the next step the
/// recoil of a bar that has become slack: by 1/3, and by 4.8 times where that step is ten times as
/// long as the rest of the one in which the cable broke. A span that broke so had 1.9 times the
/// energy that was put in.
const STEPS_AFTER_BREAK: usize = 2;

/// Positions, velocities and forces with memory at the present instant, and those of earlier steps
/// that the time integrator uses.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct NodalMotion {
    /// Position of each node, m; for a sliding node that of its mark.
    pub(in crate::model::fem) positions: Vec<Vec2>,
    /// Velocity of each node, m/s; that of a sliding node is that of its round, over which the
    /// material runs at the slide rate.
    pub(in crate::model::fem) velocities: Vec<Vec2>,
    /// Position one step ago, m.
    pub(in crate::model::fem) previous_positions: Vec<Vec2>,
    /// Velocity one step ago, m/s.
    pub(in crate::model::fem) previous_velocities: Vec<Vec2>,
    /// Position two steps ago, if the integrator uses it, m.
    pub(in crate::model::fem) older_positions: Vec<Vec2>,
    /// Velocity two steps ago, if the integrator uses it, m/s.
    pub(in crate::model::fem) older_velocities: Vec<Vec2>,
    /// Arc length at sliding nodes one step ago, m.
    pub(in crate::model::fem) previous_arc_length: Vec<f64>,
    /// Rate of the arc length at sliding nodes, m/s, now and one step ago.
    pub(in crate::model::fem) slide_rates: Vec<f64>,
    pub(in crate::model::fem) previous_slide_rates: Vec<f64>,
    /// Last step, s; 0 = no history, the next step is implicit Euler.
    pub(in crate::model::fem) step_before: f64,
    /// Number of successive steps as long as the last, after each of which all bars were in
    /// tension.
    pub(in crate::model::fem) even_steps: usize,
    /// Number of the next steps that are implicit Euler, whatever came before.
    pub(in crate::model::fem) steps_without_history: usize,
    pub(in crate::model::fem) followers: Vec<Option<SmoothedTarget>>,
    /// Hands that hold supports by springs.
    pub(in crate::model::fem) hands: Vec<Option<Hand>>,
    /// The unstretched length after an edit, on its way to that of the scene.
    pub(in crate::model::fem) length_change: Option<LengthChange>,
    /// The bending stiffness after an edit, on its way to that of the scene.
    pub(in crate::model::fem) bending_change: Option<BendingChange>,
    /// The excess of the bars over their material at the start of the present step, and at those of
    /// the two steps before, of that now.
    pub(in crate::model::fem) earlier_excess: [f64; 3],
    pub(in crate::model::fem) time: f64,
    /// The pose of the robot's outline, if there is one.
    pub(in crate::model::fem) placement: Option<RigidPose>,
    /// The account of momentum since the caller's step began.
    pub(in crate::model::fem) account: MomentumSums,
    /// The account of energy since the cable began to move.
    pub(in crate::model::fem) energies: Energies,
}

impl NodalMotion {
    /// Moves the node `k` and its history by the same way (m).
    pub(in crate::model::fem) fn shift(&mut self, k: usize, way: Vec2) {
        self.positions[k] += way;
        self.previous_positions[k] += way;
        if let Some(older) = self.older_positions.get_mut(k) {
            *older += way;
        }
    }

    /// Lets the excess of the bars fade by a factor in the present step.
    pub(in crate::model::fem) fn note_fading(&mut self, part: f64) {
        let [now, before, _] = self.earlier_excess;
        self.earlier_excess = [1.0, now, before].map(|excess| excess / part);
    }

    /// The unstretched length of bar `e` of a mesh in the present step, of that at its start and at
    /// those of the two steps before.
    pub(in crate::model::fem) fn growth(&self, mesh: &Mesh, e: usize) -> [f64; 3] {
        let of_all = self.length_change.map_or([1.0; 3], |change| change.growth());
        let excess = mesh.excess.sum(e);
        std::array::from_fn(|j| of_all[j] * (1.0 + excess) / (1.0 + excess * self.earlier_excess[j]))
    }

    /// Becomes a copy of `other`, reusing its memory where possible.
    pub(in crate::model::fem) fn copy_from(&mut self, other: &Self) {
        let Self {
            positions: x,
            velocities: v,
            previous_positions: x_before,
            previous_velocities: v_before,
            older_positions: x_older,
            older_velocities: v_older,
            previous_arc_length: s_before,
            slide_rates: w,
            previous_slide_rates: w_before,
            followers,
            hands,
            ..
        } = other;
        self.positions.clone_from(x);
        self.velocities.clone_from(v);
        self.previous_positions.clone_from(x_before);
        self.previous_velocities.clone_from(v_before);
        self.older_positions.clone_from(x_older);
        self.older_velocities.clone_from(v_older);
        self.previous_arc_length.clone_from(s_before);
        self.slide_rates.clone_from(w);
        self.previous_slide_rates.clone_from(w_before);
        self.followers.clone_from(followers);
        self.hands.clone_from(hands);
        (self.step_before, self.even_steps) = (other.step_before, other.even_steps);
        self.steps_without_history = other.steps_without_history;
        (self.length_change, self.bending_change) = (other.length_change, other.bending_change);
        self.earlier_excess = other.earlier_excess;
        (self.time, self.placement) = (other.time, other.placement);
        (self.account, self.energies) = (other.account, other.energies);
    }

    /// Forgets the earlier steps; the arc length of each node is `arc_length` (m).
    pub(in crate::model::fem) fn forget(&mut self, arc_length: &[f64]) {
        self.previous_positions.clone_from(&self.positions);
        self.previous_velocities.clone_from(&self.velocities);
        self.previous_slide_rates.clone_from(&self.slide_rates);
        self.previous_arc_length.clear();
        self.previous_arc_length.extend_from_slice(arc_length);
        self.step_before = 0.0;
        (self.account, self.energies) = (MomentumSums::unknown(), Energies::default());
    }

    /// Begins anew after a break, in which forces jump: with the history from before, BDF2 would
    /// take them into account half a step late.
    pub(in crate::model::fem) fn begin_after_break(&mut self) {
        (self.step_before, self.even_steps) = (0.0, 0);
        self.steps_without_history = STEPS_AFTER_BREAK;
    }

    /// The last step to which the next one looks back, s; 0 = none.
    pub(in crate::model::fem) fn history_s(&self) -> f64 {
        if self.steps_without_history > 0 { 0.0 } else { self.step_before }
    }

    /// True if inertia counts: the cable moves, or its last step had inertia.
    pub(in crate::model::fem) fn inertia_counts(&self) -> bool {
        self.step_before > 0.0 || self.velocities.iter().any(|v| v.norm_squared() > 0.0)
    }

    /// True if a step of `h` (s) is as long as the one before.
    pub(in crate::model::fem) fn is_even(&self, h: f64) -> bool {
        (h - self.step_before).abs() <= EVEN_STEP_TOLERANCE * h
    }

    /// Counts a step of `h` (s). If contact may have changed the motion, or a bar was not in
    /// tension, the step is not `smooth`, and the integrator does not look so far back.
    pub(in crate::model::fem) fn note_step(&mut self, h: f64, smooth: bool) {
        let count = if self.is_even(h) { self.even_steps } else { 0 };
        self.even_steps = if smooth { (count + 1).min(STEPS_BEFORE_BDF3) } else { 0 };
        self.step_before = h;
        self.steps_without_history = self.steps_without_history.saturating_sub(1);
    }

    /// True if a step of `h` (s) may look back three steps.
    pub(in crate::model::fem) fn looks_back_three(&self, h: f64) -> bool {
        self.even_steps >= STEPS_BEFORE_BDF3 && self.is_even(h)
    }

    /// Inserts a node before node `k`, at an arc length (m).
    pub(in crate::model::fem) fn insert_node(&mut self, k: usize, arc_length: f64, node: NodeMotion) {
        let half = 0.5 * self.step_before;
        self.positions.insert(k, node.position);
        self.velocities.insert(k, node.velocity);
        let way = (node.velocity + node.previous_velocity) * half;
        self.previous_positions.insert(k, node.position - way);
        self.previous_velocities.insert(k, node.previous_velocity);
        self.slide_rates.insert(k, node.slide_rate);
        self.previous_slide_rates.insert(k, node.previous_slide_rate);
        let slid = (node.slide_rate + node.previous_slide_rate) * half;
        self.previous_arc_length.insert(k, arc_length - slid);
    }

    /// Removes node `k`.
    pub(in crate::model::fem) fn remove_node(&mut self, k: usize) {
        self.positions.remove(k);
        self.velocities.remove(k);
        self.previous_positions.remove(k);
        self.previous_velocities.remove(k);
        self.slide_rates.remove(k);
        self.previous_slide_rates.remove(k);
        self.previous_arc_length.remove(k);
    }
}

/// The motion of one node, now and one step ago.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct NodeMotion {
    /// Position, m.
    pub(in crate::model::fem) position: Vec2,
    /// Velocities, m/s.
    pub(in crate::model::fem) velocity: Vec2,
    pub(in crate::model::fem) previous_velocity: Vec2,
    /// Rates of the arc length at a sliding node, m/s.
    pub(in crate::model::fem) slide_rate: f64,
    pub(in crate::model::fem) previous_slide_rate: f64,
}
