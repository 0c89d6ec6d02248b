"""The order of findings: what weighs most comes first."""

# what is wrong in every reading, then what depends on one, then what is no slip
KINDS = ("misprint", "repair", "objection", "principle", "approximation", "choice", "undefined")


def ranked(findings):
    """Findings by what they are: on equations before those of the text, then by kind. Of one kind those come first that change simulated scenes
    most, then those whose terms are of the lowest degree in the coordinates, which weigh most in small motions, then those that most
    judgements find; what is equal stays in printed order."""
    return sorted(findings, key=lambda f: (f.equation == "text", KINDS.index(f.kind), -_effect(f), float("inf") if f.order is None else f.order,
                                           -len(f.judgements)))


def _effect(finding):
    """The largest relative change of a quantity in a scene; of a run that stops early, more than any."""
    largest = 0.0
    for effect in finding.effects.values():
        for name in effect["changes"]:
            if name == "stopped":
                return float("inf")
            before, after = effect["without"][name], effect["with"][name]
            largest = max(largest, abs(after - before) / max(abs(after), abs(before)))
    return largest
