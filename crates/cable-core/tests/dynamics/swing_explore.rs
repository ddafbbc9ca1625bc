//! Exploration.
use cable_core::Vec2;
use cable_core::scene::{Support, SupportKind};
use super::linked_rods::Rods;
use super::measure::{cable, started};

fn path(links: usize, steps: usize) -> Vec<Vec2> {
    let mut rods = Rods::new(10.0 / links as f64, vec![0.0; links]);
    let mut path = Vec::new();
    for _ in 0..20 {
        for _ in 0..steps { rods.step(0.05 / steps as f64); }
        path.push(rods.tip());
    }
    path
}

#[test]
fn explore_swing() {
    let coarse = path(200, 150);
    let fine = path(400, 300);
    let finest = path(800, 600);
    let rich = |a: &[Vec2], b: &[Vec2]| -> Vec<Vec2> { a.iter().zip(b).map(|(a, b)| b + (b - a) / 3.0).collect() };
    let off = |a: &[Vec2], b: &[Vec2]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let (r1, r2) = (rich(&coarse, &fine), rich(&fine, &finest));
    println!("reference: {:.2e} rods 800 {:.2e} rods 50 {:.2e}", off(&r1, &r2), off(&finest, &r2), off(&path(50, 60), &r2));
    for ea in [1e8] {
    for n in [25, 50, 100, 200] {
        for hz in [240.0, 480.0, 960.0, 3840.0] {
            let supports = vec![Support::fixed("wall", [0.0, 0.0]), Support::new("tip", SupportKind::Free)];
            let scene = cable([10.0, 1.0, ea], n, supports);
            let mut sim = started(&scene, |state| {
                for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) { *p = Vec2::new(*s, 0.0); }
            });
            let mut mine = Vec::new();
            let begin = std::time::Instant::now();
            for _ in 0..20 {
                for _ in 0..(0.05 * hz) as usize { sim.step(1.0 / hz).unwrap(); }
                mine.push(sim.states()[0].position_m[n]);
            }
            let t = begin.elapsed().as_secs_f64();
            let each: Vec<String> = mine.iter().zip(&r2).skip(9).step_by(2).map(|(a, b)| format!("{:.1e}", (a - b).norm())).collect();
            println!("EA {ea:.0e} n {n} hz {hz}: tip off {:.2e}  {:.0} ms  {}", off(&mine, &r2), 1e3 * t, each.join(" "));
        }
    }}
}
