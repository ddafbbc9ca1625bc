//! This analysis finds the places to which a hand or a crane can take an end of a cable in the free
//! plane.
//!
//! The end is moved outwards from its present position from place to place of a grid
//! (`exploration.rs`), each on the shortest way that passes no obstacle, first on a coarse grid and
//! then on finer ones. Each place continues from the cable at the place before, with the friction
//! and the wraps of that way. The way back is the same way.
//!
//! | room | content |
//! |---|---|
//! | `exploration.rs` | the end moves from place to place of a grid, outwards |
//! | `map.rs` | the greatest tension for each place of the grid |

mod exploration;
mod map;

use std::ops::ControlFlow;

use exploration::Exploration;
pub use map::{Area, ReachQuery};

use super::{frozen_scene, least, place_cables, unsupported};
use crate::any_error::Error;
use crate::contact::World;
use crate::error::UnsupportedReach;
use crate::math::{larger, vec2};
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::scene::{Scene, Support, SupportKind};
use crate::simulation::Simulation;

/// Length of a bar of slack cable in finite elements, m. Larger: nodes catch on rough ground and
/// cause thousands of newtons that no real cable has (0.6 m over ground of 0.23 m: 800 kN), and the
/// cable is laid anew more often; smaller: each step of a heap of slack takes longer (0.2 m on the
/// tank: 2.5 times as long).
const SLACK_ELEMENT_M: f64 = 0.4;

/// Maximum number of places: more would be a mistake of the unit.
const MAX_PLACES: usize = 100_000;

/// Greatest distance that is tried, as a fraction of the cable's length: more than any cable
/// stretches before it breaks.
const REACH_FACTOR: f64 = 1.1;

/// Answers all places; `progress` receives the map so far and the completed fraction (0 to 1), and
/// can end the analysis.
///
/// # Errors An error if the scene is invalid, the support has no position, or the start has no
/// answer.
pub fn area(query: &ReachQuery, mut progress: impl FnMut(&Area, f64) -> ControlFlow<()>) -> Result<Area, Error> {
    let (mut exploration, simulation) = begin(query)?;
    // If it is ended early, the map so far is the answer.
    exploration.spread(simulation, &mut progress);
    Ok(exploration.found)
}

/// The search before its first step, and the cable as it is laid.
fn begin(query: &ReachQuery) -> Result<(Exploration<'_>, Simulation), Error> {
    let still = without_robot(&frozen_scene(&query.scene, query.now.as_deref()))?;
    let cable = still.cables.get(query.cable).ok_or_else(|| unsupported(UnsupportedReach::NoSuchCable))?;
    let start = cable.supports.get(query.support).and_then(|s| s.at_m);
    let start = vec2(start.ok_or_else(|| unsupported(UnsupportedReach::SupportWithoutPlace))?);
    if !(query.spacing_m > 0.0 && query.corners_m.iter().flatten().all(|v| v.is_finite())) {
        return Err(unsupported(UnsupportedReach::EmptyGrid));
    }
    // The start is a place of the grid.
    let before = [0, 1].map(|k| ((start[k] - query.corners_m[0][k]) / query.spacing_m).floor().max(0.0));
    let after = [0, 1].map(|k| ((query.corners_m[1][k] - start[k]) / query.spacing_m).floor().max(0.0));
    let [columns, rows] = [0, 1].map(|k| (before[k] + after[k]) as usize + 1);
    if columns.saturating_mul(rows) > MAX_PLACES {
        return Err(unsupported(UnsupportedReach::GridTooLarge));
    }
    let found = Area {
        origin_m: [0, 1].map(|k| start[k] - before[k] * query.spacing_m),
        spacing_m: query.spacing_m,
        columns,
        most_n: vec![f64::NAN; columns * rows],
        guessed: vec![false; columns * rows],
        start_m: [start.x, start.y],
        service_n: least(&query.scene, &[query.cable], |c| c.service_tension_n),
        breaking_n: least(&query.scene, &[query.cable], |c| c.breaking_tension_n),
    };
    let other_supports = cable.supports.iter().enumerate().filter(|(k, _)| *k != query.support);
    let radius_m = 0.5 * cable.diameter_m;
    let exploration = Exploration {
        query,
        world: World::new(&still.obstacles, cable.friction, radius_m),
        holds: other_supports.filter_map(|(_, s)| s.at_m.map(vec2)).collect(),
        far_m: cable.length_m * REACH_FACTOR,
        first: before[1] as usize * columns + before[0] as usize,
        free: Vec::new(),
        known: vec![false; found.most_n.len()],
        settled: vec![false; found.most_n.len()],
        beyond: vec![false; found.most_n.len()],
        parents: vec![None; found.most_n.len()],
        found,
    };
    let question = Question::History(Inertia::QuasiStatic);
    let bars = still.cables.iter().map(|c| (c.length_m / SLACK_ELEMENT_M).ceil()).fold(1.0, larger);
    let segments = Some(query.settings.segments.unwrap_or(bars as usize));
    let settings = Settings { segments, breaks: false, ..query.settings };
    let mut simulation = Simulation::for_question(still.clone(), Model::Auto, settings, question)?;
    place_cables(&mut simulation, query.now.as_deref())?;
    Ok((exploration, simulation))
}

/// The scene without its robot: the end that hangs on the robot is held instead.
fn without_robot(scene: &Scene) -> Result<Scene, Error> {
    let mut scene = scene.clone();
    let hitch = scene.hitch_m();
    for support in scene.cables.iter_mut().flat_map(|c| &mut c.supports).filter(|s| s.kind == SupportKind::Robot) {
        let at = hitch.ok_or_else(|| unsupported(UnsupportedReach::HitchWithoutRobot))?;
        *support = Support { arc_length_m: support.arc_length_m, ..Support::fixed(support.name.clone(), at) };
    }
    scene.robot = None;
    Ok(scene)
}

#[cfg(test)]
mod tests;
