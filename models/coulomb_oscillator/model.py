"""A mass on a spring with dry friction and harmonic forcing, with or without stops; see README.md."""

from codegen.model import *

model = Model("Oscillator with Coulomb friction", source="Den Hartog, J. P. (1931), Trans. ASME 53, APM-53-9, 107-115")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness of the spring", minimum=0)
c = model.parameter("c", "N s/m", 0.0, "viscous damping", minimum=0)
static = model.parameter("static_friction", "N", 0.1, "largest static friction force", minimum=0)
kinetic = model.parameter("kinetic_friction", "N", 0.1, "kinetic friction force", minimum=0, at_most=static)
stop = model.parameter("stop", "m", 1e3, "distance of the two stops from the position of rest", above=0)
e = model.parameter("e", "1", 1.0, "restitution at the stops", minimum=0, maximum=1)

x = model.coordinate("x", "m", "displacement from the position of rest")
force = model.input("force", "N", "force on the mass")

model.point_mass(m, position=(x, 0))
model.potential(k * x**2 / 2)
model.dissipation(c * x.rate**2 / 2)
model.force(x, force)

model.friction("base", slip=x, normal=1, static=static, kinetic=kinetic)
model.contact("right", gap=stop - x, restitution=e)
model.contact("left", gap=x + stop, restitution=e)

model.draw("ground", [(-3, -0.1), (3, -0.1)], kind="fixed")
model.draw("wall", [(-3, -0.1), (-3, 0.4)], kind="fixed")
model.draw("spring", [(-3, 0), (x - 0.1, 0)], kind="spring")
model.draw("mass", [(x - 0.1, -0.1), (x + 0.1, -0.1), (x + 0.1, 0.1), (x - 0.1, 0.1)])
model.draw("base", [(x, -0.1)], kind="contact")
for name, side in (("right", 0.1), ("left", -0.1)):
    model.draw(name, [(x + side, 0)], kind="contact")
