//! The sentences of warnings, errors and verdicts are made here from their data, in SI or US units.
//!
//! | room | sentences |
//! |---|---|
//! | `mod.rs` | [`Sentence`], and figures with their units |
//! | `warning.rs` | warnings |
//! | `scene_error.rs` | why a scene is refused |
//! | `solve_error.rs` | why a model has no answer |
//! | `model_reason.rs` | why a model was taken |
//! | `inertia.rs` | how fast a motion is, and whether masses matter in it |
//! | `file_error.rs` | why a file is not read or written |
//! | `import.rs` | what an import changed, and why it is refused |
//! | `verification.rs` | verdicts of the laws of mechanics |
//!
//! `Display` writes the sentence in SI units. Names stand between backticks.

mod file_error;
mod import;
mod inertia;
mod model_reason;
mod scene_error;
mod solve_error;
mod verification;
mod warning;

use crate::units::{FOOT_M, Quantity, UnitSystem};

/// Data that can be expressed as a sentence.
pub trait Sentence {
    /// The sentence in a system of units, without a full stop.
    fn sentence(&self, units: UnitSystem) -> String;
}

/// `Display` as the sentence in SI units.
macro_rules! display_in_si {
    ($($data:ty),+) => {$(
        impl std::fmt::Display for $data {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(&crate::wording::Sentence::sentence(self, crate::units::UnitSystem::Si))
            }
        }
    )+};
}
pub(crate) use display_in_si;

/// Serialises data as its sentence in SI units: files and JSON hold the words.
macro_rules! serialize_in_si {
    ($($data:ty),+) => {$(
        impl serde::Serialize for $data {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(&crate::wording::Sentence::sentence(self, crate::units::UnitSystem::Si))
            }
        }
    )+};
}
pub(crate) use serialize_in_si;

/// Figures in a system of units: a number in SI units, its unit behind it.
#[derive(Clone, Copy)]
struct Figures(UnitSystem);

/// A number with so many decimals; one that they round to zero has no sign.
fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|b| matches!(b, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}

/// A number with at most six digits.
fn six_digits(value: f64) -> String {
    shortened(format!("{value:.5e}"))
}

/// A power of ten as a plain number without zeros at its end.
fn shortened(power: String) -> String {
    power.parse::<f64>().map_or(power, |value| format!("{value}"))
}

impl Figures {
    /// The number with this many decimals.
    fn fixed(self, quantity: Quantity, value: f64, decimals: usize) -> String {
        self.with_unit(quantity, rounded(quantity.convert(value, self.0), decimals))
    }

    /// The number in scientific notation with this many decimals.
    fn power(self, quantity: Quantity, value: f64, decimals: usize) -> String {
        self.with_unit(quantity, self.bare_power(quantity, value, decimals))
    }

    /// The same without the unit.
    fn bare_power(self, quantity: Quantity, value: f64, decimals: usize) -> String {
        format!("{:.decimals$e}", quantity.convert(value, self.0))
    }

    /// As it was given, with six digits; converted, with five.
    fn given(self, quantity: Quantity, value: f64) -> String {
        self.with_unit(quantity, self.bare(quantity, value))
    }

    /// The same without the unit.
    fn bare(self, quantity: Quantity, value: f64) -> String {
        let converted = quantity.convert(value, self.0);
        // A computed value, or one dragged by a hand, has more digits than anyone reads.
        if converted == value { six_digits(value) } else { shortened(format!("{converted:.4e}")) }
    }

    /// A number beside the ends of its range, or one of them, without the unit; a power of ten
    /// where it is small or large.
    fn bound(self, quantity: Quantity, value: f64) -> String {
        let text = self.bare(quantity, value);
        match text.parse::<f64>() {
            Ok(shown) if shown != 0.0 && !(1e-3..1e6).contains(&shown.abs()) => format!("{shown:e}"),
            _ => text,
        }
    }

    fn with_unit(self, quantity: Quantity, number: String) -> String {
        match quantity.symbol(self.0) {
            "" => number,
            symbol => format!("{number} {symbol}"),
        }
    }

    /// A length (m) with this many decimals.
    fn length(self, length_m: f64, decimals: usize) -> String {
        self.fixed(Quantity::Length, length_m, decimals)
    }

    /// A radius (m) of a bend in millimetres or inches, with three digits.
    fn radius(self, radius_m: f64) -> String {
        let (symbol, unit_m) = match self.0 {
            UnitSystem::Si => ("mm", 1e-3),
            UnitSystem::Us => ("in", FOOT_M / 12.0),
        };
        format!("{} {symbol}", shortened(format!("{:.2e}", radius_m / unit_m)))
    }

    /// A length (m) with three decimals, or three digits where it is small or huge.
    fn distance(self, length_m: f64) -> String {
        let size = length_m.abs();
        if size > 0.0 && size < 0.01 || size >= 1e6 {
            self.power(Quantity::Length, length_m, 2)
        } else {
            self.length(length_m, 3)
        }
    }

    /// A point (m) with this many decimals.
    fn point(self, at_m: [f64; 2], decimals: usize) -> String {
        format!("({}, {})", self.length(at_m[0], decimals), self.length(at_m[1], decimals))
    }

    /// A point (m) as a scene has it, without a unit.
    fn bare_point(self, at_m: [f64; 2]) -> String {
        format!("[{}, {}]", self.bare(Quantity::Length, at_m[0]), self.bare(Quantity::Length, at_m[1]))
    }

    /// A force (N) with this many decimals.
    fn force(self, force_n: f64, decimals: usize) -> String {
        self.fixed(Quantity::Force, force_n, decimals)
    }

    /// From one force (N) to another, with two decimals.
    fn forces(self, [from_n, to_n]: [f64; 2]) -> String {
        format!("{} to {}", rounded(Quantity::Force.convert(from_n, self.0), 2), self.force(to_n, 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::SpanError;

    /// A chord that was computed had sixteen digits.
    #[test]
    fn a_number_that_was_computed_has_six_digits() {
        let slack = SpanError::Slack { length_m: 12.0, chord_m: 98.0_f64.sqrt() };
        let told = "a cable of 12 m without weight is slack over 9.89949 m: it has no one shape";
        assert_eq!(slack.sentence(UnitSystem::Si), told);
        assert_eq!(six_digits(0.14), "0.14");
        assert_eq!(six_digits(1e6), "1000000");
        assert_eq!(six_digits(f64::NAN), "NaN");
    }
}
