//! An elastic catenary is a cable between two points under a uniform load of any direction.
//!
//! | room | content |
//! |---|---|
//! | `span.rs` | [`Catenary`] and [`Span`]: the solved span and its quantities |
//! | `closed_form.rs` | the formulas and the Newton iteration of one piece |
//! | `span_with_loads.rs` | several pieces with dead loads between them |
//!
//! H. M. Irvine, *Cable Structures*, MIT Press, 1981, gives the elastic catenary in terms of the
//! end force; M. Ahmadi-Kashani and A. J. Bell, "The analysis of cables subject to uniformly
//! distributed loads", *Engineering Structures* 10 (1988) 174–184, discuss its solution. Here the
//! end force is the minimum of the convex complementary energy ∫ |F| + |F|²/2EA ds − F·d, so
//! Newton's method with a line search finds it from any start: slack, taut, folded, vertical. See
//! `closed_form.rs` for the formulas.
//!
//! Material is measured by its unstretched length s at rest temperature. Warmth lengthens it by 1 +
//! αΔT and keeps total load and EA, so the span is solved with length (1 + αΔT)L and the same total
//! load.

mod closed_form;
mod span;
mod span_with_loads;
#[cfg(test)]
mod tests;

pub use crate::error::SpanError;
pub use span::{Catenary, Span};
pub use span_with_loads::{Chain, ChainForce, PointForce};
