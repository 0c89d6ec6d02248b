//! How errors name things.

pub(crate) use crate::formula::nearest;
pub(crate) use crate::model::shown;

/// Names as a list in words: `` `a`, `b` or `c` ``.
pub(crate) fn listing<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = names.into_iter().map(|n| format!("`{n}`")).collect();
    match quoted.split_last() {
        None => "none".into(),
        Some((only, [])) => only.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}
