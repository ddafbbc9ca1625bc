//! The system assembles the energies of a mesh into value, gradient and banded Hessian.
//!
//! Unknowns are node positions, `2·node + axis`. Bars reach one node away (half-bandwidth 3),
//! bending two (5). Nodes that are held keep their rows: `System::pin_held` turns these into rows
//! of the identity, so the band and the numbering never change. Before pinning, minus the gradient
//! at a held node is the force of the cable on its support.

use std::sync::Arc;

use crate::energy::axial::Bar;
use crate::energy::bending::{BendingEnergy, ClampBend, turn};
use crate::energy::{Curvature, Energy};
use crate::linalg::{BARS_HALF_BANDWIDTH, BENDING_HALF_BANDWIDTH, BandMatrix};
use crate::math::{Mat2, Vec2};
use crate::model::fem::mesh::sliding_node::SlidingNode;
use crate::model::fem::mesh::tangent_path::{End, Path};
use crate::model::fem::settings::Tuning;
use crate::model::fem::system::mass::Spread;
use crate::problem::Problem;

/// A direction prescribed at a node; it bends the bars on both sides of the node, each by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clamp {
    /// The node.
    pub node: usize,
    /// Unit vector of growing arc length.
    pub direction: Vec2,
}

/// A cable cut into bars.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The tuned constants by which it is solved.
    pub tuning: Arc<Tuning>,
    /// Unstretched arc length of each node at rest temperature, m, increasing.
    pub arc_length: Vec<f64>,
    /// Unstretched length of each bar at the present temperature (thermal stretch · ds), m.
    pub rest_length: Vec<f64>,
    /// True if each node is held in place.
    pub held: Vec<bool>,
    /// Directions prescribed.
    pub clamps: Vec<Clamp>,
    /// The corner, post or pulley of each sliding node; None: the node moves with the material.
    pub sliding: Vec<Option<SlidingNode>>,
    /// 1 + αΔT: unstretched length of a metre of arc length.
    pub thermal_stretch: f64,
    /// EA, N.
    pub axial_stiffness: f64,
    /// EI, N·m²; 0 = no bending.
    pub bending_stiffness: f64,
    /// Difference of its mass from that lumped at its nodes.
    pub spread: Spread,
}

impl Mesh {
    /// Cuts a cable into about `segments` bars with a node at each of `breaks` (arc lengths, m,
    /// increasing, the ends among them) and even bars in between. All nodes are free. `spreads`:
    /// whether its mass is spread over the bars.
    #[must_use]
    pub fn new(problem: &Problem, tuning: Arc<Tuning>, breaks: &[f64], segments: usize, spreads: bool) -> Self {
        let mut arc_length: Vec<f64> = Vec::with_capacity(segments + breaks.len());
        let mut stretches = Vec::with_capacity(breaks.len());
        for pair in breaks.windows(2) {
            let count = bars_between(pair[1] - pair[0], problem.length, segments);
            let step = (pair[1] - pair[0]) / count as f64;
            arc_length.extend((0..count).map(|k| pair[0] + step * k as f64));
            stretches.push((count, step));
        }
        arc_length.extend(breaks.last());
        let rest_length = arc_length.windows(2).map(|p| problem.thermal_stretch * (p[1] - p[0])).collect();
        Self {
            tuning,
            held: vec![false; arc_length.len()],
            sliding: vec![None; arc_length.len()],
            thermal_stretch: problem.thermal_stretch,
            rest_length,
            arc_length,
            clamps: Vec::new(),
            axial_stiffness: problem.axial_stiffness,
            bending_stiffness: problem.bending_stiffness,
            spread: if spreads { Spread::of(&stretches) } else { Spread::default() },
        }
    }

    /// Mass that moves with a node, kg; `support_node` is the node of each support.
    #[must_use]
    pub fn mass_with(&self, problem: &Problem, support_node: &[Option<usize>], node: usize) -> f64 {
        let lumps = problem.supports.iter().zip(support_node).filter(|(_, k)| **k == Some(node));
        problem.linear_density * self.share(node) + lumps.map(|(s, _)| s.mass).sum::<f64>()
    }

    /// Becomes a copy without new memory where there is room; `slides`: whether there can be
    /// sliding nodes to copy.
    pub fn copy_from(&mut self, other: &Self, slides: bool) {
        let Self { tuning, arc_length, rest_length, held, clamps, sliding, spread, .. } = other;
        self.tuning.clone_from(tuning);
        self.arc_length.clone_from(arc_length);
        self.rest_length.clone_from(rest_length);
        self.held.clone_from(held);
        self.clamps.clone_from(clamps);
        self.spread.copy_from(spread);
        if slides {
            self.sliding.clone_from(sliding);
        }
        self.thermal_stretch = other.thermal_stretch;
        self.axial_stiffness = other.axial_stiffness;
        self.bending_stiffness = other.bending_stiffness;
    }

    /// Number of nodes.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.arc_length.len()
    }

    /// True if nothing resists bending.
    #[must_use]
    pub fn is_flexible(&self) -> bool {
        self.bending_stiffness == 0.0
    }

    /// Half-bandwidth of the Hessian.
    #[must_use]
    pub fn half_bandwidth(&self) -> usize {
        if self.bending_stiffness > 0.0 { BENDING_HALF_BANDWIDTH } else { BARS_HALF_BANDWIDTH }
    }

    /// The end that node `k` makes for the bars beside it.
    #[must_use]
    pub fn end(&self, k: usize, x: &[Vec2]) -> End {
        self.sliding[k].as_ref().map_or_else(|| End::point(x[k]), |s| s.end)
    }

    /// The way of bar `e`.
    #[must_use]
    pub fn path(&self, e: usize, x: &[Vec2]) -> Path {
        if self.sliding[e].is_none() && self.sliding[e + 1].is_none() {
            return Path::line(x[e], x[e + 1]);
        }
        Path::between(&self.end(e, x), &self.end(e + 1, x))
    }

    /// Ends of the straight part of bar `e`, m.
    #[must_use]
    pub fn straight(&self, e: usize, x: &[Vec2]) -> [Vec2; 2] {
        if self.sliding[e].is_none() && self.sliding[e + 1].is_none() { [x[e], x[e + 1]] } else { self.path(e, x).ends }
    }

    /// Features that the ends of bar `e` run round.
    #[must_use]
    pub fn rounds(&self, e: usize) -> [Option<usize>; 2] {
        [e, e + 1].map(|k| self.sliding[k].as_ref().and_then(SlidingNode::feature))
    }

    /// True if a node moves with the material and nothing prescribes where it is.
    #[must_use]
    pub fn is_free(&self, k: usize) -> bool {
        !self.held[k] && self.sliding[k].is_none()
    }

    /// The bar from node `e` to node `e + 1`.
    #[must_use]
    pub fn bar(&self, e: usize) -> Bar {
        Bar { rest_length: self.rest_length[e], stiffness: self.axial_stiffness }
    }

    /// Arc length that belongs to a node (half of the bars beside it, at rest temperature, and what
    /// of them is spread), m: weight, wind and what momentum a node has are this times their value
    /// per metre.
    #[must_use]
    pub fn share(&self, node: usize) -> f64 {
        let s = &self.arc_length;
        let before = if node > 0 { s[node] - s[node - 1] } else { 0.0 };
        let after = if node + 1 < s.len() { s[node + 1] - s[node] } else { 0.0 };
        0.5 * (before + after) + self.spread.more.get(node).copied().unwrap_or(0.0)
    }

    /// The node at an arc length (m), within a millionth of the cable.
    #[must_use]
    pub fn node_at(&self, arc_length: f64) -> Option<usize> {
        let near = 1e-6 * self.arc_length.last().copied().unwrap_or(0.0);
        let k = self.arc_length.partition_point(|&s| s < arc_length - near);
        (k < self.nodes() && (self.arc_length[k] - arc_length).abs() <= near).then_some(k)
    }
}

/// True if the turn at an inner node bends the cable: not where it or a neighbour slides over
/// something.
fn bends(mesh: &Mesh, node: usize) -> bool {
    mesh.sliding[node - 1..=node + 1].iter().all(Option::is_none)
}

/// Even bars for a stretch of `length` out of `whole` when the whole is to have about `segments`.
#[must_use]
pub fn bars_between(length: f64, whole: f64, segments: usize) -> usize {
    let share = (segments as f64 * length / whole).round();
    if share >= 1.0 { share as usize } else { 1 }
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
    /// Room for a mesh.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            gradient: vec![0.0; 2 * mesh.nodes()],
            hessian: BandMatrix::new(2 * mesh.nodes(), mesh.half_bandwidth()),
        }
    }

    /// Adds a 2×2 block; a block on the diagonal (`i == j`) must be symmetric, and of a pair (i,
    /// j), (j, i) with `i != j` only one is to be added.
    pub fn add_block(&mut self, i: usize, j: usize, block: &Mat2) {
        let b = block;
        if i <= j {
            self.hessian.add_block(2 * i, 2 * j, [[b[(0, 0)], b[(0, 1)]], [b[(1, 0)], b[(1, 1)]]]);
        } else {
            self.hessian.add_block(2 * j, 2 * i, [[b[(0, 0)], b[(1, 0)]], [b[(0, 1)], b[(1, 1)]]]);
        }
    }

    /// Adds a force gradient (N) at a node.
    pub fn add_gradient(&mut self, node: usize, gradient: Vec2) {
        self.gradient[2 * node] += gradient.x;
        self.gradient[2 * node + 1] += gradient.y;
    }

    /// The gradient at a node, N.
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
        for e in 0..mesh.rest_length.len() {
            value += self.add_energy(&mesh.bar(e), [e, e + 1], x, curvature);
        }
        if mesh.bending_stiffness > 0.0 {
            value += self.add_bending(mesh, x, curvature);
        }
        value
    }

    /// Adds one energy of `N` nodes; returns its value, J.
    pub fn add_energy<const N: usize>(
        &mut self,
        energy: &impl Energy<N>,
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

    /// Adds the bending energy at `x` (m); returns its value, J.
    pub fn add_bending(&mut self, mesh: &Mesh, x: &[Vec2], curvature: Curvature) -> f64 {
        self.add_bends(mesh, mesh.bending_stiffness, None, x, curvature)
    }

    /// Bends of this stiffness (N m²), measured from those at `from` (m), if there is such; returns
    /// their energy, J. With EI τ/h and where a step of h began it is the loss of bending, as that
    /// of stretch is.
    pub fn add_bends(
        &mut self,
        mesh: &Mesh,
        stiffness: f64,
        from: Option<&[Vec2]>,
        x: &[Vec2],
        curvature: Curvature,
    ) -> f64 {
        let rest = &mesh.rest_length;
        let mut value = 0.0;
        let mut clamps = mesh.clamps.iter().peekable();
        for node in 0..mesh.nodes() {
            if let Some(clamp) = clamps.next_if(|c| c.node == node) {
                let first = node.saturating_sub(1);
                for (e, rest) in rest.iter().enumerate().take(node + 1).skip(first) {
                    let direction = clamp.direction;
                    let from = from.map_or(0.0, |x| turn(direction, x[e + 1] - x[e]));
                    let bend = ClampBend { stiffness, length: 0.5 * rest, direction, from };
                    value += self.add_energy(&bend, [e, e + 1], x, curvature);
                }
            } else if node > 0 && node < rest.len() && bends(mesh, node) {
                let from = from.map_or(0.0, |x| turn(x[node] - x[node - 1], x[node + 1] - x[node]));
                let bend = BendingEnergy { stiffness, length: 0.5 * (rest[node - 1] + rest[node]), from };
                value += self.add_energy(&bend, [node - 1, node, node + 1], x, curvature);
            }
        }
        value
    }

    /// Prescribes the held nodes: zero gradient, identity rows.
    #[cfg(test)]
    pub fn pin_held(&mut self, mesh: &Mesh) {
        for (node, _) in mesh.held.iter().enumerate().filter(|(_, held)| **held) {
            for k in [2 * node, 2 * node + 1] {
                self.gradient[k] = 0.0;
                self.hessian.pin(k);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::BandFactor;

    fn mesh(bending_stiffness: f64) -> Mesh {
        Mesh {
            tuning: Arc::default(),
            arc_length: (0..9).map(|k| 0.5 * f64::from(k)).collect(),
            rest_length: vec![0.5; 8],
            held: (0..9).map(|k| k == 0 || k == 8).collect(),
            clamps: vec![
                Clamp { node: 0, direction: Vec2::new(1.0, 0.0) },
                Clamp { node: 5, direction: Vec2::new(0.8, -0.6) },
            ],
            axial_stiffness: 1e4,
            bending_stiffness,
            sliding: vec![None; 9],
            thermal_stretch: 1.0,
            spread: Spread::default(),
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
        system.pin_held(&mesh);
        assert!(factor.factor(&system.hessian).is_err());
        system.assemble(&mesh, &x, &[Vec2::zeros(); 9], Curvature::Clipped);
        for node in 0..9 {
            system.add_block(node, node, &Mat2::identity());
        }
        system.pin_held(&mesh);
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
        assert!(((0..9).map(|k| mesh.share(k)).sum::<f64>() - 4.0).abs() < 1e-14);
        assert_eq!(mesh.node_at(1.5 + 1e-9), Some(3));
        assert_eq!(mesh.node_at(1.6), None);
    }
}
