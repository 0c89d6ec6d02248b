"""Says how far a verification is, and early if it will take long."""

import time

# What is awaited without a word; a first estimate needs a part of it.
PATIENCE, FIRST = 20.0, 1.0


def silent(what, done=0, total=0):
    """Says nothing: what is told where nobody listens."""


class Progress:
    """Writes what is being done to `stream`, over one line where it is a terminal; elsewhere, and there too, a line once for
    each step that is estimated to take more than `PATIENCE` seconds."""

    def __init__(self, stream, now=time.monotonic):
        self.stream, self.now, self.live = stream, now, stream.isatty()
        self.step, self.began, self.warned, self.width = None, 0.0, False, 0

    def __call__(self, what, done=0, total=0):
        """`done` of at most `total` parts of a step are done."""
        now = self.now()
        if what != self.step:
            self.step, self.began, self.warned = what, now, False
        elapsed = now - self.began
        if done and not self.warned and elapsed > FIRST and (left := elapsed / done * (total - done)) > PATIENCE:
            self.end()
            print(f"verify: {what} can take {round(left / 60)} minutes" if left > 90 else f"verify: {what} can take {left:.0f} s",
                  "more; --quick leaves it out", file=self.stream, flush=True)
            self.warned = True
        if self.live:
            text = f"verify: {what}" + (f", {done} of at most {total}" if total else "")
            self.stream.write("\r" + text.ljust(self.width))
            self.stream.flush()
            self.width = len(text)

    def end(self):
        """Clears the line."""
        if self.live and self.width:
            self.stream.write("\r" + " " * self.width + "\r")
            self.stream.flush()
            self.width = 0
