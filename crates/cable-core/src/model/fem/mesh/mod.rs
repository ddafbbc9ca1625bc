//! These modules divide a cable into bars: nodes, masses, sliding nodes, and the paths of bars
//! round corners, posts and pulleys.
//!
//! | room | content |
//! |---|---|
//! | `cable_mesh.rs` | `Mesh`: nodes, bars, clamps, sliding nodes, masses and stiffnesses |
//! | `bar_memory.rs` | forces and impulses that bars remember, through changes of the mesh |
//! | `branch_moments.rs` | moments in those of bends, through changes of the mesh |
//! | `mass_matrix.rs` | mean of lumped and consistent mass matrix, fourth order in the frequencies |
//! | `bar_count.rs` | number of bars, given by the user or by length and surroundings |
//! | `sliding_node.rs` | node on a corner, post or pulley, its arc length unknown; capstan stick-slip |
//! | `tangent_path.rs` | path of a bar, straight or tangent to the rounds at its ends; derivatives |

pub(in crate::model::fem) mod bar_count;
pub(in crate::model::fem) mod bar_memory;
pub(in crate::model::fem) mod branch_moments;
pub(in crate::model::fem) mod cable_mesh;
pub(in crate::model::fem) mod mass_matrix;
pub(in crate::model::fem) mod sliding_node;
pub(in crate::model::fem) mod tangent_path;

pub(in crate::model::fem) use bar_count::bar_count;
pub(in crate::model::fem) use cable_mesh::{Clamp, Mesh, bars_between};
pub(in crate::model::fem) use mass_matrix::MassMatrix;
#[cfg(test)]
pub(in crate::model::fem) use mass_matrix::Spread;
pub(in crate::model::fem) use sliding_node::{
    BalancedTensions, SlideOver, SlidingNode, SlidingNodeLoad, StickSlip, mean_factor, round_of,
};
pub(in crate::model::fem) use tangent_path::{BarEnd, StraightPart, TangentPath, angle_between, rotate};

/// Gap to which a shape is pushed out of obstacles, as a fraction of the barrier's reach. Smaller:
/// nodes begin with a larger barrier force; larger: at 1 they are out of contact and fall back into
/// it. A choice, tuned on no campaign; the landing gap of predicted contacts is half of the reach.
pub(in crate::model::fem) const PUSHED_OUT_REACHES: f64 = 0.9;
