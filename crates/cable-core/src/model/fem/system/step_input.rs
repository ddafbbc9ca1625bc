//! This module defines the input of a step, its unknowns and its outcome.

pub use crate::error::FailureCause;
use crate::math::Vec2;
use crate::model::fem::mesh::Mesh;
use crate::problem::Problem;

/// Least load per metre, as a fraction of the whole load over the cable's length: that of a cable
/// that weighs nothing. Smaller: its contacts are softer than its loads need; larger: those of
/// light cables with heavy loads are stiffer. A choice, tuned on no campaign.
const LEAST_LINE_LOAD_FRACTION: f64 = 1e-3;

/// Fraction of force times coordinate that counts as magnitude of an energy: with the noise of an
/// energy it is four roundings of the coordinate. Without it, a stiff pendulum's last iteration is
/// lost in the round-off of 98 N times 1 m and its step is halved without need.
pub const WORK_MAGNITUDE_FRACTION: f64 = 0.01;

/// Accepted unbalanced force, as a fraction of the whole load.
const FORCE_TOLERANCE_FRACTION: f64 = 1e-6;

/// Round-off of the strain of a bar that may remain in its axial force, in units of the last place.
/// Smaller: steps of stiff cables never converge; larger: their forces are less accurate than
/// possible. A choice, tuned on no campaign.
const STRAIN_ROUNDINGS: f64 = 64.0;

/// Size of coordinates in lengths of a bar, which multiplies the round-off of a strain. Smaller and
/// larger: as for `STRAIN_ROUNDINGS`.
const COORDINATE_BARS: f64 = 100.0;

/// Round-off of the inertia force of a node, in units of the last place. Smaller: small steps of
/// heavy point masses fail; larger: they are less accurate.
const INERTIA_ROUNDINGS: f64 = 16.0;

/// The unknowns of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unknowns {
    /// Position of each node, m; for a sliding node that of its mark.
    pub positions: Vec<Vec2>,
    /// Slide of the arc length at each sliding node in this step, m.
    pub slides: Vec<f64>,
}

/// The input of a step.
#[derive(Clone, Debug, Default)]
pub struct StepInput {
    /// Factor of each bar's energy (see `sliding_node`); 1 without friction at sliding nodes.
    pub scale: Vec<f64>,
    /// Inertia, and the springs of hands, which enter like inertia.
    pub inertial: InertialTerms,
    /// Loss of bars and bends.
    pub losses: LossTerms,
    /// Forces from outside.
    pub loads: Loads,
    /// Targets of the supports, and positions at the start of the step.
    pub supports: SupportTargets,
    /// Criteria at which the iteration ends.
    pub stopping: StoppingCriteria,
}

/// Inertia of the nodes in a step.
#[derive(Clone, Debug, Default)]
pub struct InertialTerms {
    /// True if it is a step with inertia.
    pub moves: bool,
    /// Inertia of each node, mᵢ a², N/m.
    pub stiffness: Vec<f64>,
    /// Predicted position x̃ of each node, m.
    pub predicted: Vec<Vec2>,
    /// Predicted slide of each sliding node, m.
    pub predicted_slide: Vec<f64>,
    /// Momentum flux of the cable over each sliding node, N: ρw² at its rate w when the step
    /// begins. The tension less this flux presses on the round.
    pub momentum_flux: Vec<f64>,
    /// For each bar the inertia that couples its nodes (m a², N/m) and its predicted chord (m);
    /// empty if there is none.
    pub coupling: Vec<(f64, Vec2)>,
    /// The springs of hands, which are included in inertia and prediction of their nodes.
    pub hands: Vec<HandSpring>,
}

/// A spring by which a hand holds a node in a step.
#[derive(Clone, Copy, Debug)]
pub struct HandSpring {
    pub node: usize,
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Position of its other end, m.
    pub at: Vec2,
}

/// Loss in a step.
#[derive(Clone, Debug, Default)]
pub struct LossTerms {
    /// Damping stiffness of each bar when taut and when slack, N: EA τ a for viscous damping (0:
    /// none).
    pub bars: Vec<[f64; 2]>,
    /// Predicted length of each bar, m.
    pub predicted_length: Vec<f64>,
    /// Length of each bar at which the damping of a taut bar has no force, m.
    pub damped_from: Vec<f64>,
    /// Engineering strain of the material of each bar at the start of the step.
    pub material_strain: Vec<f64>,
    /// Bars beside the wheels of pulleys, with the length (m) of the path of each at the start of
    /// the step, before the wheels move.
    pub lengths_at_wheels: Vec<(usize, f64)>,
    /// Damping stiffness of bends, N m² (0: none): that of all their loss, and the part of it that
    /// is viscous.
    pub bending: [f64; 2],
    /// The turn of each bend at the start of the step and that at which its loss has no moment,
    /// rad, in its slots (`branch_moments.rs`).
    pub turns: [Vec<f64>; 2],
}

/// Forces from outside in a step.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// Distributed force, N/m.
    pub body: Vec2,
    /// External force on each node, N.
    pub force: Vec<Vec2>,
    /// Point loads that run over rounds.
    pub on_rounds: Vec<RoundLoad>,
    /// Plan view: largest friction force of each node, N (empty otherwise).
    pub floor_limit: Vec<f64>,
    /// The time at which the forces hold, s.
    pub time_s: f64,
}

/// A point load that runs over the round of a sliding node. The round carries it; along the cable
/// it pulls at the material there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundLoad {
    /// The sliding node.
    pub node: usize,
    /// The force, N.
    pub force: Vec2,
    /// The way of the material under the load for a slide of one metre, as the step begins.
    pub way: Vec2,
    /// The side of the node's mark on which it is: 0 before it, 1 after it.
    pub side: usize,
}

impl Loads {
    /// The force of the loads that run over the round of a sliding node, N.
    #[must_use]
    pub fn on_round(&self, node: usize) -> Vec2 {
        self.on_rounds.iter().filter(|load| load.node == node).map(|load| load.force).sum()
    }

    /// The forces of these loads on the slide of the node, N: of those before and after its mark.
    #[must_use]
    pub fn on_slide(&self, node: usize) -> [f64; 2] {
        let mut out = [0.0; 2];
        for load in self.on_rounds.iter().filter(|load| load.node == node) {
            out[load.side] += load.force.dot(&load.way);
        }
        out
    }
}

/// Targets of the supports of a step, and the positions at its start.
#[derive(Clone, Debug, Default)]
pub struct SupportTargets {
    /// Target of each held node, m (others: ignored).
    pub target: Vec<Vec2>,
    /// True if held nodes may stop short of their targets because of an obstacle or the cable.
    pub may_lag: bool,
    /// True if an outline or a post that moves may squeeze the cable against an obstacle.
    pub has_moving_bodies: bool,
    /// Positions at the start of the step, m.
    pub start: Vec<Vec2>,
    /// Nodes that slide over wheels of pulleys, with the velocity of the wheel (m/s) at the end of
    /// the step.
    pub wheel_velocities: Vec<(usize, Vec2)>,
    /// Positions from which the iteration begins, m, if a body moved; else empty.
    pub cleared: Vec<Vec2>,
}

/// The criteria at which the iteration of a step ends.
#[derive(Clone, Copy, Debug, Default)]
pub struct StoppingCriteria {
    /// Unbalanced force to reach, N.
    pub tolerance: f64,
    /// Greatest unbalanced force that is accepted if contact forces are known no better, N.
    pub max_noise: f64,
    /// Maximum number of iterations.
    pub max_iterations: usize,
    /// Largest move of a node in one iteration, m.
    pub max_move: f64,
    /// First shift of the Hessian, N/m.
    pub shift: f64,
}

impl StepInput {
    /// EA τ a of a bar with a sliding node, N.
    #[inline]
    #[must_use]
    pub fn damping(&self, e: usize) -> f64 {
        self.losses.bars.get(e).map_or(0.0, |c| c[0])
    }

    /// Positions from which the iteration begins, m.
    #[must_use]
    pub fn begins(&self) -> &[Vec2] {
        if self.supports.cleared.is_empty() { &self.supports.start } else { &self.supports.cleared }
    }

    /// Sets the factor of each bar's energy from the friction states of the sliding nodes before
    /// it.
    pub(in crate::model::fem) fn set_scale(&mut self, mesh: &Mesh) {
        let mut scale = 1.0;
        self.scale.clear();
        for e in 0..mesh.rest_length.len() {
            if let Some(s) = &mesh.sliding[e] {
                scale *= s.factor;
            }
            self.scale.push(scale);
        }
    }

    /// Unbalanced force to reach in a step with inertia, N: at least the round-off of m a² (x − x̃)
    /// at positions `at` (m). That grows as the step shrinks: with 5 kg at 20 m and 1/4000 s the
    /// force is known only to 1e-6 N.
    pub(in crate::model::fem) fn rounded_tolerance(&self, at: &[Vec2]) -> f64 {
        let mut tolerance = self.stopping.tolerance;
        for (inertia, x) in self.inertial.stiffness.iter().zip(at) {
            let rounding = INERTIA_ROUNDINGS * f64::EPSILON * inertia * x.norm();
            if rounding > tolerance {
                tolerance = rounding;
            }
        }
        tolerance
    }
}

/// The work that a search may still do, in iterations times nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorkBudget {
    /// The caller bounds the work in another way.
    Unlimited,
    /// So much work is left.
    Left(usize),
}

impl WorkBudget {
    /// True if nothing is left.
    #[must_use]
    pub fn is_spent(self) -> bool {
        self == Self::Left(0)
    }

    /// Subtracts one iteration of so many nodes.
    pub fn spend(&mut self, nodes: usize) {
        if let Self::Left(left) = self {
            *left = left.saturating_sub(nodes);
        }
    }
}

/// The reason why a step failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// Worst node.
    pub node: usize,
    /// Its unbalanced force, N.
    pub residual: f64,
    /// The cause.
    pub cause: FailureCause,
}

/// The outcome of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Converged {
    /// Newton iterations.
    pub iterations: usize,
    /// Largest unbalanced force left, N.
    pub residual: f64,
}

/// Factor of the equations of a node.
#[inline]
pub(in crate::model::fem) fn node_scale(input: &StepInput, node: usize) -> f64 {
    input.scale.get(node.saturating_sub(1)).copied().unwrap_or(1.0)
}

/// Load per metre that presses on the ground (N/m), and the whole load (N); neither is 0.
pub(in crate::model::fem) fn load_scale(problem: &Problem) -> (f64, f64) {
    // The normal force on the floor of a plan view counts by its friction.
    let floor = problem.floor_friction.map_or(0.0, |(friction, normal)| friction * normal);
    let whole = problem.force_scale().max(problem.max_whole_floor_friction());
    let per_m = problem.body_force(0.0).norm().max(floor).max(LEAST_LINE_LOAD_FRACTION * whole / problem.length);
    (per_m, whole)
}

/// Unbalanced force to reach, N: at least the round-off of the axial forces.
pub(in crate::model::fem) fn tolerance(problem: &Problem, whole: f64) -> f64 {
    let rounding = STRAIN_ROUNDINGS * f64::EPSILON * problem.axial_stiffness * COORDINATE_BARS;
    (FORCE_TOLERANCE_FRACTION * whole).max(rounding)
}
