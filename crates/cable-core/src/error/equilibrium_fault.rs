//! This file lists the faults for which a model refuses its own equilibrium.

/// A law of equilibrium that the answer of `spans` breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EquilibriumFault {
    /// The material of contacts and spans does not follow in order.
    MaterialOrder,
    /// Material is missing at an end of a contact.
    MaterialAtContactEnd,
    /// Material is missing along a contact.
    MaterialAlongContact,
    /// Supports and contacts do not hold the weight and the loads.
    Unbalanced,
    /// A free span does not end where the next contact begins.
    SpanOpen,
    /// A free span leaves a contact at an angle.
    SpanNotTangent,
    /// A contact extends beyond the boundary that it lies on.
    ContactBeyondBoundary,
    /// A contact pulls.
    ContactPulls,
    /// The change of tension exceeds friction.
    FrictionBeyondCone,
    /// A slack stretch has tension.
    SlackUnderTension,
    /// A stretch without tension slides.
    LooseCableSlides,
    /// The tension at an end is not that of its support.
    EndTension,
    /// A load would have to be held down.
    LoadHeldDown,
    /// A load is not in its kink.
    LoadOutOfKink,
    /// A load slides against more than its friction.
    LoadSlides,
    /// A load is not where the cable beside it ends.
    LoadElsewhere,
    /// The cable is inside an obstacle.
    InsideObstacle,
}
