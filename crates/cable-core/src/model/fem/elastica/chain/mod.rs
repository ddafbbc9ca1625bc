//! A chain of bars is released and relaxes to rest. It finds the equilibrium of a stiff cable whose
//! contacts differ from those of a flexible one, and tests whether an equilibrium is stable.
//!
//! | room | content |
//! |---|---|
//! | `initial_mesh.rs` | bars laid along a curve, with a node at each support and load |
//! | `chain_contacts.rs` | gaps of nodes and bars to obstacles; which contacts push |
//! | `newton_step.rs` | one Newton step with tensions as unknowns and an active set of contacts |
//! | `relaxation.rs` | pseudo-transient continuation to rest; a push sideways off unstable balances |
//! | `solution.rs` | a chain at rest as an answer: nodes, moments, reactions, contact reports |
//!
//! Bars of rest length l̂ between nodes x, the angle ψ between two of them, weight and loads b,
//! obstacles at gaps g:
//! ```text
//! E(x) = Σ EA (|d| − l̂)²/2l̂ + Σ EI ψ²/2l̄ − Σ b·x        least, with every g ≥ 0
//! ```
//! The chain is laid along a curve (`initial_mesh`) and comes to rest by Newton's method with a
//! resistance to motion that fades (`relaxation`, of steps by `newton_step`). Obstacles enter as
//! contacts that the step opens and closes (`chain_contacts`), and a chain at rest is written as an
//! answer (`solution`). At the end the second derivative of E on the active set is positive
//! definite: the equilibrium is stable.

mod chain_contacts;
mod initial_mesh;
mod newton_step;
mod relaxation;
mod solution;

use crate::energy::bending::turn;
use crate::math::Vec2;
use crate::model::fem::elastica::reference_curve::ReferenceCurve;
use crate::model::fem::first_shape::leaning_way;
use crate::problem::Problem;
use crate::solution::{CableSolution, Node};
pub(super) use chain_contacts::ChainContact;
pub(super) use relaxation::{CLAMPED_EULER, LYING_EULER, RestState};

/// Ratio of a bar's length to its unstretched length below which an answer is folded there.
/// Smaller: folds of a slack flexible cable crush a stiff one; larger: chains start from the route
/// although the shape of the answer would do.
const FOLDED_BAR_FRACTION: f64 = 0.97;

/// Shortest bar of an answer that is tested for folds, as a fraction of the cable's length.
const FOLDED_BAR_LENGTH_FRACTION: f64 = 1e-3;

/// Distance, in bars, by which a relaxed chain may differ from the answer that it started from.
/// Smaller: the error of a coarse chain counts as motion; larger: answers that give way a little
/// pass for stable.
const STABILITY_DISTANCE_BARS: f64 = 2.0;

/// Resistance with which a chain that is nearly at rest begins, as a fraction of the first
/// resistance.
const REDUCED_RESISTANCE_FACTOR: f64 = 1e-2;

/// The scene at one instant, which all chains of a search share.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChainInput<'a> {
    pub(super) problem: &'a Problem,
    pub(super) time_s: f64,
    /// The places to which supports are dragged, m.
    pub(super) dragged: &'a [Option<Vec2>],
    /// The answer from which the mobilised friction of each contact is read; None: contacts are
    /// frictionless.
    pub(super) friction_source: Option<&'a CableSolution>,
}

/// A node whose bar, before or after it, has a prescribed direction.
#[derive(Clone, Copy, Debug)]
struct ChainClamp {
    node: usize,
    side: ClampedSide,
    direction: Vec2,
}

/// The bar of a clamped node whose direction is prescribed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ClampedSide {
    Before,
    After,
}

impl ChainClamp {
    /// Index of the bar.
    fn bar(&self) -> usize {
        match self.side {
            ClampedSide::Before => self.node - 1,
            ClampedSide::After => self.node,
        }
    }
}

/// A chain of bars.
#[derive(Clone, Debug)]
pub(super) struct BarChain<'a> {
    pub(super) chain_input: ChainInput<'a>,
    /// Weight and wind, N per metre of arc length.
    body: Vec2,
    /// Arc length of each node, m.
    arc: Vec<f64>,
    /// Positions of the nodes, m.
    positions: Vec<Vec2>,
    /// Rest lengths of the bars at present, m. They grow to the unstretched lengths.
    rest: Vec<f64>,
    /// Lengths of the bars without tension, m.
    unstretched: Vec<f64>,
    /// Tension of each bar, N.
    tension: Vec<f64>,
    /// True for nodes that a support holds.
    fixity: Vec<bool>,
    clamps: Vec<ChainClamp>,
    /// Weight, wind and dead loads at each node, N.
    load: Vec<Vec2>,
    contacts: Vec<ChainContact>,
    /// Forces of the scene, N.
    scale: f64,
    /// Length of a bar, m.
    pub(super) bar: f64,
    /// Number of Newton steps so far.
    pub(super) steps: usize,
    /// Number of its bars over that of the coarsest chain.
    refinement: f64,
}

/// The outcome of releasing a chain from an answer.
pub(super) enum StabilityOutcome<'a> {
    /// The chain stays: the answer is stable.
    Stays,
    /// The chain runs away and rests elsewhere.
    Leaves(Box<BarChain<'a>>),
    /// The chain stays where it is, but its second derivative is not positive definite: any
    /// disturbance would move it.
    Unstable,
    /// The scene has things that a chain does not model, or the chain does not come to rest.
    Unknown,
}

/// The route of a cable as nodes.
fn nodes_along_route(problem: &Problem) -> Vec<Node> {
    let node = |(s, x): (f64, Vec2)| Node { arc_length_m: s, x_m: x.x, y_m: x.y, ..Node::default() };
    leaning_way(problem).into_iter().map(node).collect()
}

/// True if material of an answer lies in folds. A stiff cable has none.
pub(super) fn is_folded(problem: &Problem, answer: &CableSolution) -> bool {
    let least = FOLDED_BAR_LENGTH_FRACTION * problem.length;
    answer.nodes.windows(2).any(|p| {
        let ds = p[1].arc_length_m - p[0].arc_length_m;
        ds > least && (p[1].at() - p[0].at()).norm() < FOLDED_BAR_FRACTION * ds
    })
}

/// A chain at stable rest, released from the answer for a flexible cable, or from the route if that
/// answer has folds. None if the chain does not come to rest.
pub(super) fn rest_of_flexible(chain_input: ChainInput<'_>) -> Option<BarChain<'_>> {
    let problem = chain_input.problem;
    let usable = |l: &&CableSolution| l.nodes.len() > 1 && l.breaks.is_empty() && !is_folded(problem, l);
    let flexible = chain_input.friction_source.filter(usable);
    let route = nodes_along_route(problem);
    if route.len() < 2 {
        return None;
    }
    let of_flexible =
        flexible.and_then(|l| BarChain::along(ChainInput { friction_source: flexible, ..chain_input }, &l.nodes, 1.0));
    let of_route = || BarChain::along(ChainInput { friction_source: None, ..chain_input }, &route, 1.0);
    let mut chain = of_flexible.or_else(of_route)?;
    if chain.relax(1.0) != RestState::Stable {
        return None;
    }
    let mut bowed = chain.clone();
    let rests = bowed.bow_crushed() && bowed.relax(REDUCED_RESISTANCE_FACTOR) == RestState::Stable;
    Some(if rests { bowed } else { chain })
}

/// Releases a chain from an answer for the stiff cable, with the friction of that answer.
pub(super) fn test_stability<'a>(chain_input: ChainInput<'a>, answer: &'a CableSolution) -> StabilityOutcome<'a> {
    let chain_input = ChainInput { friction_source: Some(answer), ..chain_input };
    let Some(mut chain) = BarChain::along(chain_input, &answer.nodes, 1.0) else { return StabilityOutcome::Unknown };
    let from = chain.positions.clone();
    let state = chain.relax(REDUCED_RESISTANCE_FACTOR);
    let near = STABILITY_DISTANCE_BARS * chain.bar;
    let stays = from.iter().zip(&chain.positions).all(|(a, b)| (a - b).norm() <= near);
    match state {
        RestState::Stable if stays => StabilityOutcome::Stays,
        RestState::Stable => StabilityOutcome::Leaves(Box::new(chain)),
        RestState::Unstable => StabilityOutcome::Unstable,
        RestState::NotFound => StabilityOutcome::Unknown,
    }
}

impl<'a> BarChain<'a> {
    /// The same cable with bars of half the length, released from this shape, and the state in
    /// which it ends.
    pub(super) fn halved(&self) -> Option<(Self, RestState)> {
        let mut fine = Self::along(self.chain_input, &self.nodes(), 2.0 * self.refinement)?;
        let state = fine.relax(REDUCED_RESISTANCE_FACTOR);
        Some((fine, state))
    }

    /// A chain at stable rest, released from a shape; None if it does not come to rest.
    pub(super) fn rest_near(chain_input: ChainInput<'a>, shape: &[Node]) -> Option<Self> {
        let mut chain = Self::along(ChainInput { friction_source: None, ..chain_input }, shape, 1.0)?;
        (chain.relax(REDUCED_RESISTANCE_FACTOR) == RestState::Stable).then_some(chain)
    }

    /// The chain along nodes; see [`BarChain::along_curve`].
    fn along(chain_input: ChainInput<'a>, nodes: &[Node], refinement: f64) -> Option<Self> {
        Self::along_curve(chain_input, &ReferenceCurve::new(nodes), refinement)
    }

    /// Unit vector along a bar.
    fn direction(&self, bar: usize) -> Vec2 {
        (self.positions[bar + 1] - self.positions[bar]).normalize()
    }

    /// Curvatures at all nodes, 1/m of unstretched length.
    fn curvatures(&self) -> Vec<f64> {
        let n = self.positions.len();
        let mut curvatures = vec![0.0; n];
        for k in 1..n - 1 {
            let psi = turn(self.positions[k] - self.positions[k - 1], self.positions[k + 1] - self.positions[k]);
            curvatures[k] = psi / (0.5 * (self.arc[k + 1] - self.arc[k - 1]));
        }
        for clamp in &self.clamps {
            let bar = clamp.bar();
            let d = self.positions[bar + 1] - self.positions[bar];
            let psi = match clamp.side {
                ClampedSide::After => turn(clamp.direction, d),
                ClampedSide::Before => turn(d, clamp.direction),
            };
            curvatures[clamp.node] = psi / (0.5 * (self.arc[bar + 1] - self.arc[bar]));
        }
        curvatures
    }

    /// Its nodes as those of an answer: positions, tensions and curvatures.
    pub(super) fn nodes(&self) -> Vec<Node> {
        let n = self.positions.len();
        let curvatures = self.curvatures();
        let tension = |k: usize| 0.5 * (self.tension[k.saturating_sub(1)] + self.tension[k.min(n - 2)]);
        (0..n)
            .map(|k| Node {
                arc_length_m: self.arc[k],
                x_m: self.positions[k].x,
                y_m: self.positions[k].y,
                tension_n: tension(k),
                curvature_per_m: curvatures[k],
                ..Node::default()
            })
            .collect()
    }
}
