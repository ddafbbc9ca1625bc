//! The momentum of a run is compared with the impulses of its account.

#![allow(dead_code)] // no test needs all of it

/// Momentum that came from nowhere, of the greatest impulse.
pub fn imbalance(account: &cable_core::solution::MomentumAccount) -> f64 {
    let [before, after] = [account.before_kg_m_per_s, account.after_kg_m_per_s];
    let change = [after[0] - before[0], after[1] - before[1]];
    let impulses = account.impulses_n_s();
    let sum = impulses.iter().fold([0.0; 2], |s, i| [s[0] + i[0], s[1] + i[1]]);
    let greatest = impulses.iter().map(|i| i[0].hypot(i[1])).fold(change[0].hypot(change[1]), f64::max);
    (change[0] - sum[0]).hypot(change[1] - sum[1]) / greatest
}

/// Says how large it is.
pub fn tell_imbalance(found: &[(f64, String)]) {
    let mut all: Vec<&(f64, String)> = found.iter().collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = |part: f64| all.get((part * all.len() as f64) as usize).map_or(0.0, |a| a.0);
    let Some((worst, place)) = all.last() else { return };
    println!(
        "momentum from nowhere in {} steps, of the greatest impulse: median {:.1e}, 99 % {:.1e}, 99.9 % {:.1e}, worst {worst:.1e} ({place})",
        all.len(),
        at(0.5),
        at(0.99),
        at(0.999)
    );
    if std::env::var("TELL").is_ok_and(|t| t == "momentum") {
        for (part, place) in all.iter().rev().take(20) {
            println!("  {part:.1e} {place}");
        }
    }
}
