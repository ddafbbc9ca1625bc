//! A handle is the point by which an item of the scene is dragged.

use cable_core::math::Point;
use cable_core::scene::Shape;

use crate::geometry::arrows::{head_at, load_at};
use crate::geometry::robot::path_flags;
use crate::geometry::supports::support_position;
use crate::state::{AppState, Item};

/// Returns the position of an item that can be dragged, m; `None` for one that cannot.
#[must_use]
pub fn of(state: &AppState, item: Item) -> Option<Point> {
    match item {
        Item::Support { cable, support } => {
            state.document.scene.cables.get(cable)?.supports.get(support)?.at_m?;
            support_position(state, cable, support)
        }
        Item::Corner { obstacle, corner } => match &state.document.scene.obstacles.get(obstacle)?.shape {
            Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                points_m.get(corner).copied()
            }
            Shape::Circle { .. } => None,
        },
        Item::Obstacle(k) => match &state.document.scene.obstacles.get(k)?.shape {
            // The whole ground is not dragged by accident: its corners are.
            Shape::Terrain { .. } => None,
            Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => points_m.first().copied(),
            Shape::Circle { center_m, .. } => Some(*center_m),
        },
        Item::Load(k) => load_at(state, k).map(|(at, _)| at),
        Item::LoadHead(k) => {
            state.document.scene.loads.get(k)?.force_n?;
            head_at(state, k)
        }
        Item::Robot => state.document.scene.robot.as_ref().map(|r| r.at_m),
        Item::PathLeg(k) => path_flags(state).into_iter().find(|(leg, ..)| *leg == k).map(|(_, at, _)| at),
        Item::Cable(_) | Item::Scene | Item::Environment | Item::Solver => None,
    }
}

/// Returns the items that move when one item is moved by a vector (m), each with its new position,
/// m: the item alone, or the whole selection if the item is selected.
#[must_use]
pub fn moved(state: &AppState, item: Item, by_m: Point) -> Vec<(Item, Point)> {
    let items = if state.selection.contains(item) { state.selection.selected_items() } else { vec![item] };
    // Loads and heads of arrows have places that follow from others.
    let alone = items.len() == 1;
    let moves =
        items.into_iter().filter(|i| alone || !matches!(i, Item::Load(_) | Item::LoadHead(_) | Item::PathLeg(_)));
    moves.filter_map(|i| of(state, i).map(|at| (i, [at[0] + by_m[0], at[1] + by_m[1]]))).collect()
}

/// All items that lie in a frame between two corners, m.
#[must_use]
pub fn within(state: &AppState, [a, b]: [Point; 2]) -> Vec<Item> {
    let inside = |p: Point| (0..2).all(|k| p[k] >= a[k].min(b[k]) && p[k] <= a[k].max(b[k]));
    let scene = &state.document.scene;
    let supports = scene.cables.iter().enumerate().flat_map(|(cable, c)| {
        (0..c.supports.len()).map(move |support| (Item::Support { cable, support }, (cable, support)))
    });
    let mut out: Vec<Item> = supports
        .filter(|(_, (cable, support))| support_position(state, *cable, *support).is_some_and(inside))
        .map(|(item, _)| item)
        .collect();
    for (k, o) in scene.obstacles.iter().enumerate() {
        let whole = match &o.shape {
            Shape::Circle { center_m, .. } => inside(*center_m),
            Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                points_m.iter().all(|p| inside(*p))
            }
        };
        if whole {
            out.push(Item::Obstacle(k));
        }
    }
    out.extend((0..scene.loads.len()).map(Item::Load).filter(|i| of(state, *i).is_some_and(inside)));
    out
}

/// All items that can be selected, in the order of the scene panel.
#[must_use]
pub fn all(state: &AppState) -> Vec<Item> {
    let scene = &state.document.scene;
    let supports = scene.cables.iter().enumerate();
    let supports =
        supports.flat_map(|(cable, c)| (0..c.supports.len()).map(move |support| Item::Support { cable, support }));
    let legs = path_flags(state).into_iter().map(|(k, ..)| Item::PathLeg(k));
    supports
        .chain((0..scene.obstacles.len()).map(Item::Obstacle))
        .chain((0..scene.loads.len()).map(Item::Load))
        .chain(scene.robot.iter().map(|_| Item::Robot))
        .chain(legs)
        .collect()
}
