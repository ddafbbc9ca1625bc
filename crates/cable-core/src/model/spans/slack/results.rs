//! This module reports a slack section of cable: its nodes, and the contacts that carry it.

use crate::math::Vec2;
use crate::model::arc_nodes;
use crate::model::catenary::results::{Nodes, ShapePoint};
use crate::model::spans::boundary::{BoundaryPoint, Heap, LooseSection, LyingStretch, SlackForm, SlackPart};
use crate::model::spans::section::SolveContext;
use crate::model::spans::slack::upper_surfaces::NONE_M;
use crate::solution::{ContactReport, ContactSample, ContactState};

/// Shortest contact that is reported, in lengths that are none. Smaller: contacts of round-off are
/// reported; larger: those in one point are lost.
const LEAST_CONTACT_NONES: f64 = 1e-3;

/// Number of nodes of a plumb leg and of a straight stretch.
const NODES: usize = 8;

/// Forces of one obstacle on a continuous run of lying cable.
#[derive(Default)]
struct LooseRun {
    /// Index of the boundary.
    curve: usize,
    samples: Vec<ContactSample>,
    /// Middle of each piece: its arc length (m) and position (m).
    middles: Vec<(f64, Vec2)>,
    /// Sum of the normal forces, N.
    normal_force: f64,
    /// Sum of the normal forces as vectors, N.
    push: Vec2,
    /// Sum of the forces along the boundary, N.
    tangential_force: f64,
    /// Turn of the cable on arcs, rad.
    turn: f64,
    /// Arc length of both ends, m.
    ends: [f64; 2],
    /// Tension at both ends, N.
    tension: [f64; 2],
}

/// A point of lying cable.
struct LyingPoint {
    place: BoundaryPoint,
    /// Arc length, m.
    arc_length: f64,
    /// Tension, N.
    tension: f64,
}

impl LooseSection {
    /// Adds its nodes and returns its contact reports, each with the index of the obstacle.
    pub fn report(
        &self,
        context: &SolveContext,
        nodes: &mut Nodes<'_>,
        cable_radius: f64,
    ) -> Vec<(usize, ContactReport)> {
        let mut runs: Vec<LooseRun> = Vec::new();
        let mut goes_on = false;
        for part in &self.parts {
            match &part.form {
                SlackForm::Hangs(ends) => add_plumb_leg(context, part, *ends, nodes),
                SlackForm::Spans { from, force } => {
                    let chain = context.chain(part.arc_lengths[0], part.arc_lengths[1]);
                    chain.spans(*force, *from).for_each(|(s, at, shape)| nodes.catenary(s, at, &shape));
                }
                SlackForm::Lies(s) => {
                    if !goes_on || runs.last().is_none_or(|r| r.curve / 2 != s.curve / 2) {
                        runs.push(LooseRun::new(s.curve, part));
                    }
                    if let Some(run) = runs.last_mut() {
                        run.add_stretch(context, part, s, nodes, cable_radius);
                    }
                }
                SlackForm::Heap(heap) => {
                    for s in part.arc_lengths {
                        nodes.push(ShapePoint { arc_length: s, at: heap.at, force: Vec2::zeros(), curvature: 0.0 });
                    }
                    runs.extend(LooseRun::of_heap(part, heap));
                }
            }
            goes_on = matches!(part.form, SlackForm::Lies(_));
        }
        runs.into_iter().filter_map(|run| run.report(context)).collect()
    }
}

/// Adds the nodes of cable that hangs plumb between two points (m), stretched by its own weight.
fn add_plumb_leg(context: &SolveContext, part: &SlackPart, [from, to]: [Vec2; 2], nodes: &mut Nodes<'_>) {
    let (law, whole) = (&context.law, part.arc_lengths[1] - part.arc_lengths[0]);
    let weight = law.load.norm();
    let along = (to - from).normalize();
    // Material u is counted from the foot up: h = λ (s + b s²/2EA).
    let falls = part.tension[0] > 0.0;
    for k in 0..=NODES {
        let s = whole * k as f64 / NODES as f64;
        let below = if falls { whole - s } else { s };
        let risen = law.thermal * below * (1.0 + 0.5 * weight * below / law.stiffness);
        let at = if falls { to - along * risen } else { from + along * risen };
        nodes.push(ShapePoint {
            arc_length: part.arc_lengths[0] + s,
            at,
            force: along * (weight * below),
            curvature: 0.0,
        });
    }
}

impl SlackPart {
    /// Force in the cable at an end of it, N.
    pub(super) fn force(&self, context: &SolveContext, end: usize) -> Vec2 {
        match &self.form {
            SlackForm::Hangs([from, to]) => (to - from).normalize() * self.tension[end],
            SlackForm::Lies(s) => s.place(context, s.coordinates[end]).tangent * self.tension[end],
            SlackForm::Heap(_) => Vec2::zeros(),
            SlackForm::Spans { force, .. } => {
                force - context.law.load * if end == 0 { 0.0 } else { self.arc_lengths[1] - self.arc_lengths[0] }
            }
        }
    }

    /// The force of the obstacles that carry it, N.
    pub(super) fn obstacle_force(&self, context: &SolveContext) -> Vec2 {
        match &self.form {
            SlackForm::Hangs(_) | SlackForm::Spans { .. } => Vec2::zeros(),
            SlackForm::Lies(_) => {
                self.force(context, 0)
                    - self.force(context, 1)
                    - context.law.load * (self.arc_lengths[1] - self.arc_lengths[0])
            }
            SlackForm::Heap(heap) => {
                heap.edges.iter().flatten().map(crate::model::spans::boundary::BearingEdge::force).sum()
            }
        }
    }
}

impl SlackForm {
    /// The greatest coefficient of friction of the boundaries that carry it.
    pub(super) fn friction(&self, context: &SolveContext) -> f64 {
        match self {
            Self::Hangs(_) | Self::Spans { .. } => 0.0,
            Self::Lies(s) => s.friction(context),
            Self::Heap(heap) => {
                heap.edges.iter().flatten().map(|b| context.curves[b.curve].friction).fold(0.0, f64::max)
            }
        }
    }
}

impl LooseRun {
    fn new(curve: usize, part: &SlackPart) -> Self {
        Self { curve, ends: part.arc_lengths, tension: part.tension, ..Self::default() }
    }

    /// One run for each edge that carries a heap.
    fn of_heap<'a>(part: &'a SlackPart, heap: &'a Heap) -> impl Iterator<Item = Self> + 'a {
        heap.edges.iter().flatten().map(|b| {
            let middle = 0.5 * (part.arc_lengths[0] + part.arc_lengths[1]);
            Self {
                middles: vec![(middle, heap.at)],
                samples: vec![ContactSample::new(middle, b.force())],
                normal_force: b.press,
                push: b.normal,
                tangential_force: b.friction,
                ..Self::new(b.curve, part)
            }
        })
    }

    /// Adds a stretch that lies on the boundary of this run: its nodes, and the forces that carry
    /// it from node to node.
    fn add_stretch(
        &mut self,
        context: &SolveContext,
        part: &SlackPart,
        s: &LyingStretch,
        nodes: &mut Nodes<'_>,
        cable_radius: f64,
    ) {
        let law = &context.law;
        let [p0, p1] = s.coordinates;
        let start = s.place(context, p0);
        let turns = start.turn != 0.0;
        let count = match turns {
            true => arc_nodes::parts(start.stretch, p1 - p0, cable_radius),
            false => NODES,
        };
        (self.ends[1], self.tension[1]) = (part.arc_lengths[1], part.tension[1]);
        self.turn += start.turn * (p1 - p0);
        // If there is more material than length, it is folded evenly.
        let material = part.arc_lengths[1] - part.arc_lengths[0];
        let point = |k: usize| {
            let f = k as f64 / count as f64;
            let place = s.place(context, p0 + (p1 - p0) * f);
            if part.is_loose() {
                return LyingPoint { place, arc_length: part.arc_lengths[0] + material * f, tension: 0.0 };
            }
            let slide = s.slide(context, p0, p0 + (p1 - p0) * f, part.tension[0], s.mobilised);
            let (arc_length, tension) = match k {
                0 => (part.arc_lengths[0], part.tension[0]),
                k if k == count => (part.arc_lengths[1], part.tension[1]),
                _ => (part.arc_lengths[0] + slide.material, slide.tension),
            };
            LyingPoint { place, arc_length, tension }
        };
        let mut before = point(0);
        for k in 0..=count {
            let here = point(k);
            let LyingPoint { place, arc_length, tension } = &here;
            let curvature = if turns { place.turn * law.stretch(*tension) / place.stretch } else { 0.0 };
            nodes.push(ShapePoint {
                arc_length: *arc_length,
                at: place.at,
                force: place.tangent * *tension,
                curvature,
            });
            if k > 0 {
                let weight = law.load * (arc_length - before.arc_length);
                let force = before.place.tangent * before.tension - place.tangent * *tension - weight;
                let f = (k as f64 - 0.5) / count as f64;
                let middle = s.place(context, p0 + (p1 - p0) * f);
                let press = force.dot(&middle.normal);
                self.normal_force += press;
                self.push += middle.normal * press;
                self.tangential_force += force.dot(&middle.tangent);
                let middle_arc_length = 0.5 * (before.arc_length + arc_length);
                self.samples.push(ContactSample::new(middle_arc_length, force));
                self.middles.push((middle_arc_length, middle.at));
            }
            before = here;
        }
    }

    /// The report of the contact, with the index of the obstacle; None for a contact of round-off.
    fn report(self, context: &SolveContext) -> Option<(usize, ContactReport)> {
        let curve = &context.curves[self.curve];
        let middle = 0.5 * (self.ends[0] + self.ends[1]);
        let nearest = self.middles.iter().min_by(|a, b| (a.0 - middle).abs().total_cmp(&(b.0 - middle).abs()));
        let (_, at) = nearest.filter(|_| self.ends[1] - self.ends[0] > NONE_M * LEAST_CONTACT_NONES)?;
        let unit = self.push.try_normalize(0.0)?;
        let mut report = ContactReport {
            x_m: at.x,
            y_m: at.y,
            arc_length_m: middle,
            normal: [unit.x, unit.y],
            normal_n: self.normal_force,
            friction_n: self.tangential_force,
            state: if curve.friction > 0.0 { ContactState::Stick } else { ContactState::Slip },
            turn_deg: self.turn.to_degrees(),
            tension_before_n: self.tension[0],
            tension_after_n: self.tension[1],
            begins_m: self.ends[0],
            ends_m: self.ends[1],
            ..ContactReport::default()
        };
        report.set_samples(self.samples);
        Some((curve.obstacle?, report))
    }
}
