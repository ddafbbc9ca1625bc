//! This file writes the summary of an answer as text.

use std::fmt::Write as _;

use cable_core::analysis::{EndStiffness, NeglectedBending};
use cable_core::solution::JudgedBend;
use cable_core::summary::{CablePlace, CableSummary, EndForce, ForceBalance, FrictionUse, TouchKind, Utilisation};

use crate::answer_json::SummaryJson;

/// Appends a block for each cable. Writing to a `String` cannot fail, so its results are ignored.
pub fn write(t: &mut String, figures: &SummaryJson) {
    for s in &figures.cables {
        let _ = writeln!(t, "\nCable `{}`, key figures", s.cable);
        for (line, value) in lines(s) {
            let _ = writeln!(t, "  {line:<17} {value}");
        }
        for e in figures.stiffness.iter().flatten().filter(|e| e.cable == s.cable) {
            let _ = writeln!(t, "  {:<17} {}", "End stiffness", stiffness(e));
        }
        for b in figures.bending.iter().filter(|b| b.cable == s.cable) {
            let _ = writeln!(t, "  {:<17} {}", "With bending", neglected(b, s.greatest_tension.tension_n));
        }
    }
}

fn lines(s: &CableSummary) -> Vec<(&'static str, String)> {
    let mut out: Vec<(&'static str, String)> =
        ["Start", "End"].into_iter().zip(&s.ends).map(|(name, end)| (name, force(end))).collect();
    let [most, least] = [s.greatest_tension, s.least_tension];
    out.push(("Greatest tension", format!("{} N {}", fixed(most.tension_n), at(most.at))));
    out.push(("Least tension", format!("{} N {}", fixed(least.tension_n), at(least.at))));
    let longer = s.stretched_length_m - s.length_m;
    out.push(("Length", format!("{:.4} m, now {:.6} m ({longer:+.3e} m)", s.length_m, s.stretched_length_m)));
    out.push(("Lying", format!("{:.4} m, suspended {:.4} m", s.lying_m, s.suspended_m)));
    for d in &s.touchdowns {
        let touch = match d.touch {
            TouchKind::Begins => "lies on",
            TouchKind::Ends => "leaves",
            TouchKind::Point => "touches",
        };
        out.push(("Touchdown", format!("{touch} `{}` with {} N {}", d.obstacle, fixed(d.tension_n), at(d.at))));
    }
    if let Some(sag) = s.sag {
        out.push(("Sag", format!("{} m {}", fixed(sag.sag_m), at(sag.at))));
    }
    out.push(("Lowest", format!("{} m {}", fixed(s.lowest.y_m), at(s.lowest))));
    out.push(("Highest", format!("{} m {}", fixed(s.highest.y_m), at(s.highest))));
    out.push(("Share of limits", used_of_limits(&s.utilisation)));
    if let Some(j) = &s.judged_bend {
        out.push(("Bend at a guide", judged_bend(j)));
    }
    if let Some(f) = &s.friction {
        out.push(("Friction used", friction_used(f)));
    }
    out.push(("Balance", balance(s.balance.as_ref())));
    out
}

fn used_of_limits(u: &Utilisation) -> String {
    let mut used = format!(
        "service tension {}, breaking tension {}",
        percent(u.service_tension_ratio),
        percent(u.breaking_tension_ratio)
    );
    for (name, ratio) in [("bend radius", u.bend_radius_ratio), ("sidewall pressure", u.sidewall_pressure_ratio)] {
        if let Some(ratio) = ratio {
            let _ = write!(used, ", {name} {}", percent(ratio));
        }
    }
    used
}

fn judged_bend(j: &JudgedBend) -> String {
    let by = match j.bending_stiffness_n_m2 {
        e if e > 0.0 => format!("with a bending stiffness of {e} N·m²"),
        _ => "its bending stiffness is not known".to_owned(),
    };
    let b = &j.bend;
    let place = CablePlace { arc_length_m: b.arc_length_m, x_m: b.x_m, y_m: b.y_m };
    format!("radius {:.4} m {}, {by}", b.radius_m, at(place))
}

fn friction_used(f: &FrictionUse) -> String {
    let most = percent(f.greatest_ratio);
    format!(
        "{} of {} N available, most on `{}` at {} m: {most}",
        fixed(f.used_n),
        fixed(f.available_n),
        f.obstacle,
        fixed(f.arc_length_m)
    )
}

fn balance(b: Option<&ForceBalance>) -> String {
    match b {
        Some(b) => {
            let [x, y] = b.residual_n;
            format!(
                "sum of all forces on the cable {:.2e} N {}, {:.2e} N {}: {:.1e} of the largest",
                x.abs(),
                left_or_right(x),
                y.abs(),
                up_or_down(y),
                b.relative_residual
            )
        }
        None => "not known: in a plan view the floor's friction is not among the forces reported".to_owned(),
    }
}

fn force(e: &EndForce) -> String {
    let angle = match e.elevation_deg {
        Some(d) => format!(", leaves {:.3}° {} the horizontal", d.abs(), if d < 0.0 { "below" } else { "above" }),
        None => String::new(),
    };
    let [x, y] = [e.horizontal_n, e.vertical_n].map(|n| without_sign_of_zero(n, 4));
    format!(
        "`{}` tension {} N, pulls with {} N {}, {} N {}{angle}",
        e.support,
        fixed(e.tension_n),
        fixed(x.abs()),
        left_or_right(x),
        fixed(y.abs()),
        up_or_down(y)
    )
}

/// The word for the direction of a component along x.
fn left_or_right(x: f64) -> &'static str {
    if x < 0.0 { "left" } else { "right" }
}

/// The word for the direction of a component along y.
fn up_or_down(y: f64) -> &'static str {
    if y < 0.0 { "down" } else { "up" }
}

/// A number with four decimals; one that rounds to zero has no sign.
pub fn fixed(value: f64) -> String {
    format!("{:.4}", without_sign_of_zero(value, 4))
}

/// A number that is written with so many decimals; one that rounds to zero has no sign.
pub fn without_sign_of_zero(value: f64, decimals: i32) -> f64 {
    if value.abs() < 0.5 * 10f64.powi(-decimals) { 0.0 } else { value }
}

fn stiffness(e: &EndStiffness) -> String {
    let [[right, aslant], [raised, up]] = e.stiffness_n_per_m;
    let across = |k: f64| format!("{} N/m {}", figure(k.abs(), 6), left_or_right(k));
    let along = |k: f64| format!("{} N/m {}", figure(k.abs(), 6), up_or_down(k));
    format!(
        "`{}`: moving it right changes the force that holds it by {} and {}; moving it up, by {} and {} (moves of {} m)",
        e.support,
        across(right),
        along(raised),
        across(aslant),
        along(up),
        figure(e.moved_m, 2)
    )
}

fn at(p: CablePlace) -> String {
    format!("at {} m ({} m, {} m)", fixed(p.arc_length_m), fixed(p.x_m), fixed(p.y_m))
}

/// A number with so many significant digits, in powers of ten only where it is very large or small.
fn figure(value: f64, digits: i32) -> String {
    let size = value.abs().log10().floor() as i32;
    if value == 0.0 {
        "0".to_owned()
    } else if (-4..6).contains(&size) {
        format!("{value:.*}", (digits - 1 - size).max(0) as usize)
    } else {
        format!("{value:.*e}", (digits - 1).max(0) as usize)
    }
}

fn percent(ratio: f64) -> String {
    format!("{:.2} %", without_sign_of_zero(100.0 * ratio, 2))
}

/// A line for each cable on the changes that the neglected bending stiffness would make to the
/// first equilibrium of a run, whose figures are given.
pub fn neglected_at_first_rest(figures: &SummaryJson) -> Vec<String> {
    let of = |b: &NeglectedBending| {
        let rest = figures.cables.iter().find(|s| s.cable == b.cable)?;
        let changes = neglected(b, rest.greatest_tension.tension_n);
        Some(format!("\nBending of `{}` was neglected: at the first rest, {changes}", b.cable))
    };
    figures.bending.iter().filter_map(of).collect()
}

/// The text on the changes that the neglected bending stiffness would make; `most` is the greatest
/// tension without it, N.
fn neglected(b: &NeglectedBending, most: f64) -> String {
    let range = match b.range_n_m2 {
        [Some(low), Some(high)] => format!(" ({low} to {high})"),
        _ => String::new(),
    };
    let with = format!("with the likely {}{range} N·m² of its preset,", b.bending_stiffness_n_m2);
    let Some(tension) = b.greatest_tension_n else {
        return format!(
            "{with} no answer was found: {}",
            b.unknown.as_ref().map_or_else(|| "not sought".to_owned(), ToString::to_string)
        );
    };
    let more = if most > 0.0 { format!(" ({:+.2} %)", 100.0 * (tension / most - 1.0)) } else { String::new() };
    let change = |what: &str, of: Option<f64>, unit: &str| {
        of.map_or_else(
            || format!("{what} by an unknown amount"),
            |v| format!("{what} by up to {} {unit}", figure(v, 3)),
        )
    };
    let supports = change("forces on supports change", b.changes.support_force_n, "N");
    let shape = change("the shape", b.changes.position_m, "m");
    format!("{with} the greatest tension is {tension:.4} N{more}; {supports}, {shape}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_usual_size_have_no_powers_of_ten() {
        let all = [0.0, 6.9, -0.001_6, 82.123_456, 123_456.7, 2.5e7, 3e-9].map(|v| figure(v, 3));
        assert_eq!(all, ["0", "6.90", "-0.00160", "82.1", "123457", "2.50e7", "3.00e-9"]);
    }
}
