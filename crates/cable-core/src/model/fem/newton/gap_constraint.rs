//! A gap constraint keeps a Newton step from closing a gap beyond a given least gap.

use crate::contact::self_contact_pairs::SelfPair;
use crate::math::{Vec2, cross, larger};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::system::{ContactPair, Coupling, System, couple};

/// The point or edge about which a bar turns.
#[derive(Clone, Copy, Debug)]
enum Pivot {
    /// A corner or the middle of a circle, m.
    Fixed(Vec2),
    /// A node of the same cable.
    Node(usize),
}

/// One predicted contact.
#[derive(Clone, Copy, Debug)]
pub struct GapConstraint {
    /// Nodes and their weights in the gradient of the gap; unused entries have weight 0.
    shares: [(usize, f64); 3],
    normal: Vec2,
    /// Gap now, m.
    pub gap: f64,
    /// Least gap that a step may leave, m.
    pub least: f64,
    /// First node of a bar that touches between its nodes, and what it touches.
    bar: Option<(usize, Pivot)>,
    /// Stiffness of the spring that holds it, N/m.
    stiffness: f64,
    /// Change of the gap to which it is held, m; None while it is inactive.
    gap_goal: Option<f64>,
}

/// What a round changes in the equations of a constraint.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::model::fem) enum ConstraintChange {
    None,
    /// Its target, on the right-hand side.
    Target,
    /// Its target and the matrix, to which its spring was added.
    Matrix,
}

impl GapConstraint {
    /// Makes the constraint of a contact with an obstacle.
    pub fn of(touch: &ContactPair, mesh: &Mesh, system: &System, least: f64) -> Self {
        let (gap, [a, b]) = (&touch.pair.gap, touch.shares());
        let next = touch.node + usize::from(touch.on_segment);
        let turns = touch.on_segment && [touch.node, next].iter().all(|&k| mesh.sliding[k].is_none());
        let shares = [(touch.node, a), (next, b), (next, 0.0)];
        Self {
            shares,
            stiffness: stiffness(mesh, system, &shares),
            normal: gap.normal,
            gap: gap.gap_m,
            least,
            bar: turns.then_some((touch.node, Pivot::Fixed(gap.point))),
            gap_goal: None,
        }
    }

    /// Makes the constraint of a contact of the cable with itself.
    pub fn of_own(pair: &SelfPair, mesh: &Mesh, system: &System, least: f64) -> Self {
        let inside = pair.fraction > 0.0 && pair.fraction < 1.0;
        let shares = pair.shares();
        Self {
            shares,
            stiffness: stiffness(mesh, system, &shares),
            normal: pair.normal,
            gap: pair.gap_m,
            least,
            bar: inside.then_some((pair.segment, Pivot::Node(pair.node))),
            gap_goal: None,
        }
    }

    /// Opening of the gap in a step to first order, m.
    fn opening(&self, step: &[f64]) -> f64 {
        let at = |k: usize| Vec2::new(step[2 * k], step[2 * k + 1]);
        self.shares.iter().map(|&(k, part)| self.normal.dot(&at(k)) * part).sum()
    }

    /// Opening of the gap beyond first order, m: a bar that turns while it slides along a corner
    /// comes nearer to it.
    ///
    /// With e = b − a the distance of p from the line is ± e × (p − a)/|e| for any step.
    fn second_order_opening(&self, x: &[Vec2], step: &[f64]) -> f64 {
        let Some((bar, pivot)) = self.bar else { return 0.0 };
        let gone = |k: usize| Vec2::new(step[2 * k], step[2 * k + 1]);
        let (p, go) = match pivot {
            Pivot::Fixed(p) => (p, Vec2::zeros()),
            Pivot::Node(k) => (x[k], gone(k)),
        };
        let off = |[a, b]: [Vec2; 2], p: Vec2| {
            let e = b - a;
            (cross(e, p - a) / e.norm(), (p - a).dot(&e) / e.norm_squared())
        };
        let (now, _) = off([x[bar], x[bar + 1]], p);
        let (then, fraction) = off([x[bar] + gone(bar), x[bar + 1] + gone(bar + 1)], p + go);
        if !(fraction > 0.0 && fraction < 1.0) {
            return 0.0;
        }
        (then - now) * now.signum() - self.opening(step)
    }

    /// Holds a contact that a step would pass, by a spring ½ K (n·δc − way)²; the target of an
    /// active one follows the second-order opening. Returns what changed.
    pub fn add_to(
        &mut self,
        system: &mut System,
        coupling: &mut Coupling,
        right: &mut [f64],
        mesh: &Mesh,
        x: &[Vec2],
        step: &[f64],
    ) -> ConstraintChange {
        let second_order = self.second_order_opening(x, step);
        let new = self.gap_goal.is_none();
        if new && self.gap + self.opening(step) + second_order >= self.least {
            return ConstraintChange::None;
        }
        let mut way = self.least - self.gap - second_order;
        for &(k, part) in self.shares.iter().filter(|s| s.1 != 0.0 && mesh.fixity[s.0]) {
            // A held node moves to its target; a sliding node stays.
            way -= part * self.normal.dot(&Vec2::new(step[2 * k], step[2 * k + 1]));
        }
        let change = way - self.gap_goal.unwrap_or(0.0);
        if !new && change.abs() <= mesh.tuning.newton.constraint_tolerance * self.least {
            return ConstraintChange::None;
        }
        self.gap_goal = Some(way);
        let free = |&&(k, part): &&(usize, f64)| part != 0.0 && mesh.is_free(k);
        let n = self.normal;
        for (i, &(k, part)) in self.shares.iter().enumerate() {
            if !free(&&(k, part)) {
                continue;
            }
            let pull = self.stiffness * part * change;
            right[2 * k] += pull * n.x;
            right[2 * k + 1] += pull * n.y;
            for &(other, its) in self.shares[i..].iter().filter(free).filter(|_| new) {
                couple(system, coupling, [k, other], &(n * n.transpose() * (self.stiffness * part * its)));
            }
        }
        if new { ConstraintChange::Matrix } else { ConstraintChange::Target }
    }
}

/// Stiffness of the spring of a constraint at these nodes, N/m.
fn stiffness(mesh: &Mesh, system: &System, shares: &[(usize, f64)]) -> f64 {
    let at = |&(k, part): &(usize, f64)| {
        if part == 0.0 { 0.0 } else { system.hessian.get(2 * k, 2 * k) + system.hessian.get(2 * k + 1, 2 * k + 1) }
    };
    mesh.tuning.newton.constraint_hardness * shares.iter().map(at).fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::self_contact_pairs::{SelfContact, SortedNodes};
    use crate::model::Settings;
    use crate::model::fem::stepper::Stepper;
    use crate::problem::problems;
    use crate::scene::{Obstacle, Shape, catalog};
    use proptest::prelude::*;

    fn mesh(obstacles: Vec<Obstacle>) -> Stepper {
        let mut scene = catalog::hanging_span();
        scene.obstacles = obstacles;
        scene.cables[0].breaking_tension_n = 1e12;
        let settings = Settings { segments: Some(4), ..Settings::default() };
        Stepper::new(problems(&scene).unwrap().remove(0), settings, Default::default()).unwrap()
    }

    proptest! {
        /// The first-order opening and the rest together are the exact change of a bar's gap, for
        /// any motion.
        #[test]
        fn a_gap_changes_by_its_slope_and_its_bend(moves in prop::collection::vec(-0.02f64..0.02, 10)) {
            let post = Shape::Circle { center_m: [0.35, -0.2], radius_m: 0.1 };
            let d = mesh(vec![Obstacle { name: "post".to_owned(), shape: post, friction: None }]);
            let radius = d.cable.problem.radius;
            let x: Vec<Vec2> = (0..5).map(|k| Vec2::new(0.1 + 0.2 * f64::from(k), -0.1 + radius + 5e-3)).collect();
            let then: Vec<Vec2> = x.iter().zip(moves.chunks(2)).map(|(x, go)| x + Vec2::new(go[0], go[1])).collect();
            let touch = |x: &[Vec2]| {
                let mut found = Vec::new();
                d.cable.contacts.find_within(&d.cable.problem, &d.cable.mesh, x, 0.1, &mut found);
                found.into_iter().find(|t| t.on_segment && t.node == 1)
            };
            let before = touch(&x).unwrap();
            prop_assume!(touch(&then).is_some());
            let after = touch(&then).unwrap();
            // The gap has no sign: crossings are left to the sweep.
            prop_assume!(after.pair.gap.normal.dot(&before.pair.gap.normal) > 0.0);
            let stop = GapConstraint::of(&before, &d.cable.mesh, &System::new(&d.cable.mesh), 0.0);
            let change = stop.opening(&moves) + stop.second_order_opening(&x, &moves);
            prop_assert!((after.pair.gap.gap_m - before.pair.gap.gap_m - change).abs() < 1e-12);
        }

        /// The same holds for contacts of the cable with itself.
        #[test]
        fn a_gap_of_its_own_changes_by_its_slope_and_its_bend(moves in prop::collection::vec(-0.02f64..0.02, 10)) {
            let d = mesh(Vec::new());
            let x = [[0.0, 0.0], [0.4, 0.0], [0.5, 0.2], [0.3, 0.2], [0.2, 0.05]].map(|[x, y]| Vec2::new(x, y));
            let then: Vec<Vec2> = x.iter().zip(moves.chunks(2)).map(|(x, go)| x + Vec2::new(go[0], go[1])).collect();
            let arc = [0.0, 1.0, 2.0, 3.0, 4.0];
            let pair = |x: &[Vec2]| {
                let mut found = Vec::new();
                SelfContact::of_diameter(0.01).pairs(x, &arc, 0.2, &mut SortedNodes::default(), &mut found);
                found.into_iter().find(|p| (p.node, p.segment) == (4, 0)).unwrap()
            };
            let (before, after) = (pair(&x), pair(&then));
            let stop = GapConstraint::of_own(&before, &d.cable.mesh, &System::new(&d.cable.mesh), 0.0);
            let change = stop.opening(&moves) + stop.second_order_opening(&x, &moves);
            prop_assert!((after.gap_m - before.gap_m - change).abs() < 1e-12);
        }
    }
}
