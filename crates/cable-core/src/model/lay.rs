//! How a cable is first laid: as `spans` lays it, with the least sliding, whoever goes on from there.

use std::sync::Arc;

use super::spans::SpansModel;
use super::{Mechanics, Settings};
use crate::contact::outline::Placement;
use crate::error::SolveError;
use crate::math::Vec2;
use crate::problem::{Problem, SupportPoint};
use crate::solution::{CableSolution, Node, Warning, WarningKind};

/// A cable this near to the robot is answered by the model that knows of it, m. Less: a step passes it unseen.
const ROOM_M: f64 = 0.02;
/// An answer of `spans` at rest that is this deep in an obstacle is none, m. Less: chords across round things are; more: a slack
/// cable that hangs in the ground is shown.
const BURIED_M: f64 = 0.02;
/// How deep is looked, m: what is deeper came in somewhere.
const DEEPEST_M: f64 = 0.5;

/// A first rest.
#[derive(Clone, Debug)]
pub struct Lay {
    /// The cable there.
    pub answer: CableSolution,
    /// What there is to say of it.
    pub warnings: Vec<Warning>,
}

/// Where the cable comes to lie with the least sliding, supports `dragged` (m) and the robot led to where it is; None where `spans`
/// does not know.
///
/// # Errors
/// That it slides from where it is laid.
pub fn least_sliding(
    problem: &Arc<Problem>,
    settings: Settings,
    (dragged, led): (&[Option<Vec2>], Option<Placement>),
) -> Result<Option<Lay>, SolveError> {
    let Ok(mut spans) = SpansModel::new(laid_flexible(problem), settings) else { return Ok(None) };
    for (k, at) in dragged.iter().enumerate() {
        if let Some(at) = at {
            spans.drag_support(k, *at);
        }
    }
    let warnings = match spans.settle() {
        Ok(report) => report.warnings,
        Err(slides @ SolveError::NoRestingPlace { .. }) => return Err(slides),
        Err(_) => return Ok(None),
    };
    let answer = spans.solution();
    let clear = !meets_outline(problem, led, &answer) && !is_buried(problem, &answer);
    Ok(clear.then_some(Lay { answer, warnings }))
}

/// Whether a flexible cable that slid from where it was laid slides on from where it is said to rest: that was no rest then.
#[must_use]
pub fn slides_on(problem: &Arc<Problem>, settings: Settings, answer: &CableSolution) -> bool {
    let route = answer.nodes.iter().map(Node::at).collect();
    let there = Arc::new(Problem { route, ..Problem::clone(&Problem::without_outline(problem.clone())) });
    let slides = least_sliding(&there, settings, (&[], None));
    problem.bending_stiffness == 0.0 && matches!(slides, Err(SolveError::NoRestingPlace { .. }))
}

/// What there is to say of a rest that was found where a cable slid to.
#[must_use]
pub fn slid_first(problem: &Problem, slides: &SolveError) -> Warning {
    let message = format!("This is not where the cable was laid: from there {slides}. How it moved there is not shown");
    Warning::new(WarningKind::Stabilised, &problem.cable.name, 0.0, [0.0; 2], message)
}

/// The cable as `spans` can lay it: without the robot, which moves; a stiff one as a flexible one, it bends from there; and supports that
/// let go later hold it.
fn laid_flexible(problem: &Arc<Problem>) -> Arc<Problem> {
    let plain = Problem::without_outline(problem.clone());
    let lets_go = |s: &SupportPoint| s.release.is_some_and(|t| t > 0.0);
    if plain.bending_stiffness == 0.0 && !plain.supports.iter().any(lets_go) {
        return plain;
    }
    let mut flexible = Problem { bending_stiffness: 0.0, ..Problem::clone(&plain) };
    for support in flexible.supports.iter_mut().filter(|s| lets_go(s)) {
        support.release = None;
    }
    Arc::new(flexible)
}

/// Whether the cable is in touch with the robot, or in its place.
#[must_use]
pub fn meets_outline(problem: &Problem, led: Option<Placement>, answer: &CableSolution) -> bool {
    let (Some(outline), Some(at)) = (&problem.outline, led) else { return false };
    !outline.is_clear(at, answer.nodes.iter().map(Node::at), problem.radius + ROOM_M)
}

/// Whether it lies in an obstacle, deeper than what the models disagree by.
#[must_use]
pub fn is_buried(problem: &Problem, answer: &CableSolution) -> bool {
    let gap = |n: &Node| problem.world.signed_gap(n.at(), DEEPEST_M).map(|g| g.gap_m);
    answer.nodes.iter().any(|n| gap(n).is_some_and(|g| g < -BURIED_M))
}
