//! This module finds the initial equilibrium of a cable: the one of `spans` with the least slide,
//! for any model that continues from it.

use std::sync::Arc;

use super::spans::SpansModel;
use super::{Mechanics, Settings};
use crate::contact::self_contact_pairs::{SelfContact, SortedNodes};
use crate::contact::self_crossings::crossings;
use crate::error::{NoEquilibrium, SolveError};
use crate::math::RigidPose;
use crate::math::{Vec2, larger};
use crate::problem::{Problem, SupportPoint};
use crate::solution::{CableSolution, Node, ShownEquilibrium, SlideReason, Warning, WarningCause};
use crate::state::State;

/// Distance (m) to the robot below which a model that knows the robot is used. Smaller: one step
/// could carry the cable past it.
const ROBOT_CLEARANCE_M: f64 = 0.02;
/// Depth (m) in an obstacle from which an answer of `spans` is rejected. Smaller: chords across
/// round obstacles are rejected; larger: a slack cable that hangs in the ground is accepted.
const MAX_BURIAL_M: f64 = 0.02;
/// Greatest depth of the search, m: a cable with a deeper node has entered elsewhere, too.
const BURIAL_SEARCH_M: f64 = 0.5;

/// Distance between the surfaces of two strands below which a model with self-contact is used: the
/// larger of a length (m) and a fraction of the diameter. Contact forces begin at 1e-4 m. Smaller:
/// a contact may be missed by round-off; larger: bends count as contacts.
const STRAND_CLEARANCE: (f64, f64) = (2e-4, 0.1);

/// An initial equilibrium.
#[derive(Clone, Debug)]
pub struct InitialEquilibrium {
    /// The cable there.
    pub answer: CableSolution,
    /// Warnings about it.
    pub warnings: Vec<Warning>,
    /// The model that has it, to go on from there.
    pub spans: Box<SpansModel>,
}

/// Returns the equilibrium with the least slide, with supports `dragged` (m) and the robot at its
/// pose; None if `spans` finds none.
///
/// # Errors The error that the cable slides from where it is laid.
pub fn initial_equilibrium(
    problem: &Arc<Problem>,
    settings: Settings,
    dragged: &[Option<Vec2>],
    robot_pose: Option<RigidPose>,
) -> Result<Option<InitialEquilibrium>, SolveError> {
    let Ok(mut spans) = SpansModel::new(as_flexible(problem), settings) else { return Ok(None) };
    spans.seek_tension();
    for (k, at) in dragged.iter().enumerate() {
        if let Some(at) = at {
            spans.drag_support(k, *at);
        }
    }
    let mut warnings = match spans.settle() {
        Ok(report) => report.warnings,
        Err(slides @ SolveError::NoRestingPlace { .. }) => return Err(slides),
        Err(_) => return Ok(None),
    };
    if problem.bending_stiffness > 0.0 {
        // A loose cable gives no shape for a stiff one, because no tension draws it straight.
        if spans.has_loose_cable() {
            return Ok(None);
        }
        warnings.iter_mut().for_each(of_flexible);
    }
    let answer = spans.solution();
    let clear = !meets_outline(problem, robot_pose, &answer)
        && !meets_itself(problem, &answer.nodes)
        && !is_buried(problem, &answer.nodes);
    Ok(clear.then(|| InitialEquilibrium { answer, warnings, spans: Box::new(spans) }))
}

/// The histories that are known are those of a flexible cable.
fn of_flexible(warning: &mut Warning) {
    if let WarningCause::ManyEquilibria { shown, .. } = &mut warning.cause {
        *shown = ShownEquilibrium::FromRouteAsFlexible;
    }
}

/// Returns whether a flexible cable that slid from where it was laid slides on from its reported
/// equilibrium, which is then none.
#[must_use]
pub(crate) fn slides_on(problem: &Arc<Problem>, settings: Settings, answer: &CableSolution) -> bool {
    let route = answer.nodes.iter().map(Node::at).collect();
    let there = Arc::new(Problem { route, ..Problem::clone(&Problem::without_outline(problem.clone())) });
    let slides = initial_equilibrium(&there, settings, &[], None);
    problem.bending_stiffness == 0.0 && matches!(slides, Err(SolveError::NoRestingPlace { .. }))
}

/// Work of the weight and the dead loads of a cable between two shapes, J. A cable that slides to
/// its equilibrium goes down, because friction only dissipates.
#[must_use]
pub fn work(problem: &Problem, from: &State, to: &CableSolution, time_s: f64) -> f64 {
    let moved = |n: &Node| from.position_at(n.arc_length_m).map_or_else(Vec2::zeros, |before| n.at() - before);
    let at = |s: f64| {
        let k = to.nodes.partition_point(|n| n.arc_length_m < s);
        to.nodes.get(k).or(to.nodes.last()).map_or_else(Vec2::zeros, moved)
    };
    let body = problem.body_force(time_s);
    let pieces = to.nodes.windows(2);
    let weight: f64 =
        pieces.map(|p| body.dot(&(moved(&p[0]) + moved(&p[1]))) * 0.5 * (p[1].arc_length_m - p[0].arc_length_m)).sum();
    let loads: f64 = problem.loads.iter().map(|l| l.force.at(time_s).dot(&at(l.arc_length))).sum();
    let gravity = if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
    let ends = problem.supports.iter().filter(|s| s.at.is_none());
    let hung: f64 = ends.map(|s| (s.force.at(time_s) + gravity * s.mass).dot(&at(s.arc_length.unwrap_or(0.0)))).sum();
    weight + loads + hung
}

/// Returns the warning for an equilibrium that a cable reached by sliding.
#[must_use]
pub(crate) fn slid_first(problem: &Problem, slides: &SolveError) -> Warning {
    let why = match slides {
        SolveError::NoRestingPlace { why: NoEquilibrium::NoFriction } => SlideReason::NoFriction,
        SolveError::NoRestingPlace { why: NoEquilibrium::TooLittleFriction { friction_ratio } } => {
            SlideReason::TooLittleFriction { friction_ratio: *friction_ratio }
        }
        SolveError::NoRestingPlace { why: NoEquilibrium::UnheldForce { left_n, loads_n } } => {
            SlideReason::UnheldForce { left_n: *left_n, loads_n: *loads_n }
        }
        _ => SlideReason::NothingHolds,
    };
    Warning::new(WarningCause::SlidFromRoute { why }, &problem.cable.name, 0.0, [0.0; 2])
}

/// The cable that `spans` can solve: without the robot and self-contact, flexible even if the real
/// one is stiff, and held by all supports even if they release it later.
fn as_flexible(problem: &Arc<Problem>) -> Arc<Problem> {
    let plain = Problem::without_self_contact(Problem::without_outline(problem.clone()));
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

/// Returns whether the cable touches the robot, or overlaps it.
#[must_use]
pub(crate) fn meets_outline(problem: &Problem, robot_pose: Option<RigidPose>, answer: &CableSolution) -> bool {
    let (Some(outline), Some(at)) = (&problem.outline, robot_pose) else { return false };
    !outline.is_clear(at, answer.nodes.iter().map(Node::at), problem.radius + ROBOT_CLEARANCE_M)
}

/// Returns whether the cable has self-contact and two of its strands cross, or are nearer than
/// [`STRAND_CLEARANCE`]. [`SelfContact`] defines how far apart along the cable two strands are.
#[must_use]
pub(crate) fn meets_itself(problem: &Problem, nodes: &[Node]) -> bool {
    if !problem.cable.self_contact {
        return false;
    }
    let at: Vec<Vec2> = nodes.iter().map(Node::at).collect();
    let arc: Vec<f64> = nodes.iter().map(|n| n.arc_length_m).collect();
    let diameter = 2.0 * problem.radius;
    SelfContact::of_diameter(diameter).smallest_gap(&at, &arc, strand_clearance(diameter, nodes)).is_some()
        || !crossings(&at, |_| true).is_empty()
}

/// Watches a cable with self-contact that moves from answer to answer of a model without it.
pub(crate) struct StrandWatch<'a> {
    problem: &'a Problem,
    /// The last answer that was seen.
    last: Vec<Node>,
    /// True if two strands met, or passed each other.
    pub met: bool,
}

impl<'a> StrandWatch<'a> {
    /// None for a cable that can pass itself.
    #[must_use]
    pub(crate) fn of(problem: &'a Problem) -> Option<Self> {
        problem.cable.self_contact.then_some(Self { problem, last: Vec::new(), met: false })
    }

    /// Returns whether the cable is clear of itself in the next answer, and on the straight way of
    /// each of its points from the last one.
    pub(crate) fn stay_clear(&mut self, nodes: &[Node]) -> bool {
        let before = std::mem::replace(&mut self.last, nodes.to_vec());
        self.met |= meets_itself(self.problem, nodes)
            || !before.is_empty() && passes_itself(2.0 * self.problem.radius, &before, nodes);
        !self.met
    }
}

/// Returns whether one strand of a cable of a diameter (m) comes nearer than [`STRAND_CLEARANCE`]
/// to another where each of its points moves straight from one answer to the next.
fn passes_itself(diameter: f64, before: &[Node], after: &[Node]) -> bool {
    let mut arc: Vec<f64> = before.iter().chain(after).map(|n| n.arc_length_m).collect();
    arc.sort_by(f64::total_cmp);
    arc.dedup();
    let places = |nodes: &[Node]| -> Vec<Vec2> {
        let state = State::of_nodes(nodes, 0.0);
        arc.iter().map(|&s| state.position_at(s).unwrap_or_default()).collect()
    };
    let (from, to) = (places(before), places(after));
    let clearance = larger(strand_clearance(diameter, before), strand_clearance(diameter, after));
    let strands = SelfContact::of_diameter(diameter + clearance);
    let moves = |k: usize| to[k] - from[k];
    strands.free_fraction(&from, &arc, &moves, [0.0, 0.0, 1.0], &mut SortedNodes::default()) < 1.0
}

/// The gap of the surfaces of two strands below which they count as touching, m: see
/// [`STRAND_CLEARANCE`]. The chords between two nodes run inside the curve.
fn strand_clearance(diameter: f64, nodes: &[Node]) -> f64 {
    let sagitta = |pair: &[Node]| {
        let bend = pair[0].curvature_per_m.abs().min(pair[1].curvature_per_m.abs());
        0.125 * bend * (pair[1].at() - pair[0].at()).norm_squared()
    };
    let (least, of_diameter) = STRAND_CLEARANCE;
    larger(least, of_diameter * diameter) + 2.0 * nodes.windows(2).map(sagitta).fold(0.0, larger)
}

/// Returns whether a cable lies in an obstacle, deeper than the difference between the models.
#[must_use]
pub(crate) fn is_buried(problem: &Problem, nodes: &[Node]) -> bool {
    let gap = |n: &Node| problem.world.signed_gap(n.at(), BURIAL_SEARCH_M).map(|g| g.gap_m);
    nodes.iter().any(|n| gap(n).is_some_and(|g| g < -MAX_BURIAL_M))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cable that hangs down and comes up again `aside` (m) of itself.
    fn hook(aside: f64) -> Vec<Node> {
        let side = aside.signum();
        let places = [[0.0, 2.0], [0.0, 1.0], [0.0, 0.0], [0.5 * side, -0.5], [side, 0.0], [aside, 1.0]];
        let node =
            |(k, [x_m, y_m]): (usize, [f64; 2])| Node { arc_length_m: 1.2 * k as f64, x_m, y_m, ..Node::default() };
        places.into_iter().enumerate().map(node).collect()
    }

    /// The cable is clear of itself on the right and on the left of its leg.
    #[test]
    fn an_end_that_went_through_the_other_leg_passed_it() {
        let diameter = 0.02;
        let [right, near, left] = [hook(0.8), hook(0.3), hook(-0.8)];
        for nodes in [&right, &near, &left] {
            let at: Vec<Vec2> = nodes.iter().map(Node::at).collect();
            assert!(crossings(&at, |_| true).is_empty());
        }
        assert!(!passes_itself(diameter, &right, &near));
        assert!(passes_itself(diameter, &right, &left) && passes_itself(diameter, &left, &right));
    }
}
