//! [`Error`] joins the errors of the operations that a program calls one after the other: reading a
//! scene, solving it, keeping files.

use thiserror::Error;

use crate::error::{SceneError, SolveError};
use crate::files::FileError;
use crate::units::UnitSystem;
use crate::wording::{Sentence, serialize_in_si};

/// Any error that a user of a simple program can get.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be read or is not a scene that can be solved.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The model has no answer.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

serialize_in_si!(Error);

impl Sentence for Error {
    fn sentence(&self, units: UnitSystem) -> String {
        match self {
            Self::Scene(e) => e.sentence(units),
            Self::Solve(e) => e.sentence(units),
            Self::File(e) => e.sentence(units),
        }
    }
}
