//! This solver balances the preview's springs for the whole cable at once.
//!
//! With λ = −T h² (T tension, h the sub-step), w the inverse masses, t the directions and C =
//! length − l₀ at the predicted place, Δx = w ∇C λ and C + λ l₀/(EA h²) = 0 make
//!
//! ```text
//! A λ = −C,   A_ee = w_e + w_{e+1} + l₀/(EA h²),   A_{e,e+1} = −w_{e+1} t_e·t_{e+1}
//! ```
//!
//! tridiagonal; compressed elements are left out. Between the elements b before and a after a
//! pulley the material σ (mass m, thermal stretch θ) takes the place of the node: C_b = C_b⁰ − θΔσ,
//! C_a = C_a⁰ + θΔσ. Friction is Coulomb's on a round, |T_b − T_a| ≤ g (T_b + T_a), g = tanh(μφ/2),
//! sliding in the sense s = ±1 or stuck:
//!
//! ```text
//! stuck:  Δσ = 0                                  as long as |θ(T_b − T_a) + mΔσ⁰/h²| ≤ θ g (T_b + T_a)
//! slides: Δσ = Δσ⁰ + θ/m (−(λ_b − λ_a) + s g (λ_b + λ_a))   as long as s Δσ > 0
//! A_bb += θ²/m (1 − s g),  A_ba = −θ²/m (1 + s g),  A_aa += θ²/m (1 + s g),  A_ab = −θ²/m (1 − s g)
//! ```
//!
//! so the ratio of the capstan, (1 + g)/(1 − g) = e^{μφ}, holds at the end of the sub-step and not
//! a sub-step late. The tensions in g's law are those at the wheel: half an element's weight, taken
//! from the last sub-step, is added.

use crate::math::Vec2;
use crate::model::mass_spring::mesh::{Mesh, Pulley, least_straight_length};

/// Friction of the material on a pulley in a sub-step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum PulleyFriction {
    /// Friction holds it.
    #[default]
    Stuck,
    /// It slides, +1 to the side before the pulley, −1 to the side after it.
    Slides(f64),
    /// No material is left that could slide through.
    Blocked,
}

/// The solver of the constraints of one sub-step; it keeps its memory from one to the next.
#[derive(Default)]
pub(in crate::model::mass_spring) struct ConstraintSolver {
    /// Predicted position of each node, m.
    pub position: Vec<Vec2>,
    /// The same without springs and contacts, m.
    pub free: Vec<Vec2>,
    /// Inverse masses of the nodes, 1/kg; 0 where supported.
    pub inverse_mass: Vec<f64>,
    direction: Vec<Vec2>,
    violation: Vec<f64>,
    active: Vec<bool>,
    /// The matrix: `lower[e]` is A between rows e and e − 1, `upper[e]` between rows e − 1 and e.
    diagonal: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// The same while it is eliminated.
    pivot: Vec<f64>,
    lambda: Vec<f64>,
    friction: Vec<PulleyFriction>,
}

impl ConstraintSolver {
    /// Moves the predicted nodes, and the material on pulleys, so that the springs balance, and
    /// sets their tensions.
    pub(in crate::model::mass_spring) fn solve(&mut self, mesh: &mut Mesh, h: f64) {
        self.set_spring_rows(mesh, h);
        for _ in 0..mesh.tuning.preview.max_rounds {
            self.set_pulley_rows(mesh, h);
            self.eliminate();
            let mut changed = false;
            for e in 0..self.lambda.len() {
                if self.active[e] && self.lambda[e] > 0.0 {
                    (self.active[e], self.lambda[e], changed) = (false, 0.0, true);
                }
            }
            if !(changed | self.update_friction(mesh, h)) {
                break;
            }
        }
        for k in 0..mesh.wheels.pulleys.len() {
            let p = mesh.wheels.pulleys[k];
            let by = self.slide(mesh, &p, self.friction[k], h);
            // The last round may leave a pulley that slides against its friction: it stops.
            let by = if matches!(self.friction[k], PulleyFriction::Slides(s) if p.friction > 0.0 && s * by < 0.0) {
                0.0
            } else {
                by
            };
            mesh.arc_length[p.node] += by;
            mesh.wheels.pulleys[k].sliding_speed = by / h;
        }
        let per_square = -1.0 / (h * h);
        let mut before = Vec2::zeros();
        for ((((lambda, tension), direction), x), inverse) in self
            .lambda
            .iter()
            .zip(&mut mesh.tension)
            .zip(&self.direction)
            .zip(&mut self.position)
            .zip(&self.inverse_mass)
        {
            // A NaN passes on, and is detected later.
            let lambda = if *lambda > 0.0 { 0.0 } else { *lambda };
            *tension = lambda * per_square;
            let push = direction * lambda;
            *x += (before - push) * *inverse;
            before = push;
        }
        if let (Some(x), Some(inverse)) = (self.position.last_mut(), self.inverse_mass.last()) {
            *x += before * *inverse;
        }
    }

    /// Sets the rows of springs without pulleys, and the first guess of the friction of these.
    fn set_spring_rows(&mut self, mesh: &Mesh, h: f64) {
        let elements = mesh.rest_length.len();
        let compliance = 1.0 / (mesh.problem.axial_stiffness * h * h);
        self.active.clear();
        self.active.resize(elements, true);
        for list in [&mut self.violation, &mut self.diagonal, &mut self.upper] {
            list.resize(elements, 0.0);
        }
        self.direction.resize(elements, Vec2::zeros());
        let mut before = Vec2::zeros();
        let rows = self
            .position
            .windows(2)
            .zip(self.inverse_mass.windows(2))
            .zip(&mesh.rest_length)
            .zip(self.direction.iter_mut());
        let rows = rows.zip(self.violation.iter_mut()).zip(self.diagonal.iter_mut()).zip(self.upper.iter_mut());
        for ((((((x, inverse), rest), direction), gap), diagonal), upper) in rows {
            let d = x[1] - x[0];
            let length = d.norm();
            *direction = if length > 0.0 { d * length.recip() } else { Vec2::zeros() };
            *upper = -inverse[0] * before.dot(direction);
            *gap = length - rest;
            *diagonal = inverse[0] + inverse[1] + rest * compliance;
            before = *direction;
        }
        for p in &mesh.wheels.pulleys {
            for e in [p.node - 1, p.node] {
                self.direction[e] = mesh.wheels.element(e, &self.position).direction;
            }
            for i in [p.node - 1, p.node + 1].into_iter().filter(|&i| i > 0 && i < elements) {
                self.upper[i] = -self.inverse_mass[i] * self.direction[i - 1].dot(&self.direction[i]);
            }
        }
        self.lower.clone_from(&self.upper);
        self.friction.clear();
        self.friction.extend(mesh.wheels.pulleys.iter().map(|p| match p.sliding_speed {
            _ if p.friction == 0.0 => PulleyFriction::Slides(1.0),
            r if r > 0.0 => PulleyFriction::Slides(1.0),
            r if r < 0.0 => PulleyFriction::Slides(-1.0),
            _ => PulleyFriction::Stuck,
        }));
    }

    /// Sets the rows of springs beside pulleys.
    fn set_pulley_rows(&mut self, mesh: &Mesh, h: f64) {
        let (theta, ea) = (mesh.thermal_stretch, mesh.problem.axial_stiffness);
        for p in &mesh.wheels.pulleys {
            for e in [p.node - 1, p.node] {
                // Its other node, unless that is a pulley, too, whose terms are added below.
                let other = if e < p.node { e } else { e + 1 };
                let inverse = if mesh.wheels.at_node[other].is_none() { self.inverse_mass[other] } else { 0.0 };
                self.diagonal[e] = inverse + mesh.rest_length[e] / (ea * h * h);
                self.violation[e] = mesh.wheels.element(e, &self.position).length - mesh.rest_length[e];
            }
        }
        for (k, p) in mesh.wheels.pulleys.iter().enumerate() {
            let i = p.node;
            (self.lower[i], self.upper[i]) = (0.0, 0.0);
            if let PulleyFriction::Slides(sense) = self.friction[k] {
                let (w, g) = (theta * theta / p.mass, sense * p.friction_ratio());
                self.diagonal[i - 1] += w * (1.0 - g);
                self.diagonal[i] += w * (1.0 + g);
                self.upper[i] = -w * (1.0 + g);
                self.lower[i] = -w * (1.0 - g);
                let free = predicted_slide(mesh, p, sense, h);
                self.violation[i - 1] -= theta * free;
                self.violation[i] += theta * free;
            }
        }
    }

    /// Δσ, m: the material that slides over a pulley.
    fn slide(&self, mesh: &Mesh, p: &Pulley, friction: PulleyFriction, h: f64) -> f64 {
        let PulleyFriction::Slides(sense) = friction else { return 0.0 };
        let (before, after) = (self.lambda[p.node - 1], self.lambda[p.node]);
        let pull = (after - before) + sense * p.friction_ratio() * (before + after);
        predicted_slide(mesh, p, sense, h) + mesh.thermal_stretch / p.mass * pull
    }

    /// Sets the stick-slip states of pulleys from their tensions; returns true if any changed.
    fn update_friction(&mut self, mesh: &Mesh, h: f64) -> bool {
        let (theta, least) = (mesh.thermal_stretch, least_straight_length(mesh));
        let mut any = false;
        for (k, p) in mesh.wheels.pulleys.iter().enumerate() {
            let i = p.node;
            let next = match self.friction[k] {
                PulleyFriction::Stuck => {
                    let (before, after) = (-self.lambda[i - 1] / (h * h), -self.lambda[i] / (h * h));
                    let pull = theta * (before - after) + p.sliding_speed * p.mass / h;
                    let most = theta * p.friction_ratio() * (before + after + tension_excess(mesh, p));
                    if pull.abs() > most { PulleyFriction::Slides(pull.signum()) } else { PulleyFriction::Stuck }
                }
                PulleyFriction::Slides(sense) => {
                    let by = self.slide(mesh, p, self.friction[k], h);
                    let blocked =
                        by < 0.0 && mesh.straight_length[i - 1] < least || by > 0.0 && mesh.straight_length[i] < least;
                    if blocked {
                        PulleyFriction::Blocked
                    } else if p.friction > 0.0 && sense * by < 0.0 {
                        PulleyFriction::Stuck
                    } else {
                        self.friction[k]
                    }
                }
                PulleyFriction::Blocked => PulleyFriction::Blocked,
            };
            any |= next != self.friction[k];
            self.friction[k] = next;
        }
        any
    }

    /// A λ = −C of the active elements (L. H. Thomas' elimination; A is diagonally dominant but for
    /// friction, whose columns sum to more than zero as g < 1).
    fn eliminate(&mut self) {
        let elements = self.diagonal.len();
        self.pivot.resize(elements, 0.0);
        self.lambda.resize(elements, 0.0);
        // Elements that are left out have λ = 0 and pass nothing on: 1/pivot = 0.
        let (mut inverse, mut right) = (0.0, 0.0);
        let rows = self.diagonal.iter().zip(&self.lower).zip(&self.upper).zip(&self.violation).zip(&self.active);
        for (((((diagonal, lower), upper), gap), active), (pivot, lambda)) in
            rows.zip(self.pivot.iter_mut().zip(&mut self.lambda))
        {
            let factor = lower * inverse;
            (inverse, right) =
                if *active { ((diagonal - factor * upper).recip(), -gap - factor * right) } else { (0.0, 0.0) };
            (*pivot, *lambda) = (inverse, right);
        }
        let (mut after, mut next) = (0.0, 0.0);
        for ((lambda, inverse), upper) in self.lambda.iter_mut().zip(&self.pivot).zip(&self.upper).rev() {
            after = (*lambda - next * after) * inverse;
            next = *upper;
            *lambda = after;
        }
    }
}

/// Δσ⁰, m: the material that would slide without springs, but with friction in the given sense (0:
/// without).
fn predicted_slide(mesh: &Mesh, p: &Pulley, sense: f64, h: f64) -> f64 {
    let friction = sense * mesh.thermal_stretch * p.friction_ratio() * tension_excess(mesh, p);
    p.sliding_speed * h - friction * h * h / p.mass
}

/// Sum of the tensions at the wheel less those of the elements beside it, N, in the last sub-step.
fn tension_excess(mesh: &Mesh, p: &Pulley) -> f64 {
    p.tension[0] + p.tension[1] - mesh.tension[p.node - 1] - mesh.tension[p.node]
}
