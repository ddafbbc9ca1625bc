//! One Newton step of a chain solves its linearised equations, with the contacts that the step
//! itself closes: the active set of a quadratic programme.
//!
//! Tensions are unknowns of their own. The geometric stiffness of a bar uses the tension of the
//! last solution, not the strain that its rotation has just added, so a large EA does not shorten
//! steps. A contact is a stiff spring that acts where its gap would close, and mobilises a
//! prescribed friction.

use crate::contact::Gap;
use crate::energy::bending::{BendingEnergy, ClampBend};
use crate::energy::{Curvature, ElementEnergy};
use crate::linalg::{BandFactor, BandMatrix, PivotingBand};
use crate::math::{Mat2, Vec2, perp};
use crate::model::fem::elastica::chain::BarChain;
use crate::model::fem::elastica::chain::chain_contacts::ChainContact;

/// Maximum number of changes of the active set in a step. Larger: the first steps pay for accuracy
/// they do not need.
const MAX_SETS: usize = 8;

/// Number of changes of the active set in a step in which contacts may open as well as close.
const RELEASE_ROUNDS: usize = 4;

/// Penetration under a force of the whole weight, as a fraction of the cable's radius. Smaller: the
/// matrix loses digits; larger: contacts are found late.
const PENALTY_DEPTH_FRACTION: f64 = 1e-3;

/// Half-bandwidth: a node sees two neighbours on each side.
const HALF_BAND: usize = 5;

/// The matrix with friction is not symmetric.
type FrictionMatrix = PivotingBand<HALF_BAND, { 3 * HALF_BAND + 1 }>;

/// The second derivative with which a step is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hessian {
    /// The exact one. Where it is not positive definite, the chain is at no stable rest.
    Exact,
    /// The second derivative without the terms that can be negative: compression, curvature of
    /// bends and of rounds.
    Convex,
}

/// The matrix of a step and its factors.
pub(super) struct LinearSystem {
    matrix: BandMatrix,
    factor: BandFactor,
}

impl LinearSystem {
    /// Allocates the matrix for a chain of so many nodes; None if there is not enough memory.
    pub(super) fn new(nodes: usize) -> Option<Self> {
        Some(Self {
            matrix: BandMatrix::new(2 * nodes, HALF_BAND),
            factor: BandFactor::new(2 * nodes, HALF_BAND).ok()?,
        })
    }
}

/// A Newton step.
pub(super) struct NewtonStep {
    /// Displacement of each node, m.
    pub(super) moves: Vec<Vec2>,
    /// True if the active set it was solved with is the one it ends in.
    pub(super) contacts_settled: bool,
}

/// A symmetric 2 × 2 block as the band matrix takes it.
fn block(k: &Mat2) -> [[f64; 2]; 2] {
    [[k[(0, 0)], k[(0, 1)]], [k[(1, 0)], k[(1, 1)]]]
}

/// Adds a force to the right-hand side at a node.
fn add_force(right: &mut [f64], node: usize, f: Vec2) {
    right[2 * node] += f.x;
    right[2 * node + 1] += f.y;
}

/// Tells whether contacts may leave the active set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ContactOpening {
    Allowed,
    Forbidden,
}

impl BarChain<'_> {
    /// Stiffness of contacts, N/m.
    fn contact_stiffness(&self) -> f64 {
        self.scale / (PENALTY_DEPTH_FRACTION * self.chain_input.problem.radius)
    }

    /// One Newton step with a resistance to motion, N/m²; None where its matrix is not positive
    /// definite.
    pub(super) fn newton_step(
        &mut self,
        system: &mut LinearSystem,
        resistance: f64,
        hessian: Hessian,
    ) -> Option<NewtonStep> {
        let mut step = NewtonStep { moves: Vec::new(), contacts_settled: false };
        for set in 0..MAX_SETS {
            let mut right = vec![0.0; 2 * self.positions.len()];
            self.assemble(&mut system.matrix, &mut right, resistance, hessian);
            system.factor.factor(&system.matrix).ok()?;
            if self.contacts.iter().any(ChainContact::rubs) {
                let mut matrix = self.matrix_with_friction(&system.matrix);
                matrix.scale(&mut right);
                matrix.solve(&mut right).then_some(())?;
            } else {
                system.factor.solve_in_place(&mut right);
            }
            step.moves = right.chunks_exact(2).map(|d| Vec2::new(d[0], d[1])).collect();
            let opening = if set < RELEASE_ROUNDS { ContactOpening::Allowed } else { ContactOpening::Forbidden };
            step.contacts_settled = !self.update_active_set(&step.moves, opening);
            if step.contacts_settled {
                break;
            }
        }
        Some(step)
    }

    /// Closes the contacts whose gaps a step would close, and opens the others if that is allowed:
    /// without that limit, two contacts could open and close by turns for ever. Returns whether any
    /// gap contradicts the set with which the step was solved.
    fn update_active_set(&mut self, moves: &[Vec2], opening: ContactOpening) -> bool {
        let stiff = self.contact_stiffness();
        let mut changed = false;
        for t in &mut self.contacts {
            let moved = t.shares().iter().fold(0.0, |m, (k, a)| m + a * moves[*k].dot(&t.gap.normal));
            let gap = t.gap.gap_m + moved;
            changed |= t.active != (gap < 0.0);
            t.active = gap < 0.0 || (t.active && opening == ContactOpening::Forbidden);
            // A new contact exerts its force from the next solution on.
            t.push = if gap < 0.0 { -stiff * gap } else { 0.0 };
        }
        changed
    }

    /// Assembles matrix and right-hand side: loads, bars, bends, resistance, active contacts; nodes
    /// that are held do not move.
    fn assemble(&self, matrix: &mut BandMatrix, right: &mut [f64], resistance: f64, hessian: Hessian) {
        matrix.clear();
        for (k, load) in self.load.iter().enumerate() {
            add_force(right, k, *load);
        }
        self.add_bars_to(matrix, right, hessian);
        self.add_bends(matrix, right, hessian);
        self.add_resistance(matrix, resistance);
        for t in self.contacts.iter().filter(|t| t.active) {
            self.add_contact(matrix, right, t, hessian);
        }
        for (k, _) in self.fixity.iter().enumerate().filter(|(_, is_fixed)| **is_fixed) {
            for i in [2 * k, 2 * k + 1] {
                matrix.pin(i);
                right[i] = 0.0;
            }
        }
    }

    /// Adds the axial stiffness of the bars to the matrix and their forces to the right-hand side.
    fn add_bars_to(&self, matrix: &mut BandMatrix, right: &mut [f64], hessian: Hessian) {
        let ea = self.chain_input.problem.axial_stiffness;
        for e in 0..self.positions.len() - 1 {
            let d = self.positions[e + 1] - self.positions[e];
            let l = d.norm();
            let t = d / l;
            let (axial, pull) = (ea / self.rest[e], ea * (l / self.rest[e] - 1.0));
            let turns = match hessian {
                Hessian::Exact => self.tension[e],
                Hessian::Convex => self.tension[e].max(0.0),
            } / l;
            let k = t * t.transpose() * (axial - turns) + Mat2::identity() * turns;
            matrix.add_spring(2 * e, [k[(0, 0)], k[(0, 1)], k[(1, 1)]]);
            add_force(right, e, t * pull);
            add_force(right, e + 1, -t * pull);
        }
    }

    /// Adds the bends at inner nodes, and those of clamped bars.
    fn add_bends(&self, matrix: &mut BandMatrix, right: &mut [f64], hessian: Hessian) {
        let curvature = match hessian {
            Hessian::Exact => Curvature::Exact,
            Hessian::Convex => Curvature::Clipped,
        };
        let ei = self.chain_input.problem.bending_stiffness;
        for k in 1..self.positions.len() - 1 {
            if self.clamps.iter().any(|c| c.node == k) {
                continue;
            }
            let length = 0.5 * (self.unstretched[k - 1] + self.unstretched[k]);
            let bend = BendingEnergy { stiffness: ei, length, from: 0.0 };
            let x = [self.positions[k - 1], self.positions[k], self.positions[k + 1]];
            let (g, h) = (bend.gradient(&x), bend.hessian(&x, curvature));
            for i in 0..3 {
                add_force(right, k + i - 1, -g[i]);
                for j in i..3 {
                    matrix.add_block(2 * (k + i - 1), 2 * (k + j - 1), block(&h[i][j]));
                }
            }
        }
        for clamp in &self.clamps {
            let bar = clamp.bar();
            let length = 0.5 * self.unstretched[bar];
            let bend = ClampBend { stiffness: ei, length, direction: clamp.direction, from: 0.0 };
            let x = [self.positions[bar], self.positions[bar + 1]];
            let (g, h) = (bend.gradient(&x), bend.hessian(&x, curvature));
            for i in 0..2 {
                add_force(right, bar + i, -g[i]);
                for j in i..2 {
                    matrix.add_block(2 * (bar + i), 2 * (bar + j), block(&h[i][j]));
                }
            }
        }
    }

    /// Adds the resistance of a relaxation step (N/m per metre of cable) to the diagonal.
    fn add_resistance(&self, matrix: &mut BandMatrix, resistance: f64) {
        let n = self.positions.len();
        for k in 0..n {
            let share = 0.5 * (self.unstretched[k.saturating_sub(1).min(n - 2)] + self.unstretched[k.min(n - 2)]);
            matrix.add(2 * k, 2 * k, resistance * share);
            matrix.add(2 * k + 1, 2 * k + 1, resistance * share);
        }
    }

    /// Adds the stiffness of a contact to the matrix and its force to the right-hand side.
    fn add_contact(&self, matrix: &mut BandMatrix, right: &mut [f64], t: &ChainContact, hessian: Hessian) {
        let stiff = self.contact_stiffness();
        let f = (t.gap.normal + self.direction(t.node) * t.mobilised) * (-stiff * t.gap.gap_m);
        let mut k = t.gap.normal * t.gap.normal.transpose() * stiff;
        if hessian == Hessian::Exact && t.push > 0.0 {
            self.add_round_curvature(matrix, t, &mut k);
        }
        let shares = t.shares();
        for (i, a) in shares {
            add_force(right, i, f * a);
            for (j, b) in shares {
                if i <= j && a * b != 0.0 {
                    matrix.add_block(2 * i, 2 * j, block(&(k * (a * b))));
                }
            }
        }
    }

    /// Adds −p ∂²g of a contact of force p with a round: for a node −p/D, and for a bar that turns
    /// by φ about a point at distance D and slides along itself by m, −p g = p (Dφ²/2 + φm).
    fn add_round_curvature(&self, matrix: &mut BandMatrix, t: &ChainContact, at_node: &mut Mat2) {
        let is_round = !t.gap.feature.is_multiple_of(2);
        if !is_round {
            return;
        }
        let distance = t.gap.gap_m + self.offset(&t.gap);
        let f = t.gap.fraction;
        if f == 0.0 || f == 1.0 {
            let d = perp(t.gap.normal);
            *at_node -= d * d.transpose() * (t.push / distance);
            return;
        }
        let (k, d) = (2 * t.node, self.positions[t.node + 1] - self.positions[t.node]);
        let (l, n) = (d.norm(), t.gap.normal);
        let (turns, slides) = ([-n / l, n / l], [d * ((1.0 - f) / l), d * (f / l)]);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let own = turns[i] * turns[j].transpose() * distance;
            let both = turns[i] * slides[j].transpose() + slides[i] * turns[j].transpose();
            matrix.add_block(k + 2 * i, k + 2 * j, block(&((own + both) * t.push)));
        }
    }

    /// Distance of the centre line from a round's centre in contact, m.
    fn offset(&self, gap: &Gap) -> f64 {
        let problem = self.chain_input.problem;
        problem.world.geometry().body_of(gap.feature).map_or(problem.radius, |b| b.offset)
    }

    /// The matrix with friction that follows the normal force within the step. With the normal
    /// force of the step before, the iteration diverges where an end is pressed against a corner:
    /// each change of one force changes the other by more.
    fn matrix_with_friction(&self, matrix: &BandMatrix) -> FrictionMatrix {
        let size = matrix.rows();
        let mut band = FrictionMatrix::new(size);
        for i in 0..size {
            for j in i.saturating_sub(HALF_BAND)..(i + HALF_BAND + 1).min(size) {
                band.add(i, j, matrix.get(i, j));
            }
        }
        for t in self.contacts.iter().filter(|t| t.rubs()) {
            let k = self.direction(t.node) * t.gap.normal.transpose() * (t.mobilised * self.contact_stiffness());
            let free = |(i, _): &(usize, f64)| !self.fixity[*i];
            for (i, a) in t.shares().into_iter().filter(free) {
                for (j, b) in t.shares().into_iter().filter(free) {
                    for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        band.add(2 * i + r, 2 * j + c, k[(r, c)] * (a * b));
                    }
                }
            }
        }
        band
    }
}
