//! The headline is what an engineer looks at first, always in sight: the scene's name, the greatest
//! tension with its share of the limit, and whether the answer was checked.

use cable_core::answer_verifier::Verification;
use egui::{Align, Button, Label, Layout, RichText, Sense, Ui, Vec2};

use crate::command::{Command, ViewCommand};
use crate::panels::readouts::OUTDATED_FIGURE_OPACITY;
use crate::render::theme;
use crate::state::{AppState, Freshness};
use crate::units::format;
use crate::units::sentence::sentence;

/// Draws it into the rest of a row.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        figures(ui, state, commands);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            ui.add(Label::new(RichText::new(title(state)).strong()).truncate());
        });
    });
}

/// The scene's name, and whether it is saved.
pub fn title(state: &AppState) -> String {
    let name = if state.document.scene.name.is_empty() { "Untitled scene" } else { &state.document.scene.name };
    let mark = if state.document.unsaved() { " (not saved)" } else { "" };
    let file = state.document.path.as_deref().and_then(|p| p.file_name());
    let file = file.map_or_else(String::new, |f| format!(" – {}", f.to_string_lossy()));
    format!("{name}{mark}{file}")
}

/// Draws the greatest tension, how much of the service tension that is, and the verdict of the
/// verification, from right to left.
fn figures(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(answer) = state.live.snapshot.solution.as_deref() else { return };
    let current = state.is_current();
    if !current {
        let (said, help) = match state.freshness() {
            Freshness::Outdated => ("out of date", "This figure is of the last scene that had an answer"),
            Freshness::Draft => ("solving…", "This figure is of a coarse preview"),
            _ => ("solving…", "This figure is of the scene before the last change"),
        };
        ui.colored_label(ui.visuals().warn_fg_color, said).on_hover_text(help);
    }
    let most = answer.max_tension();
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    if let Some(verification) = answer.verification.as_ref().filter(|_| current) {
        verdict_light(ui, verification);
        ui.separator();
    }
    if let Some(cable) = scene.cables.get(most.cable).filter(|_| current) {
        let share = most.tension_n / cable.service_tension_n;
        let colour = if most.tension_n > cable.breaking_tension_n {
            ui.visuals().error_fg_color
        } else if share > 1.0 {
            ui.visuals().warn_fg_color
        } else {
            ui.visuals().text_color()
        };
        let help = format!("Service tension {}", format::force(cable.service_tension_n));
        ui.colored_label(colour, format!("{} of service", format::percent(share))).on_hover_text(help);
    }
    let text = RichText::new(format!("Max {}", format::force(most.tension_n))).size(14.0);
    let text = if current {
        text.strong()
    } else {
        text.color(ui.visuals().text_color().gamma_multiply(OUTDATED_FIGURE_OPACITY))
    };
    let figure = ui.add(Button::new(text).frame(false));
    if figure.on_hover_text("Greatest tension of all cables; click to see where").clicked() {
        let at = answer.cables.get(most.cable).and_then(|c| {
            let k = c.nodes.partition_point(|n| n.arc_length_m < most.arc_length_m);
            c.nodes.get(k).or(c.nodes.last())
        });
        commands.extend(at.map(|n| Command::View(ViewCommand::ZoomOn([n.x_m, n.y_m]))));
    }
}

/// Returns the outcome of a verification in a word or two.
pub fn verdict(verification: &Verification) -> &'static str {
    match (verification.is_sound(), verification.not_checked.is_empty()) {
        (true, true) => "verified",
        (true, false) => "partly verified",
        (false, _) => "VERIFICATION FAILED",
    }
}

/// Diameter of the light that shows the verdict, points.
const LIGHT_SIZE: f32 = 9.0;
/// The light that says if the answer obeys the laws of mechanics, checked independently of the
/// model that gave it.
fn verdict_light(ui: &mut Ui, verification: &Verification) {
    let visuals = ui.visuals();
    let text = verdict(verification);
    let (lamp, colour) = match (verification.is_sound(), verification.not_checked.is_empty()) {
        (true, true) => (theme::palette(visuals).sound, visuals.text_color()),
        (true, false) => (visuals.weak_text_color(), visuals.weak_text_color()),
        (false, _) => (visuals.error_fg_color, visuals.error_fg_color),
    };
    let laws: Vec<&str> = verification.checked.iter().map(|l| l.name()).collect();
    let help = format!("{}. Checked: {}", sentence(verification), laws.join(", "));
    // The font has no signs for this: the light is painted, and the words say the same without its
    // colour.
    let (place, _) = ui.allocate_exact_size(Vec2::splat(LIGHT_SIZE), Sense::hover());
    ui.painter().circle_filled(place.center(), 0.5 * LIGHT_SIZE, lamp);
    ui.colored_label(colour, text).on_hover_text(help);
}
