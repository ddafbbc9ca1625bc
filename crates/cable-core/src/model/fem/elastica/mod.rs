//! These modules find the equilibrium of a stiff cable in contact as a boundary value problem: the
//! elastica between supports and contacts, each a point or a stretch. No contact has to be detected
//! on a mesh.
//!
//! Let t = (cos θ, sin θ), n = perp(t), F the force of the cable after a point on the cable before
//! it (T = F·t), M the moment, s the unstretched arc length, α = 1 + αₜΔT and ε = T/EA. A free
//! piece obeys
//! ```text
//! x' = α(1 + ε) t,     θ' = αM/EI,     M' = −α(1 + ε) F·n,     F' = −b
//! ```
//! A piece that lies on a round of radius ρ, passed in the sense σ (+1 anticlockwise, outward
//! normal N = −σn), or on a line (1/ρ = 0), obeys
//! ```text
//! θ' = α(1 + ε)σ/ρ,    M = EI (1 + ε)σ/ρ,    F = T t,    p = σ(Tθ' + b·n) ≥ 0,    T' = −b·t − μp
//! ```
//! with μ the mobilised friction, positive where it pulls the cable along growing s. Where a free
//! piece meets a piece in contact, and at a point contact, a point force P(N + μt) acts; x, θ and M
//! are continuous. A contact is a point while the cable there is less bent than its round, σM/EI ≤
//! 1/ρ, and a stretch where the cable would be bent more: an active set decides. Without weight and
//! friction T + M²/2EI is constant along the cable, so T falls by EI/2ρ² where the cable lies on a
//! round.
//!
//! Each piece is solved by Lobatto collocation of fourth order (U. Ascher, R. Mattheij, R.
//! Russell, *Numerical Solution of Boundary Value Problems for Ordinary Differential Equations*,
//! SIAM 1995), with its length among the unknowns. All equations are local, so the Jacobian is a
//! band matrix.
//!
//! | room | what it holds |
//! |---|---|
//! | `reference_curve` | an answer read at any arc length |
//! | `guess/` | the first guess of an elastica, from an answer |
//! | `boundary_value` | pieces, joints, their equations, Newton's method |
//! | `active_set` | the contacts, each a point or a stretch |
//! | `stiffening` | continuation from the flexible cable up in EI |
//! | `refinement` | new nodes, and states between nodes |
//! | `results` | the answer of an elastica, with its error |
//! | `chain/` | a chain of bars that is let go: another way to the contacts, and a test of stability |
//! | `buckled_equilibria` | the other equilibria of a cable that is compressed |

mod active_set;
mod boundary_value;
pub(in crate::model::fem) mod buckled_equilibria;
mod chain;
mod guess;
mod reference_curve;
mod refinement;
mod results;
mod stiffening;

pub(in crate::model::fem) use buckled_equilibria::other_equilibria;

use crate::contact::swept_corners;
use crate::math::{Vec2, larger, smaller};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{Assumptions, CableSolution, Cost, ErrorEstimates, Node};
pub(in crate::model::fem) use boundary_value::Elastica;
use chain::{BarChain, ChainInput, LYING_EULER, RestState, StabilityOutcome};
pub(in crate::model::fem) use results::{refine, solution};

/// Relative accuracy of the forces of another equilibrium that a warning reports. Smaller: more
/// time; larger: its tensions have fewer correct digits than are written.
const BOW_TOLERANCE: f64 = 1e-4;

/// Change by bending that is neglected, as a fraction of the tolerance. Smaller: boundary layers of
/// micrometres are resolved; larger: cables whose stiffness shows get flexible answers.
const NEGLIGIBLE_FRACTION: f64 = 1e-2;

/// Turn of a stretch in contact up to which it is straight, °. Larger: wraps are taken for struts.
const MAX_STRAIGHT_TURN_DEG: f64 = 30.0;

/// Finds the equilibrium of a stiff cable in contact, starting from the answer for a flexible one
/// if there is one. The result is an elastica, or a chain of bars if no elastica is found; the
/// chain's error is the change by halving its bars. None if neither is found.
///
/// The contacts of the elastica are tried in this order: those of the flexible cable, those of a
/// chain relaxed from it, and those of a chain with bars half as long.
pub fn equilibrium(
    problem: &Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    flexible: Option<&CableSolution>,
    tolerance: f64,
) -> Option<(CableSolution, Cost)> {
    if let Some(limit) = flexible.and_then(|flexible| flexible_limit(problem, flexible, tolerance)) {
        return Some((limit, Cost::default()));
    }
    let chain_input = ChainInput { problem, time_s, dragged, friction_source: flexible };
    let bent = flexible.filter(|flexible| !chain::is_folded(problem, flexible)).and_then(|flexible| {
        let elastica = Elastica::from_flexible(problem, time_s, dragged, flexible)?;
        let found = results::stiffen_and_refine(elastica, problem, tolerance)?;
        keeps_sides(problem, &flexible.nodes, &found.0).then_some(found)
    });
    let crushed = bent.as_ref().is_some_and(|(answer, _)| is_crushed(problem, answer));
    if crushed {
        // A cable under such compression bows as soon as anything lifts it.
        let rest = rest_by_chain(chain_input, chain::rest_of_flexible(chain_input), tolerance);
        return rest.filter(|(answer, _)| !is_crushed(problem, answer)).or(bent);
    }
    let chain = match &bent {
        // The equilibrium may be unstable: a chain released there shows it.
        Some((answer, _)) => match chain::test_stability(chain_input, answer) {
            StabilityOutcome::Stays | StabilityOutcome::Unknown => return bent,
            StabilityOutcome::Leaves(chain) => Some(*chain),
            StabilityOutcome::Unstable => return None,
        },
        None => chain::rest_of_flexible(chain_input),
    };
    rest_by_chain(chain_input, chain, tolerance)
}

/// Finds the equilibrium of a stiff cable from a chain of bars at rest: an elastica if one is
/// found, else the chain with bars half as long.
fn rest_by_chain(
    chain_input: ChainInput<'_>,
    chain: Option<BarChain<'_>>,
    tolerance: f64,
) -> Option<(CableSolution, Cost)> {
    let (problem, flexible, chain) = (chain_input.problem, chain_input.friction_source, chain?);
    let bent_from = |chain: &BarChain<'_>| {
        let elastica = Elastica::from_chain(chain)?;
        let found = results::stiffen_and_refine(elastica, problem, tolerance)?;
        keeps_sides(problem, &chain.nodes(), &found.0).then_some(found)
    };
    if let Some(found) = bent_from(&chain) {
        return Some(found);
    }
    let (fine, state) = chain.halved()?;
    let rests = state != RestState::NotFound;
    if let Some(found) = if rests { bent_from(&fine) } else { None } {
        return Some(found);
    }
    let cost = Cost { iterations: chain.steps + fine.steps, ..Cost::default() };
    let (coarse, finer) = (chain.solution(), fine.solution());
    let mut errors = ErrorEstimates::between(&coarse, &finer);
    if let Some(flexible) = flexible.filter(|answer| bend_length(problem, answer) < fine.bar) {
        // With bars longer than its bends the chain is in effect flexible and cuts the bends off.
        errors = errors.componentwise_max(&ErrorEstimates::between(&finer, flexible));
    }
    Some((if rests { finer } else { coarse }.known_to(errors), cost))
}

/// True if an answer lies straight on a surface under more compression than it could bear if
/// anything lifted it.
fn is_crushed(problem: &Problem, answer: &CableSolution) -> bool {
    answer.contacts.iter().any(|contact| {
        let [from, to] = contact.extent_m();
        let lying = answer.nodes.iter().filter(|n| (from..=to).contains(&n.arc_length_m));
        let push = lying.map(|n| -n.tension_n).reduce(smaller).unwrap_or(0.0);
        let force = LYING_EULER * problem.bending_stiffness / ((to - from) * (to - from));
        to > from && contact.turn_deg.abs() < MAX_STRAIGHT_TURN_DEG && push > force
    })
}

/// Length over which a cable bends at the tension of an answer, √(EI/T), m.
fn bend_length(problem: &Problem, answer: &CableSolution) -> f64 {
    let greatest = answer.nodes.iter().map(|n| n.tension_n).fold(f64::MIN_POSITIVE, larger);
    (problem.bending_stiffness / greatest).sqrt()
}

/// Returns the answer for the flexible cable if the stiffness changes next to nothing; None if it
/// may change more, or if the flexible shape has angles, which stiffness rounds off.
///
/// A bend of curvature κ lowers the tension by EI κ²/2. Where it begins or ends, over a length λ =
/// √(EI/T), it displaces the cable sideways by κλ². The tension changes by at most EA κλ²/L at each
/// such place: the force of a straight bar of the same length L under that elongation.
fn flexible_limit(problem: &Problem, flexible: &CableSolution, tolerance: f64) -> Option<CableSolution> {
    let has_angles = problem.supports.len() > 2
        || !problem.loads.is_empty()
        || problem.supports.iter().any(|s| s.angle.is_some() || s.kind == SupportKind::Pulley);
    if has_angles || !flexible.breaks.is_empty() {
        return None;
    }
    let (mut fall_n, mut aside_m, mut greatest_n) = (0.0f64, 0.0f64, 0.0f64);
    for n in &flexible.nodes {
        let moment = problem.bending_stiffness * n.curvature_per_m.abs();
        fall_n = larger(fall_n, moment * n.curvature_per_m.abs());
        aside_m = larger(aside_m, if moment > 0.0 { moment / n.tension_n } else { 0.0 });
        greatest_n = larger(greatest_n, n.tension_n);
    }
    let places = (2 + 2 * flexible.contacts.len()) as f64;
    let force_n = fall_n + places * aside_m * problem.axial_stiffness / problem.length;
    if !(force_n <= NEGLIGIBLE_FRACTION * tolerance * greatest_n) {
        return None;
    }
    let bent = ErrorEstimates {
        max_tension_n: Some(force_n),
        support_force_n: Some(force_n),
        contact_force_n: (!flexible.contacts.is_empty()).then_some(force_n),
        position_m: Some(places * aside_m),
    };
    let assumptions = Assumptions { bending_stiffness_n_m2: problem.bending_stiffness, ..flexible.assumptions };
    Some(CableSolution { assumptions, ..flexible.clone() }.known_to(flexible.errors.plus(&bent)))
}

/// The nodes of the equilibrium of a chain of bars released at `shape`, if the cable can get there
/// from the shape `from` without passing through an obstacle; None if there is none.
pub fn rest_near(
    problem: &Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    from: &[Node],
    shape: &[Node],
) -> Option<Vec<Node>> {
    let chain = BarChain::rest_near(ChainInput { problem, time_s, dragged, friction_source: None }, shape)?;
    let (found, _) = results::stiffen_and_refine(Elastica::from_chain(&chain)?, problem, BOW_TOLERANCE)?;
    keeps_sides(problem, from, &found).then(|| found.nodes.into())
}

/// True if a cable can have moved from one shape to an answer without passing through an obstacle.
/// Newton's method can pass through: the continuation in EI opens a contact that would have to
/// pull, and a cable that springs off a post may come to rest on its other side.
fn keeps_sides(problem: &Problem, from: &[Node], to: &CableSolution) -> bool {
    let [old, new] = [from, &to.nodes].map(|nodes| nodes.iter().map(Node::at).collect::<Vec<Vec2>>());
    swept_corners::through(&swept_corners::corners(&problem.world), &old, &new, &mut Vec::new()).is_none()
}
