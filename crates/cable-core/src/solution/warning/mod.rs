//! A [`Warning`] carries its kind, its place, its cause and its numbers as data;
//! [`crate::wording`] makes the sentence.
//!
//! | room | content |
//! |---|---|
//! | `kind.rs` | kinds of warnings, with the names used in files and the window |
//! | `cause.rs` | cause of a warning, with the figures of that cause alone |
//! | `histories.rs` | other equilibria and tensions that other loading histories would have left |

mod cause;
mod histories;
mod kind;

pub use self::cause::{MeanTension, SlideReason, WarningCause};
pub use self::histories::{EndMove, Histories, ShownEquilibrium};
pub use self::kind::WarningKind;

use serde::{Deserialize, Serialize};

/// Something the user should know, with its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// The kind.
    pub kind: WarningKind,
    /// The cable's name.
    pub cable: String,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// Place in the plane, m; None = at the cable's point of that arc length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_m: Option<[f64; 2]>,
    /// Since when, s; None = it is about the last step alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since_s: Option<f64>,
    /// The value, in the SI unit of [`WarningCause::quantity`].
    pub value: f64,
    /// Its limit, same unit.
    pub limit: f64,
    /// The cause within its kind, with the figures that only this cause has.
    pub cause: WarningCause,
}

impl Warning {
    /// Returns whether two warnings have the same cause at the same place; their values may differ.
    /// A lagging support moves from place to place.
    pub(crate) fn has_cause_of(&self, other: &Self) -> bool {
        if let (Some(lags), Some(other_lags)) = (self.cause.lagging_support(), other.cause.lagging_support()) {
            return lags == other_lags && self.cable == other.cable;
        }
        self.cause == other.cause
            && self.cable == other.cable
            && (self.arc_length_m, self.at_m) == (other.arc_length_m, other.at_m)
    }

    /// A warning about the last step, or about an answer at rest; its kind is that of its cause.
    #[must_use]
    pub fn new(cause: WarningCause, cable: &str, arc_length_m: f64, [value, limit]: [f64; 2]) -> Self {
        Self {
            kind: cause.kind(),
            cable: cable.to_owned(),
            arc_length_m,
            at_m: None,
            since_s: None,
            value,
            limit,
            cause,
        }
    }

    /// Returns the warning with a place in the plane, m.
    #[must_use]
    pub fn at(self, at_m: [f64; 2]) -> Self {
        Self { at_m: Some(at_m), ..self }
    }

    /// The same of a scene whose lengths are `length` times and whose times are `time` times those
    /// of this one; forces stay. Its place is the caller's to move.
    pub(crate) fn scaled(self, length: f64, time: f64) -> Self {
        let quantity = self.cause.quantity();
        Self {
            arc_length_m: self.arc_length_m * length,
            since_s: self.since_s.map(|s| s * time),
            value: self.value * quantity.scale(length, time),
            limit: self.limit * quantity.scale(length, time),
            cause: self.cause.scaled(length, time),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A similar scene twice as large, in which time runs three times as slowly, has the same
    /// warning.
    #[test]
    fn warnings_of_a_similar_scene_are_brought_back() {
        let cause = WarningCause::Lags { support: "a".to_owned(), behind_m: 0.5 };
        let large = Warning::new(cause, "main", 3.0, [4.0, 6.0]).scaled(2.0, 3.0);
        assert_eq!((large.arc_length_m, large.value, large.limit), (6.0, 4.0 * 2.0 / 3.0, 4.0));
        assert_eq!(large.cause, WarningCause::Lags { support: "a".to_owned(), behind_m: 1.0 });
    }
}
