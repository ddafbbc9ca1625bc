//! A chain of 10 m let go from the horizontal, against rigid links with the same masses: what differs is the step in
//! time and the stretch.

use cable_core::Vec2;
use cable_core::scene::{Support, SupportKind};

use super::linked_rods::Rods;
use super::measure::{G, cable, energy, ladder, started};

const LENGTH: f64 = 10.0;
const LINKS: usize = 50;

#[test]
fn the_tip_follows_that_of_rigid_links() {
    let mut rods = Rods::new(LENGTH / LINKS as f64, vec![0.0; LINKS]);
    let mut path = vec![rods.tip()];
    let whole = rods.energy();
    for _ in 0..10 {
        for _ in 0..400 {
            rods.step(0.1 / 400.0);
        }
        path.push(rods.tip());
    }
    assert!((rods.energy() - whole).abs() < 1e-8 * G * LENGTH * LENGTH, "the links lose {}", rods.energy() - whole);
    let supports = vec![Support::fixed("wall", [0.0, 0.0]), Support::new("tip", SupportKind::Free)];
    let scene = cable([LENGTH, 1.0, 1e8], LINKS, supports);
    let (mut errors, mut losses) = (Vec::new(), Vec::new());
    for steps in [24, 48, 96] {
        let mut sim = started(&scene, |state| {
            for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                *p = Vec2::new(*s, 0.0);
            }
        });
        let start = energy(&scene, &sim.states()[0]);
        let mut off = 0.0f64;
        for at in &path[1..] {
            for _ in 0..steps {
                sim.step(0.1 / f64::from(steps)).unwrap();
            }
            off = off.max((sim.states()[0].position_m[LINKS] - at).norm());
        }
        let lost = (start - energy(&scene, &sim.states()[0])) / (G * LENGTH * LENGTH);
        println!("h 1/{}: tip {off:.2e} m, energy {lost:.2e} m g L", 10 * steps);
        errors.push(off);
        losses.push(lost);
    }
    ladder("falling chain, tip in m", &errors, 2.0, 5e-4);
    ladder("falling chain, energy lost in mgL", &losses, 2.0, 5.5e-5);
}
