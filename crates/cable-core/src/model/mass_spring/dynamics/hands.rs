//! Hands that hold supports by springs. The node is held, at the velocity that its own mass has
//! between the cable and the spring: that is taken at the end of the sub-step, so no spring is too
//! stiff for it.

use crate::math::Vec2;
use crate::model::input_filter::Hand;
use crate::model::mass_spring::MassSpringModel;
use crate::model::mass_spring::xpbd::constraint_solve::Chain;

impl MassSpringModel {
    /// The free end of a hand that holds a support goes on for `h` (s).
    pub(in crate::model::mass_spring) fn follow_hand(&mut self, support: usize, h: f64) {
        let (node, Some(target)) = (self.chain.node_of[support], self.drives.drag[support]) else { return };
        let (known, held_by) = (self.drives.hands[support], -self.chain.f[node]);
        let mut hand = known.unwrap_or_else(|| {
            Hand::grip(&self.problem, self.settings.hand_stiffness_n_per_m, self.chain.x[node], held_by)
        });
        hand.follow(target, h, self.settings.hand_speed_m_per_s);
        (self.drives.hands[support], self.drives.followers[support]) = (Some(hand), None);
    }

    /// Velocities of what hands hold after a `kick` (s) of the sub-step's forces; the spring is as
    /// at its end, `h` (s) later.
    pub(in crate::model::mass_spring) fn pull_by_hands(&mut self, [kick, h]: [f64; 2]) {
        for (hand, &node) in self.drives.hands.iter().zip(&self.chain.node_of) {
            let Some(hand) = hand else { continue };
            let (mass, before) = (self.chain.mass[node], self.chain.v[node]);
            let (stiffness, at) = hand.pull(h, self.chain.x[node]);
            let push = self.chain.f[node] + (at - self.chain.x[node]) * stiffness;
            let v = (before * mass + push * kick) / (mass + stiffness * h * kick);
            self.drives.held_acceleration[node] = (v - before) / kick;
            self.report.account.supports += (v - before) * mass;
            self.chain.v[node] = v;
        }
    }

    /// Returns where nodes that hands hold go without springs of the cable in a preview's sub-step
    /// of `h` (s): nodes and their velocities before it.
    pub(in crate::model::mass_spring) fn predict_hands(&mut self, h: f64, chain: &mut Chain) -> Vec<(usize, Vec2)> {
        let mut found = Vec::new();
        for (hand, &node) in self.drives.hands.iter().zip(&self.chain.node_of) {
            let Some(hand) = hand else { continue };
            let (mass, before) = (self.chain.mass[node], self.chain.v[node]);
            let (stiffness, at) = hand.pull(h, self.chain.x[node]);
            let push = self.chain.f[node] + (at - self.chain.x[node]) * stiffness;
            let heavier = mass + stiffness * h * h;
            chain.x[node] = self.chain.x[node] + (before * mass + push * h) * (h / heavier);
            chain.inverse[node] = heavier.recip();
            found.push((node, before));
        }
        found
    }

    /// Says which hands lag, and which supports lag behind them.
    pub(in crate::model::mass_spring) fn warn_of_hands(&mut self) {
        for (k, hand) in self.drives.hands.iter().enumerate() {
            let (Some(hand), node) = (hand, self.chain.node_of[k]) else { continue };
            let force = -self.on_support(node);
            let fastest = self.settings.hand_speed_m_per_s;
            let warning = hand.warning(&self.problem, k, self.chain.s[node], self.chain.x[node], force, fastest);
            self.report.warnings.extend(warning);
        }
    }
}
