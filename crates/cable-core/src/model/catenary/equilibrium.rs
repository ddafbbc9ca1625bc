//! This module solves for the equilibrium: the slipping pulleys, the material at pulleys, and the
//! tangent points on wheels.

use super::sliding_problem::{BalanceForm, PulleyMode, SlidingProblem, SpanSolutions, WheelArc};
use super::supports_and_loads::SupportLayout;
use crate::error::{Near, NearKind, NoEquilibrium, Place, SolveError};
use crate::linalg::{TridiagonalRow as Row, solve_tridiagonal};
use crate::math::larger;
use crate::model::Model;
use crate::numerics::{ARMIJO_FRACTION, MAX_HALVINGS, backtrack};
use crate::problem::Problem;

/// Material that must have moved against the friction of a pulley before the pulley holds again, as
/// a fraction of the cable's length. Smaller: round-off makes it hold and slip in turn; larger: it
/// slips on where it ought to hold.
const REVERSAL_FRACTION: f64 = 1e-12;
/// Pivot below which an energy counts as not convex, as a fraction of the largest. Smaller: steps
/// as long as round-off makes them; larger: flat energies are shifted without need, and converge
/// slowly.
const LEAST_PIVOT_FRACTION: f64 = 1e-12;
/// First shift of the diagonal of an energy that is not convex, as a fraction of the largest pivot.
/// Smaller: more shifts are tried; larger: the first steps are shorter than they need be.
const FIRST_SHIFT_FRACTION: f64 = 1e-3;
/// Factor from one shift of the diagonal to the next. Smaller: more are tried; larger: as above.
const SHIFT_GROWTH: f64 = 4.0;
/// Maximum number of shifts of the diagonal: 4⁶⁰ exceeds every matrix. Fewer: a solve could fail
/// that a larger shift would save.
const MAX_SHIFTS: usize = 60;

/// A balance found.
#[derive(Clone, Debug)]
pub(super) struct Equilibrium {
    /// Material point at each anchor, m.
    pub sigma: Vec<f64>,
    pub modes: Vec<PulleyMode>,
    pub arcs: Vec<WheelArc>,
    pub stretches: SpanSolutions,
    pub iterations: usize,
    /// Largest unbalanced tension at a pulley, N.
    pub residual: f64,
    /// True if it is unstable, and no stable equilibrium was found from it.
    pub runs_away: bool,
}

/// Initial unknowns of a solve and the slip that friction remembers.
pub(super) struct SlidingStart<'a> {
    /// Material points that friction holds, m.
    pub rest_points: &'a [f64],
    /// First guess of the material points, m.
    pub sigma: Vec<f64>,
    pub modes: Vec<PulleyMode>,
    pub arcs: Vec<WheelArc>,
}

/// Balance wanted at a pulley, relative to its tension.
const PULLEY_BALANCE_TOLERANCE: f64 = 1e-13;
/// Balance accepted where round-off allows no better.
const ACCEPTED_BALANCE_FRACTION: f64 = 1e-9;
/// Wheel angles wanted, rad.
const ANGLE: f64 = 1e-12;
/// A dangling end shorter than this part of the cable has run off its pulley.
const RUN_OFF_LENGTH_FRACTION: f64 = 1e-6;
/// Below this part of the energy a predicted decrease is round-off.
const ENERGY_NOISE: f64 = 1e-9;
/// Lengths of an iteration's step that are tried. 2⁻⁴⁰ of a step changes energy and residual by
/// less than their rounding: no shorter one could be told from none.
const STEP_HALVINGS: usize = 40;
/// First displacement that leaves an unstable equilibrium, as a fraction of the length. Smaller:
/// the energy falls by no more than round-off; larger: a nearby equilibrium is missed.
const LEAVING_FRACTION: f64 = 1e-2;
/// A pulley slips when friction is exceeded by this much (in ln T). Smaller: chatter of round-off.
const CONE_TOLERANCE: f64 = 1e-10;

/// Finds the equilibrium: spans and friction for given arcs on the wheels, and arcs for the spans,
/// in turn.
pub(super) fn solve(p: &Problem, layout: &SupportLayout, start: SlidingStart<'_>) -> Result<Equilibrium, SolveError> {
    let SlidingStart { rest_points, mut sigma, mut modes, mut arcs } = start;
    let wheels = layout.anchors.iter().any(|a| a.radius > 0.0);
    let mut iterations = 0;
    let (mut lifted, mut near) = (None, None);
    for _ in 0..layout.settings.max_iterations {
        let slide = SlidingProblem { problem: p, layout, arcs: &arcs };
        let found = solve_with_friction(&slide, rest_points, sigma, near, modes)?;
        iterations += found.iterations;
        let m = |k: usize| required_friction(&slide, &found.stretches, k, found.modes[k]);
        let next = slide.turn_arcs(&found.stretches, m);
        if !wheels || (next.error_rad <= ANGLE && next.lifted.is_none()) {
            return Ok(Equilibrium { iterations, ..found });
        }
        (sigma, modes, arcs, lifted, near) = (found.sigma, found.modes, next.arcs, next.lifted, Some(found.stretches));
    }
    match lifted {
        Some(k) => {
            let name = p.supports.get(layout.anchors[k].support).map_or("", |s| s.name.as_str());
            Err(SolveError::NoRestingPlace { why: NoEquilibrium::LeavesWheel { pulley: name.to_owned() } })
        }
        None => Err(not_converged(p, layout, 0, iterations, f64::NAN)),
    }
}

/// The mobilised friction m of pulley `k`, 0 where the cable does not pass it: on a sticking wheel
/// the single m of the whole arc that connects both tensions, with the weight on the arc. With the
/// m of a point, ln(T₂/T₁)/turn, the material on the wheel would jump when it begins to slip, by
/// 0.1 mm in one of 300 random wheels, for which neither state was then an equilibrium.
pub(super) fn required_friction(slide: &SlidingProblem<'_>, spans: &SpanSolutions, k: usize, mode: PulleyMode) -> f64 {
    let (Some(before), Some(after)) = SlidingProblem::forces(spans, k) else { return 0.0 };
    if let PulleyMode::Slip(m) = mode {
        return m;
    }
    let turn = slide.turn(k, before, after);
    let mut m = 0.0;
    // The slope of the excess by m is the turn but for the weight.
    for _ in 0..slide.layout.settings.max_iterations {
        let change = if turn > 0.0 { slide.excess(k, before, after, m).0 / turn } else { 0.0 };
        m += change;
        if !(change.abs() > CONE_TOLERANCE) {
            break;
        }
    }
    m
}

/// The error of a solve that found no balance, at an anchor, with the greatest unbalanced tension
/// (N).
fn not_converged(p: &Problem, layout: &SupportLayout, anchor: usize, iterations: usize, residual_n: f64) -> SolveError {
    let place = layout.anchors.get(anchor).map(|a| Place {
        arc_length_m: a.material_point.unwrap_or(f64::NAN),
        at_m: a.at,
        near: p.supports.get(a.support).map(|s| Near {
            kind: NearKind::Support,
            name: s.name.clone(),
            distance_m: 0.0,
        }),
    });
    let place = Box::new(place.unwrap_or_default());
    SolveError::NotConverged { model: Model::Catenary, iterations, residual_n, place }
}

/// Finds the equilibrium with friction: each pulley sticks or slips as its friction cone and its
/// slip direction require.
fn solve_with_friction(
    slide: &SlidingProblem<'_>,
    rest_points: &[f64],
    mut sigma: Vec<f64>,
    mut near: Option<SpanSolutions>,
    mut modes: Vec<PulleyMode>,
) -> Result<Equilibrium, SolveError> {
    let layout = slide.layout;
    let (mut iterations, joint) = (0, layout.settings.joint_mode_rounds);
    for round in 0..4 * joint + 4 * layout.anchors.len() {
        let found = match newton(slide, sigma.clone(), near.as_ref(), &modes) {
            Ok(e) => e,
            // Another branch of the slip law attracted the iteration: start from the frictionless
            // equilibrium, and report the first error if that fails.
            Err(e) => from_smooth(slide, sigma, &modes).map_err(|_| e)?,
        };
        iterations += found.iterations;
        sigma = found.sigma;
        let mut changed = false;
        for (k, a) in layout.anchors.iter().enumerate() {
            if a.material_point.is_some() || a.friction <= 0.0 || (changed && round >= joint) {
                continue;
            }
            let (Some(b), Some(f)) = SlidingProblem::forces(&found.stretches, k) else { continue };
            let next = match modes[k] {
                PulleyMode::Stick if slide.excess(k, b, f, a.friction).0 > CONE_TOLERANCE => {
                    PulleyMode::Slip(a.friction)
                }
                PulleyMode::Stick if slide.excess(k, b, f, -a.friction).0 < -CONE_TOLERANCE => {
                    PulleyMode::Slip(-a.friction)
                }
                // Friction +μ acts against material that moves to the side after the pulley, so σ
                // must have fallen.
                PulleyMode::Slip(m)
                    if m * (sigma[k] - rest_points[k]) > REVERSAL_FRACTION * a.friction * slide.problem.length =>
                {
                    sigma[k] = rest_points[k];
                    PulleyMode::Stick
                }
                same => same,
            };
            changed |= next != modes[k];
            modes[k] = next;
        }
        if !changed {
            return Ok(Equilibrium { sigma, modes, arcs: slide.arcs.to_vec(), iterations, ..found });
        }
        near = Some(found.stretches);
    }
    Err(not_converged(slide.problem, layout, 0, iterations, f64::NAN))
}

/// Finds the equilibrium with the given modes, starting without friction at slipping pulleys (an
/// energy is minimised, so any start converges) and raising friction to its value.
fn from_smooth(slide: &SlidingProblem<'_>, sigma: Vec<f64>, modes: &[PulleyMode]) -> Result<Equilibrium, SolveError> {
    let with = |part: f64| -> Vec<PulleyMode> {
        modes.iter().map(|m| if let PulleyMode::Slip(m) = m { PulleyMode::Slip(part * m) } else { *m }).collect()
    };
    let mut found = newton(slide, sigma, None, &with(0.0))?;
    let (mut reached, mut rise, mut iterations) = (0.0f64, 1.0f64, found.iterations);
    // One rise has done for every scene tried: 400 random dead loads over a rubbing wheel, EA 3e4
    // to 1e9.
    while rise >= 0.5f64.powi(MAX_HALVINGS as i32) {
        let next = if reached + rise < 1.0 { reached + rise } else { 1.0 };
        match newton(slide, found.sigma.clone(), Some(&found.stretches), &with(next)) {
            Ok(e) => {
                iterations += e.iterations;
                (found, reached, rise) = (Equilibrium { iterations, ..e }, next, 2.0 * rise);
                if next >= 1.0 {
                    return Ok(found);
                }
            }
            Err(_) => rise *= 0.5,
        }
    }
    Err(not_converged(slide.problem, slide.layout, 0, iterations, f64::NAN))
}

/// The balance of every anchor.
struct BalanceRows {
    /// Residual of each; zero where nothing slides.
    residuals: Vec<f64>,
    /// Slopes of each by the material at the anchors before, here and after; 0, 1, 0 where nothing
    /// slides.
    slopes: Vec<Row>,
    /// Greatest residual as a fraction of the tension.
    worst_fraction: f64,
    /// Greatest unbalanced tension, N.
    worst_n: f64,
}

/// The balance with the given modes; None if a span has no force.
fn balance_rows(
    slide: &SlidingProblem<'_>,
    s: &SpanSolutions,
    modes: &[PulleyMode],
    form: BalanceForm,
) -> Option<BalanceRows> {
    let n = modes.len();
    let (mut r, mut j) = (vec![0.0; n], vec![[0.0, 1.0, 0.0]; n]);
    let (mut worst_fraction, mut worst_n) = (0.0f64, 0.0f64);
    for k in 0..n {
        let PulleyMode::Slip(m) = modes[k] else { continue };
        let (rk, mut row) = slide.row(s, k, m, form)?;
        if k == 0 || modes[k - 1] == PulleyMode::Stick {
            row[0] = 0.0;
        }
        if k + 1 == n || modes[k + 1] == PulleyMode::Stick {
            row[2] = 0.0;
        }
        let tension = SlidingProblem::forces(s, k).1?.norm();
        let relative = match form {
            BalanceForm::Energy => rk.abs() / (slide.problem.thermal_stretch * tension),
            BalanceForm::SlipLaw => rk.abs(),
        };
        worst_fraction = larger(worst_fraction, relative);
        worst_n = larger(worst_n, relative * tension);
        (r[k], j[k]) = (rk, row);
    }
    Some(BalanceRows { residuals: r, slopes: j, worst_fraction, worst_n })
}

/// −J⁻¹ r for a three-diagonal J, by elimination; in the form of an energy the pivots are lifted
/// until all are positive, so that the step goes down in energy.
fn step(r: &[f64], j: &[Row], form: BalanceForm) -> Option<Vec<f64>> {
    let largest = j.iter().fold(0.0f64, |m, row| if row[1].abs() > m { row[1].abs() } else { m });
    let mut shift = 0.0;
    for _ in 0..MAX_SHIFTS {
        let lifted: Vec<Row> = j.iter().map(|[before, own, after]| [*before, own + shift, *after]).collect();
        let mut p: Vec<f64> = r.iter().map(|r| -r).collect();
        let will_do = |pivot: &f64| form == BalanceForm::SlipLaw || *pivot > LEAST_PIVOT_FRACTION * largest;
        if solve_tridiagonal(&lifted, &mut p, |pivot| Some(pivot).filter(will_do)) {
            return p.iter().all(|v| v.is_finite()).then_some(p);
        }
        shift = if shift > 0.0 { SHIFT_GROWTH * shift } else { FIRST_SHIFT_FRACTION * largest };
    }
    None
}

/// A direction of σ in which the equilibrium is unstable; None if it is stable: a disturbance of σ
/// is drawn back (all pivots of J positive). With much slack a fold pulls harder the longer it is:
/// that is an equilibrium, too, but an unstable one.
///
/// The direction v solves J v = 0 in the rows before the first pivot p that is not positive, where
/// v is 1 and beyond which it is 0: vᵀJv = p for a symmetric J.
fn runs_away(j: &[Row]) -> Option<Vec<f64>> {
    let mut pivots: Vec<f64> = Vec::with_capacity(j.len());
    for k in 0..j.len() {
        let taken = pivots.last().map_or(0.0, |before| j[k][0] * j[k - 1][2] / before);
        let pivot = j[k][1] - taken;
        if pivot > 0.0 {
            pivots.push(pivot);
            continue;
        }
        let mut way = vec![0.0; j.len()];
        way[k] = 1.0;
        for i in (0..k).rev() {
            way[i] = -j[i][2] * way[i + 1] / pivots[i];
        }
        return Some(way);
    }
    None
}

/// Leaves an unstable equilibrium for a state of lower energy, first forward (1) or backward (−1)
/// along its direction; None if neither has lower energy.
fn leave_unstable(
    slide: &SlidingProblem<'_>,
    sigma: &[f64],
    s: &SpanSolutions,
    way: &[f64],
    first: f64,
) -> Option<(Vec<f64>, SpanSolutions)> {
    let largest = way.iter().fold(0.0f64, |m, w| larger(m, w.abs()));
    backtrack(LEAVING_FRACTION * slide.problem.length / largest, STEP_HALVINGS, |far| {
        [far * first, -far * first].into_iter().find_map(|far| {
            let step: Vec<f64> = way.iter().map(|w| far * w).collect();
            let part = max_feasible_step(slide, s, &step);
            let there: Vec<f64> = sigma.iter().zip(&step).map(|(a, b)| a + part * b).collect();
            let t = slide.stretches(&there, Some(s)).filter(|t| t.energy < s.energy)?;
            Some((there, t))
        })
    })
}

/// Greatest fraction of a step that keeps some material in every stretch.
fn max_feasible_step(slide: &SlidingProblem<'_>, s: &SpanSolutions, p: &[f64]) -> f64 {
    let (mut alpha, least_fraction) = (1.0f64, slide.layout.settings.kept_stretch_fraction);
    for (i, stretch) in s.all.iter().enumerate() {
        let Some(stretch) = stretch else { continue };
        let from = if i == 0 { 0.0 } else { p[i - 1] };
        let to = if i == slide.arcs.len() { 0.0 } else { p[i] };
        let (length, change) = (stretch.to - stretch.from, to - from);
        if change < 0.0 && alpha * -change > (1.0 - least_fraction) * length {
            alpha = (1.0 - least_fraction) * length / -change;
        }
    }
    alpha
}

/// Newton's method for σ with the given modes, from a first σ and the stretches near it if known.
/// An unstable equilibrium is returned only if leaving it leads to no other.
fn newton(
    slide: &SlidingProblem<'_>,
    sigma: Vec<f64>,
    near: Option<&SpanSolutions>,
    modes: &[PulleyMode],
) -> Result<Equilibrium, SolveError> {
    let mut left = None;
    let mut from = |sigma: Vec<f64>, first: f64| descend(slide, sigma, near, modes, first, &mut left);
    let found = from(sigma.clone(), 1.0).or_else(|_| from(sigma, -1.0));
    found.or_else(|why| left.ok_or(why))
}

/// As [`newton`]; `left` is the unstable equilibrium that was left last, `first` the direction in
/// which leaving is tried first.
fn descend(
    slide: &SlidingProblem<'_>,
    sigma: Vec<f64>,
    near: Option<&SpanSolutions>,
    modes: &[PulleyMode],
    first: f64,
    left: &mut Option<Equilibrium>,
) -> Result<Equilibrium, SolveError> {
    let layout = slide.layout;
    let form = BalanceForm::of(modes);
    let mut sigma = sigma;
    let lost = |iterations| not_converged(slide.problem, layout, 0, iterations, f64::NAN);
    let mut s = slide.stretches(&sigma, near).ok_or_else(|| lost(0))?;
    let (mut iterations, mut before) = (s.iterations, f64::INFINITY);
    for _ in 0..layout.settings.max_iterations {
        let BalanceRows { residuals: r, slopes: j, worst_fraction: worst, worst_n } =
            balance_rows(slide, &s, modes, form).ok_or_else(|| lost(iterations))?;
        // Newton's method gains far more than a half there, unless what is left is rounding.
        let rounding = worst <= ACCEPTED_BALANCE_FRACTION && worst > 0.5 * before;
        before = worst;
        let end = move |sigma, s, residual| Equilibrium {
            sigma,
            modes: modes.to_vec(),
            arcs: Vec::new(),
            stretches: s,
            iterations,
            residual,
            runs_away: false,
        };
        let next = if worst <= PULLEY_BALANCE_TOLERANCE || rounding {
            None
        } else {
            run_off(slide, &s)?;
            let p = step(&r, &j, form).ok_or_else(|| lost(iterations))?;
            let (next, spent) = search(slide, &sigma, &s, &r, &p, modes);
            iterations += spent;
            next
        };
        if let Some(next) = next {
            (sigma, s) = next;
            continue;
        }
        if !(worst <= ACCEPTED_BALANCE_FRACTION) {
            return Err(not_converged(slide.problem, layout, 0, iterations, worst_n));
        }
        let Some(way) = runs_away(&j) else { return Ok(end(sigma, s, worst_n)) };
        if form == BalanceForm::SlipLaw {
            return Err(lost(iterations));
        }
        let next = leave_unstable(slide, &sigma, &s, &way, first);
        *left = Some(Equilibrium { runs_away: true, ..end(sigma, s, worst_n) });
        (sigma, s) = next.ok_or_else(|| lost(iterations))?;
        iterations += s.iterations;
    }
    Err(lost(iterations))
}

/// The material at the pulleys and the stretches after the longest fraction of a step `p` that
/// lowers the energy (without friction) or, with friction or near round-off, the residual; and the
/// number of iterations of the stretches.
fn search(
    slide: &SlidingProblem<'_>,
    sigma: &[f64],
    s: &SpanSolutions,
    r: &[f64],
    p: &[f64],
    modes: &[PulleyMode],
) -> (Option<(Vec<f64>, SpanSolutions)>, usize) {
    let form = BalanceForm::of(modes);
    let mut spent = 0;
    let slope: f64 = r.iter().zip(p).map(|(a, b)| a * b).sum();
    let size = |r: &[f64]| r.iter().map(|v| v * v).sum::<f64>();
    let (energy, norm) = (s.energy, size(r));
    let found = backtrack(max_feasible_step(slide, s, p), STEP_HALVINGS, |alpha| {
        let trial: Vec<f64> = sigma.iter().zip(p).map(|(a, b)| a + alpha * b).collect();
        let t = slide.stretches(&trial, Some(s))?;
        spent += t.iterations;
        let down = form == BalanceForm::Energy && t.energy - energy <= ARMIJO_FRACTION * alpha * slope;
        let noise = form == BalanceForm::SlipLaw || alpha * slope.abs() <= ENERGY_NOISE * energy.abs();
        let closer = noise
            && balance_rows(slide, &t, modes, form)
                .is_some_and(|b| size(&b.residuals) < (1.0 - ARMIJO_FRACTION * alpha) * norm);
        (down || closer).then_some((trial, t))
    });
    (found, spent)
}

/// A dangling end that has run through its pulley.
fn run_off(slide: &SlidingProblem<'_>, s: &SpanSolutions) -> Result<(), SolveError> {
    let ends = [(0, 0), (s.all.len() - 1, slide.arcs.len() - 1)];
    for (i, k) in ends {
        let short = s.all[i].is_some_and(|e| e.to - e.from < RUN_OFF_LENGTH_FRACTION * slide.problem.length);
        let anchor = &slide.layout.anchors[k];
        if short && anchor.material_point.is_none() {
            let name = slide.problem.supports.get(anchor.support).map_or("", |p| p.name.as_str());
            return Err(SolveError::NoRestingPlace { why: NoEquilibrium::RunsOff { pulley: name.to_owned() } });
        }
    }
    Ok(())
}
