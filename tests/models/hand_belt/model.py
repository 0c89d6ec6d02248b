"""A mass on a spring and a damper that a moving belt drags along: stick-slip; its modes written by hand."""

from codegen.model import *

model = Model("Stick-slip oscillator on a moving belt", source="Den Hartog, J. P. (1956), Mechanical Vibrations, 4th ed., section 7.6; Leine, R. I. et al. (1998), Nonlinear Dyn. 16, 41-54")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness of the spring", minimum=0)
c = model.parameter("c", "N s/m", 0.0, "damping of the damper", minimum=0)
belt = model.parameter("belt", "m/s", 0.1, "velocity of the belt")
mu_s = model.parameter("mu_s", "1", 0.4, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.25, "kinetic friction coefficient", minimum=0, at_most=mu_s)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "elongation of the spring, in the direction of the belt")
y = model.coordinate("y", "m", "height; its reaction is the normal force")
slip = model.discrete("slip", (-1, +1), "sign of the velocity of the mass relative to the belt")
force = model.input("force", "N", "force on the mass, in the direction of the belt")

model.gravity(g)
model.point_mass(m, position=(x, y))
model.potential(k * x**2 / 2)
model.dissipation(c * x.rate**2 / 2)
model.force(x, force)

slips = model.mode("slips", "slips on the belt", freeze=[(y, 0)])
sticks = model.mode("sticks", "moves with the belt", freeze=[x, (y, 0)], drift=[(x, belt)])

slips.friction(x, normal=slips.reaction(y), coefficient=mu_k, direction=slip, against=belt)
stops = falls(slip * (x.rate - belt))
limit = mu_s * sticks.reaction(y)
model.transition("stick", slips, sticks, when=stops, provided=[limit + sticks.reaction(x), limit - sticks.reaction(x)])
model.transition("reversal", slips, slips, when=stops, reset=[(slip, -slip), (x.rate, belt)])
for direction in (+1, -1):
    model.transition("slip", sticks, slips, when=falls(limit + direction * sticks.reaction(x)), reset=[(slip, direction)])

model.output("slip_rate", "m/s", x.rate - belt, "velocity of the mass relative to the belt")
model.output("friction", "N", m * x.acceleration + k * x + c * x.rate - force, "force of the belt on the mass, in its direction")

model.draw("belt", [(-1, -0.1), (2, -0.1)], kind="fixed")
model.draw("wall", [(-1, -0.1), (-1, 0.4)], kind="fixed")
model.draw("spring", [(-1, 0), (x - 0.1, 0)], kind="spring")
model.draw("mass", [(x - 0.1, -0.1), (x + 0.1, -0.1), (x + 0.1, 0.1), (x - 0.1, 0.1)])
model.draw("base", [(x, -0.1)], kind="contact", force=(x, y), states=[(slips, "slides"), (sticks, "sticks")])
