//! Sentences of the solver are written in the units on screen.
//!
//! The core speaks SI: `a` is pulled with 912.0 N at 3.200 m. On a screen in US units each figure
//! with its unit is written in the unit of that system, with as many decimals; words and figures
//! without a unit stay. Names, which the core has between backticks, are read between quotation
//! marks in both.

use std::borrow::Cow;

use crate::units::system::{self, System};
use crate::units::unit::Unit;

/// Units in sentences of the core. Longer symbols first: `N/m` begins with `N`.
const UNITS: [Unit; 9] =
    [Unit::N_PER_M, Unit::M_PER_S2, Unit::M_PER_S, Unit::KG_PER_M, Unit::KG, Unit::KN, Unit::MM, Unit::N, Unit::M];

/// A sentence as it is on screen: its units, and its names between quotation marks.
#[must_use]
pub fn display(text: &str) -> Cow<'_, str> {
    let si = system::current() == System::Si;
    if si && !text.contains('`') {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let (mut rest, mut quoted) = (text, false);
    while let Some(c) = rest.chars().next() {
        if c == '`' {
            quoted ^= true;
            out.push(if quoted { '“' } else { '”' });
            rest = rest.get(1..).unwrap_or_default();
            continue;
        }
        let word_before = out.chars().next_back().is_some_and(|b| b.is_alphanumeric() || b == '_');
        if !si
            && !quoted
            && !word_before
            && let Some((written, length)) = figure(rest)
        {
            out += &written;
            rest = rest.get(length..).unwrap_or_default();
            continue;
        }
        out.push(c);
        rest = rest.get(c.len_utf8()..).unwrap_or_default();
    }
    Cow::Owned(out)
}

/// A figure with its unit at the start of a text, in the unit on screen, and how many bytes of the
/// text it is.
fn figure(text: &str) -> Option<(String, usize)> {
    let number = number_length(text)?;
    let (digits, after) = text.split_at_checked(number)?;
    let after = after.strip_prefix([' ', '\u{a0}'])?;
    let gap = text.len() - number - after.len();
    let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || matches!(c, '/' | '·' | '²' | '_'));
    let unit = UNITS.iter().find(|u| after.strip_prefix(u.symbol).is_some_and(ends))?;
    let value: f64 = digits.replace('−', "-").parse().ok()?;
    let Unit { symbol, si, .. } = unit.display();
    Some((format!("{} {symbol}", like(digits, value * unit.si / si)), number + gap + unit.symbol.len()))
}

/// Bytes of the number that a text begins with; a minus sign may be either one.
fn number_length(text: &str) -> Option<usize> {
    let body = text.strip_prefix(['-', '−']).unwrap_or(text);
    let sign = text.len() - body.len();
    let digits = |from: usize| body.bytes().skip(from).take_while(u8::is_ascii_digit).count();
    let mut n = digits(0);
    if n == 0 {
        return None;
    }
    if body.as_bytes().get(n) == Some(&b'.') && digits(n + 1) > 0 {
        n += 1 + digits(n + 1);
    }
    if matches!(body.as_bytes().get(n), Some(b'e' | b'E')) {
        let signed = usize::from(matches!(body.as_bytes().get(n + 1), Some(b'-' | b'+')));
        let exponent = digits(n + 1 + signed);
        n += if exponent > 0 { 1 + signed + exponent } else { 0 };
    }
    Some(sign + n)
}

/// A value written as another number is: with its decimals, or as a power of ten with its digits.
fn like(digits: &str, value: f64) -> String {
    let (mantissa, power) = digits.split_once(['e', 'E']).map_or((digits, false), |(m, _)| (m, true));
    let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len());
    if power { format!("{value:.decimals$e}") } else { format!("{value:.decimals$}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn us(text: &str) -> String {
        system::set_current(System::Us);
        let out = display(text).into_owned();
        system::set_current(System::Si);
        out
    }

    #[test]
    fn figures_with_a_unit_are_written_in_the_other_system_and_nothing_else_is() {
        for (si, expected) in [
            (
                "`a` is pulled with 912.0 N at 3.200 m (1.000 m, −2.000 m)",
                "`a` is pulled with 205.0 lbf at 10.499 ft (3.281 ft, −6.562 ft)",
            ),
            ("pressed with 1459 N/m", "pressed with 100 lbf/ft"),
            ("unbalanced force 4.448e2 N at node 7", "unbalanced force 1.000e2 lbf at node 7"),
            ("stopped at 0.493 s, at 2 m/s", "stopped at 0.493 s, at 7 ft/s"),
            ("`beam 3 m` at 0 m, 5 Nm, 3 metres, x2 m", "`beam 3 m` at 0 ft, 5 Nm, 3 metres, x2 m"),
            ("it turns 360° within 0.305 m; 1.5 times", "it turns 360° within 1.001 ft; 1.5 times"),
            ("kept at 1.246 kg/m.", "kept at 0.837 lb/ft."),
        ] {
            let names = |text: &str| text.replacen('`', "“", 1).replacen('`', "”", 1);
            assert_eq!(us(si).replace('-', "−"), names(expected).replace('-', "−"), "{si}");
            assert_eq!(display(si), names(si), "but for names SI stays as it is");
        }
    }

    #[test]
    fn any_text_is_taken() {
        for text in ["", "`", "1e", "−", "1. m", "9 ", "N m 7", "ä1 m", "1\u{a0}m"] {
            assert!(!us(text).contains("NaN"));
        }
    }
}
