//! Sleep and the step size follow what was seen of the motion.

use crate::math::Vec2;

/// The observed frequency of the motion, and the step that follows from it.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct StepSizeController {
    /// ∫ Σ l |a|² dt, m³/s³, ∫ Σ l |v|² dt, m³/s, and ∫ dt, s.
    pub(in crate::model::fem) seen: [f64; 3],
    /// Longest step of the next frame, s.
    pub(in crate::model::fem) step: f64,
    /// Longest step of all, s.
    pub(in crate::model::fem) longest: f64,
    /// Longest step that is tried after others were refused, s.
    pub(in crate::model::fem) solvable: f64,
    /// Most Newton iterations of a step of the present frame.
    pub(in crate::model::fem) most_iterations: usize,
    /// True if a step of the present frame was refused.
    pub(in crate::model::fem) refused: bool,
}

impl StepSizeController {
    /// Nothing was seen yet.
    pub(in crate::model::fem) fn new(longest: f64) -> Self {
        Self { seen: [0.0; 3], step: longest, longest, solvable: longest, most_iterations: 0, refused: false }
    }

    /// Forgets the motion that was seen.
    pub(in crate::model::fem) fn forget(&mut self) {
        *self = Self::new(self.longest);
    }
}

/// The measures by which the cable is found to be still, and the loads when it fell asleep.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct Sleep {
    pub(in crate::model::fem) since: f64,
    pub(in crate::model::fem) place: Vec<Vec2>,
    pub(in crate::model::fem) arc_length: Vec<f64>,
    pub(in crate::model::fem) force: Vec<Vec2>,
    pub(in crate::model::fem) target: Vec<Vec2>,
    pub(in crate::model::fem) held: Vec<bool>,
    pub(in crate::model::fem) asleep: bool,
}
