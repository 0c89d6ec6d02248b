"""Command line of the package: `generate` writes code, `check` judges a model, `verify` judges printed equations."""

import argparse
import json
import os
import signal
import sys

from .errors import ModelError


def main(argv):
    """Runs a command; returns the exit status. `--directory DIR`, which comes first, is where paths begin: the package itself is
    imported from where Python was started."""
    if argv[:1] == ["--directory"]:
        os.chdir(argv[1])
        argv = argv[2:]
    if argv[:1] == ["verify"]:
        from .verify.cli import main as verify
        return verify(argv[1:])
    parser = argparse.ArgumentParser(prog="python -m codegen", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    generator = commands.add_parser("generate", help="write C and manifest of models")
    generator.add_argument("--model-dir", required=True, help="a folder with a model.py")
    generator.add_argument("--name", help="name of the model, if it is not that of its folder")
    generator.add_argument("--out", required=True, help="output root; the model gets a folder in it")
    generator.add_argument("--for-tests", action="store_true", help="mark the models as test models")
    generator.add_argument("--owner", default="", help="what the names of C functions begin with")
    generator.add_argument("--only", action="append", metavar="CHOICE=OPTION", nargs="?", const="",
                           help="derive one variant, with these options and the defaults of other choices")
    generator.add_argument("--reads", action="store_true", help="also list the files that were read, in reads.json")
    judge = commands.add_parser("check", help="print all errors of a model, or its modes, as JSON")
    judge.add_argument("--model-dir", required=True, help="a folder with a model.py")
    judge.add_argument("--name", help="name of the model, if it is not that of its folder")
    arguments = parser.parse_args(argv)
    if arguments.command == "check":
        from .judge import judge
        print(json.dumps(judge(arguments.model_dir, arguments.name)))
        return 0
    named = arguments.only and dict(pair.split("=", 1) for pair in arguments.only if pair)
    from . import reads
    if arguments.reads:
        reads.watch()
    from .generate import generate
    try:
        folder = arguments.model_dir
        files = generate(folder, arguments.for_tests, named, arguments.owner, arguments.name)
        target = os.path.join(arguments.out, arguments.name or os.path.basename(os.path.abspath(folder)))
        os.makedirs(target, exist_ok=True)
        if arguments.reads:
            files["reads.json"] = reads.listed(folder)
        for name, text in files.items():
            with open(os.path.join(target, name), "w", encoding="utf-8", newline="\n") as stream:
                stream.write(text)
    except ModelError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        # What it had open is closed; it ends as by Ctrl-C, at once and without a traceback.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
