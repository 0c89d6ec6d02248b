"""Parsed LaTeX as MathML, with single terms marked. Without any network or script."""

from html import escape

from ..input.latex import ENTITIES, Parser

BREAK = object()
# where a formula inside a sentence may go on in the next line
SPLIT = object()

# what stands over a symbol
OVER = {"bar": "¯", "overline": "¯", "hat": "^", "widehat": "^", "tilde": "~", "widetilde": "~"}


DOT = '<mspace class="dot" width="0.2em" height="0.2em"/>'


def dotted(body, count):
    """A symbol with dots above. They are drawn by the style of the page: the dots of fonts touch their letter, or each
    other, so that a letter with one looks like one with two."""
    label = ("one dot", "two dots", "three dots")[count - 1]
    dots = '<mspace width="0.18em"/>'.join([DOT] * count)
    return f'<mover aria-label="{label}">{body}<mrow>{dots}</mrow></mover>'


def _parts(tree, marks):
    """The MathML of a tree in parts, with BREAK and SPLIT between."""
    out = []

    def symbol(node):
        body = f"<mi>{escape(ENTITIES.get(node.text, node.text))}</mi>"
        if node.accent:
            body = f'<mover accent="true">{body}<mo>{OVER[node.accent]}</mo></mover>'
        if node.dots:
            body = dotted(body, node.dots)
        if node.index:
            index = "".join(ENTITIES.get(part, part) for part in node.index.split("\\"))
            body = f"<msub>{body}<mi mathvariant=\"normal\">{escape(index)}</mi></msub>"
        if node.time:
            body += f"<mo>(</mo><msup><mi>t</mi><mo>{node.time}</mo></msup><mo>)</mo>"
        return f"<mrow>{body}</mrow>"

    def inline(node):
        """MathML of a node without line breaks."""
        inner = []
        emit(node, inner)
        return "<mrow>" + "".join(part for part in inner if part not in (BREAK, SPLIT)) + "</mrow>"

    def call(node, name):
        """A function and its argument."""
        space = "" if node.children[0].kind == "group" and node.children[0].text else '<mspace width="0.17em"/>'
        return f"<mrow>{name}<mo>&#x2061;</mo>{space}{inline(node.children[0])}</mrow>"

    def emit(node, to):
        if node.kind == "symbol":
            to.append(symbol(node))
        elif node.kind == "number":
            to.append(f"<mn>{node.text}</mn>")
        elif node.kind == "call":
            to.append(call(node, f"<mi>{node.text}</mi>"))
        elif node.kind == "power" and node.children[0].kind == "call":
            # of a function, before its argument: after it, the argument would look raised
            to.append(call(node.children[0], f"<msup><mi>{node.children[0].text}</mi><mn>{escape(node.text)}</mn></msup>"))
        elif node.kind == "power":
            to.append(f"<msup>{inline(node.children[0])}<mn>{escape(node.text)}</mn></msup>")
        elif node.kind == "fraction" and node.text:
            to.append(f"<mrow>{inline(node.children[0])}<mo>/</mo>{inline(node.children[1])}</mrow>")
        elif node.kind == "fraction":
            to.append(f"<mfrac>{inline(node.children[0])}{inline(node.children[1])}</mfrac>")
        elif node.kind == "rate":
            d, t = ("<msup><mi>d</mi><mn>2</mn></msup>", "<msup><mi>t</mi><mn>2</mn></msup>") if node.dots == 2 else ("<mi>d</mi>", "<mi>t</mi>")
            to.append(f"<mfrac>{d}<mrow><mi>d</mi>{t}</mrow></mfrac>")
            emit(node.children[0], to)
        elif node.kind == "modulus":
            to.append(f"<mrow><mo>|</mo>{inline(node.children[0])}<mo>|</mo></mrow>")
        elif node.kind == "group" and not node.text:
            emit(node.children[0], to)
        elif node.kind == "group":
            left = node.text[-1]
            to.append(f'<mo stretchy="false">{left}</mo>')
            emit(node.children[0], to)
            to.append(f'<mo stretchy="false">{dict(zip("([{", ")]}"))[left]}</mo>')
        elif node.kind == "sum":
            for k, product in enumerate(node.children):
                if k:
                    to.append(SPLIT)
                if product.broken:
                    to.append(BREAK)
                mark = marks.get(product.ordinal) if product.ordinal is not None else None
                inside = []
                if product.lead:
                    inside.append(f'<mo form="infix">{"−" if product.lead == "-" else "+"}</mo>')
                for factor in product.children:
                    if factor.lead:
                        inside.append(f"<mo>{factor.lead}</mo>")
                    emit(factor, inside)
                to += [f'<mrow class="{mark}">' + "".join(x for x in inside if x not in (BREAK, SPLIT)) + "</mrow>"] if mark else inside
        else:
            text = node.text[6:-1] if node.kind == "text" else node.lead
            space = '<mspace width="0.5em"/>'
            to.append(f"{space}<mtext>{escape(text)}</mtext>{space}" if node.kind == "text" else f"<mo>{escape(text)}</mo>")

    for child in tree.children:
        if child.kind != "sum" and child.broken:
            out.append(BREAK)
        emit(child, out)
    return out


def mathml(tree, marks=None):
    """MathML of a tree in the lines in which it is printed; `marks` gives a CSS class by ordinal."""
    rows = [[]]
    for part in _parts(tree, marks or {}):
        if part is BREAK and rows[-1]:
            rows.append([])
        elif part not in (BREAK, SPLIT):
            rows[-1].append(part)
    cells = "".join(f'<mtr><mtd style="text-align:left">{"".join(r)}</mtd></mtr>' for r in rows)
    return f'<math display="block"><mtable displaystyle="true" columnalign="left">{cells}</mtable></math>'


def mathml_inline(latex):
    """MathML of a formula inside a sentence: a piece for each term, since browsers break no formula."""
    pieces = [[]]
    for part in _parts(Parser(latex).equation(), {}):
        if part is SPLIT:
            pieces.append([])
        elif part is not BREAK:
            pieces[-1].append(part)
    return " ".join(f"<math>{''.join(piece)}</math>" for piece in pieces)
