//! Pictures of runs, as SVG.
//!
//! plotters writes the SVG; the layout is made here, in pixels. Symbols, units and colours follow
//! the names and units of the model, and a run of any length gives a file of bounded size.

mod axis;
mod canvas;
mod chart;
mod coincide;
mod decimate;
mod look;
pub(crate) mod marked;
mod overview;
mod palette;
mod panel;
mod phase;
mod strip;
mod symbol;

pub use axis::Scale;
pub use chart::{Chart, Dimension, comparison};
pub use look::{LEAST, Look};
pub use overview::overview;
pub(crate) use overview::{Grouped, grouped, overview_of};
pub use panel::Curve;
pub use phase::phase_portraits;
pub(crate) use phase::{phase_portraits_of, portraits};
pub(crate) use symbol::symbol;
