//! From model folders to compiled models: Python with CasADi, generated code, C.
//!
//! A crate with models of its own has them in folders `models/NAME/model.py`; in its `Cargo.toml`, in one version, `dalembert`
//! under `[dependencies]` and `dalembert-build` under `[build-dependencies]`; and as all that `main` of its `build.rs` does:
//!
//! ```no_run
//! dalembert_build::models();
//! ```
//!
//! Then `dalembert::models!()` in that crate are its models, for scenes, runs and ensembles (`examples/own_crate`).
//!
//! Such a crate needs Python where it is built, unless it has a folder `generated` with the C: a build with
//! `DALEMBERT_PREGENERATE=1` writes it. List it under `include` in `Cargo.toml`, so that it becomes part of the package. It is
//! taken as long as models, generator, name and version of the crate are what it was made from. A documentation build
//! (`DOCS_RS`) needs neither.
//!
//! | module | subject |
//! |---|---|
//! | `script` | the build script of a crate with models |
//! | `owner` | whose models are linked |
//! | `engine` | what the engine tells the crates that depend on it, and whether they fit |
//! | `generator`, `files` | the generator, which travels inside this crate |
//! | `python` | which interpreter, and how it is run |
//! | `install` | the locked packages, from the cache or a registry |
//! | `generate` | from model folders to C |
//! | `packaged` | C that was generated before |
//! | `compile` | from C to static libraries |
//! | `model` | folders of models, wherever they are, and the judgement on one |
//! | `library`, `index`, `link` | from such a folder to a shared library, while a program runs |
//! | `verification` | the verification of printed equations, made ready to run |
//! | `registry` | the C file that lists the models |
//! | `cache`, `evict` | folders under content keys, and what becomes of old ones |
//! | `fingerprint`, `parallel` | hashes; threads |
//! | `error` | every failure, with what to do |
//!
//! Variables that the user may set:
//!
//! | variable | meaning |
//! |---|---|
//! | `DALEMBERT_PYTHON` | an interpreter that already has the CasADi of the lock file |
//! | `DALEMBERT_CACHE` | folder for installed packages and generated code |
//! | `DALEMBERT_GENERATOR` | a folder `codegen` in place of the generator inside |
//! | `DALEMBERT_PREGENERATE` | if set, the C is also written into the folder `generated` of the crate |
//! | `PIP_INDEX_URL`, `PIP_FIND_LINKS`, … | how pip reaches a registry |
//! | `DALEMBERT_SANITIZE` | if set, the C checks its addresses and for undefined behaviour: `.ci/sanitize` |
//! | `CC`, `CFLAGS`, … | the C compiler, as the `cc` crate understands them |

mod cache;
mod compile;
mod engine;
mod error;
mod evict;
mod files;
mod fingerprint;
mod generate;
mod generator;
mod index;
mod install;
mod library;
mod link;
mod model;
mod owner;
mod packaged;
mod parallel;
mod python;
mod registry;
mod script;
mod verification;

/// The style of pages: of this crate's reports, and of the engine's pages.
pub const PAGE_STYLE: &str = include_str!("../page.css");

pub use cache::Cache;
pub use error::{Error, InstallCause, ModelFailure};
pub use evict::Item;
pub use library::{Choices, Library, Options, Stage, library};
pub use model::{Sources, check, sources};
pub use script::models;
pub use verification::{Verification, verification};
