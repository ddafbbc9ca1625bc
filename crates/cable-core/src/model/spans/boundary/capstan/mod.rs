//! These modules integrate the tension of a cable that slides along a boundary, and the material
//! that lies there.
//!
//! | room | content |
//! |---|---|
//! | `cable_law.rs` | tension and stretch; load at a point; rates of tension there |
//! | `arc.rs` | closed forms of tension and material along a stretch of an arc |
//! | `piece_slide.rs` | sliding along one piece: an edge, a sharp corner or an arc |
//! | `segment_cursor.rs` | one boundary piece seen from a point; where two tensions become equal |
//! | `contact_path.rs` | sliding and laying down along a chain of pieces, with a loose end |
//!
//! Let b be the load per unstretched metre, t the direction of travel, n the outward normal, λ =
//! τ(1 + T/EA) the stretch, τ = 1 + αΔT, and c the radius (∞ on an edge). A piece of cable with the
//! normal force N n and the friction −mN t (both per unstretched metre; m = +μ if it slides along
//! t, −μ if it slides back, 0 without friction) is in equilibrium if
//!
//! ```text
//! N = Tλ/c − b·n,      dT/ds = −b·t + mN,      ds/dp = (dℓ/dp)/λ
//! ```
//!
//! Edge (ℓ = p): with Θ = T + T²/2EA, λ dT = τ dΘ, so τ dΘ/dp = −b·t − m b·n: Θ is exactly linear.
//! The material is ΔT/(τ dΘ/dp), which is Δp/(τ(1 + T̄/EA)) with T̄ the mean of the two end
//! tensions: no digits cancel on a level edge.
//!
//! Arc (ℓ = cψ, p = ψ): dT/dψ = mT − (c/λ)(b·t + m b·n), and dt/dψ = −n, dn/dψ = t. With λ = λ₀
//! frozen it is solved by
//!
//! ```text
//! T⁰ = α b·t + β b·n + C e^{mψ},   α = 2gm/(1+m²),   β = g(m²−1)/(1+m²),   g = c/λ₀
//! ```
//!
//! and the exact T differs by −c ∫ e^{m(ψ−ξ)} (b·t + m b·n)(1/λ(T⁰) − 1/λ₀) dξ, which is small (of
//! order cb·ΔT/EA); the remaining error is of the order of its square over T. The material is c ∫
//! dψ/λ. Both are in `arc`.

mod arc;
mod cable_law;
mod contact_path;
mod piece_slide;
mod segment_cursor;

pub(in crate::model::spans) use cable_law::{CableLaw, SlideResult};
pub(in crate::model::spans) use contact_path::ContactPath;
pub(in crate::model::spans) use piece_slide::slide_on_piece;
pub(in crate::model::spans) use segment_cursor::{CachedPiece, SegmentCursor, Sliding};

#[cfg(test)]
mod tests;
