//! Axes: ranges, scales, ticks.

use super::symbol::{Display, display, printed, superscript};
use crate::record::Units;
use crate::record::number::rounded;

/// How values are spread along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithm; values that are not positive are left out.
    Log,
}

/// A tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    /// Position from 0 to 1.
    pub at: f64,
    /// Label.
    pub label: String,
}

/// An axis, which maps values to positions from 0 to 1.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    scale: Scale,
    /// Lower and upper end, in the units of the labels.
    low: f64,
    high: f64,
    /// Values are multiplied by these two first: a power of ten where they are so small or large that their
    /// differences or quotients are no doubles. It may be none itself, and is the product of two.
    powers: [f64; 2],
    /// Values are shown as their difference to this, in the model's unit.
    offset: f64,
    /// The model's unit, as it is printed.
    unit: String,
    display: Display,
}

/// Differences below this part of the values are shown on their own, beside an offset: the labels
/// would need more digits than anybody reads.
const OFFSET_BELOW: f64 = 1e-4;

/// Magnitudes whose sums, ranges and steps are doubles with all their digits.
const PLAIN: std::ops::Range<f64> = 1e-280..1e280;

impl Axis {
    /// The axis of values between `low` and `high`, in `unit`, with `margin` times their
    /// difference free at both ends.
    pub fn new(
        scale: Scale,
        unit: &str,
        units: &Units,
        (low, high): (f64, f64),
        margin: f64,
    ) -> Axis {
        match scale {
            Scale::Linear => Self::linear(unit, units, low, high, margin),
            Scale::Log => {
                let display = display(unit, 0.0, units);
                let [low, high] = [low, high].map(|x| (x * display.factor).log10());
                let room = if high > low {
                    (high - low) * margin
                } else {
                    0.5
                };
                Axis {
                    scale,
                    low: low - room,
                    high: high + room,
                    powers: [1.0; 2],
                    offset: 0.0,
                    unit: printed(unit),
                    display,
                }
            }
        }
    }

    fn linear(unit: &str, units: &Units, low: f64, high: f64, margin: f64) -> Axis {
        let largest = low.abs().max(high.abs());
        let exponent = match largest {
            0.0 => 0,
            _ if PLAIN.contains(&largest) => 0,
            _ => largest.log10().floor() as i32,
        };
        let half = exponent / 2;
        let powers = [half, exponent - half].map(|e| 10f64.powi(-e));
        let scaled = |x: f64| x * powers[0] * powers[1];
        let (low, high, largest) = (scaled(low), scaled(high), scaled(largest));
        let range = high - low;
        let offset = if exponent == 0 && range > 0.0 && range < OFFSET_BELOW * largest {
            let place = 10f64.powf(range.log10().ceil());
            ((low + range / 2.0) / place).round() * place
        } else {
            0.0
        };
        let largest = (low - offset).abs().max((high - offset).abs());
        let mut display = display(unit, largest, units);
        // Beyond what a factor of units can be multiplied with, the model's unit stays.
        if exponent != 0 {
            let unit = format!("10{} {}", superscript(exponent), printed(unit));
            display = Display {
                unit: unit.trim_end().to_owned(),
                factor: 1.0,
            };
        }
        let (low, high) = (
            (low - offset) * display.factor,
            (high - offset) * display.factor,
        );
        let room = match high - low {
            range if range > 0.0 => range * margin,
            _ if low != 0.0 => low.abs() / 2.0,
            _ => 1.0,
        };
        Axis {
            scale: Scale::Linear,
            low: low - room,
            high: high + room,
            powers,
            offset,
            unit: printed(unit),
            display,
        }
    }

    /// Position of a value, 0 at the lower end and 1 at the upper; NaN where the scale has none.
    pub fn position(&self, value: f64) -> f64 {
        let shown = match self.scale {
            Scale::Linear => {
                let value = value * self.powers[0] * self.powers[1];
                (value - self.offset) * self.display.factor
            }
            Scale::Log if value > 0.0 => (value * self.display.factor).log10(),
            Scale::Log => f64::NAN,
        };
        (shown - self.low) / (self.high - self.low)
    }

    /// The title `what` with the offset and the unit.
    pub fn title(&self, what: &str) -> String {
        let mut title = what.to_owned();
        if self.offset != 0.0 {
            let sign = if self.offset > 0.0 { '−' } else { '+' };
            title = format!(
                "{title} {sign} {} {}",
                rounded(self.offset.abs(), 15),
                self.unit
            );
        }
        if !self.display.unit.is_empty() {
            title = format!("{title} ({})", self.display.unit);
        }
        title
    }

    /// The ticks at the finest round values of which there are no more than `most`. A logarithmic
    /// axis has them at powers of ten; below three decades also at 2 and 5 times powers of ten.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        let tick = |shown: f64, label: String| Tick {
            at: (shown - self.low) / (self.high - self.low),
            label: label.replace('-', "−"),
        };
        let multiples = |step: f64| {
            let first = (self.low / step).ceil() as i32;
            let last = (self.high / step).floor() as i32;
            (first..=last).map(move |i| f64::from(i) * step)
        };
        let step = self.step(most);
        match self.scale {
            Scale::Linear => {
                let decimals = (-step.log10().floor()).max(0.0) as usize;
                let labelled = |x| tick(x, format!("{x:.decimals$}"));
                multiples(step).map(labelled).collect()
            }
            Scale::Log if self.high - self.low < 3.0 => {
                let decades = self.low.floor() as i32..=self.high.floor() as i32;
                let values = decades.flat_map(|e| [1.0, 2.0, 5.0].map(|d| d * 10f64.powi(e)));
                let inside = values.filter(|v| (self.low..=self.high).contains(&v.log10()));
                inside.map(|v| tick(v.log10(), rounded(v, 3))).collect()
            }
            Scale::Log => {
                let labelled = |x| tick(x, format!("10{}", superscript(x as i32)));
                multiples(step.max(1.0)).map(labelled).collect()
            }
        }
    }

    /// The least distance 1, 2 or 5 times a power of ten that leaves no more than `most` multiples
    /// inside.
    fn step(&self, most: usize) -> f64 {
        let inside = |step: f64| (self.high / step).floor() - (self.low / step).ceil() + 1.0;
        // `most` multiples span at most `most + 1` distances, so no answer is below this power.
        let start = ((self.high - self.low) / (most + 1) as f64).log10().floor() as i32;
        let steps = (start..).flat_map(|e| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(e)));
        let mut fitting = steps.filter(|&step| inside(step) <= most as f64);
        fitting
            .next()
            .expect("a distance longer than the axis leaves three multiples at most")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, count: usize) -> Vec<String> {
        axis.ticks(count).into_iter().map(|t| t.label).collect()
    }

    #[test]
    fn small_values_are_shown_in_a_smaller_unit() {
        let axis = Axis::new(
            Scale::Linear,
            "m",
            &Units::default(),
            (-3.2e-6, 1.1e-6),
            0.0,
        );
        assert_eq!(axis.title("x"), "x (µm)");
        assert_eq!(labels(&axis, 5), ["−3", "−2", "−1", "0", "1"]);
        assert_eq!(labels(&axis, 4), ["−2", "0"]);
        assert_eq!(axis.position(-3.2e-6), 0.0);
        assert_eq!(axis.position(1.1e-6), 1.0);
    }

    #[test]
    fn the_reader_s_units_are_kept_whatever_the_values() {
        let units = Units::new(["mm", "ms"]).unwrap();
        let axis = Axis::new(Scale::Linear, "m", &units, (-3.2e-6, 1.1e-6), 0.0);
        assert_eq!(axis.title("x"), "x (mm)");
        assert_eq!(
            labels(&axis, 5),
            ["−0.003", "−0.002", "−0.001", "0.000", "0.001"]
        );
        let axis = Axis::new(Scale::Log, "s", &units, (1e-3, 1.0), 0.0);
        assert_eq!(axis.title("t"), "t (ms)");
        assert_eq!(labels(&axis, 10), ["10⁰", "10¹", "10²", "10³"]);
        assert_eq!(axis.position(1.0), 1.0);
    }

    #[test]
    fn small_differences_are_shown_beside_an_offset() {
        let axis = Axis::new(
            Scale::Linear,
            "m",
            &Units::default(),
            (1.234_560_9, 1.234_563_1),
            0.0,
        );
        assert_eq!(axis.title("y"), "y − 1.23456 m (µm)");
        assert_eq!(labels(&axis, 3), ["1", "2", "3"]);
    }

    #[test]
    fn the_smallest_and_the_largest_doubles_have_an_axis() {
        let (least, most) = (f64::from_bits(1), f64::MAX);
        for (low, high) in [
            (0.0, least),
            (-least, 3.0 * least),
            (1e-308, 1.1e-308),
            (-most, most),
            (0.0, most),
            (-1e-300, 1e-310),
            (most.next_down(), most),
            (1e280, 1e281),
        ] {
            let axis = Axis::new(Scale::Linear, "m", &Units::default(), (low, high), 0.05);
            let [left, right] = [low, high].map(|x| axis.position(x));
            assert!(
                -1e-9 <= left && left <= right && right <= 1.0 + 1e-9,
                "{left} {right}"
            );
            assert!(axis.ticks(8).len() <= 9, "{low} {high}");
        }
        let axis = Axis::new(Scale::Linear, "m", &Units::default(), (0.0, 4.5e-310), 0.0);
        assert_eq!(axis.title("x"), "x (10⁻³¹⁰ m)");
        assert_eq!(labels(&axis, 5), ["0", "1", "2", "3", "4"]);
    }

    #[test]
    fn a_constant_has_an_axis() {
        for value in [0.0, 5.0, -1e-9] {
            let axis = Axis::new(Scale::Linear, "1", &Units::default(), (value, value), 0.05);
            assert!((axis.position(value) - 0.5).abs() < 1e-12);
            assert!(!axis.ticks(4).is_empty());
        }
    }

    #[test]
    fn decades_are_the_ticks_of_a_logarithmic_axis() {
        let axis = Axis::new(Scale::Log, "s", &Units::default(), (1e-3, 1.0), 0.0);
        assert_eq!(labels(&axis, 10), ["10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert!(axis.position(0.0).is_nan());
    }
}
