//! Commands about files, scenes to open, dialogs and the window.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use cable_core::Scene;
use cable_core::files::{RunEnd, RunFolder};
use cable_core::record::{NodeChoice, RunRequest};
use cable_core::scene::catalog;

use crate::app::tutorials::{GUIDES, Place};
use crate::command::{Command, Effects, SceneCommand, import, submit_scene};
use crate::io::feedback;
use crate::io::feedback::Answers;
use crate::io::graph_file;
use crate::io::graph_file::Sheet;
use crate::io::scene_file;
use crate::record::run;
use crate::record::run::Run;
use crate::record::samples::Sample;
use crate::state::dialog::Dialog;
use crate::state::{AppState, Held};

/// Files and the window.
#[derive(Clone, Debug, PartialEq)]
pub enum FileCommand {
    /// Asks which file to open.
    AskOpen,
    /// Opens a file; on an error the present scene stays.
    Open(PathBuf),
    /// Opens a catalogue scene by its short id.
    OpenCatalogue(String),
    /// Opens the scene of a guide and leads through it.
    OpenGuide(usize),
    /// Saves where it came from, else asks where to.
    Save,
    /// Asks where to save.
    AskSaveAs,
    /// Saves to a file.
    SaveAs(PathBuf),
    /// Writes what was in view of a graph.
    Export(PathBuf, Box<Sheet>),
    /// Adds terrain and beams read from a file, or from a text.
    ImportMap {
        /// The file; None: the text.
        path: Option<PathBuf>,
        /// What was pasted.
        text: String,
        /// Length of a unit of it, m.
        unit_m: f64,
    },
    /// Adds what the user thinks to a table.
    SaveFeedback(PathBuf, Answers),
    /// Writes everything recorded as a run folder.
    SaveRun(PathBuf),
    /// Opens the folder of a run: its scene, and all it recorded.
    OpenRun(PathBuf),
    /// Holds the run of a folder to compare with.
    HoldRun(PathBuf),
    /// Shows a dialog, or closes it.
    SetDialog(Option<Dialog>),
    /// Takes over what a window that died had kept.
    Recover(Box<Scene>),
    /// Removes it.
    ForgetRecovery,
    /// Goes on without saving.
    Discard(Box<Command>),
    /// Starts the solver thread anew after it died.
    RestartWorker,
    /// Closes the window.
    Quit,
}

/// Does one of them.
pub fn apply(state: &mut AppState, command: FileCommand, effects: &mut Effects) {
    if replaces_scene(&command) && state.unsaved() {
        state.dialog = Some(Dialog::Unsaved { then: Box::new(Command::File(command)) });
        return;
    }
    carry_out(state, command, effects);
}

fn carry_out(state: &mut AppState, command: FileCommand, effects: &mut Effects) {
    match command {
        FileCommand::AskOpen => state.dialog = Some(Dialog::Open { path: path_text(state) }),
        FileCommand::AskSaveAs => state.dialog = Some(Dialog::SaveAs { path: path_text(state) }),
        FileCommand::Open(path) => match scene_file::load(&path) {
            Ok(scene) => open(state, scene, Some(path), effects),
            Err(text) => complain(state, &format!("“{}” was not opened", path.display()), text),
        },
        FileCommand::OpenCatalogue(id) => {
            if let Some((_, scene)) = catalog::all().into_iter().find(|(k, _)| *k == id) {
                open(state, scene, None, effects);
            }
        }
        FileCommand::OpenGuide(index) => {
            let Some(guide) = GUIDES.get(index) else { return };
            carry_out(state, FileCommand::OpenCatalogue(guide.scene.to_owned()), effects);
            state.guide = Some(Place { guide: index, step: 0 });
        }
        FileCommand::Save => match state.document.path.clone() {
            Some(path) => save(state, &path),
            None => state.dialog = Some(Dialog::SaveAs { path: path_text(state) }),
        },
        FileCommand::SaveAs(path) => save(state, &path),
        FileCommand::Export(path, sheet) => match graph_file::save(&path, &sheet) {
            Ok(()) => state.dialog = None,
            Err(text) => complain(state, &format!("“{}” was not written", path.display()), text),
        },
        FileCommand::ImportMap { path, text, unit_m } => {
            match import::add(&state.scene, path.as_deref(), &text, unit_m) {
                Ok((scene, report)) => {
                    crate::command::apply(state, Command::Scene(SceneCommand::SetScene(Box::new(scene))), effects);
                    state.camera.fit_wanted = true;
                    state.dialog = Some(Dialog::Message { title: "Imported".to_owned(), text: report });
                }
                Err(text) => complain(state, "The map was not imported", text),
            }
        }
        FileCommand::SaveFeedback(path, answers) => match feedback::save(&path, &answers, state) {
            Ok(()) => state.dialog = None,
            Err(text) => complain(state, &format!("“{}” was not written", path.display()), text),
        },
        FileCommand::SaveRun(path) => match save_run(state, &path) {
            Ok(()) => state.dialog = None,
            Err(text) => complain(state, &format!("The run was not written to “{}”", path.display()), text),
        },
        FileCommand::OpenRun(path) => match run::open(&path) {
            Ok(opened) => {
                open(state, opened.scene, None, effects);
                state.reopened = opened.answers;
                remark(state, &path, &opened.remarks);
            }
            Err(text) => complain(state, &format!("The run “{}” was not opened", path.display()), text),
        },
        FileCommand::HoldRun(path) => match run::open(&path) {
            Ok(opened) => hold(state, &path, opened),
            Err(text) => complain(state, &format!("The run “{}” was not opened", path.display()), text),
        },
        FileCommand::SetDialog(dialog) => state.dialog = dialog,
        FileCommand::Recover(scene) => {
            open(state, *scene, None, effects);
            state.document.recovered = true;
        }
        FileCommand::ForgetRecovery => {
            state.dialog = None;
            effects.forget_recovery = true;
        }
        FileCommand::Discard(then) => {
            state.dialog = None;
            match *then {
                Command::File(command) => carry_out(state, command, effects),
                other => crate::command::apply(state, other, effects),
            }
        }
        FileCommand::RestartWorker => {
            effects.restart_worker = true;
            submit_scene(state, true, effects);
        }
        FileCommand::Quit => {
            state.closing = true;
            effects.quit = true;
        }
    }
}

fn replaces_scene(command: &FileCommand) -> bool {
    matches!(
        command,
        FileCommand::Open(_)
            | FileCommand::OpenRun(_)
            | FileCommand::OpenCatalogue(_)
            | FileCommand::OpenGuide(_)
            | FileCommand::Quit
    )
}

fn open(state: &mut AppState, scene: Scene, path: Option<PathBuf>, effects: &mut Effects) {
    let fresh = AppState::new(scene, path);
    state.scene = fresh.scene;
    state.scene_fault = fresh.scene_fault;
    state.document = fresh.document;
    state.undo = fresh.undo;
    (state.selected, state.also) = (None, Vec::new());
    (state.hovered, state.probe) = (None, None);
    state.playback.paused = true;
    state.robot_order = None;
    state.reopened = Vec::new();
    state.guide = None;
    state.reach = crate::jobs::safe_reach::View::default();
    effects.reach = Some(None);
    state.models = crate::jobs::model_comparison::Progress::None;
    effects.models = Some(None);
    effects.request.robot = Some(None);
    state.camera.fit_wanted = true;
    state.dialog = None;
    submit_scene(state, true, effects);
}

/// Says what a user should know about a run that was opened.
fn remark(state: &mut AppState, path: &Path, remarks: &[String]) {
    if !remarks.is_empty() {
        complain(state, &format!("About the run “{}”", path.display()), remarks.join(" "));
    }
}

fn hold(state: &mut AppState, path: &Path, opened: run::Opened) {
    let samples: Vec<Sample> = opened.answers.iter().map(Sample::of).collect();
    let events = opened.answers.iter().map(|a| a.warnings.len()).sum();
    let run = Run::of(samples.iter(), &opened.answers, events).map(Arc::new);
    state.dialog = None;
    remark(state, path, &opened.remarks);
    if let (Some(solution), true) = (opened.answers.into_iter().next_back(), state.held.len() < Held::MOST) {
        let name = format!("{}, {}, {:.2} s", opened.scene.name, path.display(), solution.time_s);
        let (scene, solution) = (Arc::new(opened.scene), Arc::new(solution));
        state.held.push(Held { name, scene, solution, wall_s: f64::NAN, run });
    }
}

fn save(state: &mut AppState, path: &Path) {
    match scene_file::save(path, &state.scene) {
        Ok(()) => {
            state.document.path = Some(path.to_owned());
            state.document.saved = state.scene.clone();
            state.document.recovered = false;
            state.dialog = None;
        }
        Err(text) => complain(state, &format!("“{}” was not saved", path.display()), text),
    }
}

fn save_run(state: &AppState, path: &Path) -> Result<(), String> {
    let scene = state.live.scene.as_deref().ok_or("nothing was solved yet")?;
    let request =
        RunRequest { program: format!("cable-viewer {}", env!("CARGO_PKG_VERSION")), ..RunRequest::default() };
    let mut folder = RunFolder::create(path, scene, request, NodeChoice::default()).map_err(|e| e.to_string())?;
    for answer in state.recording.answers() {
        if let Err(e) = folder.push(answer) {
            let why = e.to_string();
            // The tables are readable and marked as partial already, whether this can be noted or not.
            let _ = folder.finish(RunEnd::Partial(why.clone()));
            return Err(why);
        }
    }
    folder.finish(RunEnd::Complete).map(|_| ()).map_err(|e| e.to_string())
}

fn complain(state: &mut AppState, title: &str, text: String) {
    state.dialog = Some(Dialog::Message { title: title.to_owned(), text });
}

fn path_text(state: &AppState) -> String {
    state.document.path.as_ref().map_or_else(|| "scene.toml".to_owned(), |p| p.display().to_string())
}
