"""What a report consists of: blocks, which html.py and tex.py write each in its own way. Sentences are lists of parts (words.py),
which may also be links and emphasis."""

from dataclasses import dataclass, field
from typing import Dict, List, Optional


@dataclass(frozen=True)
class Link:
    """Words that lead to an anchor of the report."""

    words: str
    target: str


@dataclass(frozen=True)
class Strong:
    """Words in bold type."""

    words: str


@dataclass
class Heading:
    """A heading of a level, from 1 (that of the report)."""

    words: str
    level: int = 2
    anchor: str = ""


@dataclass
class Paragraph:
    """A sentence; `style` is empty, faint, good or bad."""

    parts: list
    style: str = ""


@dataclass
class Items:
    """A list of sentences, each with its style."""

    items: List[Paragraph]


@dataclass
class Table:
    """Rows of cells, each a sentence; `widths` are parts of the width of the page."""

    head: List[str]
    rows: List[List[list]]
    widths: List[float] = field(default_factory=list)


@dataclass
class Display:
    """An equation as printed, by its tree, with styles of terms by ordinal."""

    tree: object
    marks: Dict[int, str]


@dataclass
class Terms:
    """Printed terms above consistent ones: pairs (aligned.py) after `lead`, the LaTeX of a symbol (or nothing) and words, and
    before `tail`, words; `anchors` those of all findings."""

    pairs: list
    lead: tuple
    tail: str
    anchors: List[str]


@dataclass
class Card:
    """A finding."""

    style: str
    title: str
    anchor: str
    blocks: list


@dataclass
class PageBreak:
    """The end of a printed page."""


@dataclass
class Document:
    """A report: its title, what stands in the head of a page, and its blocks."""

    title: str
    name: str
    blocks: list
    paper: object = field(repr=False)
    subtitle: Optional[str] = None


class Writer:
    """Blocks as lines of text in one format: a method for each kind of block, by its name in small letters, and `part`."""

    def __init__(self, paper):
        self.paper = paper

    def written(self, found):
        """The lines of blocks."""
        return [line for block in found for line in getattr(self, type(block).__name__.lower())(block)]

    def sentence(self, parts):
        """The text of a sentence."""
        return "".join(map(self.part, parts))
