"""A slender block that rocks on its corners; what a landing does is Housner's, stated by the model and not by contact."""

from codegen.model import *

model = Model("Rocking block with a landing of its own", source="Housner, G. W. (1963), Bull. Seismol. Soc. Am. 53(2), 403-417")

b = model.parameter("b", "m", 0.2, "half of the width", above=0)
h = model.parameter("h", "m", 0.6, "half of the height", above=0)
m = model.parameter("m", "kg", 1.0, "mass", above=0)
r = model.parameter("r", "1", 0.8, "part of the turning rate that a landing leaves", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
x = model.coordinate("x", "m", "centre, to the right")
y = model.coordinate("y", "m", "centre, height over the ground")
theta = model.coordinate("theta", "rad", "tilt, counter-clockwise")
model.gravity(g)
model.rigid_body(m, inertia=m * (b**2 + h**2) / 3, position=(x, y), angle=theta)
for name, side in (("left", -1), ("right", 1)):
    corner = (x + side * b * cos(theta) + h * sin(theta), y + side * b * sin(theta) - h * cos(theta))
    model.contact(name, gap=corner[1], slip=corner[0], kinetic=5)
    # It turns about the corner that lands, slower.
    after = r * theta.rate
    model.impact(name, [(theta.rate, after), (x.rate, -h * after), (y.rate, -side * b * after)])
