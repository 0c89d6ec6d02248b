"""What can be wrong with the input of a verification: one base, each with its place where it is known."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Place:
    """Where something stands in a file (empty: in the LaTeX of an equation that Python declares); line and
    column from 1."""

    file: str
    line: int
    column: int

    def __str__(self):
        return f"{self.file + ', ' if self.file else ''}line {self.line}, column {self.column}"


class VerifyError(Exception):
    """Input that cannot be judged; the message says what is wrong, where, and what to do."""

    def __init__(self, message, place=None, excerpt=""):
        super().__init__(f"{place}: {message}" + (f"\n{excerpt}" if excerpt else "") if place else message)
        self.what, self.place = message, place


class PaperError(VerifyError):
    """A paper, correction or energy file that contradicts itself."""


class LatexError(VerifyError):
    """LaTeX that cannot be read, or that can be read in two ways; the message shows where."""


class UnitError(VerifyError):
    """A unit that cannot be read, or a sum or function whose parts do not fit together."""


class NotInClass(VerifyError):
    """An expression that is not a trigonometric polynomial; the message says which part."""
