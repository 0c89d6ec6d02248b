//! What the cache holds, and the removal of what was used least recently.

use std::fs::{self, File, OpenOptions};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::cache::{self, Cache, LOCK, PARTIAL, USED};
use super::error::Error;

/// File in the cache that holds its limit in bytes.
const LIMIT: &str = "limit";

/// Where no limit was set: ten times what the packages of Python take.
pub const DEFAULT_LIMIT: u64 = 4_000_000_000;

/// Something in the cache: an entry, or what was left of one that was being made.
#[derive(Debug, Clone)]
pub struct Item {
    /// What kind it is: the name of its sub-folder.
    pub kind: String,
    /// Its key.
    pub key: String,
    /// Its size in bytes.
    pub bytes: u64,
    /// When it was last used.
    pub used: SystemTime,
    path: PathBuf,
}

impl Cache {
    /// All that it holds, least recently used first.
    pub fn items(&self) -> Result<Vec<Item>, Error> {
        let mut items = Vec::new();
        for folder in cache::list(self.root())?
            .iter()
            .filter(|path| path.is_dir())
        {
            let kind = name(folder);
            for path in cache::list(folder)? {
                if [USED, LOCK]
                    .iter()
                    .any(|ending| path.extension().is_some_and(|e| e == *ending))
                {
                    continue;
                }
                // Another process may remove it now: then it is not there.
                let Ok(data) = fs::metadata(&path) else {
                    continue;
                };
                let key = name(&path);
                let key = key
                    .strip_suffix(&format!(".{PARTIAL}"))
                    .unwrap_or(&key)
                    .to_owned();
                let mark = fs::metadata(folder.join(format!("{key}.{USED}")));
                let used = mark.as_ref().unwrap_or(&data).modified();
                items.push(Item {
                    kind: kind.clone(),
                    key,
                    bytes: size(&path),
                    used: used.unwrap_or(SystemTime::UNIX_EPOCH),
                    path,
                });
            }
        }
        items.sort_by_key(|item| item.used);
        Ok(items)
    }

    /// The limit of its size, in bytes.
    pub fn limit(&self) -> u64 {
        let text = fs::read_to_string(self.root().join(LIMIT));
        let limit = text.ok().and_then(|text| text.trim().parse().ok());
        limit.unwrap_or(DEFAULT_LIMIT)
    }

    /// Sets the limit, and removes what is beyond it; returns what was removed.
    pub fn set_limit(&self, bytes: u64) -> Result<Vec<Item>, Error> {
        let path = self.root().join(LIMIT);
        fs::write(&path, format!("{bytes}\n")).map_err(Error::io("write", &path))?;
        self.evict(bytes)
    }

    /// Removes what was used least recently, until no more than so many bytes are left; never what a process uses or
    /// makes. Returns what was removed.
    pub fn evict(&self, bytes: u64) -> Result<Vec<Item>, Error> {
        let items = self.items()?;
        let mut total: u64 = items.iter().map(|item| item.bytes).sum();
        let mut removed = Vec::new();
        for item in items {
            if total <= bytes {
                break;
            }
            if item.remove()? {
                total -= item.bytes;
                removed.push(item);
            }
        }
        Ok(removed)
    }
}

impl Item {
    /// Removes it, unless somebody uses or makes it.
    fn remove(&self) -> Result<bool, Error> {
        let Some(parent) = self.path.parent() else {
            return Ok(false);
        };
        let beside = |ending: &str| parent.join(format!("{}.{ending}", self.key));
        let (used, lock) = (beside(USED), beside(LOCK));
        let Some(_locks) = free(&lock)?.zip(free(&used)?) else {
            return Ok(false);
        };
        if self.path.is_dir() {
            // Under its name it is whole at any moment.
            let partial = beside(PARTIAL);
            if self.path != partial {
                cache::remove(&partial)?;
                fs::rename(&self.path, &partial).map_err(Error::io("remove", &self.path))?;
            }
            cache::remove(&partial)?;
        } else {
            fs::remove_file(&self.path).map_err(Error::io("remove", &self.path))?;
        }
        if cfg!(unix) {
            for path in [used, lock] {
                fs::remove_file(&path).map_err(Error::io("remove", &path))?;
            }
        }
        Ok(true)
    }
}

/// The lock of a file, if nobody holds it.
fn free(path: &Path) -> Result<Option<File>, Error> {
    let file = (OpenOptions::new().create(true).append(true).open(path))
        .map_err(Error::io("create", path))?;
    Ok((file.try_lock().is_ok() && cache::has_name(&file, path)).then_some(file))
}

fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// Bytes of all files; what another process removes meanwhile counts nothing.
fn size(path: &Path) -> u64 {
    if fs::symlink_metadata(path).is_ok_and(|data| data.is_dir()) {
        let entries = fs::read_dir(path).into_iter().flatten().flatten();
        entries.map(|entry| size(&entry.path())).sum()
    } else {
        fs::symlink_metadata(path).map_or(0, |data| data.len())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::time::{Duration, SystemTime};

    use super::super::cache::{Compares, Kind};
    use super::*;

    const KIND: Kind = Kind {
        name: "things",
        compares: Compares::Digests,
    };

    /// An empty cache, in a folder of the test's own.
    fn empty(test: &str) -> Cache {
        let root = std::env::temp_dir().join(format!("dalembert-{}-{test}", std::process::id()));
        let _ = fs::remove_dir_all(&root);
        fs::create_dir_all(&root).unwrap();
        Cache::at(&root)
    }

    fn thing(cache: &Cache, key: &str, age: u64) -> cache::Entry {
        let entry = cache.entry(KIND, key, |folder| {
            fs::write(folder.join("file"), vec![b'x'; 1000]).unwrap();
            Ok(())
        });
        let mark = cache.root().join(format!("things/{key}.used"));
        let time = SystemTime::now() - Duration::from_secs(age);
        File::options()
            .append(true)
            .open(mark)
            .unwrap()
            .set_modified(time)
            .unwrap();
        entry.unwrap()
    }

    fn keys(items: &[Item]) -> Vec<&str> {
        items.iter().map(|item| item.key.as_str()).collect()
    }

    #[test]
    fn the_least_recently_used_goes_first_and_what_is_in_use_stays() {
        let cache = empty("least");
        drop(thing(&cache, "new", 10));
        let in_use = thing(&cache, "oldest", 1000);
        drop(thing(&cache, "old", 100));
        assert_eq!(keys(&cache.items().unwrap()), ["oldest", "old", "new"]);
        let one = cache.items().unwrap()[0].bytes;
        assert!(one > 1000);
        assert_eq!(keys(&cache.set_limit(2 * one).unwrap()), ["old"]);
        assert_eq!(cache.limit(), 2 * one);
        assert_eq!(keys(&cache.evict(0).unwrap()), ["new"]);
        assert!(in_use.path.join("file").is_file());
        drop(in_use);
        assert_eq!(keys(&cache.evict(0).unwrap()), ["oldest"]);
        assert!(
            cache::list(&cache.root().join("things"))
                .unwrap()
                .is_empty()
        );
        fs::remove_dir_all(cache.root()).unwrap();
    }

    #[test]
    fn what_a_killed_process_left_is_removed_and_what_is_being_made_is_not() {
        let cache = empty("left");
        cache.staging(KIND, "left").unwrap();
        let lock = cache.lock(KIND, "made").unwrap();
        let made = cache.staging(KIND, "made").unwrap();
        fs::write(made.join("file"), "x").unwrap();
        fs::write(cache.root().join("things/left.partial/file"), "x").unwrap();
        assert_eq!(keys(&cache.evict(0).unwrap()), ["left"]);
        drop(lock);
        assert_eq!(keys(&cache.evict(0).unwrap()), ["made"]);
        fs::remove_dir_all(cache.root()).unwrap();
    }
}
