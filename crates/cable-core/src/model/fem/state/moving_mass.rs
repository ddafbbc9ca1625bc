//! The momentum of a cable, and what a change of its mesh does to that.

use crate::math::Vec2;
use crate::model::fem::mesh::{Mesh, SlideOver};
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::state::meshing::Meshing;
use crate::model::fem::state::momentum_account::{CONTACTS, SUPPORTS, kind_of};
use crate::model::fem::state::motion::NodalMotion;
use crate::problem::Problem;

/// The masses of a cable and how they move.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct MovingMass<'a> {
    problem: &'a Problem,
    mesh: &'a Mesh,
    meshing: &'a Meshing,
    motion: &'a NodalMotion,
}

impl<'a> MovingMass<'a> {
    /// Those of a cable.
    pub(in crate::model::fem) fn of(cable: &'a CableState) -> Self {
        let CableState { problem, mesh, meshing, motion, .. } = cable;
        Self { problem, mesh, meshing, motion }
    }

    /// Momentum of cable and lumps, kg m/s.
    pub(in crate::model::fem) fn momentum(&self) -> Vec2 {
        let [pulleys, rounds] = self.sliding_momentum();
        self.moved_by(&self.motion.velocities) + pulleys + rounds
    }

    /// The same of the nodes that move with their material, at velocities `v` (m/s).
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

    /// The same of the material at sliding nodes: that on pulleys, and that on rounds of obstacles.
    pub(in crate::model::fem) fn sliding_momentum(&self) -> [Vec2; 2] {
        [SUPPORTS, CONTACTS]
            .map(|kind| self.slid_by(&self.motion.slide_rates, |slide_over| kind_of(slide_over) == kind))
    }

    /// The same of all of it, at rates `w` (m/s) of the arc length.
    pub(in crate::model::fem) fn sliding_momentum_at(&self, w: &[f64]) -> Vec2 {
        self.slid_by(w, |_| true)
    }

    /// Half of it runs each way.
    fn slid_by(&self, w: &[f64], counts: impl Fn(SlideOver) -> bool) -> Vec2 {
        let mut sum = Vec2::zeros();
        if self.meshing.never_slides {
            return sum;
        }
        let (mesh, x) = (self.mesh, &self.motion.positions);
        for k in 1..mesh.nodes().saturating_sub(1) {
            if !mesh.sliding[k].is_some_and(|node| counts(node.slide_over)) {
                continue;
            }
            let s = &mesh.arc_length;
            let ways =
                mesh.path(k - 1, x).direction * (s[k] - s[k - 1]) + mesh.path(k, x).direction * (s[k + 1] - s[k]);
            sum -= ways * (0.5 * self.problem.linear_density * w[k]);
        }
        sum
    }
}

/// Makes a change of the mesh by which a node begins to slide over something or ends that: what the
/// change does to the momentum counts as the impulse of that thing.
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
