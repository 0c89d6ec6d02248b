#!/usr/bin/env python3
"""Writes tests/data/study_distributions.json: random variables of a study, their correlation by a Gaussian copula, and a regression,
by SciPy and NumPy.

    python3 tools/study_references.py

The design is Sobol's sequence of scipy.stats.qmc with a digital shift by SplitMix64 (Steele, Lea and Flood 2014), seed 7; points lie in
the middle of their cells. Quantiles are those of scipy.stats, of the empirical variable numpy.quantile, of truncated ones
scipy.stats.truncnorm.
"""

import json
from pathlib import Path

import numpy
import scipy
from scipy import stats

SEED, COUNT = 7, 32
MASK = (1 << 64) - 1
NAMES = ["R", "alpha", "e", "m", "theta", "g", "side"]
# Correlations of the normal variables behind R and alpha, R and m, alpha and e.
CORRELATIONS = {(0, 1): -0.4, (0, 3): 0.5, (1, 2): 0.2}
SAMPLE = [9.83, 9.78, 9.81, 9.80]


def splitmix(state):
    """The next state and 64 random bits."""
    state = (state + 0x9E3779B97F4A7C15) & MASK
    z = state
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return state, z ^ (z >> 31)


def design():
    """Points of the open cube, one a row."""
    state, shifts = SEED, []
    for _ in NAMES:
        state, bits = splitmix(state)
        shifts.append(bits >> 32)
    sobol = stats.qmc.Sobol(len(NAMES), scramble=False, bits=32).random(COUNT)
    digits = (sobol * 2.0**32).astype(numpy.uint64)
    return ((digits ^ numpy.array(shifts, numpy.uint64)).astype(float) + 0.5) / 2.0**32


def mixed(points):
    """The points after the copula."""
    matrix = numpy.eye(len(NAMES))
    for (i, j), coefficient in CORRELATIONS.items():
        matrix[i, j] = matrix[j, i] = coefficient
    z = stats.norm.ppf(points) @ numpy.linalg.cholesky(matrix).T
    correlated = sorted({i for pair in CORRELATIONS for i in pair})
    points = points.copy()
    points[:, correlated] = stats.norm.cdf(z[:, correlated])
    return points


def values(u):
    """The variables at points of the cube."""
    cut = stats.truncnorm((0.02 - 0.1) / 0.05, (0.16 - 0.1) / 0.05, 0.1, 0.05)
    triangle = stats.triang((0.92 - 0.85) / (0.97 - 0.85), 0.85, 0.97 - 0.85)
    return {
        "R": stats.lognorm(0.3, scale=1.2).ppf(u[:, 0]),
        "alpha": stats.norm(0.25, 0.02).ppf(u[:, 1]),
        "e": triangle.ppf(u[:, 2]),
        "m": stats.uniform(1, 2).ppf(u[:, 3]),
        "theta": cut.ppf(u[:, 4]),
        "g": numpy.quantile(SAMPLE, u[:, 5]),
        # Shares of 1/4 and 3/4.
        "side": numpy.where(u[:, 6] < 0.25, 1, -1),
    }


def regression():
    """A cloud about 2 x^0.8, and its line of least squares in logarithms."""
    x = numpy.geomspace(0.1, 2.0, 12)
    d = 2 * x**0.8 * numpy.exp(0.3 * stats.norm.ppf((numpy.arange(12) * 5 % 12 + 0.5) / 12))
    line = stats.linregress(numpy.log(x), numpy.log(d))
    rest = numpy.log(d) - line.intercept - line.slope * numpy.log(x)
    dispersion = float(numpy.sqrt(rest @ rest / (len(x) - 2)))
    return {"x": x, "d": d, "slope": line.slope, "intercept": line.intercept, "dispersion": dispersion}


def main():
    made = f"tools/study_references.py with SciPy {scipy.__version__} and NumPy {numpy.__version__}"
    reference = {"what": f"Random variables of a study and a regression, made by {made}", "seed": SEED, "count": COUNT}
    reference |= {"values": values(mixed(design())), "regression": regression()}
    plain = lambda x: x.tolist()
    path = Path(__file__).resolve().parents[1] / "tests/data/study_distributions.json"
    path.write_text(json.dumps(reference, indent=1, default=plain) + "\n")


if __name__ == "__main__":
    main()
