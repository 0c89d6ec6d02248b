//! What the end and the events of two runs differ by.

use super::matching::{Match, match_events};
use crate::record::Run;

/// The difference of a run to a better one.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Of each coordinate at the end, in its unit.
    pub q: Vec<f64>,
    /// Of each velocity at the end, in its unit.
    pub v: Vec<f64>,
    /// Largest of these, each divided by what a tolerance of 1 would allow: its typical size (absolute
    /// ÷ relative tolerance) and its magnitude.
    pub end: f64,
    /// The events and limit states.
    pub events: Match,
}

impl Difference {
    /// The difference of `run` to `better`, with the typical sizes of coordinates and velocities.
    pub fn new(run: &Run, better: &Run, [of_q, of_v]: &[Vec<f64>; 2]) -> Self {
        let minus = |a: &[f64], b: &[f64]| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect()
        };
        let (end, other) = (&run.end.state, &better.end.state);
        let (q, v) = (minus(&end.q, &other.q), minus(&end.v, &other.v));
        let sizes = of_q.iter().chain(of_v);
        let allowed = sizes
            .zip(other.q.iter().chain(&other.v))
            .map(|(size, value)| size + value.abs());
        let parts = q.iter().chain(&v).zip(allowed).map(|(d, a)| d / a);
        let mut events = match_events(&run.events, &better.events);
        let [own, other] = [run, better].map(|run| &run.reached.limit_states);
        events.add_limits(own, other);
        Difference {
            end: parts.fold(0.0, f64::max),
            events,
            q,
            v,
        }
    }
}
