//! The view is how the scene is drawn: camera, layers, colours and units.

use cable_core::math::Point;

use crate::render::colour::ColourScale;
use crate::state::camera::Camera;
use crate::units::system::System;

/// The view of the scene.
#[derive(Clone, Debug)]
pub struct Appearance {
    /// The part of the world on screen.
    pub camera: Camera,
    /// The part of the world that the canvas shows, lower left and upper right corner, m.
    pub visible_m: [Point; 2],
    /// The colouring of the cable.
    pub colour: ColourScale,
    /// The layers that are drawn.
    pub layers: Layers,
    /// Units on screen; files stay SI.
    pub units: System,
    /// Light or dark.
    pub theme: egui::ThemePreference,
}

impl Default for Appearance {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            visible_m: [[-1.0; 2], [1.0; 2]],
            colour: ColourScale::default(),
            layers: Layers::default(),
            units: System::Si,
            theme: egui::ThemePreference::System,
        }
    }
}

/// The layers of the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Grid lines and axes.
    pub grid: bool,
    /// Names and coordinates.
    pub labels: bool,
    /// Contact normals and friction.
    pub contacts: bool,
    /// Loads, reactions and wind.
    pub forces: bool,
    /// The parts of each force to the right and upwards.
    pub components: bool,
    /// The model's nodes.
    pub nodes: bool,
    /// The shape that the cables had when the run began.
    pub start_shape: bool,
    /// Dragged points land on the grid.
    pub snap: bool,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            grid: true,
            labels: true,
            contacts: true,
            forces: true,
            components: false,
            nodes: false,
            start_shape: false,
            snap: false,
        }
    }
}
