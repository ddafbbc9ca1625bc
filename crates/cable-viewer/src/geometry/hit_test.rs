//! The hit test finds what lies under a point of the screen.

use cable_core::math::Point;
use cable_core::scene::Shape;
use egui::{Pos2, Rect};

use crate::geometry::arrows::{head_at, load_at};
use crate::geometry::robot::{path_flags, robot_outline};
use crate::geometry::supports::support_position;
use crate::state::{AppState, Item};

/// The distance that counts as on it, points.
const SUPPORT_HIT_RADIUS: f32 = 13.0;
const CORNER_HIT_RADIUS: f32 = 8.0;
const LINE_HIT_RADIUS: f32 = 7.0;

/// The item under a screen point: supports before loads, corners, cables and obstacles.
#[must_use]
pub fn item_at(state: &AppState, canvas: Rect, p: Pos2) -> Option<Item> {
    let near = |at: Point, reach: f32| {
        let d = state.view.camera.to_screen(canvas, at).distance(p);
        (d <= reach).then_some(d)
    };
    let mut best: Option<(f32, Item)> = None;
    let mut offer = |d: Option<f32>, item: Item| {
        if let Some(d) = d
            && best.is_none_or(|(b, _)| d < b)
        {
            best = Some((d, item));
        }
    };
    for (cable, c) in state.document.scene.cables.iter().enumerate() {
        for support in 0..c.supports.len() {
            let d = support_position(state, cable, support).and_then(|at| near(at, SUPPORT_HIT_RADIUS));
            offer(d, Item::Support { cable, support });
        }
    }
    for load in 0..state.document.scene.loads.len() {
        offer(load_at(state, load).and_then(|(at, _)| near(at, CORNER_HIT_RADIUS)), Item::Load(load));
        if state.view.layers.forces {
            offer(head_at(state, load).and_then(|at| near(at, CORNER_HIT_RADIUS)), Item::LoadHead(load));
        }
    }
    for (leg, at, _) in path_flags(state) {
        offer(near(at, CORNER_HIT_RADIUS), Item::PathLeg(leg));
    }
    for (obstacle, o) in state.document.scene.obstacles.iter().enumerate() {
        // Corners can be picked once their handles are shown; before, the whole obstacle is.
        if !handles_shown(state, obstacle) {
            continue;
        }
        let points = corners(&o.shape);
        for (corner, &at) in points.iter().enumerate() {
            offer(near(at, corner_reach(state, points, corner)), Item::Corner { obstacle, corner });
        }
    }
    if let Some((_, item)) = best {
        return Some(item);
    }
    if let Some((cable, _, _)) = cable_at(state, canvas, p, LINE_HIT_RADIUS) {
        return Some(Item::Cable(cable));
    }
    let (robot, world) = (robot_outline(state), state.view.camera.to_world(canvas, p));
    if inside(&robot, world) {
        return Some(Item::Robot);
    }
    // A robot of 30 points is missed by a point or two: beside it, where nothing else is, it is
    // picked as well.
    obstacle_at(state, canvas, p).or_else(|| {
        let reach = f64::from(LINE_HIT_RADIUS) / state.view.camera.points_per_m;
        let sides = robot.iter().zip(robot.iter().cycle().skip(1));
        let beside = sides.into_iter().any(|(&a, &b)| distance_to_segment(a, b, world) <= reach);
        beside.then_some(Item::Robot)
    })
}

/// The obstacle, or one of its corners, is selected.
#[must_use]
pub fn handles_shown(state: &AppState, index: usize) -> bool {
    match state.selection.selected {
        Some(Item::Obstacle(k)) => k == index,
        Some(Item::Corner { obstacle, .. }) => obstacle == index,
        _ => false,
    }
}

/// Returns how near counts as on a corner, points: less where corners are close, so that the body
/// can still be picked.
fn corner_reach(state: &AppState, points: &[Point], corner: usize) -> f32 {
    let Some(&p) = points.get(corner) else { return 0.0 };
    let neighbours = [corner.checked_sub(1), corner.checked_add(1)].into_iter().flatten().filter_map(|k| points.get(k));
    let nearest = neighbours.map(|q| (q[0] - p[0]).hypot(q[1] - p[1])).fold(f64::INFINITY, f64::min);
    ((0.35 * nearest * state.view.camera.points_per_m) as f32).clamp(3.0, CORNER_HIT_RADIUS)
}

fn corners(shape: &Shape) -> &[Point] {
    match shape {
        Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => points_m,
        Shape::Circle { .. } => &[],
    }
}

/// The nearest cable within reach (points): its index, the arc length there, the point there, m.
#[must_use]
pub fn cable_at(state: &AppState, canvas: Rect, p: Pos2, reach: f32) -> Option<(usize, f64, Point)> {
    let solution = state.live.snapshot.solution.as_ref()?;
    let world = state.view.camera.to_world(canvas, p);
    let mut best: Option<(f64, usize, f64, Point)> = None;
    for (k, cable) in solution.cables.iter().enumerate() {
        for pair in cable.pieces().flat_map(|p| p.windows(2)) {
            let (a, b) = ([pair[0].x_m, pair[0].y_m], [pair[1].x_m, pair[1].y_m]);
            let f = along(a, b, world);
            let q = [a[0] + (b[0] - a[0]) * f, a[1] + (b[1] - a[1]) * f];
            let d = (q[0] - world[0]).hypot(q[1] - world[1]);
            if best.is_none_or(|(least, ..)| d < least) {
                let s = pair[0].arc_length_m + (pair[1].arc_length_m - pair[0].arc_length_m) * f;
                best = Some((d, k, s, q));
            }
        }
    }
    let (d, k, s, q) = best?;
    (d * state.view.camera.points_per_m <= f64::from(reach)).then_some((k, s, q))
}

/// Arc length where a cable is nearest to a point, m.
#[must_use]
pub fn nearest_on(state: &AppState, cable: usize, p: Point) -> Option<f64> {
    let answer = state.live.snapshot.solution.as_ref()?.cables.get(cable)?;
    let mut best: Option<(f64, f64)> = None;
    for pair in answer.pieces().flat_map(|p| p.windows(2)) {
        let (a, b) = ([pair[0].x_m, pair[0].y_m], [pair[1].x_m, pair[1].y_m]);
        let f = along(a, b, p);
        let d = (a[0] + (b[0] - a[0]) * f - p[0]).hypot(a[1] + (b[1] - a[1]) * f - p[1]);
        if best.is_none_or(|(least, _)| d < least) {
            best = Some((d, pair[0].arc_length_m + (pair[1].arc_length_m - pair[0].arc_length_m) * f));
        }
    }
    best.map(|(_, s)| s)
}

/// Returns where on a segment (0 to 1) a point is nearest.
fn along(a: Point, b: Point, p: Point) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    let l2 = d[0] * d[0] + d[1] * d[1];
    if l2 > 0.0 { (((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / l2).clamp(0.0, 1.0) } else { 0.0 }
}

/// Distance of a point from a segment, m.
fn distance_to_segment(a: Point, b: Point, p: Point) -> f64 {
    let f = along(a, b, p);
    (a[0] + (b[0] - a[0]) * f - p[0]).hypot(a[1] + (b[1] - a[1]) * f - p[1])
}

/// The topmost obstacle under a point of the canvas.
fn obstacle_at(state: &AppState, canvas: Rect, p: Pos2) -> Option<Item> {
    let world = state.view.camera.to_world(canvas, p);
    let reach = f64::from(LINE_HIT_RADIUS) / state.view.camera.points_per_m;
    let near_line =
        |points: &[Point], reach: f64| points.windows(2).any(|s| distance_to_segment(s[0], s[1], world) <= reach);
    let hit = |shape: &Shape| match shape {
        // The solid below the ground fills half the window: only its surface can be picked.
        Shape::Terrain { points_m } => near_line(points_m, reach),
        Shape::Polygon { points_m } => inside(points_m, world) || near_line(points_m, reach),
        Shape::Circle { center_m, radius_m } => {
            (world[0] - center_m[0]).hypot(world[1] - center_m[1]) <= radius_m + reach
        }
        Shape::Polyline { points_m, thickness_m } => near_line(points_m, reach.max(0.5 * thickness_m)),
    };
    // The last drawn is on top.
    let k = state.document.scene.obstacles.iter().rposition(|o| hit(&o.shape))?;
    Some(Item::Obstacle(k))
}

/// Even–odd rule.
fn inside(points: &[Point], p: Point) -> bool {
    let n = points.len();
    (0..n)
        .filter(|&i| {
            let (a, b) = (points[i], points[(i + 1) % n]);
            (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1])
        })
        .count()
        % 2
        == 1
}
