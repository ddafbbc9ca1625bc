//! Two scenes are compared as the trees that their files hold.

use toml::{Table, Value};

use crate::scene::Scene;

/// A key that has different values in two scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The key, without the path to it: `length_m`.
    pub key: String,
    /// Its value in the first scene; None: it is not there.
    pub was: Option<FieldValue>,
    /// Its value in the second scene; None: it is not there.
    pub is: Option<FieldValue>,
}

/// The value of a key of a scene file.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldValue {
    /// A number, in the unit that the key names.
    Number(f64),
    /// A point or a vector, in the unit that the key names.
    Pair([f64; 2]),
    /// A word, or yes and no.
    Text(String),
    /// So many numbers, points or the like.
    List(usize),
}

impl Scene {
    /// Returns the keys in which another scene differs from this one, as their files hold them, in
    /// the order of the first. If only one of them has an item, each key of the item counts.
    #[must_use]
    pub fn changes_to(&self, other: &Self) -> Vec<Change> {
        let mut out = Vec::new();
        of_tables(&self.written(), &other.written(), &mut out);
        out
    }
}

/// Appends the changes from one table to another.
fn of_tables(was: &Table, is: &Table, out: &mut Vec<Change>) {
    let gained = is.keys().filter(|key| !was.contains_key(*key));
    for key in was.keys().chain(gained) {
        match (was.get(key), is.get(key)) {
            (Some(Value::Table(was)), Some(Value::Table(is))) => of_tables(was, is, out),
            (Some(Value::Array(was)), Some(Value::Array(is))) if holds_tables(was) || holds_tables(is) => {
                of_things(was, is, out);
            }
            (was, is) if was != is => of_value(key, was, is, out),
            _ => {}
        }
    }
}

/// Items that both lists begin with or end with are equal. The rest is compared one by one if there
/// are equally many of them; otherwise each list has items that the other does not have.
fn of_things(was: &[Value], is: &[Value], out: &mut Vec<Change>) {
    let alike = |pairs: &mut dyn Iterator<Item = (&Value, &Value)>| pairs.take_while(|(a, b)| a == b).count();
    let first = alike(&mut was.iter().zip(is));
    let (was, is) = (was.get(first..).unwrap_or_default(), is.get(first..).unwrap_or_default());
    let last = alike(&mut was.iter().rev().zip(is.iter().rev()));
    let [was, is] = [was, is].map(|side| side.get(..side.len() - last).unwrap_or_default());
    if was.len() == is.len() {
        for pair in was.iter().zip(is) {
            if let (Value::Table(was), Value::Table(is)) = pair {
                of_tables(was, is, out);
            }
        }
        return;
    }
    let nothing = Table::new();
    was.iter().filter_map(Value::as_table).for_each(|thing| of_tables(thing, &nothing, out));
    is.iter().filter_map(Value::as_table).for_each(|thing| of_tables(&nothing, thing, out));
}

/// A value that exists in only one of the scenes, or differs; each key of an item counts.
fn of_value(key: &str, was: Option<&Value>, is: Option<&Value>, out: &mut Vec<Change>) {
    let nothing = Table::new();
    let table = |side: Option<&Value>| side.and_then(Value::as_table).cloned();
    let things = |side: Option<&Value>| side.and_then(Value::as_array).filter(|a| holds_tables(a)).cloned();
    match ((table(was), table(is)), (things(was), things(is))) {
        ((None, None), (None, None)) => {
            out.push(Change { key: key.to_owned(), was: was.map(field), is: is.map(field) });
        }
        ((None, None), (was, is)) => of_things(&was.unwrap_or_default(), &is.unwrap_or_default(), out),
        ((was, is), _) => of_tables(was.as_ref().unwrap_or(&nothing), is.as_ref().unwrap_or(&nothing), out),
    }
}

fn holds_tables(list: &[Value]) -> bool {
    list.iter().any(Value::is_table)
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

/// The value of a field as a change shows it.
fn field(value: &Value) -> FieldValue {
    match value {
        Value::String(text) => FieldValue::Text(text.clone()),
        Value::Array(list) => match list.as_slice() {
            [x, y] if number(x).is_some() && number(y).is_some() => {
                FieldValue::Pair([x, y].map(|v| number(v).unwrap_or(f64::NAN)))
            }
            list => FieldValue::List(list.len()),
        },
        other => number(other).map_or_else(|| FieldValue::Text(other.to_string()), FieldValue::Number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Motion, Support, catalog};

    fn changes(edit: impl FnOnce(&mut Scene)) -> Vec<(String, Option<FieldValue>, Option<FieldValue>)> {
        let before = catalog::tank();
        let mut after = before.clone();
        edit(&mut after);
        before.changes_to(&after).into_iter().map(|c| (c.key, c.was, c.is)).collect()
    }

    #[test]
    fn the_same_scene_has_no_changes() {
        assert_eq!(changes(|_| ()), []);
    }

    #[test]
    fn a_value_is_told_with_what_it_was() {
        let changes_found = changes(|s| s.cables[0].length_m += 1.0);
        let was = catalog::tank().cables[0].length_m;
        let [was, is] = [was, was + 1.0].map(|v| Some(FieldValue::Number(v)));
        assert_eq!(changes_found, [("length_m".to_owned(), was, is)]);
    }

    /// A name with a bracket or an equals sign in it was taken apart as if it were a line of a
    /// file.
    #[test]
    fn a_text_is_told_as_it_is() {
        let name = "a = [1, 2]";
        let changes_found = changes(|s| name.clone_into(&mut s.cables[0].name));
        assert_eq!(changes_found.len(), 1);
        assert_eq!(changes_found[0].2, Some(FieldValue::Text(name.to_owned())));
    }

    /// Two supports changed places with one another while something was added, and nothing was
    /// said: each line was in both files.
    #[test]
    fn places_that_are_exchanged_are_changes() {
        let changes_found = changes(|s| {
            let [a, b] = [0, 1].map(|k| s.cables[0].supports[k].at_m);
            (s.cables[0].supports[0].at_m, s.cables[0].supports[1].at_m) = (b, a);
            s.cables[0].supports[0].release_s = Some(1.0);
        });
        assert_eq!(changes_found.iter().filter(|(key, ..)| key == "at_m").count(), 2, "{changes_found:?}");
    }

    #[test]
    fn a_thing_that_was_added_is_told_key_by_key_and_no_other() {
        let changes_found = changes(|s| s.cables[0].supports.insert(1, Support::fixed("grip", [0.0, 3.0])));
        assert!(changes_found.iter().all(|(_, was, _)| was.is_none()), "{changes_found:?}");
        let of = |key: &str| changes_found.iter().find(|t| t.0 == key).and_then(|t| t.2.clone());
        assert_eq!(of("name"), Some(FieldValue::Text("grip".to_owned())));
        assert_eq!(of("at_m"), Some(FieldValue::Pair([0.0, 3.0])));
        let gone = changes(|s| drop(s.obstacles.remove(1)));
        assert!(!gone.is_empty() && gone.iter().all(|(.., is)| is.is_none()), "{gone:?}");
    }

    #[test]
    fn a_schedule_is_told_as_so_many_numbers() {
        let motion = Motion { times_s: vec![0.0, 1.0, 2.0], points_m: vec![[0.0, 1.0]; 3] };
        let changes_found = changes(|s| s.cables[0].supports[0].motion = Some(motion));
        assert_eq!(changes_found.iter().filter(|t| t.2 == Some(FieldValue::List(3))).count(), 2, "{changes_found:?}");
    }
}
