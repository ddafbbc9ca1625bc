//! This module derives the action of each support on the cable from scene and answer.

use crate::math::{Vec2, vec2};
use crate::scene::{Cable, Scene, Support, SupportKind, View};
use crate::solution::{CableSolution, SupportReaction};

/// Time before its release from which a support counts as released, s: the rounding of a sum of
/// steps. Smaller: it holds a step longer than in the models; larger: a step shorter.
const RELEASE_ROUNDING_S: f64 = 1e-9;

/// Present action of a support on the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// It holds a point of the cable in its place.
    Held,
    /// The cable runs through a point.
    Pulley,
    /// The cable runs over a wheel.
    Wheel {
        /// Of the centre line, m.
        radius: f64,
    },
    /// The cable hangs clear of a wheel.
    Clear {
        /// Of the centre line round it, m.
        radius: f64,
    },
    /// A given force, or nothing.
    Load,
    /// It has released the cable.
    Released,
}

/// A support as the scene gives it and the answer reports it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupportHold<'a> {
    pub support: &'a Support,
    pub role: Role,
    /// Place, m.
    pub at: Vec2,
    /// Arc length of the cable there, m.
    pub arc_length: f64,
    pub reaction: &'a SupportReaction,
}

/// The supports of a cable at a time, s.
pub(super) fn support_holds<'a>(cable: &'a Cable, answer: &'a CableSolution, time_s: f64) -> Vec<SupportHold<'a>> {
    let last = cable.supports.len().saturating_sub(1);
    let hold = |(k, (support, reaction)): (usize, (&'a Support, &'a SupportReaction))| {
        let released = support.release_s.is_some_and(|t| time_s >= t - RELEASE_ROUNDING_S);
        let wheel = support.radius_m.filter(|r| *r > 0.0);
        let role = match support.kind {
            SupportKind::Load | SupportKind::Free => Role::Load,
            _ if released => Role::Released,
            SupportKind::Pulley => wheel.map_or(Role::Pulley, |r| {
                let radius = r + 0.5 * cable.diameter_m;
                let pressed = reaction.reaction_x_n != 0.0 || reaction.reaction_y_n != 0.0;
                if pressed { Role::Wheel { radius } } else { Role::Clear { radius } }
            }),
            SupportKind::Fixed | SupportKind::Clamped | SupportKind::Robot => Role::Held,
        };
        let arc_length = match k {
            0 => 0.0,
            k if k == last => cable.length_m,
            _ => reaction.arc_length_m,
        };
        SupportHold { support, role, at: Vec2::new(reaction.x_m, reaction.y_m), arc_length, reaction }
    };
    cable.supports.iter().zip(&answer.supports).enumerate().map(hold).collect()
}

impl SupportHold<'_> {
    /// Its force on the cable as it is reported, N.
    pub fn force(&self) -> Vec2 {
        -Vec2::new(self.reaction.reaction_x_n, self.reaction.reaction_y_n)
    }

    /// Returns the force of a dead load, N.
    pub fn dead_load(&self, scene: &Scene, time_s: f64) -> Vec2 {
        let gravity = match scene.view {
            View::Elevation => Vec2::new(0.0, -scene.environment.gravity_m_per_s2),
            View::Plan => Vec2::zeros(),
        };
        let s = self.support;
        series(s.force_n, &s.times_s, &s.forces_n, time_s) + gravity * s.mass_kg.unwrap_or(0.0)
    }
}

/// A vector as a function of time: the constant, or linear between its times.
pub(super) fn series(constant: Option<[f64; 2]>, times: &[f64], values: &[[f64; 2]], time_s: f64) -> Vec2 {
    if times.is_empty() {
        return constant.map_or_else(Vec2::zeros, vec2);
    }
    let k = times.partition_point(|&t| t <= time_s);
    match (k.checked_sub(1).and_then(|i| values.get(i)), values.get(k)) {
        (Some(a), Some(b)) => {
            let f = (time_s - times[k - 1]) / (times[k] - times[k - 1]);
            vec2(*a) + (vec2(*b) - vec2(*a)) * f
        }
        (Some(v), None) | (None, Some(v)) => vec2(*v),
        (None, None) => Vec2::zeros(),
    }
}
