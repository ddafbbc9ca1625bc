//! A sample holds the scalar quantities of one instant.

use cable_core::Solution;

/// One instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Largest tension over all cables, N: in any inner step since the sample before, or at its
    /// instant where that is larger, as warnings take it.
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
            max_tension_n: solution.max_tension().tension_n.max(solution.peaks().greatest.tension_n),
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

#[cfg(test)]
mod tests {
    use cable_core::Model;
    use cable_core::solution::{CableSolution, Cost, Energy, ModelReason, Node, TensionPeak, TensionPeaks};

    use super::*;

    /// A warning takes the greater of the two; a graph of inner steps alone stood below it.
    #[test]
    fn the_greatest_of_a_frame_is_below_neither_its_instant_nor_its_inner_steps() {
        let cable = |now_n: f64, inner_n: f64| {
            let node = Node { tension_n: now_n, ..Node::default() };
            let greatest = TensionPeak { tension_n: inner_n, ..TensionPeak::default() };
            let peaks = Some(TensionPeaks { greatest, ..TensionPeaks::default() });
            CableSolution { nodes: vec![node].into(), peaks, ..CableSolution::default() }
        };
        let sample = |cables: Vec<CableSolution>| {
            Sample::of(&Solution {
                time_s: 1.0,
                model: Model::Fem,
                reason: ModelReason::Requested,
                next_cheaper: None,
                cables,
                warnings: Vec::new(),
                cost: Cost::default(),
                energy: Energy::default(),
                robot: None,
                verification: None,
            })
        };
        assert_eq!(sample(vec![cable(5.0, 20.0)]).max_tension_n, 20.0);
        assert_eq!(sample(vec![cable(9.0, 5.0)]).max_tension_n, 9.0);
        assert_eq!(sample(vec![cable(9.0, 5.0), cable(3.0, 8.0)]).max_tension_n, 9.0);
    }
}
