//! Feedback is written as a row of a table in a file of the user. Nothing is sent anywhere.

use std::path::Path;

use cable_core::{Solution, files};

/// The questions, each with the heading of its column.
pub const QUESTIONS: [(&str, &str); 4] = [
    ("useful", "It is useful for my work"),
    ("clear", "It is clear what I see"),
    ("realistic", "What the cable does looks real"),
    ("easy", "It is easy to use"),
];
/// Below this mark the user is asked what was confusing.
pub const MIN_GOOD_RATING: u8 = 4;
/// Best answer; the worst is 1.
pub const MAX_RATING: u8 = 5;

/// Largest file that is added to, bytes: more is not a table of answers.
const MAX_BYTES: u64 = 16 << 20;

/// The answers so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answers {
    /// 1 to 5; None: not answered yet.
    pub marks: [Option<u8>; QUESTIONS.len()],
    /// The text on what was confusing.
    pub words: String,
}

/// The state on screen while they were given.
#[derive(Clone, Debug)]
pub struct Context<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// The answer.
    pub answer: Option<&'a Solution>,
    /// The reason why there is none.
    pub error: Option<String>,
}

impl Answers {
    /// Returns true if a mark is low and the text on it is still empty.
    #[must_use]
    pub fn needs_comment(&self) -> bool {
        self.marks.iter().flatten().any(|m| *m < MIN_GOOD_RATING) && self.words.trim().is_empty()
    }

    /// Returns true if the answers can be saved.
    #[must_use]
    pub fn complete(&self) -> bool {
        self.marks.iter().all(Option::is_some) && !self.needs_comment()
    }

    /// A row of the table: the marks, the text, and the state on screen.
    #[must_use]
    fn row(&self, context: &Context<'_>) -> String {
        let mut cells: Vec<String> = self.marks.iter().map(|m| m.map_or_else(String::new, |m| m.to_string())).collect();
        let answer = context.answer;
        let warnings = answer.map_or(&[][..], |a| &a.warnings);
        let mut kinds: Vec<&str> = warnings.iter().map(|w| w.kind.name()).collect();
        kinds.dedup();
        cells.push(quoted(&self.words));
        cells.push(quoted(context.scene));
        cells.push(answer.map_or_else(String::new, |a| a.model.to_string()));
        cells.push(quoted(context.error.as_deref().unwrap_or_default()));
        cells.push(quoted(&kinds.join(" ")));
        cells.join(",")
    }
}

/// A cell of a table, quoted if need be.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.trim().replace('"', "\"\"").replace(['\n', '\r'], " "))
}

/// Adds the answers to a table, which is begun where there is none.
///
/// # Errors
/// In words: it is not complete, or the file refuses.
pub fn save(path: &Path, answers: &Answers, context: &Context<'_>) -> Result<(), String> {
    if !answers.complete() {
        return Err("every question needs a mark, and a low one a few words on what confused".to_owned());
    }
    let mut text = if path.exists() {
        let bytes = files::read_limited(path, MAX_BYTES).map_err(|e| e.to_string())?;
        String::from_utf8(bytes).map_err(|_| "it is no table of answers".to_owned())?
    } else {
        let columns: Vec<&str> = QUESTIONS.iter().map(|(column, _)| *column).collect();
        format!("{},confused_by,scene,model,refusal,warnings\n", columns.join(","))
    };
    if !text.ends_with('\n') {
        text.push('\n');
    }
    text += &answers.row(context);
    text.push('\n');
    files::write_atomic(path, text.as_bytes()).map_err(|e| e.to_string())
}
