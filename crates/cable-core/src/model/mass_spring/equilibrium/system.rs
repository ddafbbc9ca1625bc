//! The linear system of Newton's method on the nodes of a mesh; the σ of a pulley stands in the
//! place of its node's x.

use crate::energy::Blocks;
use crate::error::SolveError;
use crate::linalg::{BARS_HALF_BANDWIDTH, BENDING_HALF_BANDWIDTH, BandFactor, BandMatrix};
use crate::math::{Mat2, Vec2};
use crate::model::Model;
use crate::model::mass_spring::mesh::Mesh;

/// Gradient and Hessian of the energy, and the factor and step of Newton's method.
pub(in crate::model::mass_spring) struct EquilibriumSystem {
    /// Tension at the start of each element, N, which lends stiffness to slack elements.
    pub initial_tension: Vec<f64>,
    /// Part of it that still does.
    pub fade: f64,
    pub gradient: Vec<f64>,
    pub hessian: BandMatrix,
    pub factor: BandFactor,
    pub step: Vec<f64>,
    /// Positions before the step, m.
    pub position: Vec<Vec2>,
    /// Arc lengths before the step, m.
    pub arc_length: Vec<f64>,
}

impl EquilibriumSystem {
    pub(in crate::model::mass_spring) fn new(mesh: &Mesh) -> Result<Self, SolveError> {
        let n = mesh.position.len();
        let band = if mesh.bending_stiffness > 0.0 { BENDING_HALF_BANDWIDTH } else { BARS_HALF_BANDWIDTH };
        let factor = BandFactor::new(2 * n, band).map_err(|_| SolveError::Indefinite { model: Model::MassSpring })?;
        Ok(Self {
            initial_tension: mesh.tension.clone(),
            fade: 1.0,
            gradient: vec![0.0; 2 * n],
            hessian: BandMatrix::new(2 * n, band),
            factor,
            step: vec![0.0; 2 * n],
            position: mesh.position.clone(),
            arc_length: mesh.arc_length.clone(),
        })
    }

    /// Adds a block; on the diagonal it must be symmetric, and of (i, j) and (j, i) only one is to
    /// be added.
    pub(in crate::model::mass_spring) fn add_block(&mut self, i: usize, j: usize, block: &Mat2) {
        for r in 0..2 {
            for c in 0..2 {
                if i != j || c >= r {
                    self.hessian.add(2 * i + r, 2 * j + c, block[(r, c)]);
                }
            }
        }
    }

    pub(in crate::model::mass_spring) fn add_gradient(&mut self, node: usize, g: Vec2) {
        self.gradient[2 * node] += g.x;
        self.gradient[2 * node + 1] += g.y;
    }

    pub(in crate::model::mass_spring) fn add_energy<const N: usize>(
        &mut self,
        nodes: [usize; N],
        gradient: [Vec2; N],
        blocks: &Blocks<N>,
    ) {
        for a in 0..N {
            self.add_gradient(nodes[a], gradient[a]);
            for b in a..N {
                self.add_block(nodes[a], nodes[b], &blocks[a][b]);
            }
        }
    }
}
