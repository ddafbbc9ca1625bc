//! Forces, contacts and one sub-step; nothing here allocates once the buffers have grown.

use super::{Follower, MassSpringModel, Touch};
use crate::error::SolveError;
use crate::math::Vec2;

/// Fraction of the stable sub-step that is used: more is unstable as elements stretch, less is slower.
const STEP_SAFETY: f64 = 0.8;
/// Greatest fraction of the cable's radius a node travels in a sub-step: more could pass a thin obstacle.
const TRAVEL: f64 = 0.25;
/// Shortest sub-step, of the stable one: below, motion has run away.
const SHORTEST: f64 = 1e-6;
/// Distance kept ready for contact beside what is travelled, m.
pub(super) const SKIN: f64 = 1e-4;
/// Speed at which a penetration is pushed out, m/s: more throws the cable off, less lets it sink for longer.
const PUSH_OUT_SPEED: f64 = 1.0;
/// Passes over the contacts of a sub-step: one leaves neighbours in each other's way, more changes nothing visible.
const CONTACT_PASSES: usize = 2;

impl MassSpringModel {
    /// Every force but those of supports and contacts, and the tensions.
    pub(super) fn forces(&mut self) {
        let p = &self.problem;
        let body = p.body_force(self.time_s);
        self.f.fill(Vec2::zeros());
        for e in 0..self.rest.len() {
            let d = self.x[e + 1] - self.x[e];
            let (l, l0) = (d.norm(), self.rest[e]);
            let t = if l > 0.0 { d / l } else { Vec2::zeros() };
            let rate = t.dot(&(self.v[e + 1] - self.v[e])) / l0;
            let strain = l / l0 - 1.0;
            // A cable cannot push: neither its elasticity nor its damping. (NaN falls through to the result.)
            let pull = p.axial_stiffness * (strain + self.damping_time_s * rate);
            let tension = if strain < 0.0 || pull < 0.0 { 0.0 } else { pull };
            self.tension[e] = tension;
            let half = body * (0.5 * self.span[e]);
            self.f[e] += t * tension + half;
            self.f[e + 1] += half - t * tension;
        }
        let g = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        for (u, &k) in p.supports.iter().zip(&self.node_of) {
            self.f[k] += u.force.at(self.time_s) + g * u.mass;
        }
        for (l, &k) in p.loads.iter().zip(&self.load_node) {
            self.f[k] += l.force.at(self.time_s);
        }
    }

    /// The longest stable sub-step, s.
    pub(super) fn stable_step(&self) -> f64 {
        let l0 = self.rest.iter().copied().fold(f64::INFINITY, f64::min);
        let omega = 2.0 / l0 * (self.problem.axial_stiffness / self.problem.linear_density).sqrt();
        // τ = 2ζ/ω for this mode.
        let zeta = 0.5 * self.damping_time_s * omega;
        STEP_SAFETY * 2.0 / omega * ((1.0 + zeta * zeta).sqrt() - zeta)
    }

    /// Advances by `dt_s` in equal sub-steps below the stability limit, shorter where motion is fast.
    pub(super) fn integrate(&mut self, dt_s: f64) -> Result<(), SolveError> {
        let (begin, end) = (self.time_s, self.time_s + dt_s);
        let stable = self.stable_step();
        let mut count = 0;
        let mut left = dt_s;
        let mut shortest = f64::INFINITY;
        while left > 0.0 {
            let fastest = self.v.iter().map(Vec2::norm).fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a });
            let travel = TRAVEL * self.problem.radius / fastest;
            let limit = if !self.problem.world.is_empty() && travel < stable { travel } else { stable };
            let h = left / (left / limit).ceil();
            if let Some(e) = self.non_finite() {
                return Err(e);
            }
            if h < SHORTEST * if stable < dt_s { stable } else { dt_s } {
                let node = self.v.iter().position(|v| v.norm() >= fastest).unwrap_or(0);
                return Err(SolveError::StepFailed {
                    model: crate::Model::MassSpring,
                    time_s: self.time_s,
                    dt_s: h,
                    node,
                    residual_n: self.f[node].norm(),
                    cause: format!("a node moves at {fastest:.3e} m/s"),
                });
            }
            left -= h;
            self.time_s = end - left;
            self.supports(h);
            self.forces();
            for i in 0..self.x.len() {
                if !self.held[i] {
                    self.v[i] += self.f[i] * (h / self.mass[i]);
                }
            }
            self.floor_friction(h);
            self.contacts(h);
            for i in 0..self.x.len() {
                self.x[i] += self.v[i] * h;
            }
            count += 1;
            shortest = if h < shortest { h } else { shortest };
        }
        self.cost.iterations = count;
        self.cost.inner_step_s = shortest;
        self.cost.residual_n = 0.0;
        debug_assert!(self.time_s > begin);
        self.non_finite().map_or(Ok(()), Err)
    }

    /// Velocities that bring held nodes to where their supports are at the end of the sub-step.
    fn supports(&mut self, h: f64) {
        self.held.fill(false);
        for (k, support) in self.problem.supports.iter().enumerate() {
            let Some((at, _)) = support.position_at(self.time_s) else { continue };
            let node = self.node_of[k];
            self.held[node] = true;
            let to = match self.drag[k] {
                None => at,
                Some(target) => {
                    let follower = self.followers[k].get_or_insert_with(|| Follower::at_rest(self.x[node]));
                    follower.follow(target, h);
                    follower.position()
                }
            };
            let v = (to - self.x[node]) / h;
            self.held_acceleration[node] = (v - self.v[node]) / h;
            self.v[node] = v;
        }
    }

    /// Puts held nodes where their supports are now.
    pub(super) fn place_supports(&mut self) {
        self.held.fill(false);
        for (k, support) in self.problem.supports.iter().enumerate() {
            let Some((at, _)) = support.position_at(self.time_s) else { continue };
            let node = self.node_of[k];
            self.held[node] = true;
            self.held_acceleration[node] = Vec2::zeros();
            self.x[node] = self.drag[k].unwrap_or(at);
            self.followers[k] = None;
        }
        self.clearance.fill(0.0);
    }

    /// Plan view: the floor takes up to μ·w·ds·dt of each node's momentum.
    pub(super) fn floor_friction(&mut self, h: f64) {
        let Some((mu, normal)) = self.problem.floor_friction else { return };
        for i in 0..self.x.len() {
            let before = if i > 0 { self.span[i - 1] } else { 0.0 };
            let ds = 0.5 * (before + self.span.get(i).copied().unwrap_or(0.0));
            let speed = self.v[i].norm();
            let loss = mu * normal * ds * h / self.mass[i];
            if !self.held[i] {
                self.v[i] = if speed <= loss { Vec2::zeros() } else { self.v[i] * (1.0 - loss / speed) };
            }
        }
    }

    /// Makes velocities such that nothing is entered in this sub-step: at each contact an inelastic normal impulse and
    /// a friction impulse within the Coulomb cone. Inside the cone the tangential velocity becomes exactly zero, so a
    /// held cable does not creep.
    pub(super) fn contacts(&mut self, h: f64) {
        self.touches.clear();
        if self.problem.world.is_empty() {
            return;
        }
        for e in 0..self.rest.len() {
            let (va, vb) = (self.v[e].norm(), self.v[e + 1].norm());
            let travel = if va > vb { va } else { vb } * h;
            self.clearance[e] -= travel;
            if self.clearance[e] > 0.0 {
                continue;
            }
            let near = SKIN + 2.0 * travel;
            let reach = near + self.rest[e];
            self.gaps.clear();
            self.problem.world.segment_gaps(self.x[e], self.x[e + 1], reach, &mut self.gaps);
            let nearest = self.gaps.iter().map(|g| g.gap_m).fold(reach, f64::min);
            self.clearance[e] = nearest - near;
            for gap in self.gaps.iter().filter(|g| g.gap_m < near) {
                self.touches.push(Touch { element: e, gap: *gap, normal: 0.0, friction: 0.0, slips: false });
            }
        }
        for _ in 0..CONTACT_PASSES {
            for k in 0..self.touches.len() {
                let mut touch = self.touches[k];
                self.impulse(&mut touch, h);
                self.touches[k] = touch;
            }
        }
    }

    fn impulse(&mut self, touch: &mut Touch, h: f64) {
        let (a, b, c) = (touch.element, touch.element + 1, touch.gap.fraction);
        let inverse = |i: usize| if self.held[i] { 0.0 } else { 1.0 / self.mass[i] };
        let (ia, ib) = (inverse(a), inverse(b));
        // Inverse mass of the point at fraction c of the element.
        let w = (1.0 - c) * (1.0 - c) * ia + c * c * ib;
        if !(w > 0.0) {
            return;
        }
        let n = touch.gap.normal;
        let v = self.v[a] * (1.0 - c) + self.v[b] * c;
        // The gap after the sub-step is gap + v·n·h ≥ 0; a penetration leaves at a bounded speed.
        let allowed = -touch.gap.gap_m / h;
        let target = if allowed > PUSH_OUT_SPEED { PUSH_OUT_SPEED } else { allowed };
        let wanted = touch.normal + (target - v.dot(&n)) / w;
        let normal = if wanted > 0.0 { wanted } else { 0.0 };
        let change = normal - touch.normal;
        let mut along = self.x[b] - self.x[a];
        along -= n * along.dot(&n);
        let t = along.try_normalize(0.0).unwrap_or(Vec2::new(n.y, -n.x));
        let wanted = touch.friction - v.dot(&t) / w;
        let cone = touch.gap.friction * normal;
        let friction = wanted.clamp(-cone, cone);
        touch.slips = wanted.abs() > cone;
        let j = n * change + t * (friction - touch.friction);
        (touch.normal, touch.friction) = (normal, friction);
        self.v[a] += j * ((1.0 - c) * ia);
        self.v[b] += j * (c * ib);
    }
}
