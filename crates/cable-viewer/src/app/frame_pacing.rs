//! A window that is drawn without a GPU shows fewer frames while time runs: each costs as much
//! processor as several steps of the simulation, and what is recorded is the same.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time from the end of one frame of a running simulation that is drawn without a GPU to the next,
/// s: with the frame itself, 25 frames a second. Shorter: drawing takes more of a core than the
/// simulation; longer: motion is seen to jerk.
pub(super) const SOFTWARE_FRAME_INTERVAL: Duration = Duration::from_millis(40);

/// The time before which no frame is drawn for the sake of a step, shared with the solver thread.
#[derive(Clone, Debug, Default)]
pub(super) struct FramePacing {
    interval: Duration,
    next: Arc<Mutex<Option<Instant>>>,
}

/// What the next frame is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NextFrame {
    /// It shows a step of the running simulation, and nobody waits for an answer.
    Step,
    /// It shows an answer as soon as there is one.
    Answer,
}

impl FramePacing {
    /// Least time between two frames while the simulation runs.
    pub fn every(&mut self, interval: Duration) {
        self.interval = interval;
    }

    /// A frame has been drawn.
    pub fn drawn(&self, now: Instant, next_frame: NextFrame) {
        let next = (next_frame == NextFrame::Step && self.interval > Duration::ZERO).then(|| now + self.interval);
        *self.next.lock().unwrap_or_else(PoisonError::into_inner) = next;
    }

    /// The wait until what the solver has found is to be drawn.
    pub fn wait(&self, now: Instant) -> Duration {
        let next = *self.next.lock().unwrap_or_else(PoisonError::into_inner);
        next.map_or(Duration::ZERO, |next| next.saturating_duration_since(now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_wait_for_the_next_frame_and_answers_to_edits_do_not() {
        let (mut pacing, now) = (FramePacing::default(), Instant::now());
        let solver = pacing.clone();
        pacing.drawn(now, NextFrame::Step);
        assert_eq!(solver.wait(now), Duration::ZERO, "with a GPU each step is shown");
        pacing.every(SOFTWARE_FRAME_INTERVAL);
        pacing.drawn(now, NextFrame::Step);
        let later = now + Duration::from_millis(13);
        assert_eq!(solver.wait(later), Duration::from_millis(27));
        assert_eq!(solver.wait(now + Duration::from_secs(1)), Duration::ZERO);
        pacing.drawn(later, NextFrame::Answer);
        assert_eq!(solver.wait(later), Duration::ZERO);
    }
}
