//! Linear complementarity: z ≥ 0 and w = M z + q ≥ 0 with w · z = 0, by Lemke's method (C. E. Lemke 1965; R. W. Cottle,
//! J.-S. Pang and R. E. Stone 1992, §4.4).
//!
//! Ties of the ratio test are broken lexicographically, so that no basis comes back. A solution is judged by a residual of its
//! own ([`Complementary::residual`]), whatever the pivots were.

use super::linear::Lu;
use super::size::{Dynamic, Size};

/// Unit roundoff of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Most pivots for each unknown. Lemke's method takes one to three of them for problems of mechanics; one that takes this many
/// is of the exponential kind (K. G. Murty 1978).
const MOST_PIVOTS: usize = 100;

/// A solution.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Complementary {
    /// The solution.
    pub z: Vec<f64>,
    /// M z + q.
    pub w: Vec<f64>,
    /// Of each pair, whether it is z that may be positive.
    pub basic: Vec<bool>,
    /// The largest of what should be zero and is not, or is negative, as a part of the terms that it is the sum of.
    pub residual: f64,
}

/// Why there is no solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unsolved {
    /// The method ended on a ray: of matrices as those of friction, there is none.
    Ray,
    /// It took too many pivots.
    Exhausted,
}

/// Solves a problem of as many pairs as `q` has numbers; the matrix by rows and columns.
pub(crate) fn solve_complementarity(
    matrix: impl Fn(usize, usize) -> f64,
    q: &[f64],
) -> Result<Complementary, Unsolved> {
    let n = q.len();
    let mut tableau = Tableau::new(&matrix, q);
    if q.iter().all(|&q| q >= 0.0) {
        return Ok(judged(&matrix, q, vec![false; n]));
    }
    let artificial = 2 * n;
    let first = (0..n).reduce(|a, b| match tableau.is_less((b, 1.0), (a, 1.0)) {
        true => b,
        false => a,
    });
    let Some(row) = first else {
        return Ok(judged(&matrix, q, Vec::new()));
    };
    let mut leaving = tableau.pivot(row, artificial);
    for _ in 0..MOST_PIVOTS * (n + 1) {
        let entering = match leaving < n {
            true => leaving + n,
            false => leaving - n,
        };
        let row = tableau.ratio_test(entering).ok_or(Unsolved::Ray)?;
        leaving = tableau.pivot(row, entering);
        if leaving == artificial {
            let mut basic = vec![false; n];
            let positive = tableau.basis.iter().filter(|&&b| (n..2 * n).contains(&b));
            positive.for_each(|&b| basic[b - n] = true);
            return Ok(judged(&matrix, q, basic));
        }
    }
    Err(Unsolved::Exhausted)
}

/// The solution with a basis, solved for anew, and its residual.
fn judged(matrix: &impl Fn(usize, usize) -> f64, q: &[f64], basic: Vec<bool>) -> Complementary {
    let n = q.len();
    let active: Vec<usize> = (0..n).filter(|&i| basic[i]).collect();
    let mut z = vec![0.0; n];
    let size = Dynamic(active.len());
    let entry = |i: usize, j: usize| matrix(active[i], active[j]);
    let mut residual = 0.0_f64;
    if !active.is_empty() {
        match Lu::<f64, Dynamic>::factorize(entry, &size.repeat(1.0)) {
            Ok(lu) => {
                let x = lu.solve(|i| -q[active[i]]);
                active.iter().enumerate().for_each(|(i, &k)| z[k] = x[i]);
            }
            // A basis is regular; where rounding has made it singular nothing is known.
            Err(_) => residual = f64::INFINITY,
        }
    }
    let largest = z.iter().fold(0.0_f64, |most, z| most.max(z.abs()));
    let w: Vec<f64> = (0..n)
        .map(|i| {
            let terms = || (0..n).map(|j| matrix(i, j) * z[j]);
            let w = q[i] + terms().sum::<f64>();
            let size = q[i].abs() + terms().map(f64::abs).sum::<f64>();
            let off = if basic[i] { w.abs() } else { (-w).max(0.0) };
            if off > 0.0 {
                residual = residual.max(off / size);
            }
            if z[i] < 0.0 {
                residual = residual.max(-z[i] / largest);
            }
            if basic[i] { 0.0 } else { w }
        })
        .collect();
    Complementary {
        z,
        w,
        basic,
        residual,
    }
}

/// I w − M z − z₀ = q, row by row; the last column is the right side.
struct Tableau {
    n: usize,
    rows: Vec<Vec<f64>>,
    /// The variable that each row is about: w, then z, then z₀.
    basis: Vec<usize>,
}

impl Tableau {
    fn new(matrix: &impl Fn(usize, usize) -> f64, q: &[f64]) -> Self {
        let n = q.len();
        let row = |i: usize| {
            let identity = (0..n).map(|j| f64::from(u8::from(i == j)));
            let mut row: Vec<f64> = identity.collect();
            row.extend((0..n).map(|j| -matrix(i, j)));
            row.extend([-1.0, q[i]]);
            row
        };
        Tableau {
            n,
            rows: (0..n).map(row).collect(),
            basis: (0..n).collect(),
        }
    }

    /// Whether a row over a number is lexicographically less than another: the right side first, then the columns of w.
    fn is_less(&self, (a, by_a): (usize, f64), (b, by_b): (usize, f64)) -> bool {
        let last = 2 * self.n + 1;
        let columns = std::iter::once(last).chain(0..self.n);
        for column in columns {
            let [x, y] = [(a, by_a), (b, by_b)].map(|(row, by)| self.rows[row][column] / by);
            if x != y {
                return x < y;
            }
        }
        false
    }

    /// The row in which a variable that grows first takes another one to zero.
    fn ratio_test(&self, entering: usize) -> Option<usize> {
        let column = |row: usize| self.rows[row][entering];
        let largest = (0..self.n).fold(0.0_f64, |most, row| most.max(column(row).abs()));
        // What elimination leaves of a zero (Higham 2002, §9.3).
        let least = 3.0 * self.n as f64 * ROUNDOFF * largest;
        let last = 2 * self.n + 1;
        (0..self.n)
            .filter(|&row| column(row) > least)
            .reduce(|best, row| {
                let ratio = |row: usize| self.rows[row][last] / column(row);
                let ends = |row: usize| self.basis[row] == 2 * self.n;
                // Where z₀ can be the one, the solution is there.
                match ratio(row) == ratio(best) && (ends(row) || ends(best)) {
                    true if ends(row) => row,
                    true => best,
                    false if self.is_less((row, column(row)), (best, column(best))) => row,
                    false => best,
                }
            })
    }

    /// Brings a variable into the basis in a row; gives the one that leaves it.
    fn pivot(&mut self, row: usize, entering: usize) -> usize {
        let by = self.rows[row][entering];
        self.rows[row].iter_mut().for_each(|x| *x /= by);
        let pivot = self.rows[row].clone();
        for (i, other) in self.rows.iter_mut().enumerate() {
            let factor = other[entering];
            if i != row && factor != 0.0 {
                (other.iter_mut().zip(&pivot)).for_each(|(x, p)| *x -= factor * p);
                other[entering] = 0.0;
            }
        }
        std::mem::replace(&mut self.basis[row], entering)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(rows: &[&[f64]], q: &[f64]) -> Result<Complementary, Unsolved> {
        solve_complementarity(|i, j| rows[i][j], q)
    }

    fn assert_solves(rows: &[&[f64]], q: &[f64]) -> Complementary {
        let found = solve(rows, q).expect("a solution");
        assert!(found.residual <= 1e-15, "{found:?}");
        assert!(found.z.iter().all(|&z| z >= 0.0), "{found:?}");
        assert!(found.w.iter().all(|&w| w >= -1e-15), "{found:?}");
        found
    }

    #[test]
    fn empty_problems_have_the_empty_solution() {
        let found = solve(&[], &[]).unwrap();
        assert_eq!((found.z.len(), found.residual), (0, 0.0));
    }

    #[test]
    fn a_problem_that_asks_for_nothing_has_the_solution_zero() {
        assert_eq!(assert_solves(&[&[2.0]], &[1.0]).z, [0.0]);
        assert_eq!(assert_solves(&[&[-2.0]], &[0.0]).z, [0.0]);
    }

    #[test]
    fn a_problem_of_a_positive_definite_matrix_has_its_one_solution() {
        let found = assert_solves(
            &[&[2.0, 1.0, 0.0], &[1.0, 2.0, 1.0], &[0.0, 1.0, 2.0]],
            &[-4.0, -5.0, -1.0],
        );
        assert_eq!(found.z, [1.0, 2.0, 0.0]);
        assert_eq!(found.w, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn ties_are_broken() {
        // Rows that are the same: any of the solutions, whose sum is determined.
        let found = assert_solves(&[&[1.0, 1.0], &[1.0, 1.0]], &[-1.0, -1.0]);
        assert_eq!(found.z[0] + found.z[1], 1.0);
        let four = [[1.0; 4]; 4];
        let rows: Vec<&[f64]> = four.iter().map(|row| &row[..]).collect();
        let found = assert_solves(&rows, &[-2.0; 4]);
        assert_eq!(found.z.iter().sum::<f64>(), 2.0);
    }

    #[test]
    fn degenerate_problems_do_not_cycle() {
        // Without a rule for ties the pivots return to where they were (M. M. Kostreva 1979).
        assert_solves(
            &[&[1.0, 2.0, 0.0], &[0.0, 1.0, 2.0], &[2.0, 0.0, 1.0]],
            &[-1.0, -1.0, -1.0],
        );
    }

    /// K. G. Murty's (1978) take 2ⁿ pivots: few of them are solved, many given up.
    #[test]
    fn problems_of_exponentially_many_pivots_are_given_up() {
        let entry = |i: usize, j: usize| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => 1.0,
            std::cmp::Ordering::Greater => 2.0,
        };
        let found = solve_complementarity(entry, &[-1.0; 6]).unwrap();
        assert_eq!(
            (found.z, found.residual),
            (vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0.0)
        );
        let many = solve_complementarity(entry, &[-1.0; 12]);
        assert_eq!(many, Err(Unsolved::Exhausted));
    }

    #[test]
    fn an_unsolvable_problem_ends_on_a_ray() {
        // w = −z − 1 is negative for all z.
        assert_eq!(solve(&[&[-1.0]], &[-1.0]), Err(Unsolved::Ray));
        // A push that friction turns against itself: Painlevé's rod.
        assert_eq!(
            solve(&[&[-0.075, 0.0], &[0.0, 1.0]], &[-9.81, 1.0]),
            Err(Unsolved::Ray)
        );
    }

    #[test]
    fn random_problems_of_positive_definite_matrices_have_their_one_solution() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
        };
        for n in 1..24 {
            let root: Vec<f64> = (0..n * n).map(|_| random()).collect();
            let entry = |i: usize, j: usize| {
                let product: f64 = (0..n).map(|k| root[i * n + k] * root[j * n + k]).sum();
                product + if i == j { 0.5 } else { 0.0 }
            };
            // From a solution that is known.
            let z: Vec<f64> = (0..n).map(|_| random().max(0.0)).collect();
            let q: Vec<f64> = (0..n)
                .map(|i| {
                    let w = if z[i] > 0.0 { 0.0 } else { random().abs() };
                    w - (0..n).map(|j| entry(i, j) * z[j]).sum::<f64>()
                })
                .collect();
            let found = solve_complementarity(entry, &q).unwrap();
            assert!(found.residual <= 1e-13, "{n}: {}", found.residual);
            for i in 0..n {
                assert!((found.z[i] - z[i]).abs() <= 1e-12, "{n}: {i}");
            }
        }
    }
}
