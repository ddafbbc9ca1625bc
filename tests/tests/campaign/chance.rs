//! Numbers are drawn from a seed, the same on every machine.

/// A linear congruential generator (D. Knuth, "The art of computer programming", volume 2, 1981,
/// 3.3.4) whose high bits are used.
pub struct Chance(u64);

impl Chance {
    /// Draws of a family and a seed share nothing with those of another.
    pub fn new(family: &str, seed: u64) -> Self {
        let name =
            family.bytes().fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
        let mut chance = Self(name ^ seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        for _ in 0..8 {
            chance.next();
        }
        chance
    }

    /// In [0, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Evenly in the logarithm.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.within(low.ln(), high.ln()).exp()
    }

    pub fn says(&mut self, probability: f64) -> bool {
        self.next() < probability
    }

    /// One of `count`.
    pub fn one_of(&mut self, count: usize) -> usize {
        ((self.next() * count as f64) as usize).min(count - 1)
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.one_of(from.len())]
    }

    /// Nothing with the given probability, else within the bounds.
    pub fn or_nothing(&mut self, nothing: f64, low: f64, high: f64) -> f64 {
        if self.says(nothing) { 0.0 } else { self.within(low, high) }
    }
}
