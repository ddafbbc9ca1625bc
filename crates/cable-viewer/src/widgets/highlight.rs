//! A guide points at the control it speaks of: the control is found by its name while it is drawn,
//! scrolled into sight and framed.

use egui::{Align, Context, CornerRadius, Id, LayerId, Order, Rect, Response, Stroke, StrokeKind};

/// Distance of the frame from the control, points.
const GAP: f32 = 3.0;
/// Width of the frame, points.
const FRAME_LINE_WIDTH: f32 = 2.5;

/// The control that is pointed at.
#[derive(Clone, Debug, Default)]
struct HighlightTarget {
    name: &'static str,
    /// Its part in sight this frame; None: it was not drawn.
    visible_rect: Option<Rect>,
    /// It was scrolled to: the user may scroll away again.
    scrolled: bool,
}

fn id() -> Id {
    Id::unique("highlight")
}

/// Points at the control of a name from now on, or at none. It is called before the controls are
/// drawn.
pub fn set_target(ctx: &Context, name: Option<&'static str>) {
    ctx.data_mut(|d| match name {
        None => drop(d.remove_temp::<HighlightTarget>(id())),
        Some(name) => {
            let before = d.get_temp::<HighlightTarget>(id()).filter(|s| s.name == name);
            d.insert_temp(
                id(),
                HighlightTarget { name, visible_rect: None, scrolled: before.is_some_and(|s| s.scrolled) },
            );
        }
    });
}

/// A control was drawn under a name.
pub fn register(response: &Response, name: &str) {
    let ctx = &response.ctx;
    let Some(target) =
        ctx.data(|d| d.get_temp::<HighlightTarget>(id())).filter(|s| s.name == name && s.visible_rect.is_none())
    else {
        return;
    };
    if !target.scrolled {
        response.scroll_to_me(Some(Align::Center));
    }
    let visible_rect = Some(response.interact_rect).filter(Rect::is_positive);
    ctx.data_mut(|d| d.insert_temp(id(), HighlightTarget { visible_rect, scrolled: true, ..target }));
}

/// Returns where the control that is pointed at is in sight, after all were drawn.
#[must_use]
pub fn visible_rect(ctx: &Context) -> Option<Rect> {
    ctx.data(|d| d.get_temp::<HighlightTarget>(id()))?.visible_rect
}

/// Frames it.
pub fn frame(ctx: &Context) {
    let Some(rect) = visible_rect(ctx) else { return };
    let painter = ctx.layer_painter(LayerId::new(Order::Middle, id()));
    let stroke = Stroke::new(FRAME_LINE_WIDTH, ctx.global_style().visuals.hyperlink_color);
    painter.rect_stroke(rect.expand(GAP), CornerRadius::same(5), stroke, StrokeKind::Outside);
}
