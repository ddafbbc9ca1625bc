//! These tests compare the documents with the tree: every file, name and command that they quote
//! between back-quotes must exist. The history that they tell names what is gone in quotation
//! marks.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use cable_tests::{files_below, root};

/// Names that no file of the repository has: other programs and crates read them.
const FOREIGN: [&str; 1] = ["UPDATE_SNAPSHOTS"];

/// The sources, tests and scripts, from the root of the repository on.
fn tree() -> Vec<PathBuf> {
    let folders = ["crates", "tests", "benches", "assets", "docs", ".ci", ".cargo"];
    let below = folders.iter().flat_map(|folder| files_below(&root().join(folder)));
    let top = ["Cargo.toml", "README.md", "ARCHITECTURE.md", "DESIGN.md", "CONTRIBUTING.md", "CHANGELOG.md"];
    let all = below.chain(top.iter().map(|file| root().join(file)));
    all.map(|path| path.strip_prefix(root()).expect("below the root").to_owned()).collect()
}

/// The documents that describe the present tree, with their texts. A change log tells the past.
fn documents() -> Vec<(PathBuf, String)> {
    let is_document = |path: &PathBuf| path.extension().is_some_and(|e| e == "md") && !path.ends_with("CHANGELOG.md");
    let read = |path: PathBuf| std::fs::read_to_string(root().join(&path)).map(|text| (path, text));
    tree().into_iter().filter(is_document).map(|path| read(path).expect("a document")).collect()
}

/// A text without its blocks of code, which have three back-quotes.
fn without_blocks(text: &str) -> String {
    text.split("```").step_by(2).collect()
}

/// The words of a text that stand between back-quotes.
fn quoted(text: &str) -> Vec<String> {
    without_blocks(text)
        .split('`')
        .skip(1)
        .step_by(2)
        .map(|w| w.split_whitespace().collect::<Vec<_>>().join(" "))
        .collect()
}

/// The identifiers of a line of code or a quotation.
fn identifiers(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').map(|w| w.trim_matches('_'))
}

/// The identifiers of all code, comments left out, and the names of files and folders.
fn known_names() -> BTreeSet<String> {
    let mut names: BTreeSet<String> = FOREIGN.iter().map(|&name| name.to_owned()).collect();
    for path in tree() {
        let parts = path.to_string_lossy().into_owned();
        names.extend(identifiers(&parts).map(str::to_owned));
        let is_code =
            path.starts_with(".ci") || ["rs", "toml", "py"].iter().any(|e| path.extension().is_some_and(|x| x == *e));
        // This file names what is not to be found.
        if !is_code || path.ends_with("tests/documents.rs") {
            continue;
        }
        let text = std::fs::read_to_string(root().join(&path)).unwrap_or_default();
        for line in text.lines() {
            let code = line.split("//").next().unwrap_or_default();
            names.extend(identifiers(code).map(str::to_owned));
        }
    }
    names
}

/// True for a word that only code has: several words in one, or capitals within.
fn is_name_of_code(word: &str) -> bool {
    let camel = word.chars().zip(word.chars().skip(1)).any(|(a, b)| a.is_ascii_lowercase() && b.is_ascii_uppercase());
    word.contains('_') || camel
}

/// The names that a text quotes and no code has. The first or last words of a name stand for it, as
/// those of a test in a command do.
fn unknown_names(text: &str, known: &BTreeSet<String>) -> Vec<String> {
    let is_known =
        |word: &str| known.contains(word) || known.iter().any(|name| name.starts_with(word) || name.ends_with(word));
    let quotations = quoted(text);
    let words = quotations.iter().flat_map(|quotation| identifiers(quotation));
    words.filter(|word| is_name_of_code(word) && !is_known(word)).map(str::to_owned).collect()
}

/// The groups and fields of the settings of all models.
fn setting_names() -> BTreeSet<String> {
    let files = tree().into_iter().filter(|path| path.ends_with("settings.rs"));
    let texts = files.map(|path| std::fs::read_to_string(root().join(path)).expect("a source"));
    texts.flat_map(|text| identifiers(&text).map(str::to_owned).collect::<Vec<_>>()).collect()
}

/// The paths that a text quotes and the tree has not: the last parts of a path stand for it, a file
/// of sources may lack its ending, and a setting is a group and a field.
fn unknown_paths(text: &str, files: &[PathBuf], settings: &BTreeSet<String>) -> Vec<String> {
    let is_path = |word: &String| {
        word.contains('/')
            && word.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c))
            && !word.starts_with('/')
    };
    let exists = |word: &str| {
        let ends = |path: &Path| path.ends_with(word) || path.with_extension("").ends_with(word);
        files.iter().any(|file| file.ancestors().any(ends))
    };
    let is_setting = |word: &str| {
        word.split('/').all(|part| part.parse::<usize>().is_ok() || (!part.is_empty() && settings.contains(part)))
    };
    let is_made = |word: &str| word.starts_with("target/");
    let paths = quoted(text).into_iter().filter(is_path);
    paths.filter(|word| !exists(word.trim_end_matches('/')) && !is_setting(word) && !is_made(word)).collect()
}

#[test]
fn documents_name_only_what_exists() {
    let (files, known, settings) = (tree(), known_names(), setting_names());
    assert!(files.len() > 800 && known.len() > 5000, "the tree is read");
    let mut wrong = Vec::new();
    let mut count = 0;
    for (document, text) in documents() {
        count += quoted(&text).len();
        let missing = unknown_names(&text, &known).into_iter().chain(unknown_paths(&text, &files, &settings));
        wrong.extend(missing.map(|name| format!("{}: {name}", document.display())));
    }
    assert!(count > 1500, "quotations are seen");
    assert!(wrong.is_empty(), "documents name what is not there:\n{}", wrong.join("\n"));
}

/// The test above sees a name, a path and a setting that are wrong, and lets right ones pass.
#[test]
fn a_wrong_name_is_seen() {
    let (files, known, settings) = (tree(), known_names(), setting_names());
    let text = "`StepContext` `model/fem/time/bdf2.rs` `model/fem/time/bdf2` `newton/max_halvings` `--every`";
    assert_eq!(unknown_names(text, &known), [""; 0]);
    assert_eq!(unknown_paths(text, &files, &settings), [""; 0]);
    let text = "`StepContextual` `model/fem/time/bdf5.rs` `newton/max_quarterings` `settle_down_at_once`";
    assert_eq!(unknown_names(text, &known), ["StepContextual", "max_quarterings", "settle_down_at_once"]);
    assert_eq!(unknown_paths(text, &files, &settings), ["model/fem/time/bdf5.rs", "newton/max_quarterings"]);
}

/// The targets of `cargo` that a text names after `--test`, `--bench`, `--bin` and `--example`.
fn named_targets(text: &str) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().map(|w| w.trim_matches(|c| "`().,;:".contains(c))).collect();
    let kinds = ["--test", "--bench", "--bin", "--example"];
    let named = words.windows(2).filter(|pair| kinds.contains(&pair[0]));
    let names = named.map(|pair| pair[1].to_owned());
    names.filter(|n| n.starts_with(|c: char| c.is_ascii_lowercase())).collect()
}

#[test]
fn commands_of_the_documents_name_targets_that_exist() {
    let files = tree();
    let manifests = files.iter().filter(|path| path.ends_with("Cargo.toml"));
    let manifests: String =
        manifests.map(|path| std::fs::read_to_string(root().join(path)).expect("a manifest")).collect();
    let exists = |target: &str| {
        let in_folder =
            |path: &PathBuf| path.ends_with(format!("{target}.rs")) || path.ends_with(format!("{target}/main.rs"));
        files.iter().any(in_folder) || manifests.contains(&format!("name = \"{target}\""))
    };
    let mut wrong = Vec::new();
    let mut count = 0;
    for (document, text) in documents() {
        let targets = named_targets(&text);
        count += targets.len();
        let missing = targets.into_iter().filter(|target| !exists(target));
        wrong.extend(missing.map(|target| format!("{}: {target}", document.display())));
    }
    assert!(count > 30, "commands are seen");
    assert!(wrong.is_empty(), "commands name targets that are not there:\n{}", wrong.join("\n"));
}

#[test]
fn links_of_the_documents_lead_somewhere() {
    let mut wrong = Vec::new();
    let change_log = std::fs::read_to_string(root().join("CHANGELOG.md")).expect("the change log");
    for (document, text) in documents().into_iter().chain([(PathBuf::from("CHANGELOG.md"), change_log)]) {
        let folder = root().join(document.parent().expect("a folder"));
        for target in text.split("](").skip(1).filter_map(|t| t.split(')').next()) {
            let path = target.split('#').next().unwrap_or_default();
            if !target.contains("://") && !path.is_empty() && !folder.join(path).exists() {
                wrong.push(format!("{}: {target}", document.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "links lead nowhere:\n{}", wrong.join("\n"));
}
