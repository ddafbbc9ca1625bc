//! A job computes the ribbon of less and more friction whenever scene, model or run have changed.

use std::sync::Arc;

use cable_core::analysis::friction_range::{self, Action, ActionKind, FrictionQuery, FrictionRange};
use cable_core::scene::SupportKind;
use cable_core::{Scene, Solution};

use crate::jobs::background;
use crate::units::sentence::sentence;

/// The findings, and the question.
pub type Outcome = (Arc<FrictionRange>, Arc<FrictionQuery>);
/// Its progress.
pub type Progress = background::Progress<Outcome>;

/// Longest run for which the ribbon is computed, s: that takes three runs. Longer: a ribbon takes
/// both cores a minute; shorter: a drive is cut off.
pub const MAX_RUN_S: f64 = 120.0;

/// The range of friction that the user asks about, and its result.
#[derive(Clone, Debug)]
pub struct FrictionRangeState {
    /// The ribbon is wanted.
    pub on: bool,
    /// Least and greatest friction over that of the scene.
    pub factors: [f64; 2],
    /// Its progress.
    pub progress: Progress,
}

impl Default for FrictionRangeState {
    /// The default is a third less and a third more, as handbooks differ for rubber on concrete.
    fn default() -> Self {
        Self { on: false, factors: [0.67, 1.33], progress: Progress::None }
    }
}

/// A ribbon being computed.
#[derive(Debug)]
pub struct FrictionRangeJob {
    job: background::Job<Outcome>,
    query: Arc<FrictionQuery>,
}

impl FrictionRangeJob {
    /// Starts a job; `shown` is called whenever there is a new result to show.
    #[must_use]
    pub fn start(query: FrictionQuery, shown: impl Fn() + Send + 'static) -> Self {
        let query = Arc::new(query);
        let theirs = Arc::clone(&query);
        let work = move |listen: background::Listener<'_, Outcome>| {
            let found = friction_range::friction_range(&theirs, |share| listen(share, None));
            found.map(|s| (Arc::new(s), theirs)).map_err(|e| sentence(&e))
        };
        Self { job: background::Job::start("friction range", work, shown), query }
    }

    /// Returns what was asked.
    #[must_use]
    pub fn query(&self) -> &FrictionQuery {
        &self.query
    }

    /// Returns how far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.job.progress()
    }
}

/// Least move of a support between two answers that is a hand's, m: less is rounding.
const MIN_MOVE_M: f64 = 1e-9;

/// Returns the manual inputs of a run: the paths of supports that only a hand moved, and the
/// commands to the robot.
#[must_use]
pub fn recorded_actions(scene: &Scene, answers: &[Solution]) -> Vec<Action> {
    let by_hand = scene.cables.iter().enumerate().flat_map(|(cable, c)| {
        let is_moved_by_hand = |s: &cable_core::Support| {
            s.at_m.is_some() && s.motion.is_none() && !matches!(s.kind, SupportKind::Pulley | SupportKind::Robot)
        };
        c.supports
            .iter()
            .enumerate()
            .filter(move |(_, s)| is_moved_by_hand(s))
            .map(move |(support, _)| (cable, support))
    });
    let by_hand: Vec<(usize, usize)> = by_hand.collect();
    let at = |a: &Solution, (cable, support): (usize, usize)| {
        a.cables.get(cable).and_then(|c| c.supports.get(support)).map(|s| [s.x_m, s.y_m])
    };
    let mut hands = Vec::new();
    let Some(first) = answers.first() else { return hands };
    for &(cable, support) in &by_hand {
        if let Some(to_m) = at(first, (cable, support)) {
            hands.push(Action { time_s: 0.0, what: ActionKind::Support { cable, support, to_m } });
        }
    }
    let mut last_order = None;
    for pair in answers.windows(2) {
        let [before, now] = [&pair[0], &pair[1]];
        for &(cable, support) in &by_hand {
            let (Some(from_m), Some(to_m)) = (at(before, (cable, support)), at(now, (cable, support))) else {
                continue;
            };
            if (to_m[0] - from_m[0]).hypot(to_m[1] - from_m[1]) > MIN_MOVE_M {
                hands.push(Action { time_s: now.time_s, what: ActionKind::Support { cable, support, to_m } });
            }
        }
        let order = now.robot.map(|r| r.leg.is_none().then_some(r.commanded_m_per_s));
        if let Some(order) = order.filter(|o| last_order != Some(*o)) {
            hands.push(Action { time_s: now.time_s, what: ActionKind::Robot(order) });
            last_order = Some(order);
        }
    }
    hands
}
