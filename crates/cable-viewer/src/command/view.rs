//! View commands change what is shown, not what is solved.

use std::sync::Arc;
use std::time::Instant;

use cable_core::math::Point;

use crate::command::effects::Effects;
use crate::jobs::safe_reach::{self, Progress, ReachSubject, SafeReachQuery};
use crate::jobs::{model_comparison, neglected_bending, work_precision};
use crate::record::kept_run::KeptRun;
use crate::render::colour::ColourScale;
use crate::state::job_questions::{bending_query, reach_target};
use crate::state::tutorial_place::TutorialPlace;
use crate::state::{AppState, Grab, GraphRequest, Item, Layers, OpenPanels, Reference, TensionMarker, ToolSection};
use crate::units::system::System;

/// Changes what is shown.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewCommand {
    /// Selects an item, or clears the selection.
    Select(Option<Item>),
    /// Adds an item to the selection, or removes it.
    ToggleSelected(Item),
    /// Picks several things.
    SelectAll(Vec<Item>),
    /// Shows or hides the tension budget at a place of a cable.
    SetTensionMarker(Option<TensionMarker>),
    /// Draws the selection rectangle between two corners, m.
    SetMarquee(Option<[Point; 2]>),
    /// The pointer is over an item or over none, at a point of the world (m).
    Hover(Option<Item>, Option<Point>),
    /// Begins or ends the drag of an item.
    Grab(Option<Grab>),
    /// Moves the world with the pointer, points.
    Pan(egui::Vec2),
    /// Scales about a world point, m.
    Zoom {
        /// It stays where it is on screen, m.
        about_m: Point,
        /// Above 1 = closer.
        factor: f64,
    },
    /// Fits the whole scene into the view.
    Fit,
    /// A torn cable stays in view until the view is moved.
    Follow,
    /// Centres the view on the cable at the same scale.
    Recentre,
    /// Centres the view on a point (m) at the same scale.
    CentreOn(Point),
    /// Puts a point (m) in the middle and shows what lies round it.
    ZoomOn(Point),
    /// Opens and folds parts of the window.
    ShowPanels(OpenPanels),
    /// Applies a command, and shows the section with its result.
    UseTool(ToolSection, Box<ViewCommand>),
    /// Shows another measure in the graphs, or has them keep up with the data.
    AskGraph(GraphRequest),
    /// Asks where to export the graph of this title to.
    ExportGraph(&'static str),
    /// The colouring of the cable.
    SetColour(ColourScale),
    /// The layers that are drawn.
    SetLayers(Layers),
    /// Light or dark.
    SetTheme(egui::ThemePreference),
    /// Begins the search for places to which the robot or an end can be taken.
    SearchSafeReach,
    /// Ends that search and keeps its map; once it has ended, the map is dropped.
    EndSafeReach,
    /// Sets the question and the display of the safe reach.
    SetSafeReachOptions(safe_reach::SafeReachOptions),
    /// Shows or hides the effect of less and of more friction.
    SetFrictionRange {
        /// True if the effect is shown.
        shown: bool,
        /// Least and greatest friction over that of the scene.
        factors: [f64; 2],
    },
    /// Asks for the effect of neglected bending stiffness.
    AskBending,
    /// Does not show the hints of the first minute again.
    HideFirstSteps,
    /// Leads to a step of a guided scene, or not any more.
    SetTutorialPlace(Option<TutorialPlace>),
    /// SI or US units; files stay SI.
    SetUnits(System),
    /// Pins the answer on screen for comparison.
    AddReference,
    /// Asks every model about the scene at rest, and pins their answers.
    CompareModels,
    /// Ends that comparison.
    EndModelComparison,
    /// Solves the scene at rest by every model and mesh, and charts their error over their cost.
    ChartWorkPrecision,
    /// Ends that, and keeps the results found until then.
    EndWorkPrecision,
    /// Removes one pin, or all.
    RemoveReferences(Option<usize>),
}

/// Fraction of the scene that is shown round a place. With a larger fraction the place is hard to
/// find in the view; with a smaller one its position in the scene is not visible.
const PLACE_FRACTION: f64 = 0.25;

/// Applies a view command.
pub fn apply(state: &mut AppState, command: ViewCommand, effects: &mut Effects) {
    match command {
        ViewCommand::Select(item) => {
            if state.selection.selected != item {
                state.document.undo.close_entry();
            }
            (state.selection.selected, state.selection.also_selected) = (item, Vec::new());
        }
        ViewCommand::ToggleSelected(item) => toggle_selected(state, item),
        ViewCommand::SelectAll(items) => select_all(state, items),
        ViewCommand::SetTensionMarker(probe) => state.analysis.tension_marker = probe,
        ViewCommand::SetMarquee(corners) => state.selection.marquee_m = corners,
        ViewCommand::Hover(item, at_m) => {
            state.selection.hovered = item;
            state.selection.cursor_m = at_m;
        }
        ViewCommand::Grab(grab) => {
            state.selection.grab = grab;
            if grab.is_none() {
                crate::command::scene::release_spring_support(state, effects);
            }
        }
        ViewCommand::Pan(delta) => state.view.camera.pan(delta),
        ViewCommand::Zoom { about_m, factor } => state.view.camera.zoom(about_m, factor),
        ViewCommand::Fit => (state.view.camera.fit_wanted, state.view.camera.follows) = (true, false),
        ViewCommand::Follow => state.view.camera.follows = true,
        ViewCommand::Recentre => {
            let [low, high] = crate::geometry::bounds::cables(state);
            state.view.camera.centre_on([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])]);
        }
        ViewCommand::CentreOn(p) => {
            if p.iter().all(|v| v.is_finite()) {
                state.view.camera.centre_on(p);
            }
        }
        ViewCommand::ZoomOn(p) => zoom_on(state, p),
        ViewCommand::ShowPanels(panels) => state.ui.panels = panels,
        ViewCommand::UseTool(section, command) => use_tool(state, section, *command, effects),
        ViewCommand::AskGraph(request) => {
            state.ui.panels.graphs = true;
            state.ui.graph_request = (state.ui.graph_request.0 + 1, Some(request));
        }
        ViewCommand::ExportGraph(title) => {
            state.ui.panels.graphs = true;
            state.ui.graph_to_export = Some(title);
        }
        ViewCommand::SetColour(colour) => state.view.colour = colour,
        ViewCommand::SetLayers(layers) => state.view.layers = layers,
        ViewCommand::SetTheme(theme) => state.view.theme = theme,
        ViewCommand::EndSafeReach => {
            state.analysis.safe_reach.stop_or_clear();
            effects.reach = Some(None);
        }
        ViewCommand::SearchSafeReach => search_safe_reach(state, effects),
        ViewCommand::SetSafeReachOptions(choice) => state.analysis.safe_reach.choice = choice,
        ViewCommand::SetFrictionRange { shown, factors } => set_friction_range(state, shown, factors),
        ViewCommand::AskBending => {
            state.analysis.neglected_bending = neglected_bending::NeglectedBendingState {
                query: bending_query(state),
                ..neglected_bending::NeglectedBendingState::default()
            }
        }
        ViewCommand::HideFirstSteps => state.ui.first_steps.hide(),
        ViewCommand::SetTutorialPlace(place) => state.ui.tutorial = place,
        ViewCommand::SetUnits(units) => state.view.units = units,
        ViewCommand::AddReference => add_reference(state),
        ViewCommand::CompareModels => {
            state.analysis.models = model_comparison::Progress::Running(0.0, None);
            effects.models = Some(Some(Box::new(state.document.scene.clone())));
        }
        ViewCommand::EndModelComparison => {
            (state.analysis.models, effects.models) = (model_comparison::Progress::None, Some(None))
        }
        ViewCommand::ChartWorkPrecision => {
            state.analysis.work_precision = work_precision::Progress::Running(0.0, None);
            effects.work_precision = Some(Some(Box::new(state.document.scene.clone())));
        }
        ViewCommand::EndWorkPrecision => stop_work_precision(state, effects),
        ViewCommand::RemoveReferences(None) => state.analysis.references.clear(),
        ViewCommand::RemoveReferences(Some(k)) => {
            if k < state.analysis.references.len() {
                state.analysis.references.remove(k);
            }
        }
    }
}

/// Selects a thing in addition to the others, or no longer.
fn toggle_selected(state: &mut AppState, item: Item) {
    let mut picks = state.selection.selected_items();
    match picks.iter().position(|i| *i == item) {
        Some(k) => drop(picks.remove(k)),
        None => picks.push(item),
    }
    select_all(state, picks);
}

/// Applies the command of a tool and brings the section in which it is answered into sight.
fn use_tool(state: &mut AppState, section: ToolSection, command: ViewCommand, effects: &mut Effects) {
    apply(state, command, effects);
    if section == ToolSection::Solver {
        apply(state, ViewCommand::Select(Some(Item::Solver)), effects);
    }
    state.ui.panels.results = true;
    state.ui.section_request = (state.ui.section_request.0 + 1, Some(section));
}

/// Shows the ribbon of less and more friction or not, and sets its factors.
fn set_friction_range(state: &mut AppState, shown: bool, [low, high]: [f64; 2]) {
    state.analysis.friction_range.on = shown;
    if low >= 0.0 && high.is_finite() {
        // The scene's own friction lies in between.
        state.analysis.friction_range.factors = [low.min(1.0), high.max(1.0)];
    }
}

/// Centres the view on a place and shows a small part of the scene round it.
fn zoom_on(state: &mut AppState, p: Point) {
    if p.iter().all(|v| v.is_finite()) {
        let [low, high] = crate::geometry::bounds::scene(state);
        let [left, right] = state.view.visible_m;
        let (part, shown) = (PLACE_FRACTION * (high[0] - low[0]).max(high[1] - low[1]), right[0] - left[0]);
        state.view.camera.centre_on(p);
        if part > 0.0 && shown > part {
            state.view.camera.zoom(p, shown / part);
        }
    }
}

/// Starts the search for the places that a support or the robot can safely reach.
fn search_safe_reach(state: &mut AppState, effects: &mut Effects) {
    let Some(moved) = reach_target(state) else {
        state.analysis.safe_reach.progress = Progress::Failed("nothing here has a place to be taken from".to_owned());
        return;
    };
    state.analysis.safe_reach.progress = Progress::Running(0.0, None);
    (state.analysis.safe_reach.began, state.analysis.safe_reach.stopped) = (Some(Instant::now()), None);
    let corners_m = match moved {
        ReachSubject::Robot => crate::geometry::terrain_extent::ground(state).map(|x| [x, 0.0]),
        ReachSubject::Support { cable, support } => {
            let at = crate::geometry::supports::support_position(state, cable, support);
            crate::geometry::terrain_extent::within_terrain(state, at, state.view.visible_m)
        }
    };
    let (scene, settings, across) =
        (state.document.scene.clone(), state.solver.settings, state.analysis.safe_reach.choice.across);
    // Once time has run, the search begins from the cable on screen: a hand or the robot may have
    // moved it.
    let now = state.live.snapshot.solution.clone().filter(|s| s.time_s > 0.0 && !state.live.snapshot.stale);
    effects.reach = Some(Some(Box::new(SafeReachQuery { scene, now, settings, moved, corners_m, across })));
}

/// Pins the present answer with the run that was recorded.
fn add_reference(state: &mut AppState) {
    if let (Some(solution), Some(scene)) = (state.live.snapshot.solution.clone(), state.live.snapshot.scene.clone())
        && state.analysis.references.len() < Reference::MAX_COUNT
    {
        let recording = &state.live.recording;
        let run = KeptRun::of(state.live.history.samples.iter(), recording.answers(), recording.events().len());
        let (run, wall_s) = (run.map(Arc::new), state.live.snapshot.solve_wall_s);
        let changes = state.analysis.changes_to(&scene, &state.document.saved);
        state.analysis.references.push(Reference { scene, changes, folder: None, solution, wall_s, run });
    }
}

/// Ends the comparison of models and meshes; the results found until then stay.
fn stop_work_precision(state: &mut AppState, effects: &mut Effects) {
    let before = std::mem::take(&mut state.analysis.work_precision);
    if let work_precision::Progress::Running(_, Some(found)) = before {
        state.analysis.work_precision = work_precision::Progress::Done(found);
    }
    effects.work_precision = Some(None);
}

fn select_all(state: &mut AppState, items: Vec<Item>) {
    state.document.undo.close_entry();
    let mut items = items.into_iter();
    (state.selection.selected, state.selection.also_selected) = (items.next(), items.collect());
}
