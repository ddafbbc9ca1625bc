//! The figures of a warning, in words and as short as a line of the panel has room for.

use cable_core::solution::{Warning, WarningKind};

use crate::units::system::{self, Kind};
use crate::units::{format, unit};

/// A title that leaves room for figures and the place beside it.
pub fn short_title(kind: WarningKind, title: &'static str) -> &'static str {
    match kind {
        WarningKind::ServiceTension => "Above service",
        WarningKind::SidewallPressure => "Sidewall",
        WarningKind::BendRadius => "Tight bend",
        WarningKind::Accuracy => "Accuracy",
        WarningKind::Wrapped => "Wrapped",
        WarningKind::InitialPenetration => "Moved out of obstacle",
        WarningKind::ThroughRobot => "Through the robot",
        _ => title,
    }
}

/// The figures of a warning, in words and as short as they can be: a line of the panel has room for
/// a value, its limit and the place.
pub struct WarningFigures {
    /// In words.
    pub words: String,
    /// Beside the title in a line.
    pub short: String,
}

/// Digits of a value in a line: four stand in its words.
const SHORT_DIGITS: usize = 3;

impl WarningFigures {
    fn bare(value: String) -> Self {
        Self { words: value.clone(), short: value }
    }

    /// A value beside its limit: `sign` stands between them in a line, `word` before the limit in
    /// words.
    fn beside(kind: Kind, [value, limit]: [f64; 2], sign: &str, word: &str) -> Self {
        let text = |v: f64| {
            let (symbol, si) = system::for_size(kind, v);
            format::quantity(v / si, unit::DIGITS, symbol)
        };
        // One unit for both, told once.
        let (symbol, si) = system::for_size(kind, value.abs().max(limit.abs()));
        let short = |v: f64| without_trailing_zeros(format::significant(v / si, SHORT_DIGITS));
        Self {
            words: format!("{}, {word} {}", text(value), text(limit)),
            short: format!("{} {sign} {} {symbol}", short(value), short(limit)),
        }
    }
}

/// A decimal number without the zeros at its end: "0.800" stands beside a value of kilonewtons.
fn without_trailing_zeros(number: String) -> String {
    match number.contains('.') && !number.contains('^') {
        true => number.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => number,
    }
}

/// The value and its limit, in the warning's own unit.
pub fn figures(warning: &Warning) -> Option<WarningFigures> {
    let Warning { value, limit, .. } = *warning;
    let both = [value, limit];
    Some(match warning.kind {
        WarningKind::ServiceTension | WarningKind::BreakingTension => {
            WarningFigures::beside(Kind::Force, both, ">", "limit")
        }
        WarningKind::MayBreak => WarningFigures::beside(Kind::Force, both, "of", "limit"),
        WarningKind::Broken => {
            let most = format::force(limit);
            WarningFigures { words: format!("breaking tension {most}"), short: format!("limit {most}") }
        }
        WarningKind::BendRadius | WarningKind::Kink => WarningFigures::beside(Kind::Length, both, "<", "min"),
        WarningKind::Slack => WarningFigures::bare(format!("{} of cable", format::length(value))),
        WarningKind::SidewallPressure => {
            let per_metre = unit::Unit { decimals: Some(0), ..unit::Unit::N_PER_M };
            let [value, limit] = [value, limit].map(|v| per_metre.text(v));
            let bare = value.trim_end_matches(per_metre.display().symbol).trim_end();
            WarningFigures { words: format!("{value}, limit {limit}"), short: format!("{bare} > {limit}") }
        }
        WarningKind::Wrapped => WarningFigures::bare(format!("{value:.2} turns")),
        WarningKind::Curl => WarningFigures::bare(format!("{value:.0}°")),
        WarningKind::Snag => {
            WarningFigures { words: format!("tension ratio {value:.2}"), short: format!("ratio {value:.2}") }
        }
        WarningKind::EnergyGrows => {
            let energy = format::energy(value);
            WarningFigures { words: format!("{energy} too much"), short: energy }
        }
        WarningKind::Accuracy => {
            let [value, limit] = [value, limit].map(format::percent);
            let bare = value.trim_end_matches('%').trim_end().to_owned();
            WarningFigures { words: format!("{value} estimated, target {limit}"), short: format!("{bare} > {limit}") }
        }
        // A loop, a second rest, a blocked support and the like have no figure.
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use cable_core::solution::WarningCause;

    use super::*;

    /// "10.0 > 0.800…" was cut before its unit beside a place of a cable that had torn off.
    #[test]
    fn figures_of_a_line_have_no_zeros_at_their_end() {
        let short = |both| {
            let cause = WarningCause::Recorded { kind: WarningKind::ServiceTension, message: String::new() };
            figures(&Warning::new(cause, "cable", 12.0, both)).unwrap().short
        };
        assert_eq!(short([12_345.0, 800.0]), "12.3 > 0.8 kN");
        assert_eq!(short([1e4, 800.0]), "10 > 0.8 kN");
        assert_eq!(short([9987.0, 800.0]), "9987 > 800 N");
    }
}
