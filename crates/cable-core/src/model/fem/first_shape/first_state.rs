//! This module makes the first state of a cable: along its route, at rest, clear of obstacles.

use std::sync::Arc;

use crate::contact::barrier::Barrier;
use crate::math::Vec2;
use crate::model::Settings;
use crate::model::fem::first_shape::push_out::depenetrate;
use crate::model::fem::first_shape::route::{place_nodes, route};
use crate::model::fem::first_shape::threading::thread_pulleys;
use crate::model::fem::mesh::{MassMatrix, Mesh, PUSHED_OUT_REACHES, bar_count};
use crate::model::fem::obstacle::touches_nothing;
use crate::model::fem::settings::Tuning;
use crate::model::fem::state::{
    CableState, LoadNode, Meshing, MovingOutline, NodalMotion, NodeTensions, StepAnswers, prepare_input,
};
use crate::model::fem::system::{ContactSet, StepInput, load_scale, tolerance};
use crate::model::material_loss::Loss;
use crate::problem::{PointLoad, Problem};
use crate::scene::SupportKind;

/// Distance within which two places of a mesh are one node, as a fraction of the cable's length:
/// round-off. Smaller: bars of no length; larger: a load beside a support is moved to it.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// The cable along its route.
pub(in crate::model::fem) fn cable_along_route(
    problem: Arc<Problem>,
    settings: Settings,
    tuning: Arc<Tuning>,
) -> CableState {
    let Tuning { contact, start, .. } = *tuning;
    let (outline, problem) = MovingOutline::of(problem);
    let route = route(&problem);
    let segments = bar_count(&problem, settings, &start);
    let breaks = places_of_nodes(&problem, &route, start.route_node_bars * (problem.length / segments as f64));
    let mesh = Mesh::new(&problem, tuning, &breaks, segments, mass_matrix(&problem));
    let mut cable = cable_at_rest(problem, outline, mesh, segments, &route);
    if cable.problem.cable.self_contact {
        cable.contacts.self_contacts.shape.diameter = cable.problem.cable.diameter_m;
        cable.contacts.self_contacts.friction = cable.problem.cable.friction;
    }
    cable.forget_history();
    prepare_input(&mut cable, 0.0, None);
    for k in 0..cable.mesh.nodes() {
        if cable.mesh.fixity[k] {
            cable.motion.positions[k] = cable.input.supports.target[k];
        }
    }
    thread_pulleys(&mut cable, None);
    let mut x = std::mem::take(&mut cable.motion.positions);
    depenetrate(&cable.problem, &cable.mesh, &mut x, PUSHED_OUT_REACHES * contact.reach_m);
    cable.motion.positions = x;
    cable.loss = Loss::of(&cable.problem, cable.even(), cable.rubbing());
    cable.forget_history();
    cable
}

/// Arc lengths at which a mesh needs a node, m: supports, loads and, if the cable can touch
/// something, points of its route that are farther than `near` (m) from all of these.
fn places_of_nodes(problem: &Problem, route: &[(f64, Vec2)], near: f64) -> Vec<f64> {
    let mut breaks = vec![0.0, problem.length];
    breaks.extend(problem.supports.iter().filter_map(|s| s.arc_length));
    breaks.extend(problem.loads.iter().map(|l| l.arc_length));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|a, b| *a - *b < SAME_POINT_FRACTION * problem.length);
    if !problem.world.is_empty() || problem.cable.self_contact {
        for (s, _) in route {
            if breaks.iter().all(|b| (b - s).abs() > near) {
                breaks.push(*s);
            }
        }
        breaks.sort_by(f64::total_cmp);
    }
    breaks
}

/// A cable at rest with its nodes along a route, not yet pushed out of obstacles.
fn cable_at_rest(
    problem: Arc<Problem>,
    outline: Option<MovingOutline>,
    mesh: Mesh,
    segments: usize,
    route: &[(f64, Vec2)],
) -> CableState {
    let contact = mesh.tuning.contact;
    let even = problem.length / segments as f64;
    let n = mesh.nodes();
    let support_node: Vec<Option<usize>> =
        problem.supports.iter().map(|s| s.arc_length.and_then(|a| mesh.node_at(a))).collect();
    let load = |l: &PointLoad| {
        let (arc_length, force) = (l.arc_length, l.force.clone());
        Some(LoadNode { node: mesh.node_at(arc_length)?, arc_length, force })
    };
    let loads = problem.loads.iter().filter_map(load).collect();
    let (normal_per_m, whole) = load_scale(&problem);
    let barrier = Barrier { reach: contact.reach_m, stiffness: contact.stiffness_weights * normal_per_m * even };
    let mut input = StepInput::default();
    input.stopping.tolerance = tolerance(&problem, whole);
    CableState {
        contacts: ContactSet::new(barrier, contact, n),
        motion: motion_at_rest(&problem, &mesh, place_nodes(&mesh, route)),
        meshing: Meshing {
            // A sliding node scales the energy of all that lies beyond it; a cable in contact with
            // itself needs one scale.
            slides: !problem.cable.self_contact,
            never_slides: problem.world.is_empty() && problem.supports.iter().all(|s| s.kind != SupportKind::Pulley),
            even_bars: segments,
            bar_weight: normal_per_m * even,
            support_node,
            loads,
            was_contact_free: false,
            found: Vec::with_capacity(n),
        },
        loss: Loss::default(),
        answers: StepAnswers {
            reaction: vec![Vec2::zeros(); n],
            lagging_supports: Vec::new(),
            stepped: None,
            keeps: false,
            stored_answer: None,
            gauged: NodeTensions::default(),
        },
        outline,
        mesh,
        input,
        problem,
    }
}

/// Nodes at rest, without a history.
fn motion_at_rest(problem: &Problem, mesh: &Mesh, positions: Vec<Vec2>) -> NodalMotion {
    let n = mesh.nodes();
    let older = if mesh.spread.is_lumped() { 0 } else { n };
    NodalMotion {
        positions,
        velocities: vec![Vec2::zeros(); n],
        previous_positions: vec![Vec2::zeros(); n],
        previous_velocities: vec![Vec2::zeros(); n],
        older_positions: vec![Vec2::zeros(); older],
        older_velocities: vec![Vec2::zeros(); older],
        previous_arc_length: mesh.arc_length.clone(),
        slide_rates: vec![0.0; n],
        previous_slide_rates: vec![0.0; n],
        followers: vec![None; problem.supports.len()],
        length_change: None,
        bending_change: None,
        earlier_excess: [1.0; 3],
        hands: vec![None; problem.supports.len()],
        placement: problem.outline.as_ref().map(|o| o.placement),
        ..NodalMotion::default()
    }
}

/// The mass matrix of a cable. If it can touch something, the mass is always lumped: a contact
/// takes the momentum of one node, nodes come and go with corners and pulleys, and a mass matrix
/// that changed when contact begins would change the energy.
fn mass_matrix(problem: &Problem) -> MassMatrix {
    if touches_nothing(problem) && problem.supports.iter().all(|s| s.kind != SupportKind::Pulley) {
        MassMatrix::Spread
    } else {
        MassMatrix::Lumped
    }
}
