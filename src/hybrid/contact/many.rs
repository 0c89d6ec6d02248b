//! What many contacts do: more than all of whose sets can be tried.
//!
//! Forces (or impulses) and accelerations (or rates) of contacts are a linear complementarity problem, with the friction of each
//! contact that is still between its two bounds (J. C. Trinkle, J.-S. Pang, S. Sudarsky and G. Lo 1997; F. Pfeiffer and
//! C. Glocker 1996, §6):
//!
//! ```text
//! z = (λ_N, μ λ_N + λ_T, γ⁻),  w = (g̈, γ⁺, μ λ_N − λ_T),  γ̇ = γ⁺ − γ⁻
//! ```
//!
//! A pivoting method solves it. What it says is tried like any other set, so that nothing is decided by its numbers: only which
//! sets are tried.

use super::geometry::{Geometry, Line};
use crate::model::Contacts;
use crate::numerics::{Unsolved, solve_complementarity};

/// Most sets of which all are tried at once: each takes some µs, most of them less than one.
const MOST_SETS: usize = 1024;

/// Most sets that hold no gap twice of which all are tried: many feet of one body have few, sixteen on a line 1,129, and a pivoting
/// method goes astray among them.
const MOST_INDEPENDENT: usize = 1 << 13;

/// Most sets of which all are tried where none of those is admitted that the pivoting method leaves: of ten contacts with friction.
/// Those whose lines depend on each other, which are most, take some µs.
const MOST_IN_ALL: usize = 1 << 20;

/// What is no more than this part of the terms that it is the sum of (√ε) may be zero: then the other choices of the contact are
/// tried, too.
pub(super) const MAY_BE_ZERO: f64 = 1.5e-8;

/// What is asked of a contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked {
    pub contact: usize,
    /// What its gap does without forces beyond the least, and that least force; none of friction without a gap.
    pub normal: Option<[f64; 2]>,
    pub friction: Friction,
}

/// The friction of a contact.
#[derive(Debug, Clone, Copy)]
pub(super) enum Friction {
    None,
    /// What its slip does without forces; its coefficient; its bound at the least normal force.
    Still {
        slip: f64,
        coefficient: f64,
        bound: f64,
    },
    /// It slips in this direction, with this coefficient.
    Slips {
        direction: f64,
        coefficient: f64,
    },
}

/// What a contact does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Answer {
    /// It pushes with the least force.
    Opens,
    /// It pushes, and sticks where it was still.
    Holds,
    /// It pushes, and begins to slip in this direction.
    Slips(f64),
    /// It pushes, with as much friction against this direction as it can hold, and may stick or begin to slip.
    Yields(f64),
}

/// Of each contact a choice, if one is known, and whether it may be another.
pub(super) type Answers<T> = Vec<(Option<T>, bool)>;

/// What the contacts do, and of each whether that may be otherwise, as far as rounding tells.
pub(super) fn answers(
    contacts: &Contacts,
    geometry: &Geometry,
    asked: &[Asked],
) -> Result<Vec<(Answer, bool)>, Unsolved> {
    let constraints: Vec<Line> = (0..contacts.constraints.len())
        .map(Line::Constraint)
        .collect();
    let mut pairs: Vec<Pair> = Vec::new();
    for (i, of) in asked.iter().enumerate() {
        if let Some([_, least]) = of.normal {
            let mut force = vec![(Line::Normal(of.contact), 1.0)];
            let tangent = Line::Tangent(of.contact);
            match of.friction {
                Friction::None => {}
                Friction::Still { coefficient, .. } => force.push((tangent, -coefficient)),
                Friction::Slips {
                    direction,
                    coefficient,
                } => force.push((tangent, -coefficient * direction)),
            }
            let fixed = force.iter().map(|&(line, part)| (line, part * least));
            let fixed = fixed.collect();
            pairs.push(Pair {
                of: i,
                kind: Kind::Normal,
                force,
                fixed,
            });
        }
        if let Friction::Still { bound, .. } = of.friction {
            let tangent = Line::Tangent(of.contact);
            let own = match of.normal {
                // It is in what the normal brings along.
                Some(_) => Vec::new(),
                None => vec![(tangent, -bound)],
            };
            pairs.push(Pair {
                of: i,
                kind: Kind::Forwards,
                force: vec![(tangent, 1.0)],
                fixed: own,
            });
            pairs.push(Pair {
                of: i,
                kind: Kind::Backwards,
                force: Vec::new(),
                fixed: Vec::new(),
            });
        }
    }
    let line = |pair: &Pair| match pair.kind {
        Kind::Normal => Line::Normal(asked[pair.of].contact),
        Kind::Forwards | Kind::Backwards => Line::Tangent(asked[pair.of].contact),
    };
    let lines: Vec<Line> = geometry.all().collect();
    let compliance = geometry.compliance(&lines, &constraints);
    let place = |line: Line| lines.iter().position(|known| *known == line);
    let moves = |of: Line, force: &[(Line, f64)]| -> f64 {
        let row = place(of).expect("every line is there") * lines.len();
        let parts = force.iter();
        parts
            .map(|&(line, part)| compliance[row + place(line).expect("every line is there")] * part)
            .sum()
    };
    let n = pairs.len();
    let mut matrix = vec![0.0; n * n];
    let mut q = vec![0.0; n];
    for (row, pair) in pairs.iter().enumerate() {
        let of = &asked[pair.of];
        if let (
            Kind::Backwards,
            Friction::Still {
                coefficient, bound, ..
            },
        ) = (pair.kind, of.friction)
        {
            // 2 μ λ_N − (μ λ_N + λ_T).
            q[row] = 2.0 * bound;
            matrix[row * n + row - 1] = -1.0;
            if of.normal.is_some() {
                matrix[row * n + row - 2] = 2.0 * coefficient;
            }
            continue;
        }
        let own = line(pair);
        for (column, other) in pairs.iter().enumerate() {
            matrix[row * n + column] = moves(own, &other.force);
        }
        let fixed: f64 = pairs.iter().map(|other| moves(own, &other.fixed)).sum();
        q[row] = fixed
            + match (pair.kind, of.normal, of.friction) {
                (Kind::Normal, Some([moves, _]), _) => moves,
                (_, _, Friction::Still { slip, .. }) => {
                    matrix[row * n + row + 1] += 1.0;
                    slip
                }
                _ => 0.0,
            };
    }
    let solution = solve_complementarity(|i, j| matrix[i * n + j], &q)?;
    let of_pair = |i: usize, kind: Kind| pairs.iter().position(|p| p.of == i && p.kind == kind);
    let may_be_zero = |row: usize| {
        let terms = (0..n).map(|j| (matrix[row * n + j] * solution.z[j]).abs());
        let size = q[row].abs() + terms.sum::<f64>();
        let largest = solution.z.iter().fold(0.0_f64, |most, z| most.max(z.abs()));
        match solution.basic[row] {
            true => solution.z[row] <= MAY_BE_ZERO * largest,
            false => solution.w[row] <= MAY_BE_ZERO * size,
        }
    };
    let answer = |i: usize| {
        let rows = [Kind::Normal, Kind::Forwards, Kind::Backwards].map(|kind| of_pair(i, kind));
        let is_open = rows[0].is_some_and(|row| !solution.basic[row]);
        let open = rows.iter().flatten().any(|&row| may_be_zero(row));
        // The slip acceleration of what is at the limit of its friction is the other of the pair.
        let at_limit = |row: usize, direction: f64| match may_be_zero(row) {
            true => Answer::Yields(direction),
            false => Answer::Slips(direction),
        };
        let answer = match (is_open, rows[1], rows[2]) {
            (true, ..) => Answer::Opens,
            (_, Some(forwards), _) if !solution.basic[forwards] => at_limit(forwards, 1.0),
            (_, _, Some(backwards)) if solution.basic[backwards] => at_limit(backwards, -1.0),
            _ => Answer::Holds,
        };
        // Of a contact that opens its friction says nothing.
        let open = match (is_open, rows[0]) {
            (true, Some(row)) => may_be_zero(row),
            _ => open,
        };
        (answer, open || solution.residual > MAY_BE_ZERO)
    };
    Ok((0..asked.len()).map(answer).collect())
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Normal,
    Forwards,
    Backwards,
}

/// An unknown and what it is complementary to.
struct Pair {
    /// Which of those asked.
    of: usize,
    kind: Kind,
    /// The forces that a unit of it is.
    force: Vec<(Line, f64)>,
    /// Those that act without it.
    fixed: Vec<(Line, f64)>,
}

/// All sets of choices, where those of each contact are given; the last contact changes fastest.
fn products<T: Clone>(choices: &[Vec<T>]) -> impl Iterator<Item = Vec<T>> + '_ {
    (0..count(choices)).map(move |mut index| {
        let mut set: Vec<T> = (choices.iter().rev())
            .map(|own| {
                let choice = own[index % own.len()].clone();
                index /= own.len();
                choice
            })
            .collect();
        set.reverse();
        set
    })
}

/// Number of sets of choices.
pub(super) fn count<T>(choices: &[Vec<T>]) -> usize {
    let sizes = choices.iter().map(Vec::len);
    sizes.fold(1, usize::saturating_mul)
}

/// All sets, where more than those are that are tried at first: the pivoting method goes astray where lines depend on each
/// other, and that there is none is said of all of them.
pub(super) fn all_of_many<T: Clone>(choices: &[Vec<T>]) -> impl Iterator<Item = Vec<T>> + '_ {
    let is_many = (MOST_SETS + 1..=MOST_IN_ALL).contains(&count(choices));
    products(choices).take(if is_many { usize::MAX } else { 0 })
}

/// The sets of choices that hold no gap which the others hold already, in the order of all products; `None` if there are more than
/// are tried at once. `holds`: the line whose rate a choice of a contact brings to a value, if it does.
fn independent<T: Clone>(
    choices: &[Vec<T>],
    geometry: &Geometry,
    holds: impl Fn(usize, &T) -> Option<Line>,
) -> Option<Vec<Vec<T>>> {
    let is_constraint = |line: &Line| matches!(line, Line::Constraint(_));
    let constraints = geometry.all().filter(is_constraint).collect();
    let mut sets: Vec<(Vec<T>, Vec<Line>)> = vec![(Vec::new(), constraints)];
    for (k, own) in choices.iter().enumerate() {
        let mut longer = Vec::new();
        for (set, held) in &sets {
            for choice in own {
                let mut held = held.clone();
                if let Some(line) = holds(k, choice) {
                    if geometry.depends(line, &held) {
                        continue;
                    }
                    held.push(line);
                }
                let set = set.iter().chain([choice]).cloned().collect();
                longer.push((set, held));
            }
        }
        sets = longer;
        if sets.len() > MOST_INDEPENDENT {
            return None;
        }
    }
    Some(sets.into_iter().map(|(set, _)| set).collect())
}

/// The choices to try: all where they are few, or where those are that are independent; else those that the answers leave, all of a contact that may do
/// otherwise, as long as they are few.
pub(super) fn to_try<T: Clone + PartialEq>(
    choices: &[Vec<T>],
    geometry: &Geometry,
    holds: impl Fn(usize, &T) -> Option<Line>,
    answered: impl FnOnce() -> Result<Vec<Answers<T>>, Unsolved>,
) -> Vec<Vec<T>> {
    if count(choices) <= MOST_SETS {
        return products(choices).collect();
    }
    if let Some(all) = independent(choices, geometry, holds) {
        return all;
    }
    let answered = answered().unwrap_or_default();
    let left = answered.iter().map(|answers| left_by(choices, answers));
    left.flatten().collect()
}

/// The choices that answers leave: all of a contact that may do otherwise, as long as they are few.
fn left_by<T: Clone + PartialEq>(choices: &[Vec<T>], answered: &Answers<T>) -> Vec<Vec<T>> {
    let mut left: Vec<Vec<T>> = (choices.iter().zip(answered))
        .map(|(all, (answer, _))| match answer {
            Some(answer) if all.contains(answer) => vec![answer.clone()],
            _ => all.clone(),
        })
        .collect();
    for (k, (_, may_be_otherwise)) in answered.iter().enumerate() {
        if *may_be_otherwise && count(&left) * choices[k].len() <= MOST_SETS {
            // The answer stays the first.
            let mut all = std::mem::take(&mut left[k]);
            let others = choices[k].iter().filter(|choice| !all.contains(choice));
            let others: Vec<T> = others.cloned().collect();
            all.extend(others);
            left[k] = all;
        }
    }
    match count(&left) <= MOST_SETS {
        true => products(&left).collect(),
        false => Vec::new(),
    }
}
