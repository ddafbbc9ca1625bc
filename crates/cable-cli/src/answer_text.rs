//! This file writes an answer as text.

use std::cmp::Ordering;
use std::fmt::Write as _;

use cable_core::UnitSystem;
use cable_core::solution::{ContactState, Solution};
use cable_core::wording::Sentence;

use crate::answer_json::{ComparedEntry, SummaryJson};
use crate::summary::{self, fixed, without_sign_of_zero};

/// Greatest length of the reason why a model has no answer, characters.
const MAX_REASON_CHARS: usize = 90;

/// Appends the answers of other models and meshes, the quickest first and those without an answer
/// last.
fn compared(t: &mut String, entries: &[ComparedEntry]) {
    if entries.is_empty() {
        return;
    }
    let _ = writeln!(t, "\nOther models and meshes, compared with this answer");
    let _ = writeln!(
        t,
        "  {:<12} {:>8} {:>10}  {:>16}  {:>12}  {:>14}",
        "model", "segments", "time ms", "forces differ by", "shape by m", "own estimate"
    );
    let mut sorted: Vec<&ComparedEntry> = entries.iter().collect();
    sorted.sort_by(|a, b| {
        (a.answer.is_none(), a.wall_time_s).partial_cmp(&(b.answer.is_none(), b.wall_time_s)).unwrap_or(Ordering::Equal)
    });
    for e in sorted {
        let elements = e.setting.elements.map_or_else(|| "–".to_owned(), |n| n.to_string());
        let _ = write!(t, "  {:<12} {elements:>8} {:>10.3}  ", e.setting.model.name(), 1e3 * e.wall_time_s);
        let _ = match (&e.answer, &e.error) {
            (Some(a), _) => {
                let said = a.stated_error.map_or_else(|| "nothing".to_owned(), |s| format!("{s:.1e}"));
                writeln!(t, "{:>16.1e}  {:>12.1e}  {said:>14}", a.force_difference, a.shape_difference_m)
            }
            (None, Some(why)) if why.chars().count() > MAX_REASON_CHARS => {
                writeln!(t, "{}…", why.chars().take(MAX_REASON_CHARS).collect::<String>())
            }
            (None, why) => writeln!(t, "{}", why.as_deref().unwrap_or("no answer")),
        };
    }
}

/// An answer as tables with units. Writing to a `String` cannot fail, so its results are ignored.
pub fn answer_text(s: &Solution, figures: &SummaryJson) -> String {
    let mut t = String::new();
    let top = s.max_tension();
    let _ = writeln!(t, "Model             {} ({})", s.model, s.reason);
    if let Some(next) = &s.next_cheaper {
        let _ = writeln!(t, "Next cheaper      {next}");
    }
    // This is the time in the scene, not the computing time.
    let _ = writeln!(t, "Scene time        {} s", s.time_s);
    let name = s.cables.get(top.cable).map_or("", |c| &c.name);
    let _ = writeln!(t, "Greatest tension  {} N, at {:.4} m of `{name}`", fixed(top.tension_n), top.arc_length_m);
    for c in &s.cables {
        if let Some(b) = c.tightest_bend {
            let place = at(b.arc_length_m, b.x_m, b.y_m, &c.name);
            let _ = writeln!(t, "Tightest bend     radius {:.4} m, {place}", b.radius_m);
        }
        if let Some(p) = c.sidewall_pressure {
            let place = at(p.arc_length_m, p.x_m, p.y_m, &c.name);
            let _ = writeln!(t, "Sidewall pressure {:.3} N/m, {place}", p.pressure_n_per_m);
        }
    }
    for c in &s.cables {
        errors(&mut t, c);
    }
    let _ = writeln!(t, "Residual          {:.2e} N after {} iterations", s.cost.residual_n, s.cost.iterations);
    if let Some(v) = &s.verification {
        let _ = writeln!(t, "Verification      {}", v.sentence(UnitSystem::Si));
        if v.folded_m > 0.0 {
            let _ = writeln!(t, "In folds          {:.4} m of cable more than the route it lies on", v.folded_m);
        }
    }
    summary::write(&mut t, figures);
    for c in &s.cables {
        supports(&mut t, c);
        contacts(&mut t, c);
    }
    compared(&mut t, &figures.compared);
    for w in &s.warnings {
        let _ = writeln!(t, "\nWarning: {w}");
    }
    t
}

/// Appends the error estimates of a cable's figures.
fn errors(t: &mut String, c: &cable_core::solution::CableSolution) {
    let Some(part) = c.error_estimate else {
        let _ = writeln!(t, "Estimated error   not known for `{}`", c.name);
        return;
    };
    let _ = writeln!(t, "Estimated error   {part:.1e} of the greatest tension of `{}`", c.name);
    let e = &c.errors;
    let figure = |of: Option<f64>, unit| of.map_or_else(|| "not known".to_owned(), |v| format!("± {v:.1e} {unit}"));
    let _ = write!(t, "                  greatest tension {}", figure(e.max_tension_n, "N"));
    let _ = write!(t, ", supports {}", figure(e.support_force_n, "N"));
    if !c.contacts.is_empty() {
        let _ = write!(t, ", contacts {}", figure(e.contact_force_n, "N"));
    }
    let _ = writeln!(t, ", shape {}", figure(e.position_m, "m"));
}

/// A place on a cable and in the plane.
fn at(arc_length_m: f64, x_m: f64, y_m: f64, cable: &str) -> String {
    format!("at {} m of `{cable}` ({} m, {} m)", fixed(arc_length_m), fixed(x_m), fixed(y_m))
}

fn supports(t: &mut String, c: &cable_core::solution::CableSolution) {
    let wide = c.supports.iter().map(|r| r.name.chars().count()).max().unwrap_or(0).max(7);
    let _ = writeln!(t, "\nCable `{}`, force on each support", c.name);
    let _ = writeln!(
        t,
        "  {:wide$}  {:>10} {:>10} {:>10} {:>13} {:>13} {:>13} {:>13}",
        "support", "along m", "x m", "y m", "x N", "y N", "before N", "after N"
    );
    for r in &c.supports {
        let tension = |v: Option<f64>| v.map_or_else(|| "–".to_owned(), fixed);
        let _ = writeln!(
            t,
            "  {:wide$}  {:>10} {:>10} {:>10} {:>13} {:>13} {:>13} {:>13}",
            r.name,
            fixed(r.arc_length_m),
            fixed(r.x_m),
            fixed(r.y_m),
            fixed(r.reaction_x_n),
            fixed(r.reaction_y_n),
            tension(r.tension_before_n),
            tension(r.tension_after_n)
        );
    }
}

fn contacts(t: &mut String, c: &cable_core::solution::CableSolution) {
    if c.contacts.is_empty() {
        return;
    }
    let wide = c.contacts.iter().map(|k| k.obstacle.chars().count()).max().unwrap_or(0).max(8);
    let _ = writeln!(t, "\nCable `{}`, contacts", c.name);
    let _ = writeln!(
        t,
        "  {:wide$}  {:>10} {:>10} {:>10} {:>13} {:>13} {:>6} {:>9} {:>13} {:>13}",
        "obstacle", "along m", "x m", "y m", "normal N", "friction N", "state", "turn °", "before N", "after N"
    );
    for k in &c.contacts {
        let state = match k.state {
            ContactState::Stick => "holds",
            ContactState::Slip => "slides",
        };
        let _ = writeln!(
            t,
            "  {:wide$}  {:>10} {:>10} {:>10} {:>13} {:>13} {state:>6} {:>9.3} {:>13} {:>13}",
            k.obstacle,
            fixed(k.arc_length_m),
            fixed(k.x_m),
            fixed(k.y_m),
            fixed(k.normal_n),
            fixed(k.friction_n),
            without_sign_of_zero(k.turn_deg, 3),
            fixed(k.tension_before_n),
            fixed(k.tension_after_n)
        );
    }
}
