//! The cables of this family have bending stiffness.

use crate::case::{Case, apart, block, cable, clamp, fixed, flat, load_end, put};
use crate::chance::Chance;
use cable_core::scene::{STANDARD_GRAVITY, Scene, Support};

const D: f64 = 0.03;
const R: f64 = 0.5 * D;

/// A stiff cable between two ends, longer than their distance by a part; EI from 1e-3 to 1e4 as the
/// scene's size bears it.
fn stiff(r: &mut Chance, supports: Vec<Support>, far: f64, slack: f64) -> Scene {
    let length = far * (1.0 + slack);
    let w = r.scale(0.1, 10.0);
    let mut s = cable([length, w, w * STANDARD_GRAVITY * length * r.scale(1e3, 1e6), D], supports);
    let q = w * STANDARD_GRAVITY;
    s.cables[0].bending_stiffness_n_m2 = (q * far.powi(3) * r.scale(1e-6, 1.0)).clamp(1e-3, 1e4);
    s
}

pub fn air(r: &mut Chance) -> Case {
    let far = r.scale(0.5, 50.0);
    let at = [[0.0, 0.0], [far, far * r.within(-0.6, 0.6)]];
    let slack = r.scale(1e-3, 1.0);
    Case::rests(stiff(r, fixed(at), apart(at[0], at[1]), slack))
}

pub fn clamped(r: &mut Chance) -> Case {
    let far = r.scale(1.0, 20.0);
    let at = [[0.0, r.within(0.3, 2.0)], [far, r.within(0.3, 2.0)]];
    let supports = vec![clamp("a", at[0], r.within(-45.0, 45.0)), clamp("b", at[1], r.within(-45.0, 45.0))];
    let slack = r.scale(1e-2, 0.4);
    let mut s = stiff(r, supports, apart(at[0], at[1]), slack);
    put(&mut s, flat(0.0, [-100.0, 200.0]), r.or_nothing(0.3, 0.1, 0.6));
    Case::rests(s)
}

pub fn ground(r: &mut Chance) -> Case {
    let far = r.scale(1.0, 40.0);
    let at = [[0.0, R + r.or_nothing(0.4, 0.0, 1.0)], [far, 0.1 + far * r.within(0.02, 0.4)]];
    let slack = r.scale(1e-3, 0.2);
    let mut s = stiff(r, fixed(at), apart(at[0], at[1]), slack);
    put(&mut s, flat(0.0, [-200.0, 300.0]), r.or_nothing(0.3, 0.1, 0.8));
    Case::rests(s)
}

fn post_at(r: &mut Chance) -> ([f64; 2], f64) {
    ([r.within(3.0, 7.0), r.within(0.0, 1.0)], r.scale(0.03, 0.8))
}

pub fn post(r: &mut Chance) -> Case {
    let (center, radius) = post_at(r);
    let top = [center[0], center[1] + radius + 1.2 * R];
    let (a, b) = ([0.0, center[1] - r.within(0.0, 2.0)], [10.0, center[1] - r.within(0.0, 2.0)]);
    let slack = r.scale(1e-3, 0.1);
    let mut s = stiff(r, fixed([a, b]), apart(a, top) + apart(top, b), slack);
    s.cables[0].route_m = vec![a, [top[0] - radius, top[1]], [top[0] + radius, top[1]], b];
    put(&mut s, crate::case::post(center, radius), r.or_nothing(0.3, 0.1, 0.5));
    Case::rests(s)
}

pub fn corner(r: &mut Chance) -> Case {
    let x = r.within(2.0, 6.0);
    let wide = r.within(0.2, 2.0);
    let (a, b) = ([0.0, -r.within(0.0, 2.0)], [10.0, -r.within(0.0, 2.0)]);
    let top = 0.5;
    let route = vec![a, [x - R, top + 1.2 * R], [x + wide + R, top + 1.2 * R], b];
    let slack = r.scale(1e-3, 0.1);
    let mut s = stiff(r, fixed([a, b]), crate::case::way(&route), slack);
    s.cables[0].route_m = route;
    put(&mut s, block([x, top - 1.0], [wide, 1.0]), r.or_nothing(0.3, 0.1, 0.5));
    Case::rests(s)
}

pub fn free_end(r: &mut Chance) -> Case {
    let length = r.scale(0.5, 10.0);
    let high = r.within(0.1, 2.0);
    let start =
        if r.says(0.6) { clamp("a", [0.0, high], r.within(-80.0, 80.0)) } else { Support::fixed("a", [0.0, high]) };
    let end = if r.says(0.6) { Support::free("b") } else { load_end("b", [r.within(-5.0, 5.0), -r.within(0.0, 10.0)]) };
    let mut s = stiff(r, vec![start, end], length, 0.0);
    if r.says(0.6) {
        put(&mut s, flat(0.0, [-100.0, 100.0]), r.within(0.2, 0.8));
    }
    Case::rests(s)
}
