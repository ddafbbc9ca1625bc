//! A request is what the window asks of the worker. Requests merge: the latest scene, drag and
//! speed win.

use std::sync::Arc;

use cable_core::math::Point;
use cable_core::{Model, Scene, Settings, Solution};

use crate::state::Playback;

/// All that the window has asked since the worker last looked.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// The scene to solve from now on.
    pub edit: Option<Edit>,
    /// A support dragged while time runs.
    pub drag: Option<Drag>,
    /// Speed of the robot by hand, m/s; Some(None): along its path.
    pub robot: Option<Option<f64>>,
    /// An earlier instant to go on from.
    pub resume: Option<Box<Resume>>,
    /// Goes back to the start.
    pub reset: bool,
    /// Takes the last reset back: the run that it ended goes on, with this scene and model.
    pub undo_reset: Option<Box<Edit>>,
    /// Give up what is being solved: the scene stays, without an answer.
    pub cancel: bool,
    /// Time runs or stands still.
    pub playback: Option<Playback>,
    /// Single steps to take.
    pub steps: u32,
    /// True if it came while an earlier edit was being solved: edits come faster than answers.
    pub came_during_solve: bool,
    /// Number of the last edit, reset or step in it.
    pub number: u64,
}

/// A scene to solve.
#[derive(Clone, Debug)]
pub struct Edit {
    /// The scene.
    pub scene: Scene,
    /// The model to solve it with.
    pub model: Model,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// The shape that the cables start from.
    pub start: EditStart,
}

/// The shape from which cables start after an edit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditStart {
    /// They go on from where they are.
    PresentState,
    /// They lie as the scene says, wherever they are now: an undo leads back to the answer that
    /// was, even where a cable passes an obstacle on the way.
    Route,
    /// The scene is another one, not a change of the present one: nothing is carried over.
    NewScene,
}

/// An earlier instant to go on from.
#[derive(Clone, Debug)]
pub struct Resume {
    /// The scene at that instant.
    pub edit: Edit,
    /// The answer at that instant.
    pub answer: Arc<Solution>,
}

/// A support dragged while time runs.
#[derive(Clone, Debug)]
pub struct Drag {
    /// Index of the cable.
    pub cable: usize,
    /// Index of the support.
    pub support: usize,
    /// The target, m.
    pub to_m: Point,
    /// True if a hand holds the support by a spring; else it goes to the target by any force.
    pub by_spring: bool,
    /// The scene with the support there, for the next rebuild.
    pub scene: Scene,
}

/// Most single steps waiting: more would keep the window behind for seconds after a held key.
const MAX_STEPS: u32 = 60;

impl Request {
    /// Takes in a later request.
    pub fn merge(&mut self, later: Self) {
        // A request that comes after the cancellation is to be solved.
        self.cancel = later.cancel || (self.cancel && !later.solves());
        if let Some(edit) = later.edit {
            let follows_new_scene = self.edit.as_ref().is_some_and(|e| e.start == EditStart::NewScene);
            if edit.start == EditStart::NewScene {
                (self.reset, self.undo_reset) = (false, None);
                self.steps = 0;
            }
            self.drag = None;
            self.resume = None;
            let start = if follows_new_scene { EditStart::NewScene } else { edit.start };
            self.edit = Some(Edit { start, ..edit });
        }
        if let Some(drag) = later.drag {
            if let Some(edit) = &mut self.edit {
                edit.scene = drag.scene;
            } else {
                self.drag = Some(drag);
            }
        }
        if later.resume.is_some() {
            (self.edit, self.drag, self.reset, self.steps) = (None, None, false, 0);
            self.resume = later.resume;
        }
        if later.undo_reset.is_some() {
            (self.edit, self.drag, self.resume, self.reset, self.steps) = (None, None, None, false, 0);
            self.undo_reset = later.undo_reset;
        }
        if later.reset {
            self.reset = true;
            self.steps = 0;
        }
        self.robot = later.robot.or(self.robot);
        self.playback = later.playback.or(self.playback);
        self.steps = (self.steps + later.steps).min(MAX_STEPS);
        self.came_during_solve |= later.came_during_solve;
        self.number = self.number.max(later.number);
    }

    /// Returns true if it asks for an answer in place of the one being sought.
    #[must_use]
    pub fn solves(&self) -> bool {
        self.edit.is_some() || self.resume.is_some() || self.undo_reset.is_some() || self.reset
    }

    /// Returns true if it leads back to an earlier state or to another scene, so that the running
    /// solve is given up at once.
    #[must_use]
    pub fn goes_back(&self) -> bool {
        let goes_elsewhere = self.edit.as_ref().is_some_and(|e| e.start != EditStart::PresentState);
        goes_elsewhere || self.resume.is_some() || self.undo_reset.is_some() || self.reset
    }

    /// Returns true if nothing is asked.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.edit.is_none()
            && !self.cancel
            && self.drag.is_none()
            && self.resume.is_none()
            && self.undo_reset.is_none()
            && !self.reset
            && self.playback.is_none()
            && self.robot.is_none()
            && self.steps == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn later_requests_win_and_steps_are_bounded() {
        let scene = cable_core::scene::catalog::hanging_span();
        let edit = |start, name: &str| {
            let mut scene = scene.clone();
            scene.name = name.to_owned();
            let (model, settings) = (cable_core::Model::Auto, cable_core::Settings::default());
            Request { edit: Some(Edit { scene, model, settings, start }), ..Request::default() }
        };
        let mut waiting = edit(EditStart::NewScene, "first");
        for _ in 0..1000 {
            waiting.merge(Request { steps: 1, ..Request::default() });
        }
        waiting.merge(edit(EditStart::PresentState, "last"));
        let merged = waiting.edit.expect("an edit");
        assert_eq!(merged.scene.name, "last");
        assert_eq!(merged.start, EditStart::NewScene, "the new scene must not inherit the old one's state");
        assert!(waiting.steps <= 60);
    }
}
