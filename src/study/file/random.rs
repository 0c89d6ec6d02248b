//! Random variables of a study file, and their samples.

use crate::scene::check::Checked;
use crate::scene::error::{Errors, SceneError, SceneErrorKind};
use crate::scene::source::Span;
use crate::study::design::{Block, Factor, Values};
use crate::study::distribution::Distribution;
use crate::study::normal;
use crate::study::sampling::{Random, Sobol, latin_hypercube};

use super::{Names, factor_of, number};

/// Most samples of a Latin hypercube.
const MOST_LATIN: f64 = (1 << 20) as f64;
/// Most samples of any design: Sobol's sequence has no more.
const MOST: f64 = u32::MAX as f64;

/// A variable: what varies, its distribution, and the values of a discrete one.
struct Variable {
    factor: Factor,
    distribution: Distribution,
}

/// The factors of all random variables, which vary together, sample by sample.
pub(super) fn block(random: &Checked, names: &Names, errors: &mut Errors) -> Option<Block> {
    let entries = random.get("variables").map_or(&[][..], Checked::entries);
    let variables: Vec<Option<Variable>> = entries
        .iter()
        .map(|(path, described)| errors.note(variable(path, described, names)))
        .collect();
    let variables: Vec<Variable> = variables.into_iter().collect::<Option<_>>()?;
    let count = random.get("count").map_or(1.0, Checked::number);
    let design = random.get("design").map_or("sobol", Checked::text);
    let most = match design {
        "latin_hypercube" => MOST_LATIN - 1.0,
        _ => MOST,
    };
    let at = |key: &str| random.get(key).map_or(&random.place, |value| &value.place);
    if count > most {
        let range = format!("at most {most} with the design `{design}`");
        let kind = SceneErrorKind::OutOfRange {
            value: count,
            range,
        };
        errors.push(SceneError::new(kind, at("count")));
        return None;
    }
    if design == "sobol" && variables.len() > Sobol::MOST {
        let message = format!(
            "the design `sobol` has {} dimensions, and there are {} variables",
            Sobol::MOST,
            variables.len()
        );
        let error = SceneError::new(SceneErrorKind::State { message }, at("variables"));
        errors.push(error.help("choose `latin_hypercube` or `random`"));
        return None;
    }
    let mixing = errors.note(correlations(random, &variables))?;
    let seed = random.get("seed").map_or(1.0, Checked::number) as u64;
    let count = count as usize;
    let mut columns = vec![Vec::with_capacity(count); variables.len()];
    for mut point in points(design, count, variables.len(), seed) {
        if let Some(mixing) = &mixing {
            mix(&mut point, mixing);
        }
        for ((column, variable), p) in columns.iter_mut().zip(&variables).zip(point) {
            column.push(variable.distribution.quantile(p));
        }
    }
    let factors = variables.into_iter().zip(columns);
    let factors = factors.map(|(variable, column)| drawn(variable.factor, column));
    Some(Block {
        factors: factors.collect(),
        count,
        is_sample: true,
    })
}

/// A factor with the values that were drawn: numbers, or indices of the values that it has.
fn drawn(factor: Factor, column: Vec<f64>) -> Factor {
    let values = match factor.values {
        Values::Numbers(given, places) if places.len() == 1 && given.is_empty() => {
            Values::Numbers(column, places)
        }
        Values::Numbers(given, places) => {
            let indices = || column.iter().map(|&i| i as usize);
            let places = indices().map(|i| places[i.min(places.len() - 1)].clone());
            Values::Numbers(indices().map(|i| given[i]).collect(), places.collect())
        }
        Values::Others(given) => {
            Values::Others(column.iter().map(|&i| given[i as usize].clone()).collect())
        }
    };
    Factor { values, ..factor }
}

/// Points of the cube: of each coordinate what is below it and what is above.
fn points(
    design: &str,
    count: usize,
    dimensions: usize,
    seed: u64,
) -> Box<dyn Iterator<Item = Vec<[f64; 2]>>> {
    let both = |point: Vec<f64>| point.into_iter().map(|p| [p, 1.0 - p]).collect();
    match design {
        "latin_hypercube" => {
            let points = latin_hypercube(count, dimensions, seed, false);
            Box::new(points.into_iter().map(both))
        }
        "random" => {
            let mut random = Random::new(seed);
            // The middle of one of 2⁵² cells: neither 0 nor 1, and exact.
            let mut draw = move || ((random.bits() >> 12) as f64 + 0.5) / 2f64.powi(52);
            let points = (0..count).map(move |_| (0..dimensions).map(|_| draw()).collect());
            Box::new(points.map(both))
        }
        _ => Box::new(Sobol::shifted(dimensions, seed).take(count).map(both)),
    }
}

/// Gives the normal variables behind a point their correlations.
fn mix(point: &mut [[f64; 2]], mixing: &[Vec<f64>]) {
    let z: Vec<f64> = point
        .iter()
        .map(|&[p, q]| match p < q {
            true => normal::quantile(p),
            false => -normal::quantile(q),
        })
        .collect();
    for (coordinate, row) in point.iter_mut().zip(mixing) {
        // A variable that depends on itself alone keeps the digits that it has.
        if row.iter().filter(|x| **x != 0.0).count() > 1 {
            let mixed: f64 = row.iter().zip(&z).map(|(l, z)| l * z).sum();
            *coordinate = [normal::probability(mixed), normal::probability(-mixed)];
        }
    }
}

/// The lower triangle whose square the matrix of the correlations is (Cholesky); none where nothing is correlated.
fn correlations(
    random: &Checked,
    variables: &[Variable],
) -> Result<Option<Vec<Vec<f64>>>, SceneError> {
    let Some(given) = random.get("correlations") else {
        return Ok(None);
    };
    let n = variables.len();
    let mut matrix = vec![vec![0.0; n]; n];
    let mut said = vec![vec![false; n]; n];
    for i in 0..n {
        matrix[i][i] = 1.0;
    }
    for triple in given.list() {
        let [first, second, coefficient] = [0, 1, 2].map(|i| &triple.list()[i]);
        let index = |name: &Checked| {
            let known: Vec<&str> = variables.iter().map(|v| v.factor.path.as_str()).collect();
            let found = known.iter().position(|known| *known == name.text());
            found.ok_or_else(|| {
                crate::scene::check::unknown_name(
                    "random variable",
                    name.text(),
                    &known,
                    &name.place,
                )
            })
        };
        let (i, j) = (index(first)?, index(second)?);
        if i == j || said[i][j] {
            let message = match i == j {
                true => format!("`{}` is correlated with itself", first.text()),
                false => format!(
                    "the correlation of `{}` and `{}` is already there",
                    first.text(),
                    second.text()
                ),
            };
            let kind = SceneErrorKind::State { message };
            return Err(SceneError::new(kind, &triple.place).help("name each pair once"));
        }
        (said[i][j], said[j][i]) = (true, true);
        (matrix[i][j], matrix[j][i]) = (coefficient.number(), coefficient.number());
    }
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let inner: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = matrix[i][j] - inner;
            if i != j {
                lower[i][j] = rest / lower[j][j];
            } else if rest > 0.0 {
                lower[i][i] = rest.sqrt();
            } else {
                let message = format!(
                    "no random variables have these correlations: with `{}` the matrix is not positive definite",
                    variables[i].factor.path
                );
                let kind = SceneErrorKind::State { message };
                return Err(SceneError::new(kind, &given.place).help(
                    "lower a coefficient; variables that follow from each other are one variable",
                ));
            }
        }
    }
    Ok(Some(lower))
}

/// A variable of the file.
fn variable(path: &str, described: &Checked, names: &Names) -> Result<Variable, SceneError> {
    let (kind, parameters) = &described.entries()[0];
    let (kind, parameters) = match described
        .entries()
        .iter()
        .find(|(k, _)| k != "above" && k != "below")
    {
        Some((kind, parameters)) => (kind, parameters),
        None => (kind, parameters),
    };
    let of = |key: &str| number(parameters, key);
    let wrong = |key: &str, range: String| {
        let kind = SceneErrorKind::OutOfRange {
            value: of(key),
            range,
        };
        let place = parameters.get(key).map_or(&parameters.place, |v| &v.place);
        Err(SceneError::new(kind, place))
    };
    let mut factor = names.factor(path);
    let distribution = match kind.as_str() {
        "uniform" => {
            let (from, to) = (of("from"), of("to"));
            if from >= to {
                return wrong("to", format!("> {from}, the smallest value"));
            }
            Distribution::Uniform { from, to }
        }
        "normal" => Distribution::Normal {
            mean: of("mean"),
            sd: of("sd"),
        },
        "lognormal" => Distribution::Lognormal {
            median: of("median"),
            beta: of("beta"),
        },
        "triangular" => {
            let (from, mode, to) = (of("from"), of("mode"), of("to"));
            if from >= to {
                return wrong("to", format!("> {from}, the smallest value"));
            }
            if !(from..=to).contains(&mode) {
                return wrong("mode", format!("from {from} to {to}"));
            }
            Distribution::Triangular { from, mode, to }
        }
        "empirical" => {
            let mut sorted = numbers(parameters);
            if sorted.len() < 2 {
                return Err(too_few(parameters, "values", 2));
            }
            sorted.sort_by(f64::total_cmp);
            Distribution::Empirical { sorted }
        }
        _ => {
            let values = parameters.get("values").map_or(&[][..], Checked::list);
            if values.is_empty() {
                return Err(too_few(parameters, "values", 1));
            }
            factor = factor_of(path, values, names);
            Distribution::Discrete {
                sums: sums(parameters, values.len())?,
            }
        }
    };
    let [above, below] = ["above", "below"].map(|key| described.get(key));
    if above.is_none() && below.is_none() {
        return Ok(Variable {
            factor,
            distribution,
        });
    }
    let number = |bound: Option<&Checked>, none: f64| bound.map_or(none, Checked::number);
    let limits = [
        number(above, f64::NEG_INFINITY),
        number(below, f64::INFINITY),
    ];
    match distribution.truncated(limits[0], limits[1]) {
        Some(distribution) => Ok(Variable {
            factor,
            distribution,
        }),
        None => {
            let place: &Span = &below
                .or(above)
                .map_or(&described.place, |b| &b.place)
                .clone();
            let message = "the distribution has no values between these".to_owned();
            Err(SceneError::new(SceneErrorKind::State { message }, place))
        }
    }
}

fn numbers(parameters: &Checked) -> Vec<f64> {
    let values = parameters.get("values").map_or(&[][..], Checked::list);
    values.iter().map(Checked::number).collect()
}

fn too_few(parameters: &Checked, key: &str, least: usize) -> SceneError {
    let place = parameters.get(key).map_or(&parameters.place, |v| &v.place);
    let message = format!("`{key}` needs at least {least}");
    SceneError::new(SceneErrorKind::State { message }, place)
}

/// The sums of the shares of a discrete variable, the last of which is 1.
fn sums(parameters: &Checked, count: usize) -> Result<Vec<f64>, SceneError> {
    let Some(given) = parameters.get("weights") else {
        return Ok((1..=count).map(|i| i as f64 / count as f64).collect());
    };
    let weights: Vec<f64> = given.list().iter().map(Checked::number).collect();
    let total: f64 = weights.iter().sum();
    if weights.len() != count || !(total > 0.0 && total.is_finite()) {
        let message = format!("{count} values need as many weights, not all of them 0");
        let kind = SceneErrorKind::State { message };
        return Err(SceneError::new(kind, &given.place));
    }
    let mut sum = 0.0;
    let mut sums: Vec<f64> = weights
        .iter()
        .map(|weight| {
            sum += weight;
            sum / total
        })
        .collect();
    sums[count - 1] = 1.0;
    Ok(sums)
}
