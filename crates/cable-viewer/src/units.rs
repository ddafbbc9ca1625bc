//! Figures with their unit, as short as their accuracy allows.

/// A force, N or kN, three significant digits.
#[must_use]
pub fn force(newtons: f64) -> String {
    let size = newtons.abs();
    if !size.is_finite() {
        return "– N".to_owned();
    }
    if size >= 1e4 { format!("{} kN", digits(newtons / 1e3)) } else { format!("{} N", digits(newtons)) }
}

/// A number with three significant digits, without an exponent between 0.001 and 1e6.
#[must_use]
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        format!("{value:.2e}")
    } else {
        let decimals = (2 - size.log10().floor() as i32).clamp(0, 5) as usize;
        format!("{value:.decimals$}")
    }
}

/// A coordinate, m, with as many decimals as the view shows.
#[must_use]
pub fn coordinate(metres: f64, step_m: f64) -> String {
    let decimals = decimals_of(step_m);
    // −0 reads as a mistake.
    let text = format!("{metres:.decimals$}");
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
