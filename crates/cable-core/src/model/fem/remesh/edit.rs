//! An edit puts a node into a mesh or takes one out: material, place and momentum of what stays do
//! not change.

use crate::math::Vec2;
use crate::model::fem::mesh::sliding_node::SlidingNode;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::floor_friction;

impl CableState {
    /// Puts a node at an arc length (m) between nodes `k` − 1 and `k`.
    pub(in crate::model::fem) fn insert(&mut self, k: usize, arc_length: f64, sliding: Option<SlidingNode>) {
        let beside = [k - 1, k].into_iter().find_map(|j| self.mesh.sliding.get(j).copied().flatten());
        match sliding.or(beside) {
            Some(node) => self.as_of(node.slide_over, |d| d.put_in(k, arc_length, sliding)),
            None => self.put_in(k, arc_length, None),
        }
    }

    fn put_in(&mut self, k: usize, arc_length: f64, sliding: Option<SlidingNode>) {
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
        let earlier = |j: usize| if mesh.sliding[j].is_some() { t * -m.w_before[j] } else { m.v_before[j] };
        let v_before = earlier(k - 1) * (1.0 - part) + earlier(k) * part;
        // The floor does to it what it does to its neighbours.
        let slid = |j: usize| {
            let slid = self.contacts.floor_slid[j];
            if mesh.sliding[j].is_some() { floor_friction::as_move(slid, t) } else { slid }
        };
        let between = slid(k - 1) * (1.0 - part) + slid(k) * part;
        let between = if sliding.is_some() { floor_friction::as_slide(between, t) } else { between };
        let h = m.step_before;
        mesh.spread.clear();
        mesh.arc_length.insert(k, arc_length);
        mesh.rest_length[k - 1] = mesh.thermal_stretch * (arc_length - a);
        mesh.rest_length.insert(k, mesh.thermal_stretch * (b - arc_length));
        mesh.held.insert(k, false);
        mesh.sliding.insert(k, sliding);
        let w = if sliding.is_some() { -v.dot(&t) } else { 0.0 };
        let w_before = if sliding.is_some() { -v_before.dot(&t) } else { 0.0 };
        let (x, v, v_before) = sliding.map_or((at, v, v_before), |s| (s.position(), Vec2::zeros(), Vec2::zeros()));
        m.x.insert(k, x);
        m.v.insert(k, v);
        m.x_before.insert(k, x - (v + v_before) * (0.5 * h));
        m.v_before.insert(k, v_before);
        m.w.insert(k, w);
        m.w_before.insert(k, w_before);
        m.s_before.insert(k, arc_length - (w + w_before) * (0.5 * h));
        self.answers.reaction.insert(k, Vec2::zeros());
        self.contacts.floor_slid.insert(k, between);
        self.renumber(|node| Some(if node >= k { node + 1 } else { node }));
    }

    /// Takes node `k` out.
    pub(in crate::model::fem) fn remove(&mut self, k: usize) {
        match self.mesh.sliding.get(k).copied().flatten() {
            Some(node) => self.as_of(node.slide_over, |d| d.take_out(k)),
            None => self.remove_plain(k),
        }
    }

    /// Takes a node out that moves with its material. Its neighbours, where they are free, go on
    /// with its momentum, now and before.
    fn remove_plain(&mut self, k: usize) {
        let beside = [k - 1, k + 1].map(|j| self.mesh.sliding.get(j).copied().flatten());
        let Some(round) = beside.into_iter().flatten().next() else { return self.merge(k) };
        if self.mesh.is_free(k - 1) || self.mesh.is_free(k + 1) {
            // Material that comes to lie on the round has no history.
            let had = self.sliding_momentum_at(&self.motion.w) - self.sliding_momentum_at(&self.motion.w_before);
            self.merge(k);
            let has = self.sliding_momentum_at(&self.motion.w) - self.sliding_momentum_at(&self.motion.w_before);
            self.account_for_history(round.slide_over, had - has);
        } else {
            self.as_of(round.slide_over, |d| d.take_out(k));
        }
    }

    fn merge(&mut self, k: usize) {
        let momentum = |d: &Self| {
            let m = &d.motion;
            [(&m.v, &m.w), (&m.v_before, &m.w_before)].map(|(v, w)| d.moved_by(v) + d.sliding_momentum_at(w))
        };
        let had = momentum(self);
        self.take_out(k);
        let have = momentum(self);
        let free = [k - 1, k].map(|j| self.mesh.is_free(j));
        let mass = |j: usize| if free[j + 1 - k] { self.node_mass(j) } else { 0.0 };
        let mass = mass(k - 1) + mass(k);
        if !(mass > 0.0) {
            return;
        }
        let [v, v_before] = [0, 1].map(|j| (had[j] - have[j]) / mass);
        let m = &mut self.motion;
        for (j, _) in [k - 1, k].into_iter().zip(free).filter(|(_, free)| *free) {
            m.v[j] += v;
            m.v_before[j] += v_before;
            m.x_before[j] -= (v + v_before) * (0.5 * m.step_before);
        }
    }

    fn take_out(&mut self, k: usize) {
        self.keep_answer();
        let mesh = &mut self.mesh;
        mesh.spread.clear();
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
        self.answers.reaction.remove(k);
        self.contacts.floor_slid.remove(k);
        self.renumber(|node| match node.cmp(&k) {
            std::cmp::Ordering::Less => Some(node),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(node - 1),
        });
    }

    fn renumber(&mut self, change: impl Fn(usize) -> Option<usize>) {
        for node in &mut self.meshing.support_node {
            *node = node.and_then(&change);
        }
        for (node, _) in &mut self.meshing.loads {
            *node = change(*node).unwrap_or(*node);
        }
        for clamp in &mut self.mesh.clamps {
            clamp.node = change(clamp.node).unwrap_or(clamp.node);
        }
        self.contacts.renumber(change);
    }
}
