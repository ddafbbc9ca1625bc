//! Numbers are drawn from a seed, the same on every machine.

#[path = "../../../crates/cable-core/tests/dice/mod.rs"]
mod dice;

use dice::MmixDice;

/// The draws of a scene.
pub struct Chance(MmixDice);

impl Chance {
    /// Draws of a family and a seed share nothing with those of another.
    pub fn new(family: &str, seed: u64) -> Self {
        let name =
            family.bytes().fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
        let mut chance = Self(MmixDice(name ^ seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        for _ in 0..8 {
            chance.next();
        }
        chance
    }

    /// In [0, 1).
    pub fn next(&mut self) -> f64 {
        self.0.unit()
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0.within(low, high)
    }

    /// Evenly in the logarithm.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.0.log(low, high)
    }

    pub fn says(&mut self, probability: f64) -> bool {
        self.0.chance(probability)
    }

    /// One of `count`.
    pub fn one_of(&mut self, count: usize) -> usize {
        ((self.next() * count as f64) as usize).min(count - 1)
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        self.0.pick(from)
    }

    /// Nothing with the given probability, else within the bounds.
    pub fn or_nothing(&mut self, nothing: f64, low: f64, high: f64) -> f64 {
        if self.says(nothing) { 0.0 } else { self.within(low, high) }
    }
}
