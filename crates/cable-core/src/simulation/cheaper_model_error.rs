//! The next cheaper model of a scene at rest leaves out what the model of the answer was chosen
//! for; what their figures differ by is what that choice would have cost in error.

use std::sync::Arc;

use crate::contact::World;
use crate::math::larger;
use crate::model::auto::{self, Question};
use crate::model::{Settings, build};
use crate::problem::Problem;
use crate::solution::{CableSolution, ErrorEstimates, ModelReason, NeglectedEffect, NextCheaper};

/// Supports within this part of the cable's length of their places are there.
const SAME_PLACE_FRACTION: f64 = 1e-9;

/// Returns what the next cheaper choice would have cost; None where a model was not chosen for
/// something that a cheaper one leaves out.
pub(super) fn next_cheaper<'a>(
    cables: impl Iterator<Item = (&'a Problem, &'a CableSolution)>,
    reason: &ModelReason,
    settings: Settings,
) -> Option<NextCheaper> {
    let neglects = neglected_by(reason)?;
    let settings = Settings { histories: false, ..settings };
    let mut found: Option<NextCheaper> = None;
    for (problem, answer) in cables {
        let among_none = problem.world.is_empty() && problem.outline.is_none();
        if !supports_as_in_scene(problem, answer) || (neglects == NeglectedEffect::Obstacles && among_none) {
            return None;
        }
        let simpler = Arc::new(without(problem, neglects));
        let (model, _) = auto::choose(&simpler, Question::Rest);
        let settled = build(auto::built_for(model), simpler, settings).and_then(|mut mechanics| {
            mechanics.settle()?;
            Ok(mechanics.solution())
        });
        let errors = settled.ok().map(|cheaper| {
            let apart = ErrorEstimates::between(&cheaper, answer);
            [apart.relative(answer).unwrap_or(f64::INFINITY), apart.position_m.unwrap_or(f64::INFINITY)]
        });
        let mut next = NextCheaper {
            model,
            neglects,
            force_error: errors.map(|e| e[0]).filter(|e| e.is_finite()),
            position_error_m: errors.map(|e| e[1]).filter(|e| e.is_finite()),
            costs_more: false,
        };
        if let Some(before) = found {
            let worse = |a: Option<f64>, b: Option<f64>| Some(larger(a?, b?));
            next.model = if before.model.rank() > model.rank() { before.model } else { model };
            next.force_error = worse(before.force_error, next.force_error);
            next.position_error_m = worse(before.position_error_m, next.position_error_m);
        }
        found = Some(next);
    }
    found
}

/// Returns whether all supports are where the scene has them: led elsewhere they are another scene.
fn supports_as_in_scene(problem: &Problem, answer: &CableSolution) -> bool {
    let places = problem.supports.iter().zip(&answer.supports).filter_map(|(s, r)| Some((s.at?, r)));
    places.into_iter().all(|(at, r)| (at.x - r.x_m).hypot(at.y - r.y_m) <= SAME_PLACE_FRACTION * problem.length)
}

/// Returns the effect for which a model was chosen, where a cheaper one neglects it.
fn neglected_by(reason: &ModelReason) -> Option<NeglectedEffect> {
    Some(match reason {
        ModelReason::BendingStiffness => NeglectedEffect::BendingStiffness,
        ModelReason::SelfContact => NeglectedEffect::SelfContact,
        ModelReason::FloorFriction => NeglectedEffect::FloorFriction,
        ModelReason::Obstacles | ModelReason::ClearOfItself => NeglectedEffect::Obstacles,
        ModelReason::WheelFriction => NeglectedEffect::WheelFriction,
        ModelReason::Bending { reason, .. } => return neglected_by(reason),
        _ => return None,
    })
}

/// The cable without it.
fn without(problem: &Problem, neglects: NeglectedEffect) -> Problem {
    let mut this = problem.clone();
    this.wheels = None;
    if let Some((by, copy)) = this.similar.take() {
        this.similar = Some((by, Arc::new(without(&copy, neglects))));
    }
    match neglects {
        NeglectedEffect::BendingStiffness => this.bending_stiffness = 0.0,
        NeglectedEffect::SelfContact => this.cable.self_contact = false,
        NeglectedEffect::FloorFriction => this.floor_friction = None,
        NeglectedEffect::Obstacles => {
            this.world = Arc::new(World::new(&[], this.cable.friction, this.radius));
            this.outline = None;
        }
        // A rest has none.
        NeglectedEffect::Inertia => {}
        NeglectedEffect::WheelFriction => this.supports.iter_mut().for_each(|s| s.friction = 0.0),
    }
    this
}
