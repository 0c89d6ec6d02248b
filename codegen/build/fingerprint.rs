//! Short names for contents.

use std::fs;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::error::Error;

/// A SHA-256 hash under construction. Every item is preceded by its length, so that no two
/// sequences of items run together into the same bytes.
#[derive(Clone, Default)]
pub struct Fingerprint(Sha256);

impl Fingerprint {
    /// Adds an item.
    pub fn with(mut self, item: impl AsRef<[u8]>) -> Self {
        let item = item.as_ref();
        self.0.update((item.len() as u64).to_le_bytes());
        self.0.update(item);
        self
    }

    /// Adds files, each by its name below `root` and its content.
    pub fn with_files<'a>(
        mut self,
        root: &Path,
        files: impl IntoIterator<Item = &'a Path>,
    ) -> Result<Self, Error> {
        for file in files {
            let name = file.strip_prefix(root).unwrap_or(file);
            let content = fs::read(file).map_err(Error::io("read", file))?;
            self = self.with(name.as_os_str().as_encoded_bytes()).with(content);
        }
        Ok(self)
    }

    /// The hash in hexadecimal digits, cut to 64 bits: it tells the states of one project apart,
    /// and need not resist an attacker (pip checks the full hashes of what it installs).
    pub fn finish(self) -> String {
        let digest = self.0.finalize();
        digest[..8]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }
}
