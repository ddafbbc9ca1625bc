//! Impulses act where the cable meets an obstacle in a sub-step.

use crate::error::SolveError;
use crate::math::{Vec2, bounded};
use crate::model::Model;
use crate::model::mass_spring::{MassSpringModel, Touch};

/// Distance kept ready for contact beside what is travelled, m.
pub(in crate::model::mass_spring) const CONTACT_SKIN: f64 = 1e-4;
/// Greatest speed at which a penetration is pushed out, m/s: more throws the cable off, less lets
/// it sink for longer.
const PUSH_OUT_SPEED: f64 = 1.0;
/// Time in which a shallow one is pushed out, s: a cable that rests a few micrometres deep must not
/// jump.
const PUSH_OUT_TIME: f64 = 0.02;
/// Passes over the contacts of a sub-step: one leaves neighbours in each other's way, more changes
/// nothing visible.
const CONTACT_PASSES: usize = 2;

impl MassSpringModel {
    /// Refuses to go on from where the middle of the cable is inside an obstacle: distances have no
    /// sign there, and what should push it out would hold it in. What lies in less deep is pushed
    /// out.
    pub(in crate::model::mass_spring) fn refuse_buried(&self) -> Result<(), SolveError> {
        let world = &self.problem.world;
        if world.is_empty() {
            return Ok(());
        }
        let free = (0..self.chain.x.len()).filter(|&n| !self.drives.held[n] && self.wheels.pulley_at[n].is_none());
        let gaps = free.filter_map(|n| Some((n, world.signed_gap(self.chain.x[n], f64::INFINITY)?)));
        let inside = gaps.filter(|(_, gap)| gap.gap_m < -self.problem.radius);
        if let Some((n, deepest)) = inside.min_by(|a, b| a.1.gap_m.total_cmp(&b.1.gap_m)) {
            return Err(SolveError::Buried {
                model: Model::MassSpring,
                obstacle: world.obstacle_name(deepest.obstacle).to_owned(),
                depth_m: -deepest.gap_m,
                arc_length_m: self.chain.s[n],
                at_m: self.chain.x[n],
            });
        }
        Ok(())
    }

    /// Makes velocities such that nothing is entered in this sub-step: at each contact an inelastic
    /// normal impulse and a friction impulse within the Coulomb cone. Inside the cone the
    /// tangential velocity becomes exactly zero, so a held cable does not creep.
    pub(in crate::model::mass_spring) fn contacts(&mut self, h: f64) {
        self.contacts.touches.clear();
        if self.problem.world.is_empty() {
            return;
        }
        for e in 0..self.chain.rest.len() {
            if self.on_wheel(e) {
                continue;
            }
            let (va, vb) = (self.chain.v[e].norm(), self.chain.v[e + 1].norm());
            let travel = if va > vb { va } else { vb } * h;
            self.contacts.clearance[e] -= travel;
            if self.contacts.clearance[e] > 0.0 {
                continue;
            }
            let near = CONTACT_SKIN + 2.0 * travel;
            let reach = near + self.chain.rest[e];
            self.contacts.gaps.clear();
            self.problem.world.segment_gaps(self.chain.x[e], self.chain.x[e + 1], reach, &mut self.contacts.gaps);
            let nearest = self.contacts.gaps.iter().map(|g| g.gap_m).fold(reach, f64::min);
            self.contacts.clearance[e] = nearest - near;
            for gap in self.contacts.gaps.iter().filter(|g| g.gap_m < near) {
                self.contacts.touches.push(Touch { element: e, gap: *gap, normal: 0.0, friction: 0.0, slips: false });
            }
        }
        for _ in 0..CONTACT_PASSES {
            for k in 0..self.contacts.touches.len() {
                let mut touch = self.contacts.touches[k];
                self.impulse(&mut touch, h);
                self.contacts.touches[k] = touch;
            }
        }
    }

    fn impulse(&mut self, touch: &mut Touch, h: f64) {
        let (a, b, c) = (touch.element, touch.element + 1, touch.gap.fraction);
        let inverse = |i: usize| if self.drives.held[i] { 0.0 } else { 1.0 / self.chain.mass[i] };
        let (ia, ib) = (inverse(a), inverse(b));
        // Inverse mass of the point at fraction c of the element.
        let w = (1.0 - c) * (1.0 - c) * ia + c * c * ib;
        if !(w > 0.0) {
            return;
        }
        let n = touch.gap.normal;
        let v = self.chain.v[a] * (1.0 - c) + self.chain.v[b] * c;
        // The gap after the sub-step is gap + v·n·h ≥ 0; a penetration leaves at a bounded speed.
        let gap = touch.gap.gap_m;
        let target = if gap > 0.0 { -gap / h } else { (-gap / PUSH_OUT_TIME).min(PUSH_OUT_SPEED) };
        let wanted = touch.normal + (target - v.dot(&n)) / w;
        let normal = if wanted > 0.0 { wanted } else { 0.0 };
        let change = normal - touch.normal;
        let mut along = self.chain.x[b] - self.chain.x[a];
        along -= n * along.dot(&n);
        let t = along.try_normalize(0.0).unwrap_or(Vec2::new(n.y, -n.x));
        let wanted = touch.friction - v.dot(&t) / w;
        let cone = touch.gap.friction * normal;
        let friction = bounded(wanted, -cone, cone);
        touch.slips = wanted.abs() > cone;
        let j = n * change + t * (friction - touch.friction);
        (touch.normal, touch.friction) = (normal, friction);
        let of = |i: usize, part: f64| if self.drives.held[i] { 0.0 } else { part };
        self.report.account.contacts += j * (of(a, 1.0 - c) + of(b, c));
        self.chain.v[a] += j * ((1.0 - c) * ia);
        self.chain.v[b] += j * (c * ib);
    }
}
