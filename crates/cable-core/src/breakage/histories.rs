//! This file estimates how far other loading histories would have changed a cable that the floor of
//! a plan view holds.
//!
//! Friction keeps what was drawn into it. So each end of the cable is drawn out by a little and put
//! back, then let in and put back, without inertia, each time from the rest that was found. The
//! range of the results is a lower bound: other histories may leave more.

use crate::math::{Vec2, larger, smaller};
use crate::model::Inertia;
use crate::solution::{CableSolution, EndMove, Histories};

use super::BreakableCable;

/// Way of an end, of the cable's length. Less: what is held in the middle of a long cable is never
/// reached; more: a cable that is nearly taut is torn rather than drawn, and it takes longer.
const END_TRAVEL_FRACTION: f64 = 0.01;

/// Time in which an end moves, s: none that counts for what else moves.
const MOVE_TIME_S: f64 = 1e-6;

impl BreakableCable {
    /// Other histories, and what they would have left in the cable; `sound` judges each as if it
    /// were the answer. None where none was found.
    pub(crate) fn histories(&self, sound: impl Fn(&CableSolution) -> bool) -> Option<Histories> {
        let laid = self.answer();
        let way = END_TRAVEL_FRACTION * self.problem().length;
        let (mut moves, mut left) = (Vec::new(), Vec::new());
        let last = self.problem().supports.len().checked_sub(1)?;
        for k in [0, last] {
            let (support, reaction) = (self.problem().supports.get(k)?, laid.supports.get(k)?);
            let pull = Vec2::new(reaction.reaction_x_n, reaction.reaction_y_n);
            let at = Vec2::new(reaction.x_m, reaction.y_m);
            let Some(out) = pull.try_normalize(0.0).filter(|_| support.at.is_some()) else { continue };
            for (sign, drawn_out_m) in [(-1.0, way), (1.0, -way)] {
                let Some(there) = self.after(k, [at + out * (sign * way), at]).filter(|a| sound(a)) else { continue };
                let tensions = tensions(&there);
                moves.push(EndMove { support: support.name.clone(), drawn_out_m, greatest_n: tensions[2] });
                left.push(tensions);
            }
        }
        let laid = tensions(&laid);
        let range =
            |k: usize| left.iter().fold([laid[k], laid[k]], |[a, b], t: &[f64; 3]| [smaller(a, t[k]), larger(b, t[k])]);
        let (start_n, end_n, range_n) = (range(0), range(1), range(2));
        (!moves.is_empty()).then_some(Histories::EndsMoved { greatest_n: laid[2], moves, start_n, end_n, range_n })
    }

    /// The answer after a support has been to some places (m), one after the other.
    fn after(&self, support: usize, places: [Vec2; 2]) -> Option<CableSolution> {
        let mut other = self.clone();
        for place in places {
            other.drag_support(support, place);
            other.advance(MOVE_TIME_S, Inertia::QuasiStatic).ok()?;
        }
        other.breaks().is_empty().then(|| other.answer())
    }
}

fn tensions(answer: &CableSolution) -> [f64; 3] {
    let at = |n: Option<&crate::solution::Node>| n.map_or(f64::NAN, |n| n.tension_n);
    let most = answer.nodes.iter().map(|n| n.tension_n).fold(0.0, larger);
    [at(answer.nodes.first()), at(answer.nodes.last()), most]
}
