//! How precise runs are: of one run ([`estimate`]), and of all methods and tolerances ([`Study`]).
//!
//! Errors are differences to a run that is known to be better ([`Difference`]).

mod attempt;
mod difference;
mod estimate;
mod matching;
mod reference;
mod settled;
mod study;

pub use difference::Difference;
pub use estimate::{ESTIMATE_FACTOR, NoEstimate, TAYLOR_ESTIMATE_FACTOR, estimate};
pub use matching::{Match, match_events};
pub use reference::{Bound, Horizon, Reference};
pub use settled::{COMPARED, Ended, Other, other, unsettled};
pub use study::{Measured, Row, Study, TOLERANCES, Verdict};

use crate::hybrid::{Method, Problem};
use crate::record::{Recorded, Run};

/// The tightest relative tolerance that is asked for: a few tens of roundings.
pub const TIGHTEST: f64 = 1e-14;

/// A method that takes so many times as long as Radau is given up: it is no choice. Stiff equations
/// take the Taylor method thousands of times as long.
pub const GIVEN_UP: u32 = 20;

/// The problem at another tolerance and by another method, of which nothing but events, end and ledger
/// is recorded. The ratios of the scene's tolerances to each other stay.
fn variation(problem: &Problem, method: Method, tolerance: f64) -> Problem {
    let mut other = problem.clone();
    let factor = tolerance / problem.accuracy.relative;
    other.method = method;
    other.accuracy.relative = tolerance;
    let absolute = &mut other.accuracy;
    for tolerance in absolute
        .q_absolute
        .iter_mut()
        .chain(&mut absolute.v_absolute)
    {
        *tolerance *= factor;
    }
    other.record.every = Some(f64::INFINITY);
    other.record.columns = Recorded::default();
    other.record.event_states = false;
    other.record.extremes = false;
    other
}

/// Typical sizes of the coordinates and velocities that runs record: absolute ÷ relative tolerance.
fn scales(problem: &Problem) -> [Vec<f64>; 2] {
    let (accuracy, own) = (&problem.accuracy, problem.model.own_coordinates().len());
    let scale = |absolute: &[f64]| {
        let sizes = absolute[..own].iter();
        sizes.map(|a| a / accuracy.relative).collect()
    };
    [scale(&accuracy.q_absolute), scale(&accuracy.v_absolute)]
}

/// Relative error that rounding leaves in the steps of a run: each rounds the state by up to half a
/// unit in its last place, and roundings of either sign add up as the root of their number.
fn rounding(run: &Run) -> f64 {
    f64::EPSILON / 2.0 * (run.solver.steps.max(1) as f64).sqrt()
}

/// Whether the Taylor method made steps of a run; it names every method that did.
fn used_taylor(run: &Run) -> bool {
    run.solver.method.contains("Taylor")
}

/// Name of a method, as scenes write it.
pub fn method_name(method: Method) -> &'static str {
    let methods = crate::scene::METHODS;
    let found = methods.iter().find(|(_, known)| *known == method);
    found.expect("every method has a name").0
}
