//! A guard that is any smooth function.

use super::bracket::{Point, departure};
use super::chebyshev::{DEGREE, Interpolant, NODES, SAMPLES, point};
use super::doubles::moved;
use super::extrema::{Expansion, Extrema, extrema};
use super::walk::{Pieces, walk};
use super::{Crossing, Kind, Search, Watch};

/// Evaluations after which a search stops halving windows. One singular place (a jump, a kink at
/// zero) is halved down to neighbouring doubles in 53 halvings, with two windows each.
const EVALUATIONS: usize = f64::MANTISSA_DIGITS as usize * 2 * SAMPLES;

/// Half of a double's digits. Over this fraction of a window a function that the window's size
/// resolves hardly changes, and rounding errors have become independent.
const HALF_DIGITS: u32 = f64::MANTISSA_DIGITS / 2;

/// The earliest event of `guard` in `from` < t ≤ `to`.
///
/// `watch` is the sign remembered from before `from`; `noise` is a bound of the rounding error of
/// `guard`, in its unit, used while it is dormant and to see when it is resolved (0: unknown). A
/// dormant guard is exactly 0 at `from`, or has not left zero since it was.
///
/// A guard far from zero, compared with its variation, takes 6 evaluations, a nearer one 10 or 18,
/// one that falls about 20, one that is dormant at the start 10 to 20 more; see the
/// [module's page](super) for what is guaranteed.
pub fn search(
    mut guard: impl FnMut(f64) -> f64,
    from: f64,
    to: f64,
    watch: Watch,
    noise: f64,
) -> Search {
    if from >= to {
        return Search::nothing(watch);
    }
    Guard {
        function: &mut guard,
        noise,
        evaluations: 0,
    }
    .window(from, to, watch)
}

struct Guard<'f> {
    /// A call costs little beside a value, and one search serves all sizes and methods.
    function: &'f mut dyn FnMut(f64) -> f64,
    noise: f64,
    evaluations: usize,
}

/// A window and the guard's values at its nodes; not a number where it was not evaluated yet.
struct Samples {
    from: f64,
    to: f64,
    nodes: [f64; SAMPLES],
    values: [f64; SAMPLES],
}

impl Samples {
    fn new(from: f64, to: f64) -> Self {
        let mut nodes = std::array::from_fn(|j| from + point(j) * (to - from));
        nodes[DEGREE] = to;
        Self {
            from,
            to,
            nodes,
            values: [f64::NAN; SAMPLES],
        }
    }

    /// Distance from the start as a fraction of the window.
    fn fraction(&self, t: f64) -> f64 {
        (t - self.from) / (self.to - self.from)
    }

    fn magnitude(&self, degree: usize) -> f64 {
        self.values[..NODES]
            .iter()
            .step_by(DEGREE / degree)
            .fold(0.0, |m: f64, v| m.max(v.abs()))
    }

    /// What the values owe to the rounding of the nodes, by half a unit in the last place: four times as
    /// much, as in `Guard::roughness`, which does not see it where the shift is a whole number of units.
    fn rounding_of_nodes(&self) -> f64 {
        let unit = |t: f64| t.abs().next_up() - t.abs();
        let slope =
            |j: usize| (self.values[j] - self.values[j - 1]) / (self.nodes[j] - self.nodes[j - 1]);
        let steepest = (1..NODES).fold(0.0, |m: f64, j| m.max(slope(j).abs()));
        4.0 * steepest * 0.5 * unit(self.from).max(unit(self.to))
    }

    fn time(&self, fraction: f64) -> f64 {
        (self.from + fraction * (self.to - self.from)).clamp(self.from, self.to)
    }
}

impl Guard<'_> {
    fn value(&mut self, t: f64) -> f64 {
        self.evaluations += 1;
        (self.function)(t)
    }

    /// Fills in the values at the nodes of a degree and at the sample that tests it.
    fn sample(&mut self, samples: &mut Samples, degree: usize) {
        for node in (0..NODES)
            .step_by(DEGREE / degree)
            .chain([Interpolant::test_sample(degree)])
        {
            if samples.values[node].is_nan() {
                samples.values[node] = self.value(samples.nodes[node]);
            }
        }
    }

    /// The earliest event of a window, or the remembered sign at its end.
    fn window(&mut self, from: f64, to: f64, watch: Watch) -> Search {
        let mut samples = Samples::new(from, to);
        let mut noise = self.noise;
        for degree in [4, 8, DEGREE] {
            self.sample(&mut samples, degree);
            if watch == Watch::Dormant && self.noise == 0.0 && degree == 4 {
                if samples.magnitude(degree) == 0.0 {
                    return Search::nothing(watch);
                }
                let (is_noise, size) = self.is_noise(&mut samples);
                if is_noise {
                    return Search {
                        resolved: false,
                        ..Search::nothing(watch)
                    };
                }
                noise = size;
            }
            if let Some(search) = self.decide(&samples, degree, watch, noise) {
                return search;
            }
        }
        if watch != Watch::Dormant {
            // Halving the window does not help where rounding errors are what is not resolved.
            let roughness = self.roughness(&samples, DEGREE);
            let noise = noise.max(roughness).max(samples.rounding_of_nodes());
            if let Some(search) = self.decide(&samples, DEGREE, watch, noise) {
                return search;
            }
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
            // The guard may turn where the halves meet.
            turn: match (second.crossing, watch) {
                (None, Watch::Armed) => first.turn.min(second.turn).min(samples.values[DEGREE / 2]),
                _ => second.turn,
            },
            ..second
        }
    }

    /// The answer from the interpolant of this degree, if it is good enough to give one.
    fn decide(
        &mut self,
        samples: &Samples,
        degree: usize,
        watch: Watch,
        noise: f64,
    ) -> Option<Search> {
        if watch == Watch::Dormant && self.noise == 0.0 && samples.values[0] == 0.0 {
            return self.leave_zero(samples, degree, noise);
        }
        let interpolant = Interpolant::through(&samples.values, degree);
        if !interpolant.agrees(&samples.values, noise) {
            return None;
        }
        let ends = (samples.values[0], samples.values[DEGREE]);
        Cut::new(self, samples, interpolant, ends, 0, noise).search(watch)
    }

    /// A guard that is exactly zero at the start: its zero is divided out, of the lowest order that
    /// leaves a quotient with a sign there, and all lower orders must be resolved as zero.
    fn leave_zero(&mut self, samples: &Samples, degree: usize, noise: f64) -> Option<Search> {
        let from = samples.from;
        let fractions = samples.nodes.map(|node| samples.fraction(node));
        let nearest = DEGREE / degree;
        let mut noise = noise;
        for order in 1..degree {
            // The division enlarges the errors, most at the node next to the zero.
            noise /= fractions[nearest];
            let (interpolant, quotients) =
                Interpolant::deflated(&samples.values, &fractions, order, degree);
            if !interpolant.agrees(&quotients, noise) || !interpolant.decays() {
                return None;
            }
            let start = quotients[0];
            if start.abs() > interpolant.error() {
                if start < 0.0 {
                    let right = self.negative_near(from, samples.nodes[nearest])?;
                    let ((l, r), flew) = departure(&mut |t| self.value(t), from, right);
                    if flew {
                        // The interpolant did not see a flight; at the scale of its end one does.
                        return Some(self.window(from, r.0, Watch::Dormant));
                    }
                    return Some(Search::found(
                        l.0,
                        r.0,
                        Kind::LeavesNegative,
                        Watch::Violated,
                    ));
                }
                let ends = (start, quotients[DEGREE]);
                let bounds = (start, interpolant.expansion.steepest());
                let mut quotient =
                    Cut::new(self, samples, interpolant, ends, order, 0.0).search(Watch::Armed)?;
                let place = |crossing: Crossing| samples.fraction(crossing.outside);
                let place = quotient.crossing.map_or(1.0, place);
                quotient.of_quotient(order, bounds, place);
                return Some(quotient);
            }
            if !interpolant.is_resolved(noise) {
                return None;
            }
        }
        None
    }

    /// A place in (`from`, `right`] where the guard is negative, nearer to `from` by halving, until
    /// the value underflows.
    fn negative_near(&mut self, from: f64, mut right: f64) -> Option<Point> {
        let mut value = self.value(right);
        while right > from && value > 0.0 {
            right = from + (right - from) / 2.0;
            value = self.value(right);
        }
        (value < 0.0).then_some((right, value))
    }

    /// Whether the values in the window are no more than rounding errors, and the size of these.
    fn is_noise(&mut self, samples: &mut Samples) -> (bool, f64) {
        let mut size = 0.0;
        for degree in [4, DEGREE] {
            self.sample(samples, degree);
            size = self.roughness(samples, degree);
            // A few errors may all be the same; then more of them are looked at.
            if size > 0.0 {
                return (samples.magnitude(degree) <= degree as f64 * size, size);
            }
        }
        (false, size)
    }

    /// Size of the guard's rounding errors: its largest second difference at the inner nodes, over
    /// 2⁻²⁶ of the window. There a smooth guard contributes 2⁻⁵² g″ only, which is of the size of
    /// a rounding, and rounding errors are independent: an error of ν contributes up to 4ν.
    fn roughness(&mut self, samples: &Samples, degree: usize) -> f64 {
        let shift = (samples.to - samples.from) / f64::from(1_u32 << HALF_DIGITS);
        let mut largest = 0.0_f64;
        for node in (0..DEGREE).step_by(DEGREE / degree).skip(1) {
            let (t, value) = (samples.nodes[node], samples.values[node]);
            let difference = value - 2.0 * self.value(t + shift) + self.value(t + 2.0 * shift);
            largest = largest.max(difference.abs());
        }
        largest
    }

    /// By the values at the nodes alone.
    fn by_values(&mut self, samples: &Samples, watch: Watch) -> Search {
        if watch == Watch::Dormant && self.noise == 0.0 {
            return Search::nothing(watch);
        }
        walk(
            &mut Values {
                guard: self,
                samples,
            },
            watch,
        )
        .expect("every node has a value")
    }

    /// Tells a jump and a pole from a fall by comparing the bracket with places 2²⁶ doubles away:
    /// what is continuous has changed by much more there, a jump by no more, and next to a pole
    /// the value, even that of a logarithm, is at least twice the value there.
    fn classify(&mut self, inside: Point, outside: Point, samples: &Samples) -> Kind {
        let away = 1_i64 << HALF_DIGITS;
        let before = self.value(moved(inside.0, -away, samples.from, samples.to));
        let after = self.value(moved(outside.0, away, samples.from, samples.to));
        // A value at the pole itself may be infinite or not a number.
        let grows = |near: f64, far: f64| near.is_nan() || near.abs() >= 2.0 * far.abs();
        if grows(inside.1, before) && grows(outside.1, after) {
            Kind::Pole
        } else if inside.1 - outside.1 > 0.5 * (before - after) {
            Kind::Jump
        } else {
            Kind::Crossing
        }
    }
}

/// The guard cut at the extrema of its interpolant, divided by the `order`-th power of the fraction
/// of the window.
struct Cut<'g, 'f> {
    guard: &'g mut Guard<'f>,
    samples: &'g Samples,
    interpolant: Interpolant,
    extrema: Extrema<NODES>,
    /// The guard's own values at the ends, divided as well.
    ends: (f64, f64),
    order: usize,
    /// Up to here values mean zero.
    noise: f64,
    resolved: bool,
}

impl<'g, 'f> Cut<'g, 'f> {
    fn new(
        guard: &'g mut Guard<'f>,
        samples: &'g Samples,
        interpolant: Interpolant,
        ends: (f64, f64),
        order: usize,
        noise: f64,
    ) -> Self {
        let resolved = interpolant.is_resolved(noise);
        Self {
            guard,
            samples,
            interpolant,
            extrema: Extrema::new(),
            ends,
            order,
            noise,
            resolved,
        }
    }

    /// The answer, if the interpolant is good enough to give one.
    fn search(mut self, watch: Watch) -> Option<Search> {
        let error = self.interpolant.error();
        let (below, above) = self.interpolant.expansion.bounds();
        if watch == Watch::Armed && below > error {
            return Some(Search::above(below - error));
        }
        if watch == Watch::Violated && above < -error {
            return Some(Search::nothing(watch));
        }
        if !self.interpolant.decays() && !self.resolved {
            return None;
        }
        self.extrema = extrema(&self.interpolant.expansion);
        walk(&mut self, watch)
    }
}

impl Pieces for Cut<'_, '_> {
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
        let certain = self.noise + self.interpolant.error();
        let last = self.len() - 1;
        if index == 0 || index == last {
            let value = if index == 0 { self.ends.0 } else { self.ends.1 };
            // Next to an end that is nearly zero the guard may turn without the interpolant.
            return (value.abs() > certain || self.resolved).then_some((value, false));
        }
        let value = self
            .interpolant
            .expansion
            .value(self.extrema.as_slice()[index - 1]);
        if value.abs() > certain {
            Some((value, false))
        } else if self.resolved {
            let node = self.node(index);
            Some((self.own(node), true))
        } else {
            None
        }
    }

    fn rounding(&self, _index: usize) -> f64 {
        self.noise
    }

    fn own(&mut self, t: f64) -> f64 {
        let fraction = self.samples.fraction(t);
        let value = self.guard.value(t);
        (0..self.order).fold(value, |quotient, _| quotient / fraction)
    }

    fn kind(&mut self, inside: Point, outside: Point) -> Kind {
        // A continuous guard changes from a double to the next by a few roundings.
        let continuous = self.interpolant.magnitude / f64::from(1_u32 << HALF_DIGITS);
        if inside.1 - outside.1 <= continuous {
            Kind::Crossing
        } else {
            let own = |guard: &mut Guard, point: Point| (point.0, guard.value(point.0));
            let (inside, outside) = (own(self.guard, inside), own(self.guard, outside));
            self.guard.classify(inside, outside, self.samples)
        }
    }
}

/// The guard at the nodes, taken at its word.
struct Values<'g, 'f> {
    guard: &'g mut Guard<'f>,
    samples: &'g Samples,
}

impl Pieces for Values<'_, '_> {
    fn len(&self) -> usize {
        NODES
    }

    fn node(&self, index: usize) -> f64 {
        self.samples.nodes[index]
    }

    fn value(&mut self, index: usize) -> Option<(f64, bool)> {
        Some((self.samples.values[index], false))
    }

    fn rounding(&self, _index: usize) -> f64 {
        self.guard.noise
    }

    fn own(&mut self, t: f64) -> f64 {
        self.guard.value(t)
    }

    fn kind(&mut self, inside: Point, outside: Point) -> Kind {
        self.guard.classify(inside, outside, self.samples)
    }
}
