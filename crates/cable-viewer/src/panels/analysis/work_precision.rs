//! The chart of error over cost has every model on several meshes, beside the tolerance asked for.

use std::collections::BTreeMap;

use cable_core::Model;
use cable_core::analysis::Setting;
use egui::{Rangef, RichText, Ui};
use egui_plot::{AxisHints, GridInput, GridMark, HLine, LineStyle, MarkerShape, Plot, PlotBounds, Points};

use crate::command::{Command, ViewCommand};
use crate::jobs::background::Progress;
use crate::jobs::work_precision::{MeasuredSetting, WorkPrecision};
use crate::panels::display_names::capital;
use crate::plot::TOLERANCE_MARK;
use crate::render::colour;
use crate::state::AppState;
use crate::units::sentence::sentence;
use crate::units::{format, labels};
use crate::widgets::{field, progress};

/// Name of the chart.
const TITLE: &str = "Error over cost";
/// Height of the chart, points.
const HEIGHT: f32 = 190.0;
/// Distance of powers of ten below which their numbers are left out, and from which they are as
/// dark as text, points.
const LABELS_APART: Rangef = Rangef { min: 18.0, max: 26.0 };
/// Differences below this are drawn at it: they are rounding.
const MIN_DIFFERENCE: f64 = 1e-10;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let progress = &state.analysis.work_precision;
    if let Progress::Running(share, _) = progress {
        let bar = progress::bar(ui, *share);
        field::name(&bar, "Progress of the chart");
        if ui.button("Cancel chart").on_hover_text("Stops it after the model that is being asked").clicked() {
            commands.push(Command::View(ViewCommand::EndWorkPrecision));
        }
    } else {
        let help = "Solves the scene at rest with every model, with 25 to 400 segments where it has a mesh, in the background, and charts \
                    how far each is from the answer with the settings in use, and how long it takes";
        let can = state.document.fault.is_none();
        let button = ui.add_enabled(can, egui::Button::new("Plot error against cost")).on_hover_text(help);
        if button.on_disabled_hover_text("The scene has a fault: see Warnings").clicked() {
            commands.push(Command::View(ViewCommand::ChartWorkPrecision));
        }
    }
    match progress {
        Progress::Failed(why) => field::fault(ui, &format!("No chart: {why}")),
        Progress::Done(found) | Progress::Running(_, Some(found)) => outcome(ui, state, found),
        Progress::None | Progress::Running(_, None) => {}
    }
}

/// The measured settings: chart, legend, the fastest that is accurate enough, and refusals.
fn outcome(ui: &mut Ui, state: &AppState, found: &WorkPrecision) {
    if *found.scene != state.document.scene {
        ui.colored_label(ui.visuals().warn_fg_color, "Out of date: edited since");
    }
    let tolerance = state.solver.settings.tolerance;
    let (given, given_s) = &found.given;
    chart(ui, found, tolerance);
    legend(ui, found);
    ui.label(format!("In use: {}, {}", labels::model(given.model), format::duration(*given_s)))
        .on_hover_text("The answer that the others are compared with");
    ui.weak(capital(&sentence(&given.reason)));
    ui.label(match found.quickest(tolerance) {
        Some((setting, wall_s)) => {
            format!("Fastest within {}: {}, {}", format::percent(tolerance), name(setting), format::duration(wall_s))
        }
        None => format!("No setting is within {}", format::percent(tolerance)),
    });
    let refused = found.entries.iter().filter_map(|e| Some((e.setting, e.result.as_ref().err()?)));
    // A model refuses a scene on every mesh for the same reason.
    let by_model: BTreeMap<&str, String> =
        refused.map(|(setting, why)| (labels::model(setting.model), sentence(why))).collect();
    for (model, why) in by_model {
        ui.label(RichText::new(format!("{model}: {why}")).small());
    }
}

fn name(setting: Setting) -> String {
    let model = labels::model(setting.model);
    setting.elements.map_or_else(|| model.to_owned(), |n| format!("{model} with {n} segments"))
}

/// Place of an answer in the chart: powers of ten of milliseconds and of the difference.
fn place(entry: &MeasuredSetting) -> Option<[f64; 2]> {
    let (compared, wall_s) = entry.result.as_ref().ok()?;
    Some([(wall_s * 1e3).max(1e-6).log10(), compared.force_difference.max(MIN_DIFFERENCE).log10()])
}

/// The chart of difference over time, both logarithmic.
fn chart(ui: &mut Ui, found: &WorkPrecision, tolerance: f64) {
    let places: Vec<[f64; 2]> = found.entries.iter().filter_map(place).collect();
    let ends = |k: usize, also: f64| {
        let all = places.iter().map(|p| p[k]).chain([also]);
        all.fold([also, also], |[low, high], v| [low.min(v), high.max(v)])
    };
    let [left, right] = ends(0, (found.given.1 * 1e3).max(1e-6).log10());
    let [low, high] = ends(1, tolerance.max(MIN_DIFFERENCE).log10());
    let across =
        AxisHints::new_x().label("Time, ms").formatter(|mark, _| power(mark.value)).label_spacing(LABELS_APART);
    let plot = Plot::new(TITLE)
        .height(HEIGHT)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .y_axis_min_width(34.0)
        .custom_x_axes(vec![across])
        .y_axis_label("Difference of forces")
        .x_grid_spacer(decades)
        .y_grid_spacer(decades)
        .y_axis_formatter(|mark, _| power(mark.value));
    let shown = plot.show(ui, |plot| {
        plot.set_plot_bounds(PlotBounds::from_min_max([left - 0.4, low - 0.8], [right + 0.4, high + 0.8]));
        let line = HLine::new("Tolerance", tolerance.max(MIN_DIFFERENCE).log10()).color(TOLERANCE_MARK).width(1.5);
        plot.hline(line.style(LineStyle::dashed_dense()).allow_hover(false));
        for (model, shape) in Model::SOLVERS.into_iter().zip(SHAPES) {
            let of_model = found.entries.iter().filter(|e| e.setting.model == model);
            let points: Vec<[f64; 2]> = of_model.filter_map(place).collect();
            let (colour, label) = (colour::of_model(model), labels::model(model));
            plot.line(egui_plot::Line::new(label, points.clone()).color(colour).width(1.5).allow_hover(false));
            plot.points(Points::new(label, points).color(colour).shape(shape).radius(4.0).filled(true));
        }
    });
    let response = shown.response;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Figure, true, TITLE));
    field::name(&response, TITLE);
    let spoken: Vec<String> = found.entries.iter().filter_map(spoken).collect();
    response.ctx.accesskit_node_builder(response.id, |node| node.set_description(spoken.join("; ").as_str()));
}

/// Marks that tell the models apart besides their colour, in the order of [`Model::SOLVERS`].
const SHAPES: [MarkerShape; 4] = [MarkerShape::Diamond, MarkerShape::Square, MarkerShape::Circle, MarkerShape::Up];

/// A setting in words: what it differs by and takes, and the error that it states.
fn spoken(entry: &MeasuredSetting) -> Option<String> {
    let (compared, wall_s) = entry.result.as_ref().ok()?;
    let stated = compared.stated_error.map_or_else(String::new, |e| format!(", states {}", format::percent(e)));
    let difference = format::percent(compared.force_difference);
    Some(format!("{}: {difference} in {}{stated}", name(entry.setting), format::duration(*wall_s)))
}

/// The models of the chart with their colours.
fn legend(ui: &mut Ui, found: &WorkPrecision) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 5.0;
        for model in Model::SOLVERS {
            let own: Vec<&MeasuredSetting> = found.entries.iter().filter(|e| e.setting.model == model).collect();
            if own.iter().all(|e| e.result.is_err()) {
                continue;
            }
            let (rect, _) = ui.allocate_exact_size(egui::vec2(10.0, 10.0), egui::Sense::hover());
            ui.painter().rect_filled(rect, 2.0, colour::of_model(model));
            let lines: Vec<String> = own.into_iter().filter_map(spoken).collect();
            ui.label(RichText::new(labels::model(model)).small()).on_hover_text(lines.join("\n"));
        }
    });
}

/// Whole powers of ten, few enough to be read.
fn decades(input: GridInput) -> Vec<GridMark> {
    const MAX_DECADE_MARKS: f64 = 5.0;
    let (low, high) = input.bounds;
    let step = ((high - low) / MAX_DECADE_MARKS).ceil().max(1.0);
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first).clamp(0.0, 20.0) as u32;
    (0..=count).map(|k| GridMark { value: (first + f64::from(k)) * step, step_size: step }).collect()
}

/// A power of ten as a number, or with its exponent where that is long.
fn power(exponent: f64) -> String {
    let k = exponent.round() as i32;
    if (-2..=4).contains(&k) { format::significant(10f64.powi(k), 1) } else { format!("1e{k}").replace('-', "−") }
}
