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
#[cfg(feature = "cli")]
mod matrix;
mod overview;
mod palette;
mod panel;
mod phase;
mod strip;
mod symbol;

pub use axis::Scale;
pub use chart::{Chart, Dimension, comparison};
pub use look::{LEAST, Look};
#[cfg(feature = "cli")]
pub(crate) use matrix::scatter_matrix;
pub use overview::overview;
pub(crate) use overview::{Grouped, grouped, overview_of};
pub use panel::{Curve, Style};
pub use phase::phase_portraits;
pub(crate) use phase::{phase_portraits_of, portraits};
pub(crate) use symbol::symbol;
