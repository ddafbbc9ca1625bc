//! This is a chain of point masses stepped explicitly: it shares no line with the models it is
//! compared with.
//!
//! Bars pull as Kelvin-Voigt bars do, T = EA (ε + τ dε/dt) where they are stretched and T > 0, and
//! never push unless the chain is stiff. The ground is a penalty spring with a loss of its own
//! under each node, and under each bar at corners of the ground between its nodes; friction is
//! Coulomb's, as far as it stops what slides within one step. Symplectic Euler at a part of the
//! stable step. The centre line stays the cable's radius away from the ground. Bending is the
//! moment EI κ + Σ q at nodes, with one Maxwell element q' = −q/θ + EI y κ' in each decade of
//! frequency. The loss factor is constant with y = (2/π) ln 10 times it: the integral of y ωθ/(1 +
//! ω²θ²) over ln θ is π/2 y.

use cable_core::Vec2;

/// The chain and the ground that it lies on. SI units.
#[derive(Clone, Debug)]
pub struct Chain {
    pub density: f64,
    pub stiffness: f64,
    pub bending: f64,
    /// Loss factor of bending.
    pub bending_loss: f64,
    /// Time constant of the loss in stretching.
    pub loss_time: f64,
    pub radius: f64,
    pub friction: f64,
    pub gravity: f64,
    pub ground: Vec<Vec2>,
    /// Contact stiffness, N/m.
    pub contact: f64,
    /// Unstretched length of each bar, m.
    pub bar: f64,
    pub x: Vec<Vec2>,
    pub v: Vec<Vec2>,
    pub force: Vec<Vec2>,
    /// Moments of the Maxwell elements of each node, N m.
    pub branches: Vec<[f64; DECADES]>,
    /// Nothing touches above, m.
    pub top: f64,
    /// Greatest elastic tension of each bar in the step just made, N.
    pub tension: Vec<f64>,
}

/// Maxwell elements of a bend: with relaxation times of 1, 0.1, ... s.
const DECADES: usize = 7;

/// The nearest point of a line, and how far along it is, 0 to 1.
fn nearest(a: Vec2, b: Vec2, p: Vec2) -> (Vec2, f64) {
    let d = b - a;
    let t = ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
    (a + d * t, t)
}

impl Chain {
    /// The same chain cut into bars, lying at rest along `x` (m).
    pub fn laid(self, length: f64, x: Vec<Vec2>) -> Self {
        let n = x.len();
        Self {
            bar: length / (n - 1) as f64,
            v: vec![Vec2::zeros(); n],
            force: vec![Vec2::zeros(); n],
            tension: vec![0.0; n - 1],
            branches: vec![[0.0; DECADES]; n],
            top: self.ground.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max) + self.radius,
            x,
            ..self
        }
    }

    /// A chain of figures alone, to be given nodes by [`Self::laid`].
    pub fn figures() -> Self {
        Self {
            density: 1.0,
            stiffness: 1e6,
            bending: 0.0,
            bending_loss: 0.0,
            loss_time: 1e-3,
            radius: 0.014,
            friction: 0.6,
            gravity: super::G,
            ground: Vec::new(),
            contact: 2e5,
            bar: 1.0,
            x: Vec::new(),
            v: Vec::new(),
            force: Vec::new(),
            branches: Vec::new(),
            top: 0.0,
            tension: Vec::new(),
        }
    }

    /// Pieces of ground (from point g − 1 to point g) near places between two (m).
    fn pieces(&self, a: f64, b: f64) -> std::ops::Range<usize> {
        let (from, to) = (a.min(b) - self.radius, a.max(b) + self.radius);
        let first = self.ground.partition_point(|p| p.x < from).max(1);
        let last = self.ground.partition_point(|p| p.x <= to).min(self.ground.len() - 1);
        first..last + 1
    }

    fn mass(&self, k: usize) -> f64 {
        let whole = self.density * self.bar;
        if k == 0 || k + 1 == self.x.len() { 0.5 * whole } else { whole }
    }

    /// Stiffness of each Maxwell element of a bend as a part of EI.
    fn part(&self) -> f64 {
        std::f64::consts::FRAC_2_PI * std::f64::consts::LN_10 * self.bending_loss
    }

    /// The longest stable step, s: 2/ω (√(1 + ζ²) − ζ) of the highest frequency of bars and of
    /// contacts.
    pub fn stable_step(&self) -> f64 {
        let mass = self.density * self.bar;
        let limit = |rate: f64, loss: f64| {
            let omega = rate.sqrt();
            let zeta = 0.5 * omega * loss;
            2.0 / omega * ((1.0 + zeta * zeta).sqrt() - zeta)
        };
        let bars = limit(4.0 * self.stiffness / (self.bar * mass), self.loss_time);
        let unrelaxed = 1.0 + self.part() * DECADES as f64;
        let bends = limit(16.0 * self.bending * unrelaxed / (self.bar.powi(3) * mass) + 1e-9, 0.0);
        let contacts = limit(4.0 * self.contact / mass, 2.0 / (self.contact / mass).sqrt());
        bars.min(bends).min(contacts)
    }

    /// One step of `h` (s).
    pub fn step(&mut self, h: f64) {
        let n = self.x.len();
        let weight = Vec2::new(0.0, -self.gravity);
        for k in 0..n {
            self.force[k] = weight * self.mass(k);
        }
        for e in 0..n - 1 {
            let d = self.x[e + 1] - self.x[e];
            let length = d.norm();
            let t = d / length;
            let elastic = self.stiffness * (length / self.bar - 1.0);
            self.tension[e] = elastic.max(0.0);
            let is_stiff = self.bending > 0.0;
            if elastic > 0.0 || is_stiff {
                let rate = (self.v[e + 1] - self.v[e]).dot(&t) / self.bar;
                let whole = elastic + self.stiffness * self.loss_time * rate;
                // A stiff cable can be pushed.
                let pull = t * if is_stiff { whole } else { whole.max(0.0) };
                self.force[e] += pull;
                self.force[e + 1] -= pull;
            }
        }
        if self.bending > 0.0 {
            let part = self.part();
            for k in 1..n - 1 {
                // The turn is linear in the places where it is small; here its exact gradient is
                // used.
                let (a, b) = (self.x[k] - self.x[k - 1], self.x[k + 1] - self.x[k]);
                let turn = (a.x * b.y - a.y * b.x).atan2(a.dot(&b));
                let across = |d: Vec2| Vec2::new(-d.y, d.x) / d.norm_squared();
                let (na, nb) = (across(a), across(b));
                let rate = nb.dot(&(self.v[k + 1] - self.v[k])) - na.dot(&(self.v[k] - self.v[k - 1]));
                let mut moment = self.bending / self.bar * turn;
                for (decade, q) in self.branches[k].iter_mut().enumerate() {
                    let relaxation_s = 0.1f64.powi(decade as i32);
                    *q = (*q + self.bending / self.bar * part * rate * h) / (1.0 + h / relaxation_s);
                    moment += *q;
                }
                self.force[k - 1] -= na * moment;
                self.force[k] += (na + nb) * moment;
                self.force[k + 1] -= nb * moment;
            }
        }
        for k in 0..n {
            let at = self.x[k];
            if at.y > self.top {
                continue;
            }
            for g in self.pieces(at.x, at.x) {
                let (a, b) = (self.ground[g - 1], self.ground[g]);
                let (p, part) = nearest(a, b, at);
                // At corners the next piece of ground counts once.
                if part >= 1.0 && g + 1 < self.ground.len() && nearest(b, self.ground[g + 1], at).1 > 0.0 {
                    continue;
                }
                if part <= 0.0 && g > 1 {
                    continue;
                }
                let along = (b - a).normalize();
                let up = Vec2::new(-along.y, along.x);
                let away = at - p;
                let gap = if away.dot(&up) < 0.0 { -away.norm() } else { away.norm() } - self.radius;
                if gap < 0.0 {
                    let normal = if part > 0.0 && part < 1.0 { up } else { away.normalize() };
                    self.touch([k, k], [1.0, 0.0], (gap, normal), h);
                }
            }
        }
        for e in 0..n - 1 {
            let (a, b) = (self.x[e], self.x[e + 1]);
            if a.y.min(b.y) > self.top {
                continue;
            }
            for g in self.pieces(a.x, b.x) {
                let corner = self.ground[g];
                if g + 1 == self.ground.len() {
                    continue;
                }
                if corner.x < a.x.min(b.x) - self.radius || corner.x > a.x.max(b.x) + self.radius {
                    continue;
                }
                let (p, part) = nearest(a, b, corner);
                if part <= 0.0 || part >= 1.0 {
                    continue;
                }
                let (before, after) = (corner - self.ground[g - 1], self.ground[g + 1] - corner);
                if before.x * after.y - before.y * after.x > 0.0 {
                    continue; // a dent
                }
                let up = {
                    let d = (b - a).normalize();
                    let n = Vec2::new(-d.y, d.x);
                    if n.y < 0.0 { -n } else { n }
                };
                let gap = (p - corner).dot(&up) - self.radius;
                if gap < 0.0 && gap > -4.0 * self.radius {
                    self.touch([e, e + 1], [1.0 - part, part], (gap, up), h);
                }
            }
        }
        for k in 0..n {
            let mass = self.mass(k);
            self.v[k] += self.force[k] * (h / mass);
            self.x[k] += self.v[k] * h;
        }
    }

    /// Normal force with loss, and friction that stops the sliding of this step at most.
    fn touch(&mut self, nodes: [usize; 2], part: [f64; 2], (gap, normal): (f64, Vec2), h: f64) {
        let mass = self.density * self.bar;
        let v = self.v[nodes[0]] * part[0] + self.v[nodes[1]] * part[1];
        // Critical damping of one bar's mass on the spring.
        let loss = 2.0 * (self.contact * mass).sqrt();
        let push = (-self.contact * gap - loss * v.dot(&normal)).max(0.0);
        let tangent = Vec2::new(normal.y, -normal.x);
        let slides = v.dot(&tangent);
        let stop = mass * slides / h * 0.5;
        let rub = stop.clamp(-self.friction * push, self.friction * push);
        for j in 0..2 {
            self.force[nodes[j]] += (normal * push - tangent * rub) * part[j];
        }
    }
}
