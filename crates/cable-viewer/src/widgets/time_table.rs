//! A small table edits a vector that changes with time: a row for each time, linear (or smooth) in
//! between.

use cable_core::math::Point;
use egui::{Button, ScrollArea, Ui};

use crate::units::unit::Unit;
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::field;
use crate::widgets::icon::{self, Icon};

/// Height of a table, points: about six rows.
const HEIGHT: f32 = 140.0;
/// Least and greatest width of a number, points.
const WIDTHS: [f32; 2] = [32.0, 46.0];
/// Room for the buttons at the end of a row, points.
const BUTTONS: f32 = 44.0;
/// Width of a field beyond its text, points.
const FIELD_MARGIN: f32 = 8.0;
/// Between columns, points.
const GAP: f32 = 3.0;

/// Times and a value at each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Knots {
    /// s, increasing.
    pub times_s: Vec<f64>,
    /// SI.
    pub values: Vec<Point>,
}

/// The quantity of a table.
pub struct Table<'a> {
    /// Names its fields: `Time 1 of wind`, `right 1 of wind`.
    pub of: &'a str,
    /// The two columns.
    pub columns: [&'a str; 2],
    /// Of both.
    pub unit: Unit,
    /// Fewest rows.
    pub least: usize,
}

impl Knots {
    /// Those of a scene; what has no partner in the other list is left out.
    #[must_use]
    pub fn of(times_s: &[f64], values: &[Point]) -> Self {
        let n = times_s.len().min(values.len());
        Self { times_s: times_s[..n].to_vec(), values: values[..n].to_vec() }
    }

    /// The same value at a start and an end, to begin from.
    #[must_use]
    pub fn steady(value: Point, until_s: f64) -> Self {
        Self { times_s: vec![0.0, until_s], values: vec![value; 2] }
    }

    /// A row halfway to the next; after the last, as long again with its value.
    fn insert_after(&mut self, k: usize) {
        let (Some(&t), Some(&v)) = (self.times_s.get(k), self.values.get(k)) else { return };
        let (time_s, value) = match (self.times_s.get(k + 1), self.values.get(k + 1)) {
            (Some(&next), Some(&w)) => (0.5 * (t + next), [0.5 * (v[0] + w[0]), 0.5 * (v[1] + w[1])]),
            _ => (t + k.checked_sub(1).and_then(|j| self.times_s.get(j)).map_or(1.0, |before| t - before), v),
        };
        self.times_s.insert(k + 1, time_s);
        self.values.insert(k + 1, value);
    }
}

/// Draws it; the changed knots once something was entered. Only rows in view are drawn.
pub fn ui(ui: &mut Ui, table: &Table<'_>, knots: &Knots, faults: &mut Vec<String>) -> Option<Knots> {
    let mut changed = knots.clone();
    let (mut gone, mut doubled) = (None, None);
    let symbol = table.unit.display().symbol;
    let room = (ui.available_width() - BUTTONS - 4.0 * GAP) / 3.0 - FIELD_MARGIN;
    let width = room.clamp(WIDTHS[0], WIDTHS[1]);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let heads = [
            "Time, s".to_owned(),
            format!("{}, {symbol}", table.columns[0]),
            format!("{}, {symbol}", table.columns[1]),
        ];
        for head in heads {
            ui.add_sized(
                [width + FIELD_MARGIN, ui.spacing().interact_size.y],
                egui::Label::new(egui::RichText::new(head).weak()).truncate(),
            );
        }
    });
    let height = ui.spacing().interact_size.y;
    let area = ScrollArea::vertical().id_salt(("times", table.of)).max_height(HEIGHT).auto_shrink([false, true]);
    area.show_rows(ui, height, knots.times_s.len(), |ui, rows| {
        for k in rows {
            let clicked = ui.push_id(k, |ui| ui.horizontal(|ui| row(ui, table, k, width, &mut changed, faults)).inner);
            doubled = if clicked.inner.add { Some(k) } else { doubled };
            gone = if clicked.inner.remove { Some(k) } else { gone };
        }
    });
    if let Some(k) = gone.filter(|_| changed.times_s.len() > table.least) {
        changed.times_s.remove(k);
        changed.values.remove(k);
    }
    if let Some(k) = doubled {
        changed.insert_after(k);
    }
    (changed != *knots).then_some(changed)
}

/// The buttons of a row that were clicked.
struct RowButtons {
    /// Another row is asked for after it.
    add: bool,
    /// It is to go.
    remove: bool,
}

/// Row `k` of the table, with its buttons.
fn row(
    ui: &mut Ui,
    table: &Table<'_>,
    k: usize,
    width: f32,
    changed: &mut Knots,
    faults: &mut Vec<String>,
) -> RowButtons {
    ui.spacing_mut().item_spacing.x = GAP;
    let of = |what: &str| format!("{what} {} of {}", k + 1, table.of);
    if let Some(time_s) = changed.times_s.get_mut(k) {
        let entry = field::number(ui, &of("Time"), Unit::S.bare(), *time_s, width);
        *time_s = entry.value.unwrap_or(*time_s);
        faults.extend(entry.fault);
        entry.response.on_hover_text("Times increase from row to row");
    }
    if let Some(value) = changed.values.get_mut(k) {
        for (part, column) in value.iter_mut().zip(table.columns) {
            let entry = field::number(ui, &of(column), table.unit.bare(), *part, width);
            *part = entry.value.unwrap_or(*part);
            faults.extend(entry.fault);
            entry.response.on_hover_text("Before the first and after the last time it stays as it is there");
        }
    }
    let add = ui.add(Button::new("+").frame(false));
    field::name(&add, &of("Add a time after"));
    let add = add.on_hover_text("Adds a time halfway to the next").clicked();
    let remove = icon::plain_button(ui, Icon::Remove);
    field::name(&remove, &of("Remove time"));
    RowButtons { add, remove: remove.on_hover_text("Removes this row").clicked() }
}

/// A box that says whether something changes with time; what it is to be once it was clicked.
pub fn toggle(ui: &mut Ui, label: &str, on: bool, help: &str) -> Option<bool> {
    let mut wanted = on;
    ui.scope(|ui| {
        // A narrow panel cuts the label, and the hover text has it whole.
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
        checkbox(ui, &mut wanted, label).on_hover_text(format!("{label}. {help}")).changed().then_some(wanted)
    })
    .inner
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_row_lies_between_its_neighbours_or_beyond_the_last() {
        let mut knots = Knots { times_s: vec![0.0, 4.0], values: vec![[0.0, 10.0], [2.0, 20.0]] };
        knots.insert_after(0);
        assert_eq!((knots.times_s[1], knots.values[1]), (2.0, [1.0, 15.0]));
        knots.insert_after(2);
        assert_eq!((knots.times_s[3], knots.values[3]), (6.0, [2.0, 20.0]));
        knots.insert_after(9);
        assert_eq!(knots.times_s, [0.0, 2.0, 4.0, 6.0]);
        assert_eq!(Knots::of(&[0.0, 1.0, 2.0], &[[1.0; 2]]).times_s, [0.0]);
    }
}
