"""A certificate: for each finding and each term that agrees a claim that check_certificate.py checks again, with nothing but
SymPy. Expressions are text; equations of motion are derived there from T, V and D anew."""

import json
from itertools import permutations

from ..judgements.comparison import compare
from ..judgements.definite import rest
from ..normal.algebra import expression

# raised when a claim changes its meaning
VERSION = 1


def as_certificate(report):
    """The certificate as JSON text."""
    return json.dumps(_Writer(report).content(), indent=1, ensure_ascii=False) + "\n"


class _Writer:
    def __init__(self, report):
        self.report, self.paper, self.printed = report, report.case.paper, report.printed
        self.motion = report.motions[0] if report.motions else None
        self.moving = [n for n, x in self.paper.symbols.items() if x.role in ("coordinate", "input") and not x.velocity]
        self.extra = list(self.motion.energies.extra) if self.motion else []
        self.let, self.claims, self.without = {}, [], {}

    def content(self):
        """All of it. `without` says of what is not an identity why there is none."""
        self._energies()
        self._rows()
        for number in self.paper.equations:
            self._terms(number)
        for finding in self.report.findings:
            self._finding(finding)
        symbols = self.paper.symbols.values()
        units = {n: self._unit(d) for n, d in self.printed.dimension.items() if n in self.paper.names()}
        return {
            "certificate": VERSION, "title": self.paper.title, "source": self.paper.source,
            "reading": self.motion.energies.name if self.motion else None,
            "symbols": [n for n in self.paper.names() if n not in self._named(self.moving)], "moving": self.moving + self.extra,
            "states": [x.name for x in symbols if x.role == "discrete"], "held": [n for n in self._named(self.extra) if n],
            "mirror": [n for x in symbols if x.mirror == -1 for n in (self._named([x.name]) if x.name in self.moving else [x.name])],
            "units": {n: u for n, u in units.items() if u != "1"}, "let": self.let, "claims": self.claims, "without": self.without,
        }

    def _named(self, names):
        return [d + n for n in names for d in ("", "d", "dd")]

    def _unit(self, dimension):
        parts = [f"U_{base}**({power})" if power != 1 else f"U_{base}" for base, power in zip(("kg", "m", "s"), dimension) if power]
        return "*".join(parts) or "1"

    def _energies(self):
        """T, V and D of the reading, as they are declared, and its further forces."""
        if self.printed.quasi:
            for name, form in self.printed.quasi.defined.items():
                self.let.update({"d" + name: str(expression(form)), "dd" + name: f"rate({expression(form)})"})
        if self.motion:
            energies, s, m = self.motion.energies, self.motion.s, self.motion.m
            self.let.update({"T__": str(energies.kinetic(s, m)), "V__": str(energies.potential(s, m)),
                        "D__": str(energies.dissipation(s, m)) if energies.dissipation else "0"})
            self.let.update({f"Q__{n}": str(f(s, m)) for n, f in energies.forces.items()})

    def _rows(self):
        """The equations of motion without what is dissipative, each times its multiplier."""
        for k, equation in enumerate(self.paper.motions()):
            row = self.printed.multipliers[equation.number] * self.printed.conservative(equation.number)
            self.let[f"row__{k}"] = str(expression(row))

    def derivation(self, name):
        """Lagrange's equation of a coordinate as text; of a quasi-velocity, those of the coordinates times their slopes by it."""
        force = f" - Q__{name}" if f"Q__{name}" in self.let else ""
        if name in self.paper.quasi:
            quasi = self.printed.quasi
            slopes = [row[quasi.names.index(name)] for row in quasi.b]
            return " + ".join(f"({expression(b)})*({self.derivation(x)})" for b, x in zip(slopes, quasi.positions)) + force
        return f"rate(diff(T__, d{name})) - diff(T__, {name}) + diff(V__, {name}) + diff(D__, d{name}){force}"

    def _reference(self, number):
        """(what the printed terms are multiplied by, what must come out) as text; None where nothing is known."""
        comparison = self.motion and compare(self.printed, self.motion, number)
        if not comparison:
            return None
        equation = self.paper.equations[number]
        reference = self.motion.reference(equation)
        derived = comparison.weight * self.printed.total(number) - comparison.difference
        text = str(expression(reference))
        for name in self.motion.coordinates:
            if reference == self.motion.residual(name):
                text = self.derivation(name)
        one = self.printed.ring.number(1)
        for factor in self.printed.factors() if equation.kind == "motion" else [one]:
            if derived == factor * reference * comparison.scale.inverse():
                text = f"({_text(factor)})*({text})/({_text(comparison.scale)})"
                return comparison, _text(comparison.weight), text
        return comparison, _text(comparison.weight), str(expression(derived))

    def _terms(self, number):
        """What agrees: what is left of the equation has no part of the term, and what is derived has one."""
        found = self._reference(number)
        if not found:
            return
        comparison, weight, derived = found
        left = str(expression(comparison.difference))
        self._claim({"equation": number}, "equal", f"({weight})*({_sum(self.printed.expressions[number])})", f"{derived} + {left}")
        for k in comparison.agree if not self.paper.quasi else ():
            term = f"({weight})*({self.printed.expressions[number][k]})"
            self._claim({"equation": number, "term": k + 1}, "alike", term, derived)
            self._claim({"equation": number, "term": k + 1}, "apart", term, left)

    def _claim(self, about, what, left, right, **more):
        self.claims.append({**about, "is": what, "of": [left, right], **more})

    def _finding(self, f):
        """The claims of a finding."""
        about = {"finding": f.key}
        before = len(self.claims)
        if f.slipped and (found := self._reference(f.equation)):
            _, weight, derived = found
            if f.proved:
                whole = self.report.corrected.expressions[f.equation]
                weight_after, derived_after = self._after(f.equation)
                self._claim(about, "equal", f"({weight_after})*({_sum(whole)})", derived_after)
                self._claim(about, "different", f"({weight_after})*({_sum(f.slipped)})", derived_after)
            else:
                self._claim(about, "different", f"({weight})*({_sum(self.printed.expressions[f.equation])})", derived)
        for violation in f.violations:
            self._violation(about, violation)
        if f.key.startswith("impact-"):
            self._impact(about, f)
        elif f.key.startswith("unit-"):
            self._claim(about, "different", *[self._printed_unit(x) for x in (f.printed[0], f.consistent[0])])
        elif f.key == "neglect" and not self.paper.quasi:
            self._neglect(about)
        elif f.kind == "principle":
            self._split(about, f)
        if len(self.claims) == before:
            self.without[f.key] = "no identity: " + {
                "undefined": "what the paper does not define is not in its table of symbols",
            }.get(f.kind, "the objection is one of words or numbers")

    def _after(self, number):
        """The weight and the derived side with which the corrected equation is compared."""
        subject = self.report.corrected
        comparison, printed = compare(subject, self.motion, number), self.printed
        self.printed = subject
        try:
            _, weight, derived = self._reference(number)
        finally:
            self.printed = printed
        return (weight, derived) if comparison else None

    def _printed_unit(self, text):
        from ..input import units

        return self._unit(units.parse(text.split(" ", 1)[1]))

    def _violation(self, about, v):
        """One objection."""
        number, words = v.equations[0], v.message[0]
        symbols = {e.number: k for k, e in enumerate(self.paper.motions())}
        rows = [(symbols[n], self.paper.equations[n].of) for n in v.equations if n in symbols]
        terms = [str(self.printed.expressions[number][k]) for k in v.terms]
        if v.judgement == "dimensions":
            unit = next((self._unit(part) for part in v.message if isinstance(part, tuple)), None)
            expected = [self._unit(part) for part in v.message if isinstance(part, tuple)]
            if unit and len(expected) == 2:
                self._claim(about, "different", f"scaled({terms[0]})", f"({expected[1]})*({terms[0]})")
        elif v.judgement == "mirror":
            equation = self.paper.equations[number]
            signs = [self.printed.forms[number][k] for k in v.terms]
            for term in terms[:len(signs)]:
                self._claim(about, "different", f"mirror({term})", f"({self._parity(number, equation)})*({term})")
        elif v.judgement == "lagrangian" and len(rows) == 2 and len(v.message) == 2 and not self.paper.quasi:
            (i, a), (j, b) = rows
            text = None
            if "mass matrix is not symmetric" in words:
                text = f"diff(row__{i}, dd{b}) - diff(row__{j}, dd{a})"
            elif words.startswith("the velocity terms"):
                text = f"diff(row__{i}, d{b}) + diff(row__{j}, d{a}) - rate(diff(row__{i}, dd{b}) + diff(row__{j}, dd{a}))"
            elif words.startswith("the terms of"):
                text = f"diff(row__{i}, {b}) - diff(row__{j}, {a}) - rate(diff(row__{i}, d{b}) - diff(row__{j}, d{a}))/2"
            if text:
                self._claim(about, "equal", text, str(expression(v.message[1])))
                self._claim(about, "different", text, "0")
        elif v.judgement == "galilei" and words.startswith("a constant velocity"):
            name = "d" + self.paper.translation[0]
            self._claim(about, "different", f"diff({expression(self.printed.conservative(number))}, {name})", "0")

    def _parity(self, number, equation):
        """The sign that the terms of an equation take in the mirror image: that of most of them."""
        if equation.kind != "motion":
            return "1" if equation.kind == "condition" else str(self.paper.symbols[equation.of].mirror)
        flip = {n: -self.printed.ring.symbol(n) for x in self.paper.symbols.values() if x.mirror == -1
                for n in (self._named([x.name]) if x.name in self.moving else [x.name])}
        signs = [1 if image == form else -1 if image == -form else 0
                 for form in self.printed.forms[number] for image in [form.substitute(flip)]]
        return str(max((self.paper.symbols[equation.of].mirror, -self.paper.symbols[equation.of].mirror), key=signs.count))

    def _impact(self, about, f):
        """The change of the energy, and a motion for which it is positive."""
        result = self.report.impacts[f.equation, f.readings[0]]
        if f.readings[0] != self.motion.energies.name:
            self.let["T_impact__"] = str(expression(next(m for m in self.report.motions if m.energies.name == f.readings[0]).kinetic))
        kinetic = "T_impact__" if "T_impact__" in self.let else "T__"
        inputs = [n for x in self.paper.symbols.values() if x.role == "input" for n in self._named([x.name])]
        still = "".join(f", {n}, 0" for n in inputs) + (f", {f.equation and result.of}, 0" if self.paper.symbols[result.of].minimum == 0 else "")
        flips = "".join(f", {n}, -{n}" for n in self.paper.equations[f.equation].flips)
        after = f"put({kinetic}, d{result.of}, {expression(result.law)}{flips}{still})"
        self._claim(about, "equal", f"{after} - put({kinetic}{still})", str(expression(result.change)))
        case, rates = result.rises
        name, *states = case.split(", ")
        values = {n: str(v) for n, v in self.paper.sets[name].items()}
        values.update({n: str(int(v)) for n, v in (x.split(" = ") for x in states)})
        values.update({n: "0" for n in rest(self.paper)[0] if not n.startswith("d")})
        values.update({n: repr(v) for n, v in rates.items()})
        names = result.change.names()
        self._claim(about, "greater", str(expression(result.change)), "0", at={n: v for n, v in values.items() if n in names})

    def _split(self, about, f):
        """The slopes of the factors of two accelerations differ, with the certain corrections made."""
        for text, first, second, left in self.report.splits.get(f.key, ()):
            curl = f"diff(diff({text}, dd{first}), {second}) - diff(diff({text}, dd{second}), {first})"
            self._claim(about, "equal", curl, str(expression(left)))
            self._claim(about, "different", curl, "0")

    def _neglect(self, about):
        """The determinant at rest with what is neglected."""
        q = self.paper.coordinates()
        entries = [[f"diff(diff(T__, d{a}), d{b})" for b in q] for a in q]
        terms = []
        for order in permutations(range(len(q))):
            sign = (-1) ** sum(order[i] > order[j] for i in range(len(q)) for j in range(i + 1, len(q)))
            terms.append(("+" if sign > 0 else "-") + "*".join(entries[i][k] for i, k in enumerate(order)))
        zeros = "".join(f", {n}, 0" for n in [*rest(self.paper)[0], *self.paper.negligible])
        d = self.report.definiteness[1]
        self._claim(about, "equal", f"put(0{''.join(terms)}{zeros})", str(expression(d.neglected)))


def _sum(terms):
    return " + ".join(f"({term})" for term in terms) or "0"


def _text(form):
    return str(expression(form))
