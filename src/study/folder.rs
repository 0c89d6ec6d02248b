//! The folder of a study: what is finished while it goes on, and its files in the end.
//!
//! `.study/` holds the key, a lock and a file a half second with the cases finished in it. Each file is written aside and
//! renamed, so a program that is killed loses what it computed since. The files of the result are written the same way,
//! `summary.json` last; `.study/parts` goes after that.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::rows::{self, Row, Unusable};

/// What belongs to a study that goes on.
const INNER: &str = ".study";
const PARTS: &str = "parts";
const KEY: &str = "key";
const LOCK: &str = "lock";
/// First line of the key's file: the format of what is inside.
const FORMAT: &str = "dalembert study, format 1";
/// The file that is written last.
pub(crate) const SUMMARY: &str = "summary.json";

/// Why a folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StudyFolderError {
    #[error("{}: cannot {action}: {source}", path.display())]
    Io {
        action: &'static str,
        path: PathBuf,
        source: io::Error,
    },
    #[error("{}: exists and is not a folder; choose another output folder", path.display())]
    NotAFolder { path: PathBuf },
    #[error(
        "{}: this folder holds no study and is not empty (it holds `{entry}`); choose another output folder, or move its \
         files away",
        path.display()
    )]
    NotAStudy { path: PathBuf, entry: String },
    #[error("{}: there is a study here; go on with it by --resume, or choose another output folder", path.display())]
    Begun { path: PathBuf },
    #[error("{}: there is no study here to go on with; leave --resume out", path.display())]
    NoStudy { path: PathBuf },
    #[error(
        "{}: this is another study: its {what} differs; choose another output folder, or go on with what it was begun with",
        path.display()
    )]
    Other { path: PathBuf, what: &'static str },
    #[error("{}: another program is writing this study; wait for it, or choose another output folder", path.display())]
    Locked { path: PathBuf },
    #[error("{}: this file is damaged; delete it, and --resume computes its runs again", path.display())]
    Damaged { path: PathBuf },
    #[error(
        "{}: a study of another version of dalembert ({found}); go on with that version, or choose another output folder",
        path.display()
    )]
    Version { path: PathBuf, found: String },
}

type Result<T> = std::result::Result<T, StudyFolderError>;

fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> StudyFolderError {
    let path = path.to_owned();
    move |source| StudyFolderError::Io {
        action,
        path,
        source,
    }
}

/// The cases that are finished, each with its rows.
pub(crate) type Finished = BTreeMap<u64, Vec<Row>>;

/// A study's folder, which nobody else writes meanwhile.
#[derive(Debug)]
pub(crate) struct StudyFolder {
    path: PathBuf,
    key: String,
    /// Locked as long as the folder is in use; the lock goes with its process.
    _lock: File,
    /// Number of the next file of finished cases.
    next: u64,
}

/// What a file of a key says.
fn key_text(key: &str) -> String {
    format!("{FORMAT}\n{}\n{key}\n", env!("CARGO_PKG_VERSION"))
}

/// The key in a folder; an error where another version has written it, or it has another key.
fn check_key(path: &Path, key: &str) -> Result<()> {
    let file = path.join(INNER).join(KEY);
    let text = fs::read_to_string(&file).map_err(failed("read", &file))?;
    let found: Vec<&str> = text.lines().collect();
    let version = env!("CARGO_PKG_VERSION");
    let path = path.to_owned();
    match found[..] {
        [FORMAT, found, _] if found != version => Err(StudyFolderError::Version {
            path,
            found: found.to_owned(),
        }),
        [FORMAT, _, found] if found == key => Ok(()),
        [FORMAT, _, _] => Err(StudyFolderError::Other {
            path,
            what: "model, scene or design",
        }),
        _ => Err(StudyFolderError::Version {
            path,
            found: found.first().copied().unwrap_or("an empty key").to_owned(),
        }),
    }
}

impl StudyFolder {
    /// A folder for a study that begins, or, to `resume`, one that was begun with the same key. The folder is made if it is not
    /// there.
    pub fn open(path: &Path, key: &str, resume: bool) -> Result<StudyFolder> {
        let is_study = path.join(INNER).join(KEY).is_file();
        match (is_study, resume) {
            (true, false) => {
                return Err(StudyFolderError::Begun {
                    path: path.to_owned(),
                });
            }
            (false, true) => {
                return Err(StudyFolderError::NoStudy {
                    path: path.to_owned(),
                });
            }
            (true, true) => check_key(path, key)?,
            (false, false) => check_empty(path)?,
        }
        let inner = path.join(INNER);
        let parts = inner.join(PARTS);
        fs::create_dir_all(&parts).map_err(failed("create the folder", &parts))?;
        let lock = inner.join(LOCK);
        let file = File::options().create(true).append(true).open(&lock);
        let file = file.map_err(failed("write", &lock))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(fs::TryLockError::WouldBlock) => {
                return Err(StudyFolderError::Locked {
                    path: path.to_owned(),
                });
            }
            Err(fs::TryLockError::Error(error)) => return Err(failed("lock", &lock)(error)),
        }
        let folder = StudyFolder {
            path: path.to_owned(),
            key: key.to_owned(),
            _lock: file,
            next: next_number(&parts)?,
        };
        match is_study {
            // Another program may have begun meanwhile, and has ended.
            false if inner.join(KEY).is_file() => {
                return Err(StudyFolderError::Begun {
                    path: path.to_owned(),
                });
            }
            false => folder.put_aside(&inner.join(KEY), key_text(key).as_bytes())?,
            true => {}
        }
        Ok(folder)
    }

    /// Whether all files of the result are there.
    pub fn is_complete(&self) -> bool {
        self.path.join(SUMMARY).is_file()
    }

    /// Keeps finished cases: from here on nothing can lose them.
    pub fn keep(&mut self, cases: &[(u64, Vec<Row>)]) -> Result<()> {
        let name = format!("{:010}.part", self.next);
        self.next += 1;
        let contents = rows::encode(&self.key, cases);
        self.put_aside(&self.path.join(INNER).join(PARTS).join(name), &contents)
    }

    /// All cases that were kept.
    pub fn finished(&self, measures: usize) -> Result<Finished> {
        finished(&self.path, &self.key, measures)
    }

    /// Writes a file of the result.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<()> {
        self.put_aside(&self.path.join(name), contents)
    }

    /// What was kept is in the files of the result now.
    pub fn clear(&self) -> Result<()> {
        let parts = self.path.join(INNER).join(PARTS);
        fs::remove_dir_all(&parts).map_err(failed("remove", &parts))
    }

    /// Writes a file aside and renames it.
    fn put_aside(&self, to: &Path, contents: &[u8]) -> Result<()> {
        let aside = self.path.join(INNER).join("aside");
        let write = || -> io::Result<()> {
            let mut file = File::create(&aside)?;
            file.write_all(contents)?;
            file.sync_all()
        };
        write().map_err(failed("write", &aside))?;
        fs::rename(&aside, to).map_err(failed("write", to))
    }
}

/// The cases that are kept in a folder of a study with this key; none where it has no such folder any more.
pub(crate) fn finished(path: &Path, key: &str, measures: usize) -> Result<Finished> {
    check_key(path, key)?;
    let parts = path.join(INNER).join(PARTS);
    let mut cases = Finished::new();
    let entries = match fs::read_dir(&parts) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(cases),
        entries => entries.map_err(failed("read", &parts))?,
    };
    for entry in entries {
        let file = entry.map_err(failed("read", &parts))?.path();
        let contents = fs::read(&file).map_err(failed("read", &file))?;
        let found = rows::decode(key, measures, &contents).map_err(|error| match error {
            Unusable::Damaged => StudyFolderError::Damaged { path: file.clone() },
            Unusable::OtherStudy => StudyFolderError::Other {
                path: file.clone(),
                what: "key",
            },
        })?;
        cases.extend(found);
    }
    Ok(cases)
}

/// A folder that is not there, or empty.
fn check_empty(path: &Path) -> Result<()> {
    if fs::symlink_metadata(path).is_err() {
        return Ok(());
    }
    if !path.is_dir() {
        return Err(StudyFolderError::NotAFolder {
            path: path.to_owned(),
        });
    }
    let entries = fs::read_dir(path).map_err(failed("read the folder", path))?;
    for entry in entries {
        let entry = entry.map_err(failed("read the folder", path))?.file_name();
        // What a program has left that was killed before it could write its key.
        if entry != INNER {
            return Err(StudyFolderError::NotAStudy {
                path: path.to_owned(),
                entry: entry.to_string_lossy().into_owned(),
            });
        }
    }
    Ok(())
}

/// The number after those of the files that are there.
fn next_number(parts: &Path) -> Result<u64> {
    let entries = fs::read_dir(parts).map_err(failed("read", parts))?;
    let mut next = 0;
    for entry in entries {
        let path = entry.map_err(failed("read", parts))?.path();
        let number = path.file_stem().and_then(|stem| stem.to_str());
        let number = number.and_then(|number| number.parse::<u64>().ok());
        next = next.max(number.map_or(0, |number| number + 1));
    }
    Ok(next)
}
