//! The provenance of a cable's number is its preset's figure with source and confidence, or the
//! loaded file.

use cable_core::Cable;
use cable_core::scene::preset::{self, CablePreset, Confidence, Figure};

use crate::panels::cable::property::Property;
use crate::widgets::property::Provenance;

/// A property's value, where reset goes, and its source while it is still the preset's.
pub fn of(property: &Property, cable: &Cable, loaded: Option<&Cable>) -> Provenance {
    let value = (property.get)(cable);
    let figure = figure(cable.preset.as_deref(), property.key);
    let origin = figure
        .map(|f| (f.value, "preset".to_owned()))
        .or_else(|| loaded.map(|c| ((property.get)(c), "as loaded".to_owned())));
    let Some(figure) = figure else {
        return Provenance { value, origin, source: None, estimated: false };
    };
    if figure.value == value {
        let estimated = figure.confidence == Confidence::C;
        Provenance { value, origin, source: Some(source(property, figure)), estimated }
    } else {
        let source = format!("Changed from the preset. Of the preset's {}", source(property, figure));
        Provenance { value, origin, source: Some(source), estimated: false }
    }
}

/// Figure, confidence, source and band of a preset, as text.
fn source(property: &Property, figure: &Figure) -> String {
    let unit = property.quantity.unit;
    let sure = match figure.confidence {
        Confidence::A => "read in a source",
        Confidence::B => "second-hand",
        Confidence::C => "estimated",
    };
    let band = match (figure.low, figure.high) {
        (Some(low), Some(high)) => format!("\nMay lie between {} and {}.", unit.brief(low), unit.brief(high)),
        (Some(low), None) => format!("\nAt least {}.", unit.brief(low)),
        (None, Some(high)) => format!("\nAt most {}.", unit.brief(high)),
        (None, None) => String::new(),
    };
    format!("{}: {sure} (confidence {:?}), {}.{band}", unit.brief(figure.value), figure.confidence, figure.source)
}

fn figure(preset: Option<&str>, key: &str) -> Option<&'static Figure> {
    let preset: &'static CablePreset = preset::cable_preset(preset?)?;
    preset.figures().into_iter().find(|(k, _)| *k == key).map(|(_, figure)| figure)
}

/// The cable with every figure of a preset; length, supports, route and mesh stay its own.
#[must_use]
pub fn with_preset(cable: &Cable, preset: &'static CablePreset) -> Cable {
    let mut changed = Cable { preset: Some(preset.id.to_owned()), ..cable.clone() };
    for property in &crate::panels::cable::property::PROPERTIES {
        if let Some(figure) = figure(Some(preset.id), property.key) {
            (property.set)(&mut changed, figure.value);
        }
    }
    changed
}
