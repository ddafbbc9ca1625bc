//! The verifier checks answers against the laws they must obey, from scene and [`Solution`] alone.
//!
//! | room | what is in it |
//! |---|---|
//! | `mod.rs` | [`Verifier`]: asks the laws of an answer; which and what was found is a [`Verification`] |
//! | `laws.rs` | one function a law, over one cable |
//! | `surroundings.rs` | obstacles and the robot as the checker sees them: distances by brute force, normals, friction |
//! | `stability.rs` | whether a stiff cable holds what it pushes with |
//! | `supports.rs` | what supports do to the cable, and whether it is where they hold it |
//! | `pulleys.rs` | what friction of eyes and wheels allows between the tensions beside them |
//! | `tolerance.rs` | every tolerance, each with its reason |
//!
//! Nothing here is shared with the models or with their contact geometry: a fault there cannot hide
//! itself here. What is asked: each piece of cable is balanced, whatever acts on it that is neither
//! a support nor a load nor weight comes from an obstacle that touches it there, pushes, and lies
//! within the friction cone that was given; the way drawn through the nodes is the material with
//! its strain; a flexible cable does not push; nothing lies inside anything. In motion forces on a
//! piece do not add up to nothing: there the momentum of each cable must change by the impulses
//! that its account of the step names.

mod laws;
mod pulleys;
mod stability;
mod supports;
mod surroundings;
#[cfg(test)]
mod tests;
pub mod tolerance;

use serde::{Deserialize, Serialize};

use self::surroundings::Obstacles;
use crate::scene::Scene;
use crate::solution::robot_report::RobotReport;
use crate::solution::{CableSolution, Solution};
pub use crate::verification::{Balance, Finding, Law, NotChecked, Verification};

/// Extent of the check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Depth {
    /// The check of every answer: obstacles that are within the box of a bar.
    #[default]
    Always,
    /// On request: the cable against itself as well. Time grows with the square of the number of
    /// nodes.
    Full,
}

/// Checks answers of one scene.
#[derive(Clone, Debug)]
pub struct Verifier {
    obstacles: Obstacles,
}

impl Verifier {
    /// For a scene that was validated.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self { obstacles: Obstacles::new(scene) }
    }

    /// Asks every law of an answer of `scene`, the one it was made for.
    #[must_use]
    pub fn check(&self, scene: &Scene, solution: &Solution, depth: Depth) -> Verification {
        self.check_cables(scene, &solution.cables, solution.robot.as_ref(), solution.time_s, depth)
    }

    /// The same of the answers for its cables and of its robot at a time, s.
    pub(crate) fn check_cables(
        &self,
        scene: &Scene,
        answers: &[CableSolution],
        robot: Option<&RobotReport>,
        time_s: f64,
        depth: Depth,
    ) -> Verification {
        let mut found = Verification::default();
        let surroundings = self.obstacles.at(robot);
        for (cable, answer) in scene.cables.iter().zip(answers) {
            laws::check(&mut found, laws::CheckedCable::new(&surroundings, scene, cable, answer, time_s), depth);
        }
        found
    }
}
