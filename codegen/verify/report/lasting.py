"""Names of findings that last: where equations are numbered anew, or other findings come and go, a file of waivers still fits."""

import hashlib


def lasting(findings, paper):
    """{id: lasting name} of findings on equations: what the equation is, and the first digits of SHA-256 of what is printed there and of the
    slip, or of the objections. Whoever prints something else gets another name. Of the same slip in the same term of two equations that are
    the same the second has a number behind its name. Findings that are of no equation have names that last already."""
    names, used = {}, {}
    for finding in findings:
        numbers = [n for n in finding.equation.split(", ") if n in paper.equations]
        if not numbers:
            continue
        said = [finding.kind, finding.slip, *sorted(finding.judgements if finding.kind == "objection" else ()), *map(str, finding.printed)]
        digest = hashlib.sha256("\n".join(said).encode()).hexdigest()[:8]
        name = " and ".join(what(paper.equations[n]) for n in numbers) + " " + digest
        used[name] = used.get(name, 0) + 1
        names[finding.key] = name if used[name] == 1 else f"{name}, {used[name]}"
    return names


def what(equation):
    """What an equation is, as manuscripts call those without a number."""
    return f"{'reaction' if equation.momentum else equation.kind} of {equation.of}"
