//! The command palette finds every command by a part of its name.

use cable_core::Model;
use cable_core::scene::catalog;
use egui::{Key, ScrollArea, TextEdit, Ui};

use crate::app::analysis_tools::tools;
use crate::app::guidance::tutorials::{self, TUTORIALS};
use crate::app::palette_entries;
use crate::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use crate::panels::scene::{loads, obstacles, supports};
use crate::panels::timeline::restart_button;
use crate::plot::{along_cable, over_time};
use crate::render::colour::{CableQuantity, ColourScale};
use crate::state::dialog::Dialog;
use crate::state::{AppState, Item, OpenPanels};
use crate::units::labels;
use crate::units::system::System;

/// Other words that people look for, and a part of the name that they mean.
const SYNONYMS: [(&str, &str); 32] = [
    ("start here", "learn guide tutorial welcome introduction"),
    ("pin this result", "hold keep compare reference remember"),
    ("pin a recorded run", "hold compare"),
    ("compare all models", "hold every solver"),
    ("unpin all", "let go clear compare"),
    ("save run", "export record csv table"),
    ("save as", "export write"),
    ("export the graph", "save plot chart picture image csv svg png"),
    ("export picture", "save image png svg screenshot canvas scene view drawing snapshot"),
    ("add obstacle", "insert create ground terrain pipe wall"),
    ("open a file", "load read"),
    ("import map", "terrain ground svg csv"),
    ("fit scene", "zoom all view extents home"),
    ("recentre", "center middle"),
    ("reset to the start", "restart rewind begin"),
    ("play or pause", "run stop start time"),
    ("real-time speed", "1x normal"),
    ("slow motion", "slower"),
    ("find safe reach", "map reachability range"),
    ("mark the greatest", "largest maximum tension budget break down where from"),
    ("friction range", "show less and more friction ribbon uncertainty sensitivity"),
    ("resume from", "go on continue"),
    ("show the latest", "present now end"),
    ("restart the solver", "crash thread"),
    ("same drag stiffness", "hand for every cable"),
    ("drag speed limit", "fastest hand"),
    ("previous run", "undo restart swap exchange"),
    ("cancel solving", "stop abort"),
    ("quit", "exit close"),
    ("new scene", "create empty"),
    ("colour by", "color"),
    ("plot error", "chart over cost of every model work precision accuracy tolerance speed mesh compare"),
];

/// Opens a scene of the catalogue.
fn open_scene(id: &str) -> Command {
    Command::File(FileCommand::OpenCatalogue(id.to_owned()))
}

/// All commands, each with the name under which it is shown and found.
fn entries(state: &AppState) -> Vec<(String, Command)> {
    let panels = state.ui.panels;
    let show = |panels| Command::View(ViewCommand::ShowPanels(panels));
    let file = |dialog| Command::File(FileCommand::SetDialog(Some(dialog)));
    let select = |item| Command::View(ViewCommand::Select(Some(item)));
    let theme = |theme| Command::View(ViewCommand::SetTheme(theme));
    // In the order of the menus, as they are read where nothing is typed.
    let fixed = [
        ("New scene", Command::File(FileCommand::New)),
        ("Open a file…", Command::File(FileCommand::AskOpen)),
        ("Save", Command::File(FileCommand::Save)),
        ("Save as…", Command::File(FileCommand::AskSaveAs)),
        ("Import map…", Command::File(crate::app::menu::import_map())),
        ("Open run…", file(Dialog::OpenRun { path: "run".to_owned(), hold: false })),
        ("Save run…", file(Dialog::SaveRun { path: "run".to_owned() })),
        ("Pin a recorded run…", file(Dialog::OpenRun { path: "run".to_owned(), hold: true })),
        ("Export picture…", Command::File(FileCommand::AskExportPicture)),
        ("Quit", Command::File(FileCommand::Quit)),
        ("Undo", Command::Scene(SceneCommand::Undo)),
        ("Redo", Command::Scene(SceneCommand::Redo)),
        (restart_button(state), Command::Playback(PlaybackCommand::UndoRestart)),
        ("Edit the scene: name, map, robot", select(Item::Scene)),
        ("Edit the cable", select(Item::Cable(0))),
        ("Edit the environment", select(Item::Environment)),
        ("Edit the solver: model, mesh, accuracy", select(Item::Solver)),
        ("Add a cable", Command::Scene(SceneCommand::AddCable)),
        ("Remove the robot", Command::Scene(SceneCommand::SetRobot(None))),
        ("Play or pause", Command::Playback(PlaybackCommand::TogglePause)),
        ("Step", Command::Playback(PlaybackCommand::Step)),
        ("Step back", Command::Playback(PlaybackCommand::StepBack)),
        ("Reset to the start", Command::Playback(PlaybackCommand::Reset)),
        ("Show the latest", Command::Playback(PlaybackCommand::ShowTime(None))),
        ("Resume from here: the time shown", Command::Playback(PlaybackCommand::ResumeFromShown)),
        ("Real-time speed", Command::Playback(PlaybackCommand::SetSpeed(1.0))),
        ("Slow motion 0.1×", Command::Playback(PlaybackCommand::SetSpeed(0.1))),
        ("Robot: follow path", Command::Playback(PlaybackCommand::DriveRobot(None))),
        ("Robot: stop", Command::Playback(PlaybackCommand::DriveRobot(Some(0.0)))),
        (
            "Allow pulling beyond the cable's length while time runs",
            Command::Playback(PlaybackCommand::PullPastLength(true)),
        ),
        ("Refuse pulling beyond the cable's length", Command::Playback(PlaybackCommand::PullPastLength(false))),
        ("Fit scene", Command::View(ViewCommand::Fit)),
        ("Recentre on the cable", Command::View(ViewCommand::Recentre)),
        ("Follow the cable", Command::View(ViewCommand::Follow)),
        ("Show or fold the outline", show(OpenPanels { edit: !panels.edit, ..panels })),
        ("Show or fold the results panel", show(OpenPanels { results: !panels.results, ..panels })),
        ("Show or fold graphs and timeline", show(OpenPanels { graphs: !panels.graphs, ..panels })),
        ("Light theme", theme(egui::ThemePreference::Light)),
        ("Dark theme", theme(egui::ThemePreference::Dark)),
        ("Match system theme", theme(egui::ThemePreference::System)),
        ("SI units", Command::View(ViewCommand::SetUnits(System::Si))),
        ("US units", Command::View(ViewCommand::SetUnits(System::Us))),
        ("Cancel solving", Command::Playback(PlaybackCommand::CancelSolve)),
        ("Restart the solver", Command::File(FileCommand::RestartWorker)),
        ("Cancel or clear the safe reach", Command::View(ViewCommand::EndSafeReach)),
        ("Start here…", file(Dialog::StartHere)),
        ("Help: pointer and keys", file(Dialog::Help)),
        ("About: what was checked", file(Dialog::About)),
        ("Give feedback…", Command::File(crate::app::menu::feedback())),
    ];
    let colour = |quantity| Command::View(ViewCommand::SetColour(ColourScale { quantity, ..ColourScale::default() }));
    let mut all: Vec<(String, Command)> = fixed.map(|(name, command)| (name.to_owned(), command)).into();
    let graphs = [over_time::TITLE, along_cable::TITLE].map(|title| {
        let name = format!("Export the graph {}…", title.to_lowercase());
        (name, Command::View(ViewCommand::ExportGraph(title)))
    });
    all.extend(graphs);
    all.extend(tools(state).into_iter().filter_map(|tool| Some((tool.name.to_owned(), tool.command?))));
    let added =
        [("Add waypoint", supports::new_waypoint(state, state.current_cable())), ("Add load", loads::new_load(state))];
    all.extend(added.into_iter().filter_map(|(name, command)| Some((name.to_owned(), Command::Scene(command?)))));
    let obstacles = obstacles::new_obstacles(state)
        .map(|(name, _, command)| (format!("Add obstacle: {}", name.to_lowercase()), Command::Scene(command)));
    all.extend(obstacles);
    let models = [Model::Auto].into_iter().chain(Model::SOLVERS);
    all.extend(models.map(|m| (format!("Solve with {}", labels::model(m)), Command::SetModel(m))));
    all.extend(CableQuantity::ALL.map(|q| (format!("Colour by {}", q.name().to_lowercase()), colour(q))));
    all.extend(
        TUTORIALS
            .iter()
            .enumerate()
            .map(|(k, t)| (format!("Guide {}. {}", k + 1, t.title), Command::File(tutorials::open(k)))),
    );
    all.extend(catalog::all().into_iter().map(|(id, scene)| (format!("Open scene: {}", scene.name), open_scene(id))));
    all.extend(palette_entries::entries(state));
    all
}

/// The names of what is found by a text.
#[must_use]
pub fn names(text: &str, state: &AppState) -> Vec<String> {
    found(text, state).into_iter().map(|(name, _)| name).collect()
}

/// Those that have every word of a text in their name.
fn found(text: &str, state: &AppState) -> Vec<(String, Command)> {
    let words: Vec<String> = text.split_whitespace().map(str::to_lowercase).collect();
    let mut all = entries(state);
    // A scene is known by its file's name too.
    let whole = text.trim().to_lowercase();
    let scene_of_text = open_scene(&whole);
    let is_id = |command: &Command| *command == scene_of_text;
    let has_words = |text: &str| words.iter().all(|w| text.contains(w));
    let by_name = |name: &str| has_words(&name.to_lowercase());
    let by_synonym = |name: &str| {
        let text = name.to_lowercase();
        let more = SYNONYMS.iter().filter(|(part, _)| text.contains(part)).map(|(_, more)| *more);
        has_words(&more.fold(text.clone(), |all, more| all + " " + more))
    };
    let part_of_id = |command: &Command| match command {
        Command::File(FileCommand::OpenCatalogue(id)) => !whole.is_empty() && id.contains(&whole),
        _ => false,
    };
    all.retain(|(name, command)| by_synonym(name) || part_of_id(command));
    // The scene of that file comes before all, then names by how they have the text.
    all.sort_by_key(|(name, command)| (!is_id(command), !by_name(name), name_match(name, &whole, &words)));
    all
}

/// The way in which a name has a text, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum NameMatch {
    /// It begins with the text.
    Start,
    /// Each word of the text begins a word of it.
    WordStarts,
    /// Words of the text are within words of it, or in its synonyms.
    Within,
}

/// The way in which a name contains a text, whose words these are.
fn name_match(name: &str, whole: &str, words: &[String]) -> NameMatch {
    let name = name.to_lowercase();
    let begins = |word: &String| name.split(|c: char| !c.is_alphanumeric()).any(|own| own.starts_with(word.as_str()));
    if name.starts_with(whole) {
        NameMatch::Start
    } else if words.iter().all(begins) {
        NameMatch::WordStarts
    } else {
        NameMatch::Within
    }
}

/// Draws it; Enter does the first found.
pub fn ui(ui: &mut Ui, text: &mut String, state: &AppState, commands: &mut Vec<Command>) {
    let field = TextEdit::singleline(text).hint_text("Type a command…").desired_width(f32::INFINITY);
    let field = ui.add(field);
    crate::widgets::field::name(&field, "Command");
    let entered = field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
    if !entered {
        field.request_focus();
    }
    let found = found(text, state);
    let mut chosen = found.first().filter(|_| entered).map(|(_, command)| command.clone());
    ScrollArea::vertical().max_height(320.0).min_scrolled_height(320.0).auto_shrink([false, true]).show(ui, |ui| {
        for (k, (name, command)) in found.iter().enumerate() {
            if ui.selectable_label(k == 0, name).clicked() {
                chosen = Some(command.clone());
            }
        }
        if found.is_empty() {
            ui.weak(format!("No command matches “{}”", text.trim()));
        }
    });
    if let Some(command) = chosen {
        // Closed first: what is chosen may open another.
        commands.push(Command::File(FileCommand::SetDialog(None)));
        commands.push(command);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_found_in_any_order_and_case() {
        let state = AppState::new(catalog::tank(), None);
        let found = |text: &str| found(text, &state);
        assert_eq!(found("THEME dark")[0].0, "Dark theme");
        assert!(found("tank out")[0].0.starts_with("Open scene: Tank"));
        assert!(found("no such thing").is_empty());
        assert_eq!(found("").len(), entries(&state).len());
        assert!(found("comp").iter().any(|(name, _)| name == "Compare all models"));
        assert!(found("export").iter().any(|(name, _)| name == "Save run…"));
        assert!(found("export").iter().any(|(name, _)| name.starts_with("Export the graph")));
        assert!(
            ["export", "screenshot", "save image", "canvas png"].iter().all(|t| found(t)[0].0 == "Export picture…")
        );
        assert!(found("add").iter().any(|(name, _)| name == "Add obstacle: beam"));
        for (id, scene) in catalog::all() {
            assert_eq!(found(id)[0].0, format!("Open scene: {}", scene.name), "{id}");
        }
        assert_eq!(found("hold this")[0].0, "Pin this result");
        assert_eq!(found("hold")[0].0, "Pin a recorded run…");
        // Names that begin with the text stand before those that have it within a word.
        assert_eq!(found("step")[0].0, "Step");
        assert_eq!(found("re")[0].0, "Redo");
        assert_eq!(found("graph").iter().take(2).filter(|(name, _)| name.starts_with("Graph of")).count(), 2);
        let places = |text: &str, part: &str| found(text).iter().position(|(name, _)| name.contains(part));
        assert!(places("pin", "Unpin").is_none_or(|k| Some(k) > places("pin", "Pin this result")));
    }
}
