//! The models have names: a user asks for one of them, answers and errors tell which one they
//! come from.
//!
//! The capabilities and the constructor of each stand in [`crate::model::registry`].

use serde::{Deserialize, Serialize};

/// The models a user can ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Model {
    /// The cheapest model that can answer.
    #[default]
    Auto,
    /// Elastic catenaries between supports: no contact, no motion, no discretisation error.
    Catenary,
    /// Exact catenaries between contacts that are intervals of a boundary: friction without a mesh,
    /// no motion.
    Spans,
    /// Corrected bar elements with contact, friction, bending, dynamics.
    Fem,
    /// Lumped masses and springs, explicit in time.
    MassSpring,
    /// A model that the program brings along; no file and no command line asks for it.
    External,
}

impl Model {
    /// Every model that solves by itself.
    pub const SOLVERS: [Self; 4] = [Self::Catenary, Self::Spans, Self::Fem, Self::MassSpring];

    /// The name used on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Catenary => "catenary",
            Self::Spans => "spans",
            Self::Fem => "fem",
            Self::MassSpring => "mass-spring",
            Self::External => "external",
        }
    }

    /// The model of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Auto].into_iter().chain(Self::SOLVERS).find(|m| m.name() == name)
    }
}

impl std::fmt::Display for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
