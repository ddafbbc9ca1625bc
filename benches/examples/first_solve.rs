//! This example times the first solve of a process, and the least of many: of a scene at rest, or
//! of one second in motion.
//!
//! `cargo run -p cable-benches --example first_solve assets/scenes/tank.toml 20`: a scene, how many
//! times, and a model. `quick` as a fourth word leaves out the search of other histories of
//! friction; a number has so many seconds run with inertia.

#![allow(clippy::expect_used)] // a tool for a developer: it may stop

use std::time::Instant;

use cable_core::model::Settings;
use cable_core::{Model, Scene, Simulation};

/// Pages of memory that the process has had to be given so far, without reading a disk; 0 where the
/// system does not say. It is the tenth field of `/proc/self/stat`, the eighth after the name.
fn page_faults() -> u64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    after_name.split_whitespace().nth(7).and_then(|n| n.parse().ok()).unwrap_or(0)
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let text = std::fs::read_to_string(args.first().expect("a scene")).expect("a file");
    let scene = Scene::from_toml(&text).expect("a scene");
    let times = args.get(1).and_then(|a| a.parse::<usize>().ok()).unwrap_or(10);
    let model = args.get(2).and_then(|a| Model::from_name(a)).unwrap_or(Model::Auto);
    let last = args.get(3).map_or("", String::as_str);
    let settings = Settings { histories: last != "quick", ..Settings::default() };
    let (mut least, mut built) = (f64::INFINITY, f64::INFINITY);
    for k in 0..times {
        let pages = page_faults();
        let start = Instant::now();
        let mut simulation = Simulation::with_settings(scene.clone(), model, settings).expect("a simulation");
        let made = start.elapsed().as_secs_f64();
        let report = simulation.settle().expect("a rest");
        let whole = start.elapsed().as_secs_f64();
        if k == 0 {
            println!(
                "first: built {:.1} us, settled {:.1} us, {} iterations, {} pages of memory first touched",
                1e6 * made,
                1e6 * (whole - made),
                report.cost.iterations,
                page_faults() - pages
            );
        }
        (least, built) = (least.min(whole - made), built.min(made));
        if let (0, Ok(seconds)) = (k, last.parse::<f64>()) {
            let start = Instant::now();
            for _ in 0..(60.0 * seconds) as usize {
                simulation.step(1.0 / 60.0).expect("a step");
            }
            println!("{seconds} s of motion in {:.3} s", start.elapsed().as_secs_f64());
        }
    }
    println!("least of {times}: built {:.1} us, settled {:.1} us", 1e6 * built, 1e6 * least);
}
