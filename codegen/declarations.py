"""What a model consists of, as `model.py` collects it."""

from dataclasses import dataclass, field

import casadi as ca


class Named(ca.SX):
    """A symbol that knows its declaration."""


class Coordinate(Named):
    """A generalized coordinate; `.rate` and `.acceleration` are its derivatives."""


class Discrete(Named):
    """A discrete state."""


@dataclass
class Declaration:
    """What is common to everything that has a name, a unit and a meaning."""

    name: str
    unit: str
    meaning: str
    symbol: ca.SX
    extra: dict = field(default_factory=dict)

    def __getattr__(self, key):
        try:
            return self.__dict__["extra"][key]
        except KeyError:
            raise AttributeError(key) from None


@dataclass
class Body:
    """A body of the plane: mass, position of its centre, inertia about it, angle."""

    mass: ca.SX
    position: tuple
    inertia: ca.SX = None
    angle: ca.SX = None


@dataclass
class Impulse:
    """The impulse of a force of a contact or a constraint."""

    name: str
    unit: str
    meaning: str
    location: str
    expression: ca.SX
    """What it acts along: a gap, a slip or a constraint."""
    is_rate: bool
    """Whether that is a rate."""
    multiplier: ca.SX = None
    """The multiplier whose rate it is since the start; None in the reduced form."""


@dataclass
class Requirement:
    """An expression that a mode requires to be positive, or, of what `may_vanish`, not to be negative."""

    expression: ca.SX
    failure: str
    location: str
    may_vanish: bool = False


@dataclass
class Falls:
    """A guard: the mode is inadmissible once `expression` falls through zero."""

    expression: ca.SX


@dataclass
class Transition:
    """Guard → next mode; built by `Model.transition`."""

    name: str
    source: "Mode"
    target: "Mode"
    guard: ca.SX
    condition: ca.SX
    reset: list
    impact: bool
    location: str
    is_chart: bool = False
    """Whether it leads to the same state in other coordinates; see `Model.chart`."""
    direction: ca.SX = None
    """The discrete state with which its guard multiplies a slip rate, if it does: the direction of a contact that slides."""
    impulses: dict = None
    """Of an impact of contacts in the reduced form, the impulses that are not zero, by their names."""
