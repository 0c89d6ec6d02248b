"""Findings that are no slip of a term: a momentum with split masses, impacts that gain energy, what is not defined, what may
not be neglected."""

from ..construct.impacts import impact
from ..input.namespace import sympy_namespace
from ..judgements.definite import rest, states
from ..judgements.energies import wrong_terms
from ..judgements.galilei import split
from ..judgements.subject import Subject
from ..normal.algebra import expression
from ..normal.intervals import intervals, signs
from .closed import closed
from .findings import Finding
from .show import Quantity


def split_masses(printed, certain, struck):
    """For each equation of a translation whose first moment has split masses, a finding. Judged are the equations with
    what every reading corrects put right (`certain`): what is left is no misprint of one term, since each may be right. With them,
    by the finding's name: (the equation, coordinate, coordinate, what is left over)."""
    findings, found, paper = [], {}, printed.paper
    subject = Subject(certain, printed)
    for number in paper.equations:
        for first, second, left in split(subject, number):
            terms = subject.forms[number]
            taken = [k for k, form in enumerate(terms) for a, b in ((first, second), (second, first))
                     if (slope := form.diff("dd" + a).diff(b)) and slope.terms.keys() & left.terms.keys()]
            # in the equations `struck` a term was struck out, which has moved those behind it
            taken = [] if number in struck else sorted({k for k in taken if k < len(printed.forms[number])})
            key = f"split-{number}-{first}-{second}" if any(f.equation == number for f in findings) else f"split-{number}"
            findings.append(Finding(
                key, number, "principle",
                [f"The masses of one momentum are split: the accelerations of {first} and {second} belong to no first moment, and ",
                 left, " is left over between their factors. Each of the terms can be right, but not all of them: "
                 "with them a steady motion of the frame exerts a force. Every reading takes one mass."],
                tuple(taken), [printed.forms[number][k] for k in taken], ["one mass in all of these terms"], False, ["galilei"],
                left.order(paper.coordinates())))
            total = subject.scales.get(number, subject.ring.number(1)) * subject.conservative(number)
            found.setdefault(key, []).append((str(expression(total)), first, second, left))
    return findings, found


def impacts(printed, corrected, readings):
    """(findings, {(equation number, reading name): Impact}): impact laws whose coordinate goes on through its bound, and impacts
    that can gain energy."""
    findings, found = [], {}
    paper = printed.paper
    for number, equation in paper.equations.items():
        if equation.kind != "reset":
            continue
        for reading in readings:
            found[number, reading.name] = impact(corrected, number, reading.motion.kinetic.substitute(reading.motion.held))
        gains = [name for (n, name), result in found.items() if n == number and result.rises]
        if gains:
            result = found[number, gains[0]]
            case, rates = result.rises
            witness = ", ".join(f"{name} = {value:g}" for name, value in rates.items())
            jumps = [part for name, form in result.impulses.items() for part in (f"; the momentum of {name} jumps by ", form)]
            findings.append(Finding(
                f"impact-{number}", number, "principle",
                [f"The energy can rise in an impact: if the rates that ({number}) does not name keep their values, it changes by ",
                 result.change, f", which is positive, for instance, for {witness} ({case})."]
                + ([" Impulses act that nothing exerts: " + jumps[0][2:], *jumps[1:], "."] if jumps else []),
                (), ["what the other rates do at the impact"], ["momenta that no impulse changes are kept"], True, ["impact"], None,
                readings=gains))
    return findings, found


def through_the_bound(printed, number, kinetic):
    """The parameter set in which the printed impact law leads through the bound of its coordinate, or None."""
    return impact(printed, number, kinetic).penetrates


def undefined(printed):
    """A finding for each symbol that the paper uses and does not define."""
    paper, findings = printed.paper, []
    names = [name for name in paper.definitions if name not in paper.auxiliary]
    if not names:
        return findings
    symbols = sympy_namespace(paper, defined=False)
    for name in names:
        used = [n for n, e in paper.equations.items() if name in {x.name for term in e.terms(symbols, printed.m) for x in _free(term)}]
        form = printed.ring.read(paper.definitions[name](printed.s, printed.m))
        findings.append(Finding(
            f"undefined-{name}", ", ".join(used) or "text", "undefined", [f"{paper.symbols[name].meaning}."], (),
            [printed.ring.symbol(name)], [form], False, [], None))
    return findings


def _free(term):
    return getattr(term, "free_symbols", ())


def neglected(paper, readings, definiteness):
    """A finding where the mass matrix does not survive what the paper neglects, in some reading."""
    verdicts = {}
    for reading, d in zip(readings, definiteness):
        if d.neglected is None:
            continue
        found = [signs([d.neglected], intervals({**values, **rest(paper)[1], **state}))[0] for values in paper.sets.values()
                 for state in states(paper)]
        if not d.neglected:
            verdicts[reading.name] = ("singular at rest: the determinant is exactly 0, and accelerations along its null vector are not "
                                      "determined",)
        elif -1 in found:
            verdicts[reading.name] = (f"indefinite for {found.count(-1)} of {len(found)} parameter sets and states: the determinant at rest "
                                      "is ", closed(d.neglected))
        elif 0 in found:
            verdicts[reading.name] = (f"not shown to be positive definite for {found.count(0)} of {len(found)} parameter sets and states",)
    if not verdicts:
        return []
    names, zero = " and ".join(paper.negligible), " = ".join([*paper.negligible, "0"])
    by_verdict = {}
    for name, verdict in verdicts.items():
        by_verdict.setdefault(verdict, []).append(name)
    reason = [f"With {zero} the mass matrix is "]
    for verdict, found in by_verdict.items():
        reason += ["; "] * (len(reason) > 1) + [*verdict, " (reading " + ", ".join(f"'{n}'" for n in found) + ")"]
    first = next(d for reading, d in zip(readings, definiteness) if reading.name in verdicts)
    limits = _regular(paper, first)
    limits = "; the determinant is positive between " + ", and between ".join(limits) if limits else ""
    return [Finding(
        "neglect", "text", "approximation", [*reason, "."], (), [f"{names} can be negligible"],
        [f"the kinetic energy needs {paper.negligible[0]}{limits}"], True, ["definite"], None, readings=list(verdicts))]


def _regular(paper, d):
    """Where the determinant is positive between two critical values: shown halfway between them."""
    result = []
    for name, values in paper.sets.items():
        for state in states(paper, d.critical.coefficients if d.critical else None):
            key = ", ".join([name] + [f"{n} = {v:+d}" for n, v in state.items()])
            roots = d.critical.roots[key] if d.critical else []
            if len(roots) == 2:
                put = {**values, **rest(paper)[1], **state, d.critical.parameter: sum(roots) / 2}
                if signs([d.at_rest], intervals(put)) == [1]:
                    result.append(f"{roots[0]:.4g} and {roots[1]:.4g} ({key})")
    return result


def wrong_energies(printed, energies):
    """(findings, the energies that can be compared with): a finding for each term of an energy or a force that has another dimension."""
    findings, sound = [], []
    for reading in energies:
        wrong = wrong_terms(printed, reading)
        for what, term, words in wrong:
            name = what if what.startswith("force") else f"{what} energy" if what != "dissipation" else what
            findings.append(Finding(
                f"energy-{len(findings) + 1}", "text", "objection", [f"The {name} of '{reading.name}' has a term of another dimension: {words}. "
                "Nothing is compared with it."], (), [printed.ring.read(term)], [], False, ["dimensions"], None))
        if not wrong:
            sound.append(reading)
    return findings, sound


def wrong_numbers(numbers):
    """A finding for each printed number whose value or unit is not confirmed."""
    findings = []
    for x in numbers:
        n = x.number
        if x.agrees is False:
            findings.append(Finding(f"number-{n.name}", "text", "misprint", [f"{n.meaning}: it does not follow from the other "
                                    "printed numbers within their rounding"], (), [Quantity(f"{n.name} = {n.printed} {n.unit}")],
                                    [Quantity(f"{x.low:.6g} to {x.high:.6g} {n.unit}")], True, ["difference"], None))
        if not x.unit_agrees:
            findings.append(Finding(f"unit-{n.name}", "text", "misprint", [f"{n.meaning}: {n.note}"], (),
                                    [Quantity(f"{n.printed} {n.unit_printed}")], [Quantity(f"{n.printed} {n.unit}")], True, ["dimensions"], None))
    return findings
