//! Plots of motions: over time, and spectra.

use super::{Report, Told};
use crate::motion::Ordinate;
use crate::record::plot::{Chart, Curve, Dimension};
use std::f64::consts::TAU;

impl Report<'_> {
    /// The plots with their names: acceleration, velocity, displacement and the growth of the Arias intensity (Husid, 1969)
    /// over time, then the spectra.
    pub fn charts(&self) -> Vec<(&'static str, Chart)> {
        let over_time = |title: &str, y: Dimension, rows: &dyn Fn(&Told) -> Vec<f64>| Chart {
            title: title.to_owned(),
            x: Dimension::linear("time t", "s"),
            y,
            curves: self.curves(|told| {
                let times = told.channel.samples.all_times();
                times.into_iter().zip(rows(told)).collect()
            }),
            marks: false,
        };
        // ω² times the largest displacement is what an ordinate is.
        let spectrum = |quantity: &str, unit: &str, value: &dyn Fn(f64, &Ordinate) -> f64| Chart {
            title: format!("spectrum of {quantity}, damping {}", self.damping),
            x: Dimension::log("period T", "s"),
            y: Dimension::linear(quantity, unit),
            curves: self.curves(|told| {
                let ordinates = self.periods.iter().zip(&told.spectrum);
                let mut points: Vec<_> = ordinates.map(|(&t, o)| (t, value(t, o))).collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                points
            }),
            marks: self.periods.len() == 1,
        };
        let linear = Dimension::linear;
        let integral = |told: &Told, order: usize| told.channel.samples.integrals()[order].clone();
        vec![
            (
                "acceleration",
                over_time("acceleration", linear("acceleration", "m/s^2"), &|told| {
                    told.channel.samples.values.clone()
                }),
            ),
            (
                "velocity",
                over_time("velocity", linear("velocity", "m/s"), &|told| {
                    integral(told, 0)
                }),
            ),
            (
                "displacement",
                over_time("displacement", linear("displacement", "m"), &|told| {
                    integral(told, 1)
                }),
            ),
            (
                "husid",
                over_time(
                    "growth of the Arias intensity (Husid plot)",
                    linear("part of the whole", "1"),
                    &|told| told.channel.samples.husid(),
                ),
            ),
            (
                "spectrum_acceleration",
                spectrum("pseudo-acceleration", "m/s^2", &|_, o| o.peak),
            ),
            (
                "spectrum_velocity",
                spectrum("pseudo-velocity", "m/s", &|t, o| o.peak * (t / TAU)),
            ),
            (
                "spectrum_displacement",
                spectrum("displacement", "m", &|t, o| o.peak * (t / TAU) * (t / TAU)),
            ),
        ]
    }

    fn curves(&self, points: impl Fn(&Told) -> Vec<(f64, f64)>) -> Vec<Curve> {
        let curve = |(label, told)| Curve {
            label,
            points: points(told),
            ..Curve::default()
        };
        self.channels().map(curve).collect()
    }
}
