//! Every item of the scene has a unique name.

/// The name, with the first free number appended if it is taken.
pub fn unique(name: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(name) {
        return name.to_owned();
    }
    (2..).map(|k| format!("{name} {k}")).find(|n| !taken(n)).unwrap_or_default()
}
