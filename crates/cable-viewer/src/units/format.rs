//! Figures are written with four digits and their unit, for panels and graphs.

use crate::units::system;
use crate::units::unit::{DIGITS, TIMES, Unit};

/// The round step (1, 2 or 5 times a power of ten) that cuts a range into about so many parts.
pub fn round_step(range: f64, parts: f64) -> f64 {
    let raw = range / parts;
    if !(raw.is_finite() && raw > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0].map(|k| k * power).into_iter().find(|step| *step >= raw * (1.0 - 1e-9));
    step.unwrap_or(10.0 * power)
}

/// A factor of real time with three digits.
#[must_use]
pub fn times(factor: f64) -> String {
    quantity(factor, 3, "×")
}

/// Smaller forces (N) are what rounding leaves of a balance: they read 0.
const MIN_FORCE_N: f64 = 1e-9;

/// A force with N, kN or MN, N.
#[must_use]
pub fn force(value_n: f64) -> String {
    scaled(if value_n.abs() < MIN_FORCE_N { 0.0 } else { value_n }, system::Kind::Force)
}

/// The components of a force, N, each with its direction in a word.
#[must_use]
pub fn force_with_direction([x_n, y_n]: [f64; 2]) -> [String; 2] {
    let across = if x_n < 0.0 { "left" } else { "right" };
    let along = if y_n < 0.0 { "down" } else { "up" };
    [format!("{} {across}", force(x_n.abs())), format!("{} {along}", force(y_n.abs()))]
}

/// A stress with Pa, kPa, MPa or GPa, Pa.
#[must_use]
pub fn stress(value_pa: f64) -> String {
    scaled(value_pa, system::Kind::Stress)
}

/// A strain in % or µm/m.
#[must_use]
pub fn strain(value: f64) -> String {
    if value.abs() >= 1e-3 { quantity(value * 1e2, DIGITS, "%") } else { quantity(value * 1e6, DIGITS, "µm/m") }
}

/// An energy, J.
#[must_use]
pub fn energy(value_j: f64) -> String {
    scaled(value_j, system::Kind::Energy)
}

/// A length in m, mm or µm, m.
#[must_use]
pub fn length(value_m: f64) -> String {
    scaled(value_m, system::Kind::Length)
}

/// A length and the least one that is allowed, m, both in the unit of the greater: `163.0 ≥ 140.0
/// mm`.
#[must_use]
pub fn length_beside_limit(value_m: f64, limit_m: f64) -> String {
    let (symbol, si) = system::for_size(system::Kind::Length, value_m.max(limit_m));
    let sign = if value_m < limit_m { '<' } else { '≥' };
    format!("{} {sign} {}", significant(value_m / si, DIGITS), quantity(limit_m / si, DIGITS, symbol))
}

/// A duration in s, ms or µs, s.
#[must_use]
pub fn duration(value_s: f64) -> String {
    duration_with(value_s, DIGITS)
}

/// A duration with three digits: a wall time is never the same twice.
#[must_use]
pub fn rough_duration(value_s: f64) -> String {
    duration_with(value_s, 3)
}

fn duration_with(value_s: f64, digits: usize) -> String {
    let size = value_s.abs();
    let found = TIMES.iter().find(|(_, si)| size >= *si).or(TIMES.last());
    let (symbol, si) = found.filter(|_| size > 0.0 && size.is_finite()).copied().unwrap_or(("s", 1.0));
    quantity(value_s / si, digits, symbol)
}

/// Smaller ratios are not written with their power of ten: nobody reads more into it than that it
/// is very small.
pub const MIN_RATIO: f64 = 1e-6;

/// A ratio in per cent with three digits.
#[must_use]
pub fn percent(ratio: f64) -> String {
    if ratio.abs() < MIN_RATIO && ratio != 0.0 {
        return "< 0.0001 %".to_owned();
    }
    quantity(ratio * 1e2, 3, "%")
}

/// A position, m, to the millimetre.
#[must_use]
pub fn position(at_m: [f64; 2]) -> String {
    let Unit { symbol, si, .. } = Unit::M.display();
    format!("({:.3}, {:.3}) {symbol}", at_m[0] / si, at_m[1] / si).replace('-', "−")
}

fn scaled(value: f64, kind: system::Kind) -> String {
    let (symbol, si) = system::for_size(kind, value);
    quantity(value / si, DIGITS, symbol)
}

/// A number with so many significant digits; very large and small ones as powers of ten.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "no data".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let last = digits.saturating_sub(1);
    // Rounded first, so that 9.9999 counts as 10.00.
    let scientific = format!("{value:.last$e}");
    let exponent: i32 = scientific.rsplit('e').next().and_then(|e| e.parse().ok()).unwrap_or(0);
    let text = if (-4..=7).contains(&exponent) {
        let decimals = usize::try_from(i32::try_from(last).unwrap_or(0) - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        in_powers_of_ten(&scientific)
    };
    text.replace('-', "−")
}

/// A number with at most so many significant digits as a multiple of a power of ten, for what is
/// read by its order of magnitude.
#[must_use]
pub fn magnitude(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return significant(value, digits);
    }
    let last = digits.saturating_sub(1);
    let scientific = format!("{value:.last$e}");
    match scientific.split_once('e') {
        Some((number, power)) if number.contains('.') => {
            let number = number.trim_end_matches('0').trim_end_matches('.');
            in_powers_of_ten(&format!("{number}e{power}"))
        }
        _ => in_powers_of_ten(&scientific),
    }
}

/// `1.5e-9` as it is printed in books: 1.5×10^−9.
fn in_powers_of_ten(scientific: &str) -> String {
    scientific.replace('e', "×10^").replace('-', "−")
}

/// A value with so many significant digits and its symbol; "no data" alone where it is no number.
#[must_use]
pub fn quantity(value: f64, digits: usize, symbol: &str) -> String {
    let number = significant(value, digits);
    if value.is_finite() { with_symbol(number, symbol) } else { number }
}

/// A number and the symbol behind it.
#[must_use]
pub fn with_symbol(number: String, symbol: &str) -> String {
    match symbol {
        "" => number,
        "°" | "×" => number + symbol,
        _ => format!("{number} {symbol}"),
    }
}

impl Unit {
    /// A value (SI) with [`DIGITS`] digits, or the unit's own decimals, and the unit. Below one,
    /// zeros at its end are left out: they read as if more were known.
    #[must_use]
    pub fn text(self, value: f64) -> String {
        let unit = self.display();
        let shown = value / unit.si;
        match unit.decimals {
            Some(decimals) if value.is_finite() => {
                with_symbol(format!("{shown:.decimals$}").replace('-', "−"), unit.symbol)
            }
            _ if (1e-4..1.0).contains(&shown.abs()) => {
                let text = significant(shown, DIGITS);
                with_symbol(text.trim_end_matches('0').trim_end_matches('.').to_owned(), unit.symbol)
            }
            _ => quantity(shown, DIGITS, unit.symbol),
        }
    }

    /// A value (SI) with all its digits and the unit, to be edited.
    #[must_use]
    pub fn exact(self, value: f64) -> String {
        // Division by the unit may add a last wrong digit; 15 digits are what decimal text keeps.
        with_symbol(self.rounded(value, 15), self.display().symbol)
    }

    /// A value (SI) with at most six digits and the unit, to be read: `28 mm`, `463.228 N`.
    #[must_use]
    pub fn brief(self, value: f64) -> String {
        with_symbol(self.rounded(value, 6).replace('-', "−"), self.display().symbol)
    }

    /// The number alone, as it may be typed.
    fn rounded(self, value: f64, digits: usize) -> String {
        let unit = self.display();
        let shown = value / unit.si;
        let last = digits.saturating_sub(1);
        let rounded: f64 = format!("{shown:.last$e}").parse().unwrap_or(shown);
        match rounded.abs() {
            0.0 => "0".to_owned(),
            size if (1e-4..1e9).contains(&size) => format!("{rounded}"),
            _ => format!("{rounded:e}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_keep_their_digits() {
        for (value, text) in [
            (12.0, "12.00"),
            (1.246, "1.246"),
            (9.9999, "10.00"),
            (0.0, "0"),
            (-0.5, "−0.5000"),
            (123_456.7, "123457"),
            (1.5e-9, "1.500×10^−9"),
            (-2.5e12, "−2.500×10^12"),
            (f64::NAN, "no data"),
        ] {
            assert_eq!(significant(value, 4), text);
        }
    }

    /// A breaking tension of 90 N read "0.09000 kN".
    #[test]
    fn values_as_given_have_no_zeros_at_their_end_below_one() {
        assert_eq!(Unit::KN.text(90.0), "0.09 kN");
        assert_eq!(Unit::KN.text(10e3), "10.00 kN");
        assert_eq!(Unit::KN.text(999.96), "1 kN");
        assert_eq!(Unit::PLAIN_NUMBER.text(0.5), "0.5");
        assert_eq!(Unit::PLAIN_NUMBER.text(-0.123_456), "−0.1235");
        assert_eq!(Unit::COORDINATE.text(0.25), "0.250 m");
        assert_eq!(Unit::N.brief(-1.0), "−1 N");
        assert_eq!([magnitude(3.1e6, 2), magnitude(-2e-10, 3)], ["3.1×10^6", "−2×10^−10"]);
    }

    #[test]
    fn prefixes_follow_the_size() {
        assert_eq!(force(812.3), "812.3 N");
        assert_eq!(force(9_999.0), "9999 N");
        assert_eq!(force(12_345.0), "12.35 kN");
        assert_eq!(force(2.5e6), "2.500 MN");
        assert_eq!(force(-0.25), "−0.2500 N");
        assert_eq!(force(6.042e-13), "0 N");
        assert_eq!(percent(1.64e-12), "< 0.0001 %");
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(force(0.0), "0 N");
        assert_eq!(stress(1.3e6), "1.300 MPa");
        assert_eq!(stress(0.0), "0 Pa");
        assert_eq!(strain(4.0e-4), "400.0 µm/m");
        assert_eq!(strain(0.0125), "1.250 %");
        assert_eq!(duration(0.001_234), "1.234 ms");
        assert_eq!(length(0.14), "140.0 mm");
        assert_eq!(length(31.416), "31.42 m");
    }

    #[test]
    fn typed_text_is_read_with_and_without_a_unit() {
        assert_eq!(Unit::KN.parse("12"), Ok(12e3));
        assert_eq!(Unit::KN.parse(" 12 N "), Ok(12.0));
        assert_eq!(Unit::KN.parse("2 MN"), Ok(2e6));
        assert_eq!(Unit::MM.parse("0.14 m"), Ok(0.14));
        assert_eq!(Unit::N.parse("−3e2"), Ok(-300.0));
        assert_eq!(Unit::PLAIN_NUMBER.parse("0.5"), Ok(0.5));
        for wrong in ["", "abc", "1,5", "12 s", "inf", "NaN", "1e999"] {
            assert!(Unit::N.parse(wrong).is_err(), "{wrong}");
        }
        assert!(Unit::N.parse("1,5").is_err_and(|e| e.contains("point")));
    }

    #[test]
    fn the_exact_text_reads_back_bit_for_bit_where_the_unit_is_the_si_one() {
        for value in [12.345_678_9, 1e-12, 0.1 + 0.2, 9.80665, 5e8, 0.0] {
            let back = Unit::M.parse(&Unit::M.exact(value)).unwrap();
            assert!((back - value).abs() <= 1e-14 * value.abs(), "{value} {back}");
        }
        assert_eq!(Unit::MM.exact(0.028), "28 mm");
        assert_eq!(Unit::PPM_PER_K.exact(1.7e-5), "17 ppm/K");
    }
}
