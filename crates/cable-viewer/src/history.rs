//! Tension and reactions against time, of bounded length.

use std::collections::VecDeque;

use cable_core::Solution;

/// One instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Largest tension over all cables, N.
    pub max_tension_n: f64,
    /// Energy of motion, of height, of stretch and of bending, J.
    pub energy_j: [f64; 4],
    /// Speed of the robot along the ground, m/s, and the pull of the cable on it, N; None without one.
    pub robot: Option<[f64; 2]>,
    /// Force of the cable on each support (cables one after the other, in the scene's order), N.
    pub reactions_n: Vec<[f64; 2]>,
}

impl Sample {
    /// What the history keeps of an answer.
    #[must_use]
    pub fn of(solution: &Solution) -> Self {
        Self {
            time_s: solution.time_s,
            max_tension_n: solution.max_tension().tension_n,
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

/// The samples since the last start, oldest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// At most [`History::CAPACITY`]; times increase.
    pub samples: VecDeque<Sample>,
}

impl History {
    /// Longest history: twenty minutes at 60 samples a second, 12 MB. Longer costs memory and plot time,
    /// shorter forgets a whole drive through the tank.
    pub const CAPACITY: usize = 72_000;

    /// Adds an instant; one at or before the last replaces what came after it.
    pub fn push(&mut self, sample: Sample) {
        while self.samples.back().is_some_and(|last| !(last.time_s < sample.time_s)) {
            self.samples.pop_back();
        }
        if self.samples.len() == Self::CAPACITY {
            self.samples.pop_front();
        }
        self.samples.push_back(sample);
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.samples.clear();
    }
}
