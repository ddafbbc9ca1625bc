//! These durations and bounds say when the worker steps, drafts and answers.

/// One frame of simulated time at normal speed, s.
pub const FRAME_S: f64 = 1.0 / 60.0;

/// Time without a further edit (s) after which a draft is replaced by the answer. Longer: figures
/// of the draft stay on screen; shorter: an answer is begun between two steps of a drag where
/// frames are slow (a tenth of a second without a GPU), and the next draft waits for it.
pub const QUIET_S: f64 = 0.2;

/// A solve that took longer (s) has a draft go before the next one. Longer: the picture lags behind
/// the hand; shorter: drafts where the answer itself would be in the next frame. Tuned on the tank
/// at 200 segments.
pub const DRAFT_AFTER_S: f64 = 0.012;

/// Most answers waiting for a window that does not look: ten seconds of them. Fewer: a window that
/// stalls loses some; more: one that is hidden for long fills the memory.
pub const MAX_ANSWERS: usize = 600;
