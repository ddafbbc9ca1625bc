//! Named scenes are embedded from `assets/scenes/` and used by tests, benches, examples and the
//! viewer alike.

use crate::scene::{Environment, Motion, Scene, Support, VERSION, View};

macro_rules! scenes {
    ($($(#[$doc:meta])* $name:ident = $id:literal;)+) => {
        $(
            $(#[$doc])*
            #[must_use]
            pub fn $name() -> Scene {
                read(include_str!(concat!("../../../../../assets/scenes/", $id, ".toml")))
            }
        )+

        /// Every catalogue scene, in the order a picker shows them: short id, scene.
        #[must_use]
        pub fn all() -> Vec<(&'static str, Scene)> {
            vec![$(($id, $name())),+]
        }

        /// The text of every catalogue scene, with its comments: short id, text.
        pub const TEXTS: &[(&str, &str)] =
            &[$(($id, include_str!(concat!("../../../../../assets/scenes/", $id, ".toml")))),+];
    };
}

scenes! {
    /// The opening scene: a robot in a waste tank, its cable hanging free from a riser.
    tank_robot = "tank-robot";
    /// A waste tank, a cable from a riser over mounds and a beam, out and back.
    tank = "tank";
    /// A cable between two points, sagging freely.
    hanging_span = "hanging-span";
    /// One end far above the other.
    steep_span = "steep-span";
    /// A steel rope 0.01 % longer than its span.
    near_taut = "near-taut";
    /// A long cable whose middle lies on the floor.
    slack_to_floor = "slack-to-floor";
    /// Waypoints: a wheel with friction and a frictionless eye.
    pulley_waypoints = "pulley-waypoints";
    /// From a riser over a beam to a hitch near the floor.
    over_beam = "over-beam";
    /// Pulled half round a pipe.
    round_post = "round-post";
    /// Hung over a pipe and drawn down until it slips.
    draped_slipping = "draped-slipping";
    /// A tail dragged over a floor.
    floor_drag = "floor-drag";
    /// Both ends let go above rough ground.
    rubble_drop = "rubble-drop";
    /// A cable that comes down on itself.
    pile = "pile";
    /// A robot drives out and back without remote control.
    robot_drive = "robot-drive";
    /// From above, between two posts.
    plan_posts = "plan-posts";
    /// Clamped ends and a bending stiffness.
    clamped_stiff = "clamped-stiff";
    /// Point loads, wind and temperature.
    loads_wind_heat = "loads-wind-heat";
}

/// A single flexible, undamped, unbreakable cable, as closed forms assume: length (m), mass per
/// length (kg/m) and EA (N).
#[must_use]
pub fn cable_alone([length, density, ea]: [f64; 3], supports: Vec<Support>) -> Scene {
    let mut scene = hanging_span();
    scene.loads.clear();
    scene.environment = Environment::default();
    if let Some(c) = scene.cables.first_mut() {
        (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (length, density, ea);
        (c.bending_stiffness_n_m2, c.thermal_expansion_per_k, c.damping_ratio) = (0.0, 0.0, 0.0);
        (c.service_tension_n, c.breaking_tension_n) = (1e15, 1e15);
        c.route_m.clear();
        c.supports = supports;
    }
    scene
}

/// The hanging span, flexible, its far support going to and fro by 0.2 m in 2 s.
#[must_use]
pub fn swinging_span() -> Scene {
    let mut scene = hanging_span();
    if let Some(c) = scene.cables.first_mut() {
        c.bending_stiffness_n_m2 = 0.0;
        if let Some(far) = c.supports.last_mut()
            && let Some(at) = far.at_m
        {
            far.motion = Some(Motion { times_s: vec![0.0, 1.0, 2.0], points_m: vec![at, [at[0] - 0.2, at[1]], at] });
        }
    }
    scene
}

/// An embedded scene. One that cannot be read (a test sees to it that none is) has no cables and is
/// refused wherever it is solved.
fn read(text: &str) -> Scene {
    Scene::from_toml(text).unwrap_or_else(|e| Scene {
        version: VERSION,
        name: e.to_string(),
        view: View::Elevation,
        environment: Environment::default(),
        cables: Vec::new(),
        obstacles: Vec::new(),
        loads: Vec::new(),
        robot: None,
    })
}
