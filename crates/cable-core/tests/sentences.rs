//! Warnings, errors and verdicts are sentences, in SI and in US units.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::answer_verifier::{Balance, Finding, Law, NotChecked, Verification};
use cable_core::error::{
    DocumentFault, EquilibriumFault, FailureCause, Near, NearKind, NoEquilibrium, Place, SceneError, SceneFault,
    SolveError, SpanError, TensionLoss, TextPosition, Unsupported,
};
use cable_core::files::{RunFolderFault, RunRemark};
use cable_core::math::Vec2;
use cable_core::record::{LeftOut, ReadError, RowFault, RunStop, WriteError, WrittenNumber};
use cable_core::scene::import::{ImportChange, ImportFault};
use cable_core::solution::{
    AssumedStiffness, EndMove, Histories, LikelyBending, MeanTension, ModelReason, NeglectedEffect, NextCheaper,
    ShownEquilibrium, SlideReason, Warning, WarningCause, WarningKind,
};
use cable_core::units::{Quantity, UnitSystem};
use cable_core::wording::Sentence;
use cable_core::{FileError, Model};

/// A warning of every cause.
fn warnings() -> Vec<Warning> {
    use WarningCause as Cause;
    let name = |name: &str| name.to_owned();
    let many = |shown, histories| Cause::ManyEquilibria { shown, histories };
    let moves = [0.1, -0.1].map(|drawn_out_m| EndMove { support: name("left"), drawn_out_m, greatest_n: 81.0 });
    let range = [78.0, 90.5];
    let causes = [
        (Cause::AboveService { time_s: None }, [912.0, 800.0]),
        (Cause::AboveService { time_s: Some(1.5) }, [912.0, 800.0]),
        (Cause::BrieflyAboveBreaking { time_s: 1.5, breaking_n: 900.0, held_n: 700.0, over_s: 0.004 }, [912.0, 800.0]),
        (Cause::AboveBreaking { mean: None }, [1912.0, 1800.0]),
        (Cause::AboveBreaking { mean: Some(MeanTension { over_s: 0.004, time_s: 2.0 }) }, [1912.0, 1800.0]),
        (Cause::AboveBreakingAfterBreak { mean: MeanTension { over_s: 0.004, time_s: 2.0 } }, [1912.0, 1800.0]),
        (Cause::Broke { time_s: 2.0, over_s: 0.004, detached_from: None }, [1800.0; 2]),
        (Cause::Broke { time_s: 2.0, over_s: 0.0, detached_from: Some(name("hook")) }, [1800.0; 2]),
        (Cause::BreakageUncertain { broke: false, held_n: 1700.0, lowest_n: 1600.0, over_s: 0.004 }, [1900.0, 1800.0]),
        (Cause::NarrowGuide, [0.02, 0.14]),
        (Cause::FreeKink, [0.02, 0.14]),
        (Cause::Pressure, [5833.0, 4380.0]),
        (Cause::Folds { material_m: 3.0, ground_m: 1.5, on_ground: true }, [1.5, 0.1]),
        (Cause::LowTension { below_n: 0.5 }, [2.5, 0.5]),
        (Cause::Crossing { other_arc_length_m: 5.0, count: 3 }, [3.8, 0.1]),
        (Cause::TightTurn { within_m: 0.5 }, [270.0; 2]),
        (Cause::RoundObstacle { obstacle: name("post") }, [1.25, 1.0]),
        (Cause::Caught { obstacle: name("beam 3 m"), first_ratio: 1.5 }, [3.0, 2.0]),
        (Cause::Weightless, [0.0; 2]),
        (Cause::Unstable, [0.0; 2]),
        (Cause::Loose { material_m: 3.0, ground_m: 1.5, held_n: 12.5 }, [0.0; 2]),
        (many(ShownEquilibrium::EvenlyLaid, Histories::NotSought), [0.0; 2]),
        (many(ShownEquilibrium::Frictionless, Histories::NotFound { greatest_n: 80.0 }), [0.0; 2]),
        (
            many(
                ShownEquilibrium::LeastSliding,
                Histories::Mobilised {
                    greatest_n: 80.0,
                    towards_start_n: Some(90.5),
                    towards_end_n: None,
                    loose_n: Some(12.0),
                    frictionless_n: Some(70.0),
                    start_n: range,
                    end_n: range,
                },
            ),
            [0.0; 2],
        ),
        (
            many(
                ShownEquilibrium::FromRoute,
                Histories::EndsMoved {
                    greatest_n: 80.0,
                    moves: moves.to_vec(),
                    start_n: range,
                    end_n: range,
                    range_n: range,
                },
            ),
            [0.0; 2],
        ),
        (
            many(
                ShownEquilibrium::FromRoute,
                Histories::SlackElsewhere {
                    greatest_n: 80.0,
                    others_n: vec![90.5, 78.0],
                    start_n: range,
                    end_n: range,
                },
            ),
            [0.0; 2],
        ),
        (
            many(
                ShownEquilibrium::FromRoute,
                Histories::BowedElsewhere {
                    greatest_n: -6.5,
                    others_n: vec![-12.5],
                    start_n: [-12.5, -6.5],
                    end_n: [-0.001, 0.0],
                },
            ),
            [0.0; 2],
        ),
        (many(ShownEquilibrium::FromRouteAsFlexible, Histories::NotFound { greatest_n: 80.0 }), [0.0; 2]),
        (Cause::Blocked { support: name("grip"), obstacle: name("beam"), short_m: [0.2, 0.0] }, [0.2, 0.0]),
        (Cause::ClearOfWheel { pulley: name("grip") }, [0.0; 2]),
        (Cause::Lags { support: name("grip"), behind_m: 0.5 }, [2.0, 2.0]),
        (
            Cause::HandLags {
                support: name("grip"),
                behind_m: Some(0.5),
                hand_behind_m: 0.25,
                pull_n: 120.0,
                stiffness_n_per_m: 240.0,
            },
            [1.0, 2.0],
        ),
        (Cause::RouteBuried { obstacle: name("ground") }, [0.25, 0.0]),
        (Cause::SupportOnSurface { support: name("grip"), obstacle: name("beam") }, [0.014, 0.014]),
        (Cause::RobotWithoutGround, [0.0; 2]),
        (Cause::RobotInObstacle { obstacle: name("box") }, [0.0; 2]),
        (Cause::RobotIgnored { model: Model::Spans }, [0.0; 2]),
        (Cause::SlidFromRoute { why: SlideReason::UnheldForce { left_n: 12.0, loads_n: 120.0 } }, [0.0; 2]),
        (Cause::SlidOn, [0.0; 2]),
        (Cause::SpeedCut, [412.0, 300.0]),
        (Cause::TooFast, [900.0, 300.0]),
        (Cause::EnergyCut, [4.0e3, 1.0e3]),
        (Cause::StiffPreview, [2.0e-3, 1.0e-3]),
        (Cause::EnergyFromNowhere { from_s: 1.0, work_j: 40.0, speed_m_per_s: 12.0 }, [80.0, 2.0]),
        (Cause::CornerOfMesh { obstacle: name("beam"), turn_deg: 90.0, element_m: 0.2 }, [0.12, 1e-3]),
        (Cause::CoarseBend { bars: 40 }, [0.02, 1e-3]),
        (Cause::BarContacts, [0.02, 1e-3]),
        (Cause::CoarseForces { elements: 40 }, [0.02, 1e-3]),
        (Cause::CoarseTension { elements: 40 }, [0.02, 1e-3]),
        (Cause::RobotOutOfBalance { left_n: 1200.0 }, [0.02, 5e-3]),
    ];
    causes.into_iter().map(|(cause, values)| Warning::new(cause, "main", 3.2, values).at([1.0, -2.0])).collect()
}

/// An error of every form with a figure.
fn errors() -> Vec<Box<dyn Sentence>> {
    let at_m = Vec2::new(1.0, -2.0);
    let model = Model::Fem;
    let place = || {
        Box::new(Place {
            arc_length_m: 3.2,
            at_m,
            near: Some(Near { kind: NearKind::Support, name: "a".to_owned(), distance_m: 0.5 }),
        })
    };
    let name = |name: &str| name.to_owned();
    let allowed = |low, high, quantity| SceneFault::Range { value: -3.048, allowed: [low, high], quantity };
    let finding = Finding {
        law: Law::Balance,
        cable: name("main"),
        arc_length_m: 3.2,
        at_m: [1.0, -2.0],
        with: name("post"),
        value: 12.0,
        limit: 0.1,
    };
    let why = |why| SolveError::NoRestingPlace { why };
    let lacks = |feature| SolveError::Unsupported { model, feature };
    let at_line = SceneError {
        path: name("cables[0].length_m"),
        fault: allowed(1e-3, 1e6, Quantity::Length),
        at: Some(TextPosition { line: 3, column: 7 }),
    };
    vec![
        Box::new(at_line),
        Box::new(allowed(1e-6, 1e4, Quantity::MassPerLength)),
        Box::new(allowed(-1e-2, 1e-2, Quantity::PerTemperature)),
        Box::new(allowed(0.0, 10.0, Quantity::Number)),
        Box::new(SceneFault::ServiceAboveBreaking { service_n: 900.0, breaking_n: 800.0 }),
        Box::new(SceneFault::BeyondEnd { arc_length_m: 12.0, length_m: 10.0 }),
        Box::new(SceneFault::OutOfOrder { arc_length_m: 12.0, between_m: [2.0, 10.0] }),
        Box::new(SceneFault::MotionStartsElsewhere { motion_m: [1.0, 2.0], support_m: [1.0, 3.0] }),
        Box::new(SceneFault::EdgesCross { other: 2, edges_m: Box::new([[[0.0, 1.0]; 2], [[2.0, 3.0]; 2]]) }),
        Box::new(SceneFault::RouteInside { obstacle: name("post"), depth_m: 0.25, x_m: 1.0, y_m: 2.0 }),
        Box::new(SceneFault::SupportInside {
            name: "a".into(),
            obstacle: "post".into(),
            depth_m: 0.25,
            clear_m: Some([1.0, 2.0]),
        }),
        Box::new(SceneFault::NoWay { from: "a".into(), to: "b".into(), apart_m: 0.5, inside: None }),
        Box::new(SceneFault::NoWay { from: "a".into(), to: "b".into(), apart_m: 0.5, inside: Some("b".into()) }),
        Box::new(SceneFault::TooShort { length_m: 9.0, way_m: 10.0, needed_n: 2e5, breaking_n: 1e4 }),
        Box::new(SolveError::NotConverged { model, iterations: 7, residual_n: 4.448, place: place() }),
        Box::new(SolveError::TooMuchWork { model, iterations: 7, segments: 40, residual_n: f64::NAN, place: place() }),
        Box::new(SolveError::Compressed { model, tension_n: -4.448, place: place() }),
        Box::new(SolveError::TensionLost { model: Model::Spans, loss: TensionLoss::Fold, arc_length_m: 3.2, at_m }),
        Box::new(why(NoEquilibrium::UnheldForce { left_n: 12.0, loads_n: 120.0 })),
        Box::new(why(NoEquilibrium::TooLittleFriction { friction_ratio: 1.0312 })),
        Box::new(why(NoEquilibrium::ThroughObstacle { obstacle: name("post"), at_m, arc_length_m: 3.2 })),
        Box::new(why(NoEquilibrium::Span(SpanError::TooShort { length_m: 9.0, chord_m: 10.0 }))),
        Box::new(why(NoEquilibrium::Span(SpanError::NotConverged { iterations: 7, closure_m: 1e-3 }))),
        Box::new(lacks(Unsupported::Obstacle { arc_length_m: 3.2 })),
        Box::new(lacks(Unsupported::ContactImpossible { arc_length_m: 3.2, at_m })),
        Box::new(lacks(Unsupported::MotionTooFast {
            support: name("a"),
            speed_m_per_s: 412.0,
            time_s: 1.5,
            limit_m_per_s: 300.0,
        })),
        Box::new(SolveError::NonFinite { quantity: "position", arc_length_m: 3.2, time_s: 1.5 }),
        Box::new(SolveError::Buried { model, obstacle: name("post"), depth_m: 0.25, arc_length_m: 3.2, at_m }),
        Box::new(SolveError::Unsound { model, finding: Box::new(finding.clone()) }),
        Box::new(SolveError::StepFailed {
            model,
            time_s: 1.5,
            dt_s: 1e-6,
            residual_n: 4.448,
            place: place(),
            cause: FailureCause::RunawaySpeed { speed_m_per_s: 412.0 },
        }),
        Box::new(Verification { findings: vec![finding], ..Verification::default() }),
        Box::new(Verification::default()),
        Box::new(Verification {
            balance: Balance { residual_n: 2e-6, scale_n: 93.0, ..Balance::default() },
            not_checked: vec![NotChecked::SelfContact { cable: name("main") }],
            ..Verification::default()
        }),
    ]
}

/// A reason for a model of every form with a figure, what was not checked, and the faults of files,
/// imports and keys.
fn others() -> Vec<Box<dyn Sentence>> {
    let name = |name: &str| name.to_owned();
    let model = Model::Spans;
    let refusal = || {
        let feature = Unsupported::Obstacle { arc_length_m: 3.2 };
        Box::new(SolveError::Unsupported { model, feature })
    };
    let taken = || vec![AssumedStiffness { cable: name("main"), bending_stiffness_n_m2: 1.4 }];
    let bending = |bending| ModelReason::Bending { reason: Box::new(ModelReason::SupportsOnly), bending };
    let fault = SceneFault::BeyondEnd { arc_length_m: 12.0, length_m: 10.0 };
    let scene = Box::new(SceneError { path: name("loads[0]"), fault, at: None });
    let unverified = |finding| {
        let feature = Unsupported::Unverified { finding, arc_length_m: 3.2, at_m: Vec2::new(1.0, -2.0) };
        SolveError::Unsupported { model, feature }
    };
    let next = |force_error: Option<f64>| NextCheaper {
        model: Model::Catenary,
        neglects: NeglectedEffect::Obstacles,
        force_error,
        position_error_m: force_error.map(|_| 0.123),
        costs_more: false,
    };
    vec![
        Box::new(ModelReason::Requested),
        Box::new(ModelReason::NoAnswer(refusal())),
        Box::new(bending(LikelyBending::Assumed(taken()))),
        Box::new(bending(LikelyBending::AssumedWhereItMatters(taken()))),
        Box::new(bending(LikelyBending::NoAnswer(refusal()))),
        Box::new(next(Some(0.69))),
        Box::new(next(Some(2e-5))),
        Box::new(next(Some(0.0))),
        Box::new(next(None)),
        Box::new(NotChecked::MovingBalance { cable: name("main") }),
        Box::new(NotChecked::SelfContact { cable: name("main") }),
        Box::new(unverified(EquilibriumFault::LoadOutOfKink)),
        Box::new(SolveError::TimeStep { dt_s: -1.0, longest_s: f64::INFINITY }),
        Box::new(SolveError::TimeStep { dt_s: 2e3, longest_s: 1e3 }),
        Box::new(SolveError::Setting {
            name: "hand stiffness",
            value: 0.0,
            allowed: [1e-3, 1e9],
            quantity: Quantity::ForcePerLength,
        }),
        Box::new(SolveError::Setting {
            name: "tolerance",
            value: 0.0,
            allowed: [1e-14, f64::INFINITY],
            quantity: Quantity::Number,
        }),
        Box::new(SceneFault::Type { found: name("a string"), needed: name("a number") }),
        Box::new(SceneFault::Document(DocumentFault::UnknownWord {
            word: name("pully"),
            known: &["fixed", "pulley", "free"],
            nearest: Some(name("pulley")),
        })),
        Box::new(SceneFault::Document(DocumentFault::MissingForKind { kind: "clamped" })),
        Box::new(FileError::Scene { path: name("a.toml"), fault: scene }),
        Box::new(FileError::Table {
            path: name("run"),
            fault: Box::new(ReadError::Row {
                table: "nodes.csv",
                line: 3,
                fault: RowFault::NotANumber { column: name("x_m"), text: name("one") },
            }),
        }),
        Box::new(FileError::RunFolder { path: name("run"), fault: RunFolderFault::Full { count: 100 } }),
        Box::new(WriteError::NonFinite {
            table: "nodes.csv",
            number: Box::new(WrittenNumber::Node { column: "x_m", node: 4, cable: name("main") }),
            time_s: 1.5,
        }),
        Box::new(RunRemark::Partial { reached_s: Some(1.5), stop: None }),
        Box::new(RunRemark::Partial { reached_s: None, stop: Some(RunStop::Interrupted { signal: name("SIGTERM") }) }),
        Box::new(RunRemark::LeftOut(LeftOut::IncompleteLine { table: "nodes.csv", bytes: 17 })),
        Box::new(ImportChange::PointsMerged { count: 2 }),
        Box::new(ImportFault::Row { line: 3, text: name("1 2 3") }),
    ]
}

/// Every sentence as it stands in `sentences.txt`, in SI and in US units. After a change of words
/// `UPDATE_SENTENCES=1 cargo test` writes it anew.
#[test]
fn sentences_are_those_on_file_in_both_systems() {
    let told: Vec<Box<dyn Sentence>> =
        warnings().into_iter().map(|w| Box::new(w) as Box<dyn Sentence>).chain(errors()).chain(others()).collect();
    let both = |of: &dyn Sentence| [UnitSystem::Si, UnitSystem::Us].map(|units| of.sentence(units) + "\n").concat();
    let found = told.iter().map(|of| both(&**of)).collect::<Vec<_>>().join("\n");
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/sentences.txt");
    if std::env::var_os("UPDATE_SENTENCES").is_some() {
        std::fs::write(&path, &found).unwrap();
    }
    let kept = std::fs::read_to_string(path).unwrap();
    for (found, kept) in found.lines().zip(kept.lines()) {
        assert_eq!(found, kept);
    }
    assert_eq!(found, kept);
}

#[test]
fn every_kind_of_warning_has_a_sentence_and_is_read_back_from_its_data() {
    for kind in WarningKind::ALL {
        assert!(warnings().iter().any(|w| w.kind == kind), "{kind:?}");
    }
    for warning in warnings() {
        let text = serde_json::to_string(&warning).unwrap();
        assert_eq!(serde_json::from_str::<Warning>(&text).unwrap(), warning, "{text}");
    }
}

/// Figures with a unit that the other system has another for.
#[test]
fn no_sentence_mixes_the_systems() {
    let told: Vec<Box<dyn Sentence>> =
        warnings().into_iter().map(|w| Box::new(w) as Box<dyn Sentence>).chain(errors()).chain(others()).collect();
    for of in told {
        for (units, foreign) in [
            (UnitSystem::Us, ["N", "m", "N/m", "J", "m/s", "kg/m"].as_slice()),
            (UnitSystem::Si, ["lbf", "ft", "lbf/ft", "ft·lbf", "ft/s", "lb/ft"].as_slice()),
        ] {
            let text = of.sentence(units);
            // Names stand between backticks.
            let plain: String = text.split('`').step_by(2).collect();
            let words: Vec<&str> = plain.split([' ', ',', '(', ')', ':', ';']).filter(|w| !w.is_empty()).collect();
            for pair in words.windows(2) {
                let number = pair[0].parse::<f64>().is_ok();
                assert!(!number || !foreign.contains(&pair[1].trim_end_matches('.')), "{units:?}: {text}");
            }
        }
    }
}
