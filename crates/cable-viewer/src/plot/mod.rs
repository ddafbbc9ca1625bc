//! The graphs show quantities along the cable, and these, the robot and energies against time.
//!
//! - `along_cable`, `over_time`: what each graph shows
//! - `axes`: ranges, and the numbers along them
//! - `line_corners`: the pieces that a line is drawn in
//! - `cursors`, `keys`: reading values off it, and steering it without a pointer

pub mod along_cable;
mod axes;
mod cursors;
mod keys;
mod line_corners;
pub mod over_time;

use egui::{Align2, Color32, Id, Pos2, Rangef, Rect, RichText, Sense, Shape, Stroke, TextStyle, Ui, Vec2, vec2};
use egui_plot::{AxisHints, HLine, HoverPosition, LineStyle, Plot, PlotBounds, PlotResponse, PlotTransform, PlotUi};

use crate::io::graph_in_view::{GraphInView, RIBBON};
use crate::plot::axes::{AxisUnit, ends_across, grid_marks, tick_across, tick_with_unit, vertical_range};
use crate::plot::cursors::Cursors;
use crate::record::plotted_quantity::Measure;
use crate::record::series::{Series, line_style, value_at};
use crate::render::colour::{CableQuantity, LINES};
use crate::render::theme;
use crate::units::format::{quantity, significant};
use crate::units::unit::{DIGITS, Unit};
use crate::widgets::field;

/// The service limit.
pub const SERVICE: Color32 = Color32::from_rgb(196, 122, 0);
/// The breaking limit.
pub const BREAKING: Color32 = Color32::from_rgb(213, 60, 40);

/// The group of graphs over time.
pub const TIME: &str = "time";

/// The tolerance in the graph of errors over cost.
pub const TOLERANCE_MARK: Color32 = Color32::from_gray(118);
/// A cursor.
const CURSOR: Color32 = Color32::GRAY;
/// Zoom per point of wheel, as on the canvas.
const WHEEL: f32 = 0.0025;

/// Lowest graph that can still be read, points.
const MIN_HEIGHT: f32 = 42.0;
/// Distance of numbers on the horizontal axis, points: close enough to read between, far enough not
/// to touch.
const X_TICK_SPACING: f32 = 66.0;
/// Width of the numbers beside a graph, points.
const VALUES_WIDTH: f32 = 44.0;
/// Height of the numbers below a graph, points.
const TICK_LABELS_HEIGHT: f32 = 18.0;
/// Distance of numbers on the vertical axis, points.
const Y_TICK_SPACING: f32 = 24.0;

/// Room for the export button beside the legend, points.
const EXPORT_BUTTON_WIDTH: f32 = 62.0;

/// A held line that goes up and down by this many times its whole height is drawn solid and thin.
/// More: frames with long runs take longer; fewer: a few swings lose their dashes.
const OSCILLATION_RATIO: f64 = 40.0;

/// Opacity of the band between least and greatest. More: it hides the lines behind; less: it cannot
/// be told from the background.
const BAND_OPACITY: f32 = 0.45;

/// Half the size of the mark of a line that is one point, points.
const PEAK_RADIUS: f32 = 4.5;

/// Length of a line in the legend, points.
const SWATCH: f32 = 16.0;

/// The choices of the user for the graphs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraphView {
    /// The quantity that goes up.
    pub measure: Measure,
    /// The quantity that goes up in a second graph over time.
    pub second: Option<Measure>,
    /// The view follows the data.
    pub follow: bool,
    /// Length of the past that is shown, s; None = all of it.
    pub window_s: Option<f64>,
    /// The graph (by its title) whose export was asked for elsewhere than beside it.
    pub export: Option<&'static str>,
}

impl Default for GraphView {
    fn default() -> Self {
        Self {
            measure: Measure::Cable(CableQuantity::Tension),
            second: None,
            follow: true,
            window_s: Some(10.0),
            export: None,
        }
    }
}

/// The content and form of a graph.
pub struct Graph<'a> {
    /// Names the graph to tests and screen readers.
    pub title: &'a str,
    /// Graphs of one group have the same way right: their ends and their cursors are linked.
    pub group: &'a str,
    /// The quantity that goes up, and its unit.
    pub measure: Measure,
    /// The quantity that goes right, its unit, and the number of SI units in that, such as `Time`,
    /// `s`, 1.
    pub across: (&'a str, Unit),
    /// Left and right end in view while following, SI.
    pub range: [f64; 2],
    /// Last place that there are data of or that is in view, SI: cursors beyond it are forgotten.
    pub last: f64,
    /// Service and breaking limit, SI.
    pub limits: [f64; 2],
    /// The view follows the data; else it can be dragged and zoomed.
    pub follow: bool,
    /// Height, points.
    pub height: f32,
    /// Least and greatest value with less and more friction at places across, SI; empty where it is
    /// not known.
    pub ribbon: Vec<[f64; 3]>,
    /// A time to mark, where one is shown that is not the present.
    pub mark: Option<f64>,
    /// The way to something to show, where there is nothing yet.
    pub hint: Option<&'a str>,
    /// Its export was asked for elsewhere than beside it.
    pub export: bool,
}

/// The edits of the user to a graph.
#[derive(Debug, Default)]
pub struct GraphResponse {
    /// It was zoomed: it is not to follow the data any more.
    pub zoomed: bool,
    /// The time to show, s: the playhead was dragged.
    pub scrubbed_s: Option<f64>,
    /// It is to be exported: what is in view, with the lines as they were drawn.
    pub export: Option<Box<GraphInView>>,
}

/// The units and ranges in which a graph is drawn.
#[derive(Clone, Copy)]
struct GraphScale {
    /// The units of the horizontal axis and of the vertical one.
    across: AxisUnit,
    up: AxisUnit,
    /// Least and greatest value of the vertical axis, SI.
    low: f64,
    high: f64,
}

impl GraphScale {
    fn of(graph: &Graph<'_>, lines: &[Series]) -> Self {
        let [low, high] = vertical_range(lines, &graph.ribbon, graph.limits);
        let Unit { symbol, si, .. } = graph.across.1.display();
        let (up_symbol, up_si) = graph.measure.unit(high);
        Self { across: AxisUnit { symbol, si }, up: AxisUnit { symbol: up_symbol, si: up_si }, low, high }
    }

    /// The SI values of the units of both axes.
    fn si(&self) -> [f64; 2] {
        [self.across.si, self.up.si]
    }
}

/// Draws lines (SI values) with their limits.
pub fn show(ui: &mut Ui, graph: &Graph<'_>, lines: &[Series]) -> GraphResponse {
    let scale = GraphScale::of(graph, lines);
    let [x_si, si] = scale.si();
    let top = ui.cursor().top();
    let (title, export) = legend(ui, graph, lines);
    let mut cursors = Cursors::load(ui, graph.group);
    // Those of a run that is no more read nothing.
    cursors.forget_without_data(ui, graph.group, graph.last);
    let cursor_text = cursors.text(scale.across, scale.up, lines.first());
    let height = (graph.height - (ui.cursor().top() - top)).max(MIN_HEIGHT);
    let columns = f64::from(ui.available_width() / X_TICK_SPACING).max(1.0);
    let width = ui.available_width() - VALUES_WIDTH;
    let plot = axes(ui, graph, scale, [columns, f64::from(height)]).label_formatter(|at| {
        let (HoverPosition::NearDataPoint { position, .. } | HoverPosition::Elsewhere { position }) = at;
        Some(values_at(lines, position.x, scale.across, scale.up))
    });
    let moved_mark = moved_mark(ui, graph);
    let response = plot.show(ui, |plot| {
        set_bounds(plot, graph, scale, moved_mark);
        draw_ribbon(plot, &graph.ribbon, [x_si, si]);
        draw_lines(plot, graph, lines, [x_si, si]);
        draw_limits(plot, graph, scale.high, si);
        if let Some(hint) = graph.hint {
            let words = RichText::new(hint).color(plot.ctx().global_style().visuals.weak_text_color());
            plot.text(egui_plot::Text::new("hint", plot.plot_bounds().center(), words).allow_hover(false));
        }
        let places: Vec<f64> = cursors.0.iter().map(|x| x / x_si).collect();
        draw_marks(plot, &places, cursor_text.as_deref());
        let wheel = wheel(plot);
        let asked = keys::read(plot, places.last().copied());
        keys::KeyInput { zoomed: wheel || asked.zoomed, ..asked }
    });
    name_limits(ui, graph, &response.transform, scale.high, si);
    if let Some(mark) = graph.mark {
        draw_playhead(ui, &response.transform, mark / x_si);
    }
    write_ends_across(ui, &response.transform, columns, scale.across.symbol, width);
    move_cursors(ui, graph, &response, &mut cursors, x_si);
    let bounds = response.transform.bounds();
    let ends = [bounds.min()[0] * x_si, bounds.max()[0] * x_si];
    ui.data_mut(|d| d.insert_temp(Id::unique(("in view", graph.title)), ends));
    if response.response.has_focus() {
        let stroke = ui.visuals().selection.stroke;
        ui.painter().rect_stroke(response.response.rect, 2.0, stroke, egui::StrokeKind::Outside);
    }
    // A graph that follows is not moved by hand: a drag in it moves the playhead.
    let dragged = graph.follow && graph.group == TIME && response.response.dragged_by(egui::PointerButton::Primary);
    let at = response.response.interact_pointer_pos().filter(|_| dragged);
    let answer = GraphResponse {
        zoomed: response.inner.zoomed,
        scrubbed_s: at.map(|at| response.transform.value_from_position(at).x * x_si),
        export: (export || graph.export).then(|| Box::new(graph_in_view(graph, lines, scale.high, bounds))),
    };
    let figure = response.response.labelled_by(title);
    let ribbon = graph.ribbon.last().map(|r| r.map(|v| v / si));
    let spoken = SpokenGraph { title: graph.title, ribbon, lines, symbol: scale.up.symbol, si, cursors: cursor_text };
    set_accessible_text(&figure, &spoken);
    answer
}

/// Sets cursors where the pointer clicks and where keys ask for them, and stores what the pointer
/// is over.
fn move_cursors(
    ui: &mut Ui,
    graph: &Graph<'_>,
    drawn: &PlotResponse<keys::KeyInput>,
    cursors: &mut Cursors,
    x_si: f64,
) {
    let (response, asked) = (&drawn.response, &drawn.inner);
    let x_at = |at: Pos2| drawn.transform.value_from_position(at).x;
    let over = response.hover_pos().map(|p| x_at(p) * x_si);
    ui.data_mut(|d| d.insert_temp(hovered_id(graph.group), over));
    if response.clicked() {
        let place = response.interact_pointer_pos().map_or(asked.next, x_at);
        cursors.click(ui, graph.group, place * x_si);
    }
    if let Some(place) = asked.cursor {
        cursors.put_last(ui, graph.group, place * x_si);
    }
}

/// The empty graph with its axes and grid; `size` is the number of columns, and the height in
/// points.
fn axes<'a>(ui: &Ui, graph: &Graph<'_>, scale: GraphScale, [columns, height]: [f64; 2]) -> Plot<'a> {
    let follow = graph.follow;
    let width = ui.available_width() - VALUES_WIDTH;
    let rows = ((height - f64::from(TICK_LABELS_HEIGHT)) / f64::from(Y_TICK_SPACING)).max(1.0);
    // Numbers are as far apart as they are asked to be: none of them is faint.
    let axis = |hints: AxisHints<'static>| hints.label_spacing(Rangef::new(1.0, 2.0));
    let across_axis = axis(AxisHints::new_x());
    let across_axis = across_axis.formatter(move |mark, shown| tick_across(mark, shown, scale.across.symbol, width));
    let up_axis = axis(AxisHints::new_y()).min_thickness(VALUES_WIDTH);
    let up_axis = up_axis.formatter(move |mark, shown| tick_with_unit(mark, shown, scale.up.symbol));
    Plot::new(graph.title)
        .link_axis(Id::unique(("axis", graph.group.to_owned())), [!follow, false])
        .link_cursor(Id::unique(("cursor", graph.group.to_owned())), [true, false])
        .height(height as f32)
        // As fine as that of the canvas: lines of data stand off it.
        .grid_color(theme::palette(ui.visuals()).grid_zero)
        .allow_drag(!follow)
        .allow_zoom(!follow)
        .allow_boxed_zoom(!follow)
        .allow_double_click_reset(!follow)
        .allow_scroll(false)
        .allow_axis_zoom_drag(!follow)
        .x_grid_spacer(move |input| grid_marks(input, columns))
        .y_grid_spacer(move |input| grid_marks(input, rows))
        .custom_x_axes(vec![across_axis])
        .custom_y_axes(vec![up_axis])
}

/// Shows the range of a graph that follows its data; another one goes along with a mark that was
/// moved out of it.
fn set_bounds(plot: &mut PlotUi<'_>, graph: &Graph<'_>, scale: GraphScale, moved_mark: Option<f64>) {
    let [x_si, si] = scale.si();
    if graph.follow {
        let [left, right] = graph.range.map(|x| x / x_si);
        plot.set_plot_bounds(PlotBounds::from_min_max([left, scale.low / si], [right, scale.high / si]));
    } else if let Some(mark) = moved_mark {
        let [left, right] = [plot.plot_bounds().min()[0], plot.plot_bounds().max()[0]];
        if !(left..=right).contains(&(mark / x_si)) {
            let half = 0.5 * (right - left);
            plot.set_plot_bounds_x(mark / x_si - half..=mark / x_si + half);
        }
    }
}

/// The part of a graph that is in view, with its lines, as it is exported; `high` is the greatest
/// value of its range.
fn graph_in_view(graph: &Graph<'_>, lines: &[Series], high: f64, bounds: &PlotBounds) -> GraphInView {
    let (across, unit) = graph.across;
    let (Unit { symbol: across_symbol, si: x_si, .. }, column) = (unit.display(), unit.symbol);
    let (symbol, si) = graph.measure.unit(high);
    GraphInView {
        title: graph.title.to_owned(),
        across: [format!("{across}, {across_symbol}"), format!("{}_{column}", across.to_lowercase().replace(' ', "_"))],
        up: [format!("{}, {symbol}", graph.measure.name()), graph.measure.suffix().to_owned()],
        si: [x_si, si],
        bounds: [bounds.min()[0], bounds.min()[1], bounds.max()[0], bounds.max()[1]],
        lines: lines.to_vec(),
        ribbon: graph.ribbon.clone(),
        limits: graph.limits,
    }
}

/// The values of all lines at `x`, in the unit across, as text.
fn values_at(lines: &[Series], x: f64, across: AxisUnit, up: AxisUnit) -> String {
    let (x_si, AxisUnit { symbol, si }) = (across.si, up);
    let mut text = format!("{} {}", significant(x, DIGITS), across.symbol);
    for line in lines {
        if let Some(value) = value_at(&line.points, x * x_si) {
            text += &format!("\n{}: {}", line.name, quantity(value / si, DIGITS, symbol));
        }
        if let Some([low, high]) = line.range_at(x * x_si) {
            let [low, high] = [low, high].map(|v| significant(v / si, DIGITS));
            text += &format!(" (mean; {low} to {high})");
        }
    }
    text
}

/// Draws the lines with their bands; `scale` are the SI values of the units across and up.
fn draw_lines(plot: &mut PlotUi<'_>, graph: &Graph<'_>, lines: &[Series], [x_si, si]: [f64; 2]) {
    for (k, line) in lines.iter().enumerate() {
        let (colour, style, width) = line_appearance(line, k);
        draw_band(plot, line, colour, [x_si, si]);
        let points: Vec<[f64; 2]> = line.points.iter().map(|p| [p[0] / x_si, p[1] / si]).collect();
        if graph.hint.is_none() && points.len() == 1 {
            let mark = egui_plot::Points::new(line.name.clone(), points).color(colour).radius(PEAK_RADIUS);
            plot.points(mark.shape(egui_plot::MarkerShape::Diamond));
            continue;
        }
        let transform = *plot.transform();
        let to_screen = |p: [f64; 2]| transform.position_from_point(&p.into());
        let points = line_corners::without_straight_points(&points, to_screen);
        let pieces =
            if style == LineStyle::Solid { line_corners::pieces(&points, to_screen) } else { vec![&points[..]] };
        for piece in pieces {
            let piece = egui_plot::Line::new(line.name.clone(), piece.to_vec());
            plot.line(piece.color(colour).width(width).style(style));
        }
    }
}

/// Writes the numbers at both ends of the axis across.
fn write_ends_across(ui: &Ui, transform: &PlotTransform, columns: f64, across_symbol: &str, width: f32) {
    let in_view = transform.bounds();
    let in_view = in_view.min()[0]..=in_view.max()[0];
    let frame = *transform.frame();
    let ends = [(frame.left_bottom(), Align2::LEFT_TOP), (frame.right_bottom(), Align2::RIGHT_TOP)];
    for ((at, align), number) in ends.into_iter().zip(ends_across(in_view, columns, across_symbol, width)) {
        let (font, colour) = (TextStyle::Body.resolve(ui.style()), ui.visuals().text_color());
        if let Some(number) = number {
            ui.painter().text(at, align, number, font, colour);
        }
    }
}

/// The time to mark, if it is another than in the frame before: a graph that was zoomed goes to it.
fn moved_mark(ui: &Ui, graph: &Graph<'_>) -> Option<f64> {
    let id = Id::unique(("mark", graph.title));
    let before = ui.data(|d| d.get_temp::<Option<f64>>(id)).flatten();
    ui.data_mut(|d| d.insert_temp(id, graph.mark));
    graph.mark.filter(|mark| before != Some(*mark))
}

/// The contents of a graph that are read aloud.
struct SpokenGraph<'a> {
    title: &'a str,
    /// Place, least and greatest at the end of the ribbon, in the unit shown.
    ribbon: Option<[f64; 3]>,
    /// The lines, SI.
    lines: &'a [Series],
    /// The unit shown, and how many SI units it holds.
    symbol: &'a str,
    si: f64,
    /// The readings of the cursors.
    cursors: Option<String>,
}

/// Says the last values of the lines, and what the cursors read.
fn set_accessible_text(figure: &egui::Response, graph: &SpokenGraph<'_>) {
    let SpokenGraph { title, ribbon, lines, symbol, si, cursors } = graph;
    figure.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Figure, true, title));
    field::name(figure, title);
    let last = lines.iter().filter_map(|l| Some((l, l.points.last()?)));
    let values: Vec<String> =
        last.map(|(l, p)| format!("{} {}", l.name, quantity(p[1] / *si, DIGITS, symbol))).collect();
    let ribbon = ribbon.map_or_else(String::new, |[_, low, high]| {
        format!("; {RIBBON} {} to {} {symbol}", significant(low, DIGITS), significant(high, DIGITS))
    });
    let spoken = values.join(", ")
        + &ribbon
        + &cursors.as_ref().map_or_else(String::new, |t| format!("; {}", t.replace('\n', "; ")));
    figure.ctx.accesskit_node_builder(figure.id, |node| node.set_description(spoken.as_str()));
}

/// The ribbon of less and more friction, behind the lines.
fn draw_ribbon(plot: &mut PlotUi<'_>, ribbon: &[[f64; 3]], [x_si, si]: [f64; 2]) {
    let known: Vec<[f64; 3]> = ribbon
        .iter()
        .map(|r| [r[0] / x_si, r[1] / si, r[2] / si])
        .filter(|r| r.iter().all(|v| v.is_finite()))
        .collect();
    if known.len() < 2 {
        return;
    }
    let [xs, low, high] = [0, 1, 2].map(|k| known.iter().map(|r| r[k]).collect::<Vec<f64>>());
    let colour = LINES[0].gamma_multiply(0.28);
    plot.add(egui_plot::FilledArea::new(RIBBON, &xs, &low, &high).fill_color(colour).allow_hover(false));
}

/// From the least to the greatest of each column, behind the line of its means.
fn draw_band(plot: &mut PlotUi<'_>, line: &Series, colour: Color32, [x_si, si]: [f64; 2]) {
    if line.band.len() < 2 {
        return;
    }
    let [xs, low, high] =
        [(0, x_si), (1, si), (2, si)].map(|(k, unit)| line.band.iter().map(|b| b[k] / unit).collect::<Vec<f64>>());
    let area = egui_plot::FilledArea::new(format!("{}, least to greatest", line.name), &xs, &low, &high);
    plot.add(area.fill_color(colour.gamma_multiply(BAND_OPACITY)).allow_hover(false));
}

/// Colour, style and width with which it is drawn. Where it goes up and down in every column,
/// dashes cannot be seen, and would be thousands.
fn line_appearance(line: &Series, k: usize) -> (Color32, LineStyle, f32) {
    let (colour, style) = line_style(line, k);
    if line.reference.is_some() && oscillates(&line.points) {
        return (colour.gamma_multiply(0.7), LineStyle::Solid, 1.0);
    }
    (colour, style, 2.0)
}

fn oscillates(points: &[[f64; 2]]) -> bool {
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[1]), h.max(p[1])));
    points.windows(2).map(|p| (p[1][1] - p[0][1]).abs()).sum::<f64>() > OSCILLATION_RATIO * (high - low)
}

fn hovered_id(group: &str) -> Id {
    Id::unique(("hovered", group.to_owned()))
}

/// Returns where the pointer is in a graph of a group, SI.
#[must_use]
pub fn hovered(ctx: &egui::Context, group: &str) -> Option<f64> {
    ctx.data(|d| d.get_temp::<Option<f64>>(hovered_id(group))).flatten()
}

/// Left and right end of what was last in view of a graph, SI.
#[must_use]
pub fn in_view(ui: &Ui, title: &str) -> Option<[f64; 2]> {
    ui.data(|d| d.get_temp(Id::unique(("in view", title))))
}

/// The wheel zooms at the pointer; whether it did.
fn wheel(plot: &mut PlotUi<'_>) -> bool {
    if !plot.response().hovered() {
        return false;
    }
    let scroll = plot.ctx().input(|i| i.smooth_scroll_delta().y);
    if scroll == 0.0 {
        return false;
    }
    plot.zoom_bounds_around_hovered(egui::Vec2::splat((WHEEL * scroll).exp()));
    true
}

/// Half the width of the head of the playhead, and its height, points.
const PLAYHEAD: Vec2 = vec2(5.0, 7.0);

/// The time on screen, as a line with a head at the top.
fn draw_playhead(ui: &Ui, transform: &PlotTransform, mark: f64) {
    let frame = *transform.frame();
    let x = transform.position_from_point(&egui_plot::PlotPoint::new(mark, transform.bounds().min()[1])).x;
    let (painter, colour) = (ui.painter().with_clip_rect(frame), ui.visuals().text_color());
    painter.vline(x, frame.y_range(), Stroke::new(2.0, colour));
    let top = egui::pos2(x, frame.top());
    let corners = [top - vec2(PLAYHEAD.x, 0.0), top + vec2(PLAYHEAD.x, 0.0), top + vec2(0.0, PLAYHEAD.y)];
    painter.add(Shape::convex_polygon(corners.to_vec(), colour, Stroke::NONE));
}

/// Draws the cursors and their text.
fn draw_marks(plot: &mut PlotUi<'_>, cursors: &[f64], text: Option<&str>) {
    for (x, name) in cursors.iter().zip(["A", "B"]) {
        let line = egui_plot::VLine::new(name, *x).color(CURSOR).width(1.0).allow_hover(false);
        plot.vline(line.style(LineStyle::dashed_dense()));
    }
    if let Some(text) = text {
        let bounds = plot.plot_bounds();
        let at = egui_plot::PlotPoint::new(bounds.min()[0], bounds.max()[1]);
        let text = egui_plot::Text::new("cursors", at, RichText::new(text).small()).anchor(Align2::LEFT_TOP);
        plot.text(text.allow_hover(false));
    }
}

/// Returns what the colours mean, on one line above the graph, where it hides nothing; what finds
/// no room is told on hover. Limits are named at their lines.
fn legend(ui: &mut Ui, graph: &Graph<'_>, lines: &[Series]) -> (Id, bool) {
    let dashes = |l: &Series| if l.reference.is_some() { Dashes::Dashed } else { Dashes::Solid };
    let mut entries: Vec<(String, Color32, Dashes)> =
        lines.iter().enumerate().map(|(k, l)| (l.name.clone(), line_style(l, k).0, dashes(l))).collect();
    if graph.ribbon.len() >= 2 {
        entries.push((RIBBON.to_owned(), LINES[0].gamma_multiply(0.5), Dashes::Solid));
    }
    let row = ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing = vec2(5.0, 2.0);
        let title = ui.label(RichText::new(graph.title).strong().small()).id;
        let small = TextStyle::Small.resolve(ui.style());
        let mut left_out = Vec::new();
        for (name, colour, dashes) in entries {
            let galley = ui.painter().layout_no_wrap(name.clone(), small.clone(), colour);
            if !left_out.is_empty()
                || galley.size().x + 2.0 * SWATCH + 10.0 > ui.available_width() - EXPORT_BUTTON_WIDTH
            {
                left_out.push(name);
                continue;
            }
            swatch(ui, colour, dashes);
            ui.label(RichText::new(&name).small());
        }
        if !left_out.is_empty() {
            ui.label(RichText::new("…").small()).on_hover_text(left_out.join("\n"));
        }
        let room = egui::Layout::right_to_left(egui::Align::Center);
        let export = ui.with_layout(room, |ui| {
            let button = ui.small_button("Export…").on_hover_text("What is in view, as CSV, SVG or PNG");
            field::name(&button, &format!("Export {}", graph.title));
            button.clicked()
        });
        (title, export.inner)
    });
    row.inner
}

/// The way in which a line of the legend is drawn.
#[derive(Clone, Copy)]
enum Dashes {
    Solid,
    Dashed,
}

/// A sample of a line for the legend.
fn swatch(ui: &mut Ui, colour: Color32, dashes: Dashes) {
    let (rect, _) = ui.allocate_exact_size(vec2(SWATCH, 10.0), Sense::hover());
    let parts: &[[f32; 2]] = match dashes {
        Dashes::Solid => &[[0.0, 1.0]],
        Dashes::Dashed => &[[0.0, 0.4], [0.6, 1.0]],
    };
    for [from, to] in parts {
        let x = |f: f32| rect.left() + f * rect.width();
        ui.painter().hline(x(*from)..=x(*to), rect.center().y, Stroke::new(2.0, colour));
    }
}

fn named_limits(limits: [f64; 2]) -> [(&'static str, f64, Color32); 2] {
    [("Service", limits[0], SERVICE), ("Breaking", limits[1], BREAKING)]
}

/// Limits in view as dashed lines.
fn draw_limits(plot: &mut PlotUi<'_>, graph: &Graph<'_>, high: f64, si: f64) {
    for (name, limit, colour) in named_limits(graph.limits).into_iter().filter(|(_, limit, _)| *limit <= high) {
        let line = HLine::new(name, limit / si).color(colour).width(1.5).allow_hover(false);
        plot.hline(line.style(LineStyle::dashed_dense()));
    }
}

/// Names each limit at the right end of its line, on a plate: above the line where there is room,
/// and the lower one to the left of the other where both would lie over each other.
fn name_limits(ui: &Ui, graph: &Graph<'_>, shown: &PlotTransform, high: f64, si: f64) {
    let (frame, visuals) = (*shown.frame(), ui.visuals());
    let painter = ui.painter().with_clip_rect(frame);
    let font = TextStyle::Small.resolve(ui.style());
    let mut before: Option<Rect> = None;
    for (name, limit, _) in named_limits(graph.limits).into_iter().rev().filter(|(_, limit, _)| *limit <= high) {
        let y = shown.position_from_point(&egui_plot::PlotPoint::new(0.0, limit / si)).y;
        if !frame.y_range().contains(y) {
            continue;
        }
        let words = format!("{name} {}", graph.measure.text(limit));
        let words = painter.layout_no_wrap(words, font.clone(), visuals.text_color());
        let size = words.size() + vec2(4.0, 0.0);
        let top = if y - size.y - 1.0 > frame.top() { y - size.y - 1.0 } else { y + 1.0 };
        let mut place = Rect::from_min_size(egui::pos2(frame.right() - 2.0 - size.x, top), size);
        if let Some(other) = before.filter(|other| other.intersects(place.expand(1.0))) {
            place = place.translate(vec2(other.left() - 4.0 - place.right(), 0.0));
        }
        // The line below shines through.
        painter.rect_filled(place, 2.0, visuals.extreme_bg_color.gamma_multiply(0.6));
        painter.galley(place.min + vec2(2.0, 0.0), words, visuals.text_color());
        before = Some(place);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn line(values: &[f64]) -> Series {
        Series {
            name: String::new(),
            points: values.iter().enumerate().map(|(i, &v)| [i as f64, v]).collect(),
            ..Series::default()
        }
    }

    #[test]
    fn only_held_lines_that_do_not_tremble_are_dashed() {
        let reference_line = |values: &[f64]| Series { reference: Some(0), ..line(values) };
        let wave: Vec<f64> = (0..1200).map(|k| (0.02 * f64::from(k)).sin()).collect();
        let noise: Vec<f64> = (0..1200).map(|k| f64::from(k % 2)).collect();
        assert!(matches!(line_appearance(&reference_line(&wave), 0), (_, LineStyle::Dashed { .. }, _)));
        assert!(matches!(line_appearance(&reference_line(&noise), 0), (_, LineStyle::Solid, _)));
        assert!(matches!(line_appearance(&reference_line(&[1.0; 9]), 0), (_, LineStyle::Dashed { .. }, _)));
        assert!(matches!(line_appearance(&line(&noise), 0), (_, LineStyle::Solid, w) if w == 2.0));
    }
}
