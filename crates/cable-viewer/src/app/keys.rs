//! The keyboard gives commands. Single keys are left to a text field that has the focus.

use egui::{Context, Event, Key, KeyboardShortcut, Modifiers};

use crate::canvas::layers::grid;
use crate::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use crate::geometry::handles;
use crate::panels::robot;
use crate::state::dialog::Dialog;
use crate::state::{AppState, OpenPanels};
use crate::widgets::field;

/// Ctrl or ⌘ with a key.
const fn with_command(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

/// Opens a file.
pub const OPEN: KeyboardShortcut = with_command(Key::O);
/// Saves.
pub const SAVE: KeyboardShortcut = with_command(Key::S);
/// Saves under another name.
pub const SAVE_AS: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
/// Everything by name.
pub const PALETTE: KeyboardShortcut = with_command(Key::P);
/// Closes the window.
pub const QUIT: KeyboardShortcut = with_command(Key::Q);
/// An empty scene.
pub const NEW: KeyboardShortcut = with_command(Key::N);
/// Copies what is picked. (egui turns these three into events of their own.)
pub const COPY: KeyboardShortcut = with_command(Key::C);
/// Cuts it out.
pub const CUT: KeyboardShortcut = with_command(Key::X);
/// Puts it in.
pub const PASTE: KeyboardShortcut = with_command(Key::V);
/// Picks everything.
pub const SELECT_ALL: KeyboardShortcut = with_command(Key::A);
/// Back by one edit.
pub const UNDO: KeyboardShortcut = with_command(Key::Z);
/// Forward by one edit.
pub const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);

/// Pushes what the keys of this frame ask for.
pub fn read(ctx: &Context, state: &AppState, commands: &mut Vec<Command>) {
    if state.ui.dialog.is_some() {
        if ctx.input(|i| i.key_pressed(Key::Escape)) {
            commands.push(Command::File(FileCommand::SetDialog(None)));
        }
        return;
    }
    file_shortcuts(ctx, commands);
    if ctx.egui_wants_keyboard_input() {
        return;
    }
    for (shortcut, command) in [(REDO, SceneCommand::Redo), (UNDO, SceneCommand::Undo)] {
        if ctx.input_mut(|i| i.consume_shortcut(&shortcut)) {
            commands.push(Command::Scene(command));
        }
    }
    clipboard(ctx, state, commands);
    // The longer ones first here too: a plain arrow is found in alt with an arrow.
    pick_and_move(ctx, state, commands);
    camera(ctx, state, commands);
    let panels = state.ui.panels;
    let show = |panels| Command::View(ViewCommand::ShowPanels(panels));
    let plain = |key| ctx.input_mut(|i| i.consume_key(Modifiers::NONE, key));
    for (key, command) in [
        (Key::F, Command::View(ViewCommand::Fit)),
        (Key::C, Command::View(ViewCommand::Recentre)),
        (Key::OpenBracket, show(OpenPanels { edit: !panels.edit, ..panels })),
        (Key::CloseBracket, show(OpenPanels { results: !panels.results, ..panels })),
        (Key::G, show(OpenPanels { graphs: !panels.graphs, ..panels })),
        (Key::Space, Command::Playback(PlaybackCommand::TogglePause)),
        (Key::ArrowRight, Command::Playback(PlaybackCommand::Step)),
        (Key::ArrowLeft, Command::Playback(PlaybackCommand::StepBack)),
    ] {
        if plain(key) {
            commands.push(command);
        }
    }
    drive(ctx, state, commands);
    if plain(Key::R) {
        commands.push(Command::Playback(PlaybackCommand::Reset));
    }
    if plain(Key::F1) {
        commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::Help))));
    }
    if (plain(Key::Delete) || plain(Key::Backspace)) && state.selection.selected.is_some() {
        commands.push(Command::Scene(SceneCommand::RemoveAll(state.selection.selected_items())));
    }
    // An open menu or list closes first, and only it; what is typed is dropped first.
    if !egui::Popup::is_any_open(ctx) && !field::was_typed_in(ctx) && plain(Key::Escape) {
        commands.push(Command::View(ViewCommand::Select(None)));
    }
}

/// The shortcuts of files and of the palette, which act while text is typed, too.
fn file_shortcuts(ctx: &Context, commands: &mut Vec<Command>) {
    // The longer shortcut first: ctrl+shift+S contains ctrl+S.
    for (shortcut, command) in [
        (SAVE_AS, Command::File(FileCommand::AskSaveAs)),
        (SAVE, Command::File(FileCommand::Save)),
        (OPEN, Command::File(FileCommand::AskOpen)),
        (NEW, Command::File(FileCommand::New)),
        (QUIT, Command::File(FileCommand::Quit)),
        (PALETTE, Command::File(FileCommand::SetDialog(Some(Dialog::Palette { text: String::new() })))),
    ] {
        if ctx.input_mut(|i| i.consume_shortcut(&shortcut)) {
            commands.push(command);
        }
    }
}

/// Zoom by one key: three presses double the scale.
const ZOOM: f64 = 1.26;
/// Distance by which an arrow key moves the view, points.
const PAN: f32 = 60.0;

/// + and − zoom about the middle, Shift with an arrow moves the view.
fn camera(ctx: &Context, state: &AppState, commands: &mut Vec<Command>) {
    // With ctrl they scale the whole window; plus is on the shifted half of its key on many
    // keyboards.
    let pressed = |key| ctx.input_mut(|i| !i.modifiers.command && i.consume_key(Modifiers::NONE, key));
    let zoom = |factor| Command::View(ViewCommand::Zoom { about_m: state.view.camera.centre_m, factor });
    if pressed(Key::Plus) || pressed(Key::Equals) {
        commands.push(zoom(ZOOM));
    }
    if pressed(Key::Minus) {
        commands.push(zoom(1.0 / ZOOM));
    }
    for (key, by) in [
        (Key::ArrowLeft, egui::vec2(PAN, 0.0)),
        (Key::ArrowRight, egui::vec2(-PAN, 0.0)),
        (Key::ArrowUp, egui::vec2(0.0, PAN)),
        (Key::ArrowDown, egui::vec2(0.0, -PAN)),
    ] {
        if ctx.input_mut(|i| i.consume_key(Modifiers::SHIFT, key)) {
            commands.push(Command::View(ViewCommand::Pan(by)));
        }
    }
}

/// Copy, cut and paste: of things of the scene, and of a table of points from another program.
fn clipboard(ctx: &Context, state: &AppState, commands: &mut Vec<Command>) {
    let scene = |command| Command::Scene(command);
    for event in ctx.input(|i| i.events.clone()) {
        match event {
            Event::Copy => commands.push(scene(SceneCommand::Copy)),
            Event::Cut => commands.push(scene(SceneCommand::Cut)),
            Event::Paste(text) if text == state.selection.clipboard.text && !state.selection.clipboard.is_empty() => {
                commands.push(scene(SceneCommand::Paste { at_m: state.selection.cursor_m }));
            }
            Event::Paste(text) => {
                let (path, unit_m) = (String::new(), "1".to_owned());
                let dialog = Dialog::ImportMap { path, text, unit_m };
                commands.push(Command::File(FileCommand::SetDialog(Some(dialog))));
            }
            _ => {}
        }
    }
}

/// N picks the next thing, M one more, Alt with an arrow moves what is picked by a grid line,
/// Ctrl+A picks everything.
fn pick_and_move(ctx: &Context, state: &AppState, commands: &mut Vec<Command>) {
    let all = handles::all(state);
    for (modifiers, forward) in [(Modifiers::SHIFT, false), (Modifiers::NONE, true)] {
        if ctx.input_mut(|i| i.consume_key(modifiers, Key::N)) && !all.is_empty() {
            let here = state.selection.selected.and_then(|s| all.iter().position(|i| *i == s));
            let next = match (here, forward) {
                (Some(k), true) => (k + 1) % all.len(),
                (Some(k), false) => (k + all.len() - 1) % all.len(),
                (None, true) => 0,
                (None, false) => all.len() - 1,
            };
            commands.push(Command::View(ViewCommand::Select(all.get(next).copied())));
        }
    }
    if ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::M)) {
        let mut picks = state.selection.selected_items();
        let after = picks.last().and_then(|s| all.iter().position(|i| i == s)).map_or(0, |k| k + 1);
        let next = all.iter().cycle().skip(after).take(all.len()).find(|i| !picks.contains(i));
        picks.extend(next);
        commands.push(Command::View(ViewCommand::SelectAll(picks)));
    }
    if ctx.input_mut(|i| i.consume_shortcut(&SELECT_ALL)) {
        commands.push(Command::View(ViewCommand::SelectAll(all)));
    }
    let Some(item) = state.selection.selected else { return };
    let [_, step] = grid::steps(&state.view.camera);
    for (key, by) in [
        (Key::ArrowRight, [step, 0.0]),
        (Key::ArrowLeft, [-step, 0.0]),
        (Key::ArrowUp, [0.0, step]),
        (Key::ArrowDown, [0.0, -step]),
    ] {
        if ctx.input_mut(|i| i.consume_key(Modifiers::ALT, key)) {
            commands.push(Command::Scene(SceneCommand::MoveAll(handles::moved(state, item, by))));
        }
    }
}

/// A and D drive the robot while they are held.
fn drive(ctx: &Context, state: &AppState, commands: &mut Vec<Command>) {
    if state.document.scene.robot.is_none() {
        return;
    }
    let [left, right, released] = ctx.input(|i| {
        let released = i.key_released(Key::A) || i.key_released(Key::D);
        [i.modifiers.is_none() && i.key_down(Key::A), i.modifiers.is_none() && i.key_down(Key::D), released]
    });
    let speed = robot::hand_speed(state);
    let order = match (left, right) {
        (true, false) => Some(-speed),
        (false, true) => Some(speed),
        _ if released => Some(0.0),
        _ => return,
    };
    if order != state.live.robot_speed_command {
        commands.push(Command::Playback(PlaybackCommand::DriveRobot(order)));
    }
}
