"""Coefficients of the Radau IIA methods, computed with 60 digits and written as Rust constants.

    python -B tools/tableaux.py | rustfmt --edition 2024 > src/integrate/coefficients.rs

Definitions: E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, 2nd ed. (1996),
IV.5 (nodes, simplifying assumptions) and IV.8 (transformation, embedded formula);
the same, *Stiff differential equations solved by Radau methods*, J. Comput. Appl. Math. 111
(1999) 93-111 (5, 7 stages). The meaning of each field is documented in `tableau.rs`, whose tests
check the result against the order conditions.
"""

from mpmath import eig, factorial, im, legendre, lu_solve, matrix, mp, mpc, mpf, polyroots, re, taylor

mp.dps = 60
STAGES = (1, 3, 5, 7)
PAIRS = max(STAGES) // 2


def nodes(s):
    """Zeros of P_s - P_(s-1), shifted to (0, 1]: the right Radau points."""
    coefficients = taylor(lambda x: legendre(s, 2 * x - 1) - legendre(s - 1, 2 * x - 1), 0, s)
    roots = polyroots(coefficients[::-1], maxsteps=500, extraprec=400)
    c = sorted(re(root) for root in roots)
    assert abs(c[-1] - 1) < mpf(10) ** -45
    c[-1] = mpf(1)
    return c


def lagrange(points):
    """Rows: coefficients in powers of s of the Lagrange polynomials on the points."""
    basis = []
    for j, xj in enumerate(points):
        poly = [mpf(1)]
        for i, xi in enumerate(points):
            if i != j:
                shifted = [mpf(0)] + poly
                poly = [(b - xi * a) / (xj - xi) for a, b in zip(poly + [mpf(0)], shifted)]
        basis.append(poly)
    return basis


def integral(poly, x):
    return sum(coefficient * x ** (k + 1) / (k + 1) for k, coefficient in enumerate(poly))


def eigenvector(a, value):
    """Right eigenvector, last component 1."""
    s = a.rows
    if s == 1:
        return [mpf(1)]
    shifted = a - value * matrix([[mpf(i == j) for j in range(s)] for i in range(s)])
    rest = lu_solve(shifted[: s - 1, : s - 1], -shifted[: s - 1, s - 1])
    return [rest[i] for i in range(s - 1)] + [mpf(1)]


def tableau(s):
    c = nodes(s)
    basis = lagrange(c)
    a = matrix([[integral(basis[j], c[i]) for j in range(s)] for i in range(s)])
    a2 = a * a

    values = eig(a, left=False, right=False) if s > 1 else [a[0, 0]]
    real = [re(value) for value in values if abs(im(value)) < mpf(10) ** -40]
    assert len(real) == 1
    gamma = real[0]
    pairs = sorted((mpc(value) for value in values if im(value) > mpf(10) ** -40), key=lambda z: im(z))

    columns = [[re(x) for x in eigenvector(a, gamma)]]
    for value in pairs:
        vector = eigenvector(a, value)
        columns += [[re(x) for x in vector], [-im(x) for x in vector]]
    t = matrix([[columns[j][i] for j in range(s)] for i in range(s)])
    t_inverse = t**-1

    # e with sum(e_i c_i^k) = -gamma if k == 0 else 0, k = 0 .. s-1: minus gamma times the values
    # at 0 of the Lagrange polynomials.
    e = [-gamma * basis[j][0] for j in range(s)]
    ea = [sum(e[i] * a[i, j] for i in range(s)) for j in range(s)]
    constant = abs(sum(e[i] * c[i] ** s for i in range(s)) / factorial(s))

    # The leading error of the method, R(z) - e^z = C z^(2s), against that of the estimate,
    # error_constant z^(s+1); their quotient in powers of gamma z.
    method = factorial(s) * factorial(s - 1) / (factorial(2 * s - 1) * factorial(2 * s))
    quotient = method / (constant * gamma ** (s - 1))

    # Twice integrated interpolants of the acceleration; powers 2 .. s+2 of s.
    twice = lambda poly: [coefficient / ((k + 1) * (k + 2)) for k, coefficient in enumerate(poly)]
    if s == 1:
        # The interpolant of the only acceleration misses the end point (1/2 instead of 1), so the
        # cubic through q and v at both ends takes its place.
        collocation = [[mpf(2)], [mpf(-1)]]
        smooth = [[mpf(0)]]
    else:
        plain = [twice(basis[j]) + [mpf(0)] for j in range(s)]
        collocation = [[plain[j][k] for j in range(s)] for k in range(s + 1)]
        augmented = [twice(poly) for poly in lagrange([mpf(0)] + c)[1:]]
        smooth = [[augmented[j][k] for j in range(s)] for k in range(1, s + 1)]

    return dict(
        c=c, a=a.tolist(), a2=a2.tolist(), gamma=gamma,
        pairs=[[re(z), im(z)] for z in pairs] + [[mpf(0), mpf(0)]] * (PAIRS - len(pairs)),
        t=t.tolist(), t_inverse=t_inverse.tolist(), e=e, ea=ea, error_constant=constant, error_quotient=quotient,
        collocation_square=collocation[0], collocation=collocation[1:], smooth=smooth,
    )


def rust(value):
    if isinstance(value, list):
        return "[" + ", ".join(rust(entry) for entry in value) + "]"
    text = repr(float(value))  # correctly rounded, shortest decimal that reads back the same
    return "0.0" if abs(value) < mpf(10) ** -40 else text


def main():
    print("//! Written by `tools/tableaux.py`; do not edit. Fields are documented in `tableau.rs`.\n")
    print("use super::tableau::{Coefficients, RadauIia, Tableau};\n")
    for s in STAGES:
        print(f"impl Coefficients<{s}> for RadauIia<{s}> {{")
        print(f"    const TABLEAU: &'static Tableau<{s}> = &Tableau {{")
        for name, value in tableau(s).items():
            print(f"        {name}: {rust(value)},")
        print("    };\n}\n")


if __name__ == "__main__":
    main()
