"""A paper as LaTeX alone: `paper.tex` with the equations and energies as printed, `symbols.csv` with what
each symbol is. Nothing is written twice: terms, energies and constraint forces follow from the LaTeX.

Of `paper.tex` the displayed equations are read; the rest may be the manuscript as it is. What an equation
is, it shows, or a comment line in it or directly above it says: `% motion of \\theta_1`.
"""

import csv
import re
from dataclasses import replace
from pathlib import Path

from sympy import sympify

from ..errors import PaperError
from . import transcription, units
from .displays import ROLES, displayed
from .latex import Parser
from .macros import expanded, macros
from .namespace import Mathematics, sympy_namespace
from .printed import QUASI, Paper, plain_latex
from .tokens import Placed, error_at

TEX, SYMBOLS = "paper.tex", "symbols.csv"

COLUMNS = ("symbol", "kind", "unit", "meaning")
FURTHER = ("mirror", "minimum", "value", "low", "high")
KINDS = ("coordinate", "input", "parameter", "damping", "force", "friction", "sign", "multiplier", "defined", "undefined",
         "quasi-velocity")

ENERGIES = {"T": "T", "V": "V", "U": "V", "D": "D", "L": "L"}


def is_manuscript(folder):
    """Whether a folder has a paper as LaTeX."""
    return (Path(folder) / TEX).is_file()


def read(folder):
    """The paper of a folder, and the energies, forces and constraints that it prints, by role."""
    folder = Path(folder)
    if not (folder / SYMBOLS).is_file():
        raise PaperError(f"{folder / TEX} needs the table of its symbols beside it, {SYMBOLS}, with the columns {', '.join(COLUMNS)}")
    text = (folder / TEX).read_text(encoding="utf-8-sig")
    shown = re.sub(r"(?<!\\)%[^\n]*", lambda match: " " * len(match.group()), text)
    title = re.search(r"\\title\{([^{}]*)\}", shown)
    source = re.search(r"^%[ \t]*source:[ \t]*(.+)$", text, re.MULTILINE)
    paper = Paper(title.group(1).strip() if title else folder.name, source.group(1).strip() if source else str(folder / TEX))
    known = macros(shown)
    rows = _symbols(folder / SYMBOLS, paper, known)
    found = displayed(text, shown, str(folder / TEX), known)
    _translation(text, paper, rows, folder / TEX)
    _singular(text, paper, folder / TEX, known)
    printed = {}
    for equation in found:
        _sort(equation, paper, rows, printed)
    defined = [r for r in rows.values() if r["kind"] in ("defined", "undefined") and r["name"] not in paper.definitions]
    if defined:
        comment = "" if defined[0]["kind"] == "defined" else f"; say how you read it, below a line % reading of {defined[0]['symbol']}"
        raise PaperError(f"{folder / SYMBOLS}, line {defined[0]['line']}: no equation of {TEX} defines {defined[0]['symbol']}{comment}")
    _check_definitions(paper, printed)
    paper.check()
    return paper, printed


def _symbols(path, paper, known):
    """Declares the symbols of a table; its rows by what symbols are told apart by."""
    result, values, bounds, lacking = {}, {}, {}, []
    with open(path, newline="", encoding="utf-8-sig") as file:
        reader = csv.DictReader(file, skipinitialspace=True)
        header = [name.strip() for name in reader.fieldnames or ()]
        reader.fieldnames = header
        wrong = [f"lacks the column '{name}'" for name in COLUMNS if name not in header]
        wrong += [f"has an unknown column '{name}'" for name in header if name not in COLUMNS + FURTHER]
        if wrong:
            raise PaperError(f"{path}, line 1: the table {wrong[0]}; its columns are {', '.join(COLUMNS)}, and where wanted "
                             f"{', '.join(FURTHER)}")
        for row in reader:
            if row.get(None) or None in row.values():
                raise PaperError(f"{path}, line {reader.line_num}: the row has not {len(header)} cells; a cell with a comma stands in \"...\"")
            row = {key: value.strip() for key, value in row.items()}
            if not any(row.values()):
                continue
            row["line"], row["symbol"] = reader.line_num, expanded(row["symbol"], known)
            try:
                row["name"] = _declare(paper, row)
                for name in ("value", "low", "high", "minimum"):
                    if row.get(name):
                        float(row[name])
            except (PaperError, units.UnitError, ValueError) as error:
                raise PaperError(f"{path}, line {row['line']}: {error}") from error
            if row.get("value"):
                values[row["name"]] = row["value"]
            elif row["kind"] in ("parameter", "damping"):
                lacking.append(row["symbol"])
            if row.get("low") and row.get("high"):
                bounds[row["name"]] = (float(row["low"]), float(row["high"]))
            result[plain_latex(row["symbol"])] = row
    if values and lacking:
        raise PaperError(f"{path}: the column 'value' says nothing of {', '.join(lacking)}: give all parameters a value, or none")
    if values:
        paper.sets["values"] = values
    paper.box.update(bounds)
    return result


def _declare(paper, row):
    """Declares one symbol and returns its name."""
    kind, latex = row["kind"], row["symbol"]
    name = re.sub(r"\W+", "_", plain_latex(latex)).strip("_")
    units.parse(row["unit"])
    mirror = {"": 1, "1": 1, "+1": 1, "-1": -1}.get(row.get("mirror", ""))
    if mirror is None:
        raise PaperError(f"mirror is 1 or -1, not {row['mirror']}")
    if mirror == -1 and kind in ("parameter", "damping", "multiplier", "defined", "undefined"):
        raise PaperError(f"a {kind} keeps its sign in the mirror image")
    if kind == "coordinate":
        paper.coordinate(name, row["unit"], row["meaning"], latex, mirror, float(row["minimum"]) if row.get("minimum") else None)
    elif kind == "quasi-velocity":
        def undefined(s, m):
            raise PaperError(f"no equation of {TEX} defines the quasi-velocity {latex}, as a linear function of rates")

        paper.quasi_velocity(name, row["unit"], row["meaning"], latex, mirror)(undefined)
        return QUASI + name
    elif kind == "input":
        paper.input(name, row["unit"], row["meaning"], latex, mirror)
    elif kind == "sign":
        paper.discrete(name, (1, -1), row["meaning"], latex, mirror)
    elif kind in ("force", "friction"):
        paper.force(name, row["unit"], row["meaning"], latex, mirror, kind == "friction")
    elif kind in KINDS:
        paper.parameter(name, row["unit"], row["meaning"], latex, kind == "damping")
    else:
        raise PaperError(f"'{kind}' is no kind of symbol: {', '.join(KINDS)}")
    return name


def _translation(text, paper, rows, path):
    """`% translation: x, z`: the coordinate and the input that may enter as their sum only."""
    match = re.search(r"^%[ \t]*translation:(.*)$", text, re.MULTILINE)
    if match:
        names = [rows.get(plain_latex(part), {}).get("name") for part in match.group(1).split(",")]
        if len(names) != 2 or None in names:
            raise error_at(Placed(text, 0, len(text), str(path)), match.start(), "a translation is a coordinate and an input of the table, "
                           "with a comma between")
        paper.translation = tuple(names)


def _singular(text, paper, path, known):
    """`% singular where \\sin\\theta = 0`: configurations in which nothing is judged."""
    for match in re.finditer(r"^%[ \t]*singular where[ \t]*(.*?)[ \t.]*$", text, re.MULTILINE):
        latex = Placed(text, *match.span(1), str(path), known)
        tree = Parser(latex).equation() if latex else None
        if tree is None or [child.text for child in tree.children[1:2]] != ["="] or transcription._number(tree.children[2]) != 0:
            raise error_at(Placed(text, 0, len(text), str(path)), match.start(1), "what is singular is written as an expression = 0, such as "
                           "% singular where \\sin\\theta = 0")

        def left(s, m, latex=latex):
            tree = Parser(latex).equation()
            transcription._collect(tree.children[0], 1, [0])
            tree.children = tree.children[:1]
            return sum(transcription.terms(tree, paper, s, m, latex))

        paper.singular_where(str(latex))(left)


def _sort(equation, paper, rows, printed):
    """Gives an equation to the paper, or to the energies (`printed`, by role)."""
    role = equation.role or _role(equation, rows)
    if role == "skip":
        return
    latex, number = equation.latex, equation.number
    if role in ("T", "V", "D", "L"):
        reading = equation.reading()
        if reading in printed.setdefault(role, {}):
            raise equation.error(f"{role} is given twice" + (f" in reading {reading}" if reading else ": where the paper may mean one or the other, "
                                 "say which in a comment, such as % potential energy in reading A"))
        if equation.shape() != ["sum", "=", "sum"]:
            raise equation.error("an energy is written as a symbol = terms")
        printed[role][reading] = equation.right(paper)
        return
    named = equation.named or _named(equation, role, rows)
    row = rows.get(plain_latex(named))
    if row is None:
        raise equation.error(f"{named} is not in {SYMBOLS}" if named else "it is not clear what this equation is of: say it in a comment line "
                             f"above it, such as % {next(k for k, v in ROLES.items() if v == role)} \\theta")
    name = row["name"]
    number = number or _unnumbered(f"{role} of {name}", paper)
    if role in ("definition", "reading", "force"):
        if equation.shape() != ["sum", "=", "sum"]:
            raise equation.error(f"a {role} is written as a symbol = terms")
        if role != "force":
            if row["kind"] == "quasi-velocity" and role == "definition":
                paper.quasi[name] = equation.right(paper)
                return
            if row["kind"] != ("defined" if role == "definition" else "undefined"):
                raise equation.error(f"a {role} is of a symbol of kind {'defined' if role == 'definition' else 'undefined'}, and {named} is "
                                     f"a {row['kind']}")
            if name in paper.definitions:
                raise equation.error(f"{named} is defined twice")
            paper.definitions[name] = equation.defined(paper)
            paper.auxiliary += (name,) * (role == "definition")
            printed.setdefault("definitions", []).append((name, equation))
        else:
            printed.setdefault("forces", {})[name] = equation.right(paper)
            # what is given as a force is no part of a Lagrangian
            for node in _nodes(equation.tree.children[2]):
                other = rows.get(transcription._key(node), {}).get("name") if node.kind == "symbol" else None
                if other and paper.symbols[other].role == "force":
                    paper.symbols[other] = replace(paper.symbols[other], dissipative=True)
    elif role == "constraint":
        if equation.shape() != ["sum", "=", "sum"]:
            raise equation.error("a constraint is written as terms = terms")
        printed.setdefault("constraints", []).append((name, equation))
    elif role == "motion":
        paper.motion(number, of=name, latex=latex)
    elif role in ("value", "reaction"):
        paper.value(number, of=name, latex=latex, momentum=role == "reaction")
    elif role == "reset":
        paper.reset(number, of=name, latex=latex)
    else:
        relation = next((x for x in equation.shape() if x in ("<", ">")), None)
        if relation is None:
            raise equation.error(f"a {role} has the relation < or >")
        if role == "condition":
            paper.condition(number, of=name, relation=relation, latex=latex)
        else:
            result = transcription._number(equation.tree.children[2]) if len(equation.tree.children) > 2 else None
            if result not in (1, -1):
                raise equation.error("a rule is written as \\lambda = 1 \\quad \\text{if} \\quad ... > 0")
            paper.rule(number, of=name, result=int(result), relation=relation, latex=latex)


def _unnumbered(name, paper):
    """The name of an equation without number: what it is, counted where the paper has several of it."""
    names = [name] + [f"{name}, {k}" for k in range(2, len(paper.equations) + 2)]
    return next(x for x in names if x not in paper.equations)


def _role(equation, rows):
    """What an equation is, from its form."""
    shape, left = equation.shape(), equation.left()
    if "text" in shape:
        return "rule"
    if shape != ["sum", "=", "sum"]:
        return "condition"
    key = transcription._key(left) if left else None
    if left and transcription.whole_key(left) in rows and (equation.power() == 1 or rows[transcription.whole_key(left)]["kind"] == "defined"):
        kind = rows[transcription.whole_key(left)]["kind"]
        return "definition" if kind in ("defined", "quasi-velocity") else "value" if kind in ("force", "friction", "parameter") else "motion"
    if left and not left.dots and key in ENERGIES:
        return ENERGIES[key]
    if left and not left.dots and key.startswith("Q_"):
        return "force"
    return "reset" if left and left.time else "motion"


def _named(equation, role, rows):
    """The symbol that an equation is of, from its form: LaTeX, or nothing."""
    left = equation.left()
    if role in ("value", "definition", "reading", "reset", "rule", "reaction") and left:
        return transcription.whole_key(left) if transcription.whole_key(left) in rows else transcription._key(left)
    if role == "force" and left:
        return transcription._key(left).partition("_")[2]
    if role == "motion":
        quasi = any(row["kind"] == "quasi-velocity" for row in rows.values())
        kind = "quasi-velocity" if quasi else "coordinate"
        accelerated = {transcription._key(node) for node in _nodes(equation.tree) if node.kind == "symbol" and node.dots == 2 - quasi}
        of = [key for key in accelerated if rows.get(key, {}).get("kind") == kind]
        coordinates = [key for key, row in rows.items() if row["kind"] == kind]
        return of[0] if len(of) == 1 else coordinates[0] if len(coordinates) == 1 else ""
    return ""


def _nodes(node):
    """A node and all below it."""
    yield node
    for child in node.children:
        yield from _nodes(child)


def _check_definitions(paper, printed):
    """The dimension of each definition is that of its symbol."""
    known = units.table(paper.symbols.values())
    s, m = sympy_namespace(paper), Mathematics()
    for name, equation in printed.get("definitions", ()):
        try:
            found = units.measure(sympify(equation.defined(paper)(s, m)), known)
        except units.UnitError as error:
            raise equation.error(f"the definition of {name} is or contains {error}") from error
        if found != units.parse(paper.symbols[name].unit):
            raise equation.error(f"{name} is declared in {units.parse(paper.symbols[name].unit)} and defined in {found}")
