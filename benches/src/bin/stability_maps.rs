//! This program draws the maps of stability ([`cable_benches::maps`]) with 20 × 20 cells each.
//!
//! Run from the root of the repository:
//! `cargo run --release -p cable-benches --bin stability-maps`. It writes `docs/charts/maps.csv`,
//! `maps.svg` and `maps.md`, and fails where a cell is wrong in silence; `-- drag-fem` measures
//! some maps and prints what is not right, `-- anew drag-fem` measures them anew, takes the others
//! as they are in `maps.csv`, and writes all.

use std::error::Error;
use std::fmt::Write as _;

use cable_benches::maps::{Map, Verdict, maps};

const FOLDER: &str = "docs/charts";
/// Cells along each side of a map.
const CELLS: usize = 20;
/// Side of a cell in the picture, pixels.
const SIDE: f64 = 13.0;
/// Room beside a map, pixels: left, above, right and below.
const ROOM: [f64; 4] = [74.0, 34.0, 16.0, 50.0];
/// Maps in a row.
const COLUMNS: usize = 3;

/// A cell, measured.
struct Cell {
    at: [f64; 2],
    verdict: Verdict,
    error: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut asked: Vec<String> = std::env::args().skip(1).collect();
    let anew = asked.first().is_some_and(|a| a == "anew");
    if anew {
        asked.remove(0);
    }
    let is_asked = |m: &Map| asked.is_empty() || asked.iter().any(|a| a == m.id);
    let mut measured = Vec::new();
    for map in maps().into_iter().filter(|m| anew || is_asked(m)) {
        let cells = if is_asked(&map) { cells(&map) } else { measured_before(&map)? };
        println!("{}: {}", map.id, counts(&cells).join(", "));
        for cell in cells.iter().filter(|c| is_asked(&map) && !asked.is_empty() && c.verdict != Verdict::Right) {
            println!("  {:.4e} {:.4e}: {}, {:?}", cell.at[0], cell.at[1], cell.verdict.name(), cell.error);
        }
        measured.push((map, cells));
    }
    for id in without_an_end(&measured) {
        println!("{id} has no cell beyond the method's end");
    }
    let wrong = measured.iter().flat_map(|m| &m.1).filter(|c| c.verdict == Verdict::Wrong).count();
    println!("{wrong} cells are wrong in silence");
    if asked.is_empty() || anew {
        std::fs::create_dir_all(FOLDER)?;
        table(&measured)?;
        std::fs::write(format!("{FOLDER}/maps.svg"), picture(&measured))?;
        std::fs::write(format!("{FOLDER}/maps.md"), page(&measured, wrong))?;
    }
    if wrong > 0 { Err("some cells are wrong in silence".into()) } else { Ok(()) }
}

/// All cells of a map, measured on all cores.
fn cells(map: &Map) -> Vec<Cell> {
    let measure = |k: usize| {
        let at = [map.axes[0].value(k % CELLS, CELLS), map.axes[1].value(k / CELLS, CELLS)];
        let (verdict, error) = map.cell(at);
        Cell { at, verdict, error }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut numbered: Vec<(usize, Cell)> = std::thread::scope(|scope| {
        let shares = (0..threads).map(|t| {
            scope.spawn(move || (t..CELLS * CELLS).step_by(threads).map(|k| (k, measure(k))).collect::<Vec<_>>())
        });
        let shares: Vec<_> = shares.collect();
        // A thread that panics has printed why; its cells are then missing.
        shares.into_iter().flat_map(|share| share.join().unwrap_or_default()).collect()
    });
    numbered.sort_by_key(|(k, _)| *k);
    numbered.into_iter().map(|(_, cell)| cell).collect()
}

/// The cells of a map as they are in the table.
fn measured_before(map: &Map) -> Result<Vec<Cell>, Box<dyn Error>> {
    let mut found = Vec::new();
    for row in csv::Reader::from_path(format!("{FOLDER}/maps.csv"))?.into_records() {
        let row = row?;
        if row.get(0) != Some(map.id) {
            continue;
        }
        let k = found.len();
        let at = [map.axes[0].value(k % CELLS, CELLS), map.axes[1].value(k / CELLS, CELLS)];
        let verdict = Verdict::ALL.into_iter().find(|v| row.get(4) == Some(v.name()));
        let verdict = verdict.ok_or_else(|| format!("{}: no verdict in {row:?}", map.id))?;
        found.push(Cell { at, verdict, error: row.get(5).and_then(|e| e.parse().ok()) });
    }
    match found.len() == CELLS * CELLS {
        true => Ok(found),
        false => Err(format!("{}: {} cells in the table", map.id, found.len()).into()),
    }
}

/// Returns how many cells have each verdict, but for none.
fn counts(cells: &[Cell]) -> Vec<String> {
    let count = |v: Verdict| cells.iter().filter(|c| c.verdict == v).count();
    Verdict::ALL.iter().filter(|v| count(**v) > 0).map(|v| format!("{} {}", count(*v), v.name())).collect()
}

/// The maps on which a method is right everywhere.
fn without_an_end(measured: &[(Map, Vec<Cell>)]) -> Vec<&'static str> {
    let right = |cells: &[Cell]| cells.iter().all(|c| c.verdict == Verdict::Right);
    measured.iter().filter(|(_, cells)| right(cells)).map(|(map, _)| map.id).collect()
}

fn table(measured: &[(Map, Vec<Cell>)]) -> Result<(), Box<dyn Error>> {
    let mut csv = csv::Writer::from_path(format!("{FOLDER}/maps.csv"))?;
    csv.write_record(["map", "model", "x", "y", "verdict", "error"])?;
    for (map, cells) in measured {
        for c in cells {
            let error = c.error.map_or_else(String::new, |e| format!("{e:.2e}"));
            let [x, y] = c.at.map(|v| format!("{v:.4e}"));
            csv.write_record([map.id, map.model.name(), &x, &y, c.verdict.name(), &error])?;
        }
    }
    Ok(csv.flush()?)
}

/// A number on an axis.
fn short(value: f64) -> String {
    if value != 0.0 && !(1e-2..1e4).contains(&value.abs()) { format!("{value:.0e}") } else { format!("{value:.3}") }
}

fn picture(measured: &[(Map, Vec<Cell>)]) -> String {
    let side = SIDE * CELLS as f64;
    let [left, above, right, below] = ROOM;
    let (w, h) = (left + side + right, above + side + below);
    let rows = measured.len().div_ceil(COLUMNS);
    let (width, height) = (w * COLUMNS as f64, h * rows as f64 + 40.0);
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" font-family="sans-serif" font-size="11" fill="#222">
<rect width="{width}" height="{height}" fill="#fff"/>"##
    );
    let mut x = 16.0;
    for v in Verdict::ALL {
        let _ = writeln!(
            out,
            r#"<rect x="{x}" y="12" width="14" height="14" fill="{}"/><text x="{}" y="24">{}</text>"#,
            v.colour(),
            x + 20.0,
            v.name()
        );
        x += 50.0 + 6.5 * v.name().len() as f64;
    }
    for (k, (map, cells)) in measured.iter().enumerate() {
        let (x0, y0) = ((k % COLUMNS) as f64 * w + left, (k / COLUMNS) as f64 * h + above + 40.0);
        let _ = writeln!(out, r#"<text x="{x0}" y="{}" font-size="13" font-weight="bold">{}</text>"#, y0 - 8.0, map.id);
        for (i, c) in cells.iter().enumerate() {
            let (x, y) = (x0 + SIDE * (i % CELLS) as f64, y0 + side - SIDE * ((i / CELLS) as f64 + 1.0));
            let _ = writeln!(
                out,
                r#"<rect x="{x}" y="{y}" width="{SIDE}" height="{SIDE}" fill="{}"/>"#,
                c.verdict.colour()
            );
        }
        let [x, y] = map.axes;
        let bottom = y0 + side;
        let _ = writeln!(out, r#"<text x="{x0}" y="{}">{}</text>"#, bottom + 14.0, short(x.range[0]));
        let end = x0 + side;
        let _ =
            writeln!(out, r#"<text x="{end}" y="{}" text-anchor="end">{}</text>"#, bottom + 14.0, short(x.range[1]));
        let _ = writeln!(
            out,
            r#"<text x="{}" y="{}" text-anchor="middle">{}</text>"#,
            x0 + 0.5 * side,
            bottom + 30.0,
            x.label
        );
        let _ = writeln!(out, r#"<text x="{}" y="{bottom}" text-anchor="end">{}</text>"#, x0 - 5.0, short(y.range[0]));
        let _ =
            writeln!(out, r#"<text x="{}" y="{}" text-anchor="end">{}</text>"#, x0 - 5.0, y0 + 10.0, short(y.range[1]));
        let (lx, ly) = (x0 - 52.0, y0 + 0.5 * side);
        let _ = writeln!(
            out,
            r#"<text x="{lx}" y="{ly}" text-anchor="middle" transform="rotate(-90 {lx} {ly})">{}</text>"#,
            y.label
        );
    }
    out.push_str("</svg>\n");
    out
}

fn page(measured: &[(Map, Vec<Cell>)], wrong: usize) -> String {
    let mut out = format!(
        "# Maps of stability

This page shows what each model does over two parameters, in {CELLS} × {CELLS} cells, against a closed form.
`cargo run --release -p cable-benches --bin stability-maps` makes it. A refusal where another model is right
counts against the model and has a colour of its own. Of {} cells {wrong} are wrong in silence. Figures are in
[maps.csv](maps.csv).

![Maps of stability](maps.svg)

| map | asked | right up to | cells |
|---|---|---|---|
",
        measured.len() * CELLS * CELLS
    );
    for (map, cells) in measured {
        let _ = writeln!(out, "| {} | {} | {:.0e} | {} |", map.id, map.about, map.tolerance, counts(cells).join(", "));
    }
    let endless = without_an_end(measured);
    if !endless.is_empty() {
        let _ = writeln!(out, "\nOn {} no cell lies beyond the end of the method.", endless.join(", "));
    }
    out
}
