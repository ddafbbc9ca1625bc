//! Friction, and pulleys, leave many equilibria (static indeterminacy): a warning says so, with the
//! tensions that other loading histories would have left.

use std::sync::Arc;

use super::{Simulation, loading_histories};
use crate::model::Settings;
use crate::model::catenary::other_equilibria;
use crate::model::initial_equilibrium::initial_equilibrium;
use crate::problem::Problem;
use crate::solution::{Histories, ShownEquilibrium, Warning, WarningCause, WarningKind};

impl Simulation {
    /// Warns of equilibria that are one of many: of every cable that friction holds, whichever
    /// model answered, with the tensions that other histories leave where `spans` finds them; and
    /// of cables without friction that slide over pulleys, where there are several.
    pub(super) fn warn_not_unique(&mut self) {
        for (k, (cable, answer)) in self.cables.iter().zip(&self.answers).enumerate() {
            let problem = cable.problem();
            let name = &problem.cable.name;
            let of_cable = |w: &Warning| w.kind == WarningKind::NotUnique && w.cable == *name;
            let many_equilibria = |histories: Histories| {
                let cause = WarningCause::ManyEquilibria { shown: ShownEquilibrium::FromRoute, histories };
                Warning::new(cause, name, 0.0, [0.0; 2])
            };
            if !problem.rubs(answer) {
                if !self.warnings.iter().any(of_cable) && cable.breaks().is_empty() {
                    let others = other_equilibria(problem, answer, cable.time_s());
                    self.warnings.extend(others.map(many_equilibria));
                }
                continue;
            }
            let rest = |problem: &Arc<Problem>| {
                let rest = initial_equilibrium(problem, Settings::default(), &[], None).ok()??;
                rest.warnings.into_iter().find(of_cable)
            };
            // A cable that leaves a wheel is laid over posts in their place.
            let posts = || rest(&problem.wheels.as_ref()?.all_as_posts()?.problem);
            let refused = loading_histories::refused_by_spans(cable);
            let whole = || if refused { None } else { rest(&Arc::new(problem.clone())) };
            let seek = || whole().or_else(posts);
            let known = self.warnings.iter().position(|w| of_cable(w) && w.cause.histories().is_some());
            if known.is_none() && self.warnings.iter().any(of_cable) {
                continue;
            }
            // A model that has chosen says which it shows; what others there are is asked here.
            let at = known.unwrap_or_else(|| {
                self.warnings.push(many_equilibria(Histories::NotSought));
                self.warnings.len() - 1
            });
            let unknown = self.warnings[at].cause.histories() == Some(&Histories::NotSought);
            let sought = if unknown && self.settings.histories { seek() } else { None };
            let others = || if self.settings.histories { self.other_histories(k) } else { None };
            let found = match (known, sought) {
                (None, Some(sought)) => {
                    self.warnings[at] = sought;
                    None
                }
                (_, Some(sought)) => sought.cause.histories().cloned(),
                (_, None) if unknown => others(),
                (_, None) => None,
            };
            let cause = &mut self.warnings[at].cause;
            let histories = found.or_else(|| cause.histories().cloned());
            if let (Some(histories), WarningCause::ManyEquilibria { histories: shown_histories, .. }) =
                (histories, cause)
            {
                *shown_histories = histories.beside(answer);
            }
        }
    }

    /// Other histories of a cable for which `spans` has no answer; None where they cannot be
    /// sought.
    fn other_histories(&self, k: usize) -> Option<Histories> {
        let explored = loading_histories::exploration_copy(self.cables.get(k)?)?;
        Some(loading_histories::other_histories(&explored, |other| {
            let mut answers = self.answers.clone();
            answers[k].clone_from(other);
            self.verify(&answers).is_sound()
        }))
    }
}
