//! The known name nearest to a mistyped one is the hint of an error message.

/// The known name nearest to a mistyped one, if any is near enough to be meant.
pub(super) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    // Jaro–Winkler similarity below which a hint is noise: 0.95 misses `lenght` for `length_m`,
    // 0.75 offers `name` for `a`.
    const MIN_SIMILARITY: f64 = 0.8;
    // A hostile key of megabytes would be compared in quadratic time.
    const MAX_NAME_CHARS: usize = 200;
    if name.len() > MAX_NAME_CHARS {
        return None;
    }
    let (score, best) = known.map(|k| (strsim::jaro_winkler(name, k), k)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (score >= MIN_SIMILARITY).then(|| best.to_owned())
}
