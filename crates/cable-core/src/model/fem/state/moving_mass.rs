//! This module computes the momentum of a cable, and the change of it by a change of the mesh.

use crate::math::Vec2;
use crate::model::fem::mesh::{Mesh, SlideOver};
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::state::meshing::Meshing;
use crate::model::fem::state::momentum_account::{CONTACTS, SUPPORTS, kind_of};
use crate::model::fem::state::motion::NodalMotion;
use crate::problem::Problem;

/// The masses of a cable and their motion.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct MovingMass<'a> {
    problem: &'a Problem,
    mesh: &'a Mesh,
    meshing: &'a Meshing,
    motion: &'a NodalMotion,
}

impl<'a> MovingMass<'a> {
    /// The moving masses of a cable.
    pub(in crate::model::fem) fn of(cable: &'a CableState) -> Self {
        let CableState { problem, mesh, meshing, motion, .. } = cable;
        Self { problem, mesh, meshing, motion }
    }

    /// Momentum of cable and point masses, kg m/s.
    pub(in crate::model::fem) fn momentum(&self) -> Vec2 {
        let [pulleys, rounds] = self.sliding_momentum();
        self.moved_by(&self.motion.velocities) + pulleys + rounds
    }

    /// Momentum of all material now and one step ago, kg m/s.
    pub(in crate::model::fem) fn momenta(&self) -> [Vec2; 2] {
        let m = self.motion;
        [(&m.velocities, &m.slide_rates), (&m.previous_velocities, &m.previous_slide_rates)]
            .map(|(v, w)| self.moved_by(v) + self.slid_by(v, w))
    }

    /// Momentum of the material nodes at velocities `v` (m/s), kg m/s.
    pub(in crate::model::fem) fn moved_by(&self, v: &[Vec2]) -> Vec2 {
        let mesh = self.mesh;
        let mut sum = Vec2::zeros();
        for (k, v) in v.iter().enumerate() {
            if mesh.sliding[k].is_none() {
                sum += v * mesh.tributary_length(k);
            }
        }
        sum *= self.problem.linear_density;
        for (s, node) in self.problem.supports.iter().zip(&self.meshing.support_node) {
            if let Some(v) = node.and_then(|k| v.get(k)).filter(|_| s.mass > 0.0) {
                sum += v * s.mass;
            }
        }
        sum
    }

    /// Momentum of the material at sliding nodes, kg m/s: on pulleys, and on rounds of obstacles.
    pub(in crate::model::fem) fn sliding_momentum(&self) -> [Vec2; 2] {
        let NodalMotion { velocities, slide_rates, .. } = self.motion;
        [SUPPORTS, CONTACTS].map(|kind| self.slid_over(velocities, slide_rates, |over| kind_of(over) == kind))
    }

    /// Momentum of all material at sliding nodes whose rounds move at `v` (m/s), at rates `w` (m/s)
    /// of the arc length, kg m/s.
    pub(in crate::model::fem) fn slid_by(&self, v: &[Vec2], w: &[f64]) -> Vec2 {
        self.slid_over(v, w, |_| true)
    }

    /// Half of the material of a sliding node moves along each of its bars, and all of it with its
    /// round.
    fn slid_over(&self, v: &[Vec2], w: &[f64], counts: impl Fn(SlideOver) -> bool) -> Vec2 {
        let mut sum = Vec2::zeros();
        if self.meshing.never_slides {
            return sum;
        }
        let (mesh, x) = (self.mesh, &self.motion.positions);
        for k in 1..mesh.nodes().saturating_sub(1) {
            if !mesh.sliding[k].as_ref().is_some_and(|node| counts(node.slide_over)) {
                continue;
            }
            let s = &mesh.arc_length;
            let ways = mesh.direction(k - 1, x) * (s[k] - s[k - 1]) + mesh.direction(k, x) * (s[k + 1] - s[k]);
            sum += (v[k] * (s[k + 1] - s[k - 1]) - ways * w[k]) * (0.5 * self.problem.linear_density);
        }
        sum
    }
}

/// Makes a change of the mesh by which a node begins or ends to slide over a round, and counts the
/// change of momentum as an impulse of that round.
pub(in crate::model::fem) fn attribute_to<R>(
    cable: &mut CableState,
    slide_over: SlideOver,
    change: impl FnOnce(&mut CableState) -> R,
) -> R {
    let history = |d: &CableState| {
        let mass = MovingMass::of(d);
        mass.moved_by(&d.motion.velocities) - mass.moved_by(&d.motion.previous_velocities)
    };
    let (before, known) = (MovingMass::of(cable).momentum(), history(cable));
    let done = change(cable);
    let (given, changed) = (MovingMass::of(cable).momentum() - before, history(cable) - known);
    let (account, kind) = (&mut cable.motion.account, kind_of(slide_over));
    account.add(kind, given);
    account.late[kind] += given;
    account.last[kind] += changed;
    done
}
