//! Undo and redo keep the scenes before and after the present one; a drag is one entry.

use cable_core::Scene;

/// Scenes to go back and forward to.
#[derive(Clone, Debug, Default)]
pub struct Undo {
    undo_stack: Vec<Scene>,
    redo_stack: Vec<Scene>,
    /// The kind of the last edit: further ones of the same kind (a drag, a slider) join it.
    last: Option<EditKind>,
}

/// A relation of an edit to the one before it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EditKind {
    /// It is an entry of its own.
    Single,
    /// It joins those of the same name that it follows at once: a drag, a slider.
    Series(String),
}

/// Most entries kept; the oldest are forgotten.
const MAX_ENTRIES: usize = 200;

impl Undo {
    /// Keeps `scene`, about to be changed by an edit of a kind.
    pub fn record(&mut self, scene: &Scene, kind: EditKind) {
        self.redo_stack.clear();
        let is_single = kind == EditKind::Single;
        if !is_single && self.last.as_ref() == Some(&kind) {
            return;
        }
        self.last = (!is_single).then_some(kind);
        if self.undo_stack.len() == MAX_ENTRIES {
            self.undo_stack.remove(0);
        }
        self.undo_stack.push(scene.clone());
    }

    /// The next edit is a new entry, whatever its kind.
    pub fn close_entry(&mut self) {
        self.last = None;
    }

    /// The scene before `present`, which becomes the one to redo.
    pub fn undo(&mut self, present: &Scene) -> Option<Scene> {
        let scene = self.undo_stack.pop()?;
        self.redo_stack.push(present.clone());
        self.last = None;
        Some(scene)
    }

    /// The scenes that an undo and a redo lead to.
    #[must_use]
    pub fn neighbours(&self) -> [Option<&Scene>; 2] {
        [self.undo_stack.last(), self.redo_stack.last()]
    }

    /// Goes from `present` back or forward to a scene, or makes it the next entry if it is in
    /// neither direction.
    pub fn go_to(&mut self, mut present: Scene, scene: &Scene) -> Scene {
        let forward = self.redo_stack.contains(scene);
        if !forward && !self.undo_stack.contains(scene) {
            self.record(&present, EditKind::Single);
            return scene.clone();
        }
        while present != *scene {
            let next = if forward { self.redo(&present) } else { self.undo(&present) };
            let Some(next) = next else { break };
            present = next;
        }
        present
    }

    /// The scene undone last.
    pub fn redo(&mut self, present: &Scene) -> Option<Scene> {
        let scene = self.redo_stack.pop()?;
        self.undo_stack.push(present.clone());
        self.last = None;
        Some(scene)
    }

    /// Returns whether there is something to undo, to redo.
    #[must_use]
    pub fn can_undo_and_redo(&self) -> (bool, bool) {
        (!self.undo_stack.is_empty(), !self.redo_stack.is_empty())
    }
}
