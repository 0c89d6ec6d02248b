//! The scene format: every key, its meaning, its unit and its range.
//!
//! Reading a scene and `dalembert schema` both follow these tables.

use super::check::Checked;
use super::limits;
use super::outputs;
use super::record;
use super::shape::{Key, Object, Quantity, Shape};
use crate::hybrid::{ImpactLaw, ImpactOrder, Method};
use crate::integrate::{Const, Tolerances};
use crate::model::{Bounds, Coordinate, Input, Limit, Model, Variant};

/// Relative tolerance of a scene that asks for none: eight digits, well above the rounding of long
/// runs and well below what a plot shows.
pub(crate) const DEFAULT_RELATIVE: f64 = 1e-8;

/// The methods of integration by name, the default first.
pub(crate) const METHODS: [(&str, Method); 3] = [
    ("auto", Method::Auto),
    ("radau", Method::Radau),
    ("taylor", Method::Taylor),
];

/// The laws of impact by name.
pub(crate) const LAWS: [(&str, ImpactLaw); 2] = [
    ("newton", ImpactLaw::Newton),
    ("poisson", ImpactLaw::Poisson),
];

/// The orders of contacts in an impact by name.
pub(crate) const ORDERS: [(&str, ImpactOrder); 2] = [
    ("together", ImpactOrder::Together),
    ("sequence", ImpactOrder::InSequence),
];

/// Version of the format of scenes, raised when a key changes its meaning or goes. One that says nothing is of the first.
pub(crate) const FORMAT: u32 = 1;

/// An initial state in static equilibrium.
pub(crate) const AT_REST: &str = "at rest";

/// What a run does at a limit state.
pub(crate) const END: &str = "end";
pub(crate) const CONTINUE: &str = "continue";
pub(crate) const IGNORE: &str = "ignore";

/// The shape of a scene of a model, with outputs of its own by name and unit, any for `None`; of any model, with less detail, for `None`.
pub(crate) fn scene(model: Option<&Model>, own: Option<&[(String, String)]>) -> Object {
    let name = match model {
        // The path of a folder was read before, and is not its name.
        Some(model) if model.is_loaded() => Shape::Text,
        Some(model) => Shape::Choice("model", vec![model.name]),
        None => Shape::Text,
    };
    let mut keys = vec![
        Key::new(
            "$schema",
            "JSON Schema of this file, for editors",
            Shape::Text,
        ),
        Key::new(
            "format",
            "version of the format of this file",
            Shape::Values([f64::from(FORMAT)].into()),
        ),
        Key::new("model", "name of the model, or path of a model folder, relative to the scene: anything with a slash is one", name).required(),
        Key::new("title", "what the scene shows", Shape::Line),
        Key::new(
            "parameters",
            "parameters that differ from their defaults",
            parameters(model),
        ),
    ];
    let mut switches = Vec::new();
    for choice in model.map_or(&[][..], |m| &m.choices) {
        let options = Shape::Choice("choice", choice.options.to_vec());
        match choice.name.strip_prefix(SWITCHES) {
            Some(contact) => switches.push(Key::new(contact, choice.meaning, options)),
            None => keys.push(Key::new(choice.name, choice.meaning, options)),
        }
    }
    let switches = match model {
        Some(_) => Object::new("contact that may be switched", switches),
        None => Object::new("contact", Vec::new()).others(Shape::Text),
    };
    keys.extend([
        Key::new(
            "contacts",
            "contacts, friction, ratchets and constraints that are left out (`off`) or held for good (`permanent`)",
            switches,
        ),
        Key::new(
            "inputs",
            "prescribed functions of time; zero if absent",
            inputs(model),
        ),
        Key::new(
            "initial",
            "state at t = 0; `at rest`: in static equilibrium, near where all that is not said is zero",
            Shape::Either(vec![
                initial(model).into(),
                Shape::Choice("state", vec![AT_REST]),
            ]),
        ),
        Key::new("freeze", "coordinates held still throughout", freeze(model)),
        Key::new("end", "when the run ends", end(model)).required(),
        Key::new(
            "limits",
            "limit states: what becomes of those of the model, and further ones",
            limits::shape(model, own),
        ),
        Key::new(
            "outputs",
            "further quantities to record: expressions in names of the model",
            outputs::shape(),
        ),
        Key::new("accuracy", "error tolerances", accuracy(model)),
        Key::new(
            "method",
            "method of integration: `radau` for all equations; `taylor`, the faster one, for equations \
             that are not stiff; `auto` starts with `taylor` and goes over to `radau` where that is faster",
            Shape::Choice("method", METHODS.map(|(name, _)| name).to_vec()),
        ),
    ]);
    if model.is_none_or(Model::has_contacts) {
        keys.push(Key::new(
            "impacts",
            "how impacts of contacts are decided, where laws differ",
            impacts(),
        ));
    }
    keys.push(Key::new("record", "what is written", record()));
    let object = Object::new("key", keys);
    if model.is_some() {
        object
    } else {
        object.others(Shape::Text)
    }
}

fn impacts() -> Object {
    let laws = LAWS.map(|(name, _)| name).to_vec();
    let orders = ORDERS.map(|(name, _)| name).to_vec();
    Object::new(
        "key of impacts",
        vec![
            Key::new(
                "law",
                "`newton`: the rate of a gap after is −e times that before; `poisson`: the impulse of expansion is at least e \
                 times that of compression",
                Shape::Choice("law", laws),
            )
            .default("newton"),
            Key::new(
                "order",
                "`together`: all contacts that touch take part at one instant; `sequence`: those that close first, then those \
                 that these make close, and so on",
                Shape::Choice("order", orders),
            )
            .default("together"),
            Key::new(
                "without_collision",
                "whether a state without a motion (Painlevé's paradox) goes on by an impact without collision, where there is \
                 one and no other",
                Shape::Flag,
            )
            .default(false),
        ],
    )
}

fn parameters(model: Option<&Model>) -> Object {
    let meaning = "named set of parameters to start from";
    let Some(model) = model else {
        let keys = vec![Key::new("set", meaning, Shape::Text)];
        return Object::new("parameter", keys).others(Quantity::any(""));
    };
    let mut keys = Vec::new();
    if !model.parameter_sets.is_empty() {
        let sets = model.parameter_sets.iter().map(|set| set.name).collect();
        keys.push(Key::new(
            "set",
            meaning,
            Shape::Choice("parameter set", sets),
        ));
    }
    keys.extend(model.parameters.iter().map(|p| {
        let quantity = Quantity::within(p.bounds(), p.unit);
        let meaning = match p.at_most {
            Some(limit) => format!("{}; at most {limit}", p.meaning),
            None => p.meaning.into(),
        };
        Key::new(p.name, meaning, quantity).default(p.default)
    }));
    Object::new("parameter", keys)
}

fn inputs(model: Option<&Model>) -> Object {
    match model {
        None => Object::new("input", Vec::new()).others(input("")),
        Some(model) => {
            let key = |i: &Input| Key::new(i.name, i.meaning, input(i.unit));
            Object::new("input", model.inputs.iter().map(key).collect())
        }
    }
}

/// An input: nothing, one function, or a sum.
fn input(unit: &str) -> Shape {
    let mut alternatives = functions(unit);
    let summand = Shape::List(Box::new(Shape::Tagged("input", functions(unit))));
    alternatives.push(Object::new(
        "key of a sum",
        vec![Key::new("sum", "functions that add up", summand).required()],
    ));
    Shape::Either(vec![Shape::Null, Shape::Tagged("input", alternatives)])
}

fn functions(unit: &str) -> Vec<Object> {
    let amplitude = Key::new("amplitude", "largest value", Quantity::any(unit)).required();
    let sine = Object::new(
        "key of a sine",
        vec![
            amplitude,
            Key::new("frequency", "cycles per second", Quantity::positive("Hz")),
            Key::new(
                "angular_frequency",
                "2π times the frequency",
                Quantity::positive("rad/s"),
            ),
            Key::new("phase", "angle at the start", Quantity::any("rad")).default(0.0),
            Key::new(
                "start",
                "time before which it is zero",
                Quantity::at_least(0.0, "s"),
            )
            .default(0.0),
            Key::new(
                "end",
                "time from which on it is zero",
                Quantity::positive("s"),
            ),
            Key::new(
                "cycles",
                "cycles after which it is zero",
                Quantity::positive("1"),
            ),
        ],
    )
    .exactly_one(["frequency", "angular_frequency"])
    .at_most_one(["end", "cycles"]);

    let mut table = vec![
        Key::new(
            "file",
            "CSV file with the columns time (s), value; relative to the scene",
            Shape::Text,
        )
        .required(),
        Key::new(
            "scale",
            "factor for the values, or what a value of 1 stands for (\"1 g_n\")",
            Quantity::factor(unit),
        )
        .default(1.0),
    ];
    table.extend(between_rows());

    let row = Shape::Tuple(
        "[time, value]",
        vec![Quantity::any("s").into(), Quantity::any(unit).into()],
    );
    let mut knots =
        vec![Key::new("knots", "rows [time, value]", Shape::List(Box::new(row))).required()];
    knots.extend(between_rows());

    let constant = Quantity::any(unit);
    vec![
        Object::new(
            "key beside a sine",
            vec![
                Key::new(
                    "sine",
                    "amplitude sin(2π frequency (t − start) + phase)",
                    sine,
                )
                .required(),
            ],
        ),
        Object::new(
            "key beside a table",
            vec![
                Key::new(
                    "table",
                    "rows from a file",
                    Object::new("key of a table", table),
                )
                .required(),
            ],
        ),
        Object::new("key beside knots", knots),
        record::shape(),
        Object::new(
            "key beside a constant",
            vec![Key::new("constant", "the same at all times", constant).required()],
        ),
    ]
}

fn between_rows() -> [Key; 2] {
    let interpolation = Shape::Choice("interpolation", vec!["linear", "cubic", "previous"]);
    let outside = Shape::Choice("extension", vec!["zero", "hold"]);
    [
        Key::new(
            "interpolation",
            "straight lines; a twice differentiable spline; or the value of the row before",
            interpolation,
        )
        .default("linear"),
        Key::new(
            "outside",
            "zero, or the first and the last value, outside the rows",
            outside,
        )
        .default("zero"),
    ]
}

/// What names of choices begin with that are options of contacts; scenes have them as `contacts`.
pub(crate) const SWITCHES: &str = "contacts.";

/// What a checked scene says of a choice.
pub(crate) fn chosen<'s>(scene: &'s Checked, choice: &str) -> Option<&'s Checked> {
    match choice.strip_prefix(SWITCHES) {
        Some(contact) => scene.get("contacts")?.get(contact),
        None => scene.get(choice),
    }
}

/// The key of a coordinate's velocity.
pub(crate) fn rate_key(coordinate: &Coordinate) -> String {
    rate_of(coordinate.name)
}

/// The key of a velocity.
pub(crate) fn rate_of(name: &str) -> String {
    format!("{name}.rate")
}

/// The unit of a coordinate's velocity.
pub(crate) fn rate_unit(coordinate: &Coordinate) -> String {
    format!("{}/s", coordinate.unit)
}

fn initial(model: Option<&Model>) -> Object {
    let meaning =
        "mode at t = 0; by default the one with the fewest free coordinates that holds the state";
    let Some(model) = model else {
        let keys = vec![Key::new("mode", meaning, Shape::Text)];
        return Object::new("coordinate", keys).others(Quantity::any(""));
    };
    let rest = "whether it starts in the static equilibrium near these coordinates, with the contact forces that hold it";
    let mut keys = vec![Key::new("at_rest", rest, Shape::Flag).default(false)];
    let modes = mode_names(&model.variants);
    if !modes.is_empty() {
        keys.push(Key::new("mode", meaning, Shape::Choice("mode", modes)));
    }
    let may_project = model.variants.iter().any(Variant::has_inadmissible);
    if may_project {
        let meaning = "whether a state that contacts and constraints do not admit is moved to the nearest that they do";
        keys.push(Key::new("project", meaning, Shape::Flag).default(false));
    }
    for c in model.own_coordinates() {
        // What is projected may be beyond its bounds: what is not is judged with the whole scene.
        let position = match may_project {
            true => Quantity::any(c.unit),
            false => Quantity::within(c.bounds(), c.unit),
        };
        keys.push(Key::new(c.name, c.meaning, position));
        let rate = format!("velocity of {}", c.name);
        keys.push(Key::new(rate_key(c), rate, Quantity::any(rate_unit(c))));
    }
    for m in model.motions.iter().filter(|m| !m.is_ground) {
        keys.push(Key::new(m.name, m.meaning, Quantity::any(m.unit)).default(0.0));
        let rate = format!("velocity of {}", m.name);
        let unit = format!("{}/s", m.unit);
        keys.push(Key::new(rate_of(m.name), rate, Quantity::any(unit)).default(0.0));
    }
    for d in model.discretes.iter().filter(|d| d.given) {
        let mut key = Key::new(d.name, d.meaning, Shape::Values(d.values.clone()));
        key.default = d.values.first().map(|&v| v.into());
        keys.push(key);
    }
    Object::new("coordinate", keys)
}

fn freeze(model: Option<&Model>) -> Shape {
    let name = match model {
        Some(model) => Shape::Choice(
            "coordinate",
            model.own_coordinates().iter().map(|c| c.name).collect(),
        ),
        None => Shape::Text,
    };
    Shape::List(Box::new(name))
}

fn end(model: Option<&Model>) -> Shape {
    let time = Quantity::positive("s");
    let transitions = match model {
        Some(model) => {
            let key = |name| Key::new(name, "how many of these transitions", Shape::Count);
            Object::new(
                "transition",
                transition_names(&model.variants)
                    .into_iter()
                    .map(key)
                    .collect(),
            )
        }
        None => Object::new("transition", Vec::new()).others(Shape::Count),
    };
    let object = Object::new(
        "key of the end",
        vec![
            Key::new("time", "latest end", time.clone()).required(),
            Key::new(
                "after",
                "the transition that ends the run and its number",
                transitions,
            ),
        ],
    );
    Shape::Either(vec![time.into(), object.into()])
}

fn accuracy(model: Option<&Model>) -> Object {
    // Below, no method can tell a step's error from rounding; above, it controls nothing.
    let relative = Bounds {
        maximum: 0.1,
        ..Bounds::at_least(Tolerances::<Const<0>>::SMALLEST_RELATIVE)
    };
    let relative = Quantity::within(relative, "1");
    let each = match model {
        None => Object::new("coordinate", Vec::new()).others(Quantity::positive("")),
        Some(model) => {
            let keys = model.own_coordinates().iter().flat_map(|c| {
                let rate = format!("of the velocity of {}", c.name);
                [
                    Key::new(c.name, format!("of {}", c.name), Quantity::positive(c.unit)),
                    Key::new(rate_key(c), rate, Quantity::positive(rate_unit(c))),
                ]
            });
            Object::new("coordinate", keys.collect())
        }
    };
    let all = Quantity::positive("1");
    let meaning = "absolute tolerance: one number for every coordinate and velocity, each in its \
                   unit, or an object; by default the relative one times the typical magnitude";
    Object::new(
        "key of the accuracy",
        vec![
            Key::new("relative", "relative tolerance of a step", relative)
                .default(DEFAULT_RELATIVE),
            Key::new(
                "absolute",
                meaning,
                Shape::Either(vec![all.into(), each.into()]),
            ),
        ],
    )
}

fn record() -> Object {
    let flag = |name, meaning| Key::new(name, meaning, Shape::Flag).default(true);
    Object::new(
        "key of the record",
        vec![
            Key::new(
                "every",
                "time between rows of the trajectory; by default the steps and both sides of every event",
                Quantity::positive("s"),
            ),
            flag("reactions", "whether reactions are computed and written"),
            flag("outputs", "whether outputs are computed and written"),
            flag("energies", "whether the energy ledger is kept"),
            flag("inputs", "whether inputs are written"),
        ],
    )
}

/// The names of the modes of some variants, each once, but for the only one, of all sets of contact states: it says nothing.
pub(crate) fn mode_names(variants: &[Variant]) -> Vec<&'static str> {
    let says = |v: &&Variant| v.modes.len() > 1 || v.modes[0].contacts.is_none();
    let modes = variants.iter().filter(says).flat_map(|v| &v.modes);
    unique(modes.map(|m| m.name))
}

/// The names of the transitions of some variants, each once.
pub(crate) fn transition_names(variants: &[Variant]) -> Vec<&'static str> {
    let guards = variants
        .iter()
        .flat_map(|v| &v.modes)
        .flat_map(|m| &m.guards);
    let modes = variants.iter().flat_map(|v| &v.modes);
    let contacts = modes.filter_map(|m| m.contacts.as_ref());
    let of_contacts = contacts.flat_map(|contacts| contacts.events());
    let of_guards = guards.flat_map(|g| &g.transitions).map(|t| t.name);
    unique(of_guards.chain(of_contacts))
}

/// The limit states of some variants, those of one name once.
pub(crate) fn limits(variants: &[Variant]) -> Vec<&Limit> {
    let all = variants.iter().flat_map(|v| &v.limits);
    let mut known: Vec<&Limit> = Vec::new();
    for limit in all {
        if known.iter().all(|k| k.name != limit.name) {
            known.push(limit);
        }
    }
    known
}

fn unique(names: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    let mut unique = Vec::new();
    for name in names {
        if !unique.contains(&name) {
            unique.push(name);
        }
    }
    unique
}
