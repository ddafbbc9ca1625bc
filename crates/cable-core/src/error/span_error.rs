//! This file lists the reasons for which a free span has no shape.

/// The reason why a span has no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpanError {
    /// A number that is not finite or not positive where it must be.
    NotANumber,
    /// No load and no tension: any shape will do.
    Slack {
        /// Its length, m.
        length_m: f64,
        /// Distance of its ends, m.
        chord_m: f64,
    },
    /// Inextensible and not longer than the way.
    TooShort {
        /// Its length, m.
        length_m: f64,
        /// Distance of its ends, m.
        chord_m: f64,
    },
    /// Newton stopped early.
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Distance between the computed end and the given one, m.
        closure_m: f64,
    },
}
