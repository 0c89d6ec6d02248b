//! Digests of what is written, so that what is read back is what was written.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;

use sha2::{Digest, Sha256};

/// Lines that have a digest together: enough that digests are a small part of a table.
const BLOCK: u64 = 32;

/// A digest in hexadecimal digits, cut to 64 bits: it tells that something was changed, and need not resist an
/// attacker.
pub(crate) fn digest(content: impl AsRef<[u8]>) -> String {
    short(Sha256::digest(content.as_ref()).as_slice())
}

fn short(digest: &[u8]) -> String {
    digest[..8]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// Digests of the lines of a file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Lines {
    /// Number of lines.
    count: u64,
    /// Of each [`BLOCK`] of them.
    blocks: Vec<String>,
}

impl Lines {
    /// As one line of text.
    pub fn text(&self) -> String {
        format!("{} {}", self.count, self.blocks.join(" "))
    }

    /// What [`Lines::text`] has written.
    pub fn read(text: &str) -> Option<Lines> {
        let mut words = text.split_whitespace();
        let count = words.next()?.parse().ok()?;
        let blocks = words.map(str::to_owned).collect();
        Some(Lines { count, blocks })
    }

    /// The digests of a file as it is.
    pub fn of(path: &Path) -> io::Result<Lines> {
        let mut file = BufReader::new(File::open(path)?);
        let mut out = Digesting::new(io::sink());
        loop {
            let length = {
                let content = file.fill_buf()?;
                out.write_all(content)?;
                content.len()
            };
            if length == 0 {
                return Ok(out.finish());
            }
            file.consume(length);
        }
    }

    /// Where a file with the digests `found` differs from what was written, in words.
    pub fn difference(&self, found: &Lines) -> Option<String> {
        let blocks = self.blocks.iter().zip(&found.blocks);
        let same = blocks.take_while(|(a, b)| a == b).count() as u64;
        if self == found {
            return None;
        }
        let first = same * BLOCK + 1;
        let last = (first + BLOCK - 1).min(self.count.max(found.count).max(first));
        let lines = match first == last {
            true => format!("line {first} is"),
            false => format!("lines {first} to {last} are"),
        };
        let length = match self.count == found.count {
            true => String::new(),
            false => format!(" (it has {} lines, and had {})", found.count, self.count),
        };
        Some(format!("{lines} not what the run has written{length}"))
    }
}

/// Passes on what is written, and makes digests of it.
pub(super) struct Digesting<W> {
    out: W,
    hash: Sha256,
    /// Lines so far, and whether the last one has no end yet.
    count: u64,
    open: bool,
    blocks: Vec<String>,
}

impl<W: Write> Digesting<W> {
    pub fn new(out: W) -> Self {
        Digesting {
            out,
            hash: Sha256::new(),
            count: 0,
            open: false,
            blocks: Vec::new(),
        }
    }

    fn close_block(&mut self) {
        let hash = std::mem::take(&mut self.hash);
        self.blocks.push(short(hash.finalize().as_slice()));
    }

    /// The digests of all that was written.
    pub fn finish(mut self) -> Lines {
        if self.open {
            self.count += 1;
            self.close_block();
        } else if !self.count.is_multiple_of(BLOCK) {
            self.close_block();
        }
        Lines {
            count: self.count,
            blocks: self.blocks,
        }
    }
}

impl<W: Write> Write for Digesting<W> {
    fn write(&mut self, content: &[u8]) -> io::Result<usize> {
        let written = self.out.write(content)?;
        for line in content[..written].split_inclusive(|&byte| byte == b'\n') {
            self.hash.update(line);
            self.open = !line.ends_with(b"\n");
            if !self.open {
                self.count += 1;
                if self.count.is_multiple_of(BLOCK) {
                    self.close_block();
                }
            }
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Lines {
        let mut out = Digesting::new(io::sink());
        // In pieces, as buffers hand them on.
        for piece in text.as_bytes().chunks(7) {
            out.write_all(piece).unwrap();
        }
        out.finish()
    }

    #[test]
    fn a_difference_is_found_at_its_lines() {
        let table: String = (0..100).map(|i| format!("{i},{}\n", i * i)).collect();
        let written = lines(&table);
        assert_eq!(Lines::read(&written.text()), Some(written.clone()));
        assert_eq!(written.difference(&lines(&table)), None);
        let difference = |changed: &str| written.difference(&lines(changed)).unwrap();
        let digit = table.replace("40,1600", "40,1601");
        assert!(difference(&digit).starts_with("lines 33 to 64 are not"));
        let cut = &table[..table.find("98,").unwrap()];
        let words =
            "lines 97 to 100 are not what the run has written (it has 98 lines, and had 100)";
        assert_eq!(difference(cut), words);
        let half = &table[..table.len() - 3];
        assert!(difference(half).starts_with("lines 97 to 100"));
        assert!(difference("").starts_with("lines 1 to 32"));
        assert!(difference(&format!("{table}1,1\n")).contains("it has 101 lines, and had 100"));
    }
}
