//! A fault of a scene file is told with the line and column where the text has it.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{SceneError, TextPosition};

/// Adds where in the text the path of a fault is, or the nearest place above it.
pub(super) fn placed(mut error: SceneError, text: &str, table: &DeTable<'_>) -> SceneError {
    error.at = locate(table, &error.path).map(|offset| position(text, offset));
    error
}

/// Position in the text (bytes) of the innermost part of a path that is there.
fn locate(table: &DeTable<'_>, path: &str) -> Option<usize> {
    let mut found: Option<&Spanned<DeValue<'_>>> = None;
    for step in path.split(['.', '[']) {
        let next = match (step.strip_suffix(']'), found.map(Spanned::get_ref)) {
            (Some(index), Some(DeValue::Array(items))) => index.parse().ok().and_then(|i: usize| items.get(i)),
            (None, None) => table.get(step),
            (None, Some(DeValue::Table(table))) => table.get(step),
            _ => None,
        };
        match next {
            Some(node) => found = Some(node),
            None => break,
        }
    }
    found.map(|node| node.span().start)
}

/// Line and column of a byte, both from 1.
pub(super) fn position(text: &str, offset: usize) -> TextPosition {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    TextPosition {
        line: before.bytes().filter(|&b| b == b'\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
    }
}
