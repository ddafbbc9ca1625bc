//! Errors by operation, with the numbers in them.

use thiserror::Error;

use crate::files::FileError;
use crate::math::Vec2;
use crate::model::Model;
use crate::verify::Finding;

/// Anything the three-line user can meet.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Error {
    /// The scene cannot be read or is not a scene that can be solved.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The model has no answer.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Why a scene is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}{}{fault}", .at.map(|a| format!("line {}, column {}: ", a.line, a.column)).unwrap_or_default(), if .path.is_empty() { String::new() } else { format!("{path}: ") })]
pub struct SceneError {
    /// Where in the scene, for example `cables[0].length_m`.
    pub path: String,
    /// What is wrong.
    pub fault: SceneFault,
    /// Where in the text, when it came from a text.
    pub at: Option<TextPosition>,
}

/// A place in a text, both from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextPosition {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
}

/// What is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SceneFault {
    /// Not TOML, or a wrong type.
    #[error("{message}")]
    Syntax {
        /// The parser's own words.
        message: String,
    },
    /// A number out of range or not finite.
    #[error("{value} is outside the allowed range {allowed}")]
    Range {
        /// The value as given.
        value: f64,
        /// The allowed range with its unit.
        allowed: &'static str,
    },
    /// A key nobody knows.
    #[error("unknown key{}", .nearest.as_ref().map(|n| format!(", did you mean `{n}`?")).unwrap_or_default())]
    UnknownKey {
        /// The nearest known key.
        nearest: Option<String>,
    },
    /// A key that must be there, or must not.
    #[error("{what}")]
    Shape {
        /// What must be there or must not, and why.
        what: String,
    },
    /// A name that nothing has.
    #[error("there is no {what} named `{name}`{}", .nearest.as_ref().map(|n| format!(", did you mean `{n}`?")).unwrap_or_default())]
    UnknownName {
        /// What was looked for (cable, preset …).
        what: &'static str,
        /// The name as given.
        name: String,
        /// The nearest known name.
        nearest: Option<String>,
    },
    /// A route that leads through something solid.
    #[error(
        "from here the route leads {depth_m:.3} m deep through `{obstacle}` at ({x_m:.3} m, {y_m:.3} m): lead it past, on the side where the cable shall lie"
    )]
    RouteInside {
        /// The obstacle.
        obstacle: String,
        /// How deep inside it, m.
        depth_m: f64,
        /// Where, m.
        x_m: f64,
        /// Where, m.
        y_m: f64,
    },
    /// The cable is too short for the way between its supports.
    #[error(
        "the way between the supports is {way_m:.4} m, the cable is {length_m:.4} m long, and stretching to it takes {needed_n:.4e} N where it breaks at {breaking_n:.4e} N: make length_m at least {way_m:.4} m"
    )]
    TooShort {
        /// Length of the cable, m.
        length_m: f64,
        /// Straight way through all its supports, m.
        way_m: f64,
        /// Tension to stretch it there, N.
        needed_n: f64,
        /// Breaking tension, N.
        breaking_n: f64,
    },
}

/// How a cable loses its tension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TensionLoss {
    /// A free span hangs in one line and folds.
    #[error("a span folds")]
    Fold,
    /// A free span has hardly any tension left.
    #[error("a span goes slack")]
    Span,
    /// What lies on an obstacle would have to push.
    #[error("what lies goes slack")]
    Lay,
}

/// Why a model has no answer.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolveError {
    /// The iteration did not converge.
    #[error("{model} did not converge in {iterations} iterations: unbalanced force {residual_n:.3e} N at node {node} ({:.3} m, {:.3} m)", .at_m.x, .at_m.y)]
    NotConverged {
        /// The model.
        model: Model,
        /// Iterations done.
        iterations: usize,
        /// Largest unbalanced force, N.
        residual_n: f64,
        /// The node it acts on.
        node: usize,
        /// Where that node is, m.
        at_m: Vec2,
    },
    /// The only equilibrium found carries compression, which a cable cannot.
    #[error("{model} found only a state with compression {tension_n:.3e} N in element {element}: a cable cannot push")]
    Compressed {
        /// The model.
        model: Model,
        /// The element.
        element: usize,
        /// Its tension, N (negative).
        tension_n: f64,
    },
    /// The state found is not a stable equilibrium.
    #[error("{model} found a state that is not stable (indefinite tangent at node {node})")]
    Indefinite {
        /// The model.
        model: Model,
        /// The node where the factorisation met a pivot ≤ 0.
        node: usize,
    },
    /// The cable has no tension somewhere, and the model needs some everywhere.
    #[error("{model} follows a taut cable only: {loss} {arc_length_m:.3} m along it, at ({:.3} m, {:.3} m)", .at_m.x, .at_m.y)]
    TensionLost {
        /// The model.
        model: Model,
        /// In what way.
        loss: TensionLoss,
        /// Where on the cable, m.
        arc_length_m: f64,
        /// Where that is, m.
        at_m: Vec2,
    },
    /// Nothing can hold the loads.
    #[error("there is no resting place: {why}")]
    NoRestingPlace {
        /// What pulls it away.
        why: String,
    },
    /// The model cannot answer this kind of scene.
    #[error("{model} cannot answer this scene: {feature}")]
    Unsupported {
        /// The model.
        model: Model,
        /// What it lacks.
        feature: String,
    },
    /// A number blew up.
    #[error("{quantity} of node {node} is not finite at {time_s} s")]
    NonFinite {
        /// Which quantity.
        quantity: &'static str,
        /// The node.
        node: usize,
        /// Time, s.
        time_s: f64,
    },
    /// The place to go on from lies inside an obstacle.
    #[error(
        "{model} cannot go on from where the cable runs through `{obstacle}`: {depth_m:.4} m inside at {arc_length_m:.3} m along it, at ({:.3} m, {:.3} m)", .at_m.x, .at_m.y
    )]
    Buried {
        /// The model.
        model: Model,
        /// Name of the obstacle.
        obstacle: String,
        /// How deep, m.
        depth_m: f64,
        /// Where on the cable, m.
        arc_length_m: f64,
        /// Where that is, m.
        at_m: Vec2,
    },
    /// The answer breaks a law: see [`crate::verify`].
    #[error("the answer of {model} is not sound: {finding}")]
    Unsound {
        /// The model.
        model: Model,
        /// The law, the place and the figure.
        finding: Box<Finding>,
    },
    /// A time step that cannot be taken.
    #[error("a time step of {dt_s} s cannot be taken: it must lie in {allowed}")]
    TimeStep {
        /// The step asked for, s.
        dt_s: f64,
        /// The allowed range.
        allowed: &'static str,
    },
    /// The step was halved down to its floor and still failed.
    #[error(
        "{model} stopped at {time_s:.6} s: the step was halved to {dt_s:.3e} s and still failed at node {node} with {residual_n:.3e} N ({cause})"
    )]
    StepFailed {
        /// The model.
        model: Model,
        /// Time reached, s.
        time_s: f64,
        /// Smallest step tried, s.
        dt_s: f64,
        /// The worst node.
        node: usize,
        /// Its unbalanced force, N.
        residual_n: f64,
        /// Why the last try failed.
        cause: String,
    },
}
