"""Finds the verification files of a model folder and imports them."""

import importlib
import sys
import types
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, List, Optional

from ..errors import error_location
from .errors import PaperError
from .input.effects import Effects
from .input.manuscript import TEX, is_manuscript, read
from .input.printed import Paper


@dataclass
class Case:
    """All that a model folder offers to verification: `paper.py` (`paper`) or `paper.tex` with `symbols.csv`, `paper_energies.py`
    (`energies`, a list of readings in any order), `corrections.py` (`corrections`, those of one reading, and where there are
    several, `readings`: the corrections of each by its name),
    `paper_numbers.py` (`numbers`) and `paper_effects.py` (`effects`)."""

    name: str
    folder: Path
    paper: object
    energies: List = field(default_factory=list)
    corrections: List = field(default_factory=list)
    numbers: List = field(default_factory=list)
    readings: Dict = field(default_factory=dict)
    effects: object = None


def load(folder, name: Optional[str] = None) -> Case:
    """The case in a model folder. The files may import one another as `.paper`."""
    folder = Path(folder)
    name = name or folder.resolve().name
    written = (folder / "paper.py").is_file()
    if not written and not is_manuscript(folder):
        raise PaperError(f"the model '{name}' has no hand-written equations: neither {folder / 'paper.py'} nor {folder / TEX} exists")
    if written and is_manuscript(folder):
        raise PaperError(f"{folder} has both paper.py and {TEX}: one of them says what is printed")
    printed, derived = None, []
    if not written:
        from .readings.written import written as energies_of

        printed, given = read(folder)
        derived = energies_of(printed, given, folder)
    package = "printed_" + name
    for module in [m for m in sys.modules if m == package or m.startswith(package + ".")]:
        del sys.modules[module]
    parent = types.ModuleType(package)
    parent.__path__ = [str(folder)]
    sys.modules[package] = parent
    importlib.invalidate_caches()

    def offered(file, attribute, fallback, kind=list):
        if not (folder / (file + ".py")).is_file():
            return fallback
        path = folder / (file + ".py")
        try:
            module = importlib.import_module(f"{package}.{file}")
        except PaperError as error:
            raise PaperError(f"{error_location(error, str(path))}: {error}") from error
        except Exception as error:  # whatever a model file does wrong is its author's to read
            raise PaperError(f"{error_location(error, str(path))}: {type(error).__name__}: {error}") from error
        if not hasattr(module, attribute):
            raise PaperError(f"{folder / (file + '.py')} does not define '{attribute}'")
        found = getattr(module, attribute)
        if not isinstance(found, kind):
            raise PaperError(f"{path}: '{attribute}' must be a {kind.__name__}, not {type(found).__name__}")
        return found

    energies = offered("paper_energies", "energies", derived)
    corrections = offered("corrections", "corrections", [])
    readings = offered("corrections", "readings", {}, dict) if hasattr(sys.modules.get(f"{package}.corrections"), "readings") else {}
    if unknown := sorted(readings.keys() - {e.name for e in energies}):
        raise PaperError(f"{folder / 'corrections.py'}: 'readings' has corrections of '{unknown[0]}', which is none of the energies")
    return Case(name, folder, offered("paper", "paper", printed, Paper), list(energies), list(corrections),
                list(offered("paper_numbers", "numbers", [])), dict(readings), offered("paper_effects", "effects", None, Effects))
