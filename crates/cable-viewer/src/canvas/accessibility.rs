//! A screen reader, and the tests, find on the canvas a name for each thing where it is painted,
//! and the scene in words.

use cable_core::analysis::safe_reach::line::Trip;
use cable_core::math::Point;
use cable_core::solution::ContactState;
use egui::{Rect, Role, Sense, Ui, WidgetInfo, vec2};

use crate::canvas::layers::contact;
use crate::geometry::arrows::load_at;
use crate::geometry::handles;
use crate::geometry::robot::path_flags;
use crate::geometry::supports::support_position;
use crate::state::{AppState, Freshness, Item};
use crate::units::sentence::sentence;
use crate::units::{format, unit};
use crate::widgets::highlight;

/// Most contacts of a cable that are named: what lies on rubble has one a stone.
const MAX_CONTACTS: usize = 40;

/// Names everything that can be picked, and where the cable lies on something.
pub fn ui(ui: &Ui, canvas: Rect, state: &AppState) {
    let name = |at: Point, id: (&str, usize, usize), text: String| {
        let spot = Rect::from_center_size(state.view.camera.to_screen(canvas, at), vec2(20.0, 20.0));
        if !canvas.intersects(spot) {
            return;
        }
        let response = ui.interact(spot.intersect(canvas), ui.scope_id().with(id), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::GraphicsSymbol, true, &text));
        highlight::register(&response, &text);
    };
    let scene = &state.document.scene;
    for (cable, c) in scene.cables.iter().enumerate() {
        for (support, s) in c.supports.iter().enumerate() {
            if let Some(at) = support_position(state, cable, support) {
                name(at, ("support", cable, support), format!("Support {} of {}", s.name, c.name));
            }
        }
    }
    for (k, c) in state.live.snapshot.solution.iter().flat_map(|s| s.cables.iter().enumerate()) {
        if let Some(n) = c.nodes.get(c.nodes.len() / 2) {
            name([n.x_m, n.y_m], ("middle", k, 0), format!("Middle of {}", c.name));
        }
    }
    for (k, o) in scene.obstacles.iter().enumerate() {
        if let Some(at) = handles::of(state, Item::Obstacle(k)) {
            name(at, ("obstacle", k, 0), format!("Obstacle {}", o.name));
        }
    }
    contacts(state, &name);
    for k in 0..scene.loads.len() {
        if let Some((at, _)) = load_at(state, k) {
            name(at, ("load", k, 0), format!("Load {}", k + 1));
        }
        if let Some(at) = handles::of(state, Item::LoadHead(k)) {
            name(at, ("head", k, 0), format!("Force of load {}", k + 1));
        }
    }
    for (k, at, _) in path_flags(state) {
        name(at, ("leg", k, 0), format!("Leg {} of the robot's path", k + 1));
    }
    if let Some(at) = handles::of(state, Item::Robot) {
        name(at, ("robot", 0, 0), "Robot on the canvas".to_owned());
    }
}

/// Stretches of contact, what each does, and slip fronts.
fn contacts(state: &AppState, name: &impl Fn(Point, (&str, usize, usize), String)) {
    let Some(solution) = state.live.snapshot.solution.as_ref().filter(|_| state.view.layers.contacts) else { return };
    for answer in &solution.cables {
        for (k, c) in answer.contacts.iter().enumerate().take(MAX_CONTACTS) {
            for (j, part) in contact::parts(c).into_iter().enumerate().filter(|(_, p)| p.ends_m > p.begins_m) {
                let does = if part.state == ContactState::Stick { "holds" } else { "slides" };
                let [from, to] = [part.begins_m, part.ends_m].map(|s| unit::Unit::COORDINATE.text(s));
                if let Some(n) = contact::at(answer, 0.5 * (part.begins_m + part.ends_m)) {
                    let text = format!("Contact of {} with {}: {does} from {from} to {to}", answer.name, c.obstacle);
                    name([n.x_m, n.y_m], ("contact", k, j), text);
                }
            }
            for (j, s) in contact::fronts(c).enumerate() {
                if let Some(n) = contact::at(answer, s) {
                    let text = format!("Slip front of {} at {}", answer.name, unit::Unit::COORDINATE.text(s));
                    name([n.x_m, n.y_m], ("front", k, j), text);
                }
            }
        }
    }
}

/// The picture in words.
#[must_use]
pub fn summary(state: &AppState) -> String {
    let scene = &state.document.scene;
    let count = |n: usize, one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
    let mut out = vec![format!(
        "{}: {}, {}, {}{}",
        if scene.name.is_empty() { "Untitled scene" } else { &scene.name },
        count(scene.cables.len(), "cable"),
        count(scene.obstacles.len(), "obstacle"),
        count(scene.loads.len(), "load"),
        if scene.robot.is_some() { ", a robot" } else { "" }
    )];
    for (cable, c) in scene.cables.iter().enumerate() {
        let supports = c.supports.iter().enumerate().filter_map(|(k, s)| {
            support_position(state, cable, k).map(|at| format!("{} at {}", s.name, format::position(at)))
        });
        out.push(format!("{}: {}", c.name, supports.collect::<Vec<_>>().join(", ")));
    }
    if matches!(state.freshness(), Freshness::Solving | Freshness::Draft) {
        out.push("solving".to_owned());
    }
    if let Some(answer) = state.live.snapshot.solution.as_ref().filter(|_| state.is_current()) {
        let most = answer.max_tension();
        let on = answer.cables.get(most.cable).map_or("", |c| &c.name);
        out.push(format!(
            "time {}: greatest tension {} at {} along {on}",
            format::duration(answer.time_s),
            format::force(most.tension_n),
            format::length(most.arc_length_m)
        ));
        let contacts: usize = answer.cables.iter().map(|c| c.contacts.len()).sum();
        out.push(format!("{}, {}", count(contacts, "contact"), count(answer.warnings.len(), "warning")));
        if let Some(robot) = &answer.robot {
            out.push(format!("robot at {}, {}", format::position([robot.x_m, robot.y_m]), robot.going.name()));
        }
    }
    if let Some((maps, _)) = state.analysis.safe_reach.found() {
        let trip = state.analysis.safe_reach.choice.trip;
        let shown = match trip {
            Trip::There => "there",
            Trip::ThereAndBack => "there and back",
        };
        out.push(format!(
            "safe reach, {shown}: {}",
            crate::panels::analysis::safe_reach::describe(maps, trip).join(", ")
        ));
    }
    if let Some(error) = &state.live.snapshot.error {
        out.push(format!("no answer: {}", sentence(error)));
    }
    if let Some(item) = state.selection.selected {
        out.push(format!("selected: {}", state.describe(item)));
    }
    out.join(". ")
}
