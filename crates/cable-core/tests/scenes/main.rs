//! These tests read and write scenes: files in and out, faults, presets, the catalogue, motion.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

// clippy.toml's permission for tests does not reach the helpers beside them.

mod catalogue;
mod faults;
mod files;
mod motion;
mod round_trip;

use cable_core::Scene;

/// A scene with every field that a scene can have.
fn full() -> Scene {
    Scene::from_toml(FULL).unwrap()
}

const FULL: &str = r#"
version = 1
name = "Everything"
view = "elevation"

[environment]
gravity_m_per_s2 = 9.8
wind_n_per_m = [1.0, 0.5]
wind_times_s = [0.0, 2.0]
winds_n_per_m = [[0.0, 0.0], [3.0, 0.25]]
temperature_change_k = 12.0

[[cables]]
name = "umbilical"
preset = "soow-6-4"
length_m = 30.0
linear_density_kg_per_m = 1.25
axial_stiffness_n = 1.5e6
bending_stiffness_n_m2 = 0.5
diameter_m = 0.0275
damping_ratio = 0.03
thermal_expansion_per_k = 1.6e-5
service_tension_n = 700.0
breaking_tension_n = 9000.0
min_bend_radius_m = 0.15
friction = 0.45
segments = 90
self_contact = true
route_m = [[0.0, 5.0], [3.0, 4.5], [12.0, 0.5]]

[[cables.supports]]
name = "start"
kind = "load"
times_s = [0.0, 1.0]
forces_n = [[0.0, -10.0], [2.0, -20.0]]
mass_kg = 2.0

[[cables.supports]]
name = "wheel"
kind = "pulley"
at_m = [3.0, 4.5]
radius_m = 0.2
side = "under"
friction = 0.1
release_s = 9.0

[[cables.supports]]
name = "middle"
kind = "fixed"
arc_length_m = 7.0
at_m = [6.0, 3.0]
motion = { times_s = [0.0, 4.0], points_m = [[6.0, 3.0], [6.5, 3.0]] }

[[cables.supports]]
name = "clamp"
kind = "clamped"
arc_length_m = 12.0
at_m = [9.0, 2.0]
angle_deg = -20.0

[[cables.supports]]
name = "weight"
kind = "load"
arc_length_m = 20.0
force_n = [0.0, -5.0]

[[cables.supports]]
name = "hitch"
kind = "robot"
release_s = 30.0

[[obstacles]]
name = "floor"
kind = "terrain"
points_m = [[-1.0, 0.0], [30.0, 0.5]]
friction = 0.6

[[obstacles]]
name = "beam"
kind = "polygon"
points_m = [[4.0, 1.0], [4.3, 1.0], [4.3, 1.2]]

[[obstacles]]
name = "post"
kind = "circle"
center_m = [8.0, 0.5]
radius_m = 0.25

[[obstacles]]
name = "plate"
kind = "polyline"
points_m = [[1.0, 1.0], [2.0, 1.5]]
thickness_m = 0.01

[[loads]]
cable = "umbilical"
arc_length_m = 5.0
force_n = [0.0, -50.0]

[[loads]]
cable = "umbilical"
arc_length_m = 6.0
times_s = [0.5, 1.5]
forces_n = [[0.0, -1.0], [0.0, -2.0]]

[robot]
preset = "brokk-110"
at_m = [12.0, 0.25]
heading = "left"
path = [{ to_x_m = 14.0, speed_m_per_s = 0.3 }, { wait_s = 2.0 }]
"#;
