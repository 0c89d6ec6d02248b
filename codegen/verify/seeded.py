"""Seeded errors: correct hand-written equations, every kind of slip put in one at a time, and the
table of which judgement finds what, and whether the slip is undone."""

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable, List

from .input.rates import Rate
from .input.units import parse
from .judgements import JUDGEMENTS
from .judgements.subject import Subject
from .load import load
from .normal.algebra import expression
from .readings.lagrange import Motion
from .report.findings import detected, repaired

EXAMPLES = Path(__file__).parent / "examples"
PUBLISHED = Path(__file__).parent / "published"

KINDS = (
    "sign", "missing discrete state", "swapped symbol", "lost dot", "lost power", "dropped velocity term", "dropped term",
    "sine for cosine", "factor 2", "asymmetric coupling", "rewritten (no error)",
)

# what the repair of each kind is called (edits.SLIPS)
SLIP = {
    "sign": "sign", "missing discrete state": "discrete state", "swapped symbol": "symbol", "lost dot": "dot", "lost power": "power",
    "dropped velocity term": "lost term", "dropped term": "lost term", "sine for cosine": "function", "factor 2": "number",
    "asymmetric coupling": "number",
}


@dataclass
class Seed:
    """A mutated equation: which one, which term (from 0), what was done, and the new terms."""

    system: str
    equation: str
    term: int
    kind: str
    terms: Callable


@dataclass
class Outcome:
    """Which judgements object to a seed; `equivalent` if its normal form is unchanged, up to a
    constant factor of the whole equation: then it is no error, and none must object. `repairs` are
    the slips that were found in its place, as (equation, kind), and `repaired` says whether they are
    this one alone, called by its name, and give back the terms as they were."""

    seed: Seed
    equivalent: bool
    found: List[str]
    repairs: list
    repaired: bool


def variants(term, equation, paper):
    """All slips of one term: (kind, the expressions in its place)."""
    import sympy

    names = {x.name: x for x in term.free_symbols}
    symbols = paper.symbols
    yield "sign", [-term]
    yield "factor 2", [2 * term]
    moving = [n for n, x in symbols.items() if x.role in ("coordinate", "input")]
    # rates as they stand, outside of sign(...) and the like
    rates = {n for n in names if n not in symbols and n in {d + c for c in moving for d in ("d", "dd")}}
    quadratic = sum(sympy.degree(term, names[n]) for n in rates if not n.startswith("dd") and term.is_polynomial(names[n]))
    yield ("dropped velocity term" if quadratic >= 2 else "dropped term"), []
    for name in sorted(rates):
        if term.is_polynomial(names[name]) and not (name[1:] in symbols and symbols[name[1:]].velocity):
            # ddx is the acceleration of x also where x itself begins with d
            lower = name[1:]
            yield "lost dot", [term.subs(names[name], sympy.Symbol(lower, real=True))]
    for factor in sympy.Mul.make_args(term):
        if factor.func == Rate:
            for kind, instead in variants(factor.args[0], equation, paper):
                if kind in ("lost dot", "lost power", "sine for cosine", "swapped symbol"):
                    yield kind, [term / factor * Rate(instead[0])]
        if factor.is_Pow and factor.exp == 2:
            yield "lost power", [term / factor.base]
        if factor.func in (sympy.sin, sympy.cos):
            other = sympy.cos if factor.func == sympy.sin else sympy.sin
            yield "sine for cosine", [term.subs(factor, other(factor.args[0]))]
        if factor.is_Symbol and factor.name in symbols:
            symbol = symbols[factor.name]
            if symbol.role == "discrete":
                yield "missing discrete state", [term / factor]
            if symbol.role == "parameter":
                alike = [n for n, x in symbols.items() if x.role == "parameter" and n != symbol.name and n not in paper.definitions
                         and parse(x.unit) == parse(symbol.unit)]
                if alike:
                    later = [n for n in alike if list(symbols).index(n) > list(symbols).index(symbol.name)]
                    other = sympy.Symbol((later or alike)[0], real=True)
                    # what terms are divided by is printed once for all of them
                    divided = any(f.is_Pow and f.exp < 0 and f.base.is_Add for f in sympy.Mul.make_args(term))
                    yield "swapped symbol", [term / factor * other if divided else term.subs(factor, other)]
    accelerated = [c for c in paper.coordinates() if "dd" + c in rates]
    if equation.kind == "motion" and accelerated and accelerated[0] != equation.of:
        yield "asymmetric coupling", [term * sympy.Rational(3, 4)]
    expanded = sympy.expand_trig(term)
    if expanded != term:
        yield "rewritten (no error)", [expanded]


def seeds(name, paper, subject):
    """All seeds of a system."""
    for number, equation in paper.equations.items():
        terms = subject.expressions[number]
        for index, term in enumerate(terms):
            for kind, instead in variants(term, equation, paper):
                yield Seed(name, number, index, kind, _replaced(terms, index, instead))
            if term.has(Rate):
                yield Seed(name, number, index, "rewritten (no error)", _replaced(terms, index, [expression(subject.forms[number][index])]))
        if equation.kind == "motion":
            for constant in [-1] + [getattr(subject.s, n) for n in sorted(subject.ring.involutions)]:
                scaled = [constant * term for term in terms]
                yield Seed(name, number, 0, "rewritten (no error)", _replaced(scaled, 0, scaled[:1]))


def _replaced(terms, index, instead):
    """A function that gives the terms with one of them replaced."""
    return lambda s, m: [*terms[:index], *instead, *terms[index + 1:]]


def run(name, folder=None, every=1):
    """All outcomes of a system, or those of every so manieth seed. Published equations are seeded with their own misprints undone;
    then they must raise no objection."""
    case = load(folder or EXAMPLES / name, name)
    subject, motion = Subject(case.paper), Motion(case.paper, case.energies[0])
    if folder:
        _, subject = repaired(subject, motion)
    objections = detected(subject, motion)
    if objections:
        raise ArithmeticError(f"the correct equations of {name} are objected to by: {', '.join(objections)}")
    return outcomes(name, subject, motion, every)


def outcomes(name, subject, motion, every=1):
    """The outcomes of the seeds of a system whose equations are right."""
    outcomes = []
    for seed in list(seeds(name, subject.paper, subject))[::every]:
        equation = subject.paper.equations[seed.equation]
        mutated = Subject(subject.paper.with_equations([replace(equation, function=seed.terms, latex="")]), subject)
        before, after = subject.total(seed.equation), mutated.total(seed.equation)
        factors = subject.factors() if equation.kind == "motion" else [subject.ring.number(1)]
        if equation.kind == "motion" and len(subject.forms[seed.equation]) == 1 and after:
            # one term alone is zero, whatever constant it is multiplied by
            ratio = after * before.inverse()
            factors = [ratio] if not ratio.names() - subject.ring.first.keys() else factors
        found, whole = repaired(mutated, motion)
        slips = [(number, repair.slip) for number, list_ in found.items() for repair in list_]
        # the terms may come back in another order: a lost one at the end
        right = Counter(whole.forms[seed.equation]) == Counter(subject.forms[seed.equation])
        outcomes.append(Outcome(seed, any(after == factor * before for factor in factors), detected(mutated, motion), slips,
                                right and slips == [(seed.equation, SLIP.get(seed.kind))]))
    return outcomes


def run_all():
    """Outcomes of all example systems, by name."""
    return {folder.name: run(folder.name) for folder in sorted(EXAMPLES.iterdir()) if (folder / "paper.py").is_file()}


def run_published(every=1):
    """Outcomes of the published systems that print energies, by name; without energies slips are located and not undone."""
    folders = [folder for folder in sorted(PUBLISHED.iterdir()) if (folder / "paper.tex").is_file()]
    return {f"published {folder.name}": run(folder.name, folder, every) for folder in folders if load(folder).energies}


def table(outcomes):
    """Rows (kind, errors, equal, found, found without the energies, repaired, {judgement: found by it})."""
    rows = []
    for kind in KINDS:
        chosen = [o for o in outcomes if o.seed.kind == kind]
        errors = [o for o in chosen if not o.equivalent]
        counts = Counter(name for o in errors for name in o.found)
        if chosen:
            rows.append((kind, len(errors), len(chosen) - len(errors), sum(bool(o.found) for o in errors),
                         sum(bool(set(o.found) - {"difference"}) for o in errors), sum(o.repaired for o in errors),
                         {name: counts[name] for name in JUDGEMENTS}))
    return rows


def summary(results):
    """A line a system: errors, found, repaired, rewritings and those that anything is found in."""
    lines = [f"{'system':44}{'errors':>7}{'found':>6}{'repaired':>9}{'equal':>6}{'blamed':>7}"]
    for name, outcomes in [*results.items(), ("all systems", _all(results))]:
        data = as_dictionary({name: outcomes})
        lines.append(f"{name:44}{data['seeded']:7}{data['detected']:6}{data['repaired']:9}{data['rewritings']:6}{data['false_alarms']:7}")
    return "\n".join(lines)


def as_text(results):
    """The detection table of each system and of all."""
    head = f"{'slip':24}{'errors':>7}{'equal':>6}{'found':>6}{'blind':>6}{'repaired':>9} " + "".join(f"{n:>12}" for n in JUDGEMENTS)
    lines = ["Seeded errors: each slip put into correct equations, one at a time. 'equal': provably no change;",
             "'blind': found without the energies, by the other five judgements; 'repaired': undone and named, as the",
             "only finding.", "", summary(results)]
    for name, outcomes in [*results.items(), ("all systems", _all(results))]:
        lines += ["", name, head]
        rows = table(outcomes)
        for kind, *counts, by in rows:
            lines.append(f"{kind:24}{_counts(counts)} " + "".join(f"{by[n]:12}" for n in JUDGEMENTS))
        lines.append(f"{'sum':24}{_counts([sum(row[k] for row in rows) for k in range(1, 6)])} "
                     + "".join(f"{sum(row[-1][n] for row in rows):12}" for n in JUDGEMENTS))
    return "\n".join(lines)


def _counts(counts):
    """The columns before the judgements."""
    return "".join(f"{count:{width}}" for count, width in zip(counts, (7, 6, 6, 6, 9)))


def _all(results):
    """The outcomes of all systems."""
    return [o for outcomes in results.values() for o in outcomes]


def as_dictionary(results):
    """The counts and the tables for machines."""
    errors = [o for o in _all(results) if not o.equivalent]
    equal = [o for o in _all(results) if o.equivalent]
    names = ("slip", "errors", "equal", "found", "blind", "repaired", "by")
    return {
        "seeded": len(errors), "detected": sum(bool(o.found) for o in errors), "repaired": sum(o.repaired for o in errors),
        "rewritings": len(equal), "false_alarms": sum(bool(o.found or o.repairs) for o in equal),
        "systems": {name: [dict(zip(names, row)) for row in table(outcomes)] for name, outcomes in results.items()},
    }
