//! A cable whose end is fixed on the surface of a round is as long there as its material.
//!
//! Sliding nodes run round a circle as far out as the barrier reaches, 0.1 mm, but the end stands
//! on the circle itself. The bar between them was 3.7e-6 m longer than its 1.1 mm of stretched
//! material, in a taut cable without compression or slack.

#![allow(clippy::expect_used)] // a failing test is meant to panic

use cable_core::{Model, Scene, Settings, Simulation};

/// Radius of the circle, m.
const RADIUS: f64 = 0.7;

fn scene(length: f64, segments: usize) -> Scene {
    let text = format!(
        "version = 1\nname = \"end on a round\"\n\
         [[cables]]\nname = \"c\"\nlength_m = {length}\nlinear_density_kg_per_m = 4.5\n\
         axial_stiffness_n = 2.1e6\nbending_stiffness_n_m2 = 0.0\ndiameter_m = 0.02\n\
         service_tension_n = 1e9\nbreaking_tension_n = 1e9\nfriction = 0.0\n\
         segments = {segments}\n\
         [[cables.supports]]\nname = \"a\"\nkind = \"fixed\"\nat_m = [0.0, 0.01]\n\
         [[cables.supports]]\nname = \"b\"\nkind = \"fixed\"\nat_m = [3.16, 1.166]\n\
         [[obstacles]]\nname = \"o\"\nkind = \"circle\"\ncenter_m = [0.0, -{RADIUS}]\n\
         radius_m = {RADIUS}\nfriction = 0.4\n"
    );
    Scene::from_toml(&text).expect("the scene is valid")
}

#[test]
fn bars_beside_an_end_on_a_round_are_as_long_as_their_material() {
    for (length, segments) in [(3.4437, 300), (3.40, 200), (3.38, 100), (3.367, 60)] {
        let settings = Settings { segments: Some(segments), ..Settings::default() };
        let simulation = Simulation::with_settings(scene(length, segments), Model::Fem, settings);
        let answer = simulation.expect("it builds").settle().expect("it rests");
        for w in answer.cables[0].nodes.windows(2) {
            let material = w[1].arc_length_m - w[0].arc_length_m;
            let stretched = material * (1.0 + w[0].strain.max(w[1].strain));
            let chord = (w[1].x_m - w[0].x_m).hypot(w[1].y_m - w[0].y_m);
            // No chord is longer than the stretched material; strain changes along a bar by less
            // than its weight over EA, 2e-5.
            let allowed = 2e-5 * material + 1e-9 * length;
            let over = chord - stretched;
            assert!(over < allowed, "{segments} bars, {} m: {over:e} m too long", w[0].arc_length_m);
        }
    }
}
