//! The first dialog offers what to begin with: guides, a file, and the keys.

use std::path::PathBuf;

use egui::Ui;

use crate::app::guidance::tutorials::{self, TUTORIALS};
use crate::command::{Command, FileCommand};
use crate::state::dialog::Dialog;

/// Most recent files that are offered: the File menu has the rest.
const MAX_RECENT: usize = 4;

/// Draws it.
pub fn ui(ui: &mut Ui, recent: &[PathBuf], commands: &mut Vec<Command>) {
    ui.heading("Start here");
    ui.label("Each guide opens a scene, points at what it speaks of, and moves on when you have done it.");
    ui.add_space(6.0);
    for (k, guide) in TUTORIALS.iter().enumerate() {
        ui.horizontal_top(|ui| {
            let title = format!("{}. {}", k + 1, guide.title);
            let button = egui::Button::new(title).min_size(egui::vec2(160.0, 0.0));
            if ui.add(button).on_hover_text("Opens its scene; asks first if this one is not saved").clicked() {
                commands.push(Command::File(tutorials::open(k)));
            }
            let first = guide.steps.first().map_or("", |s| s.text);
            ui.add(egui::Label::new(egui::RichText::new(first).weak()).wrap());
        });
    }
    ui.add_space(8.0);
    ui.horizontal_wrapped(|ui| {
        for path in recent.iter().take(MAX_RECENT) {
            let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
            if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                commands.push(Command::File(FileCommand::Open(path.clone())));
            }
        }
        for (text, help, command) in [
            ("Open a file…", "A scene file", FileCommand::AskOpen),
            ("New scene", "One cable between two points", FileCommand::New),
            ("Pointer and keys", "What they do", FileCommand::SetDialog(Some(Dialog::Help))),
        ] {
            if ui.button(text).on_hover_text(help).clicked() {
                commands.push(Command::File(command));
            }
        }
    });
    ui.add_space(8.0);
    if ui.button("Close").clicked() {
        commands.push(Command::File(FileCommand::SetDialog(None)));
    }
}
