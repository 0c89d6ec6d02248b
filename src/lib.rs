//! Simulation of mechanical systems that stick, slip, rock and impact, from equations that are
//! derived from their energies at build time.
//!
//! energies → derivation → C → [`kernel`] → [`integrate`] → [`hybrid`] (events) → [`record`]

pub mod cli;
pub mod hybrid;
pub mod input;
pub mod integrate;
pub mod kernel;
pub mod model;
pub mod record;
pub mod scene;
