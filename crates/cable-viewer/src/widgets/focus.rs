//! The keyboard focus is seen: what has it is framed, and scrolled into sight.

use egui::{Context, CornerRadius, Id, LayerId, Order, Rect, Stroke, StrokeKind, Ui};

/// Distance of the frame from what has the focus, points.
const GAP: f32 = 1.0;
/// Width of the frame, points. Narrower: it is taken for an outline.
const FRAME_LINE_WIDTH: f32 = 1.5;

/// Frames what has the focus, but for a field that is typed into, which shows it by itself.
pub fn frame(ctx: &Context) {
    let focused = ctx.memory(|m| m.focused()).filter(|_| !ctx.text_edit_focused());
    let Some(response) = focused.and_then(|id| ctx.read_response(id)) else { return };
    let in_sight = response.interact_rect;
    if !in_sight.is_positive() {
        return;
    }
    // Above its own layer, but not above one that has opened over it.
    let layer = LayerId::new(response.layer_id.order, Id::unique(("focus", response.layer_id)));
    let layer =
        if response.layer_id.order == Order::Background { LayerId::new(Order::Middle, layer.id) } else { layer };
    let painter = ctx.layer_painter(layer);
    let stroke = Stroke::new(FRAME_LINE_WIDTH, ctx.global_style().visuals.strong_text_color());
    painter.rect_stroke(in_sight.expand(GAP), CornerRadius::same(4), stroke, StrokeKind::Middle);
}

/// Scrolls to what has just got the focus by a key, if that lies in this part of the window.
pub fn scroll_to_focused(ui: &Ui, contents: Rect) {
    let (id, focused) = (ui.scope_id().with("focus"), ui.memory(|m| m.focused()));
    let before = ui.data(|d| d.get_temp::<Option<Id>>(id)).flatten();
    ui.data_mut(|d| d.insert_temp(id, focused));
    if focused == before {
        return;
    }
    if let Some(response) = focused.and_then(|id| ui.ctx().read_response(id))
        && response.layer_id == ui.layer_id()
        && contents.contains(response.rect.center())
        && !ui.clip_rect().contains_rect(response.rect)
    {
        ui.scroll_to_rect(response.rect, None);
        ui.ctx().request_repaint();
    }
}
