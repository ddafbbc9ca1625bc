//! The cables of this family lie on ground.

use crate::case::{Case, Expect, Point, apart, cable, fixed, flat, load, load_end, put, terrain, way};
use crate::chance::Chance;
use crate::closed::{mooring, plumb};
use cable_core::Model;
use cable_core::scene::{STANDARD_GRAVITY, Scene, Support};

const D: f64 = 0.02;
const R: f64 = 0.5 * D;

fn moored(r: &mut Chance, friction: f64, extra: f64) -> (Scene, Point) {
    let high = r.scale(0.5, 100.0);
    let far = high * r.within(1.0, 8.0);
    let straight = far.hypot(high);
    let length = straight + extra * (far + high - straight);
    let w = r.scale(0.1, 50.0);
    let ea = w * STANDARD_GRAVITY * length * r.scale(30.0, 1e5);
    let mut s = cable([length, w, ea, D], fixed([[0.0, R], [far, high]]));
    put(&mut s, flat(0.0, [-far - length, 2.0 * far + length]), friction);
    (s, [far, high - R])
}

pub fn smooth_mooring(r: &mut Chance) -> Case {
    let extra = r.within(0.0, 1.1);
    let (s, at) = moored(r, 0.0, extra);
    let c = &s.cables[0];
    match mooring(at, c.length_m, c.linear_density_kg_per_m * STANDARD_GRAVITY, c.axial_stiffness_n) {
        Some(forces) => Case::new(s, Expect::Forces(forces, 1e-5)),
        None => Case::rests(s),
    }
}

pub fn rough_mooring(r: &mut Chance) -> Case {
    let (extra, friction) = (r.within(0.0, 1.0), r.within(0.05, 1.2));
    Case::rests(moored(r, friction, extra).0)
}

pub fn slack_mooring(r: &mut Chance) -> Case {
    let (extra, friction) = (r.within(1.0, 3.0), r.or_nothing(0.3, 0.05, 1.2));
    let (s, at) = moored(r, friction, extra);
    let c = &s.cables[0];
    let w = c.linear_density_kg_per_m * STANDARD_GRAVITY;
    let hangs = plumb(at[1], w, c.axial_stiffness_n);
    if hangs + at[0] <= c.length_m && friction > 0.0 {
        return Case::new(s, Expect::Forces([[0.0; 2], [0.0, -w * hangs]], 1e-6));
    }
    Case::rests(s)
}

/// A plane of the given tilt under x from 0 on.
fn slope(tilt: f64, far: f64) -> [Point; 2] {
    [[-far, -tilt * far], [2.0 * far, 2.0 * tilt * far]]
}

/// A point on a slope, the cable's centre line on it.
fn on(tilt: f64, x: f64) -> Point {
    let n = 1.0_f64.hypot(tilt);
    [x - R * tilt / n, tilt * x + R / n]
}

pub fn sloped_mooring(r: &mut Chance) -> Case {
    let far = r.scale(2.0, 200.0);
    let tilt = r.within(-0.5, 0.5);
    let friction = r.or_nothing(0.3, 0.05, 1.2);
    let a = on(tilt, 0.0);
    let b = [far, tilt * far + far * r.within(0.1, 0.5)];
    let over = apart(a, on(tilt, far)) + apart(on(tilt, far), b);
    let length = apart(a, b) + r.within(0.0, 0.95) * (over - apart(a, b)) + 1e-3 * far;
    let w = r.scale(0.1, 50.0);
    let mut s = cable([length, w, w * length * r.scale(300.0, 1e6), D], fixed([a, b]));
    put(&mut s, terrain(slope(tilt, 3.0 * (far + length)).to_vec()), friction);
    Case::rests(s)
}

pub fn slack_floor(r: &mut Chance) -> Case {
    let far = r.scale(0.5, 30.0);
    let (a, b) = ([0.0, R + r.scale(1e-3, 3.0)], [far, R + r.scale(1e-3, 3.0)]);
    let friction = r.or_nothing(0.3, 0.05, 1.0);
    let length = (far + a[1] + b[1]) * (1.0 + r.scale(1e-3, 4.0));
    let (w, ea) = (r.scale(0.05, 10.0), r.scale(1e4, 1e8));
    let mut s = cable([length, w, ea, D], fixed([a, b]));
    put(&mut s, flat(0.0, [-3.0 * length, 4.0 * length]), friction);
    let q = w * STANDARD_GRAVITY;
    let hangs = [a, b].map(|p| plumb(p[1] - R, q, ea));
    Case::new(s, Expect::Forces(hangs.map(|h| [0.0, -q * h]), 1e-6))
}

pub fn ends_on_ground(r: &mut Chance) -> Case {
    let far = r.scale(0.5, 30.0);
    let height = r.pick(&[0.0, R, 0.5 * R, 2.0 * R]);
    let other = if r.says(0.5) { height } else { r.within(0.1, 3.0) };
    let (a, b) = ([0.0, height], [far, other]);
    let length = apart(a, b) * (1.0 + if r.says(0.3) { r.scale(1e-5, 1e-2) } else { r.scale(1e-2, 3.0) });
    let mut s = cable([length, r.scale(0.05, 10.0), r.scale(1e4, 1e8), D], fixed([a, b]));
    put(&mut s, flat(0.0, [-3.0 * length, 4.0 * length]), r.or_nothing(0.3, 0.05, 1.0));
    Case::rests(s)
}

pub fn above(r: &mut Chance) -> Case {
    let high = r.scale(0.3, 10.0);
    let low = R + r.or_nothing(0.3, 0.0, 2.0);
    let aside = if r.says(0.5) { 0.0 } else { r.scale(1e-9, 0.3) };
    let length = high * (1.0 + r.scale(1e-3, 5.0)) + aside;
    let mut at = [[0.0, low + high], [aside, low]];
    if r.says(0.3) {
        at.swap(0, 1);
    }
    let mut s = cable([length, r.scale(0.05, 10.0), r.scale(1e4, 1e8), D], fixed(at));
    put(&mut s, flat(0.0, [-3.0 * length, 4.0 * length]), r.or_nothing(0.3, 0.05, 1.0));
    Case::rests(s)
}

/// Ground of corners under two ends above its outer ones.
fn over(r: &mut Chance, ground: Vec<Point>, slack: f64, friction: f64) -> Case {
    let n = ground.len();
    let (p, q) = (ground[1], ground[n - 2]);
    let (a, b) = ([p[0], p[1] + 0.05 + r.scale(0.02, 3.0)], [q[0], q[1] + 0.05 + r.scale(0.02, 3.0)]);
    let mut line = vec![a];
    line.extend(&ground[1..n - 1]);
    line.push(b);
    let length = apart(a, b) + (way(&line) - apart(a, b)).max(0.02 * apart(a, b)) * slack;
    let mut s = cable([length, r.scale(0.05, 10.0), r.scale(1e4, 1e8), D], fixed([a, b]));
    put(&mut s, terrain(ground), friction);
    Case::rests(s)
}

pub fn pits(r: &mut Chance) -> Case {
    let far = r.scale(1.0, 40.0);
    let mut ground = vec![[-100.0 * far, 0.0], [0.0, 0.0]];
    let count = 1 + r.one_of(3);
    for k in 0..count {
        let x = far * (k as f64 + r.within(0.3, 0.7)) / count as f64;
        ground.push([x, far / count as f64 * r.within(-0.6, 0.4)]);
    }
    ground.extend([[far, 0.0], [101.0 * far, 0.0]]);
    let slack = r.scale(0.1, 4.0);
    let friction = r.or_nothing(0.3, 0.05, 1.2);
    over(r, ground, slack, friction)
}

pub fn terraces(r: &mut Chance) -> Case {
    let far = r.scale(2.0, 30.0);
    let mut ground = vec![[-100.0 * far, 0.0], [0.0, 0.0]];
    let count = 1 + r.one_of(4);
    let mut y = 0.0;
    for k in 0..count {
        let x = far * (k as f64 + r.within(0.3, 0.7)) / count as f64;
        let next = y + far / count as f64 * r.within(-0.5, 0.5);
        // A wall: upright, or nearly.
        let lean = if r.says(0.6) { 0.0 } else { 0.1 * far / count as f64 * r.next() };
        ground.extend([[x, y], [x + lean, next]]);
        y = next;
    }
    ground.extend([[far, y], [101.0 * far, y]]);
    let slack = r.scale(0.1, 2.0);
    let friction = r.or_nothing(0.2, 0.05, 1.2);
    over(r, ground, slack, friction)
}

pub fn rough(r: &mut Chance) -> Case {
    let far = r.scale(2.0, 60.0);
    let count = 3 + r.one_of(20);
    let mut ground = vec![[-100.0 * far, 0.0], [0.0, 0.0]];
    for k in 1..count {
        let x = far * (k as f64 + r.within(-0.3, 0.3)) / count as f64;
        ground.push([x, far / count as f64 * r.within(-0.4, 0.4)]);
    }
    ground.extend([[far, 0.0], [101.0 * far, 0.0]]);
    let slack = r.scale(0.05, 1.5);
    let friction = r.or_nothing(0.2, 0.05, 1.2);
    over(r, ground, slack, friction)
}

pub fn free_end(r: &mut Chance) -> Case {
    let high = r.scale(0.2, 10.0);
    let lies = r.scale(0.1, 30.0);
    let friction = r.or_nothing(0.3, 0.05, 1.2);
    let length = high + lies;
    let route = vec![[0.0, R + high], [0.1 * lies, R], [lies, R]];
    let mut s = cable(
        [length, r.scale(0.05, 10.0), r.scale(1e4, 1e8), D],
        vec![Support::fixed("a", [0.0, R + high]), Support::free("b")],
    );
    if r.says(0.7) {
        s.cables[0].route_m = route;
    }
    put(&mut s, flat(0.0, [-3.0 * length, 4.0 * length]), friction);
    Case::rests(s)
}

pub fn loaded_end(r: &mut Chance) -> Case {
    let high = r.scale(0.2, 10.0);
    let lies = r.scale(0.5, 30.0);
    let length = high + lies;
    let w = r.scale(0.05, 10.0);
    let friction = r.within(0.05, 1.2);
    let down = w * STANDARD_GRAVITY * length * r.scale(0.05, 3.0);
    // Within what friction holds of it.
    let force = [down * friction * r.within(-0.8, 0.8), -down];
    let mut s = cable(
        [length, w, (down + w * length * 10.0) * r.scale(1e2, 1e6), D],
        vec![Support::fixed("a", [0.0, R + high]), load_end("b", force)],
    );
    s.cables[0].route_m = vec![[0.0, R + high], [0.1 * lies, R], [lies, R]];
    put(&mut s, flat(0.0, [-10.0 * length, 10.0 * length]), friction);
    Case { model: if r.says(0.5) { Model::Fem } else { Model::Auto }, ..Case::rests(s) }
}

/// An end with a lump of mass that lies.
pub fn lump(r: &mut Chance) -> Case {
    let mut case = loaded_end(r);
    let c = case.cable();
    let weight = c.length_m * c.linear_density_kg_per_m;
    if let Some(end) = c.supports.last_mut() {
        *end = Support { mass_kg: Some(weight * r.scale(0.05, 20.0)), ..Support::free("b") };
    }
    case
}

pub fn lying_loads(r: &mut Chance) -> Case {
    let mut case = rough_mooring(r);
    let c = case.cable();
    let (length, w) = (c.length_m, c.linear_density_kg_per_m * STANDARD_GRAVITY);
    for _ in 0..=r.one_of(3) {
        let down = w * length * r.scale(0.01, 1.0);
        case.scene.loads.push(load(length * r.within(0.02, 0.98), [down * r.or_nothing(0.5, -0.2, 0.2), -down]));
    }
    case
}

/// A cable with two free ends on a plane just within and beyond its cone.
pub fn cone(r: &mut Chance) -> Case {
    let friction = r.within(0.05, 1.2);
    let part = r.pick(&[-0.03, -0.01, 0.01, 0.03]);
    let tilt = friction * (1.0 + part);
    let length = r.scale(1.0, 100.0);
    let n = 1.0_f64.hypot(tilt);
    let (from, mut to) = (on(tilt, 0.0), on(tilt, length / n));
    let w = r.scale(0.05, 10.0);
    let ea = w * STANDARD_GRAVITY * length * r.scale(1e3, 1e7);
    let lower = r.says(0.5);
    let mut s = cable([length, w, ea, D], vec![Support::free("a"), Support::free("b")]);
    s.cables[0].route_m = vec![from, to];
    if lower {
        s.cables[0].route_m.reverse();
        to = from;
    }
    let _ = to;
    put(&mut s, terrain(slope(tilt, 100.0 * length).to_vec()), friction);
    Case::new(s, if part < 0.0 { Expect::Rests } else { Expect::Slides })
}

pub fn any_scale(r: &mut Chance) -> Case {
    let make = r.pick::<fn(&mut Chance) -> Case>(&[rough_mooring, slack_floor, pits, rough, sloped_mooring]);
    let case = make(r);
    let length = case.scene.cables[0].length_m;
    let k = r.scale(1e-3, 1e4) / length;
    let mut scene = crate::relations::longer(&case.scene, k);
    let c = &mut scene.cables[0];
    let m =
        (r.scale(1e-6, 1e4) / c.linear_density_kg_per_m).max(1.0 / c.axial_stiffness_n).min(1e12 / c.axial_stiffness_n);
    c.linear_density_kg_per_m = (c.linear_density_kg_per_m * m).clamp(1e-6, 1e4);
    c.axial_stiffness_n = (c.axial_stiffness_n * m).clamp(1.0, 1e12);
    c.diameter_m = c.diameter_m.clamp(1e-5, 10.0);
    c.length_m = c.length_m.max(1e-3);
    Case::rests(scene)
}

pub fn by_fem(r: &mut Chance) -> Case {
    let make = r.pick::<fn(&mut Chance) -> Case>(&[rough_mooring, smooth_mooring, sloped_mooring, pits, rough]);
    let mut case = make(r);
    case.model = Model::Fem;
    case.expect = Expect::Rests;
    let count = r.scale(10.0, 1000.0) as usize;
    case.cable().segments = r.says(0.7).then_some(count);
    case
}

pub fn by_mass_spring(r: &mut Chance) -> Case {
    let mut case = rough_mooring(r);
    case.model = Model::MassSpring;
    case.cable().segments = Some(r.scale(10.0, 200.0) as usize);
    case
}

pub fn wind(r: &mut Chance) -> Case {
    let mut case = if r.says(0.5) { rough_mooring(r) } else { rough(r) };
    let w = case.scene.cables[0].linear_density_kg_per_m * STANDARD_GRAVITY;
    case.scene.environment.wind_n_per_m = [w * r.within(-0.3, 0.3), w * r.within(-0.5, 0.5)];
    case
}
