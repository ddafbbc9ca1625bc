//! A model that is defined outside the crate runs through `Simulation` like those of the registry.

#![allow(clippy::unwrap_used)] // a failing test is meant to panic

use std::sync::Arc;

use cable_core::error::SolveError;
use cable_core::model::tension_gauge::TensionGauge;
use cable_core::model::{Inertia, Mechanics, StepReport};
use cable_core::problem::{Problem, SupportPoint};
use cable_core::scene::{Scene, Support, SupportKind, catalog};
use cable_core::solution::{CableSolution, Node, SupportReaction};
use cable_core::{Model, Settings, Simulation, State, Vec2};

/// A cable that hangs straight down from its start, with T(s) = w (L − s) and y' = −(1 + T/EA).
#[derive(Clone)]
struct Plumb {
    problem: Arc<Problem>,
    time_s: f64,
    dragged_m: Option<Vec2>,
}

const ELEMENTS: usize = 8;

impl Plumb {
    fn node(&self, k: usize) -> Node {
        let p = &self.problem;
        let s = p.length * k as f64 / ELEMENTS as f64;
        let (w, ea) = (p.weight.norm(), p.axial_stiffness);
        let top = self.dragged_m.or(p.supports[0].at).unwrap();
        let tension_n = w * (p.length - s);
        Node {
            arc_length_m: s,
            x_m: top.x,
            y_m: top.y - s - w * (p.length * s - 0.5 * s * s) / ea,
            tension_n,
            strain: tension_n / ea,
            force_n: [0.0, -tension_n],
            ..Node::default()
        }
    }
}

impl Mechanics for Plumb {
    fn model(&self) -> Model {
        Model::External
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        Ok(StepReport::default())
    }

    fn advance_gauged(&mut self, dt_s: f64, _: Inertia, _: &mut TensionGauge) -> Result<StepReport, SolveError> {
        self.time_s += dt_s;
        Ok(StepReport::default())
    }

    fn state(&self) -> State {
        State::of_nodes(&self.solution().nodes, self.time_s)
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.time_s = state.time_s;
        Ok(())
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if support == 0 {
            self.dragged_m = Some(target_m);
        }
    }

    fn solution(&self) -> CableSolution {
        let nodes: Vec<Node> = (0..=ELEMENTS).map(|k| self.node(k)).collect();
        let reaction = |s: &SupportPoint, n: &Node, pull: f64| SupportReaction {
            name: s.name.clone(),
            x_m: n.x_m,
            y_m: n.y_m,
            reaction_y_n: pull,
            arc_length_m: n.arc_length_m,
            ..SupportReaction::default()
        };
        let supports = vec![
            reaction(&self.problem.supports[0], &nodes[0], -nodes[0].tension_n),
            reaction(&self.problem.supports[1], &nodes[ELEMENTS], 0.0),
        ];
        CableSolution {
            name: self.problem.cable.name.clone(),
            nodes: nodes.into(),
            supports,
            ..CableSolution::default()
        }
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

fn hanging() -> Scene {
    let ends = [Support::fixed("top", [1.0, 10.0]), Support::new("end", SupportKind::Free)];
    catalog::cable_alone([5.0, 1.0, 1e5], ends.into())
}

#[test]
fn a_model_from_outside_settles_steps_resets_and_is_verified() {
    let build = |problem, _| Ok(Box::new(Plumb { problem, time_s: 0.0, dragged_m: None }) as Box<dyn Mechanics>);
    let mut simulation = Simulation::with_mechanics(hanging(), Settings::default(), build).unwrap();
    let answer = simulation.settle().unwrap();
    assert_eq!((answer.model, answer.cables.len()), (Model::External, 1));
    // The registry's own model says the same, and the laws of mechanics find nothing wrong.
    let known = Simulation::new(hanging(), Model::Catenary).unwrap().settle().unwrap();
    assert!((answer.max_tension().tension_n - known.max_tension().tension_n).abs() < 1e-9);
    assert!(answer.verification.unwrap().is_sound());
    simulation.drag_support(0, 0, Vec2::new(3.0, 10.0));
    simulation.step(0.25).unwrap();
    simulation.step_quasi_static(0.25).unwrap();
    assert_eq!((simulation.time_s(), simulation.answers()[0].nodes[0].x_m), (0.5, 3.0));
    // An edit of the scene goes on by the same model.
    let edited = simulation.with_scene(hanging(), Settings::default()).unwrap();
    assert_eq!((edited.model(), edited.time_s()), (Model::External, 0.5));
    simulation.reset();
    assert_eq!((simulation.time_s(), simulation.solution().cables), (0.0, answer.cables));
}

#[test]
fn a_model_from_outside_is_not_asked_for_by_name() {
    assert_eq!(Model::from_name("external"), None);
    let refused = Simulation::new(hanging(), Model::External).unwrap_err().to_string();
    assert!(refused.contains("external cannot answer this scene"), "{refused}");
}
