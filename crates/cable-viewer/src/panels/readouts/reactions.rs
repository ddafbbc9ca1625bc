//! The reactions give the force on each support: size, direction as an arrow, components.

use cable_core::Cable;
use cable_core::solution::{CableSolution, SupportReaction};
use egui::{Align, Align2, Label, Layout, RichText, Role, Sense, Stroke, Ui, Vec2, WidgetInfo, vec2};

use crate::command::{Command, ViewCommand};
use crate::units::{format, unit};
use crate::widgets::field;

/// Side of the square an arrow is drawn in, points.
const ARROW: f32 = 18.0;
/// Below this share of the largest reaction a direction is noise, and a dot is drawn.
const NEGLIGIBLE_FRACTION: f64 = 1e-9;

/// Draws them.
pub fn ui(ui: &mut Ui, cable: &Cable, solved: &CableSolution, commands: &mut Vec<Command>) {
    ui.label(RichText::new("Force of the cable on its supports").strong())
        .on_hover_text("What each support must hold; the force on the cable is the opposite");
    let largest = solved.supports.iter().map(size).fold(0.0, f64::max);
    for (k, s) in solved.supports.iter().enumerate() {
        let name = if s.name.is_empty() { format!("support {}", k + 1) } else { s.name.clone() };
        ui.horizontal(|ui| {
            arrow(ui, s, largest);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(format::force(size(s)));
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let link = ui.add(egui::Button::new(&name).frame(false).truncate());
                    field::name(&link, &format!("Show support {name}"));
                    if link.on_hover_text(explanation(cable, s)).clicked() {
                        commands.push(Command::View(ViewCommand::CentreOn([s.x_m, s.y_m])));
                    }
                });
            });
        });
        let [across, along] = format::force_with_direction([s.reaction_x_n, s.reaction_y_n]);
        ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
            ui.add(Label::new(RichText::new(format!("{across}, {along}")).weak()).truncate());
        });
    }
    for s in &solved.supports {
        hand(ui, s);
    }
}

/// The force with which a hand holds a support.
fn hand(ui: &mut Ui, s: &SupportReaction) {
    let Some(hand) = &s.hand else { return };
    let ahead = (hand.x_m - s.x_m).hypot(hand.y_m - s.y_m);
    let [across, along] = format::force_with_direction([hand.force_x_n, hand.force_y_n]);
    ui.label(format!(
        "Hand at {}: {} through a spring of {}, {} ahead",
        s.name,
        format::force(hand.force_n()),
        unit::Unit::N_PER_M.text(hand.stiffness_n_per_m),
        unit::Unit::COORDINATE.text(ahead)
    ))
    .on_hover_text(format!(
        "Force of the hand on the cable: {across}, {along}. The spring gives its stiffness times its length; the damper beside it gives the rest"
    ));
}

fn size(s: &SupportReaction) -> f64 {
    s.reaction_x_n.hypot(s.reaction_y_n)
}

/// Direction of the force, ° anticlockwise from the right.
fn direction_deg(s: &SupportReaction) -> f64 {
    s.reaction_y_n.atan2(s.reaction_x_n).to_degrees()
}

/// The text about a reaction on hover.
fn explanation(cable: &Cable, s: &SupportReaction) -> String {
    let mut text = format!(
        "{} at {:.1}° (anticlockwise from the right)\nAt {}, {} of {} along the cable",
        format::force(size(s)),
        direction_deg(s),
        format::position([s.x_m, s.y_m]),
        unit::Unit::COORDINATE.text(s.arc_length_m),
        unit::Unit::COORDINATE.text(cable.length_m)
    );
    if let (Some(before), Some(after)) = (s.tension_before_n, s.tension_after_n) {
        text += &format!("\nTension {} before and {} after it", format::force(before), format::force(after));
    }
    text + "\nClick to centre on it"
}

/// Draws the direction of a reaction; a dot if it is negligible beside the largest (N).
fn arrow(ui: &mut Ui, s: &SupportReaction, largest: f64) {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(ARROW), Sense::hover());
    let text = if size(s) > NEGLIGIBLE_FRACTION * largest {
        format!("{} at {:.0}°", format::force(size(s)), direction_deg(s))
    } else {
        "no force".to_owned()
    };
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("{}: {text}", s.name)));
    let colour = ui.visuals().strong_text_color();
    if size(s) > NEGLIGIBLE_FRACTION * largest {
        let angle = s.reaction_y_n.atan2(s.reaction_x_n) as f32;
        let along = vec2(angle.cos(), -angle.sin()) * (ARROW - 4.0);
        ui.painter().arrow(rect.center() - along / 2.0, along, Stroke::new(1.5, colour));
    } else {
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, "·", egui::FontId::proportional(16.0), colour);
    }
}
