//! 2D cable mechanics: where a cable goes, how hard it pulls, where it rubs.
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
//! Dependencies point one way: `math, error → scene → (catenary, energy, contact) → model → simulation → record`.

pub mod analysis;
mod breakage;
pub mod catenary;
pub mod contact;
pub mod energy;
pub mod error;
pub mod estimates;
pub mod files;
mod kinematics;
pub mod math;
pub mod model;
pub mod problem;
pub mod record;
pub mod robot;
pub mod scene;
pub mod simulation;
pub mod solution;
pub mod state;
pub mod summary;
pub mod timeline;
pub mod verify;
mod warnings;

pub use cable_linalg as linalg;
pub use error::{Error, SceneError, SolveError};
pub use estimates::ErrorEstimates;
pub use files::FileError;
pub use math::{Mat2, Vec2};
pub use model::{Model, Settings};
pub use scene::{Cable, Load, Obstacle, Robot, Scene, Support};
pub use simulation::Simulation;
pub use solution::{Solution, Warning};
pub use state::State;
