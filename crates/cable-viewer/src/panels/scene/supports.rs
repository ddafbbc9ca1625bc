//! The list of supports shows the kind of each support; a form shows all properties of one support.

use cable_core::math::Point;
use cable_core::scene::{Motion, PulleySide, SupportKind};
use cable_core::{Cable, Support};
use egui::{ComboBox, Response, Ui};

use crate::command::support_kind::{KINDS, SupportPlace, of_kind, refusal};
use crate::command::{Command, SceneCommand, waypoint};
use crate::geometry::supports::{COINCIDENCE_M, is_broken, support_position};
use crate::panels::scene::loads::FIRST_SPAN_S;
use crate::panels::scene::rows::{self, NUMBER_WIDTH, cell, components, coordinates, optional, show_faults};
use crate::panels::scene_errors;
use crate::state::{AppState, Item};
use crate::units::format;
use crate::units::unit::Unit;
use crate::widgets::field;
use crate::widgets::property::labelled;
use crate::widgets::time_table::{self, Knots, Table};

/// One support with where it stands.
struct Row<'a> {
    cable: usize,
    support: usize,
    value: &'a Support,
    place: SupportPlace,
    /// Its present place, m, and that on the cable, m.
    now: (Point, f64),
}

impl Row<'_> {
    fn item(&self) -> Item {
        Item::Support { cable: self.cable, support: self.support }
    }

    fn set(&self, value: Support, commands: &mut Vec<Command>) {
        let command = SceneCommand::SetSupport { cable: self.cable, support: self.support, value: Box::new(value) };
        commands.push(Command::Scene(command));
        commands.push(Command::Scene(SceneCommand::EditDone));
    }

    fn changed(&self, commands: &mut Vec<Command>, change: impl FnOnce(&mut Support)) {
        let mut value = self.value.clone();
        change(&mut value);
        self.set(value, commands);
    }
}

/// Lists them.
pub fn ui(ui: &mut Ui, state: &AppState, index: usize, commands: &mut Vec<Command>) {
    let Some(cable) = state.document.scene.cables.get(index) else { return };
    for (support, value) in cable.supports.iter().enumerate() {
        let item = Item::Support { cable: index, support };
        ui.push_id(support, |ui| rows::row(ui, state, item, &value.name, kind_name(value), commands));
    }
    let help = "A frictionless point the cable slides through, in the middle of the cable; drag it, or change its kind";
    if ui.button("Add waypoint").on_hover_text(help).clicked() {
        commands.extend(new_waypoint(state, index).map(Command::Scene));
    }
}

/// A waypoint in the middle of a cable.
#[must_use]
pub fn new_waypoint(state: &AppState, cable: usize) -> Option<SceneCommand> {
    let arc_length_m = state.document.scene.cables.get(cable)?.length_m / 2.0;
    let at_m = waypoint::position_at(state, cable, arc_length_m).unwrap_or([0.0; 2]);
    Some(SceneCommand::AddWaypoint { cable, arc_length_m, at_m })
}

/// The word for the kind of a support: one that the scene moves is not fixed.
fn kind_name(support: &Support) -> &'static str {
    if support.kind == SupportKind::Fixed && support.motion.is_some() {
        return "Scheduled";
    }
    KINDS.iter().find(|(k, ..)| *k == support.kind).map_or("", |(_, text, _)| text)
}

/// Returns where a support is in the present answer, else where the scene says.
fn place_now(state: &AppState, cable: usize, support: usize, of: &Cable) -> (Point, f64) {
    // An answer with other supports is of an earlier scene: its places are those of the neighbours.
    let solved = state.live.snapshot.solution.as_ref().and_then(|s| s.cables.get(cable));
    let solved = solved.filter(|c| c.supports.len() == of.supports.len()).and_then(|c| c.supports.get(support));
    solved.map_or_else(
        || {
            let value = of.supports.get(support);
            let share = support as f64 / of.supports.len().saturating_sub(1).max(1) as f64;
            (value.and_then(|s| s.at_m).unwrap_or([0.0; 2]), share * of.length_m)
        },
        |r| ([r.x_m, r.y_m], r.arc_length_m),
    )
}

/// Kind and place, and the button that takes it out.
fn head(ui: &mut Ui, state: &AppState, row: &Row<'_>, commands: &mut Vec<Command>, faults: &mut Vec<String>) {
    labelled(ui, "Kind", &format!("Kind of {}", row.value.name), |ui| kind(ui, state, row, commands));
    rows::place(ui, |ui| match row.value.at_m {
        Some(at_m) => {
            if let Some(to_m) = coordinates(ui, &row.value.name, at_m, faults) {
                commands.push(Command::Scene(SceneCommand::Move { item: row.item(), to_m }));
                commands.push(Command::Scene(SceneCommand::EditDone));
            }
        }
        None => {
            let (at_m, _) = row.now;
            for v in at_m {
                cell(ui, NUMBER_WIDTH, |ui| {
                    ui.weak(Unit::COORDINATE.bare().text(v)).on_hover_text("Where it is now; not held there");
                });
            }
        }
    });
}

/// Shows the present place of a support whose cable is torn, or that the scene moves away from
/// where it begins.
fn place_apart(ui: &mut Ui, state: &AppState, row: &Row<'_>) {
    let Some(begins) = row.value.at_m else { return };
    if !is_broken(state, row.cable) && row.value.motion.is_none() {
        return;
    }
    let Some(at) = support_position(state, row.cable, row.support) else { return };
    if (at[0] - begins[0]).hypot(at[1] - begins[1]) <= COINCIDENCE_M {
        return;
    }
    labelled(ui, "Current position", &format!("Position now of {}", row.value.name), |ui| {
        let help = "Where it is at the time shown; above stands where the scene puts it at the start";
        ui.weak(format::position(at)).on_hover_text(help)
    });
}

/// The choice of the kind of a support.
fn kind(ui: &mut Ui, state: &AppState, row: &Row<'_>, commands: &mut Vec<Command>) -> Response {
    let combo = ComboBox::from_id_salt("kind").selected_text(kind_name(row.value));
    let shown = combo.width(ui.available_width() - 14.0).truncate().show_ui(ui, |ui| {
        for (kind, text, help) in KINDS {
            let refused = refusal(kind, row.place, &state.document.scene);
            let entry = ui.add_enabled(refused.is_none(), egui::Button::selectable(kind == row.value.kind, text));
            let entry = entry.on_hover_text(help).on_disabled_hover_text(refused.unwrap_or_default());
            if entry.clicked() && kind != row.value.kind {
                let (at_m, arc_length_m) = row.now;
                row.set(of_kind(row.value, kind, at_m, arc_length_m, row.place), commands);
            }
        }
    });
    shown.response.on_hover_text("What it does to the cable")
}

/// Everything about a support.
pub fn form(ui: &mut Ui, state: &AppState, cable: usize, support: usize, commands: &mut Vec<Command>) {
    let Some(of) = state.document.scene.cables.get(cable) else { return };
    let Some(value) = of.supports.get(support) else { return };
    let is_end = support == 0 || support + 1 == of.supports.len();
    let place = if is_end { SupportPlace::CableEnd } else { SupportPlace::Between };
    let row = &Row { cable, support, value, place, now: place_now(state, cable, support, of) };
    let s = row.value;
    let mut faults = Vec::new();
    labelled(ui, "Name", "Support name", |ui| {
        let entry = field::text(ui, "Support name", &s.name, ui.available_width() - 8.0);
        if let Some(name) = entry.value {
            row.changed(commands, |s| s.name = name);
        }
        faults.extend(entry.fault);
        entry.response.on_hover_text("What it is called here, in tables and in warnings")
    });
    head(ui, state, row, commands, &mut faults);
    place_apart(ui, state, row);
    if s.arc_length_m.is_some() || (row.place == SupportPlace::Between && s.kind != SupportKind::Pulley) {
        let text = ["Arc length", "Where it grips the cable: unstretched length from the start of the cable"];
        if let Some(v) = optional(ui, text, Unit::COORDINATE, s.arc_length_m, &mut faults) {
            row.changed(commands, |s| s.arc_length_m = Some(v));
        }
    } else {
        labelled(ui, "Arc length", "Place on the cable", |ui| {
            let help = "Unstretched length from the start of the cable, as it is now";
            ui.label(Unit::COORDINATE.text(row.now.1)).on_hover_text(help)
        });
    }
    match s.kind {
        SupportKind::Clamped => {
            let text = [
                "Direction",
                "Direction of the cable at this point, going from its start to its end; anticlockwise from the right",
            ];
            if let Some(v) = optional(ui, text, Unit::DEGREE, s.angle_deg, &mut faults) {
                row.changed(commands, |s| s.angle_deg = Some(v));
            }
        }
        SupportKind::Pulley => pulley(ui, row, commands, &mut faults),
        SupportKind::Load => load(ui, row, commands, &mut faults),
        // Fixed ones, the robot, free ends, and kinds to come.
        _ => {}
    }
    if matches!(s.kind, SupportKind::Load | SupportKind::Free) {
        let text = ["Mass", "Lumped mass on the point; its weight counts too"];
        if let Some(v) = optional(ui, text, Unit::KG, s.mass_kg, &mut faults) {
            row.changed(commands, |s| s.mass_kg = (v != 0.0).then_some(v));
        }
    }
    release(ui, row, commands, &mut faults);
    motion(ui, row, commands, &mut faults);
    show_faults(ui, &faults);
    scene_errors::inline(ui, state, &format!("cables[{cable}].supports[{support}]"), commands);
}

/// A support that holds may let go.
fn release(ui: &mut Ui, row: &Row<'_>, commands: &mut Vec<Command>, faults: &mut Vec<String>) {
    let s = row.value;
    if matches!(s.kind, SupportKind::Load | SupportKind::Free) {
        return;
    }
    let help = "From this time on the support no longer holds the cable";
    if let Some(on) = time_table::toggle(ui, "Releases the cable at a set time", s.release_s.is_some(), help) {
        row.changed(commands, |s| s.release_s = on.then_some(1.0));
    }
    if s.release_s.is_some() {
        let text = ["Release time", "Time at which it releases the cable"];
        if let Some(v) = optional(ui, text, Unit::S, s.release_s, faults) {
            row.changed(commands, |s| s.release_s = Some(v));
        }
    }
}

/// A support that is held somewhere may move.
fn motion(ui: &mut Ui, row: &Row<'_>, commands: &mut Vec<Command>, faults: &mut Vec<String>) {
    let s = row.value;
    let Some(at_m) = s.at_m else { return };
    let help =
        "Passes smoothly through points at given times and stays at the last; moving the support moves all of them";
    if let Some(on) = time_table::toggle(ui, "Follows a schedule", s.motion.is_some(), help) {
        let Knots { times_s, values } = Knots::steady(at_m, FIRST_SPAN_S);
        row.changed(commands, |s| s.motion = on.then_some(Motion { times_s, points_m: values }));
        return;
    }
    let Some(motion) = &s.motion else { return };
    let table = Table { of: &s.name, columns: ["x", "y"], unit: Unit::COORDINATE, least: 1 };
    let knots = Knots::of(&motion.times_s, &motion.points_m);
    if let Some(Knots { times_s, values }) = time_table::ui(ui, &table, &knots, faults) {
        row.changed(commands, |s| {
            let motion = Motion { times_s, points_m: values };
            // It stands where its motion has it at the start.
            let start = motion.at(0.0).0;
            (s.at_m, s.motion) = (Some([start.x, start.y]), Some(motion));
        });
    }
}

/// The fields of a pulley.
fn pulley(ui: &mut Ui, row: &Row<'_>, commands: &mut Vec<Command>, faults: &mut Vec<String>) {
    let s = row.value;
    let text = ["Wheel radius", "Radius of the wheel the cable runs on; 0 = a point"];
    if let Some(v) = optional(ui, text, Unit::MM, s.radius_m, faults) {
        row.changed(commands, |s| s.radius_m = Some(v));
    }
    if s.radius_m.is_some_and(|r| r > 0.0) {
        labelled(ui, "Side", "Over", |ui| {
            let mut side = s.side.unwrap_or_default();
            let over = ui.selectable_value(&mut side, PulleySide::Over, "Over");
            ui.selectable_value(&mut side, PulleySide::Under, "Under").on_hover_text("Under the bottom of the wheel");
            if side != s.side.unwrap_or_default() {
                row.changed(commands, |s| s.side = Some(side));
            }
            over.on_hover_text("Over the top of the wheel")
        });
    }
    let text = ["Pulley friction", "Coulomb coefficient; 0 = turns freely"];
    if let Some(v) = optional(ui, text, Unit::PLAIN_NUMBER, s.friction, faults) {
        row.changed(commands, |s| s.friction = Some(v));
    }
}

/// The fields of a dead load, steady or with a time table.
fn load(ui: &mut Ui, row: &Row<'_>, commands: &mut Vec<Command>, faults: &mut Vec<String>) {
    let s = row.value;
    let knots = Knots::of(&s.times_s, &s.forces_n);
    let help = "A force at each of several times, linear in between";
    if let Some(on) = time_table::toggle(ui, "Force changes with time", s.force_n.is_none(), help) {
        let force_n = s.force_n.or(knots.values.first().copied()).unwrap_or_default();
        let knots = if on { Knots::steady(force_n, FIRST_SPAN_S) } else { Knots::default() };
        row.changed(commands, |s| {
            s.force_n = (!on).then_some(force_n);
            (s.times_s, s.forces_n) = (knots.times_s, knots.values);
        });
        return;
    }
    let Some(force_n) = s.force_n else {
        let table = Table { of: &s.name, columns: ["Right", "Up"], unit: Unit::N, least: 1 };
        if let Some(Knots { times_s, values }) = time_table::ui(ui, &table, &knots, faults) {
            row.changed(commands, |s| (s.times_s, s.forces_n) = (times_s, values));
        }
        return;
    };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.label(Unit::N.display().symbol).on_hover_text("Force to the right and upwards");
        let labels = ["Force to the right", "Force upwards"].map(str::to_owned);
        if let Some(force_n) = components(ui, labels, Unit::N, force_n, faults) {
            row.changed(commands, |s| s.force_n = Some(force_n));
        }
    });
}
