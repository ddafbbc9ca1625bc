//! Labels on the canvas are figures with their unit, as short as their accuracy allows.

use cable_core::Model;

use crate::units::unit::Unit;
use crate::units::{format, system};

/// A force, N or kN, three significant digits.
#[must_use]
pub fn force(newtons: f64) -> String {
    let size = newtons.abs();
    if !size.is_finite() {
        return format!("– {}", Unit::N.display().symbol);
    }
    let (symbol, si) = system::for_size(system::Kind::Force, newtons);
    format!("{} {symbol}", digits(newtons / si))
}

/// A number with three significant digits, without an exponent between 0.001 and 1e6.
#[must_use]
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        format::magnitude(value, 3)
    } else {
        let decimals = (2 - size.log10().floor() as i32).clamp(0, 5) as usize;
        format!("{value:.decimals$}").replace('-', "−")
    }
}

/// The unit of coordinates, and how many metres it holds.
#[must_use]
pub fn of_length() -> (&'static str, f64) {
    let Unit { symbol, si, .. } = Unit::M.display();
    (symbol, si)
}

/// A coordinate, m, in the unit shown, with as many decimals as the view shows.
#[must_use]
pub fn coordinate(metres: f64, step_m: f64) -> String {
    let (_, si) = of_length();
    let decimals = decimals_of(step_m / si * (1.0 + 1e-9));
    // −0 reads as a mistake.
    let text = format!("{:.decimals$}", metres / si);
    if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) {
        text.trim_start_matches('-').to_owned()
    } else {
        text.replace('-', "−")
    }
}

/// Decimals needed to tell multiples of a step apart.
#[must_use]
pub fn decimals_of(step: f64) -> usize {
    (-step.log10().floor()).clamp(0.0, 9.0) as usize
}

/// A speed, m/s, three significant digits.
#[must_use]
pub fn speed(metres_per_second: f64) -> String {
    let Unit { symbol, si, .. } = Unit::M_PER_S.display();
    format!("{} {symbol}", digits(metres_per_second / si))
}

/// Text which says that an answer is being sought, and for how long, s.
#[must_use]
pub fn solving(seconds: f64) -> String {
    if seconds < 1.0 { "Solving…".to_owned() } else { format!("Solving… {seconds:.0} s") }
}

/// A model as the window calls it.
#[must_use]
pub fn model(model: Model) -> &'static str {
    model.info().label
}
