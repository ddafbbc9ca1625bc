//! File commands concern files, scenes to open, dialogs and the window.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use cable_core::Scene;
use cable_core::files::{RunEnd, RunFolder};
use cable_core::record::{NodeChoice, RunRequest, RunStop};
use cable_core::scene::catalog;

use crate::command::effects::{Effects, submit_new_scene};
use crate::command::import;
use crate::command::scene::{self, SceneCommand};
use crate::io::feedback::{self, Answers};
use crate::io::graph_file;
use crate::io::graph_in_view::GraphInView;
use crate::io::saved_run::{OpenedRun, read_run};
use crate::io::scene_file;
use crate::record::kept_run::KeptRun;
use crate::record::sample::Sample;
use crate::state::dialog::{Dialog, SceneReplacement};
use crate::state::live::ReopenedRun;
use crate::state::tutorial_place::TutorialPlace;
use crate::state::{AppState, Document, Reference};

/// Files and the window.
#[derive(Clone, Debug, PartialEq)]
pub enum FileCommand {
    /// A scene with one cable and nothing else.
    New,
    /// Asks which file to open.
    AskOpen,
    /// Opens a file; on an error the present scene stays.
    Open(PathBuf),
    /// Opens a catalogue scene by its short id.
    OpenCatalogue(String),
    /// Opens the scene of a tutorial and leads through it.
    OpenTutorial {
        /// Index of the tutorial.
        tutorial: usize,
        /// Short id of its scene.
        scene: &'static str,
    },
    /// Saves to the file of the scene; asks for one if there is none.
    Save,
    /// Saves, asking for a file if need be, and then does the pending action.
    SaveThen(SceneReplacement),
    /// Asks where to save.
    AskSaveAs,
    /// Saves to a file.
    SaveAs(PathBuf),
    /// Writes what was in view of a graph.
    Export(PathBuf, Box<GraphInView>),
    /// Asks where to draw the canvas to.
    AskExportPicture,
    /// Draws the canvas with its legend to a file.
    ExportPicture(PathBuf),
    /// Adds terrain and beams read from a file, or from a text.
    ImportMap {
        /// The file; None: the text.
        path: Option<PathBuf>,
        /// The text that was pasted.
        text: String,
        /// Length of a unit of it, m.
        unit_m: f64,
        /// The map takes the place of the ground that is there.
        replaces_ground: bool,
    },
    /// Adds the user's feedback to a table.
    SaveFeedback(PathBuf, Answers),
    /// Writes the whole recording as a run folder.
    SaveRun(PathBuf),
    /// Opens the folder of a run: its scene and its recording.
    OpenRun(PathBuf),
    /// Pins the run of a folder for comparison.
    AddReferenceRun(PathBuf),
    /// Shows a dialog, or closes it.
    SetDialog(Option<Dialog>),
    /// Opens the scene that a window which died had kept.
    Recover(Box<Scene>),
    /// Removes the recovery file.
    ForgetRecovery,
    /// Goes on without saving.
    Discard(SceneReplacement),
    /// Starts the solver thread anew after it died.
    RestartWorker,
    /// Closes the window.
    Quit,
}

/// Applies a file command.
pub fn apply(state: &mut AppState, command: FileCommand, effects: &mut Effects) {
    if let Some(then) = command.replacement().filter(|_| state.document.unsaved()) {
        state.ui.dialog = Some(Dialog::Unsaved { then });
        return;
    }
    execute(state, command, effects);
}

/// Closes the dialog and names the file that was written.
fn written(state: &mut AppState, path: PathBuf) {
    (state.ui.dialog, state.ui.written) = (None, Some(path));
}

/// Shows a message that a file was written, or why it was not.
pub fn exported(state: &mut AppState, path: PathBuf, result: Result<(), String>) {
    match result {
        Ok(()) => written(state, path),
        Err(text) => {
            // The dialog opens again with the path that was typed.
            let asked = state.ui.dialog.take();
            show_error(state, &format!("“{}” was not written", path.display()), text);
            state.ui.after_message = asked;
        }
    }
}

/// Executes a file command that needs no confirmation.
fn execute(state: &mut AppState, command: FileCommand, effects: &mut Effects) {
    match command {
        FileCommand::New => {
            // Pins do not belong to a new scene, although neither has a file.
            state.analysis.references.clear();
            open(state, new_scene(), None, effects);
        }
        FileCommand::AskOpen => state.ui.dialog = Some(Dialog::Open { path: path_text(state) }),
        FileCommand::AskSaveAs => state.ui.dialog = Some(Dialog::SaveAs { path: path_text(state) }),
        FileCommand::Open(path) => open_file(state, path, effects),
        FileCommand::OpenCatalogue(id) => {
            if let Some((_, scene)) = catalog::all().into_iter().find(|(k, _)| *k == id) {
                open(state, scene, None, effects);
            }
        }
        FileCommand::OpenTutorial { tutorial, scene } => {
            execute(state, FileCommand::OpenCatalogue(scene.to_owned()), effects);
            state.ui.tutorial = Some(TutorialPlace { tutorial, step: 0 });
        }
        FileCommand::Save => match state.document.path.clone() {
            Some(path) => save(state, &path, effects),
            None => state.ui.dialog = Some(Dialog::SaveAs { path: path_text(state) }),
        },
        FileCommand::SaveAs(path) => save(state, &path, effects),
        FileCommand::SaveThen(then) => {
            state.ui.after_save = Some(then);
            execute(state, FileCommand::Save, effects);
        }
        FileCommand::Export(path, sheet) => {
            let result = graph_file::save(&path, &sheet);
            exported(state, path, result);
        }
        FileCommand::AskExportPicture => {
            let path = Path::new(&path_text(state)).with_extension("png").display().to_string();
            execute(state, FileCommand::SetDialog(Some(Dialog::ExportPicture { path })), effects);
        }
        FileCommand::ExportPicture(path) => effects.picture = Some(path),
        FileCommand::ImportMap { path, text, unit_m, replaces_ground } => {
            let read = import::Map { path: path.as_deref(), text: &text, unit_m, replaces_ground };
            import_map(state, &read, effects);
        }
        FileCommand::SaveFeedback(path, answers) => match feedback::save(&path, &answers, &feedback_context(state)) {
            Ok(()) => state.ui.dialog = None,
            Err(text) => show_error(state, &format!("“{}” was not written", path.display()), text),
        },
        FileCommand::SaveRun(path) => match save_run(state, &path) {
            Ok(()) => written(state, path),
            Err(text) => show_error(state, &format!("The run was not written to “{}”", path.display()), text),
        },
        FileCommand::OpenRun(path) => open_run(state, &path, effects),
        FileCommand::AddReferenceRun(path) => match read_run(&path) {
            Ok(opened) => pin_run(state, &path, opened),
            Err(text) => show_error(state, &format!("The run “{}” was not opened", path.display()), text),
        },
        FileCommand::SetDialog(dialog) => set_dialog(state, dialog),
        FileCommand::Recover(scene) => {
            open(state, *scene, None, effects);
            state.document.recovered = true;
        }
        FileCommand::ForgetRecovery => {
            state.ui.dialog = None;
            effects.forget_recovery = true;
        }
        FileCommand::Discard(then) => {
            state.ui.dialog = None;
            execute(state, then.into(), effects);
        }
        FileCommand::RestartWorker => {
            effects.restart_worker = true;
            submit_new_scene(state, effects);
        }
        FileCommand::Quit => {
            state.ui.closing = true;
            effects.quit = true;
        }
    }
}

/// Opens the scene of a file.
fn open_file(state: &mut AppState, path: PathBuf, effects: &mut Effects) {
    match scene_file::load(&path) {
        Ok(scene) => open(state, scene, Some(path), effects),
        Err(text) => show_error(state, &format!("“{}” was not opened", path.display()), text),
    }
}

/// Opens the scene of a recorded run, with its answers.
fn open_run(state: &mut AppState, path: &Path, effects: &mut Effects) {
    match read_run(path) {
        Ok(opened) => {
            open(state, opened.scene, None, effects);
            state.live.reopened_run = Some(ReopenedRun { answers: opened.answers, wall_time_s: opened.wall_time_s });
            remark(state, path, &opened.remarks);
        }
        Err(text) => show_error(state, &format!("The run “{}” was not opened", path.display()), text),
    }
}

/// Adds the obstacles of a map to the scene and reports what was added.
fn import_map(state: &mut AppState, read: &import::Map<'_>, effects: &mut Effects) {
    match import::add(&state.document.scene, read) {
        Ok((scene, report)) => {
            scene::apply(state, SceneCommand::SetScene(Box::new(scene)), effects);
            state.view.camera.fit_wanted = true;
            state.ui.dialog = Some(Dialog::Message { title: "Imported".to_owned(), text: report });
        }
        Err(text) => show_error(state, "The map was not imported", text),
    }
}

/// Opens a dialog, or closes it: then the one that waited behind a message opens again.
fn set_dialog(state: &mut AppState, dialog: Option<Dialog>) {
    if dialog.is_some() {
        (state.ui.written, state.ui.graph_to_export) = (None, None);
    }
    let message = matches!(state.ui.dialog, Some(Dialog::Message { .. }));
    let then = state.ui.after_message.take().filter(|_| message && dialog.is_none());
    state.ui.dialog = dialog.or(then);
    if state.ui.dialog.is_none() {
        // An action that was to follow a cancelled save must not follow a later one.
        state.ui.after_save = None;
    }
}

impl FileCommand {
    /// Returns the replacement of the present scene; None: the scene stays.
    fn replacement(&self) -> Option<SceneReplacement> {
        Some(match self {
            Self::New => SceneReplacement::New,
            Self::Open(path) => SceneReplacement::Open(path.clone()),
            Self::OpenRun(path) => SceneReplacement::OpenRun(path.clone()),
            Self::OpenCatalogue(id) => SceneReplacement::OpenCatalogue(id.clone()),
            &Self::OpenTutorial { tutorial, scene } => SceneReplacement::OpenTutorial { tutorial, scene },
            Self::Quit => SceneReplacement::Quit,
            _ => return None,
        })
    }
}

impl From<SceneReplacement> for FileCommand {
    fn from(action: SceneReplacement) -> Self {
        match action {
            SceneReplacement::New => Self::New,
            SceneReplacement::Open(path) => Self::Open(path),
            SceneReplacement::OpenRun(path) => Self::OpenRun(path),
            SceneReplacement::OpenCatalogue(id) => Self::OpenCatalogue(id),
            SceneReplacement::OpenTutorial { tutorial, scene } => Self::OpenTutorial { tutorial, scene },
            SceneReplacement::Quit => Self::Quit,
        }
    }
}

/// One cable between two points.
fn new_scene() -> Scene {
    Scene { name: "New scene".to_owned(), ..catalog::hanging_span() }
}

/// Returns true if the opened scene is that of the document: from the same file, or equal if
/// neither has a file. Names do not tell, because two files may have the same.
fn is_same_source(document: &Document, scene: &Scene, path: Option<&Path>) -> bool {
    match (document.path.as_deref(), path) {
        (Some(before), Some(now)) => std::path::absolute(before).ok() == std::path::absolute(now).ok(),
        (None, None) => document.saved == *scene,
        _ => false,
    }
}

/// Replaces the document; all that belongs to the old one ends.
fn open(state: &mut AppState, scene: Scene, path: Option<PathBuf>, effects: &mut Effects) {
    if !is_same_source(&state.document, &scene, path.as_deref()) {
        // Pins belong to the file that they were made in.
        state.analysis.references.clear();
    }
    if let Some(path) = &path {
        state.ui.add_recent(path.clone());
    }
    state.document = Document::new(scene, path);
    state.ui.scenes_opened += 1;
    (state.selection.selected, state.selection.also_selected) = (None, Vec::new());
    (state.selection.hovered, state.analysis.tension_marker) = (None, None);
    state.live.playback.paused = true;
    state.live.robot_speed_command = None;
    state.live.reopened_run = None;
    (state.live.earlier_run, state.live.reset_is_last, state.live.reset_asked) = (None, false, None);
    state.ui.tutorial = None;
    state.analysis.safe_reach = crate::jobs::safe_reach::SafeReachState::default();
    effects.reach = Some(None);
    state.analysis.models = crate::jobs::model_comparison::Progress::None;
    effects.models = Some(None);
    effects.request.robot = Some(None);
    state.view.camera.fit_wanted = true;
    state.ui.dialog = None;
    submit_new_scene(state, effects);
}

/// Shows remarks on a run that was opened.
fn remark(state: &mut AppState, path: &Path, remarks: &[String]) {
    if !remarks.is_empty() {
        show_error(state, &format!("About the run “{}”", path.display()), remarks.join(" "));
    }
}

/// Adds a run read from a folder to the pinned answers.
fn pin_run(state: &mut AppState, path: &Path, opened: OpenedRun) {
    let samples: Vec<Sample> = opened.answers.iter().map(Sample::of).collect();
    let events = opened.answers.iter().map(|a| a.warnings.len()).sum();
    let run = KeptRun::of(samples.iter(), &opened.answers, events).map(Arc::new);
    state.ui.dialog = None;
    remark(state, path, &opened.remarks);
    if let (Some(solution), true) =
        (opened.answers.into_iter().next_back(), state.analysis.references.len() < Reference::MAX_COUNT)
    {
        let wall_s = opened.wall_time_s.unwrap_or(f64::NAN);
        let changes = state.analysis.changes_to(&opened.scene, &state.document.saved);
        let (scene, solution, folder) = (Arc::new(opened.scene), Arc::new(solution), Some(path.to_owned()));
        state.analysis.references.push(Reference { scene, changes, folder, solution, wall_s, run });
    }
}

/// Saves the scene; what waited for that follows.
fn save(state: &mut AppState, path: &Path, effects: &mut Effects) {
    match scene_file::save(path, &state.document.scene) {
        Ok(()) => {
            state.document.path = Some(path.to_owned());
            state.ui.add_recent(path.to_owned());
            state.document.saved = state.document.scene.clone();
            state.document.recovered = false;
            state.ui.dialog = None;
            if let Some(then) = state.ui.after_save.take() {
                execute(state, then.into(), effects);
            }
        }
        Err(text) => {
            show_error(state, &format!("“{}” was not saved", path.display()), text);
            // The path that was typed is not lost: it is asked again.
            state.ui.after_message = Some(Dialog::SaveAs { path: path.display().to_string() });
        }
    }
}

/// Writes the recording as a run folder.
fn save_run(state: &AppState, path: &Path) -> Result<(), String> {
    let scene = state.live.latest.scene.as_deref().ok_or("nothing was solved yet")?;
    let request =
        RunRequest { program: format!("cable-viewer {}", env!("CARGO_PKG_VERSION")), ..RunRequest::default() };
    let mut folder = RunFolder::create(path, scene, request, NodeChoice::default()).map_err(|e| e.to_string())?;
    for answer in state.live.recording.answers() {
        if let Err(e) = folder.push(answer) {
            let why = e.to_string();
            // The tables are readable and marked as partial already, whether this can be noted or
            // not.
            let _ = folder.finish(RunEnd::Partial(RunStop::Failed { message: why.clone() }));
            return Err(why);
        }
    }
    if let Some(wall_s) = state.live.recording.solve_wall_s {
        folder.add_wall_time(wall_s);
    }
    folder.finish(RunEnd::Complete).map(|_| ()).map_err(|e| e.to_string())
}

fn show_error(state: &mut AppState, title: &str, text: String) {
    state.ui.dialog = Some(Dialog::Message { title: title.to_owned(), text });
}

fn path_text(state: &AppState) -> String {
    state.document.path.as_ref().map_or_else(|| "scene.toml".to_owned(), |p| p.display().to_string())
}

fn feedback_context(state: &AppState) -> feedback::Context<'_> {
    feedback::Context {
        scene: &state.document.scene.name,
        answer: state.live.snapshot.solution.as_deref(),
        error: state.live.snapshot.error.as_ref().map(ToString::to_string),
    }
}
