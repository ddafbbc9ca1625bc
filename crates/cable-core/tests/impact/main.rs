//! These tests compare cables that fall on rough ground and slip over pipes with an independent
//! explicit chain.
//!
//! The whole table of the drop, medians over 16 starts, is
//! `cargo test -p cable-core --test impact -- --ignored --nocapture` (half an hour);
//! `BENDING=1 STARTS=4 RATE=960 CHAIN=0` takes one stiffness, fewer starts, one step and no chain;
//! `CHAIN=168 RATE=1` only the chain, of 168 bars.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod explicit_chain;
mod peaks;
mod rubble;

use cable_core::scene::{Shape, catalog};
use cable_core::{Model, Settings, Simulation};
use peaks::{Tensions, median};

const G: f64 = cable_core::scene::STANDARD_GRAVITY;

/// Medians over starts, each with the least and the greatest: greatest tension, greatest mean over
/// 4 ms of one place, and how much the greatest tension still changes when the cable lies, N.
fn medians(starts: usize, drop: impl Fn(f64) -> Tensions) -> [[f64; 3]; 3] {
    let runs: Vec<Tensions> = rubble::shifts(starts).into_iter().map(drop).collect();
    let of = |read: &dyn Fn(&Tensions) -> f64| median(runs.iter().map(read).collect());
    [of(&|t| t.peak().0), of(&|t| t.mean_peak(4e-3)), of(&|t| t.chatter(rubble::LIES_FROM_S))]
}

fn show(name: &str, found: &[[f64; 3]; 3]) {
    let [peak, mean, chatter] = found.map(|[m, least, most]| format!("{m:.1} [{least:.1} {most:.1}]"));
    println!("{name}: peak {peak} N, over 4 ms {mean} N, chatter {chatter} N");
}

/// The explicit chain of 84 bars has 454 to 486 N, and 390 to 410 N over 4 ms.
const CHAIN_PEAK_N: f64 = 470.0;

/// With the loss of bars differenced over the history of their nodes, nodes put where tangents
/// meet, a reach that grew with the speed and grips left as they were the drop had 36 kN here at 84
/// bars, 71 kN at 168, and hundreds of newtons of chatter for ever.
#[test]
fn a_drop_on_rubble_pulls_as_hard_on_every_mesh() {
    // Medians over 16 starts scatter by a tenth.
    let found = [84, 168].map(|n| medians(48, |aside| rubble::by_fem(&rubble::scene(n, aside, 0.0), 1.0 / 960.0)));
    show("84 bars", &found[0]);
    show("168 bars", &found[1]);
    let [coarse, fine] = found;
    assert!((coarse[0][0] / fine[0][0] - 1.0).abs() < 0.15, "peaks {} and {} N", coarse[0][0], fine[0][0]);
    assert!((coarse[1][0] / fine[1][0] - 1.0).abs() < 0.2, "means {} and {} N", coarse[1][0], fine[1][0]);
    for [peak, _, chatter] in found {
        assert!((peak[0] / CHAIN_PEAK_N - 1.0).abs() < 0.2 && peak[2] < 1.3 * CHAIN_PEAK_N, "peaks {peak:?} N");
        assert!(chatter[2] < 3.0, "chatter {chatter:?} N");
    }
}

/// An impact rubs in the step in which it presses: a bar of a stiff cable that strikes a corner
/// presses with kilonewtons for one step, and by the normal forces of the step before that was
/// rubbed in the step after it, at nine times the normal force that was left. A drop of 336 bars
/// had 618 N by that.
///
/// The pull that holds for 4 ms is the same on every mesh. The pull of a single step is that of a
/// bar that strikes a corner, which with the loss of the material alone no step of 1/960 s resolves
/// (medians of twelve starts: 476, 272 and 313 N).
#[test]
fn a_drop_of_a_stiff_cable_on_rubble_pulls_as_hard_on_every_mesh() {
    let found = [84, 168, 336].map(|n| medians(4, |aside| rubble::by_fem(&rubble::scene(n, aside, 1.0), 1.0 / 960.0)));
    for (n, found) in [84, 168, 336].iter().zip(&found) {
        show(&format!("EI 1, {n} bars"), found);
    }
    let means = found.map(|f| f[1][0]);
    let (least, most) = means.iter().fold((f64::INFINITY, 0.0f64), |(a, b), m| (a.min(*m), b.max(*m)));
    assert!(most < 1.15 * least, "over 4 ms {means:?} N");
    let peaks = found.map(|f| f[0][0]);
    assert!(peaks.iter().all(|peak| *peak < 550.0), "{peaks:?} N");
}

/// A plastic floor gives nothing back, whether it rubs or not: contacts without friction were left
/// to the barrier, which is a spring, and threw the cable 0.8 m high. (Its ends, which come down
/// last, shove it together into folds: by 6 to 46 mm in steps of 1/240 to 1/3840 s on a rough floor
/// of 40 bars; that it is 3 mm in one of them says nothing.)
#[test]
fn a_cable_that_falls_on_a_smooth_floor_stays_there() {
    for friction in [0.5, 0.0] {
        let mut scene = rubble::scene(40, 0.0, 0.0);
        for o in &mut scene.obstacles {
            if let Shape::Terrain { points_m } = &mut o.shape {
                points_m.iter_mut().for_each(|p| p[1] = 0.0);
            }
            o.friction = Some(friction);
        }
        let mut sim = Simulation::with_settings(scene, Model::Fem, Settings::default()).expect("a sound scene");
        sim.settle().expect("it hangs");
        let mut least: Option<f64> = None;
        let mut rises = 0.0f64;
        for _ in 0..480 {
            sim.step(1.0 / 240.0).expect("it falls");
            let nodes = &sim.solution().cables[0].nodes;
            let height = nodes.iter().map(|n| n.y_m).sum::<f64>() / nodes.len() as f64;
            let low = least.map_or(height, |least| least.min(height));
            rises = rises.max(height - low);
            least = Some(low);
        }
        println!("friction {friction}: its middle rises by {rises:.4} m");
        assert!(rises < 0.1, "friction {friction}: its middle rises by {rises} m");
    }
}

/// Fine steps do not hold the cable to the ground: where all speed along the normal was taken from
/// what touches, leaving or not, 168 bars had 663 to 846 N at this step.
#[test]
fn a_drop_on_rubble_pulls_no_harder_in_fine_steps() {
    let found = medians(2, |aside| rubble::by_fem(&rubble::scene(168, aside, 0.0), 1.0 / 3840.0));
    show("168 bars, steps of 1/3840 s", &found);
    assert!(found[0][0] < 1.35 * CHAIN_PEAK_N, "{:?} N", found[0]);
}

/// The chain that is compared with is one in its own step.
#[test]
fn the_explicit_chain_is_converged_in_its_step() {
    let scene = rubble::scene(24, 0.0, 0.0);
    let [coarse, fine] = [0.6, 0.3].map(|part| rubble::by_chain(&scene, part, 2e5));
    let figures = |t: &Tensions| (t.peak().0, t.mean_peak(4e-3));
    let ((a, b), (c, d)) = (figures(&coarse), figures(&fine));
    println!("peaks {a:.1} and {c:.1} N, means {b:.1} and {d:.1} N");
    assert!((a / c - 1.0).abs() < 0.1 && (b / d - 1.0).abs() < 0.1);
}

/// Slip is found in the step: with six rounds of it, and without the loss among the forces it is
/// judged by, 600 bars had 10 kN here.
#[test]
fn a_draped_cable_slips_at_the_same_tension_on_every_mesh() {
    for segments in [200, 600] {
        let mut scene = catalog::draped_slipping();
        scene.cables[0].segments = Some(segments);
        let mut sim = Simulation::with_settings(scene, Model::Fem, Settings::default()).unwrap();
        sim.settle().unwrap();
        let mut most: f64 = 0.0;
        for _ in 0..360 {
            sim.step(1.0 / 240.0).unwrap();
            most = most.max(sim.max_tension().tension_n);
        }
        println!("{segments} bars: {most:.2} N");
        assert!((most / 237.1 - 1.0).abs() < 5e-3, "{segments} bars: {most} N");
    }
}

#[test]
#[ignore = "half an hour: the table of the drop"]
fn the_table_of_the_drop() {
    let asked = |name: &str| std::env::var(name).ok().and_then(|v| v.parse::<f64>().ok());
    let starts = asked("STARTS").map_or(16, |n| n as usize);
    for bending in [0.0, 0.3, 1.0, 3.0].into_iter().filter(|b| asked("BENDING").is_none_or(|a| a == *b)) {
        let chains = asked("CHAIN").map_or(vec![42, 84], |n| vec![n as usize]);
        for n in chains.into_iter().filter(|n| *n > 0) {
            let found = medians(4, |aside| rubble::by_chain(&rubble::scene(n, aside, bending), 0.6, 2e5));
            show(&format!("EI {bending}, explicit chain of {n} bars"), &found);
        }
        for rate in [240.0, 960.0, 3840.0].into_iter().filter(|r| asked("RATE").is_none_or(|a| a == *r)) {
            let peaks = [42, 84, 168, 336].map(|n| {
                let found = medians(starts, |aside| rubble::by_fem(&rubble::scene(n, aside, bending), 1.0 / rate));
                show(&format!("EI {bending}, steps of 1/{rate} s, {n} bars"), &found);
                found[0][0]
            });
            // Without bending stiffness: what holds today (1.10, 1.12 and 1.34, of sixteen starts).
            // The aim is 1.15 at each step.
            if bending == 0.0 {
                let (least, most) = peaks[1..].iter().fold((f64::INFINITY, 0.0f64), |(a, b), p| (a.min(*p), b.max(*p)));
                let allowed = if rate > 1000.0 { 1.35 } else { 1.25 };
                assert!(most / least < allowed, "steps of 1/{rate} s: {peaks:?} N");
            }
        }
    }
}
