"""Which files a model read, besides those of the generator and of Python itself: what is made from it depends on them."""

import json
import os
import sys

_READ = set()


def watch():
    """Notes from now on what is opened."""
    sys.addaudithook(lambda event, arguments: _note(*arguments[:2]) if event == "open" else None)


def _note(path, mode):
    if isinstance(path, (str, bytes)) and (mode is None or "r" in mode):
        _READ.add(os.path.abspath(os.fsdecode(path)))


def listed(folder):
    """JSON: the files, relative to the model folder where they are in it. Its own Python files are known to matter."""
    real = os.path.realpath
    modules = [m.__file__ for m in list(sys.modules.values()) if isinstance(getattr(m, "__file__", None), str)]
    packages = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    own = [real(p) for p in (sys.prefix, sys.base_prefix, os.path.dirname(__file__), *packages, "/dev", "/proc", "/sys") if p]
    folder, found = real(folder), set()
    for path in map(real, _READ | set(modules)):
        inside = path.startswith(folder + os.sep)
        skipped = any(path.startswith(p + os.sep) for p in own) or path.endswith(".pyc") or not os.path.isfile(path)
        if inside and not path.endswith(".py") or not inside and not skipped:
            found.add(os.path.relpath(path, folder) if inside else path)
    return json.dumps(sorted(path for path in found if not path.endswith(".pyc"))) + "\n"
