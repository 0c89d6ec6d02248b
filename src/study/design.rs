//! Which cases a study has: the product of what varies, every factor of it in nested order.

use crate::scene::source::Span;
use crate::scene::template::Change;
use crate::scene::tree::{Node, Value};

/// What varies: a path in the scene and its values.
#[derive(Debug, Clone)]
pub(crate) struct Factor {
    /// The path as the study names it.
    pub path: String,
    /// The names on it.
    pub names: Vec<Span>,
    /// Unit of the values, if they are numbers with a unit.
    pub unit: Option<String>,
    pub values: Values,
}

/// The values of a factor.
#[derive(Debug, Clone)]
pub(crate) enum Values {
    /// Numbers in the unit of the place, and where each was written, or all were.
    Numbers(Vec<f64>, Vec<Span>),
    /// Anything else, with a text for each.
    Others(Vec<(String, Node)>),
}

/// A value of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Level<'a> {
    Number(f64),
    Text(&'a str),
}

/// Factors that vary together.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub factors: Vec<Factor>,
    /// Number of values of each.
    pub count: usize,
    /// Whether they are a sample, such as of random variables or of records, and not a grid.
    pub is_sample: bool,
}

/// All that varies; the last block varies fastest.
#[derive(Debug, Clone, Default)]
pub(crate) struct Design {
    pub blocks: Vec<Block>,
}

impl Values {
    pub fn level(&self, i: usize) -> Level<'_> {
        match self {
            Values::Numbers(numbers, _) => Level::Number(numbers[i]),
            Values::Others(others) => Level::Text(&others[i].0),
        }
    }

    /// The value as a scene has it.
    pub fn node(&self, i: usize) -> Node {
        match self {
            Values::Numbers(numbers, places) => {
                let place = places.get(i).unwrap_or(&places[0]);
                number_node(numbers[i], place)
            }
            Values::Others(others) => others[i].1.clone(),
        }
    }
}

/// A number that stands somewhere.
pub(crate) fn number_node(x: f64, place: &Span) -> Node {
    Node {
        span: place.clone(),
        value: Value::Number(format!("{x:?}")),
    }
}

impl Design {
    /// Number of cases; `None` if it is beyond 2⁵³.
    pub fn cases(&self) -> Option<u64> {
        let product = self.blocks.iter().try_fold(1_u64, |product, block| {
            product.checked_mul(block.count as u64)
        })?;
        (product <= 1 << 53).then_some(product)
    }

    /// The first case in which a block has one of its values.
    pub fn case_with(&self, block: usize, value: usize) -> u64 {
        let faster = self.blocks[block + 1..].iter();
        value as u64 * faster.map(|block| block.count as u64).product::<u64>()
    }

    /// All factors in order, and which of its values each has in a case.
    fn chosen(&self, case: u64) -> Vec<(&Factor, usize)> {
        let mut rest = case;
        let mut places = vec![0; self.blocks.len()];
        for (place, block) in places.iter_mut().zip(&self.blocks).rev() {
            *place = (rest % block.count as u64) as usize;
            rest /= block.count as u64;
        }
        let blocks = self.blocks.iter().zip(places);
        blocks
            .flat_map(|(block, place)| block.factors.iter().map(move |factor| (factor, place)))
            .collect()
    }

    /// The values of a case, one a factor.
    pub fn levels(&self, case: u64) -> Vec<Level<'_>> {
        let chosen = self.chosen(case).into_iter();
        chosen.map(|(factor, i)| factor.values.level(i)).collect()
    }

    /// What a case changes in the scene.
    pub fn changes(&self, case: u64) -> Vec<Change<'_>> {
        let chosen = self.chosen(case).into_iter();
        chosen
            .map(|(factor, i)| Change {
                path: &factor.names,
                value: factor.values.node(i),
            })
            .collect()
    }

    /// Whether its cases are a sample, of which statistics can be made.
    pub fn is_sample(&self) -> bool {
        self.blocks.iter().any(|block| block.is_sample)
    }

    /// All factors in order.
    pub fn factors(&self) -> impl Iterator<Item = &Factor> {
        self.blocks.iter().flat_map(|block| &block.factors)
    }

    /// Place of a factor in their order.
    pub fn factor(&self, path: &str) -> Option<usize> {
        self.factors().position(|factor| factor.path == path)
    }
}
