//! The playback panel pauses, steps and resets time and sets its speed.

use egui::{Button, Ui};

use crate::command::{Command, PlaybackCommand};
use crate::state::{AppState, Freshness, Playback};
use crate::units::sentence::sentence;
use crate::units::unit::Unit;
use crate::units::{format, labels};
use crate::widgets::field;
use crate::widgets::icon::{self, Icon};
use crate::widgets::slider::{self, SliderRange};

/// Below this share of the speed asked for, the shortfall is named: smaller ones are jitter of the
/// clock.
const MIN_REAL_TIME_FRACTION: f64 = 0.9;

/// Width of each button, points: “Pause” and its sign fit, and nothing moves when it turns to
/// “Play”.
const BUTTON_WIDTH: f32 = 72.0;
/// Width of the typed speed, points.
const SPEED_WIDTH: f32 = 56.0;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let mut button = |ui: &mut Ui, (icon, text): (Icon, &str), help: &str, command: PlaybackCommand| {
            if icon::text_button(ui, icon, text, BUTTON_WIDTH).on_hover_text(help).clicked() {
                commands.push(Command::Playback(command));
            }
        };
        button(ui, (Icon::ToStart, "Reset"), "Back to the start", PlaybackCommand::Reset);
        if state.live.playback.paused {
            button(ui, (Icon::Play, "Play"), "Let time run", PlaybackCommand::SetPaused(false));
        } else {
            button(ui, (Icon::Pause, "Pause"), "Stop time", PlaybackCommand::SetPaused(true));
        }
        button(ui, (Icon::Step, "Step"), "One sixtieth of a second, then pause", PlaybackCommand::Step);
        ui.separator();
        speed(ui, state, commands);
        ui.separator();
        let time_s = state.live.snapshot.solution.as_ref().map_or(0.0, |s| s.time_s);
        ui.label(format!("Time {time_s:.3} s")).on_hover_text("Simulated time since the start");
        real_time(ui, state);
        ui.separator();
        status(ui, state);
    });
}

fn speed(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let label = ui.label("Speed").id;
    let rail = SliderRange { ends: [Playback::MIN_SPEED, Playback::MAX_SPEED], logarithmic: true };
    let slid = slider::ui(ui, state.live.playback.speed, rail);
    field::name(&slid.response, "Speed slider");
    if let Some(speed) = slid.value {
        commands.push(Command::Playback(PlaybackCommand::SetSpeed(speed)));
    }
    slid.response.on_hover_text(format!("Simulated seconds per second, 0.01× to 4×\n{}", slider::drag_help(true)));
    let entry = field::number(ui, "Speed", Unit::TIMES, state.live.playback.speed, SPEED_WIDTH);
    if let Some(speed) = entry.value {
        commands.push(Command::Playback(PlaybackCommand::SetSpeed(speed)));
    }
    let response = entry.response.labelled_by(label);
    field::name(&response, "Speed");
    response.on_hover_text("Simulated seconds per second, 0.01× to 4×");
    let unchanged = state.live.playback.speed == 1.0;
    let reset = ui.add_enabled(!unchanged, Button::new("1×")).on_hover_text("Back to real time");
    let reset = reset.on_disabled_hover_text("It runs in real time");
    field::name(&reset, "Real-time speed");
    if reset.clicked() {
        commands.push(Command::Playback(PlaybackCommand::SetSpeed(1.0)));
    }
    if let Some(fault) = entry.fault {
        ui.colored_label(ui.visuals().error_fg_color, fault);
    }
}

fn real_time(ui: &mut Ui, state: &AppState) {
    // The last frame keeps the speed that it was reached at.
    let Some(reached) = state.live.snapshot.real_speed.filter(|_| !state.live.playback.paused) else {
        ui.weak(if state.live.playback.paused { "Paused" } else { "Starting…" });
        return;
    };
    let asked = state.live.playback.speed;
    let text = format!("Runs at {}", format::times(reached));
    let help = "Simulated seconds per second actually reached";
    if reached < MIN_REAL_TIME_FRACTION * asked {
        let slow = format!("{text} of {}", format::times(asked));
        ui.colored_label(ui.visuals().warn_fg_color, slow)
            .on_hover_text(format!("{help}. The solver does not keep up: fewer segments or a looser tolerance help"));
    } else {
        ui.label(text).on_hover_text(help);
    }
}

/// How the solver is doing, beside the transport.
fn status(ui: &mut Ui, state: &AppState) {
    if let Some(solution) = &state.live.snapshot.solution {
        ui.label(format!("{} model", labels::model(solution.model))).on_hover_text(sentence(&solution.reason));
        ui.separator();
    }
    let solved = format!("Solved in {:.2} ms", state.live.snapshot.solve_wall_s * 1e3);
    match (state.solving(), state.freshness(), state.solver.edit_latency_s) {
        (Some(seconds), ..) => {
            ui.label(labels::solving(seconds)).on_hover_text("The answer to the last edits is being sought");
        }
        (None, Freshness::Outdated, _) => {
            ui.label("Not solved");
        }
        (None, _, Some(latency)) => {
            let help = format!("From the last edit to the first frame that shows it. {solved}");
            ui.label(format!("Updated in {:.0} ms", latency * 1e3)).on_hover_text(help);
        }
        (None, _, None) => {
            ui.label(solved);
        }
    }
    if let Some(path) = &state.ui.written {
        ui.separator();
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let whole = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let label = ui.add(egui::Label::new(format!("Saved {name}")).truncate());
        label.on_hover_text(whole.display().to_string());
    }
    if let Some(fault) = &state.ui.autosave_fault {
        ui.separator();
        ui.colored_label(ui.visuals().warn_fg_color, "changes are not kept for recovery").on_hover_text(fault);
    }
}
