//! A short report for the terminal.

use std::fmt::{self, Display, Formatter};

use super::number::rounded;
use super::{Question, Run, Summary, Units};

/// Digits shown: enough to compare two runs by eye. The exact numbers are in the files.
const DIGITS: usize = 6;

/// Shows a run as a short table: where it ended, the extremes, the transitions, the balance of
/// energies and the work of the solver.
#[derive(Debug)]
pub struct Report {
    summary: Summary,
    /// The reader's.
    units: Units,
}

impl Report {
    /// The report of a run.
    pub fn new(run: &Run) -> Report {
        Report {
            summary: Summary::new(run),
            units: Units::default(),
        }
    }

    /// The same with extremes, times and energies in the reader's units.
    pub fn in_units(self, units: &Units) -> Report {
        Report {
            units: units.clone(),
            ..self
        }
    }

    /// A number in a unit as it is shown, to so many digits, and the unit.
    fn shown(&self, x: f64, unit: &str, digits: usize) -> (String, String) {
        let (x, unit) = self.units.show(x, unit);
        (rounded(x, digits), unit)
    }

    /// A time with its unit.
    fn time(&self, t: f64) -> String {
        let (t, unit) = self.shown(t, "s", DIGITS);
        format!("{t} {unit}")
    }
}

impl Report {
    /// The summary that it shows.
    pub fn summary(&self) -> &Summary {
        &self.summary
    }
}

impl Display for Report {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let summary = &self.summary;
        let choices = summary
            .choices
            .0
            .iter()
            .map(|(choice, option)| format!(", {choice}: {option}"));
        writeln!(f, "{}{}", summary.model, choices.collect::<String>())?;
        let end = &summary.end;
        match &summary.failure {
            None => write!(f, "reached t = {}", self.time(end.t))?,
            Some(failure) => {
                let at = &failure.at;
                writeln!(
                    f,
                    "stopped early at t = {}, after {} transitions, in mode {}:\n  {}",
                    self.time(at.t),
                    at.j,
                    at.mode,
                    failure.reason
                )?;
                write!(f, "computed up to t = {}", self.time(end.t))?;
            }
        }
        writeln!(f, ", mode {}{}\n", end.mode, discrete(summary))?;
        table(f, &self.states())?;
        if !summary.projected.0.is_empty() {
            let moved = summary.projected.0.iter();
            let moved = moved.map(|(name, change)| {
                let unit = (summary.peaks.0.iter())
                    .find(|(of, _)| of == name)
                    .map_or("", |(_, peak)| &peak.unit);
                let (change, unit) = self.shown(*change, unit, DIGITS);
                format!("{name} by {change} {unit}").trim_end().to_owned()
            });
            let moved = moved.collect::<Vec<_>>().join(", ");
            writeln!(f, "\ninitial     moved: {moved}")?;
        }
        write!(f, "\ntransitions {}", summary.events.total)?;
        for (i, (name, count)) in summary.events.by_transition.iter().enumerate() {
            write!(f, "{} {count} {name}", if i == 0 { ":" } else { "," })?;
        }
        writeln!(f)?;
        self.energies(f)?;
        error_estimate(f, summary)?;
        self.uncertain(f)?;
        self.reached(f)?;
        let solver = &summary.solver;
        writeln!(
            f,
            "solver      {}: {} steps, {} rejected; {} residuals, {} Jacobians, {} factorizations; {} s",
            solver.method,
            solver.steps,
            solver.rejected,
            solver.residual_evaluations,
            solver.jacobian_evaluations,
            solver.factorizations,
            rounded(summary.wall_seconds, 3),
        )
    }
}

fn number(x: f64) -> String {
    rounded(x, DIGITS)
}

fn discrete(summary: &Summary) -> String {
    let states = summary
        .end
        .discrete
        .0
        .iter()
        .map(|(name, x)| format!(", {name} = {}", number(*x)));
    states.collect()
}

impl Report {
    /// One row a coordinate, velocity, reaction, output or energy.
    fn states(&self) -> Vec<[String; 7]> {
        let (_, second) = self.units.show(1.0, "s");
        let at = format!("at t/{second}");
        let heads = ["", "unit", "end", "min", &at, "max", &at];
        let mut rows = vec![heads.map(str::to_owned)];
        let end = &self.summary.end;
        for (name, peak) in &self.summary.peaks.0 {
            let mut state = end.state();
            let value = state.find(|(n, _)| n == name);
            let shown = |x: f64| self.shown(x, &peak.unit, DIGITS).0;
            let time = |t: f64| self.shown(t, "s", DIGITS).0;
            rows.push([
                name.clone(),
                self.units.show(1.0, &peak.unit).1,
                value.map_or(String::new(), |(_, x)| shown(*x)),
                shown(peak.min),
                time(peak.t_min),
                shown(peak.max),
                time(peak.t_max),
            ]);
        }
        rows
    }

    /// One line: how many places are in doubt, the first of them, and what to do.
    fn uncertain(&self, f: &mut Formatter) -> fmt::Result {
        let uncertain = &self.summary.uncertain;
        let Some(first) = uncertain.first.first() else {
            return Ok(());
        };
        let [value, error] = [first.value, first.error].map(|x| {
            let (x, unit) = self.shown(x, &first.unit, 2);
            match &*unit {
                "" | "1" => x,
                unit => format!("{x} {unit}"),
            }
        });
        let what = match first.what {
            Question::Graze => format!("crosses zero by {value}, with an error of {error}"),
            Question::NearMiss => format!("turns back at {value}, with an error of {error}"),
            Question::Unresolved => "could not be resolved".to_owned(),
            Question::Choice => format!("decides by {value}, with an error of {error}"),
            Question::Unsettled => format!(
                "is another event at another tolerance, where the one before differs by {value}"
            ),
        };
        writeln!(
            f,
            "uncertain   what happens at {}, first at t = {}: {} {what}; tighten accuracy.relative",
            match uncertain.total {
                1 => "one place".to_owned(),
                total => format!("{total} places"),
            },
            self.time(first.t),
            first.guard,
        )
    }

    /// One line a limit state, and one a condition of the model that does not hold.
    fn reached(&self, f: &mut Formatter) -> fmt::Result {
        for state in &self.summary.reached.limit_states {
            let ended = if state.ends {
                "; the run ends there"
            } else {
                ""
            };
            let (name, t, message) = (&state.name, self.time(state.t), &state.message);
            writeln!(f, "limit       {name} at t = {t}: {message}{ended}")?;
        }
        for left in &self.summary.reached.validity {
            let when = left
                .t
                .map_or(String::new(), |t| format!(" from t = {} on", self.time(t)));
            writeln!(
                f,
                "validity    not {}{when}: {}",
                left.condition, left.message
            )?;
        }
        Ok(())
    }

    fn energies(&self, f: &mut Formatter) -> fmt::Result {
        let Some(energy) = &self.summary.energy else {
            return Ok(());
        };
        let (_, unit) = self.units.show(1.0, "J");
        let number = |x: f64, digits: usize| self.shown(x, "J", digits).0;
        writeln!(
            f,
            "energy / {unit:<2} initial {} + input work {} − dissipated {} − lost at impacts {} = final {}\n            \
             imbalance {}",
            number(energy.initial, DIGITS),
            number(energy.input_work, DIGITS),
            number(energy.dissipated, DIGITS),
            number(energy.lost_at_impacts, DIGITS),
            number(energy.final_, DIGITS),
            number(energy.imbalance, 2),
        )?;
        if !energy.frame.is_empty() {
            writeln!(f, "            {}", energy.frame)?;
        }
        for (name, impacts) in &self.summary.impacts.by_transition.0 {
            writeln!(
                f,
                "            {} × {name}: lost {} {unit}, from {} to {} {unit} each{}",
                impacts.count,
                number(impacts.lost, DIGITS),
                number(impacts.smallest_loss, 3),
                number(impacts.largest_loss, 3),
                match impacts.gaining {
                    0 => String::new(),
                    n => format!("; {n} gained energy"),
                },
            )?;
        }
        Ok(())
    }
}

/// Writes rows with aligned columns, the first two to the left.
fn table<const N: usize>(f: &mut Formatter, rows: &[[String; N]]) -> fmt::Result {
    let width = |i: usize| {
        rows.iter()
            .map(|row| row[i].chars().count())
            .max()
            .unwrap_or(0)
    };
    for row in rows {
        let cell = |(i, text): (usize, &String)| {
            let width = width(i);
            if i < 2 {
                format!("{text:<width$}")
            } else {
                format!("{text:>width$}")
            }
        };
        let line: Vec<String> = row.iter().enumerate().map(cell).collect();
        writeln!(f, "{}", line.join("  ").trim_end())?;
    }
    Ok(())
}

fn error_estimate(f: &mut Formatter, summary: &Summary) -> fmt::Result {
    let Some(estimate) = &summary.error_estimate else {
        return Ok(());
    };
    let states = estimate.q.0.iter().chain(&estimate.v.0);
    let states: Vec<_> = states
        .map(|(name, x)| format!("{name} {}", rounded(*x, 2)))
        .collect();
    writeln!(
        f,
        "error       at the end {}, relative {}\n            \
         of an event's time {} s; events missed {}, extra {}, in tails of accumulations {}\n            \
         estimated by {}, at a tolerance of {}",
        states.join(", "),
        rounded(estimate.relative, 2),
        rounded(estimate.event_time, 2),
        estimate.missed_events,
        estimate.extra_events,
        estimate.events_in_tails,
        estimate.method,
        rounded(estimate.tolerance, 2),
    )
}
