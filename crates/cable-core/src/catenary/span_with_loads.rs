//! A chain is a cable between two points with dead loads: a row of catenaries that is still one
//! convex problem.
//!
//! Between loads the force is that of a catenary, at a load it jumps by it: F(s) = F_a − b s − Σ
//! P_k [s > s_k]. The complementary energy of the whole is a function of F_a alone, two unknowns
//! however many loads there are.

use super::closed_form::{self, ChainPiece, DualEnergy, HorizontalForce};
use super::span::{Catenary, LoadAxes, Span};
use crate::error::SpanError;
use crate::math::{Mat2, Vec2};

/// A dead load at a material point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointForce {
    /// Unstretched arc length from the start of the cable, m.
    pub arc_length: f64,
    /// Force, N.
    pub force: Vec2,
}

/// A stretch of cable from material point `from` to `to` with the loads between them.
#[derive(Clone, Copy, Debug)]
pub struct Chain<'a> {
    /// Material point of its start, m.
    pub from: f64,
    /// Material point of its end, m.
    pub to: f64,
    /// Load per metre of unstretched length, N/m.
    pub weight: Vec2,
    /// EA, N.
    pub axial_stiffness: f64,
    /// 1 + αΔT.
    pub thermal_stretch: f64,
    /// Loads of the whole cable in order of arc length; those inside (from, to) act here.
    pub loads: &'a [PointForce],
}

/// A solved chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainForce {
    /// Force at its start, N.
    pub start: Vec2,
    /// Force at its end, N.
    pub end: Vec2,
    /// d(displacement)/d(force), m/N; its inverse is the chain's stiffness.
    pub compliance: Mat2,
    /// ∫ T + T²/2EA ds, N·m.
    pub complementary: f64,
    /// Newton iterations taken.
    pub iterations: usize,
}

impl<'a> Chain<'a> {
    /// Catenaries between the loads, each with the load that follows it; a length is zero only
    /// between two loads at one point.
    fn pieces(&self) -> impl Iterator<Item = (f64, f64, Vec2)> + 'a {
        let (from, to) = (self.from, self.to);
        let inside = self.loads.iter().copied().filter(move |l| l.arc_length > from && l.arc_length < to);
        let ends = inside.chain(std::iter::once(PointForce { arc_length: to, force: Vec2::zeros() }));
        ends.scan(from, |start, l| {
            let piece = (*start, l.arc_length, l.force);
            *start = l.arc_length;
            Some(piece)
        })
    }

    fn piece(&self, length: f64) -> ChainPiece {
        ChainPiece {
            w: self.weight.norm() / self.thermal_stretch,
            l: self.thermal_stretch * length,
            eps: 1.0 / self.axial_stiffness,
        }
    }

    /// Total load on it, N.
    #[must_use]
    pub(crate) fn total_load(&self) -> Vec2 {
        self.pieces().fold(self.weight * (self.to - self.from), |sum, (_, _, p)| sum + p)
    }

    /// The catenaries of this chain for a start force (N): material point of the start, position
    /// there (m), and the span.
    pub fn spans(&self, start_force: Vec2, start: Vec2) -> impl Iterator<Item = (f64, Vec2, Catenary)> + '_ {
        self.pieces().scan((start_force, start), move |(force, at), (a, b, load)| {
            let span = Span {
                chord: Vec2::zeros(),
                length: b - a,
                weight: self.weight,
                axial_stiffness: self.axial_stiffness,
                thermal_stretch: self.thermal_stretch,
            };
            let c = Catenary::from_start_force(&span, *force);
            let item = (a, *at, c);
            *at += c.span().chord;
            *force = c.end_force() - load;
            Some(item)
        })
    }

    /// ∫ T + T²/2EA ds for a start force (N), N·m.
    #[must_use]
    pub fn complementary(&self, start_force: Vec2) -> f64 {
        let frame = LoadAxes::new(self.weight, start_force);
        let (h, v) = frame.split(start_force);
        self.energy(frame, h, v).phi
    }

    /// The displacement from its start to its end for a start force (N), m, and its derivative by
    /// the force, m/N.
    #[must_use]
    pub fn reach(&self, start_force: Vec2) -> (Vec2, Mat2) {
        let frame = LoadAxes::new(self.weight, start_force);
        let (h, v) = frame.split(start_force);
        let e = self.energy(frame, h, v);
        let turn = Mat2::from_columns(&[frame.across, frame.up]);
        (frame.join(e.x, e.z), turn * Mat2::new(e.k11, e.k12, e.k12, e.k22) * turn.transpose())
    }

    /// The dual energy of all pieces, with its slopes and curvatures, for the force at the start.
    fn energy(&self, frame: LoadAxes, h: f64, v: f64) -> DualEnergy {
        let mut sum = DualEnergy::default();
        let (mut h, mut v) = (h, v);
        let w = self.weight.norm();
        for (a, b, load) in self.pieces() {
            let e = self.piece(b - a).energy(h, v);
            sum.phi += e.phi;
            sum.x += e.x;
            sum.z += e.z;
            sum.k11 += e.k11;
            sum.k12 += e.k12;
            sum.k22 += e.k22;
            let (px, pz) = frame.split(load);
            v += w * (b - a) - pz;
            h -= px;
        }
        sum
    }

    /// The force at its start that brings its end to `chord` (m) from its start. `near` is a start
    /// for Newton, N.
    ///
    /// # Errors
    /// See [`SpanError`].
    pub fn solve(&self, chord: Vec2, near: Option<Vec2>) -> Result<ChainForce, SpanError> {
        let length = (self.to - self.from) * self.thermal_stretch;
        if !(length > 0.0 && chord.iter().all(|c| c.is_finite()) && self.axial_stiffness > 0.0) {
            return Err(SpanError::NotANumber);
        }
        let frame = LoadAxes::new(self.weight, chord);
        let start = match near {
            Some(f) => f,
            None => self.guess(chord, length)?,
        };
        let (x, z) = frame.split(chord);
        let lengths = length + x.abs() + z.abs();
        let (h, v) = frame.split(start);
        let energy = |h, v| self.energy(frame, h, v);
        let m = closed_form::minimise(energy, [x, z], [h, v], lengths, HorizontalForce::Any);
        if !m.converged {
            return Err(SpanError::NotConverged { iterations: m.iterations, closure_m: m.closure });
        }
        let e = self.energy(frame, m.h, m.v);
        let start = frame.join(m.h, m.v);
        let turn = Mat2::from_columns(&[frame.across, frame.up]);
        Ok(ChainForce {
            start,
            end: start - self.total_load(),
            compliance: turn * Mat2::new(e.k11, e.k12, e.k12, e.k22) * turn.transpose(),
            complementary: e.phi,
            iterations: m.iterations,
        })
    }

    /// The start force if the whole load were spread evenly.
    fn guess(&self, chord: Vec2, length: f64) -> Result<Vec2, SpanError> {
        let load = self.total_load();
        let total = load.norm();
        if total == 0.0 {
            let c = chord.norm();
            if c <= length {
                return Err(SpanError::Slack { length_m: length, chord_m: c });
            }
            return Ok(chord / c * (self.axial_stiffness * (c / length - 1.0)));
        }
        let frame = LoadAxes::new(load, chord).facing(chord);
        let (x, z) = frame.split(chord / length);
        let (h, v) = closed_form::guess([x, z], total / self.axial_stiffness);
        Ok(frame.join(h * total, v * total))
    }
}
