//! Nodes are put into the chain and taken out of it beside pulleys.
//!
//! Mass and momentum are conserved, kinetic energy falls or stays (it is convex). A node taken out shortens the way by
//! the sag it stood for, one put in hangs on that sag: the difference of rest length is spread over the whole stretch
//! between its fixed marks, so that tension does not jump where it happens.

use crate::math::Vec2;
use crate::model::mass_spring::MassSpringModel;

/// Free part of an element beside a pulley, of the even length, below which its other node is taken out: less shortens
/// the stable step, more remeshes more often.
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
        BLOCKED_FREE_PART * self.even
    }

    /// Keeps the elements beside pulleys near the even length; returns whether anything changed.
    pub(in crate::model::mass_spring) fn remesh(&mut self) -> bool {
        let mut changed = false;
        for k in 0..self.pulleys.len() {
            for side in 0..2 {
                let i = self.pulleys[k].node;
                let e = i - 1 + side;
                if self.share[e] < SHORTEST_FREE_PART * self.even {
                    let n = if side == 0 { i - 1 } else { i + 1 };
                    changed |= self.take_out(k, n);
                } else if self.share[e] > LONGEST_FREE_PART * self.even {
                    changed |= self.put_in(k, e);
                }
            }
        }
        changed
    }

    /// Whether a node only belongs to the mesh.
    fn plain(&self, n: usize) -> bool {
        n > 0
            && n + 1 < self.x.len()
            && self.pulley_at[n].is_none()
            && !self.node_of.contains(&n)
            && !self.load_node.contains(&n)
    }

    fn take_out(&mut self, k: usize, n: usize) -> bool {
        let i = self.pulleys[k].node;
        if !self.plain(n) {
            return false;
        }
        let far = 2 * n - i;
        // Two wheels keep a node between them.
        if self.pulley_at[far].is_some() {
            return false;
        }
        let (inner, outer) = if n < i { (n, n - 1) } else { (i, n) };
        let density = self.problem.linear_density;
        let (to_far, to_pulley) = (0.5 * density * self.share[inner], 0.5 * density * self.share[outer]);
        let (v, m) = (self.v[n], self.mass[far]);
        if !self.held[far] {
            self.v[far] = (self.v[far] * m + v * to_far) / (m + to_far);
        }
        let direction = self.reach(inner).direction;
        let sliding = -(v - self.v[i]).dot(&direction);
        let p = &mut self.pulleys[k];
        p.rate = (p.rate * p.mass + sliding * to_pulley) / (p.mass + to_pulley);
        let before = self.reach(inner).length + self.reach(outer).length;
        let rest = self.s[inner.max(outer) + 1] - self.s[inner.min(outer)];
        self.remove_node(n);
        let merged = if n < i { n - 1 } else { i };
        let after = self.reach(merged).length;
        self.settle_length(merged, rest * (after / before - 1.0));
        true
    }

    fn put_in(&mut self, k: usize, e: usize) -> bool {
        let i = self.pulleys[k].node;
        let r = self.reach(e);
        let u = self.pulleys[k].rate;
        let other = if e < i { e } else { e + 1 };
        let sliding = self.v[i] - r.direction * u;
        let velocity = (self.v[other] + sliding) * 0.5;
        let half = 0.5 * r.free;
        // The sag of a parabola under its own weight, q L²/8T with the half element L/2 on each side.
        let body = self.problem.body_force(self.time_s);
        let across = body - r.direction * body.dot(&r.direction);
        let sag = across * (0.5 * half * 0.5 * self.share[e] / self.tension[e]);
        let sag = if sag.norm() <= MOST_SAG * half { sag } else { Vec2::zeros() };
        let at = (r.start + r.end) * 0.5 + sag;
        let rest = self.span[e];
        let s = if e < i { self.s[e] + 0.5 * self.share[e] } else { self.s[e + 1] - 0.5 * self.share[e] };
        self.insert_node(e, s, at, velocity);
        let after = self.reach(e).length + self.reach(e + 1).length;
        let changed = if e < i { e } else { e + 1 };
        self.settle_length(changed, rest * (after / r.length - 1.0));
        true
    }

    /// Gives element `e` (the plain one of those that changed) `more` rest length, taken evenly from the rest of its
    /// stretch: material coordinates of the nodes up to the next mark shift a little.
    fn settle_length(&mut self, e: usize, more: f64) {
        let mark = |n: usize| n == 0 || n + 1 == self.x.len() || !self.plain(n);
        let mut first = e;
        while !mark(first) {
            first -= 1;
        }
        let mut last = e + 1;
        while !mark(last) {
            last += 1;
        }
        let others: f64 = (first..last).filter(|&k| k != e).map(|k| self.span[k]).sum();
        if others > 0.0 && more.abs() < 0.01 * others {
            let mut s = self.s[first];
            for k in first..last - 1 {
                s += if k == e { self.span[k] + more } else { self.span[k] * (1.0 - more / others) };
                self.s[k + 1] = s;
            }
        }
        self.measure();
    }

    fn remove_node(&mut self, n: usize) {
        for list in [&mut self.s, &mut self.mass, &mut self.lump] {
            list.remove(n);
        }
        for list in [&mut self.x, &mut self.v, &mut self.f, &mut self.held_acceleration] {
            list.remove(n);
        }
        self.held.remove(n);
        self.pulley_at.remove(n);
        for list in [&mut self.span, &mut self.rest, &mut self.share, &mut self.tension, &mut self.clearance] {
            list.remove(n - 1);
        }
        self.renumber(n, -1);
    }

    fn insert_node(&mut self, e: usize, s: f64, x: Vec2, v: Vec2) {
        let n = e + 1;
        self.s.insert(n, s);
        self.mass.insert(n, 0.0);
        self.lump.insert(n, 0.0);
        self.x.insert(n, x);
        self.v.insert(n, v);
        self.f.insert(n, Vec2::zeros());
        self.held_acceleration.insert(n, Vec2::zeros());
        self.held.insert(n, false);
        self.pulley_at.insert(n, None);
        let tension = self.tension[e];
        for (list, value) in [
            (&mut self.span, 0.0),
            (&mut self.rest, 0.0),
            (&mut self.share, 0.0),
            (&mut self.tension, tension),
            (&mut self.clearance, 0.0),
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
        self.node_of.iter_mut().for_each(moved);
        self.load_node.iter_mut().for_each(moved);
        for p in &mut self.pulleys {
            moved(&mut p.node);
        }
        self.clearance.fill(0.0);
        self.touches.clear();
        self.measure();
    }

    /// Spans, rest lengths and masses from the material coordinates.
    pub(in crate::model::mass_spring) fn measure(&mut self) {
        for e in 0..self.span.len() {
            self.span[e] = self.s[e + 1] - self.s[e];
            self.rest[e] = self.span[e] * self.problem.thermal_stretch;
            self.share[e] = self.span[e];
        }
        let density = self.problem.linear_density;
        for n in 0..self.x.len() {
            self.mass[n] = density * self.half_share(n) + self.lump[n];
        }
        self.weigh();
    }
}
