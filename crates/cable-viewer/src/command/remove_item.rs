//! Items of the scene are removed, and the selection with them.

use cable_core::Scene;
use cable_core::scene::{Shape, Support};

use crate::command::robot_hitch::set_robot;
use crate::state::{AppState, Item};

/// Removes items, none of them twice.
pub fn remove_all(state: &mut AppState, mut items: Vec<Item>) {
    // Items are removed from the last to the first of each kind, corners and supports before their
    // obstacle or cable, so that the indices of the others stay valid.
    let rank = |item: &Item| match *item {
        Item::Corner { obstacle, corner } => (0, obstacle, corner),
        Item::Support { cable, support } => (1, cable, support),
        Item::Load(k) | Item::LoadHead(k) => (2, k, 0),
        Item::PathLeg(k) => (3, k, 0),
        Item::Obstacle(k) => (4, k, 0),
        Item::Cable(k) => (5, k, 0),
        Item::Robot => (6, 0, 0),
        Item::Scene | Item::Environment | Item::Solver => (7, 0, 0),
    };
    items.sort_by_key(|item| std::cmp::Reverse(rank(item)));
    items.dedup_by_key(|item| rank(item));
    items.sort_by_key(|item| rank(item).0);
    for item in items {
        remove(&mut state.document.scene, item);
    }
    (state.selection.selected, state.selection.also_selected) = (None, Vec::new());
}

/// Removes an item; ends of a cable become free, and the last cable stays.
fn remove(scene: &mut Scene, item: Item) {
    match item {
        Item::Cable(k) if scene.cables.len() > 1 && k < scene.cables.len() => {
            let gone = scene.cables.remove(k);
            scene.loads.retain(|l| l.cable != gone.name);
        }
        Item::Cable(_) | Item::Scene | Item::Environment | Item::Solver => {}
        Item::Robot => set_robot(scene, None),
        Item::Support { cable, support } => {
            let Some(c) = scene.cables.get_mut(cable) else { return };
            let last = c.supports.len().saturating_sub(1);
            if support == 0 || support == last {
                if let Some(s) = c.supports.get_mut(support) {
                    *s = Support::free(s.name.clone());
                }
            } else if support < last {
                c.supports.remove(support);
            }
        }
        Item::Obstacle(k) => {
            if k < scene.obstacles.len() {
                scene.obstacles.remove(k);
            }
        }
        Item::Corner { obstacle, corner } => {
            let Some(o) = scene.obstacles.get_mut(obstacle) else { return };
            let (points, least) = match &mut o.shape {
                Shape::Polygon { points_m } => (points_m, 3),
                Shape::Terrain { points_m } | Shape::Polyline { points_m, .. } => (points_m, 2),
                Shape::Circle { .. } => return,
            };
            if points.len() > least && corner < points.len() {
                points.remove(corner);
            }
        }
        Item::PathLeg(k) => {
            if let Some(robot) = scene.robot.as_mut().filter(|r| k < r.path.len()) {
                robot.path.remove(k);
            }
        }
        Item::Load(k) | Item::LoadHead(k) => {
            if k < scene.loads.len() {
                scene.loads.remove(k);
            }
        }
    }
}

/// A selection that no longer exists must not point at its neighbour's panel.
pub fn drop_lost_selection(state: &mut AppState) {
    if state.selection.selected.is_some_and(|item| !exists(state, item)) {
        state.selection.selected = None;
    }
    let mut also = std::mem::take(&mut state.selection.also_selected);
    also.retain(|item| exists(state, *item));
    state.selection.also_selected = also;
}

/// After an undo or redo from the scene `before` no other thing is selected than before: what has
/// taken the place of one that is gone is not selected.
pub fn drop_changed_selection(state: &mut AppState, before: &Scene) {
    let scene = &state.document.scene;
    let stays = |item: &Item| is_same_item(before, scene, *item);
    let selected = state.selection.selected.filter(stays);
    let also: Vec<Item> = state.selection.also_selected.iter().copied().filter(stays).collect();
    (state.selection.selected, state.selection.also_selected) = (selected, also);
    drop_lost_selection(state);
}

/// Returns whether an item is the same thing in two scenes: there are as many of its kind, so that
/// one was edited at most, or it is known by its name or its value.
fn is_same_item(a: &Scene, b: &Scene, item: Item) -> bool {
    fn same<T, K: PartialEq>(a: &[T], b: &[T], k: usize, key: impl Fn(&T) -> K) -> bool {
        a.len() == b.len() || a.get(k).map(&key) == b.get(k).map(&key)
    }
    let corners = |scene: &Scene, k: usize| match scene.obstacles.get(k).map(|o| &o.shape) {
        Some(Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. }) => {
            points_m.clone()
        }
        Some(Shape::Circle { .. }) | None => Vec::new(),
    };
    let supports = |scene: &Scene, k: usize| scene.cables.get(k).map_or_else(Vec::new, |c| c.supports.clone());
    let path = |scene: &Scene| scene.robot.as_ref().map_or_else(Vec::new, |r| r.path.clone());
    match item {
        Item::Cable(k) => same(&a.cables, &b.cables, k, |c| c.name.clone()),
        Item::Support { cable, support } => {
            is_same_item(a, b, Item::Cable(cable))
                && same(&supports(a, cable), &supports(b, cable), support, |s| s.name.clone())
        }
        Item::Obstacle(k) => same(&a.obstacles, &b.obstacles, k, |o| o.name.clone()),
        Item::Corner { obstacle, corner } => {
            is_same_item(a, b, Item::Obstacle(obstacle))
                && same(&corners(a, obstacle), &corners(b, obstacle), corner, |p| *p)
        }
        Item::Load(k) | Item::LoadHead(k) => same(&a.loads, &b.loads, k, Clone::clone),
        Item::PathLeg(k) => same(&path(a), &path(b), k, Clone::clone),
        Item::Robot | Item::Scene | Item::Environment | Item::Solver => true,
    }
}

/// True if the scene has the item.
fn exists(state: &AppState, item: Item) -> bool {
    let scene = &state.document.scene;
    match item {
        Item::Cable(k) => k < scene.cables.len(),
        Item::Support { cable, support } => scene.cables.get(cable).is_some_and(|c| support < c.supports.len()),
        Item::Obstacle(k) => k < scene.obstacles.len(),
        Item::Corner { obstacle, corner } => scene.obstacles.get(obstacle).is_some_and(|o| match &o.shape {
            Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                corner < points_m.len()
            }
            Shape::Circle { .. } => false,
        }),
        Item::Load(k) | Item::LoadHead(k) => k < scene.loads.len(),
        Item::Robot => scene.robot.is_some(),
        Item::PathLeg(k) => scene.robot.as_ref().is_some_and(|r| k < r.path.len()),
        Item::Scene | Item::Environment | Item::Solver => true,
    }
}
