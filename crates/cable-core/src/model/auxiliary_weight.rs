//! A weightless cable has no shape of its own where it is slack: an auxiliary weight gives it that
//! of a very light one, and the answer is read without it.

use crate::math::Vec2;
use crate::problem::Problem;
use crate::solution::{Node, SupportReaction, Warning, WarningCause};

/// Weight of a weightless cable, in parts of its loads. Smaller: slack parts beside loaded ones
/// have no direction that rounding leaves alone. Larger: it shows in the ninth digit.
const HINT_OF_LOADS: f64 = 1e-15;
/// The same in parts of EA where nothing is loaded: far below the strain that rounding hides.
const HINT_OF_STIFFNESS: f64 = 1e-18;
/// Tension that such a weight can make, in weights: a slack of 1e-9 of the length gives 6e3.
/// Smaller: a trace of tension is reported where there is none. Larger: tensions that loads make
/// are reported as none.
const HINT_TENSION_FACTOR: f64 = 1e4;

/// The hint of weight (N/m) of a weightless cable with dead loads of a size (N), and the force up
/// to which it alone may be the cause, N.
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

/// Returns what there is to say of a weightless cable that is slack.
pub(in crate::model) fn slack_without_weight(problem: &Problem, nodes: &[Node]) -> Option<Warning> {
    let slack = nodes.iter().find(|n| n.tension_n == 0.0)?;
    Some(Warning::new(WarningCause::Weightless, &problem.cable.name, slack.arc_length_m, [0.0; 2]))
}
