//! Calls into the generated C: the only unsafe code of the crate.
//!
//! Every generated function has the signature `Raw`. Safety rests on two facts, both checked
//! here: each output has the length that the generated tables state (the typed wrappers below fix
//! it), and each [`Context`] was made for the model whose functions it is passed to. Guards and
//! transitions, which are passed to a kernel, name their model themselves: that is the one checked.
//!
//! What is for lanes is for the crate alone, since it relies on the level of the processor:
//!
//! ```compile_fail
//! use dalembert::kernel::LaneLevel;
//! ```

mod calls;
mod context;
mod contract;
mod description;
mod elementary;
mod few;
mod lane_calls;
mod lane_functions;
mod lanes;
mod load;
mod raw;
mod reader;
mod tables;
#[cfg(test)]
mod tests;

pub use context::Context;
pub(crate) use context::Dimensions;
pub use contract::{CONTRACT_VERSION, ContractError, RawFunctions, RawModel};
pub use elementary::{sin_cos, triangular_sums};
pub(crate) use few::{copy_few, swap_few};
pub(crate) use lane_functions::*;
pub(crate) use lanes::{
    LANE_ROWS, LaneContext, LaneGuard, LaneLevel, LaneLimits, LanePast, LanePoint, LaneRows,
    LaneSeries, LaneSystem,
};
pub use lanes::{LANES_OF_LEVELS, processor_level};
pub use load::Library;
pub(crate) use load::{linked, linked_models, name_of_linked};
pub use tables::{
    ConstantsKernel, Free, GuardKernel, LinearSystem, MOST_FREE, ModeKernel, ModeKernels,
    TransitionKernel, with_kernel,
};
