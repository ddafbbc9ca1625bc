//! The errors of a scene and of a solve are data, by operation, with their numbers;
//! [`crate::wording`] makes the sentences.
//!
//! | room | content |
//! |---|---|
//! | `document_fault.rs` | faults of keys, names and lines of a scene |
//! | `unsupported.rs` | features that a model lacks |
//! | `no_equilibrium.rs` | reasons for which a cable has no equilibrium |
//! | `span_error.rs` | reasons for which a free span has no shape |
//! | `equilibrium_fault.rs` | faults for which a model refuses its own equilibrium |
//! | `failure_cause.rs` | reasons for which a step or a search fails |

mod document_fault;
mod equilibrium_fault;
mod failure_cause;
mod no_equilibrium;
mod span_error;
mod unsupported;

use crate::math::Vec2;
use crate::model_id::Model;
use crate::units::Quantity;
use crate::verification_report::Finding;

pub use self::document_fault::DocumentFault;
pub use self::equilibrium_fault::EquilibriumFault;
pub use self::failure_cause::FailureCause;
pub use self::no_equilibrium::NoEquilibrium;
pub use self::span_error::SpanError;
pub use self::unsupported::{Unsupported, UnsupportedReach};

/// The reason why a scene is refused.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    /// Place in the scene, for example `cables[0].length_m`.
    pub path: String,
    /// The fault.
    pub fault: SceneFault,
    /// Place in the text, when it came from a text.
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

/// The fault with a scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SceneFault {
    /// Not TOML.
    Syntax {
        /// The parser's own words.
        message: String,
    },
    /// Bytes that are not UTF-8.
    NotUtf8 {
        /// The encoding that they look like.
        encoding: Option<&'static str>,
    },
    /// A value of a wrong type.
    Type {
        /// The thing found, in the reader's words.
        found: String,
        /// The thing needed, in the reader's words.
        needed: String,
    },
    /// A list with a wrong number of elements.
    Elements {
        /// Their number.
        count: usize,
        /// The thing needed, in the reader's words.
        needed: String,
    },
    /// A number out of range or not finite.
    Range {
        /// The value as given, in SI units.
        value: f64,
        /// The least and the greatest value that is allowed.
        allowed: [f64; 2],
        /// The quantity.
        quantity: Quantity,
    },
    /// A version of the scene format that is not known.
    Version {
        /// The version as given.
        value: f64,
    },
    /// A key nobody knows.
    UnknownKey {
        /// The nearest known key.
        nearest: Option<String>,
    },
    /// A key, a name or a line that must be there, or must not.
    Document(DocumentFault),
    /// More elements than a scene may have.
    TooMany {
        /// Their number.
        count: usize,
        /// The most that there may be.
        most: usize,
    },
    /// Fewer points than an outline needs.
    TooFewPoints {
        /// Their number.
        count: usize,
        /// The number it needs.
        least: usize,
    },
    /// A series with another number of values than of times.
    UnequalCounts {
        /// Number of values.
        values: usize,
        /// Number of times.
        times: usize,
    },
    /// A time that is not after the one before.
    TimesNotIncreasing {
        /// The time, s.
        time_s: f64,
        /// The one before, s.
        before_s: f64,
    },
    /// A change of temperature that changes the length too much.
    ThermalFactor {
        /// The factor of the length.
        factor: f64,
        /// The least and the greatest that is allowed.
        allowed: [f64; 2],
    },
    /// A service tension above the breaking tension.
    ServiceAboveBreaking {
        /// Service tension, N.
        service_n: f64,
        /// Breaking tension, N.
        breaking_n: f64,
    },
    /// A load beyond the end of its cable.
    BeyondEnd {
        /// The load's arc length, m.
        arc_length_m: f64,
        /// The cable's length, m.
        length_m: f64,
    },
    /// Supports that are not in order along the cable.
    OutOfOrder {
        /// The support's arc length, m.
        arc_length_m: f64,
        /// The arc lengths between which it must lie, m.
        between_m: [f64; 2],
    },
    /// A motion that does not start where its support is.
    MotionStartsElsewhere {
        /// Start of the motion, m.
        motion_m: [f64; 2],
        /// Place of the support, m.
        support_m: [f64; 2],
    },
    /// An outline whose edges cross or touch.
    EdgesCross {
        /// Index of the first point of the other edge.
        other: usize,
        /// Ends of the edge from here and of the other one, m.
        edges_m: Box<[[[f64; 2]; 2]; 2]>,
    },
    /// A name that nothing has.
    UnknownName {
        /// Kind of the thing that was looked for (cable, preset …).
        what: &'static str,
        /// The name as given.
        name: String,
        /// The nearest known name.
        nearest: Option<String>,
    },
    /// A route that leads through something solid.
    RouteInside {
        /// The obstacle.
        obstacle: String,
        /// Depth inside it, m.
        depth_m: f64,
        /// Place, m.
        x_m: f64,
        /// Place, m.
        y_m: f64,
    },
    /// A support inside something solid.
    SupportInside {
        /// The support.
        name: Box<str>,
        /// The obstacle.
        obstacle: Box<str>,
        /// Depth of the point below the obstacle's surface, m.
        depth_m: f64,
        /// The nearest place where the cable's centre line touches nothing, m.
        clear_m: Option<[f64; 2]>,
    },
    /// A support between obstacles that leave no room for the cable.
    NoRoom {
        /// The support.
        support: Box<str>,
    },
    /// A wheel that the cable cannot reach from the support beside it.
    NoWay {
        /// The support before.
        from: Box<str>,
        /// The support after.
        to: Box<str>,
        /// Distance of their centres, m.
        apart_m: f64,
        /// Of the two the one inside the wheel of the other; None = both are in one place.
        inside: Option<Box<str>>,
    },
    /// The cable is too short for the way between its supports.
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

/// The way in which a cable loses its tension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TensionLoss {
    /// A free span hangs in one line and folds.
    Fold,
    /// A free span has hardly any tension left.
    Span,
    /// A cable that lies on an obstacle would have to push.
    Lay,
}

/// A place on a cable, in words a user can find it by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// Arc length from the cable's start, m.
    pub arc_length_m: f64,
    /// Its place, m.
    pub at_m: Vec2,
    /// The nearest support or obstacle; none where there is nothing.
    pub near: Option<Near>,
}

/// The thing nearest to a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Near {
    /// Its kind.
    pub kind: NearKind,
    /// Its name.
    pub name: String,
    /// Its distance, m; 0 where it touches.
    pub distance_m: f64,
}

/// The kind of a thing near a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NearKind {
    /// A support.
    Support,
    /// An obstacle.
    Obstacle,
}

/// The reason why a model has no answer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SolveError {
    /// The iteration did not converge.
    NotConverged {
        /// The model.
        model: Model,
        /// Iterations done.
        iterations: usize,
        /// Largest unbalanced force, N; NaN where none is known.
        residual_n: f64,
        /// Its place.
        place: Box<Place>,
    },
    /// The budget of work was spent before there was an answer.
    TooMuchWork {
        /// The model.
        model: Model,
        /// Iterations done.
        iterations: usize,
        /// Segments of the cable.
        segments: usize,
        /// Largest unbalanced force, N.
        residual_n: f64,
        /// Its place.
        place: Box<Place>,
    },
    /// The only equilibrium found carries compression, which a cable cannot.
    Compressed {
        /// The model.
        model: Model,
        /// Its tension, N (negative).
        tension_n: f64,
        /// Its place.
        place: Box<Place>,
    },
    /// The state found is not a stable equilibrium.
    Indefinite {
        /// The model.
        model: Model,
    },
    /// The cable has no tension somewhere, and the model needs some everywhere.
    TensionLost {
        /// The model.
        model: Model,
        /// In what way.
        loss: TensionLoss,
        /// Place on the cable, m.
        arc_length_m: f64,
        /// Its place, m.
        at_m: Vec2,
    },
    /// Nothing can hold the loads.
    NoRestingPlace {
        /// The force that pulls it away.
        why: NoEquilibrium,
    },
    /// The cable broke in a step without inertia, and a piece of it has no answer.
    AfterBreak {
        /// Name of the cable.
        cable: String,
        /// Time of the break, s.
        time_s: f64,
        /// Place of the break on the cable, m.
        arc_length_m: f64,
        /// Its place, m.
        at_m: Vec2,
        /// Breaking tension, N.
        breaking_n: f64,
        /// The reason of the piece.
        why: Box<Self>,
    },
    /// Two models were asked, and neither has an answer or a reason that is one for every model.
    Neither {
        /// The error that says more of the scene.
        clearer: Box<Self>,
        /// The other model's error.
        other: Box<Self>,
    },
    /// The model cannot answer this kind of scene.
    Unsupported {
        /// The model.
        model: Model,
        /// The missing capability.
        feature: Unsupported,
    },
    /// A number blew up.
    NonFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// Place on the cable, m.
        arc_length_m: f64,
        /// Time, s.
        time_s: f64,
    },
    /// The place to go on from lies inside an obstacle.
    Buried {
        /// The model.
        model: Model,
        /// Name of the obstacle.
        obstacle: String,
        /// Depth, m.
        depth_m: f64,
        /// Place on the cable, m.
        arc_length_m: f64,
        /// Its place, m.
        at_m: Vec2,
    },
    /// The answer breaks a law: see [`crate::answer_verifier`].
    Unsound {
        /// The model.
        model: Model,
        /// The law, the place and the figure.
        finding: Box<Finding>,
    },
    /// A setting that no model can work by.
    Setting {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The least and the greatest that is allowed; infinite where there is no greatest.
        allowed: [f64; 2],
        /// The quantity.
        quantity: Quantity,
    },
    /// A time step that cannot be taken.
    TimeStep {
        /// The step asked for, s.
        dt_s: f64,
        /// The longest step, s; infinite where there is none. It must be more than 0 s.
        longest_s: f64,
    },
    /// The step was halved down to its floor and still failed.
    StepFailed {
        /// The model.
        model: Model,
        /// Time reached, s.
        time_s: f64,
        /// Smallest step tried, s.
        dt_s: f64,
        /// Largest unbalanced force, N; NaN where none is known.
        residual_n: f64,
        /// Its place.
        place: Box<Place>,
        /// The reason why the last try failed.
        cause: FailureCause,
    },
}

impl SolveError {
    /// Of two models' reasons for one cable the one that a user can act on: one that holds for
    /// every model stands alone; where neither does, both are reported.
    #[must_use]
    pub(crate) fn clearer(first: Self, second: Self) -> Self {
        let certain = |e: &Self| matches!(e, Self::NoRestingPlace { .. } | Self::Buried { .. });
        // The end of a search says nothing about the scene.
        let ended = |e: &Self| matches!(e, Self::NotConverged { .. } | Self::TooMuchWork { .. });
        match (certain(&first), certain(&second)) {
            (_, true) => second,
            (true, false) => first,
            (false, false) if first == second => second,
            // A third reason would say no more.
            (false, false) if matches!(first, Self::Neither { .. }) => first,
            (false, false) => {
                let (clearer, other) = if ended(&first) { (second, first) } else { (first, second) };
                Self::Neither { clearer: Box::new(clearer), other: Box::new(other) }
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
                    near: Some(Near { kind: NearKind::Support, name: "a".to_owned(), distance_m: bad }),
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
        let clearer = SolveError::clearer(SolveError::clearer(lifts, vague(Model::Fem)), vague(Model::Fem)).to_string();
        assert!(
            clearer.starts_with(
                "spans cannot answer this scene: no support holds the cable, only loads, loose ends or obstacles; and"
            ),
            "{clearer}"
        );
        assert_eq!(clearer.matches("fem").count(), 1, "{clearer}");
    }
}
