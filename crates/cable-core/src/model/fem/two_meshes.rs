//! How wrong the forces of a cable in contact are: the same cable on a mesh of twice as long bars.
//!
//! Straight bars between contacts are of the second order, where the cable touches down, meets a corner or has bars of one round of
//! the first: what is left of an error on the finer of two meshes is a third of what they differ by, or all of it. All of it is said.
//! (L. F. Richardson and J. A. Gaunt, *The deferred approach to the limit*, Phil. Trans. R. Soc. A 226, 1927, without the
//! extrapolation: its order is not known here.) The coarser cable takes over the finer one's answer with what friction holds there and goes
//! on beside it, so that friction is compared along a way, not laid twice.

use std::sync::Arc;

use super::dynamics::Dynamics;
use crate::math::{Vec2, larger};
use crate::model::{Inertia, Settings};
use crate::problem::Problem;
use crate::solution::CableSolution;

/// Fewer bars than this have no half of use.
const LEAST_BARS: usize = 8;
/// Most bars to which the mesh is refined by itself. More: 1e-3 is met by more scenes, each twice as dear as with half as many.
const MOST_BARS: usize = 800;

/// The coarser cable, and what it says.
#[derive(Clone, Debug, Default)]
pub(super) struct TwoMeshes {
    coarse: Option<Box<Dynamics>>,
    /// Error of the force on any support and of the greatest tension, in parts of the greatest tension.
    pub estimate: Option<f64>,
}

impl TwoMeshes {
    /// Compares a cable that rests; makes it finer where it may be (`refines`) and the tolerance asks for it.
    pub fn compare(
        &mut self,
        problem: &Arc<Problem>,
        (settings, refines): (Settings, bool),
        fine: &mut Dynamics,
        dragged: &[Option<Vec2>],
    ) {
        *self = Self::default();
        let bars = fine.even_bars;
        let moves = problem.outline.is_some() || problem.cable.self_contact;
        if !fine.slides || moves || bars < LEAST_BARS {
            return;
        }
        let mut answer = fine.solution();
        let Some(coarse) = laid_over(problem, settings, (fine, bars / 2), (&answer, dragged)) else { return };
        self.estimate = Some(difference(&coarse.solution(), &answer));
        self.coarse = Some(Box::new(coarse));
        while refines && self.estimate.is_some_and(|e| e > settings.tolerance) && 2 * fine.even_bars <= MOST_BARS {
            let Some(finer) = laid_over(problem, settings, (fine, 2 * fine.even_bars), (&answer, dragged)) else {
                return;
            };
            let next = finer.solution();
            self.estimate = Some(difference(&answer, &next));
            self.coarse = Some(Box::new(std::mem::replace(fine, finer)));
            answer = next;
        }
    }

    /// Goes on beside the finer cable without inertia; with inertia nothing is said.
    pub fn follow(&mut self, fine: &Dynamics, dt_s: f64, inertia: Inertia, dragged: &[Option<Vec2>]) {
        self.estimate = None;
        let Some(mut coarse) = self.coarse.take().filter(|_| inertia == Inertia::QuasiStatic) else { return };
        if coarse.advance(dt_s, inertia, dragged).is_ok() {
            self.estimate = Some(difference(&coarse.solution(), &fine.solution()));
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

/// Greatest difference of a force on a support or of the greatest tension, in parts of the greatest tension.
fn difference(a: &CableSolution, b: &CableSolution) -> f64 {
    let greatest = |c: &CableSolution| c.nodes.iter().map(|n| n.tension_n).fold(0.0, larger);
    let (first, second) = (greatest(a), greatest(b));
    let apart = a
        .supports
        .iter()
        .zip(&b.supports)
        .map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
    let off = apart.fold((first - second).abs(), larger);
    if second > 0.0 { off / second } else { off }
}
