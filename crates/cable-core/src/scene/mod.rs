//! A scene says what there is: cables, supports, obstacles, loads, environment, robot, in the words
//! of a scene file.
//!
//! | room | content |
//! |---|---|
//! | `cable.rs`, `support.rs`, `load.rs`, `motion.rs` | a cable, what holds and pulls it, how its supports move |
//! | `obstacle.rs`, `environment.rs`, `robot.rs`, `ground.rs` | what surrounds it; the ground under the robot's tracks |
//! | `read/` | files in and out, and the refusal of what cannot be solved |
//! | `library/` | named scenes and presets |
//! | `import.rs`, `scaled.rs` | lines from tables and drawings; a similar copy at another scale |
//!
//! A [`Scene`] is a plain document: every field is public, so that an editor can hold a half-typed
//! one. [`Scene::validate`] says whether it can be solved; [`crate::Simulation::new`] refuses one
//! that cannot.

pub mod cable;
pub mod environment;
pub mod ground;
pub mod import;
pub mod library;
pub mod load;
pub mod motion;
pub mod obstacle;
pub(crate) mod read;
pub mod robot;
pub mod scaled;
pub mod support;

pub use cable::{Cable, FrictionMobilised};
pub use environment::{Environment, STANDARD_GRAVITY, View};
pub use library::{catalog, preset};
pub use load::Load;
pub use motion::Motion;
pub(crate) use obstacle::LineEnds;
pub use obstacle::{Obstacle, Shape};
pub use read::{file, schema, validate};
pub use robot::{Heading, Robot, RobotTask};
pub use support::{PulleySide, Support, SupportKind};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The file version this build writes, and the newest it reads.
pub const VERSION: u32 = 1;

/// A whole scene, as a scene file holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// File format version; always 1.
    pub version: u32,
    /// Shown in title bars and reports.
    #[serde(default)]
    pub name: String,
    /// Side view or plan view.
    #[serde(default)]
    pub view: View,
    /// Gravity, wind, temperature.
    #[serde(default)]
    pub environment: Environment,
    /// The cables; at least one.
    pub cables: Vec<Cable>,
    /// Terrain, beams, posts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<Obstacle>,
    /// Point loads on cables.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// The tracked vehicle, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<Robot>,
}
