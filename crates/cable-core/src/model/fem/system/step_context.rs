//! The step context holds everything that the solvers of one step read.

use crate::contact::friction;
use crate::math::{Vec2, larger};
use crate::model::fem::mesh::{Mesh, SlidingNodeLoad};
use crate::model::fem::system::bar_energy;
use crate::model::fem::system::bar_weight::Weight;
use crate::model::fem::system::contact::contact_set::ContactSet;
use crate::model::fem::system::contact::floor_friction;
use crate::model::fem::system::step_input::StepInput;
use crate::problem::Problem;

/// The input of the solve of a step: cable, mesh, contacts, and the input of the step.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct StepContext<'a> {
    /// The cable and its obstacles.
    pub problem: &'a Problem,
    /// Its nodes and bars.
    pub mesh: &'a Mesh,
    /// The barrier, and friction as it is frozen for the step.
    pub contacts: &'a ContactSet,
    /// Forces, inertia and targets of the step.
    pub input: &'a StepInput,
}

impl StepContext<'_> {
    /// True if the cable is flexible and can touch nothing but its supports on the way to positions
    /// `to` (m).
    pub(in crate::model::fem) fn moves_freely(&self, to: &[Vec2]) -> bool {
        !self.mesh.slides_anywhere()
            && self.problem.floor_friction.is_none()
            && self.mesh.bending_stiffness == 0.0
            && self.is_out_of_reach(to)
    }

    /// True if the cable can touch nothing but its supports on the way to positions `to` (m).
    pub(in crate::model::fem) fn is_out_of_reach(&self, to: &[Vec2]) -> bool {
        self.contacts.meets_nothing(self.problem)
            || (!self.contacts.self_contacts.shape.is_on()
                && self.contacts.out_of_reach(self.mesh, [&self.input.supports.start, to]))
    }

    /// The load of a sliding node at positions `x` (m) and, if given, slides (m).
    pub(in crate::model::fem) fn load_at(
        &self,
        k: usize,
        x: &[Vec2],
        slide: Option<&[f64]>,
    ) -> Option<SlidingNodeLoad> {
        let (mesh, node) = (self.mesh, self.mesh.sliding.get(k)?.as_ref()?);
        if k == 0 || k + 1 >= mesh.nodes() {
            return None;
        }
        let path = [mesh.path(k - 1, x), mesh.path(k, x)];
        let rest = [k - 1, k].map(|e| slide.map_or(mesh.rest_length[e], |s| bar_energy::rest_length(mesh, e, s)));
        // A step balances the force of a bar with its damping.
        let tension = [0, 1].map(|j| {
            if slide.is_some() && self.input.inertial.moves {
                return bar_energy::pull_on(mesh, self.input, k - 1 + j, x, rest[j]);
            }
            let tension = mesh.tension_with(k - 1 + j, path[j].length, rest[j]);
            if tension < 0.0 { 0.0 } else { tension }
        });
        let body = self.input.loads.body;
        let weight = [0, 1].map(|j| Weight::of(mesh, k - 1 + j, &path[j], body));
        let material = rest.map(|l| l / mesh.thermal_stretch);
        let share = [0, 1].map(|j| weight[j].carried_material(material[j])[1 - j]);
        let flexible = true;
        let straight = [0, 1].map(|j| weight[j].tension_in_middle(tension[j], material[j], flexible));
        let floor = self.problem.floor_friction.map_or([0.0; 3], |(rough, normal)| {
            let slid = self.contacts.floor_slip[k].x + slide.map_or(0.0, |s| s[k]);
            let per_m = friction::at(slid, rough * normal, self.contacts.slip).1;
            floor_friction::reaches(mesh, k, x, slide).map(|reach| per_m * reach)
        });
        let load = SlidingNodeLoad::new(node, straight, [&path[0], &path[1]], body, share);
        // Between steps the input may belong to another mesh, and nothing is balanced.
        let at_material = slide.map_or(load.pull, |slide| {
            [k - 1, k].map(|e| bar_energy::pull_at_slide(mesh, self.input, e, k - e, x, slide))
        });
        // Without friction Θ = T + T²/(2 EA) changes by the force that lifts the weight: a
        // stretched cable weighs less per metre.
        let compliance = 1.0 / mesh.axial_stiffness;
        let lifted = [0, 1].map(|j| {
            let lift = body.dot(&(weight[j].center - x[k])) / mesh.thermal_stretch;
            let theta = tension[j] * (1.0 + 0.5 * compliance * tension[j]) + lift;
            2.0 * theta / (1.0 + larger(1.0 + 2.0 * compliance * theta, 0.0).sqrt())
        });
        let [before, after] = self.input.loads.on_slide(k);
        let [comes, leaves] = at_material;
        let pressed = larger(-self.input.loads.on_round(k).dot(&node.end.mark), 0.0);
        let at_material = [comes + before, leaves - after];
        Some(SlidingNodeLoad { floor, lifted, at_material, carried: [before, -after], pressed, ..load })
    }
}

/// Greatest displacement of a node in a step, m; NaN if any is NaN.
pub(in crate::model::fem) fn longest(step: &[f64]) -> f64 {
    // Four independent maxima at a time let the processor work in parallel.
    let (mut most, mut undefined) = ([0.0_f64; 4], false);
    for moves in step.chunks(8) {
        for (most, d) in most.iter_mut().zip(moves.chunks_exact(2)) {
            let square = d[0] * d[0] + d[1] * d[1];
            undefined |= square.is_nan();
            *most = if square > *most { square } else { *most };
        }
    }
    if undefined { f64::NAN } else { most.into_iter().fold(0.0, larger).sqrt() }
}
