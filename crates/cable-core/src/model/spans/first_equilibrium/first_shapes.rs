//! This module lists the first shapes from which an equilibrium is sought, in the order in which
//! they are tried.
//!
//! All first shapes have the same energy, and each reason below can keep Newton's method from its
//! minimum. The shapes of [`FIRST_SHAPES`] are tried in order, the cheapest first, and each drops
//! one assumption of the shapes before it:
//!
//! - **Friction.** The equilibrium with the least sliding lies nearest to the route, so friction
//!   acts from there. A cable whose route is far from every such equilibrium slides to one: it is
//!   sought without friction, where the energy alone decides, and friction holds it from then on. A
//!   cable that is not held at both ends would run away, and keeps its friction.
//! - **Slack.** The spans of a slack cable are not determined by its ends. The cable is shrunk
//!   until a tension of a few weights draws it taut along its route, and paid out again step by
//!   step; with more tension if the first was not enough.
//! - **Tension.** A contact that would be compressed shows that the cable has no tension left there
//!   ([`Failure::Compressed`]): only then may it lie loose on the ground.

use crate::model::spans::settings::ContinuationSettings;

/// A first shape from which an equilibrium is sought.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct FirstShape {
    pub(super) friction: FirstFriction,
    pub(super) length: FirstLength,
    pub(super) slack: SlackCable,
}

/// The friction with which an equilibrium is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum FirstFriction {
    /// All of it.
    FromTheStart,
    /// No friction until the cable rests, then the full friction.
    OnceAtRest,
}

/// The length of cable with which an equilibrium is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum FirstLength {
    /// All of it.
    Whole,
    /// Shrunk to `first_tension_weights`, then let out.
    Taut,
    /// Shrunk to `second_tension_weights`, then let out.
    VeryTaut,
}

/// The places at which a cable may lie without tension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum SlackCable {
    /// The cable has tension everywhere.
    Nowhere,
    /// A section may spread on the ground along its route.
    AlongRoute,
    /// As `AlongRoute`, and cable may lie loose on a frictionless contact where it has no tension
    /// left.
    WhereTensionEnds,
}

/// The whole cable along its route with friction: most cables rest near it.
pub(super) const ALONG_ROUTE: FirstShape =
    FirstShape { friction: FirstFriction::FromTheStart, length: FirstLength::Whole, slack: SlackCable::AlongRoute };

/// The same cable, drawn taut.
pub(super) const TAUT: FirstShape = FirstShape { length: FirstLength::Taut, ..ALONG_ROUTE };

/// The first shapes in the order in which they are tried, each with the reason for it.
pub(super) const FIRST_SHAPES: [FirstShape; 6] = [
    ALONG_ROUTE,
    // Friction holds no equilibrium near the route.
    FirstShape { friction: FirstFriction::OnceAtRest, ..ALONG_ROUTE },
    // Slack keeps Newton's method from the frictionless equilibrium.
    FirstShape { friction: FirstFriction::OnceAtRest, ..TAUT },
    // A contact would be compressed, so the cable there has no tension.
    FirstShape { slack: SlackCable::WhereTensionEnds, ..ALONG_ROUTE },
    // Slack keeps Newton's method from the equilibrium with friction.
    TAUT,
    // A stiff cable stretches so little that a few weights do not draw it taut.
    FirstShape { friction: FirstFriction::OnceAtRest, length: FirstLength::VeryTaut, ..ALONG_ROUTE },
];

/// The first shapes with friction from which the friction that a cable needs is found.
pub(in crate::model::spans) const SHAPES_WITH_FRICTION: [FirstShape; 2] = [ALONG_ROUTE, TAUT];

impl FirstLength {
    /// The tension, in weights of the cable, to which it is shrunk; None if it is not shrunk.
    pub(super) fn tension_weights(self, tuned: &ContinuationSettings) -> Option<f64> {
        match self {
            Self::Whole => None,
            Self::Taut => Some(tuned.first_tension_weights),
            Self::VeryTaut => Some(tuned.second_tension_weights),
        }
    }
}
