//! Queries are compared with a search of everything, and sweeps with exact crossing times.

#[path = "../../tests/dice/mod.rs"]
mod dice;

use super::*;
use crate::contact::sweep::WayEnd;
use crate::math::{Point, cross, vec2};
use crate::scene::Shape;
use dice::MmixDice;

const RADIUS: f64 = 0.014;

/// A point in a square of a size (m) at an offset (m).
fn point(dice: &mut MmixDice, half: f64, offset: f64) -> Vec2 {
    Vec2::new(offset + dice.within(-half, half), offset + dice.within(-half, half))
}

fn obstacle(shape: Shape) -> Obstacle {
    Obstacle { name: String::new(), shape, friction: None }
}

fn terrain(points: &[Point]) -> Shape {
    Shape::Terrain { points_m: points.to_vec() }
}

/// A rugged ground, a beam, a star with reflex corners, a post and a thin zigzag, all shifted by
/// `o`.
fn yard(o: f64) -> Vec<Obstacle> {
    let at = |p: [f64; 2]| [p[0] + o, p[1] + o];
    let mut dice = MmixDice(7);
    let ground: Vec<Point> =
        (0..=40).map(|i| at([-10.0 + 0.5 * f64::from(i), -6.0 + dice.within(-1.0, 1.0)])).collect();
    let star: Vec<Point> = (0..10)
        .map(|i| {
            let (a, r) = (std::f64::consts::PI * f64::from(i) / 5.0, if i % 2 == 0 { 1.5 } else { 0.5 });
            at([5.0 + r * a.cos(), r * a.sin()])
        })
        .collect();
    vec![
        obstacle(terrain(&ground)),
        obstacle(Shape::Polygon { points_m: [[-2.0, 1.0], [-2.0, 1.05], [1.0, 1.05], [1.0, 1.0]].map(at).to_vec() }),
        obstacle(Shape::Polygon { points_m: star }),
        obstacle(Shape::Circle { center_m: at([-5.0, 0.0]), radius_m: 0.8 }),
        obstacle(Shape::Polyline {
            points_m: [[-3.0, 4.0], [-1.0, 5.0], [0.0, 3.5], [3.0, 4.5]].map(at).to_vec(),
            thickness_m: 0.002,
        }),
    ]
}

fn inside_polygon(p: Vec2, points: &[Point]) -> bool {
    let n = points.len();
    (0..n).fold(false, |odd, i| {
        let (a, b) = (vec2(points[i]), vec2(points[(i + 1) % n]));
        let hit = (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y);
        odd != hit
    })
}

/// Signed gap (m) by a search of everything, with the inside decided by crossing parity.
fn brute(p: Vec2, obstacles: &[Obstacle]) -> f64 {
    let line = |points: &[Point], closed: bool| {
        let n = points.len();
        (0..if closed { n } else { n - 1 })
            .map(|i| distance::point_segment(p, vec2(points[i]), vec2(points[(i + 1) % n])))
            .fold(f64::INFINITY, f64::min)
    };
    obstacles
        .iter()
        .map(|o| match &o.shape {
            Shape::Circle { center_m, radius_m } => (p - vec2(*center_m)).norm() - radius_m,
            Shape::Polyline { points_m, thickness_m } => line(points_m, false) - thickness_m / 2.0,
            Shape::Polygon { points_m } => {
                if inside_polygon(p, points_m) {
                    -line(points_m, true)
                } else {
                    line(points_m, true)
                }
            }
            Shape::Terrain { points_m } => {
                let under = points_m.windows(2).any(|w| {
                    let (a, b) = (vec2(w[0]), vec2(w[1]));
                    a.x <= p.x && p.x < b.x && cross(b - a, p - a) < 0.0
                });
                if under { -line(points_m, false) } else { line(points_m, false) }
            }
        })
        .fold(f64::INFINITY, f64::min)
        - RADIUS
}

#[test]
fn signed_gaps_agree_with_brute_force_near_and_far() {
    for offset in [0.0, 1e7] {
        let obstacles = yard(offset);
        let world = World::new(&obstacles, 0.5, RADIUS);
        let (mut dice, tolerance) = (MmixDice(1), 1e-12 + 8.0 * f64::EPSILON * offset);
        for _ in 0..50_000 {
            let p = point(&mut dice, 9.5, offset);
            let g = world.signed_gap(p, 30.0).unwrap();
            // Beyond a terrain's end "below" has no meaning for the brute force; the yard's ends
            // are at ±10.
            let expected = brute(p, &obstacles);
            assert!((g.gap_m - expected).abs() <= tolerance, "{p} {g:?} {expected}");
            assert!((g.normal.norm() - 1.0).abs() < 1e-12);
            let step = 1e-4;
            if g.gap_m.abs() > 0.01 && offset == 0.0 {
                let further = world.signed_gap(p + g.normal * step, 30.0).unwrap().gap_m;
                assert!(further <= g.gap_m + step + 1e-12, "a gap grows no faster than the way");
            }
        }
    }
}

#[test]
fn reach_hides_what_is_farther() {
    let world = World::new(&[obstacle(terrain(&[[-1.0, 0.0], [1.0, 0.0]]))], 0.5, RADIUS);
    assert!(world.signed_gap(Vec2::new(0.0, 0.1 + RADIUS), 0.0999).is_none());
    let g = world.signed_gap(Vec2::new(0.0, 0.1 + RADIUS), 0.1001).unwrap();
    assert!((g.gap_m - 0.1).abs() < 1e-15 && g.normal == Vec2::y() && g.friction == 0.5);
}

#[test]
fn either_winding_gives_the_same_polygon() {
    let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut reversed = points.clone();
    reversed.reverse();
    for p in [points, reversed] {
        let world = World::new(&[obstacle(Shape::Polygon { points_m: p })], 0.5, RADIUS);
        assert!((world.signed_gap(Vec2::new(0.5, 0.9), 1.0).unwrap().gap_m + 0.1 + RADIUS).abs() < 1e-15);
        assert!((world.signed_gap(Vec2::new(0.5, 1.1), 1.0).unwrap().gap_m - 0.1 + RADIUS).abs() < 1e-15);
    }
}

#[test]
fn degenerate_obstacles_are_dropped_without_a_panic() {
    let shapes = [
        terrain(&[]),
        terrain(&[[0.0, 0.0]]),
        terrain(&[[0.0, 0.0], [0.0, 0.0]]),
        terrain(&[[0.0, f64::NAN], [1.0, 0.0]]),
        Shape::Polygon { points_m: vec![[0.0, 0.0], [1.0, 0.0]] },
        Shape::Polygon { points_m: vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]] },
        Shape::Polyline { points_m: vec![[3.0, 0.0]; 4], thickness_m: 0.01 },
    ];
    let world = World::new(&shapes.map(obstacle), 0.5, RADIUS);
    assert!(world.is_empty());
    assert_eq!(world.signed_gap(Vec2::zeros(), 1e3), None);
    assert_eq!(world.free_fraction([Vec2::zeros(); 2], [Vec2::x(); 2], 0.2), 1.0);
}

#[test]
fn corners_that_do_not_turn_are_not_felt() {
    let world = World::new(&[obstacle(terrain(&[[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]))], 0.5, RADIUS);
    let mut out = Vec::new();
    world.segment_gaps(Vec2::new(-0.4, RADIUS), Vec2::new(0.6, RADIUS), 1e-3, &mut out);
    assert_eq!(out.iter().map(|g| g.fraction).collect::<Vec<_>>(), [0.0, 1.0]);
}

/// Smallest distance of a segment from everything, less the offset, and the smallest over its
/// reported pairs.
#[test]
fn the_nearest_pair_is_the_gap_of_the_segment() {
    let obstacles = yard(0.0);
    let world = World::new(&obstacles, 0.5, RADIUS);
    let (mut dice, mut out, mut met) = (MmixDice(3), Vec::new(), 0);
    for _ in 0..100_000 {
        let a = point(&mut dice, 9.0, 0.0);
        let b = a + point(&mut dice, 0.5, 0.0);
        out.clear();
        world.segment_gaps(a, b, 0.3, &mut out);
        let mut nearest = f64::INFINITY;
        for body in world.geometry().bodies() {
            for e in body.edges.iter() {
                nearest = nearest.min(distance::segment_segment(a, b, e.from, e.to) - body.offset);
            }
            if let Some(c) = body.center {
                nearest = nearest.min(distance::point_segment(c, a, b) - body.offset);
            }
        }
        // Inside a solid or across an edge, pairs have no meaning.
        let outside = |p: Vec2| brute(p, &obstacles) > -RADIUS;
        if nearest > -RADIUS && nearest < 0.299 && outside(a) && outside(b) {
            met += 1;
            let found = out.iter().map(|g| g.gap_m).fold(f64::INFINITY, f64::min);
            assert!((found - nearest).abs() < 1e-12, "{a} {b}: {found} {nearest}");
        }
    }
    assert!(met > 3000, "{met}");
}

/// The barrier's view: the weighted sum of a smooth function of the pairs' gaps is continuous as a
/// bent chain moves.
#[test]
fn pair_sums_have_no_jump() {
    let world = World::new(&yard(0.0), 0.5, RADIUS);
    let reach = 0.2;
    let energy = |x: &[Vec2; 3]| {
        let mut sum = 0.0;
        let mut add = |p: obstacle_pairs::Pair| sum += p.weight * (reach - p.gap.gap_m).powi(2);
        let g = world.geometry();
        g.node_pairs(None, x[0], Some(x[1]), reach, &mut add);
        g.node_pairs(Some(x[0]), x[1], Some(x[2]), reach, &mut add);
        g.node_pairs(Some(x[1]), x[2], None, reach, &mut add);
        g.segment_pairs(x[0], x[1], reach, &mut add);
        g.segment_pairs(x[1], x[2], reach, &mut add);
        sum
    };
    let mut dice = MmixDice(11);
    let (mut worst, steps) = (0.0f64, 400);
    for _ in 0..400 {
        let start = point(&mut dice, 8.0, 0.0);
        let x0 = [start, start + point(&mut dice, 0.4, 0.0), start + point(&mut dice, 0.6, 0.0)];
        let move_ = [point(&mut dice, 0.05, 0.0), point(&mut dice, 0.05, 0.0), point(&mut dice, 0.05, 0.0)];
        let at = |t: f64| [x0[0] + move_[0] * t, x0[1] + move_[1] * t, x0[2] + move_[2] * t];
        // A node that crosses an edge flips normals but not distances, and only distances are
        // summed here.
        let e: Vec<f64> = (0..=steps).map(|i| energy(&at(f64::from(i) / f64::from(steps)))).collect();
        for w in e.windows(2) {
            worst = worst.max((w[1] - w[0]).abs());
        }
    }
    // One step moves a point by at most 0.07/400 m, which changes one term by 2·(reach +
    // RADIUS)·that = 8e-5.
    assert!(worst < 8.0 * 8e-5, "{worst}");
}

/// A node meets the corner of a boundary, and the corner meets the node; each bar that meets the
/// corner with its inside takes such a part of the node's.
#[test]
fn a_node_meets_a_corner_less_the_bars_that_do() {
    let ground = [[-5.0, -1.0], [0.0, 0.0], [5.0, -1.0]];
    let world = World::new(&[obstacle(terrain(&ground))], 0.5, 0.0);
    let node = Vec2::new(0.0, 0.05);
    let weight = |before: Option<Vec2>, after: Option<Vec2>| {
        let mut sum = 0.0;
        world.geometry().node_pairs(before, node, after, 0.1, &mut |p| sum += p.weight);
        sum
    };
    let (up, down) = (Some(Vec2::new(0.1, 1.0)), Some(Vec2::new(1.0, -0.5)));
    assert_eq!(weight(None, None), 2.0);
    assert_eq!((weight(up, None), weight(None, up), weight(up, up)), (2.0, 2.0, 2.0));
    assert_eq!((weight(down, None), weight(down, up), weight(down, down)), (1.0, 1.0, 0.0));
}

/// First time in (0, 1) at which the moving segment touches an edge: an end reaches the edge, or an
/// end of the edge reaches the segment. Exact roots, no search.
fn first_crossing(from: [Vec2; 2], to: [Vec2; 2], p: Vec2, q: Vec2) -> Option<f64> {
    let (da, db) = (to[0] - from[0], to[1] - from[1]);
    let mut best: Option<f64> = None;
    let mut hit = |t: f64| {
        if (0.0..=1.0).contains(&t) && best.is_none_or(|b| t < b) {
            best = Some(t);
        }
    };
    for (x, d) in [(from[0], da), (from[1], db)] {
        let rate = cross(q - p, d);
        let t = -cross(q - p, x - p) / rate;
        let y = x + d * t;
        if rate != 0.0 && (y - p).dot(&(q - p)) >= 0.0 && (y - q).dot(&(q - p)) <= 0.0 {
            hit(t);
        }
    }
    for v in [p, q] {
        let (e0, de, w0) = (from[1] - from[0], db - da, v - from[0]);
        let (c2, c1, c0) = (cross(de, -da), cross(e0, -da) + cross(de, w0), cross(e0, w0));
        let disc = c1 * c1 - 4.0 * c2 * c0;
        let roots = if c2.abs() < 1e-14 {
            [-c0 / c1, f64::NAN]
        } else {
            [(-c1 - disc.sqrt()) / (2.0 * c2), (-c1 + disc.sqrt()) / (2.0 * c2)]
        };
        for t in roots {
            let (a, b) = (from[0] + da * t, from[1] + db * t);
            if (v - a).dot(&(b - a)) >= 0.0 && (v - b).dot(&(b - a)) <= 0.0 {
                hit(t);
            }
        }
    }
    best
}

#[test]
fn sweeps_never_cross_anything() {
    let world = World::new(&yard(0.0), 0.5, RADIUS);
    let mut dice = MmixDice(5);
    let (mut stopped, mut blocked) = (0, 0);
    for round in 0..100_000 {
        // A third of the moves are 10 m long, a third are short, and a third are tiny.
        let reach = [10.0, 0.3, 1e-3][round % 3];
        let a = point(&mut dice, 9.0, 0.0);
        let from = [a, a + point(&mut dice, 0.3, 0.0)];
        let to = [from[0] + point(&mut dice, reach, 0.0), from[1] + point(&mut dice, reach, 0.0)];
        let f = world.free_fraction(from, to, 0.2);
        assert!((0.0..=1.0).contains(&f));
        let end = [from[0] + (to[0] - from[0]) * f, from[1] + (to[1] - from[1]) * f];
        for body in world.geometry().bodies() {
            for e in body.edges.iter() {
                let before = distance::segment_segment(from[0], from[1], e.from, e.to);
                let after = distance::segment_segment(end[0], end[1], e.from, e.to);
                if before <= 0.0 {
                    continue;
                }
                if before > body.offset + 1e-9 {
                    assert!(after - body.offset >= 0.2 * (before - body.offset) - 1e-12, "{before} {after}");
                }
                if let Some(t) = first_crossing(from, to, e.from, e.to) {
                    blocked += 1;
                    assert!(f < t, "free {f} but crosses at {t}");
                }
            }
        }
        stopped += usize::from(f < 1.0);
    }
    assert!(stopped > 10_000 && blocked > 10_000, "{stopped} {blocked}");
}

#[test]
fn advancement_gives_most_of_the_free_way() {
    let world = World::new(&[obstacle(terrain(&[[-9.0, 0.0], [9.0, 0.0]]))], 0.5, RADIUS);
    // The segment moves down by 2 m from 1 m above contact: 0.8 of the gap, 0.4 of the move, may be
    // used.
    let (a, b) = (Vec2::new(0.0, 1.0 + RADIUS), Vec2::new(1.0, 1.0 + RADIUS));
    let down = Vec2::new(0.0, -2.0);
    assert!((world.free_fraction([a, b], [a + down, b + down], 0.2) - 0.4).abs() < 1e-9);
    // A move up or along is free, and so is no move.
    assert_eq!(world.free_fraction([a, b], [a - down, b - down], 0.2), 1.0);
    assert_eq!(world.free_fraction([a, b], [a, b], 0.2), 1.0);
    // The same holds a micrometre above the ground, and if the segment descends meanwhile, as far
    // as that allows.
    let low = |p: Vec2| Vec2::new(p.x, RADIUS + 1e-6);
    let along = Vec2::new(3.0, 0.0);
    assert_eq!(world.free_fraction([low(a), low(b)], [low(a) + along, low(b) + along], 0.2), 1.0);
    let slanting = along + Vec2::new(0.0, -1e-6);
    let free = world.free_fraction([low(a), low(b)], [low(a) + slanting, low(b) + slanting], 0.2);
    assert!((free - 0.8).abs() < 1e-6, "{free}");
    // A move to NaN is never free.
    assert_eq!(world.free_fraction([a, b], [a * f64::NAN, b], 0.2), 0.0);
}

#[test]
fn ten_metres_in_a_step_do_not_pass_a_beam_or_a_thin_line() {
    let beam = obstacle(Shape::Polygon { points_m: vec![[5.0, -1.0], [5.05, -1.0], [5.05, 1.0], [5.0, 1.0]] });
    let line = obstacle(Shape::Polyline { points_m: vec![[5.0, -1.0], [5.0, 1.0]], thickness_m: 0.0 });
    for o in [beam, line] {
        for far in [0.0, 1e6] {
            let shifted = match &o.shape {
                Shape::Polygon { points_m } => {
                    Shape::Polygon { points_m: points_m.iter().map(|p| [p[0] + far, p[1]]).collect() }
                }
                Shape::Polyline { points_m, thickness_m } => Shape::Polyline {
                    points_m: points_m.iter().map(|p| [p[0] + far, p[1]]).collect(),
                    thickness_m: *thickness_m,
                },
                other => other.clone(),
            };
            let world = World::new(&[obstacle(shifted)], 0.5, RADIUS);
            let step = Vec2::new(10.0, 0.0);
            // The segment moves end on, broadside, and with one end that swings.
            for (a, b, to_b) in [
                (Vec2::new(0.0, 0.0), Vec2::new(-1.0, 0.0), Vec2::new(9.0, 0.0)),
                (Vec2::new(0.0, -0.5), Vec2::new(0.0, 0.5), Vec2::new(10.0, 0.5)),
                (Vec2::new(0.0, 0.0), Vec2::new(-1.0, 0.3), Vec2::new(-1.0, 0.3)),
            ] {
                let o = Vec2::new(far, 0.0);
                let f = world.free_fraction([a + o, b + o], [a + step + o, to_b + o], 0.2);
                assert!(f > 0.39 && f * 10.0 < 5.0 - RADIUS, "{f}");
            }
        }
    }
}

/// A sweep that is bounded by the speed of the ends of the bar stops long before: most of the gap
/// was left after 48 advances, and a cable that a hand draws round a corner went a hundredth of its
/// way in each iteration.
#[test]
fn a_bar_that_slides_and_turns_about_a_post_is_free_until_its_gap_is_half() {
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: 0.05 };
    let world = World::new(&[Obstacle { name: "post".to_owned(), shape, friction: None }], 0.5, RADIUS);
    let mut dice = MmixDice(11);
    let mut cut = 0;
    for _ in 0..2000 {
        let gap = 10f64.powf(-6.0 + 3.0 * dice.unit());
        let y = 0.05 + RADIUS + gap;
        let from = [Vec2::new(-0.02 - 0.2 * dice.unit(), y), Vec2::new(0.02 + 0.2 * dice.unit(), y)];
        // The bar moves along itself, turns, and rises a little, as a taut cable does that slides
        // round a corner.
        let along = Vec2::new(0.03 * (dice.unit() - 0.5), gap * dice.unit());
        let turn = 0.02 * (dice.unit() - 0.5);
        let go = [along - Vec2::y() * turn * from[0].x.abs(), along + Vec2::y() * turn * from[1].x.abs()];
        let free = world.free_fraction(from, [from[0] + go[0], from[1] + go[1]], 0.5);
        let gap_at =
            |t: f64| distance::point_segment(Vec2::zeros(), from[0] + go[0] * t, from[1] + go[1] * t) - 0.05 - RADIUS;
        let first = (0..=20_000).map(|k| f64::from(k) / 20_000.0).find(|&t| gap_at(t) < 0.5 * gap).unwrap_or(1.0);
        assert!(free <= first + 1e-12 && gap_at(free) >= 0.5 * gap - 1e-12, "{free} {first}");
        // Two hundredths of the gap may be given away; if the gap closes with the square of the
        // displacement, one hundredth of the displacement.
        assert!(free > 0.97 * first - 1e-4, "{free} of {first}, gap {gap:e}");
        cut += usize::from(first < 1.0);
    }
    assert!(cut > 300, "{cut}");
}

/// An end that touches the ground is not in its own way, in either direction; a hill of that ground
/// is, and so is a beam that the way crosses.
#[test]
fn a_way_is_blocked_by_what_it_crosses_and_not_by_what_its_ends_touch() {
    let ground = obstacle(terrain(&[[-9.0, 0.0], [2.0, 0.0], [3.0, 0.8], [4.0, 0.0], [9.0, 0.0]]));
    let points_m = vec![[-6.0, 0.3], [-5.0, 0.3], [-5.0, 3.0], [-6.0, 3.0]];
    let world = World::new(&[ground, obstacle(Shape::Polygon { points_m })], 0.5, RADIUS);
    let between = |a: [f64; 2], b: [f64; 2]| {
        let ways =
            [(a, b), (b, a)].map(|(a, b)| world.geometry().bodies_between([a.into(), b.into()], [WayEnd::Support; 2]));
        assert_eq!(ways[0], ways[1], "{a:?} to {b:?}");
        ways[0].clone()
    };
    assert!(between([-2.0, 1.0], [1.0, RADIUS]).is_empty());
    assert!(between([-2.0, RADIUS], [1.0, RADIUS]).is_empty());
    assert_eq!(between([1.0, RADIUS], [8.0, 0.3]), [0]);
    assert_eq!(between([-8.0, 1.0], [1.0, RADIUS]), [1]);
    assert_eq!(between([-8.0, 0.6], [8.0, 0.3]), [0, 1]);
}
