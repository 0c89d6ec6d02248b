//! Pictures of runs, as SVG, PNG and PDF ([`Format`]).
//!
//! The layout is made here, in pixels; what a picture then consists of is the same for every format. Symbols, units and colours follow
//! the names and units of the model, and a run of any length gives a file of bounded size.

mod appearance;
mod axis;
mod canvas;
mod chart;
mod coincide;
mod decimate;
mod format;
pub(crate) mod marked;
#[cfg(feature = "cli")]
mod matrix;
mod overview;
mod palette;
mod panel;
#[cfg(feature = "png-pdf")]
mod pdf;
mod phase;
#[cfg(feature = "png-pdf")]
mod png;
mod strip;
mod svg;
mod symbol;
#[cfg(feature = "png-pdf")]
mod typeface;

pub use appearance::{Appearance, LEAST};
pub use axis::Scale;
pub use canvas::Picture;
pub use chart::{Chart, Dimension, comparison};
pub use format::Format;
#[cfg(feature = "cli")]
pub(crate) use matrix::scatter_matrix;
pub use overview::overview;
pub(crate) use overview::{Grouped, grouped, overview_of};
pub use panel::{Curve, Style};
pub use phase::phase_portraits;
pub(crate) use phase::{phase_portraits_of, portraits};
pub(crate) use symbol::symbol;
