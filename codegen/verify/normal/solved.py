"""Equations of motion solved for the accelerations."""

from itertools import combinations

from .matrices import determinant


def solved(mass, loads, row, accelerations):
    """The acceleration of a row minus what gives it, from M a + b = 0 (forms): a + (M^-1 b) of the row, by Cramer's
    rule in the part of the system that is coupled to it. `accelerations` are forms."""
    part = coupled(mass, row)
    matrix = [[mass[i][j] for j in part] for i in part]
    own = part.index(row)
    replaced = [[loads[i] if k == own else entry for k, entry in enumerate(line)] for i, line in zip(part, matrix)]
    return accelerations[row] + determinant(replaced) * determinant(matrix).inverse()


def coupled(mass, row):
    """The rows that entries of the mass matrix connect to a row, it among them."""
    part = {row}
    for _ in mass:
        part |= {i for i, j in combinations(range(len(mass)), 2) if mass[i][j] and j in part}
        part |= {j for i, j in combinations(range(len(mass)), 2) if mass[i][j] and i in part}
    return sorted(part)
