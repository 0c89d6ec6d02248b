//! Names, units and order of everything a run records.

use std::ops::Range;

use super::modes::ModeNames;
use super::result::{Column, ColumnKind};
use crate::model::{InputKind, Model, Variant};

/// Which columns a scene records besides coordinates, velocities, discrete states and the mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Recorded {
    /// The reactions.
    pub reactions: bool,
    /// The outputs.
    pub outputs: bool,
    /// The running energy ledger.
    pub energies: bool,
    /// The signals of the inputs.
    pub inputs: bool,
}

/// A named quantity with its unit.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Quantity {
    /// Name.
    pub name: String,
    /// Unit, as the model writes it; `1` where there is none.
    pub unit: String,
    /// Meaning and sign, in words.
    pub meaning: String,
}

/// Names and units of all that a run records. A row of the trajectory holds the groups in the
/// order of the fields; [`Layout::range`] says where each one is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Layout {
    /// The coordinates.
    pub coordinates: Vec<Quantity>,
    /// The velocities, one a coordinate: `theta.rate`.
    pub velocities: Vec<Quantity>,
    /// The reactions, one a coordinate and one a motion of the ground: `reaction.theta`,
    /// `reaction.z_h`. Empty where they are not recorded.
    pub reactions: Vec<Quantity>,
    /// The discrete states.
    pub discretes: Vec<Quantity>,
    /// The outputs, those of the model first. Empty where they are not recorded.
    pub outputs: Vec<Quantity>,
    /// The impulses that an impact of contacts may have: `left.normal_impulse`. They are of transitions, not of rows.
    pub impulses: Vec<Quantity>,
    /// The running ledger, in this order: `energy.stored` (kinetic and potential),
    /// `energy.input_work`, `energy.dissipated`, `energy.lost_at_impacts`. Empty where it is not
    /// recorded.
    pub energies: Vec<Quantity>,
    /// The signals, in the model's order; an input `a` that is an acceleration gives `a`,
    /// `a.velocity` and `a.displacement`. Empty where they are not recorded.
    pub inputs: Vec<Quantity>,
    /// Names of the modes.
    pub modes: ModeNames,
}

impl Quantity {
    /// A quantity.
    pub fn new(
        name: impl Into<String>,
        unit: impl Into<String>,
        meaning: impl Into<String>,
    ) -> Self {
        Quantity {
            name: name.into(),
            unit: unit.into(),
            meaning: meaning.into(),
        }
    }
}

impl Layout {
    /// The layout of a model's runs, with outputs besides those of the model.
    pub fn new<'o>(
        model: &Model,
        variant: &Variant,
        recorded: Recorded,
        outputs: impl IntoIterator<Item = &'o Quantity>,
    ) -> Layout {
        let own = model.own_coordinates();
        let mut layout = Layout {
            coordinates: (own.iter())
                .map(|c| Quantity::new(c.name, c.unit, c.meaning))
                .collect(),
            velocities: (own.iter())
                .map(|c| {
                    let meaning = format!("rate of {}", c.name);
                    Quantity::new(format!("{}.rate", c.name), rate_unit(c.unit), meaning)
                })
                .collect(),
            discretes: (model.seen_discretes(variant))
                .map(|d| Quantity::new(d.name, "1", d.meaning))
                .collect(),
            impulses: (variant.impulses.iter())
                .map(|i| Quantity::new(i.name, i.unit, i.meaning))
                .collect(),
            modes: ModeNames::of(variant),
            ..Layout::default()
        };
        if recorded.reactions {
            layout.reactions = reactions(model);
        }
        if recorded.outputs {
            layout.outputs = Layout::outputs_of(variant, outputs);
        }
        if recorded.energies {
            layout.energies = ledger();
        }
        if recorded.inputs {
            layout.inputs = signals(model);
        }
        layout
    }

    /// The outputs of a variant, and further ones.
    pub fn outputs_of<'o>(
        variant: &Variant,
        further: impl IntoIterator<Item = &'o Quantity>,
    ) -> Vec<Quantity> {
        let of_model = variant.outputs.iter();
        let of_model = of_model.map(|o| Quantity::new(o.name, o.unit, o.meaning));
        of_model.chain(further.into_iter().cloned()).collect()
    }

    /// The groups in the order of a row.
    fn groups(&self) -> [(ColumnKind, &[Quantity]); 7] {
        [
            (ColumnKind::Coordinate, &self.coordinates),
            (ColumnKind::Velocity, &self.velocities),
            (ColumnKind::Reaction, &self.reactions),
            (ColumnKind::Discrete, &self.discretes),
            (ColumnKind::Output, &self.outputs),
            (ColumnKind::Energy, &self.energies),
            (ColumnKind::Input, &self.inputs),
        ]
    }

    /// The columns of a row, in order.
    pub fn columns(&self) -> Vec<Column> {
        let of_group = |(group, quantities): (ColumnKind, &[Quantity])| -> Vec<Column> {
            let column = |q: &Quantity| Column {
                name: q.name.clone(),
                unit: q.unit.clone(),
                meaning: q.meaning.clone(),
                group,
            };
            quantities.iter().map(column).collect()
        };
        self.groups().into_iter().flat_map(of_group).collect()
    }

    /// Where a group is in a row.
    pub fn range(&self, group: ColumnKind) -> Range<usize> {
        let mut start = 0;
        for (candidate, quantities) in self.groups() {
            if candidate == group {
                return start..start + quantities.len();
            }
            start += quantities.len();
        }
        unreachable!("groups() lists every group")
    }
}

fn reactions(model: &Model) -> Vec<Quantity> {
    let own = model.own_coordinates();
    let held = own.iter().map(|c| {
        let meaning = format!("generalized force that holds {} still", c.name);
        Quantity::new(format!("reaction.{}", c.name), c.reaction_unit, meaning)
    });
    let ground = model.motions.iter().map(|m| {
        let meaning = match m.is_ground {
            true => format!("force of the ground on the system along {}", m.name),
            false => format!("force on the system along {}, which drives it", m.name),
        };
        Quantity::new(format!("reaction.{}", m.name), m.reaction_unit, meaning)
    });
    held.chain(ground).collect()
}

fn ledger() -> Vec<Quantity> {
    vec![
        Quantity::new("energy.stored", "J", "kinetic and potential energy"),
        Quantity::new("energy.input_work", "J", "work of the inputs so far"),
        Quantity::new("energy.dissipated", "J", "energy dissipated so far"),
        Quantity::new(
            "energy.lost_at_impacts",
            "J",
            "energy lost at impacts so far",
        ),
    ]
}

fn signals(model: &Model) -> Vec<Quantity> {
    let of_input = |(i, input): (usize, &crate::model::Input)| {
        // The ground starts at rest where it is; others start where the scene says.
        let moved = model.motions.iter().find(|m| m.input == i && !m.is_ground);
        let start = moved.map_or("0 at t = 0".to_owned(), |m| {
            format!("from where {} starts", m.name)
        });
        let mut signals = vec![Quantity::new(input.name, input.unit, input.meaning)];
        if input.kind == InputKind::Acceleration {
            let length = input.unit.strip_suffix("/s^2").unwrap_or(input.unit);
            let integrals = [
                ("velocity", rate_unit(length), "integral"),
                ("displacement", length.to_owned(), "second integral"),
            ];
            for (what, unit, integral) in integrals {
                let meaning = format!("{integral} of {} over time, {start}", input.name);
                signals.push(Quantity::new(
                    format!("{}.{what}", input.name),
                    unit,
                    meaning,
                ));
            }
        }
        signals
    };
    model.inputs.iter().enumerate().flat_map(of_input).collect()
}

/// Unit of the rate of a quantity.
fn rate_unit(unit: &str) -> String {
    format!("{unit}/s")
}
