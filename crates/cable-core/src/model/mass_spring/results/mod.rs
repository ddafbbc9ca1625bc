//! These modules make the answer from the state of the model.
//!
//! | room | content |
//! |---|---|
//! | `nodes.rs` | positions, tensions, internal forces and curvatures; support reactions |
//! | `contact_reports.rs` | contact reports, and the uncertainty of tension beyond each contact |

pub(in crate::model::mass_spring) mod contact_reports;
pub(in crate::model::mass_spring) mod nodes;

pub(in crate::model::mass_spring) use contact_reports::corner_warning;

use crate::math::Vec2;
use crate::model::mass_spring::dynamics::ChainState;
use crate::solution::{Assumptions, CableSolution, ErrorEstimates};
use crate::state::State;
use nodes::NodeReader;

/// The answer of the present state, with warnings of errors above `tolerance` (relative).
pub(in crate::model::mass_spring) fn answer(
    chain: &ChainState,
    errors: &ErrorEstimates,
    tolerance: f64,
) -> CableSolution {
    let ChainState { clock, mesh, drives, contacts, report } = chain;
    let reader = NodeReader { mesh, time_s: clock.time_s };
    let answer = CableSolution {
        name: mesh.problem.cable.name.clone(),
        nodes: reader.nodes().into(),
        supports: (0..mesh.support_node.len()).map(|k| reader.reaction(k, drives.hands[k])).collect(),
        assumptions: Assumptions {
            bending_stiffness_n_m2: mesh.bending_stiffness,
            inertia: mesh.velocity.iter().any(|v| v.norm_squared() > 0.0),
            ..Assumptions::default()
        },
        momentum: report.account.report(mesh),
        unstretched_length_m: (mesh.length_change.is_some() || mesh.has_excess())
            .then(|| mesh.rest_length.iter().sum()),
        contacts: contact_reports::read(mesh, contacts, &report.cost)
            .into_iter()
            .map(|contact| contact.report)
            .collect(),
        ..CableSolution::default()
    };
    let by_contacts = || contact_reports::tension_uncertainty(mesh, contacts, &report.cost, tolerance);
    let error_estimate = errors.relative(&answer).or_else(by_contacts);
    CableSolution { error_estimate, errors: *errors, ..answer }
}

/// The state in the form that every model accepts.
pub(in crate::model::mass_spring) fn state(chain: &ChainState) -> State {
    let time_s = chain.clock.time_s;
    let nodes = NodeReader { mesh: &chain.mesh, time_s }.nodes();
    State {
        time_s,
        arc_length_m: nodes.iter().map(|n| n.arc_length_m).collect(),
        position_m: nodes.iter().map(|n| Vec2::new(n.x_m, n.y_m)).collect(),
        velocity_m_per_s: nodes.iter().map(|n| Vec2::new(n.vx_m_per_s, n.vy_m_per_s)).collect(),
        in_motion: false,
    }
}
