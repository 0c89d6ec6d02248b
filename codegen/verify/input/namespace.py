"""The namespaces that the functions of a paper and of energies get: SymPy symbols by name, and functions."""


class Mathematics:
    """The namespace `m` for SymPy expressions."""

    def __init__(self):
        import sympy

        from .rates import Rate

        self.sin, self.cos, self.tan, self.sign, self.Abs = sympy.sin, sympy.cos, sympy.tan, sympy.sign, sympy.Abs
        self.rate = Rate


def sympy_namespace(paper, extra=(), defined=True):
    """SymPy symbols for every name of a paper and of `extra` coordinates. What the paper leaves
    undefined is put in by its reading, or (not `defined`) is a symbol of its own."""
    import sympy

    names = [n for n in paper.names() if not (defined and n in paper.definitions)]
    for symbol in extra:
        names += [symbol, "d" + symbol, "dd" + symbol]
    return paper.namespace({n: sympy.Symbol(n, real=True) for n in names}, Mathematics())
