//! Where a polynomial is largest: intervals that cannot hold what is sought are left out by bounds, all others halved.
//!
//! As a function of φ, with 2s − 1 = −cos φ, a polynomial Σ cₖ Tₖ has derivatives that are bounded by Σ kⁿ|cₖ|
//! everywhere (`interpolants`), so that its values at two points bound it between them.

use super::interpolants::{Interpolants, MOST, Polynomial, point};

/// How often the interval between two nodes is halved at most: at the start of a fall from rest a rate is zero to the
/// fifth order and more, and bounds alone would look at its neighbourhood for ever. What is then left is a thousandth of
/// the window.
const MOST_HALVINGS: u32 = 5;

/// The search of one polynomial.
pub(super) struct SummitSearch {
    /// The polynomial, and its first two derivatives with respect to 2s − 1.
    of: [Polynomial; 3],
    /// Bounds of its second and third derivative with respect to φ.
    bends: [f64; 2],
    /// What is no difference: what the polynomial may be off by.
    least: f64,
    /// The largest value so far.
    pub best: f64,
    /// Where it is, if it was found here.
    pub summit: Option<f64>,
}

/// A point of the polynomial.
#[derive(Clone, Copy)]
struct Point {
    /// Place in the window.
    s: f64,
    /// cos φ and sin φ.
    direction: [f64; 2],
    value: f64,
    /// Derivatives with respect to 2s − 1 and, the first and the second, to φ.
    slope: f64,
    steepness: f64,
    bend: f64,
}

/// The ends of an interval of φ.
struct Ends([Point; 2]);

impl SummitSearch {
    /// Of a polynomial for a value above `best`.
    pub fn new(of: Polynomial, least: f64, best: f64) -> Self {
        let slope = of.derivative();
        SummitSearch {
            bends: [2, 3].map(|power| of.bound_of_derivative(power)),
            of: [of, slope, slope.derivative()],
            least,
            best,
            summit: None,
        }
    }

    /// A point with this place and direction.
    fn point(&self, s: f64, direction: [f64; 2]) -> Point {
        let [value, slope, bend] = self.of.each_ref().map(|of| of.value(s));
        let [cos, sin] = direction;
        Point {
            s,
            direction,
            value,
            slope,
            steepness: slope * sin,
            bend: bend * (sin * sin) + slope * cos,
        }
    }

    /// The interval between two nodes.
    fn between(&self, nodes: [usize; 2]) -> Ends {
        Ends(nodes.map(|node| {
            let (left, right) = (point(node), point(MOST - node));
            self.point(left, [right - left, 2.0 * (left * right).sqrt()])
        }))
    }

    /// Looks for the largest value between two nodes, at this distance in φ.
    pub fn climb(&mut self, nodes: [usize; 2], distance: f64) {
        let ends = self.between(nodes);
        self.climb_halved(ends, distance, 0);
    }

    fn climb_halved(&mut self, Ends([left, right]): Ends, width: f64, halvings: u32) {
        let bends = [left.bend, right.bend];
        // What the polynomial may exceed its values at both ends by: no place is farther from the nearer one than half
        // of the width.
        let most_bend = bends[0].abs().max(bends[1].abs()) + 0.5 * width * self.bends[1];
        let room = 0.125 * width * width * most_bend.min(self.bends[0]);
        let most = left.value.max(right.value) + room;
        if most.is_nan() || most <= self.best {
            return;
        }
        let [rises, falls] = [left.steepness, right.steepness];
        if rises * falls > 0.0 && rises.abs() + falls.abs() > width * self.bends[0] {
            return;
        }
        let is_bent_one_way =
            bends[0] * bends[1] > 0.0 && bends[0].abs() + bends[1].abs() > width * self.bends[1];
        // Bent downwards throughout it has one crest at most; upwards none.
        if is_bent_one_way || room <= self.least || halvings == MOST_HALVINGS {
            if rises > 0.0 && falls < 0.0 {
                let (from, to) = ((left.s, left.slope), (right.s, right.slope));
                let place = self.of[1].crossing(from, to, Interpolants::CLOSE);
                self.note(place, self.of[0].value(place));
            }
            return;
        }
        let sum = [0, 1].map(|i| left.direction[i] + right.direction[i]);
        let length = (sum[0] * sum[0] + sum[1] * sum[1]).sqrt();
        let direction = sum.map(|x| x / length);
        let middle = self.point(0.5 - 0.5 * direction[0], direction);
        self.note(middle.s, middle.value);
        self.climb_halved(Ends([left, middle]), 0.5 * width, halvings + 1);
        self.climb_halved(Ends([middle, right]), 0.5 * width, halvings + 1);
    }

    fn note(&mut self, place: f64, value: f64) {
        if value > self.best {
            (self.best, self.summit) = (value, Some(place));
        }
    }
}
