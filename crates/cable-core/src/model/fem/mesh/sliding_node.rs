//! Sliding nodes are points in space over which the cable runs, and for which no mesh has to be
//! fine enough.
//!
//! A chain of bars that is drawn over a sharp corner jerks at every node, and no refinement removes
//! it. So where the cable bends round a corner, a post or a pulley, the mesh has a node that stays
//! there while the material slides through (Sueda, Jones, Levin, Pai, "Large-scale dynamic
//! simulation of highly constrained strands", ACM TOG 2011): its unknown is not where it is but
//! which arc length s is there. With T₁ before and T₂ after, Coulomb's law is
//! ```text
//! stick   e^{−μφ} ≤ T₂/T₁ ≤ e^{μφ}            slide > 0 (s grows)   T₁ = T₂ e^{μφ}        slide < 0   T₂ = T₁ e^{μφ}
//! ```
//! Slipping is written without giving up the energy: multiply the energy of everything after the
//! node by γ = e^{±μφ}, and the slope of the sum by s is −T₁ + γT₂. The equations of the nodes
//! beyond are only scaled by this, and the matrix stays symmetric. A cable of ρ per metre that runs
//! at the speed w needs the momentum ρw² a second to turn, and presses by as much less: in the law
//! both tensions are less by that (as for belts: J. E. Shigley, C. R. Mischke, "Mechanical
//! Engineering Design", McGraw-Hill, 1989, chapter on flexible elements). What is balanced is Θ =
//! T + T²/2EA, the slope of a bar's energy by its own length, so γ is corrected by Θ(γT)/Θ(T)/γ.

use crate::contact::geometry::Geometry;
use crate::math::Vec2;
use crate::model::fem::mesh::tangent_path::{BarEnd, TangentPath, angle_between};

/// The corner, post or pulley of a sliding node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlideOver {
    /// The pulley that is this support.
    Pulley(usize),
    /// A corner or circle of an obstacle.
    Obstacle {
        /// Index of the obstacle in the scene.
        obstacle: usize,
        /// Its feature.
        feature: usize,
    },
}

/// State of friction at a sliding node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StickSlip {
    /// It holds.
    #[default]
    Stick,
    /// It resists a growing arc length: the cable runs towards its start.
    ToStart,
    /// The cable runs towards its end.
    ToEnd,
}

/// A sliding node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingNode {
    /// The round it sits on.
    pub end: BarEnd,
    /// Coulomb friction.
    pub friction: f64,
    /// The corner, post or pulley over which it runs.
    pub slide_over: SlideOver,
    /// State of its friction.
    pub stick_slip: StickSlip,
    /// γ.
    pub factor: f64,
    /// μφ with the turn last seen.
    pub exponent: f64,
    /// Plan view: the floor's friction as the scaled energy sees it, in parts of its own size (see
    /// `floor_friction.rs`).
    pub floor_factor: f64,
    /// Parts of the weight of the bars before and after it on rounds that act there; less than 1
    /// where they are nearly slack (see `bar_weight.rs`).
    pub lying_fractions: [f64; 2],
    /// Tensions between which friction acted in the last step with inertia. None at rest and of a
    /// new node.
    pub balanced: Option<BalancedTensions>,
}

impl SlidingNode {
    /// One on a round, through which nothing has slid yet.
    #[must_use]
    pub fn new(end: BarEnd, friction: f64, slide_over: SlideOver) -> Self {
        Self {
            end,
            friction,
            slide_over,
            stick_slip: StickSlip::Stick,
            factor: 1.0,
            exponent: 0.0,
            floor_factor: 1.0,
            lying_fractions: [1.0; 2],
            balanced: None,
        }
    }

    /// Its position, m.
    #[must_use]
    pub fn position(&self) -> Vec2 {
        self.end.center + self.end.mark * self.end.radius
    }

    /// True if its arc length is held in the present step.
    #[must_use]
    pub fn sticks(&self) -> bool {
        self.friction > 0.0 && self.stick_slip == StickSlip::Stick
    }

    /// The feature it runs over.
    #[must_use]
    pub fn feature(&self) -> Option<usize> {
        match self.slide_over {
            SlideOver::Obstacle { feature, .. } => Some(feature),
            SlideOver::Pulley(_) => None,
        }
    }

    /// True if both sit on one round, in one wrap of the cable: it runs round it in the same sense.
    #[must_use]
    pub fn shares_round(&self, other: &Self) -> bool {
        self.slide_over == other.slide_over && self.end.sense == other.end.sense
    }

    /// True if the cable runs round one round in the one sense and in the other: between the two it
    /// has to turn back beside it, and no tangent leads from the one to the other.
    #[must_use]
    pub fn opposes(&self, other: &Self) -> bool {
        self.slide_over == other.slide_over && self.end.sense != other.end.sense
    }
}

/// Tensions between which friction acted at a sliding node in a step with inertia: tensions as they
/// are reported lack the loss of the bars, and nothing says how what slides speeds up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalancedTensions {
    /// Pull where the cable comes on to the round, less the inertia of what slides, and where it
    /// leaves it, N; both less the momentum that the cable carries over it in a second.
    pub pull: [f64; 2],
    /// Angle through which the cable turned round it, rad.
    pub turn: f64,
    /// Momentum that the cable carries over it in a second, N. The pulls are less by that.
    pub momentum_flux: f64,
}

/// The ways on which a cable comes to a round and leaves it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model::fem) struct RoundPaths {
    /// Directions of both ways.
    direction: [Vec2; 2],
    /// Turn of the cable between them, rad, and its sense; None at a point.
    wrap: Option<(f64, f64)>,
}

impl RoundPaths {
    /// The turn (rad) of a cable that comes with one force (N) and leaves with the other.
    fn turn(&self, force: [Vec2; 2]) -> f64 {
        let Some((arc, sense)) = self.wrap else { return angle_between(force[0], force[1]).abs() };
        let t = self.direction;
        // No force has no direction: the angle to zeros is half a turn where the sign of one of
        // them is lost.
        let between =
            |a: Vec2, b: Vec2| if a == Vec2::zeros() || b == Vec2::zeros() { 0.0 } else { angle_between(a, b) };
        // Nor does what pushes: at the round the cable hangs straight down then.
        let hangs = |j: usize| {
            let pull = force[j].dot(&t[j]);
            if pull < 0.0 { force[j] - t[j] * pull } else { force[j] }
        };
        arc + sense * (between(hangs(0), t[0]) + between(t[1], hangs(1)))
    }
}

/// The load of a sliding node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlidingNodeLoad {
    pub(in crate::model::fem) paths: RoundPaths,
    /// Tension just before and just after, N.
    pub tension: [f64; 2],
    /// The same as the energy's slope sees it: along the bars, not along the sagging cable, N.
    pub pull: [f64; 2],
    /// The same as friction acts on it: the tension in the middle of each bar, and what it takes to
    /// lift the weight from there to the node's mark, N.
    pub lifted: [f64; 2],
    /// The same at its material, as the slope of the bars' energy by the slide sees it, N.
    pub at_material: [f64; 2],
    /// Angle through which the cable turns round it, rad: normal force over tension. Negative: it
    /// wants to leave.
    pub turn: f64,
    /// Normal force, N.
    pub normal: f64,
    /// Internal force just before and just after, N.
    pub force: [Vec2; 2],
    /// Change of the internal force there, N: the opposite of what it runs over does to the cable,
    /// with the floor of a plan view.
    pub jump: Vec2,
    /// Plan view: the floor's friction before, on and after the round, N; positive where the cable
    /// runs towards its start.
    pub floor: [f64; 3],
}

impl SlidingNodeLoad {
    /// The load between two bars with middle tensions `tension` (N) and ways `path`; `body` is the
    /// force per metre (N/m) and `share` the metres of cable from the middle of each bar to the
    /// node.
    ///
    /// dF/ds = −b: the tension force at the node is that of the bar's middle ∓ b·share, and the
    /// turn is from one to the other.
    #[must_use]
    pub fn new(node: &SlidingNode, tension: [f64; 2], path: [&TangentPath; 2], body: Vec2, share: [f64; 2]) -> Self {
        let t = [path[0].direction, path[1].direction];
        let force = [t[0] * tension[0] - body * share[0], t[1] * tension[1] + body * share[1]];
        let ends = [force[0].norm(), force[1].norm()];
        let pull = [force[0].dot(&t[0]), force[1].dot(&t[1])];
        let wrap = (node.end.radius > 0.0).then_some((path[0].arcs[1] + path[1].arcs[0], node.end.sense));
        let paths = RoundPaths { direction: t, wrap };
        let turn = paths.turn(force);
        Self {
            paths,
            tension: ends,
            pull,
            lifted: pull,
            at_material: pull,
            turn,
            normal: 0.5 * (ends[0] + ends[1]) * turn,
            force,
            jump: force[1] - force[0],
            floor: [0.0; 3],
        }
    }

    /// Angle through which the cable turns round it if what slides takes `inertia` (N) from the
    /// pull with which it comes, rad. Friction acts between the pulls that are left: one that grows
    /// from nothing within a step would turn the cable from hanging down to straight.
    #[must_use]
    pub fn turn_with_inertia(&self, inertia: f64) -> f64 {
        self.paths.turn([self.force[0] - self.paths.direction[0] * inertia, self.force[1]])
    }

    /// Pull where the cable comes on to the round and where it leaves it, N: what the floor takes
    /// of the straight halves is not the round's.
    #[must_use]
    pub fn at_round(&self) -> [f64; 2] {
        [self.lifted[0] - self.floor[0], self.lifted[1] + self.floor[2]]
    }

    /// The friction state by the law of friction: `slid` is the slide of the arc length in this
    /// step (m), `inertia` the force (N) that its inertia adds to the slope, `momentum_flux` the
    /// momentum that it carries over in a second (N), `stiffness` is EA (N).
    /// A node holds or slips by the very slope that the step balances: with another, however near
    /// to it, one that is about to slip is said to slip where it holds and to hold where it slips,
    /// for ever.
    #[must_use]
    pub fn stick_slip(
        &self,
        node: &SlidingNode,
        slid: f64,
        [inertia, momentum_flux, slack]: [f64; 3],
        stiffness: f64,
    ) -> StickSlip {
        let cone = node.exponent.exp();
        let [before, after] = self.at_material;
        let slope = |stick_slip: StickSlip| {
            let (ratio, factor) =
                (self.ratio(stick_slip, node.exponent), self.factor(stick_slip, node.exponent, stiffness));
            let floor = self.floor[0] + self.floor[1] * mean_factor(ratio) + self.floor[2] * ratio;
            after * factor + floor - before + inertia - momentum_flux * (factor - 1.0)
        };
        match node.stick_slip {
            StickSlip::Stick if slope(StickSlip::ToStart) < -slack => StickSlip::ToStart,
            StickSlip::Stick if slope(StickSlip::ToEnd) > slack => StickSlip::ToEnd,
            // Without friction both ways are one.
            StickSlip::ToStart if slid < 0.0 && cone > 1.0 => StickSlip::Stick,
            StickSlip::ToEnd if slid > 0.0 && cone > 1.0 => StickSlip::Stick,
            same => same,
        }
    }

    /// Tension before over tension after the round for a friction state.
    #[must_use]
    pub fn ratio(&self, stick_slip: StickSlip, exponent: f64) -> f64 {
        match stick_slip {
            StickSlip::Stick => 1.0,
            StickSlip::ToStart => exponent.exp(),
            StickSlip::ToEnd => (-exponent).exp(),
        }
    }

    /// γ for a friction state, for a cable of axial stiffness `stiffness` (N).
    #[must_use]
    pub fn factor(&self, stick_slip: StickSlip, exponent: f64, stiffness: f64) -> f64 {
        let ratio = self.ratio(stick_slip, exponent);
        let after = self.pull[1];
        ratio * (1.0 + ratio * after / (2.0 * stiffness)) / (1.0 + after / (2.0 * stiffness))
    }
}

/// The round a corner or circle makes for the centre line, `clear` (m) above contact; None where
/// the feature is no convex corner that turns by more than `least` (rad).
#[must_use]
pub fn round_of(geometry: &Geometry, feature: usize, clear: f64, least: f64) -> Option<(Vec2, f64)> {
    // On what moves a sliding node would come and go all the time; the barrier carries a cable
    // there as well.
    let body = geometry.body_of(feature).filter(|b| !b.moves())?;
    if let Some(center) = body.center {
        return Some((center, body.offset + clear));
    }
    let corner = body.corner((feature - body.first) / 2)?;
    let turns = match (corner.before, corner.after) {
        (Some(a), Some(b)) => angle_between(a, b).abs() > least && body.is_exposed(&corner),
        _ => true,
    };
    turns.then_some((corner.at, body.offset + clear))
}

/// (γ − 1)/ln γ.
pub(in crate::model::fem) fn mean_factor(ratio: f64) -> f64 {
    let z = ratio.ln();
    // Beyond the series' third term nothing is left at this size.
    if z.abs() < 1e-4 { 1.0 + z * (0.5 + z / 6.0) } else { (ratio - 1.0) / z }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(sense: f64) -> SlidingNode {
        let end = BarEnd { center: Vec2::zeros(), radius: 0.1, mark: Vec2::y(), sense };
        SlidingNode::new(end, 0.5, SlideOver::Obstacle { obstacle: 0, feature: 0 })
    }

    /// The last node between two such wraps was taken out, and the cable ran through the post.
    #[test]
    fn issue_016_wraps_of_one_round_in_opposite_senses_are_two() {
        let [left, right] = [on(1.0), on(-1.0)];
        assert!(left.shares_round(&left) && !left.opposes(&left));
        assert!(!left.shares_round(&right) && left.opposes(&right));
    }

    /// The cable comes up to a post at 45° and leaves it at 45°, nearly slack; the step that brings
    /// what slides to a stop pulls with 10 N where it comes.
    #[test]
    fn issue_016_friction_turns_by_the_pulls_between_which_it_acts() {
        let node = on(-1.0);
        let ends = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].map(BarEnd::point);
        let paths = [TangentPath::between(&ends[0], &node.end), TangentPath::between(&node.end, &ends[1])];
        let load = |pull: f64| {
            let body = Vec2::new(0.0, -5.0);
            SlidingNodeLoad::new(&node, [pull, 1.0], [&paths[0], &paths[1]], body, [0.1; 2])
        };
        let [slack, taut] = [0.0, 1e-3].map(load);
        // The pull of the bar is not seen in the turn beside what it takes to stop the cable.
        assert!((slack.turn_with_inertia(-10.0) - taut.turn_with_inertia(-10.0)).abs() < 1e-5);
        assert!(taut.turn_with_inertia(0.0).to_bits() == taut.turn.to_bits());
        // Nearly slack it hangs down where it comes.
        assert!(slack.turn > slack.turn_with_inertia(-10.0) + 0.3, "{} {}", slack.turn, slack.turn_with_inertia(-10.0));
    }
}
