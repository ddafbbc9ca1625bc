//! This layer draws the safe reach over the map, in the colour of the tension as a share of the
//! service tension. Of an end: the plane, with the lines of service and breaking tension; of a
//! robot: what it passes over above the ground. What the cable may not bear is hatched, so that its
//! colour is not all that tells it; where nothing is known, and where it does not reach, nothing is
//! drawn.

use cable_core::analysis::safe_reach::area::Area;
use cable_core::analysis::safe_reach::line::{ReachMap, ReachPlace, Trip};
use cable_core::math::Point;
use cable_core::scene::preset::robot_preset;
use egui::{
    Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::canvas::canvas_view::{CanvasView, FigureLabel};
use crate::jobs::safe_reach::ReachMaps;
use crate::render::colour::ColourMap;
use crate::render::theme::{self, Palette};
use crate::state::AppState;
use crate::units::labels;

/// Opacity of the map, of 1: the grid below stays readable.
const FILL_OPACITY: f32 = 0.62;
/// For lines, a place that the cable does not reach counts as this many times the breaking tension.
const OUT_OF_REACH_FACTOR: f64 = 2.0;
/// Between hatching lines, points.
const HATCH: f32 = 7.0;
/// Height of the strip of a robot of unknown size, m.
const HEIGHT_M: f64 = 1.0;
/// Height of what explains the colours, points.
pub const KEY_HEIGHT: f32 = 56.0;

/// Draws the map of an end.
pub fn area(view: &CanvasView<'_>, state: &AppState) {
    let Some((ReachMaps::Area(there, ways), _)) = state.analysis.safe_reach.found() else { return };
    let shown = match state.analysis.safe_reach.choice.trip {
        Trip::There => Some(there),
        Trip::ThereAndBack => ways.as_ref(),
    };
    let Some(area) = shown else { return };
    let mut mesh = Mesh::default();
    let mut lines = Vec::new();
    for k in 0..area.most_n.len() {
        if let Some(corners) = corners(area, k) {
            quad(view, area, corners, &mut mesh, &mut lines);
            border(view, area, k, corners, &mut lines);
        }
    }
    view.painter.add(mesh);
    view.painter.extend(lines);
}

/// A corner of a square of the map.
#[derive(Clone, Copy)]
struct MapCorner {
    at_m: Point,
    /// Greatest tension with the end there, N: infinite out of reach, NaN where it is not known.
    most_n: f64,
}

/// A place and its neighbours to the right and above, anticlockwise, with what is known of each.
fn corners(area: &Area, k: usize) -> Option<[MapCorner; 4]> {
    let columns = area.columns;
    let corner = |k: usize| Some(MapCorner { at_m: area.at(k), most_n: area.most_n.get(k).copied()? });
    let inside = k % columns.max(1) + 1 < columns;
    let found = [corner(k)?, corner(k + 1)?, corner(k + columns + 1)?, corner(k + columns)?];
    inside.then_some(found)
}

/// True if something is known of a square, and the cable reaches all of it.
fn is_filled(corners: [MapCorner; 4]) -> bool {
    corners.iter().all(|corner| corner.most_n.is_finite())
}

/// A line where the map ends: its darkest colours alone do not stand off the background.
fn border(view: &CanvasView<'_>, area: &Area, k: usize, own: [MapCorner; 4], lines: &mut Vec<Shape>) {
    if !is_filled(own) {
        return;
    }
    let at = own.map(|corner| view.at(corner.at_m));
    let beside = [k.checked_sub(area.columns), Some(k + 1), Some(k + area.columns), k.checked_sub(1)];
    for (side, next) in beside.into_iter().enumerate() {
        if !next.and_then(|k| corners(area, k)).is_some_and(is_filled) {
            let ends = [at[side], at[(side + 1) % 4]];
            lines.push(Shape::line_segment(ends, Stroke::new(1.0, view.palette.surface)));
        }
    }
}

/// Draws the map between four neighbouring places: colour, hatching above a limit, and lines of
/// equal tension.
fn quad(view: &CanvasView<'_>, area: &Area, corners: [MapCorner; 4], mesh: &mut Mesh, lines: &mut Vec<Shape>) {
    if corners.iter().any(|corner| corner.most_n.is_nan()) {
        return;
    }
    let at = corners.map(|corner| view.at(corner.at_m));
    if !view.rect.intersects(Rect::from_points(&at)) {
        return;
    }
    if is_filled(corners) {
        let first = mesh.vertices.len() as u32;
        for (p, corner) in at.into_iter().zip(corners) {
            mesh.colored_vertex(p, colour(corner.most_n / area.service_n));
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first, first + 2, first + 3);
        // Beyond the end of the map nothing is hatched: there is nothing that the strokes would
        // say.
        let over = |limit_n: f64| corners.iter().all(|corner| corner.most_n > limit_n);
        if over(area.service_n) {
            lines.extend(stroke(view.palette, [at[0], at[2]], 1.0));
        }
        if over(area.breaking_n) {
            lines.extend(stroke(view.palette, [at[1], at[3]], 1.0));
        }
    }
    let values = corners.map(|corner| corner.most_n.min(OUT_OF_REACH_FACTOR * area.breaking_n));
    for (limit_n, width) in [(area.service_n, 2.0), (area.breaking_n, 3.5)] {
        for ends in crossing(at, values, limit_n) {
            lines.extend(stroke(view.palette, ends, width));
        }
    }
}

/// A line of risk over one of the background: one of the two stands off every colour of the map
/// that is above the service tension, in both themes.
fn stroke(palette: &Palette, ends: [Pos2; 2], width: f32) -> [Shape; 2] {
    let line = |width: f32, colour: Color32| Shape::line_segment(ends, Stroke::new(width, colour));
    [line(width + 2.0, palette.background), line(width, palette.risk)]
}

/// Returns where a value is passed in a square: its ends on the sides, between which tension grows
/// by even factors.
fn crossing(at: [Pos2; 4], values: [f64; 4], limit: f64) -> Vec<[Pos2; 2]> {
    let log = |v: f64| v.max(1e-9).ln();
    let on = |k: usize| {
        let (a, b) = (values[k], values[(k + 1) % 4]);
        ((a > limit) != (b > limit)).then(|| {
            let part = (log(limit) - log(a)) / (log(b) - log(a));
            at[k] + (at[(k + 1) % 4] - at[k]) * part as f32
        })
    };
    let found: Vec<Pos2> = (0..4).filter_map(on).collect();
    found.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect()
}

/// The colour of a share of the service tension; what is below shines through.
#[must_use]
pub fn colour(share: f64) -> Color32 {
    ColourMap::Cividis.at(share).gamma_multiply(FILL_OPACITY)
}

/// Draws the map of a robot; its ends go to `figures` for the labels to place.
pub fn line(view: &CanvasView<'_>, state: &AppState, figures: &mut Vec<FigureLabel>) {
    let Some((ReachMaps::Line(map), _)) = state.analysis.safe_reach.found() else { return };
    let trip = state.analysis.safe_reach.choice.trip;
    let preset = state.document.scene.robot.as_ref().and_then(|r| robot_preset(&r.preset));
    let height = view.points(preset.map_or(HEIGHT_M, |p| p.height_m.value)).max(9.0);
    let value = |p: &ReachPlace| p.tension_n(trip);
    let mut mesh = Mesh::default();
    for pair in map.places.windows(2) {
        let [a, b] = [0, 1].map(|k| (view.at(pair[k].at_m), value(&pair[k])));
        if !a.1.is_finite() || !b.1.is_finite() {
            continue;
        }
        let first = mesh.vertices.len() as u32;
        for (at, n) in [a, b] {
            mesh.colored_vertex(at, colour(n / map.service_n));
            mesh.colored_vertex(at - vec2(0.0, height), colour(n / map.service_n));
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 3, first + 2);
    }
    view.painter.add(mesh);
    for pair in map.places.windows(2) {
        let [a, b] = [0, 1].map(|k| (view.at(pair[k].at_m), value(&pair[k])));
        if [a, b].iter().all(|(_, n)| n.is_finite() && *n > map.service_n) {
            hatch(view, [a.0, b.0], height);
        }
    }
    ends(view, map, trip, height, figures);
}

/// Strokes across what is above the service tension.
fn hatch(view: &CanvasView<'_>, [a, b]: [Pos2; 2], height: f32) {
    let strokes = ((b.x - a.x).abs() / HATCH).ceil().clamp(1.0, 40.0);
    for k in 0..strokes as usize {
        let at = a + (b - a) * (k as f32 / strokes);
        view.painter.extend(stroke(view.palette, [at, at + vec2(HATCH, -height)], 1.0));
    }
}

/// Marks from where to where the service tension is not passed.
fn ends(view: &CanvasView<'_>, map: &ReachMap, trip: Trip, height: f32, figures: &mut Vec<FigureLabel>) {
    let Some(ends) = map.safe_m(map.service_n, trip) else { return };
    for (x, name) in ends.into_iter().zip(["safe from", "safe to"]) {
        let Some(place) = map.places.iter().find(|p| p.at_m[0] >= x) else { continue };
        let at = view.at(place.at_m);
        let post = at.y - height - 8.0..=at.y + 6.0;
        view.painter.vline(at.x, post.clone(), Stroke::new(4.0, view.palette.background));
        view.painter.vline(at.x, post, Stroke::new(2.0, view.palette.risk));
        let (length, _) = labels::of_length();
        let text = format!("{name} {} {length}", labels::coordinate(place.at_m[0], 0.01));
        figures.push(FigureLabel { at: at - vec2(0.0, height), text, colour: view.palette.text });
    }
}

/// Draws what the colours of the map mean as a strip beside the canvas.
pub fn legend_beside(ui: &mut Ui, state: &AppState) {
    let Some(key) = MapKey::of(state) else { return };
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), KEY_HEIGHT), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, "Colours of the safe reach"));
    key.draw(ui.painter(), theme::palette(ui.visuals()), rect);
}

/// The meaning of the colours of a map, in words.
struct MapKey {
    title: String,
    service: String,
    over: &'static str,
}

impl MapKey {
    /// The legend of the map that is shown, if there is one.
    fn of(state: &AppState) -> Option<Self> {
        let (maps, scene) = state.analysis.safe_reach.found()?;
        let [service_n, _] = maps.limits_n();
        let title = match state.analysis.safe_reach.choice.trip {
            Trip::There => "Safe reach",
            Trip::ThereAndBack => "Safe reach, there and back",
        };
        let out_of_date = if **scene == state.document.scene { "" } else { " (out of date)" };
        let over = match maps {
            ReachMaps::Line(_) => "Above service",
            ReachMaps::Area(..) => "Above service / breaks",
        };
        let service = format!("service {}", labels::force(service_n));
        Some(Self { title: format!("{title}{out_of_date}"), service, over })
    }

    /// Draws the legend into a rectangle.
    fn draw(&self, painter: &Painter, palette: &Palette, area: Rect) {
        let text = |at: Pos2, anchor: Align2, text: &str, size: f32| {
            painter.text(pos2(at.x.round(), at.y.round()), anchor, text, FontId::proportional(size), palette.text)
        };
        text(area.min, Align2::LEFT_TOP, &self.title, 11.0);
        let bar = Rect::from_min_size(area.min + vec2(0.0, 16.0), vec2(area.width(), 9.0));
        let mut mesh = Mesh::default();
        const STRIPS: u32 = 24;
        for k in 0..=STRIPS {
            let f = k as f32 / STRIPS as f32;
            let x = bar.min.x + f * bar.width();
            mesh.colored_vertex(pos2(x, bar.min.y), colour(f64::from(f)));
            mesh.colored_vertex(pos2(x, bar.max.y), colour(f64::from(f)));
            if k > 0 {
                let b = 2 * k;
                mesh.add_triangle(b - 2, b - 1, b);
                mesh.add_triangle(b - 1, b + 1, b);
            }
        }
        painter.rect_filled(bar, 0.0, palette.background);
        painter.add(mesh);
        let under = bar.max.y + 2.0;
        text(pos2(bar.min.x, under), Align2::LEFT_TOP, &labels::force(0.0), 10.5);
        text(pos2(bar.max.x, under), Align2::RIGHT_TOP, &self.service, 10.5);
        let sample = pos2(bar.min.x, bar.max.y + 24.0);
        for k in 0..3 {
            let foot = sample + vec2(6.0 * k as f32, 5.0);
            painter.extend(stroke(palette, [foot, foot + vec2(6.0, -10.0)], 1.0));
        }
        text(sample + vec2(27.0, 0.0), Align2::LEFT_CENTER, self.over, 10.5);
    }
}
