//! The resting place of a stiff cable in contact, as a boundary value problem: the elastica between
//! supports and contacts that are a point or a stretch, without a mesh that contact would have to
//! be found on.
//!
//! With t = (cos θ, sin θ), n = perp(t), the force F of what comes after on what comes before (T =
//! F·t), the moment M and the unstretched arc length s, α = 1 + αₜΔT and ε = T/EA, a free piece
//! obeys
//! ```text
//! x' = α(1 + ε) t,     θ' = αM/EI,     M' = −α(1 + ε) F·n,     F' = −b
//! ```
//! One that lies on a round of radius ρ, passed in the sense σ (+1 anticlockwise, outward normal
//! N = −σn), or on a line (1/ρ = 0), has
//! ```text
//! θ' = α(1 + ε)σ/ρ,    M = EI (1 + ε)σ/ρ,    F = T t,    p = σ(Tθ' + b·n) ≥ 0,    T' = −b·t − μp
//! ```
//! with μ the friction that is mobilised, positive where it pulls the cable along growing s. Where
//! a free piece and one that lies meet, and at a contact in one point, a point force P(N + μt)
//! acts; x, θ and M go through. A contact is one point while its cable is less bent than its round,
//! σM/EI ≤ 1/ρ, and a stretch where that would be broken: what belongs to which is found by an
//! active set. Weightless and without friction T + M²/2EI is the same all along: T falls by EI/2ρ²
//! where the cable lies on a round.
//!
//! Each piece is solved by Lobatto collocation of fourth order (U. Ascher, R. Mattheij, R.
//! Russell, *Numerical Solution of Boundary Value Problems for Ordinary Differential Equations*,
//! SIAM 1995), its length s among the unknowns; all equations are local, so the Jacobian is a band.
//! The way there goes from the flexible cable up in EI.

mod active;
mod answer;
mod band;
mod boundary_value;
mod chain_answer;
mod flexible_answer;
mod relax;
mod start;

use crate::contact::swept_corners;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::solution::{CableSolution, Cost, ErrorEstimates, Node};
pub(in crate::model::fem) use answer::{refine, solution};
pub(in crate::model::fem) use boundary_value::Elastica;
use relax::{Chain, LetGo};

/// Accuracy asked of the forces of another equilibrium that is only told. Smaller: time; larger:
/// its tensions are told with fewer digits than they are written.
const BOW_TOLERANCE: f64 = 1e-4;

/// The resting place of a stiff cable in contact, from the answer for a flexible one where there is
/// one: as an elastica where that is found, else as a chain of bars with what halving them changes
/// as its error.
pub fn rest(
    problem: &Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    lay: Option<&CableSolution>,
    tolerance: f64,
) -> Option<(CableSolution, Cost)> {
    let bent = lay.and_then(|lay| Elastica::from_flexible(problem, time_s, dragged, lay));
    let bent = bent.and_then(|e| answer::answer(e, problem, tolerance));
    let bent = bent.filter(|(found, _)| lay.is_some_and(|lay| keeps_sides(problem, &lay.nodes, found)));
    let chain = match &bent {
        // An equilibrium may be one that a cable runs away from: a chain that is let go there
        // tells.
        Some((answer, _)) => match relax::settle_chain(problem, time_s, dragged, answer) {
            LetGo::Stays | LetGo::Unknown => return bent,
            LetGo::Leaves(chain) => *chain,
            LetGo::Totters => return None,
        },
        None => relax::relaxed(problem, time_s, dragged, lay)?,
    };
    let bend = |chain: &Chain<'_>| {
        let found = Elastica::from_chain(chain, dragged).and_then(|e| answer::answer(e, problem, tolerance))?;
        keeps_sides(problem, &chain.nodes(), &found.0).then_some(found)
    };
    if let Some(found) = bend(&chain) {
        return Some(found);
    }
    let (fine, rests) = chain.halved(dragged)?;
    if let Some(found) = if rests { bend(&fine) } else { None } {
        return Some(found);
    }
    let cost = Cost { iterations: chain.steps + fine.steps, ..Cost::default() };
    let (coarse, finer) = (chain.solution(), fine.solution());
    let errors = ErrorEstimates::between(&coarse, &finer);
    Some((if rests { finer } else { coarse }.known_to(errors), cost))
}

/// The nodes of the equilibrium to which a chain of bars leads that is let go at a shape, if it
/// keeps to the sides of obstacles on which the cable is; None where it finds none.
pub fn rest_near(
    problem: &Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    from: &[Node],
    shape: &[Node],
) -> Option<Vec<Node>> {
    let chain = Chain::near(problem, time_s, dragged, shape)?;
    let bent = Elastica::from_chain(&chain, dragged).and_then(|e| answer::answer(e, problem, BOW_TOLERANCE));
    bent.map(|(found, _)| found).filter(|found| keeps_sides(problem, from, found)).map(|found| found.nodes)
}

/// True if a cable can have come from one shape to an answer without passing through an obstacle.
/// Newton's method can: where a contact of the way up in stiffness would have to pull it is let go,
/// and what springs off a post may come to rest on its other side.
fn keeps_sides(problem: &Problem, from: &[Node], to: &CableSolution) -> bool {
    let [old, new] = [from, &to.nodes].map(|nodes| nodes.iter().map(Node::at).collect::<Vec<Vec2>>());
    swept_corners::through(&swept_corners::corners(&problem.world), &old, &new, &mut Vec::new()).is_none()
}
