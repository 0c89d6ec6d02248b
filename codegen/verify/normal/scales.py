"""What a printed equation of motion was divided by, found from dimensions and the symmetry of the mass matrix: a monomial of
parameters, or where another equation shows it a sum or a common function of the coordinates, so that an equation
over a mass or m l^2 is judged as what it is.

An equation most of whose terms have the unit that the energies give is taken as it is: what differs in
it is a slip, not a multiplier."""

from collections import Counter
from fractions import Fraction
from itertools import combinations, product

from ..input import units
from .algebra import ONE

# Exponents and numbers of parameters that are tried: a divisor such as m l^2, or k/m in an equation
# that was made dimensionless, has no more.
EXPONENTS = (1, -1, 2, -2)
PARAMETERS = 3


def expected(subject, equation):
    """The unit of an equation of motion that follows from energies."""
    return units.parse("J").times(units.parse(subject.paper.symbols[equation.of].unit), -1)


def scales(subject):
    """The factor of each equation of motion, by number: 1 where it is printed as the energies give it."""
    one = subject.ring.number(1)
    motions = subject.paper.motions()
    lacking = {e.number: d for e in motions if (d := subject.remembered(("lacking", e.number), lambda e=e: _lacking(subject, e))) is not None}
    result = {e.number: one for e in motions if e.number not in lacking}
    if not lacking:
        return result
    rows = {e.number: [subject.slope(e.number, "dd" + f.of) for f in motions] for e in motions}
    for i, equation in enumerate(motions):
        if equation.number in result:
            continue
        # what makes a coupling the same as that of an equation that has its factor already
        found = []
        for j, other in enumerate(motions):
            mine, theirs = rows[equation.number][j], other.number in result and result[other.number] * rows[other.number][i]
            if mine and theirs and not mine.names() & subject.ring.involutions:
                found += [*ratios(mine, theirs), theirs * mine.inverse()]
        found = [ratio for ratio in found if measure(subject, ratio) == lacking[equation.number]]
        # the one with which the whole coupling is the same
        found.sort(key=lambda ratio: min(_apart(ratio, rows, result, motions, i, sign) for sign in (1, -1)))
        found = found or _monomials(subject, lacking[equation.number])
        result[equation.number] = found[0] if found else one
    return result


def _apart(ratio, rows, known, motions, i, sign):
    """In how many terms the couplings of an equation, times a ratio, differ from those of the equations that are known."""
    return sum(len((ratio * rows[motions[i].number][j] - known[other.number] * rows[other.number][i] * sign).terms)
               for j, other in enumerate(motions) if other.number in known)


def measure(subject, factor):
    """The dimension of a factor, by its first term (an equation whose terms differ is objected to as it is)."""
    total = units.NONE
    for monomial, _ in list(factor.terms)[:1]:
        for name, exponent in monomial:
            total = total.times(subject.dimension[name], exponent)
    for divisor, power in factor.over:
        total = total.times(measure(subject, divisor), -power)
    return total


def ratios(printed, derived):
    """The positive monomials of parameters by which parts of one form become parts of another."""
    ring, found = printed.ring, {}
    for (monomial, harmonic), value in printed.terms.items():
        for (other, same), wanted in derived.terms.items():
            if harmonic == same:
                ratio = ring.form({(other, ONE): abs(Fraction(wanted) / value)}) * ring.form({(monomial, ONE): 1}).inverse()
                moving = {n for n in ratio.names() if n not in ring.first}
                if not moving - ring.involutions:
                    for state in moving:
                        ratio = ratio * ring.symbol(state)
                    found[ratio] = found.get(ratio, 0) + 1
    return sorted(found, key=found.get, reverse=True)


def _lacking(subject, equation):
    """The dimension that an equation lacks, or None where most of its terms have the right one."""
    found = []
    for term in subject.expressions[equation.number]:
        try:
            found.append(subject.measure(term))
        except units.UnitError:
            continue
    right = expected(subject, equation)
    if not found:
        return None
    counts = Counter(found)
    most = max(counts, key=lambda x: (counts[x], x == right))
    return None if most == right else right.times(most, -1)


def _monomials(subject, dimension):
    """The simplest monomials of parameters of a dimension."""
    names = [n for n, x in subject.paper.symbols.items() if x.role == "parameter" and n not in subject.paper.definitions]
    for count in range(1, PARAMETERS + 1):
        found = []
        for chosen in combinations(names, count):
            for exponents in product(EXPONENTS, repeat=count):
                total = units.NONE
                for name, exponent in zip(chosen, exponents):
                    total = total.times(subject.dimension[name], exponent)
                if total == dimension:
                    found.append((sum(map(abs, exponents)), chosen, exponents))
        if found:
            one = subject.ring.number(1)
            result = []
            for _, chosen, exponents in sorted(found, key=lambda item: item[0]):
                factor = one
                for name, exponent in zip(chosen, exponents):
                    factor = factor * subject.ring.symbol(name) ** exponent
                result.append(factor)
            return result
    return []
