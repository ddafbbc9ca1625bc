//! Newton's method balances all pulleys with friction together: run-on and run-off angles of the
//! wheels and the material on them.
//!
//! The unknowns at a wheel are the angles p₁, p₂ at which the cable meets and leaves it and the arc
//! lengths s₁, s₂ there; at a pulley without a radius only the arc length. The spans between follow
//! from these (`span`), so the equations are few:
//!
//! ```text
//! wheel    t(p₁) × F₁ = 0,  t(p₂) × F₂ = 0,  and the two of the friction on it (`spans::contact::wheel_friction`)
//! point    holds: s = s_old,    slides with m: ln(T₂/T₁) = m·turn
//! ```
//!
//! Slip is complementary to friction: a pulley that sticks lies within its friction cone, and one
//! that slides has moved against its friction since the last step *at points fixed to the wheel*.
//! The middle of the arc is no such point: it moves by half the radius times the turn of the
//! directions, which is more than a stiff cable stretches, so friction could get the wrong sign.
//! Newton's method with a line search solves one set of modes; then the modes are checked.

use crate::numerics::{ARMIJO_FRACTION, backtrack};
use nalgebra::{DMatrix, DVector};

use crate::math::{Vec2, cross, larger, perp};
use crate::model::fem::free::element::turn_between;
use crate::model::fem::free::pulley_balance::{PulleyFailure, PulleyNetwork};
use crate::model::fem::free::pulley_state::{FrictionState, PointFriction, PulleyState, Unknown};
use crate::model::fem::free::span::SpanEnd;
use crate::model::fem::free::stations::{Restraint, Station};

/// Maximum number of Newton steps for one set of modes. Measured: 2 to 8.
const MAX_STEPS: usize = 40;
/// Maximum number of halvings of one step.
const MAX_HALVINGS: usize = 14;
/// Maximum number of sets of modes, per pulley.
const MAX_MODES: usize = 12;
/// Greatest residual of solved equations: relative for a tension, in rad for an angle, and relative
/// to [`MATERIAL_ERROR_FRACTION`] times the cable's length for an arc length.
const RESIDUAL_TOLERANCE: f64 = 1e-13;
/// As above if no step makes the residual smaller, as in `pulley_balance`.
const RESIDUAL_LIMIT: f64 = 1e-8;
/// Fraction of the cable's length whose error counts as much as an error of the whole tension.
/// Larger: steps are judged by tension alone; smaller: by material.
const MATERIAL_ERROR_FRACTION: f64 = 0.01;
/// Greatest turn of an end round its wheel in a step, rad: with more it could come out on the other
/// side.
const MOST_TURN: f64 = 0.5;
/// Fraction of the cable between two stations that a step may take.
const STEP_ROOM_FRACTION: f64 = 0.4;
/// Excess over the friction cone or the length at which a mode changes, in roundings.
const MODE_CHANGE_ROUNDINGS: f64 = 30.0;
/// Round-off of the friction cone of a pulley without a radius (in ln T), and of its slip as a
/// fraction of the cable.
const CONE_ROUNDING: f64 = 1e-12;
const STEP_TOLERANCE: f64 = 1e-13;
/// The change of the force beside a station with an unknown.
#[derive(Clone, Copy)]
struct ForceSlope {
    station: usize,
    /// 0 before the station, 1 after it.
    side: usize,
    slope: Vec2,
}

/// The change of a residual with the force beside a station.
#[derive(Clone, Copy)]
struct ResidualSlope {
    row: usize,
    station: usize,
    /// 0 before the station, 1 after it.
    side: usize,
    slope: Vec2,
}

/// The changes between sticking and sliding that are made at once.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ModeChanges {
    /// Those of all pulleys.
    All,
    /// That of the first pulley that has one.
    First,
}

/// The equations of all pulleys at a state.
struct FrictionEquations {
    residual: DVector<f64>,
    /// Derivatives by the unknowns, with the forces frozen.
    own: DMatrix<f64>,
    /// Derivatives by the forces beside stations.
    by_force: Vec<ResidualSlope>,
}

impl PulleyNetwork {
    /// Finds the balance of all pulleys from their memory, which does not change.
    ///
    /// # Errors
    /// The reason why there is none.
    pub fn balance_with_friction(&mut self) -> Result<(), PulleyFailure> {
        self.steps = 0;
        let pulleys = self.pulleys();
        self.apply_unknowns(&pulleys)?;
        let most = MAX_MODES * pulleys.len();
        for round in 0..most {
            let solved = self.newton_on_pulleys(&pulleys);
            // After some rounds only one mode changes at a time: together they may cycle.
            let changes = if round < most / 2 { ModeChanges::All } else { ModeChanges::First };
            let changed = self.change_modes(&pulleys, changes);
            match (solved, changed) {
                (Ok(()), false) => {
                    for (&k, r) in pulleys.iter().zip(&self.pulley_states) {
                        if matches!(r.friction, FrictionState::Wheel(_)) && r.angles[1] < r.angles[0] {
                            return Err(PulleyFailure::LeavesWheel(k));
                        }
                    }
                    self.warm_now();
                    return Ok(());
                }
                (Err(failure), false) => return Err(failure),
                (_, true) => {}
            }
        }
        Err(PulleyFailure::Unbalanced(pulleys.first().copied().unwrap_or(0), self.residual))
    }

    /// Moves the stations to the unknowns and solves the spans between them.
    fn apply_unknowns(&mut self, pulleys: &[usize]) -> Result<(), PulleyFailure> {
        for (&k, r) in pulleys.iter().zip(&self.pulley_states) {
            let station: &mut Station = &mut self.layout.stations[k];
            (station.arc_length, station.material_on_wheel) = (r.material[0], r.material[1] - r.material[0]);
            if let (Restraint::Pulley(wheel), FrictionState::Wheel(w)) = (&mut station.restraint, &r.friction) {
                wheel.contact = r.angles.map(|p| w.directions(p)[1]);
            }
        }
        let stations = &self.layout.stations;
        let runs_out = (1..stations.len()).find(|&k| !(stations[k].arc_length > stations[k - 1].leaves()));
        if let Some(k) = runs_out {
            return Err(PulleyFailure::RunsOut(if stations[k].support.is_some() && self.wheel(k).is_some() {
                k
            } else {
                k - 1
            }));
        }
        self.solve_spans()
    }

    /// The residuals of all pulleys with friction, and their slopes by own unknowns and by the
    /// forces of the spans.
    fn equations(&mut self, pulleys: &[usize]) -> FrictionEquations {
        let on = self.cable_properties();
        let count: usize = self.pulley_states.iter().map(|r| r.unknowns().len()).sum();
        let mut e = FrictionEquations {
            residual: DVector::zeros(count),
            own: DMatrix::zeros(count, count),
            by_force: Vec::with_capacity(4 * count),
        };
        let unit = 1.0 / (MATERIAL_ERROR_FRACTION * self.layout.length);
        let mut pulley_states = std::mem::take(&mut self.pulley_states);
        let mut row = 0;
        for (&k, r) in pulleys.iter().zip(&mut pulley_states) {
            let [before, after] = self.forces[k];
            let ends = self.ends_at(k, r);
            let unit_vectors = [before / before.norm(), after / after.norm()];
            match &mut r.friction {
                FrictionState::Wheel(w) => {
                    // Rows and unknowns are in the order of `Unknown`.
                    for side in 0..2 {
                        let ([t, n], u) = (w.directions(r.angles[side]), unit_vectors[side]);
                        let (i, off) = (row + 2 * side, cross(t, u));
                        e.residual[i] = off;
                        e.own[(i, i)] = -cross(n, u);
                        let slope = (perp(t) - u * off) / ends.tension[side];
                        e.by_force.push(ResidualSlope { row: i, station: k, side, slope });
                    }
                    let rows = w.rows(&on, &ends);
                    for j in 0..2 {
                        let i = row + 2 * j + 1;
                        let scale =
                            if rows.of_tension[j] { 1.0 / larger(ends.tension[0], ends.tension[1]) } else { unit };
                        e.residual[i] = rows.residual[j] * scale;
                        for side in 0..2 {
                            e.own[(i, row + 2 * side)] = rows.by[j][3 * side] * scale;
                            e.own[(i, row + 2 * side + 1)] = rows.by[j][3 * side + 1] * scale;
                            let slope = unit_vectors[side] * (rows.by[j][3 * side + 2] * scale);
                            e.by_force.push(ResidualSlope { row: i, station: k, side, slope });
                        }
                    }
                }
                FrictionState::Point { mode: PointFriction::Holds, resting_place, .. } => {
                    e.residual[row] = (r.material[0] - *resting_place) * unit;
                    e.own[(row, row)] = unit;
                }
                FrictionState::Point { mode: PointFriction::Slides(m), .. } => {
                    let turn = turn_between(before, after);
                    e.residual[row] = (ends.tension[1] / ends.tension[0]).ln() - *m * turn.abs();
                    for (side, sign) in [(0, -1.0), (1, 1.0)] {
                        let (u, t) = (unit_vectors[side], ends.tension[side]);
                        let slope = (u - perp(u) * (*m * turn.signum())) * (sign / t);
                        e.by_force.push(ResidualSlope { row, station: k, side, slope });
                    }
                }
            }
            row += r.unknowns().len();
        }
        self.pulley_states = pulley_states;
        e
    }

    /// Changes of the forces beside the stations with an unknown of pulley `k`.
    fn force_slopes(&self, k: usize, r: &PulleyState, unknown: Unknown) -> Vec<ForceSlope> {
        let mut out = Vec::with_capacity(4);
        let both = unknown == Unknown::Both;
        for side in 0..2 {
            let span = self.ends.iter().position(|e| if side == 0 { e.last == k } else { e.first == k });
            let material = both || unknown == Unknown::Material(side);
            let Some(i) = span else {
                if material && (if side == 0 { k > 0 } else { k + 1 < self.layout.stations.len() }) {
                    out.push(ForceSlope { station: k, side, slope: -self.material.body });
                }
                continue;
            };
            let ends = self.ends[i];
            let slopes = if material {
                let end = if side == 0 { SpanEnd::Last } else { SpanEnd::First };
                self.spans[i].force_rates(&self.material, &self.layout, ends, end)
            } else if unknown == Unknown::Angle(side)
                && let (FrictionState::Wheel(w), Some(wheel)) = (&r.friction, self.wheel(k))
            {
                // The end of the span moves along the cable, dx/dp = R t.
                let moved = w.directions(r.angles[side])[0] * wheel.radius * if side == 0 { 1.0 } else { -1.0 };
                let stiffness = self.spans[i].span_response.compliance.try_inverse();
                [stiffness.map_or(Vec2::repeat(f64::NAN), |s| s * moved); 2]
            } else {
                continue;
            };
            out.push(ForceSlope { station: ends.first, side: 1, slope: slopes[0] });
            out.push(ForceSlope { station: ends.last, side: 0, slope: slopes[1] });
        }
        out
    }

    /// The total derivative of the equations, and the derivatives of the forces by each unknown.
    fn tangent(&self, pulleys: &[usize], e: &FrictionEquations) -> (DMatrix<f64>, Vec<Vec<ForceSlope>>) {
        let mut matrix = e.own.clone();
        let mut slopes = Vec::with_capacity(matrix.ncols());
        for (&k, r) in pulleys.iter().zip(&self.pulley_states) {
            for &unknown in r.unknowns() {
                let column = slopes.len();
                let of = self.force_slopes(k, r, unknown);
                for r in &e.by_force {
                    for f in of.iter().filter(|f| f.station == r.station && f.side == r.side) {
                        matrix[(r.row, column)] += r.slope.dot(&f.slope);
                    }
                }
                slopes.push(of);
            }
        }
        (matrix, slopes)
    }

    /// Solves for angles and materials of these pulleys at once.
    fn newton_on_pulleys(&mut self, pulleys: &[usize]) -> Result<(), PulleyFailure> {
        let first = pulleys.first().copied().unwrap_or(0);
        let mut e = self.equations(pulleys);
        for _ in 0..MAX_STEPS {
            let worst = e.residual.amax();
            let tension = self.forces.iter().flatten().fold(0.0, |m, f| larger(m, f.norm()));
            self.residual = larger(self.residual, worst * tension);
            if worst <= RESIDUAL_TOLERANCE {
                return Ok(());
            }
            let failure = PulleyFailure::Unbalanced(first, worst * tension);
            let (matrix, _) = self.tangent(pulleys, &e);
            let step = matrix.lu().solve(&-&e.residual).filter(|s| s.iter().all(|v| v.is_finite()));
            let Some(step) = step else { return Err(failure) };
            let (from, norm) = (self.pulley_states.clone(), e.residual.norm_squared());
            let better = backtrack(self.longest_step(pulleys, &step), MAX_HALVINGS, |part| {
                self.move_unknowns(&from, &step, part);
                self.steps += 1;
                self.apply_unknowns(pulleys).ok()?;
                Some(self.equations(pulleys))
                    .filter(|next| next.residual.norm_squared() <= (1.0 - ARMIJO_FRACTION * part) * norm)
            });
            let Some(next) = better else {
                self.move_unknowns(&from, &step, 0.0);
                self.apply_unknowns(pulleys)?;
                return if worst <= RESIDUAL_LIMIT { Ok(()) } else { Err(failure) };
            };
            e = next;
        }
        let worst = e.residual.amax();
        if worst <= RESIDUAL_LIMIT { Ok(()) } else { Err(PulleyFailure::Unbalanced(first, worst)) }
    }

    /// The greatest fraction of a step that keeps the order of the stations and the side of the
    /// wheels.
    fn longest_step(&self, pulleys: &[usize], step: &DVector<f64>) -> f64 {
        let (mut alpha, mut column) = (1.0, 0);
        let stations = &self.layout.stations;
        let mut limit = |by: f64, most: f64| {
            if by > most {
                alpha = if most / by < alpha { most / by } else { alpha };
            }
        };
        for (&k, r) in pulleys.iter().zip(&self.pulley_states) {
            for &unknown in r.unknowns() {
                let by = step[column];
                column += 1;
                let room = |side: usize| match side {
                    0 if k > 0 => STEP_ROOM_FRACTION * (stations[k].arc_length - stations[k - 1].leaves()),
                    1 if k + 1 < stations.len() => {
                        STEP_ROOM_FRACTION * (stations[k + 1].arc_length - stations[k].leaves())
                    }
                    _ => f64::INFINITY,
                };
                match unknown {
                    Unknown::Angle(_) => limit(by.abs(), MOST_TURN),
                    Unknown::Material(side) => limit(if side == 0 { -by } else { by }, room(side)),
                    Unknown::Both => {
                        limit(-by, room(0));
                        limit(by, room(1));
                    }
                }
            }
        }
        alpha
    }

    /// Sets the unknowns to those of `from` plus the fraction `alpha` of a step.
    fn move_unknowns(&mut self, from: &[PulleyState], step: &DVector<f64>, alpha: f64) {
        let mut column = 0;
        for (r, old) in self.pulley_states.iter_mut().zip(from) {
            for &unknown in old.unknowns() {
                let by = alpha * step[column];
                column += 1;
                match unknown {
                    Unknown::Angle(side) => r.angles[side] = old.angles[side] + by,
                    Unknown::Material(side) => r.material[side] = old.material[side] + by,
                    Unknown::Both => r.material = [old.material[0] + by; 2],
                }
            }
        }
    }

    /// Checks for every pulley whether it sticks or slides; true if one changed.
    fn change_modes(&mut self, pulleys: &[usize], changes: ModeChanges) -> bool {
        let on = self.cable_properties();
        let mut changed = false;
        let mut pulley_states = std::mem::take(&mut self.pulley_states);
        for (&k, r) in pulleys.iter().zip(&mut pulley_states) {
            if changed && changes == ModeChanges::First {
                break;
            }
            let ends = self.ends_at(k, r);
            let [before, after] = self.forces[k];
            changed |= match &mut r.friction {
                FrictionState::Wheel(w) => w.change_mode(&on, &ends, MODE_CHANGE_ROUNDINGS),
                FrictionState::Point { friction, mode, resting_place } if *friction > 0.0 => {
                    let ratio = (ends.tension[1] / ends.tension[0]).ln();
                    let over = ratio.abs() - *friction * turn_between(before, after).abs();
                    let slid = r.material[0] - *resting_place;
                    let next = match *mode {
                        PointFriction::Holds if over > CONE_ROUNDING => {
                            PointFriction::Slides(*friction * ratio.signum())
                        }
                        // With m = +μ material moves to the side after the pulley, so less of it
                        // lies before.
                        PointFriction::Slides(m)
                            if m * slid > 0.0 && slid.abs() > STEP_TOLERANCE * self.layout.length =>
                        {
                            PointFriction::Holds
                        }
                        same => same,
                    };
                    let differs = next != *mode;
                    *mode = next;
                    differs
                }
                FrictionState::Point { .. } => false,
            };
        }
        self.pulley_states = pulley_states;
        changed
    }

    /// Adds the response of pulleys with friction to small changes of the forces beside the
    /// stations.
    pub fn let_rubbing_follow(&mut self, changes: &mut [[Vec2; 2]]) {
        let pulleys = self.pulleys();
        let e = self.equations(&pulleys);
        let mut right = DVector::zeros(e.residual.len());
        for r in &e.by_force {
            right[r.row] -= r.slope.dot(&changes[r.station][r.side]);
        }
        let (matrix, slopes) = self.tangent(&pulleys, &e);
        let Some(moves) = matrix.lu().solve(&right) else {
            changes.iter_mut().flatten().for_each(|c| *c = Vec2::repeat(f64::NAN));
            return;
        };
        for (of, by) in slopes.iter().zip(moves.iter()) {
            for f in of {
                changes[f.station][f.side] += f.slope * *by;
            }
        }
    }
}
