//! The event engine: modes, guards, transitions, settling, accumulation.
//!
//! [`simulate`] runs a [`Problem`]. `simulation` holds the loop; `enter` starts a segment, `segment`
//! and `follow` integrate it to its first crossing, which `roots` isolates and `locate` lands on; `fire` applies
//! the transition; `accumulation` recognises where infinitely many of them end; `observe` records. [`simulate_from`] goes on
//! from a checkpoint.

mod accumulation;
mod advance;
mod checkpoint;
mod choice;
mod contact;
mod crossing;
mod departure;
mod doubt;
mod ensemble;
mod enter;
mod equations;
mod equilibrium;
mod failure;
mod fire;
mod follow;
mod frictions;
mod guards;
mod inertia;
mod instant;
mod limits;
mod locate;
mod margins;
mod member;
mod moment;
mod observe;
mod outputs;
mod plan;
mod problem;
mod projection;
mod rest;
mod result;
mod resume;
mod rise;
pub mod roots;
mod search;
mod segment;
mod sensitivity;
mod simulate;
mod simulation;
mod simulator;
mod solvers;
mod start;
mod stiffness;
mod touch;
mod typical;
mod unrest;
mod validate;
mod visited;

pub(crate) use accumulation::LONGEST_PATTERN;
pub use advance::Stopped;
pub use checkpoint::{Checkpoint, Misfit};
pub use ensemble::{Ensemble, Finished};
pub use failure::{Misfitting, Reason, Taken};
pub use member::Member;
pub use moment::{Moment, NotComputed};
pub use observe::{Collected, MadeStep, Observer};
pub use outputs::OwnOutput;
pub use problem::{
    Accuracy, AtLimit, Collisions, End, ImpactLaw, ImpactOrder, Initial, Limits, Method, Observed,
    OwnLimit, Problem, Record,
};
pub use result::{Failure, Run};
pub use resume::{check_row, check_same, simulate_from};
pub use simulate::{simulate, simulate_member, simulate_with};
pub use simulator::Simulator;
pub use unrest::{Restless, Tried, Unbalanced, Unfit};
pub use validate::{Exceeds, Invalid, Unknown, check_limits_of_parameters};
