//! Typed text is read as a number, alone or with a unit of its quantity.

use crate::units::format::with_symbol;
use crate::units::system;
use crate::units::unit::Unit;

impl Unit {
    /// The SI value of typed text: a number, alone or with a unit of this quantity in either
    /// system.
    ///
    /// # Errors
    /// The fault of the text, and an example that would be right.
    pub fn parse(self, text: &str) -> Result<f64, String> {
        let Self { symbol, si, others, .. } = self.display();
        let plain = text.trim().replace('−', "-").replace(' ', "");
        let number = |digits: &str, si: f64| digits.parse::<f64>().ok().filter(|v| v.is_finite()).map(|v| v * si);
        // Whatever is shown, units of both systems may be typed.
        let both = [Some(self), system::us(self)].into_iter().flatten();
        let more = both.flat_map(|u| std::iter::once((u.symbol, u.si)).chain(u.others.iter().copied()));
        let spelled = std::iter::once((symbol, si)).chain(others.iter().copied()).chain(more);
        number(&plain, si)
            .or_else(|| {
                let mut units: Vec<_> = spelled.filter(|(symbol, _)| !symbol.is_empty()).collect();
                // The longest first, or “12 kN” would read as “12k” newtons.
                units.sort_by_key(|(symbol, _)| std::cmp::Reverse(symbol.len()));
                units.iter().find_map(|&(symbol, si)| number(plain.strip_suffix(symbol)?, si))
            })
            .ok_or_else(|| {
                let example = with_symbol("12.5".to_owned(), symbol);
                if plain.contains(',') {
                    format!("“{}” is not a number: write the decimal mark as a point, like {example}", text.trim())
                } else {
                    format!("“{}” is not a number: type one like {example}", text.trim())
                }
            })
    }
}
