//! A guide points at the control it speaks of: the control is found by its name while it is drawn,
//! scrolled into sight and framed.

use egui::{Align, Context, CornerRadius, Id, LayerId, Order, Rect, Response, Stroke, StrokeKind};

/// Distance of the frame from the control, points.
const GAP: f32 = 3.0;
/// Width of the frame, points.
const LINE: f32 = 2.5;

/// The control that is pointed at.
#[derive(Clone, Debug, Default)]
struct Sought {
    name: &'static str,
    /// Its part in sight this frame; None: it was not drawn.
    seen: Option<Rect>,
    /// It was scrolled to: the user may scroll away again.
    scrolled: bool,
}

fn id() -> Id {
    Id::unique("highlight")
}

/// Points at the control of a name from now on, or at none. It is called before the controls are
/// drawn.
pub fn seek(ctx: &Context, name: Option<&'static str>) {
    ctx.data_mut(|d| match name {
        None => drop(d.remove_temp::<Sought>(id())),
        Some(name) => {
            let before = d.get_temp::<Sought>(id()).filter(|s| s.name == name);
            d.insert_temp(id(), Sought { name, seen: None, scrolled: before.is_some_and(|s| s.scrolled) });
        }
    });
}

/// A control was drawn under a name.
pub fn offer(response: &Response, name: &str) {
    let ctx = &response.ctx;
    let Some(sought) = ctx.data(|d| d.get_temp::<Sought>(id())).filter(|s| s.name == name && s.seen.is_none()) else {
        return;
    };
    if !sought.scrolled {
        response.scroll_to_me(Some(Align::Center));
    }
    let seen = Some(response.interact_rect).filter(Rect::is_positive);
    ctx.data_mut(|d| d.insert_temp(id(), Sought { seen, scrolled: true, ..sought }));
}

/// Returns where the control that is pointed at is in sight, after all were drawn.
#[must_use]
pub fn seen(ctx: &Context) -> Option<Rect> {
    ctx.data(|d| d.get_temp::<Sought>(id()))?.seen
}

/// Frames it.
pub fn frame(ctx: &Context) {
    let Some(rect) = seen(ctx) else { return };
    let painter = ctx.layer_painter(LayerId::new(Order::Middle, id()));
    let stroke = Stroke::new(LINE, ctx.global_style().visuals.hyperlink_color);
    painter.rect_stroke(rect.expand(GAP), CornerRadius::same(5), stroke, StrokeKind::Outside);
}
