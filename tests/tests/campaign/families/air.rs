//! The cables of this family touch nothing.

use crate::case::{Case, Expect, Point, apart, cable, clamp, fixed, flat, load, load_end as loaded, post, put};
use crate::chance::Chance;
use crate::closed::free_span;
use cable_core::scene::preset::cable_presets;
use cable_core::scene::{STANDARD_GRAVITY, Scene, Support, SupportKind};
use cable_core::{Model, scene};

/// Returns what a closed form says of a free span.
fn known(scene: Scene) -> Case {
    let c = &scene.cables[0];
    let weight = c.linear_density_kg_per_m * scene.environment.gravity_m_per_s2;
    let ends = [0, 1].map(|k| c.supports[k].at_m.unwrap_or_default());
    match free_span(ends, c.length_m, [0.0, -weight], c.axial_stiffness_n) {
        Some(forces) => Case::new(scene, Expect::Forces(forces, 1e-6)),
        None => Case::rests(scene),
    }
}

/// Two ends some way apart.
fn ends(r: &mut Chance) -> [Point; 2] {
    let far = r.scale(0.5, 200.0);
    let a = [r.within(-5.0, 5.0), r.within(-5.0, 5.0)];
    let way = if r.says(0.1) { -1.0 } else { 1.0 };
    [a, [a[0] + way * far, a[1] + far * r.within(-1.5, 1.5)]]
}

pub fn taut(r: &mut Chance) -> Case {
    let at = ends(r);
    let ea = r.scale(1e4, 1e9);
    let length = apart(at[0], at[1]) * (1.0 + r.within(-2e-3, 2e-2));
    known(cable([length, r.scale(0.01, 100.0), ea, 0.02], fixed(at)))
}

pub fn slack(r: &mut Chance) -> Case {
    let at = ends(r);
    let length = apart(at[0], at[1]) * (1.0 + r.scale(0.02, 20.0));
    known(cable([length, r.scale(0.01, 100.0), r.scale(1e4, 1e9), 0.02], fixed(at)))
}

pub fn vertical(r: &mut Chance) -> Case {
    let high = r.scale(0.5, 100.0);
    let aside = if r.says(0.4) { 0.0 } else { r.scale(1e-12, 0.1) * high };
    let (mut a, mut b) = ([0.0, high], [aside, 0.0]);
    if r.says(0.5) {
        (a, b) = (b, a);
    }
    let w = r.scale(0.05, 20.0);
    let slack = match r.one_of(3) {
        0 => r.within(-1e-3, 0.0),
        1 => r.scale(1e-6, 1e-2),
        _ => r.scale(1e-2, 3.0),
    };
    let length = high * (1.0 + slack);
    let ea = r.scale(1e5, 1e8);
    let made = cable([length, w, ea, 0.02], fixed([a, b]));
    if aside > 1e-7 * high { known(made) } else { Case::rests(made) }
}

pub fn same_place(r: &mut Chance) -> Case {
    let length = r.scale(0.5, 50.0);
    let at = [r.within(-3.0, 3.0), 10.0];
    let aside = if r.says(0.5) { 0.0 } else { length * r.scale(1e-9, 1e-2) };
    Case::rests(cable([length, r.scale(0.05, 20.0), r.scale(1e4, 1e8), 0.02], fixed([at, [at[0] + aside, at[1]]])))
}

pub fn loads(r: &mut Chance) -> Case {
    let at = ends(r);
    let length = apart(at[0], at[1]) * (1.0 + r.or_nothing(0.2, 1e-3, 1.0));
    let w = r.scale(0.05, 20.0);
    let mut s = cable([length, w, r.scale(1e5, 1e8), 0.02], fixed(at));
    let weight = w * length * STANDARD_GRAVITY;
    for _ in 0..r.one_of(4) {
        let force = [weight * r.within(-0.5, 0.5), -weight * r.within(-0.3, 2.0)];
        s.loads.push(load(length * r.within(0.02, 0.98), force));
    }
    if r.says(0.5) {
        s.environment.wind_n_per_m = [weight / length * r.within(-2.0, 2.0), weight / length * r.within(-0.5, 0.5)];
    }
    if r.says(0.5) {
        s.cables[0].thermal_expansion_per_k = r.within(0.0, 3e-5);
        s.environment.temperature_change_k = r.within(-80.0, 200.0);
    }
    Case::rests(s)
}

pub fn hangs_free(r: &mut Chance) -> Case {
    let (length, w) = (r.scale(0.1, 300.0), r.scale(0.01, 50.0));
    let mut s = cable(
        [length, w, (w * length * r.scale(1e2, 1e7)).max(1.0), 0.02],
        vec![Support::fixed("a", [r.within(-3.0, 3.0), 5.0]), Support::free("b")],
    );
    let mut force = [0.0, -w * STANDARD_GRAVITY * length];
    if r.says(0.3) {
        s.environment.wind_n_per_m = [w * r.within(-10.0, 10.0), 0.0];
        force[0] = s.environment.wind_n_per_m[0] * length;
    }
    if r.says(0.3) {
        let aside = r.within(-1.0, 1.0);
        s.cables[0].route_m = vec![[0.0, 5.0], [length * aside, 5.0 - length * 0.5]];
        s.cables[0].supports[0].at_m = Some([0.0, 5.0]);
    }
    Case::new(s, Expect::Forces([force, [0.0; 2]], 1e-6))
}

pub fn load_end(r: &mut Chance) -> Case {
    let (length, w) = (r.scale(0.3, 100.0), r.scale(0.01, 20.0));
    let weight = w * length * STANDARD_GRAVITY;
    let size = weight * r.scale(1e-2, 1e2);
    let angle = r.within(-0.9, 0.9) * std::f64::consts::PI;
    let force = [size * angle.sin(), -size * angle.cos()];
    let s = cable(
        [length, w, (weight + size) * r.scale(1e2, 1e6), 0.02],
        vec![Support::fixed("a", [0.0, 0.0]), loaded("b", force)],
    );
    Case::new(s, Expect::Forces([[force[0], force[1] - weight], [-force[0], -force[1]]], 1e-6))
}

pub fn held_between(r: &mut Chance) -> Case {
    let at = ends(r);
    let middle = [
        at[0][0] + (at[1][0] - at[0][0]) * r.within(0.2, 0.8),
        at[0][1] + (at[1][1] - at[0][1]) * r.within(0.0, 1.0) + r.within(-1.0, 1.0),
    ];
    let (one, two) = (apart(at[0], middle), apart(middle, at[1]));
    let first = one * (1.0 + r.scale(1e-3, 1.0));
    let length = first + two * (1.0 + r.scale(1e-3, 1.0));
    let mut supports = fixed(at);
    let mut m = Support::fixed("m", middle);
    m.arc_length_m = Some(first);
    supports.insert(1, m);
    Case::rests(cable([length, r.scale(0.05, 20.0), r.scale(1e4, 1e8), 0.02], supports))
}

/// A cable over smooth pulleys at these places, with this much slack; ground far below makes it a
/// question for other models.
fn over_pulleys(r: &mut Chance, places: &[Point]) -> Case {
    let way: f64 = places.windows(2).map(|w| apart(w[0], w[1])).sum();
    let length = way * (1.0 + r.scale(1e-4, 3.0));
    let last = places.len() - 1;
    let mut supports = fixed([places[0], places[last]]);
    for (k, at) in places.iter().enumerate().take(last).skip(1) {
        supports.insert(k, Support { friction: Some(0.0), ..Support::pulley(format!("p{k}"), *at) });
    }
    let mut s = cable([length, r.scale(0.05, 20.0), r.scale(1e4, 1e8), 0.02], supports);
    if r.says(0.3) {
        put(&mut s, flat(-2.0 * length, [-3.0 * length, 4.0 * length]), 0.0);
    }
    Case::rests(s)
}

/// Level and evenly spaced: the balance with as much slack in each span is there at any slack, and
/// stable only with little.
pub fn even_pulleys(r: &mut Chance) -> Case {
    let (count, far) = (2 + r.one_of(4), r.scale(0.5, 20.0));
    let places: Vec<Point> = (0..=count).map(|k| [far * k as f64, 0.0]).collect();
    over_pulleys(r, &places)
}

/// The same over thin posts, laid in even loops.
pub fn even_posts(r: &mut Chance) -> Case {
    let (count, far) = (2 + r.one_of(3), r.scale(0.5, 20.0));
    let length = far * count as f64 * (1.0 + r.scale(1e-4, 3.0));
    let radius = far * r.scale(1e-3, 0.01);
    // Loops as deep as takes the length, as two straight lines each.
    let loop_length = length / count as f64;
    let deep = 0.5 * (loop_length * loop_length - far * far).sqrt();
    // Over the posts, past both of their sides.
    let mut route = vec![[0.0, 0.0]];
    for k in 0..count {
        let post = far * (k as f64 + 1.0);
        route.push([post - 0.5 * far, -deep]);
        if k + 1 < count {
            route.extend([-2.0, 2.0].map(|side| [post + side * radius, 0.5 * radius]));
        } else {
            route.push([post, 0.0]);
        }
    }
    let diameter = 0.1 * radius;
    let mut s =
        cable([length, r.scale(0.05, 20.0), r.scale(1e4, 1e8), diameter], fixed([route[0], route[route.len() - 1]]));
    s.cables[0].route_m = route;
    let friction = r.or_nothing(0.7, 0.05, 0.6);
    for k in 1..count {
        put(&mut s, post([far * k as f64, -radius - 0.5 * diameter], radius), friction);
    }
    Case::rests(s)
}

pub fn uneven_pulleys(r: &mut Chance) -> Case {
    let (count, far) = (2 + r.one_of(3), r.scale(0.5, 20.0));
    let mut places = vec![[0.0, 0.0]];
    for k in 0..count {
        places.push([places[k][0] + far * r.scale(0.3, 1.0), far * r.within(-0.3, 0.3)]);
    }
    over_pulleys(r, &places)
}

pub fn weightless(r: &mut Chance) -> Case {
    let at = ends(r);
    let (length, w) = (apart(at[0], at[1]) * (1.0 + r.within(-1e-3, 0.05)), 1e-6);
    let mut s = cable([length, w, r.scale(1e3, 1e6), 0.01], fixed(at));
    if r.says(0.5) {
        s.loads.push(load(length * r.within(0.1, 0.9), [0.0, -r.scale(0.1, 100.0)]));
    }
    Case::rests(s)
}

pub fn no_gravity(r: &mut Chance) -> Case {
    let at = ends(r);
    let length = apart(at[0], at[1]) * (1.0 + if r.says(0.4) { r.within(-1e-3, 0.0) } else { r.scale(1e-4, 1.0) });
    let mut s = cable([length, r.scale(0.05, 5.0), r.scale(1e4, 1e7), 0.01], fixed(at));
    s.environment.gravity_m_per_s2 = 0.0;
    match r.one_of(3) {
        0 => s.loads.push(load(length * r.within(0.1, 0.9), [r.within(-10.0, 10.0), -r.scale(0.1, 100.0)])),
        1 => s.environment.wind_n_per_m = [r.within(-3.0, 3.0), r.within(-3.0, 3.0)],
        _ => {}
    }
    Case::rests(s)
}

/// Lengths of 1 mm to 10 km with 1e-6 to 1e4 kg/m and strains below 1.
pub fn any_scale(r: &mut Chance) -> Case {
    let far = r.scale(1e-3, 1e4);
    let length = far * (1.0 + r.scale(1e-4, 2.0));
    let w = r.scale(1e-6, 1e4);
    let ea = (w * STANDARD_GRAVITY * length * r.scale(10.0, 1e5)).clamp(1.0, 1e12);
    let at = [[0.0, 0.0], [far, far * r.within(-0.5, 0.5)]];
    let length = length.max(apart(at[0], at[1]) * 1.001).max(1e-3);
    known(cable([length, w, ea, (1e-3 * far).clamp(1e-5, 10.0)], fixed(at)))
}

pub fn clamps(r: &mut Chance) -> Case {
    let far = r.scale(0.5, 20.0);
    let at = [[0.0, 0.0], [far, far * r.within(-0.5, 0.5)]];
    let length = apart(at[0], at[1]) * (1.0 + r.scale(1e-2, 0.5));
    let supports = vec![clamp("a", at[0], r.within(-60.0, 60.0)), clamp("b", at[1], r.within(-60.0, 60.0))];
    let mut s = cable([length, r.scale(0.1, 10.0), r.scale(1e5, 1e8), 0.02], supports);
    let w = s.cables[0].linear_density_kg_per_m * STANDARD_GRAVITY;
    s.cables[0].bending_stiffness_n_m2 = w * far.powi(3) * r.scale(1e-4, 3.0);
    Case::rests(s)
}

/// 1 to 3000 segments by `fem`.
pub fn segments(r: &mut Chance) -> Case {
    let mut case = slack_or_taut(r);
    case.model = Model::Fem;
    let count = r.scale(1.0, 3000.0) as usize;
    case.cable().segments = Some(count.max(1));
    // The mesh decides how exact it is; what it says of that is asked elsewhere.
    if count < 200 {
        case.expect = Expect::Rests;
    }
    case
}

fn slack_or_taut(r: &mut Chance) -> Case {
    let at = ends(r);
    let length = apart(at[0], at[1]) * (1.0 + r.scale(1e-3, 1.0));
    known(cable([length, r.scale(0.05, 20.0), r.scale(1e4, 1e8), 0.02], fixed(at)))
}

pub fn by_mass_spring(r: &mut Chance) -> Case {
    let mut case = slack_or_taut(r);
    case.model = Model::MassSpring;
    case.cable().segments = Some(r.scale(10.0, 400.0) as usize);
    case.expect = Expect::Rests;
    case
}

pub fn presets(r: &mut Chance) -> Case {
    let all = cable_presets();
    let preset = &all[r.one_of(all.len())];
    let at = ends(r);
    let length = apart(at[0], at[1]) * (1.0 + r.scale(1e-3, 0.5));
    let text = format!(
        "version = 1\n[[cables]]\nname = \"c\"\npreset = \"{}\"\nlength_m = {length:?}\nsupports = [ {{ name = \"a\", kind = \"fixed\", at_m = {:?} }}, {{ name = \"b\", kind = \"fixed\", at_m = {:?} }} ]\n",
        preset.id, at[0], at[1]
    );
    let scene = scene::Scene::from_toml(&text).unwrap_or_else(|e| panic!("{e}: {text}"));
    debug_assert!(scene.cables[0].supports.iter().all(|s| s.kind == SupportKind::Fixed));
    Case::rests(scene)
}
