//! The first steps are what a newcomer is asked to do on the canvas; each hint goes once it is
//! done.

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstStep {
    /// Drags a support.
    Drag,
    /// Lets time run.
    Play,
    /// Zooms.
    Zoom,
}

/// Those that are still to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirstSteps(Vec<FirstStep>);

impl Default for FirstSteps {
    fn default() -> Self {
        Self(vec![FirstStep::Drag, FirstStep::Play, FirstStep::Zoom])
    }
}

impl FirstSteps {
    /// Those to be done, in the order they are shown.
    #[must_use]
    pub fn open(&self) -> &[FirstStep] {
        &self.0
    }

    /// One was done.
    pub fn done(&mut self, step: FirstStep) {
        self.0.retain(|s| *s != step);
    }

    /// The hints are not shown again.
    pub fn hide(&mut self) {
        self.0.clear();
    }
}
