//! Newton's method solves a section: all spans and contacts at once, never a span solved inside
//! another iteration.
//!
//! Six unknowns and six equations for each contact, two more for the last span, in the order span,
//! contact, span …:
//!
//! ```text
//! span     ∫ f(F(s)) ds − (x_b − x_a) = 0,   f(F) = τ(F/T + F/EA)      (2)
//! contact  F × t = 0 at p₁ and at p₂                                    (2)
//!          two rows for material and tension, see `contact/equations`   (2)
//! ```
//!
//! At a lying end the tension takes the place of p among the unknowns, and s = its material that of
//! the tangency.

pub(in crate::model::spans) mod jacobian;
pub(in crate::model::spans) mod slip_predictor;
pub(in crate::model::spans) mod stability;

#[cfg(test)]
mod tests;

use crate::math::{Vec2, larger, smaller};
use crate::model::spans::boundary::capstan::Track;
use crate::model::spans::boundary::friction_memory::{Held, Mode, TensionProfile};
use crate::model::spans::boundary_conditions::BoundaryConditions;
use crate::model::spans::cable_section::{CableSection, Course};
use crate::model::spans::contact::equations;
use crate::model::spans::contact::point_load;
use crate::model::spans::newton::jacobian::{System, assemble, gather, has_tension_unknown, pinned, renew, scatter};
use crate::model::spans::newton::slip_predictor::SlipPredictor;
pub(super) use crate::model::spans::newton::stability::stable;

/// Residual that rounding leaves where a cable is EA/T times stiffer than it is taut: this times
/// EA/T.
const STIFF_RESIDUAL: f64 = 2e-14;
/// Residual that no step makes smaller: rounding.
const RESIDUAL_ROUNDING: f64 = 5e-15;
/// A step to the end of a piece of boundary goes beyond it by this part of p: more than rounding,
/// less than matters.
const PIECE_END_OVERSHOOT: f64 = 1e-9;

/// Memory of a solve, kept between steps. A copy has none of its own: what is in it means nothing
/// between two steps.
#[derive(Debug, Default)]
pub(super) struct Work {
    system: System,
    rhs: Vec<f64>,
    saved: Vec<f64>,
    best: Vec<f64>,
    /// Winding numbers of the search for corners passed through.
    pub turns: Vec<i32>,
    /// The shape before and after a step.
    pub shapes: [Vec<Vec2>; 2],
    /// A section before a step, and with its ends moved.
    pub sections: [CableSection; 2],
    /// All of them before a step.
    pub before: Vec<CableSection>,
    /// Instants: before a step; where a way begins; where a step goes.
    pub instants: [BoundaryConditions; 3],
    /// Scratch space of the slip predictor.
    pub slip_predictor: SlipPredictor,
    /// A contact's past as it was.
    pub past: TensionProfile,
}

impl Clone for Work {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Newton did not converge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stall {
    pub iterations: usize,
    /// Scaled residual left.
    pub residual: f64,
    /// The contact or span with the greatest residual, as contacts count.
    pub at: usize,
}

/// Cost of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Solved {
    pub iterations: usize,
    pub residual: f64,
}

fn norm(r: &[f64]) -> (f64, usize) {
    let (mut worst, mut at) = (0.0, 0);
    for (i, v) in r.iter().enumerate() {
        if v.abs() > worst || v.is_nan() {
            (worst, at) = (v.abs(), i);
        }
        if v.is_nan() {
            break;
        }
    }
    (worst, at)
}

fn squares(r: &[f64]) -> f64 {
    r.iter().map(|v| v * v).sum()
}

/// The residual that will do, of a section whose contacts have the tensions of the spans beside
/// them.
fn tolerance(section: &CableSection, course: &Course) -> f64 {
    let (least, wanted) = (least_tension(section, course), course.settings.newton.residual);
    let stiff = if least.is_finite() && least > 0.0 { STIFF_RESIDUAL * course.law.stiffness / least } else { 0.0 };
    larger(wanted, stiff.min(1e3 * wanted))
}

/// True if a residual that suffices leaves forces with too great an error: a length that is missing
/// is strain, and that times EA is force.
fn is_rough(section: &CableSection, course: &Course, residual: f64) -> bool {
    let least = least_tension(section, course);
    least.is_finite()
        && residual
            > larger(RESIDUAL_ROUNDING, course.settings.newton.refined_residual_factor * least / course.law.stiffness)
}

/// The least tension at an end of a span, N; infinite where there is no span.
fn least_tension(section: &CableSection, course: &Course) -> f64 {
    let mut least = f64::INFINITY;
    let mut take = |t: f64| {
        if t < least {
            least = t;
        }
    };
    let last = section.contacts.len();
    for (k, s) in [(0, section.from), (last, section.to)] {
        if section.has_span(k) {
            take(section.force(course, k, s).norm());
        }
    }
    for (j, c) in section.contacts.iter().enumerate() {
        for side in 0..2 {
            if section.has_span(j + side) {
                take(c.ends.t[side]);
            }
        }
    }
    least
}

/// Largest part of a step that keeps spans and does not jump turns.
fn max_step(section: &CableSection, course: &Course, x: &[f64], d: &[f64]) -> f64 {
    let tuned = &course.settings.newton;
    let mut alpha = 1.0f64;
    for k in 0..section.spans() {
        if section.has_span(k) {
            let (from, to) = section.material(k);
            let first = if k > 0 { d[6 * k - 1] } else { 0.0 };
            let last = if k < section.contacts.len() { d[6 * k + 3] } else { 0.0 };
            let (length, change) = (to - from, last - first);
            if change < 0.0 && alpha * -change > (1.0 - tuned.kept_material_fraction) * length {
                alpha = (1.0 - tuned.kept_material_fraction) * length / -change;
            }
        }
        let Some(c) = section.contacts.get(k) else { continue };
        let track = course.track(c);
        for side in 0..2 {
            if has_tension_unknown(section, k, side) {
                continue;
            }
            let (p, dp) = (x[6 * k + 2 + 2 * side], d[6 * k + 2 + 2 * side]);
            if alpha * dp.abs() > tuned.max_turn && (track.turns(p) || track.turns(p + alpha * dp)) {
                alpha = tuned.max_turn / dp.abs();
            }
        }
    }
    alpha
}

/// Parts of a step after which each end of a contact is just beyond the piece of boundary it was
/// on: (index, part) for each that comes so far.
///
/// Round an arc the direction turns by one per rad, along an edge the cable leaves it by w/T per
/// metre: a step that is right on one of them says nothing of the other, and half of it less.
fn borders(section: &CableSection, course: &Course, x: &[f64], d: &[f64], mut each: impl FnMut(usize, f64)) {
    for (k, c) in section.contacts.iter().enumerate() {
        let track = course.track(c);
        for side in 0..2 {
            let index = 6 * k + 2 + 2 * side;
            let (p, dp) = (x[index], d[index]);
            if has_tension_unknown(section, k, side) || dp == 0.0 {
                continue;
            }
            let i = track.curve.locate(p, c.chain_range);
            let beyond = PIECE_END_OVERSHOOT * (1.0 + p.abs());
            let way = match dp > 0.0 {
                true if i < c.chain_range.last => track.curve.end(i) - p + beyond,
                false if i > c.chain_range.first => track.curve.origin(i) - p - beyond,
                _ => continue,
            };
            each(index, way / dp);
        }
    }
}

/// Solves a section from where it is. On an error it is left wherever the iteration was.
pub(super) fn solve(section: &mut CableSection, course: &Course, work: &mut Work) -> Result<Solved, Stall> {
    let tuned = &course.settings.newton;
    section.take_tensions(course);
    for c in &mut section.contacts {
        c.flips = 0;
        if course.mobilised != 0.0 && c.kink().is_none() {
            c.mode = Mode::Slide(course.mobilised * course.friction(c));
        }
    }
    let (mut best, mut stalled, mut iterations, mut polished) = (f64::INFINITY, 0, 0, f64::INFINITY);
    assemble(section, course, &mut work.system);
    loop {
        let (mut worst, mut at) = norm(&work.system.residual);
        let done = worst <= tolerance(section, course);
        if worst <= tuned.mode_residual || stalled >= tuned.mode_stalled_iterations {
            let (changed, content) = change_modes(
                section,
                course,
                if done { 4 * tuned.max_mode_changes } else { tuned.max_mode_changes },
                &mut work.system,
            );
            if changed {
                (worst, at) = norm(&work.system.residual);
                (best, stalled) = (f64::INFINITY, 0);
                // In rounding at the edge of the cone another mode changes nothing: nothing is left
                // to solve.
                if worst <= tolerance(section, course) {
                    continue;
                }
            } else if done {
                // For as long as it gains: where a tension vanishes, Newton's method is of the
                // first order.
                if content && worst < 0.5 * polished && is_rough(section, course, worst) {
                    (polished, iterations) = (worst, iterations + 1);
                    if step(section, course, work) {
                        continue;
                    }
                }
                return if content || modes_agree(section, course, &work.system) {
                    Ok(Solved { iterations, residual: worst })
                } else {
                    Err(Stall { iterations, residual: worst, at: at / 6 })
                };
            }
        }
        let stall = move |residual: f64| Stall { iterations, residual, at: at / 6 };
        if worst < 0.5 * best {
            (best, stalled) = (worst, 0);
        } else {
            stalled += 1;
        }
        let over = !worst.is_finite() || iterations == tuned.max_iterations || stalled > tuned.max_stalled;
        iterations += usize::from(!over);
        if over || !step(section, course, work) {
            if !over && change_modes(section, course, tuned.max_mode_changes, &mut work.system).0 {
                continue;
            }
            // Rounding: nothing is gained any more.
            return if worst <= tuned.stalled_residual_factor * tolerance(section, course)
                && modes_agree(section, course, &work.system)
            {
                Ok(Solved { iterations, residual: worst })
            } else {
                Err(stall(worst))
            };
        }
    }
}

/// The mode that the state of contact j asks for.
fn required_mode(section: &CableSection, course: &Course, system: &System, j: usize, patience: f64) -> Mode {
    let c = &section.contacts[j];
    if course.mobilised != 0.0 && c.kink().is_none() {
        return Mode::Slide(course.mobilised * course.friction(c));
    }
    if c.is_load() {
        return point_load::next_mode(section, course, j, patience);
    }
    // A contact that holds within its cone goes on so, and a smooth one slides.
    if matches!((c.mode, c.held), (Mode::Hold, Some(Held::Between(_) | Held::Meet(_)))) && course.friction(c) > 0.0 {
        return c.mode;
    }
    let track = Track { pivot: system.spots.get(j).map(|s| s.1), ..course.track(c) };
    equations::next_mode(&track, &c.history, &c.ends, c.held, c.mode, pinned(section, j), patience)
}

/// True if every contact is in the mode that its state asks for; the system is that of the state.
fn modes_agree(section: &CableSection, course: &Course, system: &System) -> bool {
    let tuned = &course.settings.newton;
    // Rounding grows with the stiffness as the residual does.
    let patience = tuned.cycle_rounding_factor * tolerance(section, course) / tuned.residual;
    (0..section.contacts.len()).all(|j| required_mode(section, course, system, j, patience) == section.contacts[j].mode)
}

/// Gives contacts the mode they ask for; whether any was changed, and whether none asked for
/// another.
fn change_modes(section: &mut CableSection, course: &Course, most: u32, system: &mut System) -> (bool, bool) {
    let tuned = &course.settings.newton;
    let (mut changed, mut content) = (false, true);
    for j in 0..section.contacts.len() {
        let flips = section.contacts[j].flips;
        let next = required_mode(
            section,
            course,
            system,
            j,
            if flips < tuned.max_mode_changes { 1.0 } else { tuned.cycle_rounding_factor },
        );
        let c = &mut section.contacts[j];
        content &= next == c.mode;
        if next != c.mode && c.flips < most {
            c.mode = next;
            c.flips += 1;
            changed = true;
            renew(section, course, j, system);
        }
    }
    (changed, content)
}

/// One Newton step with a line search on the sum of squares; false where none makes it smaller. The
/// system is that of where the section then is.
fn step(section: &mut CableSection, course: &Course, work: &mut Work) -> bool {
    gather(section, &mut work.saved);
    let before = squares(&work.system.residual);
    work.rhs.clear();
    work.rhs.extend(work.system.residual.iter().map(|v| -v));
    work.system.band.scale(&mut work.rhs);
    if work.system.band.solve(&mut work.rhs) && search(section, course, before, work) {
        return true;
    }
    scatter(section, course, &work.saved);
    assemble(section, course, &mut work.system);
    false
}

fn search(section: &mut CableSection, course: &Course, before: f64, work: &mut Work) -> bool {
    // Part of the step at which the first contact comes to the end of its piece of boundary.
    let (mut alpha, mut first) = (max_step(section, course, &work.saved, &work.rhs), None);
    for round in 0..course.settings.newton.max_halvings {
        if round > 1 {
            alpha = first.filter(|first| *first < alpha).unwrap_or(0.5 * alpha);
        }
        work.best.clear();
        work.best.extend(work.saved.iter().zip(&work.rhs).map(|(x, d)| x + alpha * d));
        if round == 1 {
            // At first only what changes its piece of boundary stops there; after that everything
            // does.
            borders(section, course, &work.saved, &work.rhs, |index, part| {
                if part > 0.0 && part < alpha {
                    first = Some(first.map_or(part, |first| smaller(part, first)));
                    work.best[index] = work.saved[index] + part * work.rhs[index];
                }
            });
            if first.is_none() {
                continue;
            }
        }
        scatter(section, course, &work.best);
        assemble(section, course, &mut work.system);
        if squares(&work.system.residual) < (1.0 - 1e-4 * alpha) * before {
            return true;
        }
    }
    false
}
