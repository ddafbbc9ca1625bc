//! Frames of egui are drawn as pictures without a window or a graphics adapter.

use egui::{Color32, Context, FullOutput, Pos2, RawInput, Rect, Ui, Vec2, ViewportId};
use image::RgbaImage;

use crate::render::svg;
use crate::render::triangle_rasteriser::{self, Frame, Textures};

/// Time between two frames, s.
const FRAME_S: f32 = 1.0 / 60.0;

/// A place to draw frames on.
pub struct Offscreen {
    ctx: Context,
    input: RawInput,
    textures: Textures,
    last: Option<FullOutput>,
    size: Vec2,
    pixels_per_point: f32,
}

impl Offscreen {
    /// One of a size in points; nothing on it is animated.
    #[must_use]
    pub fn new(size: [u32; 2], pixels_per_point: f32) -> Self {
        let ctx = Context::default();
        ctx.all_styles_mut(|style| {
            style.visuals.text_cursor.blink = false;
            style.scroll_animation = egui::style::ScrollAnimation::none();
            style.animation_time = 0.0;
        });
        let size = Vec2::new(size[0] as f32, size[1] as f32);
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            time: Some(0.0),
            predicted_dt: FRAME_S,
            ..RawInput::default()
        };
        if let Some(viewport) = input.viewports.get_mut(&ViewportId::ROOT) {
            viewport.native_pixels_per_point = Some(pixels_per_point);
        }
        Self { ctx, input, textures: Textures::default(), last: None, size, pixels_per_point }
    }

    /// The context of its frames.
    #[must_use]
    pub fn ctx(&self) -> &Context {
        &self.ctx
    }

    /// Runs a frame, 1/60 s after the one before.
    pub fn frame(&mut self, ui: impl FnMut(&mut Ui)) {
        let mut output = self.ctx.run_ui(self.input.clone(), ui);
        self.input.time = self.input.time.map(|t| t + f64::from(FRAME_S));
        if let Some(mut before) = self.last.take() {
            self.textures.free(&mut before.textures_delta);
        }
        self.textures.set(&mut output.textures_delta);
        self.last = Some(output);
    }

    /// The last frame as SVG, on a background of one colour.
    #[must_use]
    pub fn svg(&self, background: Color32) -> String {
        svg::write(self.last.as_ref().map_or(&[], |output| &output.shapes), self.size, background)
    }

    /// The last frame as a picture, on a background of one colour.
    #[must_use]
    pub fn picture(&self, background: Color32) -> RgbaImage {
        let size = [self.size.x, self.size.y].map(|s| (s * self.pixels_per_point).round() as u32);
        let shapes = self.last.as_ref().map_or_else(Vec::new, |output| output.shapes.clone());
        let primitives = self.ctx.tessellate(shapes, self.pixels_per_point);
        let frame = Frame { size, pixels_per_point: self.pixels_per_point, background };
        triangle_rasteriser::draw(&primitives, &self.textures, frame)
    }
}

impl Drop for Offscreen {
    fn drop(&mut self) {
        if let Some(last) = self.last.take() {
            last.drop_without_applying_deltas();
        }
    }
}
