//! The setup of a step collects forces, targets, inertia, damping and stick-slip states at an
//! instant.

use crate::math::Vec2;
use crate::model::fem::mesh::sliding_node::SlideOver;
use crate::model::fem::newton::step_context::StepContext;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::assembly::Mesh;
use crate::model::fem::system::bar_weight;
use crate::model::fem::system::floor_friction;
use crate::model::fem::system::step_input::Unknowns;
use crate::model::input_filter::MAX_SPEED;
use crate::problem::Problem;
use crate::scene::SupportKind;

/// Factors of sliding nodes count as found when they change by less than this.
const SCALE_TOLERANCE: f64 = 1e-9;

/// Friction of the floor for a node counts as found when it changes by less than this part. More:
/// the cones of a report are not those that were solved for (the checker asks for 1e-3); less:
/// rounds of what moves by rounding.
const FLOOR_FRICTION_TOLERANCE: f64 = 1e-6;

/// Forces at a sliding node within this part of each other are equal: the law is read off bars,
/// whose tension is known to the residual only.
const EVEN_FORCE: f64 = 1e-7;

/// Comparison of unknowns with the friction of sliding nodes with which it was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) struct StickSlipChanges {
    /// Nodes that hold where they should slip, or slip where they should hold.
    pub(in crate::model::fem) wrong: usize,
    /// True if what slips has the friction that belongs to its turn, as nearly as anyone sees.
    pub(in crate::model::fem) lawful: bool,
    /// True if nothing changed but by rounding.
    pub(in crate::model::fem) same: bool,
}

impl StickSlipChanges {
    /// Nothing slides.
    pub(in crate::model::fem) const FOUND: Self = Self { wrong: 0, lawful: true, same: true };

    /// True if the law holds at every sliding node.
    pub(in crate::model::fem) fn hold(self) -> bool {
        self.wrong == 0 && self.lawful
    }
}

impl CableState {
    /// The input of the solve of the present step.
    pub(in crate::model::fem) fn step_context(&self) -> StepContext<'_> {
        StepContext { problem: &self.problem, mesh: &self.mesh, contacts: &self.contacts, input: &self.input }
    }

    /// Sets held nodes, their targets and all forces for the time `to` (s); dragged supports go
    /// where `dragged` says.
    pub(in crate::model::fem) fn prepare_input(&mut self, to: f64, dragged: Option<&[Option<Vec2>]>) {
        self.prepare_step([to, to], dragged);
    }

    /// The same for a step from one time to another (s): what holds at its start holds to its end.
    pub(in crate::model::fem) fn prepare_step(&mut self, [from, to]: [f64; 2], dragged: Option<&[Option<Vec2>]>) {
        self.answers.stepped = None;
        let (problem, mesh, input) = (&self.problem, &mut self.mesh, &mut self.input);
        let n = mesh.nodes();
        let body = problem.body_force(to);
        let gravity =
            if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
        input.body = body;
        input.to = to;
        input.force.clear();
        input.force.extend((0..n).map(|k| body * mesh.share(k)));
        for (node, force) in &self.meshing.loads {
            input.force[*node] += force.at(to);
        }
        input.start.clone_from(&self.motion.x);
        input.target.clone_from(&self.motion.x);
        input.cleared.clear();
        input.hands.clear();
        mesh.held.fill(false);
        mesh.clamps.clear();
        for (k, (s, node)) in problem.supports.iter().zip(&self.meshing.support_node).enumerate() {
            let Some(node) = *node else { continue };
            if s.kind == SupportKind::Pulley {
                continue;
            }
            if s.kind == SupportKind::Load {
                input.force[node] += s.force.at(to);
            }
            input.force[node] += gravity * s.mass;
            if s.holds_from(from)
                && let Some((at, _)) = s.place_at(to)
            {
                let drawn = dragged.and_then(|d| d.get(k).copied().flatten());
                let at = self.motion.followers[k].map_or(drawn.unwrap_or(at), |f| f.position());
                // A support that was stopped and is free again catches up no faster than this
                // beyond its own motion, which is followed exactly.
                let own = s.place_at(from).map_or(0.0, |(before, _)| (at - before).norm());
                let most = if self.motion.followers[k].is_some() { 0.0 } else { own } + MAX_SPEED * (to - from);
                let at = if to > from { within(self.motion.x[node], at, most) } else { at };
                // A support that a hand holds by a spring is a node that moves.
                if self.motion.hands[k].is_none() {
                    mesh.held[node] = true;
                    input.target[node] = clear_way(problem, mesh, self.motion.x[node], at);
                    if input.target[node] != at && !self.answers.held_back.contains(&k) {
                        self.answers.held_back.push(k);
                    }
                }
                if let Some(angle) = s.angle
                    && s.kind == SupportKind::Clamped
                    && mesh.bending_stiffness > 0.0
                {
                    let direction = Vec2::new(angle.cos(), angle.sin());
                    mesh.clamps.push(crate::model::fem::system::assembly::Clamp { node, direction });
                }
            }
        }
        for (k, node) in mesh.sliding.iter_mut().enumerate() {
            let Some(node) = node else { continue };
            if let SlideOver::Pulley(support) = node.slide_over
                && let Some((at, _)) =
                    problem.supports.get(support).filter(|s| s.holds_from(from)).and_then(|s| s.place_at(to))
            {
                let hand = dragged.and_then(|d| d.get(support).copied().flatten());
                let follower = self.motion.followers.get(support).copied().flatten();
                node.end.center = follower.map_or(hand.unwrap_or(at), |f| f.position());
                self.motion.x[k] = node.position();
                input.start[k] = self.motion.x[k];
            }
        }
        input.may_lag = to > from;
        input.outlined = self.outline.is_some();
        input.max_iterations = mesh.tuning.step.max_iterations;
        input.max_move = mesh.tuning.newton.max_move_m;
        input.moves = false;
        input.shift = 0.0;
        input.loss.clear();
        input.loss.resize(mesh.rest_length.len(), [0.0; 2]);
        input.bending_damping = 0.0;
        input.most_noise = f64::INFINITY;
        input.inertia.clear();
        input.inertia.resize(n, 0.0);
        input.predicted.clone_from(&self.motion.x);
        input.coupling.clear();
        input.predicted_length.clear();
        input.predicted_length.extend_from_slice(&mesh.rest_length);
        input.predicted_slide.clear();
        input.predicted_slide.resize(n, 0.0);
        self.set_scale();
        let x = std::mem::take(&mut self.motion.x);
        self.press_on_floor(&x, None);
        for k in 1..n.saturating_sub(1) {
            if self.mesh.sliding[k].is_some() {
                let lies = self.parts_that_lie(k, &x);
                if let Some(node) = &mut self.mesh.sliding[k] {
                    node.lies = lies;
                }
            }
        }
        self.motion.x = x;
    }

    /// Plan view: the friction that the floor has for each node where the cable lies now; returns
    /// whether any of it changed.
    fn press_on_floor(&mut self, x: &[Vec2], slide: Option<&[f64]>) -> bool {
        let Some((friction, normal)) = self.problem.floor_friction else {
            self.input.floor_limit.clear();
            return false;
        };
        let (mesh, limits) = (&self.mesh, &mut self.input.floor_limit);
        let mut changed = limits.len() != mesh.nodes();
        limits.resize(mesh.nodes(), 0.0);
        for (k, limit) in limits.iter_mut().enumerate() {
            let reach: f64 = floor_friction::reaches(mesh, k, x, slide).iter().sum();
            let now = friction * normal * reach;
            changed |= !((now - *limit).abs() <= FLOOR_FRICTION_TOLERANCE * (now + *limit));
            *limit = now;
        }
        changed
    }

    /// The factor of each bar's energy from the grips of the sliding nodes before it.
    pub(in crate::model::fem) fn set_scale(&mut self) {
        let mut scale = 1.0;
        self.input.scale.clear();
        for e in 0..self.mesh.rest_length.len() {
            if let Some(s) = &self.mesh.sliding[e] {
                scale *= s.factor;
            }
            self.input.scale.push(scale);
        }
    }

    /// Reads turn and grip of every sliding node off unknowns and says how that differs from what
    /// the unknowns was found with. Where `one` is set only the first of the grips that are wrong
    /// is changed, and turns half of the way: nearly slack bars hang from a round, and turn over it
    /// by the more the less they pull.
    ///
    /// A node that slid the wrong way until its grip was seen to be wrong has not slid at all.
    pub(in crate::model::fem) fn update_grips(&mut self, unknowns: &mut Unknowns, one: bool) -> StickSlipChanges {
        if self.meshing.never_slides {
            return StickSlipChanges::FOUND;
        }
        let mut grips = StickSlipChanges {
            same: !self.press_on_floor(&unknowns.x, Some(&unknowns.slide)),
            ..StickSlipChanges::FOUND
        };
        for k in 0..self.mesh.nodes() {
            let (Some(node), Some(load)) = (self.mesh.sliding[k], self.load_at(k, &unknowns.x, Some(&unknowns.slide)))
            else {
                continue;
            };
            if !(node.friction > 0.0) {
                continue;
            }
            let mut next = node;
            // Bars that do not pull press on nothing, and what would push where it leaves has no
            // tension that friction could raise.
            let presses = load.turn > 0.0 && load.pull[0] + load.pull[1] > 0.0 && load.pull[1] > 0.0;
            let exponent = if presses { node.friction * load.turn } else { 0.0 };
            next.exponent = if one { 0.5 * (node.exponent + exponent) } else { exponent };
            let inertia = self.input.inertia[k] * (unknowns.slide[k] - self.input.predicted_slide[k]);
            let pulls = load.pull[0].abs() + load.pull[1].abs();
            let slack = self.input.tolerance + EVEN_FORCE * pulls;
            let stiffness = self.mesh.axial_stiffness;
            let grip = load.grip(&next, unknowns.slide[k], [inertia, slack], stiffness);
            if grip != node.grip {
                grips.wrong += 1;
                if !one || grips.wrong == 1 {
                    next.grip = grip;
                }
            }
            next.factor = load.factor(next.grip, next.exponent, stiffness);
            let floor = floor_friction::reaches(&self.mesh, k, &unknowns.x, Some(&unknowns.slide));
            next.floor_factor = floor_friction::factor(floor, load.ratio(next.grip, next.exponent));
            if next.sticks() && !node.sticks() {
                unknowns.slide[k] = 0.0;
            }
            let same = |a: f64, b: f64| (a / b - 1.0).abs() <= SCALE_TOLERANCE;
            grips.same &= same(next.factor, node.factor) && same(next.floor_factor, node.floor_factor);
            let off = ((load.factor(node.grip, exponent, stiffness) - node.factor) * load.pull[1]).abs();
            grips.lawful &= off <= self.mesh.tuning.step.grip_tolerance * pulls * exponent + slack;
            self.mesh.sliding[k] = Some(next);
        }
        self.set_scale();
        grips
    }

    /// Parts of the weight of the bars beside sliding node `k` on rounds that may act there, at
    /// positions (m).
    fn parts_that_lie(&self, k: usize, x: &[Vec2]) -> [f64; 2] {
        let mesh = &self.mesh;
        [k - 1, k].map(|e| {
            let path = mesh.path(e, x);
            let tension = mesh.axial_stiffness * (path.length / mesh.rest_length[e] - 1.0);
            bar_weight::may_lie(mesh, e, &path, self.input.body, tension)
        })
    }

    /// True if the cable is flexible and nothing but its supports can touch it on the way to places
    /// `to` (m).
    pub(in crate::model::fem) fn moves_freely(&self, to: &[Vec2]) -> bool {
        let slides = !self.meshing.never_slides && self.mesh.sliding.iter().any(Option::is_some);
        !slides
            && self.problem.floor_friction.is_none()
            && self.mesh.bending_stiffness == 0.0
            && self.is_out_of_reach(to)
    }

    /// True if nothing but supports can touch the cable on its way to places `to` (m).
    pub(in crate::model::fem) fn is_out_of_reach(&self, to: &[Vec2]) -> bool {
        self.meets_nothing()
            || (!self.contacts.own.shape.is_on() && self.contacts.out_of_reach(&self.mesh, [&self.input.start, to]))
    }
}

/// The point on the way from `from` towards `to` that is at most `most` (m) away.
fn within(from: Vec2, to: Vec2, most: f64) -> Vec2 {
    let (way, distance) = (to - from, (to - from).norm());
    if distance > most { from + way * (most / distance) } else { to }
}

/// Rounding of a gap, m.
const GAP_ROUNDING: f64 = 1e-9;

/// The target of a held node, stopped where an obstacle is in its way (m).
pub(in crate::model::fem) fn clear_way(problem: &Problem, mesh: &Mesh, from: Vec2, to: Vec2) -> Vec2 {
    if problem.world.is_empty() || from == to {
        return to;
    }
    let least_gap = mesh.tuning.step.support_gap_reaches * mesh.tuning.contact.reach_m;
    let gap = |p: Vec2| problem.world.signed_gap(p, least_gap).map_or(least_gap, |g| g.gap_m);
    // A support that the scene puts on a surface may stay on it; none may come nearer than it
    // stands.
    let least = gap(from) - GAP_ROUNDING;
    let free = problem.world.free_fraction([from, from], [to, to], mesh.tuning.step.kept_support_gap_fraction);
    let mut part = if free >= 1.0 { 1.0 } else { free };
    for _ in 0..mesh.tuning.step.stand_off_tries {
        let at = if part >= 1.0 { to } else { from + (to - from) * part };
        if gap(at) >= least {
            return at;
        }
        part *= 0.5;
    }
    from
}
