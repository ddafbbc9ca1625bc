//! A cheaper shader takes the place of egui's own if no GPU draws but Mesa's software Vulkan. The
//! picture of the frame before is kept, and only the tiles of it that have changed are drawn.

use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu};
use egui::emath::GuiRounding;
use egui::epaint::{ClippedPrimitive, ClippedShape, ImageData, ImageDelta, Mesh, Primitive, Shape, Vertex, WHITE_UV};
use egui::{Context, FullOutput, Pos2, Rect, Stroke, TextureId};

use crate::render::changed_tiles::{TileContents, TileRectangle, hash_with};

/// Colour times font.
const SHADER: &str = "
struct VertexCorner { @builtin(position) at: vec4f, @location(0) uv: vec2f, @location(1) colour: vec4f };
@group(0) @binding(0) var<uniform> screen: vec4f;
@group(0) @binding(1) var font: texture_2d<f32>;
@group(0) @binding(2) var font_sampler: sampler;
@vertex fn corner(@location(0) p: vec2f, @location(1) uv: vec2f, @location(2) colour: vec4f) -> VertexCorner {
    return VertexCorner(vec4f(2.0 * p.x / screen.x - 1.0, 1.0 - 2.0 * p.y / screen.y, 0.0, 1.0), uv, colour);
}
@fragment fn pixel(c: VertexCorner) -> @location(0) vec4f { return c.colour * textureSample(font, font_sampler, c.uv); }
@fragment fn plain(c: VertexCorner) -> @location(0) vec4f { return c.colour; }
struct Solid { @builtin(position) at: vec4f, @location(0) @interpolate(flat) colour: vec4f };
@vertex fn solid_corner(@location(0) p: vec2f, @location(2) colour: vec4f) -> Solid {
    return Solid(vec4f(2.0 * p.x / screen.x - 1.0, 1.0 - 2.0 * p.y / screen.y, 0.0, 1.0), colour);
}
@fragment fn solid(c: Solid) -> @location(0) vec4f { return c.colour; }
";

/// The kept picture, point for point. Mesa copies the rows of a rectangle whose colour is that of a
/// texture and nothing else, read at two of four numbers: 1.8 ms for 1280×800. With a vector of two
/// numbers, which says the same, it asks the texture pixel by pixel: 5.7 ms.
const COPY_SHADER: &str = "
struct CopyCorner { @builtin(position) at: vec4f, @location(0) uv: vec4f };
@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var picture_sampler: sampler;
@vertex fn copy_corner(@location(0) at: vec2f, @location(1) uv: vec2f) -> CopyCorner {
    return CopyCorner(vec4f(at, 0.0, 1.0), vec4f(uv, uv));
}
@fragment fn copy(c: CopyCorner) -> @location(0) vec4f { return textureSample(picture, picture_sampler, c.uv.xy); }
";

/// Corners of two triangles over the whole target: place, place in the picture.
const COPY_CORNERS: [[f32; 4]; 6] = [
    [-1.0, 1.0, 0.0, 0.0],
    [-1.0, -1.0, 0.0, 1.0],
    [1.0, -1.0, 1.0, 1.0],
    [-1.0, 1.0, 0.0, 0.0],
    [1.0, -1.0, 1.0, 1.0],
    [1.0, 1.0, 1.0, 0.0],
];

/// Twice the area, points², from which a triangle of one colour, or a row of small ones, is drawn
/// without asking the font. Smaller: changing the shader costs more than the pixels; larger:
/// buttons and plots ask the font for nothing.
const LEAST_PLAIN_DOUBLE_AREA_POINTS2: f32 = 4000.0;

/// Bytes that are got from the system and given back once before the first frame, of the 32 MiB at
/// most at which glibc learns from it. Fewer: what the renderer frees after each frame goes back to
/// the system, page by page, and is got again for the next: a third of the window's thread.
const RETAINED_MEMORY: usize = 31 << 20;

/// Bytes of a corner: place, place in the font, colour.
const CORNER_BYTES: u64 = 20;

/// Place, place in the font, colour.
const CORNER_ATTRIBUTES: [wgpu::VertexAttribute; 3] =
    wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Unorm8x4];

/// Place, place in the kept picture.
const COPY_CORNER_ATTRIBUTES: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x2];

/// Takes over what egui would draw.
pub struct SoftwarePainter {
    format: wgpu::TextureFormat,
    /// Changes of the font not yet on the device: a frame that is never drawn must not lose them.
    font: Arc<Mutex<Vec<ImageDelta>>>,
}

impl SoftwarePainter {
    /// For a device that is software; None where a GPU draws, which egui's shader suits.
    #[must_use]
    pub fn of(state: &RenderState) -> Option<Self> {
        let software = state.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        // egui blends in the eye's scale of brightness: a target that converts by itself would need
        // another shader.
        let plain = !state.target_format.is_srgb();
        (software && plain).then(|| {
            retain_freed_memory();
            Self { format: state.target_format, font: Arc::default() }
        })
    }
}

/// From now on the allocator keeps what is freed at the end of its heaps, up to twice
/// [`RETAINED_MEMORY`]: glibc raises its limit when a block that had a mapping of its own is freed.
/// Other allocators are not affected.
fn retain_freed_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(RETAINED_MEMORY)));
}

/// Upright and level lines of whole pixels become two triangles each, where egui makes ten, with
/// borders that fade into nothing: the picture is the same, since egui puts such lines on whole
/// pixels. Each triangle of a long line costs as much as the tiles of the screen that it passes.
fn with_lines_as_rectangles(shape: Shape, pixels_per_point: f32) -> Shape {
    match shape {
        Shape::LineSegment { points, stroke } => match rectangle_of(points, stroke, pixels_per_point) {
            Some(rect) => {
                let mut mesh = Mesh::default();
                mesh.add_colored_rect(rect, stroke.color);
                Shape::mesh(mesh)
            }
            None => Shape::LineSegment { points, stroke },
        },
        Shape::Vec(shapes) => {
            Shape::Vec(shapes.into_iter().map(|s| with_lines_as_rectangles(s, pixels_per_point)).collect())
        }
        other => other,
    }
}

/// The pixels of an upright or level line of a whole number of pixels, as egui rounds it, points.
fn rectangle_of([a, b]: [Pos2; 2], stroke: Stroke, pixels_per_point: f32) -> Option<Rect> {
    let pixels = stroke.width * pixels_per_point;
    let (upright, level) = (a.x == b.x, a.y == b.y);
    if pixels < 0.5 || (pixels - pixels.round()).abs() > 1e-3 || upright == level {
        return None;
    }
    let (mut rect, half) = (Rect::from_two_pos(a, b), 0.5 * stroke.width);
    let (pixel, mut middle) = (1.0 / pixels_per_point, if upright { a.x } else { a.y });
    stroke.round_center_to_pixel(pixels_per_point, &mut middle);
    // From pixel to pixel, both of them within the line.
    let along = |from: f32, to: f32| {
        let [from, to] = [from + 0.25 * pixel, to - 0.25 * pixel].map(|v| v.round_to_pixel_center(pixels_per_point));
        (from - 0.5 * pixel, to + 0.5 * pixel)
    };
    if upright {
        (rect.min.y, rect.max.y) = along(rect.min.y, rect.max.y);
        (rect.min.x, rect.max.x) = (middle - half, middle + half);
    } else {
        (rect.min.x, rect.max.x) = along(rect.min.x, rect.max.x);
        (rect.min.y, rect.max.y) = (middle - half, middle + half);
    }
    Some(rect)
}

impl egui::Plugin for SoftwarePainter {
    fn debug_name(&self) -> &'static str {
        "software drawing"
    }

    fn output_hook(&mut self, ctx: &Context, output: &mut FullOutput) {
        let changes = output.textures_delta.set.get(&TextureId::default());
        let mut font = self.font.lock().unwrap_or_else(PoisonError::into_inner);
        for change in changes.into_iter().flatten() {
            if change.pos.is_none() {
                font.clear();
            }
            font.push(change.clone());
        }
        drop(font);
        // Other pictures than the font, and other programs' drawing, are left to egui.
        let own =
            |s: &ClippedShape| !matches!(s.shape, Shape::Callback(_)) && s.shape.texture_id() == TextureId::default();
        if output.shapes.is_empty() || !output.shapes.iter().all(own) {
            return;
        }
        let shapes = std::mem::take(&mut output.shapes).into_iter();
        let shapes =
            shapes.map(|s| ClippedShape { shape: with_lines_as_rectangles(s.shape, output.pixels_per_point), ..s });
        let jobs = ctx.tessellate(shapes.collect(), output.pixels_per_point);
        let screen = ctx.viewport_rect();
        let picture = FrameGeometry::of(&jobs, screen, output.pixels_per_point, self.format, Arc::clone(&self.font));
        let callback = egui_wgpu::Callback::new_paint_callback(screen, picture);
        output.shapes = vec![ClippedShape::new(screen, callback)];
    }
}

/// Triangles that are drawn alike within some pixels of the target.
struct Piece {
    /// Left edge, upper edge, width and height, pixels.
    scissor: [u32; 4],
    /// Their end in the list of indices.
    end: u32,
    fill: Fill,
}

/// The pixels in both rectangles; None where there are none.
fn common(a: [u32; 4], b: [u32; 4]) -> Option<[u32; 4]> {
    let range = |k: usize| {
        let (from, to) = (a[k].max(b[k]), (a[k] + a[k + 2]).min(b[k] + b[k + 2]));
        (to > from).then(|| (from, to - from))
    };
    let ((x, w), (y, h)) = (range(0)?, range(1)?);
    Some([x, y, w, h])
}

/// Two numbers as one word.
fn bits(x: f32, y: f32) -> u64 {
    u64::from(x.to_bits()) << 32 | u64::from(y.to_bits())
}

/// A hash of a corner.
fn corner_hash(corner: &Vertex) -> u64 {
    let place = hash_with(bits(corner.pos.x, corner.pos.y), bits(corner.uv.x, corner.uv.y));
    hash_with(place, u64::from(u32::from_le_bytes(corner.color.to_array())))
}

/// The smallest upright rectangle round a triangle.
fn bounds(mesh: &Mesh, triangle: &[u32]) -> Rect {
    let corners = triangle.iter().filter_map(|i| mesh.vertices.get(*i as usize));
    corners.fold(Rect::NOTHING, |all, corner| all.union(Rect::from_min_max(corner.pos, corner.pos)))
}

/// Triangles that are drawn alike.
struct Part {
    clip: Rect,
    /// Their end in the list of indices.
    end: u32,
    fill: Fill,
}

/// The filling of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fill {
    /// Colours and the font.
    Font,
    /// Colours.
    Plain,
    /// One opaque colour.
    Solid,
}

/// A frame.
struct FrameGeometry {
    corners: Vec<u8>,
    indices: Vec<u32>,
    parts: Vec<Part>,
    /// The tiles that each triangle may touch; None where it is cut off.
    triangle_tiles: Vec<Option<TileRectangle>>,
    /// All that is drawn in each tile.
    contents: TileContents,
    screen: Rect,
    format: wgpu::TextureFormat,
    font: Arc<Mutex<Vec<ImageDelta>>>,
}

impl FrameGeometry {
    /// The corners, triangles and tiles of a frame.
    fn of(
        jobs: &[ClippedPrimitive],
        screen: Rect,
        pixels_per_point: f32,
        format: wgpu::TextureFormat,
        font: Arc<Mutex<Vec<ImageDelta>>>,
    ) -> Self {
        let meshes = || {
            jobs.iter().filter_map(|job| match &job.primitive {
                Primitive::Mesh(mesh) => Some((job.clip_rect, mesh)),
                Primitive::Callback(_) => None,
            })
        };
        let corners: usize = meshes().map(|(_, m)| m.vertices.len()).sum();
        let indices: usize = meshes().map(|(_, m)| m.indices.len()).sum();
        let mut picture = Self {
            corners: Vec::with_capacity(corners * CORNER_BYTES as usize),
            indices: Vec::with_capacity(indices),
            parts: Vec::new(),
            triangle_tiles: Vec::with_capacity(indices / 3),
            contents: TileContents::empty(screen, pixels_per_point),
            screen,
            format,
            font,
        };
        let mut first = 0;
        for (clip, mesh) in meshes() {
            picture.corners.extend_from_slice(bytemuck::cast_slice(&mesh.vertices));
            let fills = fills(mesh);
            // A clip is rounded to whole pixels.
            let reach = clip.expand(1.0 / pixels_per_point);
            let clip_hash = [clip.min, clip.max].iter().fold(0, |h, p| hash_with(h, bits(p.x, p.y)));
            let hashes: Vec<u64> = mesh.vertices.iter().map(corner_hash).collect();
            for (triangle, fill) in mesh.indices.chunks_exact(3).zip(fills) {
                picture.add(clip, fill, triangle.iter().map(|i| first + i));
                let tiles = picture.contents.covering(bounds(mesh, triangle).intersect(reach));
                picture.triangle_tiles.push(tiles);
                let own = triangle.iter().filter_map(|i| hashes.get(*i as usize));
                let hash = own.fold(hash_with(clip_hash, fill as u64), |h, corner| hash_with(h, *corner));
                tiles.into_iter().for_each(|tiles| picture.contents.add(tiles, hash));
            }
            first += mesh.vertices.len() as u32;
        }
        picture
    }

    /// The pieces of the frame that lie in these tiles of a target, each rectangle from scratch:
    /// indices of corners, and what is drawn with them. The corners of the rectangles themselves
    /// follow those of the frame.
    fn pieces_in(&self, rectangles: &[TileRectangle], scale: f32, size: [u32; 2]) -> (Vec<u8>, Vec<u32>, Vec<Piece>) {
        let (mut corners, mut indices, mut pieces) = (Vec::new(), Vec::new(), Vec::new());
        for rectangle in rectangles {
            let area = rectangle.pixels(size);
            let [x, y, w, h] = area.map(|v| v as f32 / scale);
            let area_rect = Rect::from_min_size(Pos2::new(x, y), egui::vec2(w, h));
            let mut background = Mesh::default();
            background.add_colored_rect(area_rect, egui::Color32::BLACK);
            let first = ((self.corners.len() + corners.len()) as u64 / CORNER_BYTES) as u32;
            corners.extend_from_slice(bytemuck::cast_slice(&background.vertices));
            indices.extend(background.indices.iter().map(|i| first + i));
            pieces.push(Piece { scissor: area, end: indices.len() as u32, fill: Fill::Solid });
            let mut first_triangle = 0;
            for part in &self.parts {
                let triangles = first_triangle..part.end as usize / 3;
                first_triangle = triangles.end;
                let Some(scissor) = Self::scissor(part.clip, scale, size).and_then(|clip| common(clip, area)) else {
                    continue;
                };
                let before = indices.len();
                let tiles = self.triangle_tiles.get(triangles.clone()).unwrap_or_default();
                let own = self.indices.get(3 * triangles.start..3 * triangles.end).unwrap_or_default();
                for (triangle, tiles) in own.chunks_exact(3).zip(tiles) {
                    if tiles.is_some_and(|tiles| tiles.meets(*rectangle)) {
                        indices.extend_from_slice(triangle);
                    }
                }
                if indices.len() > before {
                    pieces.push(Piece { scissor, end: indices.len() as u32, fill: part.fill });
                }
            }
        }
        (corners, indices, pieces)
    }

    /// A triangle, in order: in the last part if it is drawn alike.
    fn add(&mut self, clip: Rect, fill: Fill, indices: impl Iterator<Item = u32>) {
        self.indices.extend(indices);
        let end = self.indices.len() as u32;
        match self.parts.last_mut() {
            Some(part) if part.clip == clip && part.fill == fill => part.end = end,
            _ => self.parts.push(Part { clip, end, fill }),
        }
    }

    /// A clip in pixels of a target; None where nothing is left.
    fn scissor(clip: Rect, scale: f32, [width, height]: [u32; 2]) -> Option<[u32; 4]> {
        let pixel = |v: f32, most: u32| ((v * scale).round().max(0.0) as u32).min(most);
        let (x0, y0) = (pixel(clip.min.x, width), pixel(clip.min.y, height));
        let (x1, y1) = (pixel(clip.max.x, width), pixel(clip.max.y, height));
        (x1 > x0 && y1 > y0).then(|| [x0, y0, x1 - x0, y1 - y0])
    }
}

impl CallbackTrait for FrameGeometry {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if !resources.contains::<Device>() {
            resources.insert(Device::new(device, queue, self.format));
        }
        let Some(own) = resources.get_mut::<Device>() else { return Vec::new() };
        own.fit_picture(device, self.format, screen.size_in_pixels);
        for change in self.font.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
            own.set_font(device, queue, &change);
        }
        let changed = match &own.drawn {
            Some(drawn) => self.contents.changed_since(drawn),
            None => self.contents.all(),
        };
        if !changed.is_empty() {
            self.draw(&changed, device, queue, screen, encoder, own);
        }
        own.drawn = Some(self.contents.clone());
        Vec::new()
    }

    fn paint(
        &self,
        info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(own) = resources.get::<Device>() else { return };
        let [width, height] = info.screen_size_px;
        pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
        pass.set_scissor_rect(0, 0, width, height);
        pass.set_pipeline(&own.copy);
        pass.set_bind_group(0, &own.picture.bound, &[]);
        pass.set_vertex_buffer(0, own.copy_corners.slice(..));
        pass.draw(0..COPY_CORNERS.len() as u32, 0..1);
    }
}

impl FrameGeometry {
    /// Draws tiles of the kept picture anew.
    fn draw(
        &self,
        changed: &[TileRectangle],
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        own: &mut Device,
    ) {
        let size = [self.screen.width(), self.screen.height(), 0.0, 0.0].map(f32::to_le_bytes);
        queue.write_buffer(&own.screen, 0, size.as_flattened());
        let (backgrounds, indices, pieces) = self.pieces_in(changed, screen.pixels_per_point, screen.size_in_pixels);
        let corner_bytes = self.corners.len() as u64;
        fit_buffer(device, &mut own.corners, corner_bytes + backgrounds.len() as u64);
        queue.write_buffer(&own.corners, 0, &self.corners);
        queue.write_buffer(&own.corners, corner_bytes, &backgrounds);
        let index_bytes: &[u8] = bytemuck::cast_slice(&indices);
        fit_buffer(device, &mut own.indices, index_bytes.len() as u64);
        queue.write_buffer(&own.indices, 0, index_bytes);
        let attachment = wgpu::RenderPassColorAttachment {
            view: &own.picture.view,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            depth_slice: None,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("software drawing"),
            color_attachments: &[Some(attachment)],
            ..Default::default()
        });
        pass.set_bind_group(0, &own.bound, &[]);
        pass.set_vertex_buffer(0, own.corners.slice(..));
        pass.set_index_buffer(own.indices.slice(..), wgpu::IndexFormat::Uint32);
        let (mut first, mut fill) = (0, None);
        for piece in &pieces {
            if fill != Some(piece.fill) {
                pass.set_pipeline(match piece.fill {
                    Fill::Font => &own.pipeline,
                    Fill::Plain => &own.plain,
                    Fill::Solid => &own.solid,
                });
                fill = Some(piece.fill);
            }
            let [x, y, w, h] = piece.scissor;
            pass.set_scissor_rect(x, y, w, h);
            pass.draw_indexed(first..piece.end, 0, 0..1);
            first = piece.end;
        }
    }
}

/// Makes a buffer large enough, with room for more.
fn fit_buffer(device: &wgpu::Device, buffer: &mut wgpu::Buffer, bytes: u64) {
    if buffer.size() < bytes {
        *buffer = buffer_of(device, 2 * bytes, buffer.usage());
    }
}

/// Returns how each triangle can be drawn: large ones by themselves, small ones that ask the font
/// for nothing where enough of them follow each other.
fn fills(mesh: &Mesh) -> Vec<Fill> {
    let mut fills = Vec::with_capacity(mesh.indices.len() / 3);
    // The row of small ones that are drawn alike, and twice its area, points².
    let (mut row, mut area) = (0..0, 0.0);
    let mut row_fill = Fill::Font;
    for triangle in mesh.indices.chunks_exact(3) {
        let (size, fill) = single_triangle_fill(mesh, triangle);
        let fill = fill.unwrap_or(Fill::Font);
        if fill != row_fill {
            close_triangle_row(&mut fills, row, area, row_fill);
            (row, area, row_fill) = (fills.len()..fills.len(), 0.0, fill);
        }
        area += size;
        fills.push(if size > LEAST_PLAIN_DOUBLE_AREA_POINTS2 { fill } else { Fill::Font });
        row.end = fills.len();
    }
    close_triangle_row(&mut fills, row, area, row_fill);
    fills
}

/// A row of triangles that are drawn alike is over.
fn close_triangle_row(fills: &mut [Fill], row: std::ops::Range<usize>, area: f32, fill: Fill) {
    if area > LEAST_PLAIN_DOUBLE_AREA_POINTS2 {
        fills.get_mut(row).into_iter().flatten().for_each(|f| *f = fill);
    }
}

/// Twice the area of a triangle, points², and how it can be drawn without the font, if it can.
fn single_triangle_fill(mesh: &Mesh, triangle: &[u32]) -> (f32, Option<Fill>) {
    let corner = |k: usize| triangle.get(k).and_then(|i| mesh.vertices.get(*i as usize));
    let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else { return (0.0, None) };
    let (u, v) = (b.pos - a.pos, c.pos - a.pos);
    let size = (u.x * v.y - u.y * v.x).abs();
    if [a, b, c].iter().any(|p| p.uv != WHITE_UV) {
        return (size, None);
    }
    let even = a.color.is_opaque() && a.color == b.color && a.color == c.color;
    (size, Some(if even { Fill::Solid } else { Fill::Plain }))
}

/// The resources that stay on the device.
struct Device {
    pipeline: wgpu::RenderPipeline,
    plain: wgpu::RenderPipeline,
    solid: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    screen: wgpu::Buffer,
    font: wgpu::Texture,
    bound: wgpu::BindGroup,
    corners: wgpu::Buffer,
    indices: wgpu::Buffer,
    copy: wgpu::RenderPipeline,
    copy_layout: wgpu::BindGroupLayout,
    copy_corners: wgpu::Buffer,
    picture: Picture,
    /// The contents of the kept picture; None before the first frame.
    drawn: Option<TileContents>,
}

/// The kept picture.
struct Picture {
    size: [u32; 2],
    view: wgpu::TextureView,
    bound: wgpu::BindGroup,
}

impl Picture {
    /// The texture that keeps the picture from frame to frame.
    fn new(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
        size: [u32; 2],
    ) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("kept picture"),
            size: wgpu::Extent3d { width: size[0].max(1), height: size[1].max(1), depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("kept picture"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(sampler) },
            ],
        });
        Self { size, view, bound }
    }
}

impl Device {
    /// The buffers, textures and pipelines of the painter.
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, format: wgpu::TextureFormat) -> Self {
        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let filtering = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("software drawing"),
            entries: &[
                entry(0, wgpu::ShaderStages::VERTEX, uniform),
                entry(1, wgpu::ShaderStages::FRAGMENT, texture),
                entry(2, wgpu::ShaderStages::FRAGMENT, filtering),
            ],
        });
        let copy_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("kept picture"),
            entries: &[
                entry(0, wgpu::ShaderStages::FRAGMENT, texture),
                entry(1, wgpu::ShaderStages::FRAGMENT, filtering),
            ],
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            // Letters lie on whole pixels at every scale: to mix four points of the font for each
            // costs an eighth of a frame and changes nothing.
            mag_filter: wgpu::FilterMode::Nearest,
            min_filter: wgpu::FilterMode::Nearest,
            ..Default::default()
        });
        let screen = buffer_of(device, 16, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        let font = font_of(device, [1, 1]);
        let bound = bind(device, &layout, &screen, &font, &sampler);
        let copy_bytes = size_of_val(&COPY_CORNERS) as u64;
        let copy_corners = buffer_of(device, copy_bytes, wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST);
        queue.write_buffer(&copy_corners, 0, bytemuck::cast_slice(COPY_CORNERS.as_flattened()));
        Self {
            copy: copy_pipeline(device, format, &copy_layout),
            picture: Picture::new(device, format, &copy_layout, &sampler, [1, 1]),
            copy_layout,
            copy_corners,
            drawn: None,
            pipeline: pipeline(device, format, &layout, Fill::Font),
            plain: pipeline(device, format, &layout, Fill::Plain),
            solid: pipeline(device, format, &layout, Fill::Solid),
            corners: buffer_of(device, 1 << 20, wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST),
            indices: buffer_of(device, 1 << 20, wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST),
            layout,
            sampler,
            screen,
            font,
            bound,
        }
    }

    /// Begins another picture where the target has another size.
    fn fit_picture(&mut self, device: &wgpu::Device, format: wgpu::TextureFormat, size: [u32; 2]) {
        if self.picture.size != size {
            self.picture = Picture::new(device, format, &self.copy_layout, &self.sampler, size);
            self.drawn = None;
        }
    }

    /// Takes in a change of the font: the whole of it, or a part. Letters may lie elsewhere in
    /// another one, under the same places.
    fn set_font(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, change: &ImageDelta) {
        let ImageData::Color(image) = &change.image;
        let [width, height] = image.size.map(|s| s as u32);
        let at = match change.pos {
            Some(at) => at.map(|v| v as u32),
            None => {
                self.drawn = None;
                self.font = font_of(device, [width, height]);
                self.bound = bind(device, &self.layout, &self.screen, &self.font, &self.sampler);
                [0, 0]
            }
        };
        // Before the first whole one there is nothing to change.
        if at[0] + width > self.font.width() || at[1] + height > self.font.height() {
            return;
        }
        let to = wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d { x: at[0], y: at[1], z: 0 },
            ..self.font.as_image_copy()
        };
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        queue.write_texture(
            to,
            bytemuck::cast_slice(&image.pixels),
            rows,
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    }
}

/// A buffer of a size (bytes).
fn buffer_of(device: &wgpu::Device, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("software drawing"),
        size,
        usage,
        mapped_at_creation: false,
    })
}

/// A texture for glyphs, of a size (pixels).
fn font_of(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("font"),
        size: wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Binds the inputs of the shader.
fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    screen: &wgpu::Buffer,
    font: &wgpu::Texture,
    sampler: &wgpu::Sampler,
) -> wgpu::BindGroup {
    let view = font.create_view(&wgpu::TextureViewDescriptor::default());
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("software drawing"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: screen.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(sampler) },
        ],
    })
}

/// The pipeline that draws triangles with this fill.
fn pipeline(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    layout: &wgpu::BindGroupLayout,
    fill: Fill,
) -> wgpu::RenderPipeline {
    // The entry points of the shader.
    let entry_points = match fill {
        Fill::Font => ["corner", "pixel"],
        Fill::Plain => ["corner", "plain"],
        Fill::Solid => ["solid_corner", "solid"],
    };
    // As egui blends: colours are premultiplied.
    let part =
        |src_factor, dst_factor| wgpu::BlendComponent { src_factor, dst_factor, operation: wgpu::BlendOperation::Add };
    let blend = wgpu::BlendState {
        color: part(wgpu::BlendFactor::One, wgpu::BlendFactor::OneMinusSrcAlpha),
        alpha: part(wgpu::BlendFactor::OneMinusDstAlpha, wgpu::BlendFactor::One),
    };
    // An opaque fill covers the pixels below it: nothing is read back.
    let blend = (fill != Fill::Solid).then_some(blend);
    let corners = wgpu::VertexBufferLayout {
        array_stride: CORNER_BYTES,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &CORNER_ATTRIBUTES,
    };
    let target = wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL };
    PipelineParts { shader: SHADER, entry_points, corners, target, layout }.build(device)
}

/// The pipeline that copies the kept picture.
fn copy_pipeline(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    layout: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    let corners = wgpu::VertexBufferLayout {
        array_stride: size_of::<[f32; 4]>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &COPY_CORNER_ATTRIBUTES,
    };
    let target = wgpu::ColorTargetState { format, blend: None, write_mask: wgpu::ColorWrites::ALL };
    PipelineParts { shader: COPY_SHADER, entry_points: ["copy_corner", "copy"], corners, target, layout }.build(device)
}

/// The parts in which pipelines differ.
struct PipelineParts<'a> {
    shader: &'static str,
    /// Of the vertex program and of the fragment program.
    entry_points: [&'static str; 2],
    corners: wgpu::VertexBufferLayout<'static>,
    target: wgpu::ColorTargetState,
    layout: &'a wgpu::BindGroupLayout,
}

impl PipelineParts<'_> {
    /// Makes the pipeline.
    fn build(self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("software drawing"),
            source: wgpu::ShaderSource::Wgsl(self.shader.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("software drawing"),
            bind_group_layouts: &[Some(self.layout)],
            ..Default::default()
        });
        let [vertex, fragment] = self.entry_points;
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("software drawing"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                buffers: &[Some(self.corners)],
                compilation_options: wgpu::PipelineCompilationOptions::default(),
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                targets: &[Some(self.target)],
                compilation_options: wgpu::PipelineCompilationOptions::default(),
            }),
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            multiview_mask: None,
            cache: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use egui::{Color32, pos2};

    use super::*;

    #[test]
    fn upright_and_level_lines_of_whole_pixels_are_two_triangles_on_these_pixels() {
        let line = |a, b, width| Shape::line_segment([a, b], Stroke::new(width, Color32::RED));
        let drawn = |shape, scale| match with_lines_as_rectangles(shape, scale) {
            Shape::Mesh(mesh) => Some((mesh.indices.len() / 3, mesh.calc_bounds())),
            _ => None,
        };
        let rect = |x0, y0, x1, y1| Rect::from_min_max(pos2(x0, y0), pos2(x1, y1));
        let level = line(pos2(2.0, 5.3), pos2(9.0, 5.3), 1.0);
        assert_eq!(drawn(level.clone(), 1.0), Some((2, rect(2.0, 5.0, 9.0, 6.0))));
        let upright = line(pos2(5.0, 9.0), pos2(5.0, 2.0), 2.0);
        assert_eq!(drawn(upright, 1.0), Some((2, rect(4.0, 2.0, 6.0, 9.0))));
        // A pixel and a half, and a slope, have borders that fade.
        assert_eq!(drawn(level.clone(), 1.5), None);
        assert_eq!(drawn(line(pos2(0.0, 0.0), pos2(9.0, 1.0), 1.0), 1.0), None);
        assert!(
            matches!(with_lines_as_rectangles(Shape::Vec(vec![level]), 1.0), Shape::Vec(v) if matches!(v[0], Shape::Mesh(_)))
        );
    }
}
