//! Readouts panel: the figures of the present answer.

pub(crate) mod figures;
mod reactions;

use cable_core::Cable;
use cable_core::scene::View;
use cable_core::solution::{CableSolution, ContactState, Node};
use egui::{Color32, Grid, ProgressBar, RichText, Ui};

use super::field;
use super::icon::{self, Icon};
use super::unit;
use crate::command::{Command, ViewCommand};
use crate::state::AppState;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let index = state.current_cable();
    let Some(answer) = state.snapshot.solution.as_deref() else {
        ui.weak("Nothing solved yet");
        return;
    };
    // The figures belong to the scene that was solved, which may not be the one being typed.
    let scene = state.snapshot.scene.as_deref().unwrap_or(&state.scene);
    let (Some(cable), Some(solved)) = (scene.cables.get(index), answer.cables.get(index)) else {
        ui.weak("This cable is not solved yet");
        return;
    };
    if state.snapshot.stale {
        ui.horizontal(|ui| {
            let colour = ui.visuals().warn_fg_color;
            icon::sign(ui, Icon::Caution, colour);
            ui.colored_label(colour, "Of the last scene that was solved");
        })
        .response
        .on_hover_text("The present scene has no answer, or is still being solved");
    }
    if answer.cables.len() > 1 {
        ui.strong(&solved.name);
    }
    tension(ui, cable, solved, commands);
    ui.separator();
    Grid::new(("figures", index)).num_columns(3).spacing([10.0, 3.0]).show(ui, |ui| {
        let heat_k = scene.environment.temperature_change_k;
        let thermal = 1.0 + cable.thermal_expansion_per_k * heat_k;
        shape(ui, scene.view, (cable, solved, thermal), commands);
        material(ui, cable, solved, commands);
        accuracy(ui, solved);
    });
    ui.separator();
    reactions::ui(ui, cable, solved, commands);
}

/// The largest tension, where it is, and how much of the limits it takes.
fn tension(ui: &mut Ui, cable: &Cable, solved: &CableSolution, commands: &mut Vec<Command>) {
    let Some((tension_n, node)) = figures::greatest(solved, |n| n.tension_n) else {
        ui.weak("No tension in this answer");
        return;
    };
    ui.horizontal(|ui| {
        ui.label("Max tension");
        ui.label(RichText::new(unit::force(tension_n)).strong().size(18.0));
        place(ui, "Show the largest tension", &node, commands);
    });
    ui.weak(format!("at {} along the cable, {}", along(&node), unit::position([node.x_m, node.y_m])));
    for (name, limit_n, help) in [
        ("service", cable.service_tension_n, "Share of the tension of the first warning"),
        ("break", cable.breaking_tension_n, "Share of the tension at which it breaks"),
    ] {
        let share = tension_n / limit_n;
        let text = format!("{} of {name} {}", unit::percent(share), unit::force(limit_n));
        let bar = ProgressBar::new(share.clamp(0.0, 1.0) as f32)
            .fill(bar_colour(share, name == "break", ui.visuals().dark_mode))
            .text(text.clone())
            .desired_height(16.0)
            .corner_radius(2);
        let response = ui.add(bar);
        field::name(&response, &text);
        response.on_hover_text(help);
    }
}

/// Calm below the limit, amber above service, red above break; chosen to keep black or white text readable.
fn bar_colour(share: f64, breaking: bool, dark: bool) -> Color32 {
    match (share > 1.0, breaking) {
        (true, true) => Color32::from_rgb(214, 68, 68),
        (true, false) => Color32::from_rgb(201, 134, 20),
        _ if dark => Color32::from_rgb(38, 92, 138),
        _ => Color32::from_rgb(140, 190, 230),
    }
}

/// A row of the grid: name, value, and a button that shows the place or nothing.
fn figure(ui: &mut Ui, name: &str, value: String, help: &str, at: Option<(&Node, &mut Vec<Command>)>) {
    ui.label(name).on_hover_text(help);
    ui.label(value).on_hover_text(help);
    match at {
        Some((node, commands)) => place(ui, &format!("Show {}", name.to_lowercase()), node, commands),
        None => {
            ui.label("");
        }
    }
    ui.end_row();
}

fn along(node: &Node) -> String {
    unit::Unit::COORDINATE.text(node.arc_length_m)
}

fn place(ui: &mut Ui, label: &str, node: &Node, commands: &mut Vec<Command>) {
    let at_m = [node.x_m, node.y_m];
    let button = icon::plain_button(ui, Icon::Locate, true);
    field::name(&button, label);
    let text = format!("At {} along the cable, {}; click to centre on it", along(node), unit::position(at_m));
    if button.on_hover_text(text).clicked() {
        commands.push(Command::View(ViewCommand::CentreOn(at_m)));
    }
}

fn shape(
    ui: &mut Ui,
    view: View,
    (cable, solved, thermal): (&Cable, &CableSolution, f64),
    commands: &mut Vec<Command>,
) {
    let help = match view {
        View::Elevation => "Greatest depth below the straight line between neighbouring supports",
        View::Plan => "Greatest distance from the straight line between neighbouring supports",
    };
    match figures::sag(solved, view) {
        Some((depth_m, node)) => figure(ui, "Sag", unit::length(depth_m), help, Some((&node, &mut *commands))),
        None => figure(ui, "Sag", "–".to_owned(), "No two neighbouring supports stand apart", None),
    }
    let stretched_m = figures::stretched_length(solved, thermal);
    let longer = stretched_m - cable.length_m;
    let text =
        format!("{} ({}{})", unit::length(stretched_m), if longer < 0.0 { "" } else { "+" }, unit::length(longer));
    figure(
        ui,
        "Length now",
        text,
        "Unstretched length with strain and heat, and how much that is above the unstretched length",
        None,
    );
}

fn material(ui: &mut Ui, cable: &Cable, solved: &CableSolution, commands: &mut Vec<Command>) {
    if let Some((stress_pa, node)) = figures::greatest(solved, |n| n.stress_pa) {
        let help = "Largest tension over the full round section (conductors alone carry more)";
        figure(ui, "Max stress", unit::stress(stress_pa), help, Some((&node, &mut *commands)));
    }
    if let Some((strain, node)) = figures::greatest(solved, |n| n.strain) {
        figure(
            ui,
            "Max strain",
            unit::strain(strain),
            "Largest change of length over length",
            Some((&node, &mut *commands)),
        );
    }
    let Some((curvature, node)) = figures::greatest(solved, |n| n.curvature_per_m.abs()) else { return };
    if curvature > 0.0 {
        let radius_m = 1.0 / curvature;
        let help = "Tightest bend of the cable's centre line; what a support of no radius turns sharply is not counted";
        let limit = cable.min_bend_radius_m;
        let text = format!("{}{}", unit::length(radius_m), if radius_m < limit { ", too tight" } else { "" });
        figure(ui, "Min bend radius", text, help, Some((&node, commands)));
        if limit > 0.0 {
            figure(
                ui,
                "  allowed",
                format!("≥ {}", unit::length(limit)),
                "The cable's smallest allowed bend radius",
                None,
            );
        }
    } else {
        figure(ui, "Min bend radius", "straight".to_owned(), "No bend anywhere", None);
    }
}

fn accuracy(ui: &mut Ui, solved: &CableSolution) {
    let text = match solved.error_estimate {
        Some(0.0) => "exact for this model".to_owned(),
        Some(e) => format!("± {}", unit::percent(e)),
        None => "not estimated".to_owned(),
    };
    figure(
        ui,
        "Error estimate",
        text,
        "Estimated relative error of the largest tension, of discretisation alone",
        None,
    );
    if !solved.contacts.is_empty() {
        let sliding = solved.contacts.iter().filter(|c| c.state == ContactState::Slip).count();
        let normal_n: f64 = solved.contacts.iter().map(|c| c.normal_n).sum();
        let text = format!("{}, {sliding} sliding", solved.contacts.len());
        figure(ui, "Contacts", text, "Places where the cable touches an obstacle", None);
        figure(ui, "Contact force", unit::force(normal_n), "Sum of the normal forces", None);
    }
}
