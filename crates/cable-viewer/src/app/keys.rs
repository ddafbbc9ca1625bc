//! The keyboard. Single keys are left to a text field that has the focus.

use egui::{Context, Key, KeyboardShortcut, Modifiers};

use crate::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use crate::dialog::Dialog;
use crate::panels::robot;
use crate::state::AppState;

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
/// Back by one edit.
pub const UNDO: KeyboardShortcut = with_command(Key::Z);
/// Forward by one edit.
pub const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);

/// Pushes what the keys of this frame ask for.
pub fn read(ctx: &Context, state: &AppState, commands: &mut Vec<Command>) {
    if state.dialog.is_some() {
        if ctx.input(|i| i.key_pressed(Key::Escape)) {
            commands.push(Command::File(FileCommand::SetDialog(None)));
        }
        return;
    }
    // The longer shortcut first: ctrl+shift+S contains ctrl+S.
    for (shortcut, command) in [
        (SAVE_AS, Command::File(FileCommand::AskSaveAs)),
        (SAVE, Command::File(FileCommand::Save)),
        (OPEN, Command::File(FileCommand::AskOpen)),
        (PALETTE, Command::File(FileCommand::SetDialog(Some(Dialog::Palette { text: String::new() })))),
    ] {
        if ctx.input_mut(|i| i.consume_shortcut(&shortcut)) {
            commands.push(command);
        }
    }
    if ctx.egui_wants_keyboard_input() {
        return;
    }
    for (shortcut, command) in [(REDO, SceneCommand::Redo), (UNDO, SceneCommand::Undo)] {
        if ctx.input_mut(|i| i.consume_shortcut(&shortcut)) {
            commands.push(Command::Scene(command));
        }
    }
    let plain = |key| ctx.input_mut(|i| i.consume_key(Modifiers::NONE, key));
    if plain(Key::F) {
        commands.push(Command::View(ViewCommand::Fit));
    }
    if plain(Key::C) {
        commands.push(Command::View(ViewCommand::Recentre));
    }
    if plain(Key::Space) {
        commands.push(Command::Playback(PlaybackCommand::TogglePause));
    }
    if plain(Key::ArrowRight) {
        commands.push(Command::Playback(PlaybackCommand::Step));
    }
    if plain(Key::ArrowLeft) {
        commands.push(Command::Playback(PlaybackCommand::StepBack));
    }
    drive(ctx, state, commands);
    if plain(Key::R) {
        commands.push(Command::Playback(PlaybackCommand::Reset));
    }
    if plain(Key::F1) {
        commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::Help))));
    }
    if (plain(Key::Delete) || plain(Key::Backspace))
        && let Some(item) = state.selected
    {
        commands.push(Command::Scene(SceneCommand::Remove(item)));
    }
    if plain(Key::Escape) {
        commands.push(Command::View(ViewCommand::Select(None)));
    }
}

/// A and D drive the robot while they are held.
fn drive(ctx: &Context, state: &AppState, commands: &mut Vec<Command>) {
    if state.scene.robot.is_none() {
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
    if order != state.robot_order {
        commands.push(Command::Playback(PlaybackCommand::DriveRobot(order)));
    }
}
