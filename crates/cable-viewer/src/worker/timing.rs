//! These durations and bounds say when the worker steps, drafts and answers.

/// One frame of simulated time at normal speed, s.
pub const FRAME_S: f64 = 1.0 / 60.0;

/// Time without a further edit (s) after which a coarse mesh or a draft that follows a hand is
/// replaced. Longer: figures of the draft stay on screen; shorter: an answer is begun between two
/// steps of a drag where frames are slow (a tenth of a second without a GPU), and the next draft
/// waits for it.
pub const IDLE_S: f64 = 0.2;

/// Least time without a further edit (s) before a draft is replaced: a hand at 60 edits a second is
/// waited for no longer. Shorter: a late frame begins an answer that the next edit gives up.
pub const MIN_IDLE_S: f64 = 0.06;

/// Pause of a hand, in times between its last two edits, after which it counts as resting. Smaller:
/// an answer is begun between two edits of an uneven hand; larger: the draft stays.
pub const IDLE_EDIT_INTERVALS: f64 = 3.0;

/// A solve that took longer (s) is drafted while edits come faster than answers. Longer: the
/// picture lags behind the hand; shorter: drafts where the answer itself would be in the next two
/// frames. The tank takes 15 to 25 ms.
pub const DRAFT_AFTER_S: f64 = 0.035;

/// A solve that took longer (s) is drafted even after a single edit. Longer: an edit shows nothing
/// for as long; shorter: the draft, 0.1 s at first, delays an answer that takes little more.
pub const DRAFT_FIRST_S: f64 = 0.4;

/// A frame of motion that takes longer (s) has the cable follow a hand on a coarse mesh. Longer:
/// the cable lags behind the hand; shorter: the mesh changes where nobody would feel it. Tuned on
/// the tank at 200 segments.
pub const COARSE_AFTER_S: f64 = 0.012;

/// Most answers waiting for a window that does not look: ten seconds of them, then every second one
/// of 20 s and so on. Fewer: a window that stalls has gaps; more: one that is hidden for long fills
/// the memory.
pub const MAX_ANSWERS: usize = 600;
