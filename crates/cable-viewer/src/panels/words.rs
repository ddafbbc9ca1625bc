//! The panels have words for what a scene file calls by short names.

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
#[must_use]
pub fn property(key: &str) -> String {
    let key = key.trim();
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
    let mut letters = plain.chars();
    letters.next().map_or_else(String::new, |c| c.to_uppercase().chain(letters).collect())
}

/// The value of a key, as a scene file writes it, with its unit and four digits.
#[must_use]
pub fn value(key: &str, text: &str) -> String {
    let text = text.trim();
    let of = PROPERTIES.iter().find(|p| p.key == key.trim()).map(|p| p.quantity.unit);
    let unit = of.or_else(|| Some(unit(key.trim())?.1)).unwrap_or(Unit::NONE);
    if let Ok(number) = text.parse::<f64>() {
        return unit.text(number);
    }
    let pair = text.strip_prefix('[').and_then(|t| t.strip_suffix(']')).and_then(|t| t.split_once(", "));
    if let Some((Ok(x), Ok(y))) = pair.map(|(x, y)| (x.parse::<f64>(), y.parse::<f64>())) {
        if unit.symbol == Unit::M.symbol {
            return format::position([x, y]);
        }
        return format::with_symbol(
            format!("({}, {})", unit.bare().text(x), unit.bare().text(y)),
            unit.display().symbol,
        );
    }
    short(text.trim_matches('"'))
}

/// A line of a scene file in words.
#[must_use]
pub fn line(text: &str) -> String {
    match text.split_once(" = ") {
        Some((key, written)) => format!("{} {}", property(key), value(key, written)),
        None => short(text.trim().trim_matches(['[', ']'])),
    }
}

/// A line that one scene file has and another has not, in words.
#[must_use]
pub fn added(text: &str) -> String {
    match text.split_once(" = ") {
        Some((key, written)) if of_cable(key) => format!("{} set to {}", property(key), value(key, written)),
        _ => format!("{} added", line(text)),
    }
}

/// A line that a scene file has no more, in words.
#[must_use]
pub fn removed(text: &str) -> String {
    match text.split_once(" = ") {
        Some((key, _)) if of_cable(key) => format!("{} back to its default", property(key)),
        _ => format!("{} removed", line(text)),
    }
}

fn of_cable(key: &str) -> bool {
    PROPERTIES.iter().any(|p| p.key == key.trim())
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
        for (written, said) in [
            ("to_x_m = 15.868020304568528", "Path: drive to 15.87 m"),
            ("service_tension_n = 800.0", "Service tension 800.0 N"),
            ("at_m = [3.2, 0.85]", "Position (3.200, 0.850) m"),
            ("kind = \"fixed\"", "Kind fixed"),
        ] {
            assert_eq!(line(written), said);
        }
        assert_eq!(place("cables[0].supports[1].at_m"), "Cable 1, support 2, position");
        assert_eq!(place("environment.wind_n_per_m"), "Environment, wind");
    }
}
