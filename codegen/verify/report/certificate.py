"""A certificate: for each finding and each term that agrees a claim that check_certificate.py checks again, with nothing but
SymPy. Expressions are text; equations of motion are derived there from T, V and D anew."""

import json
import re
from itertools import permutations, product

from ..input import units
from ..input.namespace import sympy_namespace
from ..judgements.comparison import compare
from ..judgements.definite import printed_mass, rest
from ..judgements.singular import regular
from ..normal.algebra import Opaque, expression
from ..normal.matrices import determinant
from .number_claims import beside

# raised when a claim changes its meaning
VERSION = 2


def as_certificate(report):
    """The certificate as JSON text."""
    return json.dumps(_Writer(report).content(), indent=1, ensure_ascii=False) + "\n"


class _Writer:
    def __init__(self, report):
        self.report, self.paper, self.printed = report, report.case.paper, report.printed
        # objections are raised by what the repairs, or corrections, leave
        self.objected = report.corrected
        self.motion = report.motions[0] if report.motions else None
        self.moving = [n for n, x in self.paper.symbols.items() if x.role in ("coordinate", "input") and not x.velocity]
        self.extra = list(self.motion.energies.extra) if self.motion else []
        self.let, self.claims, self.without = {}, [], {}
        # signs that count as constants, by what they are of
        self.steady = {}

    def content(self):
        """All of it. `without` says of what is not an identity why there is none."""
        self._energies()
        self._rows()
        for number in self.paper.equations:
            self._terms(number)
        for finding in self.report.findings:
            self._finding(finding)
        self._without_objection()
        symbols = self.paper.symbols.values()
        units = {n: self._unit(d) for n, d in self.printed.dimension.items() if n in self.paper.names()}
        return {
            "certificate": VERSION, "title": self.paper.title, "source": self.paper.source,
            "reading": self.motion.energies.name if self.motion else None,
            "symbols": [n for n in self.paper.names() if n not in self._named(self.moving)] + list(self.steady.values()),
            "moving": self.moving + self.extra,
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
            row = self.objected.multipliers[equation.number] * self.objected.conservative(equation.number)
            self.let[f"row__{k}"] = self._steady(row)

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
        elif f.key.startswith("energy-"):
            if found := re.search(r"it is in \S+, and what it is a term of in (\S+)\. ", f.reason[0]):
                term, unit = expression(f.printed[0]), self._unit(units.parse(found[1]))
                self._claim(about, "different", f"scaled({term})", f"({unit})*({term})")
        elif f.key.startswith("number-"):
            self._claim(about, "greater", *beside(self.report.numbers, f.key.removeprefix("number-"), self.let))
        elif f.key.startswith("unit-"):
            self._claim(about, "different", *[self._printed_unit(x) for x in (f.printed[0], f.consistent[0])])
        elif f.key == "neglect" and not self.paper.quasi:
            self._neglect(about)
        elif f.kind == "principle":
            self._split(about, f)
        elif f.kind == "undefined":
            self._undefined(about, f)
        if len(self.claims) == before:
            self.without[f.key] = "no identity: " + {
                "objection": "what is objected to is a sign or modulus of what moves, or a force that is given elsewhere",
            }.get(f.kind, "it is one of words or numbers")

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
        return self._unit(units.parse(text.split(" ", 1)[1]))

    def _violation(self, about, v):
        """One objection."""
        number, words = v.equations[0], v.message[0]
        symbols = {e.number: k for k, e in enumerate(self.paper.motions())}
        rows = [(symbols[n], self.paper.equations[n].of) for n in v.equations if n in symbols]
        terms = [str(self.objected.expressions[number][k]) for k in v.terms]
        if v.judgement == "dimensions":
            unit = next((self._unit(part) for part in v.message if isinstance(part, tuple)), None)
            expected = [self._unit(part) for part in v.message if isinstance(part, tuple)]
            if unit and len(expected) == 2:
                self._claim(about, "different", f"scaled({terms[0]})", f"({expected[1]})*({terms[0]})")
            else:
                self._has_no_unit(about, self.objected.expressions[number][v.terms[0]])
        elif v.judgement == "mirror":
            equation = self.paper.equations[number]
            signs = [self.objected.forms[number][k] for k in v.terms]
            for term in terms[:len(signs)]:
                self._claim(about, "different", f"mirror({term})", f"({self._parity(number, equation)})*({term})")
        elif v.judgement == "lagrangian" and len(rows) == 2 and len(v.message) == 2 and not self.paper.quasi:
            (i, a), (j, b) = rows
            text = None
            for start, condition in zip(("the mass matrix is not symmetric", "the velocity terms", "the terms of"), _helmholtz(i, a, j, b)):
                text = condition if words.startswith(start) else text
            if text:
                self._not_zero(about, text, v.message[1])
            elif "is not linear in the accelerations" in words:
                for name in self.paper.coordinates():
                    if slope := v.message[1].diff("dd" + name):
                        self._not_zero(about, f"diff(diff(row__{i}, dd{b}), dd{name})", slope)
        elif words.startswith("no Lagrangian gives"):
            self._has_factor(about, self.objected.multipliers[number] * self.objected.conservative(number), v.message[1])
        elif found := re.search(r"contains the force (\w+), which", words):
            self._claim(about, "different", f"diff(row__{symbols[number]}, {found[1]})", "0")
        elif "multiplies some of its terms only" in words:
            self._in_some_terms(about, self.objected.total(number))
        elif v.judgement in ("lagrangian", "galilei"):
            self._alone(about, v, number, words)
        elif v.judgement == "definite":
            self._minor(about, v)

    def _has_no_unit(self, about, term):
        """In other units it is not what it is times a number: their ratio changes with something."""
        import sympy

        units = {n: self._unit(d) for n, d in self.printed.dimension.items()}
        ratio = term.subs({x: x * sympy.sympify(units[x.name]) for x in term.free_symbols if units.get(x.name, "1") != "1"}, simultaneous=True) / term
        for symbol in sorted(term.free_symbols, key=str):
            if sympy.expand(sympy.fraction(sympy.together(ratio.diff(symbol)))[0]) != 0:
                self._claim(about, "different", f"diff(scaled({term})/({term}), {symbol})", "0")
                return

    def _not_zero(self, about, text, form):
        """What must be zero is another form."""
        self._claim(about, "equal", text, self._steady(form))
        self._claim(about, "different", text, "0")

    def _has_factor(self, about, form, factor):
        """A sign of what moves, alone or in a modulus, is a factor of some term of a form; the name of the sign."""
        steady, name = self._steady(form), re.search(r"sign__\d+", self._steady(factor))[0]
        back = "".join(f", {held}, {sign}" for sign, held in self.steady.items())
        self._claim(about, "equal", f"put({steady}{back})", str(expression(form)))
        self._claim(about, "different", f"diff({steady}, {name})", "0")
        return name

    def _in_some_terms(self, about, form):
        """A sign or modulus of what moves is a factor of some terms of a form, and not of all; or it is a modulus."""
        ring = form.ring
        opaque = sorted({n for monomial, _ in form.terms for n, _ in monomial if isinstance(n, Opaque)}, key=str)
        in_all = [all(any(n == name for n, _ in monomial) for monomial, _ in form.terms) for name in opaque]
        name = opaque[in_all.index(False)] if False in in_all else opaque[0]
        sign = self._has_factor(about, form, ring.symbol(name))
        if False in in_all:
            self._claim(about, "different", f"put({self._steady(form)}, {sign}, 0)", "0")

    def _steady(self, form):
        """A form as text, in which the signs count as constants, and moduli are what they are of times its sign."""
        import sympy

        whole = expression(form).replace(sympy.Abs, lambda x: x * sympy.sign(x))
        for sign in sorted(whole.atoms(sympy.sign), key=str):
            name = self.steady.setdefault(str(sign), f"sign__{len(self.steady) + 1}")
            whole = whole.xreplace({sign: sympy.Symbol(name)})
        return str(whole)

    def _alone(self, about, v, number, words):
        """An objection to one equation: to a momentum, or by Galilei's principle."""
        total = self.objected.total(number)
        if found := re.search(r"is not the rate of a momentum: its terms in (the velocity of )?(\w+) do not", words):
            # a sign that multiplies all of it counts as a constant
            name, whole = found[2], self._steady(total)
            text = (f"diff({whole}, d{name}) - 2*rate(diff({whole}, dd{name}))" if found[1]
                    else f"diff({whole}, {name}) - rate(diff({whole}, d{name}))/2")
            self._claim(about, "equal", text, self._steady(v.message[1]))
            self._claim(about, "different", text, "0")
        elif found := re.match(r"the accelerations of (\w+) and (\w+) do not enter as their sum", words):
            rest_ = self._steady(self.objected.conservative(number))
            self._claim(about, "different", f"diff({rest_}, dd{found[1]}) - diff({rest_}, dd{found[2]})", "0")
        elif found := re.match(r"the accelerations of (\w+) and (\w+) in \(.*\) do not belong to one first moment", words):
            whole = self._steady(self.objected.scales.get(number, self.objected.ring.number(1)) * self.objected.conservative(number))
            self._claim(about, "different", f"diff(diff({whole}, dd{found[1]}), {found[2]}) - diff(diff({whole}, dd{found[2]}), {found[1]})", "0")
        elif found := re.match(r"a constant (displacement|velocity)", words):
            for name in self.paper.translation:
                name = name if found[1] == "displacement" else "d" + name
                if self.objected.conservative(number).diff(name):
                    self._claim(about, "different", f"diff({self._steady(self.objected.conservative(number))}, {name})", "0")

    def _minor(self, about, v):
        """A leading minor of the printed mass matrix at rest, and its value for a parameter set."""
        found = re.search(r"at rest \(parameter set (.*)\): the leading minor (\d+) is not positive", v.message[0])
        if not found or self.paper.quasi:
            return
        motions = self.paper.motions()[:int(found[2])]
        for k, equation in enumerate(motions):
            self.let[f"full__{k}"] = str(expression(self.objected.multipliers[equation.number] * self.objected.total(equation.number)))
        entries = [[f"(diff(full__{i}, dd{f.of}) + diff(full__{j}, dd{e.of}))/2" for j, f in enumerate(motions)] for i, e in enumerate(motions)]
        zeros, left = "".join(f", {n}, 0" for n in rest(self.paper)[0]), v.message[1]
        if self.objected.singular:
            matrix = [row[:len(motions)] for row in printed_mass(self.objected, symmetric=True)[:len(motions)]]
            whole, powers = regular(determinant(matrix), self.objected.singular)
            over = "*".join(["1", *(f"({expression(self.objected.singular[where])})**{power}" for where, power in powers.items())])
            self._claim(about, "equal", _determinant(entries), f"{over}*({expression(whole)})")
            self._claim(about, "equal", f"put({expression(whole)}{zeros})", str(expression(left)))
        else:
            self._claim(about, "equal", f"put({_determinant(entries)}{zeros})", str(expression(left)))
        name, *states = found[1].rsplit(", ", sum(x.role == "discrete" for x in self.paper.symbols.values()))
        values = {**self.paper.sets[name], **rest(self.paper)[1], **dict(x.split(" = ") for x in states)}
        values = {n: str(int(x)) if str(x).startswith("+") else str(x) for n, x in values.items() if n in v.message[1].names()}
        if v.message[1]:
            self._claim(about, "greater", "0", str(expression(v.message[1])), at=values)

    def _without_objection(self):
        """The Helmholtz conditions, where they are judged and hold: without energies they are what is proved."""
        if self.motion or self.paper.quasi or "lagrangian" in self.report.unjudged or self.report.corrected_violations["lagrangian"]:
            return
        of = [equation.of for equation in self.paper.motions()]
        for i, j in product(range(len(of)), repeat=2):
            for text in _helmholtz(i, of[i], j, of[j]) if j <= i else ():
                self._claim({"judgement": "lagrangian"}, "equal", text, "0")

    def _parity(self, number, equation):
        """The sign that the terms of an equation take in the mirror image: that of most of them."""
        if equation.kind != "motion":
            return "1" if equation.kind == "condition" else str(self.paper.symbols[equation.of].mirror)
        flip = {n: -self.objected.ring.symbol(n) for x in self.paper.symbols.values() if x.mirror == -1
                for n in (self._named([x.name]) if x.name in self.moving else [x.name])}
        signs = [1 if image == form else -1 if image == -form else 0
                 for form in self.objected.forms[number] for image in [form.substitute(flip)]]
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

    def _undefined(self, about, f):
        """The equations depend on the symbol, whatever it means."""
        symbols = sympy_namespace(self.paper, defined=False)
        name = f.key.removeprefix("undefined-")
        for number in f.equation.split(", "):
            if number in self.paper.equations:
                terms = self.paper.equations[number].terms(symbols, self.printed.m)
                self._claim(about, "different", f"({_sum(terms)}) - put({_sum(terms)}, {name}, 0)", "0")

    def _neglect(self, about):
        """The determinant at rest with what is neglected."""
        q = self.paper.coordinates()
        entries = [[f"diff(diff(T__, d{a}), d{b})" for b in q] for a in q]
        zeros = "".join(f", {n}, 0" for n in [*rest(self.paper)[0], *self.paper.negligible])
        d = self.report.definiteness[1]
        self._claim(about, "equal", f"put({_determinant(entries)}{zeros})", str(expression(d.neglected)))


def _helmholtz(i, a, j, b):
    """What is zero where the equations of the coordinates a and b come from a Lagrangian."""
    return (f"diff(row__{i}, dd{b}) - diff(row__{j}, dd{a})",
            f"diff(row__{i}, d{b}) + diff(row__{j}, d{a}) - rate(diff(row__{i}, dd{b}) + diff(row__{j}, dd{a}))",
            f"diff(row__{i}, {b}) - diff(row__{j}, {a}) - rate(diff(row__{i}, d{b}) - diff(row__{j}, d{a}))/2")


def _determinant(entries):
    """The determinant of a matrix of texts."""
    terms = []
    for order in permutations(range(len(entries))):
        sign = (-1) ** sum(order[i] > order[j] for i in range(len(entries)) for j in range(i + 1, len(entries)))
        terms.append(("+" if sign > 0 else "-") + "*".join(f"({entries[i][k]})" for i, k in enumerate(order)))
    return "0" + "".join(terms)


def _sum(terms):
    return " + ".join(f"({term})" for term in terms) or "0"


def _text(form):
    return str(expression(form))
