//! The earliest event of several guards, and all that coincide with it.

use super::{Search, Watch};

/// Answer of [`earliest`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Earliest {
    /// Time of the set of events, in the unit of the searched variable: the last `outside` of its
    /// members, so each of them is beyond its own bracket. `None`: no guard has an event.
    pub time: Option<f64>,
    /// Whether every guard could be resolved, see [`Search::resolved`].
    pub resolved: bool,
}

/// The set of the earliest events of several guards in (`from`, `to`].
///
/// `search(index, from, to, watch, found)` searches one guard, by [`Polynomial::search`] or by
/// [`function::search`], and writes what it finds. Events whose brackets share a double are one set. On return
/// `found[index]` holds the crossing of each member, in the order of the guards, and of every guard
/// the sign remembered at the time of the set (at `to`, where there is none); the answer does not
/// depend on the order.
///
/// [`Polynomial::search`]: super::Polynomial::search
/// [`function::search`]: super::search
///
/// # Panics
///
/// If `watches` and `found` have different lengths.
pub fn earliest(
    from: f64,
    to: f64,
    watches: &[Watch],
    found: &mut [Search],
    mut search: impl FnMut(usize, f64, f64, Watch, &mut Search),
) -> Earliest {
    assert_eq!(
        watches.len(),
        found.len(),
        "as many remembered signs as guards"
    );
    let order = 0..watches.len();
    match at_most_one((from, to), watches, found, order, &mut search) {
        Some(only) => only,
        None => first_of_several((from, to), watches, found, search),
    }
}

/// The event of several guards, each searched once, in an `order`, where there is at most one; `None` where there are several, or where
/// the sign of another guard may have changed before or behind it: what was found of each is written.
#[inline(always)]
pub(in crate::hybrid) fn at_most_one(
    (from, to): (f64, f64),
    watches: &[Watch],
    found: &mut [Search],
    order: impl Iterator<Item = usize>,
    mut search: impl FnMut(usize, f64, f64, Watch, &mut Search),
) -> Option<Earliest> {
    let (mut time, mut events, mut changes, mut resolved) = (None, 0, false, true);
    for index in order {
        let (found, watch) = (&mut found[index], watches[index]);
        search(index, from, to, watch, found);
        resolved &= found.resolved;
        match found.crossing {
            Some(crossing) => (time, events) = (Some(crossing.outside), events + 1),
            // Without an event an unchanged sign has not changed on the way either.
            None => changes |= found.watch != watch,
        }
    }
    (events == 0 || events == 1 && !changes).then_some(Earliest { time, resolved })
}

/// The earliest events, given what was found of each guard.
pub(in crate::hybrid) fn first_of_several(
    (from, to): (f64, f64),
    watches: &[Watch],
    found: &mut [Search],
    mut search: impl FnMut(usize, f64, f64, Watch, &mut Search),
) -> Earliest {
    let mut end = to;
    // Each pass ends earlier than the one before, until the set lies at the end of its window.
    while let Some(time) = time_of_first_set(found) {
        if time == end {
            break;
        }
        end = time;
        for (index, (found, &watch)) in found.iter_mut().zip(watches).enumerate() {
            let event_beyond = found
                .crossing
                .is_some_and(|crossing| crossing.outside > end);
            let sign_unknown = found.crossing.is_none() && found.watch != watch;
            if event_beyond || sign_unknown {
                search(index, from, end, watch, found);
            }
        }
    }
    let resolved = found.iter().all(|found| found.resolved);
    let time = found
        .iter()
        .any(|found| found.crossing.is_some())
        .then_some(end);
    Earliest { time, resolved }
}

/// The last `outside` of the events whose brackets share a double with the earliest.
fn time_of_first_set(found: &[Search]) -> Option<f64> {
    let crossings = || found.iter().filter_map(|found| found.crossing);
    let first = crossings()
        .map(|crossing| crossing.outside)
        .reduce(f64::min)?;
    crossings()
        .filter(|c| c.inside <= first)
        .map(|c| c.outside)
        .reduce(f64::max)
}
