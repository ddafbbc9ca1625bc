//! These tests draw the panels: each is driven by the names of its widgets, and has a picture.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod edits;
mod fixture;
mod pictures;
