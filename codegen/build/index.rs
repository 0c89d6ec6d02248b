//! What is known of a model folder since it was run last: its choices, and the files it read besides its Python.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::cache::Cache;
use super::error::Error;
use super::library::Choices;

/// Folder of the cache that holds indices.
const FOLDER: &str = "models";

/// The variants of a library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Combination {
    /// All.
    All,
    /// One, by its place among the combinations.
    One(usize),
}

impl Combination {
    /// As a part of a key.
    pub fn text(self) -> String {
        match self {
            Combination::All => "all".to_owned(),
            Combination::One(place) => place.to_string(),
        }
    }
}

/// What a run of the generator found out.
#[derive(Debug)]
pub struct Index {
    /// Files that were read, relative to the model folder where they are in it; sorted.
    pub read: Vec<PathBuf>,
    /// Names of the choices.
    choices: Vec<String>,
    /// For each combination the options, by the choices, and whether they are the defaults.
    combinations: Vec<Vec<(String, bool)>>,
}

impl Index {
    /// What the generator wrote into a folder for the model in `origin`.
    pub fn of(folder: &Path, origin: &Path) -> Result<Self, Error> {
        let json = |name: &str| -> Option<Value> {
            serde_json::from_slice(&fs::read(folder.join(name)).ok()?).ok()
        };
        let parsed = json("manifest.json").zip(json("reads.json"));
        let parsed = parsed.and_then(|(manifest, read)| Self::parse(&manifest, &read));
        parsed.ok_or_else(|| Error::Manifest {
            folder: origin.display().to_string(),
            problem: "no list of choices and of files that were read".to_owned(),
        })
    }

    /// What is in the cache under a key. One that is not there and one that is damaged are the same: it is made again.
    pub fn read(cache: &Cache, key: &str) -> Option<Self> {
        let text = fs::read(cache.root().join(FOLDER).join(key)).ok()?;
        let value: Value = serde_json::from_slice(&text).ok()?;
        Self::parse(&value, &value["read"])
    }

    fn parse(value: &Value, read: &Value) -> Option<Self> {
        let texts = |list: &Value| -> Option<Vec<String>> {
            let text = |item: &Value| item.as_str().map(str::to_owned);
            list.as_array()?.iter().map(text).collect()
        };
        let choices = value["choices"].as_array()?.iter();
        let combination = |value: &Value| -> Option<Vec<(String, bool)>> {
            let defaults = value["defaults"].as_array()?.iter();
            let defaults: Option<Vec<bool>> = defaults.map(Value::as_bool).collect();
            Some(
                texts(&value["options"])?
                    .into_iter()
                    .zip(defaults?)
                    .collect(),
            )
        };
        let combinations = value["combinations"].as_array()?.iter();
        Some(Self {
            read: texts(read)?.into_iter().map(PathBuf::from).collect(),
            choices: (choices.map(|choice| choice["name"].as_str().map(str::to_owned)))
                .collect::<Option<_>>()?,
            combinations: combinations.map(combination).collect::<Option<_>>()?,
        })
    }

    /// Writes it into the cache. The lock of the key is held.
    pub fn write(&self, cache: &Cache, key: &str) -> Result<(), Error> {
        let name = |name: &String| json!({ "name": name });
        let combination = |pairs: &Vec<(String, bool)>| {
            let (options, defaults): (Vec<_>, Vec<_>) = pairs.iter().cloned().unzip();
            json!({ "options": options, "defaults": defaults })
        };
        let text = json!({
            "read": self.read,
            "choices": self.choices.iter().map(name).collect::<Vec<_>>(),
            "combinations": self.combinations.iter().map(combination).collect::<Vec<_>>(),
        });
        let folder = cache.root().join(FOLDER);
        let (path, partial) = (folder.join(key), folder.join(format!("{key}.partial")));
        fs::create_dir_all(&folder).map_err(Error::io("create", &folder))?;
        fs::write(&partial, text.to_string()).map_err(Error::io("write", &partial))?;
        fs::rename(&partial, &path).map_err(Error::io("create", &path))
    }

    /// The combination that fits, as `fitting` in `combinations.py` has it.
    pub fn combination(&self, choices: &Choices) -> Combination {
        let Choices::Fitting(named) = choices else {
            return Combination::All;
        };
        let fits = |named: &dyn Fn(&str) -> Option<String>| {
            self.combinations.iter().position(|pairs| {
                (self.choices.iter().zip(pairs)).all(|(choice, (option, is_default))| {
                    named(choice).map_or(*is_default, |wanted| wanted == *option)
                })
            })
        };
        let place = fits(&|choice| named.get(choice).cloned()).or_else(|| fits(&|_| None));
        Combination::One(place.unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde_json::json;

    use super::{Combination, Index};
    use crate::Choices;

    #[test]
    fn the_combination_that_fits_is_found() {
        let value = json!({
            "choices": [{"name": "law"}, {"name": "base"}],
            "combinations": [
                {"options": ["a", "held"], "defaults": [true, true]},
                {"options": ["a", "free"], "defaults": [true, false]},
                {"options": ["b", "free"], "defaults": [false, true]},
            ],
        });
        let index = Index::parse(&value, &json!([])).unwrap();
        let one = |pairs: &[(&str, &str)]| {
            let pairs = pairs
                .iter()
                .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()));
            index.combination(&Choices::Fitting(pairs.collect::<BTreeMap<_, _>>()))
        };
        assert_eq!(one(&[]), Combination::One(0));
        assert_eq!(one(&[("base", "free")]), Combination::One(1));
        // Its default is that of what was chosen before.
        assert_eq!(
            one(&[("law", "b"), ("method", "radau")]),
            Combination::One(2)
        );
        // There is none: the defaults, and the scene's reader says why.
        assert_eq!(one(&[("law", "b"), ("base", "held")]), Combination::One(0));
        assert_eq!(index.combination(&Choices::All), Combination::All);
    }
}
