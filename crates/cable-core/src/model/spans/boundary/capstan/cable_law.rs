//! The law of a cable on a boundary relates its tension to its stretch, to the load at a point, and
//! to the rates at which the tension changes there if it slides.
//!
//! [`capstan`](crate::model::spans::boundary::capstan) has the derivation and the symbols.

use crate::math::{Vec2, sin_cos};
use crate::model::spans::boundary::curve::BoundaryPoint;

/// Load and stiffness of a cable at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct CableLaw {
    /// Load per unstretched metre, N/m.
    pub load: Vec2,
    /// τ = 1 + αΔT.
    pub thermal: f64,
    /// EA, N.
    pub stiffness: f64,
    /// 1/EA, 1/N.
    pub compliance: f64,
}

/// The values of a boundary point that the law needs.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct LocalLoad {
    /// d(length)/dp, m.
    pub stretch: f64,
    /// True on an arc.
    pub turns: bool,
    /// b·t and b·n, N/m.
    pub load: [f64; 2],
}

/// Result of an integration along the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct SlideResult {
    /// Tension at its end, N.
    pub tension: f64,
    /// Unstretched material on it, m (negative for a backward path).
    pub material: f64,
    /// ∂tension/∂(tension at its start).
    pub by_tension: f64,
    /// ∂material/∂(tension at its start), m/N.
    pub material_by_tension: f64,
}

impl CableLaw {
    /// The law with a load per metre (N/m), τ and EA (N).
    pub fn new(load: Vec2, thermal: f64, stiffness: f64) -> Self {
        Self { load, thermal, stiffness, compliance: 1.0 / stiffness }
    }

    /// The stretch λ of a tension.
    pub fn stretch(&self, t: f64) -> f64 {
        self.thermal * (1.0 + t * self.compliance)
    }

    /// Θ = T + T²/2EA of a tension.
    pub fn theta(&self, t: f64) -> f64 {
        t + 0.5 * t * t * self.compliance
    }

    /// The tension for Θ; −EA (a length of zero) if there is none.
    pub fn tension(&self, theta: f64) -> f64 {
        let square = 1.0 + 2.0 * theta * self.compliance;
        2.0 * theta / (1.0 + if square > 0.0 { square.sqrt() } else { 0.0 })
    }

    /// The values of a place that the law needs.
    pub fn local_load(&self, place: &BoundaryPoint) -> LocalLoad {
        let load = [self.load.dot(&place.tangent), self.load.dot(&place.normal)];
        LocalLoad { stretch: place.stretch, turns: place.turn != 0.0, load }
    }

    /// dT/dp at a place where the cable slides with m.
    pub fn slope(&self, place: &BoundaryPoint, t: f64, m: f64) -> f64 {
        self.slope_at(&self.local_load(place), t, m)
    }

    /// As [`Self::slope`].
    pub fn slope_at(&self, local_load: &LocalLoad, t: f64, m: f64) -> f64 {
        let turned = if local_load.turns { m * t } else { 0.0 };
        turned - local_load.stretch * (local_load.load[0] + m * local_load.load[1]) / self.stretch(t)
    }

    /// dΘ/dp on an edge.
    pub fn edge_rate(&self, local_load: &LocalLoad, m: f64) -> f64 {
        -(local_load.load[0] + m * local_load.load[1]) / self.thermal
    }

    /// Normal force per unstretched metre times its stretch, per dp: N ds/dp, N (per metre of an
    /// edge, per radian of an arc).
    pub fn press(&self, place: &BoundaryPoint, t: f64) -> f64 {
        let turned = if place.turn == 0.0 { 0.0 } else { t };
        turned - self.load.dot(&place.normal) * place.stretch / self.stretch(t)
    }
}

impl LocalLoad {
    /// The same at a point that is moved by a distance along its piece.
    pub fn at_distance(self, way: f64) -> Self {
        if !self.turns || way == 0.0 {
            return self;
        }
        let ((sin, cos), [bt, bn]) = (sin_cos(way), self.load);
        Self { load: [bt * cos - bn * sin, bn * cos + bt * sin], ..self }
    }
}

impl SlideResult {
    /// This result followed by another that starts at its end.
    pub fn then(self, next: Self) -> Self {
        Self {
            tension: next.tension,
            material: self.material + next.material,
            by_tension: self.by_tension * next.by_tension,
            material_by_tension: self.material_by_tension + next.material_by_tension * self.by_tension,
        }
    }

    /// The result of a path of length zero with tension `t`.
    pub fn none(t: f64) -> Self {
        Self { tension: t, material: 0.0, by_tension: 1.0, material_by_tension: 0.0 }
    }
}
