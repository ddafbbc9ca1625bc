//! A step that fails returns to the checkpoint before it; folds are opened as a motion begins.

use crate::math::{cross, perp};
use crate::model::fem::dynamics::Dynamics;
use crate::model::fem::state::history::Checkpoint;

/// How far (parts of a bar) the middle of a fold is moved aside. Less: the fold opens later than it
/// would; more: its bars are stretched by half of the square of it.
const ASIDE: f64 = 1e-4;

/// Sine of the turn off a line below which a fold lies in it.
const FOLD_LINE_SINE: f64 = 1e-6;

impl Dynamics {
    /// Moves the middle of each fold that lies in one line a little aside, as a motion begins. In
    /// the line itself a bar would have to pass through no length to turn over: a weight that fell
    /// beside its slack cable hung in the fold.
    pub(in crate::model::fem) fn open_folds(&mut self) {
        let (mesh, x) = (&self.mesh, &mut self.motion.x);
        for k in 1..x.len().saturating_sub(1) {
            let (a, b) = (x[k] - x[k - 1], x[k + 1] - x[k]);
            let size = a.norm() * b.norm();
            if mesh.is_free(k) && a.dot(&b) < 0.0 && cross(a, b).abs() <= FOLD_LINE_SINE * size {
                x[k] += perp(a) * ASIDE;
            }
        }
    }

    /// Keeps the present state to go back to, in the memory of the one kept before.
    pub(in crate::model::fem) fn save(&mut self) {
        match &mut self.rollback.saved {
            Some(s) => {
                s.motion.copy_from(&self.motion);
                s.mesh.copy_from(&self.mesh, !self.meshing.never_slides);
                s.contacts.copy_from(&self.contacts);
                s.support_node.clone_from(&self.meshing.support_node);
                s.reaction.clone_from(&self.answers.reaction);
                s.load_node.clear();
                s.load_node.extend(self.meshing.loads.iter().map(|l| l.0));
            }
            None => {
                self.rollback.saved = Some(Box::new(Checkpoint {
                    motion: self.motion.clone(),
                    mesh: self.mesh.clone(),
                    contacts: self.contacts.clone(),
                    support_node: self.meshing.support_node.clone(),
                    load_node: self.meshing.loads.iter().map(|l| l.0).collect(),
                    reaction: self.answers.reaction.clone(),
                }));
            }
        }
        self.rollback.can_restore = true;
    }

    /// Goes back to the state kept, once.
    pub(in crate::model::fem) fn restore(&mut self) {
        if let Some(s) = self.rollback.saved.as_ref().filter(|_| self.rollback.can_restore) {
            self.motion.copy_from(&s.motion);
            self.mesh.copy_from(&s.mesh, !self.meshing.never_slides);
            self.contacts.copy_from(&s.contacts);
            self.meshing.support_node.clone_from(&s.support_node);
            self.answers.reaction.clone_from(&s.reaction);
            for (load, &node) in self.meshing.loads.iter_mut().zip(&s.load_node) {
                load.0 = node;
            }
            self.rollback.can_restore = false;
            self.place_outline();
            self.renew_task();
        }
    }
}
