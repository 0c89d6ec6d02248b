//! Impacts that gain energy: an impact law that no mechanism explains.

use super::run::Run;

/// An impact that gains energy.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Gain {
    /// Time (s).
    pub t: f64,
    /// Number of transitions up to and including this one.
    pub j: u64,
    /// Name of the transition.
    pub transition: String,
    /// Energy gained, in the frame of the ground (J).
    pub energy: f64,
}

impl Gain {
    /// Most gains that are listed: a law that makes energy may do so at each of a million impacts. By transition all
    /// are counted.
    pub const MOST: usize = 100;
}

/// The first impacts of a run that gain energy, at most [`Gain::MOST`].
pub fn gains(run: &Run) -> Vec<Gain> {
    let gaining = run.events.iter().filter_map(|event| {
        let lost = event.energy?.lost;
        (lost < 0.0).then(|| Gain {
            t: event.t,
            j: event.j,
            transition: event.transition.into(),
            energy: -lost,
        })
    });
    gaining.take(Gain::MOST).collect()
}
