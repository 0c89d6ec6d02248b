"""A mass that falls onto a spring: stiffness that an event switches on and off."""

from codegen.model import *

model = Model("Mass on a buffer", source="test model: a stiff spring that an impact switches on")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1e6, "stiffness of the buffer", minimum=0)
c = model.parameter("c", "N s/m", 0.0, "damping of the buffer", minimum=0)
g = model.parameter("g", "m/s^2", 10.0, "gravity", minimum=0)

x = model.coordinate("x", "m", "height above the relaxed buffer")
model.gravity(g)
model.point_mass(m, position=(0, x))

flies = model.mode("flies", "above the buffer")
presses = model.mode("presses", "on the buffer")
presses.force(x, -k * x - c * x.rate)
model.transition("press", flies, presses, when=falls(x))
model.transition("leave", presses, flies, when=rises(x))
