//! Playback commands concern time and the robot that moves in it.

use crate::command::effects::{Effects, next_number, submit_edit};
use crate::command::resume::{resume_from_shown, undo_restart};
use crate::state::live::ResetOrigin;
use crate::state::{AppState, Playback};
use crate::worker::request::Request;

/// Commands of time.
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
    /// Shows the instant before; pauses first.
    StepBack,
    /// Shows an earlier time (s), or the present; pauses.
    ShowTime(Option<f64>),
    /// Goes on from the earlier time shown: the recording after it is dropped.
    ResumeFromShown,
    /// A replay begins anew at its end, or ends there.
    SetLoop(bool),
    /// Back to the start, bit for bit; pauses, and the robot's task starts again.
    Reset,
    /// Takes the last restart back, and the edits since if an edit was its cause: the recording
    /// before it is there again, and time goes on from its end.
    UndoRestart,
    /// Gives up the running solve.
    CancelSolve,
    /// Begins the solve that was given up once more.
    Solve,
    /// The robot goes at this speed, m/s, positive to the right; None: along its path.
    DriveRobot(Option<f64>),
    /// Speed it is driven with by hand, m/s.
    SetRobotSpeed(f64),
    /// A support pulled farther than the cable reaches while time runs pulls, or is refused.
    PullPastLength(bool),
}

/// Applies a playback command.
pub fn apply(state: &mut AppState, command: PlaybackCommand, effects: &mut Effects) {
    let now_s = state.live.latest.solution.as_ref().map_or(0.0, |s| s.time_s);
    if stops_time(state, command) {
        state.live.stopped_by_drag = None;
    }
    match command {
        PlaybackCommand::SetPaused(paused) => state.live.playback.paused = paused,
        PlaybackCommand::TogglePause => state.live.playback.paused = !state.live.playback.paused,
        PlaybackCommand::SetSpeed(speed) => {
            if speed.is_finite() {
                state.live.playback.speed = speed.clamp(Playback::MIN_SPEED, Playback::MAX_SPEED);
            }
        }
        PlaybackCommand::Step if state.live.recording.shown_s.is_some() => {
            state.live.playback.paused = true;
            // The present comes after the last recorded instant.
            let next = state.live.recording.neighbour_s(now_s, 1).filter(|t| *t < now_s);
            state.live.show_time(next);
        }
        PlaybackCommand::Step => {
            state.live.playback.paused = true;
            effects.request.merge(Request { steps: 1, number: next_number(state), ..Request::default() });
        }
        PlaybackCommand::StepBack => {
            state.live.playback.paused = true;
            if let Some(before) = state.live.recording.neighbour_s(now_s, -1) {
                state.live.show_time(Some(before));
            }
        }
        PlaybackCommand::ShowTime(time_s) => {
            state.live.playback.paused = true;
            state.live.show_time(time_s.filter(|t| t.is_finite()));
        }
        PlaybackCommand::ResumeFromShown => resume_from_shown(state, effects),
        PlaybackCommand::SetLoop(looped) => state.live.recording.looped = looped,
        PlaybackCommand::Reset => reset(state, effects),
        PlaybackCommand::UndoRestart => undo_restart(state, effects),
        PlaybackCommand::CancelSolve => {
            state.live.playback.paused = true;
            effects.request.merge(Request { cancel: true, number: next_number(state), ..Request::default() });
        }
        PlaybackCommand::Solve => submit_edit(state, effects),
        PlaybackCommand::DriveRobot(order) => drive_robot(state, order, effects),
        PlaybackCommand::PullPastLength(pulls) => state.solver.pulls_past_length = pulls,
        PlaybackCommand::SetRobotSpeed(speed) => set_robot_speed(state, speed, effects),
    }
    send(state, effects);
}

/// Takes the cables back to the start, and remembers what is needed to undo that.
fn reset(state: &mut AppState, effects: &mut Effects) {
    state.live.playback.paused = true;
    state.live.show_time(None);
    let (scene, robot_speed_command) = (state.document.scene.clone(), state.live.robot_speed_command.take());
    state.live.reset_asked = Some(ResetOrigin { scene, robot_speed_command });
    let number = next_number(state);
    effects.request.merge(Request { reset: true, robot: Some(None), number, ..Request::default() });
}

/// Drives the robot by hand at a speed, or lets it follow its path.
fn drive_robot(state: &mut AppState, order: Option<f64>, effects: &mut Effects) {
    // Driving the robot lets time run from the present on, so that it is seen.
    if order.is_some_and(|v| v != 0.0) {
        state.live.show_time(None);
        state.live.playback.paused = false;
    }
    if state.live.robot_speed_command != order {
        state.live.robot_speed_command = order;
        effects.request.merge(Request { robot: Some(order), ..Request::default() });
    }
}

/// Sets the speed at which the robot is driven by hand.
fn set_robot_speed(state: &mut AppState, speed: f64, effects: &mut Effects) {
    if !(speed.is_finite() && speed > 0.0) {
        return;
    }
    state.live.manual_robot_speed = Some(speed);
    // A robot that is being driven goes on at the new speed.
    if let Some(order) = state.live.robot_speed_command.filter(|v| *v != 0.0) {
        let order = Some(speed.copysign(order));
        state.live.robot_speed_command = order;
        effects.request.merge(Request { robot: Some(order), ..Request::default() });
    }
}

/// Returns true if the user wants time to stand.
fn stops_time(state: &AppState, command: PlaybackCommand) -> bool {
    match command {
        PlaybackCommand::TogglePause => !state.live.playback.paused,
        PlaybackCommand::SetPaused(true)
        | PlaybackCommand::Step
        | PlaybackCommand::StepBack
        | PlaybackCommand::ShowTime(_)
        | PlaybackCommand::ResumeFromShown
        | PlaybackCommand::Reset
        | PlaybackCommand::UndoRestart
        | PlaybackCommand::CancelSolve => true,
        _ => false,
    }
}

/// Tells the worker if time runs, which it does not during a replay.
pub fn send(state: &AppState, effects: &mut Effects) {
    let paused = state.live.playback.paused || state.live.recording.shown_s.is_some();
    let playback = Playback { paused, ..state.live.playback };
    effects.request.merge(Request { playback: Some(playback), ..Request::default() });
}
