"""The constants of codegen/elementary.c and the golden values of tests/data/sin_cos.csv.

    python3 tools/elementary.py constants
    python3 tools/elementary.py golden > tests/data/sin_cos.csv

With mpmath 1.3.0. Polynomials are Chebyshev's interpolants in z = x², of the errors stated there.
"""

import random
import struct
import sys

from mpmath import chebyfit, cos, floor, mp, mpf, pi, sin, sqrt

mp.prec = 1400


def constants():
    rest = pi / 2
    print("π/2 in parts of 27 bits, and what is left:")
    for part in range(5):
        bits = 27 if part < 4 else 53
        scale = mpf(2) ** (bits - 1 - int(floor(mp.log(rest, 2))))
        value = mp.nint(rest * scale) / scale if part == 4 else floor(rest * scale) / scale
        print(" ", float(value).hex())
        rest -= value
    print("2/π in words of 32 bits:")
    words, rest = [], 2 / pi
    for _ in range(40):
        rest *= 2 ** 32
        words.append(f"0x{int(floor(rest)):08x}")
        rest -= floor(rest)
    print(" ", ", ".join(words))
    sine = lambda z: (sin(sqrt(z)) / sqrt(z) - 1) / z if z else -mpf(1) / 6
    cosine = lambda z: (cos(sqrt(z)) - 1 + z / 2) / z ** 2 if z else mpf(1) / 24
    mp.prec = 200
    for name, function in (("sin", sine), ("cos", cosine)):
        coefficients, error = chebyfit(function, [mpf(10) ** -30, (pi / 4) ** 2 * mpf("1.0001")], 6, error=True)
        print(f"{name}: error {mp.nstr(error, 3)}")
        for c in reversed(coefficients):
            print(" ", float(c).hex())


def arguments():
    draw = random.Random(1)
    yield from (0.0, 5e-324, 1e-300, 1e-8, 2.0 ** -27, 0.5, 1.0, 1e22, 1.7976931348623157e308)
    # The doubles nearest to a multiple of π/2 (Muller 2016, Elementary Functions, 11.3.2), and those
    # nearest to small multiples.
    yield 6381956970095103.0 * 2.0 ** 797
    for n in range(1, 40):
        yield float(n * pi / 2)
    for n in range(1, 20):
        yield float(n * pi / 4)
    for _ in range(400):
        yield draw.uniform(-10.0, 10.0)
    for _ in range(200):
        yield draw.choice((-1, 1)) * 2.0 ** draw.uniform(-30, 26)
    for _ in range(100):
        yield float(draw.randrange(1, 2 ** 26) * pi / 2)
    for _ in range(200):
        yield draw.choice((-1, 1)) * 2.0 ** draw.uniform(26, 1024)


def golden():
    """Bits of x; then for sin x and cos x the bits of the nearest double and, in units of its last
    place, what it is off by."""
    print("x,sin,sin_rest,cos,cos_rest")
    bits = lambda x: f"{struct.unpack('<Q', struct.pack('<d', x))[0]:016x}"
    for x in arguments():
        row = [bits(x)]
        for function in (sin, cos):
            exact = function(mpf(x))
            near = float(exact)
            unit = mpf(2) ** max(-1074, mp.frexp(mpf(near))[1] - 53) if near else mpf(2) ** -1074
            row += [bits(near), f"{float((exact - mpf(near)) / unit):.4f}"]
        print(",".join(row))


{"constants": constants, "golden": golden}[sys.argv[1]]()
