//! Number and text fields keep the typed text until it can be read: a slip is shown, never lost.

use egui::text::{CCursor, CCursorRange};
use egui::{Align2, Id, Key, Margin, Response, TextEdit, Ui};

use crate::units::unit::Unit;
use crate::widgets::highlight;
use crate::widgets::icon::{self, Icon};

/// The text of a field while it differs from the value behind it.
#[derive(Clone, Debug, Default)]
struct FieldDraft {
    text: String,
    /// The value when typing began: if it changed since, the draft is about something else.
    value: String,
    /// The fault of the text, once it was entered.
    fault: Option<String>,
}

/// The outcome of a field in this frame.
#[derive(Debug)]
pub struct FieldOutput<T> {
    /// A new value, entered just now.
    pub value: Option<T>,
    /// The reason why the text in the field cannot be read.
    pub fault: Option<String>,
    /// The field itself.
    pub response: Response,
}

/// Gives a widget without text of its own the name that screen readers and tests find it by.
pub fn name(response: &Response, label: &str) {
    highlight::register(response, label);
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(label));
}

/// A field for a number in a unit; `value` is SI. Enter or leaving the field enters the text,
/// Escape drops it.
pub fn number(ui: &mut Ui, label: &str, unit: Unit, value: f64, width: f32) -> FieldOutput<f64> {
    let shown = [unit.text(value), unit.exact(value)];
    let format = FieldFormat { width, align: Align2::RIGHT_CENTER, unit: unit.display().symbol };
    let entry = text_field(ui, label, &shown, format, |text| unit.parse(text));
    // Text shown with fewer digits than the value has must not round it when it is entered
    // unchanged.
    let value = entry.value.filter(|&v| unit.exact(v) != shown[1]);
    FieldOutput { value, ..entry }
}

/// A field for a name.
pub fn text(ui: &mut Ui, label: &str, value: &str, width: f32) -> FieldOutput<String> {
    let shown = [value.to_owned(), value.to_owned()];
    let read = |text: &str| match text.trim() {
        "" => Err("a name must not be empty".to_owned()),
        name => Ok(name.to_owned()),
    };
    let entry = text_field(ui, label, &shown, FieldFormat { width, align: Align2::LEFT_CENTER, unit: "" }, read);
    FieldOutput { value: entry.value.filter(|v| v != value), ..entry }
}

/// The size and form of a field.
#[derive(Clone, Copy, Debug)]
struct FieldFormat {
    /// Points.
    width: f32,
    align: Align2,
    /// The unit that a number without one is taken to be in; empty for text.
    unit: &'static str,
}

/// `shown`: the value at rest, and to be edited.
fn text_field<T>(
    ui: &mut Ui,
    label: &str,
    shown: &[String; 2],
    format: FieldFormat,
    read: impl FnOnce(&str) -> Result<T, String>,
) -> FieldOutput<T> {
    let id = ui.scope_id().with(("field", label));
    let [at_rest, exact] = shown;
    let mut draft: Option<FieldDraft> = ui.data(|d| d.get_temp(id)).filter(|d: &FieldDraft| d.value == *exact);
    let began = draft.is_none() && ui.memory(|m| m.has_focus(id));
    if began {
        draft = Some(FieldDraft { text: exact.clone(), value: exact.clone(), fault: None });
        select_all(ui, id, exact);
    }
    let mut text = draft.as_ref().map_or_else(|| at_rest.clone(), |d| d.text.clone());
    // “60” typed over “10.00 kN” would not say any more whether it is kilonewtons.
    let is_bare = draft.is_some() && text.trim_end().ends_with(|c: char| c.is_ascii_digit() || c == '.');
    let mut edit = TextEdit::singleline(&mut text).id(id).desired_width(format.width).align(format.align);
    edit = edit.margin(Margin::symmetric(4, 2));
    if is_bare && !format.unit.is_empty() {
        edit = edit.suffix(egui::RichText::new(format.unit).weak());
    }
    if draft.as_ref().is_some_and(|d| d.fault.is_some()) {
        edit = edit.text_color(ui.visuals().error_fg_color);
    }
    let response = ui.add(edit);
    name(&response, label);
    if response.has_focus() {
        let pass = ui.ctx().cumulative_pass_nr();
        ui.data_mut(|d| d.insert_temp(typing_id(), pass));
    }
    let mut entered = None;
    if response.lost_focus() {
        let dropped = ui.input(|i| i.key_pressed(Key::Escape));
        draft = match read(&text) {
            _ if dropped || text == *exact || text == *at_rest => None,
            Ok(value) => {
                entered = Some(value);
                None
            }
            Err(fault) => Some(FieldDraft { text, value: exact.clone(), fault: Some(fault) }),
        };
    } else if response.changed() {
        draft = Some(FieldDraft { text, value: exact.clone(), fault: None });
    }
    let fault = draft.as_ref().and_then(|d| d.fault.clone());
    ui.data_mut(|d| match draft {
        Some(draft) => {
            d.insert_temp(id, draft);
        }
        None => {
            d.remove_temp::<FieldDraft>(id);
        }
    });
    FieldOutput { value: entered, fault, response }
}

fn typing_id() -> Id {
    Id::unique("pass in which a field was typed in")
}

/// Returns whether a field was being typed in until this frame: egui takes its focus away before
/// the keys of the frame are read, and Escape is the field's.
pub fn was_typed_in(ctx: &egui::Context) -> bool {
    let pass: Option<u64> = ctx.data(|d| d.get_temp(typing_id()));
    pass.is_some_and(|pass| pass + 1 >= ctx.cumulative_pass_nr())
}

/// Forgets what was typed into a field of this `ui`.
pub fn forget(ui: &Ui, label: &str) {
    ui.data_mut(|d| d.remove_temp::<FieldDraft>(ui.scope_id().with(("field", label))));
}

fn select_all(ui: &Ui, id: Id, text: &str) {
    let mut state = TextEdit::load_state(ui.ctx(), id).unwrap_or_default();
    let end = CCursor::new(text.chars().count());
    state.cursor.set_char_range(Some(CCursorRange::two(CCursor::new(0), end)));
    state.store(ui.ctx(), id);
}

/// A line in the error colour that says what is wrong.
pub fn fault(ui: &mut Ui, text: &str) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let colour = ui.visuals().error_fg_color;
        icon::sign(ui, Icon::Caution, colour);
        ui.vertical(|ui| ui.colored_label(colour, text));
    });
}
