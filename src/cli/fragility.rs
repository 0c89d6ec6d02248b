//! `dalembert fragility`.

use std::fmt::{self, Display, Formatter};
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::outcome::{Failure, Outcome, Result};
use super::print;
use super::table::Table as Columns;
use crate::motion::Fault;
use crate::scene::{SceneError, rendered};
use crate::study::fragility::{
    self, Bootstrap, Data, Fit, Interval, Problem, Table, Units, fractile,
};

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
A table has columns with names, separated by commas, semicolons, tabs or blanks: `im`, `n`, `k` (an intensity, runs at \
it, failures among them), or `capacity` (the intensity at which a run fails first) and, if some did not fail, `censored` \
(1: the run did not fail up to this intensity; else 0). Intensities have any unit, the same in all rows. A run without a \
result is neither a failure nor a survival and belongs in no row.

The probability of failure at an intensity x is Φ(ln(x/theta)/beta). Both are those of the largest likelihood, \
binomial for counts (Baker 2015); of capacities of which all are known beta is the standard deviation of their \
logarithms (with n - 1). Intervals are of 95 % confidence, by the profile of the likelihood.

What the data do not determine is said and not invented; that is a result, with status 0. --json prints an object: \
`theta`, `beta`, `theta_interval`, `beta_interval` (null where there is none, or no limit), `problem` (null, or why \
there is no fit), `beta_likely` (of the largest likelihood), `log_likelihood` (without binomial coefficients), \
`counted` (of known capacities the intensities below which 16, 50 and 84 % of them are), `notes`; with --bootstrap \
`theta_bootstrap`, `beta_bootstrap`, `bootstrap_samples` and how many of them are `bootstrap_unfitted`.")]
pub struct FragilityArguments {
    /// Table of runs or capacities (CSV)
    table: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Intervals by the bootstrap, too: 1000 fits to rows drawn with replacement
    #[arg(long)]
    bootstrap: bool,
}

/// Seed of the bootstrap: its intervals are the same whenever the same table is read.
const SEED: u64 = 1;

/// A table and what it says.
struct Report {
    table: Table,
    fit: std::result::Result<Fit, Problem>,
    /// Where it was asked for and there is a fit.
    bootstrap: Option<Bootstrap>,
}

pub fn fragility(arguments: &FragilityArguments) -> Result {
    let path = &arguments.table;
    let bytes = std::fs::read(path).map_err(|e| SceneError::unreadable(path.to_owned(), &e))?;
    let text = String::from_utf8(bytes).map_err(|_| {
        Failure::wrong_input(format!("{}: the table is not UTF-8 text", path.display()))
    })?;
    let table = Table::read(&text).map_err(|fault| refusal(path, &text, &fault))?;
    let fit = fragility::fit(&table.data);
    let wanted = arguments.bootstrap && fit.is_ok();
    let bootstrap = wanted.then(|| Units::of(&table.data).bootstrap(SEED));
    let report = Report {
        table,
        fit,
        bootstrap,
    };
    match arguments.json {
        true => print::output(format_args!("{:#}", report.json()))?,
        false => print::output(&report)?,
    }
    Ok(Outcome::Done)
}

/// The fault with its place in the table.
fn refusal(path: &Path, text: &str, fault: &Fault) -> Failure {
    let name = path.display().to_string();
    let about = Some((name.as_str(), text, Some(fault.range.clone())));
    let styled = io::stderr().is_terminal();
    Failure::WrongInput(rendered(&fault.message, about, Some(&fault.help), styled))
}

impl Report {
    /// 16, 50 and 84 % of capacities that are all known.
    fn counted(&self) -> Option<[f64; 3]> {
        let Data::Capacities(capacities) = &self.table.data else {
            return None;
        };
        let mut values: Vec<f64> = capacities.iter().map(|c| c.intensity).collect();
        values.sort_by(f64::total_cmp);
        let known = !values.is_empty() && capacities.iter().all(|c| !c.censored);
        known.then(|| [0.16, 0.5, 0.84].map(|p| fractile(&values, p)))
    }

    fn json(&self) -> Value {
        let fit = self.fit.as_ref().ok();
        let problem = self.fit.as_ref().err();
        let mut report = json!({
            "theta": fit.map(|f| f.theta).or(problem.and_then(Problem::theta)),
            "beta": fit.map(|f| f.beta),
            "theta_interval": fit.map(|f| f.theta_interval),
            "beta_interval": fit.map(|f| f.beta_interval),
            "problem": problem.map(Problem::to_string),
            "beta_likely": fit.map(|f| f.beta_likely),
            "log_likelihood": fit.map(|f| f.log_likelihood),
            "counted": self.counted(),
            "notes": self.table.notes.iter().map(|note| &note.message).collect::<Vec<_>>(),
        });
        if let Some(bootstrap) = &self.bootstrap {
            report["theta_bootstrap"] = json!(bootstrap.theta);
            report["beta_bootstrap"] = json!(bootstrap.beta);
            report["bootstrap_samples"] = json!(bootstrap.samples);
            report["bootstrap_unfitted"] = json!(bootstrap.unfitted);
        }
        report
    }
}

/// A number with six digits.
fn digits(value: f64) -> String {
    crate::record::rounded(value, 6)
}

fn interval(limits: Interval) -> String {
    let [from, to] = limits.map(|limit| limit.map(digits));
    match (from, to) {
        (Some(from), Some(to)) => format!("{from} to {to}"),
        (Some(from), None) => format!("from {from}, without an upper limit"),
        (None, Some(to)) => format!("up to {to}, without a lower limit"),
        (None, None) => "without limits".to_owned(),
    }
}

impl Display for Report {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        for note in &self.table.notes {
            writeln!(f, "note: {}", note.message)?;
        }
        match &self.fit {
            Ok(fit) => {
                let theta = interval(fit.theta_interval);
                writeln!(f, "median theta     {}  (95 %: {theta})", digits(fit.theta))?;
                let beta = interval(fit.beta_interval);
                write!(f, "dispersion beta  {}  (95 %: {beta})", digits(fit.beta))?;
                if let Some(bootstrap) = &self.bootstrap {
                    let [theta, beta] = [bootstrap.theta, bootstrap.beta].map(interval);
                    write!(
                        f,
                        "\nbootstrap        theta {theta}; beta {beta} ({} of {} samples have no fit)",
                        bootstrap.unfitted, bootstrap.samples
                    )?;
                }
            }
            Err(problem) => {
                if let Some(theta) = problem.theta() {
                    writeln!(f, "median theta     {}", digits(theta))?;
                }
                write!(f, "no fragility is fitted: {problem}")?;
            }
        }
        if let Some([low, middle, high]) = self.counted().map(|p| p.map(digits)) {
            write!(
                f,
                "\ncounted          16 % {low}, 50 % {middle}, 84 % {high}"
            )?;
        }
        if let Data::Stripes(stripes) = &self.table.data {
            let mut columns =
                Columns::new(["intensity", "runs", "failures", "share", "fitted"]).right(0..5);
            for stripe in stripes {
                let share = stripe.failures as f64 / stripe.runs as f64;
                let shown = |value: f64| match value.is_nan() {
                    true => "-".to_owned(),
                    false => format!("{value:.4}"),
                };
                columns.row([
                    stripe.intensity.to_string(),
                    stripe.runs.to_string(),
                    stripe.failures.to_string(),
                    shown(share),
                    self.fit.as_ref().map_or("-".to_owned(), |fit| {
                        shown(fit.probability(stripe.intensity))
                    }),
                ]);
            }
            write!(f, "\n\n{columns}")?;
        }
        Ok(())
    }
}
