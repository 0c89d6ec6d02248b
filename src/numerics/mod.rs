//! Numbers and small linear algebra: what everything stands on, and what imports nothing of ours.

mod bounded;
mod few;
mod lanes;
mod linear;
mod persist;
mod series;
mod side;

pub use bounded::Bounded;
pub(crate) use few::{copy_few, swap_few};
pub(crate) use lanes::{LaneMask, Lanes};
pub(crate) use linear::{Lu, determinant_sign};
pub use linear::{Singular, solve};
pub(crate) use persist::persist;
pub use persist::{Blank, Memory, Persist};
pub use series::{ORDERS, Series, SeriesKind};
pub use side::Side;
