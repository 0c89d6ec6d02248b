"""Singular configurations: places where coordinates or equations lose their meaning (a pole, a length of zero), declared as an expression
that is zero there. Nothing is judged there, and all that is said of the mass matrix is said of everywhere else."""

from dataclasses import dataclass
from itertools import product
from typing import Dict, List

from ..errors import NotInClass, PaperError
from ..normal.division import quotient
from ..normal.intervals import intervals, signs
from ..normal.matrices import determinant


def singular(paper, ring, s, m) -> Dict[str, object]:
    """The forms that are zero in the singular configurations, by what they are declared as."""
    found, allowed = {}, set(paper.positions()) | {n for n, x in paper.symbols.items() if x.role in ("parameter", "discrete")}
    for name, function in paper.singular.items():
        try:
            form = ring.read(function(s, m))
        except NotInClass as error:
            raise NotInClass(f"singular where {name}: {error}") from error
        except Exception as error:  # whatever a model file does wrong is its author's to read
            raise PaperError(f"singular where {name}: {error}") from error
        poles = any(exponent < 0 for monomial, _ in form.terms for _, exponent in monomial) or form.over
        if not form.names() & set(paper.positions()) or not form.names() <= allowed or poles:
            raise PaperError(f"singular where {name}: that is a polynomial of coordinates and of sines and cosines of them, without rates, "
                             f"not {form}")
        found[name] = form
    return found


def regular(form, factors):
    """(What has the sign of a form wherever none of the factors is zero and vanishes less often there, {factor's name: how often it
    was divided by}): even powers of the factors are left out."""
    powers = {}
    for name, factor in factors.items():
        while form and (whole := _over(form, factor)) is not None:
            form, powers[name] = whole, powers.get(name, 0) + 1
    for name, power in powers.items():
        if power % 2:
            form = form * factors[name]
    return form, {name: power - power % 2 for name, power in powers.items() if power > 1}


def _over(form, factor):
    """The quotient of a form by a factor that is zero somewhere; None where there is none. A quotient may have names in its divisors,
    but where the factor is a power of a name that would divide by it without end."""
    whole = quotient(form, factor)
    if whole is None:
        return None
    names = {n for monomial, _ in factor.terms for n, _ in monomial}
    return None if any(exponent < 0 and n in names for monomial, _ in whole.terms for n, exponent in monomial) else whole


def divided(form, factors):
    """(A form divided by each of the factors as often as it goes, the names of those by which it did)."""
    used = []
    for name, factor in factors.items():
        while form and (whole := _over(form, factor)) is not None:
            form, used = whole, used + [name] * (name not in used)
    return form, used


def nowhere_zero(form, paper):
    """Whether a form is proved to be nowhere zero in the paper's box, for all of its parameter sets."""
    if not paper.sets or not form.names() & set(paper.positions()) <= paper.box.keys():
        return False
    discrete = [x.name for x in paper.symbols.values() if x.role == "discrete"]
    cases = product(paper.sets.values(), product((1, -1), repeat=len(discrete)))
    return all(signs([form], intervals({**values, **paper.box, **dict(zip(discrete, state))})) != [0] for values, state in cases)


@dataclass
class Declared:
    """A singular configuration: where; the equations that were divided by what is zero there; whether a mass matrix is singular there."""

    where: str
    form: object
    divided: List[str]
    mass: bool


def declared(subject, masses, scales) -> List[Declared]:
    """What is singular where the paper says so; `masses` are the mass matrices that are judged, `scales` what each equation was divided by."""
    result = []
    for name, form in subject.singular.items():
        divided = [n for n in subject.paper.equations if _divides(form, scales.get(n), subject.multipliers.get(n))]
        mass = any(_over(whole, form) is not None for matrix in masses if (whole := determinant(matrix)) and not whole.over)
        result.append(Declared(name, form, divided, mass))
    return result


def _divides(form, *scales):
    """Whether a form is a factor of one of several, of which each may be missing."""
    return any(scale is not None and not scale.over and _over(scale, form) is not None for scale in scales)
