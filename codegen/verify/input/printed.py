"""What a paper prints: its symbols with their units, and its equations as lists of terms.

A printed equation is its LaTeX, or a Python function of a namespace `s` of symbols and a namespace `m` of
functions (`sin`, `cos`, `sign`, `Abs`), or both, and then they are proved to say the same. The function
returns the terms in printed order, every bracketed
sum multiplied out into its parts, each part as one expression. The same function is evaluated
with SymPy symbols (verification) and with CasADi symbols or numbers (simulation).

Names: a coordinate or input `x` has the rate `dx` and the acceleration `ddx`.
"""

import re
from dataclasses import dataclass, field, replace
from typing import Callable, Dict, Optional, Tuple

from ..errors import PaperError


# the coordinate that belongs to the quasi-velocity u is named so with u behind it
QUASI = "integral_of_"


class Namespace:
    """Symbols by attribute; an unknown name is an error that names it."""

    def __init__(self, values, owner="the paper"):
        self.__dict__.update(values)
        self.__dict__["_owner"] = owner

    def __getattr__(self, name):
        raise PaperError(f"{self._owner} does not declare the symbol '{name}'")


@dataclass(frozen=True)
class Symbol:
    """A symbol that the paper uses.

    `role` is coordinate, input, parameter, discrete or force. `mirror` is the sign that the
    symbol takes in the mirror image of the system. `velocity` marks the coordinate of a quasi-velocity, which has a rate and no
    values: its LaTeX is that of the rate. `dissipative` marks what must vanish for the
    equations to have a Lagrangian (damping constants, friction forces). `minimum` is a bound
    that every admissible state respects.
    """

    name: str
    unit: str
    meaning: str
    role: str
    latex: str
    mirror: int = 1
    dissipative: bool = False
    minimum: Optional[float] = None
    values: Tuple[int, ...] = ()
    velocity: bool = False


@dataclass(frozen=True)
class Equation:
    """A printed equation.

    `kind` says what the terms mean:

    - motion: they sum to zero (left side minus right side); `of` is the coordinate
    - value: they sum to the symbol `of`
    - condition: the function returns two lists, left and right of `relation`, < or >
    - rule: the discrete state `of` takes `result` when the terms' sum is `relation` 0, < or >
    - reset: they sum to the rate of the coordinate `of` after an impact, in the state before it

    `margin` marks a condition whose function already gives the terms of its margin, `momentum` a
    force that is the rate of a momentum: the reaction of a translation of the whole system, `flips` the
    discrete states that change their sign at an impact. Without a
    `function` the terms follow from the LaTeX, with the symbols of `paper`.
    """

    number: str
    kind: str
    of: str
    latex: str
    function: Optional[Callable]
    title: str = ""
    relation: str = ""
    result: int = 0
    margin: bool = False
    momentum: bool = False
    flips: Tuple[str, ...] = ()
    paper: object = field(default=None, compare=False, repr=False)

    def terms(self, s, m):
        """The printed terms, in printed order. Of a condition, with the signs that make their
        sum positive where the condition holds."""
        if self.function is None:
            from . import transcription  # it needs this module

            return transcription.terms(transcription.statement(self, self.paper), self.paper, s, m, self.latex)
        terms = self.function(s, m)
        if not isinstance(terms, (list, tuple)):
            raise PaperError(f"its function returns {terms} where a list of its terms belongs")
        if self.kind != "condition" or self.margin:
            return list(terms)
        if len(terms) != 2 or not all(isinstance(side, (list, tuple)) for side in terms):
            raise PaperError("the function of a condition returns two lists: the terms on the left and on the right")
        left, right = terms
        if self.relation == "<":
            return [-term for term in left] + list(right)
        return list(left) + [-term for term in right]

    def value(self, s, m):
        """The sum of the terms: the residual of an equation of motion, the value of a force or
        reaction, the margin of a condition (positive where it holds), the rate after an impact."""
        terms = self.terms(s, m)
        return sum(terms[1:], terms[0])


def group(factor, *terms):
    """`factor {a + b + ...}` of a printed equation as the list of its terms."""
    return [factor * term for term in terms]


@dataclass(frozen=True)
class Release:
    """A scene at its start: the system at rest with the coordinates `at` (all others zero), `held` the coordinates
    that do not move; no force acts that the paper gives by a symbol of its own (friction). `duration` of the motion that is
    looked at, s; it ends where a one-sided coordinate comes to its bound."""

    at: Dict[str, str]
    held: Tuple[str, ...] = ()
    duration: float = 0.0


@dataclass
class Paper:
    """The symbols and equations of one paper, in the order in which it prints them.

    `translation` names a coordinate and an input that may enter the energies only as their sum
    (slip and ground displacement): Galilean invariance is judged for it. `definitions` give
    symbols that the paper uses without defining them, by what they must mean; those of them that it does
    define are `auxiliary`. `sets` are the
    parameter values of its examples; `box` bounds the coordinates and parameters for which the
    mass matrix must be positive definite (what it does not name is taken from the sets); `quasi` are the definitions of the
    quasi-velocities, by the coordinates that belong to them (readings/quasi.py);
    `singular` are expressions that are zero in singular configurations, by what says so (judgements/singular.py);
    `negligible` are the parameters that the paper allows to be left out; `special` names special
    cases by what they put (a number or another symbol's name) for which symbols.
    """

    title: str
    source: str
    symbols: Dict[str, Symbol] = field(default_factory=dict)
    equations: Dict[str, Equation] = field(default_factory=dict)
    definitions: Dict[str, Callable] = field(default_factory=dict)
    auxiliary: Tuple[str, ...] = ()
    translation: Optional[Tuple[str, str]] = None
    sets: Dict[str, Dict[str, float]] = field(default_factory=dict)
    box: Dict[str, Tuple[float, float]] = field(default_factory=dict)
    negligible: Tuple[str, ...] = ()
    special: Dict[str, Dict[str, object]] = field(default_factory=dict)
    releases: Dict[str, Release] = field(default_factory=dict)
    quasi: Dict[str, Callable] = field(default_factory=dict)
    singular: Dict[str, Callable] = field(default_factory=dict)

    def _declare(self, symbol):
        """Adds a symbol. No two may have a name, a rate's name or a LaTeX in common: one would be
        taken for the other, and what is judged would not be what is printed."""
        if not re.fullmatch(r"[A-Za-z]\w*", symbol.name):
            raise PaperError(f"the symbol '{symbol.name}' must have a name of letters, digits and _, so that s.name is it")
        if symbol.name in self.symbols:
            raise PaperError(f"the symbol '{symbol.name}' is declared twice")
        if symbol.mirror not in (1, -1):
            raise PaperError(f"the symbol '{symbol.name}' has mirror={symbol.mirror}: it is 1 or -1")
        for other in self.symbols.values():
            if common := set(rates(symbol)) & set(rates(other)):
                raise PaperError(f"the symbols '{other.name}' and '{symbol.name}' cannot be told apart: "
                                 f"'{min(common)}' is a rate of one of them; rename the other")
            if plain_latex(other.latex) == plain_latex(symbol.latex):
                raise PaperError(f"the symbols '{other.name}' and '{symbol.name}' have the same LaTeX {symbol.latex}")
        self.symbols[symbol.name] = symbol

    def coordinate(self, name, unit, meaning, latex=None, mirror=1, minimum=None):
        """Declare a generalized coordinate; `minimum` where it is one-sided (an uplift)."""
        self._declare(Symbol(name, unit, meaning, "coordinate", latex or latex_name(name), mirror, minimum=minimum))

    def quasi_velocity(self, name, unit, meaning, latex=None, mirror=1):
        """Declare a quasi-velocity, which the decorated function gives as a linear function of the rates of the coordinates;
        equations are then of quasi-velocities, and use `name` and its rate `dname`."""

        def register(function):
            self._declare(Symbol(QUASI + name, f"{unit}*s", meaning, "coordinate", latex or latex_name(name), mirror, velocity=True))
            self.quasi[QUASI + name] = function
            return function

        return register

    def input(self, name, unit, meaning, latex=None, mirror=1):
        """Declare a prescribed displacement; equations use its rates `dname`, `ddname`."""
        self._declare(Symbol(name, unit, meaning, "input", latex or latex_name(name), mirror))

    def parameter(self, name, unit, meaning, latex=None, dissipative=False):
        """Declare a constant."""
        self._declare(Symbol(name, unit, meaning, "parameter", latex or latex_name(name), dissipative=dissipative))

    def discrete(self, name, values, meaning, latex=None, mirror=1):
        """Declare a discrete state; only the values (+1, -1) are known to the algebra."""
        if tuple(sorted(values)) != (-1, 1):
            raise PaperError(f"the discrete state '{name}' must take the values +1 and -1, not {values}")
        self._declare(Symbol(name, "1", meaning, "discrete", latex or latex_name(name), mirror, values=tuple(values)))

    def force(self, name, unit, meaning, latex=None, mirror=1, dissipative=True):
        """Declare a symbol for a force that another equation gives (friction, a reaction)."""
        self._declare(Symbol(name, unit, meaning, "force", latex or latex_name(name), mirror, dissipative=dissipative))

    def undefined(self, name, unit, meaning, latex=None):
        """Declare a symbol that the paper prints but does not define, read as the decorated
        function of the other symbols."""

        def register(function):
            self.parameter(name, unit, meaning, latex)
            self.definitions[name] = function
            return function

        return register

    def _equation(self, number, kind, of, latex, title, relation="", result=0, momentum=False, flips=()):
        of = QUASI + of if QUASI + of in self.symbols else of
        if number in self.equations:
            raise PaperError(f"equation ({number}) is given twice")
        if latex:
            # until a function is written beside it, the LaTeX says what the terms are
            self.equations[number] = Equation(number, kind, of, latex, None, title, relation, result, momentum=momentum, flips=flips, paper=self)

        def register(function):
            if number in self.equations and self.equations[number].function:
                raise PaperError(f"equation ({number}) is given twice")
            self.equations[number] = Equation(
                number, kind, of, latex, function, title, relation, result, momentum=momentum, flips=flips)
            return function

        return register

    def motion(self, number, of, title="", latex=""):
        """Register an equation of motion of the coordinate `of`."""
        return self._equation(number, "motion", of, latex, title)

    def value(self, number, of, title="", latex="", momentum=False):
        """Register an equation that gives the value of the symbol `of`; `momentum` if that is the
        force on a translation of the whole system (base shear, normal force)."""
        return self._equation(number, "value", of, latex, title, momentum=momentum)

    def condition(self, number, of, relation, title="", latex=""):
        """Register an inequality; `of` is the coordinate or symbol that it decides about."""
        return self._equation(number, "condition", of, latex, title, relation)

    def rule(self, number, of, result, relation, title="", latex=""):
        """Register a sign rule for the discrete state `of`."""
        return self._equation(number, "rule", of, latex, title, relation, result)

    def reset(self, number, of, title="", latex="", flips=()):
        """Register an impact law for the rate of the coordinate `of`, at whose bound it happens; `flips` are the discrete
        states that change their sign at the same time."""
        return self._equation(number, "reset", of, latex, title, flips=tuple(flips))

    def singular_where(self, name):
        """Register the decorated function of coordinates as what is zero in singular configurations, where nothing is judged; `name` says
        where: "the pole", "r = 0"."""

        def register(function):
            if name in self.singular:
                raise PaperError(f"singular where {name}: that is declared twice")
            self.singular[name] = function
            return function

        return register

    def release(self, name, at, held=(), duration=0.0):
        """Declare a release from rest at the coordinates `at` (decimal strings), while the coordinates `held` do not move:
        a scene in which the reactions of what pushes must be positive, at its start and for `duration` seconds."""
        if name in self.releases:
            raise PaperError(f"the release '{name}' is declared twice")
        for coordinate in [*at, *held]:
            if coordinate not in self.coordinates():
                raise PaperError(f"the release '{name}' names '{coordinate}', which is no coordinate")
        if not _finite(duration) or float(duration) < 0:
            raise PaperError(f"the release '{name}' has the duration {duration!r}: it is a number of seconds, not below 0")
        self.releases[name] = Release({n: str(v) for n, v in at.items()}, tuple(held), float(duration))

    def check(self):
        """Raises a PaperError where the declarations do not fit together."""
        if not self.equations:
            raise PaperError(f"'{self.title}' has no equations: there is nothing to judge")
        roles = {"motion": ("coordinate",), "reset": ("coordinate",), "rule": ("discrete",), "value": ("force", "parameter")}
        for number, equation in self.equations.items():
            symbol = self.symbols.get(equation.of)
            wanted = roles.get(equation.kind, ("coordinate", "discrete", "force"))
            if symbol is None or symbol.role not in wanted:
                raise PaperError(f"equation ({number}) is of '{equation.of}', which is not declared as a {' or '.join(wanted)}")
            if equation.kind in ("condition", "rule") and equation.relation not in ("<", ">"):
                raise PaperError(f"equation ({number}) has the relation '{equation.relation}': it is '<' or '>'")
            for name in equation.flips:
                if name not in self.symbols or self.symbols[name].role != "discrete":
                    raise PaperError(f"equation ({number}) flips '{name}', which is no discrete state")
            if equation.kind == "rule" and equation.result not in symbol.values:
                raise PaperError(f"equation ({number}) sets {equation.of} to {equation.result}, which is none of its values")
        of = [equation.of for equation in self.motions()]
        for name in of:
            if of.count(name) > 1:
                raise PaperError(f"there are {of.count(name)} equations of motion of '{name}': one belongs to each coordinate")
        if self.translation:
            found = [self.symbols[n].role if n in self.symbols else None for n in self.translation]
            if found != ["coordinate", "input"]:
                raise PaperError(f"translation={self.translation} must name a coordinate and an input")
        for where, names in [("negligible", self.negligible), ("box", self.box),
                             *[(f"set '{n}'", v) for n, v in self.sets.items()],
                             *[(f"special case '{n}'", v) for n, v in self.special.items()]]:
            for name in names:
                if name not in self.names():
                    raise PaperError(f"the {where} names '{name}', which is not declared")
        values = [(f"set '{n}'", v) for n, v in self.sets.items()] + [(f"release '{n}'", r.at) for n, r in self.releases.items()]
        for where, name, value in [(where, name, value) for where, given in values for name, value in given.items()]:
            if not _finite(value):
                raise PaperError(f"the {where} gives {name} the value {value!r}, which is no number")
        for name, bounds in self.box.items():
            if not isinstance(bounds, tuple) or len(bounds) != 2 or not all(_finite(x) and not isinstance(x, str) for x in bounds):
                raise PaperError(f"the box has {name} in {bounds!r}: it is (low, high), two numbers")
            low, high = bounds
            if not -float("inf") < low <= high < float("inf"):
                raise PaperError(f"the box has {name} from {low} to {high}: the bounds are finite, the lower one first")

    def coordinates(self):
        """Names of the coordinates that equations of motion are of, in declared order: where there are quasi-velocities, theirs."""
        return [name for name, symbol in self.symbols.items() if symbol.role == "coordinate" and symbol.velocity == bool(self.quasi)]

    def positions(self):
        """Names of the coordinates that have values, in declared order."""
        return [name for name, symbol in self.symbols.items() if symbol.role == "coordinate" and not symbol.velocity]

    def shown(self, name):
        """A coordinate's name for people: that of its quasi-velocity, where it belongs to one."""
        return name.removeprefix(QUASI) if name in self.quasi else name

    def motions(self):
        """Equations of motion, in printed order."""
        return [equation for equation in self.equations.values() if equation.kind == "motion"]

    def names(self):
        """Every name that the namespace `s` offers: symbols, rates and accelerations."""
        names = []
        for symbol in self.symbols.values():
            names += rates(symbol)
        return names

    def namespace(self, values, m):
        """The namespace `s` from values by name; undefined symbols follow from their reading."""
        known = dict(values)
        for name in self.quasi:
            if "d" + name in known:
                known[self.shown(name)], known["d" + self.shown(name)] = known["d" + name], known["dd" + name]
        for name, reading in self.definitions.items():
            if name not in known:
                known[name] = reading(Namespace(known, self.title), m)
        return Namespace(known, self.title)

    def with_equations(self, equations):
        """The same paper with some equations replaced (corrected or mutated)."""
        return replace(self, equations={**self.equations, **{e.number: e for e in equations}})


def _finite(value):
    """Whether it is a number, or text of one in decimals."""
    try:
        return -float("inf") < float(value) < float("inf")
    except (TypeError, ValueError, OverflowError):
        return False


def rates(symbol):
    """A symbol's name with those of its rate and acceleration, if it moves."""
    moving = symbol.role in ("coordinate", "input")
    return [symbol.name] + (["d" + symbol.name, "dd" + symbol.name] if moving else [])


def plain_latex(latex):
    """LaTeX of a symbol without upright letters, braces, backslashes and spaces: what symbols are told apart by."""
    return re.sub(r"\\(?:mathrm|mathit|mathnormal|mathcal|mathscr|mathsf|textrm|text|operatorname|rm|it)(?![A-Za-z])|[\\{}\s]", "", latex)


GREEK = ("alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "lambda", "mu", "nu",
         "xi", "pi", "rho", "sigma", "tau", "phi", "psi", "omega", "Omega", "Delta")


def latex_name(name):
    """LaTeX of a symbol's name: `alpha_0` is \\alpha_{0}, `M_rb` is M_{rb}."""
    head, _, index = name.partition("_")
    head = "\\" + head if head in GREEK else head
    return f"{head}_{{{index}}}" if index else head
