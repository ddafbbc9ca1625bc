//! Cables, supports, obstacles and loads are copied and pasted, within a window and as a table for
//! others.

use std::fmt::Write as _;

use cable_core::math::Point;
use cable_core::scene::{Shape, Support, SupportKind};
use cable_core::{Cable, Obstacle};

use crate::command::effects::Effects;
use crate::command::move_item::shifted;
use crate::command::support_kind::{SupportPlace, of_kind};
use crate::command::unique_name::unique;
use crate::command::waypoint::waypoint_place;
use crate::geometry::hit_test;
use crate::geometry::supports::support_position;
use crate::state::clipboard::{Clipboard, Thing};
use crate::state::{AppState, Item};

/// Offset of a pasted item from its original if the pointer is not over the canvas, m. With a
/// smaller offset the copy would hide the original; with a larger one it would be out of view in a
/// small scene.
const PASTE_OFFSET_M: Point = [0.5, 0.5];

/// Copies the selection; as text it is a table of points.
pub fn copy(state: &mut AppState, effects: &mut Effects) {
    let (mut things, mut points, mut text) = (Vec::new(), Vec::new(), String::new());
    for item in state.selection.selected_items() {
        let Some((thing, of)) = thing(state, item) else { continue };
        for p in &of {
            let _ = writeln!(text, "{:?}\t{:?}", p[0], p[1]);
        }
        text.push('\n');
        points.extend(of);
        things.push(thing);
    }
    if things.is_empty() {
        return;
    }
    let count = points.len().max(1) as f64;
    let middle_m = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / count);
    effects.copied = Some(text.clone());
    state.selection.clipboard = Clipboard { things, middle_m, text };
}

/// A copy of an item, and the points that determine its position.
fn thing(state: &AppState, item: Item) -> Option<(Thing, Vec<Point>)> {
    let scene = &state.document.scene;
    Some(match item {
        Item::Cable(k) => {
            let cable = scene.cables.get(k)?;
            (Thing::Cable(Box::new(cable.clone())), cable.supports.iter().filter_map(|s| s.at_m).collect())
        }
        Item::Support { cable, support } => {
            let value = scene.cables.get(cable)?.supports.get(support)?;
            let at_m = support_position(state, cable, support)?;
            (Thing::Support(Box::new(value.clone()), at_m), vec![at_m])
        }
        Item::Obstacle(k) | Item::Corner { obstacle: k, .. } => {
            let value = scene.obstacles.get(k)?;
            let points = match &value.shape {
                Shape::Circle { center_m, .. } => vec![*center_m],
                Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                    points_m.clone()
                }
            };
            (Thing::Obstacle(value.clone()), points)
        }
        Item::Load(k) | Item::LoadHead(k) => {
            let (at_m, _) = crate::geometry::arrows::load_at(state, k)?;
            (Thing::Load(scene.loads.get(k)?.clone()), vec![at_m])
        }
        Item::Robot | Item::PathLeg(_) | Item::Scene | Item::Environment | Item::Solver => return None,
    })
}

/// Pastes the copied items into the scene and selects them.
pub fn paste(state: &mut AppState, at_m: Option<Point>) {
    let Clipboard { things, middle_m, .. } = state.selection.clipboard.clone();
    let to = at_m.unwrap_or([middle_m[0] + PASTE_OFFSET_M[0], middle_m[1] + PASTE_OFFSET_M[1]]);
    let shift = |p: Point| shifted(p, middle_m, to);
    let target = state.current_cable();
    let mut new = Vec::new();
    for thing in things {
        new.extend(match thing {
            Thing::Cable(cable) => Some(put_cable(state, &cable, &shift)),
            Thing::Support(support, was_m) => put_support(state, target, &support, shift(was_m)),
            Thing::Obstacle(obstacle) => Some(put_obstacle(state, obstacle, &shift)),
            Thing::Load(mut load) => {
                load.cable = state.document.scene.cables.get(target).map_or(load.cable, |c| c.name.clone());
                let length = state.document.scene.cables.get(target).map_or(0.0, |c| c.length_m);
                load.arc_length_m = load.arc_length_m.min(length);
                state.document.scene.loads.push(load);
                Some(Item::Load(state.document.scene.loads.len() - 1))
            }
        });
    }
    let mut new = new.into_iter();
    (state.selection.selected, state.selection.also_selected) = (new.next(), new.collect());
}

/// Another cable like the current one, a little above it.
pub fn add_cable(state: &mut AppState) {
    let Some(cable) = state.document.scene.cables.get(state.current_cable()).cloned() else { return };
    let up = |p: Point| [p[0], p[1] + PASTE_OFFSET_M[1]];
    let item = put_cable(state, &cable, &up);
    (state.selection.selected, state.selection.also_selected) = (Some(item), Vec::new());
}

/// Adds a copy of a cable, shifted and with a name of its own.
fn put_cable(state: &mut AppState, cable: &Cable, shift: &impl Fn(Point) -> Point) -> Item {
    let mut cable = cable.clone();
    cable.name = unique(&cable.name, |n| state.document.scene.cables.iter().any(|c| c.name == n));
    cable.route_m.iter_mut().for_each(|p| *p = shift(*p));
    for s in &mut cable.supports {
        s.at_m = s.at_m.map(shift);
        for p in s.motion.iter_mut().flat_map(|m| &mut m.points_m) {
            *p = shift(*p);
        }
    }
    state.document.scene.cables.push(cable);
    Item::Cable(state.document.scene.cables.len() - 1)
}

/// Adds an obstacle, shifted and with a name of its own.
fn put_obstacle(state: &mut AppState, mut obstacle: Obstacle, shift: &impl Fn(Point) -> Point) -> Item {
    obstacle.name = unique(&obstacle.name, |n| state.document.scene.obstacles.iter().any(|o| o.name == n));
    match &mut obstacle.shape {
        Shape::Circle { center_m, .. } => *center_m = shift(*center_m),
        Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
            points_m.iter_mut().for_each(|p| *p = shift(*p));
        }
    }
    state.document.scene.obstacles.push(obstacle);
    Item::Obstacle(state.document.scene.obstacles.len() - 1)
}

/// A support between the ends of a cable, where the cable is nearest to it. What can only be an end
/// becomes a waypoint.
fn put_support(state: &mut AppState, cable: usize, support: &Support, at_m: Point) -> Option<Item> {
    let arc_length_m = hit_test::nearest_on(state, cable, at_m)?;
    let place = waypoint_place(state, cable, arc_length_m);
    let c = state.document.scene.cables.get_mut(cable).filter(|c| c.supports.len() >= 2)?;
    let kind = match support.kind {
        SupportKind::Free | SupportKind::Robot => SupportKind::Pulley,
        kind => kind,
    };
    let mut put = of_kind(support, kind, at_m, arc_length_m, SupportPlace::Between);
    put.at_m = put.at_m.map(|_| at_m);
    put.arc_length_m = put.arc_length_m.map(|_| arc_length_m);
    if let (Some(motion), Some(was)) = (&mut put.motion, support.at_m) {
        motion.points_m.iter_mut().for_each(|p| *p = shifted(*p, was, at_m));
    }
    put.name = unique(&put.name, |n| c.supports.iter().any(|s| s.name == n));
    let place = place.clamp(1, c.supports.len() - 1);
    c.supports.insert(place, put);
    c.route_m.clear();
    Some(Item::Support { cable, support: place })
}
