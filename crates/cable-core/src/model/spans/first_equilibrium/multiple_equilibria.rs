//! A slack cable without friction may have several equilibria, some of them unstable. This module
//! leaves unstable ones and finds the others.
//!
//! A hanging loop pulls harder the longer it is, so slack may rest on either side of a contact. The
//! cable leaves one equilibrium for another by sliding under a drag.

use crate::math::{bounded, larger, smaller};
use crate::model::spans::continuation::StepStats;
use crate::model::spans::initial::section_along_route;
use crate::model::spans::newton::{self, Workspace};
use crate::model::spans::section::{BoundaryConditions, CableEquilibrium, Failure};
use crate::model::spans::section_layout::SectionLayout;

/// Factor of the drag after a step that failed.
const DRAG_RISE: f64 = 8.0;

/// Least factor of the drag after a step; the drag falls with the remaining force.
const LEAST_DRAG_FALL: f64 = 0.25;

/// A length of material that is moved past one contact.
#[derive(Clone, Copy, Debug)]
struct SlackMove {
    /// Index of the contact among those of all sections.
    contact: usize,
    /// Material that is moved along the cable past the contact, m.
    passed_on_m: f64,
}

impl CableEquilibrium {
    /// Leaves an unstable equilibrium for a stable one; a stable one is kept, and on an error
    /// nothing has changed.
    pub fn leave_unstable(
        &mut self,
        layout: &SectionLayout,
        to: &BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        if self.is_stable(workspace) {
            return Ok(StepStats::default());
        }
        let by = layout.settings.continuation.leaving_fraction * layout.problem.length;
        let before = self.clone();
        self.slide_from(layout, to, |_| by, workspace).inspect_err(|_| {
            *self = before;
            layout.set_context(&mut self.context, to);
        })
    }

    /// Finds other equilibria of a slack cable without friction. Slack is moved from each side of
    /// each contact to the other, and again from each equilibrium found in this way.
    pub fn other_equilibria(&self, layout: &SectionLayout, workspace: &mut Workspace) -> Vec<Self> {
        let tuned = &layout.settings.continuation;
        let mut found = vec![self.clone()];
        let (mut from, mut tries) = (0, 0);
        while let Some(base) = found.get(from).cloned() {
            for SlackMove { contact, passed_on_m } in base.moves_of_slack(layout) {
                if tries == tuned.max_other_equilibria {
                    break;
                }
                tries += 1;
                let (mut other, to) = (base.clone(), base.instant.clone());
                let moved = |k: usize| if k == contact { passed_on_m } else { 0.0 };
                if other.slide_from(layout, &to, moved, workspace).is_ok()
                    && !found.iter().any(|f| f.is_same_balance(&other, layout))
                {
                    found.push(other);
                }
            }
            from += 1;
        }
        found.split_off(1)
    }

    /// The moves that bring the slack of either side of a contact to the other, at contacts with
    /// hanging cable on both sides.
    fn moves_of_slack(&self, layout: &SectionLayout) -> Vec<SlackMove> {
        let least = layout.settings.continuation.least_slack_fraction;
        let mut moves = Vec::new();
        let mut index = 0;
        for section in &self.sections {
            for j in 0..section.contacts.len() {
                let slack = [j, j + 1].map(|k| section.has_span(k).then(|| section.slack(&self.context, k)).flatten());
                if let [Some([before, near]), Some([after, far])] = slack
                    && before + after > least * smaller(near, far)
                {
                    let lengths = [(1.0 - least) * after, -(1.0 - least) * before];
                    moves.extend(lengths.map(|passed_on_m| SlackMove { contact: index, passed_on_m }));
                }
                index += 1;
            }
        }
        moves
    }

    /// True if two equilibria have the same material at the same contacts.
    fn is_same_balance(&self, other: &Self, layout: &SectionLayout) -> bool {
        let near = layout.settings.continuation.other_balance_fraction * layout.problem.length;
        let [here, there] = [self, other].map(Self::material_at_contacts);
        here.len() == there.len() && here.iter().zip(&there).all(|(a, b)| (a - b).abs() <= near)
    }

    /// Lets the cable slide to a stable equilibrium under a drag, after the material at each
    /// contact was moved by a length, m; on an error its state is undefined.
    ///
    /// The drag is lowered as the remaining forces fall, and stays while they grow (switched
    /// evolution relaxation: W. A. Mulder and B. van Leer, J. Comput. Phys. 59, 1985).
    fn slide_from(
        &mut self,
        layout: &SectionLayout,
        to: &BoundaryConditions,
        passed_on_m: impl Fn(usize) -> f64,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        let tuned = &layout.settings.continuation;
        let size = to.load.norm();
        let (mut drag, mut stats, mut left) = (tuned.leaving_drag_factor * size, StepStats::default(), None);
        let mut raised = 0;
        for (k, c) in self.sections.iter_mut().flat_map(|s| &mut s.contacts).enumerate() {
            let by = passed_on_m(k);
            c.history.shift_material(by);
            c.ends.material = c.ends.material.map(|s| s + by);
        }
        for section in &mut self.sections {
            section_along_route::solve_spans(section, &self.context)
                .ok_or(Failure::ContactCycling { s: section.from })?;
        }
        for _ in 0..layout.settings.changes.max_changes {
            let materials = self.material_at_contacts();
            self.context.drag = drag;
            let result = self.step(layout, to, workspace);
            self.context.drag = 0.0;
            let Ok(one) = result else {
                if raised == tuned.max_drag_raises {
                    break;
                }
                (drag, raised) = (DRAG_RISE * drag, raised + 1);
                continue;
            };
            (stats, raised) = (stats.plus(one), 0);
            let slips = self.material_at_contacts().into_iter().zip(materials).map(|(a, b)| (a - b).abs());
            let force = drag * slips.fold(0.0, larger);
            drag *= left.map_or(1.0, |left| bounded(force / left, LEAST_DRAG_FALL, 1.0));
            left = Some(force);
            if drag < tuned.drag_factor * tuned.rest_drag_fraction * size
                && let Ok(one) = self.step(layout, to, workspace)
                && self.is_stable(workspace)
            {
                return Ok(stats.plus(one));
            }
        }
        Err(Failure::ContactCycling { s: 0.0 })
    }

    /// Material at the start of each contact, m.
    fn material_at_contacts(&self) -> Vec<f64> {
        self.sections.iter().flat_map(|s| &s.contacts).map(|c| c.ends.material[0]).collect()
    }

    /// True if the equilibrium of every section is stable.
    pub fn is_stable(&self, workspace: &mut Workspace) -> bool {
        self.sections.iter().all(|s| newton::stable(s, &self.context, workspace))
    }
}
