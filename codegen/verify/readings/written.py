"""The energies that a manuscript prints, by reading."""

from ..errors import PaperError
from ..input import transcription
from ..input.energies import Energies
from ..input.latex import Parser
from ..input.manuscript import TEX
from ..input.namespace import Mathematics, sympy_namespace
from ..judgements.comparison import compare
from ..judgements.subject import Subject
from ..normal.algebra import expression, ring_of
from .lagrange import Motion


def written(paper, printed, folder):
    """The energies of each reading, in the order in which the readings are named."""
    names = list(dict.fromkeys(reading for role in ("T", "V", "D", "L") for reading in printed.get(role, {}) if reading))
    return [e for name in names or [""] for e in _reading(paper, printed, folder, name)]


def _reading(paper, printed, folder, reading):
    """The energies of one reading, with the sign of the constraint forces with which more terms agree; a list of one, or none."""
    given = {role: printed[role].get(reading) or printed[role].get("") for role in ("T", "V", "D", "L") if role in printed}
    given = {role: function for role, function in given.items() if function}
    if not given:
        return []
    of = f", reading {reading}" if reading else ""
    if "L" in given and ("T" in given or "V" in given):
        raise PaperError(f"{folder / TEX}{of}: L is given beside T or V: give one of them")
    if "L" not in given and ("T" not in given or "V" not in given):
        lost = "T" if "T" not in given else "V"
        raise PaperError(f"{folder / TEX}{of}: {lost} is not given; if there is none, write {lost} = 0")
    zero = lambda s, m: 0
    kinetic, potential = given.get("T") or given["L"], given.get("V", zero)
    constraints = [(name, _left_minus_right(equation, paper), _slopes(equation, paper)) for name, equation in printed.get("constraints", ())]

    def made(sign):
        def held(s, m):
            return potential(s, m) - sign * sum(getattr(s, name) * form(s, m) for name, form, slopes in constraints if not slopes)

        def force(coordinate):
            own = printed.get("forces", {}).get(coordinate, zero)
            return lambda s, m: own(s, m) + sign * sum(getattr(s, name) * slopes[coordinate] for name, _, slopes in constraints if coordinate in slopes)

        forces = dict(printed.get("forces", {}))
        forces.update({n: force(n) for _, _, slopes in constraints for n in slopes})
        words = f", constraint forces {'+' if sign > 0 else '-'} multiplier times slope of the constraint" if constraints else ""
        return Energies((reading or "printed energies") + words, f"the energies of {TEX}", kinetic, held if constraints else potential,
                        given.get("D"), forces)

    if not constraints:
        return [made(1)]
    subject = Subject(paper)

    def disagreeing(energies):
        found = [compare(subject, Motion(paper, energies), e.number) for e in paper.motions()]
        return sum(len(c.differ) + len(c.absent) for c in found if c)

    return [min((made(sign) for sign in (1, -1)), key=disagreeing)]


def _slopes(equation, paper):
    """The factors of the rates in a constraint on rates (rolling), by coordinate; those of the accelerations, where its rate is printed;
    empty for a constraint on coordinates."""
    s, m, ring = sympy_namespace(paper), Mathematics(), ring_of(paper)
    form = ring.read(_left_minus_right(equation, paper)(s, m))
    names = paper.positions()
    for d in ("dd", "d"):
        slopes = {n: form.diff(d + n) for n in names}
        if not any(slopes.values()):
            continue
        if any({d + n for n in names} & slope.names() for slope in slopes.values()):
            raise equation.error("a constraint is linear in what has the most dots")
        return {n: expression(slope) for n, slope in slopes.items() if slope}
    return {}


def _left_minus_right(equation, paper):
    """A constraint as the function that it holds at zero."""
    def function(s, m):
        tree = Parser(equation.latex).equation()
        left, right = tree.children[0], tree.children[2]
        counter = [0]
        transcription._collect(left, 1, counter)
        transcription._collect(right, -1, counter)
        return sum(transcription.terms(tree, paper, s, m, equation.latex))

    return function
