//! Folders that are expensive to make, kept under a key that says what they were made from.
//!
//! An entry is filled in a temporary sibling, listed in an inventory, and renamed into place under
//! a file lock. So it is there whole or not at all, and of two builds that want it at once one
//! makes it and the other waits. An entry from which something was deleted later no longer agrees
//! with its inventory and is made again.

use std::env;
use std::fs::{self, File, OpenOptions};
use std::path::{self, Path, PathBuf};
use std::time::SystemTime;

use super::error::Error;

/// Variable that names the cache folder.
pub const SETTING: &str = "DALEMBERT_CACHE";

/// Name of the list of an entry's files and sizes. It is written last.
pub const INVENTORY: &str = "inventory";

/// A folder of entries, in one sub-folder per kind.
#[derive(Debug)]
pub struct Cache {
    root: PathBuf,
}

impl Cache {
    /// A cache in the folder `root`, which exists and is ours.
    pub fn at(root: &Path) -> Self {
        Self {
            root: root.to_owned(),
        }
    }

    /// The cache shared by all builds of this user: the folder that [`SETTING`] names, else the
    /// platform's folder for caches if it is writable, else a folder in cargo's target directory,
    /// of which `out_dir` is a part.
    pub fn shared(out_dir: &Path) -> Result<Self, Error> {
        if let Some(value) = env::var_os(SETTING).filter(|value| !value.is_empty()) {
            let refuse = |problem: std::io::Error| Error::Setting {
                name: SETTING,
                value: value.to_string_lossy().into_owned(),
                problem: format!("cannot write there: {problem}"),
                advice: "let it name a writable folder, or unset it".to_owned(),
            };
            let root = path::absolute(&value).map_err(refuse)?;
            claim(&root).map_err(refuse)?;
            return Ok(Self { root });
        }
        if let Some(root) = user_caches().map(|caches| caches.join("dalembert"))
            && claim(&root).is_ok()
        {
            return Ok(Self { root });
        }
        let root = target_dir(out_dir).join("dalembert-cache");
        claim(&root).map_err(Error::io("write to", &root))?;
        Ok(Self { root })
    }

    /// Whether the entry is there, whole.
    pub fn contains(&self, kind: &str, key: &str) -> bool {
        is_whole(&self.path(kind, key))
    }

    /// The folder of the entry `key`, made by `fill` (which gets an empty folder) if it is not
    /// there or not whole.
    pub fn entry(
        &self,
        kind: &str,
        key: &str,
        fill: impl FnOnce(&Path) -> Result<(), Error>,
    ) -> Result<PathBuf, Error> {
        let entry = self.path(kind, key);
        if is_whole(&entry) {
            return Ok(entry);
        }
        let folder = self.root.join(kind);
        fs::create_dir_all(&folder).map_err(Error::io("create", &folder))?;
        let lock_path = folder.join(format!("{key}.lock"));
        let lock = File::create(&lock_path).map_err(Error::io("create", &lock_path))?;
        // Held until the file is closed, by a crash too.
        lock.lock().map_err(Error::io("lock", &lock_path))?;
        if is_whole(&entry) {
            return Ok(entry);
        }
        let staging = folder.join(format!("{key}.partial"));
        remove(&staging)?;
        remove(&entry)?;
        fs::create_dir(&staging).map_err(Error::io("create", &staging))?;
        let filled = fill(&staging).and_then(|()| write_inventory(&staging));
        if let Err(error) = filled {
            remove(&staging)?;
            return Err(error);
        }
        fs::rename(&staging, &entry).map_err(Error::io("create", &entry))?;
        Ok(entry)
    }

    /// Removes the entries of a kind other than `keys`. For a cache that no other build uses.
    pub fn retain(&self, kind: &str, keys: &[String]) -> Result<(), Error> {
        for path in list(&self.root.join(kind))? {
            if path.is_dir() && !keys.iter().any(|key| path.ends_with(key)) {
                remove(&path)?;
            }
        }
        Ok(())
    }

    fn path(&self, kind: &str, key: &str) -> PathBuf {
        self.root.join(kind).join(key)
    }
}

/// The files and folders in a folder, sorted.
pub fn list(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut paths: Vec<_> = fs::read_dir(folder)
        .and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect())
        .map_err(Error::io("list", folder))?;
    paths.sort();
    Ok(paths)
}

/// The files in a folder and its sub-folders, sorted, except under folders that `skip` names.
pub fn files(folder: &Path, skip: &dyn Fn(&Path) -> bool) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    for path in list(folder)? {
        if skip(&path) {
            continue;
        } else if path.is_dir() {
            found.extend(files(&path, skip)?);
        } else {
            found.push(path);
        }
    }
    Ok(found)
}

/// Creates the folder and shows that files can be written in it.
fn claim(root: &Path) -> std::io::Result<()> {
    fs::create_dir_all(root)?;
    OpenOptions::new()
        .create(true)
        .append(true)
        .open(root.join("writable"))
        .map(drop)
}

/// The platform's folder for caches; `None` if the variables that lead to it are unset or lead to
/// nothing. A home folder that does not exist is not created.
fn user_caches() -> Option<PathBuf> {
    let folder = |name| {
        env::var_os(name)
            .map(PathBuf::from)
            .filter(|path| path.is_absolute())
    };
    let home = || folder("HOME").filter(|home| home.is_dir());
    if let Some(caches) = folder("XDG_CACHE_HOME") {
        Some(caches)
    } else if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Caches"))
    } else {
        home().map(|home| home.join(".cache"))
    }
}

/// Cargo's target directory, which cargo marks as a folder that backups may leave out.
fn target_dir(out_dir: &Path) -> &Path {
    out_dir
        .ancestors()
        .find(|folder| folder.join("CACHEDIR.TAG").is_file())
        .unwrap_or(out_dir)
}

/// The sizes and names of the files of an entry, a line each.
fn inventory(entry: &Path) -> Result<String, Error> {
    let inventory = entry.join(INVENTORY);
    let mut lines = String::new();
    for file in files(entry, &|path| path == inventory)? {
        let size = fs::metadata(&file).map_err(Error::io("read", &file))?.len();
        let name = file.strip_prefix(entry).unwrap_or(&file);
        lines += &format!("{size} {}\n", name.display());
    }
    Ok(lines)
}

/// Lists what an entry holds, in a file older than any build: cargo is told to watch it, and must
/// see it vanish but not appear.
fn write_inventory(entry: &Path) -> Result<(), Error> {
    let path = entry.join(INVENTORY);
    fs::write(&path, inventory(entry)?)
        .and_then(|()| File::options().write(true).open(&path))
        .and_then(|file| file.set_modified(SystemTime::UNIX_EPOCH))
        .map_err(Error::io("write", &path))
}

/// Whether an entry holds every file of its inventory, in its size. Files added since (bytecode,
/// say) do no harm.
fn is_whole(entry: &Path) -> bool {
    let Ok(inventory) = fs::read_to_string(entry.join(INVENTORY)) else {
        return false;
    };
    inventory.lines().all(|line| {
        line.split_once(' ').is_some_and(|(size, name)| {
            fs::metadata(entry.join(name)).is_ok_and(|file| Ok(file.len()) == size.parse())
        })
    })
}

/// Removes a folder, if it is there.
fn remove(folder: &Path) -> Result<(), Error> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::io("remove", folder)(error))
        }
        _ => Ok(()),
    }
}
