//! A job maps where the robot, or an end of a cable, can be taken.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use cable_core::analysis::safe_reach::area::{self, Area};
use cable_core::analysis::safe_reach::line::{self, ReachMap, Trip};
use cable_core::math::Point;
use cable_core::scene::SupportKind;
use cable_core::{Scene, Settings, Solution};

use crate::jobs::background;
use crate::units::sentence::sentence;

/// Number of places of a robot that are tried. More: the map is finer but, with the way back from
/// each, slower by the square; fewer: mounds fall between them.
pub const ROBOT_PLACES: usize = 41;

/// Fewest and most places of an end side by side.
pub const PLACES_ACROSS_RANGE: [usize; 2] = [8, 96];

/// The ways back are followed from one place in so many in both directions: that takes as much work
/// as the places themselves, not thirty times as much.
const RETURN_COARSENING: f64 = 2.0;

/// Least progress, as a share, before the map is drawn again: if it were less, drawing would take
/// longer than the search.
const MIN_PROGRESS_STEP: f64 = 0.01;

/// The thing that is taken somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReachSubject {
    /// The robot, along its ground.
    Robot,
    /// A support, through free space.
    Support {
        /// Index of the cable.
        cable: usize,
        /// Index of the support.
        support: usize,
    },
}

/// The choice of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SafeReachOptions {
    /// The item that is moved; None: the robot, else the selection, else a support that moves, else
    /// an end.
    pub moved: Option<ReachSubject>,
    /// The trip whose tensions are shown.
    pub trip: Trip,
    /// Places of an end side by side.
    pub across: usize,
}

impl Default for SafeReachOptions {
    fn default() -> Self {
        Self { moved: None, trip: Trip::There, across: 24 }
    }
}

/// The state of the search.
#[derive(Clone, Debug, Default)]
pub struct SafeReachState {
    /// The choice of the user.
    pub choice: SafeReachOptions,
    /// Its progress.
    pub progress: Progress,
    /// The time at which the search began.
    pub began: Option<Instant>,
    /// The share of a search that was stopped, 0 to 1: the map is what was found until then.
    pub stopped: Option<f64>,
}

/// Least completed fraction from which the remaining time is estimated. At a smaller fraction, the
/// first places, which are solved without a neighbour, are not representative.
const FIRST_ESTIMATE: f64 = 0.04;

/// Returns the time that the rest of a search will take, s, from the time that a share of it took;
/// None if the share is too small to tell.
#[must_use]
pub fn remaining_s(share: f64, elapsed_s: f64) -> Option<f64> {
    (FIRST_ESTIMATE..=1.0).contains(&share).then(|| elapsed_s * (1.0 - share) / share)
}

/// The question of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct SafeReachQuery {
    /// The scene.
    pub scene: Scene,
    /// The present state of the cables, if time has run.
    pub now: Option<Arc<Solution>>,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// The thing that is taken somewhere.
    pub moved: ReachSubject,
    /// Lower left and upper right corner of the region that is searched, m.
    pub corners_m: [Point; 2],
    /// Places of an end side by side.
    pub across: usize,
}

/// The findings.
#[derive(Clone, Debug)]
pub enum ReachMaps {
    /// The map of a robot.
    Line(Arc<ReachMap>),
    /// The map of an end: its places, and those of the way there and back, once that is begun.
    Area(Arc<Area>, Option<Arc<Area>>),
}

impl ReachMaps {
    /// Service and breaking tension, N.
    #[must_use]
    pub fn limits_n(&self) -> [f64; 2] {
        match self {
            Self::Line(map) => [map.service_n, map.breaking_n],
            Self::Area(area, _) => [area.service_n, area.breaking_n],
        }
    }
}

/// The map, and the scene it is of.
pub type Outcome = (ReachMaps, Arc<Scene>);
/// Its progress.
pub type Progress = background::Progress<Outcome>;
/// A map being computed.
pub type Job = background::Job<Outcome>;

impl SafeReachState {
    /// Ends the search and keeps its map; without a search, drops the map.
    pub fn stop_or_clear(&mut self) {
        let before = std::mem::take(&mut self.progress);
        (self.began, self.stopped) = (None, None);
        if let Progress::Running(share, Some(found)) = before {
            (self.progress, self.stopped) = (Progress::Done(found), Some(share));
        }
    }

    /// Returns how much longer the search takes, s, as far as that can be told.
    #[must_use]
    pub fn remaining_s(&self) -> Option<f64> {
        let Progress::Running(share, _) = self.progress else { return None };
        remaining_s(share, self.began?.elapsed().as_secs_f64())
    }

    /// The map, as far as it is known.
    #[must_use]
    pub fn found(&self) -> Option<&Outcome> {
        match &self.progress {
            Progress::Done(found) => Some(found),
            Progress::Running(_, so_far) => so_far.as_ref(),
            Progress::None | Progress::Failed(_) => None,
        }
    }
}

/// Starts a job; `shown` is called whenever there is a new result to show.
#[must_use]
pub fn start(query: SafeReachQuery, shown: impl Fn() + Send + 'static) -> Job {
    Job::start("safe reach", move |listen| find(query, listen), shown)
}

/// Finds the safe reach, and tells the listener about maps that are not yet complete.
fn find(query: SafeReachQuery, listen: background::Listener<'_, Outcome>) -> Result<Outcome, String> {
    let scene = Arc::new(query.scene);
    let mut progress = -MIN_PROGRESS_STEP;
    let mut tell = |share: f64, maps: &dyn Fn() -> ReachMaps| {
        if share < progress + MIN_PROGRESS_STEP {
            return ControlFlow::Continue(());
        }
        progress = share;
        listen(share, Some((maps(), Arc::clone(&scene))))
    };
    let maps = match query.moved {
        ReachSubject::Robot => {
            let ends_m = query.corners_m.map(|p| p[0]);
            let progress = |map: &ReachMap, _: f64| tell(known_share(map), &|| ReachMaps::Line(Arc::new(map.clone())));
            let map = line::robot_reach(&scene, query.now.as_deref(), query.settings, ends_m, ROBOT_PLACES, progress)
                .map_err(|e| sentence(&e))?;
            ReachMaps::Line(Arc::new(map))
        }
        ReachSubject::Support { cable, support } => {
            let [low, high] = query.corners_m;
            let spacing_m =
                (high[0] - low[0]) / query.across.clamp(PLACES_ACROSS_RANGE[0], PLACES_ACROSS_RANGE[1]) as f64;
            let (now, settings, corners_m) = (query.now, query.settings, query.corners_m);
            let ask = area::ReachQuery {
                scene: (*scene).clone(),
                now,
                settings,
                cable,
                support,
                corners_m,
                spacing_m,
                back: false,
            };
            let progress =
                |area: &Area, share: f64| tell(0.5 * share, &|| ReachMaps::Area(Arc::new(area.clone()), None));
            let there = Arc::new(area::area(&ask, progress).map_err(|e| sentence(&e))?);
            let ask = area::ReachQuery { spacing_m: RETURN_COARSENING * spacing_m, back: true, ..ask };
            let progress = |area: &Area, share: f64| {
                tell(0.5 + 0.5 * share, &|| ReachMaps::Area(Arc::clone(&there), Some(Arc::new(area.clone()))))
            };
            let back = area::area(&ask, progress).map_err(|e| sentence(&e))?;
            ReachMaps::Area(there, Some(Arc::new(back)))
        }
    };
    Ok((maps, scene))
}

/// The share of a robot's places that is known, 0 to 1: the way there is one half, the way back the
/// other. Lengths of ways say less, because most ways back are not gone.
fn known_share(map: &ReachMap) -> f64 {
    let back = map.places.iter().filter(|p| !p.there_and_back_n.is_nan()).count();
    0.5 * (map.places.len() + back) as f64 / ROBOT_PLACES as f64
}

/// All things whose reach can be searched.
#[must_use]
pub fn movable(scene: &Scene) -> Vec<ReachSubject> {
    let hangs = |kind| scene.cables.iter().flat_map(|c| &c.supports).any(|s| s.kind == kind);
    let robot = (scene.robot.is_some() && hangs(SupportKind::Robot)).then_some(ReachSubject::Robot);
    let supports = scene.cables.iter().enumerate().flat_map(|(cable, c)| {
        let placed = c.supports.iter().enumerate().filter(|(_, s)| s.at_m.is_some());
        placed.map(move |(support, _)| ReachSubject::Support { cable, support })
    });
    robot.into_iter().chain(supports).collect()
}

/// The thing in words.
#[must_use]
pub fn name(scene: &Scene, moved: ReachSubject) -> String {
    match moved {
        ReachSubject::Robot => "Robot, along the ground".to_owned(),
        ReachSubject::Support { cable, support } => {
            let of = scene.cables.get(cable);
            let s = of.and_then(|c| c.supports.get(support)).map_or("?", |s| &s.name);
            format!("Support {s} of {}", of.map_or("?", |c| &c.name))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_from_the_share() {
        assert_eq!(remaining_s(0.25, 10.0), Some(30.0));
        assert_eq!(remaining_s(1.0, 10.0), Some(0.0));
        assert_eq!(remaining_s(0.01, 10.0), None);
        assert_eq!(remaining_s(f64::NAN, 10.0), None);
    }
}
