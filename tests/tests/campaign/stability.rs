//! A rest is stable: cable that slides over a smooth pulley either way is drawn back.
//!
//! With the spans between the supports known in closed form ([`free_span`]), the energy's slope in
//! the material at a pulley is ψ(T after) − ψ(T before), ψ = T + T²/2EA; its matrix of second
//! derivatives, by differences, must have positive pivots.

use cable_core::scene::{Cable, Scene, SupportKind};
use cable_core::solution::CableSolution;

use crate::closed::free_span;
use crate::judge::body;

/// Material by which a pulley's place is changed, of the length.
const CHANGE: f64 = 1e-5;
/// A pivot that is less than nothing by no more than this, of the largest entry, is the rounding of
/// differences.
const ROUNDING: f64 = 1e-4;

/// Says where the cable of a scene runs away at the least push; None where it does not, or where
/// this file does not know: it knows cables that touch nothing but smooth points.
pub fn runs_away(scene: &Scene, cable: &Cable, found: &CableSolution) -> Option<String> {
    let point = |k: usize| {
        let s = &cable.supports[k];
        match s.kind {
            SupportKind::Fixed => true,
            SupportKind::Pulley => s.radius_m.is_none_or(|r| r == 0.0) && s.friction.unwrap_or(0.0) == 0.0,
            _ => false,
        }
    };
    let n = cable.supports.len();
    let simple = scene.loads.is_empty() && found.contacts.is_empty() && cable.bending_stiffness_n_m2 == 0.0;
    if n < 3 || !simple || !(0..n).all(point) {
        return None;
    }
    let at: Vec<[f64; 2]> = found.supports.iter().map(|s| [s.x_m, s.y_m]).collect();
    let s: Vec<f64> = found.supports.iter().map(|s| s.arc_length_m).collect();
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
    let slides: Vec<usize> = (1..n - 1).filter(|k| cable.supports[*k].kind == SupportKind::Pulley).collect();
    let largest = matrix.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    let mut kept: Vec<Vec<f64>> =
        slides.iter().map(|a| slides.iter().map(|b| matrix[b - 1][a - 1]).collect()).collect();
    for k in 0..kept.len() {
        if kept[k][k] < -ROUNDING * largest {
            return Some(format!("{} draws the cable over, {:.3e} N/m", cable.supports[slides[k]].name, kept[k][k]));
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
