//! Forces of contacts, loads, supports and wind are drawn as arrows. One length scale for all, by
//! the square root, so that small ones stay visible beside large ones.

use cable_core::math::Point;
use cable_core::solution::{CableSolution, ContactReport, ContactState};
use egui::{Align2, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use crate::canvas::canvas_view::{CanvasView, FigureLabel};
use crate::geometry::arrows::{load_arrow, load_at};
use crate::state::{AppState, Item};
use crate::units::labels;
use crate::units::unit::Unit;

/// Of contacts nearer to each other than this (points) only the strongest has arrows; closer in
/// there is room for more.
const MIN_SPACING: f32 = 22.0;
/// Longest and shortest arrow, points.
const LENGTH: [f64; 2] = [64.0, 9.0];
/// All arrows; their figures go to `figures` for the labels to place.
pub fn draw(view: &mut CanvasView<'_>, state: &AppState, figures: &mut Vec<FigureLabel>) {
    let Some(solution) = &state.live.snapshot.solution else { return };
    // Forces of supports are known of answers only; loads are given.
    let current = state.is_current();
    let greatest = greatest(state);
    let scale = |f: Point| screen_vector(f, greatest);
    for (k, cable) in solution.cables.iter().enumerate() {
        if state.view.layers.contacts && current {
            contacts(view, cable, &scale);
        }
        if state.view.layers.forces {
            if current {
                reactions(view, state, cable, &scale, figures);
            }
            loads(view, state, k, cable, figures);
        }
    }
    if state.view.layers.forces {
        wind(view, state.document.scene.environment.wind_n_per_m);
    }
}

/// The largest force shown as reaction or contact, N.
fn greatest(state: &AppState) -> f64 {
    let mut best: f64 = 0.0;
    for c in state.live.snapshot.solution.iter().flat_map(|s| &s.cables) {
        let reactions = c.supports.iter().map(|s| s.reaction_x_n.hypot(s.reaction_y_n));
        let contacts = c.contacts.iter().map(|c| c.normal_n.abs().max(c.friction_n.abs()));
        best = reactions.chain(contacts).filter(|f| f.is_finite()).fold(best, f64::max);
    }
    best
}

/// The arrow of a force on screen, points (y down).
fn screen_vector(f: Point, greatest: f64) -> Vec2 {
    let size = f[0].hypot(f[1]);
    if !(size > 1e-9 * greatest && size.is_finite()) {
        return Vec2::ZERO;
    }
    let length = (LENGTH[0] * (size / greatest.max(size)).sqrt()).max(LENGTH[1]);
    vec2((f[0] / size * length) as f32, (-f[1] / size * length) as f32)
}

/// Draws normal force and friction of the contacts, the strongest first.
fn contacts(view: &CanvasView<'_>, cable: &CableSolution, scale: &impl Fn(Point) -> Vec2) {
    let mut drawn: Vec<Pos2> = Vec::new();
    for c in strongest_first(&cable.contacts) {
        let at = view.at([c.x_m, c.y_m]);
        // Twenty arrows on a hand's breadth hide the cable and each other.
        if drawn.iter().any(|p| p.distance(at) < MIN_SPACING) {
            continue;
        }
        drawn.push(at);
        let normal = within(view.rect, at, scale([c.normal[0] * c.normal_n, c.normal[1] * c.normal_n]));
        view.arrow(at, normal, Stroke::new(1.8, view.palette.normal));
        // Growing arc length is along the tangent nearest to the direction of the cable there.
        let tangent = tangent_at(cable, c.arc_length_m, c.normal);
        let friction = scale([tangent[0] * c.friction_n, tangent[1] * c.friction_n]);
        view.arrow(at, friction, Stroke::new(1.8, view.palette.friction));
        // Filled: holds; hollow: slides.
        let fill = if c.state == ContactState::Stick { view.palette.normal } else { view.palette.background };
        view.painter.circle(at, 3.0, fill, Stroke::new(1.5, view.palette.normal));
    }
}

/// An arrow that ends on the canvas: one beyond its edge has no head.
fn within(canvas: Rect, tail: Pos2, along: Vec2) -> Vec2 {
    if !canvas.contains(tail) {
        return along;
    }
    let share = |room: f32, way: f32| if way > room { room / way } else { 1.0 };
    let x = share(if along.x > 0.0 { canvas.right() - tail.x } else { tail.x - canvas.left() }, along.x.abs());
    let y = share(if along.y > 0.0 { canvas.bottom() - tail.y } else { tail.y - canvas.top() }, along.y.abs());
    along * x.min(y)
}

fn strongest_first(contacts: &[ContactReport]) -> Vec<&ContactReport> {
    let mut sorted: Vec<&ContactReport> = contacts.iter().collect();
    sorted.sort_by(|a, b| b.normal_n.abs().total_cmp(&a.normal_n.abs()));
    sorted
}

/// Direction of growing arc length in the contact plane.
fn tangent_at(cable: &CableSolution, arc_length_m: f64, normal: Point) -> Point {
    let k = cable.nodes.partition_point(|n| n.arc_length_m < arc_length_m);
    let t = [normal[1], -normal[0]];
    let (Some(a), Some(b)) = (cable.nodes.get(k.saturating_sub(1)), cable.nodes.get(k + 1).or(cable.nodes.last()))
    else {
        return t;
    };
    let forward = t[0] * (b.x_m - a.x_m) + t[1] * (b.y_m - a.y_m) >= 0.0;
    if forward { t } else { [-t[0], -t[1]] }
}

/// The figures beside an arrow of a force.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ForceFigures {
    Size,
    /// The size, and the parts to the right and upwards.
    Components,
}

/// A force as text.
fn figure(force: Point, figures: ForceFigures) -> String {
    let size = labels::force(force[0].hypot(force[1]));
    if figures == ForceFigures::Size {
        return size;
    }
    let part =
        |f: f64, [minus, plus]: [&str; 2]| format!("{} {}", labels::force(f.abs()), if f < 0.0 { minus } else { plus });
    format!("{size}\n{}, {}", part(force[0], ["left", "right"]), part(force[1], ["down", "up"]))
}

/// Draws the reactions of supports, and appends their figures.
fn reactions(
    view: &mut CanvasView<'_>,
    state: &AppState,
    cable: &CableSolution,
    scale: &impl Fn(Point) -> Vec2,
    figures: &mut Vec<FigureLabel>,
) {
    for s in &cable.supports {
        let along = scale([s.reaction_x_n, s.reaction_y_n]);
        if along != Vec2::ZERO {
            let at = view.at([s.x_m, s.y_m]);
            view.arrow(at, along, Stroke::new(2.0, view.palette.reaction));
            view.avoid_line(at, at + along);
            let shown = if state.view.layers.components { ForceFigures::Components } else { ForceFigures::Size };
            let figure = figure([s.reaction_x_n, s.reaction_y_n], shown);
            figures.push(FigureLabel { at: at + along, text: figure, colour: view.palette.reaction });
        }
    }
}

/// Draws the loads of a cable, and appends their figures.
fn loads(
    view: &mut CanvasView<'_>,
    state: &AppState,
    cable: usize,
    answer: &CableSolution,
    figures: &mut Vec<FigureLabel>,
) {
    let mut arrow = |at: Point, force: Point, item: Item| {
        let along = load_arrow(force);
        let head = matches!((item, state.selection.hovered), (Item::Load(k), Some(Item::LoadHead(h))) if k == h);
        let picked = state.selection.contains(item) || state.selection.hovered == Some(item) || head;
        let colour = if picked { view.palette.accent } else { view.palette.load };
        let tail = view.at(at);
        view.arrow(tail, along, Stroke::new(2.6, colour));
        view.avoid_line(tail, tail + along);
        view.painter.circle_filled(tail, 3.5, colour);
        let components = state.view.layers.components || picked;
        let text = figure(force, if components { ForceFigures::Components } else { ForceFigures::Size });
        figures.push(FigureLabel { at: tail + along, text, colour });
    };
    for (k, load) in state.document.scene.loads.iter().enumerate() {
        if load.cable == answer.name
            && let Some((at, force)) = load_at(state, k)
        {
            arrow(at, force, Item::Load(k));
        }
    }
    let Some(scene_cable) = state.document.scene.cables.get(cable) else { return };
    for (k, (s, r)) in scene_cable.supports.iter().zip(&answer.supports).enumerate() {
        if let Some(force) = s.force_n.or_else(|| s.forces_n.first().copied()) {
            arrow([r.x_m, r.y_m], force, Item::Support { cable, support: k });
        }
    }
}

/// Wind as one arrow in the upper left corner.
fn wind(view: &CanvasView<'_>, per_metre: Point) {
    let size = per_metre[0].hypot(per_metre[1]);
    if !(size > 0.0 && size.is_finite()) {
        return;
    }
    let dir = vec2((per_metre[0] / size) as f32, (-per_metre[1] / size) as f32);
    let centre = pos2(view.rect.min.x + crate::canvas::layers::grid::STRIP[0] + 56.0, view.rect.min.y + 40.0);
    view.arrow(centre - dir * 24.0, dir * 48.0, Stroke::new(3.0, view.palette.load));
    let unit = Unit::N_PER_M.display();
    let text = format!("Wind {} {}", labels::digits(size / unit.si), unit.symbol);
    view.text(pos2(centre.x, centre.y + 28.0), Align2::CENTER_TOP, &text, 11.0, view.palette.text);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The arrow of the greatest contact left the canvas at the top, without a head.
    #[test]
    fn an_arrow_ends_on_the_canvas_and_keeps_its_direction() {
        let canvas = Rect::from_min_max(pos2(0.0, 0.0), pos2(100.0, 100.0));
        let tail = pos2(50.0, 30.0);
        assert_eq!(within(canvas, tail, vec2(10.0, -64.0)), vec2(10.0, -64.0) * (30.0 / 64.0));
        assert_eq!(within(canvas, tail, vec2(10.0, -20.0)), vec2(10.0, -20.0));
        assert_eq!(within(canvas, tail, vec2(-80.0, 0.0)), vec2(-50.0, 0.0));
        assert_eq!(within(canvas, pos2(-5.0, 0.0), vec2(80.0, 0.0)), vec2(80.0, 0.0));
    }
}
