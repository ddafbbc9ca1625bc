//! Contacts that a Newton step is about to make, foreseen.
//!
//! The barrier is felt from a gap of d̂ on only. A Newton step that knows nothing of what lies beyond runs into it, is cut
//! where the first node would touch, and the next runs into the next node: where a cable comes down on the ground a step
//! took as many iterations as nodes landed. So what the step δ would carry past its landing gap g* is made to stop there,
//! and the step is found again:
//! ```text
//! min ½ δᵀHδ + gᵀδ   subject to   n·δc ≥ −(g − g*)    for each contact ahead, c its point
//! ```
//! with the violated constraints as stiff springs, added until there are no more. δ = 0 keeps every constraint, so
//! what is found goes downhill.

use super::assembly::{Mesh, System};
use super::contact_set::{ContactSet, Touch};
use crate::linalg::BandFactor;
use crate::math::{Vec2, larger};
use crate::problem::Problem;

/// Rounds of adding constraints. More find nothing new where a front of contact runs along the cable.
const MAX_ROUNDS: usize = 6;

/// Stiffness of a constraint in units of the largest stiffness at its nodes. Softer: nodes still run into the barrier; much
/// harder: rounding.
const HARDNESS: f64 = 1e5;

/// Landing gap, part of the barrier's reach: about where the barrier holds a node that lands.
const LANDING: f64 = 0.5;

/// Part of its gap that a contact within the barrier may lose in one step: less than the search of the step lets it.
const CLOSER: f64 = 0.45;

/// What a step is about to touch.
#[derive(Clone, Debug)]
pub struct Ahead {
    touches: Vec<Touch>,
    added: Vec<bool>,
    right: Vec<f64>,
    step: Vec<f64>,
}

impl Ahead {
    /// Room for a mesh of so many nodes that each touch one thing.
    #[must_use]
    pub fn new(nodes: usize) -> Self {
        Self {
            touches: Vec::with_capacity(nodes),
            added: Vec::with_capacity(nodes),
            right: Vec::with_capacity(2 * nodes),
            step: Vec::with_capacity(2 * nodes),
        }
    }

    /// Keeps the right side of the equations before they are solved in place.
    pub fn keep(&mut self, right: &[f64]) {
        self.right.clear();
        self.right.extend_from_slice(right);
    }

    /// Stops each node of a step at its landing gap, whatever its neighbours do.
    pub fn stop(
        &mut self,
        (problem, mesh): (&Problem, &Mesh),
        (contacts, x): (&ContactSet, &[Vec2]),
        direction: &mut [f64],
    ) {
        self.look((problem, mesh), (contacts, x), direction);
        for touch in self.touches.iter().filter(|t| !t.on_segment && t.pair.weight > 0.0 && mesh.is_free(t.node)) {
            let (n, k) = (touch.pair.gap.normal, 2 * touch.node);
            let least = landing(touch, contacts.barrier.reach);
            let over = least - touch.pair.gap.gap_m - n.dot(&moved(touch, direction));
            if over > 0.0 {
                direction[k] += n.x * over;
                direction[k + 1] += n.y * over;
            }
        }
    }

    /// Finds all that a step of this size could touch.
    fn look(&mut self, (problem, mesh): (&Problem, &Mesh), (contacts, x): (&ContactSet, &[Vec2]), step: &[f64]) {
        let longest = step.chunks_exact(2).map(|d| d[0] * d[0] + d[1] * d[1]).fold(0.0, larger).sqrt();
        contacts.find_within(problem, mesh, x, contacts.barrier.reach + longest, &mut self.touches);
    }

    /// Solves again, with contacts ahead as constraints; `system` is pinned, and `direction` the step that ran into them.
    /// Where that fails `direction` stays as it is.
    pub fn solve(
        &mut self,
        (system, factor): (&mut System, &mut BandFactor),
        (problem, mesh): (&Problem, &Mesh),
        (contacts, x): (&ContactSet, &[Vec2]),
        direction: &mut [f64],
    ) {
        let reach = contacts.barrier.reach;
        self.look((problem, mesh), (contacts, x), direction);
        self.added.clear();
        self.added.resize(self.touches.len(), false);
        let Self { touches, added, right, step } = self;
        step.clear();
        step.extend_from_slice(direction);
        for _ in 0..MAX_ROUNDS {
            let before = added.iter().filter(|a| **a).count();
            for (touch, added) in touches.iter().zip(added.iter_mut()) {
                let (n, gap) = (touch.pair.gap.normal, touch.pair.gap.gap_m);
                let least = landing(touch, reach);
                let closing = -n.dot(&moved(touch, step));
                if !*added && touch.pair.weight > 0.0 && closing > gap - least {
                    *added = true;
                    constrain(system, mesh, touch, (n, least - gap), step, right);
                }
            }
            if added.iter().filter(|a| **a).count() == before {
                break;
            }
            if factor.factor(&system.hessian).is_err() {
                return;
            }
            step.copy_from_slice(right);
            factor.solve_in_place(step);
            if !step.iter().all(|d| d.is_finite()) {
                return;
            }
        }
        direction.copy_from_slice(step);
    }
}

/// The gap at which a step is stopped.
fn landing(touch: &Touch, reach: f64) -> f64 {
    let gap = touch.pair.gap.gap_m;
    if gap > reach { LANDING * reach } else { (1.0 - CLOSER) * gap }
}

/// How far the touching point goes in a step.
fn moved(touch: &Touch, step: &[f64]) -> Vec2 {
    let shares = touch.shares();
    let at = |k: usize| Vec2::new(step[2 * k], step[2 * k + 1]);
    if touch.on_segment { at(touch.node) * shares[0] + at(touch.node + 1) * shares[1] } else { at(touch.node) }
}

/// Adds the spring ½ K (n·δc − way)² to the equations of the nodes that are free to move.
fn constrain(system: &mut System, mesh: &Mesh, touch: &Touch, (n, way): (Vec2, f64), step: &[f64], right: &mut [f64]) {
    let shares = touch.shares();
    let nodes = [touch.node, touch.node + usize::from(touch.on_segment)];
    let free = [0, 1].map(|j| shares[j] != 0.0 && mesh.is_free(nodes[j]));
    let mut stiffness = 0.0;
    let mut way = way;
    for j in 0..2 {
        let k = 2 * nodes[j];
        if free[j] {
            let here = system.hessian.get(k, k) + system.hessian.get(k + 1, k + 1);
            stiffness = if here > stiffness { here } else { stiffness };
        } else if shares[j] != 0.0 {
            // What is held goes where it goes; a sliding node stays where it is.
            let by = if mesh.held[nodes[j]] { Vec2::new(step[k], step[k + 1]) } else { Vec2::zeros() };
            way -= shares[j] * n.dot(&by);
        }
    }
    let k = HARDNESS * stiffness;
    let block = n * n.transpose();
    for j in (0..2).filter(|&j| free[j]) {
        system.add_block(nodes[j], nodes[j], &(block * (k * shares[j] * shares[j])));
        right[2 * nodes[j]] += k * shares[j] * way * n.x;
        right[2 * nodes[j] + 1] += k * shares[j] * way * n.y;
    }
    if free == [true, true] {
        system.add_block(nodes[0], nodes[1], &(block * (k * shares[0] * shares[1])));
    }
}

#[cfg(test)]
mod tests {
    use super::super::contact_step::Workspace;
    use super::super::dynamics::{Dynamics, REACH};
    use crate::math::Vec2;
    use crate::model::{Inertia, Settings};
    use crate::problem::problems;
    use crate::scene::{Obstacle, Shape, Support, catalog};

    const STEP: f64 = 1.0 / 240.0;

    /// A loose cable of 10 m and 100 bars in the air, in a slight wave above a floor, at 5 m/s downwards: it lands all along
    /// its length in the next step, here sooner and there later.
    fn about_to_land() -> Dynamics {
        let mut scene = catalog::hanging_span();
        let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [15.0, 0.0]] };
        scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(0.5) }];
        let c = &mut scene.cables[0];
        (c.length_m, c.bending_stiffness_n_m2) = (10.0, 0.0);
        let hook = |name: &str, x| Support { release_s: Some(0.5 * STEP), ..Support::fixed(name, [x, 0.6]) };
        c.supports = vec![hook("a", 0.0), hook("b", 9.95)];
        let radius = 0.5 * c.diameter_m;
        let settings = Settings { segments: Some(100), ..Settings::default() };
        let mut d = Dynamics::new(problems(&scene).unwrap().remove(0), settings).unwrap();
        d.settle(&[]).unwrap();
        d.advance(STEP, Inertia::Dynamic, &[]).unwrap();
        for (k, (x, v)) in d.motion.x.iter_mut().zip(&mut d.motion.v).enumerate() {
            let gap = 5.0 * REACH + 8e-3 * (1.0 + (0.13 * k as f64).sin());
            (*x, *v) = (Vec2::new(0.1 * k as f64, radius + gap), Vec2::new(0.0, -5.0));
        }
        d.forget_history();
        d
    }

    #[test]
    fn a_cable_that_lands_all_along_its_length_in_one_step_takes_few_iterations() {
        let mut d = about_to_land();
        d.begin_step(STEP, &[]);
        let mut pose = d.still_pose();
        let mut memory = Workspace::new(&d.mesh).unwrap();
        let done = memory.descend((&d.problem, &d.mesh), &d.contacts, &d.task, &mut pose).unwrap();
        let landed = memory.touches.len();
        println!("{} iterations, {landed} nodes landed", done.iterations);
        assert!(landed > 90 && done.iterations <= 8, "{landed} {}", done.iterations);
    }
}
