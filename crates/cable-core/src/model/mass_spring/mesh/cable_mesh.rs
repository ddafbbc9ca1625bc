//! The mesh of a cable holds its nodes and springs with their masses and lengths.

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::{Vec2, larger};
use crate::model::bending_change::BendingChange;
use crate::model::length_change::{LEAST_EXCESS, LengthChange, MIN_UNSTRESSED_FRACTION, excess_left};
use crate::model::mass_spring::mesh::node_placement::{
    SAME_PLACE_FRACTION, even_nodes, first_shape, separate_supports,
};
use crate::model::mass_spring::mesh::pulley::{ElementGeometry, Pulley, Wheels};
use crate::model::mass_spring::mesh::relaxation_memory::{RelaxationMemory, memories};
use crate::model::mass_spring::settings::Tuning;
use crate::problem::{Problem, SupportPoint};
use crate::state::State;

part! {
    /// The nodes and springs of a cable, and the pulleys that it runs over.
    Mesh {
        /// The cable that it divides.
        problem: Arc<Problem>,
        /// The tuned constants by which it is solved.
        tuning: Arc<Tuning>,
        /// Unstretched length of a metre of arc length: 1 + αΔT, or on its way there.
        thermal_stretch: f64,
        /// The unstretched length after an edit, on its way to that of the scene.
        length_change: Option<LengthChange>,
        /// EI, N·m²; 0: no bending.
        bending_stiffness: f64,
        /// The bending stiffness after an edit, on its way to that of the scene.
        bending_change: Option<BendingChange>,
        /// Arc length of each node, m.
        arc_length: Vec<f64>,
        /// Position of each node, m.
        position: Vec<Vec2>,
        /// Velocity of each node, m/s.
        velocity: Vec<Vec2>,
        /// Force on each node but that of supports and contacts, N.
        force: Vec<Vec2>,
        /// Mass of each node, kg.
        mass: Vec<f64>,
        /// Part of that mass that belongs to the support at the node, kg.
        point_mass: Vec<f64>,
        /// True where a support holds the node now.
        supported: Vec<bool>,
        /// Acceleration of supported nodes, m/s².
        support_acceleration: Vec<Vec2>,
        /// Unstretched length of each element at the present temperature, m.
        rest_length: Vec<f64>,
        /// Length by which each element is longer unstretched than its material, as a fraction of
        /// it. It fades.
        excess: Vec<f64>,
        /// Arc length of each element at rest temperature, m: weight and wind go with it.
        material_length: Vec<f64>,
        /// Arc length of the straight part of each element (all of it but what lies on a wheel), m.
        straight_length: Vec<f64>,
        /// Tension of each element, N.
        tension: Vec<f64>,
        /// Length of an element where they are even, m.
        even_length: f64,
        /// Node of each support.
        support_node: Vec<usize>,
        /// Node of each load.
        load_node: Vec<usize>,
        /// The material's loss in springs, a slot each.
        spring_memory: RelaxationMemory,
        /// The material's loss in bends, two slots at each node: a free bend has the first, a clamp
        /// bends the halves of the springs before and after it.
        bend_memory: RelaxationMemory,
        /// The pulleys.
        wheels: Wheels,
    }
}

impl Mesh {
    /// Puts a node at each support and load and the others evenly between them, `segments` elements
    /// on the whole cable. `support_arc_lengths` (m) are those of all supports.
    pub(in crate::model::mass_spring) fn new(
        problem: Arc<Problem>,
        tuning: Arc<Tuning>,
        segments: usize,
        support_arc_lengths: &[f64],
    ) -> Self {
        let separated = separate_supports(&problem, &tuning.mesh, support_arc_lengths, segments);
        let nodes = even_nodes(&problem, segments, &separated);
        Self::on_nodes(problem, tuning, segments, &separated, nodes)
    }

    /// Returns whether the nodes and springs of this mesh, at a time (s), can serve for another
    /// cable, with the same supports and loads at the same places of it.
    pub(in crate::model::mass_spring) fn is_divided_like(&self, other: &Self, time_s: f64) -> bool {
        let [p, q] = [&self.problem, &other.problem];
        // A longer cable is longer everywhere.
        let longer = q.length / p.length;
        let support = |s: &SupportPoint| {
            // A wheel that was moved is led there, if it has no motion of its own.
            let place = s.place_at(time_s).filter(|_| s.arc_length.is_none() && s.motion.is_some());
            let wheel = (s.wheel_radius, s.side, s.friction, s.departure, place);
            (s.kind, s.mass, wheel, s.holds_from(time_s))
        };
        let places = |p: &Problem, longer: f64| {
            let supports = p.supports.iter().map(|s| s.arc_length.map(|at| at * longer));
            supports.chain(p.loads.iter().map(|l| Some(l.arc_length * longer))).collect::<Vec<_>>()
        };
        let same_place = |(s, t): (&Option<f64>, &Option<f64>)| match (s, t) {
            (Some(s), Some(t)) => (s - t).abs() <= SAME_PLACE_FRACTION * q.length,
            _ => s == t,
        };
        let [before, after] = [places(p, longer), places(q, 1.0)];
        let same_count = before.len() == after.len();
        let same_nodes =
            (self.even_length * longer - other.even_length).abs() <= SAME_PLACE_FRACTION * other.even_length;
        (same_nodes || other.keeps_nodes(self.position.len()))
            && p.supports.iter().map(support).eq(q.supports.iter().map(support))
            && same_count
            && before.iter().zip(&after).all(same_place)
    }

    /// Becomes the mesh of a cable after an edit of it: as long unstretched as before, it begins to
    /// change that.
    pub(in crate::model::mass_spring) fn become_cable_of(&mut self, edited: &Self) {
        let material = |p: &Problem| {
            let loss = (p.cable.damping_ratio, p.cable.bending_damping_ratio);
            (p.linear_density, p.axial_stiffness, p.bending_stiffness, loss)
        };
        let other_material = material(&self.problem) != material(&edited.problem);
        let gets_stiff = self.problem.bending_stiffness == 0.0 && edited.problem.bending_stiffness > 0.0;
        self.change_length(edited.problem.clone());
        if gets_stiff {
            self.unstress_slack_springs();
        }
        self.tuning.clone_from(&edited.tuning);
        self.update_elements();
        if other_material {
            let nodes = self.position.len();
            [self.spring_memory, self.bend_memory] =
                memories(&self.problem, &self.tuning.mesh, self.even_length, self.bending_stiffness, nodes);
        }
        let change = BendingChange::between(self.bending_stiffness, self.problem.bending_stiffness);
        self.bending_change = Some(change).filter(|change| !change.is_over());
        self.set_bending_stiffness(change.stiffness());
    }

    /// Gives every slack spring the unstretched length that it has: from now on the springs push.
    fn unstress_slack_springs(&mut self) {
        for e in 0..self.rest_length.len() {
            let length = larger(self.element(e).length, MIN_UNSTRESSED_FRACTION * self.rest_length[e]);
            if length < self.rest_length[e] {
                self.excess[e] = length / (self.material_length[e] * self.thermal_stretch) - 1.0;
            }
        }
    }

    fn change_length(&mut self, problem: Arc<Problem>) {
        let longer = problem.length / self.problem.length;
        if longer != 1.0 {
            let pulleys = self.wheels.pulleys.iter_mut().map(|p| &mut p.anchor);
            self.arc_length.iter_mut().chain(pulleys).for_each(|s| *s *= longer);
            self.even_length *= longer;
            self.thermal_stretch /= longer;
        }
        self.problem = problem;
        if self.thermal_stretch != self.problem.thermal_stretch {
            let now = LengthChange::from(self.thermal_stretch * self.problem.length);
            self.length_change = Some(self.length_change.unwrap_or(now));
        }
    }

    /// Changes the unstretched length and the bending stiffness for `dt_s` towards those of the
    /// scene.
    pub(in crate::model::mass_spring) fn follow_edit(&mut self, dt_s: f64) {
        if let Some(change) = &mut self.length_change {
            let stretch = change.follow(&self.problem, dt_s);
            self.set_thermal_stretch(stretch);
        }
        self.change_bending(|bending| bending.follow(dt_s));
        let sizes = self.excess.iter().zip(&self.material_length).map(|(excess, length)| excess.abs() * length);
        let whole_m: f64 = sizes.sum();
        if whole_m > 0.0 {
            self.fade_excess(excess_left(whole_m, dt_s));
        }
    }

    /// Changes the unstretched length and the bending stiffness by a fraction of what they differ
    /// from those of the scene.
    pub(in crate::model::mass_spring) fn approach_edit(&mut self, part: f64) {
        if self.length_change.is_some() {
            let [now, to] = [self.thermal_stretch, self.problem.thermal_stretch];
            self.set_thermal_stretch(if part < 1.0 { now + (to - now) * part } else { to });
        }
        self.change_bending(|bending| bending.approach(part));
        if self.has_excess() {
            self.fade_excess(1.0 - part);
        }
    }

    /// True if the unstretched length of an element is not that of its material.
    pub(in crate::model::mass_spring) fn has_excess(&self) -> bool {
        self.excess.iter().any(|excess| *excess != 0.0)
    }

    /// Keeps a part of what unstretched lengths differ from those of the material.
    fn fade_excess(&mut self, part: f64) {
        for excess in &mut self.excess {
            *excess = if excess.abs() > LEAST_EXCESS { *excess * part } else { 0.0 };
        }
        for e in 0..self.rest_length.len() {
            self.renew_rest_length(e);
        }
    }

    /// Takes the unstretched length of element `e` from its material.
    fn renew_rest_length(&mut self, e: usize) {
        self.rest_length[e] = self.material_length[e] * self.thermal_stretch * (1.0 + self.excess[e]);
    }

    /// Changes the bending stiffness, if it changes.
    fn change_bending(&mut self, change: impl FnOnce(&mut BendingChange)) {
        if let Some(bending) = &mut self.bending_change {
            change(bending);
            let stiffness = bending.stiffness();
            self.bending_change = self.bending_change.filter(|bending| !bending.is_over());
            self.set_bending_stiffness(stiffness);
        }
    }

    fn set_bending_stiffness(&mut self, stiffness: f64) {
        self.bending_stiffness = stiffness;
        self.bend_memory.set_stiffness(stiffness);
        self.spring_memory.let_push(stiffness > 0.0);
    }

    fn set_thermal_stretch(&mut self, stretch: f64) {
        let part = stretch / self.thermal_stretch;
        self.rest_length.iter_mut().for_each(|length| *length *= part);
        self.thermal_stretch = stretch;
        if stretch == self.problem.thermal_stretch {
            self.length_change = None;
        }
    }

    /// Puts nodes at given arc lengths (m).
    pub(in crate::model::mass_spring) fn with_nodes(
        problem: Arc<Problem>,
        tuning: Arc<Tuning>,
        segments: usize,
        support_arc_lengths: &[f64],
        nodes: Vec<f64>,
    ) -> Self {
        let separated = separate_supports(&problem, &tuning.mesh, support_arc_lengths, segments);
        Self::on_nodes(problem, tuning, segments, &separated, nodes)
    }

    fn on_nodes(
        problem: Arc<Problem>,
        tuning: Arc<Tuning>,
        segments: usize,
        separated: &[f64],
        arc_length: Vec<f64>,
    ) -> Self {
        let material_length: Vec<f64> = arc_length.windows(2).map(|w| w[1] - w[0]).collect();
        let rest_length: Vec<f64> = material_length.iter().map(|d| d * problem.thermal_stretch).collect();
        let (count, elements) = (arc_length.len(), material_length.len());
        let mut mass = vec![0.0; count];
        for (e, d) in material_length.iter().enumerate() {
            mass[e] += 0.5 * d * problem.linear_density;
            mass[e + 1] += 0.5 * d * problem.linear_density;
        }
        let nearest = |at: f64| {
            let k = arc_length.partition_point(|&v| v < at).min(count - 1);
            if k > 0 && at - arc_length[k - 1] < arc_length[k] - at { k - 1 } else { k }
        };
        let support_node: Vec<usize> = separated.iter().map(|&s| nearest(s)).collect();
        let mut point_mass = vec![0.0; count];
        for (p, &k) in problem.supports.iter().zip(&support_node) {
            mass[k] += p.mass;
            point_mass[k] += p.mass;
        }
        let mut pulleys = Pulley::all(&problem);
        for p in &mut pulleys {
            let node = support_node[p.support];
            p.place_on(node, arc_length[node]);
        }
        let [spring_memory, bend_memory] =
            memories(&problem, &tuning.mesh, problem.length / segments as f64, problem.bending_stiffness, count);
        Self {
            position: first_shape(&problem, &arc_length, &support_node),
            velocity: vec![Vec2::zeros(); count],
            force: vec![Vec2::zeros(); count],
            mass,
            point_mass,
            thermal_stretch: problem.thermal_stretch,
            length_change: None,
            bending_stiffness: problem.bending_stiffness,
            bending_change: None,
            supported: vec![false; count],
            support_acceleration: vec![Vec2::zeros(); count],
            straight_length: material_length.clone(),
            tension: vec![0.0; elements],
            even_length: problem.length / segments as f64,
            load_node: problem.loads.iter().map(|l| nearest(l.arc_length)).collect(),
            spring_memory,
            bend_memory,
            wheels: Wheels::new(pulleys, count),
            problem,
            tuning,
            arc_length,
            rest_length,
            excess: vec![0.0; elements],
            material_length,
            support_node,
        }
    }

    /// The nodes of a shape, if they will do: resampled, its elements would cut the corners that
    /// they lie round.
    pub(in crate::model::mass_spring) fn usable_nodes(&self, shape: &State) -> Option<Vec<f64>> {
        let s = &shape.arc_length_m;
        let fits = |wanted: f64| s.iter().any(|v| (v - wanted).abs() <= SAME_PLACE_FRACTION * self.problem.length);
        let supports = self.problem.supports.iter().filter_map(|p| p.arc_length);
        let marks = supports.chain(self.problem.loads.iter().map(|l| l.arc_length)).chain([0.0, self.problem.length]);
        let apart = s.windows(2).all(|w| w[1] - w[0] >= self.tuning.mesh.min_spacing_lengths * self.even_length);
        (self.keeps_nodes(s.len()) && apart && marks.into_iter().all(fits)).then(|| s.clone())
    }

    /// True if a cable that can lie on something keeps its nodes, which are so many: on others it
    /// would be laid anew.
    fn keeps_nodes(&self, count: usize) -> bool {
        let wanted = self.problem.length / self.even_length;
        let many = (0.5 * wanted..=2.0 * wanted).contains(&(count as f64 - 1.0));
        many && self.wheels.pulleys.is_empty() && !self.problem.world.is_empty()
    }

    /// Geometry of element `e` now.
    pub(in crate::model::mass_spring) fn element(&self, e: usize) -> ElementGeometry {
        self.wheels.element(e, &self.position)
    }

    /// Half of the straight parts beside a node, m of arc length.
    pub(in crate::model::mass_spring) fn half_straight_length(&self, n: usize) -> f64 {
        let before = if n > 0 { self.straight_length[n - 1] } else { 0.0 };
        0.5 * (before + self.straight_length.get(n).copied().unwrap_or(0.0))
    }

    /// Element and fraction of a material point.
    pub(in crate::model::mass_spring) fn locate(&self, s: f64) -> (usize, f64) {
        let e = self.arc_length.partition_point(|&v| v <= s).clamp(1, self.arc_length.len() - 1) - 1;
        let fraction = (s - self.arc_length[e]) / self.material_length[e];
        (e, if fraction > 1.0 { 1.0 } else { fraction })
    }

    /// True if the cable can touch an obstacle or the floor of a plan view.
    pub(in crate::model::mass_spring) fn can_touch(&self) -> bool {
        !self.problem.world.is_empty() || self.problem.floor_friction.is_some()
    }

    /// The error of a state that is no longer finite, if it is not.
    pub(in crate::model::mass_spring) fn non_finite(&self, time_s: f64) -> Option<SolveError> {
        let is_bad = |&i: &usize| !(self.position[i] + self.velocity[i]).iter().all(|c| c.is_finite());
        let bad = (0..self.position.len()).find(is_bad)?;
        let arc_length_m = self.arc_length[bad];
        Some(SolveError::NonFinite { quantity: "position or velocity", arc_length_m, time_s })
    }

    /// Momentum of all nodes, kg m/s.
    pub(in crate::model::mass_spring) fn momentum(&self) -> Vec2 {
        self.velocity.iter().zip(&self.mass).map(|(v, m)| v * *m).sum()
    }

    /// Takes lengths and masses from the arc lengths of the nodes.
    pub(in crate::model::mass_spring) fn update_elements(&mut self) {
        for e in 0..self.material_length.len() {
            self.material_length[e] = self.arc_length[e + 1] - self.arc_length[e];
            self.renew_rest_length(e);
            self.straight_length[e] = self.material_length[e];
        }
        let density = self.problem.linear_density;
        for n in 0..self.position.len() {
            self.mass[n] = density * self.half_straight_length(n) + self.point_mass[n];
        }
        self.update_pulley_elements();
    }

    /// The same of the elements beside pulleys, after material slid or the wheels moved.
    pub(in crate::model::mass_spring) fn update_pulley_elements(&mut self) {
        for k in 0..self.wheels.pulleys.len() {
            let i = self.wheels.pulleys[k].node;
            for e in [i - 1, i] {
                self.material_length[e] = self.arc_length[e + 1] - self.arc_length[e];
                self.renew_rest_length(e);
            }
        }
        for k in 0..self.wheels.pulleys.len() {
            let i = self.wheels.pulleys[k].node;
            for e in [i - 1, i] {
                let r = self.element(e);
                // The arcs on wheels count as unstretched: σ then moves the straight part alone.
                self.straight_length[e] = self.material_length[e] - (r.arc[0] + r.arc[1]) / self.thermal_stretch;
            }
        }
        let density = self.problem.linear_density;
        for k in 0..self.wheels.pulleys.len() {
            let i = self.wheels.pulleys[k].node;
            for n in [i - 1, i, i + 1] {
                self.mass[n] = density * self.half_straight_length(n) + self.point_mass[n];
            }
            let whole = self.material_length[i - 1] + self.material_length[i];
            let on_wheel = whole - self.straight_length[i - 1] - self.straight_length[i];
            self.mass[i] += density * on_wheel;
            self.wheels.pulleys[k].mass = density * (self.half_straight_length(i) + on_wheel);
        }
    }
}
