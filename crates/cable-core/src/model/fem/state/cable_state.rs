//! This module holds the state of a cable: its mesh, contacts and history, the loads of the present
//! step, and its answers. It knows nothing of solvers and of the control of time.

use std::sync::Arc;

use crate::error::{Place, SolveError, Unsupported};
use crate::math::{Vec2, larger, smaller};
use crate::model::Model;
use crate::model::bending_change::{BendingChange, WHOLE_ROUNDING};
use crate::model::fem::mesh::{Mesh, SlideOver, SlidingNodeLoad};
use crate::model::fem::state::meshing::Meshing;
use crate::model::fem::state::motion::NodalMotion;
use crate::model::fem::state::outline_path::MovingOutline;
use crate::model::fem::system::{ContactSet, StepContext, StepInput, Unknowns, load_scale, slip_at_rest};
use crate::model::length_change::excess_left;
use crate::model::material_loss::{Loss, Rubbing};
use crate::problem::{MovingPost, Problem};
use crate::solution::CableSolution;
use crate::state::State;

/// Most steps without inertia into which a change is divided. Smaller: long moves on fine meshes go
/// farther at once than half a bar; larger: a scene that moves by kilometres takes minutes.
const MAX_STATIC_STEPS: f64 = 1e4;
/// Longest move of a support or post in a step without inertia, in even bars. Smaller: more steps;
/// larger: a cable may be carried past a corner.
const LONGEST_STATIC_MOVE_BARS: f64 = 0.5;

/// Tension at the nodes of a mesh.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct NodeTensions {
    /// Arc length of each node, m.
    pub(in crate::model::fem) arc_length: Vec<f64>,
    /// Tension at each node, N.
    pub(in crate::model::fem) tension: Vec<f64>,
    /// Tension of each bar, N.
    pub(in crate::model::fem) bars: Vec<f64>,
}

/// Report of the last step.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct StepAnswers {
    /// Force of the cable on each node that is held, N.
    pub(in crate::model::fem) reaction: Vec<Vec2>,
    /// Supports that were stopped short of their target.
    pub(in crate::model::fem) lagging_supports: Vec<usize>,
    /// The answer of the last step of an `advance` on the mesh on which it was balanced; the mesh
    /// is changed after it, for the next step.
    pub(in crate::model::fem) stepped: Option<Box<CableSolution>>,
    /// True if the answer is to be stored before the mesh is changed.
    pub(in crate::model::fem) keeps: bool,
    /// The stored answer.
    pub(in crate::model::fem) stored_answer: Option<Box<CableSolution>>,
    /// Tension after the last step, on the mesh that it balanced.
    pub(in crate::model::fem) gauged: NodeTensions,
}

/// The state of a cable in contact.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct CableState {
    pub(in crate::model::fem) problem: Arc<Problem>,
    pub(in crate::model::fem) mesh: Mesh,
    pub(in crate::model::fem) meshing: Meshing,
    pub(in crate::model::fem) contacts: ContactSet,
    pub(in crate::model::fem) motion: NodalMotion,
    /// Material damping of taut bars and of bends.
    pub(in crate::model::fem) loss: Loss,
    /// The outline of the robot, if there is one.
    pub(in crate::model::fem) outline: Option<MovingOutline>,
    /// Supports and loads of the present step.
    pub(in crate::model::fem) input: StepInput,
    pub(in crate::model::fem) answers: StepAnswers,
}

impl CableState {
    /// True if there is nothing to touch: no obstacle, and the cable can pass itself.
    pub(in crate::model::fem) fn meets_nothing(&self) -> bool {
        self.contacts.meets_nothing(&self.problem)
    }

    /// Tells whether the cable can rub on anything: an obstacle, itself, a pulley, or the floor of
    /// a plan.
    pub(in crate::model::fem) fn rubbing(&self) -> Rubbing {
        match self.meets_nothing() && self.meshing.never_slides && self.problem.floor_friction.is_none() {
            true => Rubbing::Never,
            false => Rubbing::Possible,
        }
    }

    /// Stores the friction of a balanced step in the memory of the contacts.
    pub(in crate::model::fem) fn commit_contacts(&mut self, unknowns: &Unknowns) {
        self.contacts.commit(&self.problem, &self.mesh, &unknowns.positions, &self.motion.positions, &unknowns.slides);
    }

    /// Forgets the steps before the present instant.
    pub(in crate::model::fem) fn forget_history(&mut self) {
        self.answers.stepped = None;
        self.motion.forget(&self.mesh.arc_length);
        self.mesh.branch_forces.clear();
        self.mesh.remembered_impulses.clear();
        self.mesh.branch_moments.clear();
    }

    /// Position of a support, m.
    pub(in crate::model::fem) fn support_position(&self, support: usize) -> Option<Vec2> {
        match self.meshing.support_node.get(support).copied().flatten() {
            Some(node) => self.motion.positions.get(node).copied(),
            None => self.mesh.pulley_center(support),
        }
    }

    /// Interpolates the points to which hands drag supports, for a fraction of the path that is
    /// left.
    pub(in crate::model::fem) fn interpolate_targets(
        &self,
        hand_targets: &mut Vec<Option<Vec2>>,
        dragged: &[Option<Vec2>],
        part: f64,
    ) {
        hand_targets.clear();
        hand_targets.extend(dragged.iter().enumerate().map(|(k, target)| {
            let (target, now) = ((*target)?, self.support_position(k));
            Some(now.filter(|_| part < 1.0 - WHOLE_ROUNDING).map_or(target, |now| now + (target - now) * part))
        }));
    }

    /// True if the unstretched length is still changing to that of the scene.
    pub(in crate::model::fem) fn changes_length(&self) -> bool {
        self.motion.length_change.is_some() || self.mesh.has_excess()
    }

    /// True if the unstretched length or the bending stiffness is still changing to that of the
    /// scene.
    pub(in crate::model::fem) fn changes(&self) -> bool {
        self.changes_length() || self.motion.bending_change.is_some()
    }

    /// Changes the bending stiffness, if it changes.
    fn change_bending(&mut self, change: impl FnOnce(&mut BendingChange)) {
        if let Some(bending) = &mut self.motion.bending_change {
            change(bending);
            self.mesh.bending_stiffness = bending.stiffness();
            self.motion.bending_change = self.motion.bending_change.filter(|bending| !bending.is_over());
        }
    }

    /// Changes the unstretched length and the bending stiffness for `dt_s` towards those of the
    /// scene.
    pub(in crate::model::fem) fn follow_edit(&mut self, dt_s: f64) {
        if let Some(change) = &mut self.motion.length_change {
            let stretch = change.follow(&self.problem, dt_s);
            self.set_thermal_stretch(stretch);
        }
        if self.mesh.has_excess() {
            let part = excess_left(self.mesh.whole_excess(), dt_s);
            self.mesh.fade_excess(part);
            self.motion.note_fading(part);
        }
        self.change_bending(|bending| bending.follow(dt_s));
    }

    /// Changes the unstretched length and the bending stiffness by a fraction of what they differ
    /// from those of the scene.
    pub(in crate::model::fem) fn approach_edit(&mut self, part: f64) {
        if self.motion.length_change.is_some() {
            let [now, to] = [self.mesh.thermal_stretch, self.problem.thermal_stretch];
            self.set_thermal_stretch(if part < 1.0 - WHOLE_ROUNDING { now + (to - now) * part } else { to });
        }
        self.mesh.fade_excess(if part < 1.0 - WHOLE_ROUNDING { 1.0 - part } else { 0.0 });
        self.change_bending(|bending| bending.approach(part));
    }

    fn set_thermal_stretch(&mut self, stretch: f64) {
        self.mesh.change_thermal_stretch(stretch);
        if stretch == self.problem.thermal_stretch {
            self.motion.length_change = None;
        }
    }

    /// Returns an error for a cable that `fem` cannot solve.
    pub(in crate::model::fem) fn check_supported(&self) -> Result<(), SolveError> {
        let pulleys = self.mesh.sliding.iter().flatten().any(|s| matches!(s.slide_over, SlideOver::Pulley(_)));
        if self.problem.cable.self_contact && pulleys {
            let feature = Unsupported::SelfContactWithPulleys;
            return Err(SolveError::Unsupported { model: Model::Fem, feature });
        }
        Ok(())
    }

    /// `h` (s), or the shorter time until a support releases the cable.
    pub(in crate::model::fem) fn until_release(&self, h: f64) -> f64 {
        let now = self.motion.time;
        let releases = self.problem.supports.iter().filter_map(|s| s.release_between(now, now + h));
        releases.fold(h, |least, r| if r - now < least { r - now } else { least })
    }

    /// The place of a node, in terms of the scene.
    pub(in crate::model::fem) fn place(&self, node: usize) -> Box<Place> {
        let arc_length = self.mesh.arc_length.get(node).copied().unwrap_or(f64::NAN);
        let at = self.motion.positions.get(node).copied().unwrap_or(Vec2::repeat(f64::NAN));
        self.problem.place(arc_length, at, self.motion.time)
    }

    /// Time reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.motion.time
    }

    /// Positions and velocities of the cable.
    #[must_use]
    pub fn state(&self) -> State {
        State {
            time_s: self.motion.time,
            arc_length_m: self.mesh.arc_length.clone(),
            position_m: self.motion.positions.clone(),
            velocity_m_per_s: self.motion.velocities.clone(),
            in_motion: false,
        }
    }

    /// Smallest gap of any free node or segment, m (infinite if nothing is near).
    #[cfg(test)]
    pub(in crate::model::fem) fn smallest_gap(&self) -> f64 {
        let mut touches = Vec::new();
        self.contacts.find(&self.problem, &self.mesh, &self.motion.positions, &mut touches);
        touches.iter().map(|t| t.pair.gap.gap_m).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    }

    /// The input of the solve of the present step.
    pub(in crate::model::fem) fn step_context(&self) -> StepContext<'_> {
        StepContext { problem: &self.problem, mesh: &self.mesh, contacts: &self.contacts, input: &self.input }
    }

    /// The load of a sliding node at the present positions.
    pub(in crate::model::fem) fn load(&self, k: usize) -> Option<SlidingNodeLoad> {
        self.step_context().load_at(k, &self.motion.positions, None)
    }

    /// Length of an even bar, m of arc length.
    pub(in crate::model::fem) fn even(&self) -> f64 {
        self.meshing.even(self.problem.length)
    }

    /// Adapts the barrier's stiffness to the greatest tension: see [`ContactSet::adapt_stiffness`].
    pub(in crate::model::fem) fn adapt_stiffness(&mut self, bounds: [f64; 2], ahead: f64) {
        if !self.meets_nothing() {
            let tension = self.mesh.greatest_tension(&self.motion.positions);
            self.contacts.adapt_stiffness([tension, self.meshing.bar_weight], bounds, ahead);
        }
    }

    /// Adapts the slide at which friction is fully mobilised, for steps without inertia.
    pub(in crate::model::fem) fn adapt_slip(&mut self) {
        let weight = load_scale(&self.problem).0 * self.problem.length;
        let tension = self.mesh.greatest_tension(&self.motion.positions);
        let force = if tension > weight { tension } else { weight };
        self.contacts.set_slip(slip_at_rest(&self.contacts.tuning, &self.problem, force));
    }

    /// True if the cable has contact with itself.
    pub(in crate::model::fem) fn touches_itself(&self) -> bool {
        self.contacts
            .self_contacts
            .smallest_gap(&self.mesh, &self.motion.positions, self.mesh.tuning.contact.reach_m)
            .is_some()
    }

    /// Number of steps without inertia that keep every support's move below half an element.
    pub(in crate::model::fem) fn static_steps(&self, end: f64, dragged: &[Option<Vec2>]) -> f64 {
        let even = self.even();
        let mut most: f64 = 0.0;
        for (k, s) in self.problem.supports.iter().enumerate() {
            if let (Some((at, _)), Some(now)) = (s.position_at(end), self.support_position(k)) {
                let at = dragged.get(k).copied().flatten().unwrap_or(at);
                most = most.max((at - now).norm());
            }
        }
        let max_way = self.mesh.tuning.outline.max_way_m;
        let (now, bodies) = (self.motion.time, self.problem.world.geometry().bodies());
        let way = |post: &MovingPost| (post.center_at(end) - post.center_at(now)).norm();
        // A post goes no farther at once than a support, and than its own radius.
        let steps = |post: &MovingPost| {
            let body = bodies.iter().find(|body| body.obstacle == post.obstacle);
            way(post) / smaller(LONGEST_STATIC_MOVE_BARS * even, body.map_or(f64::INFINITY, |body| body.offset))
        };
        let posts = self.problem.moving_posts.iter().map(steps).fold(0.0, larger);
        let carried = self.outline.as_ref().map_or(0.0, |o| o.pieces(max_way));
        larger(most / (LONGEST_STATIC_MOVE_BARS * even), larger(carried, posts)).ceil().clamp(1.0, MAX_STATIC_STEPS)
    }
}
