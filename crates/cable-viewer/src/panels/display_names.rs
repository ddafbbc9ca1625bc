//! The panels have words for what a scene file calls by short names.

use cable_core::scene::{Change, FieldValue};

use crate::panels::cable::property::PROPERTIES;
use crate::units::format;
use crate::units::unit::Unit;

/// Endings of keys that name a unit. Longer ones first: `_kg_per_m` ends with `_m`.
const UNITS: [(&str, Unit); 14] = [
    ("_m_per_s2", Unit::M_PER_S2),
    ("_m_per_s", Unit::M_PER_S),
    ("_kg_per_m", Unit::KG_PER_M),
    ("_n_per_m", Unit::N_PER_M),
    ("_n_m2", Unit::N_M2),
    ("_per_k", Unit::PPM_PER_K),
    ("_deg", Unit::DEGREE),
    ("_kg", Unit::KG),
    ("_kn", Unit::KN),
    ("_mm", Unit::MM),
    ("_m", Unit::M),
    ("_n", Unit::N),
    ("_s", Unit::S),
    ("_k", Unit::K),
];

fn unit(key: &str) -> Option<(&str, Unit)> {
    UNITS.iter().find_map(|(ending, unit)| Some((key.strip_suffix(ending)?, *unit)))
}

/// A key of a scene file in words: `to_x_m` is a drive of the path, `service_tension_n` the service
/// tension.
fn property(key: &str) -> String {
    match key {
        "to_x_m" => return "Path: drive to".to_owned(),
        "speed_m_per_s" => return "Path: speed".to_owned(),
        "wait_s" => return "Path: wait".to_owned(),
        "at_m" => return "Position".to_owned(),
        "release_s" => return "Release time".to_owned(),
        _ => {}
    }
    if let Some(known) = PROPERTIES.iter().find(|p| p.key == key) {
        return known.quantity.name.to_owned();
    }
    let plain = unit(key).map_or(key, |(name, _)| name).replace('_', " ");
    capital(&plain)
}

/// The value of a key with its unit and four digits.
fn value(key: &str, value: &FieldValue) -> String {
    let of = PROPERTIES.iter().find(|p| p.key == key).map(|p| p.quantity.unit);
    let unit = of.or_else(|| Some(unit(key)?.1)).unwrap_or(Unit::PLAIN_NUMBER);
    match value {
        FieldValue::Number(number) => unit.text(*number),
        FieldValue::Pair(at) if unit.symbol == Unit::M.symbol => format::position(*at),
        FieldValue::Pair([x, y]) => {
            format::with_symbol(format!("({}, {})", unit.bare().text(*x), unit.bare().text(*y)), unit.display().symbol)
        }
        FieldValue::Text(text) => short(text),
        FieldValue::List(count) => format!("list of {count}"),
    }
}

/// The differences in the input of two answers, in words.
#[must_use]
pub fn change(change: &Change) -> String {
    let key = change.key.as_str();
    let name = property(key);
    match (&change.was, &change.is) {
        (Some(FieldValue::List(was)), Some(FieldValue::List(is))) if was == is => format!("{name} changed"),
        (Some(was), Some(is)) => format!("{name}: {}, now {}", value(key, was), value(key, is)),
        (None, Some(is)) if of_cable(key) => format!("{name} set to {}", value(key, is)),
        (Some(_), None) if of_cable(key) => format!("{name} back to its default"),
        (None, Some(is)) => format!("{name} {} added", value(key, is)),
        (Some(was), None) => format!("{name} {} removed", value(key, was)),
        (None, None) => name,
    }
}

/// The value of a change after it, in words: `length 15.20 m`.
#[must_use]
pub fn present_value(change: &Change) -> String {
    let key = change.key.as_str();
    let name = property(key);
    // Not of an abbreviation.
    let all_capital = name.chars().nth(1).is_some_and(char::is_uppercase);
    let mut letters = name.chars();
    let first = letters.next().filter(|_| !all_capital);
    let name = first.map_or(name.clone(), |c| c.to_lowercase().chain(letters).collect());
    match (&change.was, &change.is) {
        (_, Some(FieldValue::List(_))) => format!("other {name}"),
        (_, Some(is)) => format!("{name} {}", value(key, is)),
        (Some(_), None) if of_cable(key) => format!("usual {name}"),
        (Some(was), None) => format!("without {name} {}", value(key, was)),
        (None, None) => name,
    }
}

fn of_cable(key: &str) -> bool {
    PROPERTIES.iter().any(|p| p.key == key)
}

/// A path into a scene, such as `cables[0].supports[1].at_m`, in words.
#[must_use]
pub fn place(path: &str) -> String {
    let parts = path.split('.').map(|part| {
        let (name, number) = part.strip_suffix(']').and_then(|p| p.split_once('[')).unwrap_or((part, ""));
        let known = match name {
            "cables" => "cable",
            "supports" => "support",
            "obstacles" => "obstacle",
            "loads" => "load",
            "points_m" => "point",
            "route_m" => "route point",
            "path" => "leg",
            _ => {
                return if number.is_empty() { property(name).to_lowercase() } else { one_of(&property(name), number) };
            }
        };
        if number.is_empty() { format!("{known}s") } else { one_of(known, number) }
    });
    let text = parts.collect::<Vec<_>>().join(", ");
    capital(&text)
}

/// The text with a capital, as a sentence begins.
#[must_use]
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |c| c.to_uppercase().chain(letters).collect())
}

/// People count from one.
fn one_of(name: &str, index: &str) -> String {
    index.parse::<usize>().map_or_else(|_| name.to_lowercase(), |k| format!("{} {}", name.to_lowercase(), k + 1))
}

fn short(text: &str) -> String {
    if text.chars().count() > 40 { text.chars().take(40).collect::<String>() + "…" } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_values_are_read_as_an_engineer_says_them() {
        let text = |t: &str| Some(FieldValue::Text(t.to_owned()));
        let number = |n: &str| n.parse().ok().map(FieldValue::Number);
        let pair = Some(FieldValue::Pair([3.2, 0.85]));
        for (key, was, is, said) in [
            ("to_x_m", None, number("15.868020304568528"), "Path: drive to 15.87 m added"),
            ("service_tension_n", None, number("800"), "Service tension set to 800.0 N"),
            ("service_tension_n", number("800"), None, "Service tension back to its default"),
            ("length_m", number("14.2"), number("15.2"), "Length: 14.20 m, now 15.20 m"),
            ("at_m", pair.clone(), None, "Position (3.200, 0.850) m removed"),
            ("kind", text("fixed"), text("pulley"), "Kind: fixed, now pulley"),
            ("name", text("a = [1"), text("b"), "Name: a = [1, now b"),
            ("points_m", Some(FieldValue::List(3)), Some(FieldValue::List(3)), "Points changed"),
            ("points_m", Some(FieldValue::List(3)), Some(FieldValue::List(4)), "Points: list of 3, now list of 4"),
        ] {
            assert_eq!(change(&Change { key: key.to_owned(), was, is }), said);
        }
        for (key, was, is, said) in [
            ("length_m", number("14.2"), number("15.2"), "length 15.20 m"),
            ("service_tension_n", number("800"), None, "usual service tension"),
            ("to_x_m", number("3"), None, "without path: drive to 3.000 m"),
            ("kind", text("fixed"), text("pulley"), "kind pulley"),
            ("points_m", Some(FieldValue::List(3)), Some(FieldValue::List(4)), "other points"),
        ] {
            assert_eq!(present_value(&Change { key: key.to_owned(), was, is }), said);
        }
    }

    #[test]
    fn paths_are_read_as_an_engineer_says_them() {
        assert_eq!(place("cables[0].supports[1].at_m"), "Cable 1, support 2, position");
        assert_eq!(place("environment.wind_n_per_m"), "Environment, wind");
    }
}
