//! This library computes where a 2D cable goes, how hard it pulls and where it rubs.
//!
//! ```
//! use cable_core::{Model, Scene, Simulation};
//! # fn main() -> Result<(), cable_core::Error> {
//! # let text = cable_core::scene::catalog::hanging_span().to_toml();
//! let scene = Scene::from_toml(&text)?;
//! let answer = Simulation::new(scene, Model::Auto)?.settle()?;
//! println!("{:.1} N", answer.max_tension().tension_n);
//! # Ok(()) }
//! ```
//!
//! | quantity | unit |
//! |---|---|
//! | length, arc length (unstretched, at rest temperature) | m |
//! | force, tension, axial stiffness EA | N |
//! | linear density | kg/m |
//! | bending stiffness EI | N·m² |
//! | stress | Pa |
//! | angle in files | ° |
//! | time | s |
//!
//! Dependencies between the modules point one way, as a test checks; those of one step do not know
//! each other: `math, numerics, model_id, units → energy, verification_report
//! → error → catenary, scene, solution → contact, robot → problem,
//! state → answer_verifier, breakage, model, record → files, simulated_cable
//! → warnings, wording → any_error → simulation → analysis, summary, timeline`.

#![warn(missing_debug_implementations)]

pub mod analysis;
pub mod answer_verifier;
mod any_error;
mod breakage;
pub mod catenary;
pub mod contact;
mod energy;
pub mod error;
pub mod files;
pub mod math;
pub mod model;
mod model_id;
mod numerics;
pub mod problem;
pub mod record;
mod robot;
pub mod scene;
mod simulated_cable;
mod simulation;
pub mod solution;
pub mod state;
pub mod summary;
pub mod timeline;
pub mod units;
mod verification_report;
mod warnings;
pub mod wording;

pub use any_error::Error;
pub(crate) use cable_linalg as linalg;
pub use error::{SceneError, SolveError};
pub use files::FileError;
pub use math::Vec2;
pub use model::{Model, Settings};
pub use scene::{Cable, Load, Obstacle, Robot, Scene, Support};
pub use simulation::Simulation;
pub use solution::{ErrorEstimates, Solution, Warning};
pub use state::State;
pub use units::UnitSystem;

/// The code of the README runs as a test of the documents.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
