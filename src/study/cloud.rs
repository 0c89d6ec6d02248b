//! Cloud analysis: the regression of a demand on the intensity, ln d = ln a + b ln x with normal residuals, of one standard
//! deviation at all intensities (Cornell, Jalayer, Hamburger and Foutch 2002; Jalayer 2003).

use serde_json::{Value, json};

use super::design::Level;
use super::file::Study;
use super::folder::Finished;
use super::measure::Failure;
use super::procedure::{Kind, Procedure};
use super::rows::{Row, Status};

/// What a cloud is regressed on.
pub(crate) struct Cloud<'s> {
    /// Index of the measure that is the demand.
    pub measure: usize,
    /// The level of the demand at which a run fails, if it is exceeded there.
    level: Option<f64>,
    /// Runs with a positive intensity and demand: row, intensity, demand.
    pub points: Vec<(&'s Row, f64, f64)>,
    /// Number of runs that are not among them: those that did not come to their end, or have no positive demand.
    left_out: usize,
    /// The line, or why there is none.
    pub line: Result<Line, &'static str>,
}

/// A line through points in logarithms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line {
    /// The demand at the intensity 1.
    pub a: f64,
    /// The slope.
    pub b: f64,
    /// Standard deviation of the residuals of ln d, with n − 2.
    pub dispersion: f64,
}

impl<'s> Cloud<'s> {
    /// The cloud of a study; `None` of other studies, and where no measure is a number.
    pub fn new(study: &Study, finished: &'s Finished) -> Option<Cloud<'s>> {
        let Procedure::Once {
            kind: Kind::Cloud,
            intensity,
        } = study.procedure
        else {
            return None;
        };
        let intensity = intensity?;
        let is_number = |i: &usize| {
            let what = &study.measures[*i].what;
            !what.is_flag() && !what.counts()
        };
        let decides = study.failure.as_ref().and_then(Failure::measure);
        let numbers = (0..study.measures.len()).find(is_number);
        let measure = decides.filter(is_number).or(numbers)?;
        let level = match study.failure {
            Some(Failure::Measure {
                index,
                above: true,
                level,
            }) if index == measure && level > 0.0 => Some(level),
            _ => None,
        };
        let mut points = Vec::new();
        let mut left_out = 0;
        for row in finished.values().flatten() {
            let demand = row.values[measure];
            match study.design.levels(row.case)[intensity] {
                Level::Number(x) if row.status == Status::Ok && x > 0.0 && demand > 0.0 => {
                    points.push((row, x, demand));
                }
                _ => left_out += 1,
            }
        }
        let logarithms = points
            .iter()
            .map(|(_, x, d)| (libm::log(*x), libm::log(*d)));
        let line = Line::through(&logarithms.collect::<Vec<_>>());
        Some(Cloud {
            measure,
            level,
            points,
            left_out,
            line,
        })
    }

    /// Median and dispersion of the intensity at which the line reaches the level of failure.
    fn fragility(&self) -> Option<(f64, f64)> {
        let (line, level) = (self.line.ok()?, self.level?);
        let theta = libm::exp(libm::log(level / line.a) / line.b);
        (line.b > 0.0).then_some((theta, line.dispersion / line.b))
    }

    /// What the summary says of it.
    pub fn json(&self, study: &Study) -> Value {
        let line = self.line.ok();
        let fragility = self.fragility();
        json!({
            "measure": study.measures[self.measure].name,
            "a": line.map(|line| line.a),
            "b": line.map(|line| line.b),
            "dispersion": line.map(|line| line.dispersion),
            "runs": self.points.len(),
            "left_out": self.left_out,
            "theta": fragility.map(|(theta, _)| theta),
            "beta": fragility.map(|(_, beta)| beta),
            "problem": self.line.err(),
        })
    }
}

impl Line {
    /// The line of least squares through points (ln x, ln d).
    fn through(points: &[(f64, f64)]) -> Result<Line, &'static str> {
        let n = points.len() as f64;
        if points.len() < 3 {
            return Err("a line with its dispersion needs three runs that came to their end");
        }
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            points.iter().map(|p| of(p.0 - x, p.1 - y)).sum()
        };
        let squares = sum(&|dx, _| dx * dx);
        if points.iter().all(|p| p.0 == points[0].0) {
            return Err("all runs have the same intensity");
        }
        let b = sum(&|dx, dy| dx * dy) / squares;
        let residuals = sum(&|dx, dy| (dy - b * dx) * (dy - b * dx));
        Ok(Line {
            a: libm::exp(y - b * x),
            b,
            dispersion: (residuals / (n - 2.0)).sqrt(),
        })
    }

    /// The demand at an intensity.
    pub fn at(&self, intensity: f64) -> f64 {
        self.a * libm::exp(self.b * libm::log(intensity))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_is_that_of_least_squares() {
        let reference: Value =
            serde_json::from_str(include_str!("../../tests/data/study_distributions.json"))
                .unwrap();
        let of = &reference["regression"];
        let column = |name: &str| -> Vec<f64> {
            let numbers = of[name].as_array().unwrap().iter();
            numbers.map(|x| x.as_f64().unwrap().ln()).collect()
        };
        let points: Vec<_> = column("x").into_iter().zip(column("d")).collect();
        let line = Line::through(&points).unwrap();
        for (found, name) in [
            (line.a.ln(), "intercept"),
            (line.b, "slope"),
            (line.dispersion, "dispersion"),
        ] {
            let exact = of[name].as_f64().unwrap();
            assert!(
                (found / exact - 1.0).abs() < 1e-13,
                "{name}: {found} {exact}"
            );
        }
        let flat = [(0.5, 1.0), (0.5, 2.0), (0.5, 3.0)];
        assert_eq!(
            Line::through(&flat),
            Err("all runs have the same intensity")
        );
        assert!(Line::through(&points[..2]).is_err());
    }
}
