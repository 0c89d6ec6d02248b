//! The Radau IIA tableaux with 1, 3, 5 and 7 stages (orders 1, 5, 9 and 13).
//!
//! Radau IIA: collocation at the zeros of P_S(2c − 1) − P_{S−1}(2c − 1); L-stable and stiffly
//! accurate (the last stage is the end of the step). Sources: E. Hairer, G. Wanner, *Solving
//! Ordinary Differential Equations II*, 2nd ed. (1996), IV.5 and IV.8; *Stiff differential
//! equations solved by Radau methods*, J. Comput. Appl. Math. 111 (1999) 93–111. The numbers are in
//! `coefficients.rs`, computed with 60 digits by `tools/tableaux.py`; the tests below check them
//! against the order conditions.

/// Complex pairs of eigenvalues of the largest tableau (7 stages).
pub const MAX_PAIRS: usize = 3;

/// Names the method with `S` stages; [`Coefficients`] is implemented for `S` = 1, 3, 5 and 7.
#[derive(Debug, Clone, Copy)]
pub struct RadauIia<const S: usize>;

/// The coefficients of a method. A number of stages that has no tableau does not compile.
pub trait Coefficients<const S: usize> {
    /// The coefficients.
    const TABLEAU: &'static Tableau<S>;
}

/// Coefficients of Radau IIA with `S` stages; matrices are row-major, dimensionless.
#[derive(Debug)]
pub struct Tableau<const S: usize> {
    /// Nodes c, increasing, the last is 1.
    pub c: [f64; S],
    /// Runge–Kutta matrix A; its last row holds the weights b.
    pub a: [[f64; S]; S],
    /// A², which takes accelerations to displacements.
    pub a2: [[f64; S]; S],
    /// The real eigenvalue γ of A.
    pub gamma: f64,
    /// The complex eigenvalues α + iβ of A with β > 0 as `[α, β]`; (S − 1)/2 of them, then zeros.
    pub pairs: [[f64; 2]; MAX_PAIRS],
    /// T with A T = T Λ, Λ = blockdiag(γ, `[[α, −β], [β, α]]`, …): the real eigenvector, then
    /// Re and −Im of each complex one. Last components are normalized to 1.
    pub t: [[f64; S]; S],
    /// T⁻¹.
    pub t_inverse: [[f64; S]; S],
    /// Weights of the embedded formula: γ + Σ e_i = 0 and Σ e_i c_i^k = 0 for k = 1 … S − 1.
    pub e: [f64; S],
    /// eᵀA.
    pub ea: [f64; S],
    /// |Σ e_i c_i^S| / S!: the unfiltered estimate is this × h^(S+1) × the S-th derivative of the
    /// acceleration, to leading order.
    pub error_constant: f64,
    /// Collocation polynomial of the displacement: row k holds the weights of the stage
    /// accelerations in its power k + 3 of s ∈ [0, 1], in units of h².
    pub collocation: [[f64; S]; S],
    /// The same for power 2.
    pub collocation_square: [f64; S],
    /// Displacement from the interpolant of the acceleration through the step's start and all
    /// stages: row k holds the weights of A_j − a₀ in power k + 3. Unused for S = 1.
    pub smooth: [[f64; S]; S],
}

impl<const S: usize> Tableau<S> {
    /// Number of stages, S.
    pub const STAGES: usize = S;
    /// Classical order of the end point, 2S − 1.
    pub const ORDER: usize = 2 * S - 1;
    /// Number of complex pairs of eigenvalues, (S − 1)/2.
    pub const PAIRS: usize = (S - 1) / 2;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of S products of numbers below 1 in size, with room for cancellation in T.
    const ROUNDING: f64 = 64.0 * f64::EPSILON;

    fn close(actual: f64, expected: f64, what: &str) {
        assert!(
            (actual - expected).abs() <= ROUNDING * (1.0 + expected.abs()),
            "{what}: {actual} instead of {expected}"
        );
    }

    fn check<const S: usize>()
    where
        RadauIia<S>: Coefficients<S>,
    {
        let tableau = RadauIia::<S>::TABLEAU;
        let power = |x: f64, k: usize| x.powi(k as i32);
        let sum = |weights: &[f64; S], k: usize| -> f64 {
            (0..S).map(|i| weights[i] * power(tableau.c[i], k)).sum()
        };
        let b = &tableau.a[S - 1];
        assert_eq!(tableau.c[S - 1], 1.0, "stiffly accurate");
        for k in 1..=Tableau::<S>::ORDER {
            close(sum(b, k - 1), 1.0 / k as f64, "B(2S-1)");
        }
        for i in 0..S {
            for k in 1..=S {
                let expected = power(tableau.c[i], k) / k as f64;
                close(sum(&tableau.a[i], k - 1), expected, "C(S)");
            }
            for k in 1..S {
                // ∫∫ τ^(k-1): exact for one degree less than C(S).
                let expected = power(tableau.c[i], k + 1) / (k * (k + 1)) as f64;
                close(sum(&tableau.a2[i], k - 1), expected, "C(S) twice");
            }
        }
        for j in 0..S {
            for k in 1..S {
                let total: f64 = (0..S)
                    .map(|i| b[i] * power(tableau.c[i], k - 1) * tableau.a[i][j])
                    .sum();
                close(
                    total,
                    b[j] * (1.0 - power(tableau.c[j], k)) / k as f64,
                    "D(S-1)",
                );
            }
            let ea: f64 = (0..S).map(|i| tableau.e[i] * tableau.a[i][j]).sum();
            close(tableau.ea[j], ea, "e^T A");
        }
        for k in 0..S {
            let expected = if k == 0 { -tableau.gamma } else { 0.0 };
            close(sum(&tableau.e, k), expected, "embedded formula");
        }
        transformation(tableau);
        dense(tableau);
    }

    fn transformation<const S: usize>(tableau: &Tableau<S>) {
        let mut lambda = [[0.0; S]; S];
        lambda[0][0] = tableau.gamma;
        for (pair, [alpha, beta]) in tableau.pairs.iter().take(Tableau::<S>::PAIRS).enumerate() {
            let (i, j) = (2 * pair + 1, 2 * pair + 2);
            lambda[i][i] = *alpha;
            lambda[j][j] = *alpha;
            lambda[i][j] = -beta;
            lambda[j][i] = *beta;
        }
        for i in 0..S {
            for j in 0..S {
                let at: f64 = (0..S).map(|k| tableau.a[i][k] * tableau.t[k][j]).sum();
                let tl: f64 = (0..S).map(|k| tableau.t[i][k] * lambda[k][j]).sum();
                close(at, tl, "A T = T Lambda");
                let product: f64 = (0..S)
                    .map(|k| tableau.t[i][k] * tableau.t_inverse[k][j])
                    .sum();
                close(product, if i == j { 1.0 } else { 0.0 }, "T T^-1 = 1");
            }
        }
    }

    fn dense<const S: usize>(tableau: &Tableau<S>) {
        let last = S - 1;
        for j in 0..S {
            let column = |rows: &[[f64; S]; S]| -> f64 { rows.iter().map(|row| row[j]).sum() };
            let slope = |rows: &[[f64; S]; S]| -> f64 {
                rows.iter()
                    .enumerate()
                    .map(|(k, row)| (k + 3) as f64 * row[j])
                    .sum()
            };
            let square = tableau.collocation_square[j];
            close(
                square + column(&tableau.collocation),
                tableau.a2[last][j],
                "collocation q(1)",
            );
            close(
                2.0 * square + slope(&tableau.collocation),
                tableau.a[last][j],
                "collocation v(1)",
            );
            if S > 1 {
                close(column(&tableau.smooth), tableau.a2[last][j], "smooth q(1)");
                close(slope(&tableau.smooth), tableau.a[last][j], "smooth v(1)");
                let curvature: f64 = (0..S)
                    .map(|k| ((k + 3) * (k + 2)) as f64 * tableau.smooth[k][j])
                    .sum();
                close(curvature, if j == last { 1.0 } else { 0.0 }, "smooth a(1)");
            }
        }
    }

    #[test]
    fn coefficients_satisfy_the_order_conditions() {
        check::<1>();
        check::<3>();
        check::<5>();
        check::<7>();
    }
}
