//! Icons are small painted signs, the same on every machine, whatever fonts it has.

use egui::epaint::{PathShape, Shape, Stroke};
use egui::{
    Align2, Atom, Button, Color32, FontId, IdSalt, IntoAtoms, Painter, Pos2, Rect, Response, Sense, Ui, Vec2, pos2,
};

/// The sign that is painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// Time runs.
    Play,
    /// Time stands.
    Pause,
    /// One step on.
    Step,
    /// One step back.
    StepBack,
    /// Back to the start.
    ToStart,
    /// Back to an earlier value.
    Reset,
    /// Take out.
    Remove,
    /// Show where it is.
    Locate,
    /// It does not work.
    Stop,
    /// It works, and something is not right.
    Caution,
    /// Worth knowing.
    Note,
    /// All is well.
    Check,
}

/// Side of a sign, points.
const SIDE: f32 = 14.0;

/// A sign in a line of text.
pub fn sign(ui: &mut Ui, icon: Icon, colour: Color32) {
    let (rect, _) = ui.allocate_exact_size(Vec2::splat(SIDE), Sense::hover());
    paint(ui.painter(), icon, rect, colour);
}

/// A button with only a sign on it, without a frame; the caller names it.
pub fn plain_button(ui: &mut Ui, icon: Icon) -> Response {
    let enabled = true;
    plain_button_if(enabled, ui, icon)
}

/// Such a button that can be pressed only if `enabled`.
pub fn plain_button_if(enabled: bool, ui: &mut Ui, icon: Icon) -> Response {
    ui.add_enabled_ui(enabled, |ui| {
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(SIDE + 4.0), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, format!("{icon:?}")));
        let visuals = ui.style().interact(&response);
        if response.hovered() || response.has_focus() {
            ui.painter().rect_filled(rect, visuals.corner_radius, visuals.bg_fill);
        }
        let inner = Rect::from_center_size(rect.center(), Vec2::splat(SIDE));
        paint(ui.painter(), icon, inner, visuals.text_color());
        response
    })
    .inner
}

/// A button with a sign before its text.
pub fn text_button(ui: &mut Ui, icon: Icon, text: &str, width: f32) -> Response {
    let id = IdSalt::new("icon");
    let atoms = (Atom::custom(id, Vec2::splat(SIDE)), text).into_atoms();
    let answer = Button::new(atoms).min_size(egui::vec2(width, 0.0)).atom_ui(ui);
    if let Some(rect) = answer.rect(id) {
        paint(ui.painter(), icon, rect, ui.style().interact(&answer.response).text_color());
    }
    crate::widgets::highlight::register(&answer.response, text);
    answer.response
}

/// Draws an icon into a rectangle.
fn paint(painter: &Painter, icon: Icon, rect: Rect, colour: Color32) {
    // Points of the sign lie in −1…1, y down.
    let at = |x: f32, y: f32| rect.center() + egui::vec2(x, y) * (0.5 * SIDE);
    let fill = |points: Vec<Pos2>| Shape::Path(PathShape::convex_polygon(points, colour, Stroke::NONE));
    let bar = |x: f32| Shape::rect_filled(Rect::from_min_max(at(x - 0.14, -0.7), at(x + 0.14, 0.7)), 0.0, colour);
    let triangle = |x: f32, tip: f32| fill(vec![at(x, -0.7), at(tip, 0.0), at(x, 0.7)]);
    let thin = Stroke::new(1.4, colour);
    let mark = |text: &str| {
        let back = if colour.intensity() > 0.5 { Color32::BLACK } else { Color32::WHITE };
        painter.text(at(0.0, 0.08), Align2::CENTER_CENTER, text, FontId::proportional(10.5), back);
    };
    match icon {
        Icon::Play => drop(painter.add(triangle(-0.5, 0.75))),
        Icon::Pause => painter.extend([bar(-0.35), bar(0.35)]),
        Icon::Step => painter.extend([triangle(-0.7, 0.3), bar(0.5)]),
        Icon::StepBack => drop(painter.add(triangle(0.5, -0.75))),
        Icon::ToStart => painter.extend([triangle(0.7, -0.3), bar(-0.5)]),
        Icon::Reset => {
            // Three quarters of a circle, anticlockwise, with its arrow head at the upper left.
            let arc = |k: u8| {
                let angle = -2.35 + 4.9 * f32::from(k) / 16.0;
                at(0.66 * angle.cos(), 0.66 * angle.sin())
            };
            painter.add(Shape::line((0..=16).map(arc).collect(), thin));
            painter.add(fill(vec![at(-0.95, -0.75), at(-0.95, -0.05), at(-0.2, -0.3)]));
        }
        Icon::Remove => {
            painter.line_segment([at(-0.5, -0.5), at(0.5, 0.5)], thin);
            painter.line_segment([at(-0.5, 0.5), at(0.5, -0.5)], thin);
        }
        Icon::Locate => {
            painter.circle_stroke(rect.center(), 0.27 * SIDE, thin);
            for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                painter.line_segment([at(0.25 * x, 0.25 * y), at(0.85 * x, 0.85 * y)], thin);
            }
        }
        Icon::Stop | Icon::Note => {
            painter.circle_filled(rect.center(), 0.48 * SIDE, colour);
            mark(if icon == Icon::Stop { "×" } else { "i" });
        }
        Icon::Caution => {
            painter.add(fill(vec![at(0.0, -0.95), at(1.0, 0.85), at(-1.0, 0.85)]));
            let centre = at(0.0, 0.3);
            let back = if colour.intensity() > 0.5 { Color32::BLACK } else { Color32::WHITE };
            painter.text(pos2(centre.x, centre.y), Align2::CENTER_CENTER, "!", FontId::proportional(10.5), back);
        }
        Icon::Check => {
            painter.add(Shape::line(vec![at(-0.6, 0.0), at(-0.15, 0.5), at(0.7, -0.55)], thin));
        }
    }
}
