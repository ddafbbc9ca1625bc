//! This module computes the forces on a dead load that lies on a boundary, see `point_load`.

use crate::math::{Vec2, larger};
use crate::model::spans::section::{CableSection, EndCondition, SolveContext};

/// Forces on a load.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct LoadBalance {
    /// V, N, and the part of it that does not turn with the boundary.
    pub sum: Vec2,
    pub fixed: Vec2,
    pub tangent: Vec2,
    pub normal: Vec2,
    /// Greatest of the forces in V, N.
    pub size: f64,
}

impl LoadBalance {
    /// N.
    pub fn press(&self) -> f64 {
        -self.sum.dot(&self.normal)
    }
}

/// Forces on the load of contact j.
pub(in crate::model::spans) fn load_balance(section: &CableSection, context: &SolveContext, j: usize) -> LoadBalance {
    let c = &section.contacts[j];
    let place = context.contact_path(c).place(c.ends.place[0]);
    let own = load(section, context, j);
    let (mut fixed, mut along, mut size) = (own, 0.0, own.norm());
    for (side, sign) in [(0, -1.0), (1, 1.0)] {
        if let Some(force) = section.force_at_contact(context, j, side) {
            fixed += force * sign;
            size = larger(size, force.norm());
        } else if section.is_joined(j, side) {
            let (tension, beside) = (section.forces[j + side].x, &section.contacts[j + 2 * side - 1]);
            size = larger(size, tension.abs());
            if beside.chain_range == c.chain_range {
                along += tension * sign;
            } else {
                fixed += context.contact_path(beside).place(beside.ends.place[1 - side]).tangent * (tension * sign);
            }
        }
    }
    LoadBalance { sum: fixed + place.tangent * along, fixed, tangent: place.tangent, normal: place.normal, size }
}

/// P of the load of contact j, N.
fn load(section: &CableSection, context: &SolveContext, j: usize) -> Vec2 {
    let s = section.contacts[j].ends.material[0];
    for (side, end) in [(0, 0), (1, section.contacts.len() - 1)] {
        if let (true, EndCondition::Loose(force)) = (j == end, section.end_conditions[side]) {
            return force;
        }
    }
    context.load_at(s)
}
