//! Where a robot can go along its ground.
//!
//! It is put where its tracks stand, place after place; its outline is an obstacle for its cable. No drive, slope or traction
//! limits it here: [`crate::robot::Vehicle`] answers whether the robot could pull so hard.

use std::ops::ControlFlow;

use super::{HOPELESS, STEP_S, least, stilled, unsupported};
use crate::error::Error;
use crate::math::{Point, larger};
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::robot;
use crate::scene::ground::Ground;
use crate::scene::preset::robot_preset;
use crate::scene::{Scene, SupportKind};
use crate::simulation::Simulation;

/// Longest way between two answers, m. Longer: an edge that the cable slips over is passed unseen; shorter: more answers.
const STEP_M: f64 = 0.05;

/// What the cable may leave of a step, m: a robot that it holds back by a hair has not been stopped.
const LEFT_M: f64 = 1e-3;

/// Where a heap of slack cable has no rest to be pushed to it is thrown over: such a step is taken with inertia, at this speed, m/s.
/// Faster: its swing shows in the tension; slower: longer.
const SHOVED_M_PER_S: f64 = 0.3;

/// A place of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where the tracks' middle is, m.
    pub at_m: Point,
    /// Largest tension with the robot there, N; infinite where the cable does not reach, not a number where no answer was found.
    pub there_n: f64,
    /// Largest tension on the way there and back, N; infinite where the cable does not reach, not a number where no answer was found.
    pub there_and_back_n: f64,
    /// The cable lies in the robot's way there or back and cannot get out of it.
    pub jammed: bool,
}

/// What there is to know of every place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Map {
    /// In order of x.
    pub places: Vec<Place>,
    /// Where the robot started, m.
    pub start_x_m: f64,
    /// Service tension, N: the least of all cables that hang on it.
    pub service_n: f64,
    /// Breaking tension, N: the least of all cables that hang on it.
    pub breaking_n: f64,
}

impl Map {
    /// From where to where the robot can go without passing a tension (N), and with `back` also come back; None if not even at
    /// its start.
    #[must_use]
    pub fn safe_m(&self, tension_n: f64, back: bool) -> Option<[f64; 2]> {
        let fits = |p: &Place| (if back { p.there_and_back_n } else { p.there_n }) <= tension_n;
        let start = self.places.iter().position(|p| p.at_m[0] >= self.start_x_m)?;
        self.places.get(start).filter(|p| fits(p))?;
        let right = self.places.iter().skip(start).take_while(|p| fits(p)).last()?;
        let left = self.places.iter().take(start + 1).rev().take_while(|p| fits(p)).last()?;
        Some([left.at_m[0], right.at_m[0]])
    }
}

/// Looks at so many places between two, m; `progress` hears the map so far and the share done (0 to 1), and can end it.
///
/// # Errors
/// The scene is wrong or has no robot with a cable on ground in a side view, or its start has no answer.
pub fn reach(
    scene: &Scene,
    settings: Settings,
    ([from_m, to_m], count): ([f64; 2], usize),
    mut progress: impl FnMut(&Map, f64) -> ControlFlow<()>,
) -> Result<Map, Error> {
    let vehicle = scene.robot.as_ref().ok_or_else(|| unsupported("a scene without a robot"))?;
    let preset = robot_preset(&vehicle.preset).ok_or_else(|| unsupported("a robot of no known kind"))?;
    let hangs = |k: &usize| scene.cables[*k].supports.iter().any(|s| s.kind == SupportKind::Robot);
    let cables: Vec<usize> = (0..scene.cables.len()).filter(hangs).collect();
    if cables.is_empty() {
        return Err(unsupported("a robot that no cable hangs on"));
    }
    let ground = Ground::of(scene);
    let start_x_m = vehicle.at_m[0];
    let mut map = Map {
        start_x_m,
        service_n: least(scene, &cables, |c| c.service_tension_n),
        breaking_n: least(scene, &cables, |c| c.breaking_tension_n),
        ..Map::default()
    };
    let question = Question::History(Inertia::QuasiStatic);
    let mut start = Simulation::for_question(stilled(scene), Model::Auto, settings, question)?;
    start.settle()?;
    let walk = Walk { cables: &cables, limit_n: HOPELESS * map.breaking_n };
    let step = (to_m - from_m) / count.saturating_sub(1).max(1) as f64;
    let xs: Vec<f64> = (0..count).map(|k| from_m + step * k as f64).collect();
    for side in [1.0, -1.0] {
        let mut ordered: Vec<f64> = xs.iter().copied().filter(|x| side * (x - start_x_m) >= 0.0).collect();
        if side < 0.0 {
            ordered.retain(|x| *x < start_x_m);
            ordered.reverse();
        }
        let (mut there, mut at) = (start.clone(), start_x_m);
        let mut most = Ok(there.largest_n(cables.iter().copied()));
        for x in ordered {
            let share = (map.places.len() + 1) as f64 / count.max(1) as f64;
            if progress(&map, share).is_break() {
                return Ok(map);
            }
            let Some(stand) = vehicle.pose_on(&ground, preset, x) else { continue };
            most = most.and_then(|m| walk.go(&mut there, [at, x]).map(|out| larger(m, out)));
            at = x;
            let back = most.and_then(|_| walk.go(&mut there.clone(), [x, start_x_m]));
            let value = |found: Result<f64, Stop>| match found {
                Ok(n) => n,
                Err(Stop::NoAnswer) => f64::NAN,
                Err(Stop::Taut | Stop::Jammed) => f64::INFINITY,
            };
            let place = Place {
                at_m: stand.at_m,
                there_n: value(most.map(|_| there.largest_n(cables.iter().copied()))),
                there_and_back_n: larger(value(most), value(back)),
                jammed: most == Err(Stop::Jammed) || back == Err(Stop::Jammed),
            };
            let after = map.places.partition_point(|p| p.at_m[0] < place.at_m[0]);
            map.places.insert(after, place);
        }
    }
    Ok(map)
}

/// Why it got no farther.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stop {
    /// The cable cannot bear it.
    Taut,
    /// The cable lies in its way.
    Jammed,
    /// No answer was found.
    NoAnswer,
}

/// How the robot is moved.
struct Walk<'a> {
    cables: &'a [usize],
    limit_n: f64,
}

impl Walk<'_> {
    /// Moves the robot from one place to another; the largest tension on the way.
    fn go(&self, simulation: &mut Simulation, [from, to]: [f64; 2]) -> Result<f64, Stop> {
        let steps = ((to - from).abs() / STEP_M).ceil();
        let mut most = simulation.largest_n(self.cables.iter().copied());
        for k in 1..=steps as usize {
            let x = from + (to - from) * (k as f64 / steps);
            // Where it cannot stand the cable is led past.
            let left_m = simulation.lead_robot(x, (STEP_S, Inertia::QuasiStatic)).map_err(|_| Stop::NoAnswer)?;
            most = larger(most, simulation.largest_n(self.cables.iter().copied()));
            if left_m.is_some_and(|m| m > LEFT_M) {
                self.shove(simulation, [x - (to - from) / steps, x])?;
                most = larger(most, simulation.largest_n(self.cables.iter().copied()));
            }
            if !(most <= self.limit_n) {
                return Err(Stop::Taut);
            }
        }
        Ok(most)
    }

    /// A step with inertia, against the heap of cable before the robot. What swings on the way is not looked at: with what
    /// speed a robot does this is not asked.
    fn shove(&self, simulation: &mut Simulation, [from, to]: [f64; 2]) -> Result<(), Stop> {
        let parts = ((to - from).abs() / (SHOVED_M_PER_S * robot::STEP_S)).ceil();
        let mut left_m = None;
        for k in 1..=parts as usize {
            let x = from + (to - from) * (k as f64 / parts);
            left_m = simulation.lead_robot(x, (robot::STEP_S, Inertia::Dynamic)).map_err(|_| Stop::NoAnswer)?;
        }
        // What it threw over has come down.
        let rests = simulation.lead_robot(to, (STEP_S, Inertia::QuasiStatic)).map_err(|_| Stop::NoAnswer)?.or(left_m);
        if rests.is_some_and(|m| m > LEFT_M) { Err(Stop::Jammed) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::catalog;

    fn map(change: impl FnOnce(&mut Scene), ends: [f64; 2], count: usize) -> Map {
        let mut scene = catalog::robot_drive();
        change(&mut scene);
        reach(&scene, Settings::default(), (ends, count), |_, _| ControlFlow::Continue(())).unwrap()
    }

    #[test]
    fn farther_than_its_length_it_does_not_reach_and_nearer_it_does() {
        let map = map(|_| {}, [8.0, 18.0], 12);
        assert_eq!(map.places.len(), 12);
        let first = map.places.first().unwrap();
        assert!(first.there_n < map.service_n && first.there_and_back_n >= first.there_n, "{first:?}");
        assert_eq!(map.places.last().unwrap().there_n, f64::INFINITY);
        let [left, right] = map.safe_m(map.service_n, true).unwrap();
        assert!(left <= 10.0 && (10.0..20.0).contains(&right), "{left} {right}");
        // What may bear more reaches at least as far.
        let [_, farther] = map.safe_m(map.breaking_n, true).unwrap();
        assert!(farther >= right);
    }

    #[test]
    fn it_ends_when_it_is_told_to() {
        let scene = catalog::robot_drive();
        let mut heard = 0;
        let map = reach(&scene, Settings::default(), ([8.0, 12.0], 9), |_, _| {
            heard += 1;
            if heard < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!((map.unwrap().places.len(), heard), (2, 3));
    }

    #[test]
    fn what_has_no_robot_is_refused_in_words() {
        let error = reach(&catalog::tank(), Settings::default(), ([0.0, 1.0], 3), |_, _| ControlFlow::Continue(()));
        assert!(error.unwrap_err().to_string().contains("robot"));
    }
}
