//! The list of obstacles shows the kind of each obstacle; a form shows all properties of one
//! obstacle.

use cable_core::Obstacle;
use cable_core::math::Point;
use cable_core::scene::Shape;
use egui::{Button, ScrollArea, Ui};

use crate::command::{Command, SceneCommand};
use crate::panels::scene::rows::{self, GAP, coordinates, optional, show_faults};
use crate::panels::scene_errors;
use crate::state::{AppState, Item};
use crate::units::unit::Unit;
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::field;
use crate::widgets::icon::{self, Icon};
use crate::widgets::property::labelled;

/// Height of the list of corners, points: about ten.
const CORNERS_HEIGHT: f32 = 240.0;

/// Lists them.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    for (k, obstacle) in state.document.scene.obstacles.iter().enumerate() {
        let (form, _) = shape_name(&obstacle.shape);
        ui.push_id(k, |ui| rows::row(ui, state, Item::Obstacle(k), &obstacle.name, form, commands));
    }
    let menu = ui.menu_button("Add obstacle", |ui| add(ui, state, commands));
    menu.response.on_hover_text("Ground, a beam, a post or a sheet, in the middle of the view");
}

/// The buttons that add obstacles.
fn add(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    for (name, help, command) in new_obstacles(state) {
        if ui.button(name).on_hover_text(help).clicked() {
            commands.push(Command::Scene(command));
            ui.close();
        }
    }
}

/// The obstacles that can be added, each with its name and what it is. They stand in the middle of
/// the picture, where the user looks.
#[must_use]
pub fn new_obstacles(state: &AppState) -> [(&'static str, &'static str, SceneCommand); 4] {
    let [x, y] = state.view.camera.centre_m.map(|v| (v * 10.0).round() / 10.0);
    let forms = [
        ("Ground", "From left to right, solid below", Shape::Terrain { points_m: vec![[x - 10.0, y], [x + 10.0, y]] }),
        (
            "Beam",
            "A square beam of 0.3 m",
            Shape::Polygon {
                points_m: vec![[x - 0.15, y - 0.15], [x + 0.15, y - 0.15], [x + 0.15, y + 0.15], [x - 0.15, y + 0.15]],
            },
        ),
        ("Post", "A round post or pipe of 0.2 m radius", Shape::Circle { center_m: [x, y], radius_m: 0.2 }),
        (
            "Sheet",
            "A thin line, two-sided",
            Shape::Polyline { points_m: vec![[x - 1.0, y], [x + 1.0, y]], thickness_m: 0.02 },
        ),
    ];
    forms.map(|(name, help, shape)| {
        let obstacle = Obstacle { name: name.to_lowercase(), shape, friction: None };
        (name, help, SceneCommand::AddObstacle(obstacle))
    })
}

/// The name of a shape and its description.
fn shape_name(shape: &Shape) -> (&'static str, &'static str) {
    match shape {
        Shape::Terrain { .. } => ("Ground", "From left to right, solid below"),
        Shape::Polygon { .. } => ("Polygon", "Closed, solid inside"),
        Shape::Circle { .. } => ("Circle", "A round post or pipe"),
        Shape::Polyline { .. } => ("Line", "Thin, two-sided"),
    }
}

/// Its centre or first corner.
fn anchor(shape: &Shape) -> Option<Point> {
    match shape {
        Shape::Circle { center_m, .. } => Some(*center_m),
        Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
            points_m.first().copied()
        }
    }
}

/// Form and place.
fn head(ui: &mut Ui, k: usize, obstacle: &Obstacle, commands: &mut Vec<Command>, faults: &mut Vec<String>) {
    let (text, help) = shape_name(&obstacle.shape);
    labelled(ui, "Form", &format!("Form of {}", obstacle.name), |ui| ui.label(text).on_hover_text(help));
    let Some(at_m) = anchor(&obstacle.shape) else { return };
    rows::place(ui, |ui| {
        if let Some(to_m) = coordinates(ui, &obstacle.name, at_m, faults) {
            commands.push(Command::Scene(SceneCommand::Move { item: Item::Obstacle(k), to_m }));
            commands.push(Command::Scene(SceneCommand::EditDone));
        }
    });
}

/// Everything about an obstacle.
pub fn form(ui: &mut Ui, state: &AppState, k: usize, commands: &mut Vec<Command>) {
    let Some(obstacle) = state.document.scene.obstacles.get(k) else { return };
    let mut faults = Vec::new();
    let mut value = obstacle.clone();
    labelled(ui, "Name", "Obstacle name", |ui| {
        let entry = field::text(ui, "Obstacle name", &obstacle.name, ui.available_width() - 8.0);
        if let Some(name) = entry.value {
            value.name = name;
        }
        faults.extend(entry.fault);
        entry.response.on_hover_text("What it is called here, in contacts and in warnings")
    });
    head(ui, k, obstacle, commands, &mut faults);
    let mut own = obstacle.friction.is_some();
    let help = "Off: the cable's own coefficient";
    if checkbox(ui, &mut own, "Custom friction").on_hover_text(help).changed() {
        value.friction = own.then_some(0.5);
    }
    if let Some(mu) = obstacle.friction {
        let text = ["Obstacle friction", "Coulomb coefficient with every cable"];
        if let Some(mu) = optional(ui, text, Unit::PLAIN_NUMBER, Some(mu), &mut faults) {
            value.friction = Some(mu);
        }
    }
    match &mut value.shape {
        Shape::Circle { radius_m, .. } => {
            if let Some(v) = optional(ui, ["Radius", "Radius of the post"], Unit::M, Some(*radius_m), &mut faults) {
                *radius_m = v;
            }
        }
        Shape::Polyline { points_m, thickness_m } => {
            let text = ["Thickness", "Full thickness of the line"];
            if let Some(v) = optional(ui, text, Unit::MM, Some(*thickness_m), &mut faults) {
                *thickness_m = v;
            }
            corners(ui, k, points_m, &mut faults);
        }
        Shape::Terrain { points_m } | Shape::Polygon { points_m } => corners(ui, k, points_m, &mut faults),
    }
    show_faults(ui, &faults);
    scene_errors::inline(ui, state, &format!("obstacles[{k}]"), commands);
    if value != *obstacle {
        commands.push(Command::Scene(SceneCommand::SetObstacle { obstacle: k, value }));
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
}

/// The corners with exact coordinates; only those in view are drawn, terrain can have thousands.
fn corners(ui: &mut Ui, k: usize, points_m: &mut Vec<Point>, faults: &mut Vec<String>) {
    ui.weak(format!("{} corners, x and y in {}", points_m.len(), Unit::M.display().symbol));
    let mut gone = None;
    let mut doubled = None;
    let height = ui.spacing().interact_size.y;
    let area = ScrollArea::vertical().id_salt(("corners", k)).max_height(CORNERS_HEIGHT).auto_shrink([false, true]);
    area.show_rows(ui, height, points_m.len(), |ui, rows| {
        for i in rows {
            let Some(&at_m) = points_m.get(i) else { continue };
            ui.push_id(i, |ui| {
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing.x = GAP;
                    ui.add_sized([28.0, height], egui::Label::new(format!("{}", i + 1)).selectable(false));
                    let name = format!("corner {}", i + 1);
                    if let (Some(to_m), Some(slot)) = (coordinates(ui, &name, at_m, faults), points_m.get_mut(i)) {
                        *slot = to_m;
                    }
                    let add = ui.add(Button::new("+").frame(false));
                    field::name(&add, &format!("Add a corner after {name}"));
                    if add.on_hover_text("Adds a corner halfway to the next").clicked() {
                        doubled = Some(i);
                    }
                    let remove = icon::plain_button(ui, Icon::Remove);
                    field::name(&remove, &format!("Remove {name}"));
                    if remove.on_hover_text("Removes this corner").clicked() {
                        gone = Some(i);
                    }
                });
            });
        }
    });
    if let Some(i) = gone
        && points_m.len() > 2
    {
        points_m.remove(i);
    }
    if let Some(i) = doubled {
        insert_halfway(points_m, i);
    }
}

/// A corner halfway from one to the next; after the last, one as far again.
fn insert_halfway(points_m: &mut Vec<Point>, i: usize) {
    let Some(&a) = points_m.get(i) else { return };
    let new = match (points_m.get(i + 1), i.checked_sub(1).and_then(|h| points_m.get(h))) {
        (Some(b), _) => [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0],
        (None, Some(before)) => [2.0 * a[0] - before[0], 2.0 * a[1] - before[1]],
        (None, None) => [a[0] + 1.0, a[1]],
    };
    points_m.insert(i + 1, new);
}
