//! Where the robot can go without passing the service tension, and where its cable would snag: asked for, and read off.

use cable_core::robot::reach::Map;
use egui::{ProgressBar, Ui};

use super::field;
use super::unit::{self, Unit};
use crate::command::{Command, ViewCommand};
use crate::reach::Progress;
use crate::state::AppState;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.separator();
    ui.strong("Safe reach").on_hover_text(
        "Where the robot can go and come back without its cable passing a tension: without inertia, with friction, \
         whatever its drive can pull",
    );
    if let Progress::Running(share) = state.reach {
        let bar = ui.add(ProgressBar::new(share as f32).show_percentage().desired_height(16.0));
        field::name(&bar, "Progress of the safe reach");
        if ui.button("Cancel safe reach").on_hover_text("Ends the search; nothing is kept").clicked() {
            commands.push(Command::View(ViewCommand::Reach(false)));
        }
        return;
    }
    ui.horizontal(|ui| {
        let help = "Looks at places along the ground in view, each there and back; the window stays usable meanwhile";
        if ui.button("Find safe reach").on_hover_text(help).clicked() {
            commands.push(Command::View(ViewCommand::Reach(true)));
        }
        let shown = !matches!(state.reach, Progress::None);
        if ui
            .add_enabled(shown, egui::Button::new("Clear"))
            .on_hover_text("Takes the map away")
            .on_disabled_hover_text("There is no map yet")
            .clicked()
        {
            commands.push(Command::View(ViewCommand::Reach(false)));
        }
    });
    match &state.reach {
        Progress::Done((map, scene)) => {
            if **scene != state.scene {
                ui.colored_label(ui.visuals().warn_fg_color, "Of the scene before the last edits");
            }
            figures(ui, map);
        }
        Progress::Failed(why) => {
            field::fault(ui, &format!("No map: {why}"));
        }
        Progress::None | Progress::Running(_) => {}
    }
}

fn figures(ui: &mut Ui, map: &Map) {
    for (name, tension_n) in [("service", map.service_n), ("breaking", map.breaking_n)] {
        let to = |x| Unit { decimals: Some(2), ..Unit::M }.text(x);
        let text = match map.safe_m(tension_n) {
            Some([left, right]) => {
                format!("Below {name} {} from x = {} to {}", unit::force(tension_n), to(left), to(right))
            }
            None => format!("Above {name} {} where it stands", unit::force(tension_n)),
        };
        ui.label(text);
    }
}
