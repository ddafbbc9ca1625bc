//! The models compute one cable of a scene (a [`Problem`](crate::problem::Problem)) behind one
//! trait, [`Mechanics`].
//!
//! | room | content |
//! |---|---|
//! | `mechanics.rs`, `settings.rs` | the trait and its reports; [`Settings`] |
//! | `tension_gauge/` | tensions of the inner steps |
//! | `registry.rs` | one entry a model: name, capabilities, constructor; [`build`] |
//! | `auto.rs` | the choice of a model |
//! | `layers/` | models around another one: wheels that are left, another scale, two models in turn |
//! | `initial_equilibrium.rs`, `hand.rs`, `smoothed_target.rs`, `length_change.rs`, `bending_change.rs`, `arc_nodes.rs`, `material_loss.rs`, `mobilised_friction.rs`, `auxiliary_weight.rs` | what several models share |
//! | `catenary/`, `spans/`, `fem/`, `mass_spring/` | the models |
//!
//! A model answers two kinds of question: the equilibrium of a cable ([`Mechanics::settle`]), and
//! its motion ([`Mechanics::advance`]). A model that cannot answer returns a typed error, never a
//! guess.

mod arc_nodes;
pub(crate) mod auto;
mod auxiliary_weight;
mod bending_change;
pub mod catenary;
pub mod fem;
pub mod hand;
pub(crate) mod initial_equilibrium;
mod layers;
mod length_change;
pub mod mass_spring;
mod material_loss;
pub(crate) mod mechanics;
mod mobilised_friction;
pub(crate) mod registry;
pub(crate) mod settings;
pub(crate) mod smoothed_target;
pub mod spans;
pub mod tension_gauge;

pub use self::auto::Question;
pub use self::mechanics::{BreakPlace, Inertia, Mechanics, OwnedResources, RobotContact, StepReport};
pub(crate) use self::registry::ModelSource;
pub use self::registry::{Capabilities, ModelInfo, build};
pub(crate) use self::settings::MIN_TOLERANCE;
pub use self::settings::{Settings, Stepping};
pub use crate::model_id::Model;

/// Greatest speed with inertia, m/s: faster supports are refused, and `mass-spring` cuts faster
/// motion. Smaller: recoils of broken ropes are cut (breaking strain times wave speed: 20 m/s for
/// steel, 300 m/s for nylon); larger: air drag, which no model has, would dominate, and thin
/// obstacles need ever shorter sub-steps.
pub(crate) const MAX_SPEED: f64 = 300.0;
