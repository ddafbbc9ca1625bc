//! These tests compare ARCHITECTURE.md and the maps of folders with the tree, and imports go one
//! way.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use cable_tests::{files_below, root, without_unit_tests};

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

/// A name that several files have leads nowhere. A name without a folder is that of one file below
/// the path that its row begins with.
#[test]
fn a_file_named_in_architecture_is_exactly_one() {
    let from = ["", "crates/cable-core/src", "crates/cable-viewer/src"].map(|f| root().join(f));
    // Every folder has the one, every model the other.
    let general = ["mod.rs", "settings.rs"];
    let mut wrong = Vec::new();
    for line in read("ARCHITECTURE.md").lines() {
        let row = line.strip_prefix("| `").and_then(|rest| rest.split('`').next()).unwrap_or("crates");
        let folder = root().join(row.trim_end_matches(".rs"));
        let below = if folder.is_dir() { files_below(&folder) } else { Vec::new() };
        let words = line.split('`').skip(1).step_by(2).filter(|w| w.ends_with(".rs") && !general.contains(w));
        for word in words {
            let found = match word.contains('/') {
                true => from.iter().filter(|f| f.join(word).exists()).count(),
                false => below.iter().filter(|f| f.ends_with(word)).count(),
            };
            if found != 1 {
                wrong.push(format!("`{word}` of `{row}`: {found} files"));
            }
        }
    }
    assert!(wrong.is_empty(), "ARCHITECTURE.md names files that are not exactly one: {wrong:#?}");
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
fn every_viewer_wing_has_a_line_in_architecture() {
    let text = read("ARCHITECTURE.md");
    for entry in std::fs::read_dir(root().join("crates/cable-viewer/src")).expect("the viewer's sources") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().into_string().expect("a name");
        let is_named = text.contains(&format!("cable-viewer/src/{name}/"));
        assert!(!entry.path().is_dir() || is_named, "{name} has no line in ARCHITECTURE.md");
    }
}

/// The names that the map at the head of a module has: the words between back-quotes in the first
/// cell of each row of its table, or before the colon of each item of its list.
fn rooms_on_map(text: &str) -> BTreeSet<String> {
    let doc: Vec<&str> = text.lines().map_while(|l| l.strip_prefix("//!")).collect();
    let rows = doc.iter().filter_map(|l| l.strip_prefix(" | `")?.split(" | ").next()).map(str::to_owned);
    let list = doc.join("\n");
    let items = list.split("\n - `").skip(1).filter_map(|item| item.split(": ").next()).map(str::to_owned);
    let names = rows.chain(items).flat_map(|named| {
        let words = format!("`{named}");
        words.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()
    });
    names.map(|w| w.trim_end_matches('/').trim_end_matches(".rs").to_owned()).collect()
}

/// The folder whose rooms the map at the head of a source names: its own of a `mod.rs`, that of its
/// name beside it of another file.
fn mapped_folder(module: &Path) -> Option<PathBuf> {
    let folder = if module.ends_with("mod.rs") { module.parent()?.to_owned() } else { module.with_extension("") };
    (module.extension().is_some_and(|e| e == "rs") && folder.is_dir()).then_some(folder)
}

#[test]
fn every_folder_opens_with_the_map_of_it() {
    let (mut wrong, mut beside) = (Vec::new(), 0);
    let sources = ["cable-core", "cable-viewer", "cable-cli"].map(|c| root().join("crates").join(c).join("src"));
    for module in sources.iter().flat_map(|s| files_below(s)) {
        let Some(folder) = mapped_folder(&module) else { continue };
        beside += usize::from(!module.ends_with("mod.rs"));
        let entries = std::fs::read_dir(&folder).expect("a folder").map(|e| e.expect("an entry").path());
        let rooms = entries.filter(|p| p.is_dir() || p.extension().is_some_and(|e| e == "rs"));
        let names = rooms.map(|p| p.file_stem().expect("a name").to_string_lossy().into_owned());
        let names: BTreeSet<String> = names.filter(|n| n != "mod" && !n.ends_with("tests")).collect();
        let mapped = rooms_on_map(&std::fs::read_to_string(&module).expect("a source"));
        // Two files need no map.
        if names.len() > 1 {
            wrong.extend(names.difference(&mapped).map(|n| format!("{}: `{n}` is not on the map", folder.display())));
        }
        let own = module.file_stem().expect("a name").to_string_lossy().into_owned();
        let is_room = |n: &&String| !n.contains('.') && **n != own && !n.ends_with("tests");
        let gone = mapped.difference(&names).filter(is_room);
        wrong.extend(gone.map(|n| format!("{}: `{n}` on the map is not there", folder.display())));
    }
    assert!(beside > 0, "maps at the head of other files than `mod.rs` are read");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
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
        // The module in `pub(in …)` is not imported.
        let text = without_unit_tests(&text).replace("pub(in crate::", "pub(in ");
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

/// A path of a module from the root of the crate on.
fn absolute(name: &str, path: &[String]) -> Vec<String> {
    let own = || name.split("::").map(str::to_owned);
    let up = path.iter().take_while(|w| *w == "super").count();
    let (base, skipped): (Vec<String>, usize) = match path.first().map(String::as_str) {
        Some("crate") => (Vec::new(), 1),
        Some("super") => (own().take(own().count().saturating_sub(up)).collect(), up),
        Some("self") => (own().collect(), 1),
        _ => (own().collect(), 0),
    };
    base.into_iter().chain(path.iter().skip(skipped).cloned()).filter(|w| w != "self").collect()
}

/// The statements by which a module hands out what another one defines: what lies between
/// `pub use` and `;`.
fn handed_out(code: &str) -> Vec<&str> {
    let is_public = |at: usize| code[..at].rsplit(['\n', ';']).next().is_some_and(|line| line.starts_with("pub"));
    let uses = code.match_indices("use ").filter(|(at, _)| is_public(*at));
    uses.filter_map(|(at, word)| code[at + word.len()..].split(';').next()).collect()
}

/// The paths of the crate in a text, from its root on. Rooms are called by their names alone.
fn paths_of(name: &str, code: &str, all: &BTreeMap<String, String>) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    let inside = format!("{name}::");
    let rooms = all.keys().filter_map(|m| m.strip_prefix(&inside)).filter(|room| !room.contains("::"));
    let words = ["crate", "super", "self"].into_iter().chain(rooms).map(|word| format!("{word}::"));
    for word in words.collect::<Vec<_>>() {
        for (at, _) in code.match_indices(&word) {
            if !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                path_tree(&code[at..], &[], &mut paths);
            }
        }
    }
    paths.iter().map(|path| absolute(name, path)).collect()
}

/// The modules of the crate that one of them imports from. A name that a module only hands out
/// belongs to the module that defines it, and to hand out is no import.
fn imports(name: &str, code: &str, all: &BTreeMap<String, String>) -> BTreeSet<String> {
    let mut own = code.to_owned();
    for statement in handed_out(code) {
        own = own.replace(&format!("use {statement};"), "");
    }
    let mut found = BTreeSet::new();
    for mut path in paths_of(name, &own, all) {
        let module = |path: &[String]| (1..=path.len()).rev().find(|n| all.contains_key(&path[..*n].join("::")));
        // Eight is more than any name is handed on.
        for _ in 0..8 {
            let Some(n) = module(&path) else { break };
            let at = path[..n].join("::");
            let public: Vec<_> = handed_out(&all[&at]).into_iter().flat_map(|u| paths_of(&at, u, all)).collect();
            let Some(target) = public.into_iter().find(|p| path.get(n).is_some() && p.last() == path.get(n)) else {
                break;
            };
            path = target.into_iter().chain(path.into_iter().skip(n + 1)).collect();
        }
        found.extend(module(&path).map(|n| path[..n].join("::")));
    }
    found.remove(name);
    found
}

type Graph = BTreeMap<String, BTreeSet<String>>;

/// The modules that each file of a crate imports from it.
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

/// Neither the core's top floor, nor the wings of a model, nor their files have loops.
#[test]
fn the_core_imports_one_way() {
    let files = files_of("cable-core");
    for below in ["", "model::fem", "model::spans", "model::mass_spring"] {
        let wings = wings_of(&files, below);
        assert!(wings.len() > 5, "`{below}` has wings");
        assert!(in_loops(&wings).is_empty(), "`{below}`: these import each other in a loop: {:?}", in_loops(&wings));
    }
    assert!(in_loops(&files).is_empty(), "these import each other in a loop: {:?}", in_loops(&files));
}

/// Wings of a model name what another wing's entrance hands out (`wing::X`), or a room as a whole
/// (`wing::room`, for `room::f`), and nothing inside a room.
#[test]
fn wings_of_a_model_see_only_each_others_entrances() {
    let all = modules(&root().join("crates/cable-core/src"));
    let mut wrong = BTreeSet::new();
    for (name, code) in &all {
        for path in paths_of(name, code, &all) {
            let [first, model, wing, ..] = path.as_slice() else { continue };
            let entrance = [first.as_str(), model, wing].join("::");
            let is_wing = first == "model" && all.keys().any(|m| m.starts_with(&format!("{entrance}::")));
            if !is_wing || *name == entrance || name.starts_with(&format!("{entrance}::")) {
                continue;
            }
            // The modules of the wing that the path names, one in another.
            let rooms = (4..=path.len()).take_while(|n| all.contains_key(&path[..*n].join("::"))).count();
            if rooms > 0 && path.len() > 3 + rooms {
                wrong.insert(format!("{name}: {}", path.join("::")));
            }
        }
    }
    assert!(wrong.is_empty(), "{} imports go past an entrance: {wrong:#?}", wrong.len());
}

/// Only the folder of the models knows which model it has: others ask for a capability, a label or
/// a rank.
#[test]
fn nothing_outside_the_models_asks_for_a_kind() {
    let kinds = ["Catenary", "Spans", "Fem", "MassSpring", "External"].map(|kind| format!("Model::{kind}"));
    // The most capable model is named by what it can do.
    let compares = |code: &str, sign: &str| code.split(sign).skip(1).any(|after| !after.starts_with("MOST_CAPABLE"));
    let mut found = Vec::new();
    for name in ["cable-core", "cable-viewer", "cable-cli"] {
        let modules = modules(&root().join("crates").join(name).join("src"));
        // The gallery draws one scene by a model that it names.
        let may = |module: &str| {
            module.starts_with("model::") || ["model_id", "app::documentation_pictures"].contains(&module)
        };
        for (module, code) in modules.iter().filter(|(module, _)| !may(module)) {
            let signs = ["== Model::", "!= Model::", "matches!(model, Model::"];
            if signs.iter().any(|sign| compares(code, sign)) || kinds.iter().any(|kind| code.contains(kind)) {
                found.push(format!("{name}: {module}"));
            }
        }
    }
    assert!(found.is_empty(), "these ask which model they have: {found:#?}");
}

/// Fields have words for names; only two files keep the symbols of the derivation at their head.
#[test]
fn fields_have_words_for_names() {
    let mut found = Vec::new();
    for name in ["cable-core", "cable-viewer", "cable-cli", "cable-linalg"] {
        for file in files_below(&root().join("crates").join(name).join("src")) {
            let symbols = ["catenary/closed_form.rs", "capstan/arc.rs"].iter().any(|end| file.ends_with(end));
            if symbols || file.to_string_lossy().contains("tests") {
                continue;
            }
            let code = without_unit_tests(&std::fs::read_to_string(&file).expect("a source"));
            for body in code.split("struct ").skip(1).filter_map(|rest| rest.split("\n}").next()) {
                let has_fields = body.lines().next().is_some_and(|line| line.ends_with('{'));
                let fields = body.lines().skip(1).filter(|line| has_fields && !line.trim_start().starts_with("//"));
                let named = fields.filter_map(|line| line.split_once(": ")?.0.rsplit(' ').next());
                found.extend(named.filter(|n| n.chars().count() == 1).map(|n| format!("{}: {n}", file.display())));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// Every module of the core stands in the order that its front page gives, and imports from earlier
/// steps alone.
#[test]
fn the_core_imports_in_the_order_of_its_front_page() {
    let page = read("crates/cable-core/src/lib.rs");
    let doc: String = page.lines().map_while(|line| line.strip_prefix("//!")).collect();
    let order = doc.split("each other: `").nth(1).and_then(|rest| rest.split('`').next()).expect("an order");
    let steps: Vec<Vec<&str>> = order.split('→').map(|step| step.split(',').map(str::trim).collect()).collect();
    let step_of = |module: &str| steps.iter().position(|step| step.contains(&module));
    let mut wrong = Vec::new();
    for (module, targets) in wings_of(&files_of("cable-core"), "") {
        let own = step_of(&module);
        assert!(own.is_some(), "`{module}` is not in the order");
        wrong.extend(targets.iter().filter(|t| step_of(t) >= own).map(|t| format!("{module} imports from {t}")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
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
