//! This program lets a chain of rods fall from rest, by rapier2d:
//! `peer-rapier2d JOINT N STEP_S ITERATIONS END_S X Y [X Y …]` with `JOINT` multibody or impulse,
//! N + 1 places of the nodes, the first of them held.
//!
//! Prints the least cost of the steps (s), and the place of the last node after each, as JSON.

use std::time::Instant;

use rapier2d_f64::prelude::*;

const GRAVITY: f64 = 9.80665;
const DENSITY_KG_PER_M: f64 = 1.0;
const REPEATS: usize = 3;

struct Asked {
    multibody: bool,
    step_s: f64,
    iterations: usize,
    end_s: f64,
    places: Vec<Vector>,
}

/// The world, and the last rod with half of its length.
fn world(asked: &Asked) -> (PhysicsWorld, RigidBodyHandle, f64) {
    let mut world = PhysicsWorld::default();
    world.gravity = Vector::new(0.0, -GRAVITY);
    world.integration_parameters.dt = asked.step_s;
    world.integration_parameters.num_solver_iterations = asked.iterations;
    let mut before = world.bodies.insert(RigidBodyBuilder::fixed().translation(asked.places[0]));
    let (mut anchor, mut half) = (Vector::new(0.0, 0.0), 0.0);
    for pair in asked.places.windows(2) {
        let along = pair[1] - pair[0];
        let length = along.length();
        half = 0.5 * length;
        let mass = DENSITY_KG_PER_M * length;
        let properties = MassProperties::new(Vector::new(0.0, 0.0), mass, mass * length * length / 12.0);
        let rod = RigidBodyBuilder::dynamic()
            .translation((pair[0] + pair[1]) * 0.5)
            .rotation(along.y.atan2(along.x))
            .additional_mass_properties(properties)
            .can_sleep(false);
        let rod = world.bodies.insert(rod);
        let joint = RevoluteJointBuilder::new().local_anchor1(anchor).local_anchor2(Vector::new(-half, 0.0));
        if asked.multibody {
            world.multibody_joints.insert(before, rod, joint, true);
        } else {
            world.impulse_joints.insert(before, rod, joint, true);
        }
        (before, anchor) = (rod, Vector::new(half, 0.0));
    }
    (world, before, half)
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |k: usize| words[k].parse::<f64>().expect("a number");
    let count = number(1) as usize;
    let asked = Asked {
        multibody: words[0] == "multibody",
        step_s: number(2),
        iterations: number(3) as usize,
        end_s: number(4),
        places: (0..=count).map(|k| Vector::new(number(5 + 2 * k), number(6 + 2 * k))).collect(),
    };
    let (mut least, mut seen) = (f64::INFINITY, Vec::new());
    for _ in 0..REPEATS {
        let (mut world, last, half) = world(&asked);
        seen.clear();
        let begun = Instant::now();
        for _ in 0..(asked.end_s / asked.step_s).round() as usize {
            world.step();
            let rod = &world.bodies[last];
            let tip = *rod.position() * Vector::new(half, 0.0);
            seen.push(format!("[{:e}, {:e}]", tip.x, tip.y));
        }
        least = least.min(begun.elapsed().as_secs_f64());
    }
    println!("{{\"cost_s\": {least:e}, \"tip_m\": [{}]}}", seen.join(", "));
}
