//! The cables of this family are seen from above.

use crate::case::{Case, Point, apart, block, cable, fixed, post, put, way};
use crate::chance::Chance;
use cable_core::scene::{STANDARD_GRAVITY, Scene, Shape, Support, View};

const D: f64 = 0.02;

fn seen_from_above(r: &mut Chance, supports: Vec<Support>, length: f64) -> Scene {
    let w = r.scale(0.05, 10.0);
    let mut s = cable([length, w, w * STANDARD_GRAVITY * length * r.scale(1e3, 1e6), D], supports);
    s.view = View::Plan;
    s.cables[0].friction = r.or_nothing(0.25, 0.05, 1.0);
    s
}

fn ends(r: &mut Chance) -> [Point; 2] {
    [[0.0, r.within(-1.0, 1.0)], [10.0, r.within(-1.0, 1.0)]]
}

pub fn slack(r: &mut Chance) -> Case {
    let at = ends(r);
    let slack = if r.says(0.3) { r.within(-1e-3, 0.0) } else { r.scale(1e-4, 2.0) };
    let mut s = seen_from_above(r, fixed(at), apart(at[0], at[1]) * (1.0 + slack));
    if r.says(0.3) {
        s.cables[0].route_m = vec![at[0], [5.0, r.within(-2.0, 2.0)], at[1]];
    }
    Case::rests(s)
}

/// A box about a centre, m.
fn square(center: [f64; 2], size: f64) -> Shape {
    block(center.map(|c| c - size), [2.0 * size; 2])
}

/// A cable laid past things at the given places.
fn past(r: &mut Chance, shape: fn([f64; 2], f64) -> Shape) -> Case {
    let at = ends(r);
    let mut route = vec![at[0]];
    let mut shapes = Vec::new();
    let count = 1 + r.one_of(3);
    for k in 0..count {
        let x = 10.0 * (k as f64 + r.within(0.3, 0.7)) / count as f64;
        let size = r.within(0.1, 0.5);
        let y = r.within(-1.0, 1.0);
        let side = if r.says(0.5) { 1.0 } else { -1.0 };
        let beside = y + side * (size + 2.0 * D);
        route.extend([[x - size, beside], [x + size, beside]]);
        shapes.push(shape([x, y], size));
    }
    route.push(at[1]);
    let slack = if r.says(0.5) { r.within(-1e-4, 1e-3) } else { r.scale(1e-3, 0.3) };
    let mut s = seen_from_above(r, fixed(at), way(&route) * (1.0 + slack));
    s.cables[0].route_m = route;
    let friction = r.or_nothing(0.25, 0.05, 0.8);
    for shape in shapes {
        put(&mut s, shape, friction);
    }
    Case::rests(s)
}

pub fn posts(r: &mut Chance) -> Case {
    past(r, post)
}

pub fn boxes(r: &mut Chance) -> Case {
    past(r, square)
}

pub fn free_end(r: &mut Chance) -> Case {
    let mut case = past(r, post);
    let c = case.cable();
    let last = c.supports.len() - 1;
    c.supports[last] = Support::free("b");
    c.friction = c.friction.max(0.1);
    case
}
