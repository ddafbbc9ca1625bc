//! Scene files are TOML, read and written here.

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::deserialize::{DeserializeError, DocumentDeserializer};
use super::key_path::Path;
use super::text_position::{placed, position};
use crate::error::{DocumentFault, SceneError, SceneFault};
use crate::scene::{Scene, VERSION, preset};

/// Longest scene text, bytes: about 240 000 terrain points. A hostile one takes a hundred times its
/// size in memory while it is read (measured: 800 MB for 8 MiB of `1,1,1,…`), an honest one fifty
/// times.
pub(crate) const MAX_TEXT_BYTES: usize = 4 << 20;

impl Scene {
    /// Reads and validates a scene. A byte order mark and CRLF line ends are accepted.
    ///
    /// # Errors
    /// The first thing wrong, with path, value, allowed range, line and column.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.len() > MAX_TEXT_BYTES {
            return Err(Path::Root.document_fault(DocumentFault::LongText { bytes: text.len(), most: MAX_TEXT_BYTES }));
        }
        if text.trim().is_empty() {
            return Err(Path::Root.document_fault(DocumentFault::EmptyText));
        }
        let document = DeTable::parse(text).map_err(|e| SceneError {
            path: String::new(),
            fault: SceneFault::Syntax { message: e.message().to_owned() },
            at: e.span().map(|s| position(text, s.start)),
        })?;
        let refused = |e: DeserializeError| SceneError {
            path: e.path(),
            at: e.span.as_ref().map(|s| position(text, s.start)),
            fault: e.fault,
        };
        let table = document.get_ref();
        check_version(table).map_err(|e| placed(e, text, table))?;
        let scene = Self::deserialize(DocumentDeserializer(table, document.span())).map_err(refused)?;
        scene.validate().map_err(|e| placed(e, text, table))?;
        Ok(scene)
    }

    /// As [`Self::from_toml`], for bytes that may not be text.
    ///
    /// # Errors
    /// As [`Self::from_toml`], and when the bytes are not UTF-8.
    pub fn from_toml_bytes(bytes: &[u8]) -> Result<Self, SceneError> {
        if bytes.len() > MAX_TEXT_BYTES + 3 {
            return Err(Path::Root.document_fault(DocumentFault::LongText { bytes: bytes.len(), most: MAX_TEXT_BYTES }));
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::from_toml(text),
            Err(e) => {
                let good = std::str::from_utf8(&bytes[..e.valid_up_to()]).unwrap_or_default();
                let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
                Err(SceneError {
                    path: String::new(),
                    fault: SceneFault::NotUtf8 { encoding: utf16.then_some("UTF-16") },
                    at: Some(position(good, good.len())),
                })
            }
        }
    }

    /// Writes the scene. Of a cable with a preset only what differs from it is written.
    #[must_use]
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.written()).unwrap_or_default()
    }

    /// The scene in the form in which it is written, as a tree.
    pub(in crate::scene) fn written(&self) -> toml::Table {
        let mut table = toml::Table::try_from(self).unwrap_or_default();
        let cables = table.get_mut("cables").and_then(toml::Value::as_array_mut);
        for cable in cables.into_iter().flatten().filter_map(toml::Value::as_table_mut) {
            let Some(preset) = cable.get("preset").and_then(toml::Value::as_str).and_then(preset::cable_preset) else {
                continue;
            };
            let values = preset.values();
            cable.retain(|key, value| {
                let same = |(k, v): &(&str, f64)| *k == key && value.as_float().map(f64::to_bits) == Some(v.to_bits());
                !values.iter().any(same)
            });
        }
        table
    }
}

/// An unknown version is reported first, as all other messages would only confuse.
fn check_version(table: &DeTable<'_>) -> Result<(), SceneError> {
    let at = Path::Root.key("version");
    match table.get("version").map(Spanned::get_ref) {
        Some(DeValue::Integer(i)) if i.as_str().parse::<u32>() != Ok(VERSION) => {
            Err(at.fault(SceneFault::Version { value: i.as_str().parse().unwrap_or(f64::NAN) }))
        }
        _ => Ok(()),
    }
}
