//! A tutorial that is on has a place: a tutorial and one of its steps.

/// The present tutorial, and the present one of its steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TutorialPlace {
    /// Index of the tutorial.
    pub tutorial: usize,
    /// Index of the step.
    pub step: usize,
}
