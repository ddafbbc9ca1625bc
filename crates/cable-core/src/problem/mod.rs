//! A problem is one cable of a scene in numerical form: all models read it.
//!
//! | room | content |
//! |---|---|
//! | `definition.rs` | [`Problem`]: the cable, its supports and loads |
//! | `from_scene.rs` | the steps from a scene to its problems |
//! | `time_series.rs` | forces and wind as functions of time |
//! | `support_clearance.rs` | supports on a surface are moved off it by a cable radius |
//! | `ground_route.rs`, `route_check.rs` | routes below the ground are lifted; routes through a beam are refused |
//! | `robot_outline.rs` | the robot as an obstacle |
//! | `unreachable_obstacles.rs` | obstacles that the cable cannot come to are left out |
//! | `way_over.rs` | the route between two places, over the obstacles in the way |
//! | `wheel_passage.rs` | on which side a cable passes a wheel, and how far it turns about it |
//! | `wheels_as_posts.rs` | wheels as rounds which the cable may leave |
//! | `describe_place.rs`, `rounding_error.rs` | places in words; what rounding leaves of an answer |
//! | `answer_energy.rs` | the energy of an answer, from its nodes and the numbers of the cable |
//!
//! Arc lengths are unstretched at rest temperature; temperature enters as the factor
//! `thermal_stretch` on unstretched lengths: strain = length/(thermal_stretch·ds) − 1. Weight and
//! wind are per metre of arc length.

mod answer_energy;
mod definition;
mod describe_place;
mod from_scene;
pub(crate) mod ground_route;
pub(crate) mod robot_outline;
mod rounding_error;
mod route_check;
mod support_clearance;
mod time_series;
mod unreachable_obstacles;
pub(crate) mod way_over;
pub(crate) mod wheel_passage;
pub(crate) mod wheels_as_posts;

pub(crate) use self::definition::{CableWheels, MovingPost, WheelsLeft};
pub use self::definition::{Departure, PointLoad, Problem, SupportPoint};
pub use self::from_scene::{check, problems};
pub use self::robot_outline::{OUTLINE_NAME, robot_outline};
pub use self::time_series::TimeSeries;
