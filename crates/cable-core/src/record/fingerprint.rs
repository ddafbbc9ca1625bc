//! A fingerprint tells whether two runs, or two files, are the same to the bit.

use crate::solution::{Node, Solution};

/// A 64-bit hash of every number of the answers it was shown, or of bytes (FNV-1a, after G. Fowler,
/// L. C. Noll and K.-P. Vo, 1991): two runs with the same one are the same, but for one chance in
/// 1.8e19.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(pub u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Takes in an answer: its time, where every node is and what pulls there, and the robot.
    pub fn push(&mut self, solution: &Solution) {
        self.number(solution.time_s);
        for node in solution.cables.iter().flat_map(|c| &c.nodes) {
            let Node { arc_length_m, x_m, y_m, vx_m_per_s, vy_m_per_s, tension_n, .. } = *node;
            for value in [arc_length_m, x_m, y_m, vx_m_per_s, vy_m_per_s, tension_n] {
                self.number(value);
            }
        }
        if let Some(r) = &solution.robot {
            for value in [r.x_m, r.y_m, r.speed_m_per_s, r.thrust_n, r.hitch_x_n, r.hitch_y_n] {
                self.number(value);
            }
        }
    }

    fn number(&mut self, value: f64) {
        self.bytes(&value.to_bits().to_le_bytes());
    }

    /// Takes in bytes of a file.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}
