//! A summary holds the figures of an answer that an engineer reads first: forces and angles at the
//! ends, lying and hanging lengths, sag, the range of tensions, the share of each limit that is
//! used, and the balance of all forces.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | [`CableSummary`] |
//! | `places.rs` | tensions, depths and touchdowns with their places |
//! | `shape.rs` | sag, heights, lengths, touchdowns |
//! | `balance.rs` | the sum of all forces on a cable |
//! | `friction_use.rs` | the share of its friction that each contact uses |
//!
//! Everything is read from a scene and an answer, so that it is the same for every model; command
//! line, JSON and window only write it down. Accuracy is that of the answer's nodes: of a free span
//! they leave its line by 1e-5 of its length at most.

mod balance;
mod friction_use;
mod places;
mod shape;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use crate::math::Vec2;
use crate::scene::{Cable, Scene, View};
use crate::solution::{Bend, CableSolution, JudgedBend, Node, Pressure, Solution};

pub use balance::ForceBalance;
pub use friction_use::FrictionUse;
pub use places::{CablePlace, Sag, TensionAt, TouchKind, Touchdown};
pub use shape::{sag, stretched_length_m};

/// The figures of one cable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CableSummary {
    /// The cable's name.
    pub cable: String,
    /// Its start and its end.
    pub ends: Vec<EndForce>,
    /// The greatest tension.
    pub greatest_tension: TensionAt,
    /// The least.
    pub least_tension: TensionAt,
    /// Unstretched length at rest temperature, m.
    pub length_m: f64,
    /// Length as strained and heated, m.
    pub stretched_length_m: f64,
    /// Unstretched length that lies on ground and other obstacles, m; all of it in a plan view.
    pub lying_m: f64,
    /// The rest of the cable, m, which hangs, stands or runs over wheels.
    pub suspended_m: f64,
    /// Places at which it comes down on something or leaves it, in order of arc length.
    pub touchdowns: Vec<Touchdown>,
    /// Greatest depth below the straight line between neighbouring supports (in a plan view:
    /// distance from the line), m; `None` if no two supports are apart.
    pub sag: Option<Sag>,
    /// Its lowest point.
    pub lowest: CablePlace,
    /// Its highest point.
    pub highest: CablePlace,
    /// The sharpest bend of its line; None = nearly straight.
    pub tightest_bend: Option<Bend>,
    /// The sharpest bend where a support or obstacle guides the cable, as its bending stiffness
    /// allows; `None` if the cable is not guided.
    pub judged_bend: Option<JudgedBend>,
    /// Place at which it is pressed hardest against what leads it round.
    pub sidewall_pressure: Option<Pressure>,
    /// Used part of each limit.
    pub utilisation: Utilisation,
    /// Mobilised fraction of the friction of the contacts; `None` if no contact has friction.
    pub friction: Option<FrictionUse>,
    /// Sum of all forces on the cable; `None` in a plan view with a floor that has friction, as no
    /// answer holds the force of the floor.
    pub balance: Option<ForceBalance>,
}

/// State at an end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EndForce {
    /// The support's name.
    pub support: String,
    /// Tension, N.
    pub tension_n: f64,
    /// Horizontal part of the force of the cable on what holds it, N: positive to the right.
    pub horizontal_n: f64,
    /// Vertical part, N: positive upwards.
    pub vertical_n: f64,
    /// The direction in which the cable leaves the end, °, anticlockwise from the right; `None` if
    /// it is not known.
    pub angle_deg: Option<f64>,
    /// The angle of that direction above the horizontal, °, from −90 (straight down) to 90
    /// (straight up).
    pub elevation_deg: Option<f64>,
}

/// Figures over their limits: 1 = the limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Utilisation {
    /// Greatest tension over service tension.
    pub service_tension_ratio: f64,
    /// Greatest tension over breaking tension.
    pub breaking_tension_ratio: f64,
    /// Smallest allowed bend radius over that of the sharpest judged bend, or of the sharpest free
    /// one if that is sharper; None where none is stated.
    pub bend_radius_ratio: Option<f64>,
    /// Ratio of the sidewall pressure to its limit; `None` if no limit is stated.
    pub sidewall_pressure_ratio: Option<f64>,
}

/// The figures of all cables of a scene.
#[must_use]
pub fn summaries(scene: &Scene, solution: &Solution) -> Vec<CableSummary> {
    let cables = scene.cables.iter().zip(&solution.cables);
    cables.map(|(cable, answer)| summary(scene, cable, answer, solution.time_s)).collect()
}

/// The figures of one cable of a scene at a time (s).
#[must_use]
pub fn summary(scene: &Scene, cable: &Cable, answer: &CableSolution, time_s: f64) -> CableSummary {
    let (least, greatest) = tensions(answer);
    let (lowest, highest) = shape::heights(answer);
    let lying_m = match scene.view {
        View::Plan => cable.length_m,
        View::Elevation => shape::lying_m(cable, answer),
    };
    let tension_n = greatest.tension_n;
    let stated = |limit: f64| (limit > 0.0).then_some(limit);
    // The sharpest of the line counts where nothing leads the cable: led bends are judged by its
    // stiffness.
    let bends = [answer.judged_bend.map(|b| b.bend.radius_m), answer.free_bend.map(|b| b.radius_m)];
    let sharpest = bends.into_iter().flatten().reduce(|a, b| if b < a { b } else { a });
    CableSummary {
        cable: cable.name.clone(),
        ends: ends(cable, answer),
        greatest_tension: greatest,
        least_tension: least,
        length_m: cable.length_m,
        stretched_length_m: stretched_length_m(
            answer,
            answer.unstretched_length_m.map_or_else(|| thermal_stretch(scene, cable), |now| now / cable.length_m),
        ),
        lying_m,
        suspended_m: cable.length_m - lying_m,
        touchdowns: shape::touchdowns(cable, answer),
        sag: sag(cable, answer, scene.view),
        lowest,
        highest,
        tightest_bend: answer.tightest_bend,
        judged_bend: answer.judged_bend,
        sidewall_pressure: answer.sidewall_pressure,
        utilisation: Utilisation {
            service_tension_ratio: tension_n / cable.service_tension_n,
            breaking_tension_ratio: tension_n / cable.breaking_tension_n,
            bend_radius_ratio: stated(cable.min_bend_radius_m).map(|least| sharpest.map_or(0.0, |r| least / r)),
            sidewall_pressure_ratio: cable
                .sidewall_limit_n_per_m
                .map(|most| answer.sidewall_pressure.map_or(0.0, |p| p.pressure_n_per_m / most)),
        },
        friction: friction_use::friction_use(scene, cable, answer),
        balance: balance::balance(scene, cable, answer, time_s),
    }
}

/// 1 + αΔT.
fn thermal_stretch(scene: &Scene, cable: &Cable) -> f64 {
    1.0 + cable.thermal_expansion_per_k * scene.environment.temperature_change_k
}

/// The least and the greatest tension; zero without nodes.
fn tensions(answer: &CableSolution) -> (TensionAt, TensionAt) {
    let at = |n: &Node| TensionAt { tension_n: n.tension_n, at: CablePlace::of(n) };
    let Some(first) = answer.nodes.first().map(at) else { return Default::default() };
    answer.nodes.iter().map(at).fold((first, first), |(least, most), t| {
        (if t.tension_n < least.tension_n { t } else { least }, if t.tension_n > most.tension_n { t } else { most })
    })
}

/// The forces at both ends of a cable.
fn ends(cable: &Cable, answer: &CableSolution) -> Vec<EndForce> {
    let last = cable.supports.len().saturating_sub(1);
    let nodes: [Option<[&Node; 2]>; 2] = match answer.nodes.as_slice() {
        [] | [_] => [None, None],
        [a, b] => [Some([a, b]), Some([b, a])],
        [a, b, .., c, d] => [Some([a, b]), Some([d, c])],
        [a, b, c] => [Some([a, b]), Some([c, b])],
    };
    [(0, nodes[0]), (last, nodes[1])]
        .into_iter()
        .filter_map(|(k, nodes)| {
            let r = answer.supports.get(k)?;
            let force = Vec2::new(r.reaction_x_n, r.reaction_y_n);
            let way =
                if cable.bending_stiffness_n_m2 > 0.0 { nodes.and_then(leaves) } else { force.try_normalize(0.0) };
            Some(EndForce {
                support: r.name.clone(),
                tension_n: nodes.map_or(0.0, |n| n[0].tension_n),
                horizontal_n: force.x,
                vertical_n: force.y,
                angle_deg: way.map(|t| t.y.atan2(t.x).to_degrees()),
                elevation_deg: way.map(|t| t.y.atan2(t.x.abs()).to_degrees()),
            })
        })
        .collect()
}

/// The direction in which a stiff cable leaves an end. With the curvature linear between two nodes
/// ds apart, the chord is turned from the tangent at the first by ds (κ₁/3 + κ₂/6), whichever way
/// arc length grows.
fn leaves([end, next]: [&Node; 2]) -> Option<Vec2> {
    let chord = (next.at() - end.at()).try_normalize(0.0)?;
    let ds = next.arc_length_m - end.arc_length_m;
    let (sin, cos) = (-ds * (end.curvature_per_m / 3.0 + next.curvature_per_m / 6.0)).sin_cos();
    Some(Vec2::new(cos * chord.x - sin * chord.y, sin * chord.x + cos * chord.y))
}
