//! Up to two cursors in a graph: the first click sets one, the second another, the third takes both
//! away.

use egui::{Id, Ui};

use crate::plot::axes::AxisUnit;
use crate::record::series::{Series, value_at};
use crate::units::format::quantity;
use crate::units::unit::DIGITS;

/// Places of the cursors of a graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cursors(pub Vec<f64>);

impl Cursors {
    /// Those of a graph.
    #[must_use]
    pub fn load(ui: &Ui, title: &str) -> Self {
        Self(ui.data(|d| d.get_temp(id(title))).unwrap_or_default())
    }

    /// Takes in a click at `x`.
    pub fn click(&mut self, ui: &Ui, title: &str, x: f64) {
        if self.0.len() == 2 {
            self.0.clear();
        } else {
            self.0.push(x);
        }
        self.keep(ui, title);
    }

    /// Takes away those beyond all data: of another scene, or of a run before a reset.
    pub fn forget_without_data(&mut self, ui: &Ui, title: &str, last: f64) {
        let before = self.0.len();
        self.0.retain(|x| *x <= last);
        if self.0.len() != before {
            self.keep(ui, title);
        }
    }

    /// Moves the last one to `x`, or sets the first there.
    pub fn put_last(&mut self, ui: &Ui, title: &str, x: f64) {
        match self.0.last_mut() {
            Some(last) => *last = x,
            None => self.0.push(x),
        }
        self.keep(ui, title);
    }

    fn keep(&self, ui: &Ui, title: &str) {
        let places = self.0.clone();
        ui.data_mut(|d| d.insert_temp(id(title), places));
    }

    /// Returns what they read: values of the first line at each, and the difference, in the
    /// units of the two axes.
    #[must_use]
    pub fn text(&self, across: AxisUnit, up: AxisUnit, line: Option<&Series>) -> Option<String> {
        let line = line?;
        let read = |x: f64| value_at(&line.points, x).map_or(f64::NAN, |v| v / up.si);
        let one = |name: &str, x: f64, y: f64| {
            format!("{name} {}: {}", quantity(x / across.si, DIGITS, across.symbol), quantity(y, DIGITS, up.symbol))
        };
        match *self.0.as_slice() {
            [a] => Some(one("A", a, read(a))),
            [a, b] => {
                let lines = [one("A", a, read(a)), one("B", b, read(b)), one("B − A", b - a, read(b) - read(a))];
                Some(lines.join("\n"))
            }
            _ => None,
        }
    }
}

fn id(title: &str) -> Id {
    Id::unique(("cursors", title))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_cursors_tell_their_difference() {
        let points = vec![[0.0, 100.0], [2.0, 300.0]];
        let line = Series { name: "T".to_owned(), points, ..Series::default() };
        let [time, force] = ["s", "N"].map(|symbol| AxisUnit { symbol, si: 1.0 });
        let text = Cursors(vec![0.5, 1.5]).text(time, force, Some(&line)).unwrap();
        assert!(text.contains("A 0.5000 s: 150.0 N") && text.contains("B − A 1.000 s: 100.0 N"), "{text}");
        let beyond = Cursors(vec![3.0]).text(time, force, Some(&line)).unwrap();
        assert!(beyond.ends_with(": no data"), "{beyond}");
        assert_eq!(Cursors::default().text(time, force, Some(&line)), None);
    }
}
