//! Mach and Froude numbers are of the run with inertia: its speeds beside those of waves and falls.

use crate::math::larger;
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::solution::MotionNumbers;

impl MotionNumbers {
    /// The numbers of the run so far, with those of a simulation's present instant.
    pub(super) fn with(mut self, simulation: &Simulation) -> Self {
        let Scene { cables, environment, .. } = simulation.scene();
        for (cable, answer) in cables.iter().zip(simulation.answers()) {
            let speed = answer.nodes.iter().map(|n| n.vx_m_per_s.hypot(n.vy_m_per_s)).fold(0.0, larger);
            let wave = (cable.axial_stiffness_n / cable.linear_density_kg_per_m).sqrt();
            let gravity = (environment.gravity_m_per_s2.abs() * cable.length_m).sqrt();
            self.greatest_speed_m_per_s = larger(self.greatest_speed_m_per_s, speed);
            if wave > 0.0 {
                self.mach = larger(self.mach, speed / wave);
            }
            if gravity > 0.0 {
                self.froude = Some(larger(self.froude.unwrap_or(0.0), speed / gravity));
            }
        }
        self
    }
}
