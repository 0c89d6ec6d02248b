"""What is said while one waits, and early."""

import io
import signal
import subprocess
import sys
import unittest

from codegen.verify.progress import Progress


# The command line of the package, which says when it has begun.
BEGUN = """
import runpy, sys
from codegen.verify import cli
judge = cli.main
def main(arguments):
    print("begun", flush=True)
    return judge(arguments)
cli.main = main
sys.argv = ["codegen", "verify", "walking_tank"]
runpy.run_module("codegen", run_name="__main__", alter_sys=True)
"""


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Waiting(unittest.TestCase):
    def said(self, stream, seconds):
        """What is said of a step whose parts take so many seconds."""
        clock = iter([k * seconds for k in range(100)])
        tell = Progress(stream, now=lambda: next(clock))
        for done in range(40):
            tell("boxes", done, 40)
        tell.end()
        return stream.getvalue()

    def test_long_steps_are_announced_once_and_early(self):
        self.assertEqual(self.said(io.StringIO(), 2.0), "verify: boxes can take 78 s more; --quick leaves it out\n")
        self.assertEqual(self.said(io.StringIO(), 6.0), "verify: boxes can take 4 minutes more; --quick leaves it out\n")
        self.assertEqual(self.said(io.StringIO(), 0.4), "")

    def test_a_terminal_has_one_line_that_is_cleared(self):
        lines = self.said(Terminal(), 0.4).split("\r")
        self.assertEqual(lines[1], "verify: boxes, 0 of at most 40")
        self.assertEqual(lines[40], "verify: boxes, 39 of at most 40")
        self.assertEqual((lines[41].strip(), lines[42]), ("", ""))

    @unittest.skipUnless(hasattr(signal, "SIGKILL"), "signals of POSIX")
    def test_ctrl_c_ends_it_at_once_and_without_a_traceback(self):
        # The walking tank takes many seconds; what it is told comes where the command has begun. A shell's background jobs, which
        # ignore Ctrl-C, hand that down to what they start: here it is heard.
        judged = subprocess.Popen([sys.executable, *sys.orig_argv[1:sys.orig_argv.index("-m")], "-c", BEGUN],
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.assertEqual(judged.stdout.readline(), "begun\n")
        judged.send_signal(signal.SIGINT)
        _, said = judged.communicate(timeout=60)
        self.assertEqual(judged.returncode, -signal.SIGINT)
        self.assertNotIn("Traceback", said)


if __name__ == "__main__":
    unittest.main()
