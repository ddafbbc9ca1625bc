//! Anchored Coulomb friction (placeholder).
