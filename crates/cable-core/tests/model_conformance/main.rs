//! Every model passes this suite: laws that hold whatever the method, each with the error reached.
//!
//! | room | laws of |
//! |---|---|
//! | `rest.rs` | a cable that touches nothing: closed form, balance, symmetry, scale |
//! | `pulleys.rs` | cables that slide over pulleys, at rest, drawn slowly and in motion |
//! | `contact.rs` | a cable on a smooth pipe |
//! | `friction.rs` | a cable on a rough pipe, post and floor |
//! | `motion.rs` | momentum, energy and stillness |
//! | `breaks.rs` | when a cable breaks, and what is left of it |
//! | `measure.rs` | the scenes and measures that several of them share |
//!
//! A model that lacks the ability of which a law speaks must refuse its scene as unsupported: a
//! model never guesses.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod breaks;
mod contact;
mod friction;
mod measure;
mod motion;
mod pulleys;
mod rest;

use cable_core::model::Capabilities;
use cable_core::{Error, Model, SolveError};

/// The error with which a model keeps a law.
#[derive(Clone, Debug, PartialEq)]
struct Check {
    /// The law.
    name: &'static str,
    /// Error, relative.
    error: f64,
    /// Allowed error.
    tolerance: f64,
}

impl Check {
    /// Returns whether the law holds; with an error that is no number it does not.
    fn holds(&self) -> bool {
        self.error <= self.tolerance
    }
}

/// The ability that a model needs to be asked about a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ability {
    /// Every model can: it finds equilibria of cables that touch nothing but supports and pulleys.
    Equilibrium,
    /// The model meets obstacles.
    Contact,
    /// Its masses can accelerate.
    Inertia,
}

impl Ability {
    fn is_among(self, capabilities: Capabilities) -> bool {
        match self {
            Self::Equilibrium => true,
            Self::Contact => capabilities.contact,
            Self::Inertia => capabilities.inertia,
        }
    }
}

/// Exactness with which a law holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tolerance {
    /// To the bit.
    Exact,
    /// This many times the accuracy of the model's shape, which its mesh limits.
    Shape(f64),
    /// This many times the accuracy of its equilibrium, by which its iteration stops.
    Equilibrium(f64),
    /// To this relative error where a mesh limits it; a model without a mesh, ten times the
    /// accuracy of its shape.
    Mesh(f64),
    /// To this relative error, whatever the model.
    Relative(f64),
}

/// The accuracy of its shape from which on a model has no mesh.
const MESHLESS_ACCURACY: f64 = 1e-9;

impl Tolerance {
    fn of(self, model: Model) -> f64 {
        let [shape, equilibrium] = model.info().accuracy;
        match self {
            Self::Exact => 0.0,
            Self::Shape(times) => times * shape,
            Self::Equilibrium(times) => times * equilibrium,
            Self::Mesh(_) if shape <= MESHLESS_ACCURACY => 10.0 * shape,
            Self::Mesh(error) | Self::Relative(error) => error,
        }
    }
}

/// A law, and how far an answer of a model is from it.
struct ModelLaw {
    name: &'static str,
    ability: Ability,
    tolerance: Tolerance,
    error: fn(Model) -> Result<f64, Error>,
}

/// Every law, in the order of the rooms.
const LAWS: &[ModelLaw] = &[
    ModelLaw { name: "finite", ability: Ability::Equilibrium, tolerance: Tolerance::Exact, error: rest::not_finite },
    ModelLaw {
        name: "bit-repeatable",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Exact,
        error: rest::not_repeatable,
    },
    ModelLaw {
        name: "rests on the closed form of the elastic catenary",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Shape(1.0),
        error: rest::closure,
    },
    ModelLaw {
        name: "reactions sum to the weight",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(1.0),
        error: rest::weight_not_held,
    },
    ModelLaw {
        name: "reactions have no sum sideways",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(1.0),
        error: rest::sideways_sum,
    },
    ModelLaw {
        name: "a scene moved gives the same tensions",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(10.0),
        error: rest::moved,
    },
    ModelLaw {
        name: "a scene mirrored gives the same tensions",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(10.0),
        error: rest::mirrored,
    },
    ModelLaw {
        name: "a level span is symmetric",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(10.0),
        error: rest::asymmetry,
    },
    ModelLaw {
        name: "forces scale with weight and stiffness",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(10.0),
        error: rest::scaled,
    },
    ModelLaw {
        name: "a dead load at a free end is the tension there",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(10.0),
        error: rest::loaded_end,
    },
    // With something to touch each of a hundred nodes may be out of balance by 1e-6 of all that
    // acts.
    ModelLaw {
        name: "a dead load at a free end is the tension there, with something to touch",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(100.0),
        error: rest::loaded_end_near_floor,
    },
    ModelLaw {
        name: "a smooth pulley passes tension on",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Shape(1.0),
        error: pulleys::passed_on,
    },
    ModelLaw {
        name: "reactions with a pulley sum to the weight",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Equilibrium(10.0),
        error: pulleys::weight_not_held,
    },
    ModelLaw {
        name: "drawn slowly over a rough pulley tension grows by e^{μφ}",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Mesh(1e-3),
        error: pulleys::drawn,
    },
    ModelLaw {
        name: "let back over a rough pulley tension falls by e^{μφ}",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Mesh(1e-3),
        error: pulleys::let_back,
    },
    ModelLaw {
        name: "drawn in motion over a rough pulley tension grows by e^{μφ}",
        ability: Ability::Inertia,
        tolerance: Tolerance::Mesh(1e-2),
        error: pulleys::drawn_in_motion,
    },
    ModelLaw {
        name: "nothing lies inside a pipe",
        ability: Ability::Contact,
        tolerance: Tolerance::Shape(1.0),
        error: contact::penetration,
    },
    ModelLaw {
        name: "reactions and contact forces sum to the weight",
        ability: Ability::Contact,
        tolerance: Tolerance::Equilibrium(100.0),
        error: contact::weight_not_held,
    },
    // Bars that end on the pipe pull along chords of it: by a hundredth with 40 of them.
    ModelLaw {
        name: "on a smooth pipe T + T²/2EA − wy is the same everywhere",
        ability: Ability::Contact,
        tolerance: Tolerance::Mesh(2e-2),
        error: contact::bernoulli,
    },
    ModelLaw {
        name: "a smooth pipe only pushes",
        ability: Ability::Contact,
        tolerance: Tolerance::Shape(10.0),
        error: contact::not_pushed,
    },
    ModelLaw {
        name: "no contact force leaves the friction cone",
        ability: Ability::Contact,
        tolerance: Tolerance::Mesh(1e-2),
        error: friction::outside_cone,
    },
    ModelLaw {
        name: "drawn slowly round a rough post tension grows by e^{μφ}",
        ability: Ability::Contact,
        tolerance: Tolerance::Mesh(1e-2),
        error: friction::drawn_round_post,
    },
    ModelLaw {
        name: "let back round a rough post tension falls by e^{μφ}",
        ability: Ability::Contact,
        tolerance: Tolerance::Mesh(1e-2),
        error: friction::let_back_round_post,
    },
    ModelLaw {
        name: "drawn slowly over a rough floor tension grows by μw a metre",
        ability: Ability::Contact,
        tolerance: Tolerance::Mesh(1e-2),
        error: friction::drawn_over_floor,
    },
    // `fem` corrects bars for their sag at rest alone: in motion they sag by what they lose.
    ModelLaw {
        name: "a cable at rest stays at rest",
        ability: Ability::Inertia,
        tolerance: Tolerance::Relative(1e-3),
        error: motion::stirred,
    },
    ModelLaw {
        name: "a motion is bit-repeatable",
        ability: Ability::Inertia,
        tolerance: Tolerance::Exact,
        error: motion::not_repeatable,
    },
    ModelLaw {
        name: "a cable let go falls with g",
        ability: Ability::Inertia,
        tolerance: Tolerance::Relative(1e-4),
        error: motion::free_fall,
    },
    ModelLaw {
        name: "momentum changes by the impulses",
        ability: Ability::Inertia,
        tolerance: Tolerance::Relative(1e-4),
        error: motion::momentum_from_nowhere,
    },
    ModelLaw {
        name: "a falling end gains no energy",
        ability: Ability::Inertia,
        tolerance: Tolerance::Relative(1e-3),
        error: motion::energy_from_nowhere,
    },
    ModelLaw {
        name: "drawn slowly a cable breaks when its strain says",
        ability: Ability::Equilibrium,
        tolerance: Tolerance::Mesh(1e-3),
        error: breaks::slow_break_time,
    },
    ModelLaw {
        name: "in motion a cable breaks when its strain says",
        ability: Ability::Inertia,
        tolerance: Tolerance::Relative(1e-3),
        error: breaks::break_time,
    },
    ModelLaw {
        name: "the pieces of a broken cable are as long as it was",
        ability: Ability::Inertia,
        tolerance: Tolerance::Relative(1e-12),
        error: breaks::lost_length,
    },
];

/// Returns whether a law holds, or else whether a model that cannot answer says so.
fn check(law: &ModelLaw, model: Model) -> Result<Check, Error> {
    let found = (law.error)(model);
    if law.ability.is_among(model.capabilities()) {
        return Ok(Check { name: law.name, error: found?, tolerance: law.tolerance.of(model) });
    }
    let refused = matches!(found, Err(Error::Solve(SolveError::Unsupported { .. })));
    Ok(Check { name: law.name, error: f64::from(u8::from(!refused)), tolerance: 0.0 })
}

fn passes(model: Model) {
    let checks: Vec<Check> = LAWS.iter().map(|law| check(law, model).unwrap()).collect();
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
