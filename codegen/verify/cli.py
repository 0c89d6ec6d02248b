"""`python -m codegen verify`: judge the hand-written equations of a model.

    verify MODEL [--models DIR] [--json] [--html FILE] [--latex FILE] [--certificate FILE] [--program FILE] [--quick]
                 [--fail-on misprint|finding [--waivers FILE]]
    verify --seeded [--json]

MODEL is the name of a folder under DIR (default: models) or the path of one: with paper.py, or with
paper.tex and symbols.csv. Exit status: 0 the
equations were judged (whatever the verdict, unless --fail-on asks for one); 1 there is what --fail-on names
and no waiver excuses; 2 the input is wrong.
"""

import argparse
import importlib.util
import json
import os
import sys
from pathlib import Path

from .errors import PaperError, VerifyError
from .progress import Progress


# kinds of findings by what --fail-on says; None: all
FAILS = {"misprint": ("misprint", "repair"), "finding": None}


def parser():
    """The arguments."""
    result = argparse.ArgumentParser(prog="verify", description="Judge a model's hand-written equations against its energies.")
    result.add_argument("model", nargs="?", help="name of a model folder, or its path")
    result.add_argument("--models", default="models", help="folder that holds the model folders")
    result.add_argument("--json", action="store_true", help="print the report as JSON")
    result.add_argument("--html", metavar="FILE", help="also write a self-contained HTML page")
    result.add_argument("--latex", metavar="FILE", help="also write a file for pdflatex")
    result.add_argument("--quick", action="store_true", help="skip the proof over the whole box of coordinates, and simulations")
    result.add_argument("--program", metavar="FILE", help="the program dalembert: simulate what each slip does to the scenes")
    result.add_argument("--fail-on", choices=sorted(FAILS), help="exit with status 1 where there is a misprint (a slip that is repaired or "
                        "corrected as one), or any finding")
    result.add_argument("--waivers", metavar="FILE", help="findings that --fail-on excuses: lines 'id: reason'")
    result.add_argument("--certificate", metavar="FILE", help="also write the claims that check_certificate.py checks again")
    result.add_argument("--seeded", action="store_true", help="print the detection table of seeded errors instead")
    return result


def main(argv=None):
    """Run the command and return its exit status."""
    arguments = parser().parse_args(argv)
    if importlib.util.find_spec("sympy") is None:
        print("verify: SymPy is not installed for this Python; install it with: pip install sympy", file=sys.stderr)
        return 2
    try:
        if arguments.seeded:
            from . import seeded

            results = {**seeded.run_all(), **seeded.run_published()}
            _show((json.dumps(seeded.as_dictionary(results), indent=2) if arguments.json else seeded.as_text(results)) + "\n")
            return 0
        if not arguments.model:
            print("verify: name a model, for example: verify walking_tank", file=sys.stderr)
            return 2
        return _judge(arguments)
    except VerifyError as error:
        print(f"verify: {error}", file=sys.stderr)
        return 2


def _show(text):
    """Prints the result. A reader that has seen enough (`| head`) is no error, and changes nothing of what is done besides."""
    try:
        print(text, end="", flush=True)
    except BrokenPipeError:
        # what is left in the buffer goes nowhere, and the interpreter does not complain of it when it ends
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _judge(arguments):
    """Judge one model and write the report."""
    from .report import certificate, html, machine, tex, text
    from .load import load

    folder = Path(arguments.model) if Path(arguments.model).is_dir() else Path(arguments.models) / arguments.model
    if not folder.is_dir():
        offered = sorted(p.parent.name for p in Path(arguments.models).glob("*/paper.py"))
        print(f"verify: there is no model '{arguments.model}' in {arguments.models}; "
              f"with hand-written equations: {', '.join(offered) or 'none'}", file=sys.stderr)
        return 2
    tell = Progress(sys.stderr)
    try:
        result = _result(load(folder), arguments, tell)
    finally:
        tell.end()
    _show(machine.as_json(result) if arguments.json else text.as_text(result))
    for name, write in ((arguments.html, html.as_html), (arguments.latex, tex.as_latex), (arguments.certificate, certificate.as_certificate)):
        if not name:
            continue
        path = Path(name)
        partial = path.with_name(path.name + ".tmp")
        try:
            partial.write_text(write(result), encoding="utf-8")
            partial.replace(path)
        except OSError as error:
            print(f"verify: cannot write {path}: {error.strerror}", file=sys.stderr)
            return 2
    return _gate(arguments, result) if arguments.fail_on else 0


def _result(case, arguments, tell):
    """The report of a case, with the effects of the slips where they can be simulated."""
    from .report import effects, gather
    from .report.order import ranked

    result = gather.verify(case, not arguments.quick, tell)
    if arguments.program and case.effects and not arguments.quick:
        result.simulated = effects.simulate(case.effects, result.case.corrections, arguments.program,
                                            lambda done, total: tell("simulation of the slips", done, total))
        effects.attach(result.findings, result.case.corrections, result.simulated)
        result.findings = ranked(result.findings)
    return result


def _gate(arguments, result):
    """The exit status where --fail-on is given."""
    from .report.lasting import lasting

    waived = _waivers(arguments.waivers) if arguments.waivers else {}
    kinds, names = FAILS[arguments.fail_on], lasting(result.findings, result.case.paper)
    # both names of each
    found = {f.key: {f.key, names.get(f.key, f.key)} for f in result.findings if kinds is None or f.kind in kinds}
    open_ = [key for key, called in found.items() if not called & waived.keys()]
    # what excuses nothing any more would excuse the next finding of that name
    stale = [key for key in waived if key not in set().union(*found.values())]
    if open_:
        shown = [f"{key} ({names[key]})" if key in names else key for key in open_]
        print(f"verify: --fail-on {arguments.fail_on}: {', '.join(shown)}", file=sys.stderr)
    if stale:
        print(f"verify: {arguments.waivers}: no finding needs {', '.join(stale)}: take the line out", file=sys.stderr)
    return 1 if open_ or stale else 0


def _waivers(path):
    """The reasons by the names of findings."""

    try:
        lines = Path(path).read_text(encoding="utf-8-sig").split("\n")
    except OSError as error:
        raise PaperError(f"cannot read {path}: {error.strerror}") from error
    waived = {}
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        key, colon, reason = (part.strip() for part in line.partition(":"))
        if not (key and colon and reason):
            raise PaperError(f"{path}, line {number}: a waiver is a finding and its reason, 'id: reason', not {line.strip()!r}")
        if key in waived:
            raise PaperError(f"{path}, line {number}: {key} is waived twice")
        waived[key] = reason
    return waived


if __name__ == "__main__":
    sys.exit(main())
