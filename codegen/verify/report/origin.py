"""What a report is of: the version of the program, the date, and the digests of the files that were read."""

import hashlib
import os
import sys
from datetime import datetime, timezone
from pathlib import Path

from ... import VERSION


def origin(case):
    """(version, date, {name: SHA-256}) of a case: of all its files in the model folder that were read. The date is that of
    SOURCE_DATE_EPOCH where this variable is set, so that a report can be made again bit for bit."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    now = datetime.fromtimestamp(int(epoch), timezone.utc) if epoch.isdecimal() else datetime.now(timezone.utc)
    package = f"printed_{case.name}."
    folder = case.folder.resolve()
    read = {Path(module.__file__).resolve() for name, module in list(sys.modules.items()) if name.startswith(package) and getattr(module, "__file__", None)}
    read |= {path for name in ("paper.tex", "symbols.csv") if (path := folder / name).is_file()}
    files = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(read) if path.parent == folder}
    return VERSION, now.date().isoformat(), files
