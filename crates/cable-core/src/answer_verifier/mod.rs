//! The verifier checks answers against the laws they must obey, from scene and [`Solution`] alone.
//!
//! | room | what is in it |
//! |---|---|
//! | `mod.rs` | [`Verifier`]: checks the laws of an answer; the result is a [`Verification`] |
//! | `checked_cable.rs` | one cable with the quantities that the laws need: forces, bars,
//! neighbouring obstacles |
//! | `well_formed_answer.rs` | finite numbers, and nodes in order along the material |
//! | `penetration.rs` | no cable lies inside an obstacle or itself |
//! | `balance.rs` | forces on each piece, contacts and their friction, momentum |
//! | `flexible_cable.rs`, `stiff_cable.rs` | tension, length and bending moment from node to node |
//! | `surroundings.rs` | obstacles and the robot: distances by brute force, normals, friction |
//! | `stability.rs` | whether a stiff cable bears its compression |
//! | `supports.rs`, `support_hold.rs` | whether the cable is at its supports; the action of each
//! support |
//! | `pulleys.rs` | the capstan law between the tensions beside eyes and wheels |
//! | `tolerance.rs` | every tolerance, each with its reason |
//!
//! No code is shared with the models or with their contact geometry, so a fault there cannot hide
//! itself here. The laws are: each piece of cable is balanced; every force on it other than
//! supports, loads and weight comes from an obstacle that touches it there, pushes, and lies within
//! the given friction cone; the path through the nodes fits the strained material; a flexible cable
//! has no compression; no cable lies inside an obstacle. In motion the forces on a piece do not
//! balance; there the momentum of each cable must change by the impulses of its account of the
//! step.

mod balance;
mod checked_cable;
mod flexible_cable;
mod penetration;
mod pulleys;
mod stability;
mod stiff_cable;
mod support_hold;
mod supports;
mod surroundings;
#[cfg(test)]
mod tests;
mod tolerance;
mod well_formed_answer;

use serde::{Deserialize, Serialize};

use self::checked_cable::CheckedCable;
use self::surroundings::Obstacles;
use crate::scene::Scene;
use crate::solution::robot_report::RobotReport;
use crate::solution::{CableSolution, Solution};
pub use crate::verification_report::{Balance, Finding, Law, NotChecked, Verification};

/// Extent of the check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Depth {
    /// The check of every answer: obstacles within the bounding box of a bar.
    #[default]
    Always,
    /// Also the cable against itself, on request. The time grows with the square of the number of
    /// nodes.
    Full,
}

/// Checks answers of one scene.
#[derive(Clone, Debug)]
pub struct Verifier {
    obstacles: Obstacles,
}

impl Verifier {
    /// A verifier for a validated scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self { obstacles: Obstacles::new(scene) }
    }

    /// Checks every law for an answer of `scene`, for which the verifier was made.
    #[must_use]
    pub fn check(&self, scene: &Scene, solution: &Solution, depth: Depth) -> Verification {
        self.check_cables(scene, &solution.cables, solution.robot.as_ref(), solution.time_s, depth)
    }

    /// Checks the answers of cables and robot at a time, s.
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
            check(&mut found, &CheckedCable::new(&surroundings, scene, cable, answer, time_s), depth);
        }
        found
    }
}

/// Checks the laws for one cable.
fn check(found: &mut Verification, checked: &CheckedCable<'_>, depth: Depth) {
    let (cable, answer) = (checked.cable, checked.answer);
    found.ask(Law::Finite);
    if let Some(finding) = well_formed_answer::not_finite(checked) {
        found.report(finding);
        return;
    }
    if !well_formed_answer::check_material(checked, found) {
        return;
    }
    let near = checked.neighbours();
    penetration::check_penetration(checked, found, &near);
    balance::check_contacts(checked, found);
    if answer.assumptions.inertia || !answer.breaks.is_empty() {
        let cable = cable.name.clone();
        found.not_checked.push(match answer.breaks.is_empty() {
            true => NotChecked::MovingBalance { cable },
            false => NotChecked::BrokenBalance { cable },
        });
        balance::check_momentum(checked, found);
    } else {
        supports::check_supports(checked, found);
        balance::check_balance(checked, found, &near);
        if answer.assumptions.bending_stiffness_n_m2 > 0.0 {
            stiff_cable::check_stiff(checked, found);
            stability::check_stability(checked, found, &near);
        } else {
            flexible_cable::check_flexible(checked, found, &near);
            pulleys::check_pulleys(checked, found);
        }
    }
    if cable.self_contact && depth == Depth::Full {
        penetration::check_self_contact(checked, found);
    } else if cable.self_contact {
        found.not_checked.push(NotChecked::SelfContact { cable: cable.name.clone() });
    }
}
