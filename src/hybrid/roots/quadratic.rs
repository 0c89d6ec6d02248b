//! The first fall of a guard that is a parabola, such as the height in a free flight, or a straight line.

use super::first_crossing::{certain_crossing, crossing_beside};
use super::polynomial::{Polynomial, sum_of};
use super::{Isolation, Kind, Search, Watch};

/// Coefficients of a parabola.
pub(super) const ROOM: usize = 3;

/// Writes the first event of an armed guard c₀ + c₁ s + c₂ s² in `from` < s ≤ `to`, or that there is none; false where
/// rounding decides.
#[inline(always)]
pub(super) fn first_crossing<const N: usize>(
    polynomial: &Polynomial<N>,
    (from, to): (f64, f64),
    isolation: Isolation,
    found: &mut Search,
) -> bool {
    let own = &polynomial.coefficients;
    let (c0, c1, c2) = (own[0], own[1], own[2]);
    let start = match from == 0.0 {
        true => c0,
        false => polynomial.value(from),
    };
    let end = polynomial.value(to);
    let margin = Polynomial::<N>::ROUNDING * sum_of(own, f64::abs);
    // Where it would turn: a minimum for c₂ > 0.
    let turn = c0 - 0.25 * c1 * (c1 / c2);
    if end < 0.0 && start > 0.0 {
        let s = match c2 == 0.0 {
            true => -c0 / c1,
            false => falling_root([c0, c1, c2]),
        };
        // A place outside is one by rounding.
        let s = if from < s && s < to { s } else { to };
        let derivatives = [c1 + 2.0 * c2 * s, 2.0 * c2];
        let event = match isolation {
            Isolation::Root => Some(Search::found(s, s, Kind::Crossing, Watch::Violated)),
            Isolation::Bracket => certain_crossing(polynomial, (from, to), s, margin, derivatives),
        };
        let event = event.unwrap_or_else(|| {
            let mut value = |s: f64| polynomial.value(s);
            let point = (s, value(s));
            crossing_beside(&mut value, ((from, start), (to, end)), point)
        });
        *found = match c2 > 0.0 {
            true => event.turning(turn),
            false => event,
        };
        return true;
    }
    let place = -0.5 * (c1 / c2);
    let turns = c2 > 0.0 && from < place && place < to;
    // Where it rises from near zero it does not turn there.
    let least = match from == 0.0 && c1 > 0.0 {
        true => end,
        false => start.min(end).min(if turns { turn } else { start }),
    };
    let is_clear = start > 0.0 && least > margin; // not if one of them is not a number
    if is_clear {
        *found = Search::above(least - margin);
    }
    is_clear
}

/// The first event of an armed guard that is `value` + `slope` · τ in 0 < τ ≤ `length`, by a place in τ
/// ([`Isolation::Root`]), or that there is none; `None` where rounding decides.
#[inline(always)]
pub(in crate::hybrid) fn straight_crossing(value: f64, slope: f64, length: f64) -> Option<Search> {
    let change = slope * length;
    let end = value + change;
    let margin = Polynomial::<2>::ROUNDING * (value.abs() + change.abs());
    if value > 0.0 && end > margin {
        Some(Search::above(end - margin))
    } else if value > 0.0 && end < -margin {
        let place = -value / slope;
        Some(Search::found(place, place, Kind::Crossing, Watch::Violated))
    } else {
        None
    }
}

/// Of the two roots of c₀ + c₁ s + c₂ s² the one at which it falls, without a difference of nearly equal numbers.
#[inline(always)]
fn falling_root([c0, c1, c2]: [f64; 3]) -> f64 {
    let root_of_discriminant = (c1 * c1 - 4.0 * c0 * c2).max(0.0).sqrt();
    match c1 > 0.0 {
        true => (c1 + root_of_discriminant) / (-2.0 * c2),
        false => 2.0 * c0 / (root_of_discriminant - c1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_guard_falls_where_its_polynomial_does() {
        let mut decided = 0;
        for i in 0..20_000 {
            let part = |k: f64| (f64::from(i) * k).fract();
            let value = 10f64.powf(6.0 * part(0.618_033_988_749_894_9) - 3.0);
            // From twice as fast as it must fall to reach zero to as fast upwards; near that, to the last places.
            let slope = match i % 4 {
                0 => -value * (1.0 + f64::EPSILON * f64::from(i % 100 - 50)),
                _ => value * (4.0 * part(0.754_877_666_246_692_7) - 2.0),
            };
            let length = 3.0;
            let mut expected = Search::nothing(Watch::Armed);
            let polynomial = Polynomial {
                coefficients: [value, slope / length * length, 0.0],
            };
            polynomial.search_armed((0.0, 1.0), 0.0, Isolation::Root, &mut expected);
            let Some(found) = straight_crossing(value, slope / length, length) else {
                assert_eq!(i % 4, 0, "{value} {slope}");
                continue;
            };
            decided += 1;
            assert_eq!(found.crossing.is_some(), expected.crossing.is_some());
            assert_eq!(found.watch, expected.watch);
            if let (Some(own), Some(other)) = (found.crossing, expected.crossing) {
                assert!((own.outside / length / other.outside - 1.0).abs() < 1e-14);
            } else {
                // Where it rises it does not turn at its start.
                assert!(0.0 <= found.turn && found.turn <= value + slope);
            }
        }
        assert!(decided > 15_000);
    }
}
