//! This module holds the boundary conditions at an instant: positions of supports, loads,
//! temperature.

use crate::math::Vec2;

/// Supports, loads and temperature at an instant; two of them can be mixed.
#[derive(Debug, Default, PartialEq)]
pub(in crate::model::spans) struct BoundaryConditions {
    /// Position of each support, m (unused if it has none).
    pub places: Vec<Vec2>,
    /// Load per metre, N/m.
    pub load: Vec2,
    /// 1 + αΔT.
    pub thermal: f64,
    /// Dead loads of the layout, N.
    pub forces: Vec<Vec2>,
    /// Force (N) up to which forces come from the auxiliary weight of a weightless cable; 0 for a
    /// cable with weight.
    pub hint: f64,
    /// Fraction of the friction that acts: 1, or less while an equilibrium is sought.
    pub friction: f64,
}

impl Clone for BoundaryConditions {
    fn clone(&self) -> Self {
        Self { places: self.places.clone(), forces: self.forces.clone(), ..*self }
    }

    fn clone_from(&mut self, other: &Self) {
        self.places.clone_from(&other.places);
        self.forces.clone_from(&other.forces);
        (self.load, self.hint) = (other.load, other.hint);
        (self.thermal, self.friction) = (other.thermal, other.friction);
    }
}

impl BoundaryConditions {
    /// Interpolates between `from` and `to` at the fraction f.
    pub fn between(&mut self, from: &Self, to: &Self, f: f64) {
        self.clone_from(to);
        if f >= 1.0 {
            return;
        }
        let mix = |out: &mut [Vec2], from: &[Vec2]| {
            for (b, a) in out.iter_mut().zip(from) {
                *b = a + (*b - a) * f;
            }
        };
        mix(&mut self.places, &from.places);
        mix(&mut self.forces, &from.forces);
        self.load = from.load + (to.load - from.load) * f;
        self.thermal = from.thermal + (to.thermal - from.thermal) * f;
        self.friction = from.friction + (to.friction - from.friction) * f;
    }
}
