//! These functions read peaks off a history of tensions.

/// Tensions at fixed places of the material, N, over even steps.
pub struct Tensions {
    pub step_s: f64,
    pub rows: Vec<Vec<f64>>,
}

/// Places at which tension is read, evenly spread along the cable.
pub const PLACES: usize = 112;

/// Tension at the even places of a cable of this length (m) from that at arc lengths (m).
pub fn spread(length: f64, arc_length: &[f64], tension: &[f64]) -> Vec<f64> {
    (0..PLACES)
        .map(|k| {
            let s = length * (k as f64 + 0.5) / PLACES as f64;
            let j = arc_length.partition_point(|a| *a <= s).clamp(1, arc_length.len() - 1);
            let (a, b) = (arc_length[j - 1], arc_length[j]);
            let part = if b > a { (s - a) / (b - a) } else { 0.0 };
            tension[j - 1] * (1.0 - part) + tension[j] * part
        })
        .collect()
}

impl Tensions {
    /// The greatest tension of an instant, N, and when, s.
    pub fn peak(&self) -> (f64, f64) {
        let mut best = (0.0, 0.0);
        for (i, row) in self.rows.iter().enumerate() {
            for &t in row {
                if t > best.0 || t.is_nan() {
                    best = (t, i as f64 * self.step_s);
                }
            }
        }
        best
    }

    /// The greatest mean over `window_s` (s) of the tension of one place, N.
    pub fn mean_peak(&self, window_s: f64) -> f64 {
        let count = ((window_s / self.step_s).round() as usize).max(1);
        let mut best: f64 = 0.0;
        for place in 0..PLACES {
            let mut sum = 0.0;
            for i in 0..self.rows.len() {
                sum += self.rows[i][place];
                if i >= count {
                    sum -= self.rows[i - count][place];
                }
                if i + 1 >= count {
                    best = best.max(sum / count as f64);
                }
            }
        }
        best
    }

    /// Standard deviation of the greatest tension from `from_s` (s) on, N.
    pub fn chatter(&self, from_s: f64) -> f64 {
        let most: Vec<f64> = (self.rows.iter().enumerate())
            .filter(|(i, _)| *i as f64 * self.step_s >= from_s)
            .map(|(_, row)| row.iter().copied().fold(0.0, f64::max))
            .collect();
        let mean = most.iter().sum::<f64>() / most.len() as f64;
        (most.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / most.len() as f64).sqrt()
    }
}

/// The median, and the least and the greatest.
pub fn median(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    let middle = if n % 2 == 1 { values[n / 2] } else { 0.5 * (values[n / 2 - 1] + values[n / 2]) };
    [middle, values[0], values[n - 1]]
}
