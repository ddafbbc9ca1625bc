//! The tension budget shows what adds to the tension at a place and what takes from it, as a bar
//! and as figures.

use cable_core::analysis::tension_budget::{Cause, Contribution, StartEnd, TensionBudget, tension_budget};
use cable_core::scene::View;
use cable_core::solution::Node;
use cable_core::{Scene, Solution};
use egui::{Align, Color32, Label, Layout, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::command::{Command, ViewCommand};
use crate::panels::readouts::dimmed_if_old;
use crate::render::colour::LINES;
use crate::state::{AppState, TensionMarker};
use crate::units::format::{self, significant};
use crate::units::unit::Unit;
use crate::widgets::property::{PropertyQuantity, Provenance, row};
use crate::widgets::readout;

/// Height of each of the two rows of the bar, points.
const BAR_ROW_HEIGHT: f32 = 15.0;
/// Terms below this share of the greatest are not listed: rounding.
const NEGLIGIBLE_FRACTION: f64 = 1e-6;

const END_COLOUR: Color32 = Color32::from_rgb(136, 136, 136);
const WEIGHT: Color32 = LINES[1];
const WIND: Color32 = Color32::from_rgb(110, 190, 190);
/// Neighbouring contacts differ.
const CONTACTS: [Color32; 2] = [LINES[2], Color32::from_rgb(170, 145, 220)];
const SUPPORT: Color32 = Color32::from_rgb(0, 158, 115);
const LOAD: Color32 = LINES[3];
const REST: Color32 = Color32::from_rgb(190, 190, 190);

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(answer) = state.live.snapshot.solution.as_deref() else {
        ui.weak("Nothing solved yet");
        return;
    };
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    ui.horizontal_wrapped(|ui| {
        let help = "Breaks the greatest tension down into weight, friction at each contact and pull at the end";
        if ui.button("At the greatest tension").on_hover_text(help).clicked() {
            commands.push(Command::View(ViewCommand::SetTensionMarker(at_the_largest(state))));
        }
        let help = "Removes the mark";
        if state.analysis.tension_marker.is_some() && ui.button("Unmark").on_hover_text(help).clicked() {
            commands.push(Command::View(ViewCommand::SetTensionMarker(None)));
        }
    });
    let Some(probe) = state.analysis.tension_marker else {
        ui.weak("Click the cable to break its tension down");
        return;
    };
    let Some(found) = tension_budget(scene, answer, probe.cable, probe.arc_length_m, probe.from) else {
        ui.weak("This cable is not solved");
        return;
    };
    place(ui, scene, probe, commands);
    dimmed_if_old(ui, state, |ui| {
        ui.horizontal(|ui| {
            ui.label("Tension there");
            ui.strong(format::force(found.tension_n));
        });
        motion(ui, answer, probe);
        let listed = listed(&found);
        bar(ui, &found, &listed, &|t| title(scene, answer, probe.cable, t));
        figures(ui, &listed, &|t| title(scene, answer, probe.cable, t), &|t| how(answer, probe.cable, t));
    });
}

/// A mark at the largest tension of the answer on screen.
#[must_use]
pub fn at_the_largest(state: &AppState) -> Option<TensionMarker> {
    let most = state.live.snapshot.solution.as_deref()?.max_tension();
    let from = state.analysis.tension_marker.map(|p| p.from).unwrap_or_default();
    Some(TensionMarker { cable: most.cable, arc_length_m: most.arc_length_m, from })
}

/// The place and the end the sum begins at, both to be set by keys as well.
fn place(ui: &mut Ui, scene: &Scene, probe: TensionMarker, commands: &mut Vec<Command>) {
    let Some(cable) = scene.cables.get(probe.cable) else { return };
    let quantity = PropertyQuantity {
        name: "Place on the cable",
        unit: Unit::COORDINATE,
        usual: [0.0, cable.length_m],
        logarithmic: false,
        help: "Unstretched length from the start of the cable to the place whose tension is broken down",
    };
    let change = row(ui, &quantity, &Provenance { value: probe.arc_length_m, ..Provenance::default() });
    if let Some(value) = change.value {
        let arc_length_m = value.clamp(0.0, cable.length_m);
        commands.push(Command::View(ViewCommand::SetTensionMarker(Some(TensionMarker { arc_length_m, ..probe }))));
    }
    ui.horizontal_wrapped(|ui| {
        ui.weak("From").on_hover_text("The end at which the sum begins");
        let name = |end: Option<&cable_core::Support>, other: &str| end.map_or(other.to_owned(), |s| s.name.clone());
        let ends = [
            (StartEnd::Slacker, "the lower-tension end".to_owned()),
            (StartEnd::Start, name(cable.supports.first(), "start")),
            (StartEnd::End, name(cable.supports.last(), "end")),
        ];
        for (from, name) in ends {
            let chosen = ui.selectable_label(probe.from == from, &name);
            crate::widgets::field::name(&chosen, &format!("From {name}"));
            if chosen.on_hover_text("The sum begins at this end").clicked() {
                commands.push(Command::View(ViewCommand::SetTensionMarker(Some(TensionMarker { from, ..probe }))));
            }
        }
    });
}

/// Displacement, velocity and acceleration of the marked point, live.
fn motion(ui: &mut Ui, answer: &Solution, marker: TensionMarker) {
    let Some(cable) = answer.cables.get(marker.cable) else { return };
    let next = cable.nodes.partition_point(|n| n.arc_length_m < marker.arc_length_m);
    let (Some(a), Some(b)) = (cable.nodes.get(next.saturating_sub(1)), cable.nodes.get(next).or(cable.nodes.last()))
    else {
        return;
    };
    let length_m = b.arc_length_m - a.arc_length_m;
    let share = if length_m > 0.0 { ((marker.arc_length_m - a.arc_length_m) / length_m).clamp(0.0, 1.0) } else { 0.0 };
    let between = |of: &dyn Fn(&Node) -> [f64; 2]| {
        let (a, b) = (of(a), of(b));
        [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
    };
    let rows: [(&str, Unit, [f64; 2], &str); 3] = [
        ("Displacement", Unit::M, between(&|n| n.displacement_m), "From where it was when the run began"),
        ("Velocity", Unit::M_PER_S, between(&|n| [n.vx_m_per_s, n.vy_m_per_s]), "Of the material of the cable"),
        (
            "Acceleration",
            Unit::M_PER_S2,
            between(&|n| n.acceleration_m_per_s2),
            "Mean over the last step; 0 at rest and without inertia",
        ),
    ];
    for (name, unit, [x, y], help) in rows {
        let help = format!("{help}. {} to the right, {} upwards", unit.text(x), unit.text(y));
        readout::row(ui, name, &unit.text(x.hypot(y)), &help, |_| {});
    }
}

/// The terms worth a line.
fn listed(found: &TensionBudget) -> Vec<Contribution> {
    let greatest = found.contributions.iter().map(|t| t.tension_n.abs()).fold(0.0, f64::max);
    found.contributions.iter().filter(|t| t.tension_n.abs() > NEGLIGIBLE_FRACTION * greatest).copied().collect()
}

/// The name of a contribution.
fn title(scene: &Scene, answer: &Solution, cable: usize, term: &Contribution) -> String {
    let support = |k: usize| {
        let s = scene.cables.get(cable).and_then(|c| c.supports.get(k));
        s.map_or_else(|| "a support".to_owned(), |s| s.name.clone())
    };
    match term.cause {
        Cause::End => "Pull at the end".to_owned(),
        Cause::Weight => "Weight".to_owned(),
        Cause::Wind => "Wind".to_owned(),
        Cause::Contact(k) => {
            let contact = answer.cables.get(cable).and_then(|c| c.contacts.get(k));
            format!("Friction on {}", contact.map_or("an obstacle", |c| c.obstacle.as_str()))
        }
        Cause::Support(k) => format!("At {}", support(k)),
        Cause::Load(k) => format!("Load {}", k + 1),
        Cause::Rest if scene.view == View::Plan => "Floor and motion".to_owned(),
        Cause::Rest => "Motion, bending, mesh".to_owned(),
    }
}

/// By what factor, and over what turn.
fn how(answer: &Solution, cable: usize, term: &Contribution) -> String {
    let factor = term.factor.map_or_else(String::new, |f| format!("× {}", significant(f, 3)));
    let Cause::Contact(k) = term.cause else { return factor };
    let turn = answer.cables.get(cable).and_then(|c| c.contacts.get(k)).map_or(0.0, |c| c.turn_deg.abs());
    if turn >= 0.5 { format!("{factor} over {turn:.0}°") } else { factor }
}

/// The colour of a contribution.
fn colour(term: &Contribution) -> Color32 {
    match term.cause {
        Cause::End => END_COLOUR,
        Cause::Weight => WEIGHT,
        Cause::Wind => WIND,
        Cause::Contact(k) => CONTACTS[k % CONTACTS.len()],
        Cause::Support(_) => SUPPORT,
        Cause::Load(_) => LOAD,
        Cause::Rest => REST,
    }
}

/// Returns what adds, from left to right; below it what takes away, from there back to the tension.
fn bar(ui: &mut Ui, found: &TensionBudget, listed: &[Contribution], title: &dyn Fn(&Contribution) -> String) {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), 2.0 * BAR_ROW_HEIGHT + 2.0), Sense::hover());
    let words: Vec<String> = listed.iter().map(|t| format!("{} {}", title(t), format::force(t.tension_n))).collect();
    let spoken = format!("{} = {}", format::force(found.tension_n), words.join(" + "));
    response.widget_info(|| WidgetInfo::labeled(Role::Figure, true, "Where the tension comes from"));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(spoken.as_str()));
    let added: f64 = listed.iter().map(|t| t.tension_n.max(0.0)).sum();
    if !(added > 0.0) {
        return;
    }
    let x = |n: f64| rect.left() + (n / added) as f32 * rect.width();
    let painter = ui.painter();
    painter.rect_filled(rect, 2.0, ui.visuals().faint_bg_color);
    // Pale pieces stand off the panel by their outline.
    let gap = Stroke::new(1.0, ui.visuals().weak_text_color());
    let piece = |from: f64, to: f64, row: f32, term: &Contribution| {
        let top = rect.top() + row * (BAR_ROW_HEIGHT + 2.0);
        let piece = Rect::from_x_y_ranges(x(from.min(to))..=x(from.max(to)), top..=top + BAR_ROW_HEIGHT);
        painter.rect(piece, 0.0, colour(term), gap, egui::StrokeKind::Inside);
    };
    let mut sum = 0.0;
    for t in listed.iter().filter(|t| t.tension_n > 0.0) {
        piece(sum, sum + t.tension_n, 0.0, t);
        sum += t.tension_n;
    }
    for t in listed.iter().filter(|t| t.tension_n < 0.0) {
        piece(sum + t.tension_n, sum, 1.0, t);
        sum += t.tension_n;
    }
    let end = x(sum);
    painter
        .line_segment([pos2(end, rect.top()), pos2(end, rect.bottom())], Stroke::new(2.0, ui.visuals().text_color()));
    response.on_hover_text("Above: what adds. Below: what takes away, from the right. The line: the tension");
}

/// The listed contributions with their colours and figures.
fn figures(
    ui: &mut Ui,
    listed: &[Contribution],
    title: &dyn Fn(&Contribution) -> String,
    how: &dyn Fn(&Contribution) -> String,
) {
    for t in listed {
        let sign = if t.tension_n < 0.0 { "" } else { "+" };
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
            let line = Stroke::new(1.0, ui.visuals().weak_text_color());
            ui.painter().rect(rect, 1.0, colour(t), line, egui::StrokeKind::Inside);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(format!("{sign}{}", format::force(t.tension_n)));
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.add(Label::new(title(t)).truncate()));
            });
        });
        let how = how(t);
        if !how.is_empty() {
            ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
                ui.weak(how).on_hover_text("Tension beyond it over tension before it, on the way from the end");
            });
        }
    }
}
