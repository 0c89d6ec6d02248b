"""Stands in for `codegen/` in the tests of the build script: it writes as little as is compiled,
and notes in the file PROVISIONING_LOG which models it was run on."""

import argparse
import hashlib
import json
import os
import sys

import casadi  # as the generator does

parser = argparse.ArgumentParser()
parser.add_argument("--directory", required=True)
parser.add_argument("command", choices=["generate"])
parser.add_argument("--model-dir", required=True)
parser.add_argument("--name")
parser.add_argument("--out", required=True)
parser.add_argument("--for-tests", action="store_true")
parser.add_argument("--owner", required=True)
arguments = parser.parse_args()
os.chdir(arguments.directory)

name = os.path.basename(arguments.model_dir)
with open(os.environ["PROVISIONING_LOG"], "a") as log:
    log.write(f"generate {name}{' for tests' * arguments.for_tests}\n")
with open(os.path.join(arguments.model_dir, "model.py")) as stream:
    model = stream.read().strip()
if model == "fault":
    sys.exit(f"error: {arguments.model_dir}/model.py:1: the model has a fault")
if model == "crash":
    raise RuntimeError("the generator has a fault")

text = f"double dalembert_{arguments.owner}{name}(void) {{ return {model}; }}\n"
tables = "const int DALEMBERT_SYMBOL = sizeof DALEMBERT_DIGEST;\n"
manifest = {"name": name, "tables": f"{name}_model.c", "sources": [f"{name}.c"], "lanes": [],
            "content": hashlib.sha256((text + tables).encode()).hexdigest()}
files = {f"{name}.c": text, f"{name}_model.c": tables, "manifest.json": json.dumps(manifest)}
folder = os.path.join(arguments.out, name)
os.makedirs(folder)
for file, text in files.items():
    with open(os.path.join(folder, file), "w") as stream:
        stream.write(text)
