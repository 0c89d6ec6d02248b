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

/// Endings of what stands beside an entry: the mark that it is in use, and what is being made.
pub const USED: &str = "used";
pub const PARTIAL: &str = "partial";

/// Ending of the lock of whoever makes it.
pub const LOCK: &str = "lock";

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

/// An entry in use: it is not evicted while this is held.
#[derive(Debug)]
pub struct Entry {
    /// Its folder.
    pub path: PathBuf,
    #[expect(dead_code, reason = "held, never asked")]
    used: File,
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

    /// The cache shared by all builds of this user: the folder that `DALEMBERT_CACHE` names, else the
    /// platform's folder for caches if it is writable, else a folder in cargo's target directory,
    /// of which `out_dir` is a part.
    pub fn shared(out_dir: &Path) -> Result<Self, Error> {
        if let Some(cache) = Self::of_user()? {
            return Ok(cache);
        }
        let root = target_dir(out_dir).join("dalembert-cache");
        claim(&root).map_err(Error::io("write to", &root))?;
        Ok(Self { root })
    }

    /// The same where there is no target directory: `None` if neither folder is there.
    pub fn of_user() -> Result<Option<Self>, Error> {
        if let Some(value) = env::var_os(SETTING).filter(|value| !value.is_empty()) {
            let refuse = |problem: std::io::Error| Error::Setting {
                name: SETTING,
                value: value.to_string_lossy().into_owned(),
                problem: format!("cannot write there: {problem}"),
                advice: "let it name a writable folder, or unset it".to_owned(),
            };
            let root = path::absolute(&value).map_err(refuse)?;
            claim(&root).map_err(refuse)?;
            return Ok(Some(Self { root }));
        }
        let root = user_caches().map(|caches| caches.join("dalembert"));
        let root = root.filter(|root| claim(root).is_ok());
        Ok(root.map(|root| Self { root }))
    }

    /// Whether the entry is there, whole.
    pub fn contains(&self, kind: Kind, key: &str) -> bool {
        is_whole(&self.path(kind, key), kind.compares)
    }

    /// The entry `key`, made by `fill` (which gets an empty folder) if it is not there or not whole.
    pub fn entry(
        &self,
        kind: Kind,
        key: &str,
        fill: impl FnOnce(&Path) -> Result<(), Error>,
    ) -> Result<Entry, Error> {
        let entry = Entry {
            path: self.path(kind, key),
            used: self.used(kind, key)?,
        };
        if is_whole(&entry.path, kind.compares) {
            return Ok(entry);
        }
        let _lock = self.lock(kind, key)?;
        if is_whole(&entry.path, kind.compares) {
            return Ok(entry);
        }
        let staging = self.staging(kind, key)?;
        remove(&entry.path)?;
        let filled = fill(&staging).and_then(|()| write_inventory(&staging, kind.compares));
        if let Err(error) = filled {
            self.unstage(kind, key)?;
            return Err(error);
        }
        fs::rename(&staging, &entry.path).map_err(Error::io("create", &entry.path))?;
        self.unstage(kind, key)?;
        sync_folder(&self.root.join(kind.name))?;
        Ok(entry)
    }

    /// The entry `key`, if it is there, whole.
    pub fn find(&self, kind: Kind, key: &str) -> Result<Option<Entry>, Error> {
        if !self.path(kind, key).is_dir() {
            return Ok(None);
        }
        let entry = Entry {
            path: self.path(kind, key),
            used: self.used(kind, key)?,
        };
        Ok(is_whole(&entry.path, kind.compares).then_some(entry))
    }

    /// The lock of whoever makes an entry, held until the file is closed, by a crash too.
    pub fn lock(&self, kind: Kind, key: &str) -> Result<File, Error> {
        locked(&self.beside(kind, key, LOCK)?, File::lock)
    }

    /// The mark that an entry is in use, held until the file is closed. Its time tells when it was last.
    fn used(&self, kind: Kind, key: &str) -> Result<File, Error> {
        let path = self.beside(kind, key, USED)?;
        let used = locked(&path, File::lock_shared)?;
        (used.set_modified(SystemTime::now())).map_err(Error::io("write", &path))?;
        Ok(used)
    }

    /// An empty folder for what becomes an entry. Whoever asks for it holds the lock of its key. Its path is that of no other
    /// process: programs that a killed one had started may still write.
    pub fn staging(&self, kind: Kind, key: &str) -> Result<PathBuf, Error> {
        self.unstage(kind, key)?;
        let staging = self.beside(kind, key, PARTIAL)?;
        let staging = staging.join(std::process::id().to_string());
        fs::create_dir_all(&staging).map_err(Error::io("create", &staging))?;
        Ok(staging)
    }

    /// Removes what is being made. Whoever asks for it holds the lock of its key.
    pub fn unstage(&self, kind: Kind, key: &str) -> Result<(), Error> {
        remove(&self.beside(kind, key, PARTIAL)?)
    }

    /// A path beside an entry, in the folder of its kind, which is there.
    fn beside(&self, kind: Kind, key: &str, what: &str) -> Result<PathBuf, Error> {
        let folder = self.root.join(kind.name);
        fs::create_dir_all(&folder).map_err(Error::io("create", &folder))?;
        Ok(folder.join(format!("{key}.{what}")))
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

    /// Where entries are.
    pub fn root(&self) -> &Path {
        &self.root
    }

    fn path(&self, kind: Kind, key: &str) -> PathBuf {
        self.root.join(kind.name).join(key)
    }
}

/// Creates a file and locks it. Whoever removes lock files holds their locks, and what was locked may be a file without a name
/// then.
fn locked(path: &Path, lock: fn(&File) -> std::io::Result<()>) -> Result<File, Error> {
    loop {
        let file = (OpenOptions::new().create(true).append(true).open(path))
            .map_err(Error::io("create", path))?;
        lock(&file).map_err(Error::io("lock", path))?;
        if has_name(&file, path) {
            return Ok(file);
        }
    }
}

/// Whether a name leads to a file that is open. Where that cannot be asked no lock files are removed.
#[cfg(unix)]
pub fn has_name(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |data: fs::Metadata| (data.dev(), data.ino());
    (file.metadata().map(id).ok()).is_some_and(|own| fs::metadata(path).map(id).ok() == Some(own))
}

#[cfg(not(unix))]
pub fn has_name(_: &File, _: &Path) -> bool {
    true
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
pub fn remove(folder: &Path) -> Result<(), Error> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::io("remove", folder)(error))
        }
        _ => Ok(()),
    }
}
