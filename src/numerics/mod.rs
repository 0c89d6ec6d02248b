//! Numbers and small linear algebra: what everything stands on, and what imports nothing of ours.

mod bounded;
mod buffer;
mod complementarity;
mod definite;
mod lanes;
mod linear;
mod persist;
mod series;
mod side;
mod size;

pub use bounded::Bounded;
pub use buffer::Buffer;
pub(crate) use complementarity::{Unsolved, solve_complementarity};
pub(crate) use definite::{Definite, NotPositive};
pub(crate) use lanes::{LaneMask, Lanes};
pub(crate) use linear::{Lu, solve_for};
pub use linear::{Singular, solve};
pub use persist::{Blank, Memory, Persist};
pub(crate) use persist::{Kept, persist};
pub(crate) use series::stretch;
pub use series::{ORDERS, Series, SeriesKind};
pub use side::Side;
pub use size::{Const, Dynamic, Matrix, Rows, Size, Vector};
