//! The documents and the source against the tree: every path they name must exist, and imports go
//! one way.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Every `back-quoted` word of a text that looks like a path of this repository.
fn paths(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).filter(|w| w.contains('/') || *w == "Cargo.toml").collect()
}

#[test]
fn architecture_names_only_paths_that_exist() {
    let text = read("ARCHITECTURE.md");
    let named = paths(&text);
    assert!(named.len() > 15, "the document names its rooms");
    // Walks through a crate name its files from its sources on.
    let from = ["", "crates/cable-core/src", "crates/cable-viewer/src"];
    let exists = |p: &str| from.iter().any(|f| root().join(f).join(p).exists());
    let missing: Vec<_> = named.iter().filter(|p| !exists(p)).collect();
    assert!(missing.is_empty(), "ARCHITECTURE.md names what is not there: {missing:?}");
}

/// The files below a folder.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() { folders.push(path) } else { found.push(path) }
        }
    }
    found
}

#[test]
fn documents_name_only_source_files_that_exist() {
    let sources: Vec<String> = ["crates", "tests", "benches"]
        .iter()
        .flat_map(|f| files_below(&root().join(f)))
        .map(|f| f.to_string_lossy().into_owned())
        .collect();
    let mut missing = Vec::new();
    for document in files_below(&root().join("docs")).iter().filter(|f| f.extension().is_some_and(|e| e == "md")) {
        let text = std::fs::read_to_string(document).expect("a document");
        let words = text.split('`').skip(1).step_by(2).filter(|w| w.ends_with(".rs") && !w.contains(' '));
        for word in words.filter(|w| !sources.iter().any(|s| s.ends_with(&format!("/{w}")))) {
            missing.push(format!("{}: {word}", document.display()));
        }
    }
    assert!(missing.is_empty(), "documents name files that are not there:\n{}", missing.join("\n"));
}

#[test]
fn every_core_module_has_a_line_in_architecture() {
    let text = read("ARCHITECTURE.md");
    let source = root().join("crates/cable-core/src");
    for entry in std::fs::read_dir(&source).expect("the core's sources") {
        let name = entry.expect("an entry").file_name().into_string().expect("a name");
        let line = format!("cable-core/src/{name}");
        assert!(name == "lib.rs" || text.contains(&line), "{name} has no line in ARCHITECTURE.md");
    }
}

#[test]
fn links_of_the_documents_lead_somewhere() {
    for document in ["README.md", "CONTRIBUTING.md", "DESIGN.md", "ARCHITECTURE.md", "CHANGELOG.md"] {
        let text = read(document);
        for target in text.split("](").skip(1).filter_map(|t| t.split(')').next()) {
            if !target.contains("://") && !target.starts_with('#') {
                assert!(root().join(target).exists(), "{document} links to {target}, which is not there");
            }
        }
    }
}

#[test]
fn every_viewer_wing_has_a_line_in_architecture() {
    let text = read("ARCHITECTURE.md");
    for entry in std::fs::read_dir(root().join("crates/cable-viewer/src")).expect("the viewer's sources") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().into_string().expect("a name");
        let is_named = text.contains(&format!("cable-viewer/src/{name}/"));
        assert!(!entry.path().is_dir() || is_named, "{name} has no line in ARCHITECTURE.md");
    }
}

/// Every module of a crate (`a::b`) and its code, without comments and unit tests.
fn modules(source: &Path) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for path in files_below(source).iter().filter(|f| f.extension().is_some_and(|e| e == "rs")) {
        let relative = path.strip_prefix(source).expect("below the source").with_extension("");
        let name = relative.to_str().expect("a name").replace('/', "::");
        let is_test = ["tests", "tests::mod"].iter().any(|end| name.ends_with(end)) || name.contains("::tests::");
        if is_test || ["lib", "main"].contains(&name.as_str()) {
            continue;
        }
        let text = std::fs::read_to_string(path).expect("a source");
        // What may see an item is no import.
        let text = text.split("#[cfg(test)]\n").next().unwrap_or_default().replace("pub(in crate::", "pub(in ");
        let code = |line: &str| line.split("//").next().unwrap_or_default().to_owned() + "\n";
        found.insert(name.trim_end_matches("::mod").to_owned(), text.lines().map(code).collect());
    }
    found
}

/// The paths that a text begins with: `a::{b, c::d}` is `a::b` and `a::c::d`. Returns what is left
/// of the text.
fn path_tree<'a>(text: &'a str, before: &[&'a str], out: &mut Vec<Vec<String>>) -> &'a str {
    let (mut path, mut rest) = (before.to_vec(), text);
    loop {
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        if word.is_empty() {
            break;
        }
        path.push(word);
        let Some(next) = after.strip_prefix("::") else {
            rest = after;
            break;
        };
        rest = next;
        if let Some(mut inside) = next.strip_prefix('{') {
            while !inside.is_empty() && !inside.starts_with('}') {
                let skipped = inside.trim_start_matches([' ', '\n', ',']);
                if skipped.starts_with('}') {
                    break;
                }
                let left = path_tree(skipped, &path, out);
                inside = if left.len() == skipped.len() { left.get(1..).unwrap_or_default() } else { left };
            }
            return inside.strip_prefix('}').unwrap_or_default();
        }
    }
    out.push(path.iter().map(|w| (*w).to_owned()).collect());
    rest
}

/// The modules of the crate that one of them imports from.
fn imports(name: &str, code: &str, all: &BTreeMap<String, String>) -> BTreeSet<String> {
    let mut paths = Vec::new();
    let starts = |word: &str| {
        let ends_before = |at: &usize| !code[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
        code.match_indices(word).map(|(at, _)| at).filter(ends_before).collect::<Vec<_>>()
    };
    for word in ["crate::", "super::"] {
        for at in starts(word) {
            path_tree(&code[at..], &[], &mut paths);
        }
    }
    let mut found = BTreeSet::new();
    for path in paths {
        let up = path.iter().take_while(|w| *w == "super").count();
        let own: Vec<&str> = name.split("::").collect();
        let base = if up > 0 { own[..own.len().saturating_sub(up)].to_vec() } else { Vec::new() };
        let below = path.iter().skip(up.max(1)).map(String::as_str);
        let full: Vec<&str> = base.into_iter().chain(below).collect();
        found.extend((1..=full.len()).rev().map(|n| full[..n].join("::")).find(|m| all.contains_key(m)));
    }
    // An entrance calls its rooms by their names alone.
    let inside = format!("{name}::");
    let rooms = all.keys().filter(|m| m.strip_prefix(&inside).is_some_and(|room| !room.contains("::")));
    found.extend(rooms.filter(|m| !starts(&format!("{}::", &m[inside.len()..])).is_empty()).cloned());
    found.remove(name);
    found
}

type Graph = BTreeMap<String, BTreeSet<String>>;

/// What each file of a crate imports from it.
fn files_of(name: &str) -> Graph {
    let all = modules(&root().join("crates").join(name).join("src"));
    assert!(all.len() > 5, "{name} has modules");
    let files: Graph = all.iter().map(|(m, code)| (m.clone(), imports(m, code, &all))).collect();
    assert!(files.values().map(BTreeSet::len).sum::<usize>() > 5, "{name}: imports are seen");
    files
}

/// The same of the wings below a module (`model::fem`; nothing: of the crate).
fn wings_of(files: &Graph, below: &str) -> Graph {
    let wing = |m: &str| {
        let inside = if below.is_empty() { Some(m) } else { m.strip_prefix(below)?.strip_prefix("::") };
        inside?.split("::").next().map(str::to_owned)
    };
    let mut wings = Graph::new();
    for (m, targets) in files {
        let Some(own) = wing(m) else { continue };
        let others = targets.iter().filter_map(|t| wing(t)).filter(|t| *t != own).collect::<Vec<_>>();
        wings.entry(own).or_default().extend(others);
    }
    wings
}

fn in_loops(graph: &Graph) -> Vec<&String> {
    graph.keys().filter(|m| reaches(graph, m)).collect()
}

#[test]
fn modules_of_viewer_and_program_import_one_way() {
    for name in ["cable-viewer", "cable-cli"] {
        let files = files_of(name);
        for graph in [wings_of(&files, ""), files] {
            assert!(in_loops(&graph).is_empty(), "{name}: these import each other in a loop: {:?}", in_loops(&graph));
        }
    }
}

/// Neither the core's top floor nor the wings of a model have loops. A folder and its files still
/// do: their number may not grow.
#[test]
fn the_core_imports_one_way() {
    let files = files_of("cable-core");
    for below in ["", "model::fem", "model::spans", "model::mass_spring"] {
        let wings = wings_of(&files, below);
        assert!(wings.len() > 5, "`{below}` has wings");
        assert!(in_loops(&wings).is_empty(), "`{below}`: these import each other in a loop: {:?}", in_loops(&wings));
    }
    assert!(in_loops(&files).len() <= 41, "{:?}", in_loops(&files));
}

/// A module is reached by following imports from itself.
fn reaches(graph: &BTreeMap<String, BTreeSet<String>>, from: &str) -> bool {
    let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
    while let Some(module) = next.pop() {
        for target in graph.get(module).into_iter().flatten() {
            if target == from {
                return true;
            }
            if seen.insert(target) {
                next.push(target);
            }
        }
    }
    false
}

/// Pictures were drawn by the harness of the interface tests, which every build then carried.
#[test]
fn the_window_ships_without_the_harness_of_its_tests() {
    let manifest = read("crates/cable-viewer/Cargo.toml");
    let shipped = manifest.split("[dev-dependencies]").next().expect("what is before them");
    assert!(shipped.contains("[dependencies]") && !shipped.contains("kittest"), "a test tool is a dependency");
    for file in files_below(&root().join("crates/cable-viewer/src")) {
        let code = std::fs::read_to_string(&file).expect("a source file");
        assert!(!code.contains("egui_kittest"), "{} uses it", file.display());
    }
}
