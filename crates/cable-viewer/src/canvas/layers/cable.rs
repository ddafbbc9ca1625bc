//! The cable is drawn as one mesh of ribbons (casing, warning outline, colours), so that thousands
//! of nodes cost one draw call.

use cable_core::solution::Node;
use egui::{Color32, Mesh, Pos2, Stroke, Vec2, vec2};

use crate::canvas::canvas_view::CanvasView;
use crate::canvas::layers::surface_offset::{self, MIN_WIDTH};
use crate::plot;
use crate::render::colour::ColourScale;
use crate::state::{AppState, Freshness, Item};
use crate::units::format;

/// Nodes nearer to each other than this are drawn as one, points: a ribbon of pieces shorter than
/// it is smooth costs as much as a screen full of text.
const MIN_SPACING: f32 = 1.5;
/// Width of the soft edge, points.
const SOFT_EDGE_WIDTH: f32 = 0.8;
/// A joint is drawn sharp up to this ratio of its miter to the half width, then cut.
const MITER: f32 = 2.0;

/// All cables.
pub fn draw(view: &mut CanvasView<'_>, state: &AppState) {
    let Some(solution) = &state.live.snapshot.solution else { return };
    let solved = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let range = state.view.colour.range(solution);
    let mut mesh = Mesh::default();
    let freshness = state.freshness();
    let (current, casing) = (freshness == Freshness::Current, view.palette.casing);
    // Colours are figures too: what is not the answer has none.
    let plain = if freshness == Freshness::Draft { view.palette.weak_text } else { grey(view.palette.weak_text) };
    let fade = |c: Color32| if current { c } else { grey(c) };
    for (k, answer) in solution.cables.iter().enumerate() {
        let Some(cable) = solved.cables.get(k) else { continue };
        let width = view.points(cable.diameter_m).max(MIN_WIDTH);
        let picked = |item: Option<Item>| item == Some(Item::Cable(k));
        let service = cable.service_tension_n;
        for nodes in answer.pieces() {
            let nodes = &distinct_nodes(view, nodes, service);
            let line = Ribbon::new(surface_offset::places(view, nodes, answer, cable.diameter_m));
            if state.selection.contains(Item::Cable(k)) || picked(state.selection.hovered) {
                line.add(&mut mesh, width + 7.0, |_| Some(view.palette.accent.gamma_multiply(0.55)));
            }
            line.add(&mut mesh, width + 6.0, |i| {
                (current && nodes[i].tension_n > service).then_some(view.palette.risk)
            });
            line.add(&mut mesh, width + 1.6, |_| Some(fade(casing)));
            line.add(&mut mesh, width, |i| {
                if !current {
                    return Some(plain);
                }
                let fraction = ColourScale::fraction(state.view.colour.quantity.of(&nodes[i]), range);
                Some(state.view.colour.map.at(fraction))
            });
        }
    }
    view.painter.add(mesh);
    for piece in solution.cables.iter().flat_map(|c| c.pieces()) {
        for pair in distinct_nodes(view, piece, f64::INFINITY).windows(2) {
            view.avoid_line(view.at([pair[0].x_m, pair[0].y_m]), view.at([pair[1].x_m, pair[1].y_m]));
        }
    }
    if let Some(s) = plot::hovered(view.painter.ctx(), plot::along_cable::GROUP)
        && let Some(n) =
            solution.cables.get(state.current_cable()).and_then(|c| c.nodes.iter().find(|n| n.arc_length_m >= s))
    {
        // This marks the place under the pointer in the graph along the cable.
        view.painter.circle_stroke(view.at([n.x_m, n.y_m]), 7.0, Stroke::new(2.0, view.palette.accent));
    }
    if state.view.layers.nodes {
        for n in solution.cables.iter().flat_map(|c| &c.nodes) {
            let p = view.at([n.x_m, n.y_m]);
            view.painter.circle(p, 2.4, view.palette.background, Stroke::new(1.0, view.palette.text));
        }
    }
}

/// A cable drawn thicker than it is by less is not said to be, as a ratio.
const NOTED_THICKENING: f32 = 1.05;

/// Returns how many times as thick as it is a cable is drawn, where its true diameter could not be
/// seen; the greatest of several.
pub(super) fn thickening(state: &AppState) -> Option<String> {
    state.live.snapshot.solution.as_ref()?;
    let solved = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let times = solved.cables.iter().map(|c| MIN_WIDTH / (c.diameter_m * state.view.camera.points_per_m) as f32);
    let most = times.filter(|t| t.is_finite() && *t > NOTED_THICKENING).reduce(f32::max)?;
    Some(format::significant(f64::from(most), 2))
}

/// An outdated picture: half way to grey.
fn grey(c: Color32) -> Color32 {
    let level = ((u32::from(c.r()) + u32::from(c.g()) + u32::from(c.b())) / 3) as u8;
    let mix = |v: u8| ((u16::from(v) + 5 * (u16::from(level) / 2 + 64)) / 6) as u8;
    Color32::from_rgb(mix(c.r()), mix(c.g()), mix(c.b()))
}

/// The nodes that can be told apart on screen: the ends, those at least [`MIN_SPACING`] from the
/// one before, and those where the risk begins or ends.
pub(super) fn distinct_nodes(view: &CanvasView<'_>, nodes: &[Node], service: f64) -> Vec<Node> {
    let mut out: Vec<Node> = Vec::with_capacity(nodes.len());
    let mut last: Option<(Pos2, bool)> = None;
    let end = nodes.len().saturating_sub(1);
    for (i, n) in nodes.iter().enumerate() {
        let (at, risk) = (view.at([n.x_m, n.y_m]), n.tension_n > service);
        if i == end || last.is_none_or(|(p, r)| r != risk || p.distance(at) >= MIN_SPACING) {
            out.push(*n);
            last = Some((at, risk));
        }
    }
    out
}

/// A polyline on screen with the direction to widen it at each point.
pub(super) struct Ribbon {
    points: Vec<Pos2>,
    /// Half-width vectors for width 2.
    offsets: Vec<Vec2>,
}

impl Ribbon {
    pub fn new(points: Vec<Pos2>) -> Self {
        let normal = |a: Pos2, b: Pos2| {
            let d = b - a;
            let l = d.length();
            if l > 1e-3 { vec2(-d.y, d.x) / l } else { Vec2::ZERO }
        };
        let last = points.len().saturating_sub(1);
        let offsets = (0..points.len())
            .map(|i| {
                let before = if i > 0 { normal(points[i - 1], points[i]) } else { Vec2::ZERO };
                let after = if i < last { normal(points[i], points[i + 1]) } else { Vec2::ZERO };
                let sum = before + after;
                let length2 = sum.length_sq();
                if length2 < 1e-6 {
                    return before;
                }
                // The miter of two unit normals a, b is 2(a + b)/|a + b|²; ends have only one.
                let ends = before == Vec2::ZERO || after == Vec2::ZERO;
                let miter = if ends { sum } else { sum * (2.0 / length2) };
                let size = miter.length();
                if size > MITER { miter * (MITER / size) } else { miter }
            })
            .collect();
        Self { points, offsets }
    }

    /// Adds the ribbon in the colours of its points; where a point has none, the ribbon is broken.
    pub fn add(&self, mesh: &mut Mesh, width: f32, colour: impl Fn(usize) -> Option<Color32>) {
        let half = width / 2.0;
        let soft = (half + SOFT_EDGE_WIDTH) / half;
        let mut before: Option<u32> = None;
        for (i, (&p, &o)) in self.points.iter().zip(&self.offsets).enumerate() {
            let Some(c) = colour(i) else {
                before = None;
                continue;
            };
            let base = mesh.vertices.len() as u32;
            mesh.colored_vertex(p + o * half * soft, Color32::TRANSPARENT);
            mesh.colored_vertex(p + o * half, c);
            mesh.colored_vertex(p - o * half, c);
            mesh.colored_vertex(p - o * half * soft, Color32::TRANSPARENT);
            if let Some(b) = before {
                for k in 0..3 {
                    mesh.add_triangle(b + k, b + k + 1, base + k);
                    mesh.add_triangle(b + k + 1, base + k + 1, base + k);
                }
            }
            before = Some(base);
        }
    }
}
