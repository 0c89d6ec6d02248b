"""Forms in closed form for people: factored, where the factored expression is proved equal."""

from ..errors import NotInClass
from ..normal.algebra import expression


def closed(form):
    """A form as a SymPy expression, factored where the factored one is proved equal to it."""
    import sympy

    expanded = sympy.expand(sympy.expand_trig(expression(form)))
    angles = sorted({a for f in expanded.atoms(sympy.sin) for a in f.free_symbols}, key=str)
    expanded = sympy.expand(expanded.subs({sympy.sin(a)**2: 1 - sympy.cos(a)**2 for a in angles}))
    result = sympy.factor(expanded)
    try:
        return result if form.ring.read(result) == form else expression(form)
    except NotInClass:
        return expression(form)
