//! The first steps are what a newcomer is asked to do on the canvas; each hint goes once it is
//! done.

/// A first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstStep {
    /// Drags a support.
    Drag,
    /// Lets time run.
    Play,
    /// Zooms.
    Zoom,
}

/// The steps that are still to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirstSteps(Vec<FirstStep>);

impl Default for FirstSteps {
    fn default() -> Self {
        Self(vec![FirstStep::Drag, FirstStep::Play, FirstStep::Zoom])
    }
}

impl FirstSteps {
    /// The steps to be done, in the order in which they are shown.
    #[must_use]
    pub fn open(&self) -> &[FirstStep] {
        &self.0
    }

    /// Removes a step that was done.
    pub fn done(&mut self, step: FirstStep) {
        self.0.retain(|s| *s != step);
    }

    /// Removes all steps: their hints are not shown again.
    pub fn hide(&mut self) {
        self.0.clear();
    }
}
