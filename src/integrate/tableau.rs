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
    /// The error of the method is, to leading order and for y′ = λy, this × |γhλ|^(S−1) × the
    /// unfiltered estimate.
    pub error_quotient: f64,
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

    /// Roundings of the coefficients, their powers and the sums over up to 7 stages, in units of
    /// the sum of the terms' sizes.
    const ROUNDING: f64 = 16.0 * f64::EPSILON;

    /// The sum of the terms is `expected` to rounding.
    fn close(terms: impl Iterator<Item = f64>, expected: f64, what: &str) {
        let (sum, size) = terms.fold((0.0, 1.0), |(sum, size), x| (sum + x, size + x.abs()));
        assert!(
            f64::abs(sum - expected) <= ROUNDING * size,
            "{what}: {sum:e} instead of {expected:e}"
        );
    }

    fn power(x: f64, k: usize) -> f64 {
        x.powi(k as i32)
    }

    fn quadrature<const S: usize>(tableau: &Tableau<S>) {
        let c = &tableau.c;
        let b = &tableau.a[S - 1];
        assert_eq!(c[S - 1], 1.0, "stiffly accurate");
        for k in 1..=Tableau::<S>::ORDER {
            let terms = (0..S).map(|i| b[i] * power(c[i], k - 1));
            close(terms, 1.0 / k as f64, "B(2S-1)");
        }
        for i in 0..S {
            for k in 1..=S {
                let terms = (0..S).map(|j| tableau.a[i][j] * power(c[j], k - 1));
                close(terms, power(c[i], k) / k as f64, "C(S)");
            }
            for k in 1..S {
                let terms = (0..S).map(|j| tableau.a2[i][j] * power(c[j], k - 1));
                close(
                    terms,
                    power(c[i], k + 1) / (k * (k + 1)) as f64,
                    "C(S-1) twice",
                );
            }
        }
        for j in 0..S {
            for k in 1..S {
                let terms = (0..S).map(|i| b[i] * power(c[i], k - 1) * tableau.a[i][j]);
                close(terms, b[j] * (1.0 - power(c[j], k)) / k as f64, "D(S-1)");
            }
        }
    }

    fn embedded<const S: usize>(tableau: &Tableau<S>) {
        for k in 0..S {
            let terms = (0..S).map(|i| tableau.e[i] * power(tableau.c[i], k));
            close(terms, if k == 0 { -tableau.gamma } else { 0.0 }, "e");
        }
        for j in 0..S {
            close(
                (0..S).map(|i| tableau.e[i] * tableau.a[i][j]),
                tableau.ea[j],
                "e^T A",
            );
        }
        let factorial: f64 = (1..=S).map(|k| k as f64).product();
        let terms = (0..S).map(|i| tableau.e[i] * power(tableau.c[i], S) / factorial);
        close(terms, -tableau.error_constant, "error constant");
        // R(z) − e^z = C z^2S + …: the coefficient of z^2S in R = 1 + z bᵀ(I − zA)⁻¹1 is bᵀA^(2S−1)1.
        let mut x = [1.0; S];
        for _ in 0..2 * S {
            x = std::array::from_fn(|i| (0..S).map(|j| tableau.a[i][j] * x[j]).sum());
        }
        let factorial: f64 = (1..=2 * S).map(|k| k as f64).product();
        let method = (x[S - 1] - 1.0 / factorial).abs();
        let expected = method / (tableau.error_constant * power(tableau.gamma, S - 1));
        // Powers of A cancel down to 1/(2S)!, which leaves few digits at 7 stages.
        let error = (tableau.error_quotient / expected - 1.0).abs();
        assert!(
            error < 1e-2,
            "error quotient: {} instead of {expected}",
            tableau.error_quotient
        );
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
        let (a, t) = (&tableau.a, &tableau.t);
        for i in 0..S {
            for j in 0..S {
                let difference = (0..S).flat_map(|k| [a[i][k] * t[k][j], -t[i][k] * lambda[k][j]]);
                close(difference, 0.0, "A T = T Lambda");
                let product = (0..S).map(|k| t[i][k] * tableau.t_inverse[k][j]);
                close(product, if i == j { 1.0 } else { 0.0 }, "T T^-1 = 1");
            }
        }
    }

    fn dense<const S: usize>(tableau: &Tableau<S>) {
        let (a, a2) = (&tableau.a[S - 1], &tableau.a2[S - 1]);
        let (collocation, smooth) = (&tableau.collocation, &tableau.smooth);
        for j in 0..S {
            let square = tableau.collocation_square[j];
            let terms = (0..S).map(|k| collocation[k][j]).chain([square]);
            close(terms, a2[j], "collocation q(1)");
            let terms = (0..S)
                .map(|k| (k + 3) as f64 * collocation[k][j])
                .chain([2.0 * square]);
            close(terms, a[j], "collocation v(1)");
            if S > 1 {
                let derivative = |order: usize| {
                    (0..S).map(move |k| {
                        let factors: usize = (0..order).map(|l| k + 3 - l).product();
                        factors as f64 * smooth[k][j]
                    })
                };
                close(derivative(0), a2[j], "smooth q(1)");
                close(derivative(1), a[j], "smooth v(1)");
                close(
                    derivative(2),
                    if j == S - 1 { 1.0 } else { 0.0 },
                    "smooth a(1)",
                );
            }
        }
    }

    fn check<const S: usize>()
    where
        RadauIia<S>: Coefficients<S>,
    {
        quadrature(RadauIia::<S>::TABLEAU);
        embedded(RadauIia::<S>::TABLEAU);
        transformation(RadauIia::<S>::TABLEAU);
        dense(RadauIia::<S>::TABLEAU);
    }

    #[test]
    fn coefficients_satisfy_the_order_conditions() {
        check::<1>();
        check::<3>();
        check::<5>();
        check::<7>();
    }
}
