"""Claims on printed numbers as text: each is the interval of all that rounds to it, from which check_certificate.py computes again."""

import re
from decimal import Decimal

# pi, the last digit rounded down and up
PI = "between(3.141592653589793, 3.141592653589794)"


def beside(numbers, name, let):
    """(the greater, the less) of a printed number and what its formula gives, as text. What occurs in it is added to `let`; `numbers`
    are the numbers with their verdicts (judgements/numbers.py), in order."""
    known = _Known()
    for checked in numbers:
        number = checked.number
        if number.name == name:
            computed, printed = _formula(number, known), _interval(number)
            occurring = set(re.findall(r"\w+", computed))
            for symbol, text in reversed(known.let.items()):
                if symbol in occurring:
                    occurring |= set(re.findall(r"\w+", text))
            let.update({symbol: text for symbol, text in known.let.items() if symbol in occurring})
            return (computed, printed) if checked.low > float(number.printed) else (printed, computed)
        known.add(number)
    raise KeyError(name)


class _Known:
    """Numbers by attribute, as symbols; `let` says what each is."""

    def __init__(self):
        self.let = {"pi__": PI}

    def add(self, number):
        import sympy

        symbol = "number__" + re.sub(r"\W", "_", number.name)
        if number.printed or number.formula:
            self.let[symbol] = _interval(number) if number.printed else _formula(number, self)
            setattr(self, number.name, sympy.Symbol(symbol))


class _Functions:
    """Functions of formulas."""

    def __init__(self):
        import sympy

        self.pi = sympy.Symbol("pi__")
        self.sqrt, self.sin, self.cos, self.tan, self.asin, self.atan = sympy.sqrt, sympy.sin, sympy.cos, sympy.tan, sympy.asin, sympy.atan


def _formula(number, known):
    return str(number.formula(known, _Functions()))


def _interval(number):
    """All numbers that are printed so."""
    value = Decimal(number.printed)
    if number.exact:
        return str(value)
    half = Decimal((0, (5,), value.as_tuple().exponent - 1))
    return f"between({value - half}, {value + half})"
