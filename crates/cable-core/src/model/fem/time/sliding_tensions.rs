//! This module stores the tensions between which the friction of each sliding node acted in a step,
//! for the report of its contact.

use crate::model::fem::mesh::{BalancedTensions, StickSlip};
use crate::model::fem::state::CableState;
use crate::model::fem::system::Unknowns;

/// Stores the tensions and the turn between which friction acts at each sliding node.
pub(in crate::model::fem) fn keep_balanced_tensions(cable: &mut CableState, unknowns: &Unknowns) {
    for k in 0..cable.mesh.nodes() {
        let Some(load) = cable.step_context().load_at(k, &unknowns.positions, Some(&unknowns.slides)) else { continue };
        let inertia =
            cable.input.inertial.stiffness[k] * (unknowns.slides[k] - cable.input.inertial.predicted_slide[k]);
        let momentum_flux = cable.input.inertial.momentum_flux[k];
        if let Some(node) = &mut cable.mesh.sliding[k] {
            let [comes, leaves] = load.at_round();
            // The step balances derivatives by the slide of material. They are greater than forces
            // by the stretch, and by the part by which heat or a length that is being changed makes
            // the unstretched cable longer. (A node that sticks has no momentum flux.)
            let (thermal, inertia) = (cable.mesh.thermal_stretch, inertia / cable.mesh.thermal_stretch);
            let [before, after] = load.at_material.map(|pull| pull / thermal);
            let stretch = 1.0 + 0.5 * (comes + leaves) / cable.mesh.axial_stiffness;
            let pulls = match node.stick_slip {
                _ if load.floor != [0.0; 3] => comes - inertia,
                StickSlip::Stick => leaves + (before - inertia - after) / stretch,
                slips => load.ratio(slips, node.exponent) * (leaves - momentum_flux) + momentum_flux,
            };
            node.balanced = Some(BalancedTensions {
                pull: [pulls, leaves].map(|pull| pull - momentum_flux),
                turn: load.turn_with_inertia(inertia),
                momentum_flux,
                pressed: load.pressed,
            });
        }
    }
}
