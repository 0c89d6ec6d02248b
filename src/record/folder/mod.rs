//! The output folder: written aside, then put in place by one rename.
//!
//! Everything goes into a temporary folder beside the target, which then changes places with it
//! in one system call. Whoever looks at the target, at any moment and also after the program was
//! killed, sees either the old files or the new ones, whole. What a killed program can leave is
//! the temporary folder, `.NAME.XXXXXX`, which is safe to delete.
//!
//! A folder written here holds a marker, a list of the files written. Those may be replaced by a
//! later run; any other file is somebody else's and stays. Beside it are digests of the lines of these files, so that
//! a run that is continued is the one that was written.
//!
//! Files are on the disk before they are put in place. What a killed program has left beside the target is removed
//! by the next run into it: its lock is gone.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::digest::{Digesting, Digests, difference};
#[cfg(feature = "plots")]
use super::plot::{Format, Picture};

/// Name of the marker.
const MARKER: &str = ".dalembert-output";
/// Name of the file with the digests of the others.
const DIGESTS: &str = ".dalembert-digests";
/// A file that is locked as long as a folder is being written: the lock goes with its process.
const LOCK: &str = ".dalembert-writing";
/// First line of the marker.
const MARKER_TITLE: &str =
    "# dalembert wrote the files listed here; a later run into this folder replaces them.";

/// Why an output folder cannot be written. The folder is as it was before.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// The path is something else than a folder.
    #[error("{}: exists and is not a folder; choose another output folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// The folder holds files and no marker.
    #[error(
        "{}: this folder was not written by dalembert and is not empty (it holds `{entry}`); \
         choose another output folder, or move its files away",
        path.display()
    )]
    NotOurs {
        /// The folder.
        path: PathBuf,
        /// One of the entries found.
        entry: String,
    },
    /// A file that is about to be written is already there, and dalembert did not write it.
    #[error(
        "{}: the file `{file}` in this folder was not written by dalembert and would be replaced; \
         rename it, or choose another output folder",
        path.display()
    )]
    WouldReplace {
        /// The folder.
        path: PathBuf,
        /// The file.
        file: String,
    },
    /// The folder is the current one or holds it, so it cannot change places with another.
    #[error(
        "{}: the output folder must not be the current folder or one above it, since it is \
         replaced as a whole; choose a folder inside, such as `out`",
        path.display()
    )]
    HoldsCurrent {
        /// The folder.
        path: PathBuf,
    },
    /// The operating system refused something.
    #[error("{}: cannot {action}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// On which file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
}

/// A place where output may be written.
#[derive(Debug, Clone)]
pub struct OutputFolder {
    path: PathBuf,
}

/// The files on their way into an output folder.
#[derive(Debug)]
pub struct Staging {
    folder: TempDir,
    /// What is to be replaced.
    of: OutputFolder,
    /// The folder that it is in.
    parent: PathBuf,
    files: BTreeSet<String>,
    digests: Digests,
    /// Locked until the files are in place.
    _lock: File,
}

/// A file that is filled while others are.
#[derive(Debug)]
pub struct StagedFile {
    name: String,
    out: BufWriter<Digesting<File>>,
}

impl OutputFolder {
    /// Checks that `path` is a place where output may be written, and writes nothing: it does not
    /// exist, or is an empty folder, or was written by dalembert.
    pub fn new(path: &Path) -> Result<OutputFolder, FolderError> {
        let folder = OutputFolder {
            path: path.to_owned(),
        };
        folder.target()?;
        Ok(folder)
    }

    /// The path as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the output: `write` creates the files, and if it succeeds they take the place of
    /// those of the last run, all at once. Folders above are created as needed.
    pub fn replace(
        &self,
        write: impl FnOnce(&mut Staging) -> Result<(), FolderError>,
    ) -> Result<(), FolderError> {
        let mut staging = self.stage()?;
        write(&mut staging)?;
        staging.put_in_place()
    }

    /// A place for files, which take that of the last run's with [`Staging::put_in_place`]. Folders above are created
    /// as needed.
    pub fn stage(&self) -> Result<Staging, FolderError> {
        let target = self.target()?;
        let parent = match target.parent() {
            Some(parent) if parent != Path::new("") => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        fs::create_dir_all(&parent).map_err(io_error("create the folder", &parent))?;
        let name = target
            .file_name()
            .unwrap_or(OsStr::new("out"))
            .to_string_lossy();
        remove_left(&name, &parent);
        let folder = temporary_folder(&name, &parent)
            .map_err(io_error("create a folder inside", &parent))?;
        let lock = lock(folder.path()).map_err(io_error("lock a folder inside", &parent))?;
        let digests = Digests::create(&folder.path().join(DIGESTS))
            .map_err(io_error("write", Path::new(DIGESTS)))?;
        Ok(Staging {
            folder,
            of: self.clone(),
            parent,
            files: BTreeSet::new(),
            digests,
            _lock: lock,
        })
    }

    /// The folder to replace, symbolic links resolved, after the checks of [`OutputFolder::new`].
    fn target(&self) -> Result<PathBuf, FolderError> {
        let path = &self.path;
        if fs::symlink_metadata(path).is_err() {
            return Ok(path.clone());
        }
        let target = match path.canonicalize() {
            Ok(target) => target,
            // A symbolic link that leads nowhere.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(FolderError::NotAFolder { path: path.clone() });
            }
            Err(error) => return Err(io_error("read the folder", path)(error)),
        };
        if !target.is_dir() {
            return Err(FolderError::NotAFolder { path: path.clone() });
        }
        if std::env::current_dir().is_ok_and(|current| current.starts_with(&target)) {
            return Err(FolderError::HoldsCurrent { path: path.clone() });
        }
        let mut entries = fs::read_dir(&target).map_err(io_error("read the folder", path))?;
        match entries.next() {
            Some(entry) if !target.join(MARKER).is_file() => {
                let entry = entry
                    .map_err(io_error("read the folder", path))?
                    .file_name();
                let entry = entry.to_string_lossy().into_owned();
                Err(FolderError::NotOurs {
                    path: path.clone(),
                    entry,
                })
            }
            _ => Ok(target),
        }
    }
}

impl Staging {
    /// Creates a file; `write` fills it.
    pub fn file(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), FolderError> {
        let mut file = self.create(name)?;
        write(&mut file).map_err(io_error("write", Path::new(name)))?;
        self.close(file)
    }

    /// Writes a picture into the files that are called `stem` with the endings of the formats.
    #[cfg(feature = "plots")]
    pub fn picture(
        &mut self,
        stem: &str,
        picture: &Picture,
        formats: &[Format],
    ) -> Result<(), FolderError> {
        for &format in formats {
            let name = format!("{stem}.{}", format.ending());
            self.file(&name, |out| out.write_all(&picture.file(format)))?;
        }
        Ok(())
    }

    /// Creates a file that is filled while others are, until [`Staging::close`].
    pub fn create(&mut self, name: &str) -> Result<StagedFile, FolderError> {
        let file = File::create_new(self.folder.path().join(name));
        let file = file.map_err(io_error("write", Path::new(name)))?;
        Ok(StagedFile {
            name: name.to_owned(),
            out: BufWriter::new(Digesting::new(file, name, self.digests.clone())),
        })
    }

    /// Brings a file to the disk.
    pub fn close(&mut self, file: StagedFile) -> Result<(), FolderError> {
        let StagedFile { name, out } = file;
        let digesting = out.into_inner().map_err(io::IntoInnerError::into_error);
        digesting
            .and_then(Digesting::finish)
            .and_then(|file| file.sync_all())
            .map_err(io_error("write", Path::new(&name)))?;
        self.files.insert(name);
        Ok(())
    }

    /// Finishes the digests and writes the marker.
    fn mark(&mut self) -> Result<(), FolderError> {
        self.digests
            .sync()
            .map_err(io_error("write", Path::new(DIGESTS)))?;
        self.files.insert(DIGESTS.to_owned());
        let lines: Vec<String> = self.files.iter().map(|file| format!("{file}\n")).collect();
        let write = |path: &Path| {
            let mut out = File::create_new(path)?;
            out.write_all(format!("{MARKER_TITLE}\n{}", lines.concat()).as_bytes())?;
            out.sync_all()
        };
        let marker = self.folder.path().join(MARKER);
        write(&marker).map_err(io_error("write", Path::new(MARKER)))?;
        self.files.insert(MARKER.to_owned());
        Ok(())
    }

    /// Puts the files in the place of those of the last run, all at once.
    pub fn put_in_place(mut self) -> Result<(), FolderError> {
        self.mark()?;
        // What is there may have changed since files were begun.
        let (target, parent) = (&self.of.target()?, &self.parent);
        let new = self.folder.path();
        sync(new).map_err(io_error("write", new))?;
        if fs::symlink_metadata(target).is_err() {
            fs::rename(new, target).map_err(io_error("create the folder", target))?;
            // The folder has moved: there is nothing left to clean up at its old path.
            let _ = self.folder.keep();
            let _ = fs::remove_file(target.join(LOCK));
            return sync(parent).map_err(io_error("write", parent));
        }
        let ours = ours(target)?;
        if let Some(file) = self
            .files
            .iter()
            .find(|f| !ours.contains(*f) && target.join(f).exists())
        {
            return Err(FolderError::WouldReplace {
                path: target.clone(),
                file: file.clone(),
            });
        }
        let permissions = fs::metadata(target)
            .map_err(io_error("read", target))?
            .permissions();
        fs::set_permissions(new, permissions).map_err(io_error("set the permissions of", new))?;
        keep_foreign(target, new, &ours).map_err(io_error("copy other files of", target))?;
        exchange(new, target).map_err(io_error("replace the folder", target))?;
        let _ = fs::remove_file(target.join(LOCK));
        sync(parent).map_err(io_error("write", parent))?;
        // `new` is now the path of the old folder. Foreign files that appeared there meanwhile:
        keep_foreign(new, target, &ours).map_err(io_error("copy other files of", new))?;
        self.folder
            .close()
            .map_err(io_error("remove the old output of", target))
    }
}

impl Write for StagedFile {
    fn write(&mut self, content: &[u8]) -> io::Result<usize> {
        self.out.write(content)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

pub(super) fn io_error(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> FolderError {
    let path = path.to_owned();
    move |source| FolderError::Io {
        action,
        path,
        source,
    }
}

/// The files of a folder that dalembert wrote; none in an empty folder.
fn ours(folder: &Path) -> Result<BTreeSet<String>, FolderError> {
    let path = folder.join(MARKER);
    let marker = match fs::read_to_string(&path) {
        Ok(marker) => marker,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(BTreeSet::new()),
        Err(error) => return Err(io_error("read", &path)(error)),
    };
    let files = marker.lines().skip(1).map(str::to_owned);
    let own = [MARKER, LOCK].map(str::to_owned);
    Ok(files.chain(own).collect())
}

/// Compares a file of a folder with the digests that were written with it; an error says what differs.
pub(super) fn check(folder: &Path, name: &str) -> Result<(), String> {
    match difference(&folder.join(DIGESTS), name, &folder.join(name))? {
        None => Ok(()),
        Some(difference) => Err(difference),
    }
}

/// Brings the entries of a folder to the disk.
fn sync(folder: &Path) -> io::Result<()> {
    match cfg!(unix) {
        true => File::open(folder)?.sync_all(),
        false => Ok(()),
    }
}

/// Locks a new temporary folder. The file has content only once it is locked.
fn lock(folder: &Path) -> io::Result<File> {
    let mut file = File::create_new(folder.join(LOCK))?;
    file.lock()?;
    file.write_all(b"This folder is being written.\n")?;
    Ok(file)
}

/// Removes the temporary folders beside the target that killed programs have left. What cannot be removed stays.
fn remove_left(name: &str, parent: &Path) {
    let prefix = format!(".{name}.");
    let entries = fs::read_dir(parent).into_iter().flatten().flatten();
    for entry in entries.filter(|e| e.file_type().is_ok_and(|kind| kind.is_dir())) {
        let is_temporary = entry.file_name().to_str().is_some_and(|found| {
            let rest = found.strip_prefix(&prefix).unwrap_or_default();
            rest.len() == RANDOM && rest.chars().all(|c| c.is_ascii_alphanumeric())
        });
        if is_temporary && is_left(&entry.path()) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Whether nobody writes a temporary folder any more: its lock is free, or it is the old output, which nobody needs.
fn is_left(folder: &Path) -> bool {
    match File::open(folder.join(LOCK)) {
        Ok(file) => {
            let is_locked_for_good = file.metadata().is_ok_and(|m| m.len() > 0);
            is_locked_for_good && file.try_lock().is_ok()
        }
        Err(_) => folder.join(MARKER).is_file(),
    }
}

/// Letters and digits at the end of the name of a temporary folder.
const RANDOM: usize = 6;

/// A new folder beside the target, with the permissions of any new folder.
fn temporary_folder(name: &str, parent: &Path) -> io::Result<TempDir> {
    let prefix = format!(".{name}.");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).rand_bytes(RANDOM);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o777)); // less the umask
    }
    builder.tempdir_in(parent)
}

/// Brings every entry of `from` that is not `ours` into `to`, where it is not yet there. Files are
/// linked, so that they stay the same files.
fn keep_foreign(from: &Path, to: &Path, ours: &BTreeSet<String>) -> io::Result<()> {
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (source, copy) = (entry.path(), to.join(entry.file_name()));
        let is_ours = entry
            .file_name()
            .to_str()
            .is_some_and(|name| ours.contains(name));
        if is_ours {
            continue;
        }
        if entry.file_type()?.is_dir() {
            if !copy.exists() {
                fs::create_dir(&copy)?;
            }
            keep_foreign(&source, &copy, &BTreeSet::new())?;
            fs::set_permissions(&copy, entry.metadata()?.permissions())?;
        } else if fs::symlink_metadata(&copy).is_err() {
            // Linux links symbolic links themselves; where a file cannot be linked it is copied.
            fs::hard_link(&source, &copy).or_else(|_| fs::copy(&source, &copy).map(drop))?;
        }
    }
    Ok(())
}

/// Lets two folders change places in one step, where system and file system can.
fn exchange(a: &Path, b: &Path) -> io::Result<()> {
    #[cfg(any(target_os = "linux", target_vendor = "apple"))]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        use rustix::io::Errno;
        match renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE) {
            Ok(()) => return Ok(()),
            Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP) => {} // some network file systems
            Err(error) => return Err(error.into()),
        }
    }
    exchange_in_steps(a, b)
}

/// The same in three renames. Between the first and the second there is nothing at `b`; both
/// folders are whole all the time.
fn exchange_in_steps(a: &Path, b: &Path) -> io::Result<()> {
    let mut aside = a.as_os_str().to_owned();
    aside.push(".old");
    fs::rename(b, &aside)?;
    if let Err(error) = fs::rename(a, b) {
        fs::rename(&aside, b)?;
        return Err(error);
    }
    fs::rename(&aside, a)
}

#[cfg(test)]
mod tests;
