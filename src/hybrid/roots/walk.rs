//! The walk from left to right over the monotone pieces of a guard, with the remembered sign.

use super::bracket::{Point, close, lowest};
use super::doubles::above;
use super::{Kind, Search, Watch};

/// A guard on a window that is cut at `nodes` into pieces on which it is monotone.
pub(super) trait Pieces {
    /// Number of nodes, the two ends of the window included.
    fn len(&self) -> usize;
    /// Ascending.
    fn node(&self, index: usize) -> f64;
    /// Value at a node, and whether its sign is within the error of the representation; `None`
    /// where the representation is not good enough to tell.
    fn value(&mut self, index: usize) -> Option<(f64, bool)>;
    /// Bound of the rounding error of the guard's own value at a node, as far as it is known.
    fn rounding(&self, index: usize) -> f64;
    /// The guard's own value anywhere in the window.
    fn own(&mut self, x: f64) -> f64;
    /// What a change of sign between two neighbouring doubles is.
    fn kind(&mut self, _inside: Point, _outside: Point) -> Kind {
        Kind::Crossing
    }
}

/// The earliest event, or `None` if the representation does not decide. A dormant guard leaves zero
/// where it exceeds its rounding error.
pub(super) fn walk(pieces: &mut impl Pieces, mut watch: Watch) -> Option<Search> {
    let start = pieces.node(0);
    let mut left = (start, pieces.value(0)?.0);
    let mut least = f64::INFINITY;
    if watch == Watch::Dormant && left.1.abs() > pieces.rounding(0) {
        watch = Watch::of(left.1);
        if watch == Watch::Violated {
            return Some(Search::found(
                start,
                above(start),
                Kind::LeavesNegative,
                watch,
            ));
        }
    }
    for index in 1..pieces.len() {
        let (mut right, doubtful) = {
            let (value, doubtful) = pieces.value(index)?;
            ((pieces.node(index), value), doubtful)
        };
        if right.0 <= left.0 {
            continue;
        }
        let inner = index + 1 < pieces.len();
        let noise = pieces.rounding(index);
        match watch {
            Watch::Dormant if right.1 > noise => watch = Watch::Armed,
            Watch::Dormant if right.1 < -noise => {
                let mut beyond = |x| pieces.own(x) + noise;
                let (l, r) = close(
                    &mut beyond,
                    (left.0, left.1 + noise),
                    (right.0, right.1 + noise),
                );
                return Some(Search::found(
                    l.0,
                    r.0,
                    Kind::LeavesNegative,
                    Watch::Violated,
                ));
            }
            // A rise that rounding may have made arms only if it lasts.
            Watch::Violated if right.1 > if inner { noise } else { 0.0 } => {
                watch = Watch::Armed;
            }
            Watch::Armed => {
                if left.1 == 0.0 && right.1 > 0.0 {
                    let outside = above(left.0);
                    let value = pieces.own(outside);
                    return Some(touch(left.0, outside, value, noise));
                }
                if doubtful && right.1 >= 0.0 && inner {
                    let high = pieces.node(index + 1);
                    right = lowest(&mut |x| pieces.own(x), right, left.0, high);
                }
                if right.1 < 0.0 {
                    let (l, r) = close(&mut |x| pieces.own(x), left, right);
                    let kind = pieces.kind(l, r);
                    let event = Search::found(l.0, r.0, kind, Watch::Violated);
                    return Some(match kind {
                        Kind::Crossing => event.turning(right.1),
                        _ => event,
                    });
                }
                least = least.min(right.1);
            }
            _ => {}
        }
        left = right;
    }
    Some(match watch {
        Watch::Armed => Search::above(least),
        _ => Search::nothing(watch),
    })
}

/// A touch of zero at `inside`. Among the zeros and the rounding errors that follow it the guard is
/// dormant, so that they are not events of their own.
fn touch(inside: f64, outside: f64, value: f64, noise: f64) -> Search {
    if value < 0.0 {
        return Search::found(inside, outside, Kind::Crossing, Watch::Violated);
    }
    let watch = if value <= noise {
        Watch::Dormant
    } else {
        Watch::Armed
    };
    Search::found(inside, outside, Kind::Touch, watch)
}
