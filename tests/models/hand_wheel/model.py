"""The wheel of `rolling_wheel`, its modes by hand, in coordinates that make a slip of one of them and leave out the other wheel."""

from codegen.model import *

model = Model("Wheel on a rail, by hand", source="test model: tests/engine/lines.rs")

m = model.parameter("m", "kg", 2.0, "mass of the wheel", above=0)
r = model.parameter("r", "m", 0.3, "its radius", above=0)
J = model.parameter("J", "kg m^2", 0.09, "its inertia", above=0)
j = model.parameter("j", "kg m^2", 0.02, "inertia of the other wheel", above=0)
ratio = model.parameter("ratio", "1", 2.5, "turns of the other wheel for one of this", above=0)
k = model.parameter("k", "N/m", 8.0, "stiffness of a spring at the hub", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", above=0)
mu_s = model.parameter("mu_s", "1", 0.3, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.25, "kinetic friction coefficient", minimum=0, at_most=mu_s)
moment = model.input("moment", "N m", "moment on the wheel, along its angle")

slipped = model.coordinate("slipped", "m", "how far the hub is ahead of the wheel's turns")
phi = model.coordinate("phi", "rad", "angle of the wheel; it rolls along x")
direction = model.discrete("direction", (-1, +1), "of the slip")

x, rate = slipped + r * phi, slipped.rate + r * phi.rate
model.kinetic(m * rate**2 / 2 + (J + j * ratio**2) * phi.rate**2 / 2)
model.potential(k * x**2 / 2)
model.force(phi, moment)

sticks = model.mode("sticks", "the wheel rolls", freeze=[slipped])
slides = model.mode("slides", "the wheel slips")
slides.friction(slipped, normal=m * g, coefficient=mu_k, direction=direction)
margins = {+1: mu_s * m * g + sticks.reaction(slipped), -1: mu_s * m * g - sticks.reaction(slipped)}
for way, margin in margins.items():
    model.transition("slips", sticks, slides, when=falls(margin), reset=[(direction, way)])
stops = falls(direction * slipped.rate)
model.transition("sticks", slides, sticks, when=stops, provided=list(margins.values()))
model.transition("reverses", slides, slides, when=stops, reset=[(direction, -direction), (slipped.rate, 0)])
