//! Digests of what is written, so that what is read back is what was written.
//!
//! Each line of a file has a digest of 32 bits, which tells where something was changed; all of them together have
//! one of 64, which tells that it was. They go to one file as they come, some lines of a file in a row:
//!
//! ```text
//! trajectory.csv: 1f0c33a2 90aa6b01 …
//! trajectory.csv total: 1001 5b8e3c0f9d2a7714
//! ```

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;
use std::rc::Rc;

use sha2::{Digest, Sha256};

use crate::run::hexadecimal;

/// Digests in a row of the file.
const IN_A_ROW: usize = 64;

/// Digests of the lines of one file, as they come.
#[derive(Debug, Clone, Default)]
struct Lines {
    line: Sha256,
    whole: Sha256,
    /// Lines so far, and whether the last one has no end yet.
    count: u64,
    open: bool,
}

impl Lines {
    /// Takes what comes next; `closed` gets the digest of each line that ends.
    fn take(&mut self, content: &[u8], mut closed: impl FnMut([u8; 4])) {
        for line in content.split_inclusive(|&byte| byte == b'\n') {
            self.line.update(line);
            self.open = !line.ends_with(b"\n");
            if !self.open {
                closed(self.close());
            }
        }
    }

    fn close(&mut self) -> [u8; 4] {
        self.open = false;
        self.count += 1;
        let digest = self.line.finalize_reset();
        self.whole.update(digest);
        [digest[0], digest[1], digest[2], digest[3]]
    }

    /// The end of the file: the digest of a last line without an end.
    fn last(&mut self) -> Option<[u8; 4]> {
        self.open.then(|| self.close())
    }

    /// Number of lines and the digest of all.
    fn total(self) -> String {
        format!(
            "{} {}",
            self.count,
            hexadecimal(&self.whole.finalize()[..8])
        )
    }
}

/// The file that the digests of others go to.
#[derive(Debug, Clone)]
pub(super) struct Digests(Rc<RefCell<BufWriter<File>>>);

impl Digests {
    /// A new file.
    pub fn create(path: &Path) -> io::Result<Digests> {
        let file = File::create_new(path)?;
        Ok(Digests(Rc::new(RefCell::new(BufWriter::new(file)))))
    }

    fn row(&self, row: &str) -> io::Result<()> {
        self.0.borrow_mut().write_all(row.as_bytes())
    }

    /// Brings all of it to the disk.
    pub fn sync(&self) -> io::Result<()> {
        let mut out = self.0.borrow_mut();
        out.flush()?;
        out.get_ref().sync_all()
    }
}

/// Passes on what is written, and makes digests of it.
#[derive(Debug)]
pub(super) struct Digesting<W> {
    out: W,
    name: String,
    lines: Lines,
    digests: Digests,
    row: String,
    in_row: usize,
}

impl<W: Write> Digesting<W> {
    /// Of a file of this name.
    pub fn new(out: W, name: &str, digests: Digests) -> Self {
        Digesting {
            out,
            name: name.to_owned(),
            lines: Lines::default(),
            digests,
            row: String::new(),
            in_row: 0,
        }
    }

    fn end_row(&mut self) -> io::Result<()> {
        if self.in_row > 0 {
            self.digests.row(&format!("{}:{}\n", self.name, self.row))?;
        }
        self.row.clear();
        self.in_row = 0;
        Ok(())
    }

    /// Writes the digests of the end of the file, and gives what was written to.
    pub fn finish(mut self) -> io::Result<W> {
        if let Some(digest) = self.lines.last() {
            push(&mut self.row, digest);
            self.in_row += 1;
        }
        self.end_row()?;
        let total = self.lines.total();
        self.digests
            .row(&format!("{} total: {total}\n", self.name))?;
        Ok(self.out)
    }
}

fn push(row: &mut String, digest: [u8; 4]) {
    use std::fmt::Write;
    let digest = u32::from_be_bytes(digest);
    write!(row, " {digest:08x}").expect("writing to a string succeeds");
}

impl<W: Write> Write for Digesting<W> {
    fn write(&mut self, content: &[u8]) -> io::Result<usize> {
        let written = self.out.write(content)?;
        let (row, in_row) = (&mut self.row, &mut self.in_row);
        self.lines.take(&content[..written], |digest| {
            push(row, digest);
            *in_row += 1;
        });
        if self.in_row >= IN_A_ROW {
            self.end_row()?;
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Compares a file with the digests that were written with it; gives where it differs, in words.
///
/// # Errors
/// What cannot be read, or is not listed.
pub(super) fn difference(
    digests: &Path,
    name: &str,
    file: &Path,
) -> Result<Option<String>, String> {
    let unreadable = |error: io::Error| format!("cannot be read: {error}");
    let unlisted = |error: io::Error| {
        let digests = digests.file_name().unwrap_or_default().to_string_lossy();
        format!("cannot be told to be what was written, without {digests}: {error}")
    };
    let (of_lines, of_total) = (format!("{name}: "), format!("{name} total: "));
    let mut rows = BufReader::new(File::open(digests).map_err(unlisted)?).lines();
    let mut row: std::collections::VecDeque<u32> = Default::default();
    let mut total = None;
    // The next digest of a line, as it was written.
    let mut next = || -> Result<Option<u32>, String> {
        while row.is_empty() && total.is_none() {
            let Some(text) = rows.next().transpose().map_err(unlisted)? else {
                break;
            };
            if let Some(text) = text.strip_prefix(&of_lines) {
                let digests = text.split_whitespace();
                row.extend(digests.filter_map(|digest| u32::from_str_radix(digest, 16).ok()));
            } else if let Some(text) = text.strip_prefix(&of_total) {
                total = Some(text.to_owned());
            }
        }
        Ok(row.pop_front())
    };
    let mut lines = Lines::default();
    let mut content = BufReader::new(File::open(file).map_err(unreadable)?);
    let (mut line, mut first) = (Vec::new(), None);
    loop {
        line.clear();
        if content.read_until(b'\n', &mut line).map_err(unreadable)? == 0 {
            break;
        }
        let mut found = None;
        lines.take(&line, |digest| found = Some(digest));
        let found = found.or_else(|| lines.last()).map(u32::from_be_bytes);
        if next()? != found {
            first.get_or_insert(lines.count);
        }
    }
    let count = lines.count;
    if next()?.is_some() {
        first.get_or_insert(count + 1);
    }
    // The total is behind all lines.
    while next()?.is_some() {}
    let total = total.ok_or_else(|| {
        let digests = digests.file_name().unwrap_or_default().to_string_lossy();
        format!("{digests} does not list it")
    })?;
    if lines.total() == total {
        return Ok(None);
    }
    let was = total.split(' ').next().unwrap_or_default();
    let length = match count.to_string() == was {
        true => String::new(),
        false => format!(" (it has {count} lines, and had {was})"),
    };
    let place = first.map_or("it".to_owned(), |line| format!("line {line}"));
    Ok(Some(format!(
        "{place} is not what the run has written{length}"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_found_at_its_line() {
        let home = tempfile::tempdir().unwrap();
        let (listed, file) = (home.path().join("digests"), home.path().join("a.csv"));
        let digests = Digests::create(&listed).unwrap();
        let write = |name: &str, text: &str| {
            let mut out = Digesting::new(io::sink(), name, digests.clone());
            // In pieces, as buffers hand them on.
            for piece in text.as_bytes().chunks(7) {
                out.write_all(piece).unwrap();
            }
            out.finish().unwrap();
        };
        let table: String = (0..200).map(|i| format!("{i},{}\n", i * i)).collect();
        write("b.csv", "1\n2");
        write("a.csv", &table);
        digests.sync().unwrap();
        let difference = |changed: &str| {
            std::fs::write(&file, changed).unwrap();
            difference(&listed, "a.csv", &file).unwrap()
        };
        let said = |changed: &str| difference(changed).unwrap();
        assert_eq!(difference(&table), None);
        let digit = table.replace("40,1600", "40,1601");
        assert_eq!(said(&digit), "line 41 is not what the run has written");
        let without = table.replace("40,1600\n", "");
        let words = "line 41 is not what the run has written (it has 199 lines, and had 200)";
        assert_eq!(said(&without), words);
        let cut = &table[..table.find("198,").unwrap()];
        assert!(said(cut).starts_with("line 199 is"), "{}", said(cut));
        assert!(said(&table[..table.len() - 3]).starts_with("line 200 is"));
        assert!(said("").starts_with("line 1 is"));
        let more = format!("{table}1,1\n");
        assert!(said(&more).starts_with("line 201 is"));
        assert!(said(&more).ends_with("it has 201 lines, and had 200)"));
        std::fs::write(home.path().join("b.csv"), "1\n2").unwrap();
        let b = super::difference(&listed, "b.csv", &home.path().join("b.csv"));
        assert_eq!(b, Ok(None));
        let c = super::difference(&listed, "c.csv", &file);
        assert_eq!(c, Err("digests does not list it".into()));
    }
}
