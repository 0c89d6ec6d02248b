//! A description as tables for the terminal.

use std::fmt::{self, Display, Formatter};

use super::description::{At, Coordinate, Description, Guard, Held, Mode, Parameter};
use crate::cli::table::Table;
use crate::record::rounded;

/// Digits of bounds, which may be multiples of π; the exact ones are in the JSON.
const DIGITS: usize = 6;

/// Shows a description.
pub struct Text<'a>(pub &'a Description);

impl Display for Text<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let d = self.0;
        writeln!(f, "{}: {}\nsource: {}", d.name, d.title, d.source)?;

        let mut choices = Table::new(["choice", "chosen", "options", "meaning"]);
        for c in &d.choices {
            choices.row([c.name, c.chosen, &c.options.join(", "), c.meaning]);
        }
        section(f, "Choices", &choices)?;

        let heads = [
            "coordinate",
            "unit",
            "unit of rate",
            "typical",
            "typical rate",
            "bound",
            "meaning",
        ];
        let mut coordinates = Table::new(heads).right([3, 4]);
        for c in &d.coordinates {
            coordinates.row([
                c.name.to_owned(),
                c.unit.to_owned(),
                format!("{}/s", c.unit),
                c.scale.to_string(),
                c.rate_scale.to_string(),
                bounds_of(c),
                c.meaning.to_owned(),
            ]);
        }
        section(f, "Coordinates", &coordinates)?;

        let mut discrete = Table::new(["discrete state", "values", "meaning"]);
        for s in &d.discrete {
            let values: Vec<String> = s.values.iter().map(f64::to_string).collect();
            discrete.row([s.name, &values.join(", "), s.meaning]);
        }
        section(
            f,
            "Discrete states (the first value is the default)",
            &discrete,
        )?;

        let mut inputs = Table::new(["input", "unit", "meaning"]);
        for i in &d.inputs {
            inputs.row([i.name, i.unit, i.meaning]);
        }
        section(f, "Inputs (zero by default)", &inputs)?;

        let heads = ["parameter", "unit", "default", "bounds", "meaning"];
        let mut parameters = Table::new(heads).right([2]);
        for p in &d.parameters {
            let default = p.default.to_string();
            parameters.row([p.name, p.unit, &default, &bounds(p), p.meaning]);
        }
        section(f, "Parameters", &parameters)?;

        let mut sets = Table::new(["set", "values", "meaning"]);
        for set in &d.parameter_sets {
            let value = |v: &super::description::Value| format!("{} = {}", v.parameter, v.value);
            let values: Vec<String> = set.values.iter().map(value).collect();
            let values = if values.is_empty() {
                "the defaults".into()
            } else {
                values.join(", ")
            };
            sets.row([set.name, &values, set.meaning]);
        }
        section(f, "Parameter sets", &sets)?;

        let mut reactions = Table::new(["reaction", "unit", "meaning"]);
        for r in &d.reactions {
            reactions.row([&r.name, &r.unit, &r.meaning]);
        }
        section(
            f,
            "Reactions (zero where the coordinate is free)",
            &reactions,
        )?;

        let mut outputs = Table::new(["output", "unit", "what it is", "meaning"]);
        for o in &d.outputs {
            outputs.row([o.name, o.unit, o.expression, o.meaning]);
        }
        section(f, "Outputs", &outputs)?;

        let heads = [
            "contact",
            "kind",
            "gap, rate of a ratchet, held at zero by a constraint",
            "slip",
            "friction",
            "restitution",
            "can be",
        ];
        let mut contacts = Table::new(heads);
        for c in &d.contacts {
            let under = c.normal.map(|n| format!(" under {n}"));
            let friction = match (c.static_friction, c.kinetic) {
                (Some(s), Some(k)) if s != k => format!("{s} static, {k} kinetic"),
                (_, k) => k.unwrap_or_default().to_owned(),
            };
            contacts.row([
                c.name,
                c.kind,
                c.gap.unwrap_or_default(),
                c.slip.unwrap_or_default(),
                &(friction + &under.unwrap_or_default()),
                c.restitution.unwrap_or_default(),
                &c.states.join(", "),
            ]);
        }
        section(f, "Contacts and constraints", &contacts)?;

        for mode in &d.modes {
            self::mode(f, mode)?;
        }

        let mut limits = Table::new(["limit state", "when", "then", "meaning"]);
        for limit in &d.limits {
            let then = if limit.ends {
                "the run ends"
            } else {
                "it goes on"
            };
            limits.row([limit.name, limit.when, then, limit.message]);
        }
        section(
            f,
            "Limit states (a scene may say what is done there)",
            &limits,
        )?;

        let mut validity = Table::new(["condition", "of", "what is assumed"]);
        for v in &d.validity {
            let of = if v.of_parameters {
                "parameters"
            } else {
                "motion"
            };
            validity.row([v.condition, of, v.message]);
        }
        section(f, "What the model is meant for", &validity)?;
        section(
            f,
            "Operations of one evaluation, by function and mode",
            &operations(&d.modes),
        )
    }
}

/// A table under its title; nothing if the table is empty.
fn section(f: &mut Formatter, title: &str, table: &Table) -> fmt::Result {
    if table.is_empty() {
        return Ok(());
    }
    write!(f, "\n{title}\n\n{}", indented(table))
}

/// A block two spaces to the right.
fn indented(text: &dyn Display) -> String {
    let text = text.to_string();
    text.lines().map(|line| format!("  {line}\n")).collect()
}

/// The bounds of a coordinate.
fn bounds_of(c: &Coordinate) -> String {
    let fixed = [
        c.minimum.map(|minimum| format!(">= {minimum}")),
        c.maximum.map(|maximum| format!("<= {maximum}")),
    ];
    let all: Vec<_> = fixed
        .into_iter()
        .flatten()
        .chain(c.bounds.iter().cloned())
        .collect();
    all.join(", ")
}

/// The bounds of a parameter, such as `> 0, <= mu_s`.
fn bounds(p: &Parameter) -> String {
    let sign = if p.minimum_exclusive { ">" } else { ">=" };
    let bounds = [
        p.minimum
            .map(|minimum| format!("{sign} {}", rounded(minimum, DIGITS))),
        p.maximum
            .map(|maximum| format!("<= {}", rounded(maximum, DIGITS))),
        p.at_most.map(|limit| format!("<= {limit}")),
    ];
    bounds.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn mode(f: &mut Formatter, mode: &Mode) -> fmt::Result {
    let free = match mode.free[..] {
        [] => "none".to_owned(),
        _ => mode.free.join(", "),
    };
    let held: Vec<String> = mode.held.iter().map(held).collect();
    // Modes that follow from contacts have no meaning beside their names.
    let colon = if mode.meaning.is_empty() { "" } else { ": " };
    writeln!(f, "\nMode {}{colon}{}\n", mode.name, mode.meaning)?;
    writeln!(f, "  free  {free}")?;
    if !held.is_empty() {
        writeln!(f, "  held  {}", held.join(", "))?;
    }
    for r in &mode.requirements {
        let text = within(r.text, mode);
        writeln!(f, "  needs {text} > 0 {}, else {}", r.unit, r.failure)?;
    }
    if !mode.rests.is_empty() {
        let rests = mode.rests.join(", ");
        writeln!(
            f,
            "  rest  events that accumulate end in {rests}, where their limit fits"
        )?;
    }
    let heads = [
        "transition",
        "to",
        "may change",
        "kind",
        "when this falls through 0",
        "unit",
    ];
    let mut guards = Table::new(heads);
    for guard in &mode.guards {
        transitions(&mut guards, guard, mode);
    }
    if guards.is_empty() {
        return Ok(());
    }
    write!(f, "\n{}", indented(&guards))
}

fn held(held: &Held) -> String {
    match (held.drifts, held.at) {
        _ if held.depends => match held.at {
            Some(At::Number(_)) | None => format!("{} with what it depends on", held.coordinate),
            Some(At::Expression(text)) => format!("{} at {text}", held.coordinate),
        },
        (true, _) => format!("{} moving at its rate", held.coordinate),
        (false, Some(At::Number(value))) => format!("{} at {value}", held.coordinate),
        (false, Some(At::Expression(text))) => format!("{} at {text}", held.coordinate),
        (false, None) => format!("{} where it is", held.coordinate),
    }
}

/// One row a transition; the guard is named beside its first.
fn transitions(table: &mut Table, guard: &Guard, mode: &Mode) {
    for (i, t) in guard.transitions.iter().enumerate() {
        let kind = match (t.impact, t.conditional) {
            (true, true) => "impact, conditional",
            (true, false) => "impact",
            (false, true) => "conditional",
            (false, false) if i > 0 => "otherwise",
            (false, false) => "",
        };
        let (text, unit) = match i {
            0 => (within(guard.text, mode), guard.unit),
            _ => ("as above".to_owned(), ""),
        };
        table.row([t.name, t.to, &t.changes.join(", "), kind, &text, unit]);
    }
}

/// An expression as it is read inside its mode: without the mode's name and outer brackets.
fn within(text: &str, mode: &Mode) -> String {
    let text = text.replace(&format!("@{}", mode.name), "");
    let inner = text.strip_prefix('(').and_then(|t| t.strip_suffix(')'));
    match inner {
        Some(inner) if is_balanced(inner) => inner.to_owned(),
        _ => text,
    }
}

/// Whether no bracket closes before it opens, and all are closed.
fn is_balanced(text: &str) -> bool {
    let mut depth = 0_i32;
    for c in text.chars() {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if depth < 0 {
            return false;
        }
    }
    depth == 0
}

/// One row a function, one column a mode. Functions of single guards and resets are added up.
fn operations(modes: &[Mode]) -> Table {
    let heads = ["function"]
        .into_iter()
        .chain(modes.iter().map(|mode| mode.name));
    let mut table = Table::new(heads).right(1..=modes.len());
    // `reset 0 1` is the second reset of the first guard.
    let family = |function: &'static str| function.split(' ').next().unwrap_or(function);
    let mut families = Vec::new();
    for operations in modes.iter().flat_map(|mode| &mode.operations) {
        let family = family(operations.function);
        if !families.contains(&family) {
            families.push(family);
        }
    }
    for name in families {
        let sum = |mode: &Mode| {
            let of_family = mode
                .operations
                .iter()
                .filter(|o| family(o.function) == name);
            of_family.map(|o| o.count).sum::<usize>().to_string()
        };
        let many = modes
            .iter()
            .flat_map(|m| &m.operations)
            .any(|o| o.function != name && family(o.function) == name);
        let label = if many {
            format!("{name}, all")
        } else {
            name.to_owned()
        };
        table.row([label].into_iter().chain(modes.iter().map(sum)));
    }
    table
}
