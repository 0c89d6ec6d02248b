"""Emission of C from CasADi expressions.

Every generated function has the signature

    void NAME(const real *q, const real *v, const real *a, const struct dalembert_context *x, real *out)

with the free coordinates of its mode in q, v, a and everything else in the context. Outputs are
dense and column-major. The text is single-assignment straight-line code in the order of CasADi's
own instruction list, so it is the same on every run.

A `real` is a double. The same text with the head `lanes.h` works on trajectories side by side: a `real`
is then a vector.
"""

import os

import casadi as ca

CONTEXT_FIELDS = ("u", "u_dot", "d", "h", "c", "j")
"""Arrays of `struct dalembert_context`: contract.h."""

HEADER = """\
#include <math.h>
#include <string.h>
#if defined(__GNUC__) || defined(__clang__)
#define DALEMBERT_INLINE static inline __attribute__((always_inline))
#else
#define DALEMBERT_INLINE static inline
#endif
typedef double real;
#define REAL(x) (x)
#define DALEMBERT_KEEP(block)
#if DALEMBERT_BLOCK == 4
/* At once: a processor waits where it reads as one what it has just stored in parts, and a compiler
 * makes parts of what is not volatile. */
#define DALEMBERT_PUT(at, ...) (*(volatile dalembert_block *)(at) = (dalembert_block){__VA_ARGS__})
#else
#define DALEMBERT_PUT(at, ...) DALEMBERT_PUT_EACH(at, __VA_ARGS__)
#endif
struct dalembert_sin_cos { double sin, cos; };
struct dalembert_sin_cos dalembert_sin_cos(double);
/* An angle whose sine and cosine were computed last: the functions of a mode are asked for one state
 * after another. At a contact it is zero, or nearly: sin x = x - x^3/6 and cos x = 1 - x^2/2 round to x
 * and 1 below 2^-27, as dalembert_sin_cos does. */
struct dalembert_angle { double angle; struct dalembert_sin_cos pair; };
DALEMBERT_INLINE struct dalembert_sin_cos dalembert_kept_sin_cos(struct dalembert_angle *kept, double angle) {
  if (memcmp(&kept->angle, &angle, sizeof angle) != 0) {
    if (angle < 0x1p-27 && angle > -0x1p-27) return (struct dalembert_sin_cos){angle, 1.0};
    kept->pair = dalembert_sin_cos(angle);
    kept->angle = angle;
  }
  return kept->pair;
}
#define DALEMBERT_SIN_COS(n, angle) dalembert_kept_sin_cos(x->angles + (n), angle)
"""

MOST_ORDERS = 36
"""Coefficients of a series, the one of order 0 included: `ORDERS` in src/integrate/taylor/series.rs."""

_INVERSES = (f"static const double dalembert_inverses[] = {{0.0, "
             f"{', '.join(f'1.0 / {k}.0' for k in range(1, MOST_ORDERS + 2))}}};\n")

# Rows of factors: see emit_series.py.
_FACTORS = """\
/* The least number that fills blocks and is not below n. */
#define DALEMBERT_WIDTH(n) (((n) + DALEMBERT_BLOCK - 1) / DALEMBERT_BLOCK * DALEMBERT_BLOCK)
/* Blocks of left and of right factors of order j. */
#define DALEMBERT_LEFT(j) ((const dalembert_block *)(row + 2 * width * (j)))
#define DALEMBERT_RIGHT(j) ((const dalembert_block *)(row + 2 * width * (j) + width))
/* The same, where lanes find them elsewhere, too: interiors.py. */
#ifdef LANES
#define DALEMBERT_LEFT_FACTOR(j, n) arrays[n][steps[n] * (j) + firsts[n]]
#define DALEMBERT_RIGHT_FACTOR(j, n) DALEMBERT_LEFT_FACTOR(j, blocks + (n))
#else
#define DALEMBERT_LEFT_FACTOR(j, n) DALEMBERT_LEFT(j)[n]
#define DALEMBERT_RIGHT_FACTOR(j, n) DALEMBERT_RIGHT(j)[n]
#endif
#define DALEMBERT_ZERO ((dalembert_block){0})
#define DALEMBERT_PUT_EACH(at, ...) do { \\
    const real each[] = {__VA_ARGS__}; \\
    for (size_t i = 0; i < sizeof each / sizeof *each; ++i) (at)[i] = each[i]; \\
  } while (0)
"""

LONG_RUN = 16
"""Outputs in a row that are zero and are set so by a loop: a matrix of many coordinates has most of them."""

_LONG = 150_000
"""Characters of functions that go into one file: about a second of compiling."""

KEPT_ANGLES = 4
"""Angles whose sine and cosine a context keeps. A function may have more."""

_BINARY = {ca.OP_ADD: "+", ca.OP_SUB: "-", ca.OP_MUL: "*", ca.OP_DIV: "/",
           ca.OP_EQ: "==", ca.OP_NE: "!=", ca.OP_LT: "<", ca.OP_LE: "<="}
# Functions of the C library, whose last bits may differ between systems; sine and cosine are not
# among them (see `sin_cos`), and sqrt, fabs, copysign, fmin and fmax are exact by IEEE 754.
_CALLS = {
    getattr(ca, "OP_" + name.upper()): name
    for name in ("tan", "asin", "acos", "atan", "exp", "log", "sqrt", "fabs", "sinh",
                 "cosh", "tanh", "asinh", "acosh", "atanh", "expm1", "log1p", "pow", "atan2", "hypot",
                 "erf", "fmin", "fmax", "copysign")
}
_CALLS[ca.OP_CONSTPOW] = "pow"

_LOGIC = {ca.OP_AND: "&&", ca.OP_OR: "||"}

SIN_COS = {ca.OP_SIN: "sin", ca.OP_COS: "cos"}
"""Members of a pair; see `sin_cos`."""


def body(arguments, output):
    """Body of a C function: lines of text, and the number of arithmetic operations.

    `arguments` is a list of (C array name, column of symbols); `output` a dense column.
    """
    place = {}
    for array, symbols in arguments:
        for i in range(symbols.numel()):
            place[symbols[i].element_hash()] = f"{array}[{i}]"
    symbols = ca.symvar(output)
    missing = [s.name() for s in symbols if s.element_hash() not in place]
    if missing:
        raise ValueError(f"expression depends on {', '.join(missing)}, which is not an argument")
    function = ca.Function("emit", symbols, [ca.cse(output)])
    work, pairs, operations, fresh = {}, {}, 0, 0
    constants = {i: literal(float(output[i])) for i in range(output.numel()) if output[i].is_constant()}
    lines = zeros(constants, literal(0.0))
    filled = {i for i in range(output.numel()) if output[i].is_constant()} - constants.keys()
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        into, source = function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            if into[1] in filled:
                continue
            lines.append(f"  out[{into[1]}] = REAL({work[source[0]]});")
            continue
        if op == ca.OP_CONST:
            work[into[0]] = literal(function.instruction_constant(k))
            continue
        if op == ca.OP_INPUT:
            text = place[symbols[source[0]].element_hash()]
        elif op in SIN_COS:
            angle = work[source[0]]
            if angle not in pairs:
                pairs[angle] = f"t{fresh}"
                lines.append(sin_cos(pairs[angle], len(pairs) - 1, angle))
                fresh += 1
            operations += 1
            work[into[0]] = f"{pairs[angle]}.{SIN_COS[op]}"
            continue
        else:
            text = operation(op, [work[i] for i in source])
            operations += 1
        lines.append(f"  const real t{fresh} = {text};")
        work[into[0]] = f"t{fresh}"
        fresh += 1
    return lines, operations


def zeros(values, zero):
    """Lines that set runs of outputs to zero, which are taken out of `values`, texts by index: those that are long enough for a
    loop."""
    lines, run = [], []
    for i in [*sorted(i for i, value in values.items() if value == zero), None]:
        if run and i != run[-1] + 1:
            if len(run) >= LONG_RUN:
                lines.append(f"  for (size_t i = {run[0]}; i < {run[-1] + 1}; ++i) out[i] = REAL(0.0);")
                for index in run:
                    del values[index]
            run = []
        run.append(i)
    return lines


def literal(value):
    """A double as C text that reads back to the same bits."""
    return repr(float(value)) if value == value and abs(value) != float("inf") else (
        "NAN" if value != value else ("INFINITY" if value > 0 else "-INFINITY"))


def sin_cos(name, index, angle):
    """A line of C that computes sine and cosine of an angle, by its index in the function, both at once:
    `elementary.c`."""
    kept = min(index, KEPT_ANGLES - 1)
    return f"  const struct dalembert_sin_cos {name} = DALEMBERT_SIN_COS({kept}, {angle});"


def operation(op, arguments):
    """A CasADi operation as C text."""
    if op in _BINARY:
        return f"{arguments[0]} {_BINARY[op]} {parenthesized(arguments[1])}"
    if op == ca.OP_NEG:
        return f"-{parenthesized(arguments[0])}"
    if op == ca.OP_SQ:
        return f"{arguments[0]} * {arguments[0]}"
    if op == ca.OP_TWICE:
        return f"2.0 * {arguments[0]}"
    if op == ca.OP_INV:
        return f"1.0 / {parenthesized(arguments[0])}"
    if op == ca.OP_ASSIGN:
        return arguments[0]
    # What holds is any number but zero.
    if op == ca.OP_NOT:
        return f"{arguments[0]} == 0.0"
    if op in _LOGIC:
        return f"{arguments[0]} != 0.0 {_LOGIC[op]} {arguments[1]} != 0.0"
    if op == ca.OP_IF_ELSE_ZERO:
        return f"{arguments[0]} != 0.0 ? {arguments[1]} : 0.0"
    if op == ca.OP_SIGN:
        return f"({arguments[0]} > 0.0) - ({arguments[0]} < 0.0)"
    if op in _CALLS:
        return f"{_CALLS[op]}({', '.join(arguments)})"
    raise ValueError(f"CasADi operation {op} cannot be emitted as C")


def parenthesized(text):
    """An operand, in parentheses if it begins with a sign."""
    return f"({text})" if text.startswith("-") else text


_SIGNATURE = ("const real *q, const real *v, const real *a,\n"
              "    const struct dalembert_context *x, real *out")


class Source:
    """Collector of the functions of one C file; identical functions are emitted once."""

    def __init__(self):
        self.functions, self.by_body, self.operations = {}, {}, {}

    def add(self, name, arguments, output):
        """Adds a function and returns the name under which it can be called."""
        lines, operations = body(arguments, output)
        text = "\n".join(lines)
        unused = "".join(f"  (void){array};\n" for array in ("q", "v", "a", "x"))
        arrays = "".join(
            f"  const real *const {field} = x->{field};\n"
            for field in CONTEXT_FIELDS if f" {field}[" in text or f"({field}[" in text
        )
        self.operations[name] = operations
        return self.add_text(name, _SIGNATURE, unused + arrays + text)

    def add_text(self, name, signature, text, kind=""):
        """Adds a function of that kind with the given C parameters and body; returns its name, or that
        of an identical one."""
        known = self.by_body.setdefault((signature, text), name)
        if known == name:
            self.functions[name] = f"{kind}{' ' if kind else ''}void {name}({signature}) {{\n{text}\n}}\n"
        return known

    def texts(self, title):
        """The C files: several where one would be long, since compilers work side by side. Functions that are inlined stand
        in every file that calls them."""
        inlined = {name for name, text in self.functions.items() if text.startswith("DALEMBERT_INLINE")}
        groups, length = [[]], 0
        for name, text in self.functions.items():
            if name in inlined:
                continue
            called = {other for other in inlined if f" {other}(" in text}
            size = len(text) + sum(len(self.functions[other]) for other in called)
            if groups[-1] and length + size > _LONG:
                groups.append([])
                length = 0
            groups[-1] += [*called, name]
            length += size
        chosen = [[name for name in self.functions if name in set(group)] for group in groups]
        return [_file(title, _text("vectors.h") + HEADER, map(self.functions.get, names)) for names in chosen]

    def lanes_text(self, title, names, tables):
        """The C file of some of the functions, and of what they call, for lanes, with their tables at its end; None
        without any."""
        called = {name for name in self.functions for user in names if f" {name}(" in self.functions[user]}
        chosen = [name for name in self.functions if name in names or name in called]
        renamed = [f"#define {name} LANES({name})" for name in chosen]
        text = _file(title, _lanes_header() + "\n".join(renamed) + "\n", map(self.functions.get, chosen))
        return text + "\n" + tables if chosen else None


def _file(title, header, functions):
    text = "\n".join(functions)
    inverses = _INVERSES if "dalembert_inverses" in text else ""
    return f"/* {title}: generated by codegen; do not edit. */\n{header}{_FACTORS}{inverses}{CONTRACT}\n{text}"


def _lanes_header():
    """The text of `lanes.h` with what it includes."""
    return _text("lanes.h").replace('#include "elementary.h"\n', _text("elementary.h"))


def _text(name):
    """A header of this folder: generated files stand on their own."""
    with open(os.path.join(os.path.dirname(__file__), name), encoding="utf-8") as stream:
        return stream.read()


CONTRACT = _text("contract.h")
"""The contract, which every generated file begins with, once it has said what a `real` is."""
