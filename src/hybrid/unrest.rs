//! Why a state is no static equilibrium, and why events that accumulate do not come to rest.

use super::failure::{Misfitting, Reason};

/// What was tried to bring to static equilibrium, and why it is none.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// The mode, where it is one by hand.
    pub mode: Option<&'static str>,
    /// Why it does not rest there.
    pub why: Unbalanced,
}

/// Why a state cannot be brought to static equilibrium.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unbalanced {
    /// It is not one of the mode.
    #[error(transparent)]
    Misfit(#[from] Misfitting),
    /// A force does not vanish.
    #[error("no place near is found at which the force along `{coordinate}` vanishes")]
    Force {
        /// The coordinate that it acts along.
        coordinate: &'static str,
    },
    /// A closed gap, or a constraint, cannot be brought to zero.
    #[error("what {of} holds cannot be reached")]
    Unreached {
        /// The contact or constraint, in words.
        of: String,
    },
    /// Forces of contacts do not balance the others.
    #[error("what touches there does not hold it")]
    Unheld,
    /// A gap is negative.
    #[error("where forces vanish contact `{contact}` penetrates")]
    Penetrates {
        /// The contact.
        contact: &'static str,
    },
    /// It is a mode for what slides, and nothing does.
    #[error("what slides in it is at rest")]
    Stands,
    /// A transition is taken at once.
    #[error("`{transition}` happens at once")]
    Happens {
        /// The transition.
        transition: &'static str,
    },
    /// What contacts do there sets it in motion.
    #[error("with `{states}` the acceleration of `{coordinate}` is {acceleration:.3e}")]
    Accelerates {
        /// What contacts do.
        states: String,
        /// The coordinate.
        coordinate: &'static str,
        /// Its acceleration, in its unit ÷ s².
        acceleration: f64,
    },
    /// The mode cannot be entered there.
    #[error(transparent)]
    Stops(Box<Reason>),
}

/// What was tried, in a sentence.
pub(super) fn tried(all: &[Tried]) -> String {
    let each = all.iter().map(|Tried { mode, why }| match mode {
        Some(mode) => format!("`{mode}`: {why}"),
        None => why.to_string(),
    });
    each.collect::<Vec<_>>().join("; ")
}

/// Why events that accumulate do not come to rest.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Restless {
    /// They have no limit.
    #[error(
        "their durations do not shrink like a geometric series, so that no limit is known; a mode is missing in which the motion goes on between them"
    )]
    NoLimit,
    /// They have none that numbers resolve.
    #[error(
        "its hops are lower than the rounding of its gap, and their durations do not shrink like a geometric series, so that no limit is known"
    )]
    BelowRounding,
    /// No mode is there in which they rest.
    #[error("{}", no_rest(of, unfit, *fitting))]
    NoRest {
        /// The modes in which they happen.
        of: Vec<&'static str>,
        /// The rests that are declared for these, none of which fits.
        unfit: Vec<Unfit>,
        /// A mode that fits, for which no rest is declared.
        fitting: Option<&'static str>,
    },
}

/// A declared rest that does not fit the limit of an accumulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Unfit {
    /// Its mode.
    pub mode: &'static str,
    /// What the mode holds: a coordinate, `theta`, or its rate, `theta.rate`.
    pub holds: String,
    /// Where it is held.
    pub held: f64,
    /// Where it is in the limit.
    pub there: f64,
    /// The unit of both.
    pub unit: String,
}

fn no_rest(of: &[&str], unfit: &[Unfit], fitting: Option<&str>) -> String {
    let modes = match of {
        [one] => format!("mode `{one}`"),
        several => format!("modes `{}`", several.join("`, `")),
    };
    let each = unfit.iter().map(|unfit| {
        let Unfit {
            mode,
            holds,
            held,
            there,
            unit,
        } = unfit;
        format!(
            "rest in `{mode}` holds `{holds}` at {held} {unit}, which is {there:.6e} {unit} there"
        )
    });
    let why = match unfit {
        [] => format!("no rest is declared for {modes}"),
        _ => format!(
            "no rest that is declared for {modes} fits the limit: {}",
            each.collect::<Vec<_>>().join("; ")
        ),
    };
    match fitting {
        Some(target) => {
            let rests = of.iter().map(|of| format!("`model.rest({of}, {target})`"));
            format!(
                "{why}; mode `{target}` fits it: if the motion comes to rest there, declare {}",
                rests.collect::<Vec<_>>().join(" and ")
            )
        }
        None => format!("{why}; no mode of the model fits the limit"),
    }
}
