"""A block that slides to rest and carries a mass on a stiff, damped spring."""

from codegen.model import *

model = Model("Sliding block with a stiff oscillator", source="test model: stiffness across the last slip of a block")

M = model.parameter("M", "kg", 1.0, "mass of the block", above=0)
m = model.parameter("m", "kg", 0.1, "mass on the spring", above=0)
k = model.parameter("k", "N/m", 1e6, "stiffness", minimum=0)
c = model.parameter("c", "N s/m", 0.0, "damping", minimum=0)
mu = model.parameter("mu", "1", 0.3, "friction coefficient", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "place of the block")
r = model.coordinate("r", "m", "elongation of the spring")
slip = model.discrete("slip", (+1, -1), "direction of slip")
model.point_mass(M, position=(x, 0))
model.point_mass(m, position=(x + r, 0))
model.potential(k * r**2 / 2)
model.dissipation(c * r.rate**2 / 2)

slides = model.mode("slides", "slips on the ground")
sticks = model.mode("sticks", "held by friction", freeze=[x])
limit = mu * (M + m) * g
slides.force(x, -limit * slip)
stops = falls(slip * x.rate)
model.transition("stick", slides, sticks, when=stops, provided=[limit + sticks.reaction(x), limit - sticks.reaction(x)])
model.transition("reversal", slides, slides, when=stops, reset=[(slip, -slip), (x.rate, 0)])
for direction in (+1, -1):
    model.transition("slip", sticks, slides, when=falls(limit + direction * sticks.reaction(x)), reset=[(slip, direction)])
