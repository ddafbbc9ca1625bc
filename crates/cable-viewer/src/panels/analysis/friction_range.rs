//! This panel asks how much less and more friction there may be, and shows what that does to the
//! tension.

use egui::{Grid, Ui};

use crate::command::{Command, ViewCommand};
use crate::jobs::background::Progress;
use crate::jobs::friction_range;
use crate::state::AppState;
use crate::units::format;
use crate::units::sentence::sentence;
use crate::units::unit::Unit;
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::property::{PropertyQuantity, Provenance, row};
use crate::widgets::{field, progress};

const MIN_FRICTION: PropertyQuantity = PropertyQuantity {
    name: "Least friction",
    unit: Unit::PERCENT,
    usual: [0.0, 1.0],
    logarithmic: false,
    help: "Lowest friction to assume, as a share of the values in the scene: cables, obstacles and pulleys alike.",
};
const GREATEST_FRICTION: PropertyQuantity = PropertyQuantity {
    name: "Most friction",
    unit: Unit::PERCENT,
    usual: [1.0, 3.0],
    logarithmic: false,
    help: "Highest friction to assume, as a share of the values in the scene: cables, obstacles and pulleys alike.",
};

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let view = &state.analysis.friction_range;
    let mut on = view.on;
    let help = "Repeats the run with less and with more friction and shows the spread as a ribbon in the tension graphs. Computed \
                in the background while time is paused; what you moved or drove by hand is repeated";
    if checkbox(ui, &mut on, "Show friction range").on_hover_text(help).changed() {
        commands.push(Command::View(ViewCommand::SetFrictionRange { shown: on, factors: view.factors }));
    }
    if !on {
        return;
    }
    let usual = friction_range::FrictionRangeState::default().factors;
    for (k, quantity) in [MIN_FRICTION, GREATEST_FRICTION].iter().enumerate() {
        let origin = Some((usual[k], "the default".to_owned()));
        let change = row(ui, quantity, &Provenance { value: view.factors[k], origin, ..Provenance::default() });
        if let Some(value) = change.value {
            let mut factors = view.factors;
            factors[k] = value;
            commands.push(Command::View(ViewCommand::SetFrictionRange { shown: true, factors }));
        }
    }
    match &view.progress {
        Progress::None => {
            ui.weak("Begins once time is paused");
        }
        Progress::Running(share, _) => {
            let bar = progress::bar(ui, *share);
            field::name(&bar, "Progress of the friction range");
        }
        Progress::Failed(why) => field::fault(ui, &format!("No range: {why}")),
        Progress::Done((found, _)) => {
            Grid::new("spread").num_columns(3).spacing([10.0, 3.0]).show(ui, |ui| {
                for title in ["Least friction", "As in the scene", "Most friction"] {
                    ui.weak(title).on_hover_text("Greatest tension of all cables at the end of the run");
                }
                ui.end_row();
                for most_n in found.most_n {
                    ui.label(format::force(most_n));
                }
                ui.end_row();
            });
            if let Some(failure) = &found.failure {
                field::fault(ui, &format!("Up to {:.2} s: {}", failure.time_s, sentence(&failure.error)));
            }
        }
    }
}
