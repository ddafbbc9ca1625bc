//! Commands about time and the robot that moves in it.

use super::{Effects, next_number};
use crate::state::{AppState, Playback};
use crate::worker::request::Request;

/// Time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaybackCommand {
    /// Runs or stops.
    SetPaused(bool),
    /// Runs if it stands, stands if it runs.
    TogglePause,
    /// Simulated seconds per second; clamped to 0.01–4.
    SetSpeed(f64),
    /// One 1/60 s; pauses first. While an earlier time is shown: the next picture.
    Step,
    /// The picture before; pauses first.
    StepBack,
    /// Shows an earlier time (s), or the present; pauses.
    Show(Option<f64>),
    /// A replay begins anew at its end, or ends there.
    SetLoop(bool),
    /// Back to the start, bit for bit; pauses.
    Reset,
    /// The robot goes at this speed, m/s, positive to the right; None: along its path.
    DriveRobot(Option<f64>),
    /// Speed it is driven with by hand, m/s.
    SetRobotSpeed(f64),
}

/// Does one of them.
pub fn apply(state: &mut AppState, command: PlaybackCommand, effects: &mut Effects) {
    let now_s = state.live.solution.as_ref().map_or(0.0, |s| s.time_s);
    match command {
        PlaybackCommand::SetPaused(paused) => state.playback.paused = paused,
        PlaybackCommand::TogglePause => state.playback.paused = !state.playback.paused,
        PlaybackCommand::SetSpeed(speed) => {
            if speed.is_finite() {
                state.playback.speed = speed.clamp(Playback::MIN_SPEED, Playback::MAX_SPEED);
            }
        }
        PlaybackCommand::Step if state.recording.shown_s.is_some() => {
            state.playback.paused = true;
            // After the last picture comes the present.
            let next = state.recording.neighbour_s(now_s, 1).filter(|t| *t < now_s);
            state.show_time(next);
        }
        PlaybackCommand::Step => {
            state.playback.paused = true;
            effects.request.merge(Request { steps: 1, number: next_number(state), ..Request::default() });
        }
        PlaybackCommand::StepBack => {
            state.playback.paused = true;
            if let Some(before) = state.recording.neighbour_s(now_s, -1) {
                state.show_time(Some(before));
            }
        }
        PlaybackCommand::Show(time_s) => {
            state.playback.paused = true;
            state.show_time(time_s.filter(|t| t.is_finite()));
        }
        PlaybackCommand::SetLoop(looped) => state.recording.looped = looped,
        PlaybackCommand::Reset => {
            state.playback.paused = true;
            state.show_time(None);
            effects.request.merge(Request { reset: true, number: next_number(state), ..Request::default() });
        }
        PlaybackCommand::DriveRobot(order) => {
            // Who drives wants to see it: time runs, from the present on.
            if order.is_some_and(|v| v != 0.0) {
                state.show_time(None);
                state.playback.paused = false;
            }
            if state.robot_order != order {
                state.robot_order = order;
                effects.request.merge(Request { robot: Some(order), ..Request::default() });
            }
        }
        PlaybackCommand::SetRobotSpeed(speed) => {
            if speed.is_finite() && speed > 0.0 {
                state.robot_speed = Some(speed);
                // What is being driven goes on at the new speed.
                if let Some(order) = state.robot_order.filter(|v| *v != 0.0) {
                    let order = Some(speed.copysign(order));
                    state.robot_order = order;
                    effects.request.merge(Request { robot: Some(order), ..Request::default() });
                }
            }
        }
    }
    send(state, effects);
}

/// Tells the worker whether time runs: not while what was recorded is replayed.
pub fn send(state: &AppState, effects: &mut Effects) {
    let paused = state.playback.paused || state.recording.shown_s.is_some();
    let playback = Playback { paused, ..state.playback };
    effects.request.merge(Request { playback: Some(playback), ..Request::default() });
}
