//! Names and dimensions of a formula.

use super::dimension::Dimension;
use super::expression::{Expression, Function};
use super::parse::{Node, Tree};
use super::unit::Unit;
use super::{FormulaError, Read, nearest};
use crate::model::{InputKind, Model, Variant};
use std::ops::Range;

/// The quantities that a formula may name.
#[derive(Debug, Clone)]
pub struct Names {
    /// Name, place and unit of each.
    all: Vec<(String, Read, String)>,
}

/// An expression with its dimension; of an exact zero, which fits anywhere, there is none.
type Resolved = (Expression, Option<Dimension>);

impl Names {
    /// Those of a variant of a model: coordinates (`x`), their rates and accelerations (`x.rate`, `x.acceleration`), reactions
    /// (`reaction.x`), discrete states, inputs with the velocity and displacement of the ground (`a`, `a.velocity`,
    /// `a.displacement`), parameters, outputs; and further outputs, by name and unit, that follow those of the model.
    pub fn new<'o>(
        model: &Model,
        variant: &Variant,
        further: impl IntoIterator<Item = (&'o str, &'o str)>,
    ) -> Names {
        let mut all = Vec::new();
        let mut add = |name: &str, read: Read, unit: &str| {
            all.push((name.to_owned(), read, unit.to_owned()));
        };
        let own = model.own_coordinates();
        for (i, c) in own.iter().enumerate() {
            add(c.name, Read::Coordinate(i), c.unit);
            add(
                &format!("{}.rate", c.name),
                Read::Rate(i),
                &format!("{}/s", c.unit),
            );
            add(
                &format!("{}.acceleration", c.name),
                Read::Acceleration(i),
                &format!("{}/s^2", c.unit),
            );
        }
        let forces = own.iter().map(|c| (c.name, c.reaction_unit));
        let forces = forces.chain(model.motions.iter().map(|m| (m.name, m.reaction_unit)));
        for (i, (name, unit)) in forces.enumerate() {
            let reaction = Read::Reaction(model.reaction(i));
            add(&format!("reaction.{name}"), reaction, unit);
        }
        for &i in &variant.discretes {
            add(model.discretes[i].name, Read::Discrete(i), "1");
        }
        for input in &model.inputs {
            add(input.name, Read::Signal(input.signal), input.unit);
            if input.kind == InputKind::Acceleration {
                let length = input.unit.strip_suffix("/s^2").unwrap_or(input.unit);
                let [velocity, displacement] = [1, 2].map(|k| Read::Signal(input.signal + k));
                add(
                    &format!("{}.velocity", input.name),
                    velocity,
                    &format!("{length}/s"),
                );
                add(
                    &format!("{}.displacement", input.name),
                    displacement,
                    length,
                );
            }
        }
        for (i, p) in model.parameters.iter().enumerate() {
            add(p.name, Read::Parameter(i), p.unit);
        }
        let of_model = variant.outputs.iter().map(|o| (o.name, o.unit));
        for (i, (name, unit)) in of_model.chain(further).enumerate() {
            add(name, Read::Output(i), unit);
        }
        Names { all }
    }

    /// Whether something has that name.
    pub fn has(&self, name: &str) -> bool {
        self.all.iter().any(|(known, ..)| known == name)
    }

    /// Puts in what names stand for, and checks dimensions.
    pub(super) fn resolve(&self, tree: &Tree) -> Result<Resolved, FormulaError> {
        match &tree.node {
            Node::Number(x) => Ok((
                Expression::Number(*x),
                (*x != 0.0).then_some(Dimension::NONE),
            )),
            Node::Name(name) => self.named(name, &tree.range),
            Node::Negative(of) => {
                let (x, dimension) = self.resolve(of)?;
                Ok((Expression::Negative(Box::new(x)), dimension))
            }
            Node::Two('^', of) => self.power(of),
            Node::Two(sign, of) => self.two(*sign, of),
            Node::Call(name, arguments) => self.call(name, arguments, &tree.range),
        }
    }

    fn named(&self, name: &str, range: &Range<usize>) -> Result<Resolved, FormulaError> {
        if let Some((_, read, unit)) = self.all.iter().find(|(known, ..)| known == name) {
            let unit = Unit::parse(unit).map_err(|reason| FormulaError {
                range: Some(range.clone()),
                message: format!("the unit `{unit}` of `{name}` cannot be read: {reason}"),
                help: "leave it out".to_owned(),
            })?;
            return Ok((Expression::Read(*read), Some(Dimension::of(&unit))));
        }
        if name == "pi" {
            let pi = Expression::Number(std::f64::consts::PI);
            return Ok((pi, Some(Dimension::NONE)));
        }
        let known = self.all.iter().map(|(known, ..)| known.as_str());
        let help = match nearest(name, known.clone()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("known: {}", known.collect::<Vec<_>>().join(", ")),
        };
        Err(FormulaError {
            range: Some(range.clone()),
            message: format!("unknown name `{name}`"),
            help,
        })
    }

    fn two(&self, sign: char, of: &[Tree; 2]) -> Result<Resolved, FormulaError> {
        let [(x, of_x), (y, of_y)] = [self.resolve(&of[0])?, self.resolve(&of[1])?];
        let both = Box::new([x, y]);
        let product = |power: f64| {
            let both = of_x.zip(of_y);
            both.map(|(x, y)| x.times(y.power(power)))
        };
        Ok(match sign {
            '*' => (Expression::Product(both), product(1.0)),
            '/' => (Expression::Quotient(both), product(-1.0)),
            _ => {
                if let (Some(x), Some(y)) = (of_x, of_y)
                    && x != y
                {
                    let message = format!("a term of dimension {y} is added to one of {x}");
                    return Err(FormulaError {
                        range: Some(of[1].range.clone()),
                        message,
                        help:
                            "terms of a sum have one dimension; a number has none: use a parameter"
                                .to_owned(),
                    });
                }
                let dimension = of_x.or(of_y);
                match sign {
                    '+' => (Expression::Sum(both), dimension),
                    _ => (Expression::Difference(both), dimension),
                }
            }
        })
    }

    fn power(&self, of: &[Tree; 2]) -> Result<Resolved, FormulaError> {
        /// Whole powers are products of so many factors at most.
        const MOST_FACTORS: f64 = 64.0;
        let (base, dimension) = self.resolve(&of[0])?;
        let exponent = self.plain(&of[1], "an exponent")?;
        let error = |message: &str| FormulaError {
            range: Some(of[1].range.clone()),
            message: message.to_owned(),
            help: "write a number".to_owned(),
        };
        let number = match exponent.reads(&|_| true) {
            true => None,
            false => Some(exponent.value(&super::Given::default())),
        };
        let dimension = match (number, dimension) {
            (_, None | Some(Dimension::NONE)) => dimension,
            (Some(number), Some(dimension)) => Some(dimension.power(number)),
            (None, Some(_)) => {
                return Err(error("what has a dimension has a number as its exponent"));
            }
        };
        let expression = match number {
            Some(number) if number.fract() == 0.0 && number.abs() <= MOST_FACTORS => {
                // Whole and small.
                Expression::Power(Box::new(base), number as i32)
            }
            _ => Expression::General(Box::new([base, exponent])),
        };
        Ok((expression, dimension))
    }

    fn call(
        &self,
        name: &str,
        arguments: &[Tree],
        range: &Range<usize>,
    ) -> Result<Resolved, FormulaError> {
        let error = |message: String, help: &str| FormulaError {
            range: Some(range.start..range.start + name.len()),
            message,
            help: help.to_owned(),
        };
        let takes = |count: usize| match arguments.len() == count {
            true => Ok(()),
            false => Err(error(
                format!(
                    "`{name}` takes {count} argument(s), not {}",
                    arguments.len()
                ),
                "as in sqrt(x) and atan2(y, x)",
            )),
        };
        if name == "atan2" {
            takes(2)?;
            let [(y, of_y), (x, of_x)] =
                [self.resolve(&arguments[0])?, self.resolve(&arguments[1])?];
            if of_y.zip(of_x).is_some_and(|(y, x)| y != x) {
                return Err(error(
                    "the arguments of `atan2` have different dimensions".to_owned(),
                    "it is the angle of the point (x, y): atan2(y, x)",
                ));
            }
            let angle = Expression::Angle(Box::new([y, x]));
            return Ok((angle, Some(Dimension::NONE)));
        }
        let Some((_, function)) = Function::NAMED.iter().find(|(known, _)| *known == name) else {
            let help = "functions are sin, cos, tan, exp, log, sqrt and atan2";
            return Err(match name {
                "abs" | "min" | "max" | "sign" => error(
                    format!("`{name}` is not smooth"),
                    "state the quantity with its sign: its peaks are a largest and a smallest value",
                ),
                _ => error(format!("unknown function `{name}`"), help),
            });
        };
        takes(1)?;
        let (x, dimension) = match function {
            Function::SquareRoot => {
                let (x, dimension) = self.resolve(&arguments[0])?;
                (x, dimension.map(|d| d.power(0.5)))
            }
            _ => {
                let what = format!("the argument of {name}");
                (self.plain(&arguments[0], &what)?, Some(Dimension::NONE))
            }
        };
        Ok((Expression::Function(*function, Box::new(x)), dimension))
    }

    /// An expression that must have no dimension.
    fn plain(&self, tree: &Tree, what: &str) -> Result<Expression, FormulaError> {
        let (x, dimension) = self.resolve(tree)?;
        match dimension {
            Some(dimension) if dimension != Dimension::NONE => Err(FormulaError {
                range: Some(tree.range.clone()),
                message: format!("{what} has the dimension {dimension}"),
                help: "divide it by a quantity of that dimension".to_owned(),
            }),
            _ => Ok(x),
        }
    }
}
