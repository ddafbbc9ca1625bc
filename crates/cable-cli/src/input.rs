//! The input of a command is a scene file, altered by the arguments.

use std::path::Path;

use cable_core::model::Settings;
use cable_core::{Scene, files};

use crate::args::Common;
use crate::failure::CommandFailure;

/// Reads and validates a scene.
pub fn read_scene(path: &Path) -> Result<Scene, CommandFailure> {
    files::load_scene(path).map_err(CommandFailure::File)
}

/// The scene, altered by the arguments.
pub fn scene_with_arguments(a: &Common) -> Result<Scene, CommandFailure> {
    let mut scene = read_scene(&a.scene)?;
    if let Some(mobilised) = a.mobilised {
        scene.cables.iter_mut().for_each(|cable| cable.friction_mobilised = mobilised);
    }
    Ok(scene)
}

/// The settings that arguments ask for.
pub fn settings(a: &Common) -> Settings {
    Settings { tolerance: a.tolerance(), ..Settings::default() }
}
