//! A strip leads through a guided scene, and a menu begins one.

use egui::{Align, Label, Layout, Ui};

use crate::app::guidance::tutorials::{self, TUTORIALS};
use crate::command::{Command, FileCommand, ViewCommand};
use crate::state::AppState;
use crate::state::dialog::Dialog;
use crate::state::tutorial_place::TutorialPlace;

/// Name of what the present step speaks of.
#[must_use]
pub fn points_at(state: &AppState) -> Option<&'static str> {
    state.ui.tutorial.and_then(tutorials::step).map(|step| step.points_at)
}

/// The menu of guides.
pub fn menu(ui: &mut Ui, commands: &mut Vec<Command>) {
    let help = "What to begin with: guides, scenes, files";
    if ui.button("Start here…").on_hover_text(help).clicked() {
        commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::StartHere))));
        ui.close();
    }
    ui.separator();
    for (guide, g) in TUTORIALS.iter().enumerate() {
        let help = "A scene and a few things to do in it; asks first if this one is not saved";
        if ui.button(format!("{}. {}", guide + 1, g.title)).on_hover_text(help).clicked() {
            commands.push(Command::File(tutorials::open(guide)));
            ui.close();
        }
    }
}

/// Draws the strip, if a guide is on.
pub fn strip(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(place) = state.ui.tutorial else { return };
    let (Some(guide), Some(step)) = (TUTORIALS.get(place.tutorial), tutorials::step(place)) else { return };
    let go = |to: Option<TutorialPlace>| Command::View(ViewCommand::SetTutorialPlace(to));
    let at = |step| Some(TutorialPlace { step, ..place });
    let done = step.done.is_some_and(|done| done(state));
    let last = place.step + 1 == guide.steps.len();
    if done && !last {
        commands.push(go(at(place.step + 1)));
    }
    let title = format!("{}, step {} of {}", guide.title, place.step + 1, guide.steps.len());
    let mut buttons = |ui: &mut Ui, which: BarPart| match which {
        BarPart::Done if done => drop(ui.weak("Done")),
        BarPart::Done => {}
        BarPart::Back => {
            let back = ui.add_enabled(place.step > 0, egui::Button::new("Back"));
            if back.on_hover_text("The step before").clicked() {
                commands.push(go(at(place.step.saturating_sub(1))));
            }
        }
        BarPart::Next if last => {
            let next = (place.tutorial + 1) % TUTORIALS.len();
            if ui.button("Next scene").on_hover_text(TUTORIALS[next].title).clicked() {
                commands.push(Command::File(tutorials::open(next)));
            }
        }
        BarPart::Next => {
            if ui.button("Next").on_hover_text("The next step, whether this one was done or not").clicked() {
                commands.push(go(at(place.step + 1)));
            }
        }
        BarPart::End => {
            if ui.button("End guide").on_hover_text("The scene stays open").clicked() {
                commands.push(go(None));
            }
        }
    };
    let parts = [BarPart::Done, BarPart::Back, BarPart::Next, BarPart::End];
    if ui.available_width() < ONE_ROW {
        ui.horizontal_wrapped(|ui| {
            ui.strong(title);
            ui.label(step.text);
            parts.into_iter().for_each(|part| buttons(ui, part));
        });
        return;
    }
    // A second row would move all that is below as steps come and go.
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            parts.into_iter().rev().for_each(|part| buttons(ui, part));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.strong(title);
                ui.add(Label::new(step.text).truncate()).on_hover_text(step.text);
            });
        });
    });
}

/// The mark or button beside the words of a step.
#[derive(Clone, Copy)]
enum BarPart {
    Done,
    Back,
    Next,
    End,
}

/// In a narrower window (points) a step takes the rows that it needs: its words would be cut.
const ONE_ROW: f32 = 1000.0;
