//! Every model passes the one suite.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::Model;
use cable_core::conformance;

fn passes(model: Model) {
    for check in conformance::run(model).unwrap() {
        println!("{model}: {}: {:.1e} of {:.0e}", check.name, check.error, check.tolerance);
        assert!(check.holds(), "{model}: {check:?}");
    }
}

#[test]
fn catenary() {
    passes(Model::Catenary);
}

#[test]
fn spans() {
    passes(Model::Spans);
}

#[test]
fn fem() {
    passes(Model::Fem);
}

#[test]
fn mass_spring() {
    passes(Model::MassSpring);
}
