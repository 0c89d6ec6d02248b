//! One-step integration of second-order systems r(t, q, v, a) = 0 by Radau IIA collocation.
//!
//! [`Radau`] advances a [`System`] by implicit Runge–Kutta steps of 1, 3, 5 or 7 stages (orders 1,
//! 5, 9, 13) with error control, and offers the last step as a polynomial ([`Dense`]) on which
//! events are located. q̇ = v is eliminated: with accelerations A_j at the stages as unknowns,
//!
//! ```text
//! V_i = v₀ + h Σ_j a_ij A_j,    Q_i = q₀ + h c_i v₀ + h² Σ_j (A²)_ij A_j,
//! ```
//!
//! so all linear algebra is F × F. Nothing is allocated, and only +, −, ×, ÷ and square roots are
//! used, so that results have the same bits on every processor.
//!
//! Files: `tableau` (coefficients), `newton` (stage equations), `estimate` (local
//! error), `controller` (step sizes), `first_step`, `dense`, `refined` (what is read off inside of a step), `radau` (the step), `state`, `tolerances`,
//! `stages` (how many are the fastest), `logarithm` (cheap roots), `system` (the interface to the
//! equations), `report` (counters and errors).

// Formulas over several indexed arrays read as in the literature when all of them are indexed.
#![allow(clippy::needless_range_loop)]

mod coefficients;
mod controller;
mod dense;
mod estimate;
mod first_step;
mod logarithm;
mod newton;
mod one_step;
mod radau;
mod refined;
mod report;
mod stages;
mod state;
mod system;
mod tableau;
mod taylor;
mod tolerances;

pub(crate) use crate::numerics::stretch;
pub use crate::numerics::{
    Const, Dynamic, Matrix, ORDERS, Rows, Series, SeriesKind, Singular, Size, Vector, solve,
};
pub(crate) use crate::numerics::{LaneMask, Lanes};
pub use dense::Dense;
pub use one_step::{LastStep, Motion, OneStep, Path, Retake};
pub use radau::Radau;
pub use report::{Counters, StepError, StepReport};
pub use stages::stages;
pub use state::{Node, State};
pub use system::{FirstOrder, FirstOrderProblem, System};
pub use tableau::{Coefficients, RadauIia, Tableau};
pub use taylor::{Analytic, Taylor, TaylorDense};
pub(crate) use taylor::{LaneTaylor, SERIES};
pub use tolerances::{ToleranceError, Tolerances};
