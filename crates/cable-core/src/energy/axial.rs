//! The tension of a straight bar is its stiffness times its strain.

/// A straight bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Unstretched length at the present temperature, m.
    pub rest_length: f64,
    /// EA, N.
    pub stiffness: f64,
}

impl Bar {
    /// Tension (N) at a length (m); negative in compression.
    #[must_use]
    pub fn tension(&self, length: f64) -> f64 {
        self.stiffness * (length / self.rest_length - 1.0)
    }
}
