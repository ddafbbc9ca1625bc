//! This analysis finds the places that a robot can reach along its ground.
//!
//! The robot is placed on its tracks, place after place; its outline is an obstacle for its cable.
//! Drive, slope and traction do not limit it here: `robot::Vehicle` answers whether the robot could
//! pull so hard.

use std::ops::ControlFlow;

use super::{STEP_S, UNREACHABLE_FACTOR, frozen_scene, least, place_cables, unsupported};
use crate::any_error::Error;
use crate::error::{SolveError, UnsupportedReach};
use crate::math::{Point, larger, smaller};
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::problem::robot_outline::OUTLINE_NAME;
use crate::robot;
use crate::scene::preset::robot_preset;
use crate::scene::{Scene, SupportKind};
use crate::simulation::Simulation;
use crate::solution::Solution;

/// Longest way between two answers, m. Larger: an edge that the cable slips over is missed;
/// smaller: more answers.
const STEP_M: f64 = 0.05;

/// Distance (m) by which the robot may fall short of a step without being stopped by the cable.
const MAX_SHORTFALL_M: f64 = 1e-3;

/// Speed (m/s) of a step with inertia, which is taken if a pushed heap of slack cable has no
/// equilibrium and topples. Larger: its swing shows in the tension; smaller: more time.
const PUSH_SPEED_M_PER_S: f64 = 0.3;

/// Time for which a stopped robot goes on pushing before it counts as jammed, s. Smaller: cable
/// that is still falling out of its way counts as jamming it; larger: more time. Cable that does
/// not move in this time has no equilibrium either: in the opening scene relaxing it took 60 s
/// without success.
const PUSH_TIME_S: f64 = 1.0;

/// Strides (in places) with which ways back are computed, one after the other. A smaller first one:
/// longer until the first map; a larger one: no benefit.
const RETURN_STRIDES: [usize; 4] = [8, 4, 2, 1];

/// Difference of tensions within which two places agree, as a fraction of the service tension;
/// between them the larger one counts. Larger: a snag between them is missed; smaller: more ways
/// back.
const AGREEMENT_FRACTION: f64 = 0.02;

/// A place of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachPlace {
    /// Position of the tracks' middle, m.
    pub at_m: Point,
    /// Largest tension with the robot there, N; infinite if the cable does not reach, NaN if no
    /// answer was found.
    pub there_n: f64,
    /// Largest tension on the way there and back, N; infinite if the cable does not reach, NaN if
    /// no answer was found or none is known yet. Between neighbours that agree it is the larger of
    /// theirs.
    pub there_and_back_n: f64,
    /// True if the cable lies in the robot's way there or back and cannot get out of it.
    pub jammed: bool,
}

/// The results at every place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReachMap {
    /// In order of x.
    pub places: Vec<ReachPlace>,
    /// Position at which the robot started, m.
    pub start_x_m: f64,
    /// Service tension, N: the least of all cables that hang on it.
    pub service_n: f64,
    /// Breaking tension, N: the least of all cables that hang on it.
    pub breaking_n: f64,
}

/// A trip of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trip {
    /// To a place.
    There,
    /// To a place and back.
    ThereAndBack,
}

impl ReachPlace {
    /// The greatest tension on a trip to this place, N.
    #[must_use]
    pub fn tension_n(&self, trip: Trip) -> f64 {
        match trip {
            Trip::There => self.there_n,
            Trip::ThereAndBack => self.there_and_back_n,
        }
    }
}

impl ReachMap {
    /// The range (m) in which the robot can make a trip without exceeding a tension (N); None if
    /// the start exceeds it.
    #[must_use]
    pub fn safe_m(&self, tension_n: f64, trip: Trip) -> Option<[f64; 2]> {
        let fits = |p: &ReachPlace| p.tension_n(trip) <= tension_n;
        let start = self.places.iter().position(|p| p.at_m[0] >= self.start_x_m)?;
        self.places.get(start).filter(|p| fits(p))?;
        let right = self.places.iter().skip(start).take_while(|p| fits(p)).last()?;
        let left = self.places.iter().take(start + 1).rev().take_while(|p| fits(p)).last()?;
        Some([left.at_m[0], right.at_m[0]])
    }
}

/// Answers so many places between two, m, starting from the state of `now` if given; `progress`
/// receives the map so far and the completed fraction (0 to 1), and can end the analysis.
///
/// # Errors An error if the scene is invalid, or has no robot with a cable on ground in a side
/// view, or if its start has no answer.
pub fn robot_reach(
    scene: &Scene,
    now: Option<&Solution>,
    settings: Settings,
    [from_m, to_m]: [f64; 2],
    count: usize,
    mut progress: impl FnMut(&ReachMap, f64) -> ControlFlow<()>,
) -> Result<ReachMap, Error> {
    let still = frozen_scene(scene, now);
    let vehicle = still.robot.as_ref().ok_or_else(|| unsupported(UnsupportedReach::NoRobot))?;
    let preset = robot_preset(&vehicle.preset).ok_or_else(|| unsupported(UnsupportedReach::UnknownRobot))?;
    let hangs = |k: &usize| scene.cables[*k].supports.iter().any(|s| s.kind == SupportKind::Robot);
    let cables: Vec<usize> = (0..scene.cables.len()).filter(hangs).collect();
    if cables.is_empty() {
        return Err(unsupported(UnsupportedReach::RobotWithoutCable));
    }
    let ground = scene.robot_ground();
    let start_x_m = vehicle.at_m[0];
    let mut map = ReachMap {
        start_x_m,
        service_n: least(scene, &cables, |c| c.service_tension_n),
        breaking_n: least(scene, &cables, |c| c.breaking_tension_n),
        ..ReachMap::default()
    };
    let question = Question::History(Inertia::QuasiStatic);
    let settings = Settings { breaks: false, ..settings };
    let mut start = Simulation::for_question(still.clone(), Model::Auto, settings, question)?;
    place_cables(&mut start, now)?;
    let walk = Traverse { cables: &cables, limit_n: UNREACHABLE_FACTOR * map.breaking_n };
    let step = (to_m - from_m) / count.saturating_sub(1).max(1) as f64;
    let xs: Vec<f64> = (0..count).map(|k| from_m + step * k as f64).collect();
    let right: Vec<f64> = xs.iter().copied().filter(|x| *x >= start_x_m).collect();
    let left: Vec<f64> = xs.iter().rev().copied().filter(|x| *x < start_x_m).collect();
    // The way there is computed once; every place has its own way back.
    let out_m = right.last().map_or(0.0, |x| x - start_x_m) + left.last().map_or(0.0, |x| start_x_m - x);
    let back_m: f64 = xs.iter().map(|x| (x - start_x_m).abs()).sum();
    let mut gone_m = 0.0;
    let mut progress = |map: &ReachMap, more_m: f64| {
        gone_m += more_m;
        progress(map, (gone_m / (out_m + back_m).max(STEP_M)).min(1.0))
    };
    let stands = |x: f64| vehicle.pose_on(&ground, preset, x).map(|stand| stand.at_m);
    let mut sides = Vec::with_capacity(2);
    for xs in [right, left] {
        match walk.out(&start, &xs, stands, &mut map, &mut progress) {
            ControlFlow::Continue(side) => sides.push(side),
            ControlFlow::Break(()) => return Ok(map),
        }
    }
    // Coarse strides come first.
    for stride in RETURN_STRIDES {
        for side in &mut sides {
            if walk.back(side, stride, &mut map, &mut progress).is_break() {
                return Ok(map);
            }
        }
    }
    Ok(map)
}

/// The reason why the robot got no farther.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Obstruction {
    /// The cable is taut.
    Taut,
    /// The cable lies in its way.
    Jammed,
    /// No answer was found.
    NoAnswer,
}

/// A place on one side of the start, with robot and cable there.
struct VisitedPlace {
    /// Position of its tracks' middle, m.
    at_m: Point,
    /// Target of the robot, m.
    x_m: f64,
    /// The simulation at that place, if the robot got there.
    simulation: Option<Simulation>,
    /// Largest tension on the way there.
    most: Result<f64, Obstruction>,
    /// True if the way back from it is known.
    known: bool,
}

fn value(found: Result<f64, Obstruction>) -> f64 {
    match found {
        Ok(n) => n,
        Err(Obstruction::NoAnswer) => f64::NAN,
        Err(Obstruction::Taut | Obstruction::Jammed) => f64::INFINITY,
    }
}

/// The motion of the robot.
struct Traverse<'a> {
    cables: &'a [usize],
    limit_n: f64,
}

/// A function that receives the progress of a map, and the additional distance, m.
type LineProgress<'a> = &'a mut dyn FnMut(&ReachMap, f64) -> ControlFlow<()>;

impl Traverse<'_> {
    /// Moves from place to place away from the start, and stores the simulation at each for the way
    /// back.
    fn out(
        &self,
        start: &Simulation,
        xs: &[f64],
        stands: impl Fn(f64) -> Option<Point>,
        map: &mut ReachMap,
        progress: LineProgress<'_>,
    ) -> ControlFlow<(), Vec<VisitedPlace>> {
        let (mut there, mut at) = (start.clone(), map.start_x_m);
        let mut most = Ok(there.largest_n(self.cables.iter().copied()));
        let mut side = Vec::with_capacity(xs.len());
        for &x in xs {
            progress(map, (x - at).abs())?;
            let Some(at_m) = stands(x) else { continue };
            most = most.and_then(|m| self.greatest_tension_on_way(&mut there, [at, x]).map(|out| larger(m, out)));
            at = x;
            let place = ReachPlace {
                at_m,
                there_n: value(most.map(|_| there.largest_n(self.cables.iter().copied()))),
                there_and_back_n: f64::NAN,
                jammed: most == Err(Obstruction::Jammed),
            };
            let after = map.places.partition_point(|p| p.at_m[0] < at_m[0]);
            map.places.insert(after, place);
            let simulation = most.is_ok().then(|| there.clone());
            side.push(VisitedPlace { at_m, x_m: x, simulation, most, known: false });
        }
        ControlFlow::Continue(side)
    }

    /// Computes the way back from every place of a stride that is not known yet, except between two
    /// places that agree.
    fn back(
        &self,
        side: &mut [VisitedPlace],
        stride: usize,
        map: &mut ReachMap,
        progress: LineProgress<'_>,
    ) -> ControlFlow<()> {
        let place = |map: &ReachMap, s: &VisitedPlace| map.places.iter().position(|p| p.at_m == s.at_m);
        // The stride is counted from the farthest place, whose way back leads past all others.
        for k in (0..side.len()).rev().step_by(stride) {
            if side[k].known {
                continue;
            }
            let (start_m, x) = (map.start_x_m, side[k].x_m);
            progress(map, (x - start_m).abs())?;
            let beside = |j: Option<usize>| {
                let s = j.and_then(|j| side.get(j)).filter(|s| s.known)?;
                Some(map.places[place(map, s)?])
            };
            let agreed = match (beside(k.checked_sub(stride)), beside(Some(k + stride))) {
                (Some(a), Some(b)) if a.jammed == b.jammed => {
                    let [a_n, b_n] = [a.there_and_back_n, b.there_and_back_n];
                    (a_n == b_n || (a_n - b_n).abs() <= AGREEMENT_FRACTION * map.service_n)
                        .then(|| (larger(a_n, b_n), a.jammed))
                }
                _ => None,
            };
            let (most_n, jammed) = agreed.unwrap_or_else(|| {
                let most = side[k].most;
                let back = match &side[k].simulation {
                    Some(there) => self.greatest_tension_on_way(&mut there.clone(), [x, start_m]),
                    None => most,
                };
                (larger(value(most), value(back)), most == Err(Obstruction::Jammed) || back == Err(Obstruction::Jammed))
            });
            if let Some(p) = place(map, &side[k]).and_then(|j| map.places.get_mut(j)) {
                (p.there_and_back_n, p.jammed) = (most_n, jammed);
            }
            side[k].known = true;
        }
        ControlFlow::Continue(())
    }

    /// Moves the robot from one place to another; returns the largest tension on the way.
    fn greatest_tension_on_way(&self, simulation: &mut Simulation, [from, to]: [f64; 2]) -> Result<f64, Obstruction> {
        let steps = ((to - from).abs() / STEP_M).ceil();
        let mut most = simulation.largest_n(self.cables.iter().copied());
        for k in 1..=steps as usize {
            let x = from + (to - from) * (k as f64 / steps);
            // At places where it cannot stand the cable is moved past.
            let left_m = simulation.place_robot(x, STEP_S, Inertia::QuasiStatic).map_err(|_| Obstruction::NoAnswer)?;
            most = larger(most, simulation.largest_n(self.cables.iter().copied()));
            if is_stopped_by_cable(left_m) {
                self.push_with_inertia(simulation, [x - (to - from) / steps, x])?;
                most = larger(most, simulation.largest_n(self.cables.iter().copied()));
            }
            if !(most <= self.limit_n) {
                return Err(Obstruction::Taut);
            }
        }
        Ok(most)
    }

    /// Takes a step with inertia, against the heap of cable before the robot. Tensions of swings
    /// during the step are ignored, because the speed is arbitrary.
    fn push_with_inertia(&self, simulation: &mut Simulation, [from, to]: [f64; 2]) -> Result<(), Obstruction> {
        let parts = ((to - from).abs() / (PUSH_SPEED_M_PER_S * robot::STEP_S)).ceil();
        let pushes = (PUSH_TIME_S / robot::STEP_S).ceil();
        for k in 1..=(parts + pushes) as usize {
            let x = from + (to - from) * smaller(k as f64 / parts, 1.0);
            let left_m = simulation.place_robot(x, robot::STEP_S, Inertia::Dynamic).map_err(|e| why_stuck(&e))?;
            if k as f64 >= parts && !is_stopped_by_cable(left_m) {
                break;
            }
            if k as f64 == parts + pushes {
                return Err(Obstruction::Jammed);
            }
        }
        // The cable that toppled has come down.
        let rests = simulation.place_robot(to, STEP_S, Inertia::QuasiStatic).map_err(|_| Obstruction::NoAnswer)?;
        if is_stopped_by_cable(rests) { Err(Obstruction::Jammed) } else { Ok(()) }
    }
}

/// Returns whether the cable stops a robot that is so far from its target, m.
fn is_stopped_by_cable(left_m: Option<f64>) -> bool {
    left_m.is_some_and(|m| m > MAX_SHORTFALL_M)
}

/// Returns the reason why a push has no answer: cable squeezed between the robot and a fixed
/// obstacle jams it.
fn why_stuck(error: &SolveError) -> Obstruction {
    match error {
        SolveError::StepFailed { place, .. } if place.near.as_ref().is_some_and(|n| n.name == OUTLINE_NAME) => {
            Obstruction::Jammed
        }
        _ => Obstruction::NoAnswer,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::catalog;

    fn map(change: impl FnOnce(&mut Scene), ends: [f64; 2], count: usize) -> ReachMap {
        let mut scene = catalog::robot_drive();
        change(&mut scene);
        robot_reach(&scene, None, Settings::default(), ends, count, |_, _| ControlFlow::Continue(())).unwrap()
    }

    #[test]
    fn farther_than_its_length_it_does_not_reach_and_nearer_it_does() {
        let map = map(|_| {}, [8.0, 18.0], 12);
        assert_eq!(map.places.len(), 12);
        let first = map.places.first().unwrap();
        assert!(first.there_n < map.service_n && first.there_and_back_n >= first.there_n, "{first:?}");
        assert_eq!(map.places.last().unwrap().there_n, f64::INFINITY);
        let [left, right] = map.safe_m(map.service_n, Trip::ThereAndBack).unwrap();
        assert!(left <= 10.0 && (10.0..20.0).contains(&right), "{left} {right}");
        // A robot that may bear more reaches at least as far.
        let [_, farther] = map.safe_m(map.breaking_n, Trip::ThereAndBack).unwrap();
        assert!(farther >= right);
    }

    #[test]
    fn it_ends_when_it_is_told_to() {
        let scene = catalog::robot_drive();
        let mut progress = 0;
        let map = robot_reach(&scene, None, Settings::default(), [8.0, 12.0], 9, |_, _| {
            progress += 1;
            if progress < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!((map.unwrap().places.len(), progress), (2, 3));
    }

    #[test]
    fn what_has_no_robot_is_refused_in_words() {
        let error =
            robot_reach(&catalog::tank(), None, Settings::default(), [0.0, 1.0], 3, |_, _| ControlFlow::Continue(()));
        assert!(error.unwrap_err().to_string().contains("robot"));
    }
}
