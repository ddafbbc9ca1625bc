//! Supports move the nodes that they hold.

use crate::math::Vec2;
use crate::model::Settings;
use crate::model::hand::Hand;
use crate::model::mass_spring::dynamics::Clock;
use crate::model::mass_spring::dynamics::momentum::MomentumSums;
use crate::model::mass_spring::mesh::{Mesh, release_pulleys};
use crate::model::smoothed_target::{SmoothedTarget, is_led, lag_warning};
use crate::solution::Warning;

part! {
    /// The supports that hold nodes, and the targets and hands that lead them.
    #[derive(Default)]
    SupportDrives {
        /// Nodes that their support has let go as the present sub-step began.
        released: Vec<usize>,
        /// Point to which each support is dragged, m, if it is.
        targets: Vec<Option<Vec2>>,
        /// The same, smoothed.
        smoothed: Vec<Option<SmoothedTarget>>,
        /// True for dragged supports that a hand holds by a spring.
        by_spring: Vec<bool>,
        /// Those hands.
        hands: Vec<Option<Hand>>,
        /// Greatest speed at which any support has moved, m/s.
        max_speed: f64,
    }
}

/// Limits of hands that drag supports.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::mass_spring) struct HandSettings {
    pub max_speed_m_per_s: f64,
    /// Stiffness of the spring by which a hand holds a support, N/m, if it is given.
    pub stiffness_n_per_m: Option<f64>,
}

impl HandSettings {
    pub(in crate::model::mass_spring) fn of(settings: &Settings) -> Self {
        Self { max_speed_m_per_s: settings.hand_speed_m_per_s, stiffness_n_per_m: settings.hand_stiffness_n_per_m }
    }
}

impl SupportDrives {
    /// A number of supports that nobody drags.
    pub(in crate::model::mass_spring) fn new(supports: usize) -> Self {
        Self {
            targets: vec![None; supports],
            smoothed: vec![None; supports],
            by_spring: vec![false; supports],
            hands: vec![None; supports],
            ..Self::default()
        }
    }

    /// Takes over what drags the supports of another mesh of the cable.
    pub(in crate::model::mass_spring) fn take_drags(&mut self, other: &Self) {
        self.max_speed = other.max_speed;
        self.targets.clone_from(&other.targets);
        self.smoothed.clone_from(&other.smoothed);
        self.by_spring.clone_from(&other.by_spring);
        self.hands.clone_from(&other.hands);
    }

    /// From now on supports are dragged as in `other`, those that are dragged already as fast as
    /// they are.
    pub(in crate::model::mass_spring) fn continue_to(&mut self, other: &Self) {
        self.targets.clone_from(&other.targets);
        self.by_spring.clone_from(&other.by_spring);
        for (k, target) in self.targets.iter().enumerate() {
            self.smoothed[k] = self.smoothed[k].filter(|_| target.is_some());
            self.hands[k] = self.hands[k].filter(|_| target.is_some());
        }
    }

    /// Sets the velocities that bring supported nodes to where their supports are at the end of a
    /// sub-step of `h` (s); a support that is dragged keeps to `max_speed_m_per_s`.
    pub(in crate::model::mass_spring) fn move_nodes(
        &mut self,
        mesh: &mut Mesh,
        clock: &Clock,
        max_speed_m_per_s: f64,
        account: &mut MomentumSums,
        h: f64,
    ) {
        let begins_s = clock.time_s - h;
        self.released.clear();
        for (support, &node) in mesh.problem.supports.iter().zip(&mesh.support_node) {
            if mesh.supported[node] && !support.holds_from(begins_s) {
                self.released.push(node);
            }
        }
        mesh.supported.fill(false);
        for (k, support) in mesh.problem.supports.iter().enumerate() {
            // A support that lets go at the end of the sub-step holds to its end.
            let Some((at, _)) = support.place_at(clock.time_s).filter(|_| support.holds_from(begins_s)) else {
                self.hands[k] = None;
                continue;
            };
            let node = mesh.support_node[k];
            mesh.supported[node] = true;
            if self.by_spring[k] {
                continue;
            }
            let to = match self.targets[k] {
                None => at,
                Some(target) => {
                    let begins = match self.hands[k].take() {
                        Some(_) => SmoothedTarget::moving(mesh.position[node], mesh.velocity[node]),
                        None => SmoothedTarget::at_rest(mesh.position[node]),
                    };
                    let follower = self.smoothed[k].get_or_insert(begins);
                    if is_led(&mesh.problem, k) {
                        let left = clock.due_s - clock.time_s + h;
                        follower.lead(target, if left > h { h / left } else { 1.0 }, h);
                    } else {
                        follower.follow(target, h, max_speed_m_per_s);
                    }
                    follower.position()
                }
            };
            let v = (to - mesh.position[node]) / h;
            mesh.support_acceleration[node] = (v - mesh.velocity[node]) / h;
            account.supports += (v - mesh.velocity[node]) * mesh.mass[node];
            mesh.velocity[node] = v;
        }
    }

    /// Takes back the kick of the time `hold_time_s` (s) in which nodes that were let go as the
    /// sub-step began were still held: their supports carried their forces then.
    pub(in crate::model::mass_spring) fn correct_released(
        &self,
        mesh: &mut Mesh,
        account: &mut MomentumSums,
        hold_time_s: f64,
    ) {
        for &i in &self.released {
            let impulse = mesh.force[i] * hold_time_s;
            mesh.velocity[i] -= impulse / mesh.mass[i];
            account.supports -= impulse;
        }
    }

    /// Puts the centres of pulleys where they are now.
    pub(in crate::model::mass_spring) fn place_pulleys(&self, mesh: &mut Mesh, time_s: f64) {
        for k in 0..mesh.wheels.pulleys.len() {
            let p = mesh.wheels.pulleys[k];
            if let Some((at, _)) = mesh.problem.supports[p.support].position_at(time_s) {
                mesh.position[p.node] = self.targets[p.support].unwrap_or(at);
                mesh.velocity[p.node] = Vec2::zeros();
            }
        }
    }

    /// Puts supported nodes where their supports are now.
    pub(in crate::model::mass_spring) fn place_nodes(&mut self, mesh: &mut Mesh, time_s: f64) {
        release_pulleys(mesh, time_s);
        mesh.supported.fill(false);
        for (k, support) in mesh.problem.supports.iter().enumerate() {
            let Some((at, _)) = support.position_at(time_s) else { continue };
            let node = mesh.support_node[k];
            mesh.supported[node] = true;
            mesh.support_acceleration[node] = Vec2::zeros();
            mesh.position[node] = self.targets[k].unwrap_or(at);
            self.smoothed[k] = None;
            self.hands[k] = None;
        }
    }

    /// Warnings of supports that stay behind what drags them.
    pub(in crate::model::mass_spring) fn warnings(&self, mesh: &Mesh, max_speed_m_per_s: f64) -> Vec<Warning> {
        let behind = self.smoothed.iter().enumerate().filter_map(|(k, f)| Some((k, f.as_ref()?)));
        let behind = behind.filter(|(_, f)| f.behind_m() > 0.0);
        let s = |k: usize| mesh.arc_length[mesh.support_node[k]];
        behind.map(|(k, f)| lag_warning(&mesh.problem, k, s(k), f, max_speed_m_per_s)).collect()
    }
}
