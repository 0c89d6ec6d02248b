"""The woodpecker toy by a second method, for tests: writes tests/data/woodpecker.json.

Between events its equations are linear with constant coefficients, so that each phase is a power series, here of 40 digits;
events are found by bisection, and at each all sets of contact states are tried. Newton's law with Coulomb's for impulses
(Moreau 1988), or Poisson's with compression and expansion (Glocker 1995), all contacts that touch at once. The numbers of the
model: Leine, Van Campen and Glocker (2003).
"""
import itertools
import json
import os

from mpmath import lu_solve, matrix, mp, mpf, zeros

mp.dps = 40
mM, JM, mS, JS, c = mpf("0.0003"), mpf("5e-9"), mpf("0.0045"), mpf("7e-7"), mpf("0.0056")
r0, rM, hM, lM, lG, hS, lS = map(mpf, ("0.0025", "0.0031", "0.0058", "0.010", "0.015", "0.02", "0.0201"))
mu, g = mpf("0.3"), mpf("9.81")
e = [mpf("0.5"), mpf(0), mpf(0)]
M = matrix([[mS + mM, mS * lM, mS * lG], [mS * lM, JM + mS * lM**2, mS * lM * lG], [mS * lG, mS * lM * lG, JS + mS * lG**2]])
K = matrix([[0, 0, 0], [0, -c, c], [0, c, -c]])
k0 = matrix([-(mS + mM) * g, -mS * g * lM, -mS * g * lG])
WN = [matrix([0, 0, -hS]), matrix([0, hM, 0]), matrix([0, -hM, 0])]
gN0 = [lM + lG - lS - r0, rM - r0, rM - r0]
WT = [matrix([1, lM, lG - lS]), matrix([1, rM, 0]), matrix([1, rM, 0])]
dot = lambda a, b: sum(a[i] * b[i] for i in range(3))
NAMES = ("beak", "bottom", "top")


def solve(modes):
    """(A, b) of q'' = A q + b, and rows of the forces (normal, tangent) as (row, constant), while contacts are in modes."""
    rows, cols, names = [], [], []
    for k, m in enumerate(modes):
        if m == "open":
            continue
        if m == "stick":
            cols += [WN[k], WT[k]]
            rows += [WN[k], WT[k]]
            names += [("N", k), ("T", k)]
        else:
            s = m
            cols.append(WN[k] - mu * s * WT[k])
            rows.append(WN[k])
            names.append(("N", k))
    n = len(cols)
    big = zeros(3 + n)
    for i in range(3):
        for j in range(3):
            big[i, j] = M[i, j]
        for j in range(n):
            big[i, 3 + j] = -cols[j][i]
            big[3 + j, i] = rows[j][i]
    full = zeros(3 + n, 4)
    for i in range(3):
        for j in range(3):
            full[i, j] = K[i, j]
        full[i, 3] = k0[i]
    sol = zeros(3 + n, 4)
    for j in range(4):
        col = lu_solve(big, full[:, j])
        for i in range(3 + n):
            sol[i, j] = col[i]
    return sol, names


def forces(sol, names, q):
    out = {}
    for i, name in enumerate(names):
        out[name] = sum(sol[3 + i, j] * q[j] for j in range(3)) + sol[3 + i, 3]
    return out


def series(sol, q, u, order=40):
    cs = [matrix(q), matrix(u)]
    for n in range(order):
        a = matrix([sum(sol[i, j] * cs[n][j] for j in range(3)) + (sol[i, 3] if n == 0 else 0) for i in range(3)])
        cs.append(a / ((n + 1) * (n + 2)))
    return cs


def at(cs, t):
    q, u = matrix([0, 0, 0]), matrix([0, 0, 0])
    for n in reversed(range(len(cs))):
        q = q * t + cs[n]
    for n in reversed(range(1, len(cs))):
        u = u * t + n * cs[n]
    return q, u


gap = lambda k, q: dot(WN[k], q) + gN0[k]
TINY = mpf("1e-30")


def guards(modes, sol, names, q, u):
    f = forces(sol, names, q)
    out = []
    for k, m in enumerate(modes):
        if m == "open":
            out.append((gap(k, q), k, "gap"))
            continue
        out.append((f["N", k], k, "normal"))
        if m == "stick":
            out += [(mu * f["N", k] - f["T", k], k, "+"), (mu * f["N", k] + f["T", k], k, "-")]
        else:
            out.append((m * dot(WT[k], u), k, "slip"))
    return out


def next_modes(q, u, closed):
    """The set of states that goes on from here: what it needs holds a little later."""
    choices = []
    for k in range(3):
        if k not in closed:
            choices.append(["open"])
        else:
            rate = dot(WT[k], u)
            choices.append(["open"] + (["stick", 1, -1] if abs(rate) < TINY else [1 if rate > 0 else -1]))
    found = []
    for modes in itertools.product(*choices):
        try:
            sol, names = solve(modes)
        except ZeroDivisionError:
            continue
        cs = series(sol, q, u, 12)
        good = True
        for t in (mpf("1e-9"), mpf("1e-8")):
            qq, uu = at(cs, t)
            if any(value <= 0 for value, *_ in guards(modes, sol, names, qq, uu)):
                good = False
        if good:
            found.append(modes)
    assert len(found) == 1, found
    return found[0]


def impulses(u, touching, want, least):
    """The rates after impulses of the contacts that touch, and the normal ones: a normal rate is at least its `want`, an impulse at
    least its `least`, and where it is more the rate is no more; Coulomb's law for impulses, with the rates after them."""
    found = []
    # What must deliver an impulse has friction; what need not may deliver none.
    may = [["out"] if k not in touching else ["stick", 1, -1] if least[k] else ["none", "stick", 1, -1] for k in range(3)]
    for states in itertools.product(*may):
        rubs = [s not in ("none", "out") for s in states]
        for pressed in itertools.product(*[[False] if not rubs[k] else [True, False] if least[k] else [True] for k in range(3)]):
            # Unknown: u, then of each contact what its normal impulse is beyond its least, and its tangential one.
            unknown = [("N", k) for k in range(3) if pressed[k]] + [("T", k) for k in range(3) if states[k] == "stick"]
            column = lambda of: WN[of[1]] - mu * states[of[1]] * WT[of[1]] if of[0] == "N" and states[of[1]] in (1, -1) else \
                (WN if of[0] == "N" else WT)[of[1]]
            big, rhs = zeros(3 + len(unknown)), zeros(3 + len(unknown), 1)
            given = M * u
            for k, s in enumerate(states):
                if rubs[k]:
                    given += least[k] * (WN[k] if s == "stick" else WN[k] - mu * s * WT[k])
            for i in range(3):
                rhs[i] = given[i]
                for j in range(3):
                    big[i, j] = M[i, j]
                for j, of in enumerate(unknown):
                    big[i, 3 + j] = -column(of)[i]
                    big[3 + j, i] = (WN if of[0] == "N" else WT)[of[1]][i]
            for j, (what, k) in enumerate(unknown):
                rhs[3 + j] = want[k] if what == "N" else mpf(0)
            try:
                x = lu_solve(big, rhs)
            except ZeroDivisionError:
                continue
            v = matrix([x[0], x[1], x[2]])
            P = {of: x[3 + i] for i, of in enumerate(unknown)}
            good = True
            for k in touching:
                beyond, s = P.get(("N", k), mpf(0)), states[k]
                good &= beyond > TINY if pressed[k] else dot(WN[k], v) - want[k] >= -TINY
                if s == "stick":
                    good &= abs(P["T", k]) <= mu * (least[k] + beyond)
                elif s != "none":
                    good &= s * dot(WT[k], v) > 0
            if good:
                found.append((v, [least[k] + P.get(("N", k), mpf(0)) for k in range(3)], states))
    assert len(found) == 1, [f[2] for f in found]
    return found[0][:2]


def newton(u, touching):
    return impulses(u, touching, [-e[k] * dot(WN[k], u) for k in range(3)], [mpf(0)] * 3)[0]


def poisson(u, touching):
    """Compression until no normal rate is negative; expansion by at least e times the impulse of compression."""
    u, compression = impulses(u, touching, [mpf(0)] * 3, [mpf(0)] * 3)
    return impulses(u, touching, [mpf(0)] * 3, [e[k] * compression[k] for k in range(3)])[0]


def word(modes):
    return ", ".join(f"{NAMES[k]} {m if m == 'open' else 'sticks' if m == 'stick' else 'slides'}" for k, m in enumerate(modes))


def simulate(q, u, end, law):
    t, modes = mpf(0), ("open", "open", "open")
    events = []
    while t < end:
        sol, names = solve(modes)
        h = mpf("2e-4")
        cs = series(sol, q, u, 30)
        lo, hit = mpf(0), None
        while hit is None:
            hi = lo + h
            if hi > mpf("0.004"):
                q, u = at(cs, lo)
                t += lo
                cs, lo, hi = series(sol, q, u, 30), mpf(0), h
            qq, uu = at(cs, hi)
            fell = [(k, what) for value, k, what in guards(modes, sol, names, qq, uu) if value < 0]
            if fell:
                a, b = lo if lo > 0 or t > 0 else mpf(0), hi
                a = max(a, mpf("1e-12"))
                times = []
                for k, what in fell:
                    x, y = a, b
                    for _ in range(110):
                        m = (x + y) / 2
                        qq, uu = at(cs, m)
                        value = next(v for v, kk, w in guards(modes, sol, names, qq, uu) if (kk, w) == (k, what))
                        x, y = (m, y) if value > 0 else (x, m)
                    times.append(((x + y) / 2, k, what))
                hit = min(times)
            lo = hi
            if t + lo > end:
                return events
        tau, k, what = hit
        q, u = at(cs, tau)
        t += tau
        closed = {j for j, m in enumerate(modes) if m != "open"}
        # What holds is zero exactly.
        if what == "gap":
            closed.add(k)
            u = law(u, closed)
            closed = {j for j in closed if abs(dot(WN[j], u)) < TINY}
            verb = "strikes"
        elif what == "normal":
            closed.discard(k)
            verb = "opens"
        else:
            verb = None
        before = modes
        modes = ("open",) * 3 if not closed else next_modes(q, u, closed)
        if verb is None:
            verb = {"stick": "sticks"}.get(modes[k], "slips" if before[k] == "stick" else "reverses")
        events.append({"t": mp.nstr(t, 25), "transition": f"{NAMES[k]} {verb}", "mode_after": word(modes),
                       "q": [mp.nstr(x, 22) for x in q], "u_after": [mp.nstr(x, 22) for x in u]})
    return events


# Under Poisson's law the published toy does what it does under Newton's; a rough pole and a sleeve that bounces tell the two apart.
PUBLISHED = {"mu": "0.3", "e_sleeve": "0", "initial": {"phi_M": "-0.1034", "phi_S": "-0.2788", "y.rate": "-0.3411", "phi_S.rate": "-7.4583"}, "end": "0.45"}
ROUGH = [
    {"mu": "1", "e_sleeve": "0.3", "initial": {"y.rate": "0.21", "phi_M.rate": "2.1", "phi_S.rate": "10.8"}, "end": "0.03"},
    {"mu": "1", "e_sleeve": "0.3", "initial": {"y.rate": "0.03", "phi_M.rate": "-7.1", "phi_S.rate": "14.6"}, "end": "0.03"},
    {"mu": "0.6", "e_sleeve": "0", "initial": {"y.rate": "0.15", "phi_M.rate": "-9", "phi_S.rate": "10.9"}, "end": "0.03"},
]


def solved(case, law):
    global mu
    mu = mpf(case["mu"])
    e[1] = e[2] = mpf(case["e_sleeve"])
    start = lambda suffix: matrix([mpf(case["initial"].get(name + suffix, "0")) for name in ("y", "phi_M", "phi_S")])
    return {**case, "law": law.__name__, "events": simulate(start(""), start(".rate"), mpf(case["end"]), law)}


if __name__ == "__main__":
    cases = [solved(PUBLISHED, newton), solved(PUBLISHED, poisson), *(solved(case, law) for case in ROUGH for law in (newton, poisson))]
    target = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "data", "woodpecker.json")
    with open(target, "w", encoding="utf-8") as stream:
        json.dump({"source": "tools/woodpecker.py: a second method, to 40 digits", "cases": cases}, stream, indent=1)
        stream.write("\n")
