//! The models `fem`, `mass-spring` and `spans` are compared on every scene of the catalogue: their
//! error against a reference, and their cost.
//!
//! In a scene without friction or without motion, the models find the equilibrium. In a scene with
//! friction and a moving support, many equilibria exist, so the models follow the motion slowly and
//! are compared at its end: there the whole cable slides, and one equilibrium is right.
//!
//! The reference is the elastic catenary where it has an answer, else `spans` (which has no
//! discretisation error either), else the finest `fem`, whose uncertainty is the change on half as
//! many elements. The error is the largest error of a support's force or of the largest tension,
//! relative to the largest tension. All models start from the same route.

use std::time::Instant;

use cable_core::solution::Node;
use cable_core::{Model, Scene, Simulation, Solution, SolveError};

use crate::fresh;
use crate::machine::{Clock, Spent};

/// A cost is the least time of this many solves, or of as many as fit into the time below, at least
/// one.
const REPEATS: usize = 15;
const LONGEST_S: f64 = 1.5;

/// Steps of a slow motion.
const STEPS: u32 = 60;
/// A motion that lasts longer than this (s) is not followed: the equilibrium is compared instead.
const LONGEST_MOTION_S: f64 = 10.0;

/// The question about a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    /// The equilibrium.
    Rest,
    /// The state at the end of the motion, after this time, s.
    EndOfMotion(f64),
}

impl Question {
    /// The question that has a unique answer in a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let ends = scene.cables.iter().flat_map(|c| &c.supports).filter_map(|s| s.motion.as_ref()?.times_s.last());
        let last = ends.copied().fold(0.0, f64::max);
        let rubs = !scene.obstacles.is_empty();
        if rubs && last > 0.0 && last <= LONGEST_MOTION_S { Self::EndOfMotion(last) } else { Self::Rest }
    }

    /// Returns the words that are printed beside the name of a scene.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "at rest",
            Self::EndOfMotion(_) => "after its motion",
        }
    }

    fn answer(self, simulation: &mut Simulation) -> Result<Solution, SolveError> {
        let rest = simulation.settle()?;
        let Self::EndOfMotion(end_s) = self else { return Ok(rest) };
        for _ in 0..STEPS {
            simulation.step_quasi_static(end_s / f64::from(STEPS))?;
        }
        Ok(simulation.solution())
    }

    /// The answer of a model with `segments` elements; `None`, with a printed note, if there is
    /// none.
    fn ask(self, scene: &Scene, model: Model, segments: Option<usize>) -> Option<Solution> {
        let mut simulation = fresh(scene, model, segments)?;
        match self.answer(&mut simulation) {
            Ok(answer) => Some(answer),
            Err(e) => {
                eprintln!("skipped: {model} on \"{}\" with {segments:?} elements: {e}", scene.name);
                None
            }
        }
    }
}

/// The answer that is compared against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Its source.
    pub by: String,
    /// Relative uncertainty; 0 for a closed form.
    pub uncertainty: f64,
    answer: Solution,
}

/// One measured answer.
#[derive(Clone, Debug)]
pub struct Row {
    /// Id of the scene.
    pub scene: &'static str,
    /// The model.
    pub model: Model,
    /// Number of elements; `None` if the model has none.
    pub segments: Option<usize>,
    /// Least time of several solves, s.
    pub cost_s: f64,
    /// Relative error.
    pub error: f64,
    /// Greatest distance of a node from the reference position of its material point, over the
    /// cable's length.
    pub shape_error: f64,
    /// Relative error that the model itself estimates, if it does.
    pub said: Option<f64>,
}

/// Returns whether the elements of a mesh are shorter than the diameter of a cable that touches
/// itself: then each element touches its neighbours' neighbours, and an answer takes minutes.
#[must_use]
pub fn lies_in_itself(scene: &Scene, segments: usize) -> bool {
    scene.cables.iter().any(|c| c.self_contact && c.length_m < c.diameter_m * segments as f64)
}

impl Reference {
    /// The best available answer of a scene, on `finest` elements if there is no closed form.
    #[must_use]
    pub fn of(scene: &Scene, finest: usize) -> Option<Self> {
        let flexible = scene.cables.iter().all(|c| c.bending_stiffness_n_m2 == 0.0);
        if flexible
            && scene.obstacles.is_empty()
            && let Some(answer) = Question::Rest.ask(scene, Model::Catenary, None)
        {
            return Some(Self { by: "catenary".to_owned(), uncertainty: 0.0, answer });
        }
        let question = Question::of(scene);
        if let Some(answer) = question.ask(scene, Model::Spans, None) {
            return Some(Self { by: "spans".to_owned(), uncertainty: 0.0, answer });
        }
        let half = question.ask(scene, Model::Fem, Some(finest / 2))?;
        let answer = question.ask(scene, Model::Fem, Some(finest))?;
        let mut this = Self { by: format!("fem, {finest} elements"), uncertainty: 0.0, answer };
        this.uncertainty = this.error(&half);
        Some(this)
    }

    /// Greatest distance of a node of an answer from the position of its material point in the
    /// reference, over the cable's length.
    #[must_use]
    pub fn shape_error(&self, answer: &Solution) -> f64 {
        let mut worst = 0.0;
        for (a, b) in answer.cables.iter().zip(&self.answer.cables) {
            let Some(length) = b.nodes.last().map(|n| n.arc_length_m) else { continue };
            for node in &a.nodes {
                let off = position(&b.nodes, node.arc_length_m)
                    .map_or(f64::NAN, |[x, y]| (node.x_m - x).hypot(node.y_m - y) / length);
                worst = if off > worst || off.is_nan() { off } else { worst };
            }
        }
        worst
    }

    /// Relative error of an answer of the same scene.
    #[must_use]
    pub fn error(&self, answer: &Solution) -> f64 {
        let top = self.answer.max_tension().tension_n;
        let mut worst = (answer.max_tension().tension_n - top).abs();
        for (a, b) in answer.cables.iter().zip(&self.answer.cables) {
            for (a, b) in a.supports.iter().zip(&b.supports) {
                let off = (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n);
                worst = if off > worst || off.is_nan() { off } else { worst };
            }
        }
        worst / top
    }
}

/// Returns the position of a material point between nodes, m: on the cubic that has the direction
/// of the tension at both nodes, or on a straight line if there is no tension.
fn position(nodes: &[Node], arc_length_m: f64) -> Option<[f64; 2]> {
    let next = nodes.partition_point(|n| n.arc_length_m < arc_length_m).clamp(1, nodes.len().checked_sub(1)?);
    let [a, b] = [nodes.get(next - 1)?, nodes.get(next)?];
    let way = b.arc_length_m - a.arc_length_m;
    let u = if way > 0.0 { (arc_length_m - a.arc_length_m) / way } else { 0.0 };
    let [p, q] = [a, b].map(|n| [n.x_m, n.y_m]);
    let chord = (q[0] - p[0]).hypot(q[1] - p[1]);
    let slope = |n: &Node, k: usize| {
        let size = n.force_n[0].hypot(n.force_n[1]);
        if size > 0.0 { n.force_n[k] / size * chord } else { q[k] - p[k] }
    };
    let [low, high] = [u * (1.0 - u) * (1.0 - u), -u * u * (1.0 - u)];
    let smooth = u * u * (3.0 - 2.0 * u);
    let along = |k: usize| p[k] + smooth * (q[k] - p[k]) + low * slope(a, k) + high * slope(b, k);
    Some([along(0), along(1)])
}

/// Error and cost of a model; `None`, with a printed note, if it has no answer.
#[must_use]
pub fn measure(
    id: &'static str,
    scene: &Scene,
    reference: &Reference,
    (model, segments): (Model, Option<usize>),
) -> Option<Row> {
    repeated((id, scene), reference, (model, segments), REPEATS)
}

/// Does the same as [`measure`] with a single solve.
#[must_use]
pub fn once(
    id: &'static str,
    scene: &Scene,
    reference: &Reference,
    (model, segments): (Model, Option<usize>),
) -> Option<Row> {
    repeated((id, scene), reference, (model, segments), 1)
}

fn repeated(
    (id, scene): (&'static str, &Scene),
    reference: &Reference,
    (model, segments): (Model, Option<usize>),
    repeats: usize,
) -> Option<Row> {
    let start = fresh(scene, model, segments)?;
    let (mut costs, all) = (Vec::new(), Instant::now());
    let mut answer = None;
    while costs.len() < repeats && (costs.is_empty() || all.elapsed().as_secs_f64() < LONGEST_S) {
        let mut simulation = start.clone();
        let clock = Clock::start();
        let result = Question::of(scene).answer(&mut simulation);
        costs.push(clock.spent());
        match result {
            Ok(a) => answer = Some(a),
            Err(e) => {
                eprintln!("skipped: {model} on \"{id}\" with {segments:?} elements: {e}");
                return None;
            }
        }
    }
    let answer = answer?;
    let said = answer.cables.iter().filter_map(|c| c.error_estimate).reduce(f64::max);
    Some(Row {
        scene: id,
        model,
        segments,
        cost_s: Spent::least_s(&costs),
        error: reference.error(&answer),
        shape_error: reference.shape_error(&answer),
        said,
    })
}
