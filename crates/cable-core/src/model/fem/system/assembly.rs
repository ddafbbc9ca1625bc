//! This module assembles the energies of a mesh into value, gradient and banded Hessian.
//!
//! Unknowns are node positions, `2·node + axis`. Bars reach one node away (half-bandwidth 3),
//! bending two (5). Held nodes keep their rows: `System::pin_supports` turns these into rows of the
//! identity, so the band and the numbering never change. Before that, minus the gradient at a held
//! node is the force of the cable on its support.

use crate::energy::bending::{BendingEnergy, ClampBend, turn};
use crate::energy::{Curvature, ElementEnergy};
use crate::linalg::BandMatrix;
use crate::math::{Mat2, Vec2};
use crate::model::fem::mesh::Mesh;

/// True if the turn at an inner node bends the cable: neither the node nor a neighbour is a sliding
/// node, and the cable is not broken there.
fn bends_at(mesh: &Mesh, node: usize) -> bool {
    mesh.sliding[node - 1..=node + 1].iter().all(Option::is_none) && mesh.goes_on_through(node)
}

/// A bend of a mesh and its nodes.
enum NodeBend {
    /// The bend beside a clamp, on the side of its node (0: before it, 1: after it).
    Clamped(ClampBend, [usize; 2], usize),
    /// The bend between two bars.
    Free(BendingEnergy, [usize; 3]),
}

/// The turn of a bend, positive where the cable turns to the left.
#[derive(Clone, Copy, Debug)]
pub struct BendTurn {
    /// The slots in which its moments are kept (`branch_moments.rs`), in increasing order.
    pub slots: [usize; 2],
    /// rad.
    pub turn: f64,
    /// Bent length, m.
    pub length: f64,
}

/// Passes the turn of each bend of a mesh at `x` (m) to `visit`, in the order of their slots.
pub fn visit_turns(mesh: &Mesh, x: &[Vec2], mut visit: impl FnMut(BendTurn)) {
    visit_bends(mesh, Bends { stiffness: 0.0, scale: &[], from: None }, |bend| {
        visit(match bend {
            NodeBend::Clamped(bend, [a, b], side) => {
                let slot = 2 * (b - side) + side;
                let turn = turn(bend.direction, x[b] - x[a]);
                let turn = if side == 0 { -turn } else { turn };
                BendTurn { slots: [slot, slot], turn, length: bend.length }
            }
            NodeBend::Free(bend, [a, b, c]) => {
                let turn = turn(x[b] - x[a], x[c] - x[b]);
                BendTurn { slots: [2 * b, 2 * b + 1], turn, length: bend.length }
            }
        });
    });
}

/// The stiffness of bends, and the turns from which they are measured.
#[derive(Clone, Copy, Debug)]
pub struct Bends<'a> {
    /// Bending stiffness, N m².
    pub stiffness: f64,
    /// Factors of the energies of bars and of the bends between them (see `sliding_node.rs`); where
    /// there are none, the factor is 1.
    pub scale: &'a [f64],
    /// The turn at which each bend is not bent, in its slots (see [`BendTurn`]), rad; None if the
    /// straight cable is not bent.
    pub from: Option<&'a [f64]>,
}

/// Passes each bend of a mesh to `visit`.
#[inline]
fn visit_bends(mesh: &Mesh, bends: Bends<'_>, mut visit: impl FnMut(NodeBend)) {
    let Bends { stiffness, scale, from } = bends;
    // The two bars of a bend have the same factor: no sliding node lies between them.
    let stiffness = |bar: usize| stiffness * scale.get(bar).copied().unwrap_or(1.0);
    let from = |slot: usize| from.and_then(|turns| turns.get(slot)).copied().unwrap_or(0.0);
    let rest = &mesh.rest_length;
    let mut clamps = mesh.clamps.iter().peekable();
    for node in 0..mesh.nodes() {
        if let Some(clamp) = clamps.next_if(|c| c.node == node) {
            let first = node.saturating_sub(1);
            for (e, rest) in rest.iter().enumerate().take(node + 1).skip(first).filter(|(e, _)| !mesh.is_break(*e)) {
                let direction = clamp.direction;
                let side = usize::from(e == node);
                // The angle from a clamp to the bar before it is minus the turn there.
                let from = from(2 * node + side) * if side == 0 { -1.0 } else { 1.0 };
                let bend = ClampBend { stiffness: stiffness(e), length: 0.5 * rest, direction, from };
                visit(NodeBend::Clamped(bend, [e, e + 1], side));
            }
        } else if node > 0 && node < rest.len() && bends_at(mesh, node) {
            let length = 0.5 * (rest[node - 1] + rest[node]);
            let bend = BendingEnergy { stiffness: stiffness(node), length, from: from(2 * node) };
            visit(NodeBend::Free(bend, [node - 1, node, node + 1]));
        }
    }
}

/// Energy of the bends of a mesh at `x` (m), J.
pub fn bends_energy(mesh: &Mesh, x: &[Vec2]) -> f64 {
    let mut value = 0.0;
    visit_bends(mesh, Bends { stiffness: mesh.bending_stiffness, scale: &[], from: None }, |bend| {
        value += match bend {
            NodeBend::Clamped(bend, nodes, _) => bend.value(&nodes.map(|n| x[n])),
            NodeBend::Free(bend, nodes) => bend.value(&nodes.map(|n| x[n])),
        };
    });
    value
}

/// Slope of the energy of bends (see [`System::add_bends`]) at `x` (m) times the displacements of
/// the nodes (m), J.
pub fn bends_slope(mesh: &Mesh, stiffness: f64, from: Option<&[f64]>, x: &[Vec2], ways: &[Vec2]) -> f64 {
    fn along<const N: usize>(bend: &impl ElementEnergy<N>, nodes: [usize; N], x: &[Vec2], ways: &[Vec2]) -> f64 {
        bend.gradient(&nodes.map(|n| x[n])).iter().zip(nodes).map(|(g, n)| g.dot(&ways[n])).sum()
    }
    let mut slope = 0.0;
    visit_bends(mesh, Bends { stiffness, scale: &[], from }, |bend| {
        slope += match bend {
            NodeBend::Clamped(bend, nodes, _) => along(&bend, nodes, x, ways),
            NodeBend::Free(bend, nodes) => along(&bend, nodes, x, ways),
        };
    });
    slope
}

/// Value, gradient and Hessian of all energies of a mesh.
#[derive(Clone, Debug)]
pub struct System {
    /// ∂E/∂x less the external forces, N, `2·node + axis`.
    pub gradient: Vec<f64>,
    /// ∂²E/∂x², N/m.
    pub hessian: BandMatrix,
}

impl System {
    /// Allocates the system of a mesh.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            gradient: vec![0.0; 2 * mesh.nodes()],
            hessian: BandMatrix::new(2 * mesh.nodes(), mesh.half_bandwidth()),
        }
    }

    /// Adds a 2×2 block. A diagonal block (`i == j`) must be symmetric, and only one of a pair (i,
    /// j), (j, i) must be added.
    #[inline]
    pub fn add_block(&mut self, i: usize, j: usize, block: &Mat2) {
        let b = block;
        if i <= j {
            self.hessian.add_block(2 * i, 2 * j, [[b[(0, 0)], b[(0, 1)]], [b[(1, 0)], b[(1, 1)]]]);
        } else {
            self.hessian.add_block(2 * j, 2 * i, [[b[(0, 0)], b[(1, 0)]], [b[(0, 1)], b[(1, 1)]]]);
        }
    }

    /// Adds a force gradient (N) at a node.
    #[inline]
    pub fn add_gradient(&mut self, node: usize, gradient: Vec2) {
        self.gradient[2 * node] += gradient.x;
        self.gradient[2 * node + 1] += gradient.y;
    }

    /// The gradient at a node, N.
    #[inline]
    #[must_use]
    pub fn gradient_at(&self, node: usize) -> Vec2 {
        Vec2::new(self.gradient[2 * node], self.gradient[2 * node + 1])
    }

    /// Sets gradient and Hessian to those of stretching and bending at `x` (m), less the external
    /// forces `force` (N a node); returns the energy less the work of the external forces, J.
    #[cfg(test)]
    pub fn assemble(&mut self, mesh: &Mesh, x: &[Vec2], force: &[Vec2], curvature: Curvature) -> f64 {
        self.hessian.clear();
        let mut value = 0.0;
        for (i, (f, x)) in force.iter().zip(x).enumerate() {
            value -= f.dot(x);
            self.gradient[2 * i] = -f.x;
            self.gradient[2 * i + 1] = -f.y;
        }
        for (e, &rest_length) in mesh.rest_length.iter().enumerate() {
            let bar = crate::energy::axial::Bar { rest_length, stiffness: mesh.axial_stiffness };
            value += self.add_energy(&bar, [e, e + 1], x, curvature);
        }
        if mesh.bending_stiffness > 0.0 {
            let bends = Bends { stiffness: mesh.bending_stiffness, scale: &[], from: None };
            value += self.add_bends(mesh, bends, x, curvature);
        }
        value
    }

    /// Adds one energy of `N` nodes; returns its value, J.
    pub fn add_energy<const N: usize>(
        &mut self,
        energy: &impl ElementEnergy<N>,
        nodes: [usize; N],
        x: &[Vec2],
        curvature: Curvature,
    ) -> f64 {
        let local = nodes.map(|n| x[n]);
        let (gradient, blocks) = (energy.gradient(&local), energy.hessian(&local, curvature));
        for a in 0..N {
            self.add_gradient(nodes[a], gradient[a]);
            for b in a..N {
                self.add_block(nodes[a], nodes[b], &blocks[a][b]);
            }
        }
        energy.value(&local)
    }

    /// Adds the energy of bends at `x` (m); returns it, J. With the stiffness and the unbent turns
    /// of [`LossTerms`](super::step_input::LossTerms) this is the damping of bending.
    pub fn add_bends(&mut self, mesh: &Mesh, bends: Bends<'_>, x: &[Vec2], curvature: Curvature) -> f64 {
        let mut value = 0.0;
        visit_bends(mesh, bends, |bend| {
            value += match bend {
                NodeBend::Clamped(bend, nodes, _) => self.add_energy(&bend, nodes, x, curvature),
                NodeBend::Free(bend, nodes) => self.add_energy(&bend, nodes, x, curvature),
            };
        });
        value
    }

    /// Prescribes the held nodes: zero gradient, identity rows.
    #[cfg(test)]
    pub fn pin_supports(&mut self, mesh: &Mesh) {
        for (node, _) in mesh.fixity.iter().enumerate().filter(|(_, is_fixed)| **is_fixed) {
            for k in [2 * node, 2 * node + 1] {
                self.gradient[k] = 0.0;
                self.hessian.pin(k);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::linalg::BandFactor;
    use crate::model::fem::mesh::{Clamp, Spread};

    fn mesh(bending_stiffness: f64) -> Mesh {
        Mesh {
            tuning: Arc::default(),
            arc_length: (0..9).map(|k| 0.5 * f64::from(k)).collect(),
            rest_length: vec![0.5; 8],
            fixity: (0..9).map(|k| k == 0 || k == 8).collect(),
            clamps: vec![
                Clamp { node: 0, direction: Vec2::new(1.0, 0.0) },
                Clamp { node: 5, direction: Vec2::new(0.8, -0.6) },
            ],
            axial_stiffness: 1e4,
            bending_stiffness,
            sliding: vec![None; 9],
            thermal_stretch: 1.0,
            spread: Spread::default(),
            ..Mesh::default()
        }
    }

    fn wavy() -> Vec<Vec2> {
        (0..9).map(|k| Vec2::new(0.51 * f64::from(k), 0.1 * (1.7 * f64::from(k)).sin())).collect()
    }

    #[test]
    fn gradient_and_hessian_match_differences() {
        for bending_stiffness in [0.0, 40.0] {
            let mesh = mesh(bending_stiffness);
            let (x, force) = (wavy(), vec![Vec2::new(0.2, -3.0); 9]);
            let mut at = System::new(&mesh);
            at.assemble(&mesh, &x, &force, Curvature::Exact);
            let (mut plus, mut minus) = (System::new(&mesh), System::new(&mesh));
            let h = 1e-6;
            for j in 0..18 {
                let (mut xp, mut xm) = (x.clone(), x.clone());
                xp[j / 2][j % 2] += h;
                xm[j / 2][j % 2] -= h;
                let slope = (plus.assemble(&mesh, &xp, &force, Curvature::Exact)
                    - minus.assemble(&mesh, &xm, &force, Curvature::Exact))
                    / (2.0 * h);
                assert!((slope - at.gradient[j]).abs() < 1e-3, "gradient {j}");
                for i in j.saturating_sub(at.hessian.half_bandwidth())..=j {
                    let bend = (plus.gradient[i] - minus.gradient[i]) / (2.0 * h);
                    assert!((bend - at.hessian.get(i, j)).abs() < 1e-1, "Hessian {i}, {j}");
                }
            }
        }
    }

    #[test]
    fn clipped_tangent_of_a_compressed_cable_is_definite() {
        let mesh = mesh(0.0);
        let x: Vec<Vec2> = (0..9).map(|k| Vec2::new(0.4 * f64::from(k), 0.01 * f64::from(k % 2))).collect();
        let mut system = System::new(&mesh);
        let mut factor = BandFactor::new(18, mesh.half_bandwidth()).unwrap();
        system.assemble(&mesh, &x, &[Vec2::zeros(); 9], Curvature::Exact);
        system.pin_supports(&mesh);
        assert!(factor.factor(&system.hessian).is_err());
        system.assemble(&mesh, &x, &[Vec2::zeros(); 9], Curvature::Clipped);
        for node in 0..9 {
            system.add_block(node, node, &Mat2::identity());
        }
        system.pin_supports(&mesh);
        assert!(factor.factor(&system.hessian).is_ok());
    }

    #[test]
    fn a_held_node_gives_the_force_on_its_support() {
        let mesh = Mesh { clamps: Vec::new(), ..mesh(0.0) };
        let x: Vec<Vec2> = (0..9).map(|k| Vec2::new(0.51 * f64::from(k), 0.0)).collect();
        let mut system = System::new(&mesh);
        system.assemble(&mesh, &x, &[Vec2::zeros(); 9], Curvature::Exact);
        let tension = 1e4 * 0.02;
        assert!((-system.gradient_at(0) - Vec2::new(tension, 0.0)).norm() < 1e-9);
        assert!((-system.gradient_at(8) + Vec2::new(tension, 0.0)).norm() < 1e-9);
    }

    #[test]
    fn shares_add_up_to_the_length() {
        let mesh = mesh(0.0);
        assert!(((0..9).map(|k| mesh.tributary_length(k)).sum::<f64>() - 4.0).abs() < 1e-14);
        assert_eq!(mesh.node_at(1.5 + 1e-9), Some(3));
        assert_eq!(mesh.node_at(1.6), None);
    }
}
