"""Time, generated C and build time of models over the number n of free coordinates.

    python3 tools/sizes.py PACKAGES SCRATCH model:n …

PACKAGES is the folder with the Python packages of the generator; SCRATCH a folder for what is built and for rows.jsonl, to
which a row is added for each model (`link_chain`, `spring_chain`) and n that is not there yet. Then it prints the table of docs/notes/sizes.md from all
rows and draws docs/notes/sizes.svg. It runs target/release/dalembert. Times but those of steps are of all processors.
"""

import json
import math
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CHOICES = {"link_chain": "links", "spring_chain": "masses"}
COLUMNS = {"generate_s": "derive / s", "compile_s": "compile / s", "c_bytes": "C / kB",
           "taylor_us_per_step": "Taylor step / µs", "radau_us_per_step": "Radau step / µs"}


def processor_time(command, **options):
    """Standard output, and seconds of processor time of a command and what it starts."""
    before = os.times()
    done = subprocess.run(command, capture_output=True, text=True, check=True, **options)
    after = os.times()
    return done.stdout, sum(after[2:4]) - sum(before[2:4])


def measure(packages, scratch, model, n):
    folder = os.path.join(scratch, f"{model}_{n}")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(ROOT, "tests/models", model, "model.py"), encoding="utf-8") as stream:
        text = re.sub(r"^N = \d+", f"N = {n}", stream.read(), flags=re.M)
    with open(os.path.join(folder, "model.py"), "w", encoding="utf-8") as stream:
        stream.write(text)
    scene = {"model": "./", "end": 10.0, CHOICES[model]: str(n), "record": {"every": 10.0}}
    if model == "link_chain":
        scene["initial"] = {f"theta_{k}": 1.0 for k in range(1, n + 1)}
    else:
        scene["parameters"] = {"k_3": 1e4}
    path = os.path.join(folder, "scene.json")
    with open(path, "w", encoding="utf-8") as stream:
        json.dump(scene, stream)
    out = os.path.join(folder, "out")
    generate = [sys.executable, "-m", "codegen", "generate", "--model-dir", folder, "--out", out, "--only", f"{CHOICES[model]}={n}"]
    _, derived = processor_time(generate, cwd=ROOT, env={**os.environ, "PYTHONPATH": packages})
    written = os.path.join(out, os.path.basename(folder))
    size = sum(os.path.getsize(os.path.join(written, name)) for name in os.listdir(written) if name.endswith(".c"))
    run = [os.path.join(ROOT, "target/release/dalembert"), "run", path, "--set"]
    env = {**os.environ, "DALEMBERT_CACHE": os.path.join(scratch, "cache")}
    _, built = processor_time([*run, "method=taylor"], env=env)
    row = {"model": model, "n": n, "generate_s": derived, "compile_s": built - derived, "c_bytes": size}
    for method in ("taylor", "radau"):
        reports = [processor_time([*run, f"method={method}"], env=env)[0] for _ in range(3)]
        work = [re.search(r"(\d+) steps, .*; ([0-9.e-]+) s", report).groups() for report in reports]
        row[f"{method}_us_per_step"] = min(1e6 * float(seconds) / int(steps) for steps, seconds in work)
    return row


def table(rows):
    lines = ["| model | n | " + " | ".join(COLUMNS.values()) + " |", "|---|--:|" + "--:|" * len(COLUMNS)]
    for row in rows:
        values = [row[name] / (1000 if name == "c_bytes" else 1) for name in COLUMNS]
        lines.append(f"| `{row['model']}` | {row['n']} | " + " | ".join(f"{value:.3g}" for value in values) + " |")
    return "\n".join(lines)


def plot(rows):
    """Both axes logarithmic; a panel for each column, with the cube of n as a dashed line."""
    width, height, left, top = 230, 220, 50, 30
    parts = []
    for panel, (name, title) in enumerate(COLUMNS.items()):
        values = [row[name] / (1000 if name == "c_bytes" else 1) for row in rows]
        low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
        x = lambda n: left + panel * (width + left) + width * math.log(n) / math.log(40)
        y = lambda value: top + height * (high - math.log10(value)) / (high - low)
        parts.append(f'<text x="{x(1)}" y="{top - 10}">{title}</text>')
        parts.append(f'<rect x="{x(1)}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#888"/>')
        for decade in range(low, high + 1):
            parts.append(f'<text x="{x(1) - 4}" y="{y(10.0 ** decade) + 4}" text-anchor="end">{10.0 ** decade:g}</text>')
        for n in (1, 2, 4, 8, 16, 40):
            parts.append(f'<text x="{x(n)}" y="{top + height + 14}" text-anchor="middle">{n}</text>')
        start = max(1.0, 40 / (10.0 ** (high - low)) ** (1 / 3))
        cube = f"{x(start)},{y(10.0 ** high * (start / 40) ** 3)} {x(40)},{y(10.0 ** high)}"
        parts.append(f'<polyline points="{cube}" fill="none" stroke="#888" stroke-dasharray="3 3"/>')
        for model, colour in zip(CHOICES, ("#b33", "#36a")):
            own = [(row["n"], value) for row, value in zip(rows, values) if row["model"] == model]
            points = " ".join(f"{x(n):.1f},{y(value):.1f}" for n, value in own)
            parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
    total = len(COLUMNS) * (width + left) + 10
    legend = '<text x="50" y="285" fill="#b33">link_chain</text><text x="130" y="285" fill="#36a">spring_chain</text>' \
             '<text x="230" y="285">over n; dashed: a cube of n</text>'
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{total}" height="295" font-family="sans-serif" font-size="11">\n'
            f'<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(parts) + f"\n{legend}\n</svg>\n")


def main(packages, scratch, *sizes):
    path = os.path.join(os.path.abspath(scratch), "rows.jsonl")
    rows = []
    if os.path.exists(path):
        with open(path, encoding="utf-8") as stream:
            rows = [json.loads(line) for line in stream]
    known = {(row["model"], row["n"]) for row in rows}
    for model, n in (size.split(":") for size in sizes):
        if (model, int(n)) not in known:
            rows.append(measure(packages, os.path.abspath(scratch), model, int(n)))
            with open(path, "a", encoding="utf-8") as stream:
                stream.write(json.dumps(rows[-1]) + "\n")
    rows.sort(key=lambda row: (row["model"], row["n"]))
    print(table(rows))
    with open(os.path.join(ROOT, "docs/notes/sizes.svg"), "w", encoding="utf-8") as stream:
        stream.write(plot(rows))


if __name__ == "__main__":
    main(*sys.argv[1:])
