//! The open dialog is drawn over everything else.

use std::path::{Path, PathBuf};

use cable_core::Scene;
use cable_core::scene::{Obstacle, Shape};
use egui::{Button, Context, Id, Modal, Ui};

use crate::app::path_picker::{self, PathPurpose};
use crate::command::{Command, FileCommand};
use crate::state::AppState;
use crate::state::dialog::{Dialog, SceneReplacement};

/// Draws the dialog, if one is open.
pub fn ui(ctx: &Context, state: &mut AppState, commands: &mut Vec<Command>) {
    // It is put back below: meanwhile the state can be read.
    let Some(mut open) = state.ui.dialog.take() else { return };
    let dialog = &mut open;
    let response = Modal::new(Id::unique("dialog")).show(ctx, |ui| {
        ui.set_max_width(460.0);
        match dialog {
            Dialog::Message { title, text } => message(ui, title, text, commands),
            Dialog::Open { path } => ask_path(ui, "Open a scene", path, PathPurpose::Open, commands),
            Dialog::SaveAs { path } => ask_path(ui, "Save the scene as", path, PathPurpose::Save, commands),
            Dialog::Export { path, sheet } => {
                ui.heading("Export the part of the graph in view");
                ui.add_space(6.0);
                format(ui, path, &[CSV, SVG, PNG]);
                let note = "CSV has every sample in view in SI units; SVG and PNG are drawings of it";
                if let Some(path) = ask(ui, &save("Ends in .csv, .svg or .png", note), path, commands) {
                    commands.push(Command::File(FileCommand::Export(path, sheet.clone())));
                }
            }
            Dialog::ExportPicture { path } => {
                let note = "The canvas as it is in view, with its legend and the greatest tension above it";
                ui.heading("Export the canvas as a picture");
                ui.add_space(6.0);
                format(ui, path, &[PNG, SVG]);
                if let Some(path) = ask(ui, &save("Ends in .png or .svg", note), path, commands) {
                    commands.push(Command::File(FileCommand::ExportPicture(path)));
                }
            }
            Dialog::SaveRun { path } => {
                let note = "The scene and the tables history.csv, nodes.csv and events.csv, in a folder that is new, empty or of an earlier run, which is replaced once the new one is whole";
                let question = PathQuestion { title: "Save what was recorded", ..save("A folder", note) };
                if let Some(path) = ask(ui, &question, path, commands) {
                    commands.push(Command::File(FileCommand::SaveRun(path)));
                }
            }
            Dialog::OpenRun { path, hold } => {
                let title = if *hold { "Pin a recorded run to compare with" } else { "Open a run" };
                let note = "A folder with scene.toml, history.csv, nodes.csv and events.csv, as this window and cable run write them";
                let question = PathQuestion { title, purpose: PathPurpose::Open, hint: "A folder", note };
                if let Some(path) = ask(ui, &question, path, commands) {
                    let command = if *hold { FileCommand::AddReferenceRun(path) } else { FileCommand::OpenRun(path) };
                    commands.push(Command::File(command));
                }
            }
            Dialog::Feedback { answers, path } => crate::app::feedback_form::ui(ui, answers, path, commands),
            Dialog::StartHere => crate::app::guidance::welcome_dialog::ui(ui, &state.ui.recent, commands),
            Dialog::About => about(ui, commands),
            Dialog::Palette { text } => crate::app::palette::ui(ui, text, state, commands),
            Dialog::ImportMap { path, text, unit_m } => {
                import_map(ui, [path, text, unit_m], &grounds(&state.document.scene), commands)
            }
            Dialog::Unsaved { then } => unsaved(ui, &state.document.scene.name, then, commands),
            Dialog::Recover { scene } => recover(ui, scene, commands),
            Dialog::Help => help(ui, commands),
        }
    });
    state.ui.dialog = Some(open);
    if response.should_close() {
        commands.push(close());
    }
}

fn close() -> Command {
    Command::File(FileCommand::SetDialog(None))
}

/// A message with a button that closes it.
fn message(ui: &mut Ui, title: &str, text: &str, commands: &mut Vec<Command>) {
    ui.heading(title);
    ui.add_space(6.0);
    ui.label(text);
    ui.add_space(10.0);
    if ui.button("Close").clicked() {
        commands.push(close());
    }
}

/// A dialog that asks for a path is typed into without a click first.
fn typed_at_once(ui: &Ui, field: &egui::Response) {
    if ui.memory(|m| m.focused().is_none()) && !field.lost_focus() {
        field.request_focus();
    }
}

/// A kind of file: its name, its ending and what it is.
type Format = (&'static str, &'static str, &'static str);
const CSV: Format = ("CSV", "csv", "A table of numbers");
const SVG: Format = ("SVG", "svg", "A drawing that stays sharp at any size");
const PNG: Format = ("PNG", "png", "A picture");

/// The format of an exported graph, which is the ending of its path.
fn format(ui: &mut Ui, path: &mut String, formats: &[Format]) {
    ui.horizontal(|ui| {
        ui.label("Format");
        for &(name, ending, help) in formats {
            let typed = Path::new(path.trim());
            let on = typed.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
            let named = typed.file_stem().is_some();
            if ui.add_enabled(named, Button::selectable(on, name)).on_hover_text(help).clicked() {
                *path = typed.with_extension(ending).display().to_string();
            }
        }
    });
}

/// A question for a path.
struct PathQuestion<'a> {
    /// Its heading; empty: none.
    title: &'a str,
    /// The use of the path.
    purpose: PathPurpose,
    /// Help in the empty field.
    hint: &'a str,
    /// A sentence below it.
    note: &'a str,
}

/// A question for a path to save at, without a heading.
fn save<'a>(hint: &'a str, note: &'a str) -> PathQuestion<'a> {
    PathQuestion { title: "", purpose: PathPurpose::Save, hint, note }
}

/// A path to type; some once it is entered.
fn ask(ui: &mut Ui, question: &PathQuestion<'_>, path: &mut String, commands: &mut Vec<Command>) -> Option<PathBuf> {
    if !question.title.is_empty() {
        ui.heading(question.title);
        ui.add_space(6.0);
    }
    let mut done = false;
    ui.horizontal(|ui| {
        let label = ui.label("Path");
        let field = egui::TextEdit::singleline(path).desired_width(320.0).hint_text(question.hint);
        let field = ui.add(field).labelled_by(label.id).on_hover_text(question.hint);
        typed_at_once(ui, &field);
        done |= field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    });
    path_picker::list(ui, path, &[], question.purpose);
    ui.weak(question.note);
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        done |= ui.button(question.purpose.verb()).clicked();
        if ui.button("Cancel").clicked() {
            commands.push(close());
        }
    });
    (done && !path.trim().is_empty()).then(|| PathBuf::from(path.trim()))
}

/// The names of what is ground in a scene, in quotation marks.
fn grounds(scene: &Scene) -> Vec<String> {
    let ground = |o: &&Obstacle| matches!(o.shape, Shape::Terrain { .. });
    scene.obstacles.iter().filter(ground).map(|o| format!("“{}”", o.name)).collect()
}

/// Asks for a map to read, and whether it is to be added or to replace the ground.
fn import_map(ui: &mut Ui, [path, text, unit_m]: [&mut String; 3], grounds: &[String], commands: &mut Vec<Command>) {
    ui.heading("Import terrain and beams");
    ui.add_space(6.0);
    ui.weak("A table of x and y (tab, comma, semicolon; decimal comma) or an SVG with paths. Open lines become ground, closed shapes become beams.");
    ui.horizontal(|ui| {
        let label = ui.label("File");
        ui.add(egui::TextEdit::singleline(path).desired_width(320.0)).labelled_by(label.id);
    });
    egui::CollapsingHeader::new("Pick a file").show_unindented(ui, |ui| {
        path_picker::list(ui, path, &["csv", "tsv", "txt", "dat", "svg"], PathPurpose::Open);
    });
    let label = ui.label("or paste it here");
    egui::ScrollArea::vertical().max_height(160.0).show(ui, |ui| {
        ui.add(egui::TextEdit::multiline(text).desired_rows(6).desired_width(f32::INFINITY).code_editor())
            .labelled_by(label.id);
    });
    ui.horizontal(|ui| {
        let label = ui.label("1 unit =");
        ui.add(egui::TextEdit::singleline(unit_m).desired_width(70.0)).labelled_by(label.id);
        ui.label("m");
    });
    let unit = unit_m.trim().replacen(',', ".", 1).parse::<f64>().ok().filter(|u| *u > 0.0 && u.is_finite());
    if unit.is_none() {
        ui.colored_label(ui.visuals().error_fg_color, "Type a length above 0");
    }
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        let ready = !path.trim().is_empty() || !text.trim().is_empty();
        let [adds, replaces] = [false, true];
        let mut import = |ui: &mut Ui, name: &str, help: &str, replaces_ground: bool| {
            let button = ui.add_enabled(ready && unit.is_some(), Button::new(name)).on_hover_text(help);
            if let (true, Some(unit_m)) = (button.clicked(), unit) {
                let path = (!path.trim().is_empty()).then(|| PathBuf::from(path.trim()));
                let text = text.clone();
                commands.push(Command::File(FileCommand::ImportMap { path, text, unit_m, replaces_ground }));
            }
        };
        if grounds.is_empty() {
            import(ui, "Import", "Adds it to the scene", adds);
        } else {
            // Two grounds at once are hardly ever meant.
            let help = format!("Takes out {} for the ground that is read; beams and posts stay", grounds.join(", "));
            import(ui, "Replace the ground", &help, replaces);
            import(ui, "Add to the scene", "Keeps the ground that is there, and adds to it", adds);
        }
        if ui.button("Cancel").clicked() {
            commands.push(close());
        }
    });
}

/// Lets contents that may be taller than the window scroll; heading and buttons stay in sight.
fn scrollable(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    /// Of heading, buttons and margins, points.
    const DIALOG_CHROME_HEIGHT: f32 = 130.0;
    let most = (ui.ctx().content_rect().height() - DIALOG_CHROME_HEIGHT).max(60.0);
    ui.scope(|ui| {
        ui.spacing_mut().scroll = egui::style::ScrollStyle::solid();
        // Else it grows by a line a frame.
        egui::ScrollArea::vertical().max_height(most).min_scrolled_height(most).show(ui, contents);
    });
}

/// Lists what was checked and what was not.
fn about(ui: &mut Ui, commands: &mut Vec<Command>) {
    ui.heading("About the cable simulator");
    ui.weak(format!("Version {}; MIT or Apache-2.0", env!("CARGO_PKG_VERSION")));
    scrollable(ui, |ui| {
        for (title, lines) in ABOUT {
            ui.add_space(8.0);
            ui.strong(*title);
            for line in *lines {
                ui.horizontal_top(|ui| {
                    ui.label("•");
                    ui.add(egui::Label::new(*line).wrap());
                });
            }
        }
    });
    ui.add_space(10.0);
    if ui.button("Close").clicked() {
        commands.push(close());
    }
}

/// As the tests of the project have it.
const ABOUT: &[(&str, &[&str])] = &[
    (
        "Checked",
        &[
            "Free spans against the elastic catenary, worked out with 40 digits",
            "Whole scenes over floors, beams and posts against references from a separate method (shooting)",
            "Motion against closed forms: pendulums, falling and hanging chains, strings, Irvine’s modes, the capstan",
            "Breaking at the time and place predicted from the strain",
            "The robot’s speed, stall and slip against its balance of forces by hand",
            "Its models against each other",
        ],
    ),
    (
        "Not checked",
        &[
            "Nothing was compared with a test of a real cable or robot: it is not certified",
            "Figures of presets marked ≈ or C are estimates; the bending stiffness of rubber cables is known only to within a factor of about 10",
            "Everything is 2D: no cable passes sideways round anything, and knots cannot be detected",
            "The robot’s outline is an obstacle for its cable with FEM only; its drive curve is an assumption",
            "The accuracy of violent motion (ends thrown metres in a frame): only that it does not fail was checked",
            "Mass-spring over sharp corners: its tension swings there by a third and more, and the answer says by how much",
            "Contact of the cable with itself works with FEM only, and not in scenes with eyes, or with wheels that are released or dragged",
            "Safe reach assumes slow motion and tests places on a grid: jerks, and places in between, are not covered",
            "With friction there are many resting places; one way of laying is computed",
        ],
    ),
];

/// A path to type or to pick.
fn ask_path(ui: &mut Ui, title: &str, path: &mut String, purpose: PathPurpose, commands: &mut Vec<Command>) {
    ui.heading(title);
    ui.add_space(6.0);
    let mut done = false;
    ui.horizontal(|ui| {
        let label = ui.label("Path");
        let field = ui.add(egui::TextEdit::singleline(path).desired_width(320.0)).labelled_by(label.id);
        typed_at_once(ui, &field);
        done |= field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        path_picker::system(ui, path, purpose);
    });
    done |= path_picker::list(ui, path, &["toml"], purpose) && purpose == PathPurpose::Open;
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        done |= ui.button(if purpose == PathPurpose::Save { "Save" } else { "Open" }).clicked();
        if ui.button("Cancel").clicked() {
            commands.push(close());
        }
    });
    if done && !path.trim().is_empty() {
        let path = PathBuf::from(path.trim());
        commands.push(Command::File(match purpose {
            PathPurpose::Open => FileCommand::Open(path),
            PathPurpose::Save => FileCommand::SaveAs(path),
        }));
    }
}

/// Asks whether to save before the scene is replaced.
fn unsaved(ui: &mut Ui, name: &str, then: &SceneReplacement, commands: &mut Vec<Command>) {
    ui.heading("Unsaved changes");
    ui.add_space(6.0);
    ui.label(format!("“{name}” has changes that are not saved."));
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        if ui.button("Save…").clicked() {
            commands.push(close());
            commands.push(Command::File(FileCommand::SaveThen(then.clone())));
        }
        if ui.button("Discard changes").clicked() {
            commands.push(Command::File(FileCommand::Discard(then.clone())));
        }
        if ui.button("Cancel").clicked() {
            commands.push(close());
        }
    });
}

/// Asks whether to recover the scene of a window that ended unexpectedly.
fn recover(ui: &mut Ui, scene: &cable_core::Scene, commands: &mut Vec<Command>) {
    ui.heading("Recover unsaved changes");
    ui.add_space(6.0);
    let name = if scene.name.is_empty() { "Untitled scene" } else { &scene.name };
    ui.label(format!("The program closed unexpectedly. Unsaved changes to “{name}” have been kept."));
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        if ui.button("Recover").on_hover_text("Opens them; nothing is overwritten").clicked() {
            commands.push(Command::File(FileCommand::Recover(Box::new(scene.clone()))));
        }
        if ui.button("Discard").on_hover_text("They cannot be recovered later").clicked() {
            commands.push(Command::File(FileCommand::ForgetRecovery));
        }
        if ui.button("Ask next time").clicked() {
            commands.push(close());
        }
    });
}

/// The table of what pointer and keys do; docs/controls.md has the same one.
const CONTROLS: [(&str, &str); 28] = [
    ("Drag a support, waypoint or corner", "Moves it; the cable follows"),
    ("Drag an obstacle", "Moves all of it; click it to see its corners"),
    ("Double-click the cable", "Adds a waypoint"),
    ("Shift+click, Shift+drag", "Selects several items; draws a frame round them"),
    ("Drag the head of a load's arrow", "Sets its force"),
    ("Double-click the ground", "Adds a leg to the robot's path; drag its flag to move it"),
    ("Drag the background", "Moves the view"),
    ("Wheel", "Zooms at the pointer, in graphs too"),
    ("+, −, Shift+arrows", "Zooms about the middle; moves the view"),
    ("Click the cable", "Breaks down the tension there"),
    ("Drag in a graph over time", "Moves the playhead; in a zoomed graph the view"),
    ("Click in a graph", "Sets a cursor; a second one shows the difference"),
    ("Tab, Enter, Esc", "Next control; presses it; back to the canvas"),
    ("Left, right in a graph", "Moves its cursor; with Shift, moves the view"),
    ("Up, down, Enter in a graph", "Zooms; sets another cursor"),
    ("F, C", "Fits the scene, recentres on the cable"),
    ("[, ], G", "Shows or hides outline, selection and results, graphs"),
    ("Space", "Play or pause"),
    ("Arrow right, left", "One step of 1/60 s forward; one frame back"),
    ("Hold A, D", "Drives the robot left, right"),
    ("R", "Back to the start"),
    ("Del", "Removes what is selected"),
    ("Ctrl+Z, Ctrl+Shift+Z", "Undo, redo"),
    ("N, Shift+N, M", "Next item, previous one; M adds the next to the selection"),
    ("Alt+arrows", "Moves the selection by one grid spacing"),
    ("Ctrl+C, X, V, A", "Copy, cut, paste, select everything"),
    ("Ctrl+N, Ctrl+O, Ctrl+S", "New, open, save"),
    ("Ctrl+P", "Every command, by name"),
];

/// The table of pointer and keys.
fn help(ui: &mut Ui, commands: &mut Vec<Command>) {
    ui.heading("Pointer and keys");
    ui.add_space(6.0);
    scrollable(ui, |ui| {
        egui::Grid::new("keys").num_columns(2).spacing([24.0, 4.0]).show(ui, |ui| {
            for (what, does) in CONTROLS {
                ui.strong(what);
                ui.label(does);
                ui.end_row();
            }
        });
    });
    ui.add_space(10.0);
    if ui.button("Close").clicked() {
        commands.push(close());
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_page_of_controls_lists_what_the_window_lists() {
        let page = include_str!("../../../../docs/controls.md");
        let rows: Vec<String> = super::CONTROLS.iter().map(|(what, does)| format!("| {what} | {does} |")).collect();
        let listed: Vec<&str> = page.lines().filter(|l| l.starts_with("| ")).skip(1).collect();
        assert_eq!(rows, listed);
    }
}
