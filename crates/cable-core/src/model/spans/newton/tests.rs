//! These tests solve spans and contacts by Newton's method and compare them with closed forms.

use crate::model::spans::newton::*;
use crate::model::spans::section::{BoundaryConditions, CableEquilibrium, Connection};
use crate::model::spans::section_layout::{CableEnd, SectionLayout};
use crate::problem::problems;
use crate::scene::obstacle::{Obstacle, Shape};
use crate::scene::{Load, Support, catalog};

/// Error of an entry that differences may leave, as a fraction of the largest entry of its row.
const CLOSE: f64 = 1e-4;

/// A flexible cable over shapes, at rest, then moved.
fn section(
    shapes: Vec<Shape>,
    route_m: Vec<[f64; 2]>,
    length: f64,
    friction: f64,
    moved: Vec2,
) -> (CableSection, SolveContext) {
    loaded(shapes, route_m, Vec::new(), length, friction, moved)
}

/// The same with loads.
fn loaded(
    shapes: Vec<Shape>,
    route_m: Vec<[f64; 2]>,
    loads: Vec<Load>,
    length: f64,
    friction: f64,
    moved: Vec2,
) -> (CableSection, SolveContext) {
    let mut scene = catalog::hanging_span();
    scene.loads = loads;
    let name = scene.cables[0].name.clone();
    scene.loads.iter_mut().for_each(|l| l.cable.clone_from(&name));
    let named = |(k, shape)| Obstacle { name: format!("obstacle {k}"), shape, friction: None };
    scene.obstacles = shapes.into_iter().enumerate().map(named).collect();
    let c = &mut scene.cables[0];
    (c.bending_stiffness_n_m2, c.axial_stiffness_n, c.diameter_m) = (0.0, 1e5, 0.04);
    (c.service_tension_n, c.breaking_tension_n) = (1e15, 1e15);
    (c.length_m, c.friction) = (length, friction);
    c.supports = vec![Support::fixed("A", route_m[0]), Support::fixed("B", *route_m.last().unwrap())];
    c.route_m = route_m;
    let layout =
        SectionLayout::new(&problems(&scene).unwrap().remove(0), CableEnd::Start, std::sync::Arc::default()).unwrap();
    let mut instant = BoundaryConditions::default();
    layout.instant(&[None, None], 0.0, &mut instant);
    let mut workspace = Workspace::default();
    let (mut cable_equilibrium, _) =
        CableEquilibrium::along_route(&layout, &instant, &mut workspace).map_err(|e| e.failure).unwrap();
    instant.places[1] += moved;
    cable_equilibrium.advance_load(&layout, &instant, 0.1, &mut workspace).unwrap();
    (cable_equilibrium.sections.remove(0), cable_equilibrium.context)
}

/// Reproducible numbers in −1 … 1.
fn noise(k: usize) -> f64 {
    ((k as f64 + 1.0) * 12.9898).sin() * 43758.5453 % 1.0
}

/// Compares every entry of the Jacobian with a difference of residuals, at a state a little off the
/// answer.
fn compare(section: &CableSection, context: &SolveContext, seed: usize) {
    let mut x = Vec::new();
    gather(section, &mut x);
    let force = section.forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
    // The unknowns are two forces, then place and material at both ends of a contact.
    let size = |i: usize| if i % 6 < 2 { force } else { 1.0 };
    for (i, v) in x.iter_mut().enumerate() {
        *v += 1e-7 * size(i) * noise(97 * seed + i);
    }
    let at = |x: &[f64]| {
        let mut moved = section.clone();
        scatter(&mut moved, context, x);
        moved
    };
    let residual = |x: &[f64]| {
        let mut system = SectionEquations::default();
        assemble(&mut at(x), context, &mut system);
        system.residual
    };
    let mut system = SectionEquations::default();
    assemble(&mut at(&x), context, &mut system);
    let (r, band) = (system.residual, system.band);
    let n = x.len();
    let largest: Vec<f64> =
        (0..n).map(|i| (0..n).map(|j| band.entry(i, j).abs() * size(j)).fold(0.0, f64::max)).collect();
    // A load in a kink stays there: its place and the force of a missing span are not unknowns.
    let fixed = |j: usize| match j % 6 {
        0 | 1 => !section.has_span(j / 6),
        of => of % 2 == 0 && section.in_pocket(j / 6, (of - 2) / 2),
    };
    // Neither are the material of a load and the place of a contact held by a sticking load.
    let fixed = |j: usize| {
        let (c, of) = (j / 6, j % 6);
        let joint = of == 0 && c > 0 && section.is_joined(c, 0);
        let side = of.saturating_sub(2) / 2;
        let load = of > 1 && if of % 2 == 1 { section.has_load_material(c, side) } else { section.is_pinned(c, side) };
        !joint && (fixed(j) || load)
    };
    for j in (0..n).filter(|&j| !fixed(j)) {
        let h = 1e-8 * size(j);
        let (mut up, mut down) = (x.clone(), x.clone());
        up[j] += h;
        down[j] -= h;
        let (up, down) = (residual(&up), residual(&down));
        // An end that is held on the boundary has a row that is linear only near its answer.
        let linear = |i: &usize| !(i % 6 > 2 && i % 6 < 5 && section.is_pinned(i / 6, i % 6 - 3));
        for i in (0..n).filter(linear) {
            let exact = band.entry(i, j) * size(j);
            // If the residual has an angle (a front at a corner), either one-sided difference will
            // do.
            let ways = [(up[i] - down[i]) / (2.0 * h), (up[i] - r[i]) / h, (r[i] - down[i]) / h];
            let off = ways.iter().map(|d| (d * size(j) - exact).abs()).fold(f64::INFINITY, f64::min);
            assert!(off <= CLOSE * largest[i], "row {i}, unknown {j} of {n}: {exact} and {ways:?} times {}", size(j));
        }
    }
}

#[test]
fn the_jacobian_is_that_of_differences() {
    let hills = || Shape::Terrain {
        points_m: vec![[-5.0, 0.0], [3.0, 0.0], [4.0, 0.4], [5.0, 0.5], [6.0, 0.4], [7.0, 0.0], [15.0, 0.0]],
    };
    let posts = || {
        let post = |x: f64, y: f64| Shape::Circle { center_m: [x, y], radius_m: 0.3 };
        vec![post(3.0, 2.0), post(6.0, 2.4)]
    };
    let valley = || Shape::Terrain { points_m: vec![[-5.0, 0.5], [0.5, 0.5], [4.0, 0.0], [7.5, 0.5], [15.0, 0.5]] };
    for (seed, friction) in [0.0, 0.1, 0.3, 0.8].into_iter().enumerate() {
        for moved in [Vec2::new(0.05, 0.1), Vec2::new(0.02, -0.2), Vec2::new(0.1, 0.3)] {
            let (s, c) = section(vec![hills()], vec![[0.0, 1.0], [10.0, 1.0]], 10.7, friction, moved);
            compare(&s, &c, seed);
            let (s, c) = section(posts(), vec![[0.0, 2.0], [3.0, 3.0], [6.0, 3.0], [9.0, 2.0]], 9.8, friction, moved);
            compare(&s, &c, seed + 7);
        }
        // With slack in the kink.
        let (s, c) = section(vec![valley()], vec![[0.0, 1.0], [8.0, 1.0]], 8.5, friction, Vec2::new(-0.05, 0.0));
        assert!(s.contacts.iter().any(|c| c.next == Connection::Pocket));
        compare(&s, &c, seed + 13);
    }
}

#[test]
fn the_jacobian_is_that_of_differences_where_loads_lie() {
    let floor = || Shape::Terrain { points_m: vec![[-5.0, 0.0], [4.0, 0.0], [15.0, 0.3]] };
    let post = || Shape::Circle { center_m: [5.0, 2.6], radius_m: 0.5 };
    for (seed, friction) in [0.0, 0.1, 0.3, 0.8].into_iter().enumerate() {
        for (k, moved) in [Vec2::new(0.0, -1.5), Vec2::new(0.6, -1.2), Vec2::new(-0.2, -1.0)].into_iter().enumerate() {
            let load = |s: f64| {
                vec![Load {
                    cable: "cable".to_owned(),
                    arc_length_m: s,
                    force_n: Some([0.0, -100.0]),
                    times_s: Vec::new(),
                    forces_n: Vec::new(),
                }]
            };
            let (s, c) = loaded(vec![floor()], vec![[0.0, 1.0], [10.0, 2.5]], load(6.0), 11.0, friction, moved);
            assert!(s.contacts.iter().any(|c| c.is_load()), "{s:?}");
            compare(&s, &c, seed + k);
            let (s, c) =
                loaded(vec![post()], vec![[0.0, 1.0], [5.0, 3.1], [10.0, 2.5]], load(5.6), 11.2, friction, moved * 0.1);
            assert!(s.contacts.iter().any(|c| c.is_load()), "{s:?}");
            compare(&s, &c, seed + k);
        }
    }
}
