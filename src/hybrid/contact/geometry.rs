//! Masses, and the lines along which contacts and constraints push.

use super::ContactState;
use super::hold::ROUNDOFF;
use crate::kernel::Context;
use crate::model::Contacts;
use crate::numerics::{Buffer, Definite, Dynamic, Lu, Size};

/// What is left of a line beside others, as a part of it, where it is taken to depend on them: √ε. What is less cannot be told
/// from the rounding of a matrix of such lines, which squares it.
pub(super) const DEPENDENT: f64 = 1.5e-8;

/// Something that a force acts along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Line {
    /// The gap of a contact.
    Normal(usize),
    /// The slip of a contact.
    Tangent(usize),
    /// A constraint.
    Constraint(usize),
}

/// Masses and lines at a state.
#[derive(Debug)]
pub(super) struct Geometry {
    /// Free coordinates that are no multipliers.
    pub own: Vec<usize>,
    /// Their inertia, row by row.
    pub mass: Vec<f64>,
    /// How what the lines are about changes with these coordinates.
    lines: Vec<(Line, Vec<f64>)>,
    /// The same, in coordinates in which the inertia is 1.
    scaled: Vec<Vec<f64>>,
}

/// The multiplier of a line.
pub(super) fn multiplier(contacts: &Contacts, line: Line) -> usize {
    match line {
        Line::Normal(k) => contacts.contacts[k].normal.expect("it has a gap"),
        Line::Tangent(k) => contacts.contacts[k].tangent.expect("it has friction"),
        Line::Constraint(c) => contacts.constraints[c].multiplier,
    }
}

impl Geometry {
    /// At a state of a mode with all coordinates free, whose signals the context is set for.
    pub fn new(context: &Context, contacts: &Contacts, [q, v]: [&Buffer<f64>; 2]) -> Self {
        let own: Vec<usize> = (0..contacts.kernel.size().get())
            .filter(|&i| !contacts.is_multiplier(i))
            .collect();
        let mut rows = contacts.kernel.lines(context, q, v);
        let of_lines = rows.split_off(own.len() * own.len());
        let of_contacts = (contacts.contacts.iter().enumerate()).flat_map(|(k, contact)| {
            let normal = contact.normal.map(|_| Line::Normal(k));
            normal
                .into_iter()
                .chain(contact.tangent.map(|_| Line::Tangent(k)))
        });
        let lines = of_contacts.chain((0..contacts.constraints.len()).map(Line::Constraint));
        let lines: Vec<(Line, Vec<f64>)> = lines
            .zip(of_lines.chunks(own.len()))
            .map(|(line, row)| (line, row.to_vec()))
            .collect();
        let factor = inertia(&rows, own.len());
        let scaled = (lines.iter())
            .map(|(_, along)| factor.scaled(along))
            .collect();
        Geometry {
            own,
            mass: rows,
            lines,
            scaled,
        }
    }

    /// All lines.
    pub fn all(&self) -> impl Iterator<Item = Line> + '_ {
        self.lines.iter().map(|(line, _)| *line)
    }

    fn index(&self, line: Line) -> usize {
        let found = self.lines.iter().position(|(known, _)| *known == line);
        found.expect("every multiplier has its line")
    }

    /// How what a line is about changes with the coordinates.
    pub fn along(&self, line: Line) -> &[f64] {
        &self.lines[self.index(line)].1
    }

    /// Those of some lines that do not depend on those before them.
    pub fn independent(&self, lines: &[Line]) -> Vec<Line> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut kept = Vec::new();
        for &line in lines {
            if let Some(new) = beside(&self.scaled[self.index(line)], &basis) {
                basis.push(new);
                kept.push(line);
            }
        }
        kept
    }

    /// Those of some lines that together determine all of them, each time the one of which most is left beside those before it: of
    /// feet side by side the two outermost. What the others are about follows from these with parts that are no greater than about 1.
    pub fn spanning(&self, lines: &[Line]) -> Vec<Line> {
        let independent = self.independent(lines);
        if independent.len() == lines.len() {
            return independent;
        }
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut kept = Vec::new();
        while kept.len() < independent.len() {
            let left = (lines.iter().enumerate())
                .filter(|(i, _)| !kept.contains(i))
                .map(|(i, &line)| {
                    let (part, unit) = left_of(&self.scaled[self.index(line)], &basis);
                    (part * self.strength(line), i, unit)
                });
            let most = left.max_by(|(a, i, _), (b, j, _)| a.total_cmp(b).then(j.cmp(i)));
            let Some((_, i, unit)) = most else { break };
            kept.push(i);
            basis.push(unit);
        }
        kept.sort_unstable();
        kept.into_iter().map(|i| lines[i]).collect()
    }

    /// The parts of others that make up a line which depends on them; `None` of one that does not.
    pub fn parts(&self, line: Line, others: &[Line]) -> Option<Vec<(Line, f64)>> {
        let others = self.spanning(others);
        let all = others.iter().copied().chain([line]);
        let forces: Vec<Vec<(Line, f64)>> = all.map(|line| vec![(line, 1.0)]).collect();
        let parts = self.without_effect(&forces).pop()?;
        Some(
            others
                .into_iter()
                .zip(parts.into_iter().map(|part| -part))
                .collect(),
        )
    }

    /// Of some lines that of which the least is left beside those before it, as a part of the longest: whose force is determined
    /// least, and that part; `None` of no lines. What becomes shorter than all others is determined as little as what becomes
    /// parallel to them.
    pub fn least_determined(&self, lines: &[Line]) -> Option<(Line, f64)> {
        let length = |line: &Line| self.strength(*line);
        let longest = lines.iter().map(length).fold(0.0, f64::max);
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let determined = |&line: &Line| {
            let (part, unit) = left_of(&self.scaled[self.index(line)], &basis);
            basis.push(unit);
            (line, part * length(&line) / longest)
        };
        lines
            .iter()
            .map(determined)
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// The volume that some lines span: how well they determine their forces together.
    pub fn volume(&self, lines: &[Line]) -> f64 {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let left = |&line: &Line| {
            let scaled = &self.scaled[self.index(line)];
            let (part, unit) = left_of(scaled, &basis);
            basis.push(unit);
            part * dot(scaled, scaled).sqrt()
        };
        lines.iter().map(left).product()
    }

    /// Whether what is left of a line beside those before it points the other way at another place.
    pub fn turns_round(&self, line: Line, lines: &[Line], at: &Geometry) -> bool {
        let left = |geometry: &Geometry| {
            let mut basis: Vec<Vec<f64>> = Vec::new();
            for &before in lines.iter().take_while(|&&before| before != line) {
                basis.extend(beside(&geometry.scaled[geometry.index(before)], &basis));
            }
            left_of(&geometry.scaled[geometry.index(line)], &basis).1
        };
        dot(&left(self), &left(at)) < 0.0
    }

    /// Whether a line depends on others.
    pub fn depends(&self, line: Line, others: &[Line]) -> bool {
        let mut all = self.independent(others);
        all.push(line);
        self.independent(&all).len() < all.len()
    }

    /// How a coordinate, by its index in the mode, moves with what another line is about, while the places of some lines stay; zero
    /// where they hold it. `None` where more than these decides.
    pub fn moves(&self, coordinate: usize, lines: &[Line], with: Option<Line>) -> Option<f64> {
        let along: Vec<f64> = (self.own.iter())
            .map(|&i| f64::from(i == coordinate))
            .collect();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for &line in lines {
            basis.extend(beside(&self.scaled[self.index(line)], &basis));
        }
        let scaled = inertia(&self.mass, self.own.len()).scaled(&along);
        let Some(rest) = beside(&scaled, &basis) else {
            return Some(0.0);
        };
        let unit = beside(&self.scaled[self.index(with?)], &basis)?;
        let moves = dot(&rest, &unit);
        basis.push(unit);
        beside(&scaled, &basis).is_none().then_some(moves)
    }

    /// Whether two lines are the same but for their sign.
    pub fn are_parallel(&self, one: Line, other: Line) -> bool {
        let [a, b] = [one, other].map(|line| &self.scaled[self.index(line)]);
        let (length, product) = (dot(a, a), dot(a, b));
        let differs = |sign: f64| {
            let rest: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - sign * b).collect();
            dot(&rest, &rest) > (DEPENDENT * DEPENDENT) * length
        };
        !differs(product.signum())
    }

    /// How what lines are about changes per force along each of them, row by row, while others are held.
    pub fn compliance(&self, lines: &[Line], held: &[Line]) -> Vec<f64> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for &line in held {
            basis.extend(beside(&self.scaled[self.index(line)], &basis));
        }
        let left = |line: &Line| {
            let mut rest = self.scaled[self.index(*line)].clone();
            for unit in basis.iter().chain(&basis) {
                let part = dot(&rest, unit);
                rest.iter_mut().zip(unit).for_each(|(x, u)| *x -= part * u);
            }
            rest
        };
        let left: Vec<Vec<f64>> = lines.iter().map(left).collect();
        let row = |a: &Vec<f64>| left.iter().map(|b| dot(a, b)).collect::<Vec<f64>>();
        left.iter().flat_map(row).collect()
    }

    /// How much a unit force along a line moves.
    pub fn strength(&self, line: Line) -> f64 {
        let scaled = &self.scaled[self.index(line)];
        dot(scaled, scaled).sqrt()
    }

    /// What rounding leaves of a line that is brought back from coordinates, or rates, as these: a sum of as many products as there are
    /// coordinates, each no larger than both in the metric of the masses.
    pub fn rounding(&self, line: Line, x: &Buffer<f64>) -> f64 {
        let x: Vec<f64> = self.own.iter().map(|&i| x[i]).collect();
        let rows = self.mass.chunks(x.len()).map(|row| dot(row, &x));
        let square = dot(&x, &rows.collect::<Vec<f64>>());
        x.len() as f64 * ROUNDOFF * self.strength(line) * square.sqrt()
    }

    /// What rounding leaves of accelerations where forces of such sizes along the coordinates are held in balance: as of rates.
    pub fn rounding_of_accelerations(&self, forces: &[f64]) -> Vec<f64> {
        let n = self.own.len();
        let factor = inertia(&self.mass, n);
        let length = |along: &[f64]| {
            let scaled = factor.scaled(along);
            dot(&scaled, &scaled).sqrt()
        };
        let strongest = n as f64 * ROUNDOFF * length(forces);
        let unit = |i: usize| (0..n).map(|k| f64::from(k == i)).collect::<Vec<f64>>();
        (0..n).map(|i| strongest * length(&unit(i))).collect()
    }

    /// Changes of some forces that together have no effect, as many as are independent. A force is a sum of parts along lines.
    pub fn without_effect(&self, forces: &[Vec<(Line, f64)>]) -> Vec<Vec<f64>> {
        // Each vector of the basis with its own parts of the forces.
        let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        let mut found = Vec::new();
        for (i, pushes) in forces.iter().enumerate() {
            let mut left = vec![0.0; self.own.len()];
            for &(line, part) in pushes {
                let along = &self.scaled[self.index(line)];
                left.iter_mut().zip(along).for_each(|(x, a)| *x += part * a);
            }
            let length = dot(&left, &left).sqrt();
            let mut parts = vec![0.0; forces.len()];
            parts[i] = 1.0;
            for _ in 0..2 {
                for (unit, of) in &basis {
                    let along = dot(&left, unit);
                    left.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
                    parts.iter_mut().zip(of).for_each(|(p, o)| *p -= along * o);
                }
            }
            let rest = dot(&left, &left).sqrt();
            match rest > DEPENDENT * length {
                true => {
                    left.iter_mut().for_each(|x| *x /= rest);
                    parts.iter_mut().for_each(|p| *p /= rest);
                    basis.push((left, parts));
                }
                false => found.push(parts),
            }
        }
        found
    }

    /// The least change of coordinates, weighed by the masses, that changes what some independent lines are about by given
    /// amounts; `None` where they do depend on each other.
    pub fn least_change(&self, lines: &[Line], amounts: &[f64]) -> Option<Vec<f64>> {
        let mut change = self.pushed(lines, amounts)?;
        change.truncate(self.own.len());
        Some(change)
    }

    /// The same change, of rates, with the impulses along the lines that make it.
    pub fn least_push(&self, lines: &[Line], amounts: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut change = self.pushed(lines, amounts)?;
        let pushes = change.split_off(self.own.len());
        Some((change, pushes))
    }

    /// What impulses along some lines make of a change of rates, and these impulses.
    pub fn impulses(&self, lines: &[Line], change: &[f64]) -> (Vec<f64>, Vec<(Line, f64)>) {
        let lines = self.independent(lines);
        let amounts: Vec<f64> = (lines.iter())
            .map(|&line| dot(self.along(line), change))
            .collect();
        let (change, impulses) = self.least_push(&lines, &amounts).unwrap_or_default();
        (change, lines.into_iter().zip(impulses).collect())
    }

    /// The least change, and behind it the pushes along the lines that make it.
    fn pushed(&self, lines: &[Line], amounts: &[f64]) -> Option<Vec<f64>> {
        let (n, k) = (self.own.len(), lines.len());
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => self.mass[i * n + j],
            (true, false) => -self.along(lines[j - n])[i],
            (false, true) => self.along(lines[i - n])[j],
            (false, false) => 0.0,
        };
        let lu = Lu::<f64, Dynamic>::factorize(entry, &Dynamic(n + k).repeat(1.0)).ok()?;
        let pushed = lu.solve(|i| if i < n { 0.0 } else { amounts[i - n] });
        Some((0..n + k).map(|i| pushed[i]).collect())
    }
}

/// An inertia, row by row, factorized.
fn inertia(mass: &[f64], size: usize) -> Definite<Dynamic> {
    Definite::factorize(Dynamic(size), |i, j| mass[i * size + j])
}

/// The discrete states of contacts that do so, all of whose forces are determined.
pub(super) fn write_states(contacts: &Contacts, states: &[ContactState], discrete: &mut [f64]) {
    for (contact, &state) in contacts.contacts.iter().zip(states) {
        let mut set = |index: Option<usize>, value: f64| {
            if let Some(i) = index {
                discrete[i] = value;
            }
        };
        set(contact.closed, f64::from(u8::from(state.is_closed())));
        set(
            contact.direction,
            match state {
                ContactState::Slides(direction) => direction,
                _ => 0.0,
            },
        );
        for of_share in [contact.shares, contact.dropped, contact.at_limit] {
            set(of_share, 0.0);
        }
        (contact.joined.iter()).for_each(|&joined| set(joined, 0.0));
    }
    let of_constraints = contacts.constraints.iter().filter_map(|c| c.shares);
    of_constraints.for_each(|shares| discrete[shares] = 0.0);
}

/// What is left of a vector beside an orthonormal basis, of the length 1; `None` if nothing is.
fn beside(vector: &[f64], basis: &[Vec<f64>]) -> Option<Vec<f64>> {
    let (part, unit) = left_of(vector, basis);
    (part > DEPENDENT).then_some(unit)
}

/// The part of a vector that is left beside an orthonormal basis, and what is left, of the length 1. Of a vector that is zero
/// nothing is.
fn left_of(vector: &[f64], basis: &[Vec<f64>]) -> (f64, Vec<f64>) {
    let length = dot(vector, vector).sqrt();
    let mut rest = vector.to_vec();
    // Twice is enough (Giraud, Langou and Rozložník 2005).
    for _ in 0..2 {
        for unit in basis {
            let part = dot(&rest, unit);
            rest.iter_mut().zip(unit).for_each(|(x, u)| *x -= part * u);
        }
    }
    let left = dot(&rest, &rest).sqrt();
    if left == 0.0 {
        return (0.0, rest);
    }
    rest.iter_mut().for_each(|x| *x /= left);
    (left / length, rest)
}

/// Sum of products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_a_vector_is_told_from_nothing() {
        let basis = vec![vec![1.0, 0.0, 0.0]];
        assert_eq!(beside(&[3.0, 4.0, 0.0], &basis), Some(vec![0.0, 1.0, 0.0]));
        assert_eq!(beside(&[3.0, 1e-9, 0.0], &basis), None);
        assert!(beside(&[3.0, 1e-6, 0.0], &basis).is_some());
    }

    /// Of two lines of a unit mass in the plane, the second this far off the first.
    fn two_lines(angle: f64, length: f64) -> Geometry {
        let lines = [[1.0, 0.0], [length * angle.cos(), length * angle.sin()]].map(Vec::from);
        Geometry {
            own: vec![0, 1],
            mass: vec![1.0, 0.0, 0.0, 1.0],
            lines: [0, 1]
                .map(|c| (Line::Constraint(c), lines[c].clone()))
                .into(),
            scaled: lines.into(),
        }
    }

    #[test]
    fn a_line_is_determined_by_what_is_left_of_it_as_a_part_of_the_longest() {
        let both = [Line::Constraint(0), Line::Constraint(1)];
        let least = |angle: f64, length: f64| two_lines(angle, length).least_determined(&both);
        let (line, part) = least(0.3, 1.0).unwrap();
        assert_eq!(line, Line::Constraint(1));
        assert!((part - 0.3_f64.sin()).abs() < 1e-15);
        // A short line is determined as little as one that is nearly parallel to the first.
        let (line, part) = least(std::f64::consts::FRAC_PI_2, 0.01).unwrap();
        assert_eq!(line, Line::Constraint(1));
        assert!((part - 0.01).abs() < 1e-15);
        let (line, part) = least(std::f64::consts::FRAC_PI_2, 4.0).unwrap();
        assert_eq!((line, part), (Line::Constraint(0), 0.25));
        assert_eq!(two_lines(0.3, 1.0).least_determined(&[]), None);
    }

    #[test]
    fn what_is_left_of_a_line_turns_round_beyond_a_singular_position() {
        let both = [Line::Constraint(0), Line::Constraint(1)];
        let turns =
            |[a, b]: [f64; 2]| two_lines(a, 1.0).turns_round(both[1], &both, &two_lines(b, 1.0));
        assert!(turns([0.2, -0.1]));
        assert!(turns([-0.2, 0.1]));
        assert!(!turns([0.2, 0.1]));
        assert!(!turns([-0.2, -0.1]));
    }

    #[test]
    fn lines_that_depend_are_parts_of_those_that_are_farthest_apart() {
        // Heights of feet at these places beside the centre of a body that moves up and turns.
        let feet = [-0.1, 0.3, -0.5, 0.7];
        let lines: Vec<(Line, Vec<f64>)> = (feet.iter().enumerate())
            .map(|(k, &across)| (Line::Normal(k), vec![1.0, across]))
            .collect();
        let geometry = Geometry {
            own: vec![0, 1],
            mass: vec![1.0, 0.0, 0.0, 1.0],
            scaled: lines.iter().map(|(_, along)| along.clone()).collect(),
            lines,
        };
        let all: Vec<Line> = geometry.all().collect();
        assert_eq!(geometry.independent(&all), all[..2]);
        assert_eq!(geometry.spanning(&all), [all[2], all[3]]);
        assert_eq!(geometry.spanning(&all[..2]), all[..2]);
        let parts = geometry.parts(all[1], &[all[0], all[2], all[3]]).unwrap();
        let expected = [(all[2], 1.0 / 3.0), (all[3], 2.0 / 3.0)];
        for ((line, part), (of, expected)) in parts.into_iter().zip(expected) {
            assert_eq!(line, of);
            assert!((part - expected).abs() < 1e-15, "{part} and {expected}");
        }
        assert_eq!(geometry.parts(all[1], &all[..1]), None);
    }
}
