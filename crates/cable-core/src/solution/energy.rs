//! The energy of a cable has four forms.

use serde::{Deserialize, Serialize};

/// Energy in its forms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Of motion, J.
    pub kinetic_j: f64,
    /// Of height above y = 0, J.
    pub gravity_j: f64,
    /// Of stretch, J.
    pub stretch_j: f64,
    /// Of bending, J.
    pub bending_j: f64,
}

impl Energy {
    /// All of it, J.
    #[must_use]
    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.gravity_j + self.stretch_j + self.bending_j
    }
}

impl std::ops::Mul<f64> for Energy {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            kinetic_j: self.kinetic_j * factor,
            gravity_j: self.gravity_j * factor,
            stretch_j: self.stretch_j * factor,
            bending_j: self.bending_j * factor,
        }
    }
}

impl std::iter::Sum for Energy {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |s, e| Self {
            kinetic_j: s.kinetic_j + e.kinetic_j,
            gravity_j: s.gravity_j + e.gravity_j,
            stretch_j: s.stretch_j + e.stretch_j,
            bending_j: s.bending_j + e.bending_j,
        })
    }
}
