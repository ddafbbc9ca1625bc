//! A chain of masses and springs comes to rest where its supports are.

use crate::error::{NoEquilibrium, SolveError};
use crate::math::Vec2;
use crate::model::mass_spring::dynamics::ChainState;
use crate::model::mass_spring::equilibrium::contact_energy::Anchors;
use crate::model::mass_spring::equilibrium::newton::EquilibriumSolver;
use crate::model::mass_spring::forces::nodal;
use crate::model::mass_spring::mesh::Mesh;

/// Moves the nodes to equilibrium. On an error they are somewhere on the way.
pub(in crate::model::mass_spring) fn find_equilibrium(
    chain: &mut ChainState,
    anchors: Anchors,
) -> Result<(), SolveError> {
    chain.mesh.velocity.fill(Vec2::zeros());
    chain.clock.behind_s = 0.0;
    let time_s = chain.clock.time_s;
    chain.drives.place_nodes(&mut chain.mesh, time_s);
    chain.contacts.forget_distances();
    if !chain.mesh.supported.contains(&true) && !chain.mesh.can_touch() {
        return Err(SolveError::NoRestingPlace { why: NoEquilibrium::NothingBelow });
    }
    let mut solver = EquilibriumSolver::new(&mut chain.mesh, time_s, &chain.contacts.anchors, anchors)?;
    let iterations = match solver.solve() {
        Ok(iterations) => iterations,
        Err(error) => {
            nodal::update(&mut chain.mesh, time_s, 0.0);
            return Err(left_wheel(&chain.mesh).unwrap_or(error));
        }
    };
    chain.contacts.anchors = solver.move_anchors();
    let impulses = solver.impulses();
    chain.contacts.renew(chain.mesh.rest_length.len());
    chain.contacts.impulses.extend(impulses);
    chain.report.cost.iterations = iterations.count;
    chain.report.cost.residual_n = iterations.residual_n;
    chain.report.cost.inner_step_s = 0.0;
    nodal::update(&mut chain.mesh, time_s, 0.0);
    chain.mesh.non_finite(time_s).or_else(|| left_wheel(&chain.mesh)).map_or(Ok(()), Err)
}

/// The refusal of a wheel about which the cable turns the wrong way: its mark would draw the cable
/// towards it.
fn left_wheel(mesh: &Mesh) -> Option<SolveError> {
    let left = mesh.wheels.pulleys.iter().find(|p| p.radius > 0.0 && p.turn < 0.0)?;
    let pulley = mesh.problem.supports.get(left.support)?.name.clone();
    Some(SolveError::NoRestingPlace { why: NoEquilibrium::LeavesWheel { pulley } })
}
