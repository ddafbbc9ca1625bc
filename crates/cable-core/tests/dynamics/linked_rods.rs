//! This is an independent chain: rigid massless links with the mass in their joints, angles as
//! unknowns, Runge–Kutta 4.
//!
//! With link length a, t_j = (cos θ_j, sin θ_j), T_j the tension of link j, m_j the mass of the
//! joint after it:
//! ```text
//! a_j = g + (T_{j+1} t_{j+1} − T_j t_j)/m_j,    t_j·(a_j − a_{j−1}) = −a θ̇_j²,    a θ̈_j = n_j·(a_j − a_{j−1})
//! ```
//! The middle equations are tridiagonal in T; the joint before the first link stands still.

use cable_core::Vec2;

use super::measure::G;

/// The chain: angles and their rates.
#[derive(Clone)]
pub struct Rods {
    /// Link length, m.
    pub link: f64,
    /// Angle of each link, rad.
    pub angle: Vec<f64>,
    /// Its rate, rad/s.
    pub rate: Vec<f64>,
}

impl Rods {
    /// At rest.
    pub fn new(link: f64, angle: Vec<f64>) -> Self {
        let rate = vec![0.0; angle.len()];
        Self { link, angle, rate }
    }

    /// The free end, m.
    pub fn tip(&self) -> Vec2 {
        self.angle.iter().map(|q| Vec2::new(q.cos(), q.sin()) * self.link).sum()
    }

    /// Angular accelerations, 1/s². Masses per metre cancel.
    fn acceleration(&self) -> Vec<f64> {
        let n = self.angle.len();
        let t: Vec<Vec2> = self.angle.iter().map(|q| Vec2::new(q.cos(), q.sin())).collect();
        let m: Vec<f64> = (0..n).map(|j| self.link * if j + 1 < n { 1.0 } else { 0.5 }).collect();
        let gravity = Vec2::new(0.0, -G);
        // Rows: low T_{j−1} + mid T_j + high T_{j+1} = right.
        let (mut high, mut right) = (vec![0.0; n], vec![0.0; n]);
        for j in 0..n {
            let low = if j > 0 { t[j - 1].dot(&t[j]) / m[j - 1] } else { 0.0 };
            let mid = -1.0 / m[j] - if j > 0 { 1.0 / m[j - 1] } else { 0.0 };
            let up = if j + 1 < n { t[j].dot(&t[j + 1]) / m[j] } else { 0.0 };
            let mut r = -self.link * self.rate[j] * self.rate[j];
            if j == 0 {
                r -= t[0].dot(&gravity);
            }
            let (before_high, before_right) = if j > 0 { (high[j - 1], right[j - 1]) } else { (0.0, 0.0) };
            let pivot = mid - low * before_high;
            high[j] = up / pivot;
            right[j] = (r - low * before_right) / pivot;
        }
        let mut tension = right;
        for j in (0..n - 1).rev() {
            tension[j] -= high[j] * tension[j + 1];
        }
        let mut before = Vec2::zeros();
        (0..n)
            .map(|j| {
                let after = if j + 1 < n { t[j + 1] * tension[j + 1] } else { Vec2::zeros() };
                let a = gravity + (after - t[j] * tension[j]) / m[j];
                let along = a - before;
                before = a;
                (-t[j].y * along.x + t[j].x * along.y) / self.link
            })
            .collect()
    }

    /// One step of Runge–Kutta 4, s.
    pub fn step(&mut self, h: f64) {
        let n = self.angle.len();
        let start = self.clone();
        let mut sum = (vec![0.0; n], vec![0.0; n]);
        for (weight, ahead) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            let (rate, acceleration) = (self.rate.clone(), self.acceleration());
            for j in 0..n {
                sum.0[j] += weight / 6.0 * rate[j];
                sum.1[j] += weight / 6.0 * acceleration[j];
                self.angle[j] = start.angle[j] + ahead * h * rate[j];
                self.rate[j] = start.rate[j] + ahead * h * acceleration[j];
            }
        }
        for j in 0..n {
            self.angle[j] = start.angle[j] + h * sum.0[j];
            self.rate[j] = start.rate[j] + h * sum.1[j];
        }
    }

    /// Motion and height, J per kg/m.
    pub fn energy(&self) -> f64 {
        let (mut x, mut v, mut sum) = (Vec2::zeros(), Vec2::zeros(), 0.0);
        for j in 0..self.angle.len() {
            let (sin, cos) = self.angle[j].sin_cos();
            x += Vec2::new(cos, sin) * self.link;
            v += Vec2::new(-sin, cos) * (self.link * self.rate[j]);
            let mass = self.link * if j + 1 < self.angle.len() { 1.0 } else { 0.5 };
            sum += mass * (0.5 * v.norm_squared() + G * x.y);
        }
        sum
    }
}
