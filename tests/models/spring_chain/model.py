"""Masses between springs and dampers; the first rests on a rough belt. As many as are asked for, up to N."""

from codegen.model import *

N = 7

model = Model("Chain of masses with friction", source="test model: any number of free coordinates, which stick and slip")

masses = int(model.choice("masses", [str(n) for n in range(N, 0, -1)], "how many masses move; the others are held"))
m = model.parameter("m", "kg", 1.0, "each mass", above=0)
k = model.parameter("k", "N/m", 100.0, "stiffness of each spring", minimum=0)
k_3 = model.parameter("k_3", "N/m^3", 0.0, "by which it stiffens", minimum=0)
c = model.parameter("c", "kg/s", 0.1, "each damper", minimum=0)
friction = model.parameter("friction", "N", 5.0, "friction of the first mass on the belt while it slips", minimum=0)
holds = model.parameter("holds", "N", 6.0, "largest friction while it sticks", minimum=0)
belt = model.parameter("belt", "m/s", 0.1, "speed of the belt", above=0)

places = [model.coordinate(f"x_{i}", "m", f"displacement of mass {i}") for i in range(1, N + 1)]
slip = model.discrete("slip", (-1, +1), "direction of slip of the first mass on the belt")

moving = places[:masses]
for x in moving:
    model.kinetic(m * x.rate**2 / 2)
# A spring to the wall, one between each two, and one from the last.
ends = [0, *moving, 0]
rates = [0, *(x.rate for x in moving), 0]
for left, right, left_rate, right_rate in zip(ends, ends[1:], rates, rates[1:]):
    stretch = right - left
    model.potential(k * stretch**2 / 2 + k_3 * stretch**4 / 4)
    model.dissipation(c * (right_rate - left_rate) ** 2 / 2)

first, held = places[0], [(x, 0) for x in places[masses:]]
slips = model.mode("slips", "the first mass slips on the belt", freeze=held)
sticks = model.mode("sticks", "the first mass goes with the belt", freeze=[first, *held], drift=[(first, belt)])
slips.force(first, -slip * friction)

# The belt drags the mass by a force that friction can give.
margins = {-1: holds - sticks.reaction(first), +1: holds + sticks.reaction(first)}
for direction, margin in margins.items():
    model.transition("slip", sticks, slips, when=falls(margin), reset=[(slip, direction)])
stops = falls(slip * (first.rate - belt))
model.transition("stick", slips, sticks, when=stops, provided=list(margins.values()))
model.transition("reversal", slips, slips, when=stops, reset=[(slip, -slip), (first.rate, belt)])
