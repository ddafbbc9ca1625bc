//! Numbers in sentences have as many digits as are read, and their unit, SI or US.

use crate::units::{FOOT_M, Quantity, UnitSystem};

/// Figures in a system of units: a number in SI units, its unit behind it.
#[derive(Clone, Copy)]
pub(super) struct Figures(pub UnitSystem);

/// Sizes within which a number is read without a power of ten.
const PLAIN_SIZES: std::ops::Range<f64> = 1e-6..1e7;

/// A number with so many decimals; one that they round to zero has no sign.
pub(super) fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|b| matches!(b, b'0' | b'.')) => size.to_owned(),
        Some(size) => format!("−{size}"),
        None => text,
    }
}

/// A number with at most six digits.
pub(super) fn six_digits(value: f64) -> String {
    at_most(value, 6)
}

/// A number with at most so many significant digits, without zeros at its end and without a power
/// of ten.
pub(super) fn at_most(value: f64, digits: usize) -> String {
    format!("{}", round_to(value, digits)).replace('-', "−")
}

/// A number with so many significant digits, those that are zero included; a power of ten where it
/// is very small or very large.
pub(super) fn significant(value: f64, digits: usize) -> String {
    let value = round_to(value, digits);
    let last = digits.saturating_sub(1);
    if value == 0.0 || !value.is_finite() {
        return format!("{value}").replace('-', "−");
    }
    if !PLAIN_SIZES.contains(&value.abs()) {
        return in_powers_of_ten(&format!("{value:.last$e}"));
    }
    let decimals = (last as f64 - value.abs().log10().floor()).max(0.0);
    rounded(value, decimals as usize)
}

/// A ratio in per cent with at most two digits.
pub(super) fn percent(ratio: f64) -> String {
    let shown = round_to(100.0 * ratio, 2);
    let text = if shown == 0.0 || PLAIN_SIZES.contains(&shown.abs()) {
        at_most(shown, 2)
    } else {
        in_powers_of_ten(&format!("{shown:e}"))
    };
    text + " %"
}

/// Significant digits of a number that was given, or that was `converted` to another unit.
fn given_digits(value: f64, converted: f64) -> usize {
    if converted == value { 6 } else { 5 }
}

/// The number that so many significant digits are of.
fn round_to(value: f64, digits: usize) -> f64 {
    let last = digits.saturating_sub(1);
    format!("{value:.last$e}").parse().unwrap_or(value)
}

/// `1.5e-9` as it is printed in books: 1.5×10^−9.
fn in_powers_of_ten(scientific: &str) -> String {
    let text = match scientific.split_once('e') {
        Some(("1", power)) => format!("10^{power}"),
        Some((number, power)) => format!("{number}×10^{power}"),
        None => scientific.to_owned(),
    };
    text.replace('-', "−")
}

impl Figures {
    /// The number with this many decimals.
    pub(super) fn fixed(self, quantity: Quantity, value: f64, decimals: usize) -> String {
        self.with_unit(quantity, rounded(quantity.convert(value, self.0), decimals))
    }

    /// The number with this many significant digits, however small or large it is.
    pub(super) fn significant(self, quantity: Quantity, value: f64, digits: usize) -> String {
        self.with_unit(quantity, self.bare_significant(quantity, value, digits))
    }

    /// The same without the unit.
    pub(super) fn bare_significant(self, quantity: Quantity, value: f64, digits: usize) -> String {
        significant(quantity.convert(value, self.0), digits)
    }

    /// As it was given, with six digits; converted, with five.
    pub(super) fn given(self, quantity: Quantity, value: f64) -> String {
        self.with_unit(quantity, self.bare(quantity, value))
    }

    /// The same without the unit.
    pub(super) fn bare(self, quantity: Quantity, value: f64) -> String {
        let converted = quantity.convert(value, self.0);
        // A computed value, or one dragged by a hand, has more digits than anyone reads.
        at_most(converted, given_digits(value, converted))
    }

    /// A number beside the ends of its range, or one of them, without the unit; a power of ten
    /// where it is very small or large.
    pub(super) fn bound(self, quantity: Quantity, value: f64) -> String {
        let converted = quantity.convert(value, self.0);
        let shown = round_to(converted, given_digits(value, converted));
        if shown == 0.0 || PLAIN_SIZES.contains(&shown.abs()) {
            self.bare(quantity, value)
        } else {
            in_powers_of_ten(&format!("{shown:e}"))
        }
    }

    pub(super) fn with_unit(self, quantity: Quantity, number: String) -> String {
        match quantity.symbol(self.0) {
            "" => number,
            symbol => format!("{number} {symbol}"),
        }
    }

    /// A length (m) with this many decimals.
    pub(super) fn length(self, length_m: f64, decimals: usize) -> String {
        self.fixed(Quantity::Length, length_m, decimals)
    }

    /// A radius (m) of a bend in millimetres or inches, with three digits.
    pub(super) fn radius(self, radius_m: f64) -> String {
        let (symbol, unit_m) = match self.0 {
            UnitSystem::Si => ("mm", 1e-3),
            UnitSystem::Us => ("in", FOOT_M / 12.0),
        };
        format!("{} {symbol}", at_most(radius_m / unit_m, 3))
    }

    /// A length (m) with three decimals, or three digits where it is small or huge.
    pub(super) fn distance(self, length_m: f64) -> String {
        let size = length_m.abs();
        if size > 0.0 && size < 0.01 || size >= 1e6 {
            self.significant(Quantity::Length, length_m, 3)
        } else {
            self.length(length_m, 3)
        }
    }

    /// A point (m) with this many decimals.
    pub(super) fn point(self, at_m: [f64; 2], decimals: usize) -> String {
        format!("({}, {})", self.length(at_m[0], decimals), self.length(at_m[1], decimals))
    }

    /// A point (m) as it was given.
    pub(super) fn given_point(self, at_m: [f64; 2]) -> String {
        format!("({}, {})", self.given(Quantity::Length, at_m[0]), self.given(Quantity::Length, at_m[1]))
    }

    /// A force (N) with this many decimals.
    pub(super) fn force(self, force_n: f64, decimals: usize) -> String {
        self.fixed(Quantity::Force, force_n, decimals)
    }

    /// From one force (N) to another, with two decimals; one number where these are the same.
    pub(super) fn forces(self, [from_n, to_n]: [f64; 2]) -> String {
        let (from, to) = (self.force(from_n, 2), self.force(to_n, 2));
        if from == to {
            return to;
        }
        format!("{} to {to}", rounded(Quantity::Force.convert(from_n, self.0), 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::SpanError;
    use crate::wording::Sentence;

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

    /// Residuals were written "3.060e-4 N", and "-1" stood beside "−1" of the window.
    #[test]
    fn numbers_of_any_size_are_written_as_engineers_write_them() {
        for (value, digits, text) in [
            (3.06e-4, 3, "0.000306"),
            (12.0, 4, "12.00"),
            (-0.1, 2, "−0.10"),
            (9.999_99, 4, "10.00"),
            (4_000.0, 4, "4000"),
            (123_456.0, 4, "123500"),
            (1.5e-9, 2, "1.5×10^−9"),
            (-2.5e12, 2, "−2.5×10^12"),
            (0.0, 4, "0"),
        ] {
            assert_eq!(significant(value, digits), text);
        }
        assert_eq!([0.02, 1e-3, 0.123, 3.2e-5, 0.0].map(percent), ["2 %", "0.1 %", "12 %", "0.0032 %", "0 %"]);
        assert_eq!(rounded(-1.25, 1), "−1.2");
        assert_eq!(rounded(-0.01, 1), "0.0");
        let bound = |value: f64| Figures(UnitSystem::Si).bound(Quantity::Number, value);
        assert_eq!([1e6, 1e9, -0.01, 1e-14].map(bound), ["1000000", "10^9", "−0.01", "10^−14"]);
    }
}
