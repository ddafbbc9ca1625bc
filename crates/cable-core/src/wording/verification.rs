//! A verdict names the broken law, by how much it is broken, and where.

use super::figures::{Figures, percent};
use super::{Sentence, display_in_si, serialize_in_si};
use crate::units::{Quantity, UnitSystem};
use crate::verification_report::{Finding, NotChecked, Verification};

display_in_si!(Finding, NotChecked);
serialize_in_si!(NotChecked);

impl Sentence for Finding {
    fn sentence(&self, units: UnitSystem) -> String {
        let (f, quantity) = (Figures(units), self.law.quantity());
        let mut text = self.law.broken().to_owned();
        if quantity != Quantity::Number {
            let limit = f.bare_significant(quantity, self.limit, 2);
            text += &format!(" by {} ({limit} allowed)", f.significant(quantity, self.value, 4));
        }
        if !self.with.is_empty() {
            text += &format!(" at `{}`", self.with);
        }
        if self.law.is_of_whole() {
            text += &format!(", of `{}`", self.cable);
        } else if self.at_m.iter().all(|c| c.is_finite()) && self.arc_length_m.is_finite() {
            let along = f.length(self.arc_length_m, 3);
            text += &format!(", {along} along `{}` at {}", self.cable, f.point(self.at_m, 3));
        }
        text
    }
}

impl Sentence for NotChecked {
    fn sentence(&self, _: UnitSystem) -> String {
        match self {
            Self::MovingBalance { cable } => format!("balance and length of `{cable}`: it moves"),
            Self::BrokenBalance { cable } => format!("balance and length of `{cable}`: it is broken"),
            Self::SelfContact { cable } => format!("contact of `{cable}` with itself"),
        }
    }
}

impl Sentence for Verification {
    /// The verdict in a line: verified or not, the balance, and what was not checked.
    fn sentence(&self, units: UnitSystem) -> String {
        let (residual_n, scale_n) = (self.balance.residual_n, self.balance.scale_n);
        let share = if scale_n > 0.0 { residual_n / scale_n } else { 0.0 };
        let verdict = if self.not_checked.is_empty() { "verified" } else { "partly verified" };
        let scale = Figures(units).force(scale_n, 4);
        let mut line = match self.worst() {
            None if scale_n > 0.0 => format!("{verdict}: forces balance to within {} of {scale}", percent(share)),
            None => verdict.to_owned(),
            Some(worst) => format!("VERIFICATION FAILED: {}", worst.sentence(units)),
        };
        for what in &self.not_checked {
            line.push_str("; not checked: ");
            line.push_str(&what.sentence(units));
        }
        line
    }
}
