"""Runs of a model file, one for each combination of its choices."""

import os
import sys
import types

from . import reduced, rests
from .errors import Contradiction, ModelError


class BuildContext:
    """One run of a model file: its name, and the options of the choices made so far."""

    def __init__(self, name, file, options):
        self.name, self.file, self.options = name, file, options
        self.open, self.model = [], None

    def choose(self, name, options):
        if name not in self.options:
            self.options[name] = options[0]
            self.open.append((name, options[1:]))
        return self.options[name]


CONTEXT = []


def build(name, file, source, run=exec):
    """Runs a model file (its text) for every combination of choices; returns the models. `run` runs its code."""
    package = _package(name, os.path.dirname(file))
    code = compile(source, file, "exec")
    models, pending = [], [{}]
    while pending:
        context = BuildContext(name, file, dict(pending.pop(0)))
        CONTEXT.append(context)
        path = list(sys.path)
        try:
            run(code, {"__name__": package, "__package__": package, "__file__": file})
        finally:
            CONTEXT.pop()
            sys.path[:] = path
        if context.model is None:
            raise ModelError("no Model(…) is made here", file)
        try:
            reduced.expand(context.model)
            rests.add(context.model)
            models.append(context.model)
        except Contradiction:
            # What a scene holds for good may contradict itself where what is declared does not: then the model does not offer it.
            if not any(contact.permanent for contact in context.model.contacts):
                raise
        made = dict(context.options)
        for choice, others in context.open:
            prefix = {}
            for key, value in made.items():
                if key == choice:
                    break
                prefix[key] = value
            pending += [{**prefix, choice: other} for other in others]
    return models


def _package(name, folder):
    """The package whose modules are the files of a model folder, wherever it is: `from .paper import paper` in a model file."""
    parent = sys.modules.setdefault("models", types.ModuleType("models"))
    parent.__path__ = []
    package = f"models.{name}"
    for module in [m for m in sys.modules if m == package or m.startswith(package + ".")]:
        del sys.modules[module]
    sys.modules[package] = types.ModuleType(package)
    sys.modules[package].__path__ = [folder]
    return package
