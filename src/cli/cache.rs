//! `dalembert cache`: what is kept of models that were built, and how much of it.

use std::collections::BTreeMap;

use dalembert_build::{Cache, Error, Item};
use serde_json::json;

use super::outcome::{Outcome, Result};
use super::print;
use super::table::Table;

#[derive(Debug, clap::Args)]
pub struct CacheArguments {
    /// Most bytes that are kept, such as `2GB` or `500MB`; what was used least recently goes first
    #[arg(long, value_name = "SIZE", value_parser = size)]
    limit: Option<u64>,
    /// Remove everything that no process uses now; it is made again when it is needed
    #[arg(long, conflicts_with = "limit")]
    clear: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn cache(arguments: &CacheArguments) -> Result {
    let cache = Cache::of_user()?.ok_or(Error::NoCache)?;
    let removed = match arguments.limit {
        Some(limit) => cache.set_limit(limit)?,
        None if arguments.clear => cache.evict(0)?,
        None => Vec::new(),
    };
    let items = cache.items()?;
    if arguments.json {
        let mut kinds = BTreeMap::<&str, (u64, u64)>::new();
        for item in &items {
            let (entries, bytes) = kinds.entry(&item.kind).or_default();
            *entries += 1;
            *bytes += item.bytes;
        }
        let kinds = kinds.iter().map(
            |(kind, (entries, bytes))| json!({ "kind": kind, "entries": entries, "bytes": bytes }),
        );
        let value = json!({
            "folder": cache.root(),
            "bytes": bytes(&items),
            "limit": cache.limit(),
            "removed": { "entries": removed.len(), "bytes": bytes(&removed) },
            "kinds": kinds.collect::<Vec<_>>(),
        });
        print::output(format_args!("{value:#}"))?;
        return Ok(Outcome::Done);
    }
    if !removed.is_empty() {
        let (count, freed) = (removed.len(), shown(bytes(&removed)));
        print::output(format_args!("removed {count} entries, {freed}"))?;
    }
    let mut table = Table::new(["what", "entries", "size"]);
    for (kind, meaning) in KINDS {
        let of_kind: Vec<Item> = items
            .iter()
            .filter(|item| item.kind == kind)
            .cloned()
            .collect();
        if !of_kind.is_empty() {
            let (count, size) = (of_kind.len().to_string(), shown(bytes(&of_kind)));
            table.row([meaning, count.as_str(), size.as_str()]);
        }
    }
    let others: Vec<Item> = (items.iter())
        .filter(|item| KINDS.iter().all(|(kind, _)| item.kind != *kind))
        .cloned()
        .collect();
    if !others.is_empty() {
        let (count, size) = (others.len().to_string(), shown(bytes(&others)));
        table.row(["of other versions", count.as_str(), size.as_str()]);
    }
    print::output(table)?;
    print::output(format_args!(
        "{}: {} of at most {}",
        cache.root().display(),
        shown(bytes(&items)),
        shown(cache.limit())
    ))?;
    Ok(Outcome::Done)
}

/// What the folders of the cache hold.
const KINDS: [(&str, &str); 6] = [
    ("python", "Python packages"),
    ("generator", "generators"),
    ("code", "C of crates"),
    ("models", "what models depend on"),
    ("derived", "C of model folders"),
    ("shared", "libraries of model folders"),
];

fn bytes(items: &[Item]) -> u64 {
    items.iter().map(|item| item.bytes).sum()
}

/// A size for people.
fn shown(bytes: u64) -> String {
    let units = [(1_000_000_000, "GB"), (1_000_000, "MB"), (1_000, "kB")];
    for (unit, name) in units {
        if bytes >= unit {
            let value = bytes as f64 / unit as f64;
            return format!("{value:.1} {name}");
        }
    }
    format!("{bytes} B")
}

/// A size in bytes: a number, with a unit of thousands.
fn size(text: &str) -> std::result::Result<u64, String> {
    let digits = text
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let factor = match unit.trim().to_ascii_uppercase().as_str() {
        "" | "B" => 1,
        "KB" => 1_000,
        "MB" => 1_000_000,
        "GB" => 1_000_000_000,
        _ => return Err("expected a whole number with B, kB, MB or GB, such as `2GB`".to_owned()),
    };
    let number: Option<u64> = number.parse().ok();
    let bytes = number.and_then(|number| number.checked_mul(factor));
    bytes.ok_or_else(|| "expected a whole number with B, kB, MB or GB, such as `2GB`".to_owned())
}
