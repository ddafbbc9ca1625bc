//! The answer of the model.

use super::step::SKIN;
use super::{MassSpringModel, Touch};
use crate::math::{Vec2, cross};
use crate::solution::{CableSolution, ContactReport, ContactState, Node, SupportReaction};

/// Below this speed (m/s) a held node does not rub.
const RESTING_SPEED: f64 = 1e-9;

impl MassSpringModel {
    /// Reads the present state.
    pub(super) fn answer(&self) -> CableSolution {
        CableSolution {
            name: self.problem.cable.name.clone(),
            nodes: (0..self.x.len()).map(|i| self.node(i)).collect(),
            supports: (0..self.node_of.len()).map(|k| self.reaction(k)).collect(),
            contacts: self.contact_reports(),
            error_estimate: None,
        }
    }

    fn element_force(&self, e: usize) -> Vec2 {
        let d = self.x[e + 1] - self.x[e];
        d.try_normalize(0.0).unwrap_or_default() * self.tension[e]
    }

    /// Tension at a node: inside, the mean of its elements' force vectors; at an end, the force there, half an
    /// element's weight and inertia beyond the middle of the last element.
    fn node(&self, i: usize) -> Node {
        let tension_n = match (i.checked_sub(1), i < self.rest.len()) {
            (Some(e), true) => ((self.element_force(e) + self.element_force(i)) * 0.5).norm(),
            _ if self.held[i] => self.on_support(i).norm(),
            (Some(e), false) => self.tension[e],
            (None, _) => self.tension.first().copied().unwrap_or(0.0),
        };
        let curvature_per_m = match (i.checked_sub(1), self.x.get(i + 1)) {
            (Some(e), Some(next)) => {
                let (a, b) = (self.x[i] - self.x[e], next - self.x[i]);
                cross(a, b).atan2(a.dot(&b)) / (0.5 * (self.span[e] + self.span[i]))
            }
            _ => 0.0,
        };
        Node {
            arc_length_m: self.s[i],
            x_m: self.x[i].x,
            y_m: self.x[i].y,
            vx_m_per_s: self.v[i].x,
            vy_m_per_s: self.v[i].y,
            tension_n,
            strain: tension_n / self.problem.axial_stiffness,
            stress_pa: tension_n / self.problem.cable.area_m2(),
            curvature_per_m,
        }
    }

    /// Force of the cable on the support that holds node `i`, N. Ground under the node carries its share of the weight
    /// and rubs on it: without that a drag comes out half an element's friction short.
    fn on_support(&self, i: usize) -> Vec2 {
        let force = self.f[i] - self.held_acceleration[i] * self.mass[i];
        let Some(ground) = self.problem.world.signed_gap(self.x[i], SKIN) else { return force };
        let pressed = -force.dot(&ground.normal);
        if !(pressed > 0.0) {
            return force;
        }
        let along = self.v[i] - ground.normal * self.v[i].dot(&ground.normal);
        let rubbing = along.try_normalize(RESTING_SPEED).unwrap_or_default() * (ground.friction * pressed);
        // At rest the ground can hold what the cable pulls along it, but the support is there for that.
        force + ground.normal * pressed - rubbing
    }

    fn reaction(&self, k: usize) -> SupportReaction {
        let i = self.node_of[k];
        let force = if self.held[i] {
            self.on_support(i)
        } else {
            // A dead load is what hangs there: the cable pulls it the other way.
            -self.problem.supports[k].force.at(self.time_s)
        };
        SupportReaction {
            name: self.problem.supports[k].name.clone(),
            x_m: self.x[i].x,
            y_m: self.x[i].y,
            reaction_x_n: force.x,
            reaction_y_n: force.y,
            arc_length_m: self.s[i],
            tension_before_n: None,
            tension_after_n: None,
        }
    }

    /// Neighbouring contacts with the same obstacle are one.
    fn contact_reports(&self) -> Vec<ContactReport> {
        let h = if self.cost.inner_step_s > 0.0 { self.cost.inner_step_s } else { 1.0 };
        let mut out: Vec<ContactReport> = Vec::new();
        let mut last: Option<(usize, usize, Vec2)> = None;
        for t in self.touches.iter().filter(|t| t.normal > 0.0) {
            let (obstacle, e) = (t.gap.obstacle, t.element);
            match (last, out.last_mut()) {
                (Some((o, before, n)), Some(r)) if o == obstacle && e <= before + 1 => {
                    let turned = cross(n, t.gap.normal).atan2(n.dot(&t.gap.normal));
                    r.turn_deg += turned.to_degrees();
                    self.add(r, t, h);
                }
                _ => {
                    let mut r = ContactReport {
                        obstacle: self.problem.world.obstacle_name(obstacle).to_owned(),
                        tension_before_n: self.tension[e.saturating_sub(1)],
                        ..ContactReport::default()
                    };
                    self.add(&mut r, t, h);
                    out.push(r);
                }
            }
            last = Some((obstacle, e, t.gap.normal));
        }
        for r in &mut out {
            r.turn_deg = r.turn_deg.abs();
            let at = self.s.partition_point(|&s| s <= r.arc_length_m).clamp(1, self.x.len() - 1) - 1;
            let p = self.x[at] + (self.x[at + 1] - self.x[at]) * ((r.arc_length_m - self.s[at]) / self.span[at]);
            (r.x_m, r.y_m) = (p.x, p.y);
        }
        out
    }

    fn add(&self, r: &mut ContactReport, t: &Touch, h: f64) {
        let e = t.element;
        let at = self.s[e] + self.span[e] * t.gap.fraction;
        // The middle, weighted by force.
        let before = r.normal_n;
        r.normal_n += t.normal / h;
        r.arc_length_m = (r.arc_length_m * before + at * (t.normal / h)) / r.normal_n;
        r.friction_n += t.friction / h;
        r.normal = [t.gap.normal.x, t.gap.normal.y];
        r.tension_after_n = self.tension[(e + 1).min(self.tension.len() - 1)];
        if t.slips || before == 0.0 {
            r.state = if t.slips { ContactState::Slip } else { ContactState::Stick };
        }
    }
}
