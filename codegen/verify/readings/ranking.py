"""Readings of a paper: energies that it may mean, ranked by what a system must satisfy and then by what the paper prints.

First definiteness (the kinetic energy is not negative, also with what the paper neglects), then the reactions of what
only pushes in the scenes that the paper speaks of, at their start and along their motion, then the invariances of the derived equations, then the printed
terms that agree. A reading that only counts terms can make a tank pull on the ground.
"""

from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import product
from typing import Dict, List, Optional

from ..judgements.comparison import compare
from ..judgements.definite import BISECTIONS, prove_matrix, rest, states
from ..judgements.galilei import galilei
from ..judgements.mirror import mirror
from ..judgements.subject import Subject
from ..normal.algebra import expression
from ..normal.intervals import intervals, signs
from ..normal.matrices import determinant
from ..progress import silent
from .along import Along, Least
from .lagrange import Motion

# What is neglected is mostly singular at rest, so that no number of boxes proves anything there; where the matrix is
# indefinite, a few show it.
NEGLECTED = 16

# the order of verdicts on definiteness, the best first
VERDICTS = ("squares", "proved", "undecided", "refuted")


@dataclass
class Reaction:
    """A reaction in a scene: bounds of its value at the start, proved; negative where it pulls. `least` is what it comes down to along the
    motion, computed (None: not looked at)."""

    release: str
    case: str
    coordinate: str
    low: float
    high: float
    least: Optional[Least] = None

    def pushes(self):
        """Whether it is proved to push at the start, and does so along the motion by more than its uncertainty."""
        return self.low > 0 and (self.least is None or self.least.value > self.least.uncertainty)


@dataclass
class Reading:
    """One reading: what follows from its energies, and what speaks for and against it. `squares` is whether its kinetic
    energy is proved to be the declared sum of squares with coefficients that are not negative (None: none is declared);
    `boxes` verdicts on the mass matrix by parameter set, state and what is neglected; `reactions` in the scenes; `objections`
    to the derived equations by the judgements on invariance; `agree` of `terms` printed terms agree, `absent` are not printed;
    `differing` the ordinals of those that do not, by equation; `whole` whether the verdicts are over the whole box, or at rest."""

    motion: object
    squares: Optional[bool]
    boxes: Dict[str, object]
    reactions: List[Reaction]
    objections: Dict[str, list]
    agree: int
    terms: int
    absent: int
    differing: Dict[str, List[int]] = field(default_factory=dict)
    whole: bool = False

    @property
    def name(self):
        """The name of the energies."""
        return self.motion.energies.name

    def verdict(self):
        """The worst verdict on definiteness."""
        found = {v.status for v in self.boxes.values()}
        if self.squares and "refuted" not in found:
            return "squares"
        return next((v for v in reversed(VERDICTS) if v in found), "undecided")

    def pulls(self):
        """The reactions that are not known to push."""
        return [r for r in self.reactions if not r.pushes()]

    def rank(self):
        """What readings are sorted by."""
        refuted = sum(v.status == "refuted" for v in self.boxes.values())
        return (VERDICTS.index(self.verdict()), refuted, len(self.pulls()), sum(map(len, self.objections.values())), -self.agree, self.absent)


def ranked(printed, energies, thorough=True, tell=silent) -> List[Reading]:
    """The readings, the best first; of equals, that which is declared first. `tell` is told how far it is (progress.py)."""
    return sorted((_reading(printed, e, thorough, tell) for e in energies), key=Reading.rank)


def _reading(printed, energies, thorough, tell):
    motion = Motion(printed.paper, energies)
    squares = _squares(motion) if energies.squares else None
    counted = [n for n, e in printed.paper.equations.items() if e.kind in ("motion", "value")]
    found = {n: c for n in printed.paper.equations if (c := compare(printed, motion, n))}
    judged = [c for n, c in found.items() if n in counted]
    derived = derived_subject(printed, motion)
    objections = {"mirror": mirror(derived), "galilei": galilei(derived)}
    boxes, whole = _boxes(motion, squares, thorough, tell)
    reactions = _reactions(motion)
    if thorough and all(r.low > 0 for r in reactions):
        tell(f"motions of '{energies.name}'")
        _follow(motion, reactions)
    return Reading(motion, squares, boxes, reactions, objections, sum(len(c.agree) for c in judged),
                   sum(c.terms() for c in judged), sum(len(c.absent) for c in judged), {n: c.differ for n, c in found.items()}, whole)


def derived_subject(printed, motion):
    """The equations that energies give in the place of the printed ones, one term each; conditions and rules as printed."""
    changed = []
    for equation in printed.paper.equations.values():
        if equation.kind in ("motion", "value", "reset") and (form := motion.reference(equation)) is not None:
            changed.append(replace(equation, function=lambda s, m, form=form: [expression(form)], latex=""))
    return Subject(printed.paper.with_equations(changed), printed)


def _squares(motion):
    """Whether the declared sum of squares is the kinetic energy, an identity in normal form, and no coefficient is negative
    for any parameter set, also with what is neglected."""
    total, coefficients = motion.ring.number(0), []
    for coefficient, velocity in motion.squares():
        coefficients.append(coefficient)
        total += coefficient * velocity**2
    if total - motion.kinetic.substitute(motion.held) * 2:
        return False
    for values, neglected in product(motion.paper.sets.values(), ({}, {n: 0 for n in motion.paper.negligible})):
        for state in states(motion.paper, coefficients):
            given = {**values, **state, **neglected}
            if any(_negative(coefficient, given) for coefficient in coefficients):
                return False
    return True


def _negative(form, values):
    """Whether a form at values is not proved to be at least zero; in rational numbers, where it has no angles."""
    if any(angle for _, (_, angle) in form.terms):
        return signs([form], intervals(values)) != [1]
    return form.evaluate({n: Fraction(str(v)) for n, v in values.items()}, None, None, Fraction(0)) < 0


def _boxes(motion, squares, thorough, tell):
    """(verdicts on the mass matrix, whether they are over the box): at rest where that is not asked for or has no bounds."""
    paper, mass, result = motion.paper, motion.mass(), {}
    moving = set(paper.coordinates()) & set().union(*(form.names() for row in mass for form in row)) if mass else set()
    zeros, places = rest(paper)
    whole = thorough and moving <= paper.box.keys()
    try:
        at_rest = None if whole else mass if motion.singular else [[form.substitute(zeros) for form in row] for row in mass]
    except ZeroDivisionError:  # rest is a pole of the energy
        return {}, whole
    # with a sum of squares the matrix is not negative whatever is neglected, and where it is singular the report says so
    cases = list(product(paper.sets.items(), (False, True) if paper.negligible and not squares else (False,)))
    what, total, before = f"kinetic energy of '{motion.energies.name}'", len(cases) * len(states(paper)) * BISECTIONS, 0
    for (name, values), neglect in cases:
        neglected = {n: 0 for n in paper.negligible} if neglect else {}
        label = name + (", " + " = ".join([*paper.negligible, "0"]) if neglect else "")
        for state in states(paper):
            key = ", ".join([label] + [f"{n} = {v:+d}" for n, v in state.items()])
            box = paper.box if whole else {n: (p, p) for n, p in places.items()}
            limit = NEGLECTED if neglect else BISECTIONS
            given = {**values, **neglected, **state} if whole or not motion.singular else {**zeros, **values, **neglected, **state}
            result[key] = prove_matrix(mass if whole else at_rest, given, box, limit, lambda done, before=before: tell(what, before + done, total),
                                       motion.singular)
            before += BISECTIONS
    return result, whole


def _reactions(motion):
    """The reactions of what only pushes, in the releases of the paper: accelerations by Cramer's rule over intervals."""
    from mpmath import iv

    paper, result = motion.paper, []
    for (release_name, release), (set_name, values) in product(paper.releases.items(), paper.sets.items()):
        free = [n for n in paper.coordinates() if n not in release.held]
        still = {d + n: 0 for n, x in paper.symbols.items() if x.role in ("coordinate", "input") for d in ("", "d", "dd")}
        forces = {n: 0 for n, x in paper.symbols.items() if x.role == "force"}
        for state in states(paper):
            put = intervals({**still, **forces, **values, **release.at, **state})

            def value(form, put=put):
                return form.evaluate(put, iv.sin, iv.cos, iv.mpf(0))

            rows = [motion.residual(n) for n in free]
            mass = [[value(row.diff("dd" + n)) for n in free] for row in rows]
            loads = [-value(row) for row in rows]
            whole = determinant(mass)
            if 0 in whole:
                continue  # singular within the rounding of the interval: definiteness says so
            found = dict(put)
            for k, name in enumerate(free):
                replaced = [row[:k] + [load] + row[k + 1:] for row, load in zip(mass, loads)]
                found["dd" + name] = determinant(replaced) / whole
            case = _case(set_name, state)
            for coordinate in motion.energies.pushes:
                reaction = value(motion.residual(coordinate), found)
                result.append(Reaction(release_name, case, coordinate, float(reaction.a), float(reaction.b)))
    return result


def _follow(motion, reactions):
    """Follows the motion of the releases that last, and gives the reactions the least that they come down to."""
    paper, equations = motion.paper, {}
    found = {(r.release, r.case, r.coordinate): r for r in reactions}
    for (release_name, release), (set_name, values), state in product(paper.releases.items(), paper.sets.items(), states(paper)):
        case = _case(set_name, state)
        if not release.duration or not any(key[:2] == (release_name, case) for key in found):
            continue
        free = tuple(n for n in paper.coordinates() if n not in release.held)
        if free not in equations:
            equations[free] = Along(motion, free)
        numbers = {n: float(v) for n, v in {**values, **release.at, **state}.items()}
        for coordinate, least in equations[free].least(numbers, numbers, release.duration).items():
            found[release_name, case, coordinate].least = least


def _case(set_name, state):
    """A parameter set and a state in words."""
    return ", ".join([set_name] + [f"{n} = {v:+d}" for n, v in state.items()])
