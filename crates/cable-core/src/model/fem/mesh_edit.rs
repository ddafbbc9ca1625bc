//! Putting nodes into a mesh and taking them out: material, place and momentum of what stays are left as they are.

use super::dynamics::Dynamics;
use super::floor;
use super::sliding::Sliding;
use crate::math::Vec2;

impl Dynamics {
    /// Puts a node at an arc length (m) between nodes `k` − 1 and `k`.
    pub(super) fn insert(&mut self, k: usize, arc_length: f64, sliding: Option<Sliding>) {
        self.keep_answer();
        let mesh = &mut self.mesh;
        let path = mesh.path(k - 1, &self.motion.x);
        let (a, b) = (mesh.arc_length[k - 1], mesh.arc_length[k]);
        let part = (arc_length - a) / (b - a);
        let lead = path.arcs[0] * mesh.end(k - 1, &self.motion.x).radius;
        let fraction =
            if path.straight > 0.0 { ((part * path.length - lead) / path.straight).clamp(0.0, 1.0) } else { 0.5 };
        let at = path.ends[0] + (path.ends[1] - path.ends[0]) * fraction;
        let m = &mut self.motion;
        let t = path.direction;
        let speed = |j: usize| if mesh.sliding[j].is_some() { t * -m.w[j] } else { m.v[j] };
        let v = speed(k - 1) * (1.0 - part) + speed(k) * part;
        // The floor does to it what it does to its neighbours.
        let slid = |j: usize| {
            let slid = self.contacts.floor_slid[j];
            if mesh.sliding[j].is_some() { floor::as_move(slid, t) } else { slid }
        };
        let between = slid(k - 1) * (1.0 - part) + slid(k) * part;
        let between = if sliding.is_some() { floor::as_slide(between, t) } else { between };
        let h = m.step_before;
        mesh.arc_length.insert(k, arc_length);
        mesh.rest_length[k - 1] = mesh.thermal_stretch * (arc_length - a);
        mesh.rest_length.insert(k, mesh.thermal_stretch * (b - arc_length));
        mesh.held.insert(k, false);
        mesh.sliding.insert(k, sliding);
        let w = if sliding.is_some() { -v.dot(&t) } else { 0.0 };
        let (x, v) = sliding.map_or((at, v), |s| (s.position(), Vec2::zeros()));
        m.x.insert(k, x);
        m.v.insert(k, v);
        m.x_before.insert(k, x - v * h);
        m.v_before.insert(k, v);
        m.w.insert(k, w);
        m.w_before.insert(k, w);
        m.s_before.insert(k, arc_length - w * h);
        self.reaction.insert(k, Vec2::zeros());
        self.contacts.floor_slid.insert(k, between);
        self.renumber(|node| Some(if node >= k { node + 1 } else { node }));
    }

    /// Takes node `k` out.
    pub(super) fn remove(&mut self, k: usize) {
        self.keep_answer();
        let mesh = &mut self.mesh;
        mesh.arc_length.remove(k);
        mesh.rest_length.remove(k);
        mesh.rest_length[k - 1] = mesh.thermal_stretch * (mesh.arc_length[k] - mesh.arc_length[k - 1]);
        mesh.held.remove(k);
        mesh.sliding.remove(k);
        let m = &mut self.motion;
        m.x.remove(k);
        m.v.remove(k);
        m.x_before.remove(k);
        m.v_before.remove(k);
        m.w.remove(k);
        m.w_before.remove(k);
        m.s_before.remove(k);
        self.reaction.remove(k);
        self.contacts.floor_slid.remove(k);
        self.renumber(|node| match node.cmp(&k) {
            std::cmp::Ordering::Less => Some(node),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(node - 1),
        });
    }

    fn renumber(&mut self, change: impl Fn(usize) -> Option<usize>) {
        for node in &mut self.support_node {
            *node = node.and_then(&change);
        }
        for (node, _) in &mut self.loads {
            *node = change(*node).unwrap_or(*node);
        }
        for clamp in &mut self.mesh.clamps {
            clamp.node = change(clamp.node).unwrap_or(clamp.node);
        }
        self.contacts.renumber(change);
    }
}
