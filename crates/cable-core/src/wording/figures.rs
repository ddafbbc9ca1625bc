//! Numbers in sentences have as many digits as are read, and their unit, SI or US.

use crate::units::{FOOT_M, Quantity, UnitSystem};

/// Figures in a system of units: a number in SI units, its unit behind it.
#[derive(Clone, Copy)]
pub(super) struct Figures(pub UnitSystem);

/// A number with so many decimals; one that they round to zero has no sign.
pub(super) fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|b| matches!(b, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}

/// A number with at most six digits.
pub(super) fn six_digits(value: f64) -> String {
    shortened(format!("{value:.5e}"))
}

/// A power of ten as a plain number without zeros at its end.
pub(super) fn shortened(power: String) -> String {
    power.parse::<f64>().map_or(power, |value| format!("{value}"))
}

impl Figures {
    /// The number with this many decimals.
    pub(super) fn fixed(self, quantity: Quantity, value: f64, decimals: usize) -> String {
        self.with_unit(quantity, rounded(quantity.convert(value, self.0), decimals))
    }

    /// The number in scientific notation with this many decimals.
    pub(super) fn power(self, quantity: Quantity, value: f64, decimals: usize) -> String {
        self.with_unit(quantity, self.bare_power(quantity, value, decimals))
    }

    /// The same without the unit.
    pub(super) fn bare_power(self, quantity: Quantity, value: f64, decimals: usize) -> String {
        format!("{:.decimals$e}", quantity.convert(value, self.0))
    }

    /// As it was given, with six digits; converted, with five.
    pub(super) fn given(self, quantity: Quantity, value: f64) -> String {
        self.with_unit(quantity, self.bare(quantity, value))
    }

    /// The same without the unit.
    pub(super) fn bare(self, quantity: Quantity, value: f64) -> String {
        let converted = quantity.convert(value, self.0);
        // A computed value, or one dragged by a hand, has more digits than anyone reads.
        if converted == value { six_digits(value) } else { shortened(format!("{converted:.4e}")) }
    }

    /// A number beside the ends of its range, or one of them, without the unit; a power of ten
    /// where it is small or large.
    pub(super) fn bound(self, quantity: Quantity, value: f64) -> String {
        let text = self.bare(quantity, value);
        match text.parse::<f64>() {
            Ok(shown) if shown != 0.0 && !(1e-3..1e6).contains(&shown.abs()) => format!("{shown:e}"),
            _ => text,
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
        format!("{} {symbol}", shortened(format!("{:.2e}", radius_m / unit_m)))
    }

    /// A length (m) with three decimals, or three digits where it is small or huge.
    pub(super) fn distance(self, length_m: f64) -> String {
        let size = length_m.abs();
        if size > 0.0 && size < 0.01 || size >= 1e6 {
            self.power(Quantity::Length, length_m, 2)
        } else {
            self.length(length_m, 3)
        }
    }

    /// A point (m) with this many decimals.
    pub(super) fn point(self, at_m: [f64; 2], decimals: usize) -> String {
        format!("({}, {})", self.length(at_m[0], decimals), self.length(at_m[1], decimals))
    }

    /// A point (m) as a scene has it, without a unit.
    pub(super) fn bare_point(self, at_m: [f64; 2]) -> String {
        format!("[{}, {}]", self.bare(Quantity::Length, at_m[0]), self.bare(Quantity::Length, at_m[1]))
    }

    /// A force (N) with this many decimals.
    pub(super) fn force(self, force_n: f64, decimals: usize) -> String {
        self.fixed(Quantity::Force, force_n, decimals)
    }

    /// From one force (N) to another, with two decimals.
    pub(super) fn forces(self, [from_n, to_n]: [f64; 2]) -> String {
        format!("{} to {}", rounded(Quantity::Force.convert(from_n, self.0), 2), self.force(to_n, 2))
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
}
