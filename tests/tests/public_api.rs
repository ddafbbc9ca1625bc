//! The names that a user of `cable-core` can write are listed in `docs/public-api.txt`, fields of
//! structs with their types: this test compares the list with the crate.
//!
//! A change that means to add or take away a public item writes the list anew:
//! ```text
//! UPDATE_PUBLIC_API=1 cargo test --locked -p cable-tests --test public_api
//! ```

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use cable_tests::without_unit_tests;

/// The file of a module below a folder.
fn file_of(folder: &Path, name: &str) -> Option<PathBuf> {
    let own = folder.join(format!("{name}.rs"));
    let entrance = folder.join(name).join("mod.rs");
    [own, entrance].into_iter().find(|p| p.exists())
}

/// The word that an item's line names, after its keyword.
fn name_after(line: &str, keyword: &str) -> Option<String> {
    let rest = line.strip_prefix(keyword)?.strip_prefix(' ')?;
    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    Some(rest[..end].to_owned())
}

/// A source with each of its `pub use` statements on one line.
fn one_line_a_use(text: &str) -> String {
    let mut out = String::new();
    for part in text.split_inclusive(';') {
        match part.split_once("\npub use ") {
            Some((before, used)) => {
                let used = used.split_whitespace().collect::<Vec<_>>().join(" ");
                out += &format!("{before}\npub use {}", used.replace("{ ", "{").replace(", }", "}"));
            }
            None => out += part,
        }
    }
    out
}

/// The head of an `impl` without the parameters that it begins with.
fn without_parameters(head: &str) -> &str {
    let mut depth = 0;
    for (at, c) in head.char_indices() {
        match c {
            '<' => depth += 1,
            '>' => depth -= 1,
            _ if depth == 0 => return &head[at..],
            _ => {}
        }
    }
    head
}

/// The private room of a module from which a line such as `self::room::{A, B}` hands out names, and
/// these; None for what is public elsewhere.
fn private_room(text: &str, used: &str) -> Option<(String, Vec<String>)> {
    let (room, names) = used.strip_prefix("self::").unwrap_or(used).split_once("::")?;
    let is_private =
        text.lines().any(|line| [format!("mod {room};"), format!("pub(crate) mod {room};")].contains(&line.to_owned()));
    let names =
        names.trim_matches(['{', '}']).split(',').filter(|name| !name.is_empty()).map(|name| name.trim().to_owned());
    (is_private && !names.clone().any(|name| name.contains("::"))).then(|| (room.to_owned(), names.collect()))
}

/// The public fields of the public structs of a source, as `Struct.field: type`.
fn fields(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let Some(name) = name_after(line, "pub struct") else { continue };
        if let Some((_, members)) = line.split_once('(').filter(|_| line.ends_with(");")) {
            let members = members.trim_end_matches(");").split(", ").enumerate();
            let public = members.filter_map(|(k, member)| Some((k, member.strip_prefix("pub ")?)));
            found.extend(public.map(|(k, of)| format!("{name}.{k}: {of}")));
        }
        if !line.ends_with('{') {
            continue;
        }
        let mut field = String::new();
        for line in lines.by_ref().take_while(|line| *line != "}") {
            let begins = line.strip_prefix("    pub ").filter(|_| field.is_empty());
            match begins {
                Some(begin) => field = begin.to_owned(),
                // A type that does not fit on a line.
                None if !field.is_empty() => field = format!("{field} {}", line.trim()),
                None => continue,
            }
            if field.ends_with(',') && field.matches('<').count() == field.matches('>').count() {
                found.push(format!("{name}.{}", std::mem::take(&mut field).trim_end_matches(',')));
            }
        }
    }
    found
}

/// Public items of some names that a module hands out of one of its private rooms.
fn list_of_room(module: &str, room: &str, names: &[String], folder: &Path, out: &mut BTreeSet<String>) {
    let mut all = BTreeSet::new();
    let file = file_of(folder, room).expect("the room has a file");
    list(module, &file, &folder.join(room), &mut all);
    let inside = format!("{module}::");
    let of_names = |item: &String| {
        let name = item.strip_prefix(&inside).and_then(|rest| rest.split([':', '.']).next());
        name.is_some_and(|name| names.iter().any(|n| n == name))
    };
    out.extend(all.into_iter().filter(of_names));
}

/// Public items of a module and of the public modules inside it. Items begin a line; methods are
/// indented once.
fn list(module: &str, file: &Path, folder: &Path, out: &mut BTreeSet<String>) {
    let text = one_line_a_use(&without_unit_tests(&std::fs::read_to_string(file).expect("a source")));
    out.extend(fields(&text).into_iter().map(|field| format!("{module}::{field}")));
    let mut owner = String::new();
    for line in text.lines() {
        if line.starts_with("impl") {
            // `impl<T> Trait for Type {` and `impl Type {`: the last word that begins with a
            // capital is the type.
            let head = line.trim_end_matches([' ', '{']);
            let head = head.rsplit(" for ").next().unwrap_or(head);
            let head = without_parameters(head.strip_prefix("impl").unwrap_or(head)).trim();
            owner = head.split(['<', ' ']).next().unwrap_or_default().to_owned();
        }
        if let Some(name) = name_after(line, "pub mod") {
            out.insert(format!("{module}::{name}"));
            let file = file_of(folder, &name).expect("the module has a file");
            list(&format!("{module}::{name}"), &file, &folder.join(&name), out);
        }
        for keyword in ["struct", "enum", "trait", "fn", "const", "type", "static", "const fn"] {
            if let Some(name) = line.strip_prefix("pub ").and_then(|l| name_after(l, keyword)) {
                out.insert(format!("{module}::{name}"));
            }
            if let Some(name) = line.strip_prefix("    pub ").and_then(|l| name_after(l, keyword))
                && ["fn", "const", "const fn"].contains(&keyword)
            {
                out.insert(format!("{module}::{owner}::{name}"));
            }
        }
        if let Some(used) = line.strip_prefix("pub use ") {
            let used = used.trim_end_matches(';');
            match private_room(&text, used) {
                Some((room, names)) => list_of_room(module, &room, &names, folder, out),
                None => _ = out.insert(format!("{module}: use {used}")),
            }
        }
    }
}

/// Fields of structs that a public module hands out of a private one elsewhere in the crate: they
/// have the path by which they are handed out.
fn list_fields_of_handed_out(sources: &Path, out: &mut BTreeSet<String>) {
    let mut found = Vec::new();
    for (module, used) in out.iter().filter_map(|item| item.split_once(": use crate::")) {
        let Some((path, names)) = used.rsplit_once("::") else { continue };
        let parts: Vec<&str> = path.split("::").collect();
        let (room, above) = parts.split_last().expect("a path");
        let folder = above.iter().fold(sources.to_owned(), |folder, part| folder.join(part));
        let Some(file) = file_of(&folder, room) else { continue };
        let public = fields(&std::fs::read_to_string(file).expect("a source"));
        let names = names.trim_matches(['{', '}']).split(", ");
        let is_new = |name: &&str| !out.contains(&format!("cable_core::{path}::{name}"));
        for name in names.filter(is_new) {
            let own = public.iter().filter(|field| field.split('.').next() == Some(name));
            found.extend(own.map(|field| format!("{module}::{field}")));
        }
    }
    out.extend(found);
}

/// The files below a folder, without those of tests.
fn sources_below(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path());
    let mut found = Vec::new();
    for path in entries {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        match path.is_dir() {
            _ if name.ends_with("tests") => {}
            true => found.extend(sources_below(&path)),
            false => found.push(path),
        }
    }
    found
}

/// Public methods that another file than that of their type gives it: a private room may hand out
/// nothing and extend a type all the same.
fn list_methods_of_other_files(sources: &Path, out: &mut BTreeSet<String>) {
    let is_type =
        |name: &str| name.starts_with(|c: char| c.is_uppercase()) && name.contains(|c: char| c.is_lowercase());
    let mut paths: BTreeMap<String, String> = BTreeMap::new();
    for item in out.iter().filter(|item| !item.contains(": ")) {
        if let Some(name) = item.rsplit("::").next().filter(|name| is_type(name)) {
            paths.entry(name.to_owned()).or_insert_with(|| item.clone());
        }
    }
    // A type of a private module has the path by which it is handed out.
    let mut handed_out = BTreeSet::new();
    for (module, used) in out.iter().filter_map(|item| item.split_once(": use ")) {
        let names = used.rsplit("::").next().unwrap_or_default().trim_matches(['{', '}']);
        for name in names.split(", ").filter(|name| is_type(name)) {
            if !paths.contains_key(name) {
                paths.insert(name.to_owned(), format!("{module}::{name}"));
                handed_out.insert(name.to_owned());
            }
        }
    }
    let mut methods = BTreeSet::new();
    for file in sources_below(sources) {
        let text = without_unit_tests(&std::fs::read_to_string(&file).expect("a source"));
        let mut owner = None;
        for line in text.lines() {
            if let Some(head) = line.strip_prefix("impl") {
                let name = without_parameters(head.trim_end_matches([' ', '{'])).trim();
                let name = name.split(['<', ' ']).next().unwrap_or_default();
                // An item that the file itself defines under that name is listed, or private,
                // unless it is handed out from elsewhere.
                let is_head =
                    |line: &str| line.contains(&format!("struct {name} ")) || line.contains(&format!("enum {name} "));
                let defines = !handed_out.contains(name) && text.lines().any(is_head);
                owner = paths.get(name).filter(|_| !defines);
            }
            for keyword in ["fn", "const", "const fn"] {
                if let (Some(owner), Some(name)) =
                    (owner, line.strip_prefix("    pub ").and_then(|l| name_after(l, keyword)))
                {
                    methods.insert(format!("{owner}::{name}"));
                }
            }
        }
    }
    out.extend(methods);
}

#[test]
fn fields_are_those_that_are_public() {
    let text = "pub struct A<T> {\n    /// Doc.\n    pub a: Vec<T>,\n    b: f64,\n    pub(crate) c: f64,\n    pub d:\n        \
                Option<(u8, u8)>,\n}\nstruct B {\n    pub a: u8,\n}\npub struct C(pub u64, f64);\n";
    assert_eq!(fields(text), ["A.a: Vec<T>", "A.d: Option<(u8, u8)>", "C.0: u64"]);
}

#[test]
fn the_list_of_public_items_is_that_of_the_crate() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let sources = root.join("crates/cable-core/src");
    let mut found = BTreeSet::new();
    list("cable_core", &sources.join("lib.rs"), &sources, &mut found);
    list_methods_of_other_files(&sources, &mut found);
    list_fields_of_handed_out(&sources, &mut found);
    assert!(found.contains("cable_core::Simulation::settle"), "methods are seen");
    assert!(found.contains("cable_core::scene::Scene::from_toml"), "so are those of other files than their type's");
    let field = "cable_core::solution::Solution.cables: Vec<CableSolution>";
    assert!(found.contains(field), "fields are seen, those of private rooms too");
    let path = root.join("docs/public-api.txt");
    let text: String = found.iter().map(|item| item.clone() + "\n").collect();
    if std::env::var_os("UPDATE_PUBLIC_API").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let listed = std::fs::read_to_string(&path).unwrap_or_default();
    let listed: BTreeSet<String> = listed.lines().map(str::to_owned).collect();
    let added: Vec<_> = found.difference(&listed).collect();
    let gone: Vec<_> = listed.difference(&found).collect();
    assert!(added.is_empty() && gone.is_empty(), "new: {added:#?}, gone: {gone:#?}; see the head of this test");
}
