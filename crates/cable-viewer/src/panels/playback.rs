//! The playback panel pauses, steps and resets time and sets its speed.

use egui::{Align, Button, Color32, Id, Label, Layout, Rect, RichText, TextStyle, Ui, UiBuilder, vec2};

use crate::command::{Command, PlaybackCommand};
use crate::panels::timeline;
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
/// Narrowest row with a slider of the speed, points: below, the time and how it runs stand in its
/// place, and the speed is typed.
const MIN_SLIDER_ROW_WIDTH: f32 = 740.0;
/// Width of the typed speed, points.
const SPEED_WIDTH: f32 = 56.0;

/// The place of the timeline's rail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rail {
    /// Above the graphs, or in no place.
    Elsewhere,
    /// In this row: the graphs are folded.
    Here,
}

/// Room that a timeline in this row leaves to the status, points: time and pace fit.
const STATUS_WIDTH: f32 = 180.0;
/// Widest timeline in this row, points.
const MOST_TIMELINE_WIDTH: f32 = 520.0;

/// The timeline of folded graphs.
fn folded_timeline(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let width = (ui.available_width() - STATUS_WIDTH).min(MOST_TIMELINE_WIDTH);
    let size = vec2(width, ui.available_height());
    // The buttons above that come with an earlier picture must not change its identity: a drag of
    // its knob would end.
    let named = UiBuilder::new().scope_id(Id::unique("timeline in the row of playback"));
    let named = named.max_rect(Rect::from_min_size(ui.available_rect_before_wrap().min, size));
    let rail = ui.scope_builder(named.layout(Layout::left_to_right(Align::Center)), |ui| {
        timeline::rail(ui, state, commands);
    });
    ui.advance_cursor_after_rect(rail.response.rect);
}

/// Draws it without a timeline.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    with_rail(ui, state, Rail::Elsewhere, commands);
}

/// Draws it, in one row at every width: a second one would move all above it.
pub fn with_rail(ui: &mut Ui, state: &AppState, rail: Rail, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let with_slider = ui.available_width() >= MIN_SLIDER_ROW_WIDTH;
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
        speed(ui, state, with_slider, commands);
        ui.separator();
        // At the end of the row: nothing moves when it comes and goes.
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            timeline::restart(ui, state, commands);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if rail == Rail::Here {
                    folded_timeline(ui, state, commands);
                    ui.separator();
                }
                show_status(ui, status(state));
            });
        });
    });
}

/// A part of the status, which is told on hover only where the row has no room for it.
struct StatusItem {
    text: String,
    help: String,
    tone: Tone,
    importance: Importance,
}

#[derive(Clone, Copy)]
enum Tone {
    Plain,
    Weak,
    Warning,
}

/// The order in which parts of the status get their room.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Importance {
    Fault,
    Time,
    Answer,
    File,
    Model,
}

/// Room of a line between two parts and of the space around it, points.
const SEPARATOR_WIDTH: f32 = 22.0;
/// Room of the sign for what is told on hover only, points.
const ELLIPSIS_WIDTH: f32 = 20.0;

/// Shows the most important items that fit, and an ellipsis for the others.
fn show_status(ui: &mut Ui, items: Vec<StatusItem>) {
    let font = TextStyle::Body.resolve(ui.style());
    let width = |text: &str| ui.painter().layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE).size().x;
    let widths: Vec<f32> = items.iter().map(|item| width(&item.text).ceil() + SEPARATOR_WIDTH).collect();
    let mut by_importance: Vec<usize> = (0..items.len()).collect();
    by_importance.sort_by_key(|&k| items[k].importance);
    let all: f32 = widths.iter().sum();
    let room = ui.available_width() + SEPARATOR_WIDTH;
    let mut left = if all <= room { room } else { room - ELLIPSIS_WIDTH };
    let mut fits = vec![false; items.len()];
    for k in by_importance {
        fits[k] = widths[k] <= left;
        left -= if fits[k] { widths[k] } else { 0.0 };
    }
    let mut left_out = Vec::new();
    let mut is_first = true;
    for (item, fits) in items.into_iter().zip(fits) {
        if !fits {
            left_out.push(item.text);
            continue;
        }
        if !std::mem::take(&mut is_first) {
            ui.separator();
        }
        let visuals = ui.visuals();
        let colour = match item.tone {
            Tone::Plain => visuals.text_color(),
            Tone::Weak => visuals.weak_text_color(),
            Tone::Warning => visuals.warn_fg_color,
        };
        ui.add(Label::new(RichText::new(item.text).color(colour)).extend()).on_hover_text(item.help);
    }
    if !left_out.is_empty() {
        ui.label("…").on_hover_text(left_out.join("\n"));
    }
}

/// The playback speed, with its slider if there is room.
fn speed(ui: &mut Ui, state: &AppState, with_slider: bool, commands: &mut Vec<Command>) {
    let label = ui.label("Speed").id;
    if with_slider {
        let rail = SliderRange { ends: [Playback::MIN_SPEED, Playback::MAX_SPEED], logarithmic: true };
        let slid = slider::ui(ui, state.live.playback.speed, rail);
        field::name(&slid.response, "Speed slider");
        if let Some(speed) = slid.value {
            commands.push(Command::Playback(PlaybackCommand::SetSpeed(speed)));
        }
        slid.response.on_hover_text(format!(
            "Simulated seconds per second, 0.01× to 4×\n{}",
            slider::drag_help(rail.logarithmic)
        ));
    }
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

/// The pace of time and the state of the solver.
fn status(state: &AppState) -> Vec<StatusItem> {
    let plain = |text: String, help: String, importance| StatusItem { text, help, tone: Tone::Plain, importance };
    let time_s = state.live.snapshot.solution.as_ref().map_or(0.0, |s| s.time_s);
    let mut items = vec![
        plain(format!("Time {time_s:.3} s"), "Simulated time since the start".to_owned(), Importance::Time),
        pace(state),
    ];
    if let Some(solution) = &state.live.snapshot.solution {
        let model = format!("{} model", labels::model(solution.model));
        items.push(plain(model, sentence(&solution.reason), Importance::Model));
    }
    let solved = format!("Solved in {:.2} ms", state.live.snapshot.solve_wall_s * 1e3);
    let (text, help) = match (state.solving_for_s(), state.freshness(), state.solver.edit_latency_s) {
        (Some(seconds), ..) => (labels::solving(seconds), "The answer to the last edits is being sought".to_owned()),
        (None, Freshness::Outdated, _) => {
            ("Not solved".to_owned(), "The scene has no answer: see the warnings".to_owned())
        }
        (None, _, Some(latency)) => {
            let help = format!("From the last edit to the first frame that shows it. {solved}");
            (format!("Updated in {:.0} ms", latency * 1e3), help)
        }
        (None, _, None) => (solved, "Wall time of the last answer".to_owned()),
    };
    items.push(plain(text, help, Importance::Answer));
    if let Some(path) = &state.ui.written {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let whole = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        items.push(plain(format!("Saved {name}"), whole.display().to_string(), Importance::File));
    }
    if let Some(fault) = &state.ui.autosave_fault {
        let (text, help) = ("Changes are not kept for recovery".to_owned(), fault.clone());
        items.push(StatusItem { text, help, tone: Tone::Warning, importance: Importance::Fault });
    }
    items
}

/// The speed at which time runs.
fn pace(state: &AppState) -> StatusItem {
    let item = |text: String, help: String, tone| StatusItem { text, help, tone, importance: Importance::Time };
    // The last frame keeps the speed that it was reached at.
    let Some(reached) = state.live.snapshot.real_speed.filter(|_| !state.live.playback.paused) else {
        let at_rest = state.live.snapshot.brought_to_rest && state.live.recording.shown_s.is_none();
        return match state.live.playback.paused {
            true if at_rest => item(
                "Brought to rest by the edit".to_owned(),
                "The edit changes what moves the cable: the place where it rests at this time is shown, and time goes on from \
                 there"
                    .to_owned(),
                Tone::Plain,
            ),
            true => item("Paused".to_owned(), "Time stands still".to_owned(), Tone::Weak),
            false => item("Starting…".to_owned(), "The first step is being made".to_owned(), Tone::Weak),
        };
    };
    let asked = state.live.playback.speed;
    let text = format!("Runs at {}", format::times(reached));
    let help = "Simulated seconds per second actually reached".to_owned();
    if reached < MIN_REAL_TIME_FRACTION * asked {
        let help = format!("{help}. The solver does not keep up: fewer segments or a looser tolerance help");
        item(format!("{text} of {}", format::times(asked)), help, Tone::Warning)
    } else {
        item(text, help, Tone::Plain)
    }
}
