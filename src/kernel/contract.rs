//! The contract as C lays it out (codegen/contract.h), and what is wrong with something that is not it.

use super::raw::{Raw, RawRun, RawStart};
use thiserror::Error;

/// Version of the contract that this engine speaks: `DALEMBERT_CONTRACT_VERSION`.
pub const CONTRACT_VERSION: u32 = 14;

/// What a model begins with: `DALEMBERT_CONTRACT_MARK`.
pub(crate) const MARK: [u8; 8] = *b"dalembrt";

/// Levels of the processor for which a model may have functions for lanes: `DALEMBERT_LEVELS`.
pub(crate) const LEVELS: usize = 3;

/// `struct dalembert_functions`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RawFunctions {
    pub(crate) values: usize,
    pub(crate) value: *const Option<Raw>,
    pub(crate) series: usize,
    pub(crate) start: *const Option<RawStart>,
    pub(crate) run: *const Option<RawRun>,
}

/// `struct dalembert_model`: what a compiled model exports.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RawModel {
    pub(crate) mark: [u8; 8],
    pub(crate) version: u32,
    pub(crate) size: u32,
    pub(crate) digest: [u8; 64],
    pub(crate) name: *const std::ffi::c_char,
    pub(crate) description_length: usize,
    pub(crate) description: *const u8,
    pub(crate) functions: RawFunctions,
    pub(crate) lanes: [*const RawFunctions; LEVELS],
}

// SAFETY: it is a constant, and so is all that it refers to.
unsafe impl Sync for RawModel {}

/// Functions by the places that the description tells.
#[derive(Debug, Clone, Default)]
pub(crate) struct Functions {
    pub values: Vec<Option<Raw>>,
    pub series: Vec<Option<(RawStart, RawRun)>>,
}

/// What a model has in it besides its mark.
#[derive(Debug, Clone)]
pub(crate) struct Parts {
    /// Of what the model was made from.
    pub digest: String,
    /// JSON.
    pub description: String,
    pub functions: Functions,
    /// By level of the processor; none where the model was compiled without them.
    pub lanes: Vec<Functions>,
}

/// What the header of a file shows that cannot be loaded as a library.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LibraryFault {
    /// It is another kind of file.
    #[error("it is no shared library")]
    NoLibrary,
    /// It is for another processor.
    #[error(
        "it is for another processor: its header has the machine {found} where that of this program has {expected}"
    )]
    Processor {
        /// The machine in its header.
        found: u64,
        /// That of this program.
        expected: u64,
    },
    /// Its end is missing.
    #[error("it is cut off: it has {length} of {end} bytes")]
    CutOff {
        /// Its length, bytes.
        length: u64,
        /// The length that its header tells, bytes.
        end: u64,
    },
}

/// Why something is not a model that this engine can run.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ContractError {
    /// The file shows that it is no library for this program.
    #[error("it cannot be loaded: {0}")]
    File(LibraryFault),
    /// The file cannot be read, the system refuses it, or no constant with the name of the contract is exported.
    #[error("it cannot be loaded: {message}")]
    Library {
        /// What the system says.
        message: String,
    },
    /// It does not begin as a model does.
    #[error("it does not begin with the mark {expected:?} of a model, but with {found:?}")]
    Mark {
        /// What it begins with.
        found: String,
        /// What a model begins with.
        expected: String,
    },
    /// It was generated for another version of the contract.
    #[error(
        "it has version {found} of the contract between models and engine, and this engine has version {expected}: \
         generate it again, with the dalembert that runs it"
    )]
    Version {
        /// Of the model.
        found: u32,
        /// Of the engine.
        expected: u32,
    },
    /// It was compiled with another layout.
    #[error("its table has {found} bytes where the contract has {expected}")]
    Size {
        /// Of the model.
        found: u32,
        /// Of the engine.
        expected: u32,
    },
    /// It is not what was asked for.
    #[error("it was made from {found}, not from {expected}: its file was exchanged")]
    Digest {
        /// Digest in the model.
        found: String,
        /// Digest that was asked for.
        expected: String,
    },
    /// The description is not as the contract says.
    #[error("its description is wrong at {place}: {found}, where {expected} is meant")]
    Description {
        /// Path in the description, such as `variants[0].modes[2].free[1]`.
        place: String,
        /// What is there.
        found: String,
        /// What may be there.
        expected: String,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{offset_of, size_of};

    /// The layout as a C compiler sees it, in the order of codegen/contract.h.
    #[test]
    fn the_layout_is_that_of_the_header() {
        let header = include_str!("../../codegen/contract.h");
        let version = format!("#define DALEMBERT_CONTRACT_VERSION {CONTRACT_VERSION}\n");
        assert!(header.contains(&version));
        assert!(header.contains(&format!("enum {{ DALEMBERT_LEVELS = {LEVELS} }};")));
        let mark = MARK
            .map(|byte| format!("'{}'", char::from(byte)))
            .join(", ");
        assert!(header.contains(&format!("#define DALEMBERT_CONTRACT_MARK {{{mark}}}")));

        let pointer = size_of::<usize>();
        assert_eq!(
            fields(header, "dalembert_functions"),
            ["values", "value", "series", "start", "run"]
        );
        let offsets = [
            offset_of!(RawFunctions, values),
            offset_of!(RawFunctions, value),
            offset_of!(RawFunctions, series),
            offset_of!(RawFunctions, start),
            offset_of!(RawFunctions, run),
        ];
        assert_eq!(offsets, [0, 1, 2, 3, 4].map(|i| i * pointer));

        let names = fields(header, "dalembert_model");
        let expected = [
            "mark",
            "version",
            "size",
            "digest",
            "name",
            "description_length",
            "description",
            "functions",
            "lanes",
        ];
        assert_eq!(names, expected);
        let offsets = [
            offset_of!(RawModel, mark),
            offset_of!(RawModel, version),
            offset_of!(RawModel, size),
            offset_of!(RawModel, digest),
            offset_of!(RawModel, name),
            offset_of!(RawModel, description_length),
            offset_of!(RawModel, description),
            offset_of!(RawModel, functions),
            offset_of!(RawModel, lanes),
        ];
        let after = |fields: usize| 80 + fields * pointer;
        assert_eq!(
            offsets,
            [0, 8, 12, 16, 80, after(1), after(2), after(3), after(8)]
        );
        assert_eq!(size_of::<RawModel>(), after(11));
    }

    /// Names of the fields of a structure in a header.
    fn fields<'h>(header: &'h str, name: &str) -> Vec<&'h str> {
        let start = header.find(&format!("struct {name} {{\n")).unwrap();
        let body = &header[start..][..header[start..].find("};").unwrap()];
        let lines = body.lines().skip(1).filter_map(|line| line.split_once(';'));
        lines
            .map(|(field, _)| {
                let name = field.rsplit([' ', '*']).next().unwrap();
                name.split('[').next().unwrap()
            })
            .collect()
    }

    /// The same once more, by a C compiler: codegen/tests/test_contract.py asserts these sizes when it compiles.
    #[test]
    fn a_pointer_to_a_function_may_be_null() {
        assert_eq!(size_of::<Option<Raw>>(), size_of::<usize>());
        assert_eq!(size_of::<Option<RawStart>>(), size_of::<usize>());
    }
}
