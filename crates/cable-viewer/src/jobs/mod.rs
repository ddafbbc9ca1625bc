//! The jobs are long computations beside the window, each on a thread of its own.
//!
//! - `background`: a job, its progress, and how it is ended
//! - `safe_reach`: the map of where the robot or an end can be taken
//! - `friction_range`: the ribbon of less and more friction
//! - `model_comparison`: a scene at rest by every model
//! - `neglected_bending`: what neglecting bending stiffness changes
//! - `work_precision`: error and cost of every model on several meshes

pub mod background;
pub mod friction_range;
pub mod model_comparison;
pub mod neglected_bending;
pub mod safe_reach;
pub mod work_precision;
