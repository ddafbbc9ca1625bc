//! Newton's method on one energy finds where the chain rests.
//!
//! Springs that only pull, U = EA (length − l₀)²/2l₀ for length > l₀, are convex in nodes and
//! material coordinates together, so no compressed state can come out; weight is linear. Bending,
//! contacts and friction (see `contact_energy`) add their terms, the σ of a pulley stands in the
//! place of its node's x. The tangent is a band: a step costs about as much as a few sweeps of
//! relaxation, of which a stiff chain needs N·√(EA/T) for each swing. The diagonal is shifted (K.
//! Levenberg, A method for the solution of certain non-linear problems in least squares, Quarterly
//! of Applied Mathematics 2, 1944) until the energy or the unbalanced force falls.
//!
//! Derivatives of a spring beside a pulley, t its direction, L its length, λ the thermal stretch:
//! ```text
//! ∂²U/∂p² = (EA/l₀) t tᵀ + (T/L_free)(I − t tᵀ),   ∂²U/∂σ² = λ² EA L²/l₀³,   ∂²U/∂p∂σ = λ EA L/l₀² t
//! ```

use crate::contact::friction;
use crate::energy::{Blocks, Curvature, Energy};
use crate::error::{NoEquilibrium, SolveError};
use crate::linalg::{BARS_HALF_BANDWIDTH, BENDING_HALF_BANDWIDTH, BandFactor, BandMatrix};
use crate::math::{Mat2, Vec2, larger};
use crate::model::Model;
use crate::model::mass_spring::MassSpringModel;
use crate::model::mass_spring::equilibrium::contact_energy::{Anchors, Contacts};

/// Unbalanced force at rest, of the force scale: round-off allows little less, more shows in the
/// reactions.
const RESIDUAL: f64 = 1e-9;
/// The same where something is touched: contacts that come and go leave more.
const TOUCHING_RESIDUAL: f64 = 1e-7;
/// Stiffness lent to elements that are slack at the start, whose tension there is known (corrected
/// bars are shorter by their sag, which is more than a stiff spring stretches): how it fades from
/// step to step. More makes truly slack elements slow, less starts with wild steps.
const LENT_STIFFNESS_FADE: f64 = 0.1;
/// Units in the last place by which positions are off when they are good: strain is off by that
/// over l₀, tension EA times it. Two positions and the length between them lose about one each, and
/// both springs of a node add up.
const ULPS: f64 = 8.0;
/// Newton steps. The hardest scene of the catalogue takes some 200.
const MAX_STEPS: usize = 1500;
/// First shift of the diagonal, of EA over the shortest element; and how it falls and rises with
/// success. Smaller starts with wild steps, larger wastes a few steps.
const FIRST_SHIFT: f64 = 1e-8;
const SHIFT_DOWN: f64 = 0.1;
const SHIFT_UP: f64 = 8.0;
/// Shift beyond which no step helps, of that or of the stiffness of contacts where that is more;
/// and below which it is left alone.
const LAST_SHIFT: f64 = 1e3;
const LEAST_SHIFT: f64 = 1e-14;
/// Up to this step friction follows the normal forces at every step, which is fastest; where that
/// runs in circles, later ones first solve with them frozen, for so many steps at most.
const EAGER_FRICTION_STEPS: usize = 150;
const MOST_FROZEN: usize = 25;
/// Greatest move in a step where there is something to run into, of the cable's radius: more steps
/// over an edge.
const MOST_MOVE: f64 = 0.5;
/// Greatest slide through a pulley in a step, of the even length: more turns an element inside out.
const MOST_SLIDE: f64 = 0.25;
/// Slide through a pulley at which its friction is called up whole, m.
const PULLEY_SLIP: f64 = 1e-6;

/// Gradient, Hessian and their factor.
pub(in crate::model::mass_spring) struct System {
    /// Tension that is lent to the stiffness of each element, N, and how much of it still is.
    lent: Vec<f64>,
    fade: f64,
    pub gradient: Vec<f64>,
    pub hessian: BandMatrix,
    factor: BandFactor,
    step: Vec<f64>,
    x: Vec<Vec2>,
    s: Vec<f64>,
}

impl System {
    fn new(model: &MassSpringModel) -> Result<Self, SolveError> {
        let n = model.chain.x.len();
        let band = if model.problem.bending_stiffness > 0.0 { BENDING_HALF_BANDWIDTH } else { BARS_HALF_BANDWIDTH };
        let factor = BandFactor::new(2 * n, band).map_err(|_| SolveError::Indefinite { model: Model::MassSpring })?;
        Ok(Self {
            lent: model.chain.tension.clone(),
            fade: 1.0,
            gradient: vec![0.0; 2 * n],
            hessian: BandMatrix::new(2 * n, band),
            factor,
            step: vec![0.0; 2 * n],
            x: model.chain.x.clone(),
            s: model.chain.s.clone(),
        })
    }

    /// Adds a block; on the diagonal it must be symmetric, of (i, j) and (j, i) only one is to be
    /// added.
    pub(in crate::model::mass_spring) fn add_block(&mut self, i: usize, j: usize, block: &Mat2) {
        for r in 0..2 {
            for c in 0..2 {
                if i != j || c >= r {
                    self.hessian.add(2 * i + r, 2 * j + c, block[(r, c)]);
                }
            }
        }
    }

    pub(in crate::model::mass_spring) fn add_gradient(&mut self, node: usize, g: Vec2) {
        self.gradient[2 * node] += g.x;
        self.gradient[2 * node + 1] += g.y;
    }

    fn add_energy<const N: usize>(&mut self, nodes: [usize; N], gradient: [Vec2; N], blocks: &Blocks<N>) {
        for a in 0..N {
            self.add_gradient(nodes[a], gradient[a]);
            for b in a..N {
                self.add_block(nodes[a], nodes[b], &blocks[a][b]);
            }
        }
    }
}

impl MassSpringModel {
    /// Moves the nodes to equilibrium. On an error they are somewhere on the way.
    pub(in crate::model::mass_spring) fn equilibrium(&mut self, anchors: Anchors) -> Result<(), SolveError> {
        self.chain.v.fill(Vec2::zeros());
        self.clock.behind_s = 0.0;
        self.place_supports();
        if !self.drives.held.contains(&true) && !self.touches_something() {
            return Err(SolveError::NoRestingPlace { why: NoEquilibrium::NothingBelow });
        }
        self.weigh();
        let mut contacts = Contacts::new(self, anchors);
        for p in &mut self.wheels.pulleys {
            p.rate = 0.0;
            if anchors == Anchors::Forgotten {
                p.anchor = self.chain.s[p.node];
            }
        }
        self.newton(&mut contacts)?;
        self.contacts.anchors = contacts.commit(self);
        for k in 0..self.wheels.pulleys.len() {
            let p = &mut self.wheels.pulleys[k];
            let s = self.chain.s[p.node];
            p.anchor = s - friction::return_map(s - p.anchor, PULLEY_SLIP);
        }
        self.report.cost.inner_step_s = 0.0;
        contacts.report(self);
        self.forces();
        self.non_finite().map_or(Ok(()), Err)
    }

    fn newton(&mut self, contacts: &mut Contacts) -> Result<(), SolveError> {
        let mut system = System::new(self)?;
        let unit = self.problem.axial_stiffness / self.chain.rest.iter().copied().fold(f64::INFINITY, f64::min);
        // What meets the ground is as stiff as that: a step must be short for it, too.
        let stiffest = larger(unit, contacts.stiffness(self));
        let tolerance = self.rest_tolerance();
        let mut shift = FIRST_SHIFT * unit;
        let mut curvature = Curvature::Exact;
        contacts.refresh(self);
        let mut energy = self.assemble(&mut system, contacts, curvature);
        let (mut worst, mut node) = self.unbalanced(&system);
        // Steps since normal forces were taken over into friction.
        let mut frozen = 0;
        for k in 1..=MAX_STEPS {
            self.report.cost.iterations = k;
            self.report.cost.residual_n = worst;
            if worst <= tolerance && frozen == 0 {
                return Ok(());
            }
            let solved = self.try_step(&mut system, shift);
            let new = self.assemble(&mut system, contacts, Curvature::Exact);
            let (left, at) = self.unbalanced(&system);
            // Near round-off the energy no longer tells a better state, the unbalanced force does.
            if solved && new.is_finite() && (new < energy || left < worst) {
                shift = (shift * SHIFT_DOWN).max(LEAST_SHIFT * unit);
                curvature = Curvature::Exact;
                (energy, worst, node) = (new, left, at);
                system.fade *= LENT_STIFFNESS_FADE;
                let remeshed = !self.wheels.pulleys.is_empty() && self.remesh();
                if remeshed {
                    let fade = system.fade;
                    system = System { fade, ..System::new(self)? };
                }
                let due = k < EAGER_FRICTION_STEPS || left <= tolerance || frozen >= MOST_FROZEN || remeshed;
                frozen = if due { 0 } else { frozen + 1 };
                if due && (contacts.refresh(self) || remeshed) {
                    energy = self.assemble(&mut system, contacts, curvature);
                    (worst, node) = self.unbalanced(&system);
                }
            } else {
                self.chain.x.copy_from_slice(&system.x);
                self.chain.s.copy_from_slice(&system.s);
                self.weigh();
                if solved {
                    shift *= SHIFT_UP;
                } else if curvature == Curvature::Exact {
                    curvature = Curvature::Clipped;
                } else {
                    shift *= SHIFT_UP;
                }
                if !(shift < LAST_SHIFT * stiffest) {
                    break;
                }
                energy = self.assemble(&mut system, contacts, curvature);
            }
        }
        Err(SolveError::NotConverged {
            model: Model::MassSpring,
            iterations: self.report.cost.iterations,
            residual_n: worst,
            place: self.problem.place(self.chain.s[node], self.chain.x[node], self.clock.time_s),
        })
    }

    /// Unbalanced force that counts as none, N: a part of the forces here, but never below what
    /// round-off of the positions makes of EA.
    fn rest_tolerance(&self) -> f64 {
        let part = if self.touches_something() { TOUCHING_RESIDUAL } else { RESIDUAL };
        let far =
            self.chain.x.iter().map(|p| p.amax()).fold(self.problem.length, |a: f64, b| if b > a { b } else { a });
        let shortest = self.chain.rest.iter().copied().fold(f64::INFINITY, f64::min);
        part * self.problem.force_scale() + ULPS * f64::EPSILON * self.problem.axial_stiffness * far / shortest
    }

    /// Goes one step; whether the tangent was positive. The place before is kept in the system.
    fn try_step(&mut self, system: &mut System, shift: f64) -> bool {
        let n = self.chain.x.len();
        system.x.copy_from_slice(&self.chain.x);
        system.s.copy_from_slice(&self.chain.s);
        for i in 0..n {
            system.hessian.add(2 * i, 2 * i, shift);
            system.hessian.add(2 * i + 1, 2 * i + 1, shift);
        }
        for i in 0..n {
            let slides = self.wheels.pulley_at[i].is_some();
            for axis in 0..2 {
                if self.drives.held[i] && !(slides && axis == 0) {
                    system.gradient[2 * i + axis] = 0.0;
                    system.hessian.pin(2 * i + axis);
                }
            }
        }
        if system.factor.factor(&system.hessian).is_err() {
            return false;
        }
        system.step.copy_from_slice(&system.gradient);
        system.factor.solve_in_place(&mut system.step);
        let limit = if self.problem.world.is_empty() { f64::INFINITY } else { MOST_MOVE * self.problem.radius };
        let mut scale = 1.0;
        for i in 0..n {
            let (size, limit) = if self.wheels.pulley_at[i].is_some() {
                (system.step[2 * i].abs(), MOST_SLIDE * self.chain.even)
            } else {
                (system.step[2 * i].hypot(system.step[2 * i + 1]), limit)
            };
            if size * scale > limit {
                scale = limit / size;
            }
        }
        for i in 0..n {
            let step = Vec2::new(system.step[2 * i], system.step[2 * i + 1]) * scale;
            if self.wheels.pulley_at[i].is_some() {
                self.chain.s[i] -= step.x;
            } else {
                self.chain.x[i] -= step;
            }
        }
        self.weigh();
        true
    }

    /// Energy, gradient and Hessian here; the tensions too.
    fn assemble(&mut self, system: &mut System, contacts: &mut Contacts, curvature: Curvature) -> f64 {
        system.hessian.clear();
        system.gradient.fill(0.0);
        let mut value = self.assemble_loads(system);
        for e in 0..self.chain.rest.len() {
            value += self.assemble_spring(system, e);
        }
        if self.problem.bending_stiffness > 0.0 {
            value += self.assemble_bending(system, curvature);
        }
        value += contacts.assemble(self, system);
        let body = self.problem.body_force(self.clock.time_s);
        for k in 0..self.wheels.pulleys.len() {
            self.load_pulley(k, body);
            let p = &self.wheels.pulleys[k];
            let (_, slope, stiff) = friction::at(self.chain.s[p.node] - p.anchor, p.hold, PULLEY_SLIP);
            value += friction::at(self.chain.s[p.node] - p.anchor, p.hold, PULLEY_SLIP).0;
            system.gradient[2 * p.node] = slope - p.drive;
            system.hessian.add(2 * p.node, 2 * p.node, stiff);
        }
        value
    }

    /// Weight, wind and loads.
    fn assemble_loads(&self, system: &mut System) -> f64 {
        let p = &self.problem;
        let body = p.body_force(self.clock.time_s);
        let mut value = 0.0;
        for e in 0..self.chain.rest.len() {
            let moment = if self.at_pulley(e) {
                let r = self.reach(e);
                // σ moves half of the weight to the other end's side.
                for (node, other, sign) in [(e, e + 1, 1.0), (e + 1, e, -1.0)] {
                    if self.wheels.pulley_at[node].is_some() && self.wheels.pulley_at[other].is_none() {
                        system.hessian.add(2 * other, 2 * node, 0.5 * sign * body.x);
                        system.hessian.add(2 * other + 1, 2 * node, 0.5 * sign * body.y);
                    }
                }
                r.middle * self.chain.share[e] + r.hung / p.thermal_stretch
            } else {
                (self.chain.x[e] + self.chain.x[e + 1]) * (0.5 * self.chain.share[e])
            };
            let half = body * (0.5 * self.chain.share[e]);
            value -= body.dot(&moment);
            system.add_gradient(e, -half);
            system.add_gradient(e + 1, -half);
        }
        let g = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        let supports =
            p.supports.iter().zip(&self.chain.node_of).map(|(u, &k)| (k, u.force.at(self.clock.time_s) + g * u.mass));
        let loads = p.loads.iter().zip(&self.chain.load_node).map(|(l, &k)| (k, l.force.at(self.clock.time_s)));
        for (k, force) in supports.chain(loads) {
            value -= force.dot(&self.chain.x[k]);
            system.add_gradient(k, -force);
        }
        value
    }

    fn assemble_spring(&mut self, system: &mut System, e: usize) -> f64 {
        let r = self.reach(e);
        let (l0, ea, lambda) = (self.chain.rest[e], self.problem.axial_stiffness, self.problem.thermal_stretch);
        let stretch = r.length - l0;
        let (taut, lent) = (stretch > 0.0, system.lent[e] * system.fade);
        let tension = if taut { ea * stretch / l0 } else { 0.0 };
        self.chain.tension[e] = tension;
        if !taut && lent == 0.0 {
            return 0.0;
        }
        let t = r.direction;
        let along = t * t.transpose();
        let ea = if taut { ea } else { ea * system.fade };
        let across = if tension > lent { tension } else { lent };
        let k = along * (ea / l0) + (Mat2::identity() - along) * if r.free > 0.0 { across / r.free } else { 0.0 };
        let slides = [self.wheels.pulley_at[e].is_some(), self.wheels.pulley_at[e + 1].is_some()];
        let cross = t * (lambda * ea * r.length / (l0 * l0));
        let square = lambda * lambda * ea * r.length * r.length / l0.powi(3);
        for (i, sign, slides) in [(e, -1.0, slides[0]), (e + 1, 1.0, slides[1])] {
            if slides {
                system.hessian.add(2 * i, 2 * i, square);
            } else {
                system.add_gradient(i, t * (sign * tension));
                system.add_block(i, i, &k);
            }
        }
        match slides {
            [false, false] => system.add_block(e, e + 1, &-k),
            [true, true] => system.hessian.add(2 * e, 2 * e + 2, -square),
            [first, _] => {
                let (wheel, other) = if first { (e, e + 1) } else { (e + 1, e) };
                system.hessian.add(2 * other, 2 * wheel, cross.x);
                system.hessian.add(2 * other + 1, 2 * wheel, cross.y);
            }
        }
        0.5 * tension * stretch
    }

    fn assemble_bending(&self, system: &mut System, curvature: Curvature) -> f64 {
        let mut value = 0.0;
        for n in 0..self.chain.x.len() {
            if let Some(direction) = self.clamp_at(n) {
                for e in n.saturating_sub(1)..(n + 1).min(self.chain.rest.len()) {
                    let (bend, x) = (self.clamp_bend(e, direction), [self.chain.x[e], self.chain.x[e + 1]]);
                    value += bend.value(&x);
                    system.add_energy([e, e + 1], bend.gradient(&x), &bend.hessian(&x, curvature));
                }
            } else if let Some(bend) = self.bend_at(n) {
                let x = [self.chain.x[n - 1], self.chain.x[n], self.chain.x[n + 1]];
                value += bend.value(&x);
                system.add_energy([n - 1, n, n + 1], bend.gradient(&x), &bend.hessian(&x, curvature));
            }
        }
        value
    }

    /// The largest unbalanced force, N, and its node; NaN wins.
    fn unbalanced(&self, system: &System) -> (f64, usize) {
        let mut out = (0.0, 0);
        for i in 0..self.chain.x.len() {
            let g = Vec2::new(system.gradient[2 * i], system.gradient[2 * i + 1]);
            let force = match (self.wheels.pulley_at[i].is_some(), self.drives.held[i]) {
                (true, _) => g.x.abs(),
                (false, true) => 0.0,
                (false, false) => g.norm(),
            };
            if force > out.0 || force.is_nan() {
                out = (force, i);
            }
        }
        out
    }
}
