//! The time integrator is BDF2, with a part of BDF3 for a cable that can touch nothing.
//!
//! BDF2 with a step ratio ω = h/h₋ (Hairer, Wanner, "Solving ordinary differential equations II",
//! 1996): with α₀ = (1 + 2ω)/(1 + ω) and the history x̂ = ((1 + ω) x₀ − ω²/(1 + ω) x₋)/α₀,
//! ```text
//! v = a (x − x̂),  a = α₀/h,   v̂ likewise,   m a² (x − x̃) + ∂E/∂x − f = 0,   x̃ = x̂ + v̂/a
//! ```
//! If the cable can touch nothing, steps that are even and smooth take a part β of the next
//! order, BDF3: α₀ = (9 + 2β)/6 and x̂ = ((2 + β) x₀ − (½ + β) x₋ + (β/3) x₌)/α₀ at the same cost.
//! Of a vibration ω BDF2 makes one that is slower by (ωh)²/3 and loses ω⁴h³/4 of its amplitude a
//! second; this 1 − β and 1 − 2β of that.

use crate::math::Vec2;
use crate::model::fem::mesh::sliding_node::{BalancedTensions, StickSlip};
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::state::motion::NodalMotion;
use crate::model::fem::system::loss_branches::damping_time;
use crate::model::fem::system::step_input::Unknowns;
use crate::model::fem::time::loss_memory;

/// Part β of BDF3 in a step of a cable that can touch nothing. It is A-stable up to ½; 0.48 is V.
/// N. Vatsa's, M. H. Carpenter's and D. P. Lockard's ("Re-evaluation of an optimized second order
/// backward difference (BDF2OPT) scheme for unsteady flow applications", AIAA 2010-122). Less:
/// vibrations are slower, up to twice, and damped, up to 25 times; more: what bars ring is not
/// damped at all.
const BDF3_PART: f64 = 0.48;

/// The weights of its history in a step: v = a (x − x̂), x̂ = now x₀ − past x₋ + older x₌.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct Weights {
    pub(in crate::model::fem) now: f64,
    pub(in crate::model::fem) past: f64,
    pub(in crate::model::fem) older: f64,
    /// 1/s.
    pub(in crate::model::fem) a: f64,
}

impl Weights {
    /// A step of `h` after one of `before` (s); 0: there is no history.
    fn bdf2(h: f64, before: f64) -> Self {
        let omega = if before > 0.0 { h / before } else { 0.0 };
        let alpha = (1.0 + 2.0 * omega) / (1.0 + omega);
        let past = omega * omega / (1.0 + omega) / alpha;
        Self { now: (1.0 + omega) / alpha, past, older: 0.0, a: alpha / h }
    }

    /// The third of steps of `h` (s) with a part of BDF3.
    fn blended(h: f64) -> Self {
        let alpha = 1.5 + BDF3_PART / 3.0;
        Self {
            now: (2.0 + BDF3_PART) / alpha,
            past: (0.5 + BDF3_PART) / alpha,
            older: BDF3_PART / 3.0 / alpha,
            a: alpha / h,
        }
    }

    pub(in crate::model::fem) fn place(self, m: &NodalMotion, k: usize) -> Vec2 {
        self.of([&m.positions, &m.previous_positions, &m.older_positions], k)
    }

    fn velocity(self, m: &NodalMotion, k: usize) -> Vec2 {
        self.of([&m.velocities, &m.previous_velocities, &m.older_velocities], k)
    }

    fn of(self, [now, before, older]: [&[Vec2]; 3], k: usize) -> Vec2 {
        let recent = now[k] * self.now - before[k] * self.past;
        if self.older > 0.0 { recent + older[k] * self.older } else { recent }
    }

    /// Those of a step of `h` (s) after a motion.
    pub(in crate::model::fem) fn of_step(motion: &NodalMotion, h: f64) -> Self {
        if motion.looks_back_three(h) { Self::blended(h) } else { Self::bdf2(h, motion.step_before) }
    }
}

/// Keeps the tensions and the turn between which friction acts at each sliding node.
pub(in crate::model::fem) fn keep_balanced_tensions(cable: &mut CableState, unknowns: &Unknowns) {
    for k in 0..cable.mesh.nodes() {
        let Some(load) = cable.step_context().load_at(k, &unknowns.positions, Some(&unknowns.slides)) else { continue };
        let inertia = cable.input.inertia[k] * (unknowns.slides[k] - cable.input.predicted_slide[k]);
        if let Some(node) = &mut cable.mesh.sliding[k] {
            let [comes, leaves] = load.at_round();
            // The step balances slopes by the slide, where inertia counts by what is stretched.
            let [before, after] = load.at_material;
            let stretch = 1.0 + 0.5 * (comes + leaves) / cable.mesh.axial_stiffness;
            let pulls = match node.stick_slip {
                _ if load.floor != [0.0; 3] => comes - inertia,
                StickSlip::Stick => leaves + (before - inertia - after) / stretch,
                slips => load.ratio(slips, node.exponent) * leaves,
            };
            node.balanced = Some(BalancedTensions { pull: [pulls, leaves], turn: load.turn });
        }
    }
}

/// Reports the supports that did not reach their targets; their hands start again from where they
/// are.
pub(in crate::model::fem) fn report_held_back(cable: &mut CableState, unknowns: &Unknowns) {
    for (support, node) in cable.meshing.support_node.iter().enumerate() {
        let Some(k) = node.filter(|&k| cable.mesh.held[k]) else { continue };
        if unknowns.positions[k] != cable.input.target[k] && !cable.answers.held_back.contains(&support) {
            cable.answers.held_back.push(support);
        }
        if let Some(f) = &mut cable.motion.followers[support]
            && f.position() != unknowns.positions[k]
        {
            f.stop_at(unknowns.positions[k]);
        }
    }
}

/// Inertia and damping of a step of `h` (s).
///
/// The rate of a length has no history where velocities jump between two steps (a plastic
/// impulse, a change of the mesh): two steps extrapolate through the jump and add ½ EA τ Δv/l₀
/// to the loss, 150 kN where nodes are 3 cm apart. So the loss of a cable that may touch
/// something is that of the step itself, EA τ (P − P₀)/(L h). It is a first-order error of a
/// small force, ¾ τ/h of that which BDF2 makes of a vibration.
pub(in crate::model::fem) fn set_inertia(cable: &mut CableState, weights: Weights, h: f64, decay: &mut Vec<f64>) {
    let Weights { now, past, a, .. } = weights;
    let rubs = !(cable.meets_nothing() && cable.meshing.never_slides && cable.problem.floor_friction.is_none());
    let jumps = !cable.meets_nothing();
    let (m, input, mesh) = (&cable.motion, &mut cable.input, &cable.mesh);
    for k in 0..m.positions.len() {
        input.predicted[k] = weights.place(m, k) + weights.velocity(m, k) / a;
        input.inertia[k] = cable.problem.linear_density * mesh.tributary_length(k) * a * a;
        if mesh.sliding[k].is_some() {
            let w_hat = m.slide_rates[k] * now - m.previous_slide_rates[k] * past;
            let s = mesh.arc_length[k];
            input.predicted_slide[k] = s * now - m.previous_arc_length[k] * past + w_hat / a - s;
        }
    }
    // Of the masses alone: hands draw at their nodes, not at what these are coupled with.
    let predicted = &input.predicted;
    input.coupling.extend(mesh.spread.coupling.iter().enumerate().map(|(e, length)| {
        let chord = predicted[e + 1] - predicted[e];
        (cable.problem.linear_density * length * a * a, chord)
    }));
    for (s, node) in cable.problem.supports.iter().zip(&cable.meshing.support_node) {
        if let Some(k) = node {
            input.inertia[*k] += s.mass * a * a;
        }
    }
    for (hand, node) in m.hands.iter().zip(&cable.meshing.support_node) {
        let (Some(hand), Some(k)) = (hand, *node) else { continue };
        let (stiffness, at) = hand.pull(h, m.positions[k]);
        let (inertia, both) = (input.inertia[k], input.inertia[k] + stiffness);
        input.predicted[k] = (input.predicted[k] * inertia + at * stiffness) / both;
        input.inertia[k] = both;
        input.hands.push((k, stiffness, at));
    }
    input.moves = true;
    let (rate, time) = (if jumps { 1.0 / h } else { a }, damping_time(&cable.problem, rubs));
    input.loss.fill([cable.problem.axial_stiffness * time * rate; 2]);
    input.bending_damping = mesh.bending_stiffness * time / h;
    for e in 0..mesh.rest_length.len() {
        input.predicted_length[e] = if jumps || mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some() {
            mesh.path(e, &m.positions).length
        } else {
            let length = |x: &[Vec2]| (x[e + 1] - x[e]).norm();
            let older = if weights.older > 0.0 { length(&m.older_positions) * weights.older } else { 0.0 };
            length(&m.positions) * now - length(&m.previous_positions) * past + older
        };
    }
    loss_memory::add(cable, h, rate, decay);
}
