//! A sine that may start late and end early.

use super::lanes::LaneJet;
use super::{INVERSES, Jet, Side, Signals};
use crate::integrate::Lanes;
use crate::kernel::{lane_sine, lane_sine_series, sin_cos};

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
    /// Of the Taylor coefficients: that of order k + 2 is −ω²/((k + 1)(k + 2)) times that of order k.
    factors: [f64; Signals::MOST_ORDERS],
}

impl Sine {
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
            factors: std::array::from_fn(|k| {
                -(angular_frequency * angular_frequency) * (INVERSES[k + 1] * INVERSES[k + 2])
            }),
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
    pub fn at(&self, t: f64, side: Side) -> Jet {
        let y = self.angular_frequency * (t.clamp(self.start, self.end) - self.start);
        let (sin, cos) = sin_cos(0.5 * y);
        let acts = match side {
            Side::Right => self.start <= t && t < self.end,
            Side::Left => self.start < t && t <= self.end,
        };
        let (amplitude, omega) = (self.amplitude, self.angular_frequency);
        let sin_shifted = sin * self.cos_phase + cos * self.sin_phase;
        let cos_shifted = cos * self.cos_phase - sin * self.sin_phase;
        let [first, second] = self.of_integrals;
        let integral = first * 2.0 * sin_shifted * sin;
        let double_integral = second
            * (self.cos_phase * less_its_sine(y, 2.0 * sin * cos)
                + 2.0 * self.sin_phase * sin * sin);
        let (rate, value) = if acts {
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

    /// The Taylor coefficients about the time at which value and rate are those given.
    #[inline]
    pub(super) fn series(&self, [value, rate]: [f64; 2]) -> impl Iterator<Item = f64> {
        let steps = self.factors.iter();
        steps.scan((value, rate), |(now, next), factor| {
            let coefficient = *now;
            (*now, *next) = (*next, coefficient * factor);
            Some(coefficient)
        })
    }

    /// [`Sine::at`] on the right of each of several times (codegen/lanes.c).
    #[inline]
    pub(super) fn at_lanes<const W: usize>(
        &self,
        level: usize,
        t: &Lanes<W>,
        jet: &mut LaneJet<W>,
    ) {
        let [of_integral, of_double_integral] = self.of_integrals;
        let numbers = [
            self.amplitude,
            self.angular_frequency,
            self.start,
            self.end,
            self.sin_phase,
            self.cos_phase,
            of_integral,
            of_double_integral,
        ];
        lane_sine(level, &numbers, t, &mut jet.0);
    }

    /// [`Sine::series`] for each of several times, into every `stride`-th of `rows`.
    #[inline]
    pub(super) fn series_of_lanes<const W: usize>(
        &self,
        level: usize,
        jet: &LaneJet<W>,
        rows: &mut [Lanes<W>],
        stride: usize,
    ) {
        lane_sine_series(level, &self.factors, &jet.0, rows, stride);
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
