//! Triangles that egui made of a frame become pixels without any graphics adapter.
//!
//! A picture file must look the same on every machine and must not need a driver. Colours are
//! blended as egui's own renderer blends them: premultiplied, in the eye's scale of brightness. A
//! pixel belongs to a triangle where its middle lies inside; a middle on an edge belongs to the
//! triangle that has the edge on its top or left, so that neighbours never both draw a pixel.

use std::collections::HashMap;
use std::ops::Range;

use egui::epaint::{ClippedPrimitive, ImageData, ImageDelta, Mesh, Primitive, Vertex, WHITE_UV};
use egui::{Color32, Pos2, Rect, TextureId, TexturesDelta};
use image::{Rgba, RgbaImage};

/// A colour, premultiplied, each part 0 to 255.
type Colour = [f32; 4];

/// The pictures that triangles are filled with: the font, and what was loaded beside it.
#[derive(Debug, Default)]
pub struct Textures {
    known: HashMap<TextureId, Texture>,
}

/// A picture that triangles are filled with.
#[derive(Debug)]
struct Texture {
    size: [usize; 2],
    pixels: Vec<Color32>,
}

impl Textures {
    /// Takes in what a frame adds and changes.
    pub fn set(&mut self, delta: &mut TexturesDelta) {
        for (id, changes) in delta.set.drain() {
            for change in changes {
                self.change(id, &change);
            }
        }
    }

    /// Forgets what the frame was the last to use.
    pub fn free(&mut self, delta: &mut TexturesDelta) {
        for id in delta.free.drain() {
            self.known.remove(&id);
        }
    }

    /// Applies a change of a texture.
    fn change(&mut self, id: TextureId, change: &ImageDelta) {
        let ImageData::Color(image) = &change.image;
        let Some([left, top]) = change.pos else {
            self.known.insert(id, Texture { size: image.size, pixels: image.pixels.clone() });
            return;
        };
        let Some(texture) = self.known.get_mut(&id) else { return };
        for (row, pixels) in image.pixels.chunks_exact(image.size[0].max(1)).enumerate() {
            let from = (top + row) * texture.size[0] + left;
            if let Some(place) = texture.pixels.get_mut(from..from + pixels.len()) {
                place.copy_from_slice(pixels);
            }
        }
    }
}

impl Texture {
    fn texel(&self, x: f32, y: f32) -> Colour {
        let within = |v: f32, size: usize| (v.max(0.0) as usize).min(size.saturating_sub(1));
        let index = within(y, self.size[1]) * self.size[0] + within(x, self.size[0]);
        parts(self.pixels.get(index).copied().unwrap_or_default())
    }

    /// The colour at a place from 0 to 1, mixed of the four texels round it.
    fn at(&self, u: f32, v: f32) -> Colour {
        let (x, y) = (u * self.size[0] as f32 - 0.5, v * self.size[1] as f32 - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (right, low) = (x - left, y - top);
        // Letters that lie on whole pixels ask for one texel alone.
        if right < 1e-3 && low < 1e-3 {
            return self.texel(left, top);
        }
        let mix = |a: Colour, b: Colour, share: f32| std::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
        let row = |y: f32| mix(self.texel(left, y), self.texel(left + 1.0, y), right);
        mix(row(top), row(top + 1.0), low)
    }
}

fn parts(colour: Color32) -> Colour {
    colour.to_array().map(f32::from)
}

/// The picture that a frame is drawn on.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Pixels per point.
    pub pixels_per_point: f32,
    /// Its colour, which counts as opaque.
    pub background: Color32,
}

/// The part of a picture that a mesh may draw in.
#[derive(Clone, Copy, Debug)]
struct Clip {
    /// Left, top, right and bottom, pixels; right and bottom are not within.
    pixels: [u32; 4],
    pixels_per_point: f32,
}

/// Draws what a frame is made of.
#[must_use]
pub fn draw(primitives: &[ClippedPrimitive], textures: &Textures, frame: Frame) -> RgbaImage {
    let Frame { size, pixels_per_point, background } = frame;
    let mut picture = RgbaImage::from_pixel(size[0], size[1], Rgba(background.to_opaque().to_array()));
    for ClippedPrimitive { clip_rect, primitive } in primitives {
        if let Primitive::Mesh(mesh) = primitive
            && let Some(texture) = textures.known.get(&mesh.texture_id)
        {
            let clip = Clip { pixels: pixels(*clip_rect, pixels_per_point, size), pixels_per_point };
            draw_mesh(&mut picture, mesh, texture, clip);
        }
    }
    picture
}

/// Left, top, right and bottom of a clip in pixels; right and bottom are not within.
fn pixels(clip: Rect, pixels_per_point: f32, size: [u32; 2]) -> [u32; 4] {
    let pixel = |v: f32, most: u32| ((v * pixels_per_point).round().max(0.0) as u32).min(most);
    [pixel(clip.min.x, size[0]), pixel(clip.min.y, size[1]), pixel(clip.max.x, size[0]), pixel(clip.max.y, size[1])]
}

/// Draws the triangles of a mesh.
fn draw_mesh(picture: &mut RgbaImage, mesh: &Mesh, texture: &Texture, clip: Clip) {
    for triangle in mesh.indices.chunks_exact(3) {
        let corner = |k: usize| triangle.get(k).and_then(|i| mesh.vertices.get(*i as usize));
        if let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) {
            draw_triangle(picture, texture, [a, b, c], clip);
        }
    }
}

/// Twice the area between an edge and a point: positive on the inner side of a triangle whose
/// corners go round clockwise on the screen. An edge and the same one backwards differ in the sign
/// alone, so that neighbours leave no gap by rounding.
fn side(from: Pos2, to: Pos2, x: f32, y: f32) -> f32 {
    if (from.x, from.y) > (to.x, to.y) {
        return -side(to, from, x, y);
    }
    (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)
}

/// An edge is on the top or the left of a triangle whose corners go round clockwise.
fn top_or_left(from: Pos2, to: Pos2) -> bool {
    to.y < from.y || (to.y == from.y && to.x > from.x)
}

/// Draws a triangle; pixels on an edge between two belong to one of them.
fn draw_triangle(picture: &mut RgbaImage, texture: &Texture, corners: [&Vertex; 3], clip: Clip) {
    let Clip { pixels: clip, pixels_per_point: scale } = clip;
    let [mut a, mut b, c] = corners;
    let at = |v: &Vertex| Pos2::new(v.pos.x * scale, v.pos.y * scale);
    let area = side(at(a), at(b), at(c).x, at(c).y);
    if !area.is_finite() || area == 0.0 {
        return;
    }
    if area < 0.0 {
        std::mem::swap(&mut a, &mut b);
    }
    let (corners, area) = ([a, b, c], area.abs());
    let places = corners.map(at);
    let edges = [[places[1], places[2]], [places[2], places[0]], [places[0], places[1]]];
    let owned = edges.map(|[from, to]| top_or_left(from, to));
    let (low, high) = places.iter().fold((places[0], places[0]), |(low, high), p| (low.min(*p), high.max(*p)));
    let first = |v: f32, least: u32| ((v - 0.5).ceil().max(0.0) as u32).max(least);
    let end = |v: f32, most: u32| ((v + 0.5).floor().max(0.0) as u32).min(most);
    let (columns, rows) = (first(low.x, clip[0])..end(high.x, clip[2]), first(low.y, clip[1])..end(high.y, clip[3]));
    let colours = corners.map(|v| parts(v.color));
    let even = corners.iter().all(|v| v.color == a.color).then_some(colours[0]);
    let plain = corners.iter().all(|v| v.uv == WHITE_UV);
    for y in rows {
        let py = y as f32 + 0.5;
        for x in reach(&edges, py, columns.clone()) {
            let px = x as f32 + 0.5;
            let sides = edges.map(|[from, to]| side(from, to, px, py));
            if !sides.iter().zip(owned).all(|(s, owned)| *s > 0.0 || (owned && *s == 0.0)) {
                continue;
            }
            let shares = sides.map(|s| s / area);
            let mixed = |of: [f32; 3]| shares[0] * of[0] + shares[1] * of[1] + shares[2] * of[2];
            let mut colour =
                even.unwrap_or_else(|| std::array::from_fn(|k| mixed([colours[0][k], colours[1][k], colours[2][k]])));
            if !plain {
                let texel = texture.at(mixed(corners.map(|v| v.uv.x)), mixed(corners.map(|v| v.uv.y)));
                colour = std::array::from_fn(|k| colour[k] * texel[k] / 255.0);
            }
            blend(picture.get_pixel_mut(x, y), colour);
        }
    }
}

/// The columns of a row that a triangle can reach, with one to spare on both sides for rounding: a
/// long thin triangle would otherwise ask every pixel of its frame.
fn reach(edges: &[[Pos2; 2]; 3], y: f32, columns: Range<u32>) -> Range<u32> {
    let (mut low, mut high) = (columns.start as f32, columns.end as f32);
    for [from, to] in edges {
        let rise = to.y - from.y;
        let x = from.x + (to.x - from.x) * (y - from.y) / rise;
        if rise > 0.0 {
            high = high.min(x + 1.5);
        } else if rise < 0.0 {
            low = low.max(x - 1.5);
        }
    }
    (low as u32).max(columns.start)..(high.ceil().max(0.0) as u32).min(columns.end)
}

/// Lays a premultiplied colour over an opaque one.
fn blend(pixel: &mut Rgba<u8>, colour: Colour) {
    let through = 1.0 - colour[3] / 255.0;
    for k in 0..3 {
        pixel.0[k] = (colour[k] + through * f32::from(pixel.0[k])).round().clamp(0.0, 255.0) as u8;
    }
}

#[cfg(test)]
mod tests {
    use egui::epaint::ColorImage;

    use super::*;

    fn square(of: [[f32; 2]; 4], colour: Color32) -> ClippedPrimitive {
        let vertices = of.map(|[x, y]| Vertex { pos: Pos2::new(x, y), uv: WHITE_UV, color: colour }).to_vec();
        let mesh = Mesh { vertices, indices: vec![0, 1, 2, 0, 2, 3], ..Mesh::default() };
        let clip_rect = Rect::from_min_max(Pos2::ZERO, Pos2::new(5.0, 5.0));
        ClippedPrimitive { clip_rect, primitive: Primitive::Mesh(mesh) }
    }

    fn textures(pixels: Vec<Color32>) -> Textures {
        let mut textures = Textures::default();
        let image = ColorImage::new([2, pixels.len() / 2], pixels);
        textures.change(TextureId::default(), &ImageDelta::full(image, egui::TextureOptions::LINEAR));
        textures
    }

    #[test]
    fn triangles_that_share_an_edge_draw_each_pixel_once_and_stay_in_their_clip() {
        let half = Color32::from_rgba_premultiplied(64, 64, 64, 128);
        let white = textures(vec![Color32::WHITE; 4]);
        // Either way round, and with the shared edge through the middles of pixels.
        for of in [[[1.0, 1.0], [7.0, 1.0], [7.0, 7.0], [1.0, 7.0]], [[1.0, 1.0], [1.0, 7.0], [7.0, 7.0], [7.0, 1.0]]] {
            let picture = draw(
                &[square(of, half)],
                &white,
                Frame { size: [8, 8], pixels_per_point: 1.0, background: Color32::BLACK },
            );
            for (x, y, pixel) in picture.enumerate_pixels() {
                let inside = (1..5).contains(&x) && (1..5).contains(&y);
                assert_eq!(pixel.0, if inside { [64, 64, 64, 255] } else { [0, 0, 0, 255] }, "{x}, {y}");
            }
        }
    }

    #[test]
    fn a_part_of_a_texture_is_changed_and_mixed_between_its_texels() {
        let mut textures = textures(vec![Color32::BLACK, Color32::WHITE, Color32::BLACK, Color32::WHITE]);
        let texture = &textures.known[&TextureId::default()];
        assert_eq!(texture.at(0.25, 0.25)[0], 0.0);
        assert!((texture.at(0.5, 0.5)[0] - 127.5).abs() < 1e-3);
        let red = ColorImage::new([1, 1], vec![Color32::RED]);
        textures.change(TextureId::default(), &ImageDelta::partial([1, 1], red, egui::TextureOptions::LINEAR));
        assert_eq!(textures.known[&TextureId::default()].at(0.75, 0.75), [255.0, 0.0, 0.0, 255.0]);
    }
}
