//! A wheel can press on the cable, but not pull it: one round which a cable in motion would turn
//! the wrong way lets go. If a post stands in its place the cable slides over that from then on,
//! and leaves it like any other post.

use std::sync::Arc;

use crate::contact::geometry::Body;
use crate::math::Vec2;
use crate::model::Inertia;
use crate::model::fem::mesh::{BarEnd, SlideOver, SlidingNode, round_of};
use crate::model::fem::obstacle::{IntersectionCheck, place_bodies};
use crate::model::fem::remesh::adapt::remove_sliding_nodes;
use crate::model::fem::remesh::loads_over_rounds::carries;
use crate::model::fem::state::{CableState, MovingOutline, renew_input};
use crate::problem::{Departure, Problem, SupportPoint};

/// The node on a wheel that would have to pull the cable, with its support.
pub(in crate::model::fem) fn lifted_wheel(cable: &CableState) -> Option<&SupportPoint> {
    let mesh = &cable.mesh;
    (1..mesh.nodes().saturating_sub(1)).find_map(|k| {
        let node = mesh.sliding[k].filter(|_| mesh.is_alone_on_round(k))?;
        let SlideOver::Pulley(support) = node.slide_over else { return None };
        let support = cable.problem.supports.get(support)?;
        let holds = support.departure == Departure::Possible && support.holds_from(cable.motion.time);
        (holds && mesh.turn(k, &cable.motion.positions) < 0.0).then_some(support)
    })
}

/// The pulley that a load between the ends of the cable has come to within a radius of the cable,
/// and the arc length of the load, m, where the load does not run over it: in an eye it would jam,
/// with 600 N from 60.
pub(in crate::model::fem) fn load_at_pulley(cable: &CableState) -> Option<(&SupportPoint, f64)> {
    if cable.meshing.never_slides {
        return None;
    }
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    (1..mesh.nodes().saturating_sub(1)).find_map(|k| {
        let node = mesh.sliding[k]?;
        let SlideOver::Pulley(support) = node.slide_over else { return None };
        let force = |j: usize| -> Vec2 {
            let loads = cable.meshing.loads.iter().filter(|load| load.node == j);
            loads.map(|load| load.force.at(cable.motion.time)).sum()
        };
        let jams = |j: &usize| cable.meshing.only_carries_load(mesh, *j) && !carries(mesh, &node, force(*j));
        let inner = |j: &usize| *j > 0 && *j + 1 < mesh.nodes();
        let near = |j: &usize| !(mesh.path(k.min(*j), x).straight > cable.problem.radius);
        let load = [k - 1, k + 1].into_iter().filter(inner).filter(jams).find(near)?;
        let support = cable.problem.supports.get(support)?;
        support.holds_from(cable.motion.time).then_some((support, mesh.arc_length[load]))
    })
}

/// Goes on with a problem in which some wheels have let go, with posts for some of them after its
/// other obstacles.
pub(in crate::model::fem) fn change_wheels(cable: &mut CableState, problem: Arc<Problem>) {
    let known = cable.problem.world.geometry().bodies().iter().filter(|body| !body.moves()).count();
    let (outline, problem) = MovingOutline::of(problem);
    cable.problem = problem;
    if let (Some(present), Some(new)) = (&mut cable.outline, outline) {
        // The obstacles of its contacts have other numbers.
        present.obstacle = new.obstacle;
        cable.contacts.forget();
    }
    cable.contacts.search.lists.clear();
    place_bodies(cable);
    for k in 0..cable.mesh.nodes() {
        if let Some(on_post) = cable.mesh.sliding[k].and_then(|node| on_post(cable, known, node)) {
            cable.motion.shift(k, on_post.position() - cable.motion.positions[k]);
            cable.mesh.sliding[k] = Some(on_post);
        }
    }
    let x = std::mem::take(&mut cable.motion.positions);
    cable.contacts.prepare(&cable.problem, &cable.mesh, &x, &x);
    cable.motion.positions = x;
    // Material on a wheel that moved goes on with its velocity.
    remove_sliding_nodes(cable, &[], Inertia::Dynamic);
    renew_input(cable);
}

/// A node that slides over a wheel which has let go, on the post in its place: one of the obstacles
/// after the first `known`.
fn on_post(cable: &CableState, known: usize, node: SlidingNode) -> Option<SlidingNode> {
    let SlideOver::Pulley(support) = node.slide_over else { return None };
    let geometry = cable.problem.world.geometry();
    let has_left = cable.problem.supports.get(support).is_some_and(|s| s.departure == Departure::Done);
    let is_post = |body: &&Body| body.center == Some(node.end.center);
    let body = geometry.bodies().iter().skip(known).filter(|_| has_left).find(is_post)?;
    // An edge would have the first feature of the body, a circle has the next.
    let feature = body.first + 1;
    let clearance = IntersectionCheck::of(cable).clearance(feature);
    let (center, radius) = round_of(geometry, feature, clearance, 0.0)?;
    let slide_over = SlideOver::Obstacle { obstacle: body.obstacle, feature };
    Some(SlidingNode { end: BarEnd { center, radius, ..node.end }, slide_over, ..node })
}
