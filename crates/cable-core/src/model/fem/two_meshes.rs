//! How wrong the forces of a cable in contact are.
//!
//! Where `spans` laid the cable its answer has no error of a mesh, and the bars only came to rest from it: the two differ by what mesh,
//! barrier and grips do, and that is what is said. Where it has no answer (slack, stiff, in plan) the same cable on bars twice as long
//! is asked. Straight bars between contacts are of the second order, where the cable touches down or meets a corner of the first: what
//! is left of an error on the finer of two meshes is a third of what they differ by, or all of it. All of it is said. (L. F. Richardson and
//! J. A. Gaunt, *The deferred approach to the limit*, Phil. Trans. R. Soc. A 226, 1927, without the extrapolation: its order is not
//! known here.)
//!
//! On the way without inertia the coarser cable goes on beside the finer one: what they come to differ by more than at the start is
//! added.

use std::sync::Arc;

use super::dynamics::Dynamics;
use crate::math::{Vec2, larger};
use crate::model::{Inertia, Settings};
use crate::problem::Problem;
use crate::solution::{CableSolution, SupportReaction};

/// Fewer bars than this have no half of use.
const LEAST_BARS: usize = 8;
/// Rounding of both answers, of the greatest tension.
const ROUNDING: f64 = 1e-12;
/// Most bars to which the mesh is refined by itself. More: 1e-3 is met by more scenes, each twice as dear as with half as many.
const MOST_BARS: usize = 800;

/// The coarser cable, and what is said.
#[derive(Clone, Debug, Default)]
pub(super) struct TwoMeshes {
    coarse: Option<Box<Dynamics>>,
    /// What was said at rest, and what the two cables differed by then, N.
    begun: f64,
    apart: Vec<Vec2>,
    /// Error of the force on any support and of the greatest tension, in parts of the greatest tension.
    pub estimate: Option<f64>,
}

impl TwoMeshes {
    /// Looks at a cable that came to rest, beside the answer without a mesh where there is one; makes its mesh finer where it may be
    /// (`refines`) and that comes nearer.
    pub fn compare(
        &mut self,
        problem: &Arc<Problem>,
        (settings, refines): (Settings, bool),
        (fine, exact): (&mut Dynamics, Option<&CableSolution>),
        dragged: &[Option<Vec2>],
    ) {
        *self = Self::default();
        let moves = problem.outline.is_some() || problem.cable.self_contact;
        if !fine.slides || moves {
            return;
        }
        if let Some(exact) = exact {
            let mut found = difference(&fine.solution(), exact);
            while refines && found > settings.tolerance && 2 * fine.even_bars <= MOST_BARS {
                let bars = 2 * fine.even_bars;
                let Some(finer) = laid_over(problem, settings, (fine, bars), (exact, dragged)) else { break };
                let next = difference(&finer.solution(), exact);
                if !(next < found) {
                    break;
                }
                *fine = finer;
                found = next;
            }
            self.estimate = Some(found + ROUNDING);
        }
        if fine.even_bars < LEAST_BARS {
            return;
        }
        let answer = fine.solution();
        let laid = (exact.unwrap_or(&answer), dragged);
        let Some(coarse) = laid_over(problem, settings, (fine, fine.even_bars / 2), laid) else { return };
        let other = coarse.solution();
        self.estimate = self.estimate.or(Some(difference(&other, &answer) + ROUNDING));
        self.apart = forces_apart(&other, &answer);
        self.begun = self.estimate.unwrap_or(f64::NAN);
        self.coarse = Some(Box::new(coarse));
    }

    /// Goes on beside the finer cable without inertia; with inertia nothing is said.
    pub fn follow(&mut self, fine: &Dynamics, dt_s: f64, inertia: Inertia, dragged: &[Option<Vec2>]) {
        self.estimate = None;
        let Some(mut coarse) = self.coarse.take().filter(|_| inertia == Inertia::QuasiStatic) else { return };
        if coarse.advance(dt_s, inertia, dragged).is_ok() {
            let answer = fine.solution();
            let apart = forces_apart(&coarse.solution(), &answer);
            let more = apart.iter().zip(&self.apart).map(|(a, b)| (a - b).norm()).fold(0.0, larger);
            let greatest = greatest(&answer);
            self.estimate = Some(self.begun + if greatest > 0.0 { more / greatest } else { more });
            self.coarse = Some(coarse);
        }
    }
}

/// The same cable on another number of bars, at rest where an answer has it.
fn laid_over(
    problem: &Arc<Problem>,
    settings: Settings,
    (like, bars): (&Dynamics, usize),
    (answer, dragged): (&CableSolution, &[Option<Vec2>]),
) -> Option<Dynamics> {
    let mut other = Dynamics::new(problem.clone(), Settings { segments: Some(bars), ..settings }).ok()?;
    other.slides = like.slides;
    other.take_over(answer, like.time(), dragged).ok()?;
    if !other.rested {
        other.settle(dragged).ok()?;
    }
    Some(other)
}

fn greatest(c: &CableSolution) -> f64 {
    c.nodes.iter().map(|n| n.tension_n).fold(0.0, larger)
}

/// What the forces on each support differ by, N.
fn forces_apart(a: &CableSolution, b: &CableSolution) -> Vec<Vec2> {
    let force = |s: &SupportReaction| Vec2::new(s.reaction_x_n, s.reaction_y_n);
    a.supports.iter().zip(&b.supports).map(|(a, b)| force(a) - force(b)).collect()
}

/// Greatest difference of a force on a support or of the greatest tension from the better answer, in parts of its greatest tension.
fn difference(other: &CableSolution, better: &CableSolution) -> f64 {
    let (first, second) = (greatest(other), greatest(better));
    let off = forces_apart(other, better).iter().map(|d| d.norm()).fold((first - second).abs(), larger);
    if second > 0.0 { off / second } else { off }
}
