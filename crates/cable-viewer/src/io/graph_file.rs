//! A graph is written to a file: CSV in SI units, SVG and PNG as drawn.

use std::fmt::Write as _;
use std::path::Path;

use cable_core::files;

use crate::io::graph_drawing;
use crate::io::graph_in_view::{GraphInView, visible};

/// Writes what is in view in the format that the path's ending names.
///
/// # Errors
/// In words: another ending, or the path refuses.
pub fn save(path: &Path, graph: &GraphInView) -> Result<(), String> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let bytes = match ending.as_str() {
        "csv" => csv(graph).into_bytes(),
        "svg" => graph_drawing::svg(graph).into_bytes(),
        "png" => graph_drawing::png(graph)?,
        _ => return Err("its name must end in .csv, .svg or .png".to_owned()),
    };
    files::write_atomic(path, &bytes).map_err(|e| e.to_string())
}

/// A row for each place, a column for each line; SI units, and the fewest digits that read back to
/// the same bits.
#[must_use]
pub fn csv(graph: &GraphInView) -> String {
    let name = |text: &str| text.to_lowercase().replace([' ', ',', '"', '\n', '\r'], "_");
    let mut out = graph.across[1].clone();
    for line in &graph.lines {
        let (line, quantity) = (name(&line.name), &graph.up[1]);
        // A line that is called as the quantity says nothing beside it.
        let _ = match quantity.strip_prefix(&line) {
            Some(unit) if unit.starts_with('_') => write!(out, ",{quantity}"),
            _ => write!(out, ",{line}_{quantity}"),
        };
    }
    out.push('\n');
    // Lines of a graph have the same places; one that has fewer leaves its cells empty.
    let longest = graph.lines.iter().map(|l| visible(l, graph)).max_by_key(|p| p.len()).unwrap_or_default();
    for (k, place) in longest.iter().enumerate() {
        let _ = write!(out, "{:?}", place[0]);
        for line in &graph.lines {
            match visible(line, graph).get(k).filter(|p| p[0] == place[0] && p[1].is_finite()) {
                Some(p) => {
                    let _ = write!(out, ",{:?}", p[1]);
                }
                None => out.push(','),
            }
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::graph_in_view::sample as graph;

    #[test]
    fn a_line_named_as_its_quantity_is_named_once() {
        let mut graph = graph();
        graph.lines.truncate(1);
        graph.lines[0].name = "Tension".to_owned();
        assert_eq!(csv(&graph).lines().next(), Some("time_s,tension_n"));
    }

    #[test]
    fn the_table_has_what_is_in_view_bit_for_bit() {
        let text = csv(&graph());
        let mut rows = text.lines();
        assert_eq!(rows.next(), Some("time_s,maximum_tension_n,at_left__end_tension_n"));
        let table: Vec<Vec<&str>> = rows.map(|r| r.split(',').collect()).collect();
        assert_eq!(table.len(), 31);
        for row in &table {
            let x: f64 = row[0].parse().unwrap();
            let y: f64 = row[1].parse().unwrap();
            assert_eq!(y.to_bits(), (100.0 * x.sin() + 0.1).to_bits());
            // A pole is an empty cell, not a word that no program reads.
            assert_eq!(row[2].is_empty(), x == 3.0, "{row:?}");
        }
    }

    #[test]
    fn other_endings_are_refused_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let error = save(&folder.path().join("graph.xls"), &graph()).unwrap_err();
        assert!(error.contains(".csv"), "{error}");
    }
}
