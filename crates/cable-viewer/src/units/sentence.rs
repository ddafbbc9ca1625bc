//! Sentences of the solver are made in the units on screen, and call things as the window does.

use cable_core::Model;
use cable_core::wording::Sentence;

use crate::units::{labels, system};

/// A sentence in the units on screen. Names, which the core has between backticks, stand between
/// quotation marks; keys of a scene file and short names of models are called as they are in the
/// window.
#[must_use]
pub fn sentence(of: &impl Sentence) -> String {
    plain(&of.sentence(system::current()))
}

/// A sentence of the core with the words of the window: code becomes quotes.
fn plain(text: &str) -> String {
    // A sentence about a file has the words of the file.
    let of_file = [".csv", ".toml", "line "].iter().any(|word| text.contains(word));
    let mut out = String::new();
    for (k, part) in text.split('`').enumerate() {
        out.push_str(match k {
            0 => "",
            _ if k % 2 == 1 => "“",
            _ => "”",
        });
        match k % 2 == 1 || of_file {
            true => out.push_str(part),
            false => out.push_str(&renamed(part)),
        }
    }
    out
}

/// Words in the place of keys and short names.
fn renamed(text: &str) -> String {
    let text = text.replace("[robot]", "robot").replace("kind = \"free\"", "a free end");
    let in_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let mut out = String::new();
    let mut rest = text.as_str();
    while !rest.is_empty() {
        let word_end = rest.find(|c| !in_word(c)).unwrap_or(rest.len());
        let (word, after) = rest.split_at(word_end);
        out.push_str(&match Model::from_name(word) {
            Some(model) if names_a_model(word, &out) => labels::model(model).to_owned(),
            _ if word.contains('_') => key(word),
            _ => word.to_owned(),
        });
        let next = after.find(in_word).unwrap_or(after.len());
        let (between, after) = after.split_at(next);
        out.push_str(between);
        rest = after;
    }
    out
}

/// Some models are called by words that a sentence may mean otherwise: they are meant where it
/// begins, or where one is to be used.
fn names_a_model(word: &str, before: &str) -> bool {
    let begins = before.is_empty() || [": ", "; ", "use ", "answer of ", "only "].iter().any(|w| before.ends_with(w));
    matches!(word, "fem" | "mass-spring") || (begins && matches!(word, "spans" | "catenary"))
}

/// A key of a scene file without its unit: `temperature_change_k` is the temperature change.
fn key(word: &str) -> String {
    const UNITS: [&str; 6] = ["m", "n", "s", "k", "deg", "kg"];
    let name = word.rsplit_once('_').filter(|(_, unit)| UNITS.contains(unit)).map_or(word, |(name, _)| name);
    name.replace('_', " ")
}

#[cfg(test)]
mod tests {
    use cable_core::solution::{Warning, WarningCause};

    use super::*;

    /// Every sentence of the core, as the window tells it.
    #[test]
    fn no_sentence_has_a_key_a_short_name_of_a_model_or_a_number_of_many_digits() {
        let all = include_str!("../../../cable-core/tests/data/sentences.txt");
        let mut seen = 0;
        for line in all.lines().filter(|l| !l.contains("line ") && !l.contains(".csv")) {
            let shown = plain(line);
            let outside: String = shown.split(['“', '”']).step_by(2).collect::<Vec<_>>().join(" ");
            let words = outside.split(|c: char| !c.is_ascii_alphanumeric() && !"_-.".contains(c));
            for word in words {
                assert!(!word.contains('_') && word != "fem" && word != "mass-spring", "{word} in {shown}");
                let significant = word.trim_start_matches(['-', '0', '.']);
                let digits = significant.bytes().filter(u8::is_ascii_digit).count();
                assert!(digits <= 7, "{word} in {shown}");
            }
            for begins in ["spans ", "catenary "] {
                assert!(!outside.starts_with(begins), "{shown}");
            }
            seen += usize::from(shown.len() > 1);
        }
        assert!(seen > 100, "{seen}");
        assert_eq!(
            plain("fem cannot go on: make length_m at least 3 m at `a_m`"),
            "FEM cannot go on: make length at least 3 m at “a_m”"
        );
        assert_eq!(plain("supports only: the elastic catenary"), "supports only: the elastic catenary");
    }

    #[test]
    fn a_sentence_follows_the_units_on_screen() {
        let cause = WarningCause::Lags { support: "beam 3 m".to_owned(), behind_m: 0.3048 };
        let warning = Warning::new(cause, "a", 0.0, [1.0, 2.0]);
        let expected = "Support “beam 3 m” is 0.30 m behind its target, because it moves at 2 m/s at most";
        assert_eq!(sentence(&warning), expected);
        system::set_current(system::System::Us);
        let expected = "Support “beam 3 m” is 1.00 ft behind its target, because it moves at 6.5617 ft/s at most";
        assert_eq!(sentence(&warning), expected);
        system::set_current(system::System::Si);
    }
}
