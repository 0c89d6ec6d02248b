"""Computes tests/data/forced_pendulum.json: where driven pendulums are after 10 s, to 25 digits.

    python3 tools/forced_pendulum.py > tests/data/forced_pendulum.json

Needs mpmath. theta'' = -g sin theta + sin(omega t) by Taylor series in 40 digits; half the step gives the
same 30 digits. The members are those of the ensemble in benches/ensemble.rs and benches/peers/ensemble.py.
"""

import json

from mpmath import mp, mpf, nstr

GRAVITY, OMEGA, END, MEMBERS = 4.84, 9.42477796076938, 10, 512
EVERY, ORDER = 16, 40


def initial(member):
    """Angle and rate of a member: evenly spread, not in step with each other."""
    return 3.0 * (member * 0.6180339887498949 % 1.0) - 1.5, 2.0 * (member * 0.41421356237309515 % 1.0) - 1.0


def end(theta, rate, steps):
    h, omega, gravity = mpf(END) / steps, mpf(OMEGA), mpf(GRAVITY)
    theta, rate = mpf(theta), mpf(rate)
    for step in range(steps):
        x, s, c = [theta, rate], [mp.sin(theta)], [mp.cos(theta)]
        phase = omega * h * step
        drive = [mp.sin(phase), omega * mp.cos(phase)]
        for k in range(ORDER):
            x.append((drive[k] - gravity * s[k]) / ((k + 1) * (k + 2)))
            n = k + 1
            s.append(sum(j * x[j] * c[n - j] for j in range(1, n + 1)) / n)
            c.append(-sum(j * x[j] * s[n - j] for j in range(1, n + 1)) / n)
            drive.append(-omega**2 * drive[k] / ((k + 1) * (k + 2)))
        theta = mp.polyval(x[::-1], h)
        rate = mp.polyval([k * x[k] for k in range(1, len(x))][::-1], h)
    return theta, rate


def main():
    mp.dps = 40
    rows = []
    for member in range(0, MEMBERS, EVERY):
        start = initial(member)
        coarse, fine = end(*start, 100), end(*start, 200)
        assert all(abs(a - b) < mpf("1e-30") for a, b in zip(coarse, fine)), member
        rows.append({"member": member, "start": list(map(repr, start)), "end": [nstr(value, 25) for value in fine]})
    lines = ",\n  ".join(map(json.dumps, rows))
    print(f'{{\n "title": "Driven pendulums",\n "source": "tools/forced_pendulum.py",\n "members": [\n  {lines}\n ]\n}}')


if __name__ == "__main__":
    main()
