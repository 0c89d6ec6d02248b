//! Folders that are expensive to make, kept under a key that says what they were made from.
//!
//! An entry is filled in a temporary sibling, listed in an inventory, written to the disk, and renamed
//! into place under a file lock. So it is there whole or not at all, and of two builds that want it at
//! once one makes it and the other waits. An entry in which something was changed or deleted later no
//! longer agrees with its inventory and is made again.

use std::env;
use std::fs::{self, File, OpenOptions};
use std::path::{self, Path, PathBuf};
use std::time::SystemTime;

use super::error::Error;
use super::fingerprint::Fingerprint;

/// Variable that names the cache folder.
pub const SETTING: &str = "DALEMBERT_CACHE";

/// Name of the list of an entry's files. It is written last.
pub const INVENTORY: &str = "inventory";

/// A kind of entries: a sub-folder, and what its inventories compare.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Name of the sub-folder.
    pub name: &'static str,
    /// What is compared.
    pub compares: Compares,
}

/// What an inventory knows of a file.
#[derive(Debug, Clone, Copy)]
pub enum Compares {
    /// A hash of its content.
    Digests,
    /// Its size: for what takes longer to read than a build, and was checked when it was installed.
    Sizes,
}

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
    pub fn contains(&self, kind: Kind, key: &str) -> bool {
        is_whole(&self.path(kind, key), kind.compares)
    }

    /// The folder of the entry `key`, made by `fill` (which gets an empty folder) if it is not
    /// there or not whole.
    pub fn entry(
        &self,
        kind: Kind,
        key: &str,
        fill: impl FnOnce(&Path) -> Result<(), Error>,
    ) -> Result<PathBuf, Error> {
        let entry = self.path(kind, key);
        if is_whole(&entry, kind.compares) {
            return Ok(entry);
        }
        let folder = self.root.join(kind.name);
        fs::create_dir_all(&folder).map_err(Error::io("create", &folder))?;
        let lock_path = folder.join(format!("{key}.lock"));
        let lock = File::create(&lock_path).map_err(Error::io("create", &lock_path))?;
        // Held until the file is closed, by a crash too.
        lock.lock().map_err(Error::io("lock", &lock_path))?;
        if is_whole(&entry, kind.compares) {
            return Ok(entry);
        }
        let staging = folder.join(format!("{key}.partial"));
        remove(&staging)?;
        remove(&entry)?;
        fs::create_dir(&staging).map_err(Error::io("create", &staging))?;
        let filled = fill(&staging).and_then(|()| write_inventory(&staging, kind.compares));
        if let Err(error) = filled {
            remove(&staging)?;
            return Err(error);
        }
        fs::rename(&staging, &entry).map_err(Error::io("create", &entry))?;
        sync_folder(&folder)?;
        Ok(entry)
    }

    /// Removes the entries of a kind other than `keys`. For a cache that no other build uses.
    pub fn retain(&self, kind: Kind, keys: &[String]) -> Result<(), Error> {
        for path in list(&self.root.join(kind.name))? {
            if path.is_dir() && !keys.iter().any(|key| path.ends_with(key)) {
                remove(&path)?;
            }
        }
        Ok(())
    }

    fn path(&self, kind: Kind, key: &str) -> PathBuf {
        self.root.join(kind.name).join(key)
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

/// What an inventory says of a file.
fn mark(file: &Path, compares: Compares) -> std::io::Result<String> {
    Ok(match compares {
        Compares::Digests => Fingerprint::default().with(fs::read(file)?).finish(),
        Compares::Sizes => fs::metadata(file)?.len().to_string(),
    })
}

/// Lists what an entry holds, a mark and a name a line, in a file older than any build: cargo is told to
/// watch it, and must see it vanish but not appear. All of it is on the disk before it gets its name.
fn write_inventory(entry: &Path, compares: Compares) -> Result<(), Error> {
    let inventory = entry.join(INVENTORY);
    let mut lines = String::new();
    for file in files(entry, &|path| path == inventory)? {
        let mark = mark(&file, compares).map_err(Error::io("read", &file))?;
        let name = file.strip_prefix(entry).unwrap_or(&file);
        lines += &format!("{mark} {}\n", name.display());
        (File::open(&file).and_then(|file| file.sync_all())).map_err(Error::io("write", &file))?;
    }
    fs::write(&inventory, lines)
        .and_then(|()| File::options().write(true).open(&inventory))
        .and_then(|file| {
            file.set_modified(SystemTime::UNIX_EPOCH)?;
            file.sync_all()
        })
        .map_err(Error::io("write", &inventory))
}

/// Writes the names in a folder to the disk, where a folder can be opened for that.
fn sync_folder(folder: &Path) -> Result<(), Error> {
    if cfg!(unix) {
        (File::open(folder).and_then(|folder| folder.sync_all()))
            .map_err(Error::io("write to", folder))?;
    }
    Ok(())
}

/// Whether an entry holds every file of its inventory, as it was. Files added since (bytecode, say) do
/// no harm.
fn is_whole(entry: &Path, compares: Compares) -> bool {
    let Ok(inventory) = fs::read_to_string(entry.join(INVENTORY)) else {
        return false;
    };
    inventory.lines().all(|line| {
        line.split_once(' ').is_some_and(|(known, name)| {
            mark(&entry.join(name), compares).is_ok_and(|found| found == known)
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
