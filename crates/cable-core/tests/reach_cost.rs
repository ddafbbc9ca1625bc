//! The cost of a map of safe reach on the tank is printed, not asserted.
//! `cargo test -p cable-core --test reach_cost -- --nocapture --ignored`.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)]

use std::ops::ControlFlow;
use std::time::Instant;

use cable_core::analysis::safe_reach::area::{ReachQuery, area};
use cable_core::analysis::safe_reach::line::robot_reach;
use cable_core::scene::catalog;
use cable_core::{Scene, Settings};

/// CPU time of this thread so far, s; 0 where it is not known. Linux only.
fn cpu_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    stat.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok()).map_or(0.0, |ns| ns * 1e-9)
}

/// A robot there and back, 41 places.
#[test]
#[ignore = "a minute"]
fn cost_of_a_robot() {
    print_cost(&catalog::robot_drive(), [-2.0, 20.0]);
}

/// The robot of the opening scene along the ground of its tank, as its window asks.
#[test]
#[ignore = "a minute"]
fn cost_of_the_robot_in_the_tank() {
    print_cost(&catalog::tank_robot(), [-7.2, 7.2]);
}

/// Issue 20: the safe reach of the opening scene ended in "no solution found" for places below 0.57
/// m, after a minute: the robot had driven into its own slack cable, and the heap that held it was
/// relaxed in vain.
#[test]
fn issue_020_a_robot_that_backs_into_its_slack_cable_is_jammed_by_it() {
    let (scene, settings) = (catalog::tank_robot(), Settings::default());
    let map = robot_reach(&scene, None, settings, [-1.2, 4.2], 9, |_, _| ControlFlow::Continue(())).unwrap();
    for p in &map.places {
        assert!(!p.there_n.is_nan() && !p.there_and_back_n.is_nan(), "{p:?}");
        assert_eq!(p.jammed, p.there_and_back_n.is_infinite(), "{p:?}");
    }
    assert!(map.places[0].jammed && !map.places[8].jammed, "{map:?}");
}

fn print_cost(scene: &Scene, ends_m: [f64; 2]) {
    let (began, cpu, mut told) = (Instant::now(), cpu_s(), -1.0);
    let map = robot_reach(scene, None, Settings::default(), ends_m, 41, |map, share| {
        if share > told + 0.1 {
            told = share;
            let back = map.places.iter().filter(|p| !p.there_and_back_n.is_nan()).count();
            println!(
                "{:5.1} s of CPU: {:3.0} %, {} places, back from {back}",
                cpu_s() - cpu,
                100.0 * share,
                map.places.len()
            );
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    println!("{:5.1} s of CPU, {:.1} s", cpu_s() - cpu, began.elapsed().as_secs_f64());
    for p in &map.places {
        println!(
            "{:6.2} m {:9.0} N there, {:9.0} N and back{}",
            p.at_m[0],
            p.there_n,
            p.there_and_back_n,
            if p.jammed { ", jammed" } else { "" }
        );
    }
}

#[test]
#[ignore = "a minute"]
fn cost_on_the_tank() {
    let across: usize = std::env::var("ACROSS").ok().and_then(|v| v.parse().ok()).unwrap_or(16);
    let (low, high) = ([-14.0, -2.0], [14.0, 12.0]);
    let ask = ReachQuery {
        scene: catalog::tank(),
        now: None,
        settings: Settings::default(),
        cable: 0,
        support: 1,
        corners_m: [low, high],
        spacing_m: (high[0] - low[0]) / across as f64,
        back: std::env::var("BACK").is_ok(),
    };
    let (began, cpu) = (Instant::now(), cpu_s());
    let mut told = -1.0;
    let found = area(&ask, |so_far, share| {
        if share > told + 0.1 {
            told = share;
            let known = so_far.most_n.iter().filter(|n| !n.is_nan()).count();
            println!(
                "{:5.1} s: {:3.0} %, {known} of {}",
                began.elapsed().as_secs_f64(),
                100.0 * share,
                so_far.most_n.len()
            );
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    let guessed = found.guessed.iter().filter(|g| **g).count();
    println!("{:5.1} s of CPU, {:.1} s; {guessed} places guessed", cpu_s() - cpu, began.elapsed().as_secs_f64());
    for row in found.most_n.chunks(found.columns).rev() {
        let text = |n: &f64| match *n {
            n if n.is_nan() => "    .".to_owned(),
            n if n.is_infinite() => "   oo".to_owned(),
            n => format!("{n:5.0}"),
        };
        println!("{}", row.iter().map(text).collect::<String>());
    }
}
