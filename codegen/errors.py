"""Errors of a model file: what is wrong, where, and what to do."""

import itertools
import os
import re
import sys


class ModelError(Exception):
    """A model cannot be turned into code; the message is for the author of the model."""

    def __init__(self, message, location=None):
        super().__init__(message)
        self.message = message
        self.location = location

    def __str__(self):
        return f"{self.location}: {self.message}" if self.location else self.message


class Contradiction(ModelError):
    """What the model holds contradicts itself."""


class Location(str):
    """`file:line`, with the columns of what is meant there where Python knows them, counted from 1; the end is past it."""

    line, column, end_column = None, None, None

    @property
    def file(self):
        """The file as the author knows it."""
        return self[:-len(f":{self.line}")] if self.line else str(self)


def location(file, line, column=None, end_column=None):
    """A location; columns are those of characters."""
    result = Location(f"{display_path(file)}:{line}")
    result.line, result.column, result.end_column = line, column, end_column
    return result


def caller_location(model_file):
    """The innermost frame of `model_file` on the stack, or None."""
    frame = sys._getframe(1)
    while frame is not None:
        if frame.f_code.co_filename == model_file:
            return _location_in(frame.f_code, frame.f_lineno, frame.f_lasti)
        frame = frame.f_back
    return None


def error_location(error, model_file):
    """The innermost frame of `model_file` in the traceback of `error`."""
    if isinstance(error, SyntaxError) and error.filename:
        return location(error.filename, error.lineno, error.offset, error.offset and error.offset + 1)
    found, trace = Location(display_path(model_file)), error.__traceback__
    while trace is not None:
        code = trace.tb_frame.f_code
        if code.co_filename == model_file:
            found = _location_in(code, trace.tb_lineno, trace.tb_lasti)
        trace = trace.tb_next
    return found


def _location_in(code, line, instruction):
    """The place of an instruction; Python knows columns since 3.11."""
    if not hasattr(code, "co_positions"):
        return location(code.co_filename, line)
    _, last, start, end = next(itertools.islice(code.co_positions(), instruction // 2, None))
    if start is None:
        return location(code.co_filename, line)
    text = _line(code.co_filename, line)
    characters = lambda offset: len(text[:offset].decode("utf-8", "replace"))
    return location(code.co_filename, line, characters(start) + 1, characters(end if last == line else len(text)) + 1)


def _line(file, number):
    """A line as bytes, in which Python counts columns."""
    try:
        with open(file, "rb") as stream:
            return stream.read().splitlines()[number - 1]
    except (OSError, IndexError):
        return b""


def display_path(path):
    """A path as the author knows it: relative to the working directory where that is shorter."""
    relative = os.path.relpath(path)
    return path if relative.startswith("..") else relative


# ---- all errors at once -------------------------------------------------------------------------

_COLLECTED = []
"""The list that takes the errors, innermost last; without one the first error ends the run."""


class collected:
    """Within it independent errors are listed, and do not end the run."""

    def __enter__(self):
        self.errors = []
        _COLLECTED.append(self.errors)
        return self.errors

    def __exit__(self, kind, error, trace):
        _COLLECTED.pop()
        if isinstance(error, ModelError):
            self.errors.append(error)
            return True
        return False


def report(error):
    """An error after which other checks still make sense."""
    if not _COLLECTED:
        raise error
    _COLLECTED[-1].append(error)


def each(check, items):
    """Checks items of which none depends on another."""
    for item in items:
        try:
            check(item)
        except ModelError as error:
            report(error)


_TO_DO = re.compile(r"[:;,] (?:so )?((?:add|calculate|choose|declare|freeze|give|leave|let|make|name|put|remove|rename|say|set|state|take|use|write)"
                    r" .*)", re.DOTALL)
_OF_PYTHON = re.compile(r"[A-Z]\w*(Error|Exception): ")


def split(message):
    """(what is wrong, what to do): messages say them in this order, and the second is an imperative. It may be missing."""
    found = None if _OF_PYTHON.match(message) else _TO_DO.search(message)
    return (message[:found.start()], found.group(1)) if found else (message, "")
