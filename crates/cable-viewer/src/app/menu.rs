//! The menu bar offers the commands; the headline stands in what it leaves of its row.

use cable_core::scene::catalog;
use egui::{Button, KeyboardShortcut, MenuBar, Ui};

use crate::app::{headline, keys};
use crate::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use crate::render::colour::{CableQuantity, ColourMap};
use crate::state::dialog::Dialog;
use crate::state::{AppState, WorkerStatus};
use crate::units::system::System;
use crate::widgets::checkbox_and_radio::{checkbox, radio_value};
use crate::widgets::highlight;

/// Narrower windows (points) have the last entries of the bar in a menu: the figures on the right
/// would lie over them.
const MIN_WHOLE_WIDTH: f32 = 760.0;

/// The menu bar.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file(ui, state, commands));
        let edit = ui.menu_button("Edit", |ui| edit(ui, state, commands));
        highlight::register(&edit.response, "Edit menu");
        ui.menu_button("View", |ui| view(ui, state, commands));
        ui.menu_button("Tools", |ui| crate::app::analysis_tools::menu(ui, state, commands));
        ui.menu_button("Scenes", |ui| scenes(ui, commands));
        ui.menu_button("Learn", |ui| crate::app::guidance::tutorial_bar::menu(ui, commands));
        if ui.ctx().content_rect().width() < MIN_WHOLE_WIDTH {
            ui.menu_button("More", |ui| dialogs(ui, commands));
        } else {
            dialogs(ui, commands);
        }
        ui.separator();
        headline::ui(ui, state, commands);
    });
}

/// The buttons that open dialogs about the program.
fn dialogs(ui: &mut Ui, commands: &mut Vec<Command>) {
    for (text, help, command) in [
        ("Help", "Pointer and keys (F1)", FileCommand::SetDialog(Some(Dialog::Help))),
        ("About", "What was checked and what was not", FileCommand::SetDialog(Some(Dialog::About))),
        ("Feedback", "Four questions, saved to a CSV file on this computer", feedback()),
    ] {
        if ui.button(text).on_hover_text(help).clicked() {
            commands.push(Command::File(command));
            ui.close();
        }
    }
}

/// Asks what the user thinks.
pub fn feedback() -> FileCommand {
    let (answers, path) = (crate::io::feedback::Answers::default(), "feedback.csv".to_owned());
    FileCommand::SetDialog(Some(Dialog::Feedback { answers, path }))
}

/// An entry of a menu; returns whether it was clicked.
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

/// Returns what an entry does, where its name leaves something open.
fn help(text: &str) -> &'static str {
    match text {
        "New" => "A scene with one cable; asks first if this one is not saved",
        "Open…" => "A scene file; asks first if this one is not saved",
        "Save" => "To the same file; the old one stays intact if saving fails",
        "Save as…" => "To another file",
        "Import map…" => "Terrain and beams from a table or an SVG, added to the scene",
        "Export picture…" => "The canvas with its legend, as PNG or SVG",
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

/// The file menu.
fn file(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    for (text, shortcut, command) in [
        ("New", Some(&keys::NEW), FileCommand::New),
        ("Open…", Some(&keys::OPEN), FileCommand::AskOpen),
        ("Save", Some(&keys::SAVE), FileCommand::Save),
        ("Save as…", Some(&keys::SAVE_AS), FileCommand::AskSaveAs),
        ("Import map…", None, import_map()),
        ("Export picture…", None, FileCommand::AskExportPicture),
        ("Open run…", None, FileCommand::SetDialog(Some(Dialog::OpenRun { path: "run".to_owned(), hold: false }))),
        ("Save run…", None, FileCommand::SetDialog(Some(Dialog::SaveRun { path: "run".to_owned() }))),
        ("Quit", Some(&keys::QUIT), FileCommand::Quit),
    ] {
        let opens = command == FileCommand::AskOpen;
        if ["Save", "Import map…", "Open run…", "Quit"].contains(&text) {
            ui.separator();
        }
        if entry(ui, text, shortcut) {
            commands.push(Command::File(command));
        }
        if opens {
            recent(ui, state, commands);
        }
    }
}

/// The files opened and saved last.
fn recent(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let help = "Files opened and saved last";
    let list = ui.add_enabled_ui(!state.ui.recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for path in &state.ui.recent {
                let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
                if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                    commands.push(Command::File(FileCommand::Open(path.clone())));
                    ui.close();
                }
            }
        })
        .response
        .on_hover_text(help)
        .on_disabled_hover_text("No file was opened or saved yet")
    });
    list.response.on_hover_text(help);
}

/// Asks what to import.
pub fn import_map() -> FileCommand {
    let (path, text, unit_m) = (String::new(), String::new(), "1".to_owned());
    FileCommand::SetDialog(Some(Dialog::ImportMap { path, text, unit_m }))
}

/// The edit menu.
fn edit(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let (undo, redo) = state.document.undo.can_undo_and_redo();
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
        ("Remove selected", None, picked, SceneCommand::RemoveAll(state.selection.selected_items())),
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

/// The view menu.
fn view(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    if entry(ui, "Fit scene (F)", None) {
        commands.push(Command::View(ViewCommand::Fit));
    }
    if entry(ui, "Recentre on the cable (C)", None) {
        commands.push(Command::View(ViewCommand::Recentre));
    }
    ui.separator();
    let mut panels = state.ui.panels;
    checkbox(ui, &mut panels.edit, "Outline ([)").on_hover_text("Outline, scene, robot, cable, environment, solver");
    checkbox(ui, &mut panels.results, "Results panel (])").on_hover_text("Warnings, readouts, safe reach, compare");
    checkbox(ui, &mut panels.graphs, "Graphs and timeline (G)").on_hover_text("The drawer below the canvas");
    if panels != state.ui.panels {
        commands.push(Command::View(ViewCommand::ShowPanels(panels)));
    }
    ui.separator();
    let mut layers = state.view.layers;
    checkbox(ui, &mut layers.grid, "Grid").on_hover_text("Lines and numbered axes");
    checkbox(ui, &mut layers.labels, "Labels").on_hover_text("Names, coordinates and figures");
    checkbox(ui, &mut layers.contacts, "Contacts").on_hover_text(
        "Where the cable touches: normal force and friction; filled where it holds, hollow where it slides",
    );
    checkbox(ui, &mut layers.forces, "Forces").on_hover_text("Loads, and what the cable does to its supports");
    checkbox(ui, &mut layers.components, "Force components")
        .on_hover_text("Horizontal and vertical part of each force");
    checkbox(ui, &mut layers.nodes, "Nodes").on_hover_text("The points the model works with");
    checkbox(ui, &mut layers.start_shape, "Shape at the start")
        .on_hover_text("Where the cable lay when the run began, dashed beside where it is now");
    ui.separator();
    checkbox(ui, &mut layers.snap, "Snap to grid").on_hover_text("Dragged points land on the finest grid lines shown");
    if layers != state.view.layers {
        commands.push(Command::View(ViewCommand::SetLayers(layers)));
    }
    ui.separator();
    colours(ui, state, commands);
    ui.separator();
    let mut units = state.view.units;
    radio_value(ui, &mut units, System::Si, "SI units").on_hover_text("Metres, newtons, kilograms");
    radio_value(ui, &mut units, System::Us, "US units").on_hover_text("Feet, pounds-force, pounds; files stay SI");
    if units != state.view.units {
        commands.push(Command::View(ViewCommand::SetUnits(units)));
    }
    ui.separator();
    let mut theme = state.view.theme;
    radio_value(ui, &mut theme, egui::ThemePreference::System, "Match system theme")
        .on_hover_text("Dark where it does not say");
    radio_value(ui, &mut theme, egui::ThemePreference::Light, "Light theme").on_hover_text("Dark on light");
    radio_value(ui, &mut theme, egui::ThemePreference::Dark, "Dark theme").on_hover_text("Light on dark");
    if theme != state.view.theme {
        commands.push(Command::View(ViewCommand::SetTheme(theme)));
    }
}

/// Offers what the cable's colours show, and between which values.
fn colours(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let mut colour = state.view.colour;
    for quantity in CableQuantity::ALL {
        let text = format!("Colour by {}", quantity.name().to_lowercase());
        if radio_value(ui, &mut colour.quantity, quantity, text)
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
            radio_value(ui, &mut colour.map, map, map.name()).on_hover_text(help);
        }
        let mut fixed = colour.fixed.is_some();
        let help =
            "On: the colours keep the values they have now; off: they follow the least and greatest of each answer";
        let present = state.live.snapshot.solution.as_deref().map(|s| state.view.colour.range(s));
        if checkbox(ui, &mut fixed, "Lock colour range").on_hover_text(help).changed() {
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
