//! The cables of this family run over, under and round posts, beams and wheels.

use crate::case::{Case, Expect, Point, apart, block, cable, fixed, flat, load_end, post, put, way, wheel};
use crate::chance::Chance;
use cable_core::scene::{STANDARD_GRAVITY, Scene, Shape, Support, catalog};

const D: f64 = 0.02;
const R: f64 = 0.5 * D;

/// A cable along a route, longer than it by a part.
fn along(r: &mut Chance, route: Vec<Point>, slack: f64) -> Scene {
    let (a, b) = (route[0], route[route.len() - 1]);
    let length = way(&route) * (1.0 + slack);
    let (w, stiff) = (r.scale(0.05, 10.0), r.scale(1e3, 1e6));
    let mut s = cable([length, w, w * STANDARD_GRAVITY * length * stiff, D], fixed([a, b]));
    s.cables[0].route_m = route;
    s
}

/// Points round a centre at a radius, from one angle to another, rad.
fn round(center: Point, radius: f64, [from, to]: [f64; 2]) -> Vec<Point> {
    let count = 2 + ((to - from).abs() / 0.2) as usize;
    (0..=count)
        .map(|k| {
            let angle = from + (to - from) * k as f64 / count as f64;
            [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
        })
        .collect()
}

fn passed(r: &mut Chance, side: f64) -> Case {
    let radius = r.scale(0.05, 1.0);
    let center = [r.within(3.0, 7.0), r.within(-1.0, 1.0)];
    let a = [0.0, center[1] - side * r.within(0.0, 3.0)];
    let b = [10.0, center[1] - side * r.within(0.0, 3.0)];
    let tight = radius + 1.5 * R;
    let turn = std::f64::consts::FRAC_PI_2;
    let mut route = vec![a];
    route.extend(round(center, 1.1 * tight, [side * (turn + 0.3), side * (turn - 0.3)]));
    route.push(b);
    // Under a post the cable has to be taut to stay on it: any slack leaves it, which is an answer,
    // too.
    let slack = if r.says(0.5) { r.within(-1e-4, 1e-3) } else { r.scale(1e-3, 0.3) };
    let mut s = along(r, route, slack);
    put(&mut s, post(center, radius), r.or_nothing(0.3, 0.05, 0.8));
    Case::rests(s)
}

pub fn over_post(r: &mut Chance) -> Case {
    passed(r, 1.0)
}

pub fn under_post(r: &mut Chance) -> Case {
    passed(r, -1.0)
}

pub fn round_post(r: &mut Chance) -> Case {
    let radius = r.scale(0.05, 1.0);
    let center = [5.0, 0.0];
    let turns = r.within(1.0, 2.5);
    let full = std::f64::consts::TAU;
    let start = std::f64::consts::FRAC_PI_2 + 0.5;
    let mut route = vec![[0.0, r.within(0.0, 3.0)]];
    route.extend(round(center, radius + R, [start, start - full * turns.floor() - 1.0]));
    route.push([10.0, r.within(0.0, 3.0)]);
    let slack = r.within(-1e-4, 2e-2);
    let mut s = along(r, route, slack);
    put(&mut s, post(center, radius), r.or_nothing(0.2, 0.05, 0.6));
    Case::rests(s)
}

pub fn beam(r: &mut Chance) -> Case {
    let count = 1 + r.one_of(3);
    let mut route = vec![[0.0, r.within(-2.0, 1.0)]];
    let mut boxes = Vec::new();
    for k in 0..count {
        let size = [r.within(0.1, 0.8), r.within(0.1, 0.8)];
        let corner = [10.0 * (k as f64 + r.within(0.3, 0.6)) / count as f64, r.within(0.0, 1.0)];
        route.extend([
            [corner[0] - R, corner[1] + size[1] + 1.2 * R],
            [corner[0] + size[0] + R, corner[1] + size[1] + 1.2 * R],
        ]);
        boxes.push(block(corner, size));
    }
    route.push([10.5, r.within(-2.0, 1.0)]);
    let slack = if r.says(0.5) { r.within(0.0, 1e-2) } else { r.scale(1e-2, 0.5) };
    let mut s = along(r, route, slack);
    let friction = r.or_nothing(0.3, 0.05, 0.8);
    for b in boxes {
        put(&mut s, b, friction);
    }
    if r.says(0.5) {
        put(&mut s, flat(-2.5, [-100.0, 100.0]), friction);
    }
    Case::rests(s)
}

pub fn slack(r: &mut Chance) -> Case {
    let far = r.scale(3.0, 20.0);
    let (a, b) = ([0.0, r.within(1.5, 3.0)], [far, r.within(1.5, 3.0)]);
    let length = (apart(a, b) + a[1] + b[1]) * (1.0 + r.scale(0.05, 3.0));
    let mut s = cable([length, r.scale(0.05, 10.0), r.scale(1e4, 1e8), D], fixed([a, b]));
    let friction = r.or_nothing(0.3, 0.05, 0.8);
    put(&mut s, flat(0.0, [-3.0 * length, 4.0 * length]), friction);
    for k in 0..=r.one_of(3) {
        let x = far * (k as f64 + r.within(0.3, 0.6)) / 3.0;
        let size = far * r.within(0.02, 0.08);
        let shape = if r.says(0.5) {
            post([x, size + r.within(0.0, 0.5)], size)
        } else {
            block([x, r.within(0.0, 0.5)], [size, size])
        };
        put(&mut s, shape, friction);
    }
    Case::rests(s)
}

/// A rope over a post with dead loads at both ends near e^{μθ} (L. Euler, 1769); nearly weightless.
pub fn capstan(r: &mut Chance) -> Case {
    let mu = r.within(0.05, 0.8);
    let radius = r.scale(0.05, 0.5);
    // Angles below the level in which the two ends leave.
    let (left, right) = (r.within(0.1, 1.4), r.within(0.1, 1.4));
    let part = r.pick(&[-0.03, -0.01, 0.01, 0.03]);
    let light = r.scale(10.0, 1e4);
    let heavy = light * (mu * (1.0 + part) * (left + right)).exp();
    let arm = 2.0;
    let length = 2.0 * arm + (left + right) * (radius + R);
    let (one, two) = if r.says(0.5) { (heavy, light) } else { (light, heavy) };
    let ways = [[-left.cos(), -left.sin()], [right.cos(), -right.sin()]];
    let top = std::f64::consts::FRAC_PI_2;
    let arc = round([0.0, 0.0], (radius + R) * 1.001, [top + left, top - right]);
    let end = |from: Point, way: Point| [from[0] + arm * way[0], from[1] + arm * way[1]];
    let mut route = vec![end(arc[0], ways[0])];
    route.extend(&arc);
    route.push(end(arc[arc.len() - 1], ways[1]));
    let pull = |way: Point, by: f64| [by * way[0], by * way[1]];
    let supports = vec![load_end("a", pull(ways[0], one)), load_end("b", pull(ways[1], two))];
    let mut s = cable([length, 1e-6, heavy * r.scale(1e3, 1e6), D], supports);
    s.cables[0].route_m = route;
    put(&mut s, post([0.0, 0.0], radius), mu);
    Case::new(s, if part < 0.0 { Expect::Rests } else { Expect::Slides })
}

pub fn buried(r: &mut Chance) -> Case {
    let far = r.scale(3.0, 20.0);
    let deep = r.pick(&[-R, -0.5 * R, 0.0, 0.5 * R, 0.1, 0.5]);
    let (a, b) = ([0.0, -deep], [far, r.within(0.5, 2.0)]);
    let length = apart(a, b) * (1.0 + r.scale(1e-3, 1.0));
    let mut s = cable([length, r.scale(0.1, 10.0), r.scale(1e4, 1e7), D], fixed([a, b]));
    match r.one_of(3) {
        0 => put(&mut s, flat(0.0, [-3.0 * length, 4.0 * length]), 0.4),
        1 => put(&mut s, block([-0.5, -1.0], [1.0, 1.0]), 0.4),
        _ => put(&mut s, post([0.0, -0.7], 0.7), 0.4),
    }
    Case::new(s, Expect::Perhaps)
}

pub fn tank(r: &mut Chance) -> Case {
    let mut s = catalog::tank();
    s.robot = None;
    let c = &mut s.cables[0];
    for p in &mut c.supports {
        if p.at_m.is_none() || p.motion.is_some() {
            p.motion = None;
        }
    }
    c.length_m *= r.within(0.9, 4.0);
    c.friction = r.within(0.1, 0.9);
    c.bending_stiffness_n_m2 = 0.0;
    let friction = r.within(0.1, 0.9);
    for o in &mut s.obstacles {
        o.friction = Some(friction);
    }
    if s.cables[0].supports.iter().any(|p| p.at_m.is_none()) {
        let last = s.cables[0].supports.len() - 1;
        let name = s.cables[0].supports[last].name.clone();
        s.cables[0].supports[last] = Support::free(name);
    }
    Case::new(s, Expect::Perhaps)
}

pub fn thin(r: &mut Chance) -> Case {
    let far = r.scale(3.0, 20.0);
    let (a, b) = ([0.0, r.within(0.5, 1.5)], [far, r.within(0.5, 1.5)]);
    let x = far * r.within(0.3, 0.7);
    let high = r.within(0.2, 3.0);
    let route = vec![a, [x, high + 0.05], b];
    let slack = r.scale(1e-3, 0.5);
    let mut s = along(r, route, slack);
    let friction = r.or_nothing(0.3, 0.05, 0.8);
    let points_m = vec![[x, -1.0], [x, high]];
    put(&mut s, Shape::Polyline { points_m, thickness_m: r.or_nothing(0.5, 0.005, 0.05) }, friction);
    put(&mut s, flat(0.0, [-20.0 * far, 20.0 * far]), friction);
    Case::rests(s)
}

fn over_wheels(r: &mut Chance, friction: fn(&mut Chance) -> f64) -> Case {
    let count = 1 + r.one_of(3);
    let far = r.scale(2.0, 50.0);
    let (a, b) = ([0.0, r.within(-1.0, 1.0)], [far, r.within(-1.0, 1.0)]);
    let mut supports = fixed([a, b]);
    let mut line = vec![a];
    for k in 0..count {
        let at = [far * (k as f64 + 1.0) / (count as f64 + 1.0), r.within(0.5, 3.0)];
        let radius = if r.says(0.4) { 0.0 } else { far * r.within(0.005, 0.03) };
        supports.insert(1 + k, wheel(&format!("w{k}"), at, radius, friction(r)));
        line.push(at);
    }
    line.push(b);
    let length = way(&line) * (1.0 + r.scale(1e-2, 0.3)) + 0.1 * far;
    Case::rests(cable([length, r.scale(0.1, 10.0), r.scale(1e5, 1e8), D], supports))
}

pub fn wheels(r: &mut Chance) -> Case {
    over_wheels(r, |_| 0.0)
}

pub fn rubbing_wheels(r: &mut Chance) -> Case {
    over_wheels(r, |r| r.within(0.01, 0.5))
}

pub fn self_contact(r: &mut Chance) -> Case {
    let far = r.scale(1.0, 10.0);
    let (a, b) = ([0.0, r.within(0.3, 2.0)], [far, r.within(0.3, 2.0)]);
    let length = apart(a, b) * (1.0 + r.scale(1e-3, 0.3)) + if r.says(0.5) { a[1] + b[1] } else { 0.0 };
    let mut s = cable([length, r.scale(0.1, 10.0), r.scale(1e4, 1e7), D], fixed([a, b]));
    s.cables[0].self_contact = true;
    s.cables[0].friction = 0.3;
    put(&mut s, flat(0.0, [-3.0 * length, 4.0 * length]), 0.4);
    Case::rests(s)
}
