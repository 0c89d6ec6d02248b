"""Mass matrices whose angles enter as differences, M_ij = C_ij cos(a_i - a_j), where a_i is the angle of coordinate i, this and a right
angle, or zero: links, carts and what hangs on them. There

    r'M r = u'C u + w'C w  with  u_i = r_i cos a_i,  w_i = r_i sin a_i,

and u = w = 0 only where r = 0. So M is positive definite at all angles where C is, which has no angle any more."""

from fractions import Fraction

from ..normal.form import ONE


def without_angles(matrix):
    """C of such a matrix of forms in rational symbols, or None where the matrix is none."""
    ring, size = matrix[0][0].ring, len(matrix)
    harmonics = [[_harmonic(form) for form in row] for row in matrix]
    if any(h is None for row in harmonics for h in row) or any(harmonics[k][k] != ONE for k in range(size)):
        return None
    # a coordinate that is an angle occurs in the harmonics of its row
    own = [_own(harmonics[k]) for k in range(size)]
    found = _assigned(ring, matrix, harmonics, [[*own[k], ({}, 0)] for k in range(size)], [])
    if found is None:
        return None
    return [[_factor(ring, matrix[i][j], harmonics[i][j], found[i], found[j]) for j in range(size)] for i in range(size)]


def _harmonic(form):
    """The one harmonic of a form (that of a constant for zero); None where there are several, or a divisor."""
    found = {harmonic for _, harmonic in form.terms}
    return None if len(found) > 1 or form.over else found.pop() if found else ONE


def _own(row):
    """The angles, as {name: factor} and a number of right angles, that a coordinate of this row can have."""
    names = dict.fromkeys(name for _, angle in row for name, _ in angle)
    return [({name: 1}, quarter) for name in names for quarter in (0, 1)]


def _assigned(ring, matrix, harmonics, choices, taken):
    """Angles for all coordinates, those `taken` among them, or None: each must fit with all before it."""
    k = len(taken)
    if k == len(choices):
        return taken
    for choice in choices[k]:
        if all(_factor(ring, matrix[i][k], harmonics[i][k], taken[i], choice) is not None for i in range(k)):
            if found := _assigned(ring, matrix, harmonics, choices, [*taken, choice]):
                return found
    return None


def _factor(ring, form, harmonic, first, second):
    """C of one entry with these angles, or None where it is no multiple of the cosine of their difference."""
    if not form.terms:
        return form
    angle = dict(first[0])
    for name, slope in second[0].items():
        angle[name] = angle.get(name, 0) - slope
    # cos(x - q pi/2) is cos x, sin x, -sin x for q = 0, 1, -1
    quarter = first[1] - second[1]
    cosine = ring.harmonic("sin" if quarter else "cos", {n: s for n, s in angle.items() if s}) * (-1 if quarter < 0 else 1)
    (key, value), *more = cosine.terms.items() or [(None, 0)]
    if more or key is None or key[1] != harmonic:
        return None
    return ring.form({(monomial, ONE): Fraction(factor) / value for (monomial, _), factor in form.terms.items()})
