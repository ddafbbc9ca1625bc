//! This module chooses the number of bars of a cable: the one that the scene or the settings give,
//! else one that suits its length and surroundings.

use crate::model::Settings;
use crate::model::fem::settings::StartTuning;
use crate::problem::Problem;

/// Number of bars of a cable. If neither the scene nor the settings give one, bars are shorter for
/// a cable that can touch an obstacle.
pub(in crate::model::fem) fn bar_count(problem: &Problem, settings: Settings, tuning: &StartTuning) -> usize {
    let bar = if problem.world.is_empty() { tuning.free_bar_m } else { tuning.bar_m };
    let automatic = (problem.length / bar).ceil().max(tuning.min_bars).min(tuning.max_bars) as usize;
    settings.segments.or(problem.cable.segments).unwrap_or(automatic).max(2)
}
