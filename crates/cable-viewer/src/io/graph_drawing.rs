//! A graph as a drawing: it is laid out once, and written as SVG or painted as PNG.

use std::fmt::Write as _;

use egui::epaint::TextShape;
use egui::{Color32, FontId, Mesh, Pos2, Shape, Stroke, Ui};

use crate::io::graph_in_view::{GraphInView, RIBBON, visible};
use crate::io::picture_file;
use crate::render::colour::LINES;
use crate::render::offscreen::Offscreen;
use crate::units::format::{magnitude, round_step, significant};

/// Names of the limits, and their colours.
const LIMITS: [(&str, [u8; 3]); 2] = [("service limit", [196, 122, 0]), ("breaking limit", [213, 60, 40])];

/// The limits that are in view, in the unit shown.
fn limits(graph: &GraphInView) -> impl Iterator<Item = (f64, &'static str, [u8; 3])> {
    let [_, bottom, _, top] = graph.bounds;
    let shown = graph.limits.map(|limit| limit / graph.si[1]);
    let named = shown.into_iter().zip(LIMITS).map(|(limit, (name, colour))| (limit, name, colour));
    named.filter(move |(limit, ..)| limit.is_finite() && *limit > bottom && *limit < top)
}

/// Size of a drawing, points.
const SIZE: [f64; 2] = [800.0, 420.0];
/// Room for numbers and names round it: left, top, right, bottom; for each line of the legend more.
const MARGINS: [f64; 4] = [70.0, 28.0, 24.0, 52.0];
/// Height of a line of the legend, points.
const LEGEND_LINE: f64 = 16.0;
/// Length of a line's sample in the legend, points.
const SWATCH: f64 = 20.0;
/// Width of a letter, points: fonts of a reader are wider or narrower, and must not overlap.
const LETTER_WIDTH: f64 = 7.0;

/// The name of a line above the graph.
#[derive(Debug)]
struct LegendEntry {
    name: String,
    /// Its place, points from the left.
    at: f64,
    /// Its place, lines from above.
    row: usize,
}

/// The entries of the legend with their places, so that none
/// leaves the picture or lies on another; longer names are cut. Lines come first, then the ribbon.
/// Last: how many lines of text there are.
fn legend(graph: &GraphInView) -> (Vec<LegendEntry>, usize) {
    let widest = SIZE[0] - MARGINS[0] - MARGINS[2];
    let most = ((widest - SWATCH - 6.0) / LETTER_WIDTH) as usize;
    let (mut at, mut row, mut entries) = (MARGINS[0], 0, Vec::new());
    let ribbon = (!graph.known_ribbon().is_empty()).then_some(RIBBON);
    for name in graph.lines.iter().map(|l| l.name.as_str()).chain(ribbon) {
        let cut = name.chars().count() > most;
        let mut name: String = name.chars().take(if cut { most - 1 } else { most }).collect();
        if cut {
            name.push('…');
        }
        let width = SWATCH + 6.0 + LETTER_WIDTH * name.chars().count() as f64;
        if at > MARGINS[0] && at + width > SIZE[0] - MARGINS[2] {
            (at, row) = (MARGINS[0], row + 1);
        }
        entries.push(LegendEntry { name, at, row });
        at += width + 16.0;
    }
    let rows = if entries.is_empty() { 0 } else { row + 1 };
    (entries, rows)
}

/// Strength of the ribbon's colour on white paper, per cent of that of its line.
const RIBBON_PERCENT: u16 = 28;
/// Size of letters, points.
const FONT_SIZE: f64 = 12.0;
/// Pixels of a PNG in a point: sharp on paper and on dense screens.
const PNG_PIXELS_PER_POINT: f32 = 2.0;
/// Colour of the grid; those of the frame and of text follow.
const GRID: [u8; 3] = [221; 3];
const FRAME: [u8; 3] = [68; 3];
const TEXT_COLOUR: [u8; 3] = [0; 3];

/// Stroke of a line: colour, width and lengths of dashes and gaps (points), if it has any.
type StrokeStyle = ([u8; 3], f64, Option<[f64; 2]>);

/// One mark of a drawing, in points from the left and from above.
#[derive(Debug)]
enum GraphMark {
    /// Straight from one place to another.
    Line([[f64; 2]; 2], StrokeStyle),
    /// From place to place, as far as it lies in the frame.
    Path(Vec<[f64; 2]>, StrokeStyle),
    /// Filled between places above and below each other, as far as it lies in the frame: across,
    /// upper and lower.
    Area(Vec<[f64; 3]>, [u8; 3]),
    /// Words on a base line.
    Text(TextLabel),
}

/// Side of its place on which a word stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TextAnchor {
    Start,
    Middle,
    End,
}

/// Words on a base line.
#[derive(Debug)]
struct TextLabel {
    at: [f64; 2],
    anchor: TextAnchor,
    colour: [u8; 3],
    text: String,
    /// They read upwards.
    upwards: bool,
    /// They are the title.
    title: bool,
}

impl TextLabel {
    fn new(at: [f64; 2], anchor: TextAnchor, text: impl Into<String>) -> Self {
        Self { at, anchor, colour: TEXT_COLOUR, text: text.into(), upwards: false, title: false }
    }
}

/// A graph, laid out.
#[derive(Debug)]
struct Drawing {
    size: [f64; 2],
    /// Left, top, right and bottom of what is plotted.
    frame: [f64; 4],
    marks: Vec<GraphMark>,
}

impl Drawing {
    /// The drawing of a graph as it is in view.
    fn of(graph: &GraphInView) -> Self {
        let (entries, rows) = legend(graph);
        let under = MARGINS[1] + LEGEND_LINE * rows as f64;
        let [width, height] = [SIZE[0] - MARGINS[0] - MARGINS[2], SIZE[1] - MARGINS[1] - LEGEND_LINE - MARGINS[3]];
        let frame = [MARGINS[0], under, MARGINS[0] + width, under + height];
        // The graph keeps its height however many lines are named above it.
        let size = [SIZE[0], frame[3] + MARGINS[3]];
        let mut drawing = Self { size, frame, marks: Vec::new() };
        drawing.ribbon(graph, entries.last());
        drawing.grid(graph);
        for k in 0..graph.lines.len() {
            drawing.line(graph, k, entries.get(k));
        }
        drawing.limits(graph);
        drawing.titles(graph);
        drawing
    }

    /// Where a value of the horizontal axis is.
    fn x(&self, graph: &GraphInView, v: f64) -> f64 {
        let [left, _, right, _] = graph.bounds;
        self.frame[0] + (v - left) / (right - left) * (SIZE[0] - MARGINS[0] - MARGINS[2])
    }

    /// Where a value of the vertical axis is.
    fn y(&self, graph: &GraphInView, v: f64) -> f64 {
        let [_, bottom, _, top] = graph.bounds;
        self.frame[1] + (top - v) / (top - bottom) * (SIZE[1] - MARGINS[1] - LEGEND_LINE - MARGINS[3])
    }

    /// The name of a line above the graph, beside a sample of it.
    fn legend_entry(&mut self, LegendEntry { name, at, row }: &LegendEntry, pen: StrokeStyle) {
        let low = MARGINS[1] + LEGEND_LINE * *row as f64 + 8.0;
        self.marks.push(GraphMark::Line([[*at, low - 4.0], [at + SWATCH, low - 4.0]], pen));
        self.marks.push(GraphMark::Text(TextLabel::new([at + SWATCH + 6.0, low], TextAnchor::Start, name)));
    }

    /// Adds the area between the ranges of the friction search.
    fn ribbon(&mut self, graph: &GraphInView, entry: Option<&LegendEntry>) {
        let ribbon = graph.known_ribbon();
        if ribbon.is_empty() {
            return;
        }
        let [r, g, b, _] = LINES[0].to_array();
        let colour = [r, g, b].map(|c| 255 - ((255 - u16::from(c)) * RIBBON_PERCENT / 100) as u8);
        let area = ribbon.iter().map(|r| [self.x(graph, r[0]), self.y(graph, r[2]), self.y(graph, r[1])]).collect();
        self.marks.push(GraphMark::Area(area, colour));
        if let Some(entry) = entry {
            self.legend_entry(entry, (colour, 8.0, None));
        }
    }

    /// Adds grid lines with their numbers.
    fn grid(&mut self, graph: &GraphInView) {
        let ([left, bottom, right, top], frame) = (graph.bounds, self.frame);
        for v in ticks(left, right) {
            let x = self.x(graph, v);
            self.marks.push(GraphMark::Line([[x, frame[1]], [x, frame[3]]], (GRID, 1.0, None)));
            let at = [x, frame[3] + 16.0];
            self.marks.push(GraphMark::Text(TextLabel::new(at, TextAnchor::Middle, tick_text(v, [left, right]))));
        }
        for v in ticks(bottom, top) {
            let y = self.y(graph, v);
            self.marks.push(GraphMark::Line([[frame[0], y], [frame[2], y]], (GRID, 1.0, None)));
            let text = tick_text(v, [bottom, top]);
            self.marks.push(GraphMark::Text(TextLabel::new([frame[0] - 6.0, y + 4.0], TextAnchor::End, text)));
        }
    }

    /// Adds line `k` of the graph and its entry in the legend.
    fn line(&mut self, graph: &GraphInView, k: usize, entry: Option<&LegendEntry>) {
        let line = &graph.lines[k];
        let [r, g, b, _] = LINES[line.reference.unwrap_or(k) % LINES.len()].to_array();
        let pen = |width: f64| ([r, g, b], width, line.reference.map(|_| [6.0, 4.0]));
        let points = visible(line, graph).iter().filter(|p| p[1].is_finite());
        let path = points.map(|p| [self.x(graph, p[0] / graph.si[0]), self.y(graph, p[1] / graph.si[1])]).collect();
        self.marks.push(GraphMark::Path(path, pen(1.8)));
        if let Some(entry) = entry {
            self.legend_entry(entry, pen(2.5));
        }
    }

    /// Adds the limits of the cable with their names.
    fn limits(&mut self, graph: &GraphInView) {
        let [left, under, right, _] = self.frame;
        for (limit, name, colour) in limits(graph) {
            let at = self.y(graph, limit);
            self.marks.push(GraphMark::Line([[left, at], [right, at]], (colour, 1.0, Some([8.0, 4.0]))));
            // A limit at the top has its name below it: beside the names above the graph it would
            // be taken for one.
            let low = if at - 18.0 < under { at + 14.0 } else { at - 5.0 };
            let unit = graph.up[0].rsplit_once(", ").map_or("", |(_, unit)| unit);
            let text = format!("{name} {} {unit}", significant(limit, 4));
            let words = TextLabel::new([right - 6.0, low], TextAnchor::End, text.trim_end());
            self.marks.push(GraphMark::Text(TextLabel { colour, ..words }));
        }
    }

    /// The names of the axes and the title.
    fn titles(&mut self, graph: &GraphInView) {
        let ([left, top, right, bottom], height) = (self.frame, self.size[1]);
        let middle = [(left + right) / 2.0, (top + bottom) / 2.0];
        let across = TextLabel::new([middle[0], height - 14.0], TextAnchor::Middle, &graph.across[0]);
        let up = TextLabel::new([16.0, middle[1]], TextAnchor::Middle, &graph.up[0]);
        let title = TextLabel::new([MARGINS[0], 18.0], TextAnchor::Start, &graph.title);
        self.marks.push(GraphMark::Text(across));
        self.marks.push(GraphMark::Text(TextLabel { upwards: true, ..up }));
        self.marks.push(GraphMark::Text(TextLabel { title: true, ..title }));
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The graph as SVG.
#[must_use]
pub fn svg(graph: &GraphInView) -> String {
    let Drawing { size: [w, h], frame, marks } = Drawing::of(graph);
    let [left, top, width, height] = [frame[0], frame[1], frame[2] - frame[0], frame[3] - frame[1]];
    let inside = format!("<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"");
    let hex = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
    let stroke = |(colour, width, dashes): &StrokeStyle| {
        let dashes = dashes.map_or_else(String::new, |[dash, gap]| format!(" stroke-dasharray=\"{dash} {gap}\""));
        format!("stroke=\"{}\" stroke-width=\"{width}\"{dashes}", hex(*colour))
    };
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"sans-serif\" font-size=\"{FONT_SIZE}\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"white\"/>\n\
         <clipPath id=\"c\">{inside}/></clipPath>\n"
    );
    for mark in &marks {
        let _ = match mark {
            GraphMark::Line([[x1, y1], [x2, y2]], pen) => {
                let stroke = stroke(pen);
                writeln!(out, "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" {stroke}/>")
            }
            GraphMark::Path(points, pen) => {
                let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
                let (points, stroke) = (points.join(" "), stroke(pen));
                writeln!(out, "<polyline clip-path=\"url(#c)\" fill=\"none\" {stroke} points=\"{points}\"/>")
            }
            GraphMark::Area(places, colour) => {
                let upper = places.iter().map(|[x, y, _]| format!("{x:.2},{y:.2}"));
                let lower = places.iter().rev().map(|[x, _, y]| format!("{x:.2},{y:.2}"));
                let (points, fill) = (upper.chain(lower).collect::<Vec<_>>().join(" "), hex(*colour));
                writeln!(out, "<polygon clip-path=\"url(#c)\" fill=\"{fill}\" points=\"{points}\"/>")
            }
            GraphMark::Text(words) => {
                let [x, y] = words.at;
                let anchor = match words.anchor {
                    TextAnchor::Start => "start",
                    TextAnchor::Middle => "middle",
                    TextAnchor::End => "end",
                };
                let turn = if words.upwards { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
                let weight = if words.title { " font-weight=\"bold\"" } else { "" };
                let (fill, text) = (hex(words.colour), escaped(&words.text));
                writeln!(
                    out,
                    "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\" fill=\"{fill}\"{turn}{weight}>{text}</text>"
                )
            }
        };
    }
    let _ = writeln!(out, "{inside} fill=\"none\" stroke=\"{}\"/>\n</svg>", hex(FRAME));
    out
}

/// The graph as PNG, drawn without a window or a graphics adapter.
///
/// # Errors
/// In words: the picture cannot be encoded.
pub fn png(graph: &GraphInView) -> Result<Vec<u8>, String> {
    let drawing = Drawing::of(graph);
    let mut offscreen = Offscreen::new(drawing.size.map(|s| s.ceil() as u32), PNG_PIXELS_PER_POINT);
    crate::render::theme::install(offscreen.ctx());
    // The font knows its letters from the second frame on.
    for _ in 0..2 {
        offscreen.frame(|ui| {
            paint(ui, &drawing);
        });
    }
    picture_file::png(&offscreen.picture(Color32::WHITE))
}

/// Paints a drawing; returns where its words stand.
fn paint(ui: &Ui, drawing: &Drawing) -> Vec<egui::Rect> {
    let place = |[x, y]: [f64; 2]| Pos2::new(x as f32, y as f32);
    let paper = ui.painter().with_clip_rect(ui.ctx().content_rect());
    let [left, top, right, bottom] = drawing.frame;
    let frame = egui::Rect::from_min_max(place([left, top]), place([right, bottom]));
    let plot = paper.with_clip_rect(frame);
    let colour = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
    let line = |painter: &egui::Painter, points: Vec<Pos2>, (ink, width, dashes): &StrokeStyle| {
        let stroke = Stroke::new(*width as f32, colour(*ink));
        match dashes {
            Some([dash, gap]) => painter.extend(Shape::dashed_line(&points, stroke, *dash as f32, *gap as f32)),
            None => drop(painter.add(Shape::line(points, stroke))),
        }
    };
    let mut words = Vec::new();
    for mark in &drawing.marks {
        match mark {
            GraphMark::Line(ends, pen) => line(&paper, ends.map(place).to_vec(), pen),
            GraphMark::Path(points, pen) => line(&plot, points.iter().copied().map(place).collect(), pen),
            GraphMark::Area(places, ink) => {
                let mut mesh = Mesh::default();
                for [x, upper, lower] in places {
                    let next = mesh.vertices.len() as u32;
                    mesh.colored_vertex(place([*x, *upper]), colour(*ink));
                    mesh.colored_vertex(place([*x, *lower]), colour(*ink));
                    if next > 0 {
                        mesh.add_triangle(next - 2, next - 1, next);
                        mesh.add_triangle(next - 1, next + 1, next);
                    }
                }
                plot.add(mesh);
            }
            GraphMark::Text(text) => words.push(write(&paper, text)),
        }
    }
    paper.rect_stroke(frame, 0.0, Stroke::new(1.0, colour(FRAME)), egui::StrokeKind::Middle);
    words
}

/// Paints words; returns where they stand.
fn write(painter: &egui::Painter, words: &TextLabel) -> egui::Rect {
    let [r, g, b] = words.colour;
    let size = FONT_SIZE as f32 * if words.title { 1.15 } else { 1.0 };
    let colour = Color32::from_rgb(r, g, b);
    let galley = painter.layout_no_wrap(words.text.clone(), FontId::proportional(size), colour);
    // Words of SVG stand on their base line: that is where the first row has it.
    let ascent = galley.rows.first().and_then(|row| row.glyphs.first()).map_or(size, |g| g.pos.y);
    let shift = match words.anchor {
        TextAnchor::Start => 0.0,
        TextAnchor::Middle => 0.5,
        TextAnchor::End => 1.0,
    } * galley.size().x;
    let at = Pos2::new(words.at[0] as f32, words.at[1] as f32);
    let (corner, angle) = if words.upwards {
        (at + egui::vec2(-ascent, shift), -std::f32::consts::FRAC_PI_2)
    } else {
        (at - egui::vec2(shift, ascent), 0.0)
    };
    let text = TextShape::new(corner, galley, colour).with_angle(angle);
    let rect = text.visual_bounding_rect();
    painter.add(text);
    rect
}

/// Round numbers between two, about six of them.
fn ticks(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let step = round_step(high - low, 6.0);
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first).clamp(0.0, 20.0) as u32;
    (0..=count).map(move |k| (first + f64::from(k)) * step)
}

/// A number at a line of the grid, with as many decimals as tell it from the next.
fn tick_text(value: f64, [low, high]: [f64; 2]) -> String {
    let step = round_step(high - low, 6.0);
    let decimals = (-(step.log10() + 1e-9).floor()).max(0.0);
    if !(decimals <= 4.0 && low.abs().max(high.abs()) < 1e5) {
        let text = significant(value, 4);
        // Lines of a grid are round: their powers of ten have no digits to spare.
        return if text.contains('^') { magnitude(value, 4) } else { text };
    }
    // A zero that rounding left below nothing has no sign.
    let text = format!("{:.*}", decimals as usize, value + 0.0);
    if text.trim_matches(['-', '0', '.']).is_empty() { text.replace('-', "") } else { text.replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::graph_in_view::sample as graph;
    use crate::record::series::Series;

    #[test]
    fn the_drawing_is_well_formed_and_clipped() {
        let text = svg(&graph());
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
        assert!(text.contains("Over &lt;time&gt;") && text.matches("<polyline").count() == 2 && !text.contains("NaN"));
        assert!(text.contains("service limit") && !text.contains("breaking limit"), "10 kN is not in view");
        assert!(
            !svg(&GraphInView { bounds: [0.0, 0.0, 1.0, 1.0], si: [1.0; 2], ..GraphInView::default() }).contains("NaN")
        );
    }

    /// From the sixth line on names stood outside the picture, and long ones lay on the next.
    #[test]
    fn names_in_a_drawing_neither_leave_it_nor_lie_on_each_other() {
        let name = |k: usize| format!("Maximum of pinned run number {k}, tank out and back");
        let lines = (0..9).map(|k| Series { name: name(k), ..graph().lines[0].clone() });
        let mut many = GraphInView { lines: lines.collect(), ..graph() };
        many.lines[3].name = "a name without end ".repeat(20);
        let (entries, rows) = legend(&many);
        let end = |e: &LegendEntry| e.at + SWATCH + 6.0 + LETTER_WIDTH * e.name.chars().count() as f64;
        assert!(entries.iter().all(|e| end(e) <= SIZE[0] && e.row < rows), "{entries:?}");
        assert!(entries.windows(2).all(|e| e[0].row < e[1].row || end(&e[0]) < e[1].at), "{entries:?}");
        let text = svg(&many);
        let height: f64 = text.split("height=\"").nth(1).and_then(|t| t.split('"').next()).unwrap().parse().unwrap();
        for y in text.split(" y=\"").skip(1).filter_map(|t| t.split('"').next()) {
            assert!((0.0..height).contains(&y.parse::<f64>().unwrap()), "{y} of {height}");
        }
        assert!(text.contains("service limit 0.8000 kN"));
    }

    /// Issue 20: the ribbon of less and more friction was left out of what is exported.
    #[test]
    fn issue_020_the_ribbon_of_friction_is_drawn_and_named() {
        let plain = graph();
        assert!(!svg(&plain).contains("<polygon") && !svg(&plain).contains(RIBBON));
        let ribbon = vec![[2.0, 200.0, 400.0], [3.0, f64::NAN, 500.0], [4.0, 300.0, 700.0]];
        let graph = GraphInView { ribbon, ..plain };
        let text = svg(&graph);
        assert!(text.contains("<polygon") && text.contains(RIBBON) && !text.contains("NaN"), "{text}");
        let drawing = Drawing::of(&graph);
        let picture = image::load_from_memory(&png(&graph).unwrap()).unwrap().to_rgb8();
        let [left, top, _, bottom] = drawing.frame;
        // At 3 s, in the middle of the ribbon: from 250 to 550 N of 0 to 1 kN.
        let pixel = |share: f64| {
            let at = [left + (SIZE[0] - MARGINS[0] - MARGINS[2]) / 3.0 + 5.0, bottom - share * (bottom - top)];
            picture.get_pixel((2.0 * at[0]) as u32, (2.0 * at[1]) as u32).0
        };
        assert_ne!(pixel(0.45), [255; 3]);
        assert_eq!([pixel(0.65), pixel(0.22)], [[255; 3]; 2]);
    }

    #[test]
    fn numbers_of_a_grid_have_as_many_decimals_as_they_need() {
        let texts = |low: f64, high: f64| ticks(low, high).map(|v| tick_text(v, [low, high])).collect::<Vec<_>>();
        assert_eq!(texts(2.4, 12.4), ["4", "6", "8", "10", "12"]);
        assert_eq!(texts(-0.2, 0.4)[..3], ["−0.2", "−0.1", "0.0"]);
        assert_eq!(texts(0.0, 3e6).last().map(String::as_str), Some("3000000"));
        assert!(texts(0.0, 1e-9).iter().all(|t| t.chars().count() < 10));
    }

    /// A graph with both limits in view and long names, as a run of hours has it.
    fn crowded() -> GraphInView {
        GraphInView {
            up: ["Tension, kN".to_owned(), "tension_n".to_owned()],
            bounds: [0.0, -0.000_012_345, 9.9, 10.2],
            ..graph()
        }
    }

    #[test]
    fn words_of_a_picture_are_whole_and_stand_clear_of_each_other() {
        let drawing = Drawing::of(&crowded());
        let mut offscreen = Offscreen::new(drawing.size.map(|s| s.ceil() as u32), PNG_PIXELS_PER_POINT);
        let mut words = Vec::new();
        for _ in 0..2 {
            offscreen.frame(|ui| words = paint(ui, &drawing));
        }
        assert!(words.len() > 15, "{}", words.len());
        let paper = egui::Rect::from_min_size(Pos2::ZERO, egui::vec2(drawing.size[0] as f32, drawing.size[1] as f32));
        for (k, rect) in words.iter().enumerate() {
            assert!(paper.shrink(2.0).contains_rect(*rect), "{rect:?} leaves {paper:?}");
            let other = words.iter().skip(k + 1).find(|o| o.shrink(1.0).intersects(rect.shrink(1.0)));
            assert!(other.is_none(), "{rect:?} lies on {other:?}");
        }
    }

    #[test]
    fn a_picture_has_the_limits_from_side_to_side_and_nothing_on_its_edges() {
        let graph = crowded();
        let picture = image::load_from_memory(&png(&graph).unwrap()).unwrap().to_rgb8();
        let drawing = Drawing::of(&graph);
        assert_eq!([picture.width(), picture.height()], drawing.size.map(|s| 2 * s as u32));
        let edge = |x: u32, y: u32| x < 4 || y < 4 || x + 4 >= picture.width() || y + 4 >= picture.height();
        assert!(picture.enumerate_pixels().all(|(x, y, p)| !edge(x, y) || p.0 == [255; 3]), "a mark is cut off");
        let near = |p: [u8; 3], c: [u8; 3]| p.iter().zip(c).all(|(a, b)| a.abs_diff(b) < 40);
        for (limit, name, colour) in limits(&graph) {
            let height = drawing.frame[3] - drawing.frame[1];
            let y = drawing.frame[1] + (10.2 - limit) / (10.2 + 0.000_012_345) * height;
            let rows = || (2.0 * y) as u32 - 1..=(2.0 * y) as u32 + 1;
            let columns = (2.0 * drawing.frame[0]) as u32..(2.0 * drawing.frame[2]) as u32;
            let drawn: Vec<u32> =
                columns.clone().filter(|x| rows().any(|y| near(picture.get_pixel(*x, y).0, colour))).collect();
            // Dashes of 8 points with gaps of 4.
            assert!(drawn.len() > columns.len() / 2, "{name}: {} of {}", drawn.len(), columns.len());
            assert!(drawn[0] < columns.start + 26 && drawn[drawn.len() - 1] + 26 > columns.end, "{name}");
        }
    }
}
