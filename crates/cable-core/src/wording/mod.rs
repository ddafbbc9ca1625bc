//! The sentences of warnings, errors and verdicts are made here from their data, in SI or US units.
//!
//! | room | sentences |
//! |---|---|
//! | `mod.rs` | [`Sentence`] |
//! | `figures.rs` | numbers with their units, in SI or US |
//! | `warning.rs` | warnings |
//! | `scene_error.rs` | why a scene is refused |
//! | `solve_error.rs` | why a model has no answer |
//! | `model_reason.rs` | why a model was taken |
//! | `inertia.rs` | how fast a motion is, and whether masses matter in it |
//! | `file_error.rs` | why a file is not read or written |
//! | `import.rs` | what an import changed, and why it is refused |
//! | `verification.rs` | verdicts of the laws of mechanics |
//!
//! `Display` writes the sentence in SI units. Names stand between backticks.

mod figures;
mod file_error;
mod import;
mod inertia;
mod model_reason;
mod scene_error;
mod solve_error;
mod verification;
mod warning;

use crate::units::UnitSystem;

/// Data that can be expressed as a sentence.
pub trait Sentence {
    /// The sentence in a system of units, without a full stop.
    fn sentence(&self, units: UnitSystem) -> String;
}

/// `Display` as the sentence in SI units.
macro_rules! display_in_si {
    ($($data:ty),+) => {$(
        impl std::fmt::Display for $data {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(&crate::wording::Sentence::sentence(self, crate::units::UnitSystem::Si))
            }
        }
    )+};
}
pub(crate) use display_in_si;

/// Serialises data as its sentence in SI units: files and JSON hold the words.
macro_rules! serialize_in_si {
    ($($data:ty),+) => {$(
        impl serde::Serialize for $data {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(&crate::wording::Sentence::sentence(self, crate::units::UnitSystem::Si))
            }
        }
    )+};
}
pub(crate) use serialize_in_si;
