//! Names that were mistyped.

/// The known name nearest to a mistyped one, if one is near.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Names of which at least half agree: nearer ones are typing mistakes, farther ones chance.
    const NEAR: f64 = 0.5;
    let lower = name.to_lowercase();
    known
        .into_iter()
        .map(|k| {
            (
                strsim::normalized_damerau_levenshtein(&lower, &k.to_lowercase()),
                k,
            )
        })
        .filter(|(likeness, _)| *likeness >= NEAR)
        // The first of equally near ones, so that the answer does not depend on chance.
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
        .map(|(_, k)| k)
}
