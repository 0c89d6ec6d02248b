"""The proof that the function of a printed equation says what the LaTeX beside it says: the same
statement (left side, relation, what follows from it), and the same terms, one by one."""

from fractions import Fraction

from sympy import sympify

from ..errors import LatexError, NotInClass, PaperError
from .latex import Parser
from .namespace import sympy_namespace
from .printed import plain_latex
from .tokens import error_at


def proved(subject):
    """Numbers of the equations whose function is proved to say what their LaTeX says; an equation
    where it does not is an error."""
    # a symbol that the paper does not define stands for itself: its reading is not what is printed
    s = sympy_namespace(subject.paper, defined=False)
    return [number for number, equation in subject.paper.equations.items()
            if equation.latex and equation.function and _prove(subject, equation, s)]


def _prove(subject, equation, s):
    """Proves one equation or raises a PaperError that names it."""
    name = f"equation ({equation.number})"
    try:
        tree = statement(equation, subject.paper)
        written = [subject.ring.read(term) for term in terms(tree, subject.paper, s, subject.m, equation.latex)]
    except (LatexError, NotInClass, ZeroDivisionError) as error:
        raise PaperError(f"{name}: its LaTeX: {error}") from error
    given = [subject.ring.read(term) for term in equation.terms(s, subject.m)]
    if written != given:
        k = next((k for k, pair in enumerate(zip(written, given)) if pair[0] != pair[1]), min(len(written), len(given)))
        raise PaperError(f"{name}: the function and the LaTeX beside it differ from term {k + 1} on")
    return True


def statement(equation, paper):
    """The tree of an equation's LaTeX, its terms numbered in printed order. What stands around the
    terms must be what the equation is declared to be: its symbol, its relation, its result."""
    parser = Parser(equation.latex)
    tree = parser.equation()
    shape = [child.kind if child.kind != "relation" else child.text for child in tree.children]
    sides = [child for child in tree.children if child.kind == "sum"]
    relation = equation.relation or "="
    expected = ["sum", relation, "sum"]
    if equation.kind == "rule":
        expected = ["sum", "=", "sum", "text", "sum", relation, "sum"]
    if shape != expected:
        words = {"sum": "terms", "text": "words"}
        raise parser.error(f"a {equation.kind} is written as {' '.join(words.get(x, x) for x in expected)}, "
                           f"not as {' '.join(words.get(x, x) for x in shape)}:")
    if equation.kind in ("value", "rule", "reset"):
        _subject_of(equation, paper, sides[0], parser)
        _times(equation, tree, parser)
    else:
        _times(None, tree, parser)
    if equation.kind == "rule":
        if tree.children[3].text != r"\text{if}":
            raise parser.error(f"expected \\text{{if}} and found {tree.children[3].text}")
        if _number(sides[1]) != equation.result or _number(sides[3]) != 0:
            raise parser.error(f"the rule is declared as {equation.of} = {equation.result} if ... {relation} 0, "
                               "which is not what is written")
        sides = [sides[2]]
    elif equation.kind in ("value", "reset"):
        sides = [sides[1]]
    counter = [0]
    for side in sides:
        # the side that a residual or a margin takes with the opposite sign
        opposite = equation.kind in ("motion", "condition") and (side is sides[0]) == (relation == "<")
        if _number(side) != 0:
            _collect(side, -1 if opposite else 1, counter)
    return tree


def _sums(product):
    """The factors of a product that are sums of terms: brackets, and fractions and rates of more than one term."""
    return [f for f in product.children if f.kind == "group" or f.kind == "fraction" and len(f.children[0].children) > 1
            or f.kind == "rate" and (len(_inside(f).children) > 1 or any(map(_sums, _inside(f).children)))]


def _inside(factor):
    """The sum that a bracket, a fraction or a rate has terms of."""
    return factor.children[0].children[0] if factor.kind == "rate" else factor.children[0]


def _collect(node, sign, counter):
    """Numbers the terms of a sum, brackets multiplied out, and gives each its sign on its side."""
    for product in node.children:
        groups = _sums(product)
        product.side = sign
        if groups:
            _collect(_inside(groups[-1]), sign, counter)
        else:
            product.ordinal = counter[0]
            counter[0] += 1


def _number(side):
    """The number that a side consists of, or None."""
    if len(side.children) != 1 or len(side.children[0].children) != 1:
        return None
    factor = side.children[0].children[0]
    return side.children[0].sign * Fraction(factor.text) if factor.kind == "number" else None


def _subject_of(equation, paper, side, parser):
    """Checks that the left side is the symbol that the equation is for (after an impact, its rate)."""
    dots, time = (1, "+") if equation.kind == "reset" else (0, "")
    factors = side.children[0].children
    node = factors[0]
    alone = len(side.children) == 1 and len(factors) == 1 and side.children[0].sign == 1 and node.kind == "symbol"
    if not alone or _key(node) != plain_latex(paper.symbols[equation.of].latex) or (node.dots, node.time) != (dots, time):
        wanted = f"the rate of {equation.of} with (t^+)" if equation.kind == "reset" else equation.of
        raise parser.error(f"the left side must be {wanted} and nothing else")


def _times(equation, tree, parser):
    """Checks the instants: the right side of an impact law is in the state before it, and nothing
    else has instants."""
    def visit(node, law):
        if node.kind == "symbol":
            if law and (node.time == "+" or node.dots and node.time != "-"):
                raise parser.error("an impact law gives the rate after the impact, (t^+), from what is before it: every rate on "
                                   "the right has (t^-)")
            if not law and node.time:
                raise parser.error("only an impact law has instants such as (t^+)")
        for child in node.children:
            visit(child, law)

    law = equation is not None and equation.kind == "reset"
    for side in tree.children[1:] if law else tree.children:
        visit(side, law)


def _key(node):
    """What a symbol's LaTeX is told by."""
    return plain_latex(node.accent + node.text + ("_" + node.index if node.index else ""))


def whole_key(node):
    """The same for a symbol whose LaTeX has its dots in it."""
    return "d" * node.dots + "ot" * bool(node.dots) + _key(node)


def terms(tree, paper, s, m, latex=""):
    """The expressions of the numbered terms, with the signs of `Equation.terms`: an equation of
    motion is left minus right, a condition positive where it holds."""
    by_latex = {plain_latex(symbol.latex): symbol for symbol in paper.symbols.values()}

    def symbol(node):
        if node.dots and whole_key(node) in by_latex:
            return getattr(s, by_latex[whole_key(node)].name)
        if _key(node) not in by_latex:
            hint = ": declare what depends on time as an input or a force" if _key(node) == "t" else ""
            raise error_at(latex, node.at, f"the symbol {_key(node)!r} is not declared by the paper{hint}")
        found = by_latex[_key(node)]
        if node.dots and found.name in paper.definitions:
            return rate(node, getattr(s, found.name))
        if node.dots and found.role not in ("coordinate", "input"):
            raise error_at(latex, node.at, f"the symbol {found.name} has dots and is neither a coordinate nor an input")
        if found.velocity:
            if node.dots > 1:
                raise error_at(latex, node.at, f"the quasi-velocity {paper.shown(found.name)} has {node.dots} dots; equations of motion have one at most")
            return getattr(s, "d" * (node.dots + 1) + found.name)
        if node.dots > 2:
            raise error_at(latex, node.at, f"the symbol {found.name} has {node.dots} dots; equations of motion have two at most")
        return getattr(s, "d" * node.dots + found.name)

    def value(node):
        if node.kind == "sum":
            return sum(product.sign * value(product) for product in node.children)
        if node.kind == "product":
            result = 1
            for factor in node.children:
                result = result * value(factor)
            return result
        if node.kind == "symbol":
            return symbol(node)
        if node.kind == "number":
            return Fraction(node.text)
        if node.kind == "call" and node.text in ("tan", "cot", "sec", "csc"):
            angle = value(node.children[0])
            above = {"tan": m.sin, "cot": m.cos}.get(node.text, lambda x: 1)
            return above(angle) / (m.cos if node.text in ("tan", "sec") else m.sin)(angle)
        if node.kind == "call":
            return getattr(m, node.text)(value(node.children[0]))
        if node.kind == "rate":
            return rate(node, value(node.children[0]))
        if node.kind == "modulus":
            return m.Abs(value(node.children[0]))
        if node.kind == "power":
            return value(node.children[0]) ** int(node.text)
        if node.kind == "fraction":
            below = value(node.children[1])
            if below == 0:
                raise error_at(latex, node.at, "a division by zero")
            return value(node.children[0]) / below
        return value(node.children[0])

    def rate(node, inner):
        if not hasattr(m, "rate"):
            raise error_at(latex, node.at, "a time derivative of a bracket can be judged, and not computed with: carry it out")
        for _ in range(node.dots):
            inner = m.rate(sympify(inner))
        return inner

    found = {}

    def collect(node, outer):
        # `outer` makes a term of what stands in the brackets around it
        for product in node.children:
            if product.ordinal is not None:
                found[product.ordinal] = product.side * outer(product.sign * value(product))
                continue
            groups = _sums(product)
            if groups and product.side:
                before = product.sign
                for factor in product.children:
                    if factor is not groups[-1]:
                        before = before * value(factor)
                if groups[-1].kind == "fraction":
                    before = before / value(groups[-1].children[1])
                derived = (lambda x, node=groups[-1]: rate(node, x)) if groups[-1].kind == "rate" else lambda x: x
                collect(_inside(groups[-1]), lambda x, before=before, derived=derived: outer(before * derived(x)))

    for side in tree.children:
        if side.kind == "sum":
            collect(side, lambda x: x)
    return [found[k] for k in sorted(found)]
