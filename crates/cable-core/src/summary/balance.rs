//! The force balance checks whether the forces on a whole cable add up to zero.

use serde::{Deserialize, Serialize};

use super::shape::is_of_obstacle;
use crate::math::Vec2;
use crate::problem::TimeSeries;
use crate::scene::{Cable, Scene, SupportKind, View};
use crate::solution::CableSolution;

/// Distance within which a place is that of a support, as a fraction of the cable's length:
/// round-off. Smaller: what hangs there is counted twice; larger: what hangs beside it, never.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// The forces on a cable, N, right and up. In motion what is left is what accelerates it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceBalance {
    /// Of its supports, dead loads and lumps at its ends among them.
    pub supports_n: [f64; 2],
    /// Of the obstacles.
    pub contacts_n: [f64; 2],
    /// Of its point loads.
    pub loads_n: [f64; 2],
    /// Its weight and wind.
    pub weight_n: [f64; 2],
    /// The sum.
    pub residual_n: [f64; 2],
    /// Size of the sum over that of the largest force above.
    pub relative_residual: f64,
}

/// The balance of a cable at a time (s).
pub(super) fn balance(scene: &Scene, cable: &Cable, answer: &CableSolution, time_s: f64) -> Option<ForceBalance> {
    let environment = &scene.environment;
    let weight_per_m = cable.linear_density_kg_per_m * environment.gravity_m_per_s2;
    if scene.view == View::Plan && weight_per_m > 0.0 && cable.friction > 0.0 {
        return None;
    }
    let weight = if scene.view == View::Plan { Vec2::zeros() } else { Vec2::new(0.0, -weight_per_m) };
    let wind = series(Some(environment.wind_n_per_m), &environment.wind_times_s, &environment.winds_n_per_m).at(time_s);
    let weight = (weight + wind) * cable.length_m;
    let mut largest = weight.norm();
    let mut sum = |forces: &mut dyn Iterator<Item = Vec2>| {
        forces.fold(Vec2::zeros(), |sum, f| {
            largest = if f.norm() > largest { f.norm() } else { largest };
            sum + f
        })
    };
    let supports = sum(&mut answer.supports.iter().map(|s| -Vec2::new(s.reaction_x_n, s.reaction_y_n)));
    let contacts = sum(&mut answer.contacts.iter().filter(|c| is_of_obstacle(cable, c)).map(|c| Vec2::from(c.force_n)));
    let loads = scene.loads.iter().filter(|l| l.cable == cable.name && !hangs_at_a_support(cable, l.arc_length_m));
    let loads = sum(&mut loads.map(|l| series(l.force_n, &l.times_s, &l.forces_n).at(time_s)));
    let residual = supports + contacts + loads + weight;
    Some(ForceBalance {
        supports_n: supports.into(),
        contacts_n: contacts.into(),
        loads_n: loads.into(),
        weight_n: weight.into(),
        residual_n: residual.into(),
        relative_residual: if largest > 0.0 { residual.norm() / largest } else { 0.0 },
    })
}

/// Returns whether a point load acts where a support is a dead load or free: the force of that
/// support includes all loads there.
fn hangs_at_a_support(cable: &Cable, arc_length_m: f64) -> bool {
    let last = cable.supports.len().saturating_sub(1);
    cable.supports.iter().enumerate().any(|(k, s)| {
        let at = match k {
            0 => Some(0.0),
            k if k == last => Some(cable.length_m),
            _ => s.arc_length_m,
        };
        matches!(s.kind, SupportKind::Load | SupportKind::Free)
            && at.is_some_and(|a| (a - arc_length_m).abs() <= SAME_POINT_FRACTION * cable.length_m)
    })
}

fn series(force: Option<[f64; 2]>, times: &[f64], forces: &[[f64; 2]]) -> TimeSeries {
    match force {
        _ if !times.is_empty() => TimeSeries::new(times, forces),
        Some(f) => TimeSeries::constant(Vec2::from(f)),
        None => TimeSeries::default(),
    }
}
