"""A mass on a spring with dry friction and harmonic forcing, with or without stops; its modes written by hand."""

from codegen.model import *

model = Model("Oscillator with Coulomb friction", source="Den Hartog, J. P. (1931), Trans. ASME 53, APM-53-9, 107-115")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness of the spring", minimum=0)
c = model.parameter("c", "N s/m", 0.0, "viscous damping", minimum=0)
static = model.parameter("static_friction", "N", 0.1, "largest static friction force", minimum=0)
kinetic = model.parameter("kinetic_friction", "N", 0.1, "kinetic friction force", minimum=0, at_most=static)
stop = model.parameter("stop", "m", 1e3, "distance of the two stops from the position of rest", above=0)
e = model.parameter("e", "1", 1.0, "restitution at the stops", minimum=0, maximum=1)

x = model.coordinate("x", "m", "displacement from the position of rest", minimum=-stop, maximum=stop)
slip = model.discrete("slip", (+1, -1), "direction of slip")
force = model.input("force", "N", "force on the mass")

model.point_mass(m, position=(x, 0))
model.potential(k * x**2 / 2)
model.dissipation(c * x.rate**2 / 2)
model.force(x, force)

slides = model.mode("slides", "in motion")
sticks = model.mode("sticks", "held by friction", freeze=[x])
at_stops = {
    +1: model.mode("rests_right", "pressed against the stop on the right", freeze=[(x, stop)]),
    -1: model.mode("rests_left", "pressed against the stop on the left", freeze=[(x, -stop)]),
}
slides.force(x, -kinetic * slip)

stops = falls(slip * x.rate)
model.transition("stick", slides, sticks, when=stops, provided=[static + sticks.reaction(x), static - sticks.reaction(x)])
model.transition("reversal", slides, slides, when=stops, reset=[(slip, -slip), (x.rate, 0)])
for direction in (+1, -1):
    model.transition("slip", sticks, slides, when=falls(static + direction * sticks.reaction(x)), reset=[(slip, direction)])
    model.transition(
        "impact", slides, slides, when=falls(stop - direction * x), impact=True,
        reset=[(x, direction * stop), (x.rate, -e * x.rate), (slip, -direction)])

# A stop pushes the mass away from it; friction alone can hold it back there.
for direction, rests in at_stops.items():
    model.rest(slides, rests)
    model.transition("leave", rests, slides, when=falls(static - direction * rests.reaction(x)), reset=[(slip, -direction)])

model.draw("ground", [(-3, -0.1), (3, -0.1)], kind="fixed")
model.draw("wall", [(-3, -0.1), (-3, 0.4)], kind="fixed")
model.draw("spring", [(-3, 0), (x - 0.1, 0)], kind="spring")
model.draw("mass", [(x - 0.1, -0.1), (x + 0.1, -0.1), (x + 0.1, 0.1), (x - 0.1, 0.1)])
model.draw("base", [(x, -0.1)], kind="contact", force=(x, None),
           states=[(slides, "slides"), (sticks, "sticks")] + [(rests, "sticks") for rests in at_stops.values()])
