//! A sine that may start late and end early.

use super::lanes::LaneJet;
use super::{Jet, Side, Signals};
use crate::kernel::{LaneLevel, lane_sine, lane_sine_series, sin_cos, sin_cos_of_eight};
use crate::numerics::{LaneMask, Lanes};

/// 1/((k + 1) (k + 2)), of the product of the rounded inverses.
const INVERSES_OF_PAIRS: [f64; Signals::MOST_ORDERS] = {
    let mut inverses = [0.0; Signals::MOST_ORDERS];
    let mut k = 0;
    while k < inverses.len() {
        inverses[k] = (1.0 / (k + 1) as f64) * (1.0 / (k + 2) as f64);
        k += 1;
    }
    inverses
};

/// A·sin(ω (t − start) + φ) for start ≤ t < end, and zero outside.
///
/// With a phase, or an end inside a half wave, the function jumps there; both ends are
/// breakpoints.
#[derive(Debug, Clone, PartialEq)]
pub struct Sine {
    amplitude: f64,
    angular_frequency: f64,
    start: f64,
    end: f64,
    sin_phase: f64,
    cos_phase: f64,
    /// Amplitudes of the antiderivatives, A/ω and A/ω².
    of_integrals: [f64; 2],
}

impl Sine {
    /// Hands on the numbers that decide it.
    pub(super) fn content(&self, put: &mut dyn FnMut(f64)) {
        let Sine {
            amplitude,
            angular_frequency,
            start,
            end,
            sin_phase,
            cos_phase,
            of_integrals: _,
        } = *self;
        let phase = [sin_phase, cos_phase];
        let numbers = [amplitude, angular_frequency, start, end].into_iter();
        numbers.chain(phase).for_each(put);
    }

    /// A sine that acts from t = 0 on. The amplitude is in the unit of the function, the angular
    /// frequency ω > 0 in rad/s, the phase φ in rad.
    pub fn new(amplitude: f64, angular_frequency: f64, phase: f64) -> Self {
        let (sin_phase, cos_phase) = sin_cos(phase);
        let (start, end) = (0.0, f64::INFINITY);
        Sine {
            amplitude,
            angular_frequency,
            start,
            end,
            sin_phase,
            cos_phase,
            of_integrals: [
                amplitude / angular_frequency,
                amplitude / (angular_frequency * angular_frequency),
            ],
        }
    }

    /// The same sine, counted from `start` ≥ 0 and zero from `end` ≥ `start` on; both in s.
    pub fn between(self, start: f64, end: f64) -> Self {
        Sine { start, end, ..self }
    }

    /// Value, rate and antiderivatives at time `t` (s).
    ///
    /// With y = ω s, s = t − start, the antiderivatives are
    /// A/ω (cos φ − cos(y + φ)) and A/ω² (y cos φ − sin(y + φ) + sin φ). They are written as
    /// A/ω · 2 sin(y/2 + φ) sin(y/2) and A/ω² (cos φ (y − sin y) + 2 sin φ sin²(y/2)), so that
    /// nothing cancels near the start.
    #[inline(always)]
    pub fn at(&self, t: f64, side: Side) -> Jet {
        let y = self.angle(t);
        self.jet(t, side, y, sin_cos(0.5 * y))
    }

    /// sin(y/2 + φ) and cos(y/2 + φ) from those of y/2.
    #[inline(always)]
    fn shifted(&self, (sin, cos): (f64, f64)) -> (f64, f64) {
        (
            sin * self.cos_phase + cos * self.sin_phase,
            cos * self.cos_phase - sin * self.sin_phase,
        )
    }

    /// The value alone at each of up to eight instants; the others are zero.
    #[inline]
    pub(super) fn values(&self, at: &[(f64, Side)]) -> [f64; 8] {
        let mut angles = [0.0; 8];
        for (angle, (t, _)) in angles.iter_mut().zip(at) {
            *angle = 0.5 * self.angle(*t);
        }
        let [sines, cosines] = sin_cos_of_eight(&angles);
        let mut values = [0.0; 8];
        for (i, &(t, side)) in at.iter().enumerate().take(8) {
            if self.acts(t, side) {
                let (sin, cos) = (sines[i], cosines[i]);
                let (sin_shifted, cos_shifted) = self.shifted((sin, cos));
                values[i] = self.amplitude * (sin_shifted * cos + cos_shifted * sin);
            }
        }
        values
    }

    /// Whether it acts at an instant.
    #[inline(always)]
    fn acts(&self, t: f64, side: Side) -> bool {
        match side {
            Side::Right => self.start <= t && t < self.end,
            Side::Left => self.start < t && t <= self.end,
        }
    }

    /// The numbers that its values follow from, as `struct sine` of codegen/lanes.c has them, and the factor of its series.
    fn numbers(&self) -> [f64; 9] {
        let [of_integral, of_double_integral] = self.of_integrals;
        [
            self.amplitude,
            self.angular_frequency,
            self.start,
            self.end,
            self.sin_phase,
            self.cos_phase,
            of_integral,
            of_double_integral,
            -(self.angular_frequency * self.angular_frequency),
        ]
    }

    /// y = ω s while the sine acts.
    #[inline(always)]
    fn angle(&self, t: f64) -> f64 {
        self.angular_frequency * (t.clamp(self.start, self.end) - self.start)
    }

    /// What [`Sine::at`] gives, with sin(y/2) and cos(y/2).
    #[inline(always)]
    fn jet(&self, t: f64, side: Side, y: f64, (sin, cos): (f64, f64)) -> Jet {
        let (amplitude, omega) = (self.amplitude, self.angular_frequency);
        let (sin_shifted, cos_shifted) = self.shifted((sin, cos));
        let [first, second] = self.of_integrals;
        let integral = first * 2.0 * sin_shifted * sin;
        let double_integral = second
            * (self.cos_phase * less_its_sine(y, 2.0 * sin * cos)
                + 2.0 * self.sin_phase * sin * sin);
        let (rate, value) = if self.acts(t, side) {
            (
                amplitude * omega * (cos_shifted * cos - sin_shifted * sin),
                amplitude * (sin_shifted * cos + cos_shifted * sin),
            )
        } else {
            (0.0, 0.0)
        };
        // After the end the integral stays and its own integral goes on.
        let after = if t > self.end { t - self.end } else { 0.0 };
        Jet {
            rate,
            value,
            integral,
            double_integral: double_integral + integral * after,
        }
    }

    /// Fills every `stride`-th entry of `out` with the Taylor coefficients about the time at which value
    /// and rate are those given; each is −ω²/(k (k − 1)) times the last but one.
    #[inline]
    pub(super) fn fill_series(
        &self,
        [mut now, mut next]: [f64; 2],
        stride: usize,
        out: &mut [f64],
    ) {
        let factor = -(self.angular_frequency * self.angular_frequency);
        // Two at a time, which do not wait for each other.
        let mut pairs = out.chunks_exact_mut(2 * stride);
        for (pair, inverses) in pairs.by_ref().zip(INVERSES_OF_PAIRS.as_chunks::<2>().0) {
            (pair[0], pair[stride]) = (now, next);
            now *= factor * inverses[0];
            next *= factor * inverses[1];
        }
        let rest = pairs.into_remainder();
        for (at, coefficient) in [(0, now), (stride, next)] {
            if let Some(rest) = rest.get_mut(at) {
                *rest = coefficient;
            }
        }
    }

    /// Start and end, if they are after `t`.
    pub fn next_breakpoint(&self, t: f64) -> f64 {
        [self.start, self.end]
            .into_iter()
            .find(|&b| b > t)
            .unwrap_or(f64::INFINITY)
    }

    /// A quarter period while the sine acts; infinite before its start and after its end.
    pub fn resolution(&self, t: f64) -> f64 {
        if self.start <= t && t < self.end {
            std::f64::consts::FRAC_PI_2 / self.angular_frequency
        } else {
            f64::INFINITY
        }
    }
}

/// The sines of trajectories side by side, each with its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct LaneSines<const W: usize> {
    numbers: [Lanes<W>; 8],
    /// Of the series: −ω².
    factor: Lanes<W>,
    /// The lanes that have one.
    pub lanes: LaneMask,
    /// Whether all of them have.
    all: bool,
}

impl<const W: usize> LaneSines<W> {
    /// Of some lanes. The values of a lane are the same whatever the others have.
    pub fn new(of: [Option<&Sine>; W]) -> Self {
        let mut sines = LaneSines {
            numbers: [Lanes::of(0.0); 8],
            factor: Lanes::of(0.0),
            lanes: LaneMask::NONE,
            all: of.iter().all(Option::is_some),
        };
        for (lane, sine) in of.into_iter().enumerate() {
            let Some(sine) = sine else { continue };
            let rows = sines.numbers.iter_mut().chain([&mut sines.factor]);
            rows.zip(sine.numbers())
                .for_each(|(row, number)| row.0[lane] = number);
            sines.lanes.set(lane, true);
        }
        sines
    }

    /// [`Sine::at`] on the right of each of several times (codegen/lanes.c), in the lanes that have one.
    #[inline]
    pub fn at(&self, level: LaneLevel<W>, t: &Lanes<W>, jet: &mut LaneJet<W>) {
        if self.all {
            return lane_sine(level, &self.numbers, t, &mut jet.0);
        }
        let mut of_all = *jet;
        lane_sine(level, &self.numbers, t, &mut of_all.0);
        for lane in self.lanes.lanes() {
            jet.set(lane, of_all.get(lane));
        }
    }

    /// [`Sine::fill_series`] for each of several times, in the lanes that have one.
    #[inline]
    pub fn fill_series(
        &self,
        level: LaneLevel<W>,
        jet: &LaneJet<W>,
        stride: usize,
        out: &mut [Lanes<W>],
    ) {
        let of = (&self.factor, &INVERSES_OF_PAIRS[..]);
        if self.all {
            return lane_sine_series(level, of, &jet.0, stride, out);
        }
        let mut of_all = [Lanes::of(0.0); Signals::MOST_ORDERS];
        let of_all = &mut of_all[..out.len().div_ceil(stride)];
        lane_sine_series(level, of, &jet.0, 1, of_all);
        for (out, of_all) in out.iter_mut().step_by(stride).zip(&*of_all) {
            for lane in self.lanes.lanes() {
                out.0[lane] = of_all.0[lane];
            }
        }
    }
}

/// How many sines of a sum are evaluated side by side.
pub(super) const SIDE_BY_SIDE: usize = 8;

/// [`Sine::at`] of up to [`SIDE_BY_SIDE`] sines, added to a sum one after the other.
#[inline]
pub(super) fn add_jets<'a>(
    sines: impl Iterator<Item = &'a Sine> + Clone,
    t: f64,
    side: Side,
    sum: Jet,
) -> Jet {
    jets(sines, t, side).fold(sum, |sum, (_, jet)| sum + jet)
}

/// Sines and what they are at a time.
#[inline]
fn jets<'a>(
    sines: impl Iterator<Item = &'a Sine> + Clone,
    t: f64,
    side: Side,
) -> impl Iterator<Item = (&'a Sine, Jet)> {
    let mut angles = [0.0; SIDE_BY_SIDE];
    for (angle, sine) in angles.iter_mut().zip(sines.clone()) {
        *angle = sine.angle(t);
    }
    let [sin, cos] = sin_cos_of_eight(&angles.map(|y| 0.5 * y));
    let all = sines.zip(angles).zip(sin.into_iter().zip(cos));
    all.map(move |((sine, y), of_half)| (sine, sine.jet(t, side, y, of_half)))
}

/// Adds the Taylor coefficients about `t` (s) of up to [`SIDE_BY_SIDE`] sines, as [`Sine::fill_series`] has them.
pub(super) fn add_series<'a>(
    sines: impl Iterator<Item = &'a Sine> + Clone,
    t: f64,
    side: Side,
    out: &mut [f64],
) {
    let [mut now, mut next, mut factors] = [[0.0; SIDE_BY_SIDE]; 3];
    for (i, (sine, jet)) in jets(sines, t, side).enumerate() {
        (now[i], next[i]) = (jet.value, jet.rate);
        factors[i] = -(sine.angular_frequency * sine.angular_frequency);
    }
    // In pairs, so that no addition waits for the one before.
    let sum =
        |x: &[f64; SIDE_BY_SIDE]| ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
    let inverses = INVERSES_OF_PAIRS.as_chunks::<2>().0;
    for (pair, inverses) in out.chunks_mut(2).zip(inverses) {
        for (out, terms) in pair.iter_mut().zip([&now, &next]) {
            *out += sum(terms);
        }
        let both = now.iter_mut().zip(&mut next);
        for ((now, next), factor) in both.zip(factors) {
            *now *= factor * inverses[0];
            *next *= factor * inverses[1];
        }
    }
}

/// y − sin y for y ≥ 0, without cancellation; `sin_y` is sin y.
fn less_its_sine(y: f64, sin_y: f64) -> f64 {
    // From y = 1 on the difference loses less than three bits. Below, the Taylor series does:
    // y³/6 (1 − y²/(4·5) (1 − y²/(6·7) (…))), up to y¹⁹/19!, of which the next term is less than
    // 2⁻⁵³ of the first.
    if y >= 1.0 {
        return y - sin_y;
    }
    let y2 = y * y;
    let tail = (2..=9).rev().fold(1.0, |tail, n| {
        let n = f64::from(n);
        1.0 - y2 / (2.0 * n * (2.0 * n + 1.0)) * tail
    });
    y * y2 / 6.0 * tail
}
