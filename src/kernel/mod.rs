//! Calls into the generated C: the only unsafe code of the crate.
//!
//! Every generated function has the signature `Raw`. Safety rests on two facts: each output has the length that the
//! generated tables state (`crate::model` reads and checks these, the typed wrappers below fix them), and each
//! [`Context`] was made for the model whose functions it is passed to. Guards and transitions, which are passed to a
//! kernel, name their model themselves: that is the one checked.
//!
//! What is for lanes is for the crate alone, since it relies on the level of the processor:
//!
//! ```compile_fail
//! use dalembert::kernel::LaneLevel;
//! ```

mod calls;
mod context;
mod contract;
mod elementary;
mod guard_calls;
mod lane_calls;
mod lane_functions;
mod lanes;
mod library_file;
mod load;
mod raw;
mod tables;

pub use context::Context;
pub(crate) use context::{Dimensions, Rooms};
pub use contract::{CONTRACT_VERSION, ContractError, LibraryFault, RawFunctions, RawModel};
pub(crate) use contract::{Functions, Parts};
pub use elementary::{sin_cos, triangular_sums};
pub(crate) use lane_functions::*;
pub(crate) use lanes::{
    LANE_ROWS, LaneContext, LaneGuard, LaneLevel, LaneLimits, LanePast, LanePoint, LaneRows,
    LaneSeries, LaneSystem,
};
pub use lanes::{LANES_OF_LEVELS, processor_level};
pub use load::{Library, LinkedModels};
pub(crate) use load::{linked_models, name_of_linked, open, parts_of_linked};
pub(crate) use raw::Raw;
pub use tables::{
    ConstantsKernel, Free, GuardKernel, LinearSystem, ModeKernel, ModeKernels, TransitionKernel,
    with_kernel,
};
pub(crate) use tables::{LaneKernel, ModeFunctions, SeriesKernel};
