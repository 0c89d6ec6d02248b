"""The signals of a model's inputs as columns of symbols: values, rates, and radii within which they stay."""

import casadi as ca


def of(model):
    """The signals of all inputs."""
    return ca.vertcat(*[s for i in model.inputs for s in i.signals])


def rates(model):
    """Their rates."""
    return _beside(model, "dot")


def radii(model):
    """Radii within which they stay."""
    return _beside(model, "radius")


def _beside(model, what):
    """A symbol for each signal: always the same ones."""
    names = [f"{i.name}.signal{k}.{what}" for i in model.inputs for k in range(len(i.signals))]
    return model.__dict__.setdefault(f"_signals_{what}", ca.vertcat(*[ca.SX.sym(name) for name in names]))
