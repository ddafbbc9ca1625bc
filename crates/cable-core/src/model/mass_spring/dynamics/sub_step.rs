//! A sub-step computes forces and contacts and moves the nodes; it allocates nothing once the
//! buffers have grown.

use crate::error::{FailureCause, SolveError};
use crate::math::{Vec2, smaller};
use crate::model::gauge::TensionGauge;
use crate::model::input_filter::is_led;
use crate::model::mass_spring::{MassSpringModel, SmoothedTarget};

/// Fraction of the stable sub-step that is used: more is unstable as elements stretch, less is
/// slower.
const STEP_SAFETY: f64 = 0.8;
/// Greatest fraction of the cable's radius a node travels in a sub-step: more could pass a thin
/// obstacle.
const TRAVEL_RADIUS_FRACTION: f64 = 0.25;
/// Shortest sub-step, of the stable one: below, motion has run away.
const SHORTEST_SUB_STEP_FRACTION: f64 = 1e-6;

impl MassSpringModel {
    /// Every force but those of supports and contacts, and the tensions.
    pub(in crate::model::mass_spring) fn forces(&mut self) {
        let (ea, thermal) = (self.problem.axial_stiffness, self.problem.thermal_stretch);
        self.pull_of_loads();
        for e in 0..self.chain.rest.len() {
            let l0 = self.chain.rest[e];
            let (length, t, shortening) = if self.at_pulley(e) {
                let r = self.reach(e);
                let rate = |n: usize| self.pulley_of(n).map_or(0.0, |k| k.rate);
                (r.length, r.direction, (rate(e + 1) - rate(e)) * thermal)
            } else {
                let d = self.chain.x[e + 1] - self.chain.x[e];
                let l = d.norm();
                (l, if l > 0.0 { d / l } else { Vec2::zeros() }, 0.0)
            };
            let strain = length / l0 - 1.0;
            let rate = (t.dot(&(self.chain.v[e + 1] - self.chain.v[e])) - shortening * (1.0 + strain)) / l0;
            // A cable cannot push: neither its elasticity nor its damping. (NaN falls through to
            // the result.)
            let pull = ea * (strain + self.chain.damping_time_s * rate);
            let tension = if strain < 0.0 || pull < 0.0 { 0.0 } else { pull };
            self.chain.tension[e] = tension;
            self.chain.f[e] += t * tension;
            self.chain.f[e + 1] -= t * tension;
        }
        self.bend();
        self.load_pulleys();
    }

    /// Forces and what pulleys feel, of the tensions as they are.
    pub(in crate::model::mass_spring) fn read_forces(&mut self) {
        self.pull_of_loads();
        for e in 0..self.chain.rest.len() {
            let pull = self.element_force(e);
            self.chain.f[e] += pull;
            self.chain.f[e + 1] -= pull;
        }
        self.load_pulleys();
    }

    pub(in crate::model::mass_spring) fn load_pulleys(&mut self) {
        let body = self.problem.body_force(self.clock.time_s);
        for k in 0..self.wheels.pulleys.len() {
            self.load_pulley(k, body);
        }
    }

    /// Sets the forces to those of weight, wind and loads.
    pub(in crate::model::mass_spring) fn pull_of_loads(&mut self) {
        let p = &self.problem;
        let body = p.body_force(self.clock.time_s);
        let mut before = Vec2::zeros();
        for (f, share) in self.chain.f.iter_mut().zip(self.chain.share.iter().copied().chain([0.0])) {
            let half = body * (0.5 * share);
            *f = before + half;
            before = half;
        }
        for k in &self.wheels.pulleys {
            let i = k.node;
            self.chain.f[i] +=
                body * (self.chain.span[i - 1] - self.chain.share[i - 1] + self.chain.span[i] - self.chain.share[i]);
        }
        let g = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        for (u, &k) in p.supports.iter().zip(&self.chain.node_of) {
            self.chain.f[k] += u.force.at(self.clock.time_s) + g * u.mass;
        }
        for (l, &k) in p.loads.iter().zip(&self.chain.load_node) {
            self.chain.f[k] += l.force.at(self.clock.time_s);
        }
    }

    /// The longest stable sub-step, s. By Gershgorin's circles a node of mass m between springs k₁,
    /// k₂ swings no faster than ω² = 2(k₁ + k₂)/m, and bending adds 16 EI/(m l³) (its row is 1, −4,
    /// 6, −4, 1).
    pub(in crate::model::mass_spring) fn stable_step(&self) -> f64 {
        let p = &self.problem;
        let mut fastest = 0.0;
        for n in 0..self.chain.x.len() {
            let spring = |e: Option<usize>| e.and_then(|e| self.chain.rest.get(e)).map_or(0.0, |l| 1.0 / l);
            let (before, after) = (spring(n.checked_sub(1)), spring(Some(n)));
            let tighter = if before > after { before } else { after };
            let stiffness = 2.0 * p.axial_stiffness * (before + after) + 16.0 * p.bending_stiffness * tighter.powi(3);
            let mass = self.pulley_of(n).map_or(self.chain.mass[n], |k| k.mass);
            let square = stiffness / mass;
            if square > fastest {
                fastest = square;
            }
        }
        let omega = f64::sqrt(fastest);
        // τ = 2ζ/ω for this mode.
        let zeta = 0.5 * self.chain.damping_time_s * omega;
        STEP_SAFETY * 2.0 / omega * ((1.0 + zeta * zeta).sqrt() - zeta)
    }

    /// Advances by `dt_s` in equal sub-steps below the stability limit, shorter where motion is
    /// fast.
    pub(in crate::model::mass_spring) fn integrate(
        &mut self,
        dt_s: f64,
        gauge: &mut TensionGauge,
    ) -> Result<(), SolveError> {
        let (begin, end) = (self.clock.time_s, self.clock.time_s + dt_s);
        self.release_pulleys();
        self.remesh();
        let mut stable = self.stable_step();
        let mut count = 0;
        let mut left = dt_s;
        let mut shortest = f64::INFINITY;
        let mut trouble = self.no_trouble();
        // Material only slides over pulleys.
        let same = self.wheels.pulleys.is_empty() && gauge.knows(&self.chain.s);
        while left > 0.0 {
            let fastest = self.calm(&mut trouble);
            let travel = TRAVEL_RADIUS_FRACTION * self.problem.radius / fastest;
            let limit = if !self.problem.world.is_empty() && travel < stable { travel } else { stable };
            let h = self.until_let_go(left / (left / limit).ceil());
            if let Some(e) = self.non_finite() {
                return Err(e);
            }
            if h < SHORTEST_SUB_STEP_FRACTION * if stable < dt_s { stable } else { dt_s } {
                let node = self.chain.v.iter().position(|v| v.norm() >= fastest).unwrap_or(0);
                return Err(SolveError::StepFailed {
                    model: crate::Model::MassSpring,
                    time_s: self.clock.time_s,
                    dt_s: h,
                    residual_n: self.chain.f[node].norm(),
                    place: self.problem.place(self.chain.s[node], self.chain.x[node], self.clock.time_s),
                    cause: FailureCause::RunawaySpeed { speed_m_per_s: fastest },
                });
            }
            left -= h;
            self.clock.time_s = end - left;
            self.release_pulleys();
            self.supports(h);
            self.forces();
            self.tell(gauge, same);
            // Velocities go with the middle of a sub-step: from that of the last one to that of
            // this. A motion that begins has half a kick; with a whole one all falls g h t/2 too
            // far, an error of first order.
            let kick = self.clock.behind_s + 0.5 * h;
            self.clock.behind_s = 0.5 * h;
            self.pull_by_hands([kick, h]);
            self.slide([kick, h]);
            for i in 0..self.chain.x.len() {
                if !self.drives.held[i] {
                    self.chain.v[i] += self.chain.f[i] * (kick / self.chain.mass[i]);
                }
            }
            self.account_for_kick(kick);
            self.begin_let_go(kick - 0.5 * h);
            self.floor_friction(kick);
            self.contacts(h);
            for i in 0..self.chain.x.len() {
                self.chain.x[i] += self.chain.v[i] * h;
            }
            if !self.wheels.pulleys.is_empty() {
                self.weigh();
                self.remesh();
                stable = self.stable_step();
            }
            count += 1;
            shortest = if h < shortest { h } else { shortest };
        }
        self.calm(&mut trouble);
        self.warn_of(&trouble);
        self.report.cost.iterations = count;
        self.report.cost.inner_step_s = shortest;
        self.report.cost.residual_n = 0.0;
        debug_assert!(self.clock.time_s > begin);
        self.non_finite().map_or(Ok(()), Err)
    }

    /// A sub-step `h` (s), cut short where a support lets go in it.
    fn until_let_go(&self, h: f64) -> f64 {
        let releases =
            self.problem.supports.iter().filter_map(|s| s.release_between(self.clock.time_s, self.clock.time_s + h));
        releases.map(|at| at - self.clock.time_s).fold(h, smaller)
    }

    /// Tells a gauge the tension; whether its points are the `same` as the nodes, which then are no
    /// pulleys.
    fn tell(&self, gauge: &mut TensionGauge, same: bool) {
        if same {
            let last = self.chain.rest.len();
            let ends = [self.gauged(0), self.gauged(last)];
            if let [first, inner @ .., end] = gauge.room(self.clock.time_s) {
                (*first, *end) = (ends[0], ends[1]);
                for (t, pair) in inner.iter_mut().zip(self.chain.tension.windows(2)) {
                    *t = 0.5 * (pair[0] + pair[1]);
                }
            }
        } else {
            gauge.note(self.clock.time_s, &self.chain.s, |i| self.gauged(i));
        }
        gauge.keep();
    }

    /// Pulleys that have let go become nodes of the chain: the material goes on as it slid.
    pub(in crate::model::mass_spring) fn release_pulleys(&mut self) {
        let mut k = 0;
        while k < self.wheels.pulleys.len() {
            let p = self.wheels.pulleys[k];
            if self.problem.supports[p.support].position_at(self.clock.time_s).is_some() {
                k += 1;
                continue;
            }
            let (b, a) = (self.reach(p.node - 1), self.reach(p.node));
            let along = (b.direction + a.direction).try_normalize(0.0).unwrap_or_default();
            self.chain.x[p.node] = (b.end + a.start) * 0.5;
            self.chain.v[p.node] -= along * p.rate;
            self.wheels.pulleys.remove(k);
            self.wheels.pulley_at.fill(None);
            for (j, q) in self.wheels.pulleys.iter().enumerate() {
                self.wheels.pulley_at[q.node] = Some(j);
            }
            self.measure();
        }
    }

    /// Nodes let go as the sub-step began have the velocity of then: of the time before, `held_s`,
    /// their forces were their supports'.
    fn begin_let_go(&mut self, held_s: f64) {
        for k in 0..self.drives.let_go.len() {
            let i = self.drives.let_go[k];
            let impulse = self.chain.f[i] * held_s;
            self.chain.v[i] -= impulse / self.chain.mass[i];
            self.report.account.supports -= impulse;
        }
    }

    /// Velocities that bring held nodes to where their supports are at the end of the sub-step.
    pub(in crate::model::mass_spring) fn supports(&mut self, h: f64) {
        let begins_s = self.clock.time_s - h;
        self.drives.let_go.clear();
        for (support, &node) in self.problem.supports.iter().zip(&self.chain.node_of) {
            if self.drives.held[node] && !support.holds_from(begins_s) {
                self.drives.let_go.push(node);
            }
        }
        self.drives.held.fill(false);
        for (k, support) in self.problem.supports.iter().enumerate() {
            // What lets go at the end of the sub-step holds to its end.
            let Some((at, _)) = support.place_at(self.clock.time_s).filter(|_| support.holds_from(begins_s)) else {
                self.drives.hands[k] = None;
                continue;
            };
            let node = self.chain.node_of[k];
            self.drives.held[node] = true;
            if self.drives.pulled[k] {
                continue;
            }
            let to = match self.drives.drag[k] {
                None => at,
                Some(target) => {
                    let begins = match self.drives.hands[k].take() {
                        Some(_) => SmoothedTarget::moving(self.chain.x[node], self.chain.v[node]),
                        None => SmoothedTarget::at_rest(self.chain.x[node]),
                    };
                    let follower = self.drives.followers[k].get_or_insert(begins);
                    if is_led(&self.problem, k) {
                        let left = self.clock.due_s - self.clock.time_s + h;
                        follower.lead(target, if left > h { h / left } else { 1.0 }, h);
                    } else {
                        follower.follow(target, h, self.settings.hand_speed_m_per_s);
                    }
                    follower.position()
                }
            };
            let v = (to - self.chain.x[node]) / h;
            self.drives.held_acceleration[node] = (v - self.chain.v[node]) / h;
            self.report.account.supports += (v - self.chain.v[node]) * self.chain.mass[node];
            self.chain.v[node] = v;
        }
        for k in 0..self.drives.pulled.len() {
            if self.drives.pulled[k] && self.drives.held[self.chain.node_of[k]] {
                self.follow_hand(k, h);
            }
        }
    }

    /// Puts the centres of pulleys where they are now.
    pub(in crate::model::mass_spring) fn place_pulleys(&mut self) {
        for k in 0..self.wheels.pulleys.len() {
            let p = self.wheels.pulleys[k];
            if let Some((at, _)) = self.problem.supports[p.support].position_at(self.clock.time_s) {
                self.chain.x[p.node] = self.drives.drag[p.support].unwrap_or(at);
                self.chain.v[p.node] = Vec2::zeros();
            }
        }
    }

    /// Puts held nodes where their supports are now.
    pub(in crate::model::mass_spring) fn place_supports(&mut self) {
        self.release_pulleys();
        self.drives.held.fill(false);
        for (k, support) in self.problem.supports.iter().enumerate() {
            let Some((at, _)) = support.position_at(self.clock.time_s) else { continue };
            let node = self.chain.node_of[k];
            self.drives.held[node] = true;
            self.drives.held_acceleration[node] = Vec2::zeros();
            self.chain.x[node] = self.drives.drag[k].unwrap_or(at);
            self.drives.followers[k] = None;
            self.drives.hands[k] = None;
        }
        self.contacts.clearance.fill(0.0);
    }

    /// Plan view: the floor takes up to μ·w·ds·dt of each node's momentum in a time `h` (s).
    pub(in crate::model::mass_spring) fn floor_friction(&mut self, h: f64) {
        let Some((mu, normal)) = self.problem.floor_friction else { return };
        for i in 0..self.chain.x.len() {
            let before = if i > 0 { self.chain.span[i - 1] } else { 0.0 };
            let ds = 0.5 * (before + self.chain.span.get(i).copied().unwrap_or(0.0));
            let speed = self.chain.v[i].norm();
            let loss = mu * normal * ds * h / self.chain.mass[i];
            if !self.drives.held[i] {
                let kept = if speed <= loss { 0.0 } else { 1.0 - loss / speed };
                self.report.account.contacts -= self.chain.v[i] * ((1.0 - kept) * self.chain.mass[i]);
                self.chain.v[i] *= kept;
            }
        }
    }
}
