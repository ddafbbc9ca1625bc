//! The panels: each is driven by the names of its widgets, and has a picture.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod edits;
mod fixture;
mod pictures;
