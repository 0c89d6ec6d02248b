"""A ground motion of our own, with a horizontal and a vertical component: studies/records/synthetic.csv.

Sums of cosines with random phases (Shinozuka, M. and Deodatis, G. (1991), Appl. Mech. Rev. 44(4), 191-204), whose spectrum
is that of Kanai and Tajimi times the high-pass filter of Clough and Penzien, under the envelope of Amin and Ang (1968).
No record of an earthquake is in it. Run: python3 tools/synthetic_record.py > studies/records/synthetic.csv
"""

import math

STEP = 0.01  # s
DURATION = 20.0  # s
HIGHEST = 25.0  # Hz, half of what the step can hold
LINES = 500  # as many that no phase comes back within the duration
FILTER = (0.4, 0.6)  # Clough and Penzien: frequency in Hz, damping
RISE, STRONG, DECAY = 2.0, 9.0, 0.4  # s, s, 1/s
# Name, peak in m/s^2, frequency (Hz) and damping of the ground, seed.
COMPONENTS = (("h", 4.0, 2.5, 0.6, 1), ("v", 2.4, 5.0, 0.6, 2))


def phases(seed):
    """Numbers from 0 to 2 pi (Knuth's generator), the same everywhere."""
    state = seed
    while True:
        state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
        yield (state >> 11) / 2**53 * 2.0 * math.pi


def density(f, ground, damping):
    """Of power at a frequency, without its scale."""
    r = f / ground
    soil = (1.0 + (2.0 * damping * r) ** 2) / ((1.0 - r * r) ** 2 + (2.0 * damping * r) ** 2)
    r = f / FILTER[0]
    return soil * r**4 / ((1.0 - r * r) ** 2 + (2.0 * FILTER[1] * r) ** 2)


def envelope(t):
    if t < RISE:
        return (t / RISE) ** 2
    return 1.0 if t < STRONG else math.exp(-DECAY * (t - STRONG))


def component(peak, ground, damping, seed):
    width = HIGHEST / LINES
    frequencies = [(k + 0.5) * width for k in range(LINES)]
    lines = [(2.0 * math.pi * f, math.sqrt(density(f, ground, damping)), phase)
             for f, phase in zip(frequencies, phases(seed))]
    times = [STEP * i for i in range(round(DURATION / STEP) + 1)]
    values = [envelope(t) * sum(a * math.cos(w * t + phase) for w, a, phase in lines) for t in times]
    largest = max(map(abs, values))
    return [peak * value / largest for value in values]


def main():
    columns = [component(*rest) for _, *rest in COMPONENTS]
    print("# Synthetic: tools/synthetic_record.py. No earthquake.")
    print(",".join(["t_s", *(f"{name}_m_s2" for name, *_ in COMPONENTS)]))
    for i, row in enumerate(zip(*columns)):
        print(",".join([f"{STEP * i:.2f}", *(f"{value:.5f}" for value in row)]))


if __name__ == "__main__":
    main()
