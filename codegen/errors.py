"""Errors of a model file: what is wrong, where, and what to do."""

import os
import traceback


class ModelError(Exception):
    """A model cannot be turned into code; the message is for the author of the model."""

    def __init__(self, message, location=None):
        super().__init__(message)
        self.message = message
        self.location = location

    def __str__(self):
        return f"{self.location}: {self.message}" if self.location else self.message


def caller_location(model_file):
    """`file:line` of the innermost frame of `model_file` on the stack, or None."""
    for frame in reversed(traceback.extract_stack()):
        if frame.filename == model_file:
            return f"{display_path(frame.filename)}:{frame.lineno}"
    return None


def error_location(error, model_file):
    """`file:line` of the innermost frame of `model_file` in the traceback of `error`."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{display_path(error.filename)}:{error.lineno}"
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        if frame.filename == model_file:
            return f"{display_path(frame.filename)}:{frame.lineno}"
    return display_path(model_file)


def display_path(path):
    """A path as the author knows it: relative to the working directory where that is shorter."""
    relative = os.path.relpath(path)
    return path if relative.startswith("..") else relative
