//! Where a robot can go: what its cable pulls with it there, and on the way there and back.
//!
//! The robot is put where its tracks stand on the ground, place after place, slowly enough that nothing swings (histories
//! without inertia, with friction). From each place it goes back to where it started: a cable that was drawn round an
//! edge on the way out may hold there on the way back. No drive, slope or traction limits it here: the question is what
//! the cable would have to bear, and [`super::Vehicle`] answers whether the robot could pull so hard.

use std::ops::ControlFlow;

use crate::error::{Error, SolveError};
use crate::math::{Point, Vec2, larger, vec2};
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::scene::ground::Ground;
use crate::scene::preset::robot_preset;
use crate::scene::{Scene, Support, SupportKind};
use crate::simulation::Simulation;

/// Longest way between two answers, m. Longer: an edge that the cable slips over is passed unseen; shorter: more answers.
const STEP_M: f64 = 0.05;

/// Time of such a step, s: no inertia acts, so it only says how fast supports are drawn; half a metre a second.
const STEP_S: f64 = 0.1;

/// A cable that would have to bear this many times its breaking tension will not get any farther.
const HOPELESS: f64 = 2.0;

/// Breaking tension while looking, N: the map says where it would break and goes on.
const UNBREAKABLE_N: f64 = 1e15;

/// A place of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where the tracks' middle is, m.
    pub at_m: Point,
    /// Largest tension with the robot there, N; infinite where the cable does not reach.
    pub there_n: f64,
    /// Largest tension on the way there and back, N; infinite where the cable does not reach.
    pub there_and_back_n: f64,
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
    /// From where to where the robot can go there and back without passing a tension, m; None if not even at its start.
    #[must_use]
    pub fn safe_m(&self, tension_n: f64) -> Option<[f64; 2]> {
        let fits = |p: &Place| p.there_and_back_n <= tension_n;
        let start = self.places.iter().position(|p| p.at_m[0] >= self.start_x_m)?;
        self.places.get(start).filter(|p| fits(p))?;
        let right = self.places.iter().skip(start).take_while(|p| fits(p)).last()?;
        let left = self.places.iter().take(start + 1).rev().take_while(|p| fits(p)).last()?;
        Some([left.at_m[0], right.at_m[0]])
    }
}

/// Looks at so many places between two, m; `progress` hears the share done (0 to 1) and can end it.
///
/// # Errors
/// The scene is wrong or has no robot with a cable on ground in a side view, or its start has no answer.
pub fn reach(
    scene: &Scene,
    settings: Settings,
    ([from_m, to_m], count): ([f64; 2], usize),
    mut progress: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Map, Error> {
    let (puppet, hitches) = puppet(scene)?;
    let robot = scene.robot.as_ref().ok_or_else(|| unsupported("a scene without a robot"))?;
    let preset = robot_preset(&robot.preset).ok_or_else(|| unsupported("a robot of no known kind"))?;
    let ground = Ground::of(scene);
    let pose = |x: f64| robot.pose_on(&ground, preset, x);
    let start_x_m = robot.at_m[0];
    let least = |of: fn(&crate::scene::Cable) -> f64| {
        let hung = hitches.iter().filter_map(|(k, _)| scene.cables.get(*k));
        hung.map(of).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    };
    let mut map = Map {
        start_x_m,
        service_n: least(|c| c.service_tension_n),
        breaking_n: least(|c| c.breaking_tension_n),
        ..Map::default()
    };
    let mut start = Simulation::for_question(puppet, Model::Auto, settings, Question::History(Inertia::QuasiStatic))?;
    start.settle()?;
    let walk = Walk {
        hitches: &hitches,
        hitch: &|x| pose(x).map(|p| vec2(p.hitch_m(preset))),
        limit_n: HOPELESS * map.breaking_n,
    };
    let step = (to_m - from_m) / count.saturating_sub(1).max(1) as f64;
    let xs: Vec<f64> = (0..count).map(|k| from_m + step * k as f64).collect();
    let mut done = 0;
    for side in [1.0, -1.0] {
        let mut ordered: Vec<f64> = xs.iter().copied().filter(|x| side * (x - start_x_m) >= 0.0).collect();
        if side < 0.0 {
            ordered.retain(|x| *x < start_x_m);
            ordered.reverse();
        }
        let (mut there, mut at) = (start.clone(), start_x_m);
        let mut most = there.solution().max_tension().tension_n;
        for x in ordered {
            done += 1;
            if progress(done as f64 / count.max(1) as f64).is_break() {
                return Ok(sorted(map));
            }
            let Some(stand) = pose(x) else { continue };
            let out = walk.go(&mut there, [at, x]);
            at = x;
            most = larger(most, out);
            let there_n = if out.is_finite() { there.solution().max_tension().tension_n } else { out };
            let back = if most.is_finite() { walk.go(&mut there.clone(), [x, start_x_m]) } else { most };
            map.places.push(Place { at_m: stand.at_m, there_n, there_and_back_n: larger(most, back) });
        }
    }
    Ok(sorted(map))
}

fn sorted(mut map: Map) -> Map {
    map.places.sort_by(|a, b| a.at_m[0].total_cmp(&b.at_m[0]));
    map
}

fn unsupported(feature: &str) -> Error {
    Error::from(SolveError::Unsupported { model: Model::Auto, feature: feature.to_owned() })
}

/// The scene with its robot's hitch as a support that can be moved by hand, and which supports those are.
fn puppet(scene: &Scene) -> Result<(Scene, Vec<(usize, usize)>), Error> {
    let hitch = scene.hitch_m().ok_or_else(|| unsupported("a scene without a robot"))?;
    let mut puppet = scene.clone();
    let mut hitches = Vec::new();
    for (k, cable) in puppet.cables.iter_mut().enumerate() {
        cable.breaking_tension_n = UNBREAKABLE_N;
        for (i, s) in cable.supports.iter_mut().enumerate().filter(|(_, s)| s.kind == SupportKind::Robot) {
            *s = Support { arc_length_m: s.arc_length_m, ..Support::fixed(s.name.clone(), hitch) };
            hitches.push((k, i));
        }
    }
    puppet.robot = None;
    if hitches.is_empty() {
        return Err(unsupported("a robot that no cable hangs on"));
    }
    Ok((puppet, hitches))
}

/// How the hitch is moved.
struct Walk<'a> {
    hitches: &'a [(usize, usize)],
    /// Where the hitch is with the robot at x; None where it cannot stand.
    hitch: &'a dyn Fn(f64) -> Option<Vec2>,
    limit_n: f64,
}

impl Walk<'_> {
    /// Moves the robot from one place to another; the largest tension on the way, infinite where it got no farther.
    fn go(&self, simulation: &mut Simulation, [from, to]: [f64; 2]) -> f64 {
        let steps = ((to - from).abs() / STEP_M).ceil();
        let mut most = simulation.solution().max_tension().tension_n;
        for k in 1..=steps as usize {
            let x = from + (to - from) * (k as f64 / steps);
            // Where it cannot stand the cable is led past.
            let Some(hitch) = (self.hitch)(x) else { continue };
            for &(cable, support) in self.hitches {
                simulation.drag_support(cable, support, hitch);
            }
            if simulation.step_quasi_static(STEP_S).is_err() {
                return f64::INFINITY;
            }
            most = larger(most, simulation.solution().max_tension().tension_n);
            if !(most <= self.limit_n) {
                return f64::INFINITY;
            }
        }
        most
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::catalog;

    fn map(change: impl FnOnce(&mut Scene), ends: [f64; 2], count: usize) -> Map {
        let mut scene = catalog::robot_drive();
        change(&mut scene);
        reach(&scene, Settings::default(), (ends, count), |_| ControlFlow::Continue(())).unwrap()
    }

    #[test]
    fn farther_than_its_length_it_does_not_reach_and_nearer_it_does() {
        let map = map(|_| {}, [8.0, 18.0], 12);
        assert_eq!(map.places.len(), 12);
        let first = map.places.first().unwrap();
        assert!(first.there_n < map.service_n && first.there_and_back_n >= first.there_n, "{first:?}");
        assert_eq!(map.places.last().unwrap().there_n, f64::INFINITY);
        let [left, right] = map.safe_m(map.service_n).unwrap();
        assert!(left <= 10.0 && (10.0..20.0).contains(&right), "{left} {right}");
        // What may bear more reaches at least as far.
        let [_, farther] = map.safe_m(map.breaking_n).unwrap();
        assert!(farther >= right);
    }

    #[test]
    fn it_ends_when_it_is_told_to() {
        let scene = catalog::robot_drive();
        let mut heard = 0;
        let map = reach(&scene, Settings::default(), ([8.0, 12.0], 9), |_| {
            heard += 1;
            if heard < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!((map.unwrap().places.len(), heard), (2, 3));
    }

    #[test]
    fn what_has_no_robot_is_refused_in_words() {
        let error = reach(&catalog::tank(), Settings::default(), ([0.0, 1.0], 3), |_| ControlFlow::Continue(()));
        assert!(error.unwrap_err().to_string().contains("robot"));
    }
}
