//! Every model passes the one suite.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::Model;
use cable_core::conformance;

fn passes(model: Model) {
    let checks = conformance::run(model).unwrap();
    for check in &checks {
        println!("{model}: {}: {:.1e} of {:.0e}", check.name, check.error, check.tolerance);
    }
    let broken: Vec<_> = checks.iter().filter(|c| !c.holds()).collect();
    assert!(broken.is_empty(), "{model}: {broken:#?}");
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
