//! The file of a shared library, before the system loads it. The loader of Linux says of one for another processor that it is
//! not there, and reads beyond the end of one that was cut off.

use super::contract::LibraryFault;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Parts of the header of an ELF file (System V Application Binary Interface, 64 bits): where they begin.
const KIND: usize = 4;
const MACHINE: usize = 18;
const SECTIONS: usize = 40;
const SECTION_SIZE: usize = 58;
const HEADER: usize = 64;

/// What is wrong with the file of a library, if that is seen in its header. A file of another format is left to the system.
pub(super) fn fault(file: &Path) -> io::Result<Option<LibraryFault>> {
    if !cfg!(all(target_os = "linux", target_pointer_width = "64")) {
        return Ok(None);
    }
    let library = header(file)?;
    let Some(own) = std::env::current_exe().and_then(|own| header(&own))? else {
        return Ok(None);
    };
    let Some(library) = library else {
        return Ok(Some(LibraryFault::NoLibrary));
    };
    // Width of numbers and their order, and the processor.
    let processor = |header: &[u8; HEADER]| {
        let number = number(header, MACHINE, 2);
        (header[KIND], header[KIND + 1], number)
    };
    let (found, expected) = (processor(&library), processor(&own));
    if found != expected {
        return Ok(Some(LibraryFault::Processor {
            found: found.2,
            expected: expected.2,
        }));
    }
    // The table of sections is what linkers put last.
    let sections = number(&library, SECTION_SIZE, 2) * number(&library, SECTION_SIZE + 2, 2);
    let end = number(&library, SECTIONS, 8).saturating_add(sections);
    let length = file.metadata()?.len();
    Ok((length < end).then_some(LibraryFault::CutOff { length, end }))
}

/// The header of an ELF file; nothing if it is none.
fn header(file: &Path) -> io::Result<Option<[u8; HEADER]>> {
    let mut header = Vec::new();
    File::open(file)?
        .take(HEADER as u64)
        .read_to_end(&mut header)?;
    let header = <[u8; HEADER]>::try_from(header).ok();
    Ok(header.filter(|header| header.starts_with(b"\x7fELF")))
}

/// A number in the order of bytes of this machine, which that of its own libraries is.
fn number(header: &[u8; HEADER], at: usize, bytes: usize) -> u64 {
    let bytes = &header[at..at + bytes];
    let push = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
    match cfg!(target_endian = "little") {
        true => bytes.iter().rev().fold(0, push),
        false => bytes.iter().fold(0, push),
    }
}
