"""The walking tank for the peers: its generated C, compiled, and the tables of its modes as C++.

python3 tank.py FOLDER writes walking_tank.c, tank_tables.hpp and libtank.a into the folder. The tables are read
off the Rust tables of the generator, for the variant of the defaults: the one that the scenes take.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def blocks(text, word):
    """The texts between the braces of every `word {` that is not inside another one."""
    found, start = [], 0
    while match := re.compile(rf"\b{word} \{{").search(text, start):
        depth, end = 1, match.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        found.append(text[match.end():end - 1])
        start = end
    return found


def field(name, text):
    """The word or number that follows `name: `."""
    found = re.search(rf"\b{name}: ([-\w.]+)", text)
    if not found:
        raise ValueError(f"the tables of the generator have no `{name}` here: {text[:200]}")
    return found.group(1)


def transition(text):
    condition = re.search(r"condition: Some\(\((\w+), \d+, (\d+)\)\)", text)
    function, count = condition.groups() if condition else ("nullptr", "0")
    return f"{{{field('target', text)}, {field('reset', text)}, {function}, {count}, {field('impact', text)}}}"


def guard(text):
    transitions = ", ".join(transition(t) for t in blocks(text, "Transition"))
    accelerations = "true" if "accelerations: true" in text else "false"
    return f"{{{field('value', text)}, {accelerations}, {{{transitions}}}}}"


def mode(text):
    guards = ",\n    ".join(guard(g) for g in blocks(text, "Guard"))
    rest = re.search(r"\brest: Some\((\d+)\)", text)
    free = re.search(r"free: &\[([\d, ]*)\]", text).group(1)
    head = f"{len(free.split(','))}, {{{free}}}, {field('system', text)}, {field('jacobian', text)}, {rest.group(1) if rest else -1}"
    return f"  {{{head},\n   {{{guards}}}}},"


def tables(rust):
    """The C++ tables of the first variant."""
    variant = blocks(rust, "Variant")[0]
    if "false" in re.search(r"defaults: &\[(.*)\]", variant).group(1):
        raise ValueError("the first variant of the generator is not that of the defaults")
    modes = blocks(variant, "Mode")
    names = ", ".join(re.search(r'name: "(\w+)"', m).group(1).upper() for m in modes)
    rows = [mode(m) for m in modes]
    constants = field("function", rust[rust.index("ConstantsKernel"):])
    functions = sorted(set(re.findall(r"\bdalembert_\w+", "".join(rows))) | {constants})
    declared = blocks(rust[rust.index("parameters: &["):rust.index("parameter_sets: &[")], "Parameter")
    parameters = ", ".join(field("default", p) for p in declared)
    dimensions = [f"constexpr int {what.upper()} = {field(what, rust)};" for what in ("coordinates", "signals", "discretes", "constants", "angles")]
    return "\n".join([
        "// Modes of the walking tank; written by tank.py.", 'extern "C" {', *(f"Function {name};" for name in functions), "}",
        *dimensions, f"constexpr double PARAMETERS[] = {{{parameters}}};", f"constexpr auto &CONSTANTS_OF = {constants};",
        f"enum {{ {names} }};", "inline const Mode MODES[] = {", *rows, "};", ""])


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, "-B", "-m", "codegen", "generate", "--model-dir", "models/walking_tank", "--out", folder], cwd=ROOT, check=True)
    generated = folder / "walking_tank"
    (folder / "tank_tables.hpp").write_text(tables((generated / "model.rs").read_text()))
    compile_c = ["gcc", "-O3", "-march=native", "-fPIC", "-c"]
    subprocess.run([*compile_c, generated / "walking_tank.c", "-o", folder / "walking_tank.o"], check=True)
    # Its error-free sums must not be contracted.
    subprocess.run([*compile_c, "-ffp-contract=off", ROOT / "codegen" / "elementary.c", "-o", folder / "elementary.o"], check=True)
    (folder / "libtank.a").unlink(missing_ok=True)
    subprocess.run(["ar", "rcs", folder / "libtank.a", folder / "walking_tank.o", folder / "elementary.o"], check=True)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
