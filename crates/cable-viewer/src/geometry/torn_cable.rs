//! These functions find the pieces of a cable that broke.

use cable_core::math::Point;

use crate::geometry::bounds::Bounds;
use crate::state::AppState;

/// A cable that broke: its longest piece, and if it falls.
#[derive(Clone, Copy, Debug)]
pub struct TornCable {
    /// Least and greatest corner of its longest piece, m.
    pub piece: [Point; 2],
    /// No support holds any of it.
    pub falls: bool,
}

/// The first cable that is broken in the answer on screen.
#[must_use]
pub fn torn(state: &AppState) -> Option<TornCable> {
    let solution = state.live.snapshot.solution.as_ref()?;
    let cable = solution.cables.iter().find(|c| !c.breaks.is_empty())?;
    let mut bounds = Bounds::EMPTY;
    for n in cable.pieces().max_by_key(|p| p.len())? {
        bounds.add([n.x_m, n.y_m]);
    }
    let falls = cable.supports.iter().all(|s| s.reaction_x_n == 0.0 && s.reaction_y_n == 0.0);
    (bounds.low[0] <= bounds.high[0]).then_some(TornCable { piece: [bounds.low, bounds.high], falls })
}
