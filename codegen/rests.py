"""Rests that need no declaration: where infinitely many impacts at a stop end.

Such impacts bring their coordinate to rest at the stop. Where a model has one mode that holds what the mode of the impacts holds, and that
coordinate there besides, the motion goes on in it. All else that may come to rest (slip that dies with the impacts, switches without an
impact) is for the model to say.
"""

import casadi as ca

from .contacts import as_line


def add(model):
    """Adds them behind those that are declared, of a model whose modes are written by hand."""
    if model.contacts or model.constraints:
        return
    for transition in model.transitions:
        source = transition.source
        if not transition.impact or transition.target is not source:
            continue
        stop = as_line(model, transition.guard, False)
        if stop is None or stop.name in source.held:
            continue
        targets = [mode for mode in model.modes if mode.held.keys() == source.held.keys() | {stop.name} and _rests(mode, source, stop)]
        if len(targets) == 1 and (source, targets[0]) not in model.rests:
            model.rests.append((source, targets[0]))


def _rests(mode, source, stop):
    """Whether a mode holds the coordinate at the stop, and all else as the other mode does."""
    return _same(mode.held[stop.name], stop.value()) and all(_same(mode.held[name], value) for name, value in source.held.items()) \
        and not mode.drift.keys() - source.drift.keys()


def _same(one, other):
    """Whether two places where a coordinate is held are the same."""
    if one is None or other is None:  # wherever it was
        return one is other
    return ca.simplify(ca.SX(one) - ca.SX(other)).is_zero()
