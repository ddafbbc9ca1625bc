//! A graph is written to a file: CSV in SI units, SVG and PNG as drawn.

use std::fmt::Write as _;
use std::path::Path;

use cable_core::files;

use crate::record::series::Series;
use crate::render::colour::LINES;
use crate::units::format::round_step;

/// What is in view of a graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// Its title.
    pub title: String,
    /// What goes right: name with unit for people, and for a column.
    pub across: [String; 2],
    /// What goes up, the same, and how many SI units its unit holds.
    pub up: [String; 2],
    /// SI units in one unit shown, across and up.
    pub si: [f64; 2],
    /// Left, bottom, right, top in the units shown.
    pub bounds: [f64; 4],
    /// The lines, every sample, SI.
    pub lines: Vec<Series>,
    /// Service and breaking limit, SI; those that are not finite or not in view are left out.
    pub limits: [f64; 2],
}

/// What the limits are called, and their colours.
const LIMITS: [(&str, [u8; 3]); 2] = [("service limit", [196, 122, 0]), ("breaking limit", [213, 60, 40])];

/// The limits that are in view, in the unit shown.
fn limits(sheet: &Sheet) -> impl Iterator<Item = (f64, &'static str, [u8; 3])> {
    let [_, bottom, _, top] = sheet.bounds;
    let shown = sheet.limits.map(|limit| limit / sheet.si[1]);
    let named = shown.into_iter().zip(LIMITS).map(|(limit, (name, colour))| (limit, name, colour));
    named.filter(move |(limit, ..)| limit.is_finite() && *limit > bottom && *limit < top)
}

/// Size of a drawing, points.
const SIZE: [f64; 2] = [800.0, 420.0];
/// Room for numbers and names round it: left, top, right, bottom; for each line of the legend more.
const ROOM: [f64; 4] = [70.0, 28.0, 24.0, 52.0];
/// Height of a line of the legend, points.
const LEGEND_LINE: f64 = 16.0;
/// Length of a line's sample in the legend, points.
const SWATCH: f64 = 20.0;
/// Width of a letter, points: fonts of a reader are wider or narrower, and must not overlap.
const LETTER: f64 = 7.0;

/// Where the entries of the legend stand, points from the left and lines from above, so that none
/// leaves the picture or lies on another; longer names are cut. Last: how many lines there are.
fn legend(sheet: &Sheet) -> (Vec<(String, f64, usize)>, usize) {
    let widest = SIZE[0] - ROOM[0] - ROOM[2];
    let most = ((widest - SWATCH - 6.0) / LETTER) as usize;
    let (mut at, mut row, mut entries) = (ROOM[0], 0, Vec::new());
    for line in &sheet.lines {
        let cut = line.name.chars().count() > most;
        let mut name: String = line.name.chars().take(if cut { most - 1 } else { most }).collect();
        if cut {
            name.push('…');
        }
        let width = SWATCH + 6.0 + LETTER * name.chars().count() as f64;
        if at > ROOM[0] && at + width > SIZE[0] - ROOM[2] {
            (at, row) = (ROOM[0], row + 1);
        }
        entries.push((name, at, row));
        at += width + 16.0;
    }
    (entries, if sheet.lines.is_empty() { 0 } else { row + 1 })
}

/// Writes what is in view in the format that the path's ending names.
///
/// # Errors
/// In words: another ending, or the path refuses.
pub fn save(path: &Path, sheet: &Sheet) -> Result<(), String> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let bytes = match ending.as_str() {
        "csv" => csv(sheet).into_bytes(),
        "svg" => svg(sheet).into_bytes(),
        "png" => png(sheet)?,
        _ => return Err("its name must end in .csv, .svg or .png".to_owned()),
    };
    files::write_atomic(path, &bytes).map_err(|e| e.to_string())
}

/// Points of a line in view, and one on each side of it so that it reaches the frame.
fn visible<'a>(line: &'a Series, sheet: &Sheet) -> &'a [[f64; 2]] {
    let [left, right] = [sheet.bounds[0], sheet.bounds[2]].map(|x| x * sheet.si[0]);
    let from = line.points.partition_point(|p| p[0] < left);
    let to = line.points.partition_point(|p| p[0] <= right).max(from);
    line.points.get(from..to).unwrap_or_default()
}

/// A row for each place, a column for each line; SI units, and the fewest digits that read back to
/// the same bits.
#[must_use]
pub fn csv(sheet: &Sheet) -> String {
    let name = |text: &str| text.to_lowercase().replace([' ', ',', '"', '\n', '\r'], "_");
    let mut out = sheet.across[1].clone();
    for line in &sheet.lines {
        let _ = write!(out, ",{}_{}", name(&line.name), sheet.up[1]);
    }
    out.push('\n');
    // Lines of a graph have the same places; one that has fewer leaves its cells empty.
    let longest = sheet.lines.iter().map(|l| visible(l, sheet)).max_by_key(|p| p.len()).unwrap_or_default();
    for (k, place) in longest.iter().enumerate() {
        let _ = write!(out, "{:?}", place[0]);
        for line in &sheet.lines {
            match visible(line, sheet).get(k).filter(|p| p[0] == place[0] && p[1].is_finite()) {
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

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The graph as a drawing.
#[must_use]
pub fn svg(sheet: &Sheet) -> String {
    let [left, bottom, right, top] = sheet.bounds;
    let (entries, rows) = legend(sheet);
    let under = ROOM[1] + LEGEND_LINE * rows as f64;
    let [width, height] = [SIZE[0] - ROOM[0] - ROOM[2], SIZE[1] - ROOM[1] - LEGEND_LINE - ROOM[3]];
    let x = |v: f64| ROOM[0] + (v - left) / (right - left) * width;
    let y = |v: f64| under + (top - v) / (top - bottom) * height;
    // The graph keeps its height however many lines are named above it.
    let [w, h] = [SIZE[0], under + height + ROOM[3]];
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"white\"/>\n\
         <clipPath id=\"c\"><rect x=\"{}\" y=\"{under}\" width=\"{width}\" height=\"{height}\"/></clipPath>\n",
        ROOM[0]
    );
    for (value, across) in ticks(left, right).map(|v| (v, true)).chain(ticks(bottom, top).map(|v| (v, false))) {
        let text = crate::units::format::significant(value, 4);
        let (x1, y1, x2, y2) = if across {
            (x(value), under, x(value), under + height)
        } else {
            (ROOM[0], y(value), ROOM[0] + width, y(value))
        };
        let _ = writeln!(out, "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"#ddd\"/>");
        let (tx, ty, anchor) = if across { (x1, y2 + 16.0, "middle") } else { (x1 - 6.0, y1 + 4.0, "end") };
        let _ = writeln!(out, "<text x=\"{tx:.2}\" y=\"{ty:.2}\" text-anchor=\"{anchor}\">{text}</text>");
    }
    for (k, line) in sheet.lines.iter().enumerate() {
        let c = LINES[line.reference.unwrap_or(k) % LINES.len()];
        let dashes = if line.reference.is_some() { " stroke-dasharray=\"6 4\"" } else { "" };
        let colour = format!("#{:02x}{:02x}{:02x}", c.r(), c.g(), c.b());
        let points = visible(line, sheet).iter().filter(|p| p[1].is_finite());
        let path: Vec<String> =
            points.map(|p| format!("{:.2},{:.2}", x(p[0] / sheet.si[0]), y(p[1] / sheet.si[1]))).collect();
        let _ = writeln!(
            out,
            "<polyline clip-path=\"url(#c)\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.8\"{dashes} points=\"{}\"/>",
            path.join(" ")
        );
        if let Some((name, at, row)) = entries.get(k) {
            let low = ROOM[1] + LEGEND_LINE * *row as f64 + 8.0;
            let _ = writeln!(
                out,
                "<line x1=\"{at}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{colour}\" stroke-width=\"2.5\"{dashes}/>\n\
                 <text x=\"{}\" y=\"{low}\">{}</text>",
                low - 4.0,
                at + SWATCH,
                low - 4.0,
                at + SWATCH + 6.0,
                escaped(name)
            );
        }
    }
    for (limit, name, [r, g, b]) in limits(sheet) {
        let (at, right, colour) = (y(limit), ROOM[0] + width, format!("#{r:02x}{g:02x}{b:02x}"));
        let _ = writeln!(
            out,
            "<line x1=\"{}\" y1=\"{at:.2}\" x2=\"{right}\" y2=\"{at:.2}\" stroke=\"{colour}\" stroke-dasharray=\"8 4\"/>\n\
             <text x=\"{}\" y=\"{:.2}\" text-anchor=\"end\" fill=\"{colour}\">{name} {}</text>",
            ROOM[0],
            right - 6.0,
            // Below a limit that lies at the top: beside the names above the graph it would be
            // taken for one.
            if at - 18.0 < under { at + 14.0 } else { at - 5.0 },
            crate::units::format::significant(limit, 4)
        );
    }
    let (middle, low) = (ROOM[0] + width / 2.0, h - 14.0);
    let _ = writeln!(
        out,
        "<rect x=\"{}\" y=\"{}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"#444\"/>\n\
         <text x=\"{middle}\" y=\"{low}\" text-anchor=\"middle\">{}</text>\n\
         <text x=\"16\" y=\"{}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {})\">{}</text>\n\
         <text x=\"{}\" y=\"18\" font-weight=\"bold\">{}</text>\n</svg>",
        ROOM[0],
        under,
        escaped(&sheet.across[0]),
        under + height / 2.0,
        under + height / 2.0,
        escaped(&sheet.up[0]),
        ROOM[0],
        escaped(&sheet.title)
    );
    out
}

/// Round numbers between two, about six of them.
fn ticks(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let step = round_step(high - low, 6.0);
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first).clamp(0.0, 20.0) as u32;
    (0..=count).map(move |k| (first + f64::from(k)) * step)
}

/// The graph as a picture, drawn without a window.
fn png(sheet: &Sheet) -> Result<Vec<u8>, String> {
    let sheet = sheet.clone();
    let size = SIZE.map(|s| s as f32);
    let mut harness = egui_kittest::Harness::builder()
        .with_size(size)
        .with_pixels_per_point(2.0)
        .with_theme(egui::Theme::Light)
        .with_render_cursor(false)
        .with_accessibility_check(false)
        .renderer(crate::render::offscreen::renderer()?)
        .build_ui(move |ui| {
            crate::render::theme::install(ui.ctx());
            // The paper reaches the edges, and nothing on it touches them.
            ui.painter().rect_filled(ui.ctx().content_rect(), 0.0, ui.visuals().panel_fill);
            ui.strong(&sheet.title);
            let [left, bottom, right, top] = sheet.bounds;
            egui_plot::Plot::new("export")
                .x_axis_label(sheet.across[0].clone())
                .y_axis_label(sheet.up[0].clone())
                .y_axis_min_width(60.0)
                .legend(egui_plot::Legend::default())
                .height(size[1] - 50.0)
                .show(ui, |plot| {
                    plot.set_plot_bounds(egui_plot::PlotBounds::from_min_max([left, bottom], [right, top]));
                    for (k, line) in sheet.lines.iter().enumerate() {
                        let (colour, style) = crate::record::series::line_style(line, k);
                        let points: Vec<[f64; 2]> =
                            visible(line, &sheet).iter().map(|p| [p[0] / sheet.si[0], p[1] / sheet.si[1]]).collect();
                        let drawn = egui_plot::Line::new(line.name.clone(), points).color(colour).width(2.0);
                        plot.line(drawn.style(style));
                    }
                    for (limit, name, [r, g, b]) in limits(&sheet) {
                        let text = format!("{name} {}", crate::units::format::significant(limit, 4));
                        let line = egui_plot::HLine::new(text, limit).color(egui::Color32::from_rgb(r, g, b));
                        plot.hline(line.style(egui_plot::LineStyle::dashed_loose()));
                    }
                });
        });
    harness.run_steps(3);
    let picture = harness.render()?;
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).map_err(|e| e.to_string())?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet() -> Sheet {
        let line = |name: &str, f: fn(f64) -> f64| Series {
            name: name.to_owned(),
            points: (0..100).map(|k| f64::from(k) / 10.0).map(|x| [x, f(x)]).collect(),
            ..Series::default()
        };
        Sheet {
            title: "Over <time>".to_owned(),
            across: ["Time, s".to_owned(), "time_s".to_owned()],
            up: ["Tension, kN".to_owned(), "tension_n".to_owned()],
            si: [1.0, 1e3],
            bounds: [2.0, 0.0, 5.0, 1.0],
            limits: [800.0, 10e3],
            lines: vec![line("Maximum", |x| 100.0 * x.sin() + 0.1), line("At left, end", |x| 1.0 / (x - 3.0))],
        }
    }

    #[test]
    fn the_table_has_what_is_in_view_bit_for_bit() {
        let text = csv(&sheet());
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
    fn the_drawing_is_well_formed_and_clipped() {
        let text = svg(&sheet());
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
        assert!(text.contains("Over &lt;time&gt;") && text.matches("<polyline").count() == 2 && !text.contains("NaN"));
        assert!(text.contains("service limit") && !text.contains("breaking limit"), "10 kN is not in view");
        assert!(!svg(&Sheet { bounds: [0.0, 0.0, 1.0, 1.0], si: [1.0; 2], ..Sheet::default() }).contains("NaN"));
    }

    /// From the sixth line on names stood outside the picture, and long ones lay on the next.
    #[test]
    fn names_in_a_drawing_neither_leave_it_nor_lie_on_each_other() {
        let name = |k: usize| format!("Maximum of pinned run number {k}, tank out and back");
        let lines = (0..9).map(|k| Series { name: name(k), ..sheet().lines[0].clone() });
        let mut many = Sheet { lines: lines.collect(), ..sheet() };
        many.lines[3].name = "a name without end ".repeat(20);
        let (entries, rows) = legend(&many);
        let end = |(name, at, _): &(String, f64, usize)| at + SWATCH + 6.0 + LETTER * name.chars().count() as f64;
        assert!(entries.iter().all(|e| end(e) <= SIZE[0] && e.2 < rows), "{entries:?}");
        assert!(entries.windows(2).all(|e| e[0].2 < e[1].2 || end(&e[0]) < e[1].1), "{entries:?}");
        let text = svg(&many);
        let height: f64 = text.split("height=\"").nth(1).and_then(|t| t.split('"').next()).unwrap().parse().unwrap();
        for y in text.split(" y=\"").skip(1).filter_map(|t| t.split('"').next()) {
            assert!((0.0..height).contains(&y.parse::<f64>().unwrap()), "{y} of {height}");
        }
        assert!(text.contains("service limit 0.8000"));
    }

    #[test]
    fn other_endings_are_refused_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let error = save(&folder.path().join("graph.xls"), &sheet()).unwrap_err();
        assert!(error.contains(".csv"), "{error}");
    }
}
