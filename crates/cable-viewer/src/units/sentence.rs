//! Sentences of the solver are made in the units on screen.

use cable_core::wording::Sentence;

use crate::units::system;

/// A sentence in the units on screen. Names, which the core has between backticks, stand between
/// quotation marks.
#[must_use]
pub fn sentence(of: &impl Sentence) -> String {
    let mut out = String::new();
    for (k, part) in of.sentence(system::current()).split('`').enumerate() {
        out.push_str(match k {
            0 => "",
            _ if k % 2 == 1 => "“",
            _ => "”",
        });
        out.push_str(part);
    }
    out
}

#[cfg(test)]
mod tests {
    use cable_core::solution::{Warning, WarningCause};

    use super::*;

    #[test]
    fn a_sentence_follows_the_units_on_screen() {
        let cause = WarningCause::Lags { support: "beam 3 m".to_owned(), behind_m: 0.3048 };
        let warning = Warning::new(cause, "a", 0.0, [1.0, 2.0]);
        let expected = "support “beam 3 m” lags 0.30 m behind where it is sent: it follows at 2 m/s at most";
        assert_eq!(sentence(&warning), expected);
        system::set_current(system::System::Us);
        let expected = "support “beam 3 m” lags 1.00 ft behind where it is sent: it follows at 6.5617 ft/s at most";
        assert_eq!(sentence(&warning), expected);
        system::set_current(system::System::Si);
    }
}
