//! A scene says what there is: cables, supports, obstacles, loads, environment, robot, in the words
//! of a scene file.
//!
//! | room | content |
//! |---|---|
//! | `document.rs` | [`Scene`]: the parts of a scene file, and where the robot stands |
//! | `cable.rs`, `support.rs`, `load.rs`, `motion.rs` | a cable, what holds and pulls it, how its supports move |
//! | `obstacle.rs`, `environment.rs`, `robot.rs`, `ground.rs` | what surrounds it; the ground under the robot's tracks |
//! | `robot_contact_outline.rs` | the robot's outline as a cable meets it |
//! | `read/` | files in and out, and the refusal of what cannot be solved |
//! | `library/` | named scenes and presets |
//! | `nearest_name.rs` | the known name that a mistyped one means |
//! | `import.rs`, `froude_scaling.rs` | lines from tables and drawings; a similar copy at another scale |
//! | `comparison.rs` | in which keys do two scenes differ? |
//!
//! A [`Scene`] is a plain document: every field is public, so that an editor can hold a half-typed
//! one. [`Scene::validate`] says whether it can be solved; [`crate::Simulation::new`] refuses one
//! that cannot.

pub(crate) mod cable;
mod comparison;
mod document;
pub(crate) mod environment;
pub(crate) mod froude_scaling;
pub(crate) mod ground;
pub mod import;
pub(crate) mod library;
pub(crate) mod load;
pub(crate) mod motion;
mod nearest_name;
pub(crate) mod obstacle;
pub(crate) mod read;
pub(crate) mod robot;
mod robot_contact_outline;
pub(crate) mod support;

pub use cable::{Cable, FrictionMobilised};
pub use comparison::{Change, FieldValue};
pub use document::Scene;
pub(crate) use document::VERSION;
pub use environment::{Environment, STANDARD_GRAVITY, View};
pub use ground::{Ground, Stand};
pub use library::{catalog, preset};
pub use load::Load;
pub use motion::Motion;
pub(crate) use obstacle::LineEnds;
pub use obstacle::{Obstacle, Shape};
pub use robot::{Heading, Pose, ROLLING_RESISTANCE, Robot, RobotTask, TRACK_FRICTION};
pub use support::{PulleySide, Support, SupportKind};
