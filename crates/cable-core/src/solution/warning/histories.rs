//! Other loading histories would have left other tensions in a cable that rubs.

use serde::{Deserialize, Serialize};

use crate::math::{larger, smaller};
use crate::solution::error_estimates::greatest_tension;
use crate::solution::{CableSolution, Node};

/// Selection of the equilibrium that is shown among many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ShownEquilibrium {
    /// The one laid evenly along its route with the least sliding.
    EvenlyLaid,
    /// The one laid along its route with the least sliding.
    LeastSliding,
    /// The frictionless shape, held by friction.
    Frictionless,
    /// The one found from the route.
    FromRoute,
    /// The one found from the route; the histories are those of a flexible cable in its place.
    FromRouteAsFlexible,
}

/// The tensions that other loading histories would have left in a cable, N; ranges from the least
/// to the greatest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Histories {
    /// None was sought.
    NotSought,
    /// None was found.
    NotFound {
        /// Greatest tension as laid, N.
        greatest_n: f64,
    },
    /// Friction fully mobilised towards either end.
    Mobilised {
        /// Greatest tension as laid, N.
        greatest_n: f64,
        /// The same with friction mobilised towards the start, N; None = no equilibrium was found.
        towards_start_n: Option<f64>,
        /// The same towards the end, N.
        towards_end_n: Option<f64>,
        /// The same laid down loose, N; None = there is no cable to spare.
        #[serde(default)]
        loose_n: Option<f64>,
        /// The same of the shape without friction, held by friction, N; None = it was not sought,
        /// as drawing the cable leads further, or it is the one that is shown.
        #[serde(default)]
        frictionless_n: Option<f64>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
    },
    /// Each end drawn out or let in, and put back.
    EndsMoved {
        /// Greatest tension as laid, N.
        greatest_n: f64,
        /// The movements and what they left.
        moves: Vec<EndMove>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
        /// Range of the greatest tension, N.
        range_n: [f64; 2],
    },
    /// The slack of a cable that slides over pulleys without friction began in another span.
    SlackElsewhere {
        /// Greatest tension as laid, N.
        greatest_n: f64,
        /// The same of each of the others, N.
        others_n: Vec<f64>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
    },
    /// A stiff cable that is compressed was bowed to another side.
    BowedElsewhere {
        /// Greatest tension as laid, N; less than zero = all of it is compressed.
        greatest_n: f64,
        /// The same of each of the others, N.
        others_n: Vec<f64>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
    },
}

impl Histories {
    /// Other balances of a slack cable beside the one that is shown: the tensions of each at its
    /// start, at its end and at most, N. None where there is no other.
    #[must_use]
    pub(crate) fn slack_elsewhere(shown: [f64; 3], others: &[[f64; 3]]) -> Option<Self> {
        let [start_n, end_n] = ranges_at_ends(shown, others)?;
        let (greatest_n, others_n) = (shown[2], others.iter().map(|t| t[2]).collect());
        Some(Self::SlackElsewhere { greatest_n, others_n, start_n, end_n })
    }

    /// The same of a stiff cable that is compressed.
    #[must_use]
    pub(crate) fn bowed_elsewhere(shown: [f64; 3], others: &[[f64; 3]]) -> Option<Self> {
        let [start_n, end_n] = ranges_at_ends(shown, others)?;
        let (greatest_n, others_n) = (shown[2], others.iter().map(|t| t[2]).collect());
        Some(Self::BowedElsewhere { greatest_n, others_n, start_n, end_n })
    }

    /// The same of an answer that may be another equilibrium than the one they were sought from:
    /// it is the one as laid, and the ranges hold it.
    #[must_use]
    pub(crate) fn beside(mut self, answer: &CableSolution) -> Self {
        let tension = |node: Option<&Node>| node.map_or(0.0, |n| n.tension_n);
        let ends = [tension(answer.nodes.first()), tension(answer.nodes.last())];
        let most = greatest_tension(&answer.nodes);
        let widen = |range: &mut [f64; 2], n: f64| *range = [smaller(range[0], n), larger(range[1], n)];
        match &mut self {
            Self::NotSought => {}
            Self::NotFound { greatest_n } => *greatest_n = most,
            Self::Mobilised { greatest_n, start_n, end_n, .. }
            | Self::SlackElsewhere { greatest_n, start_n, end_n, .. }
            | Self::BowedElsewhere { greatest_n, start_n, end_n, .. } => {
                *greatest_n = most;
                widen(start_n, ends[0]);
                widen(end_n, ends[1]);
            }
            Self::EndsMoved { greatest_n, start_n, end_n, range_n, .. } => {
                *greatest_n = most;
                widen(start_n, ends[0]);
                widen(end_n, ends[1]);
                widen(range_n, most);
            }
        }
        self
    }
}

/// The ranges of the tension at the start and at the end among the equilibrium that is shown and
/// the others, N; None where there is no other.
fn ranges_at_ends(shown: [f64; 3], others: &[[f64; 3]]) -> Option<[[f64; 2]; 2]> {
    let range = |k: usize| others.iter().fold([shown[k]; 2], |[a, b], t| [smaller(a, t[k]), larger(b, t[k])]);
    (!others.is_empty()).then(|| [range(0), range(1)])
}

/// An end that was moved and put back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EndMove {
    /// The support's name.
    pub support: String,
    /// Length by which it was drawn out, m; negative = let in.
    pub drawn_out_m: f64,
    /// Greatest tension that it left, N.
    pub greatest_n: f64,
}
