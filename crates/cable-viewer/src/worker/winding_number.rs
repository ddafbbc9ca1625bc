//! Winding numbers tell whether a cable has passed an obstacle between two shapes of it.
//!
//! The two shapes and the moves of the ends enclose an area. An obstacle that stays where it is and
//! that the area goes round was passed: the cable cannot get from one shape to the other without
//! leading through it.

use cable_core::Simulation;
use cable_core::math::{Point, Vec2};
use cable_core::scene::{Obstacle, Shape};

/// Returns the cables (by number) that would have to pass an obstacle to get from one shape to
/// another.
#[must_use]
pub fn tunnelled_cables(old: &Simulation, new: &Simulation) -> Vec<usize> {
    let stays = |o: &&Obstacle| new.scene().obstacles.iter().any(|n| n.shape == o.shape);
    let points: Vec<Vec2> = old.scene().obstacles.iter().filter(stays).filter_map(|o| inner_point(&o.shape)).collect();
    if points.is_empty() {
        return Vec::new();
    }
    let shapes = old.states().into_iter().zip(new.states());
    let jumps = shapes.map(|(before, after)| {
        let mut loop_m = before.position_m;
        loop_m.extend(after.position_m.into_iter().rev());
        points.iter().any(|p| winding(&loop_m, *p) != 0)
    });
    jumps.enumerate().filter(|(_, jumps)| *jumps).map(|(k, _)| k).collect()
}

/// A point inside an obstacle that a cable can pass; ground cannot be passed.
fn inner_point(shape: &Shape) -> Option<Vec2> {
    let middle = |points: &[Point]| {
        let sum = points.iter().fold(Vec2::zeros(), |sum, p| sum + Vec2::new(p[0], p[1]));
        (!points.is_empty()).then(|| sum / points.len() as f64)
    };
    match shape {
        Shape::Circle { center_m, .. } => Some(Vec2::new(center_m[0], center_m[1])),
        Shape::Polygon { points_m } => middle(points_m),
        Shape::Polyline { points_m, .. } => middle(points_m.get(..2)?),
        Shape::Terrain { .. } => None,
    }
}

/// Returns how often a closed line goes round a point, anticlockwise.
fn winding(line: &[Vec2], about: Vec2) -> i32 {
    let next = line.iter().skip(1).chain(line.first());
    let crossings = line.iter().zip(next).map(|(a, b)| {
        let (a, b) = (a - about, b - about);
        let side = a.x * b.y - a.y * b.x;
        match (a.y <= 0.0, b.y <= 0.0) {
            (true, false) if side > 0.0 => 1,
            (false, true) if side < 0.0 => -1,
            _ => 0,
        }
    });
    crossings.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_goes_round_what_it_encloses() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|p: Point| Vec2::new(p[0], p[1]));
        assert_eq!(winding(&square, Vec2::new(1.0, 1.0)), 1);
        assert_eq!(winding(&square, Vec2::new(3.0, 1.0)), 0);
        let back: Vec<Vec2> = square.into_iter().rev().collect();
        assert_eq!(winding(&back, Vec2::new(1.0, 1.0)), -1);
    }
}
