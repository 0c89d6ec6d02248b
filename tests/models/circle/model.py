"""A mass on two equal springs that runs on a circle, on which the guard is identically zero."""

from codegen.model import *

model = Model("Mass on a circle", source="test model: a guard that is zero but for rounding")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
omega = model.parameter("omega", "rad/s", 0.1, "angular velocity", above=0)
radius = model.parameter("radius", "m", 1.0, "radius of the circle", above=0)

x = model.coordinate("x", "m", "horizontal place")
y = model.coordinate("y", "m", "vertical place")
model.point_mass(m, position=(x, y))
model.potential(m * omega**2 * (x**2 + y**2) / 2)

outside = model.mode("outside", "not inside of the circle")
inside = model.mode("inside", "not outside of the circle")
distance = x**2 + y**2 - radius**2
model.transition("enter", outside, inside, when=falls(distance))
model.transition("leave", inside, outside, when=rises(distance))
