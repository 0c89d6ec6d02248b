"""Parsed LaTeX as LaTeX again, line by line, with single terms marked: what is shown is the tree that was judged."""

from ..input.latex import ENTITIES

BREAK = object()
NAMED = {"sin", "cos", "tan", "cot", "sec", "csc"}


def lines(tree, marks):
    """The printed lines of an equation; `marks` names the colour of a term by its ordinal."""
    out = []

    def symbol(node):
        body = "\\" + node.text if node.text in ENTITIES else node.text if len(node.text) == 1 else rf"\mathrm{{{node.text}}}"
        if node.accent:
            body = rf"\{node.accent}{{{body}}}"
        if node.dots:
            body = rf"\{'d' * node.dots}ot{{{body}}}"
        if node.index:
            body += rf"_{{\mathrm{{{node.index}}}}}"
        return body + (f"(t^{node.time})" if node.time else "")

    def inline(node):
        inner = []
        emit(node, inner)
        return " ".join(part for part in inner if part is not BREAK)

    def function(name, power=""):
        return (rf"\{name}" if name in NAMED else rf"\operatorname{{{name}}}") + (f"^{{{power}}}" if power else "")

    def call(node, power=""):
        return f"{function(node.text, power)} {inline(node.children[0])}"

    def emit(node, to):
        if node.kind == "symbol":
            to.append(symbol(node))
        elif node.kind == "number":
            to.append(node.text)
        elif node.kind == "call":
            to.append(call(node))
        elif node.kind == "power" and node.children[0].kind == "call":
            to.append(call(node.children[0], node.text))
        elif node.kind == "power":
            to.append(f"{{{inline(node.children[0])}}}^{{{node.text}}}")
        elif node.kind == "fraction" and node.text:
            to.append(f"{inline(node.children[0])} / {inline(node.children[1])}")
        elif node.kind == "fraction":
            to.append(rf"\frac{{{inline(node.children[0])}}}{{{inline(node.children[1])}}}")
        elif node.kind == "rate":
            to.append(r"\frac{d}{d t}")
            emit(node.children[0], to)
        elif node.kind == "modulus":
            to.append(f"|{inline(node.children[0])}|")
        elif node.kind == "group" and not node.text:
            emit(node.children[0], to)
        elif node.kind == "group":
            left = node.text[-1]
            brace = "\\" if left == "{" else ""
            to.append(brace + left)
            emit(node.children[0], to)
            to.append(brace + dict(zip("([{", ")]}"))[left])
        elif node.kind == "sum":
            for product in node.children:
                if product.broken:
                    to.append(BREAK)
                inside = [product.lead] if product.lead else []
                for factor in product.children:
                    if factor.lead:
                        inside.append(r"\cdot" if factor.lead in ("·", "⋅") else factor.lead)
                    emit(factor, inside)
                mark = marks.get(product.ordinal) if product.ordinal is not None else None
                # an empty formula in front keeps a sign binary
                to += [rf"{{\color{{{mark}}}{{}}{' '.join(x for x in inside if x is not BREAK)}}}"] if mark else inside
        else:
            to.append(rf"\;\text{{{node.text[6:-1]}}}\;" if node.kind == "text" else node.lead)

    for child in tree.children:
        if child.kind != "sum" and child.broken:
            out.append(BREAK)
        emit(child, out)
    rows = [[]]
    for part in out:
        if part is BREAK and rows[-1]:
            rows.append([])
        elif part is not BREAK:
            rows[-1].append(part)
    return [" ".join(row) for row in rows]
