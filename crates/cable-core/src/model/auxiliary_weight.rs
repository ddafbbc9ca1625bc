//! A slack weightless cable has no definite shape: an auxiliary weight gives it that of a very
//! light one, and its forces are removed from the answer.

use crate::math::Vec2;
use crate::problem::Problem;
use crate::solution::{Node, SupportReaction, Warning, WarningCause};

/// Auxiliary weight of a weightless cable, as a fraction of its loads. Smaller: slack parts beside
/// loaded ones have directions of round-off only. Larger: it shows in the ninth digit.
const HINT_OF_LOADS: f64 = 1e-15;
/// Auxiliary weight without loads, as a fraction of EA: far below the strain of round-off.
const HINT_OF_STIFFNESS: f64 = 1e-18;
/// Greatest tension by that weight, in weights: a slack of 1e-9 of the length gives 6e3. Smaller: a
/// trace of tension is reported where there is none. Larger: tensions by loads are reported as 0.
const HINT_TENSION_FACTOR: f64 = 1e4;

/// The auxiliary weight (N/m) of a weightless cable with dead loads of a size (N), and the greatest
/// force that it may cause, N.
pub(in crate::model) fn auxiliary_weight(p: &Problem, loads: f64) -> (Vec2, f64) {
    let whole = if loads > 0.0 { HINT_OF_LOADS * loads } else { HINT_OF_STIFFNESS * p.axial_stiffness };
    (Vec2::new(0.0, -whole / p.length), HINT_TENSION_FACTOR * whole)
}

/// Sets the tension to 0 where only the auxiliary weight pulls: the cable is slack there.
pub(in crate::model) fn remove_auxiliary_weight(nodes: &mut [Node], reactions: &mut [SupportReaction], hint: f64) {
    for n in nodes.iter_mut().filter(|n| n.tension_n <= hint) {
        (n.tension_n, n.strain, n.stress_pa, n.force_n) = (0.0, 0.0, 0.0, [0.0; 2]);
    }
    for r in reactions {
        let tensions = [&mut r.tension_before_n, &mut r.tension_after_n].into_iter().flatten();
        for force in [&mut r.reaction_x_n, &mut r.reaction_y_n].into_iter().chain(tensions) {
            if force.abs() <= hint {
                *force = 0.0;
            }
        }
    }
}

/// Returns a warning for a weightless cable that is slack.
pub(in crate::model) fn slack_without_weight(problem: &Problem, nodes: &[Node]) -> Option<Warning> {
    let slack = nodes.iter().find(|n| n.tension_n == 0.0)?;
    Some(Warning::new(WarningCause::Weightless, &problem.cable.name, slack.arc_length_m, [0.0; 2]))
}
