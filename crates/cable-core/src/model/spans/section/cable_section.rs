//! A cable section is a row of free spans and contacts between two end conditions.
//!
//! The unknowns of each span are the force G that the cable would carry at the section's start if
//! its law continued there, F(s) = G − b(s − s_a) − Σ P_k [s_k < s]; those of each contact are its
//! interval (p₁, p₂) of the boundary and the material (s₁, s₂) at both ends. Material slides
//! through points fixed in space, after S. Sueda, G. L. Jones, D. I. W. Levin and D. K. Pai,
//! "Large-scale dynamic simulation of highly constrained strands", ACM Transactions on Graphics 30
//! (2011) 39.

use std::sync::Arc;

use crate::catenary::{Catenary, Chain, PointForce};
use crate::math::Vec2;
use crate::model::spans::boundary::{
    CableLaw, ChainRange, ContactPath, Curve, Ends, LooseSection, Mode, StickZone, TensionProfile,
};
use crate::model::spans::section::boundary_conditions::BoundaryConditions;
use crate::model::spans::settings::SpansSettings;

/// All given quantities at an instant.
#[derive(Clone, Debug)]
pub(in crate::model::spans) struct SolveContext {
    /// Boundaries: both senses of each body, then both of each wheel.
    pub curves: Vec<Curve>,
    pub law: CableLaw,
    /// Drag against sliding in addition to friction, N per m of slip, while a cable that runs away
    /// is followed; else 0.
    pub drag: f64,
    /// Direction in which friction is fully mobilised at every contact: 1 against a cable drawn
    /// towards its end, −1 towards its start; 0 if friction follows the contact's memory.
    pub mobilised: f64,
    /// True if cable on a frictionless contact lies loose where it has no tension left, held by the
    /// friction of the ground.
    pub loose_where_tension_ends: bool,
    /// Dead loads inside the cable, in order, N.
    pub loads: Vec<PointForce>,
    pub settings: Arc<SpansSettings>,
}

/// Condition at an end of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum EndCondition {
    /// The end is held in the air at a point, m.
    Fixed(Vec2),
    /// The end hangs free, drawn by a dead force, N.
    Hangs(Vec2),
    /// The end is held at p on the boundary of the contact beside it.
    Lies(f64),
    /// The end lies on the contact beside it, held by friction alone, and drawn by a dead force, N.
    Loose(Vec2),
}

impl EndCondition {
    /// True if a free span begins here.
    pub fn has_span(&self) -> bool {
        matches!(self, Self::Fixed(_) | Self::Hangs(_))
    }
}

/// A contact.
#[derive(Debug, PartialEq)]
pub(in crate::model::spans) struct Contact {
    /// Index of the boundary.
    pub curve: usize,
    pub chain_range: ChainRange,
    pub ends: Ends,
    pub mode: Mode,
    /// The stick zone at its present tensions, if it was computed.
    pub stick_zone: Option<StickZone>,
    pub history: TensionProfile,
    /// Index of the pulley's support, if it is a wheel.
    pub wheel: Option<usize>,
    /// Number of changes of the mode in this solve.
    pub mode_changes: u32,
    /// Connection to the next contact.
    pub next: Connection,
    /// The point load that rests here, if there is one.
    pub load: Option<RestingLoad>,
    /// True if it is frictionless for now, because it was found while an equilibrium is sought.
    pub smooth: bool,
}

/// A point load that rests on an obstacle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model::spans) struct RestingLoad {
    /// The kink that it is in, if it is in one.
    pub kink: Option<Kink>,
}

/// The direction along the boundary of the kink that a load is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum Kink {
    Back,
    Ahead,
}

impl Kink {
    /// −1 or 1 along the boundary.
    pub fn sign(self) -> f64 {
        match self {
            Self::Back => -1.0,
            Self::Ahead => 1.0,
        }
    }

    /// The end of the contact at which the kink is.
    pub fn side(self) -> usize {
        match self {
            Self::Back => 0,
            Self::Ahead => 1,
        }
    }
}

/// Connection between a contact and the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::model::spans) enum Connection {
    /// A free span.
    #[default]
    Span,
    /// No span: both end in a kink without tension, see `slack_pocket`.
    Pocket,
    /// No span: one of the two is a load that rests on the chain of the other, see `point_load`.
    Joined,
}

impl Connection {
    /// Parts a joined connection, which leaves a span; returns whether it was joined.
    pub fn part(&mut self) -> bool {
        let joined = *self == Self::Joined;
        if joined {
            *self = Self::Span;
        }
        joined
    }

    /// Ends a pocket, which leaves a span.
    pub fn end_pocket(&mut self) {
        if *self == Self::Pocket {
            *self = Self::Span;
        }
    }
}

impl Contact {
    /// A contact with an obstacle, without a friction memory, and with a span beyond it.
    pub fn new(curve: usize, chain_range: ChainRange, ends: Ends, mode: Mode) -> Self {
        Self {
            curve,
            chain_range,
            ends,
            mode,
            stick_zone: None,
            history: TensionProfile::default(),
            wheel: None,
            mode_changes: 0,
            next: Connection::Span,
            load: None,
            smooth: false,
        }
    }

    /// True if a point load rests here.
    pub fn is_load(&self) -> bool {
        self.load.is_some()
    }

    /// The kink of its load.
    pub fn kink(&self) -> Option<Kink> {
        self.load.and_then(|load| load.kink)
    }
}

/// A section.
#[derive(Debug, Default, PartialEq)]
pub(in crate::model::spans) struct CableSection {
    /// Material at both ends, m.
    pub from: f64,
    pub to: f64,
    pub end_conditions: [EndCondition; 2],
    /// In order along the cable.
    pub contacts: Vec<Contact>,
    /// The force G of each span, N; one more than contacts.
    pub forces: Vec<Vec2>,
    /// The shape without tension, if the cable is loose; then it has neither contacts nor spans.
    pub loose: Option<LooseSection>,
}

/// All sections of a cable at an instant.
#[derive(Clone, Debug)]
pub(in crate::model::spans) struct CableEquilibrium {
    pub sections: Vec<CableSection>,
    pub context: SolveContext,
    pub instant: BoundaryConditions,
}

impl Default for EndCondition {
    fn default() -> Self {
        Self::Fixed(Vec2::zeros())
    }
}

// Clone is written by hand, so that `clone_from` reuses memory.
impl Clone for Contact {
    fn clone(&self) -> Self {
        Self { history: self.history.clone(), ..*self }
    }

    fn clone_from(&mut self, other: &Self) {
        let mut history = std::mem::take(&mut self.history);
        history.clone_from(&other.history);
        *self = Self { history, ..*other };
    }
}

impl Clone for CableSection {
    fn clone(&self) -> Self {
        let (contacts, forces) = (self.contacts.clone(), self.forces.clone());
        Self { contacts, forces, loose: self.loose.clone(), ..*self }
    }

    fn clone_from(&mut self, other: &Self) {
        (self.from, self.to, self.end_conditions) = (other.from, other.to, other.end_conditions);
        self.loose.clone_from(&other.loose);
        self.contacts.clone_from(&other.contacts);
        self.forces.clone_from(&other.forces);
    }
}

impl SolveContext {
    /// The chain a contact lies on.
    pub fn contact_path(&self, c: &Contact) -> ContactPath<'_> {
        let curve = &self.curves[c.curve];
        ContactPath {
            curve,
            chain_range: c.chain_range,
            law: self.law,
            friction: self.friction(c),
            drag: self.drag,
            floored: if c.smooth {
                self.loose_where_tension_ends
            } else {
                self.mobilised != 0.0 && curve.friction > 0.0
            },
            friction_of_loose: curve.friction,
            cached_piece: None,
        }
    }

    /// Friction of a contact.
    pub fn friction(&self, c: &Contact) -> f64 {
        if c.smooth { 0.0 } else { self.curves[c.curve].friction }
    }

    /// Tension that a dead force causes at a lying end, N.
    pub fn pull(&self, c: &Contact, side: usize, force: Vec2) -> f64 {
        let along = force.dot(&self.contact_path(c).place(c.ends.place[side]).tangent);
        if side == 0 { -along } else { along }
    }

    /// The span of cable between two material points.
    pub fn chain(&self, from: f64, to: f64) -> Chain<'_> {
        Chain {
            from,
            to,
            weight: self.law.load,
            axial_stiffness: self.law.stiffness,
            thermal_stretch: self.law.thermal,
            loads: &self.loads,
        }
    }

    /// Load at a material point, N.
    pub fn load_at(&self, s: f64) -> Vec2 {
        self.loads.iter().filter(|l| l.arc_length == s).fold(Vec2::zeros(), |sum, l| sum + l.force)
    }

    /// Load between two material points, N.
    pub fn load_between(&self, from: f64, to: f64) -> Vec2 {
        let inside = self.loads.iter().filter(|l| l.arc_length > from && l.arc_length < to);
        inside.fold(self.law.load * (to - from), |sum, l| sum + l.force)
    }

    /// d(position)/ds for a force in the cable.
    pub fn rate(&self, force: Vec2) -> Vec2 {
        force * (self.law.thermal * (1.0 / force.norm() + 1.0 / self.law.stiffness))
    }
}

impl CableSection {
    /// Solves span `k` anew after a change; if there is no solution, it stays.
    pub fn resolve_span(&mut self, context: &SolveContext, k: usize) {
        if let Some(g) = self.solve_span(context, k) {
            self.forces[k] = g;
        }
    }

    /// Calls back with each catenary of span k: its first material point, the position of that, and
    /// its shape.
    pub fn shapes(&self, context: &SolveContext, k: usize, mut each: impl FnMut(f64, Vec2, &Catenary)) {
        let (from, to) = self.material(k);
        let chain = context.chain(from, to);
        let start = self.force(context, k, from);
        let origin = match self.span_ends(context, k) {
            [Some(a), _] => a,
            [None, Some(b)] => b - chain.reach(start).0,
            [None, None] => return,
        };
        for (s0, at, shape) in chain.spans(start, origin) {
            each(s0, at, &shape);
        }
    }

    /// Number of spans, including those that are missing beside a lying end.
    pub fn spans(&self) -> usize {
        self.contacts.len() + 1
    }

    /// True if span k exists.
    pub fn has_span(&self, k: usize) -> bool {
        if self.loose.is_some() {
            return false;
        }
        let none = k.checked_sub(1).and_then(|j| self.contacts.get(j)).is_some_and(|c| c.next != Connection::Span);
        !none
            && (k > 0 || self.end_conditions[0].has_span())
            && (k < self.contacts.len() || self.end_conditions[1].has_span())
    }

    /// True if contact j ends in a pocket on a side.
    pub fn in_pocket(&self, j: usize, side: usize) -> bool {
        (j + side).checked_sub(1).and_then(|i| self.contacts.get(i)).is_some_and(|c| c.next == Connection::Pocket)
    }

    /// True if contact j is joined to its neighbour on a side.
    pub fn is_joined(&self, j: usize, side: usize) -> bool {
        (j + side).checked_sub(1).and_then(|i| self.contacts.get(i)).is_some_and(|c| c.next == Connection::Joined)
    }

    /// True if the material at a side of contact j belongs to a load.
    pub fn has_load_material(&self, j: usize, side: usize) -> bool {
        self.contacts[j].is_load() || self.is_joined(j, side)
    }

    /// True if contact j is joined to a load on a side that sticks.
    pub fn is_pinned(&self, j: usize, side: usize) -> bool {
        let beside = (j + 2 * side).checked_sub(1).and_then(|i| self.contacts.get(i));
        self.is_joined(j, side) && beside.is_some_and(|c| c.is_load() && c.mode == Mode::Stick)
    }

    /// Material at both ends of span k, m.
    pub fn material(&self, k: usize) -> (f64, f64) {
        let from = k.checked_sub(1).and_then(|j| self.contacts.get(j)).map_or(self.from, |c| c.ends.material[1]);
        let to = self.contacts.get(k).map_or(self.to, |c| c.ends.material[0]);
        (from, to)
    }

    /// Excess length of span k over its chord, and the chord, m; None if an end hangs.
    pub fn slack(&self, context: &SolveContext, k: usize) -> Option<[f64; 2]> {
        let [Some(a), Some(b)] = self.span_ends(context, k) else { return None };
        let (from, to) = self.material(k);
        let chord = (b - a).norm();
        Some([(to - from) * context.law.thermal - chord, chord])
    }

    /// Force in span k at a material point, N.
    pub fn force(&self, context: &SolveContext, k: usize, s: f64) -> Vec2 {
        self.forces.get(k).copied().unwrap_or_default() - context.load_between(self.from, s)
    }

    /// Start and end of span k, m; None for a hanging end.
    pub fn span_ends(&self, context: &SolveContext, k: usize) -> [Option<Vec2>; 2] {
        let tie = |t: &EndCondition| if let EndCondition::Fixed(at) = t { Some(*at) } else { None };
        let point = |c: &Contact, side: usize| Some(context.contact_path(c).place(c.ends.place[side]).at);
        [
            match k.checked_sub(1).and_then(|j| self.contacts.get(j)) {
                Some(c) => point(c, 1),
                None => tie(&self.end_conditions[0]),
            },
            match self.contacts.get(k) {
                Some(c) => point(c, 0),
                None => tie(&self.end_conditions[1]),
            },
        ]
    }

    /// The force G with which span k connects its start and its end.
    pub fn solve_span(&self, context: &SolveContext, k: usize) -> Option<Vec2> {
        let (from, to) = self.material(k);
        match self.span_ends(context, k) {
            [Some(a), Some(b)] => {
                let near = self.forces.get(k).map(|g| g - context.load_between(self.from, from));
                let chain = context.chain(from, to);
                let near = near.filter(|f| f.norm() > 0.0 && f.iter().all(|v| v.is_finite()));
                let found = chain.solve(b - a, near).or_else(|_| chain.solve(b - a, None)).ok()?;
                Some(found.start + context.load_between(self.from, from))
            }
            [None, _] => self.hanging(context, 0),
            [_, None] => self.hanging(context, 1),
        }
    }

    /// The force G of a hanging end.
    pub fn hanging(&self, context: &SolveContext, side: usize) -> Option<Vec2> {
        match self.end_conditions[side] {
            EndCondition::Hangs(force) if side == 0 => Some(-force),
            EndCondition::Hangs(force) => Some(force + context.load_between(self.from, self.to)),
            _ => None,
        }
    }

    /// Sets the end tensions of contacts to those of the spans beside them.
    pub fn update_end_tensions(&mut self, context: &SolveContext) {
        for j in 0..self.contacts.len() {
            for side in 0..2 {
                if let Some(force) = self.force_at_contact(context, j, side) {
                    self.contacts[j].ends.tension[side] = force.norm();
                } else if self.in_pocket(j, side) {
                    self.contacts[j].ends.tension[side] = 0.0;
                } else if self.is_joined(j, side) {
                    self.contacts[j].ends.tension[side] = self.forces[j + side].x;
                } else if self.contacts[j].is_load() {
                    // There is no cable beyond it.
                    let k = j + 1 - side;
                    let inner = self.force_at_contact(context, j, 1 - side);
                    self.contacts[j].ends.tension[side] = inner.map_or(self.forces[k].x, |f| f.norm());
                } else if let EndCondition::Loose(force) = self.end_conditions[side] {
                    self.contacts[j].ends.tension[side] = context.pull(&self.contacts[j], side, force);
                }
            }
        }
    }

    /// Force of the span beside contact j on a side of it; None beside a lying end.
    pub fn force_at_contact(&self, context: &SolveContext, j: usize, side: usize) -> Option<Vec2> {
        let k = j + side;
        let s = self.contacts.get(j)?.ends.material[side];
        self.has_span(k).then(|| self.force(context, k, s))
    }
}
