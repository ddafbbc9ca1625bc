//! A layout lists the supports and loads of the cable at an instant.

use crate::catenary::PointForce;
use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::{Vec2, perp};
use crate::model::Model;
use crate::model::auxiliary_weight::auxiliary_weight;
use crate::model::catenary::settings::CatenarySettings;
use crate::problem::wheel_passage::facing;
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;

/// A point where the cable is held or slides through.
#[derive(Clone, Debug)]
pub(super) struct SupportNode {
    /// Index of the support.
    pub support: usize,
    /// Position (of a wheel, its centre), m.
    pub at: Vec2,
    /// Material point held, m; None = slides.
    pub material_point: Option<f64>,
    /// Radius of the centre line round the wheel, m; 0 = a point.
    pub radius: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Wheel: outward normal = facing × (tangent turned +90°).
    pub facing: f64,
}

/// The cable's holds and loads at an instant.
#[derive(Clone, Debug)]
pub(super) struct SupportLayout {
    /// In order along the cable; at least one.
    pub anchors: Vec<SupportNode>,
    /// Dead loads in order, those at the very ends of a dangling cable included, N.
    pub loads: Vec<PointForce>,
    /// Load per metre of unstretched length, N/m.
    pub weight: Vec2,
    /// Force (N) up to which forces come from the auxiliary weight of a weightless cable; 0 for a
    /// cable with weight.
    pub hint: f64,
    /// True for an end (start, end) that is free.
    pub free: [bool; 2],
    /// Dead force on a dangling start and end, N.
    pub end_force: [Vec2; 2],
    pub settings: CatenarySettings,
}

/// Returns the present position of a support: where it is dragged, or else by its motion; None for
/// a free one.
fn place(s: &SupportPoint, dragged: Option<Vec2>, time_s: f64) -> Option<Vec2> {
    let p = s.position_at(time_s).map(|(p, _)| p)?;
    Some(dragged.unwrap_or(p))
}

impl SupportLayout {
    /// The layout at a time.
    ///
    /// # Errors
    /// `NoRestingPlace` when nothing holds the cable.
    pub fn new(p: &Problem, dragged: &[Option<Vec2>], time_s: f64) -> Result<Self, SolveError> {
        let gravity = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        let mut anchors = Vec::with_capacity(p.supports.len());
        let mut loads: Vec<PointForce> =
            p.loads.iter().map(|l| PointForce { arc_length: l.arc_length, force: l.force.at(time_s) }).collect();
        for (k, s) in p.supports.iter().enumerate() {
            let at = place(s, dragged.get(k).copied().flatten(), time_s);
            match (s.kind, at) {
                (SupportKind::Load | SupportKind::Free, _) => {
                    if let Some(arc_length) = s.arc_length {
                        loads.push(PointForce { arc_length, force: s.force.at(time_s) + gravity * s.mass });
                    }
                }
                (_, None) => {}
                (SupportKind::Pulley, Some(at)) => anchors.push(SupportNode {
                    support: k,
                    at,
                    material_point: None,
                    radius: s.wheel_radius,
                    friction: s.friction,
                    facing: 0.0,
                }),
                (_, Some(at)) => anchors.push(SupportNode {
                    support: k,
                    at,
                    material_point: s.arc_length,
                    radius: 0.0,
                    friction: 0.0,
                    facing: 0.0,
                }),
            }
        }
        loads.sort_by(|a, b| a.arc_length.total_cmp(&b.arc_length));
        let has_first_place = anchors.first().is_some_and(|a| a.material_point == Some(0.0));
        let has_last_place = anchors.last().is_some_and(|a| a.material_point == Some(p.length));
        let mut layout = Self {
            anchors,
            weight: p.body_force(time_s),
            hint: 0.0,
            free: [!has_first_place, !has_last_place],
            end_force: [0.0, p.length]
                .map(|end| loads.iter().filter(|l| l.arc_length == end).fold(Vec2::zeros(), |sum, l| sum + l.force)),
            loads,
            settings: CatenarySettings::default(),
        };
        if layout.anchors.is_empty() {
            return Err(SolveError::NoRestingPlace { why: NoEquilibrium::NothingHolds });
        }
        // Where a weightless cable is slack, any shape is at rest.
        if !(layout.weight.norm() > 0.0) {
            let loads = layout.loads.iter().map(|l| l.force.norm()).sum();
            (layout.weight, layout.hint) = auxiliary_weight(p, loads);
        }
        layout.face_wheels(p);
        Ok(layout)
    }

    /// Sets the side of its wheel on which the cable runs, seen along it.
    fn face_wheels(&mut self, p: &Problem) {
        let centres: Vec<Vec2> = self.anchors.iter().map(|a| a.at).collect();
        for (k, a) in self.anchors.iter_mut().enumerate() {
            let before = if k > 0 { centres[k - 1] } else { a.at };
            let after = centres.get(k + 1).copied().unwrap_or(a.at);
            a.facing = facing(p.supports[a.support].side, after - before);
        }
    }

    /// Loads that act at a held material point, where the support takes them, N.
    pub(crate) fn loads_at(&self, arc_length: f64) -> Vec2 {
        self.loads.iter().filter(|l| l.arc_length == arc_length).fold(Vec2::zeros(), |sum, l| sum + l.force)
    }

    /// Total load between two material points, N.
    pub(crate) fn load_between(&self, from: f64, to: f64) -> Vec2 {
        let inside = self.loads.iter().filter(|l| l.arc_length > from && l.arc_length < to);
        inside.fold(self.weight * (to - from), |sum, l| sum + l.force)
    }
}

/// Direction of an angle.
pub(super) fn direction(angle: f64) -> Vec2 {
    Vec2::new(angle.cos(), angle.sin())
}

/// The angle of a vector.
pub(super) fn angle_of(v: Vec2) -> f64 {
    v.y.atan2(v.x)
}

impl SupportNode {
    /// Returns the point (m) at which the centre line touches the wheel if its direction is `angle`
    /// (rad).
    pub fn touch(&self, angle: f64) -> Vec2 {
        self.at + perp(direction(angle)) * (self.facing * self.radius)
    }
}

/// The error for a feature that the model lacks.
pub(super) fn unsupported(feature: Unsupported) -> SolveError {
    SolveError::Unsupported { model: Model::Catenary, feature }
}
