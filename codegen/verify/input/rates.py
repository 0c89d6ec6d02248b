"""The time derivative of a printed bracket, d/dt(...), as a function of SymPy: what is printed keeps its form, so that a slip inside
the bracket is one slip. The normal form carries it out."""

import sympy


class Rate(sympy.Function):
    """d/dt of an expression of coordinates, rates, inputs and constants; numbers are taken out."""

    nargs = 1
    is_commutative = True

    @classmethod
    def eval(cls, inner):
        """A number has no rate, and a numerical factor stands before it."""
        if inner.is_number:
            return sympy.Integer(0)
        number, rest = inner.as_coeff_Mul()
        return None if number == 1 else number * cls(rest)

    def _eval_is_real(self):
        return True

    def _sympystr(self, printer):
        """As certificates write it."""
        return f"rate({printer.doprint(self.args[0])})"
