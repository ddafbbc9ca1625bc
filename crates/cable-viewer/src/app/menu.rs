//! The menu bar offers the commands, and the status line says how the solver is doing.

use cable_core::scene::catalog;
use cable_core::verify::Verification;
use egui::{Button, Color32, KeyboardShortcut, MenuBar, Sense, Ui, Vec2};

use crate::app::keys;
use crate::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use crate::panels::words;
use crate::render::colour::{ColourMap, Quantity};
use crate::state::dialog::Dialog;
use crate::state::{AppState, Freshness, WorkerStatus};
use crate::units::system::System;
use crate::units::{labels, translate};

/// The menu bar.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file(ui, commands));
        ui.menu_button("Edit", |ui| edit(ui, state, commands));
        ui.menu_button("View", |ui| view(ui, state, commands));
        ui.menu_button("Scenes", |ui| scenes(ui, commands));
        ui.menu_button("Learn", |ui| crate::app::tutorial_bar::menu(ui, commands));
        if ui.button("Help").on_hover_text("Pointer and keys (F1)").clicked() {
            commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::Help))));
        }
        if ui.button("About").on_hover_text("What was checked and what was not").clicked() {
            commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::About))));
        }
        if ui.button("Feedback").on_hover_text("Four questions, saved to a CSV file on this computer").clicked() {
            commands.push(Command::File(feedback()));
        }
        ui.separator();
        ui.strong(title(state));
    });
}

/// Asks what the user thinks.
pub fn feedback() -> FileCommand {
    let (answers, path) = (crate::io::feedback::Answers::default(), "feedback.csv".to_owned());
    FileCommand::SetDialog(Some(Dialog::Feedback { answers, path }))
}

/// The scene's name, and whether it is saved.
pub fn title(state: &AppState) -> String {
    let name = if state.document.scene.name.is_empty() { "Untitled scene" } else { &state.document.scene.name };
    let mark = if state.document.unsaved() { " (not saved)" } else { "" };
    format!("{name}{mark}")
}

fn entry(ui: &mut Ui, text: &str, shortcut: Option<&KeyboardShortcut>) -> bool {
    let mut button = Button::new(text);
    if let Some(shortcut) = shortcut {
        button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
    }
    let clicked = ui.add(button).on_hover_text(help(text)).on_disabled_hover_text(help(text)).clicked();
    if clicked {
        ui.close();
    }
    clicked
}

/// What an entry does, where its name leaves something open.
fn help(text: &str) -> &'static str {
    match text {
        "Open…" => "A scene file; asks first if this one is not saved",
        "Save" => "To the same file; the old one stays intact if saving fails",
        "Save as…" => "To another file",
        "Import map…" => "Terrain and beams from a table or an SVG, added to the scene",
        "Open run…" => "A folder with a recording",
        "Save run…" => "The whole recording, as tables in a folder",
        "Quit" => "Asks first if the scene is not saved",
        "Undo" => "Back by one edit; a drag is one",
        "Redo" => "Forward by one edit",
        "Command palette…" => "Every command, by name",
        "Copy" => "The selection; other programs receive its points as a table",
        "Cut" => "Copies the selection and removes it",
        "Paste" => "At the pointer, or a little beside the original",
        "Remove selected" => "Removes the selection; cable ends become free",
        "Add a cable" => "Like the present one, half a metre above it",
        "Reset to start (R)" => "Back to the start",
        "Restart the solver" => "The scene stays as it is",
        "Fit scene (F)" => "Shows the whole scene",
        "Recentre on the cable (C)" => "Centres the cable, same scale",
        _ => "Opens this scene; asks first if the present one is not saved",
    }
}

fn file(ui: &mut Ui, commands: &mut Vec<Command>) {
    for (text, shortcut, command) in [
        ("Open…", Some(&keys::OPEN), FileCommand::AskOpen),
        ("Save", Some(&keys::SAVE), FileCommand::Save),
        ("Save as…", Some(&keys::SAVE_AS), FileCommand::AskSaveAs),
        ("Import map…", None, import_map()),
        ("Open run…", None, FileCommand::SetDialog(Some(Dialog::OpenRun { path: "run".to_owned(), hold: false }))),
        ("Save run…", None, FileCommand::SetDialog(Some(Dialog::SaveRun { path: "run".to_owned() }))),
        ("Quit", None, FileCommand::Quit),
    ] {
        if entry(ui, text, shortcut) {
            commands.push(Command::File(command));
        }
    }
}

/// Asks what to import.
pub fn import_map() -> FileCommand {
    let (path, text, unit_m) = (String::new(), String::new(), "1".to_owned());
    FileCommand::SetDialog(Some(Dialog::ImportMap { path, text, unit_m }))
}

fn edit(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let (undo, redo) = state.document.undo.available();
    for (text, shortcut, enabled, command) in
        [("Undo", &keys::UNDO, undo, SceneCommand::Undo), ("Redo", &keys::REDO, redo, SceneCommand::Redo)]
    {
        ui.add_enabled_ui(enabled, |ui| {
            if entry(ui, text, Some(shortcut)) {
                commands.push(Command::Scene(command));
            }
        });
    }
    if entry(ui, "Command palette…", Some(&keys::PALETTE)) {
        commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::Palette { text: String::new() }))));
    }
    ui.separator();
    let picked = state.selection.selected.is_some();
    for (text, shortcut, enabled, command) in [
        ("Copy", Some(&keys::COPY), picked, SceneCommand::Copy),
        ("Cut", Some(&keys::CUT), picked, SceneCommand::Cut),
        ("Paste", Some(&keys::PASTE), !state.selection.clipboard.is_empty(), SceneCommand::Paste { at_m: None }),
        ("Remove selected", None, picked, SceneCommand::RemoveAll(state.selection.picks())),
        ("Add a cable", None, !state.document.scene.cables.is_empty(), SceneCommand::AddCable),
    ] {
        ui.add_enabled_ui(enabled, |ui| {
            if entry(ui, text, shortcut) {
                commands.push(Command::Scene(command));
            }
        });
    }
    if entry(ui, "Reset to start (R)", None) {
        commands.push(Command::Playback(PlaybackCommand::Reset));
    }
    if matches!(state.solver.status, WorkerStatus::Dead(_)) && entry(ui, "Restart the solver", None) {
        commands.push(Command::File(FileCommand::RestartWorker));
    }
}

fn view(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    if entry(ui, "Fit scene (F)", None) {
        commands.push(Command::View(ViewCommand::Fit));
    }
    if entry(ui, "Recentre on the cable (C)", None) {
        commands.push(Command::View(ViewCommand::Recentre));
    }
    ui.separator();
    let mut layers = state.view.layers;
    ui.checkbox(&mut layers.grid, "Grid").on_hover_text("Lines and numbered axes");
    ui.checkbox(&mut layers.labels, "Labels").on_hover_text("Names, coordinates and figures");
    ui.checkbox(&mut layers.contacts, "Contacts").on_hover_text(
        "Where the cable touches: normal force and friction; filled and blue where it holds, hollow and orange where it slides",
    );
    ui.checkbox(&mut layers.forces, "Forces").on_hover_text("Loads, and what the cable does to its supports");
    ui.checkbox(&mut layers.components, "Force components").on_hover_text("Horizontal and vertical part of each force");
    ui.checkbox(&mut layers.nodes, "Nodes").on_hover_text("The points the model works with");
    ui.separator();
    ui.checkbox(&mut layers.snap, "Snap to grid").on_hover_text("Dragged points land on the finest grid lines shown");
    if layers != state.view.layers {
        commands.push(Command::View(ViewCommand::SetLayers(layers)));
    }
    ui.separator();
    colours(ui, state, commands);
    ui.separator();
    let mut units = state.view.units;
    ui.radio_value(&mut units, System::Si, "SI units").on_hover_text("Metres, newtons, kilograms");
    ui.radio_value(&mut units, System::Us, "US units").on_hover_text("Feet, pounds-force, pounds; files stay SI");
    if units != state.view.units {
        commands.push(Command::View(ViewCommand::SetUnits(units)));
    }
    ui.separator();
    let mut theme = state.view.theme;
    ui.radio_value(&mut theme, egui::ThemePreference::System, "Match system theme")
        .on_hover_text("Dark where it does not say");
    ui.radio_value(&mut theme, egui::ThemePreference::Light, "Light theme").on_hover_text("Dark on light");
    ui.radio_value(&mut theme, egui::ThemePreference::Dark, "Dark theme").on_hover_text("Light on dark");
    if theme != state.view.theme {
        commands.push(Command::View(ViewCommand::SetTheme(theme)));
    }
}

/// What the cable's colours show, and between which values.
fn colours(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let mut colour = state.view.colour;
    for quantity in Quantity::ALL {
        let text = format!("Colour by {}", quantity.name().to_lowercase());
        if ui
            .radio_value(&mut colour.quantity, quantity, text)
            .on_hover_text("What the colours of the cable show")
            .changed()
        {
            // A range of another quantity means nothing.
            colour.fixed = None;
        }
    }
    ui.menu_button("Colours", |ui| {
        for map in ColourMap::ALL {
            let help = "Even steps to every eye, also in grey and to colour-blind eyes";
            ui.radio_value(&mut colour.map, map, map.name()).on_hover_text(help);
        }
        let mut fixed = colour.fixed.is_some();
        let help =
            "On: the colours keep the values they have now; off: they follow the least and greatest of each answer";
        let present = state.live.snapshot.solution.as_deref().map(|s| state.view.colour.range(s));
        if ui.checkbox(&mut fixed, "Lock colour range").on_hover_text(help).changed() {
            colour.fixed = present.filter(|_| fixed);
        }
    });
    if colour != state.view.colour {
        commands.push(Command::View(ViewCommand::SetColour(colour)));
    }
}

fn scenes(ui: &mut Ui, commands: &mut Vec<Command>) {
    for (id, scene) in catalog::all() {
        if entry(ui, &scene.name, None) {
            commands.push(Command::File(FileCommand::OpenCatalogue(id.to_owned())));
        }
    }
}

/// Diameter of the light that shows the verdict, points.
const LIGHT_SIZE: f32 = 9.0;
/// Colour of the light where every law was asked and none is broken: green, told from red by its
/// brightness too.
const SOUND: Color32 = Color32::from_rgb(64, 170, 110);

/// Whether the answer obeys the laws of mechanics, as they were checked independently of the model
/// that gave it.
fn light(ui: &mut Ui, verification: &Verification) {
    let visuals = ui.visuals();
    let (lamp, colour, text) = match (verification.is_sound(), verification.not_checked.is_empty()) {
        (true, true) => (SOUND, visuals.text_color(), "checked: sound"),
        (true, false) => (visuals.weak_text_color(), visuals.weak_text_color(), "checked in part: sound"),
        (false, _) => (visuals.error_fg_color, visuals.error_fg_color, "NOT SOUND"),
    };
    let laws: Vec<&str> = verification.checked.iter().map(|l| l.name()).collect();
    let help = format!("{}. Checked: {}", translate::display(&verification.summary()), laws.join(", "));
    // The font has no signs for this: the light is painted, and the words say the same without its
    // colour.
    let (place, _) = ui.allocate_exact_size(Vec2::splat(LIGHT_SIZE), Sense::hover());
    ui.painter().circle_filled(place.center(), 0.5 * LIGHT_SIZE, lamp);
    ui.colored_label(colour, text).on_hover_text(help);
}

/// The status line: cursor, model, time taken.
pub fn status(ui: &mut Ui, state: &AppState) {
    ui.horizontal(|ui| {
        let (length, si) = labels::of_length();
        match state.selection.cursor_m.map(|p| p.map(|v| v / si)) {
            Some([x, y]) => ui.monospace(format!("x {x:9.3} {length}   y {y:9.3} {length}")),
            None => ui.monospace(format!("x         – {length}   y         – {length}")),
        };
        ui.separator();
        if let Some(solution) = &state.live.snapshot.solution {
            ui.label(format!("{} model", words::model(solution.model))).on_hover_text(&solution.reason);
            ui.separator();
            if let Some(verification) = solution.verification.as_ref().filter(|_| state.is_current()) {
                light(ui, verification);
                ui.separator();
            }
            ui.label(format!("t = {:.3} s", solution.time_s));
            ui.separator();
        }
        match (state.solving(), state.freshness()) {
            (Some(seconds), _) => {
                ui.label(labels::solving(seconds)).on_hover_text("The answer to the last edits is being sought");
            }
            (None, Freshness::Outdated) => {
                ui.label("not solved");
            }
            (None, _) => {
                ui.label(format!("solved in {:.2} ms", state.live.snapshot.solve_wall_s * 1e3));
            }
        }
        if let Some(latency) = state.solver.edit_latency_s.filter(|_| state.is_current()) {
            ui.separator();
            ui.label(format!("updated in {:.0} ms", latency * 1e3))
                .on_hover_text("From the last edit to the first frame that shows it");
        }
        if let Some(fault) = &state.ui.autosave_fault {
            ui.separator();
            ui.colored_label(ui.visuals().warn_fg_color, "changes are not kept for recovery").on_hover_text(fault);
        }
    });
}
