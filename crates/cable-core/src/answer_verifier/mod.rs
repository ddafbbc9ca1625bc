//! The verifier checks answers against the laws they must obey, from scene and [`Solution`] alone.
//!
//! | room | what is in it |
//! |---|---|
//! | `mod.rs` | [`Verifier`]: asks the laws of an answer; which and what was found is a [`Verification`] |
//! | `checked_cable.rs` | one cable as the laws see it: its forces, bars, and what touches them |
//! | `answer.rs` | every number is one, and nodes run along the material |
//! | `penetration.rs` | nothing lies inside anything |
//! | `balance.rs` | forces on each piece, contacts and their friction, momentum |
//! | `flexible_cable.rs`, `stiff_cable.rs` | tension, length and bending moment from node to node |
//! | `surroundings.rs` | obstacles and the robot as the checker sees them: distances by brute force, normals, friction |
//! | `stability.rs` | whether a stiff cable holds what it pushes with |
//! | `supports.rs`, `support_hold.rs` | whether the cable is where its supports hold it; what each does to it |
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

mod answer;
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
            check(&mut found, &CheckedCable::new(&surroundings, scene, cable, answer, time_s), depth);
        }
        found
    }
}

/// Asks the laws of one cable.
fn check(found: &mut Verification, checked: &CheckedCable<'_>, depth: Depth) {
    let (cable, answer) = (checked.cable, checked.answer);
    found.ask(Law::Finite);
    if let Some(finding) = answer::not_finite(checked) {
        found.report(finding);
        return;
    }
    if !answer::check_material(checked, found) {
        return;
    }
    let near = checked.near();
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
