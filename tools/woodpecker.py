"""The woodpecker toy by a second method, for tests: writes tests/data/woodpecker.json.

Between events its equations are linear with constant coefficients, so that each phase is a power series, here of 40 digits;
events are found by bisection, and at each all sets of contact states are tried. Newton's law with Coulomb's for impulses
(Moreau 1988), all contacts that touch at once. The numbers of the model: Leine, Van Campen and Glocker (2003).
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


def impact(q, u, touching):
    found = []
    for states in itertools.product(*[["none", "stick", 1, -1] if k in touching else ["none"] for k in range(3)]):
        cols, rows, want, names = [], [], [], []
        for k, s in enumerate(states):
            if s == "none":
                continue
            cols.append(WN[k] if s == "stick" else WN[k] - mu * s * WT[k])
            rows.append(WN[k]); want.append(-e[k] * dot(WN[k], u)); names.append(("N", k))
            if s == "stick":
                cols.append(WT[k]); rows.append(WT[k]); want.append(mpf(0)); names.append(("T", k))
        n = len(cols)
        big, rhs = zeros(3 + n), zeros(3 + n, 1)
        Mu = M * u
        for i in range(3):
            rhs[i] = Mu[i]
            for j in range(3):
                big[i, j] = M[i, j]
            for j in range(n):
                big[i, 3 + j] = -cols[j][i]
                big[3 + j, i] = rows[j][i]
        for j in range(n):
            rhs[3 + j] = want[j]
        try:
            x = lu_solve(big, rhs)
        except ZeroDivisionError:
            continue
        v = matrix([x[0], x[1], x[2]])
        P = {name: x[3 + i] for i, name in enumerate(names)}
        good = True
        for k in touching:
            s = states[k]
            if s == "none":
                good &= dot(WN[k], v) + e[k] * dot(WN[k], u) >= -TINY
            else:
                good &= P["N", k] > 0
                if s == "stick":
                    good &= abs(P["T", k]) <= mu * P["N", k]
                else:
                    good &= s * dot(WT[k], v) > 0
        if good:
            found.append((v, states))
    assert len(found) == 1, [f[1] for f in found]
    return found[0][0]


def word(modes):
    return ", ".join(f"{NAMES[k]} {m if m == 'open' else 'sticks' if m == 'stick' else 'slides'}" for k, m in enumerate(modes))


def simulate(q, u, end):
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
            u = impact(q, u, closed)
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


if __name__ == "__main__":
    q = matrix([0, mpf("-0.1034"), mpf("-0.2788")])
    u = matrix([mpf("-0.3411"), 0, mpf("-7.4583")])
    events = simulate(q, u, mpf("0.45"))
    source = "tools/woodpecker.py: a second method, to 40 digits"
    target = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "data", "woodpecker.json")
    with open(target, "w", encoding="utf-8") as stream:
        json.dump({"source": source, "events": events}, stream, indent=1)
        stream.write("\n")
