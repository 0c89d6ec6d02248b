"""From a difference to repairs: the smallest edits of the printed terms with which an equation is
what the energies give. Every set of repairs is exact: with all of them the difference is zero."""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import List, Tuple

from sympy import Add, Derivative, Mul, Symbol, expand, sympify

from ..errors import NotInClass
from ..input.rates import Rate
from ..judgements.comparison import compare
from ..normal.algebra import ONE, expression
from ..normal.points import vanishes
from .edits import editor

# Two edits in one term are looked for where one does not explain it; three are not a misprint but
# another term.
SINGLE, DOUBLE = 1, 2


@dataclass
class Repair:
    """One repair: the ordinals of the printed terms (from 0; none where a term is lost), the kind of
    slip (edits.SLIPS; several are joined by +), the printed forms and the consistent ones, and the
    expressions that stand for them."""

    ordinals: Tuple[int, ...]
    slip: str
    printed: list
    consistent: list
    expressions: list


def repairs(subject, motion, number) -> List[Repair]:
    """The repairs of one equation; none where it is what the energies give, or they do not say."""
    comparison = motion and compare(subject, motion, number)
    if not comparison or not comparison.difference:
        return []
    if not comparison.weight.is_number():
        # a sign rule that was multiplied by a positive factor: its terms cannot be told apart
        reference = motion.reference(subject.paper.equations[number]) * comparison.orientation
        forms = subject.forms[number]
        return [Repair(tuple(range(len(forms))), "other", list(forms), [reference], [expression(reference)])]
    best = None
    least = min(len(difference.terms) for difference in comparison.differences)
    for difference in comparison.differences:
        # a factor with which far more differs cannot need fewer edits
        if len(difference.terms) <= 2 * least:
            found = _search(subject, motion, number, difference * comparison.weight, comparison.clear)
            if best is None or len(found) < len(best):
                best = found
    return best


def apply(equation, terms, found):
    """An equation with repairs applied to its terms."""
    slots = {k: [term] for k, term in enumerate(terms)}
    lost = []
    for repair in found:
        for k in repair.ordinals[1:]:
            slots[k] = []
        if repair.ordinals:
            slots[repair.ordinals[0]] = list(repair.expressions)
        else:
            lost += repair.expressions
    result = [term for slot in slots.values() for term in slot] + lost
    return replace(equation, function=lambda s, m: result, latex="", margin=True)


def _search(subject, motion, number, difference, clear):
    """The repairs for a difference of printed and derived, which is multiplied by `clear`, as all is that is compared here."""
    forms, terms, found = subject.forms[number], subject.expressions[number], []
    for momentum in momenta(motion, subject.paper.equations[number]):
        rate = Rate(momentum)
        parts = subject.read(rate).terms.keys()
        # a printed term with the same parts has a wrong factor
        for written in (rate, -rate) if len(parts) > 1 and not any(form.terms.keys() == parts for form in forms) else ():
            if not difference + subject.read(written) * clear:
                return [Repair((), "lost term", [], [subject.read(written)], [written])]
    if divided := _divisor(subject, forms, terms, difference, clear):
        return [divided]
    cleared = [form * clear for form in forms]
    open_terms = set(range(len(forms)))
    for depth in (SINGLE, DOUBLE):
        while difference:
            choice = _best(subject, cleared, terms, open_terms, difference, depth, clear)
            if choice is None:
                break
            k, slip, form, written = choice
            found.append(Repair((k,), slip, [forms[k]], [form], [written]))
            difference += form * clear - cleared[k]
            open_terms.discard(k)
    for k in sorted(open_terms):
        if len(_lost(subject, motion, -difference * clear.inverse())) == 1 and not cleared[k].terms.keys() <= difference.terms.keys():
            break  # one lost term, of which other terms have parts
        # what is left of a term that differs, coefficient by coefficient
        wrong = subject.ring.form({key: difference.terms[key] for key in cleared[k].terms if key in difference.terms})
        if wrong:
            form = forms[k] - wrong * clear.inverse()
            found.append(Repair((k,), "other" if form else "surplus term", [forms[k]], [form] if form else [],
                                [expression(form)] if form else []))
            difference -= wrong
    missing = -difference * clear.inverse()
    # what is no polynomial without the divisor falls apart with it
    parts = [part * clear.inverse() for part in _lost(subject, motion, -difference)] if missing.over else _lost(subject, motion, missing)
    for form in parts:
        found.append(Repair((), "lost term", [], [form], [expression(form)]))
    return sorted(found, key=lambda r: r.ordinals or (len(forms),))


def _divisor(subject, forms, terms, difference, clear):
    """One slip in a sum that terms are divided by, or None: it is printed once, and changes all of them."""
    divisors = dict.fromkeys(f.base for term in terms for f in Mul.make_args(term) if _divides(f))
    wanted = divisors and expression(difference * clear.inverse())
    for divisor in divisors:
        chosen = [k for k, term in enumerate(terms) if divisor in [f.base for f in Mul.make_args(term) if _divides(f)]]
        for part in divisor.args:
            for slip, written in [*editor(subject).edits(part), ("number", 2 * part), ("number", part / 2), ("surplus term", sympify(0))]:
                other = divisor - part + written
                changed = [terms[k].xreplace({divisor: other}) for k in chosen]
                if other == 0 or not vanishes([wanted, *changed, *(-terms[k] for k in chosen)], subject.ring.involutions):
                    continue
                edited = [_read(subject, term) for term in changed]
                if None not in edited and not difference + sum((new - forms[k] for k, new in zip(chosen, edited)), forms[0] * 0) * clear:
                    return Repair(tuple(chosen), slip, [forms[k] for k in chosen], edited, changed)
    return None


def _divides(factor):
    """Whether a factor is a reciprocal of a sum."""
    return factor.is_Pow and factor.exp.is_Integer and factor.exp < 0 and factor.base.is_Add


def _best(subject, cleared, terms, open_terms, difference, depth, clear):
    """The edit of one term that removes most of the difference and adds nothing to it, or None."""
    best = None
    for k in sorted(open_terms):
        if not cleared[k].terms.keys() & difference.terms.keys():
            continue
        for rank, (slip, form, written) in enumerate(_candidates(subject, subject.read(terms[k]), terms[k], cleared[k], difference, depth)):
            made = form * clear
            left = difference + made - cleared[k]
            # the edited term must agree, and nothing else may differ for it
            if not form or left.over or made.terms.keys() & left.terms.keys() or left.terms.keys() - difference.terms.keys():
                continue
            gain = len(difference.terms) - len(left.terms)
            order = (-gain, slip == "number", rank)
            if best is None or order < best[0]:
                best = (order, (k, slip, form, written))
    return best and best[1]


def _candidates(subject, form, term, cleared, difference, depth):
    """(slip, form, expression) of the edits of a term; of what it is divided by, _divisor has the edits."""
    divisors = [factor for factor in Mul.make_args(term) if _divides(factor)]
    below = Mul(*divisors)
    singles = [(slip, above * below) for slip, above in editor(subject).edits(term / below)] if divisors else editor(subject).edits(term)
    if divisors:
        # a wrong symbol may have cancelled with what the terms are divided by
        singles += [("symbol", term * other / symbol) for symbol, other in editor(subject).exchanges()
                    if symbol not in (term / below).free_symbols]
    if depth == SINGLE:
        for slip, written in singles:
            if (changed := _read(subject, written)) is not None:
                yield slip, changed, written
        for key, value in cleared.terms.items():
            if key in difference.terms:
                ratio = 1 - Fraction(difference.terms[key]) / value
                yield "number", form * ratio, term * sympify(ratio)
        return
    for first, between in singles:
        for second, above in editor(subject).edits(between / below):
            if (changed := _read(subject, above * below)) is not None:
                yield f"{first} + {second}", changed, above * below


def _read(subject, written):
    """The form of an edited term, or None where it is outside the class."""
    try:
        return subject.read(written)
    except (NotInClass, ZeroDivisionError):
        return None


def momenta(motion, equation):
    """The parts of the momentum of an equation's coordinate as SymPy expressions, as the kinetic energy prints them, and all of it."""
    if equation.kind != "motion":
        return []
    rate, energy = Symbol("d" + equation.of, real=True), sympify(motion.energies.kinetic(motion.s, motion.m))
    if energy.has(Rate):
        energy = expression(motion.ring.read(energy))
    parts = dict.fromkeys(part.diff(rate) for part in Add.make_args(expand(energy, trig=False)))
    return [part for part in [*parts, sum(parts)] if part != 0 and not part.has(Derivative)]


def _lost(subject, motion, missing):
    """The terms that a form consists of: products that the paper or the energies print elsewhere as one unit stay
    one (the sine of a difference, a sum that has a symbol), the rest falls into its parts."""
    result = []
    for unit in [*subject.units(), *motion.units()]:
        for key in list(missing.terms):
            if key in missing.terms and (form := _multiple(missing, key, unit)):
                result.append(form)
                missing -= form
    return result + _products(subject, missing)


def _products(subject, missing):
    """The parts of a form: two that are the sum and the difference of the angles of one product are that product."""
    result, rest = [], dict(missing.terms)
    while rest:
        key, value = next(iter(rest.items()))
        (monomial, (kind, _)), parts = key, {key: rest.pop(key)}
        same = [k for k in rest if k[0] == monomial and k[1][0] == kind and abs(rest[k]) == abs(value)]
        if len(same) == 1 and _product(key[1], same[0][1]):
            parts[same[0]] = rest.pop(same[0])
        result.append(subject.ring.form(parts))
    return result


def _product(first, second):
    """Whether two harmonics are the sum and the difference of the angles of one product, or of one square: then half the angle is one
    that is printed by whole multiples."""
    if ONE in (first, second):
        return all(Fraction(slope).numerator % 2 == 0 for _, slope in (second if first == ONE else first)[1])
    return True


def _multiple(missing, key, unit):
    """The multiple of a unit that has the part `key` and is contained in what is missing, or None."""
    (monomial, harmonic), value = next(iter(unit.terms.items()))
    if harmonic != key[1]:
        return None
    ring = missing.ring
    ratio = ring.form({(key[0], ONE): Fraction(missing.terms[key]) / value}) * ring.form({(monomial, ONE): 1}).inverse()
    form = unit * ratio
    return form if all(missing.terms.get(k) == v for k, v in form.terms.items()) else None
