//! A graph shows the largest tension and the pulls at both ends, the robot or energies against
//! time.

use cable_core::{Cable, Scene};
use egui::Ui;

use crate::plot::{Graph, GraphResponse, GraphView, TIME, in_view, show};
use crate::record::plotted_quantity::{Measure, per_newton};
use crate::record::sample::Sample;
use crate::record::series::{Series, envelope, thin};
use crate::render::colour::CableQuantity;
use crate::state::AppState;
use crate::state::job_questions::friction_answer;
use crate::units::unit::Unit;

/// Between two columns of a line of more samples than can be told apart, points: lines are as wide.
/// Less: twice the triangles for the same picture; more: peaks look blunt.
const SAMPLE_COLUMN_WIDTH: f32 = 2.0;

/// Title of the first graph.
pub const TITLE: &str = "Over time";
/// Shortest time axis, s: the first frames would otherwise jump.
const MIN_SPAN_S: f64 = 1.0;

/// Draws the first one. Stress and strain follow from tension for a single cable only; with
/// several, tension is shown.
///
/// `pins`: the names of pinned results.
pub fn ui(ui: &mut Ui, state: &AppState, pins: &[String], view: GraphView, height: f32) -> GraphResponse {
    graph(ui, state, pins, view, TITLE, height)
}

/// Draws the second one, with time linked to the first.
pub fn second(ui: &mut Ui, state: &AppState, pins: &[String], view: GraphView, height: f32) -> GraphResponse {
    let Some(measure) = view.second else { return GraphResponse::default() };
    let title = format!("{} over time", measure.name());
    graph(ui, state, pins, GraphView { measure, ..view }, &title, height)
}

/// The graph over time.
fn graph(ui: &mut Ui, state: &AppState, pins: &[String], view: GraphView, title: &str, height: f32) -> GraphResponse {
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let Some(cable) = scene.cables.get(state.current_cable()) else { return GraphResponse::default() };
    let measure = match view.measure {
        Measure::Cable(_) if scene.cables.len() > 1 => Measure::Cable(CableQuantity::Tension),
        measure => measure,
    };
    let now_s = state.live.history.samples.back().map_or(0.0, |s| s.time_s);
    let first_s = state.live.history.samples.front().map_or(0.0, |s| s.time_s);
    let left_s = view.window_s.map_or(first_s, |w| (now_s - w).max(first_s));
    let recorded_s = now_s;
    let runs_end_s = state.analysis.references.iter().filter_map(|r| Some(r.run.as_ref()?.span_s()[1]));
    // A past that is shown is in view: all graphs follow the timeline.
    let left_s = match (state.live.recording.shown_s, view.window_s) {
        (Some(shown), Some(w)) if shown < left_s || shown > now_s => (shown - 0.5 * w).max(first_s),
        _ => left_s,
    };
    let now_s = view.window_s.map_or(now_s, |w| now_s.min(left_s + w));
    let range = [left_s, now_s.max(left_s + view.window_s.unwrap_or(MIN_SPAN_S).max(MIN_SPAN_S))];
    // A zoomed graph shows what it showed in the frame before, and a little on each side.
    let seen = if view.follow { None } else { in_view(ui, title) }.unwrap_or(range);
    let margin = 0.1 * (seen[1] - seen[0]);
    let seen = [seen[0] - margin, seen[1] + margin];
    let columns = (ui.available_width() / SAMPLE_COLUMN_WIDTH).max(1.0) as usize;
    let graph = Graph {
        title,
        group: TIME,
        measure,
        across: ("Time", Unit::S),
        range,
        last: runs_end_s.fold(recorded_s.max(range[1]), f64::max),
        limits: measure.limits(cable),
        follow: view.follow,
        height,
        ribbon: ribbon(state, cable, measure),
        mark: state.live.recording.shown_s,
        // A single instant is no line.
        hint: (state.live.history.samples.len() < 2 && state.analysis.references.iter().all(|r| r.run.is_none()))
            .then_some("Press Play to fill this graph"),
        export: view.export == Some(title),
    };
    let mut touched = show(ui, &graph, &lines(state, scene, pins, measure, seen, Some(columns)));
    if let Some(sheet) = &mut touched.export {
        // Every sample, not only those that can be told apart on screen.
        sheet.lines = lines(state, scene, pins, measure, [f64::NEG_INFINITY, f64::INFINITY], None);
    }
    touched
}

/// The largest tension with less and more friction, and what follows from it.
fn ribbon(state: &AppState, cable: &Cable, measure: Measure) -> Vec<[f64; 3]> {
    let (Measure::Cable(quantity), Some((found, _))) = (measure, friction_answer(state)) else {
        return Vec::new();
    };
    let scale = per_newton(quantity, cable);
    found.over_time.iter().map(|b| [b.at, b.low_n * scale, b.high_n * scale]).collect()
}

/// The lines of a measure, SI, between two times: thinned to `columns` of the screen if there are
/// any; then those of held runs.
fn lines(
    state: &AppState,
    scene: &Scene,
    pins: &[String],
    measure: Measure,
    seen: [f64; 2],
    columns: Option<usize>,
) -> Vec<Series> {
    let mut lines = recorded_lines(state, scene, measure, seen, columns);
    for (k, reference) in state.analysis.references.iter().enumerate() {
        let Some(line) = reference.run.as_ref().and_then(|r| r.line(measure)) else { continue };
        let scale = match (measure, reference.scene.cables.first()) {
            (Measure::Cable(quantity), Some(cable)) => per_newton(quantity, cable),
            _ => 1.0,
        };
        let mut points = line.view(seen, columns.unwrap_or(usize::MAX));
        if let Some(columns) = columns {
            // Blocks are finer than columns: a line of as many points as can be told apart is drawn
            // in a third of the time.
            points = thin(points.into_iter(), columns);
        }
        points.iter_mut().for_each(|p| p[1] *= scale);
        let name = format!("Pinned: {}", pins.get(k).map_or("", String::as_str));
        lines.push(Series { name, points, reference: Some(k), ..Series::default() });
    }
    lines
}

/// Those of what was recorded.
fn recorded_lines(
    state: &AppState,
    scene: &Scene,
    measure: Measure,
    seen: [f64; 2],
    columns: Option<usize>,
) -> Vec<Series> {
    let history = &state.live.history;
    let (samples, means) = (history.view(seen, columns), history.means(seen, columns));
    let ends = [samples.first(), samples.last()].map(|s| s.map_or(0.0, |s| s.time_s));
    let index = state.current_cable();
    let cable = scene.cables.get(index);
    let scale = match (measure, cable) {
        (Measure::Cable(quantity), Some(cable)) => per_newton(quantity, cable),
        _ => 1.0,
    };
    let line = |name: String, of: &dyn Fn(&Sample) -> f64| {
        let points = |samples: &[&Sample]| samples.iter().map(|s| [s.time_s, of(s) * scale]).collect::<Vec<_>>();
        match columns.filter(|c| samples.len() > 2 * c) {
            None => Series { name, points: points(&samples), ..Series::default() },
            // Denser than columns: what happens in each, and its mean, instead of a line up and
            // down.
            Some(c) => {
                let (points, band) = envelope(points(&samples).into_iter(), points(&means).into_iter(), ends, c);
                Series { name, points, band, reference: None }
            }
        }
    };
    let (Measure::Cable(_), Some(cable)) = (measure, cable) else {
        return measure.lines().iter().map(|(name, of)| line((*name).to_owned(), of)).collect();
    };
    let what = if scene.cables.len() == 1 { "Maximum" } else { "Maximum of all" };
    let mut lines = vec![line(what.to_owned(), &|s| s.max_tension_n)];
    // Reactions of all cables stand one after the other.
    let before: usize = scene.cables.iter().take(index).map(|c| c.supports.len()).sum();
    for k in [0, cable.supports.len().saturating_sub(1)] {
        let Some(support) = cable.supports.get(k) else { continue };
        let pull = move |s: &Sample| s.reactions_n.get(before + k).map_or(f64::NAN, |r| r[0].hypot(r[1]));
        lines.push(line(format!("At {}", support.name), &pull));
    }
    lines
}
