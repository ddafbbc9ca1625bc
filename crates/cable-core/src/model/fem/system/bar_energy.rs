//! This module computes the energy of a bar in a step: stretching, damping, and the weight that
//! moves with its material.
//!
//! With P the length of its path and L its unstretched length, ε = P/L − 1:
//! ```text
//! E = ½ EA L ε²,     ∂E/∂P = T = EA ε,      ∂E/∂L = −Θ = −(T + ½ T ε),
//! ∂²E/∂P² = EA/L,    ∂²E/∂P∂L = −EA P/L²,   ∂²E/∂L² = EA P²/L³
//! ```
//! At a material node P depends on the position of the node; at a sliding node L depends on its
//! slide. The weight of the bar acts at the centroid c of its path (`bar_weight.rs`), so a change
//! δL of the material adds −b·(c − x₀) δL, with x₀ the sliding node it came through. Viscous
//! damping with time constant τ is a second bar of stiffness EA τ a whose strain is measured from
//! the predicted one; so is that of relaxation branches in a taut bar (`model/material_loss.rs`).

use crate::energy::Curvature;
use crate::math::{Mat2, Vec2};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::system::assembly::System;
use crate::model::fem::system::bar_weight::Weight;
use crate::model::fem::system::step_input::{StepInput, Unknowns, WORK_MAGNITUDE_FRACTION};

/// Effective EA of a bar, N: a flexible bar has none in compression, because it buckles between its
/// nodes. With any fraction of EA slack cables would stand in arches on the ground and push their
/// supports (with a hundredth a loose power cable pushed with 5.7 kN). A cable with bending
/// stiffness resists compression.
#[inline]
#[must_use]
pub fn stiffness(mesh: &Mesh, stretched: bool) -> f64 {
    if stretched || !mesh.is_flexible() { mesh.axial_stiffness } else { 0.0 }
}

/// The branch of a bar's force law in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BarBranch {
    /// It is slack and buckles between its nodes.
    Slack,
    /// It is in tension, or has bending stiffness.
    Taut,
}

/// The unknowns of a bar in the mixed iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarIterate {
    /// Its force, N.
    pub pull: f64,
    /// The branch on which it is.
    pub branch: BarBranch,
}

/// A bar between material nodes in a step: its force is a continuous, piecewise linear and
/// non-decreasing function of its length.
///
/// The force is EA (P/L − 1) by stretch plus c (P − P̂)/L by damping, as long as their sum is
/// tensile. Otherwise the bar buckles: only its folds resist, with a force proportional to its
/// speed and small compared with its weight (`step_inertia.rs`), measured from its length P̂ at the
/// start of the step or, if it was stretched then, from the length at which its tension ends. With
/// the damping of a taut bar in slack ones, a plumb cable lowered on to a floor stood as a column
/// and pushed its riser up with 35 times its weight.
#[derive(Clone, Copy, Debug)]
pub struct PlainBar {
    /// Length at which it begins to be stretched, m.
    taut_from: f64,
    /// Force at that length, N.
    pull_there: f64,
    /// Slopes of the force where it is taut and where it is slack, N/m.
    slopes: [f64; 2],
    /// True if it can be slack.
    flexible: bool,
}

impl PlainBar {
    /// Bar `e` of a mesh.
    #[inline]
    #[must_use]
    pub fn of(mesh: &Mesh, input: &StepInput, e: usize) -> Self {
        let (length, ea, flexible) = (mesh.rest_length[e], mesh.axial_stiffness, mesh.is_flexible());
        if mesh.is_break(e) {
            return Self { taut_from: 0.0, pull_there: 0.0, slopes: [0.0; 2], flexible };
        }
        let [taut, slack] = input.losses.bars.get(e).copied().unwrap_or_default();
        let slopes = [(ea + taut) / length, slack / length];
        if taut + slack == 0.0 {
            return Self { taut_from: length, pull_there: 0.0, slopes, flexible };
        }
        let damped_from = input.losses.damped_from[e] - length;
        if !flexible {
            return Self { taut_from: length, pull_there: -damped_from * taut / length, slopes, flexible };
        }
        let taut_from = length + damped_from * taut / (ea + taut);
        let folded = taut_from - input.losses.predicted_length[e];
        Self { taut_from, pull_there: if folded > 0.0 { folded * slopes[1] } else { 0.0 }, slopes, flexible }
    }

    /// Length at which it becomes taut or slack, m.
    #[must_use]
    pub fn taut_from(&self) -> f64 {
        self.taut_from
    }

    /// Its branch at a length, m.
    #[inline]
    #[must_use]
    pub fn branch(&self, p: f64) -> BarBranch {
        if self.flexible && p < self.taut_from { BarBranch::Slack } else { BarBranch::Taut }
    }

    /// True if it is on a branch at a length (m), or within a strain `rounding` of it.
    #[inline]
    #[must_use]
    pub fn is_on(&self, branch: BarBranch, p: f64, rounding: f64) -> bool {
        branch == self.branch(p) || (p - self.taut_from).abs() <= rounding * self.taut_from
    }

    /// Its force on a branch, N, and the derivative of that by its length, N/m.
    #[inline]
    #[must_use]
    pub fn pull(&self, branch: BarBranch, p: f64) -> (f64, f64) {
        let slope = self.slopes[usize::from(branch == BarBranch::Slack)];
        (self.pull_there + slope * (p - self.taut_from), slope)
    }

    /// The potential of this force, J, which is 0 where the bar becomes taut.
    #[inline]
    #[must_use]
    pub fn energy(&self, branch: BarBranch, p: f64) -> f64 {
        let longer = p - self.taut_from;
        longer * (self.pull_there + 0.5 * self.slopes[usize::from(branch == BarBranch::Slack)] * longer)
    }
}

/// Unstretched length of a bar with these slides, m.
#[must_use]
pub fn rest_length(mesh: &Mesh, e: usize, slide: &[f64]) -> f64 {
    mesh.rest_length[e] + mesh.thermal_stretch * (slide[e + 1] - slide[e])
}

/// The energy of a bar with a sliding node in a step, J, and its derivatives by the length P of its
/// path and by its unstretched length L.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::fem) struct BarEnergy {
    energy: f64,
    /// ∂E/∂P (the force) and ∂E/∂L, N.
    slope: [f64; 2],
    /// ∂²E/∂P², ∂²E/∂P∂L, ∂²E/∂L², N/m.
    curvature: [f64; 3],
}

impl BarEnergy {
    /// A spring of stiffness `k` (N) whose strain P/L − q is measured from `q` − 1: E = ½ k L (P/L
    /// − q)².
    fn spring(k: f64, q: f64, [p, l]: [f64; 2]) -> Self {
        let strain = p / l - q;
        let pull = k * strain;
        Self {
            energy: 0.5 * l * pull * strain,
            slope: [pull, -pull * (q + 0.5 * strain)],
            curvature: [k / l, -k * p / (l * l), k * p * p / (l * l * l)],
        }
    }

    /// The sum of two energies, with their slopes and curvatures.
    fn plus(self, other: Self) -> Self {
        let sum = |k: usize| self.curvature[k] + other.curvature[k];
        Self {
            energy: self.energy + other.energy,
            slope: [self.slope[0] + other.slope[0], self.slope[1] + other.slope[1]],
            curvature: [sum(0), sum(1), sum(2)],
        }
    }

    /// Stretching and damping of bar `e` at `[P, L]`, m. The total force of a flexible bar is
    /// tensile: if damping could compress a slack bar on a round, it would cause friction without a
    /// normal force.
    fn of(mesh: &Mesh, input: &StepInput, e: usize, at: [f64; 2]) -> Self {
        let (ea, loss) = (mesh.axial_stiffness, input.damping(e));
        let ratio = input.losses.damped_from[e] / mesh.rest_length[e];
        let (elastic, viscous) = (Self::spring(ea, 1.0, at), Self::spring(loss, ratio, at));
        if !mesh.is_flexible() || elastic.slope[0] > 0.0 && elastic.slope[0] + viscous.slope[0] > 0.0 {
            return elastic.plus(viscous);
        }
        // Damping is measured from no less than the unstretched length. The energy at the length at
        // which the tension ends remains, per length.
        let slope = 0.5 * ea * loss / (ea + loss) * (ratio - 1.0) * (ratio - 1.0);
        Self { energy: slope * at[1], slope: [0.0, slope], ..Self::default() }
    }
}

/// Derivatives of the energy of a bar with a sliding node by the length P of its path and by its
/// unstretched length L at `[P, L]` (m), N: those of stretching, and those of damping.
#[must_use]
pub fn slopes(mesh: &Mesh, input: &StepInput, e: usize, at @ [p, l]: [f64; 2]) -> [[f64; 2]; 2] {
    let whole = BarEnergy::of(mesh, input, e, at).slope;
    let elastic = BarEnergy::spring(stiffness(mesh, !(p < l)), 1.0, at).slope;
    [elastic, [whole[0] - elastic[0], whole[1] - elastic[1]]]
}

/// Energy of stretching of a bar at `[P, L]` (m), J.
#[must_use]
pub fn stretch_energy(mesh: &Mesh, [p, l]: [f64; 2]) -> f64 {
    0.5 * stiffness(mesh, !(p < l)) / l * (p - l) * (p - l)
}

/// Force of a bar on the material of the sliding node at its start (`j` 0) or end (1), N: the
/// derivative of its energy by the slide of that node, without the factor of the energy. It
/// consists of Θ, damping, and the weight that moves with the material.
#[must_use]
pub fn pull_at_slide(mesh: &Mesh, input: &StepInput, e: usize, j: usize, x: &[Vec2], slide: &[f64]) -> f64 {
    let at = [mesh.path(e, x).length, rest_length(mesh, e, slide)];
    -mesh.thermal_stretch * BarEnergy::of(mesh, input, e, at).slope[1] + lifted(mesh, input.loads.body, e, j, x)
}

/// Tension of a bar with a sliding node at an end, N, at the present length of its path and with an
/// unstretched length `l`, m.
#[must_use]
pub fn pull_on(mesh: &Mesh, input: &StepInput, e: usize, x: &[Vec2], l: f64) -> f64 {
    BarEnergy::of(mesh, input, e, [mesh.path(e, x).length, l]).slope[0]
}

/// Force that lifts the weight from the centroid of a bar to its start (`j` 0) or end (1), N.
#[must_use]
pub fn lifted(mesh: &Mesh, body: Vec2, e: usize, j: usize, x: &[Vec2]) -> f64 {
    body.dot(&(Weight::of(mesh, e, &mesh.path(e, x), body).center - x[e + j]))
}

/// Adds all bars; returns their energy and the sum of the magnitudes of its terms (with their
/// round-off), J. The geometric stiffness of a bar is that of the force `carried`, if given, not
/// that of its present length.
pub fn add_all(
    s: &mut System,
    mesh: &Mesh,
    input: &StepInput,
    unknowns: &Unknowns,
    curvature: Curvature,
    carried: &[BarIterate],
) -> (f64, f64) {
    let (mut energy, mut size) = (0.0, 0.0);
    let mut slides = mesh.sliding.first().is_some_and(Option::is_some);
    for e in 0..mesh.rest_length.len() {
        let next = mesh.sliding[e + 1].is_some();
        let (more, sized) = if slides || next {
            add_sliding(s, mesh, input, e, unknowns, curvature)
        } else {
            add(s, mesh, input, e, &unknowns.positions, curvature, carried.get(e))
        };
        (energy, size) = (energy + more, size + sized);
        slides = next;
    }
    (energy, size)
}

/// Adds bar `e`, which has no sliding node; returns what [`add_all`] does.
#[inline(always)]
fn add(
    s: &mut System,
    mesh: &Mesh,
    input: &StepInput,
    e: usize,
    x: &[Vec2],
    curvature: Curvature,
    carried: Option<&BarIterate>,
) -> (f64, f64) {
    let d = x[e + 1] - x[e];
    let (p, scale) = (d.norm(), input.scale[e]);
    let t = if p > 0.0 { d / p } else { Vec2::x() };
    let bar = PlainBar::of(mesh, input, e);
    let branch = carried.map_or_else(|| bar.branch(p), |c| c.branch);
    let (pull, slope) = bar.pull(branch, p);
    let across = carried.map_or(pull, |c| c.pull);
    let clip = curvature == Curvature::Clipped && across < 0.0;
    let geometric = if p > 0.0 && !clip { scale * across / p } else { 0.0 };
    let along = scale * slope - geometric;
    let gradient = t * (pull * scale);
    if let Some([ax, ay, bx, by]) = s.gradient.get_mut(2 * e..).and_then(|g| g.first_chunk_mut()) {
        *ax -= gradient.x;
        *ay -= gradient.y;
        *bx += gradient.x;
        *by += gradient.y;
    }
    s.hessian.add_spring(2 * e, [along * t.x * t.x + geometric, along * t.x * t.y, along * t.y * t.y + geometric]);
    let energy = scale * bar.energy(branch, p);
    // The undamped Newton method does not use the energy, so its round-off is not estimated.
    let rounding = if carried.is_some() { 0.0 } else { scale * WORK_MAGNITUDE_FRACTION * pull.abs() * x[e].norm() };
    (energy, energy + rounding)
}

/// Adds a bar that has a sliding node at one end or both; returns what [`add_all`] does.
fn add_sliding(
    s: &mut System,
    mesh: &Mesh,
    input: &StepInput,
    e: usize,
    unknowns: &Unknowns,
    curvature: Curvature,
) -> (f64, f64) {
    let path = mesh.path(e, &unknowns.positions);
    let (p, l, scale) = (path.length, rest_length(mesh, e, &unknowns.slides), input.scale[e]);
    let slides = [mesh.sliding[e].is_some(), mesh.sliding[e + 1].is_some()];
    let BarEnergy { energy, slope: [pull, push], curvature: h } = BarEnergy::of(mesh, input, e, [p, l]);
    let h = h.map(|h| scale * h);
    let t = path.direction;
    let mut geometric = if path.straight > 0.0 { scale * pull / path.straight } else { 0.0 };
    if curvature == Curvature::Clipped && geometric < 0.0 {
        geometric = 0.0;
    }
    let rounding = WORK_MAGNITUDE_FRACTION * pull.abs() * unknowns.positions[e].norm();
    let carried = mesh.thermal_stretch;
    let hung = Weight::of(mesh, e, &path, input.loads.body);
    let sign = [-1.0, 1.0];
    // Work is measured from the sliding node itself, because with friction its two sides have
    // different factors.
    let weight =
        [0, 1].map(|j| if slides[j] { input.loads.body.dot(&(hung.center - unknowns.positions[e + j])) } else { 0.0 });
    // These are the generalised directions of P and L, and of the lever of the weight, at both
    // ends.
    let along = [0, 1].map(|j| if slides[j] { Vec2::zeros() } else { t * sign[j] });
    let length = [0, 1].map(|j| if slides[j] { Vec2::new(carried * sign[j], 0.0) } else { Vec2::zeros() });
    let lever = [0, 1].map(|j| if slides[j] { Vec2::new(sign[j], 0.0) } else { Vec2::zeros() });
    let change = unknowns.slides[e + 1] - unknowns.slides[e];
    // Half of the bar's first material is already among the forces on its nodes.
    let material = mesh.arc_length[e + 1] - mesh.arc_length[e];
    let half = (unknowns.positions[e] + unknowns.positions[e + 1]) * 0.5;
    let shifted = input.loads.body.dot(&(hung.center - half)) * material;
    let hang = [0, 1].map(|j| {
        if slides[j] {
            Vec2::zeros()
        } else {
            hung.slope[j] * change + (hung.slope[j] - input.loads.body * 0.5) * material
        }
    });
    let across = Mat2::identity() - t * t.transpose();
    for j in 0..2 {
        s.add_gradient(e + j, (along[j] * pull + length[j] * push - lever[j] * weight[j] - hang[j]) * scale);
        for k in j..2 {
            let mixed = along[j] * length[k].transpose() + length[j] * along[k].transpose();
            let mut block =
                along[j] * along[k].transpose() * h[0] + mixed * h[1] + length[j] * length[k].transpose() * h[2];
            if !slides[j] && !slides[k] {
                block += across * (geometric * sign[j] * sign[k]);
            }
            if curvature == Curvature::Exact {
                block -= (lever[j] * hung.slope[k].transpose() + hung.slope[j] * lever[k].transpose()) * scale;
                if j == k && !slides[j] {
                    block -= Weight::second_derivative(mesh, e, j, &path, unknowns.positions[e + j], input.loads.body)
                        * ((material + change) * scale);
                }
            }
            s.add_block(e + j, e + k, &block);
        }
    }
    let fallen = weight[1] * unknowns.slides[e + 1] - weight[0] * unknowns.slides[e] + shifted;
    (scale * (energy - fallen), scale * (energy + fallen.abs() + rounding))
}
