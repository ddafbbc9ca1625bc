//! The plots panel shows a quantity over time and along the cable, with cursors and export, and
//! above them the timeline.

use egui::{ComboBox, Id, Ui};

use crate::command::{Command, FileCommand, PlaybackCommand};
use crate::panels::pin_names::pin_names;
use crate::panels::readouts::dimmed_if_old;
use crate::panels::timeline;
use crate::plot::{GraphResponse, GraphView, along_cable, over_time};
use crate::record::plotted_quantity::Measure;
use crate::render::colour::CableQuantity;
use crate::state::dialog::Dialog;
use crate::state::job_questions::friction_answer;
use crate::state::{AppState, GraphRequest};
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::field;

/// Room of the line between the choice of graphs and the timeline, points.
const SEPARATOR_WIDTH: f32 = 14.0;
/// Below this width the graphs stand one under the other, points.
const LEAST_SIDE_BY_SIDE_WIDTH: f32 = 480.0;
/// Lowest graph that can still be read, points.
const MIN_HEIGHT: f32 = 90.0;

/// The lengths of the past that can be followed.
const WINDOWS: [(Option<f64>, &str); 4] =
    [(Some(10.0), "Last 10 s"), (Some(60.0), "Last 60 s"), (Some(300.0), "Last 300 s"), (None, "All")];

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let id = Id::unique("plot view");
    let mut view: GraphView = ui.data(|d| d.get_temp(id)).unwrap_or_default();
    view.export = state.ui.graph_to_export;
    apply_request(ui, state, &mut view);
    // Beside the choice of graphs where its rail is long enough to aim at there.
    let id_of_width = Id::unique("width of the choice of graphs");
    let beside = ui.data(|d| d.get_temp::<f32>(id_of_width)).unwrap_or(f32::INFINITY);
    if ui.available_width() >= beside + timeline::width_in_row(ui) {
        ui.horizontal(|ui| {
            let left = ui.cursor().left();
            controls(ui, state, &mut view);
            ui.separator();
            let width = ui.cursor().left() - left;
            ui.data_mut(|d| d.insert_temp(id_of_width, width));
            timeline::in_row(ui, state, commands);
        });
    } else {
        // Every point goes to the graphs.
        ui.spacing_mut().item_spacing.y = 0.0;
        timeline::ui(ui, state, commands);
        ui.horizontal_wrapped(|ui| {
            let left = ui.cursor().left();
            controls(ui, state, &mut view);
            let width = ui.cursor().left() - left + SEPARATOR_WIDTH;
            let is_one_row = ui.min_rect().height() < 1.5 * ui.spacing().interact_size.y;
            ui.data_mut(|d| d.insert_temp(id_of_width, if is_one_row { width } else { f32::INFINITY }));
        });
    }
    let wide = ui.available_width() >= LEAST_SIDE_BY_SIDE_WIDTH;
    let room = ui.available_height() - ui.spacing().item_spacing.y;
    let height = if wide { room } else { room / 2.0 };
    let touched = if !wide && height < MIN_HEIGHT {
        // No room for both: the one that is always full.
        vec![along_cable(ui, state, view, room)]
    } else if wide && view.second.is_some() {
        ui.columns_const(|[left, middle, right]| {
            vec![
                over_time(left, state, view, height, over_time::ui),
                over_time(middle, state, view, height, over_time::second),
                along_cable(right, state, view, height),
            ]
        })
    } else if wide {
        ui.columns_const(|[left, right]| {
            vec![over_time(left, state, view, height, over_time::ui), along_cable(right, state, view, height)]
        })
    } else {
        vec![over_time(ui, state, view, height, over_time::ui), along_cable(ui, state, view, height)]
    };
    for graph in touched {
        // A graph that follows would take the zoom back at once.
        view.follow &= !graph.zoomed;
        if let (Some(time_s), Some([first, last])) = (graph.scrubbed_s, state.live.recording.span_s()) {
            commands.push(Command::Playback(PlaybackCommand::ShowTime(Some(time_s.clamp(first, last)))));
        }
        if let Some(sheet) = graph.export {
            let path = format!("{}.csv", sheet.title.to_lowercase().replace(' ', "-"));
            commands.push(Command::File(FileCommand::SetDialog(Some(Dialog::Export { path, sheet }))));
        }
    }
    ui.data_mut(|d| d.insert_temp(id, view));
}

/// The row of controls: measures, following, and the time window.
fn controls(ui: &mut Ui, state: &AppState, view: &mut GraphView) {
    measures(ui, state, view);
    ui.separator();
    checkbox(ui, &mut view.follow, "Follow").on_hover_text(
        "The graphs keep up with the data. The wheel zooms at the pointer and turns this off; then drag to move, double-click \
         to fit. Click for a cursor, again for a second and their difference, again for none",
    );
    time_window(ui, view);
    if state.live.history.samples.len() >= 2
        && state.document.scene.cables.len() > 1
        && matches!(view.measure, Measure::Cable(CableQuantity::Stress | CableQuantity::Strain))
    {
        ui.weak("Over time: tension, as there are several cables");
    }
}

/// The measures to choose from; those of a robot only if there is one.
fn measures(ui: &mut Ui, state: &AppState, view: &mut GraphView) {
    for measure in Measure::ALL {
        let robot = matches!(measure, Measure::Pull | Measure::Speed);
        if !robot || state.document.scene.robot.is_some() {
            let on = view.measure == measure || view.second == Some(measure);
            let help = format!(
                "{}. Shift+click: in a second graph beside the first, with time and cursors linked",
                measure.help()
            );
            if ui.selectable_label(on, measure.name()).on_hover_text(help).clicked() {
                pick(ui, view, measure);
            }
        }
    }
}

/// The length of the past that the time graph follows.
fn time_window(ui: &mut Ui, view: &mut GraphView) {
    let present = WINDOWS.iter().find(|(w, _)| *w == view.window_s).map_or("", |(_, text)| text);
    let combo = ComboBox::from_id_salt("window").selected_text(present).width(84.0);
    let shown = combo.show_ui(ui, |ui| {
        for (window_s, text) in WINDOWS {
            ui.selectable_value(&mut view.window_s, window_s, text);
        }
    });
    field::name(&shown.response, "Time window");
    shown.response.on_hover_text("How much of the past the time graph follows");
}

/// Takes in a request that was made of the graphs since the frame before.
fn apply_request(ui: &Ui, state: &AppState, view: &mut GraphView) {
    let id = Id::unique("graph requests");
    let (count, request) = state.ui.graph_request;
    let before = ui.data(|d| d.get_temp::<u64>(id)).unwrap_or(0);
    ui.data_mut(|d| d.insert_temp(id, count));
    match request.filter(|_| count != before) {
        Some(GraphRequest::Measure(measure)) => (view.measure, view.second) = (measure, None),
        Some(GraphRequest::Follow) => view.follow = !view.follow,
        None => {}
    }
}

/// A click shows a measure alone; with shift, in a second graph or not any more.
fn pick(ui: &Ui, view: &mut GraphView, measure: Measure) {
    if !ui.input(|i| i.modifiers.shift) {
        (view.measure, view.second) = (measure, None);
    } else if view.second == Some(measure) {
        view.second = None;
    } else if view.measure != measure {
        view.second = Some(measure);
    }
}

/// A graph over time.
type TimeGraph = fn(&mut Ui, &AppState, &[String], GraphView, f32) -> GraphResponse;

fn over_time(ui: &mut Ui, state: &AppState, view: GraphView, height: f32, graph: TimeGraph) -> GraphResponse {
    let pins: Vec<String> = pin_names(state).into_iter().map(|name| name.short).collect();
    dimmed_if_old(ui, state, |ui| graph(ui, state, &pins, view, height))
}

/// The graph along the cable.
fn along_cable(ui: &mut Ui, state: &AppState, view: GraphView, height: f32) -> GraphResponse {
    let index = state.current_cable();
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let answer = state.live.snapshot.solution.as_deref().and_then(|s| s.cables.get(index));
    match (scene.cables.get(index), answer) {
        (Some(cable), Some(solved)) => {
            // The ribbon is of the end of the run.
            let present = state.live.snapshot.solution.as_ref().map(|s| s.time_s);
            let found = friction_answer(state).filter(|(_, ask)| present == Some(ask.span_s));
            let ribbon = found.and_then(|(s, _)| s.along.get(index)).map_or(&[][..], Vec::as_slice);
            dimmed_if_old(ui, state, |ui| along_cable::ui(ui, cable, solved, ribbon, view, height))
        }
        _ => {
            ui.weak("Nothing solved yet");
            GraphResponse::default()
        }
    }
}
