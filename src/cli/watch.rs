//! Commands that are carried out again whenever a file that they read has changed.
//!
//! Files are asked for their size, time and identity rather than listened to: that works on every file system, the
//! network's among them, and for editors that write a new file and rename it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

use super::outcome::{self, Result};
use super::{interrupt, print};
use crate::folders::{self, Sources};
use crate::scene::{Disk, Files};

/// Time between two looks at the files: too short to be noticed by who saves one, long enough to cost nothing.
const INTERVAL: Duration = Duration::from_millis(100);

/// What tells one content of a file from the next; none for a file that is not there.
type Stamp = Option<(u64, Option<SystemTime>, u64)>;

/// The files that a command reads, with their stamps from before it read them.
#[derive(Debug, Clone, Default)]
pub struct Watched {
    files: Arc<Mutex<BTreeMap<PathBuf, Stamp>>>,
    models: Arc<Mutex<Vec<PathBuf>>>,
}

impl Watched {
    /// A file that is about to be read.
    fn note(&self, file: &Path) {
        let mut files = locked(&self.files);
        files.entry(file.to_owned()).or_insert_with(|| stamp(file));
    }

    /// A model folder that is about to be read.
    pub fn note_model(&self, folder: &Path) {
        self.note(&folder.join("model.py"));
        let sources = folders::sources(folder).unwrap_or_default();
        for file in sources.python.iter().chain(&sources.read) {
            self.note(file);
        }
        locked(&self.models).push(folder.to_owned());
    }

    /// A file that is no longer what it was, if there is one: a new Python file of a model, too. What a derivation turns
    /// out to read is watched from then on.
    fn changed(&self) -> Option<PathBuf> {
        let models = locked(&self.models).clone();
        let sources = models
            .iter()
            .filter_map(|model| folders::sources(model).ok());
        let sources: Vec<Sources> = sources.collect();
        for file in sources.iter().flat_map(|sources| &sources.read) {
            self.note(file);
        }
        let files = locked(&self.files);
        let new = |file: &&PathBuf| !files.contains_key(*file);
        let new = sources.iter().flat_map(|s| &s.python).find(new);
        let other = || files.iter().find(|(file, old)| stamp(file) != **old);
        new.or_else(|| other().map(|(file, _)| file)).cloned()
    }
}

impl Files for Watched {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.note(path);
        Disk.read(path)
    }
}

/// A thread that panicked while it held the lock has left a map that is whole.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn stamp(file: &Path) -> Stamp {
    let data = fs::metadata(file).ok()?;
    #[cfg(unix)]
    let identity = std::os::unix::fs::MetadataExt::ino(&data);
    #[cfg(not(unix))]
    let identity = 0;
    Some((data.len(), data.modified().ok(), identity))
}

/// Carries a command out, and again whenever a file changes that it read, until a signal ends it; says after each time how
/// it ended. A simulation whose input changes meanwhile ends early.
pub fn whenever_changed(command: impl Fn(&Watched) -> Result) -> Result {
    loop {
        interrupt::up_to_date();
        let watched = Watched::default();
        let result = while_watched(&watched, || command(&watched));
        if interrupt::asked() {
            return result;
        }
        outcome::say(&result);
        print::error("\nwatching the scene and what it reads; Ctrl-C ends");
        interrupt::leave();
        let changed = loop {
            if let Some(file) = watched.changed() {
                break file;
            }
            thread::sleep(INTERVAL);
        };
        print::error(format!("{} has changed\n", changed.display()));
    }
}

/// Carries a command out while another thread looks at the files.
fn while_watched(watched: &Watched, command: impl FnOnce() -> Result) -> Result {
    let over = AtomicBool::new(false);
    thread::scope(|scope| {
        let watcher = scope.spawn(|| {
            while !over.load(Ordering::Relaxed) {
                if watched.changed().is_some() {
                    return interrupt::outdate();
                }
                thread::park_timeout(INTERVAL);
            }
        });
        let result = command();
        over.store(true, Ordering::Relaxed);
        watcher.thread().unpark();
        result
    })
}
