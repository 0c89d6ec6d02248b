"""Writes a wheel that stands in for CasADi and prints its SHA-256. The only module tells its
version, and notes in the file PROVISIONING_LOG that it was installed: the installation is the one
time that it is imported with bytecode being written.

Usage: wheel.py FOLDER VERSION"""

import hashlib
import os
import sys
import zipfile

folder, version = sys.argv[1:]
module = f"""
import os, sys
__version__ = "{version}"
if not sys.dont_write_bytecode:
    with open(os.environ["PROVISIONING_LOG"], "a") as log:
        log.write("install\\n")
"""
info = f"casadi-{version}.dist-info"
files = {
    "casadi/__init__.py": module,
    f"{info}/METADATA": f"Metadata-Version: 2.1\nName: casadi\nVersion: {version}\n",
    f"{info}/WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
}
files[f"{info}/RECORD"] = "".join(f"{name},,\n" for name in [*files, f"{info}/RECORD"])
path = os.path.join(folder, f"casadi-{version}-py3-none-any.whl")
with zipfile.ZipFile(path, "w") as wheel:
    for name, text in files.items():
        wheel.writestr(name, text)
with open(path, "rb") as stream:
    print(hashlib.sha256(stream.read()).hexdigest())
