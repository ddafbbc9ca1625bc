//! The compare panel shows answers held beside the present one, and what differs in their input.

use std::sync::Arc;

use cable_core::summary::sag;
use cable_core::{Model, Scene, Solution};
use egui::{Grid, Id, Response, RichText, Ui};

use crate::command::{Command, FileCommand, ViewCommand};
use crate::jobs::background::Progress;
use crate::panels::display_names;
use crate::panels::pin_names::{PinName, pin_names};
use crate::panels::readouts::OUTDATED_FIGURE_OPACITY;
use crate::record::kept_run::Peak;
use crate::record::plotted_quantity::Measure;
use crate::render::colour::{CableQuantity, LINES};
use crate::state::dialog::Dialog;
use crate::state::{AppState, Reference};
use crate::units::sentence::sentence;
use crate::units::{format, labels};
use crate::widgets::{field, highlight, progress, readout};

/// Narrowest column of the table, points: the cross and the number of a pin fit.
const MIN_COLUMN_WIDTH: f32 = 28.0;
/// Width of the panel from which columns stand apart, points: below, they have no room to.
const MIN_WIDE_TABLE: f32 = 300.0;
/// Size of its figures, points. Larger: the last column is cut in US units.
const FIGURE_SIZE_POINTS: f32 = 12.0;
/// Most lines of difference told; more are counted.
const MAX_LINES: usize = 12;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| pin_buttons(ui, state, commands));
    every_model(ui, state, commands);
    if state.analysis.references.is_empty() {
        ui.weak("Nothing pinned. Pin a result, then change something to compare");
        return;
    }
    let names = pin_names(state);
    figures(ui, state, &names, commands);
    runs(ui, state, &names);
    for (k, (reference, name)) in state.analysis.references.iter().zip(&names).enumerate() {
        ui.weak(&name.full);
        for line in remembered(ui, k, reference, state).iter() {
            ui.label(RichText::new(line).small());
        }
    }
}

/// The buttons that pin results and take pins away.
fn pin_buttons(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let full = state.analysis.references.len() == Reference::MAX_COUNT;
    let help =
        if full { "No more can be pinned: unpin one first" } else { "Keeps this result on screen beside later ones" };
    let can = state.live.snapshot.solution.is_some() && !full;
    let pin = ui.add_enabled(can, egui::Button::new("Pin this result")).on_hover_text(help);
    highlight::register(&pin, "Pin this result");
    if pin.clicked() {
        commands.push(Command::View(ViewCommand::AddReference));
    }
    let help = "Reads a recorded run from its folder and pins it";
    if ui.add_enabled(!full, egui::Button::new("Pin a recorded run…")).on_hover_text(help).clicked() {
        let dialog = Dialog::OpenRun { path: "run".to_owned(), hold: true };
        commands.push(Command::File(FileCommand::SetDialog(Some(dialog))));
    }
    if !state.analysis.references.is_empty()
        && ui.button("Unpin all").on_hover_text("Removes every pinned result").clicked()
    {
        commands.push(Command::View(ViewCommand::RemoveReferences(None)));
    }
}

/// The table of the greatest figures: of the present answer, and of what is pinned.
fn figures(ui: &mut Ui, state: &AppState, names: &[PinName], commands: &mut Vec<Command>) {
    // An answer goes with the scene that it is of, which may not be the one being edited.
    let solved = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let answer = state.live.snapshot.solution.as_deref();
    let present = answer.map(|s| RunFigures::of(s, solved, state.live.snapshot.solve_wall_s));
    let compared = present.as_ref().filter(|_| state.is_current());
    readout::wide(ui, "compare", |ui| {
        let gap = if ui.available_width() < MIN_WIDE_TABLE { 4.0 } else { 14.0 };
        let grid = Grid::new("compare").num_columns(5).spacing([gap, 3.0]).min_col_width(MIN_COLUMN_WIDTH);
        grid.show(ui, |ui| {
            for title in ["", "Tension", "Sag", "Energy", "Cost"] {
                ui.weak(title);
            }
            ui.end_row();
            if let Some(present) = &present {
                dimmed_row_if_old(ui, state, |ui| {
                    ui.strong("Now").on_hover_text("What is on screen");
                    row(ui, present, None);
                });
                ui.end_row();
            }
            for (k, (reference, name)) in state.analysis.references.iter().zip(names).enumerate() {
                name_above(ui, k, &name.full);
                ui.end_row();
                ui.horizontal(|ui| {
                    let away = crate::widgets::icon::plain_button(ui, crate::widgets::icon::Icon::Remove);
                    field::name(&away, &format!("Unpin {}", name.full));
                    if away.on_hover_text("Unpins this result").clicked() {
                        commands.push(Command::View(ViewCommand::RemoveReferences(Some(k))));
                    }
                });
                row(ui, &RunFigures::of(&reference.solution, &reference.scene, reference.wall_s), compared);
                ui.end_row();
            }
        });
    });
}

/// Length of the line that shows the colour of a pin, points.
const SWATCH_LENGTH: f32 = 14.0;

/// The name of a pin over all columns of a grid, beside a line in the colour of its lines: that is
/// too dark for text in one theme.
fn name_above(ui: &mut Ui, k: usize, name: &str) {
    let height = ui.text_style_height(&egui::TextStyle::Body);
    let (cell, _) = ui.allocate_exact_size(egui::vec2(SWATCH_LENGTH, height), egui::Sense::hover());
    ui.painter().hline(cell.x_range(), cell.center().y, egui::Stroke::new(2.5, LINES[k % LINES.len()]));
    // The name takes no part in the widths of the columns.
    let right = egui::pos2(ui.clip_rect().right() - 2.0, cell.bottom());
    let room = egui::Rect::from_min_max(cell.right_top() + egui::vec2(4.0, 0.0), right);
    let mut over = ui.new_child(egui::UiBuilder::new().max_rect(room));
    over.add(egui::Label::new(RichText::new(name).strong()).truncate()).on_hover_text(name);
}

/// A row of a grid, dimmed while its figures are not of the scene as it is.
fn dimmed_row_if_old(ui: &mut Ui, state: &AppState, cells: impl FnOnce(&mut Ui)) {
    let before = ui.opacity();
    if !state.is_current() {
        ui.multiply_opacity(OUTDATED_FIGURE_OPACITY);
    }
    cells(ui);
    ui.set_opacity(before);
}

/// Asks every model at once, and tells why some have no answer.
fn every_model(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    if let Progress::Running(share, _) = state.analysis.models {
        let bar = progress::bar(ui, share);
        field::name(&bar, "Progress of the comparison");
        if ui.button("Cancel comparison").on_hover_text("Stops it; nothing is pinned").clicked() {
            commands.push(Command::View(ViewCommand::EndModelComparison));
        }
        return;
    }
    let help = "Solves the scene at rest with each model in turn, in the background, and pins the results: tension, sag, \
                energy and cost side by side";
    let can = state.document.fault.is_none();
    let button = ui.add_enabled(can, egui::Button::new("Compare all models")).on_hover_text(help);
    if button.on_disabled_hover_text("The scene has a fault: see Warnings").clicked() {
        commands.push(Command::View(ViewCommand::CompareModels));
    }
    match &state.analysis.models {
        Progress::Failed(why) => field::fault(ui, why),
        Progress::Done(found) if *found.scene == state.document.scene => {
            for answer in &found.answers {
                if let Err(why) = &answer.result {
                    // Most refusals begin with the model's name.
                    let why = sentence(why);
                    let name = if why.contains(labels::model(answer.model)) { "" } else { labels::model(answer.model) };
                    let colon = if name.is_empty() { "" } else { ": " };
                    ui.label(RichText::new(format!("{name}{colon}{why}")).small());
                }
            }
        }
        _ => {}
    }
}

/// The greatest of each whole run, where time ran.
fn runs(ui: &mut Ui, state: &AppState, names: &[PinName]) {
    if state.analysis.references.iter().all(|h| h.run.is_none()) {
        return;
    }
    let measures = [Measure::Cable(CableQuantity::Tension), Measure::Pull];
    let own = state.live.recording.span_s().map(|span_s| {
        let peaks =
            measures.map(|m| state.live.history.peak(m.primary_line()?).map(|[time_s, value]| Peak { time_s, value }));
        (None, (span_s, peaks, state.live.recording.events().len()))
    });
    ui.separator();
    ui.strong("Whole runs");
    readout::wide(ui, "runs", |ui| {
        Grid::new("runs").num_columns(4).spacing([10.0, 3.0]).show(ui, |ui| {
            for (title, help) in [
                ("Lasts", "From its first to its last frame"),
                ("Peak tension", "Over the whole run, and when"),
                ("Peak pull", "Of the cable on the robot's hitch, and when"),
                ("Events", "Warnings that began"),
            ] {
                ui.add(egui::Label::new(RichText::new(title).weak().size(FIGURE_SIZE_POINTS)).extend())
                    .on_hover_text(help);
            }
            ui.end_row();
            let reference = state.analysis.references.iter().enumerate();
            let reference = reference.filter_map(|(k, h)| {
                let run = h.run.as_deref()?;
                Some((Some(k), (run.span_s(), measures.map(|m| run.peak(m)), run.events)))
            });
            for (k, ([first, last], peaks, events)) in own.into_iter().chain(reference) {
                match k.and_then(|k| Some((k, names.get(k)?))) {
                    Some((k, name)) => name_above(ui, k, &name.full),
                    None => dimmed_row_if_old(ui, state, |ui| {
                        ui.strong("Now").on_hover_text("The run on screen");
                    }),
                }
                ui.end_row();
                let cells = |ui: &mut Ui| {
                    figure(ui, &format::duration(last - first), None);
                    for peak in peaks {
                        let text = peak.map_or_else(|| "–".to_owned(), |p: Peak| format::force(p.value));
                        figure(ui, &text, peak.map(|p| format!("at {:.2} s", p.time_s)));
                    }
                    figure(ui, &events.to_string(), None);
                };
                if k.is_none() {
                    dimmed_row_if_old(ui, state, cells)
                } else {
                    cells(ui)
                }
                ui.end_row();
            }
        });
    });
}

/// The answers that are compared.
struct RunFigures {
    tension_n: f64,
    sag_m: Option<f64>,
    energy_j: f64,
    wall_s: f64,
}

impl RunFigures {
    /// The figures of an answer, which took `wall_s` (s) to find.
    fn of(solution: &Solution, scene: &Scene, wall_s: f64) -> Self {
        let sags = scene
            .cables
            .iter()
            .zip(&solution.cables)
            .filter_map(|(cable, c)| sag(cable, c, scene.view))
            .map(|s| s.sag_m);
        Self {
            tension_n: solution.max_tension().tension_n,
            sag_m: sags.reduce(f64::max),
            energy_j: solution.energy.total_j(),
            wall_s,
        }
    }
}

/// A row of figures, with their differences from the present ones.
fn row(ui: &mut Ui, f: &RunFigures, present: Option<&RunFigures>) {
    cell(ui, format::force(f.tension_n), Some(f.tension_n), present.map(|p| p.tension_n));
    let sag = f.sag_m.map_or_else(|| "–".to_owned(), format::length);
    cell(ui, sag, f.sag_m, present.and_then(|p| p.sag_m));
    let energy = format::energy(f.energy_j);
    cell(ui, energy, Some(f.energy_j), present.map(|p| p.energy_j));
    cell(ui, format::rough_duration(f.wall_s), None, None);
}

/// A figure, and below it how much it is above the present one.
fn cell(ui: &mut Ui, text: String, value: Option<f64>, present: Option<f64>) {
    let share = value.zip(present).filter(|(value, present)| *present != 0.0 && value.is_finite());
    let below = share.map(|(value, present)| change(value / present - 1.0));
    if let Some(share) = figure(ui, &text, below) {
        share.on_hover_text("Against the present answer");
    }
}

/// A figure with its unit, and small words below it, which are returned.
fn figure(ui: &mut Ui, text: &str, below: Option<String>) -> Option<Response> {
    let column = ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        // Units are weaker than figures: four of them in a row were read as one string.
        let (figure, unit) = text.split_at(text.find([' ', '\u{a0}']).unwrap_or(text.len()));
        let mut words = egui::text::LayoutJob::default();
        for (part, colour) in [(figure, ui.visuals().strong_text_color()), (unit, ui.visuals().weak_text_color())] {
            words.append(part, 0.0, egui::TextFormat::simple(egui::FontId::proportional(FIGURE_SIZE_POINTS), colour));
        }
        ui.add(egui::Label::new(words).extend());
        below.map(|below| ui.add(egui::Label::new(RichText::new(below).small().weak()).extend()))
    });
    column.inner
}

/// A relative change in per cent; a change that rounds to zero has no sign.
fn change(ratio: f64) -> String {
    let text = format!("{:+.2} %", 100.0 * ratio).replace('-', "−");
    if ["+0.00 %", "−0.00 %"].contains(&text.as_str()) { "0.00 %".to_owned() } else { text }
}

/// The differences between two scenes and models.
#[derive(Clone)]
struct SceneDifferences {
    reference: Arc<Scene>,
    present: Arc<Scene>,
    models: [Option<Model>; 2],
    lines: Arc<Vec<String>>,
}

/// The differences of the last frame are reused if nothing has changed since, as writing and
/// comparing two files takes milliseconds.
fn remembered(ui: &Ui, k: usize, reference: &Reference, state: &AppState) -> Arc<Vec<String>> {
    let id = Id::unique(("differences", k));
    let models = [Some(reference.solution.model), state.live.snapshot.solution.as_ref().map(|s| s.model)];
    let last = ui.data(|d| d.get_temp::<SceneDifferences>(id));
    let fits = |t: &SceneDifferences| {
        Arc::ptr_eq(&t.reference, &reference.scene) && t.models == models && *t.present == state.document.scene
    };
    if let Some(memory) = last.filter(fits) {
        return memory.lines;
    }
    let lines = Arc::new(differences(reference, state));
    let (present, reference) = (Arc::new(state.document.scene.clone()), Arc::clone(&reference.scene));
    ui.data_mut(|d| d.insert_temp(id, SceneDifferences { reference, present, models, lines: Arc::clone(&lines) }));
    lines
}

/// Returns what differs in the input of a held answer and the present one, key by key of their
/// files; the models first.
#[must_use]
pub fn differences(reference: &Reference, state: &AppState) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(present) = &state.live.snapshot.solution
        && present.model != reference.solution.model
    {
        out.push(format!("Model: {}, now {}", labels::model(reference.solution.model), labels::model(present.model)));
    }
    out.extend(reference.scene.changes_to(&state.document.scene).iter().map(display_names::change));
    if out.is_empty() {
        out.push("Same inputs".to_owned());
    }
    if out.len() > MAX_LINES {
        let more = out.len() - MAX_LINES;
        out.truncate(MAX_LINES);
        out.push(format!("and {more} more"));
    }
    out
}
