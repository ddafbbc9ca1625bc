//! Newton's method solves a section: all spans and contacts at once, without nested iterations for
//! single spans.
//!
//! | room | content |
//! |---|---|
//! | `jacobian.rs` | unknowns, residuals and band Jacobian of a section |
//! | `slip_predictor.rs` | complementarity estimate of which contacts will slide, and how far |
//! | `stability.rs` | stability test of a frictionless equilibrium |
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
//! At a lying end the tension replaces p among the unknowns, and the equation of its material
//! replaces that of tangency.

pub(in crate::model::spans) mod jacobian;
pub(in crate::model::spans) mod slip_predictor;
pub(in crate::model::spans) mod stability;

#[cfg(test)]
mod tests;

pub(in crate::model::spans) use slip_predictor::predict_slip;

use crate::math::{Vec2, larger, smaller};
use crate::model::spans::boundary::{ContactPath, Mode, StickZone, TensionProfile};
use crate::model::spans::contact::{equations, point_load};
use crate::model::spans::newton::jacobian::{
    SectionEquations, assemble, gather, has_tension_unknown, pinned, renew, scatter,
};
use crate::model::spans::newton::slip_predictor::SlipPredictor;
pub(super) use crate::model::spans::newton::stability::stable;
use crate::model::spans::section::{BoundaryConditions, CableSection, SolveContext};
use crate::model::spans::settings::NewtonSettings;
use crate::numerics::ARMIJO_FRACTION;

/// Greatest factor by which stiffness may widen the accepted residual of a section. Smaller: taut
/// stiff cables are halved at round-off until the search fails; larger: places are off.
const MAX_STIFF_RESIDUAL_FACTOR: f64 = 1e3;

/// Residual of round-off for EA/T = 1; the residual grows in proportion to EA/T.
const STIFF_RESIDUAL: f64 = 2e-14;
/// Residual of round-off, which no step reduces.
const RESIDUAL_ROUNDING: f64 = 5e-15;
/// Distance by which a step to the end of a boundary piece goes beyond it, as a fraction of p: more
/// than round-off, and negligible.
const PIECE_END_OVERSHOOT: f64 = 1e-9;

/// Working memory of a solve, kept between steps. A copy starts empty, because the contents have no
/// meaning between two steps.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    system: SectionEquations,
    rhs: Vec<f64>,
    saved: Vec<f64>,
    best: Vec<f64>,
    /// Winding numbers of the search for tunnelled corners.
    pub turns: Vec<i32>,
    /// The shape before and after a step.
    pub shapes: [Vec<Vec2>; 2],
    /// A section before a step, and with its ends moved.
    pub sections: [CableSection; 2],
    /// All sections before a step.
    pub before: Vec<CableSection>,
    /// Instants: before a step, at the start of a path, and at the end of a step.
    pub instants: [BoundaryConditions; 3],
    /// Working memory of the slip predictor.
    pub slip_predictor: SlipPredictor,
    /// Copy of a contact's friction memory.
    pub past: TensionProfile,
    /// Work that may still be done, in contacts and spans times iterations; when it is spent,
    /// solves fail. None: no limit.
    pub work_left: Option<usize>,
}

impl Clone for Workspace {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Newton's method did not converge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NotConverged {
    pub iterations: usize,
    /// Scaled residual left.
    pub residual: f64,
    /// Index of the contact with the greatest residual, or of the contact after the span with it.
    pub at: usize,
}

/// Cost of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Converged {
    pub iterations: usize,
    pub residual: f64,
}

/// The greatest absolute value and its index; that of the first that is not a number, if there is
/// one.
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

/// The accepted residual of a section whose contacts have the tensions of the spans beside them.
fn tolerance(section: &CableSection, context: &SolveContext) -> f64 {
    let (least, wanted) = (least_tension(section, context), context.settings.newton.residual);
    let stiff = if least.is_finite() && least > 0.0 { STIFF_RESIDUAL * context.law.stiffness / least } else { 0.0 };
    larger(wanted, stiff.min(MAX_STIFF_RESIDUAL_FACTOR * wanted))
}

/// True if an accepted residual still means a large error of forces: a missing length is a strain,
/// and that times EA is a force.
fn is_rough(section: &CableSection, context: &SolveContext, residual: f64) -> bool {
    let least = least_tension(section, context);
    least.is_finite()
        && residual
            > larger(RESIDUAL_ROUNDING, context.settings.newton.refined_residual_factor * least / context.law.stiffness)
}

/// The least tension at an end of a span, N; infinite where there is no span.
fn least_tension(section: &CableSection, context: &SolveContext) -> f64 {
    let mut least = f64::INFINITY;
    let mut take = |t: f64| {
        if t < least {
            least = t;
        }
    };
    let last = section.contacts.len();
    for (k, s) in [(0, section.from), (last, section.to)] {
        if section.has_span(k) {
            take(section.force(context, k, s).norm());
        }
    }
    for (j, c) in section.contacts.iter().enumerate() {
        for side in 0..2 {
            if section.has_span(j + side) {
                take(c.ends.tension[side]);
            }
        }
    }
    least
}

/// Greatest fraction of a step that keeps material in spans and does not jump a turn.
fn max_step(section: &CableSection, context: &SolveContext, x: &[f64], d: &[f64]) -> f64 {
    let tuned = &context.settings.newton;
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
        let contact_path = context.contact_path(c);
        for side in 0..2 {
            if has_tension_unknown(section, k, side) {
                continue;
            }
            let (p, dp) = (x[6 * k + 2 + 2 * side], d[6 * k + 2 + 2 * side]);
            if alpha * dp.abs() > tuned.max_turn && (contact_path.turns(p) || contact_path.turns(p + alpha * dp)) {
                alpha = tuned.max_turn / dp.abs();
            }
        }
    }
    alpha
}

/// Calls back with (index, fraction of the step) for each end of a contact that gets just beyond
/// its boundary piece in the step.
///
/// Round an arc the direction turns by one per rad, along an edge the cable leaves it by w/T per
/// metre: a step that is right on one piece is meaningless on the other.
fn borders(section: &CableSection, context: &SolveContext, x: &[f64], d: &[f64], mut each: impl FnMut(usize, f64)) {
    for (k, c) in section.contacts.iter().enumerate() {
        let contact_path = context.contact_path(c);
        for side in 0..2 {
            let index = 6 * k + 2 + 2 * side;
            let (p, dp) = (x[index], d[index]);
            if has_tension_unknown(section, k, side) || dp == 0.0 {
                continue;
            }
            let i = contact_path.curve.locate(p, c.chain_range);
            let beyond = PIECE_END_OVERSHOOT * (1.0 + p.abs());
            let way = match dp > 0.0 {
                true if i < c.chain_range.last => contact_path.curve.end(i) - p + beyond,
                false if i > c.chain_range.first => contact_path.curve.origin(i) - p - beyond,
                _ => continue,
            };
            each(index, way / dp);
        }
    }
}

/// Progress of an iteration.
struct IterationProgress {
    iterations: usize,
    /// The residual that counts as the last progress.
    best: f64,
    /// Number of iterations since then.
    stalled: usize,
}

impl IterationProgress {
    fn new() -> Self {
        Self { iterations: 0, best: f64::INFINITY, stalled: 0 }
    }

    /// Takes in the residual of an iterate.
    fn record(&mut self, residual: f64) {
        if residual < 0.5 * self.best {
            (self.best, self.stalled) = (residual, 0);
        } else {
            self.stalled += 1;
        }
    }

    fn is_over(&self, tuned: &NewtonSettings) -> bool {
        self.iterations == tuned.max_iterations || self.stalled > tuned.max_stalled
    }

    /// Forgets the residuals of other equations.
    fn restart(&mut self) {
        (self.best, self.stalled) = (f64::INFINITY, 0);
    }
}

/// Lets contacts slide that friction drives in one direction, and forgets how often each has
/// changed its mode.
fn start_modes(section: &mut CableSection, context: &SolveContext) {
    for c in &mut section.contacts {
        c.mode_changes = 0;
        if context.mobilised != 0.0 && c.kink().is_none() {
            c.mode = Mode::Slip(context.mobilised * context.friction(c));
        }
    }
}

/// Solves a section from its present state. On an error it holds the last iterate.
pub(super) fn solve(
    section: &mut CableSection,
    context: &SolveContext,
    workspace: &mut Workspace,
) -> Result<Converged, NotConverged> {
    let tuned = &context.settings.newton;
    section.update_end_tensions(context);
    start_modes(section, context);
    let (mut progress, mut polished) = (IterationProgress::new(), f64::INFINITY);
    assemble(section, context, &mut workspace.system);
    loop {
        let (mut worst, mut at) = norm(&workspace.system.residual);
        let done = worst <= tolerance(section, context);
        if worst <= tuned.mode_residual || progress.stalled >= tuned.mode_stalled_iterations {
            let most = if done { 4 * tuned.max_mode_changes } else { tuned.max_mode_changes };
            let (changed, content) = change_modes(section, context, most, &mut workspace.system);
            if changed {
                (worst, at) = norm(&workspace.system.residual);
                progress.restart();
                // Within round-off at the edge of the friction cone another mode changes nothing:
                // the section is solved.
                if worst <= tolerance(section, context) {
                    continue;
                }
            } else if done {
                // Polish as long as it helps: where a tension vanishes, Newton's method converges
                // only linearly.
                if content && worst < 0.5 * polished && is_rough(section, context, worst) {
                    polished = worst;
                    progress.iterations += 1;
                    if step(section, context, workspace) {
                        continue;
                    }
                }
                return if content || modes_agree(section, context, &workspace.system) {
                    Ok(Converged { iterations: progress.iterations, residual: worst })
                } else {
                    Err(NotConverged { iterations: progress.iterations, residual: worst, at: at / 6 })
                };
            }
        }
        let last = NotConverged { iterations: progress.iterations, residual: worst, at: at / 6 };
        progress.record(worst);
        let over = !worst.is_finite() || progress.is_over(tuned);
        progress.iterations += usize::from(!over);
        if over || !step(section, context, workspace) {
            if !over && change_modes(section, context, tuned.max_mode_changes, &mut workspace.system).0 {
                continue;
            }
            // At round-off no step helps any more.
            return if worst <= tuned.stalled_residual_factor * tolerance(section, context)
                && modes_agree(section, context, &workspace.system)
            {
                Ok(Converged { iterations: progress.iterations, residual: worst })
            } else {
                Err(last)
            };
        }
    }
}

/// The mode that the state of contact j requires.
fn required_mode(
    section: &CableSection,
    context: &SolveContext,
    system: &SectionEquations,
    j: usize,
    patience: f64,
) -> Mode {
    let c = &section.contacts[j];
    if context.mobilised != 0.0 && c.kink().is_none() {
        return Mode::Slip(context.mobilised * context.friction(c));
    }
    if c.is_load() {
        return point_load::next_mode(section, context, j, patience);
    }
    // A contact that sticks within its friction cone stays so, and a frictionless one slides.
    if matches!((c.mode, c.stick_zone), (Mode::Stick, Some(StickZone::Between(_) | StickZone::Meet(_))))
        && context.friction(c) > 0.0
    {
        return c.mode;
    }
    let contact_path = ContactPath { cached_piece: system.end_points.get(j).map(|s| s.1), ..context.contact_path(c) };
    equations::next_mode(&contact_path, &c.history, &c.ends, c.stick_zone, c.mode, pinned(section, j), patience)
}

/// True if every contact is in the mode that its state requires; `system` is assembled at that
/// state.
fn modes_agree(section: &CableSection, context: &SolveContext, system: &SectionEquations) -> bool {
    let tuned = &context.settings.newton;
    // Like the residual, round-off grows with the stiffness.
    let patience = tuned.cycle_rounding_factor * tolerance(section, context) / tuned.residual;
    (0..section.contacts.len())
        .all(|j| required_mode(section, context, system, j, patience) == section.contacts[j].mode)
}

/// Gives contacts the mode that they require; returns whether any was changed, and whether all have
/// the required mode.
fn change_modes(
    section: &mut CableSection,
    context: &SolveContext,
    most: u32,
    system: &mut SectionEquations,
) -> (bool, bool) {
    let tuned = &context.settings.newton;
    let (mut changed, mut content) = (false, true);
    for j in 0..section.contacts.len() {
        let mode_changes = section.contacts[j].mode_changes;
        let next = required_mode(
            section,
            context,
            system,
            j,
            if mode_changes < tuned.max_mode_changes { 1.0 } else { tuned.cycle_rounding_factor },
        );
        let c = &mut section.contacts[j];
        content &= next == c.mode;
        if next != c.mode && c.mode_changes < most {
            c.mode = next;
            c.mode_changes += 1;
            changed = true;
            renew(section, context, j, system);
        }
    }
    (changed, content)
}

/// Takes one Newton step with a line search on the sum of squares; false if no step reduces it. The
/// system is assembled at the new state.
fn step(section: &mut CableSection, context: &SolveContext, workspace: &mut Workspace) -> bool {
    if let Some(left) = &mut workspace.work_left {
        *left = left.saturating_sub(section.contacts.len() + 1);
        if *left == 0 {
            return false;
        }
    }
    gather(section, &mut workspace.saved);
    let before = squares(&workspace.system.residual);
    workspace.rhs.clear();
    workspace.rhs.extend(workspace.system.residual.iter().map(|v| -v));
    workspace.system.band.scale(&mut workspace.rhs);
    if workspace.system.band.solve(&mut workspace.rhs) && search(section, context, before, workspace) {
        return true;
    }
    scatter(section, context, &workspace.saved);
    assemble(section, context, &mut workspace.system);
    false
}

/// Takes the longest fraction of the step that lowers the residual; returns whether there is one.
fn search(section: &mut CableSection, context: &SolveContext, before: f64, workspace: &mut Workspace) -> bool {
    // `first` is the fraction of the step at which the first contact reaches the end of its
    // boundary piece.
    let (mut alpha, mut first) = (max_step(section, context, &workspace.saved, &workspace.rhs), None);
    for round in 0..context.settings.newton.max_halvings {
        if round > 1 {
            alpha = first.filter(|first| *first < alpha).unwrap_or(0.5 * alpha);
        }
        workspace.best.clear();
        workspace.best.extend(workspace.saved.iter().zip(&workspace.rhs).map(|(x, d)| x + alpha * d));
        if round == 1 {
            // At first only the contacts that change their boundary piece stop there; after that
            // the whole step is cut.
            borders(section, context, &workspace.saved, &workspace.rhs, |index, part| {
                if part > 0.0 && part < alpha {
                    first = Some(first.map_or(part, |first| smaller(part, first)));
                    workspace.best[index] = workspace.saved[index] + part * workspace.rhs[index];
                }
            });
            if first.is_none() {
                continue;
            }
        }
        scatter(section, context, &workspace.best);
        assemble(section, context, &mut workspace.system);
        if squares(&workspace.system.residual) < (1.0 - ARMIJO_FRACTION * alpha) * before {
            return true;
        }
    }
    false
}
