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

/// Development: series of one run.
#[test]
#[ignore = "for looking"]
fn series() {
    let get = |name: &str, or: &str| std::env::var(name).unwrap_or(or.to_owned());
    let num = |name: &str, or: &str| get(name, or).parse::<f64>().unwrap();
    let scene = rubble::scene(num("N", "84") as usize, num("ASIDE", "0"), num("EI", "0"));
    let rate = num("RATE", "960");
    let t = if get("CHAIN", "") != "" { rubble::by_chain(&scene, 1.0 / rate, 2e5) } else { rubble::by_fem(&scene, 1.0 / rate) };
    let (from, to, every) = (num("FROM", "0"), num("TO", "2"), num("STRIDE", "1") as usize);
    for (i, row) in t.rows.iter().enumerate() {
        let time = i as f64 * t.step_s;
        if time >= from && time <= to && i % every == 0 {
            let k = (0..row.len()).max_by(|a, b| row[*a].total_cmp(&row[*b])).unwrap();
            println!("{time:.5} {k} {:.2} | {}", row[k], row.iter().step_by(8).map(|t| format!("{t:.0}")).collect::<Vec<_>>().join(" "));
        }
    }
}
