"""Papers as an absent-minded hand leaves them: shipped ones with letters, tokens, lines and cells lost, doubled, exchanged."""

import random
import re

TOKENS = ["\\", "{", "}", "(", ")", "\\frac", "\\dot", "\\ddot{", "^", "_", "=", "+", "-", "&", "\\\\", "\\sin", "\\left(", "\\right)", "0", "2.5",
          "1e400", "\\theta", "% value of N", "% motion of ", "% constraint with ", "\\begin{equation}", "\\end{equation}", "$$", "\\[", "x", "\u00a0",
          "\u0301", "sign", ",", ";", "\t", "nan", "-1", "1/0", "|", "\\text{if}", "<", "\\tan", "d/dt", "\\frac{d}{dt}(", "'", "\\newcommand{\\a}{\\a}",
          "**", "^{-9}", "^{99}", "kg*m^2", "coordinate", "input", "defined", "sign", "force", "\x00", "\ufeff", "/", "\\cdot", "!"]


def mutated(text, seed):
    """The text with one to three mutations, by a seed."""
    rng = random.Random(seed)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        parts = re.findall(r"\\[A-Za-z]+|\w+|\s+|.", text) or [""]
        at, other, kind = rng.randrange(len(parts)), rng.randrange(len(parts)), rng.randrange(7)
        if kind == 0:
            del parts[at]
        elif kind == 1:
            parts.insert(at, rng.choice(TOKENS))
        elif kind == 2:
            parts[at] = rng.choice(TOKENS)
        elif kind == 3:
            parts[at], parts[other] = parts[other], parts[at]
        elif kind == 4:
            parts.insert(at, parts[other])
        elif kind == 5:
            lines = "".join(parts).split("\n")
            line = rng.randrange(len(lines))
            lines[line:line + 1] = rng.choice(([], [lines[line]] * 2, [lines[rng.randrange(len(lines))]]))
            parts = ["\n".join(lines)]
        else:
            parts = ["".join(parts)[:rng.randrange(1, len("".join(parts)) + 1)]]
        text = "".join(parts)
    return text
