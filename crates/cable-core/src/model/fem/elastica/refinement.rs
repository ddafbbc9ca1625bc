//! This module evaluates the pieces of an elastica between their nodes, and gives them new nodes:
//! graded into boundary layers, or at half the distance.

use crate::math::{Vec2, cross};
use crate::model::fem::elastica::boundary_value::{
    ANGLE, Elastica, ElasticaPiece, LENGTH, MOMENT, STATES, force, tangent,
};
use crate::model::fem::free::places;

/// Step of the differences of a state's slope, as a fraction of an element. Smaller: round-off;
/// larger: an error that grows with its square.
const DIFFERENCE_STEP_ELEMENTS: f64 = 1e-2;

/// Element length, in layers √(EI/T), up to which an element resolves the bend. Smaller: states are
/// interpolated with less than their order; larger: errors of shear appear as bends.
const RESOLVED_LAYERS: f64 = 2.0;

/// Turn of a boundary layer (rad) that may remain at the node where elements become long compared
/// with the layer. Smaller: layers that are resolved well enough are rejected; larger: bends
/// between nodes are missed.
const MAX_LEFT_TURN: f64 = 0.05;

impl Elastica {
    /// Thickness λ (m) of the boundary layer in which bending fades, at a tension (N); where the
    /// tension goes to zero, the weight limits it.
    pub(super) fn layer_thickness(&self, tension: f64) -> f64 {
        let w = self.body.norm();
        let least = (self.bending / (self.length * self.length)).max((self.bending * w * w).cbrt());
        (self.bending / tension.max(least)).sqrt()
    }

    /// The state at the place `x` (0 to 1) of a piece, by Hermite's quintic between its nodes. It
    /// is as accurate there as the nodes are (the cubic is off by 3e-7 m where a cable is bent to 1
    /// m within 10 elements).
    ///
    /// An element longer than the layer λ does not resolve it: an error δ of the shear would turn
    /// the quintic by (h/λ)² δ/T. Such an element is evaluated by [`Self::outer_state`].
    pub(super) fn state_in(&self, piece: &ElasticaPiece, x: f64) -> [f64; STATES] {
        let e = piece.grid.partition_point(|g| *g <= x).clamp(1, piece.grid.len() - 1) - 1;
        let (a, b) = (&piece.nodes[e], &piece.nodes[e + 1]);
        let h = piece.grid[e + 1] - piece.grid[e];
        let z = ((x - piece.grid[e]) / h).clamp(0.0, 1.0);
        if piece.contact.is_none() && self.layer_of_long([a, b], h).is_some() {
            return self.outer_state([a, b], z, h);
        }
        let [(fa, ga), (fb, gb)] = [a, b].map(|u| {
            let f = self.slope(piece.contact, u);
            (f, self.second_slope(piece.contact, u, &f, h))
        });
        let (z2, z3) = (z * z, z * z * z);
        let (z4, z5) = (z2 * z2, z2 * z3);
        std::array::from_fn(|i| {
            a[i] * (1.0 - 10.0 * z3 + 15.0 * z4 - 6.0 * z5)
                + b[i] * (10.0 * z3 - 15.0 * z4 + 6.0 * z5)
                + h * (fa[i] * (z - 6.0 * z3 + 8.0 * z4 - 3.0 * z5) + fb[i] * (-4.0 * z3 + 7.0 * z4 - 3.0 * z5))
                + 0.5 * h * h * (ga[i] * (z2 - 3.0 * z3 + 3.0 * z4 - z5) + gb[i] * (z3 - 2.0 * z4 + z5))
        })
    }

    /// The layer thickness √(EI/F) in a free element that is long compared with it, m; None if the
    /// element resolves the bend.
    fn layer_of_long(&self, [a, b]: [&[f64; STATES]; 2], h: f64) -> Option<f64> {
        let layer = (2.0 * self.bending / (force(a) + force(b)).norm()).sqrt();
        (h * a[LENGTH] > RESOLVED_LAYERS * layer).then_some(layer)
    }

    /// True if no bend of a boundary layer reaches an element that is long compared with the layer.
    /// There the discrete equations do not damp it, and a cable that turns back and forth from node
    /// to node would satisfy them.
    pub(super) fn resolves_layers(&self) -> bool {
        let is_resolved = |piece: &ElasticaPiece| {
            piece.contact.is_some()
                || piece.nodes.windows(2).zip(piece.grid.windows(2)).all(|(u, g)| {
                    let layer = self.layer_of_long([&u[0], &u[1]], g[1] - g[0]);
                    // The outer solution turns with the force.
                    let left = |u: &[f64; STATES]| {
                        u[MOMENT] / self.bending - cross(force(u), -self.body) / force(u).norm_squared()
                    };
                    layer.is_none_or(|layer| u.iter().all(|u| (left(u) * layer).abs() <= MAX_LEFT_TURN))
                })
        };
        self.pieces.iter().all(is_resolved)
    }

    /// The state at the fraction `z` of a free element that is long compared with its layer. Its
    /// force changes by its weight alone, so it is linear. The cable has the direction of the
    /// force, apart from a small turn by shear; the moment is small, too.
    fn outer_state(&self, [a, b]: [&[f64; STATES]; 2], z: f64, h: f64) -> [f64; STATES] {
        let mut u: [f64; STATES] = std::array::from_fn(|i| a[i] + z * (b[i] - a[i]));
        let angle_between = |v: Vec2, w: Vec2| cross(v, w).atan2(v.dot(&w));
        let sheared = [a, b].map(|u| angle_between(force(u), tangent(u)));
        let turned = angle_between(force(a), force(&u));
        u[ANGLE] = a[ANGLE] + turned + z * (sheared[1] - sheared[0]);
        let slopes = [a, b].map(|u| self.slope(None, u));
        for i in [0, 1] {
            let [from, to] = slopes.map(|f| h * f[i] - (b[i] - a[i]));
            u[i] += z * (1.0 - z) * (from * (1.0 - z) - to * z);
        }
        u
    }

    /// Change of the slope `f` of a state along a piece, by central differences over a part of an
    /// element of length `h`.
    fn second_slope(&self, contact: Option<usize>, u: &[f64; STATES], f: &[f64; STATES], h: f64) -> [f64; STATES] {
        let step = DIFFERENCE_STEP_ELEMENTS * h;
        let [back, on] = [-step, step].map(|by| self.slope(contact, &std::array::from_fn(|i| u[i] + by * f[i])));
        std::array::from_fn(|i| (on[i] - back[i]) / (2.0 * step))
    }

    /// Gives free pieces new nodes on the present curve, graded to their present boundary layers.
    pub(super) fn regrid(&mut self) {
        let regridded = |piece: &ElasticaPiece| {
            let (Some(first), Some(last)) = (piece.nodes.first(), piece.nodes.last()) else { return piece.clone() };
            let l = first[LENGTH];
            if piece.contact.is_some() {
                return piece.clone();
            }
            let layers = [first, last].map(|u| self.layer_thickness(force(u).norm()));
            let count = piece.grid.len() - 1;
            let mut grid: Vec<f64> = places(layers, l, count).iter().map(|s| s / l).collect();
            grid[count] = 1.0;
            let mut nodes: Vec<[f64; STATES]> = grid.iter().map(|&x| self.state_in(piece, x)).collect();
            for u in &mut nodes {
                u[LENGTH] = l;
            }
            ElasticaPiece { contact: None, grid, nodes }
        };
        self.pieces = self.pieces.iter().map(regridded).collect();
    }

    /// Returns the same elastica with every element halved.
    #[must_use]
    pub fn halved(&self) -> Self {
        let halve = |piece: &ElasticaPiece| {
            let mut grid = Vec::with_capacity(2 * piece.grid.len());
            for g in piece.grid.windows(2) {
                grid.extend([g[0], 0.5 * (g[0] + g[1])]);
            }
            grid.extend(piece.grid.last());
            let mut nodes: Vec<[f64; STATES]> = grid.iter().map(|&x| self.state_in(piece, x)).collect();
            for (k, u) in piece.nodes.iter().enumerate() {
                nodes[2 * k] = *u;
            }
            ElasticaPiece { contact: piece.contact, grid, nodes }
        };
        Self { pieces: self.pieces.iter().map(halve).collect(), ..self.clone() }
    }
}
