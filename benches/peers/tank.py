"""The walking tank for the peers: its generated C, compiled, and the tables of its modes as C++.

python3 tank.py FOLDER writes the generated files, tank_tables.hpp and libtank.a into the folder. The tables are read
off the description of the model, for the variant of the defaults: the one that the scenes take.
"""

import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def transition(of, names):
    condition = of["condition"] or {"function": None, "count": 0}
    function = "nullptr" if condition["function"] is None else names[condition["function"]]
    impact = str(of["impact"]).lower()
    return f"{{{of['target']}, {names[of['reset']]}, {function}, {condition['count']}, {impact}}}"


def guard(of, names):
    transitions = ", ".join(transition(t, names) for t in of["transitions"])
    accelerations = str(of["shape"].get("general", {}).get("accelerations", False)).lower()
    return f"{{{names[of['guard']]}, {accelerations}, {{{transitions}}}}}"


def mode(index, of, rests, names):
    guards = ",\n    ".join(guard(g, names) for g in of["guards"])
    rest = next((r["target"] for r in rests if r["source"] == index), -1)
    free, kernel = of["free"], of["kernel"]
    head = f"{len(free)}, {{{', '.join(map(str, free))}}}, {names[kernel['system']]}, {names[kernel['jacobian']]}, {rest}"
    return f"  {{{head},\n   {{{guards}}}}},"


def tables(description, names):
    """The C++ tables of the first variant, from the description of the model and the names of its functions by their places."""
    variant = description["variants"][0]
    if not all(variant["defaults"]):
        raise ValueError("the first variant of the generator is not that of the defaults")
    rows = [mode(i, m, variant["rests"], names) for i, m in enumerate(variant["modes"])]
    constants = names[description["constants"]["function"]]
    functions = sorted(set(re.findall(r"\bdalembert_\w+", "".join(rows))) | {constants})
    parameters = ", ".join(repr(p["default"]) for p in description["parameters"])
    dimensions = [f"constexpr int {what.upper()} = {description['dimensions'][what]};"
                  for what in ("coordinates", "signals", "discretes", "constants", "angles")]
    return "\n".join([
        "// Modes of the walking tank; written by tank.py.", 'extern "C" {', *(f"Function {name};" for name in functions), "}",
        *dimensions, f"constexpr double PARAMETERS[] = {{{parameters}}};", f"constexpr auto &CONSTANTS_OF = {constants};",
        f"enum {{ {', '.join(m['name'].upper() for m in variant['modes'])} }};", "inline const Mode MODES[] = {", *rows, "};", ""])


def functions_of(table):
    """The names of a model's functions, in the order of the table in its C."""
    return re.search(r"\bvalues\[\] = \{([^}]*)\}", table).group(1).replace(",", " ").split()


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, "-B", "-m", "codegen", "generate", "--model-dir", "models/walking_tank", "--out", folder, "--only"], cwd=ROOT, check=True)
    generated = folder / "walking_tank"
    manifest = json.loads((generated / "manifest.json").read_text())
    description = json.loads((generated / "description.json").read_text())
    names = functions_of((generated / manifest["tables"]).read_text())
    (folder / "tank_tables.hpp").write_text(tables(description, names))
    compile_c = ["gcc", "-O3", "-march=native", "-fPIC", f"-I{ROOT / 'codegen'}", "-c"]
    objects = []
    for source in manifest["sources"]:
        objects.append(folder / f"{source}.o")
        subprocess.run([*compile_c, generated / source, "-o", objects[-1]], check=True)
    # Its error-free sums must not be contracted.
    objects.append(folder / "elementary.o")
    subprocess.run([*compile_c, "-ffp-contract=off", ROOT / "codegen" / "elementary.c", "-o", objects[-1]], check=True)
    (folder / "libtank.a").unlink(missing_ok=True)
    subprocess.run(["ar", "rcs", folder / "libtank.a", *objects], check=True)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
