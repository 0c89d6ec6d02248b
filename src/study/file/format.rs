//! The format of study files: every key, its meaning, its unit and its range.
//!
//! Reading a study and `dalembert schema --study` both follow these tables.

use crate::model::Bounds;
use crate::scene::shape::{Key, Object, Quantity, Shape};

/// The quantities at the paths that a study names; none of a path where no number with a unit stands, and none at all where
/// the scene is not known.
#[derive(Default)]
pub(super) struct Quantities {
    /// All paths that it names.
    pub known: Vec<(String, Option<Quantity>)>,
    /// The path whose values `stripes`, `ida` or `critical` state.
    pub intensity: String,
}

impl Quantities {
    /// The number at a path with the bounds that the scene sets, if one stands there.
    pub fn quantity(&self, path: &str) -> Option<&Quantity> {
        let found = self.known.iter().find(|(known, _)| known == path);
        found.and_then(|(_, quantity)| quantity.as_ref())
    }

    /// A number in the unit at a path, of any size.
    fn any(&self, path: &str) -> Quantity {
        Quantity::any(self.quantity(path).map_or("", |q| &q.unit))
    }
}

/// The designs of random variables by name, the default first.
pub(super) const DESIGNS: [&str; 3] = ["sobol", "latin_hypercube", "random"];

/// Which runs are made a second time, the default first.
pub(super) const SECOND_RUNS: [&str; 3] = ["near", "all", "none"];

/// Runs of an incremental dynamic analysis for each case, if it does not say.
pub(super) const IDA_RUNS: f64 = 16.0;

/// Width of the bracket about a capacity, as a part of it, if an analysis does not say.
pub(super) const IDA_RESOLUTION: f64 = 0.02;

/// The same of a critical value.
pub(super) const CRITICAL_RESOLUTION: f64 = 1e-9;

/// The shape of a study.
pub(super) fn study(places: &Quantities) -> Object {
    let path = || Shape::Text;
    let keys = vec![
        Key::new("$schema", "JSON Schema of this file, for editors", Shape::Text),
        Key::new("title", "what the study asks", Shape::Line),
        Key::new(
            "scene",
            "scene file that is varied, relative to the study",
            Shape::Text,
        )
        .required(),
        Key::new(
            "vary",
            "values by their paths in the scene: every combination is a case, the last path varies fastest",
            by_path(places, &|path| levels(places, path)),
        ),
        Key::new(
            "cases",
            "a list of objects with values by their paths, which vary together; or a CSV file whose columns are paths",
            Shape::Either(vec![
                Shape::List(Box::new(by_path(places, &|path| level(places, path)))),
                Shape::Text,
            ]),
        ),
        Key::new("random", "random variables and their design", random(places)),
        Key::new(
            "stripes",
            "every case is run at these intensities",
            stripes(places),
        ),
        Key::new(
            "cloud",
            "every case has an intensity of its own",
            Object::new(
                "key of a cloud",
                vec![Key::new("intensity", "path of the intensity, which is varied or random", path()).required()],
            ),
        ),
        Key::new(
            "ida",
            "incremental dynamic analysis: of every case the intensity is raised until it fails",
            ida(places),
        ),
        Key::new(
            "critical",
            "of every case the least value that fails, by bisection",
            critical(places),
        ),
        Key::new(
            "measure",
            "what is measured of each run: `peak.NAME`, `max.NAME`, `min.NAME`, `end.NAME`, `count.TRANSITION`, \
             `reached.LIMIT`, `time.LIMIT`",
            Shape::List(Box::new(Shape::Text)),
        ),
        Key::new("failure", "when a run counts as a failure", failure()),
        Key::new(
            "second_runs",
            "which runs are made again at a hundredth of their tolerance, to tell those that are not decided",
            Shape::Choice("rule", SECOND_RUNS.to_vec()),
        )
        .default(SECOND_RUNS[0]),
        Key::new(
            "group",
            "path of what is varied, for each value of which a fragility is fitted of its own",
            path(),
        ),
    ];
    let mut object = Object::new("key", keys);
    let kinds = ["stripes", "cloud", "ida", "critical"];
    for (i, &first) in kinds.iter().enumerate() {
        for &second in &kinds[i + 1..] {
            object = object.at_most_one([first, second]);
        }
    }
    object
}

/// An object whose keys are paths: those that are known, or any.
fn by_path(places: &Quantities, shape: &dyn Fn(&str) -> Shape) -> Shape {
    if places.known.is_empty() {
        return Object::new("path", Vec::new()).others(shape("")).into();
    }
    let keys = places.known.iter().map(|(path, _)| {
        let meaning = format!("values of {path}");
        Key::new(path.clone(), meaning, shape(path))
    });
    Object::new("path", keys.collect()).into()
}

/// A single value at a path.
fn level(places: &Quantities, path: &str) -> Shape {
    match places.quantity(path) {
        Some(quantity) => quantity.clone().into(),
        None => Shape::Any,
    }
}

/// Values at a path: a list, or so many between two.
fn levels(places: &Quantities, path: &str) -> Shape {
    let list = Shape::List(Box::new(level(places, path)));
    let bound = || level_number(places, path);
    let range = Object::new(
        "key of a range",
        vec![
            Key::new("from", "first value", bound()).required(),
            Key::new("to", "last value", bound()).required(),
            Key::new("count", "number of values", Shape::Count),
            Key::new(
                "step",
                "difference of a value to the next",
                places.any(path),
            ),
            Key::new(
                "spacing",
                "whether differences or ratios are equal",
                Shape::Choice("spacing", vec!["linear", "log"]),
            )
            .default("linear"),
        ],
    )
    .exactly_one(["count", "step"]);
    Shape::Either(vec![list, range.into()])
}

/// A number at a path, within its bounds.
fn level_number(places: &Quantities, path: &str) -> Quantity {
    let quantity = places.quantity(path).cloned();
    quantity.unwrap_or_else(|| Quantity::any(""))
}

fn random(places: &Quantities) -> Object {
    let coefficient = Bounds {
        maximum: 1.0,
        ..Bounds::at_least(-1.0)
    };
    let correlation = Shape::Tuple(
        "[path, path, coefficient]",
        vec![
            Shape::Text,
            Shape::Text,
            Quantity::within(coefficient, "1").into(),
        ],
    );
    Object::new(
        "key of the random variables",
        vec![
            Key::new(
                "variables",
                "distributions by their paths in the scene",
                by_path(places, &|path| distribution(places, path)),
            )
            .required(),
            Key::new(
                "correlations",
                "coefficients of a Gaussian copula: of the normal variables behind two of them",
                Shape::List(Box::new(correlation)),
            ),
            Key::new("count", "number of samples", Shape::Count).required(),
            Key::new(
                "design",
                "how the samples are spread",
                Shape::Choice("design", DESIGNS.to_vec()),
            )
            .default(DESIGNS[0]),
            Key::new("seed", "another one gives other samples", Shape::Count).default(1),
        ],
    )
}

/// The distribution of the value at a path.
fn distribution(places: &Quantities, path: &str) -> Shape {
    let number = || places.any(path);
    let positive = || Quantity::positive(number().unit);
    let sample = |name: &'static str, meaning: &str, keys: Vec<Key>| {
        let parameters = Object::new("parameter of a distribution", keys);
        let key = Key::new(name, meaning, parameters).required();
        Object::new("key beside a distribution", vec![key])
    };
    let kind = |name: &'static str, meaning: &str, keys: Vec<Key>| {
        let cut = |name: &str, meaning: &str| Key::new(name, meaning, number());
        let mut object = sample(name, meaning, keys);
        object.keys.extend([
            cut("above", "only values above this one occur"),
            cut("below", "only values below this one occur"),
        ]);
        object
    };
    let values = || Shape::List(Box::new(level(places, path)));
    let share = Shape::List(Box::new(Quantity::at_least(0.0, "1").into()));
    let discrete = sample(
        "discrete",
        "one of some values",
        vec![
            Key::new("values", "the values", values()).required(),
            Key::new("weights", "their shares; equal ones if absent", share),
        ],
    );
    let numbers = Shape::List(Box::new(number().into()));
    let empirical = sample(
        "empirical",
        "a sample; between its values the quantile is linear",
        vec![Key::new("values", "the sample", numbers).required()],
    );
    Shape::Tagged(
        "distribution",
        vec![
            kind(
                "uniform",
                "equally likely between two values",
                vec![
                    Key::new("from", "smallest value", number()).required(),
                    Key::new("to", "largest value", number()).required(),
                ],
            ),
            kind(
                "normal",
                "normal",
                vec![
                    Key::new("mean", "mean", number()).required(),
                    Key::new("sd", "standard deviation", positive()).required(),
                ],
            ),
            kind(
                "lognormal",
                "the logarithm is normal",
                vec![
                    Key::new("median", "median", positive()).required(),
                    Key::new(
                        "beta",
                        "standard deviation of the logarithm",
                        Quantity::positive("1"),
                    )
                    .required(),
                ],
            ),
            kind(
                "triangular",
                "a density that rises and falls linearly",
                vec![
                    Key::new("from", "smallest value", number()).required(),
                    Key::new("mode", "most likely value", number()).required(),
                    Key::new("to", "largest value", number()).required(),
                ],
            ),
            discrete,
            empirical,
        ],
    )
}

fn stripes(places: &Quantities) -> Object {
    Object::new(
        "key of stripes",
        vec![
            Key::new("intensity", "path of the intensity", Shape::Text).required(),
            Key::new(
                "levels",
                "the intensities",
                levels(places, &places.intensity),
            )
            .required(),
        ],
    )
}

fn ida(places: &Quantities) -> Object {
    let number = || Quantity::positive(places.any(&places.intensity).unit);
    let part = Bounds {
        maximum: 0.5,
        ..Bounds::POSITIVE
    };
    Object::new(
        "key of the analysis",
        vec![
            Key::new("intensity", "path of the intensity", Shape::Text).required(),
            Key::new("first", "the first intensity", number()).required(),
            Key::new("step", "from the first to the second one", number()).required(),
            Key::new(
                "increment",
                "what each step of the hunt is longer by",
                Quantity::at_least(0.0, number().unit),
            )
            .default(0.0),
            Key::new("runs", "most runs of a case", Shape::Count).default(IDA_RUNS),
            Key::new(
                "resolution",
                "width of the bracket about the capacity, as a part of it, at which the trace ends and gaps are filled",
                Quantity::within(part, "1"),
            )
            .default(IDA_RESOLUTION),
            Key::new(
                "measure",
                "what the curves show; by default the first measure that is a number",
                Shape::Text,
            ),
        ],
    )
}

fn critical(places: &Quantities) -> Object {
    let number = || level_number(places, &places.intensity);
    let part = Bounds {
        maximum: 0.5,
        ..Bounds::at_least(2.0 * f64::EPSILON)
    };
    Object::new(
        "key of the critical value",
        vec![
            Key::new("value", "path of the value", Shape::Text).required(),
            Key::new("from", "where no run fails", number()).required(),
            Key::new("to", "the last value that is tried", number()).required(),
            Key::new(
                "scan",
                "number of equal steps from `from` to `to`; the first that ends in a failure is bisected",
                Shape::Count,
            )
            .default(1),
            Key::new(
                "resolution",
                "width of the last bracket, as a part of the value",
                Quantity::within(part, "1"),
            )
            .default(CRITICAL_RESOLUTION),
        ],
    )
}

fn failure() -> Shape {
    let limit = Key::new("limit", "a limit state that is reached", Shape::Text).required();
    let transition = Key::new("transition", "a transition that happens", Shape::Text).required();
    let measure = Key::new("measure", "a measure and its limit", Shape::Text).required();
    let bound = |name: &str| {
        let meaning = format!("it fails {name} this value, in the unit of the measure");
        // Its unit is that of the measure, and judged when that is known.
        Key::new(name, meaning, Shape::Any)
    };
    Shape::Tagged(
        "failure",
        vec![
            Object::new("key beside a limit state", vec![limit]),
            Object::new(
                "key beside a measure",
                vec![measure, bound("above"), bound("below")],
            )
            .exactly_one(["above", "below"]),
            Object::new("key beside a transition", vec![transition]),
        ],
    )
}
