"""The terms of a printed equation beside those of the consistent one, each with the findings that it belongs to."""

from dataclasses import dataclass, field
from typing import List


@dataclass
class Pair:
    """A printed term above the term that stands for it (None: there is none), with the findings, as their places in the report
    from 1, that make the difference."""

    printed: object
    consistent: object
    findings: List[int] = field(default_factory=list)

    def changed(self):
        """Whether the two differ."""
        return self.printed is None or self.consistent is None or self.printed != self.consistent


def aligned(report, number):
    """The pairs of one equation, in printed order and then what is not printed. Terms that a slip moves into another place stand
    where it has put them."""
    before, after = report.printed.forms[number], list(report.corrected.forms[number])
    found = [(k, f) for k, f in enumerate(report.findings, 1)
             if f.equation == number and f.kind not in ("objection", "principle", "undefined")]
    whole = any(c.equation == number and c.whole for c in report.case.corrections) if report.by_hand else any(
        len(f.ordinals) > 1 or f.ordinals and len(f.consistent) > 1 for _, f in found)
    if whole:
        return _matched(before, after, [k for k, _ in found])
    pairs = []
    for ordinal, form in enumerate(before):
        changed = [(k, f) for k, f in found if ordinal in f.ordinals]
        gone = any(_struck(report, f, ordinal) for _, f in changed)
        pairs.append(Pair(form, None if gone else after.pop(0), [k for k, _ in changed]))
    for form in after:
        pairs.append(Pair(None, form, [k for k, f in found if form in f.consistent]))
    return pairs


def _struck(report, finding, ordinal):
    """Whether the consistent equation has no term in the place of a printed one."""
    if not report.by_hand:
        return not finding.consistent
    return any((c.terms or {}).get(ordinal + 1, c) is None for c in report.case.corrections if c.key == finding.key)


def _matched(before, after, findings):
    """Pairs of an equation that is written anew: equal terms beside each other, the others by themselves."""
    rest, pairs = list(after), []
    for form in before:
        same = form in rest
        if same:
            rest.remove(form)
        pairs.append(Pair(form, form if same else None, [] if same else findings))
    return pairs + [Pair(None, form, findings) for form in rest]
