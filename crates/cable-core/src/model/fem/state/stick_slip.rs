//! Each sliding node sticks or slips. This module compares the friction that a solve assumed with
//! the law of friction at its solution.

use crate::math::larger;
use crate::model::fem::mesh::{SlidingNode, SlidingNodeLoad, StickSlip};
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::system::Unknowns;
use crate::model::fem::system::contact::floor_friction;

/// Relative change of the factors of sliding nodes below which they have converged.
const SCALE_TOLERANCE: f64 = 1e-9;

/// Relative difference below which two forces at a sliding node are equal: tensions of bars are
/// known only to the residual.
const EVEN_FORCE_FRACTION: f64 = 1e-7;

/// The difference between the friction of sliding nodes at a solution and the friction assumed for
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) struct StickSlipChanges {
    /// Number of nodes that stick where they should slip, or slip where they should stick.
    pub(in crate::model::fem) wrong: usize,
    /// True if every slipping node has the friction of its turn, within the tolerance.
    pub(in crate::model::fem) lawful: bool,
    /// True if nothing changed by more than round-off.
    pub(in crate::model::fem) same: bool,
}

impl StickSlipChanges {
    /// No sliding node needs a change.
    pub(in crate::model::fem) const NONE: Self = Self { wrong: 0, lawful: true, same: true };

    /// True if the law of friction holds at every sliding node.
    pub(in crate::model::fem) fn are_lawful(self) -> bool {
        self.wrong == 0 && self.lawful
    }
}

/// The sliding nodes whose friction a round may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) enum ChangedNodes {
    /// All nodes whose friction violates the law.
    All,
    /// The first of these nodes.
    One,
}

/// Greatest slope dE/de used by the secant, with E the exponent of a node's turn and e the exponent
/// that was assumed. Smaller: rounds creep; larger: far guesses where the two nearly agree.
const MAX_EXPONENT_SLOPE: f64 = 0.9;

/// The exponents μφ that were last assumed at sliding nodes, and those that their turns then
/// required.
///
/// The next guess is that of the secant (J. F. Steffensen, "Remarks on iteration", Skandinavisk
/// Aktuarietidskrift 16, 1933, node by node). Nearly slack bars hang from a round, and turn over it
/// by more the smaller their tension is, so plain substitution alternates.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct TriedExponents(Vec<Option<[f64; 2]>>);

impl TriedExponents {
    /// The next exponent of node `k`, which required `asked` when it was solved with `used`.
    fn next(&mut self, k: usize, used: f64, asked: f64) -> f64 {
        if self.0.len() <= k {
            self.0.resize(k + 1, None);
        }
        let before = self.0[k].replace([used, asked]);
        let slope = before.map_or(f64::NAN, |[x, g]| (asked - g) / (used - x));
        if slope.is_finite() && slope < MAX_EXPONENT_SLOPE {
            larger(used + (asked - used) / (1.0 - slope), 0.0)
        } else {
            asked
        }
    }
}

/// The friction that the law requires of a sliding node.
struct SlipLaw {
    /// μφ with the turn at the solution.
    exponent: f64,
    stick_slip: StickSlip,
    /// True if the friction of the solution is that of its turn, within the tolerance.
    lawful: bool,
}

/// The law of friction at sliding node `k` under a load, after a slide (m) in this step.
fn slip_law(cable: &CableState, k: usize, node: &SlidingNode, load: &SlidingNodeLoad, slid: f64) -> SlipLaw {
    let inertia = cable.input.inertial.stiffness[k] * (slid - cable.input.inertial.predicted_slide[k]);
    // Friction vanishes with the tension, and a compressed bar has none. (The pull where the
    // cable meets the round is a result of the step: when it was tested, friction jumped on and
    // off, and no state was lawful.)
    let turn = load.turn_with_inertia(inertia / cable.mesh.thermal_stretch) + load.pressed_turn();
    let momentum_flux = cable.input.inertial.momentum_flux[k];
    let presses = turn > 0.0 && load.at_material[1] > momentum_flux;
    let exponent = if presses { node.friction * turn } else { 0.0 };
    let pulls = load.pull[0].abs() + load.pull[1].abs();
    let slack = cable.input.stopping.tolerance + EVEN_FORCE_FRACTION * pulls;
    let stiffness = cable.mesh.axial_stiffness;
    let off = ((load.factor(node.stick_slip, exponent, stiffness) - node.factor) * load.pull[1]).abs();
    let lawful = off <= cable.mesh.tuning.step.grip_tolerance * pulls * exponent + slack;
    // The sense of slip follows from the turn, not from a guess of it.
    let by_turn = SlidingNode { exponent, ..*node };
    let stick_slip = load.stick_slip(&by_turn, slid, [inertia, momentum_flux, slack], stiffness);
    SlipLaw { exponent, stick_slip, lawful }
}

/// Sets the friction of every sliding node by the law of friction at `unknowns`, and returns the
/// difference from the friction with which they were found. `tried` holds the exponents of earlier
/// rounds of the step; without it, exponents change by half if one node changes at a time.
///
/// A node that slid the wrong way because of wrong friction counts as not having slid.
pub(in crate::model::fem) fn update_stick_slip(
    cable: &mut CableState,
    unknowns: &mut Unknowns,
    changed: ChangedNodes,
    tried: Option<&mut TriedExponents>,
) -> StickSlipChanges {
    let mut tried = tried;
    let one = changed == ChangedNodes::One;
    if cable.meshing.never_slides {
        return StickSlipChanges::NONE;
    }
    let mut changes = StickSlipChanges {
        same: !floor_friction::renew_limits(
            &mut cable.input.loads.floor_limit,
            &cable.problem,
            &cable.mesh,
            &cable.meshing.support_node,
            &unknowns.positions,
            Some(&unknowns.slides),
        ),
        ..StickSlipChanges::NONE
    };
    for k in 0..cable.mesh.nodes() {
        let (Some(node), Some(load)) =
            (cable.mesh.sliding[k], cable.step_context().load_at(k, &unknowns.positions, Some(&unknowns.slides)))
        else {
            continue;
        };
        if !(node.friction > 0.0) {
            continue;
        }
        let mut next = node;
        let SlipLaw { exponent, stick_slip, lawful } = slip_law(cable, k, &node, &load, unknowns.slides[k]);
        changes.lawful &= lawful;
        next.exponent = match &mut tried {
            Some(tried) if !lawful => tried.next(k, node.exponent, exponent),
            None if one => 0.5 * (node.exponent + exponent),
            _ => exponent,
        };
        if stick_slip != node.stick_slip {
            changes.wrong += 1;
            if !one || changes.wrong == 1 {
                next.stick_slip = stick_slip;
            }
        }
        next.factor = load.factor(next.stick_slip, next.exponent, cable.mesh.axial_stiffness);
        let floor = floor_friction::reaches(&cable.mesh, k, &unknowns.positions, Some(&unknowns.slides));
        next.floor_factor = floor_friction::factor(floor, load.ratio(next.stick_slip, next.exponent));
        if next.sticks() && !node.sticks() {
            unknowns.slides[k] = 0.0;
        }
        let same = |a: f64, b: f64| (a / b - 1.0).abs() <= SCALE_TOLERANCE;
        changes.same &= same(next.factor, node.factor) && same(next.floor_factor, node.floor_factor);
        cable.mesh.sliding[k] = Some(next);
    }
    cable.input.set_scale(&cable.mesh);
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The turns fall by 0.77 and by 0.9 of the growth of the exponent, so substitution alternates.
    #[test]
    fn issue_016_exponents_that_go_to_and_fro_are_found_in_a_few_rounds() {
        for slope in [-0.77, -0.9, 0.6] {
            let asked = |exponent: f64| 2.0 + slope * (exponent - 2.0) - 0.05 * (exponent - 2.0).powi(2);
            let (mut tried, mut exponent) = (TriedExponents::default(), 3.0);
            for _ in 0..5 {
                exponent = tried.next(0, exponent, asked(exponent));
            }
            assert!((exponent - 2.0).abs() < 1e-6, "{slope}: {exponent}");
        }
    }
}
