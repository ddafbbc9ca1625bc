//! Commands that change what is shown.

use cable_core::math::Point;

use crate::colour::ColourScale;
use crate::state::{AppState, Grab, Held, Item, Layers};

/// Changes what is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewCommand {
    /// Picks a thing, or nothing.
    Select(Option<Item>),
    /// The pointer is over a thing, or over nothing, at a point of the world (m).
    Hover(Option<Item>, Option<Point>),
    /// Picks a thing up, or lets it go.
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
    /// The whole scene in view.
    Fit,
    /// The cable's middle in the middle, same scale.
    Recentre,
    /// A point in the middle, same scale, m.
    CentreOn(Point),
    /// How the cable is coloured.
    SetColour(ColourScale),
    /// What is drawn.
    SetLayers(Layers),
    /// Light or dark.
    SetTheme(egui::ThemePreference),
    /// Keeps the answer on screen to compare with.
    Hold,
    /// Lets one go, or all.
    LetGo(Option<usize>),
}

/// Does one of them.
pub fn apply(state: &mut AppState, command: ViewCommand) {
    match command {
        ViewCommand::Select(item) => {
            if state.selected != item {
                state.undo.close_entry();
            }
            state.selected = item;
        }
        ViewCommand::Hover(item, at_m) => {
            state.hovered = item;
            state.cursor_m = at_m;
        }
        ViewCommand::Grab(grab) => state.grabbed = grab,
        ViewCommand::Pan(delta) => state.camera.pan(delta),
        ViewCommand::Zoom { about_m, factor } => state.camera.zoom(about_m, factor),
        ViewCommand::Fit => state.camera.fit_wanted = true,
        ViewCommand::Recentre => {
            let [low, high] = crate::canvas::bounds::cables(state);
            state.camera.centre_m = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        }
        ViewCommand::CentreOn(p) => {
            if p.iter().all(|v| v.is_finite()) {
                state.camera.centre_m = p;
            }
        }
        ViewCommand::SetColour(colour) => state.colour = colour,
        ViewCommand::SetLayers(layers) => state.layers = layers,
        ViewCommand::SetTheme(theme) => state.theme = theme,
        ViewCommand::Hold => {
            if let (Some(solution), Some(scene)) = (state.snapshot.solution.clone(), state.snapshot.scene.clone())
                && state.held.len() < Held::MOST
            {
                let name = format!("{}, {} model, {:.2} s", scene.name, solution.model, solution.time_s);
                state.held.push(Held { name, scene, solution, wall_s: state.snapshot.solve_wall_s });
            }
        }
        ViewCommand::LetGo(None) => state.held.clear(),
        ViewCommand::LetGo(Some(k)) => {
            if k < state.held.len() {
                state.held.remove(k);
            }
        }
    }
}
