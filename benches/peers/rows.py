"""Rows of the comparison: errors against the references, the best of each peer, table and figure."""

import math

PROBLEMS = ["P1", "P2", "P3b", "P4", "P4S", "P5", "free", "plate"]
LEVELS = [1e-3, 1e-6, 1e-9, 1e-12]
COLUMNS = ["peer", "method", "problem", "tolerance", "least_us", "median_us", "repeats", "rhs", "jacobians", "steps", "events", "end_error", "event_time_error", "verdict"]
# Bare code made for each problem: what can be reached, and no peer.
FLOOR = "floor(own)"
# The spring of P4S follows its load to 1e-9 m; the height at an impact is 0 by the reset.
COMPARED = {"P4S": [0, 2], "P5": [1]}


def least_events(reference, tolerance):
    """How many events must be found: all, but of the tank's landings, which accumulate, only those before a
    hop that is lower than the absolute tolerance of the angle."""
    return reference.get("least_events", {}).get(f"{tolerance:g}", len(reference["events"]))


def collect(line, references):
    """A printed row as a row of results.csv: errors against the references, and whether every event was found."""
    peer, method, problem, tolerance, least, median, repeats, rhs, jacobians, steps, status, time, y, events = line.split("|")
    reference = references[problem]
    y, events = ([float(x) for x in field.split(";") if x] for field in (y, events))
    true_events = [float(t) for t in reference["events"]]
    end_error = event_error = math.nan
    found = least_events(reference, float(tolerance)) <= len(events) <= len(true_events)
    verdict = "failed" if int(status) else "ok" if found else "wrong events"
    if verdict == "ok":
        true_y = [float(x) for x in reference["y_end"]]
        end_error = max(abs(y[i] - true_y[i]) / reference["scales"][i] for i in COMPARED.get(problem, range(len(y))))
        if problem == "P5":
            end_error = max(end_error, abs(float(time) - float(reference["t_end"])))
        event_error = max(abs(t - s) for t, s in zip(events, true_events))
    values = [peer, method, problem, f"{float(tolerance):g}", f"{1e6 * float(least):.2f}", f"{1e6 * float(median):.2f}", repeats, rhs, jacobians, steps,
              len(events), f"{end_error:.2e}", f"{event_error:.2e}", verdict]
    return dict(zip(COLUMNS, map(str, values)))


def merged(rows, new):
    """Rows with new ones in place of the old ones of the same peers and problems."""
    replaced = {(row["peer"], row["problem"]) for row in new}
    return [row for row in rows if (row["peer"], row["problem"]) not in replaced] + new


# Of these rows' times the cost of calls is subtracted.
LESS = " less calls"


def least(rows, again):
    """Rows of another pass of the same programs, each with the least times of both passes.

    A time less calls is the least time less the least cost of calls: of the differences themselves the least would be
    that of a pass in which the calls alone were disturbed."""
    key = lambda row: (row["peer"], row["method"], row["problem"], row["tolerance"], row["steps"])
    by_key = [{key(row): row for row in one_pass} for one_pass in (again, rows)]

    def time(row, name):
        passes = [one_pass for one_pass in by_key if key(row) in one_pass]
        own = [float(one_pass[key(row)][name]) for one_pass in passes]
        if not row["peer"].endswith(LESS):
            return f"{min(own):.2f}"
        with_calls = key({**row, "peer": row["peer"].removesuffix(LESS)})
        full = [float(one_pass[with_calls][name]) for one_pass in passes]
        return f"{min(full) - min(f - o for f, o in zip(full, own)):.2f}"

    return [{**row, **{name: time(row, name) for name in ("least_us", "median_us")}} for row in again]


def least_costs(before, again):
    """The table of the cost of a step of another pass, each row with the least times of both passes; `before` may be empty."""
    cells = lambda line: [cell.strip() for cell in line.strip("| ").split("|")]
    known = {tuple(cells(line)[:4]): cells(line) for line in before.splitlines()[2:]}
    lines = again.splitlines()
    for i, line in enumerate(lines[2:], start=2):
        *key, time, own, _ = cells(line)
        earlier = known.get(tuple(key), [*key, time, own])
        time, own = (min(int(a), int(b)) for a, b in zip((time, own), earlier[4:6]))
        lines[i] = f"| {' | '.join(key)} | {time} | {own} | {100 * own / time:.0f} % |"
    return "\n".join(lines) + "\n"


def best(rows, problem, level):
    """Fastest row of each peer with every event and an end error of at most the level."""
    fastest = {}
    for row in rows:
        if row["problem"] == problem and row["verdict"] == "ok" and float(row["end_error"]) <= level:
            if row["peer"] not in fastest or float(row["least_us"]) < float(fastest[row["peer"]]["least_us"]):
                fastest[row["peer"]] = row
    return fastest


def table(rows):
    """Markdown: per problem and level each peer's best time, that of the floor, and our ratios."""
    peers = sorted({row["peer"] for row in rows} - {"dalembert", FLOOR})
    lines = ["| problem | error | dalembert | " + " | ".join(peers) + " | floor | to the best peer | to the floor |", "|---|--:|--:|" + "--:|" * (len(peers) + 3)]
    for problem in PROBLEMS:
        for level in LEVELS:
            fastest = best(rows, problem, level)
            cell = lambda peer: f"{float(fastest[peer]['least_us']):.1f} ({fastest[peer]['method']}, {fastest[peer]['tolerance']})" if peer in fastest else "–"
            ours = float(fastest["dalembert"]["least_us"]) if "dalembert" in fastest else math.nan
            times = lambda names: [float(fastest[peer]["least_us"]) for peer in names if peer in fastest]
            ratio = lambda others: f"{ours / min(others):.2f}" if others and not math.isnan(ours) else "–"
            cells = [*map(cell, ["dalembert", *peers, FLOOR]), ratio(times(peers)), ratio(times([FLOOR]))]
            lines.append(f"| {problem} | {level:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def summary(rows):
    """Markdown for the README: our best time and that of the best peer, where both reach the error."""
    lines = ["| problem | error | dalembert / µs | best other / µs | ratio |", "|---|--:|--:|---|--:|"]
    for problem in PROBLEMS:
        for level in (1e-3, 1e-6, 1e-12):
            fastest = best(rows, problem, level)
            fastest.pop(FLOOR, None)
            ours = fastest.pop("dalembert", None)
            if ours and fastest:
                other = min(fastest.values(), key=lambda row: float(row["least_us"]))
                times = [float(row["least_us"]) for row in (ours, other)]
                ratio = times[0] / times[1]
                shown = f"{ratio:.2f}" if ratio >= 0.1 else f"{ratio:.1g}"
                lines.append(f"| {problem} | 1e-{round(-math.log10(level))} | {times[0]:.1f} | {times[1]:.1f} ({other['peer']}) | {shown} |")
    return "\n".join(lines) + "\n"


def with_summary(page, rows):
    """A page with its table replaced by that of the rows."""
    new = summary(rows)
    head = new.splitlines()[0]
    before, found, after = page.partition(head)
    if not found:
        raise ValueError(f"the page has no table with the head `{head}`")
    return before + new + after[after.index("\n\n") + 1:]


def frontier(points):
    """Of (error, time) those that no point of a smaller error beats in time: a peer at its best."""
    points = sorted(points)
    return [p for p in points if all(p[1] < q[1] for q in points if q[0] < p[0])]


def figure(rows, path):
    """Least time against achieved error: a panel a problem, a line a peer."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    grey = "#808080"  # is readable on white and on black
    plt.rcParams.update({"svg.hashsalt": "peers", "text.color": grey, "axes.edgecolor": grey, "axes.labelcolor": grey, "xtick.color": grey, "ytick.color": grey})
    peers = sorted({row["peer"] for row in rows}, key=lambda peer: (peer != "dalembert", peer == FLOOR, peer))
    colours = dict(zip(peers, plt.get_cmap("tab10").colors)) | {FLOOR: grey}
    panels, axes = plt.subplots(2, 4, figsize=(13, 7), sharex=True)
    for axis, problem in zip(axes.flat, PROBLEMS):
        for peer in peers:
            points = frontier((float(r["end_error"]), float(r["least_us"])) for r in rows if (r["peer"], r["problem"], r["verdict"]) == (peer, problem, "ok"))
            ours = peer == "dalembert"
            axis.loglog([max(e, 1e-16) for e, _ in points], [t for _, t in points], ":" if peer == FLOOR else "-o", ms=3, lw=3 if ours else 1.2, color=colours[peer], label="bare code" if peer == FLOOR else peer)
        axis.set_title(problem, color=grey)
        axis.set_xlim(3e-1, 1e-16)
        axis.grid(alpha=0.3)
    for axis in axes[1]:
        axis.set_xlabel("error of the end state")
    for axis in axes[:, 0]:
        axis.set_ylabel("time / µs")
    panels.legend(*axes.flat[0].get_legend_handles_labels(), ncol=5, loc="lower center", frameon=False, labelcolor=grey)
    panels.tight_layout(rect=(0, 0.08, 1, 1))
    panels.savefig(path, transparent=True, metadata={"Date": None})


if __name__ == "__main__":
    import csv
    import sys

    source, target = sys.argv[1:]
    with open(source) as file:
        figure(list(csv.DictReader(file)), target)
