//! A chain relaxes to rest by Newton's method with a viscous resistance that fades
//! (pseudo-transient continuation: C. Kelley, D. Keyes, *SIAM Journal on Numerical Analysis* 35(2),
//! 1998).
//!
//! Far from rest the steps use the convex part of the second derivative, near rest the exact one.
//! If the exact one is not positive definite, the convex part is used as long as it leads to rest,
//! and more resistance if it does not. Material that the first shape has no room for is paid out
//! gradually. A chain that rests in an unstable equilibrium is moved sideways and relaxed again.

use crate::math::{Vec2, larger, perp, smaller};
use crate::model::fem::elastica::chain::initial_mesh::PAY_OUT_RATE;
use crate::model::fem::elastica::chain::newton_step::{Hessian, LinearSystem, NewtonStep};
use crate::model::fem::elastica::chain::{BarChain, REDUCED_RESISTANCE_FACTOR};
use crate::numerics::backtrack;

/// Maximum number of Newton steps. Usual are 10 to 20 from a flexible cable, and 200 to 600 from
/// its route.
const MAX_STEPS: usize = 1200;

/// Number of steps from which a second derivative that is not positive definite is answered with
/// more resistance.
const STEPS_BEFORE_RESISTANCE: usize = 700;

/// Maximum number of times that the resistance is raised in a step.
const MAX_RESISTANCE_RISES: usize = 8;

/// Factor of the resistance after a step that could not be taken, and the least resistance after
/// that, as a fraction of the first one.
const RESISTANCE_RISE: f64 = 8.0;
/// See `RESISTANCE_RISE`.
const LEAST_RAISED_RESISTANCE: f64 = 1e-6;

/// Factor of the resistance after a full short step, and after one that was cut to less than
/// `LEAST_FREE_PART`. In between the resistance stays.
const RESISTANCE_FALL: f64 = 0.4;
/// See `RESISTANCE_FALL`.
const CUT_STEP_RISE: f64 = 3.0;
/// See `RESISTANCE_FALL`.
const LEAST_FREE_PART: f64 = 0.3;

/// Least resistance, and the greatest one at which a chain counts as at rest, as fractions of the
/// first one.
const LEAST_RESISTANCE: f64 = 1e-9;
/// See `LEAST_RESISTANCE`.
const REST_RESISTANCE: f64 = 1e-3;

/// Greatest turn of a bar in a step, rad.
const LONGEST_TURN: f64 = 0.4;

/// Greatest motion, in bars, of a step after which the resistance falls, and of one after which the
/// exact second derivative is used.
const SHORT_STEP_BARS: f64 = 0.5;
/// See `SHORT_STEP_BARS`.
const NEAR_REST_BARS: f64 = 0.2;

/// Maximum number of halvings of a step that leads into an obstacle.
const MAX_HALVINGS: usize = 12;

/// Motion below which a chain is at rest, as a fraction of the cable's radius.
const MOVE_TOLERANCE: f64 = 1e-5;

/// Number of times that a chain in an unstable equilibrium is moved sideways.
const MAX_PERTURBATIONS: usize = 2;

/// Size of that motion as a fraction of the cable's radius. Smaller: round-off moves it as far;
/// larger: it is moved into obstacles.
const PERTURBATION_FRACTION: f64 = 1e-2;

/// Euler's buckling load of a strut that is clamped at both ends, in EI/l².
pub(in crate::model::fem::elastica) const CLAMPED_EULER: f64 = 4.0 * std::f64::consts::PI * std::f64::consts::PI;

/// Compression, in EI/l², from which a strut that lies on a surface is bowed away from it: Euler's
/// load of a strut that is also clamped at its middle. Smaller: heavy struts that lie safely are
/// lifted into one of several bows; larger: cables with slack stay compressed along the ground.
pub(in crate::model::fem::elastica) const LYING_EULER: f64 = 4.0 * CLAMPED_EULER;

/// Cosine of the angle between two bars up to which a stretch is straight: half a radian.
const STRAIGHT_COSINE: f64 = 0.88;
/// Least distance of two nodes, m, that keeps nodes at one place from a division by zero. Larger
/// than any bar: the nodes are moved by less; smaller: it is no number.
const LEAST_DISTANCE_M: f64 = 1e-300;

/// The state in which a relaxation ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem::elastica) enum RestState {
    /// At rest, with a positive definite second derivative of the energy.
    Stable,
    /// At rest, with one that is not.
    Unstable,
    /// Not at rest.
    NotFound,
}

/// The resistance of a relaxation, N/m², and the state of its control.
struct Resistance {
    now: f64,
    /// The value that the weight of the chain suggests.
    first: f64,
    /// True if the last step was short enough for the exact second derivative.
    near_rest: bool,
    /// Number of times that the chain has been moved sideways.
    perturbations: usize,
}

impl Resistance {
    /// Raises the resistance after a step that could not be taken.
    fn raise(&mut self) {
        self.now = larger(self.now * RESISTANCE_RISE, LEAST_RAISED_RESISTANCE * self.first);
    }

    /// Adapts the resistance after a step of which the fraction `part` was taken.
    fn adapt(&mut self, part: f64, is_short: bool) {
        self.now *= if part == 1.0 && is_short {
            RESISTANCE_FALL
        } else if part > LEAST_FREE_PART {
            1.0
        } else {
            CUT_STEP_RISE
        };
        if self.now < LEAST_RESISTANCE * self.first {
            self.now = LEAST_RESISTANCE * self.first;
        }
    }
}

impl BarChain<'_> {
    /// Relaxes the chain until it rests. `resistance` is the fraction of the first resistance that
    /// it begins with.
    pub(super) fn relax(&mut self, resistance: f64) -> RestState {
        let Some(mut system) = LinearSystem::new(self.positions.len()) else { return RestState::NotFound };
        let problem = self.chain_input.problem;
        let first = self.scale / problem.length / self.bar;
        let mut resistance = Resistance { now: resistance * first, first, near_rest: false, perturbations: 0 };
        for round in 0..MAX_STEPS {
            self.steps += 1;
            let paid_out = self.pay_out();
            self.find_contacts();
            let Some((step, hessian)) = self.solvable_step(&mut system, &mut resistance, round) else {
                resistance.near_rest = false;
                continue;
            };
            let (moved, turned) = self.size_of(&step.moves);
            if !moved.is_finite() {
                return RestState::NotFound;
            }
            let longest = (self.bar / moved).min(LONGEST_TURN / turned).min(1.0);
            let Some((part, positions)) = self.clear_part(&step.moves, longest) else {
                resistance.raise();
                continue;
            };
            self.apply_step(&step.moves, part, &positions);
            let whole = part == 1.0;
            let still = moved < MOVE_TOLERANCE * problem.radius && resistance.now <= REST_RESISTANCE * first;
            if whole && paid_out && step.contacts_settled && still {
                if hessian == Hessian::Exact {
                    return RestState::Stable;
                }
                if resistance.perturbations >= MAX_PERTURBATIONS {
                    return RestState::Unstable;
                }
                resistance.perturbations += 1;
                self.perturb(resistance.perturbations);
                resistance.now = larger(resistance.now, REDUCED_RESISTANCE_FACTOR * first);
            }
            resistance.near_rest = paid_out && whole && moved < NEAR_REST_BARS * self.bar;
            let is_short = moved < SHORT_STEP_BARS * self.bar;
            resistance.adapt(part, is_short);
        }
        RestState::NotFound
    }

    /// A step whose matrix is positive definite, and the kind of second derivative it used; None if
    /// none is found. Near rest the exact one is tried first.
    fn solvable_step(
        &mut self,
        system: &mut LinearSystem,
        resistance: &mut Resistance,
        round: usize,
    ) -> Option<(NewtonStep, Hessian)> {
        let mut hessian = if resistance.near_rest { Hessian::Exact } else { Hessian::Convex };
        for _ in 0..MAX_RESISTANCE_RISES {
            if let Some(step) = self.newton_step(system, resistance.now, hessian) {
                return Some((step, hessian));
            }
            if hessian == Hessian::Exact && round < STEPS_BEFORE_RESISTANCE && resistance.perturbations == 0 {
                hessian = Hessian::Convex;
            } else {
                resistance.raise();
            }
        }
        None
    }

    /// Greatest motion of a node (m) and turn of a bar (rad) in a step.
    fn size_of(&self, moves: &[Vec2]) -> (f64, f64) {
        let (mut moved, mut turned): (f64, f64) = (0.0, 0.0);
        for k in 0..moves.len() {
            moved = larger(moved, moves[k].norm());
            if k + 1 < moves.len() {
                let bar = (self.positions[k + 1] - self.positions[k]).norm();
                turned = larger(turned, (moves[k + 1] - moves[k]).norm() / bar);
            }
        }
        (moved, turned)
    }

    /// The fraction of a step, at most `longest`, that leads into no obstacle, and the positions
    /// there.
    fn clear_part(&self, moves: &[Vec2], longest: f64) -> Option<(f64, Vec<Vec2>)> {
        backtrack(longest, MAX_HALVINGS + 1, |part| {
            let positions: Vec<Vec2> = self.positions.iter().zip(moves).map(|(x, d)| x + d * part).collect();
            self.is_clear_enough(&positions).then_some((part, positions))
        })
    }

    /// Moves the nodes to the positions to which a part of a step leads, with the tensions of the
    /// linearised bars.
    fn apply_step(&mut self, moves: &[Vec2], part: f64, positions: &[Vec2]) {
        for e in 0..self.rest.len() {
            let d = self.positions[e + 1] - self.positions[e];
            let l = d.norm();
            let longer = (moves[e + 1] * part - moves[e] * part).dot(&d) / (l * part);
            let pull = self.chain_input.problem.axial_stiffness * ((l + longer) / self.rest[e] - 1.0);
            self.tension[e] += part * (pull - self.tension[e]);
        }
        self.positions.copy_from_slice(positions);
    }

    /// Moves all nodes a little sideways, in the shape of a wave.
    fn perturb(&mut self, waves: usize) {
        let n = self.positions.len();
        let from = self.positions.clone();
        for k in (1..n - 1).filter(|&k| !self.fixity[k]) {
            let phase = std::f64::consts::PI * (waves * k) as f64 / n as f64;
            let along = from[k + 1] - from[k - 1];
            let size = PERTURBATION_FRACTION * self.chain_input.problem.radius * phase.sin();
            self.positions[k] += perp(along) * (size / larger(along.norm(), LEAST_DISTANCE_M));
        }
    }

    /// Bows each straight stretch that is compressed by more than [`LYING_EULER`] away from the
    /// surface it lies on, as far as its material allows; returns whether any could be bowed. A
    /// perfectly straight strut on a surface stays straight under any compression until something
    /// lifts it, but no real cable lies that straight.
    pub(super) fn bow_crushed(&mut self) -> bool {
        let ei = self.chain_input.problem.bending_stiffness;
        let mut bowed = false;
        let mut first = 0;
        while first < self.tension.len() {
            let along = self.direction(first);
            let is_of_it = |e: &usize| self.tension[*e] < 0.0 && along.dot(&self.direction(*e)) > STRAIGHT_COSINE;
            let last = (first..self.tension.len()).take_while(is_of_it).last();
            let Some(last) = last else {
                first += 1;
                continue;
            };
            let length: f64 = self.unstretched[first..=last].iter().sum();
            let push = self.tension[first..=last].iter().fold(f64::INFINITY, |p, t| smaller(p, -t));
            if push * length * length > LYING_EULER * ei {
                bowed |= self.bow([first, last + 1], length, push);
            }
            first = last + 1;
        }
        bowed
    }

    /// Moves the nodes between `from` and `to` into a half wave that is longer than their chord by
    /// the length that the compression `push` (N) has taken from their material; returns whether
    /// there is room for it.
    fn bow(&mut self, [from, to]: [usize; 2], length: f64, push: f64) -> bool {
        let chord = self.positions[to] - self.positions[from];
        let normals = self.contacts.iter().filter(|t| (from..=to).contains(&t.node)).map(|t| t.gap.normal);
        let up = normals.sum::<Vec2>() - self.body;
        let across = perp(chord);
        let across =
            across * (if across.dot(&up) < 0.0 { -1.0 } else { 1.0 } / larger(chord.norm(), f64::MIN_POSITIVE));
        let height = 2.0 * length / std::f64::consts::PI * (push / self.chain_input.problem.axial_stiffness).sqrt();
        let mut moves = vec![Vec2::zeros(); self.positions.len()];
        for k in (from + 1..to).filter(|&k| !self.fixity[k]) {
            let part = (self.arc[k] - self.arc[from]) / (self.arc[to] - self.arc[from]);
            moves[k] = across * (height * (std::f64::consts::PI * part).sin());
        }
        let Some((_, positions)) = self.clear_part(&moves, 1.0) else { return false };
        self.positions = positions;
        self.tension[from..to].fill(0.0);
        true
    }

    /// Lets the rest lengths of the bars grow to their unstretched lengths; returns whether all
    /// have reached them.
    fn pay_out(&mut self) -> bool {
        let mut paid_out = true;
        for (rest, unstretched) in self.rest.iter_mut().zip(&self.unstretched) {
            if *rest < *unstretched {
                let grown = *rest * (1.0 + PAY_OUT_RATE);
                *rest = if grown < *unstretched { grown } else { *unstretched };
                paid_out &= *rest >= *unstretched;
            }
        }
        paid_out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::fem::elastica::chain::ChainInput;
    use crate::problem::Problem;
    use crate::scene::Scene;
    use crate::solution::{CableSolution, Node};

    fn problem(text: &str) -> Result<Problem, Box<dyn std::error::Error>> {
        let scene = Scene::from_toml(text)?;
        let first = crate::problem::problems(&scene)?.into_iter().next().ok_or("no cable")?;
        Ok(Problem::clone(&first))
    }

    /// A weightless strut of 2 m between hinges, pressed by `part` of its critical force π²EI/L².
    fn strut(part: f64) -> Result<(Problem, CableSolution), Box<dyn std::error::Error>> {
        let (ei, ea, l) = (1.0, 1e4, 2.0);
        let pull = -part * std::f64::consts::PI.powi(2) * ei / (l * l);
        let way = l * (1.0 + pull / ea);
        let p = problem(&format!(
            "version = 1\n[environment]\ngravity_m_per_s2 = 0.0\n[[cables]]\nname = \"c\"\nlength_m = {l}\ndiameter_m = 0.02\n\
             linear_density_kg_per_m = 1.0\naxial_stiffness_n = {ea:e}\nbending_stiffness_n_m2 = {ei}\n\
             service_tension_n = 1e9\nbreaking_tension_n = 1e9\n\
             [[cables.supports]]\nname = \"a\"\nkind = \"fixed\"\nat_m = [0.0, 1.0]\n\
             [[cables.supports]]\nname = \"b\"\nkind = \"fixed\"\nat_m = [{way:.12}, 1.0]\n"
        ))?;
        let node = |s: f64| Node { arc_length_m: s, x_m: s * way / l, y_m: 1.0, tension_n: pull, ..Node::default() };
        Ok((p, CableSolution { nodes: vec![node(0.0), node(l)].into(), ..CableSolution::default() }))
    }

    /// Euler's strut stays straight below its critical force, and buckles above it.
    #[test]
    fn a_strut_buckles_at_its_critical_force() -> Result<(), Box<dyn std::error::Error>> {
        for (part, stays) in [(0.5, true), (0.98, true), (1.02, false), (2.0, false)] {
            let (problem, straight) = strut(part)?;
            let chain_input =
                ChainInput { problem: &problem, time_s: 0.0, dragged: &[None, None], friction_source: Some(&straight) };
            let mut chain = BarChain::along(chain_input, &straight.nodes, 1.0).ok_or("no chain")?;
            assert_eq!(chain.relax(REDUCED_RESISTANCE_FACTOR), RestState::Stable, "{part}");
            let off = chain.positions.iter().map(|x| (x.y - 1.0).abs()).fold(0.0, larger);
            assert_eq!(off < 1e-9, stays, "{part} of the critical force: {off} m aside");
        }
        Ok(())
    }
}
