//! The errors of a scene and of a solve, by operation, with the numbers in them.

mod no_equilibrium;
mod unsupported;

use thiserror::Error;

use crate::math::Vec2;
use crate::model_id::Model;
use crate::solution::verification::Finding;

pub use self::no_equilibrium::{FailureCause, NoEquilibrium};
pub use self::unsupported::{Unsupported, UnsupportedReach};

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
    /// A support inside something solid.
    #[error(
        "support `{name}` is {depth_m:.4} m inside `{obstacle}`{}", .clear_m.map(|[x, y]| format!(": the nearest place clear of it is [{x:.4}, {y:.4}]")).unwrap_or_default()
    )]
    SupportInside {
        /// The support.
        name: Box<str>,
        /// The obstacle.
        obstacle: Box<str>,
        /// How deep the point is below the obstacle's surface, m.
        depth_m: f64,
        /// The nearest place where the cable's centre line touches nothing, m.
        clear_m: Option<[f64; 2]>,
    },
    /// A wheel that the cable cannot reach from the support beside it.
    #[error(
        "`{from}` and `{to}` are {apart_m:.4} m apart, and no cable leads from one to the other: {reason}. Move one, make the wheel smaller, or leave one out"
    )]
    NoWay {
        /// The support before.
        from: Box<str>,
        /// The support after.
        to: Box<str>,
        /// Distance of their centres, m.
        apart_m: f64,
        /// Why not.
        reason: Box<str>,
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

/// A place on a cable, in words a user can find it by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// Arc length from the cable's start, m.
    pub arc_length_m: f64,
    /// Where that is, m.
    pub at_m: Vec2,
    /// The nearest support or obstacle by kind and name, and its distance, m; none where there is
    /// nothing.
    pub near: Option<(String, f64)>,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.arc_length_m.is_finite() {
            true => write!(f, "{} along the cable", metres(self.arc_length_m))?,
            false => write!(f, "somewhere along the cable")?,
        }
        if self.at_m.iter().all(|c| c.is_finite()) {
            write!(f, ", at ({}, {})", metres(self.at_m.x), metres(self.at_m.y))?;
        }
        match &self.near {
            Some((name, distance)) if distance.is_finite() && *distance > 0.0 => {
                write!(f, ", {} from {name}", metres(*distance))
            }
            Some((name, _)) => write!(f, ", at {name}"),
            None => Ok(()),
        }
    }
}

/// A length in metres with three decimals, or three digits where it is small.
fn metres(length_m: f64) -> String {
    let size = length_m.abs();
    if size > 0.0 && size < 0.01 || size >= 1e6 { format!("{length_m:.2e} m") } else { format!("{length_m:.3} m") }
}

/// A force that no cable bears, N: left over it says that a search ran away, not how much is
/// missing.
const MAX_CREDIBLE_FORCE_N: f64 = 1e9;

/// A force that is left over, where a solver knows one: a figure that is not finite, or beyond all
/// measure, says nothing to anybody.
fn left_over(residual_n: f64) -> String {
    if residual_n.abs() < MAX_CREDIBLE_FORCE_N {
        format!("{residual_n:.3e} N stay unbalanced")
    } else {
        "no balance of forces was reached".to_owned()
    }
}

/// A time in seconds, where it is one.
fn seconds(time_s: f64) -> String {
    if time_s.is_finite() { format!("{time_s} s") } else { "no finite time".to_owned() }
}

/// Why a model has no answer. Every text says where, in metres and names, and what can be done;
/// none holds a number that is not finite.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolveError {
    /// The iteration did not converge.
    #[error("{model} found no resting place: {} {place}. Lay the cable by another way there (route_m), or ask another model", left_over(*.residual_n))]
    NotConverged {
        /// The model.
        model: Model,
        /// Iterations done.
        iterations: usize,
        /// Largest unbalanced force, N; NaN where none is known.
        residual_n: f64,
        /// Where it acts.
        place: Box<Place>,
    },
    /// The budget of work was spent before there was an answer.
    #[error("{model} has found no resting place with {segments} segments by all the work it does for one: {} {place}. Draw the cable a route_m nearer to where it will lie, or give it fewer segments", left_over(*.residual_n))]
    TooMuchWork {
        /// The model.
        model: Model,
        /// Iterations done.
        iterations: usize,
        /// Segments of the cable.
        segments: usize,
        /// Largest unbalanced force, N.
        residual_n: f64,
        /// Where it acts.
        place: Box<Place>,
    },
    /// The only equilibrium found carries compression, which a cable cannot.
    #[error("{model} found only a state in which the cable pushes{} {place}, and a cable cannot push: it needs more tension there, or another model", if .tension_n.is_finite() && *.tension_n < 0.0 { format!(" with {:.3e} N", -.tension_n) } else { String::new() })]
    Compressed {
        /// The model.
        model: Model,
        /// Its tension, N (negative).
        tension_n: f64,
        /// Where.
        place: Box<Place>,
    },
    /// The state found is not a stable equilibrium.
    #[error(
        "{model} found only a shape that does not stay (it would snap to another): lay the cable on the side where it shall rest (route_m)"
    )]
    Indefinite {
        /// The model.
        model: Model,
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
        why: NoEquilibrium,
    },
    /// Two models were asked, and neither has an answer or a reason that is one for every model.
    #[error("{told}; and {other}")]
    Neither {
        /// What says more of the scene.
        told: Box<Self>,
        /// What the other model said.
        other: Box<Self>,
    },
    /// The model cannot answer this kind of scene.
    #[error("{model} cannot answer this scene: {feature}")]
    Unsupported {
        /// The model.
        model: Model,
        /// What it lacks.
        feature: Unsupported,
    },
    /// A number blew up.
    #[error("{quantity} is no finite number {} along the cable at {}: a time step, a load or a stiffness is far out of proportion to the others", metres(*.arc_length_m), seconds(*.time_s))]
    NonFinite {
        /// Which quantity.
        quantity: &'static str,
        /// Where on the cable, m.
        arc_length_m: f64,
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
    /// A setting that no model can work by.
    #[error("the setting {name} = {value} cannot be worked by: it must lie in {allowed}")]
    Setting {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The allowed range.
        allowed: &'static str,
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
        "{model} stopped at {time_s:.6} s: the step was halved to {dt_s:.3e} s and still failed: {} {place} ({cause})", left_over(*.residual_n)
    )]
    StepFailed {
        /// The model.
        model: Model,
        /// Time reached, s.
        time_s: f64,
        /// Smallest step tried, s.
        dt_s: f64,
        /// Largest unbalanced force, N; NaN where none is known.
        residual_n: f64,
        /// Where it acts.
        place: Box<Place>,
        /// Why the last try failed.
        cause: FailureCause,
    },
}

impl SolveError {
    /// Of two models' reasons for one cable the one that a user can act on: what is so whatever the
    /// model is told alone; where neither says that, both are.
    #[must_use]
    pub(crate) fn clearer(first: Self, second: Self) -> Self {
        let certain = |e: &Self| matches!(e, Self::NoRestingPlace { .. } | Self::Buried { .. });
        // That a search ended says nothing of the scene.
        let ended = |e: &Self| matches!(e, Self::NotConverged { .. } | Self::TooMuchWork { .. });
        match (certain(&first), certain(&second)) {
            (_, true) => second,
            (true, false) => first,
            (false, false) if first == second => second,
            // A third reason would say no more.
            (false, false) if matches!(first, Self::Neither { .. }) => first,
            (false, false) => {
                let (told, other) = if ended(&first) { (second, first) } else { (first, second) };
                Self::Neither { told: Box::new(told), other: Box::new(other) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every text with every figure not finite.
    #[test]
    fn no_text_holds_a_number_that_is_not_finite() {
        let model = Model::Fem;
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let place = || {
                Box::new(Place {
                    arc_length_m: bad,
                    at_m: Vec2::new(bad, 1.0),
                    near: Some(("support `a`".to_owned(), bad)),
                })
            };
            let all = [
                SolveError::NotConverged { model, iterations: 7, residual_n: bad, place: place() },
                SolveError::Compressed { model, tension_n: bad, place: place() },
                SolveError::StepFailed {
                    model,
                    time_s: 0.0,
                    dt_s: 1e-3,
                    residual_n: bad,
                    place: place(),
                    cause: FailureCause::NoDescent,
                },
                SolveError::NonFinite { quantity: "position", arc_length_m: 1.0, time_s: bad },
            ];
            for error in all {
                let text = error.to_string();
                assert!(!text.contains("NaN") && !text.contains("inf "), "{text}");
                assert!(!text.contains("node") && !text.contains("iteration"), "{text}");
            }
        }
    }

    #[test]
    fn the_clearer_reason_of_two_models_is_told() {
        let vague = |model| SolveError::NotConverged { model, iterations: 1, residual_n: 1.0, place: Box::default() };
        let clear = SolveError::NoRestingPlace { why: NoEquilibrium::SlidesOff };
        assert_eq!(SolveError::clearer(clear.clone(), vague(Model::Fem)), clear);
        assert_eq!(SolveError::clearer(vague(Model::Spans), clear.clone()), clear);
        let both = SolveError::clearer(vague(Model::Spans), vague(Model::Fem)).to_string();
        assert!(both.contains("spans") && both.contains("fem"), "{both}");
        let lifts = SolveError::Unsupported { model: Model::Spans, feature: Unsupported::NothingHolds };
        let told = SolveError::clearer(SolveError::clearer(lifts, vague(Model::Fem)), vague(Model::Fem)).to_string();
        assert!(told.starts_with("spans cannot answer this scene: no support holds the cable: two loads or loose ends, and obstacles at most; and"), "{told}");
        assert_eq!(told.matches("fem").count(), 1, "{told}");
    }
}
