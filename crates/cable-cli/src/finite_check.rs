//! No number that is printed is NaN or infinite.

use cable_core::solution::Solution;

/// Refuses an answer with such a number: `serde_json` would write it as null, which could not be
/// read back.
pub(super) fn check_finite(s: &Solution) -> Result<(), String> {
    let all = |values: &[f64]| values.iter().all(|v| v.is_finite());
    for c in &s.cables {
        for (i, n) in c.nodes.iter().enumerate() {
            if !all(&[n.arc_length_m, n.x_m, n.y_m, n.tension_n, n.strain, n.stress_pa, n.curvature_per_m]) {
                return Err(format!("node {i} of cable `{}`", c.name));
            }
        }
        for r in &c.supports {
            let tensions = [r.tension_before_n.unwrap_or(0.0), r.tension_after_n.unwrap_or(0.0)];
            if !all(&[r.x_m, r.y_m, r.reaction_x_n, r.reaction_y_n, r.arc_length_m]) || !all(&tensions) {
                return Err(format!("support `{}` of cable `{}`", r.name, c.name));
            }
        }
        for k in &c.contacts {
            let forces = [k.normal_n, k.friction_n, k.turn_deg, k.tension_before_n, k.tension_after_n];
            if !all(&[k.x_m, k.y_m, k.arc_length_m]) || !all(&forces) {
                return Err(format!("a contact of cable `{}` with `{}`", c.name, k.obstacle));
            }
        }
        if let Some(peaks) = c.peaks
            && !all(&[peaks.greatest.tension_n, peaks.held.tension_n])
        {
            return Err(format!("a peak of the tension of cable `{}`", c.name));
        }
        if c.energy_account.is_some_and(|account| !account.is_finite()) {
            return Err(format!("the energy account of cable `{}`", c.name));
        }
        let bend = c.tightest_bend.unwrap_or_default();
        let pressure = c.sidewall_pressure.unwrap_or_default();
        let values = [bend.radius_m, bend.arc_length_m, bend.x_m, bend.y_m];
        if !all(&values) || !all(&[pressure.pressure_n_per_m, pressure.arc_length_m, pressure.x_m, pressure.y_m]) {
            return Err(format!("a bend of cable `{}`", c.name));
        }
        if c.error_estimate.is_some_and(|e| !e.is_finite()) || !c.errors.is_finite() {
            return Err(format!("the error estimate of cable `{}`", c.name));
        }
    }
    if s.warnings.iter().any(|w| !all(&[w.arc_length_m, w.value, w.limit])) {
        return Err("a number of a warning".to_owned());
    }
    if !all(&[s.cost.residual_n, s.time_s]) { Err("the residual".to_owned()) } else { Ok(()) }
}
