//! This module finds the static equilibrium of a cable in contact: from its first shape through the
//! search to the polish of the result.

use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::{Vec2, larger};
use crate::model::fem::equilibrium::lagged_friction::rounding_of_bars;
use crate::model::fem::equilibrium::relaxation::moved_away;
use crate::model::fem::first_shape::{bow, depenetrate};
use crate::model::fem::mesh::{Mesh, PUSHED_OUT_REACHES};
use crate::model::fem::obstacle::{IntersectionCheck, prepare_way, put_outline};
use crate::model::fem::results;
use crate::model::fem::state::{CableState, prepare_input};
use crate::model::fem::stepper::Stepper;
use crate::model::fem::system::{Converged, Failure, FailureCause, load_scale, tolerance};
use crate::model::{Model, StepReport};
use crate::state::State;

/// Returns the reason why a cable held by friction alone does not rest in its present place: the
/// forces that may be left unbalanced at single nodes add up.
pub(in crate::model::fem) fn slides_as_a_whole(cable: &CableState) -> Option<NoEquilibrium> {
    if cable.problem.supports.iter().any(|s| s.at.is_some()) || cable.contacts.self_contacts.shape.is_on() {
        return None;
    }
    let left = results::forces::unbalanced(cable, &cable.motion.positions, cable.motion.time).norm();
    let scale = load_scale(&cable.problem).1;
    (left > cable.mesh.tuning.equilibrium.unheld_load_fraction * scale)
        .then_some(NoEquilibrium::UnheldForce { left_n: left, loads_n: scale })
}

/// True if two bars of a cable at positions `x` (m) cross.
fn crosses_itself(mesh: &Mesh, x: &[Vec2]) -> bool {
    !crate::contact::self_crossings::crossings(x, |e| !mesh.is_break(e)).is_empty()
}

impl Stepper {
    /// Reduces the residual of an equilibrium, which adds up along the cable, to the level of
    /// round-off. It starts from the present shape, and changes nothing where it does not converge
    /// or friction would not be lawful.
    pub(in crate::model::fem) fn polish(&mut self, found: Converged, dragged: &[Option<Vec2>]) -> Converged {
        let outer_rollback = self.rollback.with_saved();
        let (exact, to) = (self.cable.input.stopping.tolerance, self.cable.motion.time);
        let rounding = rounding_of_bars(&self.cable);
        let mut all = found;
        let tuning = self.cable.mesh.tuning.equilibrium;
        let stages = [
            (1.0, tuning.polish_iterations),
            (tuning.polish_residual.sqrt(), tuning.max_iterations),
            (tuning.polish_residual, tuning.max_iterations),
        ];
        for (part, iterations) in stages {
            self.rollback.save(&self.cable);
            if prepare_way(&mut self.cable, [to, to], Some(dragged)).is_err() {
                self.rollback.restore(&mut self.cable);
                break;
            }
            self.cable.input.stopping.max_noise = exact;
            (self.cable.input.stopping.tolerance, self.cable.input.stopping.max_iterations) =
                (larger(part * exact, rounding), iterations);
            let mut unknowns = self.solver.present_unknowns(&self.cable);
            let Ok(done) = self.solver.solve_lawfully(&mut self.cable, &mut unknowns) else {
                self.rollback.restore(&mut self.cable);
                break;
            };
            all = Converged { iterations: all.iterations + done.iterations, ..done };
            // The bars stay as they are in balance: new ones would have to be brought to rest
            // again.
            self.accept_unknowns(&unknowns, to);
        }
        self.cable.input.stopping.tolerance = exact;
        self.rollback = outer_rollback;
        all
    }

    /// Brings straight bars to rest that were placed along the sagging bars of statics. Their
    /// positions change to the second order in the bar length; without this a run would begin with
    /// a jerk. If they do not come to rest, they stay where they were placed; returns whether they
    /// did.
    pub(in crate::model::fem) fn come_to_rest(&mut self, dragged: &[Option<Vec2>]) -> bool {
        if !self.rested {
            return false;
        }
        self.rollback.save(&self.cable);
        let reach = self.cable.problem.length / self.cable.meshing.even_bars as f64;
        let first_positions = self.cable.motion.positions.clone();
        let found = self.quasi_static_step(self.cable.motion.time, dragged).is_ok();
        let near = |(a, b): (&Vec2, &Vec2)| (a - b).norm() <= reach;
        let is_near = found
            && first_positions.len() == self.cable.motion.positions.len()
            && first_positions.iter().zip(&self.cable.motion.positions).all(near);
        if !is_near {
            self.rollback.restore(&mut self.cable);
        }
        is_near
    }

    /// Finds the equilibrium with contact at the present time; `dragged` are the hand-set support
    /// positions, m.
    ///
    /// # Errors
    /// A typed reason when there is none, or none was found.
    pub fn settle(&mut self, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        self.cable.check_supported()?;
        self.time_control.sleep.wake();
        self.cable.answers.lagging_supports.clear();
        self.rollback.save(&self.cable);
        self.cable.motion.followers.fill(None);
        self.cable.approach_edit(1.0);
        self.cable.motion.hands.fill(None);
        if !self.rested && put_outline(&mut self.cable) {
            let mut x = std::mem::take(&mut self.cable.motion.positions);
            depenetrate(
                &self.cable.problem,
                &self.cable.mesh,
                &mut x,
                PUSHED_OUT_REACHES * self.cable.contacts.barrier.reach,
            );
            self.cable.motion.positions = x;
            self.forget_history();
        }
        match self.find_equilibrium(dragged)? {
            Ok(done) => {
                self.rested = true;
                let done = self.polish(done, dragged);
                Ok(self.report(done, 0, 0.0))
            }
            Err(f) => {
                let at_m = self.cable.motion.positions.get(f.node).copied().unwrap_or_default();
                let sought = self.cable.motion.positions.clone();
                self.rollback.restore(&mut self.cable);
                if moved_away(self.cable.problem.length, &self.cable.motion.positions, &sought).is_some() {
                    return Err(SolveError::NoRestingPlace { why: NoEquilibrium::SlidesOff });
                }
                if f.cause == FailureCause::WorkSpent {
                    let (model, segments) = (Model::Fem, self.cable.mesh.rest_length.len());
                    let iterations = self.cable.mesh.tuning.equilibrium.max_work / self.cable.mesh.nodes().max(1);
                    let (residual_n, place) = (f.residual, self.cable.place(f.node));
                    return Err(SolveError::TooMuchWork { model, iterations, segments, residual_n, place });
                }
                if let Some(why) = IntersectionCheck::at(&self.cable, &sought).obstacle_run_through() {
                    return Err(SolveError::NoRestingPlace { why });
                }
                let arc_length = self.cable.mesh.arc_length.get(f.node).copied().unwrap_or(f64::NAN);
                let place = self.cable.problem.place(arc_length, at_m, self.cable.motion.time);
                Err(SolveError::NotConverged {
                    model: Model::Fem,
                    iterations: self.cable.mesh.tuning.equilibrium.max_relaxation_steps,
                    residual_n: f.residual,
                    place,
                })
            }
        }
    }

    /// Starts from `shape`, an equilibrium without contact, if the cable can get there from its
    /// first shape without coming near an obstacle. Relaxation with contact would take as many
    /// rounds as a hanging cable has bars.
    pub(in crate::model::fem) fn start_from_shape(&mut self, shape: &State, dragged: &[Option<Vec2>]) {
        let touched = self.cable.problem.floor_friction.is_some() || self.cable.contacts.self_contacts.shape.is_on();
        let alone = self.cable.outline.is_none() && !touched && !self.cable.problem.world.is_empty();
        if self.rested || !alone || self.cable.mesh.sliding.iter().any(Option::is_some) {
            return;
        }
        let Some(to) = self.cable.mesh.arc_length.iter().map(|&s| shape.position_at(s)).collect::<Option<Vec<Vec2>>>()
        else {
            return;
        };
        let (x, geometry) = (&self.cable.motion.positions, self.cable.problem.world.geometry());
        let clear = (0..self.cable.mesh.rest_length.len()).all(|e| {
            let [[a, b], [c, d]] = [self.cable.mesh.straight(e, x), self.cable.mesh.straight(e, &to)];
            geometry
                .parts(a.inf(&b).inf(&c.inf(&d)), a.sup(&b).sup(&c.sup(&d)), self.cable.contacts.barrier.reach)
                .next()
                .is_none()
        });
        if !clear {
            return;
        }
        self.cable.motion.positions = to;
        self.forget_history();
        // The bars here are straight. The missing sag between nodes makes their tensions wrong, but
        // evenly, so little unbalanced force is left.
        let now = self.cable.motion.time;
        prepare_input(&mut self.cable, now, Some(dragged));
        self.cable.input.stopping.max_iterations = self.cable.mesh.tuning.equilibrium.max_iterations;
        let exact = self.cable.input.stopping.tolerance;
        self.cable.input.stopping.tolerance = tolerance(&self.cable.problem, 0.0);
        let mut unknowns = self.solver.present_unknowns(&self.cable);
        if self.solver.free.solve(&self.cable.mesh, &self.cable.input, &mut unknowns).is_some() {
            self.cable.motion.positions.clone_from(&unknowns.positions);
            self.forget_history();
        }
        self.solver.unknowns = unknowns;
        self.cable.input.stopping.tolerance = exact;
    }

    /// Finds the equilibrium. Since the first shape may cross itself, an equilibrium without
    /// self-contact is first sought as if the cable could pass through itself.
    fn find_equilibrium(&mut self, dragged: &[Option<Vec2>]) -> Result<Result<Converged, Failure>, SolveError> {
        let time = self.cable.motion.time;
        if !self.cable.contacts.self_contacts.shape.is_on() {
            return Ok(self.relax(time, dragged));
        }
        if !self.rested {
            let diameter = std::mem::replace(&mut self.cable.contacts.self_contacts.shape.diameter, 0.0);
            let found = self.relax(time, dragged);
            self.cable.contacts.self_contacts.shape.diameter = diameter;
            if found.is_ok()
                && !self.cable.touches_itself()
                && !crosses_itself(&self.cable.mesh, &self.cable.motion.positions)
            {
                return Ok(found);
            }
            self.rollback.restore(&mut self.cable);
            self.rollback.save(&self.cable);
            self.start_on_an_arc();
        }
        let overlap =
            self.cable.contacts.self_contacts.smallest_gap(&self.cable.mesh, &self.cable.motion.positions, 0.0);
        if overlap.is_some() || crosses_itself(&self.cable.mesh, &self.cable.motion.positions) {
            let arc_length_m = self.cable.mesh.arc_length[overlap.map_or(0, |o| o.1)];
            let feature = Unsupported::SelfContactAtStart { arc_length_m };
            return Err(SolveError::Unsupported { model: Model::Fem, feature });
        }
        Ok(self.relax(time, dragged))
    }

    /// A cable with much slack and no drawn route starts on an arc, where it does not touch itself.
    /// Along a straight line it would, or its bars would stand upright in a row under compression.
    fn start_on_an_arc(&mut self) {
        let cable = &mut self.cable;
        let way: f64 = cable.motion.positions.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        if !cable.problem.cable.route_m.is_empty()
            || cable.problem.length < cable.mesh.tuning.start.arc_length_ratio * way
        {
            return;
        }
        let Some(arc) = bow(&cable.problem, &cable.mesh, &cable.motion.positions) else { return };
        let straight = std::mem::replace(&mut cable.motion.positions, arc);
        for k in (0..straight.len()).filter(|&k| cable.mesh.fixity[k]) {
            cable.motion.positions[k] = straight[k];
        }
        if IntersectionCheck::of(cable).cuts_nothing() {
            cable.forget_history();
        } else {
            cable.motion.positions = straight;
        }
    }
}
