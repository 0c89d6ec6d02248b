//! What a compiled model exports: linked into the program, or loaded from a shared library.

use super::contract::{
    CONTRACT_VERSION, ContractError, Functions, MARK, Parts, RawFunctions, RawModel,
};
use super::library_file;
use std::ffi::CStr;
use std::mem::size_of;
use std::path::Path;

/// A shared library that was loaded.
#[derive(Debug)]
pub struct Library {
    #[expect(dead_code, reason = "it is there so that the library is not unloaded")]
    loaded: libloading::Library,
}

/// Name of the constant that the shared library of a model exports: `DALEMBERT_SYMBOL` as it is compiled.
const SYMBOL: &CStr = c"dalembert_model";

/// Opens the shared library of a model and copies what is in it.
///
/// The library is code: what it does when it is loaded, and what its functions do, no check can tell. Mark, version and
/// digest are compared before anything in it is called.
///
/// # Errors
/// [`ContractError`] if it is no library of this system, no model, of another version, or not made from what
/// `digest` tells, if that is given.
pub(crate) fn open(file: &Path, digest: Option<&str>) -> Result<(Parts, Library), ContractError> {
    let refused = |error: libloading::Error| ContractError::Library {
        message: error.to_string(),
    };
    match library_file::fault(file) {
        Ok(None) => {}
        Ok(Some(fault)) => return Err(ContractError::File(fault)),
        Err(error) => {
            let message = error.to_string();
            return Err(ContractError::Library { message });
        }
    }
    // SAFETY: a library of generated code has no initializers; that it is one the caller answers for.
    let loaded = unsafe { libloading::Library::new(file) }.map_err(refused)?;
    // SAFETY: the constant is only read once its mark, version and size were compared, and then is what they say.
    let parts = unsafe {
        let symbol = loaded
            .get::<*const RawModel>(SYMBOL.to_bytes_with_nul())
            .map_err(refused)?;
        parts(*symbol)?
    };
    if let Some(expected) = digest
        && parts.digest != expected
    {
        return Err(ContractError::Digest {
            found: parts.digest,
            expected: expected.to_owned(),
        });
    }
    Ok((parts, Library { loaded }))
}

/// What is in a model that is linked into the program.
///
/// # Errors
/// [`ContractError`] if it is of another version.
pub(crate) fn parts_of_linked(raw: &'static RawModel) -> Result<Parts, ContractError> {
    // SAFETY: only generated C makes one, and what is linked stays.
    unsafe { parts(raw) }
}

/// The name of a model that is linked into the program.
///
/// # Errors
/// As [`parts_of_linked`].
pub(crate) fn name_of_linked(raw: &'static RawModel) -> Result<&'static str, ContractError> {
    // SAFETY: as in `parts_of_linked`; a name ends with a zero.
    unsafe {
        check(raw)?;
        Ok(CStr::from_ptr(raw.name).to_str().unwrap_or_default())
    }
}

/// A list of models as a build wrote it in C, with null after them: `codegen/build/registry.rs`.
#[repr(C)]
#[derive(Debug)]
pub struct LinkedModels([Option<&'static RawModel>; 1]);

impl LinkedModels {
    /// The models of a list.
    ///
    /// # Safety
    /// It must be a list that the build script of a crate wrote, which stays.
    #[doc(hidden)]
    pub unsafe fn all(list: *const LinkedModels) -> &'static [&'static RawModel] {
        // SAFETY: the list ends with null, before which are pointers to constants.
        unsafe {
            let first = list.cast::<Option<&'static RawModel>>();
            let count = (0..).take_while(|&i| (*first.add(i)).is_some()).count();
            std::slice::from_raw_parts(first.cast(), count)
        }
    }
}

/// The list of the models that the build script of the calling crate linked.
#[doc(hidden)]
#[macro_export]
macro_rules! linked {
    () => {{
        unsafe extern "C" {
            #[link_name = env!(
                            "DALEMBERT_MODELS",
                            "this crate has no build script that calls dalembert_build::models()"
                        )]
            static LINKED: $crate::kernel::LinkedModels;
        }
        // SAFETY: the variable with the name is set by the build script that wrote the list.
        unsafe { $crate::kernel::LinkedModels::all(&raw const LINKED) }
    }};
}

/// The models that the build of this crate linked.
pub(crate) fn linked_models() -> &'static [&'static RawModel] {
    crate::linked!()
}

/// Compares mark, version and size.
///
/// # Safety
/// There must be as many bytes as a mark and two numbers take.
unsafe fn check(raw: *const RawModel) -> Result<(), ContractError> {
    // SAFETY: as the caller promises.
    let (mark, version, size) = unsafe { ((*raw).mark, (*raw).version, (*raw).size) };
    if mark != MARK {
        let text = |mark: &[u8]| String::from_utf8_lossy(mark).into_owned();
        return Err(ContractError::Mark {
            found: text(&mark),
            expected: text(&MARK),
        });
    }
    if version != CONTRACT_VERSION {
        return Err(ContractError::Version {
            found: version,
            expected: CONTRACT_VERSION,
        });
    }
    let expected = size_of::<RawModel>() as u32;
    if size != expected {
        return Err(ContractError::Size {
            found: size,
            expected,
        });
    }
    Ok(())
}

/// Copies what a model has in it.
///
/// # Safety
/// As [`check`]; and if it is of this version, all that it refers to must be there.
unsafe fn parts(raw: *const RawModel) -> Result<Parts, ContractError> {
    // SAFETY: as the caller promises; lengths and tables are as the contract says, since the version is its own.
    unsafe {
        check(raw)?;
        let raw = &*raw;
        let digest = raw.digest.split(|byte| *byte == 0).next().unwrap_or(&[]);
        let description = std::slice::from_raw_parts(raw.description, raw.description_length);
        let lanes = raw.lanes.iter().take_while(|level| !level.is_null());
        Ok(Parts {
            digest: String::from_utf8_lossy(digest).into_owned(),
            description: String::from_utf8_lossy(description).into_owned(),
            functions: functions(&raw.functions),
            lanes: lanes.map(|level| functions(&**level)).collect(),
        })
    }
}

/// Copies tables of functions.
///
/// # Safety
/// They must have the lengths that are stated.
unsafe fn functions(raw: &RawFunctions) -> Functions {
    fn table<'t, T>(count: usize, table: *const T) -> &'t [T] {
        match count {
            0 => &[],
            // SAFETY: as the caller of `functions` promises.
            _ => unsafe { std::slice::from_raw_parts(table, count) },
        }
    }
    let (starts, runs) = (table(raw.series, raw.start), table(raw.series, raw.run));
    let pairs = starts.iter().zip(runs);
    Functions {
        values: table(raw.values, raw.value).to_vec(),
        series: pairs.map(|(start, run)| start.zip(*run)).collect(),
    }
}
