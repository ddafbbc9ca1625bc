//! Block-banded factorisation on faer (placeholder).
