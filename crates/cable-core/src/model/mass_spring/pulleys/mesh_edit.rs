//! Nodes are put into the chain and taken out of it beside pulleys.
//!
//! Mass and momentum are conserved, kinetic energy falls or stays (it is convex). A node taken out
//! shortens the way by the sag it stood for, one put in hangs on that sag: the difference of rest
//! length is spread over the whole stretch between its fixed marks, so that tension does not jump
//! where it happens.

use crate::math::Vec2;
use crate::model::mass_spring::MassSpringModel;

/// Free part of an element beside a pulley, of the even length, below which its other node is taken
/// out: less shortens the stable step, more remeshes more often.
const SHORTEST_FREE_PART: f64 = 0.3;
/// And beyond which it is halved.
const LONGEST_FREE_PART: f64 = 1.7;
/// Beside what cannot be taken out the material stops at this part of the even length.
const BLOCKED_FREE_PART: f64 = 0.1;
/// Greatest sag of a new node, of its element: more comes of slack, whose tension says nothing.
const MOST_SAG: f64 = 0.1;

impl MassSpringModel {
    /// Material left beside something that does not run through a pulley, m.
    pub(in crate::model::mass_spring) fn least_span(&self) -> f64 {
        BLOCKED_FREE_PART * self.chain.even
    }

    /// Keeps the elements beside pulleys near the even length; returns whether anything changed.
    pub(in crate::model::mass_spring) fn remesh(&mut self) -> bool {
        let mut changed = false;
        for k in 0..self.wheels.pulleys.len() {
            for side in 0..2 {
                let i = self.wheels.pulleys[k].node;
                let e = i - 1 + side;
                if self.chain.share[e] < SHORTEST_FREE_PART * self.chain.even {
                    let n = if side == 0 { i - 1 } else { i + 1 };
                    changed |= self.take_out(k, n);
                } else if self.chain.share[e] > LONGEST_FREE_PART * self.chain.even {
                    changed |= self.put_in(k, e);
                }
            }
        }
        changed
    }

    /// Returns whether a node only belongs to the mesh.
    fn plain(&self, n: usize) -> bool {
        n > 0
            && n + 1 < self.chain.x.len()
            && self.wheels.pulley_at[n].is_none()
            && !self.chain.node_of.contains(&n)
            && !self.chain.load_node.contains(&n)
    }

    fn take_out(&mut self, k: usize, n: usize) -> bool {
        let i = self.wheels.pulleys[k].node;
        if !self.plain(n) {
            return false;
        }
        let far = 2 * n - i;
        // Two wheels keep a node between them.
        if self.wheels.pulley_at[far].is_some() {
            return false;
        }
        let (inner, outer) = if n < i { (n, n - 1) } else { (i, n) };
        let density = self.problem.linear_density;
        let (to_far, to_pulley) = (0.5 * density * self.chain.share[inner], 0.5 * density * self.chain.share[outer]);
        let (v, m) = (self.chain.v[n], self.chain.mass[far]);
        if !self.drives.held[far] {
            self.chain.v[far] = (self.chain.v[far] * m + v * to_far) / (m + to_far);
        }
        let direction = self.reach(inner).direction;
        let sliding = -(v - self.chain.v[i]).dot(&direction);
        let p = &mut self.wheels.pulleys[k];
        p.rate = (p.rate * p.mass + sliding * to_pulley) / (p.mass + to_pulley);
        let before = self.reach(inner).length + self.reach(outer).length;
        let rest = self.chain.s[inner.max(outer) + 1] - self.chain.s[inner.min(outer)];
        self.remove_node(n);
        let merged = if n < i { n - 1 } else { i };
        let after = self.reach(merged).length;
        self.settle_length(merged, rest * (after / before - 1.0));
        true
    }

    fn put_in(&mut self, k: usize, e: usize) -> bool {
        let i = self.wheels.pulleys[k].node;
        let r = self.reach(e);
        let u = self.wheels.pulleys[k].rate;
        let other = if e < i { e } else { e + 1 };
        let sliding = self.chain.v[i] - r.direction * u;
        let velocity = (self.chain.v[other] + sliding) * 0.5;
        let half = 0.5 * r.free;
        // The sag of a parabola under its own weight, q L²/8T with the half element L/2 on each
        // side.
        let body = self.problem.body_force(self.clock.time_s);
        let across = body - r.direction * body.dot(&r.direction);
        let sag = across * (0.5 * half * 0.5 * self.chain.share[e] / self.chain.tension[e]);
        let sag = if sag.norm() <= MOST_SAG * half { sag } else { Vec2::zeros() };
        let at = (r.start + r.end) * 0.5 + sag;
        let rest = self.chain.span[e];
        let s = if e < i {
            self.chain.s[e] + 0.5 * self.chain.share[e]
        } else {
            self.chain.s[e + 1] - 0.5 * self.chain.share[e]
        };
        self.insert_node(e, s, at, velocity);
        let after = self.reach(e).length + self.reach(e + 1).length;
        let changed = if e < i { e } else { e + 1 };
        self.settle_length(changed, rest * (after / r.length - 1.0));
        true
    }

    /// Gives element `e` (the plain one of those that changed) `more` rest length, taken evenly
    /// from the rest of its stretch: material coordinates of the nodes up to the next mark shift a
    /// little.
    fn settle_length(&mut self, e: usize, more: f64) {
        let mark = |n: usize| n == 0 || n + 1 == self.chain.x.len() || !self.plain(n);
        let mut first = e;
        while !mark(first) {
            first -= 1;
        }
        let mut last = e + 1;
        while !mark(last) {
            last += 1;
        }
        let others: f64 = (first..last).filter(|&k| k != e).map(|k| self.chain.span[k]).sum();
        if others > 0.0 && more.abs() < 0.01 * others {
            let mut s = self.chain.s[first];
            for k in first..last - 1 {
                s += if k == e { self.chain.span[k] + more } else { self.chain.span[k] * (1.0 - more / others) };
                self.chain.s[k + 1] = s;
            }
        }
        self.measure();
    }

    fn remove_node(&mut self, n: usize) {
        for list in [&mut self.chain.s, &mut self.chain.mass, &mut self.chain.lump] {
            list.remove(n);
        }
        for list in [&mut self.chain.x, &mut self.chain.v, &mut self.chain.f, &mut self.drives.held_acceleration] {
            list.remove(n);
        }
        self.drives.held.remove(n);
        self.wheels.pulley_at.remove(n);
        for list in [
            &mut self.chain.span,
            &mut self.chain.rest,
            &mut self.chain.share,
            &mut self.chain.tension,
            &mut self.contacts.clearance,
        ] {
            list.remove(n - 1);
        }
        self.renumber(n, -1);
    }

    fn insert_node(&mut self, e: usize, s: f64, x: Vec2, v: Vec2) {
        let n = e + 1;
        self.chain.s.insert(n, s);
        self.chain.mass.insert(n, 0.0);
        self.chain.lump.insert(n, 0.0);
        self.chain.x.insert(n, x);
        self.chain.v.insert(n, v);
        self.chain.f.insert(n, Vec2::zeros());
        self.drives.held_acceleration.insert(n, Vec2::zeros());
        self.drives.held.insert(n, false);
        self.wheels.pulley_at.insert(n, None);
        let tension = self.chain.tension[e];
        for (list, value) in [
            (&mut self.chain.span, 0.0),
            (&mut self.chain.rest, 0.0),
            (&mut self.chain.share, 0.0),
            (&mut self.chain.tension, tension),
            (&mut self.contacts.clearance, 0.0),
        ] {
            list.insert(n, value);
        }
        self.renumber(n, 1);
    }

    /// Nodes from `n` on moved up or down by one.
    fn renumber(&mut self, n: usize, by: isize) {
        let moved = |k: &mut usize| {
            if *k >= n {
                *k = k.wrapping_add_signed(by);
            }
        };
        self.chain.node_of.iter_mut().for_each(moved);
        self.chain.load_node.iter_mut().for_each(moved);
        for p in &mut self.wheels.pulleys {
            moved(&mut p.node);
        }
        self.contacts.clearance.fill(0.0);
        self.contacts.touches.clear();
        self.measure();
    }

    /// Spans, rest lengths and masses from the material coordinates.
    pub(in crate::model::mass_spring) fn measure(&mut self) {
        for e in 0..self.chain.span.len() {
            self.chain.span[e] = self.chain.s[e + 1] - self.chain.s[e];
            self.chain.rest[e] = self.chain.span[e] * self.problem.thermal_stretch;
            self.chain.share[e] = self.chain.span[e];
        }
        let density = self.problem.linear_density;
        for n in 0..self.chain.x.len() {
            self.chain.mass[n] = density * self.half_share(n) + self.chain.lump[n];
        }
        self.weigh();
    }
}
