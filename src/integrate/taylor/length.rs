//! Order and length of a step.

use super::super::logarithm::{
    BIAS, PLACES, binary_logarithm, natural_logarithm, part, places, power_of_two, reciprocal,
};
use super::super::stages;
use crate::numerics::{ORDERS, SeriesKind};

/// What a step costs besides its series (search for events and the engine's loop), what an order
/// costs for each coordinate, and what a product in a convolution costs, in ns. Their ratios decide, and these
/// hardly depend on the processor: they lie between those of steps alone and of steps with their events, and are
/// set where the shaken rocking block takes little time. Of the orders 10, 12 … 30 those with the least are 18 at
/// 1e-3, 14 to 18 at 1e-6, 20 and 22 at 1e-9, 24 to 30 at 1e-12; it gets 18, 18, 22, 26.
const STEP: f64 = 200.0;
const ORDER: f64 = 4.0;
const PRODUCT: f64 = 0.25;

/// Least order: five terms decide about the length, and the term of order s + 1 about that of a Radau IIA step of
/// s ≥ 5 stages ([`super::Implicit`]).
const LEAST: usize = 6;

/// The search for events works on coefficients by fours, of which a coordinate has two more than orders.
const FULL: usize = 4;

/// λh of the longest step of a linear motion: seven eighths of a period. An oscillation that comes to an event comes to
/// it within a period mostly, as a stick-slip oscillator does, and then each flight is one step. Longer ones cost more:
/// behind the fall of a guard they see it rise again, and the search has to tell the two from each other. The eighth
/// is left since the last terms tell λ to some per cent only. The largest terms, e^5.5 times the motion, leave rounding
/// errors of 3e-14.
const LONGEST: f64 = 0.875 * std::f64::consts::TAU;

/// Where so many steps or more are still to be made, those of a linear motion take half a period only
/// ([`half_period`]): there no flight is one step, and the coefficients of high orders would overflow.
pub(super) const MANY: f64 = 4096.0;

/// Cost of the series of an order, in ns.
fn series(order: usize, convolutions: usize, coordinates: usize) -> f64 {
    let p = order as f64;
    ORDER * p * coordinates as f64 + PRODUCT * 0.5 * p * p * convolutions as f64
}

/// The highest order whose series costs no more than the rest of a step. Events cut steps: where a flight
/// takes one step instead of two, all of the second is saved, so that a lower order gains little, and nothing at
/// most tolerances (`docs/notes/series.md`, "An order costs less than a step").
fn cheap(convolutions: usize, coordinates: usize) -> usize {
    let full = (LEAST..=ORDERS - 2).rev().filter(|p| (p + 2) % FULL == 0);
    let mut affordable = full.filter(|&p| series(p, convolutions, coordinates) <= STEP);
    affordable.next().unwrap_or(LEAST)
}

/// Order at which a unit of time is cheapest for a relative tolerance ε, if it is not below [`cheap`].
///
/// A step of order p costs a + b p + c p²/2 with c in proportion to the number of convolutions. A
/// series with radius of convergence ρ meets ε with h = ρ ε^(1/p) (Jorba and Zou 2005, section 3.2).
/// Where there is no convolution the motion is a sum of exponentials, whose terms are (λh)^p/p!, so
/// that h = (p! ε)^(1/p)/λ grows with p nearly at no cost, up to a period ([`LONGEST`]).
/// A series that ends has no need of more orders than those that are looked at.
pub(super) fn order(tolerance: f64, kind: SeriesKind, coordinates: usize) -> usize {
    match kind {
        SeriesKind::Ends => LEAST.max(stages(tolerance) + 1),
        SeriesKind::Entire => entire(tolerance, LONGEST),
        SeriesKind::Convolved(convolutions) => {
            let cheap = cheap(convolutions, coordinates);
            cheapest(tolerance, convolutions, coordinates).max(cheap)
        }
    }
}

/// The order of a linear motion where there are [`MANY`] steps, if it is less than [`order`].
pub(super) fn half_period(tolerance: f64, kind: SeriesKind) -> Option<usize> {
    let order = entire(tolerance, std::f64::consts::PI);
    (kind == SeriesKind::Entire && order < entire(tolerance, LONGEST)).then_some(order)
}

/// The least order p for which (λh)^p/p! meets a tolerance, as far as there are so many.
fn entire(tolerance: f64, angle: f64) -> usize {
    let digits = natural_logarithm(tolerance);
    let angle = natural_logarithm(angle);
    let mut factorial = 0.0; // its logarithm
    for order in 1..ORDERS - 2 {
        let p = order as f64;
        factorial += natural_logarithm(p);
        if order >= LEAST && factorial + digits >= p * angle {
            return order;
        }
    }
    ORDERS - 2
}

/// The order at which ρ ε^(1/p) costs least.
fn cheapest(tolerance: f64, convolutions: usize, coordinates: usize) -> usize {
    let digits = natural_logarithm(tolerance);
    let mut best = (LEAST, f64::INFINITY);
    for order in LEAST..=ORDERS - 2 {
        let cost = STEP + series(order, convolutions, coordinates);
        let cost = natural_logarithm(cost) - digits / order as f64;
        if cost < best.1 {
            best = (order, cost);
        }
    }
    best.0
}

/// The terms that limit the length of a step of order p ≥ 6: those of order p − 1, p and p + 1, and before
/// them those of order p − 3 and p − 2.
///
/// Two last orders of each of coordinates and velocities are looked at, since those of an even or odd
/// motion vanish alternately. From a state of high symmetry only every fourth term differs from zero (a
/// pendulum released from the horizontal: τ², τ⁶, τ¹⁰ …), so that the last terms tell nothing. A term of
/// order k tells the radius of convergence, ρ = h_k ε^(−1/k) with the length h_k at which it equals the
/// tolerance, and from there the length for order p, ρ ε^(1/p). Without convolutions the radius is
/// infinite, and what the terms tell of it grows in proportion to their order.
///
/// Lengths are compared as logarithms in [`PLACES`]: whole numbers, which a power of two as the unit of time moves by
/// the same in all of them. They are right to 0.05 ÷ the power, and 1 % more is lost when the shortest becomes a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Terms {
    /// Powers k of τ.
    pub powers: [usize; 5],
    /// Those that [`part`] takes instead.
    reciprocals: [u64; 5],
    /// What is added to the logarithm of a term ÷ its power, so that it is that of the reciprocal of a length.
    pub offsets: [i64; 5],
}

impl Terms {
    /// Those of a method of order `p`.
    pub fn new(tolerance: f64, p: usize, kind: SeriesKind) -> Self {
        let powers = [p - 1, p, p + 1, p - 3, p - 2];
        let one = f64::from(1_u32 << PLACES);
        let offsets = powers.map(|power| {
            // What the bits of a number leave out of its logarithm, on average.
            let missed = 0.043 * one - BIAS as f64;
            let of_factor = one * factor(tolerance, power, p, kind);
            (missed / power as f64 - of_factor).round() as i64
        });
        Terms {
            powers,
            reciprocals: powers.map(reciprocal),
            offsets,
        }
    }

    /// The shortest of the lengths that terms of these sizes, in units of the tolerance, allow.
    #[inline(always)]
    pub fn length(&self, sizes: [f64; 5]) -> f64 {
        let logarithms: [i64; 5] = std::array::from_fn(|k| match sizes[k] >= f64::MIN_POSITIVE {
            true => part(places(sizes[k]), self.reciprocals[k]) + self.offsets[k],
            false => i64::MIN,
        });
        let [a, b, c, d, e] = logarithms;
        match a.max(b).max(c.max(d)).max(e) {
            i64::MIN => f64::INFINITY,
            shortest => power_of_two(-shortest),
        }
    }
}

/// What limits the length of steps of several orders, and how these lengths compare.
#[derive(Debug, Clone)]
pub(super) struct Orders {
    first: usize,
    terms: Vec<Terms>,
    /// Lengths of steps, ÷ that of the highest order.
    lengths: Vec<f64>,
    /// What a step costs, in ns.
    costs: Vec<f64>,
}

impl Orders {
    /// Those from `least` to `highest` of a method of that order, none below [`LEAST`].
    pub fn new(
        tolerance: f64,
        (least, highest): (usize, usize),
        kind: SeriesKind,
        coordinates: usize,
    ) -> Self {
        let first = least.max(LEAST).min(highest);
        let one = f64::from(1_u32 << PLACES);
        let convolutions = match kind {
            SeriesKind::Convolved(convolutions) => convolutions,
            _ => 0,
        };
        // As a term of one order tells the length that another has.
        let length = |p| power_of_two((one * factor_of_orders(tolerance, highest, p, kind)) as i64);
        Orders {
            first,
            terms: (first..=highest)
                .map(|p| Terms::new(tolerance, p, kind))
                .collect(),
            lengths: (first..=highest).map(length).collect(),
            costs: (first..=highest)
                .map(|p| STEP + series(p, convolutions, coordinates))
                .collect(),
        }
    }

    /// The terms that limit a step of an order.
    #[inline(always)]
    pub fn terms(&self, order: usize) -> &Terms {
        &self.terms[order - self.first]
    }

    /// The order with which steps cost least of which so many need an order for twice the length that they are to have
    /// ([`super::Taylor::step`]): with a lower one they are made in pieces.
    pub fn cheapest_for(&self, needed: &[u64]) -> usize {
        let pieces = |need: usize, own: usize| {
            let whole = 0.5 * self.lengths[need] / self.lengths[own];
            whole.ceil().max(1.0)
        };
        let needed = &needed[self.first..][..self.lengths.len()];
        let cost = |own: usize| {
            let steps = needed.iter().enumerate();
            let steps: f64 = steps.map(|(need, &n)| n as f64 * pieces(need, own)).sum();
            steps * self.costs[own]
        };
        let all = 0..self.lengths.len();
        let best = all.min_by(|&a, &b| cost(a).total_cmp(&cost(b)));
        self.first + best.expect("there is an order")
    }

    /// The least order whose step has a length, or the highest, where one of an order would have had the length `last.1`.
    #[inline]
    pub fn least(&self, last: (usize, f64), length: f64) -> usize {
        let scale = last.1 / self.lengths[last.0 - self.first];
        let enough = self.lengths.iter().position(|own| own * scale >= length);
        self.first + enough.unwrap_or(self.lengths.len() - 1)
    }
}

/// Binary logarithm of what the length at which the term of a power equals the tolerance is multiplied with.
fn factor(tolerance: f64, power: usize, p: usize, kind: SeriesKind) -> f64 {
    match power + 1 >= p {
        true => 0.0,
        false => factor_of_orders(tolerance, power, p, kind),
    }
}

/// Binary logarithm of the length of a step of order `p` ÷ that of a step of order `power`.
fn factor_of_orders(tolerance: f64, power: usize, p: usize, kind: SeriesKind) -> f64 {
    let radius = (1.0 / p as f64 - 1.0 / power as f64) * binary_logarithm(tolerance);
    match kind {
        SeriesKind::Convolved(_) => radius,
        _ => radius + binary_logarithm(p as f64 / power as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_follows_tolerance_and_costs() {
        let orders = |kind| [1e-3, 1e-6, 1e-9, 1e-12].map(|e| order(e, kind, 1));
        for kind in [
            SeriesKind::Ends,
            SeriesKind::Entire,
            SeriesKind::Convolved(2),
            SeriesKind::Convolved(100),
        ] {
            let orders = orders(kind);
            assert!(orders.is_sorted() && orders[3] <= ORDERS - 2, "{orders:?}");
        }
        // Where convolutions are all that costs, p = 1 − ½ ln ε (Jorba and Zou).
        let costly = orders(SeriesKind::Convolved(10_000));
        assert!(costly[3].abs_diff(14) <= 1, "{costly:?}");
        assert!(orders(SeriesKind::Convolved(2))[3] > orders(SeriesKind::Convolved(100))[3]);
    }

    #[test]
    fn a_series_that_costs_little_is_not_cut_short() {
        assert_eq!(
            [1e-3, 1e-6, 1e-9, 1e-12].map(|e| order(e, SeriesKind::Convolved(3), 1)),
            [18, 18, 22, 26]
        );
        for (convolutions, coordinates) in [(1, 1), (2, 1), (3, 1), (5, 2), (12, 3), (34, 3)] {
            let cheap = cheap(convolutions, coordinates);
            let next = series(cheap + FULL, convolutions, coordinates);
            assert!(cheap == ORDERS - 2 || next > STEP, "{cheap}");
            assert!(order(1e-3, SeriesKind::Convolved(convolutions), coordinates) >= cheap);
            assert_eq!((cheap + 2) % FULL, 0);
        }
        // Where the series is what costs, the tolerance alone decides.
        assert!(order(1e-3, SeriesKind::Convolved(34), 3) < 10 && cheap(34, 3) == LEAST);
    }

    #[test]
    fn a_step_of_a_linear_motion_is_as_long_as_it_may_be() {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let p = order(tolerance, SeriesKind::Entire, 1);
            let factorial = |p: usize| (1..=p).map(|k| k as f64).product::<f64>();
            let length = |p| f64::powf(factorial(p) * tolerance, 1.0 / p as f64);
            assert!(length(p) >= LONGEST && length(p - 1) < LONGEST, "{p}");
        }
    }

    /// Lengths of the series of 1/(1 − τ) and of exp τ, whose terms are known.
    #[test]
    fn the_least_order_that_reaches_a_length_is_found() {
        let tolerance = 1e-9;
        let of_pole = |p: usize| f64::powf(tolerance, 1.0 / p as f64);
        let of_exponential = |p: usize| p as f64 * of_pole(p); // (p!)^(1/p) grows as p
        let convolved = SeriesKind::Convolved(3);
        for (kind, length) in [
            (convolved, &of_pole as &dyn Fn(usize) -> f64),
            (SeriesKind::Entire, &of_exponential),
        ] {
            let orders = Orders::new(tolerance, (0, 22), kind, 1);
            for last in [6, 13, 22] {
                for p in 7..=22 {
                    let between = 0.5 * (length(p - 1) + length(p));
                    assert_eq!(orders.least((last, length(last)), between), p);
                }
                let least = orders.least((last, length(last)), 0.5 * length(6));
                assert_eq!(least, LEAST);
            }
            assert_eq!(orders.least((22, length(22)), 2.0 * length(22)), 22);
            assert_eq!(orders.least((22, f64::INFINITY), 1.0), LEAST);
        }
    }

    #[test]
    fn one_order_for_all_steps_is_that_of_most_of_them() {
        let orders = Orders::new(1e-9, (0, 22), SeriesKind::Convolved(3), 1);
        let mut needed = [0; ORDERS];
        needed[9] = 1;
        assert!(orders.cheapest_for(&needed) <= 9);
        let of_one = orders.cheapest_for(&needed);
        needed[9] = 10_000;
        needed[20] = 1;
        assert_eq!(orders.cheapest_for(&needed), of_one);
        needed[20] = 1_000_000;
        assert!(orders.cheapest_for(&needed) > of_one);
    }

    #[test]
    fn the_length_is_the_shortest_that_a_term_allows() {
        let kind = SeriesKind::Convolved(3);
        let terms = Terms::new(1e-9, 13, kind);
        let mut state = 1_u64;
        let mut draw = || {
            // Knuth's multiplier: any scatter will do.
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..100_000 {
            let scale = 10f64.powf(6.0 * draw() - 3.0);
            let sizes = terms
                .powers
                .map(|n| (scale * (1.0 + 0.1 * draw())).powi(-(n as i32)));
            let all: [f64; 5] = std::array::from_fn(|k| {
                let power = terms.powers[k];
                factor(1e-9, power, 13, kind).exp2() * sizes[k].powf(-1.0 / power as f64)
            });
            let length = terms.length(sizes);
            let least = all.into_iter().fold(f64::INFINITY, f64::min);
            assert!((length / least - 1.0).abs() < 0.02, "{length} {least}");
            for c in [-20, 1, 13] {
                let scaled =
                    std::array::from_fn(|k| sizes[k] * 2f64.powi(-c * terms.powers[k] as i32));
                assert_eq!(terms.length(scaled), length * 2f64.powi(c));
            }
        }
        assert_eq!(terms.length([0.0; 5]), f64::INFINITY);
    }
}
