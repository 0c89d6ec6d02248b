//! A guard that is any smooth function.

use super::bracket::{Point, departure};
use super::chebyshev::{DEGREE, Interpolant, NODES, place};
use super::doubles::{middle, moved};
use super::extrema::{Expansion, Places, extrema};
use super::walk::{Pieces, walk};
use super::{Crossing, Kind, Search, Watch};

/// Evaluations after which a search stops halving windows. One singular place (a jump, a kink at
/// zero) is halved down to neighbouring doubles in 53 halvings, with two windows each.
const EVALUATIONS: usize = f64::MANTISSA_DIGITS as usize * 2 * NODES;

/// Half of a double's digits. Over this fraction of a window a function that the window's size
/// resolves hardly changes, and rounding errors have become independent.
const HALF_DIGITS: u32 = f64::MANTISSA_DIGITS / 2;

/// The earliest event of `guard` in `from` < t ≤ `to`.
///
/// `watch` is the sign remembered from before `from`; `noise` is a bound of the rounding error of
/// `guard`, in its unit, used while it is dormant and to see when it is resolved (0: unknown). A
/// dormant guard is exactly 0 at `from`, or has not left zero since it was.
///
/// A guard far from zero takes 5 evaluations, one that falls about 15; see the
/// [module's page](super) for what is guaranteed.
pub fn search(
    guard: impl FnMut(f64) -> f64,
    from: f64,
    to: f64,
    watch: Watch,
    noise: f64,
) -> Search {
    if from >= to {
        return Search::quiet(watch);
    }
    Guard {
        function: guard,
        noise,
        evaluations: 0,
    }
    .window(from, to, watch)
}

struct Guard<F> {
    function: F,
    noise: f64,
    evaluations: usize,
}

/// A window and the guard's values at its nodes.
struct Samples {
    from: f64,
    to: f64,
    nodes: [f64; NODES],
    values: [f64; NODES],
}

impl Samples {
    fn new(from: f64, to: f64) -> Self {
        let mut nodes = std::array::from_fn(|j| from + place(j) * (to - from));
        nodes[DEGREE] = to;
        Self {
            from,
            to,
            nodes,
            values: [f64::NAN; NODES],
        }
    }

    /// Distance from the start as a fraction of the window.
    fn fraction(&self, t: f64) -> f64 {
        (t - self.from) / (self.to - self.from)
    }

    fn time(&self, fraction: f64) -> f64 {
        (self.from + fraction * (self.to - self.from)).clamp(self.from, self.to)
    }
}

impl<F: FnMut(f64) -> f64> Guard<F> {
    fn value(&mut self, t: f64) -> f64 {
        self.evaluations += 1;
        (self.function)(t)
    }

    /// The earliest event of a window, or the remembered sign at its end.
    fn window(&mut self, from: f64, to: f64, watch: Watch) -> Search {
        let mut samples = Samples::new(from, to);
        for degree in [4, 8, DEGREE] {
            let stride = DEGREE / degree;
            for index in 0..=degree {
                // Every second node is one of the lower degree.
                if degree == 4 || index % 2 == 1 {
                    samples.values[index * stride] = self.value(samples.nodes[index * stride]);
                }
            }
            if let Some(search) = self.decide(&samples, degree, watch) {
                return search;
            }
        }
        if watch == Watch::Dormant && self.is_rough(&samples) {
            return Search {
                resolved: false,
                ..Search::quiet(watch)
            };
        }
        let centre = from + (to - from) / 2.0;
        let neighbours = !(from < centre && centre < to);
        if neighbours || self.evaluations >= EVALUATIONS {
            return Search {
                resolved: neighbours,
                ..self.by_values(&samples, watch)
            };
        }
        let first = self.window(from, centre, watch);
        if first.crossing.is_some() {
            return first;
        }
        let second = self.window(centre, to, first.watch);
        Search {
            resolved: first.resolved && second.resolved,
            ..second
        }
    }

    /// The answer from the interpolant of this degree, if it is good enough to give one.
    fn decide(&mut self, samples: &Samples, degree: usize, watch: Watch) -> Option<Search> {
        let at_start = samples.values[0];
        if watch == Watch::Dormant && self.noise == 0.0 && at_start == 0.0 {
            return self.leave_zero(samples, degree);
        }
        let interpolant = Interpolant::through(&samples.values, degree);
        let error = interpolant.error();
        let (below, above) = interpolant.expansion.bounds();
        if watch == Watch::Armed && below > error || watch == Watch::Violated && above < -error {
            return Some(Search::quiet(watch));
        }
        // A guard that slept through the window before, and whose noise is unknown, is awake where
        // it differs from zero by more than its interpolant can be wrong.
        let unknown = watch == Watch::Dormant && self.noise == 0.0;
        let noise = if unknown { error } else { self.noise };
        let ends = (at_start, samples.values[DEGREE]);
        walk(
            &mut Cut::new(self, samples, degree, interpolant, ends, 0, noise),
            watch,
            noise,
        )
    }

    /// A guard that is exactly zero at the start: its zero is divided out, of the lowest order that
    /// leaves a quotient with a sign there, and all lower orders must be resolved as zero.
    fn leave_zero(&mut self, samples: &Samples, degree: usize) -> Option<Search> {
        let from = samples.from;
        if samples
            .values
            .iter()
            .step_by(DEGREE / degree)
            .all(|&value| value == 0.0)
        {
            return Some(Search::quiet(Watch::Dormant));
        }
        let fractions = samples.nodes.map(|node| samples.fraction(node));
        for order in 1..degree {
            let (interpolant, quotients) =
                Interpolant::deflated(&samples.values, &fractions, order, degree);
            let start = quotients[0];
            if start < -interpolant.error()
                && let Some(right) = self.negative_near(from, samples.nodes[DEGREE / degree])
            {
                let (l, r, flew) = departure(&mut |t| self.value(t), from, right);
                let kind = if flew {
                    Kind::Fall
                } else {
                    Kind::LeavesNegative
                };
                return Some(Search::found(l.0, r.0, kind, Watch::Violated));
            } else if start.abs() > interpolant.error() {
                let ends = (start, quotients[DEGREE]);
                let cut = &mut Cut::new(self, samples, degree, interpolant, ends, order, 0.0);
                return walk(cut, Watch::Armed, 0.0);
            } else if !interpolant.is_resolved(0.0, degree) {
                return None;
            }
        }
        None
    }

    /// A place in (`from`, `right`] where the guard is negative, nearer to `from` by halving the
    /// number of doubles.
    fn negative_near(&mut self, from: f64, mut right: f64) -> Option<Point> {
        while right > from {
            let value = self.value(right);
            if value < 0.0 {
                return Some((right, value));
            }
            right = middle(from, right);
        }
        None
    }

    /// Whether the guard changes over a tiny fraction of the window by as much as its values: it is
    /// then rounding noise about zero, or rougher than doubles resolve.
    fn is_rough(&mut self, samples: &Samples) -> bool {
        let largest = samples.values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let shift = (samples.to - samples.from) / f64::from(1_u32 << HALF_DIGITS);
        let mut change = 0.0_f64;
        for index in 0..DEGREE {
            let shifted = self.value(samples.nodes[index] + shift);
            change = change.max((shifted - samples.values[index]).abs());
        }
        // A smooth function changes by 2n²/2²⁶, 1e-5, of its values at most (Markov's inequality),
        // independent values by as much as they are large; one half separates the two.
        change >= 0.5 * largest
    }

    /// By the values at the nodes alone.
    fn by_values(&mut self, samples: &Samples, watch: Watch) -> Search {
        if watch == Watch::Dormant && self.noise == 0.0 {
            return Search::quiet(watch);
        }
        let noise = self.noise;
        let search = walk(
            &mut Values {
                guard: self,
                samples,
            },
            watch,
            noise,
        )
        .expect("every node has a value");
        match search.crossing {
            Some(crossing) if crossing.kind == Kind::Fall => {
                let kind = self.classify(crossing, samples);
                Search {
                    crossing: Some(Crossing { kind, ..crossing }),
                    ..search
                }
            }
            _ => search,
        }
    }

    /// Tells a jump and a pole from a fall by comparing the bracket with places 2²⁶ doubles away:
    /// what is continuous has changed by much more there, a jump by no more, and next to a pole
    /// the value, even that of a logarithm, is at least twice the value there.
    fn classify(&mut self, crossing: Crossing, samples: &Samples) -> Kind {
        let away = 1_i64 << HALF_DIGITS;
        let inside = self.value(crossing.inside);
        let outside = self.value(crossing.outside);
        let before = self.value(moved(crossing.inside, -away, samples.from, samples.to));
        let after = self.value(moved(crossing.outside, away, samples.from, samples.to));
        // A value at the pole itself may be infinite or not a number.
        let grows = |near: f64, far: f64| near.is_nan() || near.abs() >= 2.0 * far.abs();
        if grows(inside, before) && grows(outside, after) {
            Kind::Pole
        } else if inside - outside > 0.5 * (before - after) {
            Kind::Jump
        } else {
            Kind::Fall
        }
    }
}

/// The guard cut at the extrema of its interpolant, divided by the `order`-th power of the fraction
/// of the window.
struct Cut<'g, F> {
    guard: &'g mut Guard<F>,
    samples: &'g Samples,
    interpolant: Interpolant,
    extrema: Places<NODES>,
    /// The guard's own values at the ends, divided as well.
    ends: (f64, f64),
    order: usize,
    /// Up to here values mean zero.
    noise: f64,
    resolved: bool,
}

impl<'g, F: FnMut(f64) -> f64> Cut<'g, F> {
    fn new(
        guard: &'g mut Guard<F>,
        samples: &'g Samples,
        degree: usize,
        interpolant: Interpolant,
        ends: (f64, f64),
        order: usize,
        noise: f64,
    ) -> Self {
        let resolved = interpolant.is_resolved(guard.noise, degree);
        let extrema = extrema(&interpolant.expansion);
        Self {
            guard,
            samples,
            interpolant,
            extrema,
            ends,
            order,
            noise,
            resolved,
        }
    }
}

impl<F: FnMut(f64) -> f64> Pieces for Cut<'_, F> {
    fn len(&self) -> usize {
        self.extrema.as_slice().len() + 2
    }

    fn node(&self, index: usize) -> f64 {
        if index == 0 {
            return self.samples.from;
        }
        let extremum = self.extrema.as_slice().get(index - 1);
        extremum.map_or(self.samples.to, |&fraction| self.samples.time(fraction))
    }

    fn value(&mut self, index: usize) -> Option<(f64, bool)> {
        if index == 0 {
            return Some((self.ends.0, false));
        }
        let Some(&fraction) = self.extrema.as_slice().get(index - 1) else {
            return Some((self.ends.1, false));
        };
        let value = self.interpolant.expansion.value(fraction);
        if value.abs() > self.noise + self.interpolant.error() {
            Some((value, false))
        } else if self.resolved {
            let node = self.node(index);
            Some((self.own(node), true))
        } else {
            None
        }
    }

    fn own(&mut self, t: f64) -> f64 {
        let fraction = self.samples.fraction(t);
        let value = self.guard.value(t);
        (0..self.order).fold(value, |quotient, _| quotient / fraction)
    }
}

/// The guard at the nodes, taken at its word.
struct Values<'g, F> {
    guard: &'g mut Guard<F>,
    samples: &'g Samples,
}

impl<F: FnMut(f64) -> f64> Pieces for Values<'_, F> {
    fn len(&self) -> usize {
        NODES
    }

    fn node(&self, index: usize) -> f64 {
        self.samples.nodes[index]
    }

    fn value(&mut self, index: usize) -> Option<(f64, bool)> {
        Some((self.samples.values[index], false))
    }

    fn own(&mut self, t: f64) -> f64 {
        self.guard.value(t)
    }
}
