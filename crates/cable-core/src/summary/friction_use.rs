//! This module tells how much of their friction the contacts of a cable use.

use serde::{Deserialize, Serialize};

use crate::scene::{Cable, Scene};
use crate::solution::CableSolution;

/// Friction of the contacts with obstacles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionUse {
    /// Sum of the sizes of their friction forces, N.
    pub used_n: f64,
    /// Sum of μ times their normal forces, N.
    pub available_n: f64,
    /// The greatest share that one contact uses of its own: 1 = it is about to slide or slides.
    pub greatest_ratio: f64,
    /// Name of the obstacle.
    pub obstacle: String,
    /// Its middle, m.
    pub arc_length_m: f64,
}

/// Contacts whose normal force is below this part of the greatest are not asked how much of their
/// friction they use: both are rounding. Larger: light contacts that slide are not seen. Smaller:
/// nothing divided by nothing is the greatest share.
const MIN_NORMAL_FRACTION: f64 = 1e-6;

/// The friction that the contacts of a cable use; `None` if none of them can rub.
pub(super) fn friction_use(scene: &Scene, cable: &Cable, answer: &CableSolution) -> Option<FrictionUse> {
    let coefficient = |name: &str| {
        let obstacle = scene.obstacles.iter().find(|o| o.name == name);
        obstacle.and_then(|o| o.friction).unwrap_or(cable.friction)
    };
    let pressed = answer.contacts.iter().map(|c| c.normal_n).fold(0.0, f64::max);
    let mut out: Option<FrictionUse> = None;
    for c in answer.contacts.iter().filter(|c| c.normal_n > MIN_NORMAL_FRACTION * pressed) {
        let (used, available) = (c.friction_n.abs(), coefficient(&c.obstacle) * c.normal_n);
        if !(available > 0.0) {
            continue;
        }
        let one = FrictionUse {
            used_n: used,
            available_n: available,
            greatest_ratio: used / available,
            obstacle: c.obstacle.clone(),
            arc_length_m: c.arc_length_m,
        };
        out = Some(match out {
            None => one,
            Some(all) => {
                let (used_n, available_n) = (all.used_n + used, all.available_n + available);
                FrictionUse { used_n, available_n, ..if one.greatest_ratio > all.greatest_ratio { one } else { all } }
            }
        });
    }
    out
}
