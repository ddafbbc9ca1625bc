//! A pinned result is named by what it is of: its scene, and what differs in its input.

use crate::panels::display_names;
use crate::state::{AppState, Reference};
use crate::units::labels;

/// Most differences that a name tells; more are counted.
const MAX_DIFFERENCES: usize = 2;

/// The name of a pinned result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PinName {
    /// Its name among the pins: the inputs that differ, else its scene.
    pub short: String,
    /// Its scene, and what sets it apart.
    pub full: String,
}

/// The names of all pinned results, in their order; no two are the same.
#[must_use]
pub fn pin_names(state: &AppState) -> Vec<PinName> {
    let pins = &state.analysis.references;
    let mut names: Vec<PinName> = Vec::with_capacity(pins.len());
    for pin in pins {
        let name = name(pin, pins);
        // Two pins of the same answer: only their number tells them apart.
        let alike = names.iter().filter(|n| n.full == name.full || n.full.starts_with(&format!("{} (", name.full)));
        let nth = match alike.count() {
            0 => String::new(),
            before => format!(" ({})", before + 1),
        };
        names.push(PinName { short: name.short + &nth, full: name.full + &nth });
    }
    names
}

/// The name of a pin by what makes it different from the others.
fn name(pin: &Reference, pins: &[Reference]) -> PinName {
    let scene = if pin.scene.name.is_empty() { "Untitled scene" } else { &pin.scene.name };
    let changes = pin.changes.iter().filter(|c| c.key != "name");
    let mut parts: Vec<String> = changes.clone().take(MAX_DIFFERENCES).map(display_names::present_value).collect();
    let more = changes.count().saturating_sub(MAX_DIFFERENCES);
    if more > 0 {
        parts.push(format!("{more} more"));
    }
    if pins.iter().any(|p| p.solution.model != pin.solution.model) {
        parts.push(format!("{} model", labels::model(pin.solution.model)));
    }
    // Of another input, the time says nothing more.
    let mut alike = pins.iter().filter(|p| p.changes == pin.changes);
    if alike.any(|p| p.solution.time_s != pin.solution.time_s) {
        parts.push(format!("at {:.2}\u{a0}s", pin.solution.time_s));
    }
    if let Some(folder) = &pin.folder {
        parts.push(format!("read from “{}”", folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy()));
    }
    match parts.is_empty() {
        true => PinName { short: scene.to_owned(), full: scene.to_owned() },
        false => {
            let short = parts.join(", ");
            PinName { full: format!("{scene}: {short}"), short }
        }
    }
}
