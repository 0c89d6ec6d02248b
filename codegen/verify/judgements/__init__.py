"""The judgements on printed equations; numbers.py judges printed numbers.

Each takes a `Subject` and returns its violations. Each is exact: a violation is a non-zero
normal form (of the sixth, a proof that a minor is not positive), and none means that the identity is
proved, where the judgement has something to judge by: `unjudged` says where it has not.
"""

from .definite import definite
from .difference import difference
from .dimensions import dimensions
from .galilei import galilei
from .helmholtz import lagrangian
from .mirror import mirror

TITLES = {
    "dimensions": "Dimensions of each term",
    "lagrangian": "Symmetric mass matrix and Helmholtz conditions",
    "difference": "Term by term against the energies",
    "mirror": "Mirror symmetry",
    "galilei": "Galilean invariance",
    "definite": "Positive definite kinetic energy at rest",
}

FIVE = {"dimensions": dimensions, "lagrangian": lagrangian, "difference": difference, "mirror": mirror, "galilei": galilei}
JUDGEMENTS = {**FIVE, "definite": definite}


def unjudged(subject, motion):
    """For each judgement that has nothing to judge by, why: its silence says nothing."""
    paper, reasons = subject.paper, {}
    if not paper.motions():
        reasons["lagrangian"] = reasons["definite"] = "there are no equations of motion"
        if any(equation.momentum for equation in paper.equations.values()):
            del reasons["lagrangian"]
    elif subject.solved:
        reasons["lagrangian"] = reasons["definite"] = "the equations are solved for the accelerations, and show no mass matrix"
    elif not paper.sets:
        reasons["definite"] = "the paper has no parameter sets"
    if motion is None:
        reasons["difference"] = "no energies are given"
    elif all(motion.reference(equation) is None for equation in paper.equations.values()):
        reasons["difference"] = "the energies say nothing about any equation"
    if all(symbol.mirror == 1 for symbol in paper.symbols.values()):
        reasons["mirror"] = "no symbol is declared to change its sign in the mirror image"
    if paper.translation is None:
        reasons["galilei"] = "no translation is declared"
    return reasons


def unreferenced(subject, motion):
    """Numbers of the equations that the energies say nothing about."""
    return [n for n, equation in subject.paper.equations.items() if motion is None or motion.reference(equation) is None]
