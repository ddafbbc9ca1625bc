//! Terrain and beams are read from tables and drawings and added to a scene.

use std::path::Path;

use cable_core::scene::{Obstacle, Shape, import};
use cable_core::{Scene, files};

use crate::units::sentence::sentence;

/// Largest file, bytes: a million points with room to spare.
const MAX_BYTES: u64 = 64 << 20;

/// A map to read.
pub struct Map<'a> {
    /// The file; None: the text.
    pub path: Option<&'a Path>,
    /// The text that was pasted.
    pub text: &'a str,
    /// Length of a unit of it, m.
    pub unit_m: f64,
    /// It takes the place of the ground that is there.
    pub replaces_ground: bool,
}

/// Returns the scene with the obstacles that were read, and a report in words.
///
/// # Errors
/// The place that cannot be read, or the reason why the scene would be refused with it, in words.
pub fn add(scene: &Scene, map: &Map<'_>) -> Result<(Scene, String), String> {
    let from_file;
    let text = match map.path {
        Some(path) => {
            let bytes = files::read_limited(path, MAX_BYTES).map_err(|e| e.to_string())?;
            from_file = String::from_utf8(bytes).map_err(|_| "it is no text in UTF-8".to_owned())?;
            &from_file
        }
        None => map.text,
    };
    let read = import::read(text, map.unit_m).map_err(|e| e.to_string())?;
    let mut scene = scene.clone();
    let mut report = Vec::new();
    if map.replaces_ground {
        if read.lines.iter().all(|line| line.closed) {
            return Err("it has no open line that could be the ground".to_owned());
        }
        let (grounds, others) =
            scene.obstacles.into_iter().partition::<Vec<_>, _>(|o| matches!(o.shape, Shape::Terrain { .. }));
        scene.obstacles = others;
        report.extend(grounds.iter().map(|o| format!("“{}”: taken out", o.name)));
    }
    for line in read.lines {
        let count = line.points_m.len();
        let (kind, shape) = if line.closed {
            ("imported beam", Shape::Polygon { points_m: line.points_m })
        } else {
            ("imported ground", Shape::Terrain { points_m: line.points_m })
        };
        let taken = |n: &str| scene.obstacles.iter().any(|o| o.name == n);
        let name = std::iter::once(kind.to_owned())
            .chain((2..).map(|k| format!("{kind} {k}")))
            .find(|n| !taken(n))
            .unwrap_or_default();
        report.push(format!("“{name}”: {count} points"));
        scene.obstacles.push(Obstacle { name, shape, friction: None });
    }
    report.extend(read.changes.iter().map(sentence));
    // A fault that the scene already had is not the import's.
    if let Err(fault) = scene.validate()
        && fault.path.starts_with("obstacles")
    {
        return Err(fault.to_string());
    }
    Ok((scene, report.join("\n")))
}
