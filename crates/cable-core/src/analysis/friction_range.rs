//! This analysis answers a scene with less and with more friction, because friction coefficients
//! are known poorly.
//!
//! Coulomb's coefficient of a cable on rubble is known to a third at best, and enters tensions as
//! e^{μφ}. So the scene is answered as it is and with all its coefficients scaled down and up; the
//! ribbon at each place is between the least and the greatest of the three tensions. Tension does
//! not always grow with friction (a floor may hold what a hitch need not pull), so the ribbon is
//! from least to greatest, not from low to high friction.

use std::ops::ControlFlow;

use crate::any_error::Error;
use crate::error::SolveError;
use crate::math::{Point, vec2};
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::solution::{CableSolution, Solution};

/// Number of places along a cable at which answers are compared. Smaller: the jump at a corner is
/// drawn as a visible slope.
const SAMPLES_ALONG: usize = 401;

/// Longest step, s: that of a frame, so that the ribbon belongs to the run on screen.
const STEP_S: f64 = 1.0 / 60.0;

/// Least and greatest of the tensions at a place or an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TensionRange {
    /// Arc length, m, or time, s.
    pub at: f64,
    /// Least, N.
    pub low_n: f64,
    /// Greatest, N.
    pub high_n: f64,
}

/// The effect of less and of more friction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrictionRange {
    /// The range along each cable at the end of the time span.
    pub along: Vec<Vec<TensionRange>>,
    /// The largest tension over time; one instant for an equilibrium.
    pub over_time: Vec<TensionRange>,
    /// Largest tension at the end with the least, the likely and the most friction, N.
    pub most_n: [f64; 3],
    /// The failure that ended one of the three runs, if any; the ranges end before it.
    pub failure: Option<FrictionFailure>,
}

/// The failure of a run with less or more friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionFailure {
    /// End of the step that failed, s.
    pub time_s: f64,
    /// The error.
    pub error: SolveError,
}

/// The query: scene, model, settings and duration.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionQuery {
    /// The scene.
    pub scene: Scene,
    /// The model.
    pub model: Model,
    /// Its mesh and accuracy.
    pub settings: Settings,
    /// Least and greatest friction over that of the scene.
    pub factors: [f64; 2],
    /// Duration of the motion, s; 0 for the equilibrium alone.
    pub span_s: f64,
    /// Actions of a hand meanwhile, in order of time; those at 0 s apply to the start of the scene.
    pub hands: Vec<Action>,
}

/// An action of a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Action {
    /// Its time, s.
    pub time_s: f64,
    /// Its kind.
    pub what: ActionKind,
}

/// A support or robot that a hand moves, with its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActionKind {
    /// A support is moved to a place.
    Support {
        /// Index of the cable.
        cable: usize,
        /// Index of the support.
        support: usize,
        /// Place, m.
        to_m: Point,
    },
    /// The robot gets a target speed, m/s; None: that of its path.
    Robot(Option<f64>),
}

impl Action {
    fn place(self, scene: &mut Scene) {
        if let ActionKind::Support { cable, support, to_m } = self.what
            && let Some(s) = scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support))
        {
            s.at_m = Some(to_m);
        }
    }

    fn act(self, run: &mut Simulation) {
        match self.what {
            ActionKind::Support { cable, support, to_m } => run.drag_support(cable, support, vec2(to_m)),
            ActionKind::Robot(speed_m_per_s) => run.command_robot(speed_m_per_s),
        }
    }
}

/// The scene with every coefficient of friction of its cables, obstacles and pulleys scaled.
#[must_use]
pub fn with_scaled_friction(scene: &Scene, factor: f64) -> Scene {
    let mut scene = scene.clone();
    for cable in &mut scene.cables {
        cable.friction *= factor;
        for friction in cable.supports.iter_mut().filter_map(|s| s.friction.as_mut()) {
            *friction *= factor;
        }
    }
    for friction in scene.obstacles.iter_mut().filter_map(|o| o.friction.as_mut()) {
        *friction *= factor;
    }
    scene
}

/// Answers the scene three times; `progress` receives the completed fraction (0 to 1) and can end
/// the analysis.
///
/// # Errors An error if the scene is invalid, or an equilibrium was not found.
pub fn friction_range(
    query: &FrictionQuery,
    mut progress: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<FrictionRange, Error> {
    let [low, high] = query.factors;
    let motion = query.span_s > 0.0;
    // Models without inertia advance time quasi-statically, as the window does.
    let slow = !query.model.capabilities().inertia;
    let inertia = if slow { Inertia::QuasiStatic } else { Inertia::Dynamic };
    let question = if motion { Question::History(inertia) } else { Question::Rest };
    let mut runs = Vec::with_capacity(3);
    let mut hands = query.hands.as_slice();
    let mut start = query.scene.clone();
    while let Some((hand, later)) = hands.split_first().filter(|(h, _)| h.time_s <= 0.0) {
        hand.place(&mut start);
        hands = later;
    }
    for factor in [low, 1.0, high] {
        let mut run =
            Simulation::for_question(with_scaled_friction(&start, factor), query.model, query.settings, question)?;
        run.settle()?;
        runs.push(run);
        if progress(if motion { 0.0 } else { runs.len() as f64 / 3.0 }).is_break() {
            return Ok(FrictionRange::default());
        }
    }
    let mut out = FrictionRange::default();
    let mut answers: Vec<Solution> = runs.iter().map(Simulation::solution).collect();
    out.over_time.push(most(&answers));
    let steps = (query.span_s / STEP_S).ceil();
    for k in 1..=steps as u64 {
        let end = if k as f64 >= steps { query.span_s } else { k as f64 * STEP_S };
        while let Some((hand, later)) = hands.split_first().filter(|(h, _)| h.time_s < end + 0.5 * STEP_S) {
            runs.iter_mut().for_each(|run| hand.act(run));
            hands = later;
        }
        let stepped = runs.iter_mut().try_for_each(|run| {
            let dt_s = end - run.time_s();
            if slow { run.step_quasi_static(dt_s) } else { run.step(dt_s) }
        });
        if let Err(error) = stepped {
            out.failure = Some(FrictionFailure { time_s: end, error });
            break;
        }
        answers = runs.iter().map(Simulation::solution).collect();
        out.over_time.push(most(&answers));
        if progress(k as f64 / steps).is_break() {
            break;
        }
    }
    out.along = (0..query.scene.cables.len()).map(|k| along(&answers, k, query.scene.cables[k].length_m)).collect();
    for (most, answer) in out.most_n.iter_mut().zip(&answers) {
        *most = answer.max_tension().tension_n;
    }
    Ok(out)
}

/// Least and greatest value; NaN if any value is NaN.
fn band(at: f64, values: impl Iterator<Item = f64>) -> TensionRange {
    let start = TensionRange { at, low_n: f64::INFINITY, high_n: f64::NEG_INFINITY };
    values.fold(start, |b, v| TensionRange {
        at,
        low_n: if v < b.low_n || v.is_nan() { v } else { b.low_n },
        high_n: if v > b.high_n || v.is_nan() { v } else { b.high_n },
    })
}

fn most(answers: &[Solution]) -> TensionRange {
    let time_s = answers.first().map_or(0.0, |a| a.time_s);
    band(time_s, answers.iter().map(|a| a.max_tension().tension_n))
}

fn along(answers: &[Solution], cable: usize, length_m: f64) -> Vec<TensionRange> {
    let solved: Vec<&CableSolution> = answers.iter().filter_map(|a| a.cables.get(cable)).collect();
    let places = (0..SAMPLES_ALONG).map(|i| length_m * i as f64 / (SAMPLES_ALONG - 1) as f64);
    places.map(|s| band(s, solved.iter().map(|c| tension(c, s)))).collect()
}

/// Tension at an arc length, N, linear between nodes; of two nodes at one place that before it.
fn tension(cable: &CableSolution, s: f64) -> f64 {
    let k = cable.nodes.partition_point(|n| n.arc_length_m < s);
    match (k.checked_sub(1).and_then(|j| cable.nodes.get(j)), cable.nodes.get(k)) {
        (Some(a), Some(b)) => {
            let f = (s - a.arc_length_m) / (b.arc_length_m - a.arc_length_m);
            a.tension_n + (b.tension_n - a.tension_n) * f
        }
        (Some(one), None) | (None, Some(one)) => one.tension_n,
        (None, None) => f64::NAN,
    }
}
