//! These modules continue from the state or the answer of another mesh or model.
//!
//! | room | content |
//! |---|---|
//! | `after_edit.rs` | continues on the same mesh after an edit of the scene, if that is possible |
//! | `from_state.rs` | adopts a state of another mesh or model |
//! | `from_solution.rs` | adopts an answer with its tensions: sliding nodes, stretch, friction
//! anchors |

pub(in crate::model::fem) mod after_edit;
pub(in crate::model::fem) mod from_solution;
pub(in crate::model::fem) mod from_state;

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::fem::first_shape::{depenetrate, thread_pulleys};
use crate::model::fem::mesh::PUSHED_OUT_REACHES;
use crate::model::fem::obstacle::{IntersectionCheck, place_bodies, put_outline};
use crate::model::fem::remesh::{StretchedBars, change_wheels};
use crate::model::fem::state::{Energies, MovingMass, renew_input, stored_energy};
use crate::model::fem::stepper::Stepper;
use crate::model::fem::transfer::after_edit::{SupportDrag, after_edit, loses_bending, stand_clear};
use crate::model::fem::transfer::from_solution::{
    SolutionCurve, adopt_floor_friction, adopt_friction, adopt_sliding_nodes, adopt_stretch, restore_positions,
    state_of_solution,
};
use crate::model::fem::transfer::from_state::{follow_corners, remove_all_sliding_nodes};
use crate::problem::Problem;
use crate::solution::CableSolution;
use crate::state::State;

impl Stepper {
    /// Adopts a state (from statics: at rest).
    ///
    /// # Errors An error if a number is not finite, and `Buried` if the state is so far inside an
    /// obstacle that nodes cannot be pushed out.
    pub fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(e) = state.refuse_non_finite() {
            return Err(e);
        }
        if state.arc_length_m.len() < 2 || state.position_m.len() != state.arc_length_m.len() {
            return Ok(());
        }
        self.rollback.save(&self.cable);
        let adopted = self.adopt_state(state);
        if adopted.is_err() {
            self.rollback.restore(&mut self.cable);
        }
        adopted
    }

    /// Continues from an answer of the same cable at rest, with its friction.
    ///
    /// # Errors
    /// As [`Self::set_state`].
    pub fn warm_start(
        &mut self,
        answer: &CableSolution,
        time_s: f64,
        dragged: &[Option<Vec2>],
    ) -> Result<(), SolveError> {
        let curve = SolutionCurve(&answer.nodes);
        let state = state_of_solution(&self.cable, &curve, &State::of_nodes(&answer.nodes, time_s));
        self.set_state(&state)?;
        let moves = answer.nodes.iter().any(|n| n.vx_m_per_s != 0.0 || n.vy_m_per_s != 0.0);
        let touches = !self.cable.problem.world.is_empty() || self.cable.problem.floor_friction.is_some();
        if moves || !touches || self.cable.touches_itself() {
            return Ok(());
        }
        self.rollback.save(&self.cable);
        restore_positions(&mut self.cable, &state);
        adopt_sliding_nodes(&mut self.cable, &curve);
        let mut x = std::mem::take(&mut self.cable.motion.positions);
        depenetrate(
            &self.cable.problem,
            &self.cable.mesh,
            &mut x,
            PUSHED_OUT_REACHES * self.cable.contacts.barrier.reach,
        );
        self.cable.motion.positions = x;
        adopt_stretch(&mut self.cable, &curve);
        renew_input(&mut self.cable);
        adopt_friction(&mut self.cable, &curve);
        adopt_floor_friction(&mut self.cable, &curve);
        // With sticking nodes the balance is a tiny displacement but a large force away. If
        // Newton's method alone does not find it, a fading resistance does. From bars that cut a
        // corner it would lead to a state that still cuts it.
        let found = self.quasi_static_step(time_s, dragged).or_else(|failed| {
            match IntersectionCheck::of(&self.cable).cuts_nothing() {
                true => self.relax(time_s, dragged),
                false => Err(failed),
            }
        });
        if found.is_ok() {
            self.rested = true;
        } else {
            self.rollback.restore(&mut self.cable);
        }
        Ok(())
    }

    /// Continues from where `old`, the same cable before an edit of its scene, is, with all that it
    /// remembers; supports are dragged to the points `dragged` (m). A cable that lost its bending
    /// stiffness has another mesh, and keeps the stretch of its bars alone. Returns false if the
    /// edit concerns the mesh in another way.
    pub(in crate::model::fem) fn continue_from(&mut self, old: &Self, dragged: &[Option<Vec2>]) -> bool {
        let pulled = &self.hand_drive.pulled;
        let drags: Vec<SupportDrag> =
            dragged.iter().zip(pulled).map(|(target, pulled)| SupportDrag::of(*target, *pulled)).collect();
        let Some(cable) = after_edit(&old.cable, &self.cable, &drags) else {
            return loses_bending(&self.cable, &old.cable) && self.adopt_stretched(old);
        };
        self.cable = cable;
        let heavier = self.cable.problem.linear_density * self.cable.problem.length
            / (old.cable.problem.linear_density * old.cable.problem.length);
        let [before, after] = [&old.cable, &self.cable].map(|cable| MovingMass::of(cable).momentum());
        self.cable.motion.account.change_mass(heavier, after - before);
        self.cable.motion.energies = Energies::default();
        self.time_control.sleep.wake();
        self.time_control.step_size.continue_from(&old.time_control.step_size);
        self.rested = true;
        true
    }

    /// Adopts the state of `old`, a cable on another mesh, with the stretch of its bars. Measured
    /// on the new mesh the stretch was that of chords through its nodes: 144 kN in place of 46 N
    /// where a cable lost its bending stiffness.
    fn adopt_stretched(&mut self, old: &Self) -> bool {
        if self.set_state(&old.cable.state()).is_err() {
            return false;
        }
        StretchedBars::of(&old.cable).restore(&mut self.cable);
        renew_input(&mut self.cable);
        true
    }

    /// Goes on with a problem in which some wheels have let go, with posts for some of them after
    /// its other obstacles, or hold the cable again where it is. Returns false, without a change,
    /// if the cable cannot be where it is beside those posts.
    pub(in crate::model::fem) fn change_wheels(&mut self, problem: Arc<Problem>) -> bool {
        let before = (!problem.moving_posts.is_empty()).then(|| self.cable.clone());
        change_wheels(&mut self.cable, problem);
        let state = self.cable.state();
        thread_pulleys(&mut self.cable, Some(&state));
        if let Some(before) = before
            && !stand_clear(&mut self.cable)
        {
            self.cable = before;
            return false;
        }
        renew_input(&mut self.cable);
        if self.accounts_energy {
            self.cable.motion.energies.edit(stored_energy(&self.cable));
            self.cable.motion.energies.end_step();
        }
        true
    }

    /// Adopts a state: node by node if the nodes are the same, else by arc length.
    fn adopt_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.time_control.sleep.wake();
        let led = put_outline(&mut self.cable);
        let same = state.arc_length_m == self.cable.mesh.arc_length && !led;
        if !same {
            remove_all_sliding_nodes(&mut self.cable);
        }
        let breaks: Vec<usize> = self.cable.mesh.breaks().collect();
        let pieces = if breaks.is_empty() { Vec::new() } else { state.pieces() };
        for (k, &s) in self.cable.mesh.arc_length.iter().enumerate() {
            if self.cable.mesh.sliding[k].is_some() {
                continue;
            }
            // Arc lengths do not tell two nodes at a break apart.
            let state = pieces.get(breaks.partition_point(|&e| e < k)).unwrap_or(state);
            if let Some(p) = state.position_at(s) {
                self.cable.motion.positions[k] = p;
            }
            self.cable.motion.velocities[k] = state.velocity_at(s).unwrap_or_default();
        }
        self.cable.motion.time = state.time_s;
        place_bodies(&mut self.cable);
        self.cable.motion.followers.fill(None);
        self.cable.motion.hands.fill(None);
        self.cable.contacts.forget();
        if !same {
            thread_pulleys(&mut self.cable, Some(state));
        }
        // A state in motion continues as it is; one at rest is brought to rest on this mesh.
        let still = !state.in_motion && self.cable.motion.velocities.iter().all(|v| v.norm() == 0.0);
        // Bars that cut a corner would come to rest there. Where none does, friction is not
        // disturbed within a quasi-static run.
        let cuts = !same && !IntersectionCheck::of(&self.cable).cuts_nothing();
        if !same && (!still || state.time_s == 0.0 || cuts) {
            follow_corners(&mut self.cable, state);
        }
        if !same || IntersectionCheck::of(&self.cable).refuse_buried().is_err() {
            let mut x = std::mem::take(&mut self.cable.motion.positions);
            depenetrate(
                &self.cable.problem,
                &self.cable.mesh,
                &mut x,
                PUSHED_OUT_REACHES * self.cable.contacts.barrier.reach,
            );
            self.cable.motion.positions = x;
        }
        IntersectionCheck::of(&self.cable).refuse_buried()?;
        self.forget_history();
        if state.in_motion {
            self.cable.motion.begin_after_break();
        }
        // A state at rest on another mesh is brought to rest on this one before it moves.
        self.rested = same || !still;
        renew_input(&mut self.cable);
        Ok(())
    }
}
