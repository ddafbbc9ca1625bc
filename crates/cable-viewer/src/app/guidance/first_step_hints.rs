//! The hints of the first minute stand at the foot of the canvas; each goes once it was followed.

use egui::{Align2, Area, Frame, Id, Label, Margin, Order, Pos2, Rect, Ui, pos2, vec2};

use crate::canvas;
use crate::command::{Command, FileCommand, ViewCommand};
use crate::state::dialog::Dialog;
use crate::state::{AppState, FirstStep};
use crate::widgets::field;
use crate::widgets::icon::{self, Icon};

/// Distance from the foot of the canvas, points: the scale bar and the axis stay in sight.
const FOOT_DISTANCE_POINTS: f32 = 58.0;
/// Space round the words, points.
const MARGIN: Margin = Margin { left: 10, right: 10, top: 4, bottom: 4 };
/// Space between the words and the buttons, points.
const GAP: f32 = 6.0;
/// Height of the line, points: that of a button.
const HEIGHT: f32 = 22.0;
/// Half the width of the buttons beside the hints, points: both together stand in the middle.
const BUTTONS: f32 = 71.0;
/// Narrower canvases (points) have no room for a line of hints.
const MIN_WIDTH: f32 = 420.0;

/// Draws those that are still open over the canvas.
pub fn ui(ui: &Ui, canvas: Rect, state: &AppState, commands: &mut Vec<Command>) {
    let open = state.ui.first_steps.open();
    if open.is_empty() || canvas.width() < MIN_WIDTH || state.ui.tutorial.is_some() {
        return;
    }
    // The words let the pointer through to what lies below them; only the buttons take it.
    let area = |name: &str, at: Pos2| {
        Area::new(Id::unique(("first steps", name.to_owned()))).order(Order::Middle).fixed_pos(at)
    };
    let foot = pos2(canvas.center().x - BUTTONS, canvas.bottom() - FOOT_DISTANCE_POINTS);
    let hints = area("words", foot).pivot(Align2::CENTER_BOTTOM).interactable(false).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).inner_margin(MARGIN).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.set_min_height(HEIGHT);
                for (k, step) in open.iter().enumerate() {
                    if k > 0 {
                        ui.separator();
                    }
                    ui.add(Label::new(text(state, *step)).selectable(false));
                }
            });
        });
    });
    let buttons = area("buttons", hints.response.rect.right_top() + vec2(GAP, 0.0)).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).inner_margin(MARGIN).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.set_min_height(HEIGHT);
                let help = "What to begin with: guides, scenes, files";
                if ui.button("Start here…").on_hover_text(help).clicked() {
                    commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::StartHere))));
                }
                let hide = icon::plain_button(ui, Icon::Remove);
                field::name(&hide, "Hide these hints");
                if hide.on_hover_text("Hides these hints for good").clicked() {
                    commands.push(Command::View(ViewCommand::HideFirstSteps));
                }
            });
        });
    });
    canvas::keep_clear(ui, hints.response.rect.union(buttons.response.rect));
}

/// The text of the hint for a step.
fn text(state: &AppState, step: FirstStep) -> String {
    match step {
        FirstStep::Drag => {
            if state.document.scene.robot.is_some() {
                return "Drag the robot".to_owned();
            }
            // One that is held at a place.
            let support =
                state.document.scene.cables.first().and_then(|c| c.supports.iter().rfind(|s| s.at_m.is_some()));
            support.map_or_else(|| "Drag an end of the cable".to_owned(), |s| format!("Drag “{}”", s.name))
        }
        FirstStep::Play => "Press Space to play".to_owned(),
        FirstStep::Zoom => "Scroll to zoom".to_owned(),
    }
}
