"""The slips that a hand makes in one printed term, each undone: the candidates of a repair."""

import sympy

from ..input.printed import rates
from ..input.rates import Rate
from ..input.units import parse

# kinds of slips in the order in which they are preferred where several explain the same
SLIPS = {
    "sign": "a wrong sign",
    "discrete state": "a discrete state lost or added",
    "dot": "a dot lost or added",
    "function": "sine for cosine, or the reverse",
    "power": "a power lost or added",
    "symbol": "one symbol for another",
    "index": "one index for another",
    "factor lost": "a factor lost",
    "factor added": "a factor added",
    "number": "a wrong numerical factor",
    "lost term": "a term that is not printed",
    "surplus term": "a term that nothing gives",
    "other": "another term",
}


def slip_text(slip):
    """A slip, or several joined by +, in words."""
    return " and ".join(SLIPS[part] for part in slip.split(" + "))


class Editor:
    """The edits of terms in the symbols of a paper."""

    def __init__(self, paper):
        self.discrete = [n for n, x in paper.symbols.items() if x.role == "discrete"]
        self.levels = {}
        for symbol in paper.symbols.values():
            if symbol.role in ("coordinate", "input"):
                for k, name in enumerate(rates(symbol)):
                    self.levels[name] = (symbol.name, k)
        self.still = {n for n, x in paper.symbols.items() if x.velocity}
        # symbols of one unit can be taken for one another, a coordinate for a coordinate or an input
        self.alike, kinds = {}, {}
        for name, symbol in paper.symbols.items():
            moving = symbol.role in ("coordinate", "input")
            if (symbol.role in ("parameter", "force") or moving) and name not in paper.definitions:
                kinds.setdefault((moving, symbol.role == "force", parse(symbol.unit)), []).append(name)
        for names in kinds.values():
            for name in names:
                self.alike[name] = [other for other in names if other != name]
        self.parameters = [n for n, x in paper.symbols.items() if x.role == "parameter" and n not in paper.definitions]
        self.known = {}

    def edits(self, term):
        """(slip, the term with it undone), each expression once, the preferred slips first."""
        if term not in self.known:
            found = {}
            for slip, expression in sorted(self._edits(term), key=lambda item: list(SLIPS).index(item[0])):
                if expression != term:
                    found.setdefault(expression, slip)
            self.known[term] = [(slip, expression) for expression, slip in found.items()]
        return self.known[term]

    def exchanges(self):
        """Pairs of parameters that can be taken for one another."""
        return [(_symbol(name), _symbol(other)) for name in self.parameters for other in self.alike.get(name, ())]

    def _edits(self, term):
        yield "sign", -term
        for name in self.discrete:
            state = _symbol(name)
            yield "discrete state", term / state if state in sympy.Mul.make_args(term) else term * state
        for factor in sympy.Mul.make_args(term):
            yield from self._of_factor(term, factor)
        for symbol in sorted(term.free_symbols, key=str):
            yield from self._of_symbol(term, symbol)
        yield from self._of_indices(term)
        for name in self.parameters:
            yield "factor lost", term * _symbol(name)

    def _of_factor(self, term, factor):
        """Edits of one factor of the product."""
        base, exponent = factor.as_base_exp()
        if base.func == Rate:
            for slip, inner in self._edits(base.args[0]):
                yield slip, term / factor * Rate(inner)**exponent
            return
        if base.is_number or not exponent.is_Integer:
            return
        yield "power" if exponent > 0 else "factor lost", term * base
        yield "power" if exponent > 1 else "factor added", term / base
        if base.is_Symbol and base.name in self.levels:
            for other in self._dotted(base.name):
                yield "dot", term / factor * other**exponent
                yield "dot", term / base * other
                if exponent > 2:
                    yield "dot", term / base**2 * other**2
        if base.is_Symbol and base.name not in self.levels and exponent > 1:
            for other in self.alike.get(base.name, ()):
                yield "symbol", term / base * _symbol(other)
        if base.func in (sympy.sin, sympy.cos):
            other = sympy.cos if base.func == sympy.sin else sympy.sin
            yield "function", term / factor * other(base.args[0])**exponent
            if exponent > 1:
                yield "function", term / base * other(base.args[0])
            summands = sympy.Add.make_args(base.args[0])
            for summand in summands if len(summands) > 1 else ():
                yield "sign", term / factor * base.func(base.args[0] - 2 * summand)**exponent

    def _of_symbol(self, term, symbol):
        """Exchanges of one symbol wherever it stands, and dots inside functions."""
        if symbol.name in self.alike and symbol.name not in self.levels:
            for other in self.alike[symbol.name]:
                yield "symbol", term.xreplace({symbol: _symbol(other)})
        if symbol.name in self.levels:
            name, level = self.levels[symbol.name]
            for other in self.alike.get(name, ()):
                yield "symbol", term.xreplace({symbol: _symbol("d" * level + other)})
            if level:
                for other in self._dotted(symbol.name):
                    yield "dot", term.xreplace({symbol: other})

    def _of_indices(self, term):
        """Exchanges of one index for another wherever it stands."""
        names = {x.name: x for x in term.free_symbols if x.name in self.alike and x.name not in self.levels}
        indices = {name.partition("_")[2] for name in self.alike}
        for old in sorted({name.partition("_")[2] for name in names} - {""}):
            for new in sorted(indices - {old, ""}):
                put = {}
                for name, symbol in names.items():
                    head, _, index = name.partition("_")
                    if index == old and f"{head}_{new}" in self.alike[name]:
                        put[symbol] = _symbol(f"{head}_{new}")
                if len(put) > 1:
                    yield "index", term.xreplace(put)

    def _dotted(self, name):
        """The symbol with one dot less and one more, as far as there are such."""
        base, level = self.levels[name]
        return [_symbol("d" * k + base) for k in (level + 1, level - 1) if (base in self.still) <= k <= 2]


def _symbol(name):
    return sympy.Symbol(name, real=True)


def editor(subject):
    """The editor of a subject's paper; subjects that share equations share it."""
    if "editor" not in subject.shared:
        subject.shared["editor"] = Editor(subject.paper)
    return subject.shared["editor"]
