"""Energies as a person declares them: functions of the symbols of a paper."""

from dataclasses import dataclass, field
from typing import Callable, Dict, List, Optional

from ...errors import error_location, location
from ..errors import PaperError, VerifyError
from .printed import Symbol, latex_name


@dataclass
class Energies:
    """Energies in the symbols of a paper; functions of the same namespaces `s`, `m`.

    `kinetic`, `potential` and `dissipation` (Rayleigh) are energies in J (W for the last);
    `forces` gives further generalized forces by coordinate. `squares`, where known, lists pairs
    (coefficient, velocity) with T = 1/2 sum coefficient velocity^2 while the further coordinates
    are held: a certificate that T >= 0 where no coefficient is negative. `references` says,
    by equation number, what a printed value, condition or rule must equal (of a rule: what is
    positive where the state is +1): a function of `s`, `m` and the derived `Motion`. Coordinates that the paper does not have (the height whose reaction
    is the normal force) are declared with `coordinate` and are held at zero.
    """

    name: str
    description: str
    kinetic: Callable
    potential: Callable
    dissipation: Optional[Callable] = None
    forces: Dict[str, Callable] = field(default_factory=dict)
    squares: Optional[Callable] = None
    references: Dict[str, Callable] = field(default_factory=dict)
    scales: Dict[str, Callable] = field(default_factory=dict)
    extra: Dict[str, Symbol] = field(default_factory=dict)
    pushes: List[str] = field(default_factory=list)

    def called(self, function, s, m, *context):
        """What one of the functions gives; an error says where it stands."""
        try:
            found = function(s, m, *context)
        except VerifyError:
            raise
        except Exception as error:  # whatever a model file does wrong is its author's to read
            raise PaperError(f"{self._place(function, error)}the energies '{self.name}': {type(error).__name__}: {error}") from error
        if found is None or isinstance(found, (tuple, set, dict)):
            raise PaperError(f"{self._place(function)}the energies '{self.name}': '{function.__name__}' gives {found!r}, which is no expression "
                             "of the symbols")
        return found

    def _place(self, function, error=None):
        """Where an error in a function, or the function, stands."""
        code = getattr(function, "__code__", None)
        return f"{error_location(error, code.co_filename) if error else location(code.co_filename, code.co_firstlineno)}: " if code else ""

    def coordinate(self, name, unit, meaning, mirror=1, pushes=False):
        """Declare a coordinate that is held at zero in all equations; `pushes` where what holds it cannot pull (the ground),
        so that its reaction must be positive."""
        if pushes:
            self.pushes.append(name)
        self.extra[name] = Symbol(name, unit, meaning, "coordinate", latex_name(name), mirror)

    def reference(self, number, scale=None):
        """Register the decorated function as what equation `number` must say, once the printed
        terms are multiplied by the positive factor `scale` (of a sign rule)."""

        def register(function):
            self.references[number] = function
            if scale:
                self.scales[number] = scale
            return function

        return register
