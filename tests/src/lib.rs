//! The tests of documents and sources share how these are found and read.

use std::path::{Path, PathBuf};

/// The root of the repository.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The files below a folder; none where it cannot be read.
#[must_use]
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() { folders.push(path) } else { found.push(path) }
        }
    }
    found
}

/// A source without the items that only unit tests see: those that `#[cfg(test)]` stands before.
#[must_use]
pub fn without_unit_tests(source: &str) -> String {
    let mut kept = String::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        if line.trim() == "#[cfg(test)]" {
            let indent = line.len() - line.trim_start().len();
            let is_attribute = |line: &&str| line.trim_start().starts_with("#[") || line.trim_start().starts_with("//");
            let first = lines.by_ref().find(|line| !is_attribute(line)).unwrap_or_default();
            if !first.ends_with([';', ',', '}']) {
                // The item ends with the brace that stands below its first letter.
                lines.by_ref().find(|line| line.get(..indent + 1).is_some_and(|head| head.trim_start() == "}"));
            }
        } else {
            kept += line;
            kept.push('\n');
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::without_unit_tests;

    #[test]
    fn code_after_a_declared_test_module_is_read() {
        let source = "mod a;\n#[cfg(test)]\nmod tests;\n\nuse b::c;\n#[cfg(test)]\n#[allow(x)]\nmod inner {\n    fn d() {\n    }\n}\nfn e() {}\n";
        assert_eq!(without_unit_tests(source), "mod a;\n\nuse b::c;\nfn e() {}\n");
    }

    #[test]
    fn only_the_method_of_tests_is_left_out_of_an_impl() {
        let source = "impl A {\n    #[cfg(test)]\n    pub fn b(&self) {\n        if c {\n        }\n    }\n\n    pub fn d() {}\n}\n";
        assert_eq!(without_unit_tests(source), "impl A {\n\n    pub fn d() {}\n}\n");
    }
}
