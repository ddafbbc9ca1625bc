//! The view is how the scene is drawn: camera, layers and colours.

/// What is drawn on the canvas.
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
    /// Dragged points land on the grid.
    pub snap: bool,
}
