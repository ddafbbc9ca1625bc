//! The step bound limits a Newton step: no node moves too far, no obstacle is crossed, and some
//! cable remains beside sliding nodes.

use crate::contact::sweep::Sweep;
use crate::math::Vec2;
use crate::model::fem::mesh::{BarEnd, Mesh, StraightPart};
use crate::model::fem::newton::step_potential::Workspace;
use crate::model::fem::system::{StepContext, StepInput, Unknowns, longest};

impl Workspace {
    /// The greatest fraction of the direction with which no node moves too far.
    pub(in crate::model::fem) fn max_step_fraction(&self, input: &StepInput) -> f64 {
        let largest = longest(&self.direction);
        if largest > input.stopping.max_move { input.stopping.max_move / largest } else { 1.0 }
    }

    /// The greatest part of the direction (at most `fraction`) that crosses no obstacle and leaves
    /// some cable between sliding nodes and their neighbours.
    pub(in crate::model::fem) fn ccd_step_bound(
        &mut self,
        step: &StepContext<'_>,
        unknowns: &Unknowns,
        fraction: f64,
    ) -> f64 {
        let StepContext { problem, mesh, contacts, .. } = *step;
        let (direction, geometry) = (&self.direction, problem.world.geometry());
        let move_of = |k: usize| Vec2::new(direction[2 * k], direction[2 * k + 1]);
        let tuning = &mesh.tuning.newton;
        let most = tuning.bound_margin * tuning.landing_gap_fraction * contacts.barrier.reach;
        let mut free = fraction;
        for e in 0..mesh.rest_length.len() {
            let slides = [e, e + 1].map(|k| mesh.sliding[k].is_some());
            if slides != [false, false] {
                free = self.remaining_cable_bound(mesh, unknowns, e, free);
            }
            if problem.world.is_empty() || slides == [true, true] || mesh.is_break(e) {
                continue;
            }
            let x = &unknowns.positions;
            if slides == [false, false] {
                let ends = [x[e], x[e + 1]];
                if contacts.search.lists.is_clear(
                    e,
                    [ends, [ends[0] + move_of(e) * free, ends[1] + move_of(e + 1) * free]],
                    most,
                ) {
                    continue;
                }
            }
            let from = mesh.straight(e, x);
            let to = if slides == [false, false] {
                [from[0] + move_of(e) * free, from[1] + move_of(e + 1) * free]
            } else {
                let end =
                    |k: usize| mesh.sliding[k].as_ref().map_or(BarEnd::point(x[k] + move_of(k) * free), |s| s.end);
                StraightPart::of(&end(e), &end(e + 1)).ends
            };
            let sweep = Sweep::new(from, to, mesh.tuning.newton.kept_gap_fraction).at_most(most);
            free *= match contacts.search.lists.of(e, [from, to], sweep.margin) {
                Some([]) => 1.0,
                Some(parts) => geometry.free_fraction_among(parts.iter().copied(), &sweep, mesh.rounds(e)),
                None => geometry.free_fraction_round(&sweep, mesh.rounds(e)),
            };
        }
        let limits = [mesh.tuning.newton.kept_gap_fraction, most, free];
        contacts.self_contacts.shape.free_fraction(
            &unknowns.positions,
            &mesh.arc_length,
            &move_of,
            limits,
            &mut self.self_contact.order,
        )
    }

    /// The greatest part of the direction, at most `free`, that leaves some cable in bar e, which
    /// has a sliding node.
    fn remaining_cable_bound(&self, mesh: &Mesh, unknowns: &Unknowns, e: usize, free: f64) -> f64 {
        let go = [e, e + 1].map(|k| if mesh.sliding[k].is_some() { self.direction[2 * k] } else { 0.0 });
        let change = go[1] - go[0];
        let whole = mesh.rest_length[e] / mesh.thermal_stretch + unknowns.slides[e + 1] - unknowns.slides[e];
        let straight = mesh.straight_length(e, &unknowns.positions);
        let length = if straight > 0.0 && straight < whole { straight } else { whole };
        let spare = (1.0 - mesh.tuning.newton.kept_cable_fraction) * length;
        if change < 0.0 && -change * free > spare { spare / -change } else { free }
    }

    /// The same bound, from the positions of the last assembly. A step shorter than the smallest
    /// gap is free in any direction. This holds for nearly all last iterations, where sweeps of
    /// every bar would cost as much as the rest of the iteration.
    pub(in crate::model::fem) fn step_bound_from_assembly(
        &mut self,
        step: &StepContext<'_>,
        unknowns: &Unknowns,
        fraction: f64,
    ) -> f64 {
        let StepContext { mesh, contacts, .. } = *step;
        let still = |k: usize| self.direction[2 * k] == 0.0 && self.direction[2 * k + 1] == 0.0;
        let plain = || {
            !contacts.self_contacts.shape.is_on()
                && (0..mesh.nodes()).all(|k| mesh.sliding[k].is_none() && (!mesh.fixity[k] || still(k)))
        };
        let gaps = self.touches.iter().map(|t| t.pair.gap.gap_m);
        let least = gaps.fold(contacts.barrier.reach, |a, b| if b < a { b } else { a });
        let is_short = fraction * longest(&self.direction) <= (1.0 - mesh.tuning.newton.kept_gap_fraction) * least;
        if is_short && plain() { fraction } else { self.ccd_step_bound(step, unknowns, fraction) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::Curvature;
    use crate::model::Settings;
    use crate::model::fem::stepper::Stepper;
    use crate::problem::problems;
    use crate::scene::{Obstacle, Shape, Support, catalog};
    use proptest::prelude::*;

    /// A cable that lies in a shallow dip with both ends released. Convex corners would have
    /// sliding nodes, which are always checked.
    fn lying() -> Stepper {
        let mut scene = catalog::hanging_span();
        let points_m = vec![[-4.0, 0.0], [3.0, -0.1], [11.0, 0.1]];
        let shape = Shape::Terrain { points_m };
        scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape, friction: Some(0.5) }];
        let c = &mut scene.cables[0];
        (c.length_m, c.bending_stiffness_n_m2) = (6.0, 0.0);
        let hook = |name: &str, x| Support { release_s: Some(1e-3), ..Support::fixed(name, [x, 0.4]) };
        c.supports = vec![hook("a", 0.0), hook("b", 5.9)];
        let settings = Settings { segments: Some(60), ..Settings::default() };
        let mut d = Stepper::new(problems(&scene).unwrap().remove(0), settings, Default::default()).unwrap();
        d.settle(&[]).unwrap();
        for _ in 0..240 {
            d.advance(1.0 / 240.0, crate::model::Inertia::Dynamic, &[]).unwrap();
        }
        d
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]
        /// A step that counts as free without a sweep is also free by the sweep.
        #[test]
        fn a_short_way_is_free(seed in prop::collection::vec(-0.5f64..0.5, 122), down in 0.0f64..1.0) {
            let mut d = lying();
            d.begin_step(1.0 / 240.0, &[]).unwrap();
            let unknowns = d.solver.present_unknowns(&d.cable);
            d.cable.contacts.prepare(&d.cable.problem, &d.cable.mesh, &unknowns.positions, &d.cable.motion.positions);
            let mut memory = Workspace::new(&d.cable.mesh).unwrap();
            let step = d.cable.step_context();
            memory.assemble(&step, &unknowns, Curvature::Exact);
            prop_assert!(memory.touches.len() > 10, "{} touch", memory.touches.len());
            let gaps = memory.touches.iter().map(|t| t.pair.gap.gap_m);
            let least = gaps.fold(f64::INFINITY, |a, b| if b < a { b } else { a });
            for gaps in [0.01, 0.1, 0.3, 0.5, 0.7, 1.0, 2.0, 10.0] {
                for (k, (way, s)) in memory.direction.iter_mut().zip(&seed).enumerate() {
                    *way = gaps * least * (s - if k % 2 == 1 { down } else { 0.0 });
                }
                let looked = memory.ccd_step_bound(&step, &unknowns, 1.0);
                let by_assembly = memory.step_bound_from_assembly(&step, &unknowns, 1.0);
                prop_assert!(by_assembly == looked, "{} free where {} is", by_assembly, looked);
            }
        }
    }
}
