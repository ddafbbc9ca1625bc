//! The continuation follows an equilibrium through time, and halves load steps that fail.
//!
//! A step solves each section for the new supports and loads, and checks the answer. The path to an
//! instant consists of such steps ([`CableEquilibrium::advance_load`]). If no nearby equilibrium
//! continues the path, the cable slides under a drag to the next one that holds it.

use crate::contact::swept_corners;
use crate::math::{Vec2, larger, smaller};
use crate::model::spans::acceptance::{clearance, equilibrium, tunnelling};
use crate::model::spans::boundary::{LooseSection, Mode};
use crate::model::spans::changes;
use crate::model::spans::contact::{point_load, slack_pocket};
use crate::model::spans::newton::{Converged, Workspace, predict_slip};
use crate::model::spans::section::{BoundaryConditions, CableEquilibrium, CableSection, Failure, tension_loss};
use crate::model::spans::section_layout::{SectionLayout, place_ends};
use crate::model::spans::settings::ContinuationSettings;
use crate::model::spans::slack::{self, LooseShapes};

/// Relative difference below which two forces are the same.
const FORCE_TOLERANCE: f64 = 1e-9;

/// Factor of the drag on a cable that runs away, after a step that was solved. Smaller: the next
/// step fails more often; larger: more steps until the cable rests without a drag. A choice, tuned
/// on no campaign, as are the two below.
const DRAG_DECREASE: f64 = 0.25;
/// Factor of the drag after a step that was solved only after the drag had been raised. Smaller and
/// larger: as above.
const DRAG_DECREASE_AFTER_RAISE: f64 = 0.5;
/// Factor of the drag after a step that failed. Smaller: more steps fail; larger: more steps follow
/// until it has faded.
const DRAG_INCREASE: f64 = 8.0;

/// Factor that lets a step within round-off of the end of the path go to the end.
const END_ROUNDING: f64 = 1.000_001;

/// Cost and events of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model::spans) struct StepStats {
    pub solved: Converged,
    /// Number of halvings.
    pub halvings: usize,
    /// Number of times that the cable ran away to another equilibrium.
    pub runaways: usize,
    /// True if the equilibrium was found without friction, and friction holds it since then.
    pub found_without_friction: bool,
    /// Friction that contacts lacked in the step in which they came down, as a fraction of the
    /// force there.
    pub missing_friction: f64,
}

/// The size of the steps of a path to an instant, as fractions of it.
#[derive(Clone, Copy, Debug)]
struct StepSize<'a> {
    tuned: &'a ContinuationSettings,
    step: f64,
    /// Number of halvings of failed steps that no growth has undone.
    halvings: u32,
    /// Number of successive halvings of steps shorter than those with which a cable that runs away
    /// is followed.
    short_halvings: u32,
    /// True for a history, which needs short steps when a contact comes down; the path to a first
    /// equilibrium does not.
    is_history: bool,
    /// True if the next step is shortened for that.
    shortens: bool,
    /// The step that was solved before it was shortened for that.
    whole_step: Option<f64>,
}

impl<'a> StepSize<'a> {
    fn new(tuned: &'a ContinuationSettings, first: f64) -> Self {
        let is_history = first >= 1.0;
        Self { tuned, step: first, halvings: 0, short_halvings: 0, is_history, shortens: is_history, whole_step: None }
    }

    /// True if a solved step has to be shorter: a contact has no friction in the step in which it
    /// comes down.
    fn is_too_long(&self, stats: &StepStats) -> bool {
        self.shortens
            && stats.missing_friction > self.tuned.missing_friction_fraction
            && self.step > self.tuned.landing_step_fraction
    }

    /// Shortens a step that was solved.
    fn shorten(&mut self) {
        self.whole_step = self.whole_step.or(Some(self.step));
        self.step *= 0.5;
    }

    /// Returns to the step that was solved before it was shortened, because that is better than
    /// none; returns whether there was one.
    fn restore_whole_step(&mut self) -> bool {
        let Some(step) = self.whole_step.take() else { return false };
        (self.shortens, self.step) = (false, step);
        true
    }

    /// Grows after a step that was accepted.
    fn grow(&mut self) {
        (self.shortens, self.whole_step) = (self.is_history, None);
        if self.halvings > 0 || self.step < self.tuned.grown_step {
            self.halvings = self.halvings.saturating_sub(1);
            self.step *= 2.0;
        }
    }

    /// Halves a step that failed.
    fn halve(&mut self) {
        self.halvings += 1;
        self.short_halvings = if self.step < self.tuned.runaway_step_fraction { self.short_halvings + 1 } else { 0 };
        self.step *= 0.5;
    }

    /// True if no shorter step is tried.
    fn is_exhausted(&self) -> bool {
        self.halvings > self.tuned.max_halvings || self.short_halvings > self.tuned.max_short_step_halvings
    }

    /// Begins anew after a cable was followed that ran away.
    fn restart(&mut self) {
        (self.halvings, self.short_halvings, self.step) = (0, 0, self.tuned.runaway_step_fraction);
    }
}

/// The result of a continuation that did not reach its instant.
#[derive(Clone, Debug)]
pub(in crate::model::spans) struct AdvanceFailure {
    /// The reason why it ended.
    pub failure: Failure,
    /// The completed fraction of the path.
    pub done: f64,
}

impl From<AdvanceFailure> for Failure {
    fn from(stopped: AdvanceFailure) -> Self {
        stopped.failure
    }
}

impl CableEquilibrium {
    /// Takes one step to an instant; on an error nothing has changed.
    pub fn step(
        &mut self,
        layout: &SectionLayout,
        to: &BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        self.step_from(layout, to, &[], workspace)
    }

    /// Takes one step to an instant. `routes` are the shapes of the sections from which a first
    /// equilibrium is sought, else empty.
    pub(super) fn step_from(
        &mut self,
        layout: &SectionLayout,
        to: &BoundaryConditions,
        routes: &[Vec<Vec2>],
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        let mut stats = StepStats::default();
        workspace.before.clone_from(&self.sections);
        workspace.instants[0].clone_from(&self.instant);
        self.instant.clone_from(to);
        layout.set_context(&mut self.context, to);
        for k in 0..self.sections.len() {
            match self.solve_section(layout, k, routes.get(k).map(Vec::as_slice), workspace) {
                Ok(one) => stats = stats.plus(one),
                Err(failure) => {
                    self.undo(layout, workspace);
                    return Err(failure);
                }
            }
        }
        if let Err(failure) = equilibrium::balanced(layout, self) {
            self.undo(layout, workspace);
            return Err(failure);
        }
        Ok(stats)
    }

    /// Restores the start of the last step.
    fn undo(&mut self, layout: &SectionLayout, workspace: &Workspace) {
        self.sections.clone_from(&workspace.before);
        self.instant.clone_from(&workspace.instants[0]);
        layout.set_context(&mut self.context, &self.instant);
    }

    /// Solves one section for the present instant; on an error it is unchanged. `route` is the
    /// shape from which a first equilibrium is sought.
    fn solve_section(
        &mut self,
        layout: &SectionLayout,
        k: usize,
        route: Option<&[Vec2]>,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        let [mut start, mut moved] = std::mem::take(&mut workspace.sections);
        start.clone_from(&self.sections[k]);
        let found = self.solve_section_from(layout, k, route, [&mut start, &mut moved], workspace);
        if found.is_err() {
            self.sections[k].clone_from(&start);
        }
        workspace.sections = [start, moved];
        found
    }

    /// As [`Self::solve_section`]; on an error the section is in an undefined state.
    fn solve_section_from(
        &mut self,
        layout: &SectionLayout,
        k: usize,
        route: Option<&[Vec2]>,
        [start, moved]: [&mut CableSection; 2],
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        if self.sections[k].loose.is_some() {
            return self.renew_loose_section(layout, k);
        }
        let solved = self.find_section_equilibrium(layout, k, route, [&mut *start, moved], workspace)?;
        let mut stats = StepStats { solved, ..StepStats::default() };
        if route.is_none() {
            stats.missing_friction = point_load::unremembered_friction(&self.sections[k], &self.context);
        }
        for c in &mut self.sections[k].contacts {
            let contact_path = self.context.contact_path(c).with_cached_piece(c.ends.place[0]);
            if c.is_load() {
                c.ends.place[1] = c.ends.place[0];
            }
            c.history.commit(&contact_path, &c.ends, c.mode, c.stick_zone, &mut workspace.past);
            // Contacts that came down in this step have friction from now on.
            if c.smooth && route.is_none() {
                c.smooth = false;
                c.mode = if self.context.curves[c.curve].friction > 0.0 { Mode::Stick } else { c.mode };
            }
        }
        equilibrium::verify(&self.sections[k], &self.context)?;
        clearance::verify(&self.sections[k], &self.context, &layout.problem.world)?;
        if !layout.problem.world.is_empty() && route.is_none() {
            self.refuse_passing(layout, k, start, workspace)?;
        }
        Ok(stats)
    }

    /// Finds the equilibrium of one section: from its shape with the predicted slip; else from the
    /// solution of each span by itself; else with the spans of least tension turned into pockets,
    /// because they may have lost their tension.
    fn find_section_equilibrium(
        &mut self,
        layout: &SectionLayout,
        k: usize,
        route: Option<&[Vec2]>,
        [start, moved]: [&mut CableSection; 2],
        workspace: &mut Workspace,
    ) -> Result<Converged, Failure> {
        let world = &layout.problem.world;
        let section = &mut self.sections[k];
        place_ends(layout, k, section, &self.context, &self.instant)?;
        moved.clone_from(section);
        if route.is_none() && self.context.mobilised == 0.0 {
            predict_slip(section, &self.context, &mut workspace.slip_predictor);
        }
        let mut found = changes::solve(section, &mut self.context, world, &layout.corners, route, workspace);
        if found.is_err() {
            section.clone_from(moved);
            let mut other = route.is_none();
            for j in 0..section.spans() {
                if section.has_span(j)
                    && let Some(g) = section.solve_span(&self.context, j)
                {
                    other |= (section.forces[j] - g).norm() > FORCE_TOLERANCE * g.norm();
                    section.forces[j] = g;
                }
            }
            if other {
                found = changes::solve(section, &mut self.context, world, &layout.corners, route, workspace);
            }
        }
        if found.is_err() {
            // Of the spans with hardly any tension left, first the one with the least is tried,
            // then the two least …
            let mut loose = Vec::new();
            slack_pocket::candidates(start, &self.context, &mut loose);
            for n in 1..=loose.len().min(layout.settings.continuation.max_pockets) {
                section.clone_from(moved);
                for (_, k) in &loose[..n] {
                    slack_pocket::fill(section, &self.context, *k);
                }
                let again = changes::solve(section, &mut self.context, world, &layout.corners, route, workspace);
                if again.is_ok() {
                    found = again;
                    break;
                }
            }
        }
        found
    }

    /// Returns an error if a section has passed through a corner since the shape `start`.
    fn refuse_passing(
        &mut self,
        layout: &SectionLayout,
        k: usize,
        start: &CableSection,
        workspace: &mut Workspace,
    ) -> Result<(), Failure> {
        // The shape before the step is computed with the old load and lengths: with the new ones,
        // spans of a cable that is paid out or loaded in this step would end beside their contacts.
        let was = &workspace.instants[0];
        let other =
            was.load != self.instant.load || was.thermal != self.instant.thermal || was.forces != self.instant.forces;
        if !other && tunnelling::is_clear(start, &self.sections[k], &self.context, &layout.corners) {
            return Ok(());
        }
        let [old, new] = &mut workspace.shapes;
        if other {
            layout.set_context(&mut self.context, &workspace.instants[0]);
        }
        tunnelling::shape(start, &self.context, old);
        if other {
            layout.set_context(&mut self.context, &self.instant);
        }
        tunnelling::shape(&self.sections[k], &self.context, new);
        match swept_corners::through(&layout.corners, old, new, &mut workspace.turns) {
            Some(corner) => Err(Failure::Tunnelled { at: corner.at }),
            None => Ok(()),
        }
    }

    /// Lays a loose section anew while its supports stay where they are. Moving supports would drag
    /// its folds over the ground, and the force for that is not modelled.
    fn renew_loose_section(&mut self, layout: &SectionLayout, k: usize) -> Result<StepStats, Failure> {
        let found = slack::loose_section(layout, k, &self.context, &self.instant, LooseShapes::AnyTension);
        let section = &mut self.sections[k];
        let Some(found) = found.filter(|f| f.end_conditions == section.end_conditions) else {
            return Err(Failure::SlackDragged { s: section.from });
        };
        *section = found;
        Ok(StepStats::default())
    }

    /// Length of the loose material and of the ground on which it lies, m; None if there is none.
    pub fn loose_lengths(&self) -> Option<[f64; 2]> {
        let lengths = self.sections.iter().filter_map(|s| s.loose.as_ref()).map(|l| l.lying_lengths(&self.context));
        lengths.reduce(|[a, b], [c, d]| [a + c, b + d])
    }

    /// Greatest friction force on loose cable, N.
    pub fn friction_of_loose(&self) -> f64 {
        self.sections.iter().filter_map(|s| s.loose.as_ref()).map(|l| l.friction(&self.context)).sum()
    }

    /// Advances to an instant that no nearby equilibrium leads to: the cable slides under a drag
    /// that is reduced as it comes to rest.
    ///
    /// Each step is one of implicit Euler for η ds/dt = T₂ − T₁, in which the energy falls; η is
    /// lowered as far as possible (pseudo-transient continuation: C. T. Kelley and D. E. Keyes,
    /// SIAM J. Numer. Anal. 35, 1998).
    fn pseudo_transient_continuation(
        &mut self,
        layout: &SectionLayout,
        to: &BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        let tuned = &layout.settings.continuation;
        let (before, old) = (self.sections.clone(), self.instant.clone());
        let size = to.load.norm();
        let (mut drag, mut stats, mut raised) = (tuned.drag_factor * size, StepStats::default(), 0);
        let mut pushed = None;
        for _ in 0..layout.settings.changes.max_changes {
            self.context.drag = drag;
            let result = self.step(layout, to, workspace);
            self.context.drag = 0.0;
            match result {
                Ok(t) => {
                    pushed = None;
                    stats = stats.plus(t);
                    drag *= if raised > 0 { DRAG_DECREASE_AFTER_RAISE } else { DRAG_DECREASE };
                    raised = 0;
                    if drag < tuned.drag_factor * tuned.rest_drag_fraction * size
                        && let Ok(t) = self.step(layout, to, workspace)
                    {
                        return Ok(stats.plus(t));
                    }
                }
                Err(failure) => {
                    pushed = matches!(failure, Failure::Compressed { .. }).then_some(failure);
                    drag *= DRAG_INCREASE;
                    raised += 1;
                }
            }
            if raised > tuned.max_drag_raises {
                break;
            }
        }
        self.sections = before;
        layout.set_context(&mut self.context, &old);
        self.instant = old;
        Err(pushed.unwrap_or(Failure::ContactCycling { s: 0.0 }))
    }

    /// The failure that explains best why a step was not taken: that of the step itself, or that of
    /// the cable under a drag if it would be compressed.
    fn failure_to_report(&self, step: Failure, held_back: Failure) -> Failure {
        let found_nothing = matches!(step, Failure::Stalled { .. } | Failure::ContactCycling { .. });
        let pushes = matches!(held_back, Failure::Compressed { .. });
        if found_nothing && pushes && tension_loss::find(&self.sections, &self.context, &step).is_none() {
            held_back
        } else {
            step
        }
    }

    /// Gives a loose cable a very small tension when it begins to be drawn, because only a cable in
    /// tension can be followed: with a free end along its route; held at both ends and drawn over
    /// crests, with the surplus in a kink.
    fn tension_loose_sections(&mut self, layout: &SectionLayout, to: &BoundaryConditions, workspace: &mut Workspace) {
        if self.loose_lengths().is_none() || self.instant.places == to.places {
            return;
        }
        let has_both_ends = |k: usize| layout.sections[k].supports.iter().all(Option::is_some);
        let spreads = |k: usize| self.sections[k].loose.as_ref().is_some_and(LooseSection::spreads);
        let all =
            |of: &dyn Fn(usize) -> bool| (0..self.sections.len()).all(|k| self.sections[k].loose.is_none() || of(k));
        let instant = self.instant.clone();
        let taut = if all(&|k| spreads(k) && !has_both_ends(k)) {
            let mut taut = self.clone();
            taut.place_in_tension(layout, &instant, workspace).ok().map(|_| taut)
        } else if all(&|k| !spreads(k) && has_both_ends(k)) {
            Self::along_route(layout, &instant, workspace).ok().map(|(taut, _)| taut)
        } else {
            None
        };
        if let Some(taut) = taut {
            *self = taut;
        }
    }

    /// Advances to an instant in steps; the first one is the fraction `first` of the path. A failed
    /// step is halved.
    pub fn advance_load(
        &mut self,
        layout: &SectionLayout,
        to: &BoundaryConditions,
        first: f64,
        workspace: &mut Workspace,
    ) -> Result<StepStats, AdvanceFailure> {
        self.tension_loose_sections(layout, to, workspace);
        let [old, mut from, mut at] = std::mem::take(&mut workspace.instants);
        workspace.instants[0] = old;
        from.clone_from(&self.instant);
        let found = self.advance_load_from(layout, &from, to, &mut at, first, workspace);
        let old = std::mem::take(&mut workspace.instants[0]);
        workspace.instants = [old, from, at];
        found
    }

    /// As [`Self::advance_load`], with the instants of both ends, and working memory for those
    /// between them.
    fn advance_load_from(
        &mut self,
        layout: &SectionLayout,
        from: &BoundaryConditions,
        to: &BoundaryConditions,
        at: &mut BoundaryConditions,
        first: f64,
        workspace: &mut Workspace,
    ) -> Result<StepStats, AdvanceFailure> {
        let tuned = &layout.settings.continuation;
        let (mut done, mut stats) = (0.0, StepStats::default());
        let mut size = StepSize::new(tuned, first);
        while done < 1.0 {
            let next = if done + END_ROUNDING * size.step >= 1.0 { 1.0 } else { done + size.step };
            at.between(from, to, next);
            let failure = match self.step(layout, at, workspace) {
                Ok(t) if size.is_too_long(&t) => {
                    self.undo(layout, workspace);
                    size.shorten();
                    stats.halvings += 1;
                    continue;
                }
                Ok(t) => {
                    size.grow();
                    (stats, done) = (stats.plus(t), next);
                    continue;
                }
                Err(failure) => {
                    if size.restore_whole_step() {
                        continue;
                    }
                    failure
                }
            };
            size.halve();
            stats.halvings += 1;
            if size.is_exhausted() {
                // No nearby equilibrium holds the cable: it runs away to the next one that does.
                let next = smaller(done + tuned.runaway_step_fraction, 1.0);
                at.between(from, to, next);
                let slid = self.pseudo_transient_continuation(layout, at, workspace);
                let slid = slid.map_err(|held_back| AdvanceFailure {
                    failure: self.failure_to_report(failure, held_back),
                    done,
                })?;
                (stats, done) = (stats.plus(slid), next);
                stats.runaways += 1;
                size.restart();
            }
        }
        Ok(stats)
    }
}

impl StepStats {
    /// The sum of these statistics and those of another step.
    pub fn plus(self, more: Self) -> Self {
        Self {
            solved: self.solved.plus(more.solved),
            halvings: self.halvings + more.halvings,
            runaways: self.runaways + more.runaways,
            found_without_friction: self.found_without_friction || more.found_without_friction,
            missing_friction: larger(self.missing_friction, more.missing_friction),
        }
    }
}

impl Converged {
    fn plus(self, more: Self) -> Self {
        Self {
            iterations: self.iterations + more.iterations,
            residual: if more.residual > self.residual { more.residual } else { self.residual },
        }
    }
}
