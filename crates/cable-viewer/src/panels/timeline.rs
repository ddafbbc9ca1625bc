//! The timeline shows what was recorded, what happened in it, and which of it is on screen.

use cable_core::solution::WarningKind;
use egui::{Color32, Id, Label, Rect, RectAlign, RichText, Sense, Slider, Stroke, TextStyle, Tooltip, Ui, pos2, vec2};

use crate::command::{Command, PlaybackCommand};
use crate::state::AppState;
use crate::state::live::RestartCause;
use crate::units::format;
use crate::units::sentence::sentence;
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::icon::{self, Icon};
use crate::widgets::{field, highlight};

/// Shortest rail in the narrowest windows, points.
const MIN_SLIDER_WIDTH: f32 = 60.0;
/// Shortest rail beside other controls, points. Less: a frame of a minute is not aimed at.
const MIN_SLIDER_WIDTH_IN_ROW: f32 = 300.0;
/// Room that is kept for the words beside a rail, points: “12.34 of 123.45 s” fits.
const WORDS_WIDTH: f32 = 130.0;
/// Distance from a mark within which the pointer shows its text, points.
const MARK_REACH: f32 = 4.0;

/// The reason why its controls are off.
const NO_RECORDING_HINT: &str = "Nothing is recorded yet: press play";
/// The reason why the control that leads back to the present is off.
const AT_PRESENT_HINT: &str = "The latest frame is shown";

/// Draws it in a row of its own.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| in_row(ui, state, commands));
}

/// Returns the width (points) that it takes beside other controls, with a rail that can be aimed
/// at; its buttons are as wide as they were in the frame before.
#[must_use]
pub fn width_in_row(ui: &Ui) -> f32 {
    buttons_width(ui) + MIN_SLIDER_WIDTH_IN_ROW + WORDS_WIDTH
}

fn buttons_width(ui: &Ui) -> f32 {
    ui.data(|d| d.get_temp(Id::unique("width of the replay controls"))).unwrap_or(FIRST_BUTTONS_WIDTH)
}

/// Width of the buttons in the first frame, points.
const FIRST_BUTTONS_WIDTH: f32 = 260.0;

/// Draws it in the rest of a row.
pub fn in_row(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    buttons(ui, state, commands);
    rail(ui, state, commands);
}

/// Draws the controls of the replay without the rail.
pub fn buttons(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let left = ui.cursor().left();
    replay_controls(ui, state, commands);
    let width = ui.cursor().left() - left;
    ui.data_mut(|d| d.insert_temp(Id::unique("width of the replay controls"), width));
}

/// Draws the rail with the words beside it in the rest of a row.
pub fn rail(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let span = state.live.recording.span_s();
    let now_s = state.live.latest.solution.as_ref().map_or(0.0, |s| s.time_s);
    let mut push = |command| commands.push(Command::Playback(command));
    let [first, last] = span.unwrap_or([0.0, 1.0]);
    let text = match state.live.recording.shown_s {
        _ if span.is_none() => "Press play to record".to_owned(),
        // The time of the frame on screen, not that of the knob between two frames.
        Some(t) => format!("{:.2} of {last:.2} s", state.live.snapshot.solution.as_ref().map_or(t, |s| s.time_s)),
        None => format!("recorded {}", format::duration(last - first)),
    };
    let count = match state.live.recording.events().len() {
        1 => "1 event".to_owned(),
        n => format!("{n} events"),
    };
    // The row must not be wider than its panel: it would push the graphs below out of sight.
    // Without room events are marks on the rail and stand in the hover text.
    let beside = width(ui, &text);
    let with_count = beside + width(ui, &count);
    let counted = span.is_some()
        && !state.live.recording.events().is_empty()
        && ui.available_width() - with_count >= MIN_SLIDER_WIDTH;
    ui.spacing_mut().slider_width =
        (ui.available_width() - if counted { with_count } else { beside }).max(MIN_SLIDER_WIDTH);
    let mut time_s = state.live.recording.shown_s.unwrap_or(now_s).clamp(first, last);
    let slider = ui.add_enabled(span.is_some(), Slider::new(&mut time_s, first..=last).show_value(false));
    field::name(&slider, "Timeline");
    if slider.changed() {
        push(PlaybackCommand::ShowTime(Some(time_s)));
    }
    if span.is_some() {
        marks(ui, state, slider.rect, [first, last]);
    }
    slider.on_hover_text(state.live.recording.about()).on_disabled_hover_text(NO_RECORDING_HINT);
    let text = if span.is_some() { RichText::new(text) } else { RichText::new(text).weak() };
    ui.add(Label::new(text).truncate()).on_hover_text(count.as_str());
    if counted {
        ui.weak(count);
    }
}

/// Draws the controls that replay the recording: step back, loop, to the latest, resume.
fn replay_controls(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let span = state.live.recording.span_s();
    let mut push = |command| commands.push(Command::Playback(command));
    ui.add_enabled_ui(span.is_some(), |ui| {
        let back = icon::plain_button_if(span.is_some(), ui, Icon::StepBack);
        field::name(&back, "Step back");
        let back =
            back.on_hover_text("The frame before this one (arrow left)").on_disabled_hover_text(NO_RECORDING_HINT);
        if back.clicked() {
            push(PlaybackCommand::StepBack);
        }
        let mut looped = state.live.recording.looped;
        let help = "Playback starts again at the end of the recording; off, the simulation goes on from there";
        if checkbox(ui, &mut looped, "Loop").on_hover_text(help).on_disabled_hover_text(NO_RECORDING_HINT).changed() {
            push(PlaybackCommand::SetLoop(looped));
            // A loop of what is not shown begins at its start.
            if let (true, None, Some([first, _])) = (looped, state.live.recording.shown_s, span) {
                push(PlaybackCommand::ShowTime(Some(first)));
            }
        }
        let shown = state.live.recording.shown_s.is_some();
        let help = "Returns to the latest frame";
        let present = ui.add_enabled(shown, egui::Button::new("Latest")).on_hover_text(help);
        highlight::register(&present, "Latest");
        if present.on_disabled_hover_text(AT_PRESENT_HINT).clicked() {
            push(PlaybackCommand::ShowTime(None));
        }
        let help = "Continues from the time shown: later frames are dropped, and friction starts fresh";
        let on = ui.add_enabled(shown, egui::Button::new("Resume")).on_hover_text(help);
        field::name(&on, "Resume from here");
        if on.on_disabled_hover_text(AT_PRESENT_HINT).clicked() {
            push(PlaybackCommand::ResumeFromShown);
        }
    });
}

/// The button that goes on with the other run, where a restart has put one away.
pub fn restart(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(run) = &state.live.earlier_run else { return };
    let is_later = is_later_run(state);
    let help = match &run.cause {
        _ if !is_later && !is_one_undo_away(state) => {
            "Switches to the previous run, with its scene, and continues it from its end; the present run is kept and can be \
             brought back"
        }
        RestartCause::Reset(_) => "Undoes the reset: the run continues from its end, with its recording (Ctrl+Z)",
        RestartCause::Edit(_) if is_later => {
            "Repeats the edit that restarted the run and brings back what was recorded after it; the present run is kept \
             (Ctrl+Shift+Z)"
        }
        RestartCause::Edit(_) => {
            "Undoes the edit that restarted the run and brings back the earlier recording; what was recorded since is \
             kept (Ctrl+Z)"
        }
    };
    if ui.button(restart_button(state)).on_hover_text(help).clicked() {
        commands.push(Command::Playback(PlaybackCommand::UndoRestart));
    }
}

/// The other run is the one that came after the edit that began it anew.
fn is_later_run(state: &AppState) -> bool {
    let [_, redone] = state.document.undo.neighbours();
    let cause = state.live.earlier_run.as_ref().map(|run| &run.cause);
    matches!(cause, Some(RestartCause::Edit(scene)) if redone == Some(scene))
}

/// Nothing was edited or reset since the restart that an undo takes back.
fn is_one_undo_away(state: &AppState) -> bool {
    let [undone, _] = state.document.undo.neighbours();
    match state.live.earlier_run.as_ref().map(|run| &run.cause) {
        Some(RestartCause::Reset(_)) => state.live.reset_is_last,
        Some(RestartCause::Edit(scene)) => undone == Some(scene),
        None => true,
    }
}

/// Returns what the button says that goes on with the other run.
#[must_use]
pub fn restart_button(state: &AppState) -> &'static str {
    match (is_later_run(state), is_one_undo_away(state)) {
        (true, _) => "Redo restart",
        (false, true) => "Undo restart",
        (false, false) => "Previous run",
    }
}

/// Width of a text and the space before it, points.
fn width(ui: &Ui, text: &str) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    galley.size().x.ceil() + ui.spacing().item_spacing.x + 1.0
}

/// Events as marks over the rail; a click on one shows its time.
fn marks(ui: &mut Ui, state: &AppState, rail: Rect, [first, last]: [f64; 2]) {
    // The knob's middle stays half its width within the rail.
    let inset = 0.5 * rail.height();
    let x = |time_s: f64| {
        let share = ((time_s - first) / (last - first)).clamp(0.0, 1.0) as f32;
        rail.left() + inset + share * (rail.width() - 2.0 * inset)
    };
    for event in state.live.recording.events() {
        let colour = colour(ui, event.warning.kind);
        let top = pos2(x(event.time_s), rail.top());
        let size = if event.warning.kind == WarningKind::Broken { 4.0 } else { 3.0 };
        ui.painter().line_segment([top, top + vec2(0.0, rail.height())], Stroke::new(1.5, colour));
        ui.painter().circle_filled(top, size, colour);
    }
    let Some(pointer) = ui.input(|i| i.pointer.hover_pos()).filter(|p| rail.expand(MARK_REACH).contains(*p)) else {
        return;
    };
    let near = state.live.recording.events().iter().filter(|e| (x(e.time_s) - pointer.x).abs() < MARK_REACH);
    let text: Vec<String> = near.take(4).map(|e| format!("{:.2} s: {}", e.time_s, sentence(&e.warning))).collect();
    if !text.is_empty() {
        // Above the rail, over the ground of the picture: below it are the graphs.
        let spot = Rect::from_center_size(pos2(pointer.x, rail.center().y), vec2(1.0, rail.height()));
        let mark = ui.interact(spot, ui.scope_id().with("event"), Sense::hover());
        let mut tip = Tooltip::for_enabled(&mark);
        tip.popup = tip.popup.align(RectAlign::TOP);
        tip.show(|ui| ui.label(text.join("\n")));
    }
}

fn colour(ui: &Ui, kind: WarningKind) -> Color32 {
    match kind {
        WarningKind::Broken | WarningKind::BreakingTension => ui.visuals().error_fg_color,
        WarningKind::Slack => ui.visuals().weak_text_color.unwrap_or(Color32::GRAY),
        _ => ui.visuals().warn_fg_color,
    }
}
