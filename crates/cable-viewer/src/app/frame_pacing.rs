//! A window that is drawn without a GPU shows fewer frames while time runs: each costs as much
//! processor as several steps of the simulation, and what is recorded is the same.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use cable_core::Solution;
use cable_core::solution::Node;

/// Time from the end of one frame of a running simulation that is drawn without a GPU to the next,
/// s, where the picture moves fast: with the frame itself, 25 frames a second. Shorter: drawing
/// takes more of a core than the simulation; longer: motion is seen to jerk.
pub(super) const SOFTWARE_FRAME_INTERVAL: Duration = Duration::from_millis(40);

/// Factor by which that time is longer where hardly anything moves. Smaller: a picture that stands
/// costs as much as one that moves; larger: figures and clock are seen to stutter.
const MAX_STRETCH: f64 = 2.0;

/// Way of the fastest point of the picture from one frame to the next, points, that is still seen
/// as even. Smaller: slow motion is drawn as often as fast one; larger: it is seen in steps.
const EVEN_STEP_POINTS: f64 = 1.5;

/// The time before which no frame is drawn for the sake of a step, shared with the solver thread.
#[derive(Clone, Debug, Default)]
pub(super) struct FramePacing {
    interval: Duration,
    next: Arc<Mutex<Option<Instant>>>,
}

/// What the next frame is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NextFrame {
    /// It shows a step of the running simulation, and nobody waits for an answer.
    Step {
        /// Speed of the fastest point of the picture, points/s.
        points_per_s: f64,
    },
    /// It shows an answer as soon as there is one.
    Answer,
}

impl FramePacing {
    /// Least time between two frames while the simulation runs.
    pub fn every(&mut self, interval: Duration) {
        self.interval = interval;
    }

    /// A frame has been drawn.
    pub fn drawn(&self, now: Instant, next_frame: NextFrame) {
        let next = match next_frame {
            NextFrame::Step { points_per_s } if self.interval > Duration::ZERO => {
                let step = points_per_s * self.interval.as_secs_f64();
                let even = if step.is_finite() { EVEN_STEP_POINTS / step.max(f64::MIN_POSITIVE) } else { 1.0 };
                Some(now + self.interval.mul_f64(even.clamp(1.0, MAX_STRETCH)))
            }
            _ => None,
        };
        *self.next.lock().unwrap_or_else(PoisonError::into_inner) = next;
    }

    /// The wait until what the solver has found is to be drawn.
    pub fn wait(&self, now: Instant) -> Duration {
        let next = *self.next.lock().unwrap_or_else(PoisonError::into_inner);
        next.map_or(Duration::ZERO, |next| next.saturating_duration_since(now))
    }
}

/// The speed of the fastest shown node, from one frame to the next.
#[derive(Debug, Default)]
pub(super) struct ShownMotion {
    last: Option<(Instant, Arc<Solution>)>,
}

impl ShownMotion {
    /// Speed (m/s of the wall clock) of the fastest point since the frame before; infinite where
    /// that is not known.
    pub fn speed(&mut self, now: Instant, shown: Option<&Arc<Solution>>) -> f64 {
        let before = std::mem::replace(&mut self.last, shown.map(|s| (now, Arc::clone(s))));
        match (before, shown) {
            (Some((then, before)), Some(shown)) => {
                farthest_move_m(&before, shown) / now.saturating_duration_since(then).as_secs_f64()
            }
            _ => f64::INFINITY,
        }
    }
}

/// The longest way that a point of a cable or the robot has between two answers, m; infinite where
/// they have not the same pieces. Points are compared at one arc length: a cable that moves over
/// corners gets and loses nodes in every second frame.
fn farthest_move_m(before: &Solution, now: &Solution) -> f64 {
    let cables = || before.cables.iter().zip(&now.cables);
    let same = before.cables.len() == now.cables.len()
        && cables().all(|(a, b)| a.pieces().map(<[_]>::is_empty).eq(b.pieces().map(<[_]>::is_empty)));
    if !same || before.robot.is_some() != now.robot.is_some() {
        return f64::INFINITY;
    }
    let pieces = cables().flat_map(|(a, b)| a.pieces().zip(b.pieces()));
    let ways = pieces.map(|(before, now)| farthest_move_of_piece_m(before, now));
    let robot = before.robot.as_ref().zip(now.robot.as_ref());
    let robot = robot.map(|(a, b)| (b.x_m - a.x_m).hypot(b.y_m - a.y_m));
    ways.chain(robot).fold(0.0, f64::max)
}

/// The longest way that a node of a piece has from where its point of the cable was, m.
fn farthest_move_of_piece_m(before: &[Node], now: &[Node]) -> f64 {
    let (mut bar, mut farthest_m) = (0, 0.0);
    for node in now {
        let ends_before = |n: &&Node| n.arc_length_m < node.arc_length_m;
        while bar + 2 < before.len() && before.get(bar + 1).filter(ends_before).is_some() {
            bar += 1;
        }
        let Some(from) = before.get(bar) else { return f64::INFINITY };
        let to = before.get(bar + 1).unwrap_or(from);
        let length_m = to.arc_length_m - from.arc_length_m;
        let part =
            if length_m > 0.0 { ((node.arc_length_m - from.arc_length_m) / length_m).clamp(0.0, 1.0) } else { 0.0 };
        let [x_m, y_m] = [from.x_m + (to.x_m - from.x_m) * part, from.y_m + (to.y_m - from.y_m) * part];
        farthest_m = f64::max(farthest_m, (node.x_m - x_m).hypot(node.y_m - y_m));
    }
    farthest_m
}

#[cfg(test)]
mod tests {
    use cable_core::Model;
    use cable_core::solution::{CableSolution, Cost, Energy, ModelReason};

    use super::*;

    #[test]
    fn steps_wait_for_the_next_frame_and_answers_to_edits_do_not() {
        let (mut pacing, now) = (FramePacing::default(), Instant::now());
        let fast = NextFrame::Step { points_per_s: 300.0 };
        let solver = pacing.clone();
        pacing.drawn(now, fast);
        assert_eq!(solver.wait(now), Duration::ZERO, "with a GPU each step is shown");
        pacing.every(SOFTWARE_FRAME_INTERVAL);
        pacing.drawn(now, fast);
        let later = now + Duration::from_millis(13);
        assert_eq!(solver.wait(later), Duration::from_millis(27));
        assert_eq!(solver.wait(now + Duration::from_secs(1)), Duration::ZERO);
        pacing.drawn(later, NextFrame::Answer);
        assert_eq!(solver.wait(later), Duration::ZERO);
    }

    #[test]
    fn what_moves_slowly_is_drawn_less_often_and_never_in_steps_that_are_seen() {
        let (mut pacing, now) = (FramePacing::default(), Instant::now());
        pacing.every(SOFTWARE_FRAME_INTERVAL);
        let mut wait_ms = |points_per_s: f64| {
            pacing.drawn(now, NextFrame::Step { points_per_s });
            pacing.wait(now).as_secs_f64() * 1e3
        };
        for points_per_s in [20.0, 25.0, 30.0, 37.0] {
            let wait = wait_ms(points_per_s);
            assert!(wait > 40.0 && points_per_s * wait * 1e-3 <= 1.5 + 1e-6, "{points_per_s}: {wait} ms");
        }
        assert_eq!([0.0, 10.0].map(&mut wait_ms), [80.0; 2]);
        assert_eq!([40.0, 1e9, f64::INFINITY].map(&mut wait_ms), [40.0; 3]);
    }

    /// An answer with one cable, by arc length and place of its nodes, m, that is broken before
    /// some.
    fn answer(nodes: &[[f64; 3]], breaks: &[usize]) -> Arc<Solution> {
        let nodes = nodes.iter().map(|&[arc_length_m, x_m, y_m]| Node { arc_length_m, x_m, y_m, ..Node::default() });
        let nodes = nodes.collect::<Vec<_>>().into();
        let cables = vec![CableSolution { nodes, breaks: breaks.to_vec(), ..CableSolution::default() }];
        Arc::new(Solution {
            time_s: 0.0,
            model: Model::Fem,
            reason: ModelReason::Requested,
            next_cheaper: None,
            cables,
            warnings: Vec::new(),
            cost: Cost::default(),
            energy: Energy::default(),
            robot: None,
            verification: None,
        })
    }

    #[test]
    fn the_speed_is_that_of_the_fastest_point() {
        let (mut motion, now) = (ShownMotion::default(), Instant::now());
        let later = now + Duration::from_millis(100);
        let whole = answer(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], &[]);
        assert_eq!(motion.speed(now, Some(&whole)), f64::INFINITY);
        let speed = motion.speed(later, Some(&answer(&[[0.0, 0.0, 0.1], [1.0, 1.3, 0.4]], &[])));
        assert!((speed - 5.0).abs() < 1e-9, "{speed}");
        let broken = answer(&[[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.5, 0.0], [1.0, 1.0, 0.0]], &[2]);
        motion.speed(now, Some(&whole));
        assert_eq!(motion.speed(later, Some(&broken)), f64::INFINITY, "it has just broken");
    }

    /// The nodes of a cable on corners come and go, and slide along it.
    #[test]
    fn a_cable_that_stands_stands_on_any_mesh() {
        let bent = |s: f64| if s < 1.0 { [s, s, 0.0] } else { [s, 1.0, s - 1.0] };
        let meshes: [&[f64]; 4] = [
            &[0.0, 0.4, 1.0, 1.7, 2.0],
            &[0.0, 1.0, 2.0],
            &[0.0, 0.1, 0.9, 1.0, 2.0],
            &[0.0, 0.99, 1.0, 1.01, 1.5, 2.0],
        ];
        let (mut motion, now) = (ShownMotion::default(), Instant::now());
        for (k, mesh) in meshes.iter().enumerate() {
            let nodes: Vec<[f64; 3]> = mesh.iter().map(|s| bent(*s)).collect();
            let then = now + Duration::from_millis(40 * k as u64);
            let speed = motion.speed(then, Some(&answer(&nodes, &[])));
            assert!(if k == 0 { speed == f64::INFINITY } else { speed < 1e-12 }, "{k}: {speed}");
        }
        let pieces =
            |gap: f64| answer(&[[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.5 + gap, 0.0], [1.0, 1.0 + gap, 0.0]], &[2]);
        motion.speed(now, Some(&pieces(1.0)));
        let speed = motion.speed(now + Duration::from_millis(100), Some(&pieces(1.02)));
        assert!((speed - 0.2).abs() < 1e-9, "each piece by itself: {speed}");
    }
}
