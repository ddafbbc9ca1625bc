//! A sample holds the scalar quantities of one instant.

use cable_core::Solution;

/// One instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Largest tension over all cables in any inner step since the sample before, N.
    pub max_tension_n: f64,
    /// Energy of motion, of height, of stretch and of bending, J.
    pub energy_j: [f64; 4],
    /// Speed of the robot along the ground, m/s, and the pull of the cable on it, N; None without
    /// one.
    pub robot: Option<[f64; 2]>,
    /// Force of the cable on each support (cables one after the other, in the scene's order), N.
    pub reactions_n: Vec<[f64; 2]>,
}

impl Sample {
    /// Returns what the history keeps of an answer.
    #[must_use]
    pub fn of(solution: &Solution) -> Self {
        Self {
            time_s: solution.time_s,
            max_tension_n: solution.peaks().greatest.tension_n,
            energy_j: [
                solution.energy.kinetic_j,
                solution.energy.gravity_j,
                solution.energy.stretch_j,
                solution.energy.bending_j,
            ],
            robot: solution.robot.map(|r| [r.speed_m_per_s, r.hitch_x_n.hypot(r.hitch_y_n)]),
            reactions_n: solution
                .cables
                .iter()
                .flat_map(|c| c.supports.iter().map(|s| [s.reaction_x_n, s.reaction_y_n]))
                .collect(),
        }
    }
}

impl Sample {
    /// Its memory, bytes, with what the heap adds.
    pub(super) fn bytes(&self) -> usize {
        /// Of a piece of heap.
        const ALLOCATION_OVERHEAD_BYTES: usize = 16;
        size_of::<Self>() + ALLOCATION_OVERHEAD_BYTES + size_of_val(self.reactions_n.as_slice())
    }
}
