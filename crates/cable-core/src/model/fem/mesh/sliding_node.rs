//! Sliding nodes are points in space over which the cable runs; they need no fine mesh.
//!
//! A chain of bars that is drawn over a sharp corner jerks at every node, and no refinement removes
//! these jerks. So where the cable bends round a corner, a post or a pulley, the mesh has a node
//! that stays there while the material slides through (Sueda, Jones, Levin, Pai, "Large-scale
//! dynamic simulation of highly constrained strands", ACM TOG 2011): its unknown is not its
//! position but the arc length s at it. With the tensions T₁ before and T₂ after it, Coulomb's law
//! is
//! ```text
//! stick   e^{−μφ} ≤ T₂/T₁ ≤ e^{μφ}            slide > 0 (s grows)   T₁ = T₂ e^{μφ}        slide < 0   T₂ = T₁ e^{μφ}
//! ```
//! Slip is expressed through the energy: if the energy of everything after the node is multiplied
//! by γ = e^{±μφ}, the slope of the sum by s is −T₁ + γT₂. The equations of the nodes beyond are
//! only scaled by γ, and the matrix stays symmetric. A cable of ρ per metre that runs at the speed
//! w turns by a momentum flux ρw², and its normal force is smaller by that: the law uses both
//! tensions less ρw² (as for belts: J. E. Shigley, C. R. Mischke, "Mechanical Engineering Design",
//! McGraw-Hill, 1989, chapter on flexible elements). The energy balances Θ = T + T²/2EA, the slope
//! of a bar's energy by its own length, instead of T, so γ is corrected by Θ(γT)/Θ(T)/γ.

use crate::contact::geometry::Geometry;
use crate::math::{Vec2, larger, smaller};
use crate::model::fem::mesh::tangent_path::{BarEnd, TangentPath, angle_between};

/// Exponent z below which (e^z − 1)/z is a series of three terms, of which the next is below
/// round-off. Smaller: the quotient loses digits; larger: the series does.
const MAX_SERIES_EXPONENT: f64 = 1e-4;

/// The corner, post or pulley of a sliding node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlideOver {
    /// The pulley that is this support.
    Pulley(usize),
    /// A corner or circle of an obstacle.
    Obstacle {
        /// Index of the obstacle in the scene.
        obstacle: usize,
        /// Index of the feature.
        feature: usize,
    },
}

/// State of friction at a sliding node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StickSlip {
    /// It holds.
    #[default]
    Stick,
    /// The arc length at the node grows: the cable runs towards its start.
    ToStart,
    /// The arc length at the node falls: the cable runs towards its end.
    ToEnd,
}

/// A sliding node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingNode {
    /// The round on which it sits.
    pub end: BarEnd,
    /// Coulomb friction coefficient.
    pub friction: f64,
    /// The corner, post or pulley over which it runs.
    pub slide_over: SlideOver,
    /// State of its friction.
    pub stick_slip: StickSlip,
    /// The factor γ.
    pub factor: f64,
    /// μφ with the turn φ of the last assembly.
    pub exponent: f64,
    /// Plan view: the factor of the floor's friction in the scaled energy (see
    /// `floor_friction.rs`).
    pub floor_factor: f64,
    /// Lying fractions of the bars before and after it: the part of their weight on rounds that
    /// acts there, less than 1 where they are nearly slack (see `bar_weight.rs`).
    pub lying_fractions: [f64; 2],
    /// Tensions between which friction acted in the last step with inertia. None at rest and for a
    /// new node.
    pub balanced: Option<BalancedTensions>,
}

impl SlidingNode {
    /// A sliding node on a round, through which no material has slid yet.
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

    /// The feature over which the cable runs.
    #[must_use]
    pub fn feature(&self) -> Option<usize> {
        match self.slide_over {
            SlideOver::Obstacle { feature, .. } => Some(feature),
            SlideOver::Pulley(_) => None,
        }
    }

    /// True if both sit on one round in one wrap of the cable: the cable runs round it in the same
    /// sense.
    #[must_use]
    pub fn shares_round(&self, other: &Self) -> bool {
        self.slide_over == other.slide_over && self.end.sense == other.end.sense
    }

    /// True if both sit on one round and the cable runs round it in opposite senses: between the
    /// two it has to turn back beside the round, and no tangent leads from one to the other.
    #[must_use]
    pub fn opposes(&self, other: &Self) -> bool {
        self.slide_over == other.slide_over && self.end.sense != other.end.sense
    }
}

/// Tensions between which friction acted at a sliding node in a step with inertia. The reported
/// tensions do not suffice: they lack the damping of the bars and the acceleration of the sliding
/// cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalancedTensions {
    /// Pull where the cable meets the round, less the inertia of the sliding cable, and pull where
    /// it leaves it, N; both less the momentum flux.
    pub pull: [f64; 2],
    /// Angle through which the cable turned round it, rad.
    pub turn: f64,
    /// Momentum flux of the cable over it, N, by which the pulls are reduced.
    pub momentum_flux: f64,
    /// Force with which point loads pressed on it, N.
    pub pressed: f64,
}

/// The paths on which a cable meets a round and leaves it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model::fem) struct RoundPaths {
    /// Directions of both paths.
    direction: [Vec2; 2],
    /// Turn of the cable between them, rad, and its sense; None at a point.
    wrap: Option<(f64, f64)>,
    /// Part of the force at each of the two ends that is weight, N.
    weight: [Vec2; 2],
}

impl RoundPaths {
    /// The turn (rad) of a cable that meets the round with one force (N) and leaves it with the
    /// other.
    fn turn(&self, force: [Vec2; 2]) -> f64 {
        let Some((arc, sense)) = self.wrap else { return angle_between(force[0], force[1]).abs() };
        let t = self.direction;
        // A zero force has no direction: the angle to it would be half a turn if one of its zeros
        // has a minus sign.
        let between =
            |a: Vec2, b: Vec2| if a == Vec2::zeros() || b == Vec2::zeros() { 0.0 } else { angle_between(a, b) };
        // A compressed end has no direction either: the cable then hangs straight down at the
        // round, or lies along its path if it has no weight there. (Of the whole force, rounding
        // would remain.)
        let across = |j: usize| self.weight[j] - t[j] * self.weight[j].dot(&t[j]);
        let hangs = |j: usize| if force[j].dot(&t[j]) < 0.0 { across(j) } else { force[j] };
        arc + sense * (between(hangs(0), t[0]) + between(t[1], hangs(1)))
    }
}

/// The loads on a sliding node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlidingNodeLoad {
    pub(in crate::model::fem) paths: RoundPaths,
    /// Tension just before and just after, N.
    pub tension: [f64; 2],
    /// Pull just before and just after in the slope of the energy: along the bars, not along the
    /// sagging cable, N.
    pub pull: [f64; 2],
    /// Pull just before and just after on which friction acts: the tension in the middle of each
    /// bar, and the weight between there and the node's mark, N.
    pub lifted: [f64; 2],
    /// Pull on its material in the slope of the bars' energy by the slide, N.
    pub at_material: [f64; 2],
    /// Angle through which the cable turns round it, rad: normal force over tension. If negative,
    /// the cable tends to leave the round.
    pub turn: f64,
    /// Normal force, N.
    pub normal: f64,
    /// Internal force just before and just after, N.
    pub force: [Vec2; 2],
    /// Change of the internal force there, N: the opposite of the force of the round on the cable,
    /// with that of the floor in plan view.
    pub jump: Vec2,
    /// Plan view: the floor's friction before, on and after the round, N; positive if the cable
    /// runs towards its start.
    pub floor: [f64; 3],
    /// Pull that point loads on the round add before and after its mark, N.
    pub carried: [f64; 2],
    /// Force with which these loads press on the round, N.
    pub pressed: f64,
}

impl SlidingNodeLoad {
    /// The loads between two bars with middle tensions `tension` (N) and paths `path`; `body` is
    /// the force per metre (N/m) and `share` the length of cable (m) from the middle of each bar to
    /// the node.
    ///
    /// dF/ds = −b: the tension force at the node is that of the bar's middle ∓ b·share, and the
    /// turn is from one to the other.
    #[must_use]
    pub fn new(node: &SlidingNode, tension: [f64; 2], path: [&TangentPath; 2], body: Vec2, share: [f64; 2]) -> Self {
        let t = [path[0].direction, path[1].direction];
        let weight = [-body * share[0], body * share[1]];
        let force = [t[0] * tension[0] + weight[0], t[1] * tension[1] + weight[1]];
        let ends = [force[0].norm(), force[1].norm()];
        let pull = [force[0].dot(&t[0]), force[1].dot(&t[1])];
        let wrap = (node.end.radius > 0.0).then_some((path[0].arcs[1] + path[1].arcs[0], node.end.sense));
        let paths = RoundPaths { direction: t, wrap, weight };
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
            carried: [0.0; 2],
            pressed: 0.0,
        }
    }

    /// Angle (rad) through which the cable turns round it if the inertia of the sliding cable takes
    /// `inertia` (N) from the pull where it meets the round. Friction acts between the remaining
    /// pulls: a pull that grows from zero within a step would turn the cable from hanging down to
    /// straight.
    #[must_use]
    pub fn turn_with_inertia(&self, inertia: f64) -> f64 {
        self.paths.turn([self.force[0] - self.paths.direction[0] * inertia, self.force[1]])
    }

    /// The turn (rad) under its pull by which the cable would press as much as the loads do.
    #[must_use]
    pub fn pressed_turn(&self) -> f64 {
        let pull = 0.5 * (self.at_material[0] + self.at_material[1]);
        // A nearly slack cable is held by its load in any case.
        if self.pressed > 0.0 { smaller(self.pressed / larger(pull, 0.0), std::f64::consts::TAU) } else { 0.0 }
    }

    /// Pull where the cable meets the round and where it leaves it, N: without the floor's friction
    /// on the straight halves of the bars, and with the loads on the round.
    #[must_use]
    pub fn at_round(&self) -> [f64; 2] {
        [self.lifted[0] + self.carried[0] - self.floor[0], self.lifted[1] + self.carried[1] + self.floor[2]]
    }

    /// The friction state by the law of friction: `slid` is the slide of the arc length in this
    /// step (m), `inertia` the force (N) of inertia in the slope, `momentum_flux` the momentum flux
    /// (N), `stiffness` is EA (N). Stick and slip are decided with exactly the slope that the step
    /// balances. With any other value, however close, a node about to slip would alternate between
    /// both states for ever.
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
            // Without friction both directions are the same.
            StickSlip::ToStart if slid < 0.0 && cone > 1.0 => StickSlip::Stick,
            StickSlip::ToEnd if slid > 0.0 && cone > 1.0 => StickSlip::Stick,
            same => same,
        }
    }

    /// Ratio of the tension before the round to that after it for a friction state.
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

/// Centre and radius (m) of the round of a corner or circle for the centre line, `clear` (m) above
/// contact. None if the feature is a corner that is not convex or turns by less than `least` (rad).
#[must_use]
pub fn round_of(geometry: &Geometry, feature: usize, clear: f64, least: f64) -> Option<(Vec2, f64)> {
    // On a moving body a sliding node would come and go all the time; the barrier carries a cable
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
    if z.abs() < MAX_SERIES_EXPONENT { 1.0 + z * (0.5 + z / 6.0) } else { (ratio - 1.0) / z }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn on(sense: f64) -> SlidingNode {
        let end = BarEnd { center: Vec2::zeros(), radius: 0.1, mark: Vec2::y(), sense };
        SlidingNode::new(end, 0.5, SlideOver::Obstacle { obstacle: 0, feature: 0 })
    }

    /// The last node between two such wraps was removed, and the cable ran through the post.
    #[test]
    fn issue_016_wraps_of_one_round_in_opposite_senses_are_two() {
        let [left, right] = [on(1.0), on(-1.0)];
        assert!(left.shares_round(&left) && !left.opposes(&left));
        assert!(!left.shares_round(&right) && left.opposes(&right));
    }

    /// The nearly slack cable comes up to a post at 45° and leaves it at 45°; the step that stops
    /// the slide pulls with 10 N where it meets the post.
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
        // The pull of the bar has no visible effect on the turn beside the force that stops the
        // cable.
        assert!((slack.turn_with_inertia(-10.0) - taut.turn_with_inertia(-10.0)).abs() < 1e-5);
        assert!(taut.turn_with_inertia(0.0).to_bits() == taut.turn.to_bits());
        // Nearly slack, it hangs down where it meets the post.
        assert!(slack.turn > slack.turn_with_inertia(-10.0) + 0.3, "{} {}", slack.turn, slack.turn_with_inertia(-10.0));
    }

    proptest! {
        /// A floor carries the weight of a cable seen from above, and a compressed end of it has no
        /// direction: what rounding left of its force gave the turn any value.
        #[test]
        fn issue_016_a_compressed_end_without_weight_turns_by_the_arc(
            x in -1.0..1.0, y in -2.0..-0.2, tension in -1.0..0.0, inertia in 0.0..1.0,
        ) {
            let node = on(-1.0);
            let ends = [Vec2::new(x - 1.0, y), Vec2::new(x + 1.0, y)].map(BarEnd::point);
            let paths = [TangentPath::between(&ends[0], &node.end), TangentPath::between(&node.end, &ends[1])];
            let arc = paths[0].arcs[1] + paths[1].arcs[0];
            let paths = [&paths[0], &paths[1]];
            let load = SlidingNodeLoad::new(&node, [tension, 1.0], paths, Vec2::zeros(), [0.1; 2]);
            prop_assert!((load.turn_with_inertia(inertia) - arc).abs() < 1e-12, "{} {arc}", load.turn_with_inertia(inertia));
        }
    }
}
