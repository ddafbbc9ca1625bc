//! Every button of the window by the words on it, for the palette: what it does, or for what
//! belongs to one thing the form that it stands in.

use cable_core::analysis::safe_reach::line::Trip;
use cable_core::scene::preset::{map_presets, robot_presets};
use cable_core::scene::{Heading, RobotTask, SupportKind, View};
use cable_core::summary::summary;

use crate::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use crate::geometry::handles;
use crate::geometry::supports::support_position;
use crate::panels::analysis::tension_budget;
use crate::panels::cable::property::PROPERTIES;
use crate::panels::pin_names::pin_names;
use crate::panels::readouts::{extremes, take_likely_bending};
use crate::panels::scene::{map, robot as robot_form};
use crate::panels::{robot, warnings};
use crate::record::plotted_quantity::Measure;
use crate::render::colour::{ColourMap, ColourScale};
use crate::state::{AppState, GraphRequest, Item, Layers};

/// A command and the name that it is shown and found by.
pub type PaletteEntry = (String, Command);

/// All of them that the present scene has.
pub fn entries(state: &AppState) -> Vec<PaletteEntry> {
    let groups: [fn(&AppState) -> Vec<PaletteEntry>; 9] =
        [layers, edits, things, graphs, analyses, robot_entries, forms, places, guides];
    groups.iter().flat_map(|group| group(state)).collect()
}

fn view(name: impl Into<String>, command: ViewCommand) -> PaletteEntry {
    (name.into(), Command::View(command))
}

fn scene(name: impl Into<String>, command: SceneCommand) -> PaletteEntry {
    (name.into(), Command::Scene(command))
}

fn play(name: impl Into<String>, command: PlaybackCommand) -> PaletteEntry {
    (name.into(), Command::Playback(command))
}

fn select(name: impl Into<String>, item: Item) -> PaletteEntry {
    view(name, ViewCommand::Select(Some(item)))
}

/// The layers of the canvas and its colours.
fn layers(state: &AppState) -> Vec<PaletteEntry> {
    let shown = state.view.layers;
    let layers = [
        ("Grid", Layers { grid: !shown.grid, ..shown }),
        ("Labels", Layers { labels: !shown.labels, ..shown }),
        ("Contacts", Layers { contacts: !shown.contacts, ..shown }),
        ("Forces", Layers { forces: !shown.forces, ..shown }),
        ("Force components", Layers { components: !shown.components, ..shown }),
        ("Nodes", Layers { nodes: !shown.nodes, ..shown }),
        ("Shape at the start", Layers { start_shape: !shown.start_shape, ..shown }),
        ("Snap to grid", Layers { snap: !shown.snap, ..shown }),
    ];
    let mut all: Vec<PaletteEntry> =
        layers.map(|(name, layers)| view(format!("{name}: on or off"), ViewCommand::SetLayers(layers))).into();
    let colour = state.view.colour;
    all.extend(
        ColourMap::ALL
            .map(|map| view(format!("Colours: {}", map.name()), ViewCommand::SetColour(ColourScale { map, ..colour }))),
    );
    let range = state.live.snapshot.solution.as_deref().map(|s| colour.range(s));
    let fixed = if colour.fixed.is_some() { None } else { range };
    all.push(view("Lock colour range: on or off", ViewCommand::SetColour(ColourScale { fixed, ..colour })));
    all.push(view("Follow the cable", ViewCommand::Follow));
    all
}

/// Edits of what is selected, and of the scene as a whole.
fn edits(state: &AppState) -> Vec<PaletteEntry> {
    let mut all = vec![
        scene("Copy", SceneCommand::Copy),
        scene("Cut", SceneCommand::Cut),
        scene("Paste", SceneCommand::Paste { at_m: None }),
        scene("Remove selected", SceneCommand::RemoveAll(state.selection.selected_items())),
        scene("Lay again: the cable from its supports", SceneCommand::LayAnew { cable: state.current_cable() }),
        view("Deselect", ViewCommand::Select(None)),
    ];
    let at_m = state.selection.selected.and_then(|item| handles::of(state, item));
    all.extend(at_m.map(|at| view("Zoom on it: what is selected", ViewCommand::ZoomOn(at))));
    for (name, shown) in [("Side view", View::Elevation), ("Plan view", View::Plan)] {
        let changed = cable_core::Scene { view: shown, ..state.document.scene.clone() };
        all.push(scene(name, SceneCommand::SetScene(Box::new(changed))));
    }
    for preset in map_presets() {
        let changed = cable_core::Scene { obstacles: preset.obstacles.clone(), ..state.document.scene.clone() };
        all.push(scene(format!("Map: {}", preset.name), SceneCommand::SetScene(Box::new(changed))));
    }
    all.extend(map::to_opening(state).map(|command| scene("Route the cable through the tank opening", command)));
    all.extend(state.ui.recent.iter().map(|path| {
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        (format!("Open recent: {name}"), Command::File(FileCommand::Open(path.clone())))
    }));
    all
}

/// The rows of the outline, and what takes a thing out.
fn things(state: &AppState) -> Vec<PaletteEntry> {
    let of = &state.document.scene;
    let supports = of.cables.iter().enumerate().flat_map(|(cable, c)| {
        let items = (0..c.supports.len()).map(move |support| Item::Support { cable, support });
        std::iter::once(Item::Cable(cable)).chain(items)
    });
    let obstacles = (0..of.obstacles.len()).map(Item::Obstacle);
    let loads = (0..of.loads.len()).map(Item::Load);
    let mut all = Vec::new();
    for item in supports.chain(obstacles).chain(loads) {
        let name = state.describe(item);
        all.push(select(format!("Select {name}"), item));
        all.push(scene(format!("Remove {name}"), SceneCommand::Remove(item)));
    }
    for item in [Item::Scene, Item::Environment, Item::Solver] {
        all.push(select(format!("Select {}", state.describe(item)), item));
    }
    all
}

/// The graphs and the timeline.
fn graphs(state: &AppState) -> Vec<PaletteEntry> {
    let shown = |name: String, request| view(name, ViewCommand::AskGraph(request));
    let mut all: Vec<PaletteEntry> =
        Measure::ALL.map(|m| shown(format!("Graph of {}", m.name().to_lowercase()), GraphRequest::Measure(m))).into();
    all.push(shown("Follow: graphs keep up with the data".to_owned(), GraphRequest::Follow));
    all.push(play("Loop: on or off", PlaybackCommand::SetLoop(!state.live.recording.looped)));
    all
}

/// Questions that are asked beside the answer.
fn analyses(state: &AppState) -> Vec<PaletteEntry> {
    let reach = state.analysis.safe_reach.choice;
    let friction = &state.analysis.friction_range;
    let other = match reach.trip {
        Trip::There => Trip::ThereAndBack,
        Trip::ThereAndBack => Trip::There,
    };
    let both_ways = crate::jobs::safe_reach::SafeReachOptions { trip: other, ..reach };
    let mut all = vec![
        view("Cancel comparison", ViewCommand::EndModelComparison),
        view("Cancel chart", ViewCommand::EndWorkPrecision),
        view("Safe reach: there and back, or there only", ViewCommand::SetSafeReachOptions(both_ways)),
        view("Show friction range", ViewCommand::SetFrictionRange { shown: !friction.on, factors: friction.factors }),
        view("Unmark the place on the cable", ViewCommand::SetTensionMarker(None)),
    ];
    all.extend(
        take_likely_bending(state).map(|(name, take)| scene(format!("{name}: the likely bending stiffness"), take)),
    );
    let most = tension_budget::at_the_largest(state);
    all.extend(
        most.map(|marker| view("At the greatest tension: break it down", ViewCommand::SetTensionMarker(Some(marker)))),
    );
    let pins = pin_names(state).into_iter().enumerate();
    all.extend(pins.map(|(k, name)| view(format!("Unpin {}", name.full), ViewCommand::RemoveReferences(Some(k)))));
    all
}

/// Driving the robot, its path, and which it is.
fn robot_entries(state: &AppState) -> Vec<PaletteEntry> {
    let mut all: Vec<PaletteEntry> =
        robot_presets().iter().map(|p| (format!("Robot: {}", p.name), robot_form::chosen(state, p))).collect();
    let Some(present) = &state.document.scene.robot else { return all };
    let speed = robot::hand_speed(state);
    all.push(play("Drive left", PlaybackCommand::DriveRobot(Some(-speed))));
    all.push(play("Drive right", PlaybackCommand::DriveRobot(Some(speed))));
    all.push(select("Select robot", Item::Robot));
    let mut changed = |name: String, change: &dyn Fn(&mut cable_core::Robot)| {
        let mut robot = present.clone();
        change(&mut robot);
        all.push(scene(name, SceneCommand::SetRobot(Some(robot))));
    };
    changed("Add drive: a leg of the path".to_owned(), &|r| r.path.push(robot::first_drive(r)));
    changed("Add wait: a leg of the path".to_owned(), &|r| r.path.push(robot::first_wait()));
    changed("Repeat the path: on or off".to_owned(), &|r| r.repeat = !r.repeat);
    changed("Robot facing left".to_owned(), &|r| r.heading = Heading::Left);
    changed("Robot facing right".to_owned(), &|r| r.heading = Heading::Right);
    for k in 0..present.path.len() {
        changed(format!("Remove leg {}", k + 1), &|r| {
            r.path.remove(k);
        });
    }
    let drives = present.path.iter().enumerate().filter(|(_, task)| matches!(task, RobotTask::Drive { .. }));
    all.extend(drives.map(|(k, _)| select(format!("Select leg {}", k + 1), Item::PathLeg(k))));
    all
}

/// Boxes and small buttons of forms: they are ticked where their figures stand.
fn forms(state: &AppState) -> Vec<PaletteEntry> {
    let of = &state.document.scene;
    let cable = state.current_cable();
    let own = |name: &str, item| select(format!("{name}…"), item);
    let mut all = vec![
        own("Same number of segments for every cable", Item::Solver),
        own("Same drag stiffness for all cables", Item::Solver),
        own("Reset tolerance, drag speed limit, segments", Item::Solver),
        own("Wind changes with time", Item::Environment),
        own("Reset gravity, wind to the right, wind upwards, temperature rise", Item::Environment),
        own("Fixed number of segments", Item::Cable(cable)),
        own("Self-contact", Item::Cable(cable)),
    ];
    all.extend(
        PROPERTIES.iter().map(|p| own(&format!("Reset {}", p.quantity.name.to_lowercase()), Item::Cable(cable))),
    );
    all.extend((0..of.obstacles.len()).map(|k| {
        let item = Item::Obstacle(k);
        own(&format!("Custom friction of {}", state.describe(item)), item)
    }));
    for k in 0..of.loads.len() {
        all.push(own(&format!("Load {} changes with time", k + 1), Item::Load(k)));
        all.push(own(&format!("Reset load force of load {}", k + 1), Item::Load(k)));
    }
    for (k, cable) in of.cables.iter().enumerate() {
        for (support, s) in cable.supports.iter().enumerate() {
            let item = Item::Support { cable: k, support };
            let name = state.describe(item);
            if !matches!(s.kind, SupportKind::Load | SupportKind::Free) {
                all.push(own(&format!("Releases the cable at a set time: {name}"), item));
            }
            if s.at_m.is_some() {
                all.push(own(&format!("Follows a schedule: {name}"), item));
            }
            if s.kind == SupportKind::Load {
                all.push(own(&format!("Force changes with time: {name}"), item));
            }
            if s.kind == SupportKind::Pulley {
                all.push(own(&format!("Over or under the wheel: {name}"), item));
            }
        }
    }
    all
}

/// The places that figures have on the cable.
fn places(state: &AppState) -> Vec<PaletteEntry> {
    let index = state.current_cable();
    let to = |name: &str, at: [f64; 2]| view(format!("Show {name}"), ViewCommand::ZoomOn(at));
    let mut all: Vec<PaletteEntry> =
        warnings::places(state).into_iter().map(|(title, command)| (format!("Details of {title}"), command)).collect();
    let solved = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let answer = state.live.snapshot.solution.as_deref();
    let (Some(cable), Some(answer)) = (solved.cables.get(index), answer) else { return all };
    let Some(found) = answer.cables.get(index) else { return all };
    let summary_of_cable = summary(solved, cable, found, answer.time_s);
    for (name, at) in [
        ("lowest", Some(summary_of_cable.lowest)),
        ("highest", Some(summary_of_cable.highest)),
        ("sag", summary_of_cable.sag.map(|s| s.at)),
        ("least tension", Some(summary_of_cable.least_tension.at)),
        ("touchdown points", summary_of_cable.touchdowns.first().map(|t| t.at)),
    ] {
        all.extend(at.map(|at| to(name, [at.x_m, at.y_m])));
    }
    for (name, bend) in [
        ("tightest bend", summary_of_cable.judged_bend.map(|j| j.bend).or(summary_of_cable.tightest_bend)),
        ("bend of the line", summary_of_cable.tightest_bend),
        ("bend away from guides", found.free_bend),
    ] {
        all.extend(bend.map(|b| to(name, [b.x_m, b.y_m])));
    }
    let far = |n: &cable_core::solution::Node| n.displacement_m[0].hypot(n.displacement_m[1]);
    for (name, node) in [
        ("the greatest tension", extremes::greatest(found, |n| n.tension_n)),
        ("max stress", extremes::greatest(found, |n| n.stress_pa)),
        ("max strain", extremes::greatest(found, |n| n.strain)),
        ("greatest displacement", extremes::greatest(found, far)),
    ] {
        all.extend(node.map(|(_, n)| to(name, [n.x_m, n.y_m])));
    }
    all.extend(summary_of_cable.sidewall_pressure.map(|p| to("sidewall pressure", [p.x_m, p.y_m])));
    for (support, s) in cable.supports.iter().enumerate() {
        let at = support_position(state, index, support);
        all.extend(at.map(|at| view(format!("Show support {}", s.name), ViewCommand::CentreOn(at))));
    }
    all
}

/// The guide that is on, and the hints of the first minute.
fn guides(state: &AppState) -> Vec<PaletteEntry> {
    let mut all = Vec::new();
    if !state.ui.first_steps.open().is_empty() {
        all.push(view("Hide these hints", ViewCommand::HideFirstSteps));
    }
    if state.ui.tutorial.is_some() {
        all.push(view("End guide", ViewCommand::SetTutorialPlace(None)));
    }
    all
}
