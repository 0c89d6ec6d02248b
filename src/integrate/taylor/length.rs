//! Order and length of a step.

use super::super::logarithm::{Factor, natural_logarithm, root};
use super::series::ORDERS;

/// What a step costs besides its series (search for events and the engine's loop), what an order
/// costs for each coordinate, and what a product in a convolution costs, in ns: measured on the
/// benchmark problems. Their ratios decide, and these hardly depend on the processor.
const STEP: f64 = 120.0;
const ORDER: f64 = 10.0;
const PRODUCT: f64 = 0.6;

/// Least order: so many terms decide about the length.
const LEAST: usize = 5;

/// Order at which a unit of time is cheapest for a relative tolerance ε.
///
/// A step of order p costs a + b p + c p²/2 with c in proportion to the number of convolutions. A
/// series with radius of convergence ρ meets ε with h = ρ ε^(1/p) (Jorba and Zou 2005, section 3.2).
/// Where there is no convolution the motion is a sum of exponentials, whose terms are (λh)^p/p!, so
/// that h = (p! ε)^(1/p)/λ grows with p nearly at no cost. Half a period, λh = π, is enough: within
/// longer steps guards swing to and fro, and their roots take longer to find than a further step.
pub(super) fn order(tolerance: f64, convolutions: usize, coordinates: usize) -> usize {
    let digits = natural_logarithm(tolerance);
    let half_period = natural_logarithm(std::f64::consts::PI);
    let mut factorial = 0.0; // its logarithm
    let mut best = (LEAST, f64::INFINITY);
    for order in 1..=ORDERS - 2 {
        let p = order as f64;
        factorial += natural_logarithm(p);
        if order < LEAST {
            continue;
        }
        if convolutions == 0 {
            best.0 = order;
            if factorial + digits >= p * half_period {
                break;
            }
            continue;
        }
        let products = 0.5 * p * p * convolutions as f64;
        let cost = STEP + ORDER * p * coordinates as f64 + PRODUCT * products;
        let cost = natural_logarithm(cost) - digits / p;
        if cost < best.1 {
            best = (order, cost);
        }
    }
    best.0
}

/// A term before the last ones, which limits the length where those happen to vanish.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EarlierTerm {
    /// Power of τ in the velocity.
    pub power: usize,
    /// What the length at which this term equals the tolerance is multiplied with.
    pub factor: Factor,
}

/// The terms of order p − 3 and p − 2 of a method of order `p` ≥ 5.
///
/// From a state of high symmetry only every fourth term differs from zero (a pendulum released from the
/// horizontal: τ², τ⁶, τ¹⁰ …), so that the two last terms tell nothing. A term of order k tells the
/// radius of convergence, ρ = h_k ε^(−1/k) with the length h_k at which it equals the tolerance, and from
/// there the length for order p, ρ ε^(1/p). Without convolutions the radius is infinite, and what the
/// terms tell of it grows in proportion to their order.
pub(super) fn earlier_terms(tolerance: f64, p: usize, convolutions: usize) -> [EarlierTerm; 2] {
    [p - 3, p - 2].map(|power| {
        let growth = match convolutions {
            0 => p as f64 / power as f64,
            _ => 1.0,
        };
        EarlierTerm {
            power,
            factor: Factor::new(growth * root(tolerance, power) / root(tolerance, p)),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_follows_tolerance_and_costs() {
        let orders = |convolutions| [1e-3, 1e-6, 1e-9, 1e-12].map(|e| order(e, convolutions, 1));
        for convolutions in [0, 2, 100] {
            let orders = orders(convolutions);
            assert!(orders.is_sorted() && orders[3] <= ORDERS - 2, "{orders:?}");
        }
        // Where convolutions are all that costs, p = 1 − ½ ln ε (Jorba and Zou).
        assert!(orders(10_000)[3].abs_diff(14) <= 1, "{:?}", orders(10_000));
        assert!(orders(2)[3] > orders(100)[3]);
    }
}
