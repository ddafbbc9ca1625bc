//! The documents against the tree: every path they name must exist.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

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
    let missing: Vec<_> = named.iter().filter(|p| !root().join(p).exists()).collect();
    assert!(missing.is_empty(), "ARCHITECTURE.md names what is not there: {missing:?}");
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
