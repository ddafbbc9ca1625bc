//! These tests compare motion with closed forms: every reference is a ladder in the number of bars
//! or in the time step, with the error at each rung, the observed order, and an identity that does
//! not use the reference.
//!
//! The error in time is known from theory: a step h of BDF2 with a part β of BDF3 turns λ into
//! λ(1 + (1 − β)(λh)²/3 − (1 − 2β)(λh)³/4 + …), so it swings (1 − β)(ωh)²/3 too slowly and damps by
//! (1 − 2β) ω⁴h³/4 (see [`measure::slows`], [`measure::damps`]). Inverted, this gives the frequency
//! and decay that bars would have without steps (see [`measure::behind`]).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod atwood;
mod axial_wave;
mod bending_wave;
mod capstan;
mod dropped_mass;
mod falling_chain;
mod folded_chain;
mod forces_in_time;
mod hanging_chain;
mod hanging_weight;
mod irvine;
mod linked_rods;
mod lumped_mass;
mod mass_spring;
mod measure;
mod pendulum;
mod release;
mod rest_stretch;
mod swing_energy;
mod taut_string;
