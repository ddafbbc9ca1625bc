//! An error of the scene is shown where it was typed, with the fix where there is one.

use cable_core::error::SceneFault;
use cable_core::scene::SupportKind;
use cable_core::{Cable, SceneError};
use egui::Ui;

use crate::command::{Command, SceneCommand};
use crate::panels::display_names;
use crate::state::AppState;
use crate::units::unit::Unit;
use crate::units::{format, sentence};
use crate::widgets::field;

/// A change that puts a fault right.
#[derive(Clone, Debug, PartialEq)]
pub struct Fix {
    /// The text of the button.
    pub label: String,
    /// Its effect.
    pub command: Command,
}

/// The fault of the scene if it lies at a path or below it, such as `cables[0].length_m`.
#[must_use]
pub fn at<'a>(state: &'a AppState, path: &str) -> Option<&'a SceneError> {
    let fault = state.document.fault.as_ref()?;
    let rest = fault.path.strip_prefix(path)?;
    (rest.is_empty() || rest.starts_with(['.', '['])).then_some(fault)
}

/// One sentence that says what is wrong.
#[must_use]
pub fn sentence(fault: &SceneFault) -> String {
    let Unit { symbol, si, .. } = Unit::M.display();
    match fault {
        SceneFault::TooShort { length_m, way_m, needed_n, breaking_n } => format!(
            "needs ≥ {} {symbol}, is {:.2} {symbol}: stretching to its supports would take {}, and it breaks at {}",
            up_to_hundredth(*way_m / si),
            length_m / si,
            format::force(*needed_n),
            format::force(*breaking_n)
        ),
        other => sentence::sentence(other),
    }
}

/// Returns the fault of the scene, if any: the item, the property and the reason.
#[must_use]
pub fn summary(state: &AppState) -> Option<String> {
    let found = state.document.fault.as_ref()?;
    let named = cable_and_key(&found.path).and_then(|(index, key)| {
        let property = crate::panels::cable::property::PROPERTIES.iter().find(|p| p.key == key)?;
        Some(format!("{} of “{}”", property.quantity.name, state.document.scene.cables.get(index)?.name))
    });
    Some(format!(
        "{} {}",
        named.unwrap_or_else(|| format!("{}:", display_names::place(&found.path))),
        sentence(&found.fault)
    ))
}

/// Rounded up to the next hundredth, so that the figure shown is long enough.
fn up_to_hundredth(length: f64) -> String {
    format!("{:.2}", ceil_hundredth(length))
}

fn ceil_hundredth(length: f64) -> f64 {
    (length * 100.0 - 1e-9).ceil() / 100.0
}

/// Returns what would put the scene's fault right, where one change does.
#[must_use]
pub fn fix(state: &AppState) -> Option<Fix> {
    let fault = state.document.fault.as_ref()?;
    let (index, key) = cable_and_key(&fault.path)?;
    let cable = state.document.scene.cables.get(index)?;
    match &fault.fault {
        SceneFault::TooShort { length_m, way_m, .. } => {
            // With a grip between the ends it is one stretch that is too short, which more length
            // at the end does not help.
            let grips = cable.supports.iter().filter(|s| !matches!(s.kind, SupportKind::Pulley | SupportKind::Free));
            if grips.count() > 2 {
                return None;
            }
            let thermal = length_m / cable.length_m;
            let Unit { symbol, si, .. } = Unit::M.display();
            let wanted = ceil_hundredth(if thermal > 0.0 { way_m / thermal } else { *way_m } / si);
            Some(set_cable(index, cable, format!("Set to {wanted:.2} {symbol}"), |c| c.length_m = wanted * si))
        }
        SceneFault::ServiceAboveBreaking { breaking_n: wanted, .. } => {
            let wanted = *wanted;
            let label = format!("Set to {}", Unit::N.text(wanted));
            Some(set_cable(index, cable, label, |c| c.service_tension_n = wanted))
        }
        _ => {
            let value = preset_value(cable, key)?;
            let property = crate::panels::cable::property::PROPERTIES.iter().find(|p| p.key == key)?;
            let label = format!("Set to {}", property.quantity.unit.text(value));
            Some(set_cable(index, cable, label, |c| (property.set)(c, value)))
        }
    }
}

fn preset_value(cable: &Cable, key: &str) -> Option<f64> {
    let preset = cable_core::scene::preset::cable_preset(cable.preset.as_deref()?)?;
    preset.figures().into_iter().find(|(k, _)| *k == key).map(|(_, f)| f.value)
}

fn set_cable(index: usize, cable: &Cable, label: String, change: impl FnOnce(&mut Cable)) -> Fix {
    let mut value = cable.clone();
    change(&mut value);
    Fix { label, command: Command::Scene(SceneCommand::SetCable { cable: index, value: Box::new(value) }) }
}

/// `cables[2].length_m` → 2 and `length_m`.
fn cable_and_key(path: &str) -> Option<(usize, &str)> {
    let (index, key) = path.strip_prefix("cables[")?.split_once("].")?;
    Some((index.parse().ok()?, key))
}

/// The fault at a path, if that is where it lies, with its fix.
pub fn inline(ui: &mut Ui, state: &AppState, path: &str, commands: &mut Vec<Command>) {
    let Some(found) = at(state, path) else { return };
    let below = found.path.strip_prefix(path).unwrap_or_default().trim_start_matches('.');
    let text = sentence(&found.fault);
    field::fault(ui, &if below.is_empty() { text } else { format!("{}: {text}", display_names::place(below)) });
    if let Some(fix) = fix(state)
        && ui.button(&fix.label).on_hover_text("Puts this right").clicked()
    {
        commands.push(fix.command);
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_length_shown_is_never_too_short() {
        assert_eq!(up_to_hundredth(31.4159), "31.42");
        assert_eq!(up_to_hundredth(31.42), "31.42");
        assert_eq!(up_to_hundredth(31.420_001), "31.43");
    }

    #[test]
    fn paths_are_taken_apart() {
        assert_eq!(cable_and_key("cables[2].length_m"), Some((2, "length_m")));
        assert_eq!(cable_and_key("cables[0].supports[1].at_m[0]"), Some((0, "supports[1].at_m[0]")));
        assert_eq!(cable_and_key("environment.wind_n_per_m"), None);
    }
}
