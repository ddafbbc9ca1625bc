//! The layout holds the sections into which supports and loads divide a cable, the side on which it
//! passes each wheel, and the boundaries.

use crate::catenary::PointForce;
use crate::contact::swept_corners::{self, ImpassableCorner};
use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::Vec2;
use crate::model::Model;
use crate::model::auxiliary_weight::auxiliary_weight;
use crate::model::spans::boundary::{CableLaw, Curve, SUPPORT_CONTACT_DISTANCE_M};
use crate::model::spans::section::{BoundaryConditions, CableSection, EndCondition, Failure, SolveContext};
use crate::model::spans::settings::SpansSettings;
use crate::problem::wheel_passage::facing;
use crate::problem::{Departure, Problem, SupportPoint};
use crate::scene::SupportKind;
use std::sync::Arc;

/// A dead load: its arc length and its index.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SectionLoad {
    arc_length: f64,
    /// Index among the supports, else among the loads.
    support: Option<usize>,
    load: usize,
}

/// A pulley between the ends of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct SectionPulley {
    pub support: usize,
    /// Index of its boundary with sense +1.
    pub curve: usize,
    /// Sense in which the cable must pass it; 0 for a point, which it may pass in either.
    pub facing: f64,
}

/// Supports and loads of the cable that do not change with time.
#[derive(Clone, Debug)]
pub(in crate::model::spans) struct SectionLayout {
    pub problem: Arc<Problem>,
    pub settings: Arc<SpansSettings>,
    /// The end of the scene's cable from which arc lengths are counted.
    pub counted_from: CableEnd,
    loads: Vec<SectionLoad>,
    /// Corners that it must not pass, in order of x.
    pub corners: Arc<[ImpassableCorner]>,
    /// Sections: arc lengths of both ends (m) and the support at each end; None for a free end or a
    /// dead load.
    pub sections: Vec<SectionBounds>,
}

/// The bounds of a section.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::model::spans) struct SectionBounds {
    pub material: [f64; 2],
    pub supports: [Option<usize>; 2],
    pub pulleys: Vec<SectionPulley>,
}

/// The error for a feature that the model lacks.
pub(in crate::model::spans) fn unsupported(feature: Unsupported) -> SolveError {
    SolveError::Unsupported { model: Model::Spans, feature }
}

/// An end of a cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum CableEnd {
    Start,
    End,
}

impl CableEnd {
    pub fn other(self) -> Self {
        match self {
            Self::Start => Self::End,
            Self::End => Self::Start,
        }
    }
}

/// An error for a cable with a feature that the model lacks.
fn refuse_unsupported(p: &Problem) -> Result<(), SolveError> {
    if p.bending_stiffness > 0.0 {
        return Err(unsupported(Unsupported::BendingStiffness));
    }
    if p.floor_friction.is_some() {
        return Err(unsupported(Unsupported::PlanView));
    }
    if p.cable.self_contact {
        return Err(unsupported(Unsupported::SelfContact));
    }
    if p.supports.iter().any(|s| s.release.is_some() && s.departure != Departure::Done) {
        return Err(unsupported(Unsupported::Release));
    }
    Ok(())
}

/// The loads along a cable, in order.
fn dead_loads(p: &Problem) -> Vec<SectionLoad> {
    let own = p.loads.iter().enumerate();
    let mut loads: Vec<SectionLoad> =
        own.map(|(load, l)| SectionLoad { arc_length: l.arc_length, support: None, load }).collect();
    for (k, s) in p.supports.iter().enumerate() {
        if matches!(s.kind, SupportKind::Load | SupportKind::Free) {
            loads.push(SectionLoad { arc_length: s.arc_length.unwrap_or(0.0), support: Some(k), load: k });
        }
    }
    loads.sort_by(|a, b| a.arc_length.total_cmp(&b.arc_length));
    loads
}

/// The sections into which its supports divide a cable.
fn sections_of(p: &Problem) -> Result<Vec<SectionBounds>, SolveError> {
    let mut sections: Vec<SectionBounds> = Vec::new();
    let mut part = SectionBounds { material: [0.0, p.length], supports: [None, None], pulleys: Vec::new() };
    let mut next_wheel = 2 * p.world.geometry().bodies().len();
    for (k, s) in p.supports.iter().enumerate() {
        match s.kind {
            SupportKind::Load | SupportKind::Free => {}
            SupportKind::Pulley if s.departure == Departure::Done => {}
            SupportKind::Pulley => {
                part.pulleys.push(SectionPulley { support: k, curve: next_wheel, facing: 0.0 });
                next_wheel += 2;
            }
            SupportKind::Fixed | SupportKind::Clamped | SupportKind::Robot => {
                let Some(arc_length) = s.arc_length else {
                    return Err(unsupported(Unsupported::SupportWithoutPlace));
                };
                if arc_length > part.material[0] {
                    part.material[1] = arc_length;
                    part.supports[1] = Some(k);
                    sections.push(part);
                }
                part =
                    SectionBounds { material: [arc_length, p.length], supports: [Some(k), None], pulleys: Vec::new() };
            }
        }
    }
    if part.material[1] > part.material[0] {
        sections.push(part);
    }
    Ok(sections)
}

impl SectionLayout {
    /// True if its problem is that of the scene reversed.
    pub fn is_reversed(&self) -> bool {
        self.counted_from == CableEnd::End
    }

    /// The layout of a cable.
    ///
    /// # Errors
    /// `Unsupported` for what the model lacks.
    pub fn new(
        problem: &Arc<Problem>,
        counted_from: CableEnd,
        settings: Arc<SpansSettings>,
    ) -> Result<Self, SolveError> {
        refuse_unsupported(problem)?;
        let sections = sections_of(problem)?;
        if problem.supports.iter().all(|s| s.at.is_none()) && problem.world.is_empty() {
            return Err(SolveError::NoRestingPlace { why: NoEquilibrium::NothingHolds });
        }
        let loads = dead_loads(problem);
        let corners = swept_corners::corners(&problem.world).into();
        let mut layout = Self { problem: problem.clone(), settings, counted_from, loads, corners, sections };
        layout.face_wheels();
        Ok(layout)
    }

    /// Sets the side on which the cable passes each wheel, from the direction in which the scene
    /// counts arc length.
    fn face_wheels(&mut self) {
        let (p, reversed) = (&self.problem, self.counted_from == CableEnd::End);
        let supports_in_place: Vec<usize> = (0..p.supports.len()).filter(|&k| p.supports[k].at.is_some()).collect();
        let at = |k: usize| p.supports[k].at.unwrap_or_default();
        for pulley in self.sections.iter_mut().flat_map(|s| &mut s.pulleys) {
            let s = &p.supports[pulley.support];
            if s.wheel_radius == 0.0 {
                continue;
            }
            let i = supports_in_place.iter().position(|&k| k == pulley.support).unwrap_or(0);
            let before = i.checked_sub(1).and_then(|j| supports_in_place.get(j)).map_or(at(pulley.support), |&k| at(k));
            let after = supports_in_place.get(i + 1).map_or(at(pulley.support), |&k| at(k));
            let travel = if reversed { before - after } else { after - before };
            pulley.facing = facing(s.side, travel) * if reversed { -1.0 } else { 1.0 };
        }
    }

    /// Every boundary: both senses of each body, then both of each pulley.
    pub fn curves(&self) -> Vec<Curve> {
        let p = &self.problem;
        let mut out: Vec<Curve> = p.world.geometry().bodies().iter().flat_map(Curve::both).collect();
        let holds = |s: &&SupportPoint| s.kind == SupportKind::Pulley && s.departure != Departure::Done;
        for s in p.supports.iter().filter(holds) {
            for sense in [1.0, -1.0] {
                out.push(Curve::wheel(s.wheel_radius, s.friction, sense));
            }
        }
        out
    }

    /// Sets the boundary conditions at a time, with dragged supports at their hand-set positions.
    pub fn instant(&self, dragged: &[Option<Vec2>], time_s: f64, out: &mut BoundaryConditions) {
        let p = &self.problem;
        let gravity = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        let place = |(k, s): (usize, &SupportPoint)| {
            let own = s.position_at(time_s).map_or(Vec2::zeros(), |(at, _)| at);
            dragged.get(k).copied().flatten().unwrap_or(own)
        };
        let force = |l: &SectionLoad| match l.support.and_then(|k| p.supports.get(k)) {
            Some(s) => s.force.at(time_s) + gravity * s.mass,
            None => p.loads.get(l.load).map_or(Vec2::zeros(), |l| l.force.at(time_s)),
        };
        out.places.clear();
        out.places.extend(p.supports.iter().enumerate().map(place));
        out.forces.clear();
        out.forces.extend(self.loads.iter().map(force));
        (out.load, out.hint) = (p.body_force(time_s), 0.0);
        if out.load.norm() == 0.0 {
            (out.load, out.hint) = auxiliary_weight(p, out.forces.iter().map(|f| f.norm()).sum());
        }
        (out.thermal, out.friction) = (p.thermal_stretch, 1.0);
    }

    /// The context at an instant; the boundaries are those of `self.curves()`.
    pub fn context(&self, curves: Vec<Curve>, instant: &BoundaryConditions) -> SolveContext {
        let loads = self.loads.iter().map(|l| PointForce { arc_length: l.arc_length, force: Vec2::zeros() });
        let law = CableLaw::new(instant.load, instant.thermal, self.problem.axial_stiffness);
        let mut context = SolveContext {
            curves,
            law,
            drag: 0.0,
            mobilised: self.problem.cable.friction_mobilised.direction(),
            loose_where_tension_ends: false,
            loads: loads.collect(),
            settings: self.settings.clone(),
        };
        self.set_context(&mut context, instant);
        context
    }

    /// Sets loads, friction and places of a context to those of an instant.
    pub fn set_context(&self, context: &mut SolveContext, instant: &BoundaryConditions) {
        context.law.load = instant.load;
        context.law.thermal = instant.thermal;
        for (l, force) in context.loads.iter_mut().zip(&instant.forces) {
            l.force = *force;
        }
        for pulley in self.sections.iter().flat_map(|s| &s.pulleys) {
            for curve in context.curves.iter_mut().skip(pulley.curve).take(2) {
                curve.shift = instant.places[pulley.support];
            }
        }
        let bodies = self.problem.world.geometry().bodies();
        for (k, curve) in context.curves.iter_mut().enumerate() {
            if let Some(body) = bodies.get(k / 2) {
                curve.friction = body.friction * instant.friction;
            }
        }
        for pulley in self.sections.iter().flat_map(|s| &s.pulleys) {
            for curve in context.curves.iter_mut().skip(pulley.curve).take(2) {
                curve.friction = self.problem.supports[pulley.support].friction * instant.friction;
            }
        }
    }

    /// Dead force on an end of the cable, N.
    pub fn end_force(&self, instant: &BoundaryConditions, at: f64) -> Vec2 {
        let here = self.loads.iter().zip(&instant.forces).filter(|(l, _)| l.arc_length == at);
        here.fold(Vec2::zeros(), |sum, (_, f)| sum + f)
    }
}

/// Moves the ends of a section to their positions at an instant.
///
/// # Errors
/// An error if a support is inside an obstacle.
pub(in crate::model::spans) fn place_ends(
    layout: &SectionLayout,
    index: usize,
    section: &mut CableSection,
    context: &SolveContext,
    instant: &BoundaryConditions,
) -> Result<(), Failure> {
    let part = &layout.sections[index];
    for side in 0..2 {
        let Some(support) = part.supports[side] else {
            if let EndCondition::Hangs(force) | EndCondition::Loose(force) = &mut section.end_conditions[side] {
                *force = layout.end_force(instant, part.material[side]);
            }
            continue;
        };
        let at = instant.places[support];
        let world = &layout.problem.world;
        let gap = world.signed_gap(at, layout.problem.radius).map(|g| g.gap_m);
        if gap.is_some_and(|g| g < -SUPPORT_CONTACT_DISTANCE_M) {
            return Err(Failure::SupportInside { at });
        }
        crate::model::spans::contact::place(section, context, side, at);
    }
    Ok(())
}
