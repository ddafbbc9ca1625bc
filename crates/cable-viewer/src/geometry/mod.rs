//! This wing says where the things of a scene are on screen and which one lies under a point.
//!
//! - `supports`, `arrows`, `robot`: where supports, load arrows and the robot with its path are now
//! - `handles`: where anything that can be dragged is, and what moves with it
//! - `hit_test`: the thing under a screen point
//! - `bounds`: the rectangle that things take up
//! - `terrain_extent`: the ground between a tank's walls
//! - `leader`: the thing that leads a cable while time runs
//! - `torn_cable`: the pieces of a cable that broke
//! - `triangulate`: triangles of a polygon

pub mod arrows;
pub mod bounds;
pub mod handles;
pub mod hit_test;
pub mod leader;
pub mod robot;
pub mod supports;
pub mod terrain_extent;
pub mod torn_cable;
pub mod triangulate;
