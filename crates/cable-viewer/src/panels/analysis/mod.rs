//! These panels show what the answer means and how it compares.
//!
//! - `compare`: answers held beside the present one
//! - `friction_range`: what less and more friction does
//! - `safe_reach`: where the robot or an end can be taken
//! - `tension_budget`: where the tension at a place comes from
//! - `work_precision`: error over cost of every model and mesh

pub mod compare;
pub mod friction_range;
pub mod safe_reach;
pub mod tension_budget;
pub mod work_precision;
