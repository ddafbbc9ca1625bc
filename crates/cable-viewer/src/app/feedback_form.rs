//! A dialog asks what the user thinks.

use egui::{TextEdit, Ui};

use crate::command::{Command, FileCommand};
use crate::io::feedback::{Answers, MAX_RATING, MIN_GOOD_RATING, QUESTIONS};
use crate::widgets::checkbox_and_radio::radio_button;
use crate::widgets::field;

/// Draws it.
pub fn ui(ui: &mut Ui, answers: &mut Answers, path: &mut String, commands: &mut Vec<Command>) {
    ui.heading("What do you think of it?");
    ui.weak("1: not at all, 5: fully. Saved to a CSV file on this computer; nothing is sent anywhere.");
    ui.add_space(6.0);
    egui::Grid::new("feedback").num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
        for ((_, question), mark) in QUESTIONS.iter().zip(&mut answers.marks) {
            ui.label(*question);
            ui.horizontal(|ui| {
                for k in 1..=MAX_RATING {
                    let button = radio_button(ui, *mark == Some(k), k.to_string());
                    field::name(&button, &format!("{question}: {k}"));
                    if button.clicked() {
                        *mark = Some(k);
                    }
                }
            });
            ui.end_row();
        }
    });
    let label = ui.label("What was confusing or should change?");
    ui.add(TextEdit::multiline(&mut answers.words).desired_rows(3).desired_width(f32::INFINITY)).labelled_by(label.id);
    if answers.needs_comment() {
        ui.colored_label(ui.visuals().warn_fg_color, format!("Below {MIN_GOOD_RATING}: please say what was confusing"));
    }
    ui.horizontal(|ui| {
        let label = ui.label("Table");
        ui.add(TextEdit::singleline(path).desired_width(300.0)).labelled_by(label.id);
    });
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        let ready = answers.complete() && !path.trim().is_empty();
        let save = ui.add_enabled(ready, egui::Button::new("Save feedback"));
        if save.on_disabled_hover_text("Every question needs a mark, and a low one a few words").clicked() {
            let path = std::path::PathBuf::from(path.trim());
            commands.push(Command::File(FileCommand::SaveFeedback(path, answers.clone())));
        }
        if ui.button("Cancel").clicked() {
            commands.push(Command::File(FileCommand::SetDialog(None)));
        }
    });
}
