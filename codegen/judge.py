"""Judges a model without generating code: all errors that are independent of each other, and what its modes are."""

import ast
import contextlib
import multiprocessing
import os
import sys

import casadi as ca

from . import check, contact_outputs, dimensions, generate, momentum
from .context import build
from .errors import Location, ModelError, collected, error_location, report, split


def judge(folder, name=None):
    """The judgement as data for JSON: model, ok, errors, and for a model without errors its modes."""
    result = {"model": name or os.path.basename(os.path.abspath(folder)), "ok": False, "errors": [], "modes": [], "contacts": [], "variants": []}
    # Whatever the model file prints is not the answer.
    with contextlib.redirect_stdout(sys.stderr), collected() as errors:
        models = generate.load(folder, name, _build)
        if not errors:
            variants = _variants(models)
    result["errors"] = _unique([_error(error) for error in errors])
    result["ok"] = not errors
    if not errors:
        result["variants"] = variants
        default = next((v for v in variants if all(v["defaults"])), variants[0])
        result["modes"], result["contacts"] = default["modes"], default["contacts"]
    return result


def _unique(errors):
    """Without repetitions, in the order of their lines: the file is run once a combination of choices."""
    errors = [e for k, e in enumerate(errors) if e not in errors[:k]]
    return sorted(errors, key=lambda e: (e["line"] or 0, e["column"] or 0))


def _error(error):
    where = error.location if isinstance(error.location, Location) else Location(error.location or "")
    message, to_do = split(error.message)
    return {"file": where.file, "line": where.line, "column": where.column, "end_column": where.end_column, "message": message,
            "help": to_do}


# ---- the model file -----------------------------------------------------------------------------


def _build(name, file, source):
    """As `context.build`, going on after a statement that fails; what follows from its failure is not reported."""
    tree = ast.parse(source, file)

    def run(_, scope):
        lost = set()
        for statement in tree.body:
            try:
                exec(compile(ast.Module([statement], []), file, "exec"), scope)
            except Exception as error:
                if not _follows(error, lost):
                    report(generate.as_model_error(error, file))
                lost |= _names(statement)

    try:
        return build(name, file, source, run)
    except ModelError as error:
        # Without a model nothing else can be said.
        report(error)
        return []


_DECLARE = ("parameter", "coordinate", "ground", "input", "discrete", "mode", "choice")
"""Methods whose first argument is the name of what they declare."""


def _names(statement):
    """What a statement would have declared: variables, and what later messages would call it."""
    names = set()
    for node in ast.walk(statement):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.alias):
            names.add((node.asname or node.name).split(".")[0])
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in _DECLARE:
            names.update(a.value for a in node.args[:1] if isinstance(a, ast.Constant) and isinstance(a.value, str))
    return names


def _follows(error, lost):
    """Whether an error is about something that an earlier one kept from being declared."""
    text = str(error)
    return any(f"`{name}`" in text or isinstance(error, NameError) and f"'{name}'" in text for name in lost)


# ---- the model ----------------------------------------------------------------------------------


def _variants(models):
    generate.check_same_declarations(models)
    found = []
    for errors, variant in _side_by_side(_judge, models):
        for error in errors:
            report(error)
        found += [variant] if variant else []
    return found


def _judge(model):
    """The errors of a combination of choices, or what it is."""
    with collected() as errors:
        check.check(model)
        dimensions.check(model)
        if not errors:
            momentum.check(model)
        if not errors:
            variant = _variant(model, generate.derive_variant(model))
    return errors, None if errors else variant


def _side_by_side(function, arguments):
    """A function of each argument, by a process each where the system can copy this one: expressions cannot be sent."""
    if len(arguments) < 2 or "fork" not in multiprocessing.get_all_start_methods():
        return [function(argument) for argument in arguments]
    context = multiprocessing.get_context("fork")
    _WORK[:] = [function, arguments]
    with context.Pool(min(len(arguments), os.cpu_count() or 1)) as pool:
        return pool.map(_work, range(len(arguments)), chunksize=1)


_WORK = []


def _work(k):
    function, arguments = _WORK
    return function(arguments[k])


def _variant(model, variant):
    defaults = [c[3] == c[4] for c in model.choices]
    return {
        "options": {c[0]: c[3] for c in model.choices}, "defaults": defaults, "contacts": contact_outputs.described(model),
        "modes": [_mode(variant, i, equations, all(defaults)) for i, equations in enumerate(variant.modes)]}


def _mode(variant, i, equations, counts):
    """A mode; with the operations of its functions if they are to be counted, which takes longer than the derivation."""
    coordinates = variant.model.coordinates
    mode = {
        "name": equations.mode.name,
        "free": [coordinates[k].name for k in equations.free if "multiplier" not in coordinates[k].extra],
        # Those of a mode of all sets of contact states have no transitions.
        "guards": [" / ".join(dict.fromkeys(t.name for t in transitions)) for _, transitions in equations.guards if transitions]}
    if counts:
        functions = {slot: f for slot, f in variant.functions.items() if slot[0] == i}
        mode["operations"] = {" ".join(map(str, slot[1:])): _operations(f.output) for slot, f in functions.items()}
    return mode


def _operations(output):
    """Operations of a function, as the emission counts them."""
    function = ca.Function("count", ca.symvar(output), [ca.cse(output)])
    uncounted = (ca.OP_CONST, ca.OP_INPUT, ca.OP_OUTPUT)
    return sum(function.instruction_id(k) not in uncounted for k in range(function.n_instructions()))
