//! The suite every model must pass (placeholder).
