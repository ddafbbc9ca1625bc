//! This module refines the mesh of a stiff cable until its error estimate suffices.

use crate::model::fem::free::beam::equilibrium::{Beam, BeamOutcome};
use crate::model::fem::free::dual_weighted_residual;

/// A solved stiff cable on its last mesh.
pub(in crate::model::fem) struct RefinedBeam {
    /// The cable.
    pub(in crate::model::fem) beam: Beam,
    /// The outcome of its solve.
    pub(in crate::model::fem) outcome: BeamOutcome,
    /// Newton steps on all meshes.
    pub(in crate::model::fem) steps: usize,
    /// Estimated error of its tensions, relative to the greatest.
    pub(in crate::model::fem) estimate: Option<f64>,
    /// Estimated error of its shape, m.
    pub(in crate::model::fem) shape_error: Option<f64>,
}

/// Solves a cable on a mesh and on one with bars half as long, whose difference gives the error (of
/// fourth order: a fifteenth of it is left), and refines until that is `wanted` or there are
/// `most_bars`. If `wanted` is None, the given mesh is kept.
pub(in crate::model::fem) fn refine(mut coarse: Beam, wanted: Option<f64>, most_bars: usize) -> RefinedBeam {
    let mut outcome = coarse.solve();
    let mut steps = coarse.steps;
    let (mut estimate, mut shape_error) = (None, None);
    while let Some(wanted) = wanted
        && outcome == BeamOutcome::Stable
        && coarse.bars() < most_bars
    {
        let mut fine = coarse.halved();
        outcome = fine.solve();
        steps += fine.steps - coarse.steps;
        let found = dual_weighted_residual::halving_error(&coarse, &fine);
        estimate = Some(found);
        shape_error =
            Some(2.0 / 15.0 * dual_weighted_residual::greatest_distance(&coarse.node_points(), &fine.node_points()));
        coarse = fine;
        if found <= wanted {
            break;
        }
    }
    if wanted.is_none() && outcome == BeamOutcome::Stable {
        // The given mesh is kept; the finer one only gives its error, sixteen fifteenths of the
        // change.
        let mut fine = coarse.halved();
        if fine.solve() == BeamOutcome::Stable {
            estimate = Some(16.0 * dual_weighted_residual::halving_error(&coarse, &fine));
            shape_error =
                Some(2.0 * dual_weighted_residual::greatest_distance(&coarse.node_points(), &fine.node_points()));
        }
    }
    RefinedBeam { beam: coarse, outcome, steps, estimate, shape_error }
}
