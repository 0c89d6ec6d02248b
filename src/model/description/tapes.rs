//! Tapes: expressions as lists of instructions, each of which uses those before it.

use super::{Read, Reader};
use crate::model::reader::{At, number, text};
use crate::model::{Instruction, Name, Pick, Tape};

impl Reader<'_> {
    /// A tape with so many results. Operands are instructions before them; only the slope of a function may stand behind it.
    pub(super) fn tape(&self, at: &At, results: usize) -> Read<Tape> {
        let count = at.get("instructions", |at| Ok(at.list(|_| Ok(()))?.len()))?;
        let mut place = 0;
        let instructions = at.get("instructions", |at| {
            at.list(|at| {
                let instruction = self.instruction(at, (place, count));
                place += 1;
                instruction
            })
        })?;
        Ok(Tape {
            instructions,
            results: at.get("results", |at| at.list_of(results, |at| at.index(count)))?,
        })
    }

    fn instruction(&self, at: &At, (place, count): (usize, usize)) -> Read<Instruction> {
        let of = &*self.dimensions;
        at.tagged(|key, at| {
            let before = |at: &At| at.index(place);
            let two = |of: fn(usize, usize) -> Instruction| {
                Ok(of(at.entry(0, 2, before)?, at.entry(1, 2, before)?))
            };
            Ok(match key {
                "Constant" => Instruction::Constant(number(at)?),
                "Coordinate" => Instruction::Coordinate(at.index(of.coordinates)?),
                "Held" => Instruction::Held(at.index(of.coordinates + of.motions.len())?),
                "Rate" => Instruction::Rate(at.index(of.coordinates)?),
                "Acceleration" => Instruction::Acceleration(at.index(of.coordinates)?),
                "Signal" => Instruction::Signal(at.index(of.signals)?),
                "Discrete" => Instruction::Discrete(at.index(of.discretes)?),
                "Parameter" => Instruction::Parameter(at.index(of.parameters)?),
                "Sum" => two(Instruction::Sum)?,
                "Difference" => two(Instruction::Difference)?,
                "Product" => two(Instruction::Product)?,
                "Quotient" => two(Instruction::Quotient)?,
                "Negative" => Instruction::Negative(before(at)?),
                "Function" => Instruction::Function(
                    at.entry(0, 3, function_name)?,
                    at.entry(1, 3, before)?,
                    at.entry(2, 3, |at| at.index(count))?,
                ),
                "Fixed" => Instruction::Fixed(
                    at.entry(0, 3, pick)?,
                    at.entry(1, 3, before)?,
                    at.entry(2, 3, before)?,
                ),
                _ => return Err(at.wrong(format!("an instruction, which `{key}` is not"))),
            })
        })
    }
}

fn function_name(at: &At) -> Read<Name> {
    Ok(match text(at)? {
        "SquareRoot" => Name::SquareRoot,
        "Exponential" => Name::Exponential,
        "Logarithm" => Name::Logarithm,
        "Sine" => Name::Sine,
        "Cosine" => Name::Cosine,
        "Tangent" => Name::Tangent,
        "ArcSine" => Name::ArcSine,
        "ArcCosine" => Name::ArcCosine,
        "ArcTangent" => Name::ArcTangent,
        "HyperbolicSine" => Name::HyperbolicSine,
        "HyperbolicCosine" => Name::HyperbolicCosine,
        "HyperbolicTangent" => Name::HyperbolicTangent,
        _ => return Err(at.wrong("a smooth function")),
    })
}

fn pick(at: &At) -> Read<Pick> {
    Ok(match text(at)? {
        "Least" => Pick::Least,
        "Greatest" => Pick::Greatest,
        "Less" => Pick::Less,
        "NotMore" => Pick::NotMore,
        "Equal" => Pick::Equal,
        "Unequal" => Pick::Unequal,
        "Not" => Pick::Not,
        "And" => Pick::And,
        "Or" => Pick::Or,
        "Where" => Pick::Where,
        "Modulus" => Pick::Modulus,
        "Sign" => Pick::Sign,
        "Floor" => Pick::Floor,
        "Ceiling" => Pick::Ceiling,
        _ => return Err(at.wrong("an operation that is not smooth")),
    })
}
