//! These tests draw stiff cables at rest on rough ground, with boxes, posts, friction and slack:
//! every scene has an answer that is sound.
//!
//! The checker judges every answer before it is handed out; these tests require that there is an
//! answer, and that it states its error.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use std::fmt::Write;

use cable_core::scene::Scene;
use cable_core::{Model, Simulation};
use dice::MmixDice;

/// A power cable over rough ground, boxes and posts; three of ten have L/chord up to 3.
fn scene(seed: u64) -> String {
    let mut r = MmixDice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
    for _ in 0..4 {
        r.unit();
    }
    let w = r.within(8.0, 20.0);
    let (a, b) = (r.within(1.2, 6.0), r.within(1.2, 6.0));
    let slack = r.unit() < 0.3;
    let length = w.hypot(a - b) * if slack { r.within(1.3, 3.0) } else { r.within(1.02, 1.3) };
    let ei = 10f64.powf(r.within(-1.0, 2.0));
    let mut text = format!(
        "version = 1\n[[cables]]\nname = \"c\"\npreset = \"soow-6-4\"\nlength_m = {length}\nbending_stiffness_n_m2 = {ei}\n\
         [[cables.supports]]\nname = \"a\"\nkind = \"fixed\"\nat_m = [0.0, {a}]\n\
         [[cables.supports]]\nname = \"b\"\nkind = \"fixed\"\nat_m = [{w}, {b}]\n"
    );
    let rough = r.pick(&[0.05, 0.2, 0.4]);
    let mut points = String::new();
    let mut x = -5.0;
    while x < w + 5.0 {
        write!(points, "[{x}, {}], ", r.within(-rough, rough)).unwrap();
        x += 1.3;
    }
    let friction = r.pick(&[0.0, 0.3, 0.6]);
    writeln!(
        text,
        "[[obstacles]]\nname = \"ground\"\nkind = \"terrain\"\npoints_m = [{points}[{}, 0.0]]\nfriction = {friction}",
        w + 6.0
    )
    .unwrap();
    let things = (r.unit() * 4.0) as usize;
    for k in 0..things {
        let (x, y, friction) = (r.within(1.5, w - 1.5), r.within(0.6, 4.0), r.pick(&[0.0, 0.3, 0.4]));
        let what = if r.unit() < 0.5 {
            format!("kind = \"circle\"\ncenter_m = [{x}, {y}]\nradius_m = {}", r.within(0.05, 0.5))
        } else {
            let (u, v) = (x + r.within(0.1, 0.5), y + r.within(0.1, 0.5));
            format!("kind = \"polygon\"\npoints_m = [[{x}, {y}], [{u}, {y}], [{u}, {v}], [{x}, {v}]]")
        };
        writeln!(text, "[[obstacles]]\nname = \"o{k}\"\n{what}\nfriction = {friction}").unwrap();
    }
    text
}

#[test]
fn stiff_cables_on_rough_ground_have_a_sound_answer() {
    let (scenes, mut refused, mut coarse) = (40, Vec::new(), 0);
    for seed in 0..scenes {
        let text = scene(seed);
        let scene = Scene::from_toml(&text).unwrap();
        let mut simulation = Simulation::new(scene, Model::Auto).unwrap();
        match simulation.settle() {
            Ok(answer) => {
                let cable = &answer.cables[0];
                let error = cable.error_estimate.expect("it says how accurate it is");
                assert!(error.is_finite(), "seed {seed}");
                coarse += usize::from(error > 1e-2);
            }
            Err(why) => refused.push(format!("seed {seed}: {why}")),
        }
    }
    // 2 % of many; of 40 that is at most one.
    assert!(refused.len() <= 1, "{refused:#?}");
    // A chain of bars answers where contacts are too many for the elastica: it is good to some per
    // cent.
    assert!(coarse <= 8, "{coarse} of {scenes} answers are off by more than 1 %");
}

/// Length, density, EA, EI, height of the support, its angle where it is clamped (°), the load at
/// the other end (N).
type Leaning = ([f64; 5], Option<f64>, Option<[f64; 2]>);

/// They would hang into the floor.
const LEANING: [Leaning; 6] = [
    ([6.012, 0.1617, 5.774e5, 185.46, 0.8135], None, None),
    ([0.8892, 0.141, 3.829e5, 0.001, 0.7284], Some(-56.8), None),
    ([2.0193, 2.4933, 1.617e5, 10.096, 1.1317], None, None),
    ([1.2007, 0.1614, 1.744e4, 0.001, 0.5751], Some(59.75), None),
    ([7.816, 8.215, 4.448e6, 2212.8, 1.1937], None, None),
    ([2.8675, 0.6872, 1.519e6, 0.8984, 0.9834], Some(49.93), Some([4.17, -5.21])),
];

#[test]
fn a_free_end_leans_where_it_cannot_hang() {
    let mut refused = Vec::new();
    for (k, ([length, density, ea, ei, high], angle, load)) in LEANING.into_iter().enumerate() {
        let held = angle.map_or("kind = \"fixed\"".to_owned(), |a| format!("kind = \"clamped\"\nangle_deg = {a}"));
        let loose = load.map_or("kind = \"free\"".to_owned(), |f| format!("kind = \"load\"\nforce_n = {f:?}"));
        let text = format!(
            "version = 1\n[[cables]]\nname = \"c\"\npreset = \"soow-6-4\"\nlength_m = {length}\ndiameter_m = 0.03\n\
             linear_density_kg_per_m = {density}\naxial_stiffness_n = {ea}\nbending_stiffness_n_m2 = {ei}\n\
             [[cables.supports]]\nname = \"a\"\n{held}\nat_m = [0.0, {high}]\n[[cables.supports]]\nname = \"b\"\n{loose}\n\
             [[obstacles]]\nname = \"floor\"\nkind = \"terrain\"\npoints_m = [[-100.0, 0.0], [100.0, 0.0]]\nfriction = 0.4\n"
        );
        match Simulation::new(Scene::from_toml(&text).unwrap(), Model::Auto).unwrap().settle() {
            Ok(answer) => assert!(answer.cables[0].nodes.iter().all(|n| n.y_m > 0.0147), "{k}"),
            Err(why) => refused.push(format!("{k}: {why}")),
        }
    }
    assert!(refused.is_empty(), "{refused:#?}");
}
