//! This sentence says how fast a motion is, and whether masses matter in it.

use super::figures::{at_most, significant};
use super::{Sentence, display_in_si};
use crate::solution::InertiaEffect;
use crate::units::UnitSystem;

display_in_si!(InertiaEffect);

impl Sentence for InertiaEffect {
    fn sentence(&self, units: UnitSystem) -> String {
        let mach = format!("Mach number {}", significant(self.numbers.mach, 2));
        let froude = self
            .numbers
            .froude
            .map_or_else(String::new, |froude| format!(", Froude number {}", significant(froude, 2)));
        let Some(without) = self.without else { return format!("{mach}{froude}") };
        let verdict = match self.matters() {
            Some(true) => "inertia matters",
            Some(false) => "inertia does not matter",
            None => "it is not clear whether inertia matters",
        };
        let tolerance = at_most(self.tolerance, 2);
        let hidden = self.hidden_by().filter(|_| self.matters().is_none()).map_or_else(String::new, |error| {
            format!("; at rest the two differ by {} % already", significant(100.0 * error, 2))
        });
        format!("{mach}{froude}: {verdict} at tolerance {tolerance} ({}{hidden})", without.sentence(units))
    }
}
