//! The gallery draws the window in eight states, for `docs/gallery.md`.

use std::path::Path;

use cable_core::analysis::tension_budget::StartEnd;
use cable_core::scene::catalog;
use cable_core::{Model, Scene};
use egui::{Context, ThemePreference};
use image::RgbaImage;

use crate::ViewerApp;
use crate::app::screenshot;
use crate::command::{Command, PlaybackCommand, SceneCommand, ViewCommand};
use crate::jobs::safe_reach::SafeReachOptions;
use crate::state::{FirstSteps, Item, TensionMarker};
use crate::units::system::System;

/// Size of the pictures, points.
const SIZE: [u32; 2] = [1280, 800];
/// Frames of a state in which nothing moves: enough to lay out, to fit and to solve.
const STILL_FRAMES: usize = 6;
/// Frames in a second.
const FRAMES_PER_S: usize = 60;

/// A state of the window.
pub struct PicturedState {
    /// Name of its file, without the ending.
    pub name: &'static str,
    scene: fn() -> Scene,
    prepare: fn(&mut ViewerApp, &Context),
    /// Frames before the picture: time runs in them, where it does.
    frames: Frames,
}

/// The frames before a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Frames {
    /// Nothing moves, and nothing is computed beside the window.
    Still,
    /// Nothing moves; a computation beside the window has to end.
    AfterJob,
    /// Time runs in so many frames.
    Moving(usize),
}

impl Frames {
    fn count(self) -> usize {
        match self {
            Self::Still | Self::AfterJob => STILL_FRAMES,
            Self::Moving(count) => count,
        }
    }
}

/// All of them, in the order of the page.
pub const STATES: [PicturedState; 8] = [
    PicturedState { name: "first-minute", scene: catalog::tank_robot, prepare: first_minute, frames: Frames::Still },
    PicturedState { name: "selection", scene: catalog::pulley_waypoints, prepare: selection, frames: Frames::Still },
    PicturedState {
        name: "tension-budget",
        scene: catalog::draped_slipping,
        prepare: tension_budget,
        frames: Frames::Still,
    },
    PicturedState { name: "motion", scene: catalog::tank, prepare: motion, frames: Frames::Moving(8 * FRAMES_PER_S) },
    PicturedState {
        name: "robot",
        scene: catalog::robot_drive,
        prepare: robot,
        frames: Frames::Moving(5 * FRAMES_PER_S),
    },
    PicturedState { name: "break", scene: weak, prepare: motion, frames: Frames::Moving(2 * FRAMES_PER_S / 3) },
    PicturedState { name: "safe-reach", scene: catalog::over_beam, prepare: safe_reach, frames: Frames::AfterJob },
    PicturedState { name: "compare", scene: catalog::hanging_span, prepare: compare, frames: Frames::Still },
];

impl PicturedState {
    /// True if nothing moves in it and nothing is computed beside the window: it is drawn at once.
    #[must_use]
    pub fn rests(&self) -> bool {
        self.frames == Frames::Still
    }

    /// Draws it.
    ///
    /// # Errors
    /// In words: a computation takes too long.
    pub fn draw(&self) -> Result<RgbaImage, String> {
        screenshot::draw_after((self.scene)(), SIZE, self.frames.count(), self.prepare)
    }
}

/// Draws all of them into a folder.
///
/// # Errors
/// The missing thing, in one sentence with the remedy.
pub fn save(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for state in &STATES {
        let picture = state.draw()?;
        let path = folder.join(state.name).with_extension("png");
        picture.save(&path).map_err(|e| format!("{} could not be written: {e}", path.display()))?;
    }
    Ok(())
}

fn view(app: &mut ViewerApp, ctx: &Context, command: ViewCommand) {
    app.apply(ctx, vec![Command::View(command)]);
}

fn theme(app: &mut ViewerApp, ctx: &Context, theme: ThemePreference) {
    view(app, ctx, ViewCommand::SetTheme(theme));
}

fn play(app: &mut ViewerApp, ctx: &Context) {
    app.apply(ctx, vec![Command::Playback(PlaybackCommand::SetPaused(false))]);
}

fn first_minute(app: &mut ViewerApp, ctx: &Context) {
    theme(app, ctx, ThemePreference::Dark);
    app.state.ui.first_steps = FirstSteps::default();
}

fn selection(app: &mut ViewerApp, ctx: &Context) {
    theme(app, ctx, ThemePreference::Light);
    view(app, ctx, ViewCommand::Select(Some(Item::Support { cable: 0, support: 1 })));
}

fn tension_budget(app: &mut ViewerApp, ctx: &Context) {
    theme(app, ctx, ThemePreference::Dark);
    let marker = TensionMarker { cable: 0, arc_length_m: 6.0, from: StartEnd::Slacker };
    view(app, ctx, ViewCommand::SetTensionMarker(Some(marker)));
}

fn motion(app: &mut ViewerApp, ctx: &Context) {
    theme(app, ctx, ThemePreference::Dark);
    play(app, ctx);
}

fn robot(app: &mut ViewerApp, ctx: &Context) {
    theme(app, ctx, ThemePreference::Light);
    view(app, ctx, ViewCommand::Select(Some(Item::Robot)));
    play(app, ctx);
}

/// A span that holds a little less than its own weight pulls with at its ends.
fn weak() -> Scene {
    let mut scene = catalog::hanging_span();
    for cable in &mut scene.cables {
        (cable.service_tension_n, cable.breaking_tension_n) = (80.0, 93.0);
    }
    scene
}

/// Sets up the picture of a safe reach search.
fn safe_reach(app: &mut ViewerApp, ctx: &Context) {
    theme(app, ctx, ThemePreference::Light);
    let choice = SafeReachOptions { across: 20, ..SafeReachOptions::default() };
    view(app, ctx, ViewCommand::SetSafeReachOptions(choice));
    // The view covers as much as the cable reaches.
    let camera = &mut app.state.view.camera;
    (camera.centre_m, camera.points_per_m, camera.fit_wanted) = ([5.0, 4.0], 46.0, false);
    app.state.view.visible_m = [[-3.0, -1.0], [13.0, 9.0]];
    view(app, ctx, ViewCommand::SearchSafeReach);
}

/// Sets up the picture of a comparison with a pinned answer.
fn compare(app: &mut ViewerApp, ctx: &Context) {
    theme(app, ctx, ThemePreference::Dark);
    app.apply(ctx, vec![Command::SetModel(Model::Fem), Command::View(ViewCommand::SetUnits(System::Us))]);
    app.receive_reports(ctx);
    view(app, ctx, ViewCommand::AddReference);
    let Some(mut cable) = app.state.document.scene.cables.first().cloned() else { return };
    cable.length_m *= 1.1;
    app.apply(ctx, vec![Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) })]);
}
