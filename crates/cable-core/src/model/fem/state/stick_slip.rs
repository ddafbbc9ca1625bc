//! Each sliding node sticks or slips: this module compares the friction that a solve assumed with
//! the law at what it found.

use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::system::Unknowns;
use crate::model::fem::system::contact::floor_friction;

/// Factors of sliding nodes count as found when they change by less than this.
const SCALE_TOLERANCE: f64 = 1e-9;

/// Forces at a sliding node within this part of each other are equal: tensions of bars are known to
/// the residual only.
const EVEN_FORCE: f64 = 1e-7;

/// The difference between the friction that sliding nodes have at unknowns and the friction with
/// which these were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) struct StickSlipChanges {
    /// Nodes that hold where they should slip, or slip where they should hold.
    pub(in crate::model::fem) wrong: usize,
    /// True if what slips has the friction that belongs to its turn, within the tolerance.
    pub(in crate::model::fem) lawful: bool,
    /// True if nothing changed by more than rounding.
    pub(in crate::model::fem) same: bool,
}

impl StickSlipChanges {
    /// No node slides.
    pub(in crate::model::fem) const NONE: Self = Self { wrong: 0, lawful: true, same: true };

    /// True if the law holds at every sliding node.
    pub(in crate::model::fem) fn are_lawful(self) -> bool {
        self.wrong == 0 && self.lawful
    }
}

/// The sliding nodes whose friction a round may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) enum ChangedNodes {
    /// All whose friction breaks its law.
    All,
    /// The first of them, and turns half of the way: nearly slack bars hang from a round, and turn
    /// over it by the more the less they pull.
    One,
}

/// Sets the friction of every sliding node to what its law asks for at unknowns, and returns how
/// that differs from the friction with which the unknowns were found.
///
/// A node that slid the wrong way until its friction was seen to be wrong has not slid at all.
pub(in crate::model::fem) fn update_stick_slip(
    cable: &mut CableState,
    unknowns: &mut Unknowns,
    changed: ChangedNodes,
) -> StickSlipChanges {
    let one = changed == ChangedNodes::One;
    if cable.meshing.never_slides {
        return StickSlipChanges::NONE;
    }
    let mut changes = StickSlipChanges {
        same: !floor_friction::renew_limits(
            &mut cable.input.loads.floor_limit,
            &cable.problem,
            &cable.mesh,
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
        // Bars that do not pull press on nothing, and what would push where it leaves has no
        // tension that friction could raise.
        let presses = load.turn > 0.0 && load.pull[0] + load.pull[1] > 0.0 && load.pull[1] > 0.0;
        let exponent = if presses { node.friction * load.turn } else { 0.0 };
        next.exponent = if one { 0.5 * (node.exponent + exponent) } else { exponent };
        let inertia =
            cable.input.inertial.stiffness[k] * (unknowns.slides[k] - cable.input.inertial.predicted_slide[k]);
        let pulls = load.pull[0].abs() + load.pull[1].abs();
        let slack = cable.input.stopping.tolerance + EVEN_FORCE * pulls;
        let stiffness = cable.mesh.axial_stiffness;
        let stick_slip = load.stick_slip(&next, unknowns.slides[k], [inertia, slack], stiffness);
        if stick_slip != node.stick_slip {
            changes.wrong += 1;
            if !one || changes.wrong == 1 {
                next.stick_slip = stick_slip;
            }
        }
        next.factor = load.factor(next.stick_slip, next.exponent, stiffness);
        let floor = floor_friction::reaches(&cable.mesh, k, &unknowns.positions, Some(&unknowns.slides));
        next.floor_factor = floor_friction::factor(floor, load.ratio(next.stick_slip, next.exponent));
        if next.sticks() && !node.sticks() {
            unknowns.slides[k] = 0.0;
        }
        let same = |a: f64, b: f64| (a / b - 1.0).abs() <= SCALE_TOLERANCE;
        changes.same &= same(next.factor, node.factor) && same(next.floor_factor, node.floor_factor);
        let off = ((load.factor(node.stick_slip, exponent, stiffness) - node.factor) * load.pull[1]).abs();
        changes.lawful &= off <= cable.mesh.tuning.step.grip_tolerance * pulls * exponent + slack;
        cable.mesh.sliding[k] = Some(next);
    }
    cable.input.set_scale(&cable.mesh);
    changes
}
