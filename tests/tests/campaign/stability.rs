//! A rest is stable: cable that slides over a smooth pulley either way is drawn back.
//!
//! With the spans between the supports known in closed form ([`free_span`]), the energy's slope in
//! the material at a pulley is ψ(T after) − ψ(T before), ψ = T + T²/2EA; its matrix of second
//! derivatives, by differences, must have positive pivots.

use cable_core::scene::{Cable, Scene, Shape, SupportKind};
use cable_core::solution::CableSolution;

use crate::closed::free_span;
use crate::judge::body;

/// Material by which a pulley's place is changed, of the length.
const CHANGE: f64 = 1e-5;
/// A pivot that is less than nothing by no more than this, of the largest entry, is the rounding of
/// differences.
const ROUNDING: f64 = 1e-4;

/// Radius of a post beside the spans next to it up to which it counts as a point.
const SLENDER: f64 = 0.02;

/// A point on which the cable hangs: where, the material there (m), and its name if the cable
/// slides over it.
struct Point {
    at: [f64; 2],
    material: f64,
    slides: Option<String>,
}

/// The points on which the cable hangs; None where something else holds it.
fn points(scene: &Scene, cable: &Cable, found: &CableSolution) -> Option<Vec<Point>> {
    let mut out = Vec::new();
    for (s, r) in cable.supports.iter().zip(&found.supports) {
        let smooth_point = s.radius_m.is_none_or(|r| r == 0.0) && s.friction.unwrap_or(0.0) == 0.0;
        let slides = match s.kind {
            SupportKind::Fixed => None,
            SupportKind::Pulley if smooth_point => Some(s.name.clone()),
            _ => return None,
        };
        out.push(Point { at: [r.x_m, r.y_m], material: r.arc_length_m, slides });
    }
    let mut widest = 0.0;
    for c in &found.contacts {
        let o = scene.obstacles.iter().find(|o| o.name == c.obstacle)?;
        let Shape::Circle { radius_m, .. } = o.shape else { return None };
        if o.friction != Some(0.0) {
            return None;
        }
        widest = f64::max(widest, radius_m);
        out.push(Point { at: [c.x_m, c.y_m], material: c.arc_length_m, slides: Some(o.name.clone()) });
    }
    out.sort_by(|a, b| a.material.total_cmp(&b.material));
    let apart = |w: &[Point]| (w[1].at[0] - w[0].at[0]).hypot(w[1].at[1] - w[0].at[1]);
    out.windows(2).all(|w| widest <= SLENDER * apart(w)).then_some(out)
}

/// Says where the cable of a scene runs away at the least push; None where it does not, or where
/// this file does not know: it knows cables that touch nothing but smooth points and thin posts.
pub fn runs_away(scene: &Scene, cable: &Cable, found: &CableSolution) -> Option<String> {
    let points = points(scene, cable, found)?;
    let n = points.len();
    if n < 3 || !scene.loads.is_empty() || cable.bending_stiffness_n_m2 > 0.0 {
        return None;
    }
    let at: Vec<[f64; 2]> = points.iter().map(|p| p.at).collect();
    let s: Vec<f64> = points.iter().map(|p| p.material).collect();
    let load = body(scene, cable);
    let psi = |f: [f64; 2]| {
        let t = f[0].hypot(f[1]);
        t + 0.5 * t * t / cable.axial_stiffness_n
    };
    // ψ at both ends of each span, with the material at the supports.
    let slopes = |s: &[f64]| -> Option<Vec<f64>> {
        let ends: Option<Vec<[f64; 2]>> = (1..n)
            .map(|k| {
                let [a, b] = free_span([at[k - 1], at[k]], s[k] - s[k - 1], load, cable.axial_stiffness_n)?;
                Some([psi(a), psi(b)])
            })
            .collect();
        let ends = ends?;
        Some((1..n - 1).map(|k| ends[k][0] - ends[k - 1][1]).collect())
    };
    let change = CHANGE * cable.length_m;
    let mut matrix: Vec<Vec<f64>> = Vec::new();
    for k in 1..n - 1 {
        let moved = |by: f64| {
            let mut there = s.clone();
            there[k] += by;
            slopes(&there)
        };
        let (more, less) = (moved(change)?, moved(-change)?);
        matrix.push(more.iter().zip(&less).map(|(a, b)| (a - b) / (2.0 * change)).collect());
    }
    // Held in the middle it cannot slide there.
    let slides: Vec<usize> = (1..n - 1).filter(|k| points[*k].slides.is_some()).collect();
    let largest = matrix.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    let mut kept: Vec<Vec<f64>> =
        slides.iter().map(|a| slides.iter().map(|b| matrix[b - 1][a - 1]).collect()).collect();
    for k in 0..kept.len() {
        if kept[k][k] < -ROUNDING * largest {
            let name = points[slides[k]].slides.as_deref().unwrap_or_default();
            return Some(format!("{name} draws the cable over, {:.3e} N/m", kept[k][k]));
        }
        for i in k + 1..kept.len() {
            let factor = kept[i][k] / kept[k][k];
            for j in k..kept.len() {
                kept[i][j] -= factor * kept[k][j];
            }
        }
    }
    None
}
