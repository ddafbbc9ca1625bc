//! The shapes of a frame as SVG: lines, areas and words stay what they are, in the order in which
//! they are painted.

use std::fmt::Write as _;

use egui::epaint::{ClippedShape, CubicBezierShape, Mesh, PathStroke, QuadraticBezierShape, RectShape, TextShape};
use egui::epaint::{ColorMode, StrokeKind};
use egui::{Color32, Pos2, Rect, Shape, Stroke, Vec2};

/// Steps that a curve is drawn in.
const STEPS: u16 = 16;

/// Writes shapes on a background of one colour, of a size in points.
#[must_use]
pub fn write(shapes: &[ClippedShape], size: Vec2, background: Color32) -> String {
    let (w, h) = (size.x, size.y);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"Ubuntu, sans-serif\">\n<rect width=\"{w}\" height=\"{h}\"{}/>\n",
        fill(background)
    );
    let paper = Rect::from_min_size(Pos2::ZERO, size);
    let mut clip: Option<Rect> = None;
    // Writing to a `String` cannot fail.
    for (k, shape) in shapes.iter().enumerate() {
        let area = shape.clip_rect.intersect(paper);
        if !area.is_positive() {
            continue;
        }
        if clip != Some(area) {
            let close = if clip.is_some() { "</g>\n" } else { "" };
            let _ = writeln!(
                out,
                "{close}<clipPath id=\"c{k}\"><rect {}/></clipPath>\n<g clip-path=\"url(#c{k})\">",
                place(area)
            );
            clip = Some(area);
        }
        draw(&mut out, &shape.shape);
    }
    out.push_str(if clip.is_some() { "</g>\n</svg>\n" } else { "</svg>\n" });
    out
}

fn place(r: Rect) -> String {
    format!("x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", r.min.x, r.min.y, r.width(), r.height())
}

/// A colour as the attributes of a name; nothing to see is left out by who asks.
fn colour(name: &str, c: Color32) -> String {
    let [r, g, b, a] = c.to_srgba_unmultiplied();
    let opacity = if a == 255 { String::new() } else { format!(" {name}-opacity=\"{:.3}\"", f32::from(a) / 255.0) };
    format!(" {name}=\"#{r:02x}{g:02x}{b:02x}\"{opacity}")
}

fn fill(c: Color32) -> String {
    if c.a() == 0 { " fill=\"none\"".to_owned() } else { colour("fill", c) }
}

fn line(stroke: Stroke) -> String {
    if stroke.width <= 0.0 || stroke.color.a() == 0 {
        return String::new();
    }
    format!("{} stroke-width=\"{}\"", colour("stroke", stroke.color), stroke.width)
}

/// The stroke attributes of a path.
fn path_line(stroke: &PathStroke, points: &[Pos2]) -> String {
    let color = match &stroke.color {
        ColorMode::Solid(color) => *color,
        // One colour for a line that has many.
        ColorMode::UV(of) => points.first().map_or(Color32::TRANSPARENT, |p| of(Rect::from_points(points), *p)),
    };
    line(Stroke::new(stroke.width, color))
}

/// The element of SVG for a line through points.
#[derive(Clone, Copy)]
enum LineElement {
    Polygon,
    Polyline,
}

impl LineElement {
    fn of(closed: bool) -> Self {
        if closed { Self::Polygon } else { Self::Polyline }
    }
}

/// Writes a polygon or polyline.
fn path(out: &mut String, points: &[Pos2], element: LineElement, inside: Color32, stroke: &PathStroke) {
    let words: Vec<String> = points.iter().map(|p| format!("{:.2},{:.2}", p.x, p.y)).collect();
    let name = match element {
        LineElement::Polygon => "polygon",
        LineElement::Polyline => "polyline",
    };
    let _ = writeln!(
        out,
        "<{name} points=\"{}\"{}{} stroke-linejoin=\"round\"/>",
        words.join(" "),
        fill(inside),
        path_line(stroke, points)
    );
}

/// Writes a shape.
fn draw(out: &mut String, shape: &Shape) {
    let _ = match shape {
        Shape::Vec(shapes) => {
            shapes.iter().for_each(|s| draw(out, s));
            Ok(())
        }
        Shape::Circle(c) => writeln!(
            out,
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}{}/>",
            c.center.x,
            c.center.y,
            c.radius,
            fill(c.fill),
            line(c.stroke)
        ),
        Shape::Ellipse(e) => writeln!(
            out,
            "<ellipse cx=\"{}\" cy=\"{}\" rx=\"{}\" ry=\"{}\"{}{}/>",
            e.center.x,
            e.center.y,
            e.radius.x,
            e.radius.y,
            fill(e.fill),
            line(e.stroke)
        ),
        Shape::LineSegment { points: [a, b], stroke } => writeln!(
            out,
            "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\"{}/>",
            a.x,
            a.y,
            b.x,
            b.y,
            line(*stroke)
        ),
        Shape::Path(p) => {
            path(out, &p.points, LineElement::of(p.closed), p.fill, &p.stroke);
            Ok(())
        }
        Shape::Rect(r) => {
            rectangle(out, r);
            Ok(())
        }
        Shape::Text(t) => {
            words(out, t);
            Ok(())
        }
        Shape::Mesh(m) => {
            triangles(out, m);
            Ok(())
        }
        Shape::QuadraticBezier(c @ QuadraticBezierShape { closed, .. }) => {
            let points: Vec<Pos2> = (0..=STEPS).map(|k| c.sample(f32::from(k) / f32::from(STEPS))).collect();
            path(out, &points, LineElement::of(*closed), c.fill, &c.stroke);
            Ok(())
        }
        Shape::CubicBezier(c @ CubicBezierShape { closed, .. }) => {
            let points: Vec<Pos2> = (0..=STEPS).map(|k| c.sample(f32::from(k) / f32::from(STEPS))).collect();
            path(out, &points, LineElement::of(*closed), c.fill, &c.stroke);
            Ok(())
        }
        Shape::Noop | Shape::Band(_) | Shape::Callback(_) => Ok(()),
    };
}

/// Writes a rectangle.
fn rectangle(out: &mut String, r: &RectShape) {
    // A blurred one is a shadow.
    if r.blur_width > 0.0 {
        return;
    }
    let half = 0.5 * r.stroke.width;
    let rect = match r.stroke_kind {
        StrokeKind::Inside => r.rect.shrink(half),
        StrokeKind::Middle => r.rect,
        StrokeKind::Outside => r.rect.expand(half),
    };
    if rect.is_positive() {
        let round = r.corner_radius.nw;
        let _ = writeln!(out, "<rect {} rx=\"{round}\"{}{}/>", place(rect), fill(r.fill), line(r.stroke));
    }
}

/// Each row as words as wide as they are in the window, whatever font the reader has.
fn words(out: &mut String, t: &TextShape) {
    let Some(section) = t.galley.job.sections.first() else { return };
    let own = if section.format.color == Color32::PLACEHOLDER { t.fallback_color } else { section.format.color };
    let ink = t.override_text_color.unwrap_or(own).gamma_multiply(t.opacity_factor);
    let turned = if t.angle == 0.0 {
        String::new()
    } else {
        format!(" transform=\"rotate({:.2} {} {})\"", t.angle.to_degrees(), t.pos.x, t.pos.y)
    };
    for row in &t.galley.rows {
        let text: String = row.row.glyphs.iter().map(|g| g.chr).collect();
        let (Some(first), Some(last)) = (row.row.glyphs.first(), row.row.glyphs.last()) else { continue };
        let at = t.pos + row.pos.to_vec2() + first.pos.to_vec2();
        let width = last.pos.x + last.advance_width - first.pos.x;
        let _ = writeln!(
            out,
            "<text x=\"{:.2}\" y=\"{:.2}\" font-size=\"{}\" textLength=\"{width:.2}\" \
             lengthAdjust=\"spacingAndGlyphs\" xml:space=\"preserve\"{}{turned}>{}</text>",
            at.x,
            at.y,
            section.format.font_id.size,
            fill(ink),
            escaped(&text)
        );
    }
}

/// Triangles, each of the mean of its three colours; lines of the same colour close their seams.
fn triangles(out: &mut String, m: &Mesh) {
    for corners in m.indices.chunks_exact(3) {
        let found: Vec<_> = corners.iter().filter_map(|k| m.vertices.get(*k as usize)).collect();
        let [a, b, c] = found[..] else { continue };
        let mean = |k: usize| {
            let sum: u16 = [a, b, c].iter().map(|v| u16::from(v.color.to_array()[k])).sum();
            u8::try_from(sum / 3).unwrap_or(u8::MAX)
        };
        let ink = Color32::from_rgba_premultiplied(mean(0), mean(1), mean(2), mean(3));
        path(out, &[a.pos, b.pos, c.pos], LineElement::Polygon, ink, &PathStroke::new(0.4, ink));
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
