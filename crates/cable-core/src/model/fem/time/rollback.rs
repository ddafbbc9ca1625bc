//! This module stores a checkpoint before each step and restores it if the step fails.

use crate::math::Vec2;
use crate::model::fem::mesh::Mesh;
use crate::model::fem::obstacle::place_bodies;
use crate::model::fem::state::{CableState, Meshing, NodalMotion, renew_input};
use crate::model::fem::system::ContactSet;

/// The stored state of a cable.
#[derive(Clone, Debug)]
struct Checkpoint {
    motion: NodalMotion,
    mesh: Mesh,
    contacts: ContactSet,
    support_node: Vec<Option<usize>>,
    /// Nodes of the loads; their number never changes.
    load_node: Vec<usize>,
    reaction: Vec<Vec2>,
}

/// The checkpoint that is restored when a step fails; a copy of the model stores its own.
#[derive(Debug, Default)]
pub(in crate::model::fem) struct Rollback {
    /// The last stored checkpoint, whose memory is reused.
    saved: Option<Box<Checkpoint>>,
    /// True if it belongs to the present step.
    can_restore: bool,
}

impl Clone for Rollback {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Rollback {
    /// A copy with the stored state.
    pub(in crate::model::fem) fn with_saved(&self) -> Self {
        Self { saved: self.saved.clone(), can_restore: self.can_restore }
    }

    /// Stores the present state in the memory of the previous checkpoint.
    pub(in crate::model::fem) fn save(&mut self, cable: &CableState) {
        match &mut self.saved {
            Some(s) => {
                s.motion.copy_from(&cable.motion);
                copy_mesh(&mut s.mesh, &cable.mesh, &cable.meshing);
                s.contacts.copy_from(&cable.contacts);
                s.support_node.clone_from(&cable.meshing.support_node);
                s.reaction.clone_from(&cable.answers.reaction);
                s.load_node.clear();
                s.load_node.extend(cable.meshing.loads.iter().map(|load| load.node));
            }
            None => {
                self.saved = Some(Box::new(Checkpoint {
                    motion: cable.motion.clone(),
                    mesh: cable.mesh.clone(),
                    contacts: cable.contacts.clone(),
                    support_node: cable.meshing.support_node.clone(),
                    load_node: cable.meshing.loads.iter().map(|load| load.node).collect(),
                    reaction: cable.answers.reaction.clone(),
                }));
            }
        }
        self.can_restore = true;
    }

    /// Restores the stored state, once.
    pub(in crate::model::fem) fn restore(&mut self, cable: &mut CableState) {
        if let Some(s) = self.saved.as_ref().filter(|_| self.can_restore) {
            cable.motion.copy_from(&s.motion);
            copy_mesh(&mut cable.mesh, &s.mesh, &cable.meshing);
            cable.contacts.copy_from(&s.contacts);
            cable.meshing.support_node.clone_from(&s.support_node);
            cable.answers.reaction.clone_from(&s.reaction);
            for (load, &node) in cable.meshing.loads.iter_mut().zip(&s.load_node) {
                load.node = node;
            }
            self.can_restore = false;
            place_bodies(cable);
            renew_input(cable);
        }
    }
}

/// Makes a mesh a copy of another; of sliding nodes, where there can be none, nothing is copied.
fn copy_mesh(to: &mut Mesh, from: &Mesh, meshing: &Meshing) {
    if meshing.never_slides { to.copy_material_nodes_from(from) } else { to.copy_from(from) }
}
