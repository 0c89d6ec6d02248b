"""From a difference to repairs: the smallest edits of the printed terms with which an equation is
what the energies give. Every set of repairs is exact: with all of them the difference is zero."""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import List, Tuple

from sympy import sympify

from ..errors import NotInClass
from ..judgements.comparison import compare
from ..normal.algebra import ONE, expression

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
            found = _search(subject, number, difference * comparison.weight)
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


def _search(subject, number, difference):
    """The repairs for a difference of printed and derived."""
    forms, terms, found = subject.forms[number], subject.expressions[number], []
    open_terms = set(range(len(forms)))
    for depth in (SINGLE, DOUBLE):
        while difference:
            choice = _best(subject, forms, terms, open_terms, difference, depth)
            if choice is None:
                break
            k, slip, form, written = choice
            found.append(Repair((k,), slip, [forms[k]], [form], [written]))
            difference += form - forms[k]
            open_terms.discard(k)
    for k in sorted(open_terms):
        # what is left of a term that differs, coefficient by coefficient
        wrong = subject.ring.form({key: difference.terms[key] for key in forms[k].terms if key in difference.terms})
        if wrong:
            form = forms[k] - wrong
            found.append(Repair((k,), "other" if form else "surplus term", [forms[k]], [form] if form else [],
                                [expression(form)] if form else []))
            difference -= wrong
    for form in _lost(subject, -difference):
        found.append(Repair((), "lost term", [], [form], [expression(form)]))
    return sorted(found, key=lambda r: r.ordinals or (len(forms),))


def _best(subject, forms, terms, open_terms, difference, depth):
    """The edit of one term that removes most of the difference and adds nothing to it, or None."""
    best = None
    for k in sorted(open_terms):
        if not forms[k].terms.keys() & difference.terms.keys():
            continue
        for rank, (slip, form, written) in enumerate(_candidates(subject, forms[k], terms[k], difference, depth)):
            left = difference + form - forms[k]
            # the edited term must agree, and nothing else may differ for it
            if not form or form.terms.keys() & left.terms.keys() or left.terms.keys() - difference.terms.keys():
                continue
            gain = len(difference.terms) - len(left.terms)
            order = (-gain, slip == "number", rank)
            if best is None or order < best[0]:
                best = (order, (k, slip, form, written))
    return best and best[1]


def _candidates(subject, form, term, difference, depth):
    """(slip, form, expression) of the edits of a term."""
    editor = subject.editor
    singles = editor.edits(term)
    if depth == SINGLE:
        for slip, written in singles:
            if (changed := _read(subject, written)) is not None:
                yield slip, changed, written
        for key, value in form.terms.items():
            if key in difference.terms:
                ratio = 1 - Fraction(difference.terms[key]) / value
                yield "number", form * ratio, term * sympify(ratio)
        return
    for first, between in singles:
        for second, written in editor.edits(between):
            if (changed := _read(subject, written)) is not None:
                yield f"{first} + {second}", changed, written


def _read(subject, written):
    """The form of an edited term, or None where it is outside the class."""
    try:
        return subject.read(written)
    except (NotInClass, ZeroDivisionError):
        return None


def _lost(subject, missing):
    """The terms that a form consists of: products that the paper prints elsewhere as one unit stay
    one (the sine of a difference), the rest falls into its parts."""
    result = []
    for unit in subject.units():
        for key in list(missing.terms):
            if key in missing.terms and (form := _multiple(missing, key, unit)):
                result.append(form)
                missing -= form
    return result + [subject.ring.form({key: value}) for key, value in missing.terms.items()]


def _multiple(missing, key, unit):
    """The multiple of a unit that has the part `key` and is contained in what is missing, or None."""
    (monomial, harmonic), value = next(iter(unit.terms.items()))
    if harmonic != key[1]:
        return None
    ring = missing.ring
    ratio = ring.form({(key[0], ONE): Fraction(missing.terms[key]) / value}) * ring.form({(monomial, ONE): 1}).inverse()
    form = unit * ratio
    return form if all(missing.terms.get(k) == v for k, v in form.terms.items()) else None
