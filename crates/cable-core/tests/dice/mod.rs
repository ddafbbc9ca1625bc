//! The random numbers of random scenes are the same on every machine.

#![allow(dead_code)] // no test needs all of it

/// SplitMix64: G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom number
/// generators", OOPSLA 2014.
pub struct Dice(pub u64);

impl Dice {
    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        part_of_one(z ^ (z >> 31))
    }
}

/// The linear congruential generator of MMIX (D. Knuth, "The art of computer programming", volume
/// 2, 3.3.4), whose high bits are used. Seeds that are near each other begin alike, so a campaign
/// spreads its seeds and skips the first draws.
pub struct MmixDice(pub u64);

impl MmixDice {
    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        part_of_one(self.0)
    }
}

/// The high 53 bits of a number as a fraction.
fn part_of_one(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// Draws that are made of numbers in [0, 1).
macro_rules! draws {
    ($($dice:ty)*) => {$(
        impl $dice {
            pub fn within(&mut self, low: f64, high: f64) -> f64 {
                low + (high - low) * self.unit()
            }

            /// Evenly in the logarithm.
            pub fn log(&mut self, low: f64, high: f64) -> f64 {
                self.within(low.ln(), high.ln()).exp()
            }

            pub fn chance(&mut self, probability: f64) -> bool {
                self.unit() < probability
            }

            pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
                of[((self.unit() * of.len() as f64) as usize).min(of.len() - 1)]
            }
        }
    )*};
}

draws!(Dice MmixDice);
