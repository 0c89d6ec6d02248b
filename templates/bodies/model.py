"""A rod on a cart, stated by its bodies: see README.md."""

from codegen.model import *

model = Model("Rod on a cart", source="any textbook of mechanics")

# Constants of a run: name, unit, default, meaning. A scene may give other values within the limits.
M = model.parameter("M", "kg", 2.0, "mass of the cart", above=0)
m = model.parameter("m", "kg", 1.0, "mass of the rod, which is slender and homogeneous", above=0)
l = model.parameter("l", "m", 1.0, "length of the rod", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

# What moves, and what is held: the force that holds y is that of the rails.
x = model.coordinate("x", "m", "place of the cart, to the right")
y = model.coordinate("y", "m", "height of the cart above the rails")
theta = model.coordinate("theta", "rad", "angle of the rod from hanging, counter-clockwise")
force = model.input("force", "N", "force on the cart, to the right")

# Bodies in the plane: X to the right, Y up; a rod about its centre has the moment of inertia m l²/12.
model.gravity(g)
model.point_mass(M, position=(x, y))
model.rigid_body(m, m * l**2 / 12, position=(x + l / 2 * sin(theta), y - l / 2 * cos(theta)), angle=theta)
model.force(x, force)

# One mode: the cart stays on its rails.
rolls = model.mode("rolls", "on its rails", freeze=[(y, 0)])
model.requires(rolls, rolls.reaction(y), "the cart would leave its rails")

# What pages show: `dalembert run scene.json --html page.html`.
model.draw("rails", [(-2, 0), (2, 0)], kind="fixed")
model.draw("cart", [(x - 0.2, y - 0.05), (x + 0.2, y - 0.05), (x + 0.2, y + 0.05), (x - 0.2, y + 0.05)])
model.draw("rod", [(x, y), (x + l * sin(theta), y - l * cos(theta))], kind="line")
