"""Emission of C for the interiors of convolutions, Σ_{j=1}^{k-1} left_j right_{k-j}.

The interiors of an order are known before the order is begun: one loop over j computes all of them,
side by side in vector lanes. Their factors are two tables in the workspace, a row an order. The
sums go from the middle outwards, so that the coefficients that were computed last enter last: what
an order has to wait for is one product and one sum. Of three or four interiors two orders are summed side by
side, up to that last product: they have most factors in common.

Lanes, whose factors are no parts of a block, read those that are coefficients of the motion or of an input where
these are.

A processor reads as a block only after a while what was stored number by number. Where an order is
so short that it would wait for that, the last factors are kept in registers as well.
"""

import re

BLOCK = 4
"""Most numbers side by side in a register: DALEMBERT_BLOCK in vectors.h."""

_COEFFICIENT = re.compile(r"([qvau])\[(\d+) \* (?:k|\((k - 1)\)) \+ (\d+)\]")
"""A coefficient of a series: array, numbers of a row, whether it is of the order before, index."""

LINE = 8
"""Numbers that fill a line of the cache. The workspace begins with a line; a block that lies in two of them is
read and written in half the pace."""


class Interiors:
    """The convolutions of an expression graph. Factors are text of the function of an order."""

    def __init__(self):
        self.indices, self.late = {}, {}

    def __len__(self):
        return len(self.indices)

    def add(self, left, right):
        """Text of the interior of two series."""
        for key in ((left, right), (right, left)):
            if key in self.indices:
                return f"y[{self.indices[key]}]"
        index = self.indices[left, right] = len(self.indices)
        return f"y[{index}]"

    def add_late(self, left, name, right):
        """The same where the right factor of order k is not known at order k: it is stored at the
        beginning of the next, when its text gives it."""
        inner = self.add(left, name)
        # Two rows of a mass matrix may have the same element: then the interior is not the one added last.
        self.late[self.indices[left, name]] = right
        return inner

    @property
    def few(self):
        """Whether all fit into one block."""
        return len(self) <= BLOCK

    @property
    def halves(self):
        """2 where both halves of the sums fit into a block: right factors follow the left ones in the left
        table, and left factors the right ones in the right table."""
        return 2 if 2 * len(self) <= BLOCK else 1

    @property
    def in_pairs(self):
        """Whether the sums of two successive orders are taken side by side: most of their factors are the same, and
        reading them is what the sums wait for. Late factors are not known so soon, and of many interiors the sums
        would not fit into the registers."""
        return self.few and self.halves == 1 and not self.late

    @property
    def blocks(self):
        """Text of the number of blocks of a row of a table."""
        return f"(DALEMBERT_WIDTH({self.halves * len(self)}) / DALEMBERT_BLOCK)"

    @property
    def row(self):
        """Numbers of a row of both tables, filled up to whole blocks."""
        return 2 * -(-self.halves * len(self) // BLOCK) * BLOCK

    @staticmethod
    def lead(slots):
        """Where the tables begin in the workspace, after so many other numbers."""
        return -(-slots // LINE) * LINE

    def sums(self, lead):
        """Statements that leave the interiors of order k in `y`. The tables begin at `lead` in the workspace."""
        count = len(self)
        lines = [
            f"  enum {{ width = DALEMBERT_WIDTH({self.halves * count}), blocks = width / DALEMBERT_BLOCK }};",
            f"  real *const row = w + {lead}, *const now = row + 2 * width * k;",
        ]
        lines += self._late_stores()
        if self.in_pairs:
            # Before the first pair there is nothing between the first factors and the last.
            lines += [
                "  dalembert_block sums[blocks];",
                "  for (size_t n = 0; n < blocks; ++n) sums[n] = given ? given[n] : DALEMBERT_ZERO;",
            ]
        else:
            lines += self._loop()
        if not self.few:
            return [*lines, "  const real *const y = (const real *)sums;"]
        sum = "((const real *)sums)[%s]"
        lines += [f"  real y[{count}];"]
        for n in range(count):
            lines.append(f"  y[{n}] = {' + '.join(sum % m for m in range(n, self.halves * count, count))};")
        lines += [
            "  if (k == 2) {",
            *(f"    y[{n}] += last[{n}] * last[{count + n}];" for n in range(count)),
            "  } else if (k > 2) {",
            *(f"    y[{n}] = y[{n}] + last[{n}] * row[3 * width + {n}] + row[2 * width + {n}] * last[{count + n}];"
              for n in range(count)),
            "  }",
        ]
        return lines

    def _loop(self):
        """Statements that sum over j."""
        first = 2 if self.few else 1
        half = "0.5 * " if self.halves == 2 else ""
        others = self.halves == 1
        return [
            f"  dalembert_block sums[blocks]{', others[blocks]' if others else ''};",
            "  for (size_t n = 0; n < blocks; ++n) {",
            f"    sums[n] = {'others[n] = ' if others else ''}DALEMBERT_ZERO;",
            f"    if (k % 2 == 0{' && k > 2' if self.few else ''}) sums[n] = {half}(DALEMBERT_LEFT(k / 2)[n] * DALEMBERT_RIGHT(k / 2)[n]);",
            "  }",
            # Of an order that is unrolled.
            *(["#ifndef LANES", "#pragma GCC unroll 16", "#endif"] if self.halves == 2 else []),
            f"  for (size_t j = (k - 1) / 2; j >= {first}; --j) {{",
            "    for (size_t n = 0; n < blocks; ++n) {",
            "      sums[n] += DALEMBERT_LEFT(j)[n] * DALEMBERT_RIGHT(k - j)[n];",
            *(["      others[n] += DALEMBERT_LEFT(k - j)[n] * DALEMBERT_RIGHT(j)[n];"] if others else []),
            "    }",
            "  }",
            *(["  for (size_t n = 0; n < blocks; ++n) sums[n] += others[n];"] if others else []),
        ]

    def _places(self):
        """Statements that say where lanes find each factor of order j: in the series it is of, or in the tables."""
        arrays, steps, firsts = [], [], []
        for side, texts in enumerate(zip(*self.indices)):
            for n, text in enumerate(texts):
                known = _COEFFICIENT.fullmatch(text)
                array, step, before, first = known.groups() if known else ("row", "2 * width", None, f"{side} * width + {n}")
                arrays.append(array)
                steps.append(step)
                firsts.append(f"{first} - {step}" if before else first)
        return [
            "#ifdef LANES",
            f"  const real *const arrays[] = {{{', '.join(arrays)}}};",
            f"  static const size_t steps[] = {{{', '.join(steps)}}}, firsts[] = {{{', '.join(firsts)}}};",
            "#endif",
        ]

    def pair(self, lead):
        """Statements that leave the sums of the orders k, which is three at least, and k + 1 in `out`, but for the
        factors of the last order before each: to the bit those that `_loop` gives."""
        return [
            f"  enum {{ width = DALEMBERT_WIDTH({len(self)}), blocks = width / DALEMBERT_BLOCK }};",
            f"  const real *const row = w + {lead};",
            *self._places(),
            "  dalembert_block left[blocks], right[blocks], sums[blocks], others[blocks], next[blocks], next_others[blocks];",
            "  for (size_t n = 0; n < blocks; ++n) {",
            "    const size_t middle = k / 2;",
            "    left[n] = DALEMBERT_LEFT_FACTOR(middle + 1, n), right[n] = DALEMBERT_RIGHT_FACTOR(middle + 1, n);",
            "    sums[n] = others[n] = next[n] = next_others[n] = DALEMBERT_ZERO;",
            "    if (k % 2 == 1) {",
            "      next[n] = left[n] * right[n];",
            "    } else {",
            "      sums[n] = DALEMBERT_LEFT_FACTOR(middle, n) * DALEMBERT_RIGHT_FACTOR(middle, n);",
            "      next[n] += DALEMBERT_LEFT_FACTOR(middle, n) * right[n];",
            "      next_others[n] += left[n] * DALEMBERT_RIGHT_FACTOR(middle, n);",
            "    }",
            "  }",
            "  for (size_t j = (k - 1) / 2; j >= 2; --j) {",
            "    for (size_t n = 0; n < blocks; ++n) {",
            "      dalembert_block own_left = DALEMBERT_LEFT_FACTOR(j, n), own_right = DALEMBERT_RIGHT_FACTOR(j, n);",
            "      DALEMBERT_KEEP(own_left);",
            "      DALEMBERT_KEEP(own_right);",
            "      sums[n] += own_left * right[n];",
            "      others[n] += left[n] * own_right;",
            "      left[n] = DALEMBERT_LEFT_FACTOR(k + 1 - j, n), right[n] = DALEMBERT_RIGHT_FACTOR(k + 1 - j, n);",
            "      next[n] += own_left * right[n];",
            "      next_others[n] += left[n] * own_right;",
            "    }",
            "  }",
            "  for (size_t n = 0; n < blocks; ++n) out[n] = sums[n] + others[n], out[blocks + n] = next[n] + next_others[n];",
        ]

    def stores(self):
        """Statements that store the factors of order k."""
        count, lines = len(self), []
        tables = [list(side) for side in zip(*self.indices)]
        for n in self.late:
            tables[1][n] = "REAL(0.0)"
        if self.few:
            for n, text in enumerate(tables[0] + tables[1]):
                lines.append(f"  last[{n}] = {text};")
            tables = [[f"last[{count * side + n}]" for n in range(count)] for side in (0, 1)]
        if self.halves == 2:
            tables = [tables[0] + tables[1], tables[1] + tables[0]]
        puts = [f"  DALEMBERT_PUT(now + {side}{n}, {', '.join(table[n:n + BLOCK])});"
                for side, table in zip(("", "width + "), tables) for n in range(0, len(table), BLOCK)]
        if not self.in_pairs:
            return lines + puts
        # Those that are coefficients of a series lanes find there. The first ones are asked for in the tables.
        own = [f"  now[{side} * width + {n}] = last[{count * side + n}];"
               for side, texts in enumerate(zip(*self.indices)) for n, text in enumerate(texts)
               if not _COEFFICIENT.fullmatch(text)]
        return [*lines, "#ifdef LANES", "  if (k == 1) {", *puts, "  }", *own, "#else", *puts, "#endif"]

    def _late_stores(self):
        """Statements that store the late factors of order k - 1."""
        count, lines = len(self), []
        for n, text in self.late.items():
            places = [f"width + {n}"] + ([f"{count + n}"] if self.halves == 2 else [])
            target = "".join(f"row[2 * width * (k - 1) + {place}] = " for place in places)
            lines.append(f"  {target}{f'last[{count + n}] = ' if self.few else ''}{text};")
        return lines
