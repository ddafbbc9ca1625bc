//! The random numbers of random scenes are the same on every machine.

#![allow(dead_code)] // no test needs all of it

/// SplitMix64: G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom number
/// generators", OOPSLA 2014.
pub struct Dice(pub u64);

impl Dice {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        self.within(low.ln(), high.ln()).exp()
    }

    pub fn chance(&mut self, part: f64) -> bool {
        self.unit() < part
    }
}

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
