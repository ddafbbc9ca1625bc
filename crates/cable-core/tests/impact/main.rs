//! Cables that fall on rough ground, against an independent explicit chain.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod explicit_chain;
mod peaks;
mod rubble;

const G: f64 = cable_core::scene::STANDARD_GRAVITY;

use peaks::median;

/// Development driver: N, step, bending, starts.
#[test]
#[ignore = "for looking"]
fn look() {
    let get = |name: &str, or: &str| std::env::var(name).unwrap_or(or.to_owned());
    let numbers = |text: String| text.split(',').map(|t| t.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let bending: f64 = get("EI", "0").parse().unwrap();
    let starts: usize = get("STARTS", "4").parse().unwrap();
    let chain = get("CHAIN", "") != "";
    for rate in numbers(get("RATE", "960")) {
        for n in numbers(get("N", "42,84,168,336")) {
            let began = std::time::Instant::now();
            let (mut peak, mut mean, mut chatter) = (vec![], vec![], vec![]);
            for aside in rubble::shifts(starts.max(2)).into_iter().take(starts) {
                let scene = rubble::scene(n as usize, aside, bending);
                let t = if chain {
                    rubble::by_chain(&scene, 1.0 / rate, get("K", "2e5").parse().unwrap())
                } else {
                    rubble::by_fem(&scene, 1.0 / rate)
                };
                peak.push(t.peak().0);
                mean.push(t.mean_peak(4e-3));
                chatter.push(t.chatter(rubble::LIES_FROM_S));
                if get("EACH", "") != "" {
                    println!("   {aside:.1e}: {:.0} N at {:.4} s; 4 ms {:.0}; chatter {:.3}", t.peak().0, t.peak().1, mean[mean.len()-1], chatter[chatter.len()-1]);
                }
            }
            let show = |v: Vec<f64>| { let [m, a, b] = median(v); format!("{m:.1} [{a:.1} {b:.1}]") };
            println!("EI {bending} rate {rate} N {n}: peak {} 4ms {} chatter {}  ({:.1} s each)", show(peak), show(mean), show(chatter), began.elapsed().as_secs_f64() / starts as f64);
        }
    }
}
