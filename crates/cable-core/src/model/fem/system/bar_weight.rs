//! The weight of a bar that lies partly on a round acts at the centroid of its path.
//!
//! A bar is strained evenly, so its material is spread evenly over its path of length P: with C =
//! ∫r over the path, the weight of L metres has the potential −L b·C/P. A free end x of the bar
//! beyond a round moves and turns the straight part (length l, middle m, direction u away from the
//! round):
//! ```text
//! dC = ½ l dx + (u·dx) m,   dP = u·dx,   c = C/P,
//! ∂(b·c)/∂x = ½ (l/P) b + u b·(m − c)/P
//! ```
//! So the end carries half the weight of the straight part, and the weight of the part on the round
//! acts there. The tension in the middle of the straight part is T − L b·(m − c)/P, with T the
//! tension of the bar as a whole. A bar without a round has c = m and l = P: half of its weight
//! acts at each end.
//!
//! If that tension would be negative, the bar is slack, and its material is not spread evenly: only
//! so much of the weight on the round acts there that nothing is compressed, and half of the rest
//! at each end. This fraction is found from the unknowns at the start of a step; within the step it
//! would alternate when a bar is nearly slack.

use crate::math::{Mat2, Vec2, larger, perp, smaller};
use crate::model::fem::mesh::{Mesh, SlidingNode, TangentPath};

/// The weight of one bar with a sliding node at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    /// Point where it acts, c, m.
    pub center: Vec2,
    /// ∂(b·c)/∂x at a free end, N/m; zero at a sliding node.
    pub slope: [Vec2; 2],
    /// b·(m − c)/P, N/m: times L (m) it is the excess of the tension of the bar as a whole over
    /// that in the middle of its straight part.
    pub excess: f64,
    /// Fractions of the material on the round of the first node, on the straight part, and on the
    /// round of the second node.
    pub parts: [f64; 3],
}

impl Weight {
    /// The weight of bar `e` on its path, under a body force (N/m).
    #[must_use]
    pub fn of(mesh: &Mesh, e: usize, path: &TangentPath, body: Vec2) -> Self {
        match lying_fraction(mesh, e) {
            0.0 => Self::at_ends(mesh, e, path, body),
            1.0 => Self::spread_evenly(mesh, e, path, body),
            part => Self::spread_evenly(mesh, e, path, body).with_lying_fraction(part, mesh, e, path, body),
        }
    }

    /// The weight if the material is spread evenly over the path.
    #[must_use]
    pub fn spread_evenly(mesh: &Mesh, e: usize, path: &TangentPath, body: Vec2) -> Self {
        let middle = (path.ends[0] + path.ends[1]) * 0.5;
        let slides = [mesh.sliding[e].is_some(), mesh.sliding[e + 1].is_some()];
        let half = slides.map(|slides| if slides { Vec2::zeros() } else { body * 0.5 });
        let mut sum = middle * path.straight;
        let mut laps = [0.0; 2];
        for j in [0, 1] {
            if let Some(node) = &mesh.sliding[e + j]
                && node.end.radius > 0.0
                && path.arcs[j] != 0.0
            {
                let way = [1.0, -1.0][j];
                sum += node.end.arc(way * path.arcs[j]) * way;
                laps[j] = node.end.radius * path.arcs[j];
            }
        }
        if laps == [0.0; 2] || !(path.length > 0.0) {
            return Self { center: middle, slope: half, excess: 0.0, parts: [0.0, 1.0, 0.0] };
        }
        let center = sum / path.length;
        let part = path.straight / path.length;
        let excess = body.dot(&(middle - center)) / path.length;
        let away = [path.direction * -excess, path.direction * excess];
        let slope = [0, 1].map(|j| if slides[j] { Vec2::zeros() } else { half[j] * part + away[j] });
        // A bar that lies completely on one round hangs from its ends.
        let hangs = !(path.straight > 0.0);
        let (excess, parts) =
            if hangs { (0.0, [0.0, 1.0, 0.0]) } else { (excess, [laps[0] / path.length, part, laps[1] / path.length]) };
        Self { center, slope, excess, parts }
    }

    /// The weight if none of it acts on rounds: half of it acts at each end of the bar.
    fn at_ends(mesh: &Mesh, e: usize, path: &TangentPath, body: Vec2) -> Self {
        let at = |j: usize| mesh.sliding[e + j].as_ref().map_or(path.ends[j], SlidingNode::position);
        let half = [0, 1].map(|j| if mesh.sliding[e + j].is_some() { Vec2::zeros() } else { body * 0.5 });
        Self { center: (at(0) + at(1)) * 0.5, slope: half, excess: 0.0, parts: [0.0, 1.0, 0.0] }
    }

    /// The weight if only a fraction of the weight on rounds (0 to 1) acts there, and half of the
    /// rest at each end of the bar.
    fn with_lying_fraction(self, part: f64, mesh: &Mesh, e: usize, path: &TangentPath, body: Vec2) -> Self {
        let at = |j: usize| mesh.sliding[e + j].as_ref().map_or(path.ends[j], SlidingNode::position);
        let slide = [mesh.sliding[e].is_some(), mesh.sliding[e + 1].is_some()];
        let half = slide.map(|slides| if slides { Vec2::zeros() } else { body * 0.5 });
        let [first, _, second] = self.parts;
        Self {
            center: self.center * part + (at(0) + at(1)) * (0.5 * (1.0 - part)),
            slope: [0, 1].map(|j| self.slope[j] * part + half[j] * (1.0 - part)),
            excess: self.excess * part,
            parts: [first * part, 1.0 - (first + second) * part, second * part],
        }
    }

    /// ∂²(b·c)/∂x² at the free end `j` (0 or 1) of bar `e`, which is at `at` (m), N/m²; b is the
    /// distributed force `body` (N/m), c the point where it acts.
    #[must_use]
    pub fn second_derivative(mesh: &Mesh, e: usize, j: usize, path: &TangentPath, at: Vec2, body: Vec2) -> Mat2 {
        let Some(round) = mesh.sliding[e + 1 - j].as_ref().map(|s| s.end).filter(|end| end.radius > 0.0) else {
            return Mat2::zeros();
        };
        let full = Self::spread_evenly(mesh, e, path, body);
        if !(path.straight > 0.0 && path.length > 0.0) || full.parts[1] == 1.0 {
            return Mat2::zeros();
        }
        let u = path.direction * [-1.0, 1.0][j];
        let n = perp(u);
        let across = n * n.transpose() / path.straight;
        let longer = (at - round.center) / path.straight;
        // ∂(b·m)/∂x, with m = x − ½ l u.
        let middle = body - longer * (0.5 * body.dot(&u)) - n * (0.5 * body.dot(&n));
        let own = full.slope[j];
        let bend = body * (longer - u * full.parts[1]).transpose() * 0.5
            + across * (full.excess * path.length)
            + u * (middle - own - u * full.excess).transpose();
        // The matrix is symmetric except for round-off.
        (bend + bend.transpose()) * (0.5 * lying_fraction(mesh, e) / path.length)
    }

    /// Tension in the middle of the straight part of a bar of `material` (m) with the tension
    /// `tension` (N) as a whole, N; it is not negative if the bar is `flexible`.
    #[must_use]
    pub fn tension_in_middle(&self, tension: f64, material: f64, flexible: bool) -> f64 {
        let pull = tension - material * self.excess;
        if flexible && !(pull > 0.0) { 0.0 } else { pull }
    }

    /// Length of `material` (m) that the first end and the second end carry: half of the straight
    /// part, and the part on its round.
    #[must_use]
    pub fn carried_material(&self, material: f64) -> [f64; 2] {
        let [first, straight, second] = self.parts;
        [(first + 0.5 * straight) * material, (second + 0.5 * straight) * material]
    }
}

/// True if the round of a sliding node has several marks. On a small round there is little weight,
/// and its friction is computed as if that hung beside it. (A mesh of one bar stands for a part of
/// a longer one.)
fn is_large(mesh: &Mesh, k: usize) -> bool {
    let shares = |j: Option<usize>| {
        let beside = j.and_then(|j| mesh.sliding.get(j)?.as_ref());
        beside.zip(mesh.sliding[k].as_ref()).is_some_and(|(a, b)| a.shares_round(b))
    };
    shares(k.checked_sub(1)) || shares(Some(k + 1))
}

/// Lying fraction of bar `e`: the fraction of its weight on rounds that acts there.
fn lying_fraction(mesh: &Mesh, e: usize) -> f64 {
    let of = |k: usize, side: usize| {
        mesh.sliding[k]
            .as_ref()
            .map_or(1.0, |s| if is_large(mesh, k) || mesh.nodes() == 2 { s.lying_fractions[side] } else { 0.0 })
    };
    smaller(of(e, 1), of(e + 1, 0))
}

/// The greatest fraction of the weight of bar `e` on rounds that may act there if the bar as a
/// whole has the tension `tension` (N): with more, the middle of its straight part would be
/// compressed.
#[must_use]
pub fn max_lying_fraction(mesh: &Mesh, e: usize, path: &TangentPath, body: Vec2, tension: f64) -> f64 {
    let excess = Weight::spread_evenly(mesh, e, path, body).excess * (mesh.arc_length[e + 1] - mesh.arc_length[e]);
    let pull = larger(tension, 0.0);
    if !mesh.is_flexible() || pull >= excess { 1.0 } else { pull / excess }
}

/// The weight of bar `e` that acts on its first and second end with the slides `slide` (m), N; the
/// weight that no free end carries acts on rounds.
#[must_use]
pub fn force_on_ends(mesh: &Mesh, e: usize, x: &[Vec2], slide: Option<&[f64]>, body: Vec2) -> [Vec2; 2] {
    let slid = slide.map_or(0.0, |s| s[e + 1] - s[e]);
    let material = mesh.arc_length[e + 1] - mesh.arc_length[e] + slid;
    match [mesh.sliding[e].is_some(), mesh.sliding[e + 1].is_some()] {
        [true, false] => {
            let on = Weight::of(mesh, e, &mesh.path(e, x), body).slope[1] * material;
            [body * material - on, on]
        }
        [false, true] => {
            let on = Weight::of(mesh, e, &mesh.path(e, x), body).slope[0] * material;
            [on, body * material - on]
        }
        _ => [body * (0.5 * material); 2],
    }
}

/// The weight that acts on a node, N.
#[must_use]
pub fn force_on_node(mesh: &Mesh, k: usize, x: &[Vec2], body: Vec2) -> Vec2 {
    let last = mesh.nodes() - 1;
    if (k.saturating_sub(1)..=(k + 1).min(last)).all(|j| mesh.sliding[j].is_none()) {
        return body * mesh.tributary_length(k);
    }
    let before = if k > 0 { force_on_ends(mesh, k - 1, x, None, body)[1] } else { Vec2::zeros() };
    let after = if k < last { force_on_ends(mesh, k, x, None, body)[0] } else { Vec2::zeros() };
    before + after
}

/// Lying fractions of the bars beside sliding node `k` at positions `x` (m) under a distributed
/// force `body` (N/m).
pub(in crate::model::fem) fn lying_fractions_beside(mesh: &Mesh, k: usize, x: &[Vec2], body: Vec2) -> [f64; 2] {
    [k - 1, k].map(|e| {
        let path = mesh.path(e, x);
        let tension = mesh.tension(e, path.length);
        max_lying_fraction(mesh, e, &path, body, tension)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::fem::mesh::{BarEnd, SlideOver};
    use proptest::prelude::*;

    const BODY: Vec2 = Vec2::new(0.7, -3.0);

    fn unit(angle: f64) -> Vec2 {
        Vec2::new(angle.cos(), angle.sin())
    }

    fn on(end: BarEnd) -> SlidingNode {
        let slide_over = SlideOver::Obstacle { obstacle: 0, feature: 0 };
        SlidingNode { lying_fractions: [0.7; 2], ..SlidingNode::new(end, 0.3, slide_over) }
    }

    /// A bar with its mark on a round at the origin at one end (`j` the free one), and a mark at an
    /// angle from its tangent point.
    fn bar(j: usize, at: Vec2, radius: f64, sense: f64, lap: f64) -> (Mesh, Vec<Vec2>) {
        let round = |mark: Vec2| BarEnd { center: Vec2::zeros(), radius, mark, sense };
        let ends =
            |mark: Vec2| if j == 1 { [round(mark), BarEnd::point(at)] } else { [BarEnd::point(at), round(mark)] };
        let [a, b] = ends(Vec2::x());
        let touches = TangentPath::between(&a, &b).ends[1 - j] / radius;
        let back = crate::model::fem::mesh::rotate(touches, if j == 1 { -sense * lap } else { sense * lap });
        let mut sliding = vec![None, None];
        sliding[1 - j] = Some(on(round(back)));
        let mesh = Mesh {
            arc_length: vec![0.0, 1.7],
            rest_length: vec![1.7],
            fixity: vec![false; 2],
            sliding,
            thermal_stretch: 1.0,
            axial_stiffness: 1e3,
            ..Mesh::default()
        };
        let mut x = vec![back * radius; 2];
        x[j] = at;
        (mesh, x)
    }

    fn weight(mesh: &Mesh, x: &[Vec2]) -> Weight {
        Weight::of(mesh, 0, &mesh.path(0, x), BODY)
    }

    proptest! {
        #[test]
        fn the_weight_acts_at_the_mean_of_the_way_and_its_slopes_are_those_of_its_work(
            place in (1.3f64..3.0, 0.0f64..6.2), round in (0.2f64..1.0, any::<bool>(), -0.4f64..1.5), first in any::<bool>(),
            lying in 0.0f64..1.5,
        ) {
            let (j, sense) = (usize::from(first), if round.1 { 1.0 } else { -1.0 });
            let (mut mesh, x) = bar(j, unit(place.1) * place.0, round.0, sense, round.2);
            let path = mesh.path(0, &x);
            prop_assume!(path.length > 0.1);
            if let Some(node) = &mut mesh.sliding[1 - j] {
                node.lying_fractions = [1.0; 2];
            }
            // Compare the centroid with a sum along the path.
            let end = mesh.sliding[1 - j].unwrap().end;
            let (parts, lap) = (4000, path.arcs[1 - j]);
            let mut sum = (path.ends[0] + path.ends[1]) * (0.5 * path.straight);
            for k in 0..parts {
                let turned = lap * (f64::from(k) + 0.5) / f64::from(parts) * if j == 1 { sense } else { -sense };
                sum += crate::model::fem::mesh::rotate(end.mark, turned) * (end.radius * end.radius * lap / f64::from(parts));
            }
            let w = weight(&mesh, &x);
            prop_assert!((w.center - sum / path.length).norm() < 1e-6, "{} {}", w.center, sum / path.length);
            // Compare the first and second derivative with differences, with a fraction lying
            // there.
            if let Some(node) = &mut mesh.sliding[1 - j] {
                node.lying_fractions = [smaller(lying, 1.0); 2];
            }
            let w = weight(&mesh, &x);
            let h = 1e-5;
            let at = |d: Vec2| {
                let mut x = x.clone();
                x[j] += d;
                (weight(&mesh, &x), BODY.dot(&weight(&mesh, &x).center))
            };
            let bend = Weight::second_derivative(&mesh, 0, j, &path, x[j], BODY);
            for axis in [Vec2::x(), Vec2::y()] {
                let ((plus, up), (minus, down)) = (at(axis * h), at(-axis * h));
                prop_assert!(((up - down) / (2.0 * h) - w.slope[j].dot(&axis)).abs() < 1e-6);
                prop_assert!(((plus.slope[j] - minus.slope[j]) / (2.0 * h) - bend * axis).norm() < 1e-5);
            }
            // The end carries half of the straight part; the rest is the excess of the bar's
            // tension over that of its middle.
            let [_, carried] = w.carried_material(1.0);
            prop_assert!((w.carried_material(1.0)[0] + carried - 1.0).abs() < 1e-12);
        }

        #[test]
        fn the_energy_of_a_bar_on_a_round_has_the_slopes_that_are_added(
            place in (1.3f64..2.4, 0.0f64..6.2), round in (0.2f64..0.9, any::<bool>(), 0.0f64..1.2), first in any::<bool>(),
            slide in -0.1f64..0.1,
        ) {
            use crate::model::fem::system::assembly::System;
            use crate::model::fem::system::bar_energy;
            use crate::model::fem::system::step_input::{Unknowns, StepInput};
            use crate::energy::Curvature;
            let (j, sense) = (usize::from(first), if round.1 { 1.0 } else { -1.0 });
            let (mut mesh, x) = bar(j, unit(place.1) * place.0, round.0, sense, round.2);
            // The bar is taut, far from being slack.
            mesh.rest_length = vec![0.8 * mesh.path(0, &x).length];
            mesh.arc_length[1] = mesh.rest_length[0];
            prop_assume!(mesh.rest_length[0] > 0.5);
            let mut input = StepInput { scale: vec![1.4], ..StepInput::default() };
            input.loads.body = BODY;
            input.losses.damped_from.clone_from(&mesh.rest_length);
            let energy = |x: &[Vec2], slide: &[f64]| {
                let mut s = System::new(&mesh);
                let unknowns = Unknowns { positions: x.to_vec(), slides: slide.to_vec() };
                (bar_energy::add_all(&mut s, &mesh, &input, &unknowns, Curvature::Exact, &[]).0, s)
            };
            let mut slides = [0.0; 2];
            slides[1 - j] = slide;
            let (_, s) = energy(&x, &slides);
            let h = 1e-6;
            let moved = |k: usize, by: f64| {
                let (mut x, mut slides) = (x.clone(), slides);
                match k {
                    2 => slides[1 - j] += by,
                    axis => x[j][axis] += by,
                }
                energy(&x, &slides)
            };
            let row = |k: usize| if k == 2 { 2 * (1 - j) } else { 2 * j + k };
            for k in 0..3 {
                let ((up, plus), (down, minus)) = (moved(k, h), moved(k, -h));
                let slope = (up - down) / (2.0 * h);
                prop_assert!((slope - s.gradient[row(k)]).abs() < 1e-4, "{slope} {}", s.gradient[row(k)]);
                for i in 0..3 {
                    let bend = (plus.gradient[row(i)] - minus.gradient[row(i)]) / (2.0 * h);
                    let own = s.hessian.get(row(i).max(row(k)), row(i).min(row(k)));
                    prop_assert!((bend - own).abs() < 1e-3 * (1.0 + own.abs()), "{i} {k}: {bend} {own}");
                }
            }
        }
    }
}
