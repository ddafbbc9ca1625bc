//! Energies: value, gradient, Hessian (placeholder).
