"""A disc that falls into a wedge: two contacts with friction, and spin."""

from codegen.model import *

model = Model("Disc in a wedge", source="Newton's law of restitution and Coulomb's of friction (Moreau 1988)")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
R = model.parameter("R", "m", 0.5, "radius", above=0)
n_x = model.parameter("n_x", "1", 0.6, "normal of the left side, to the right", above=0)
n_y = model.parameter("n_y", "1", 0.8, "normal of the left side, upwards", above=0)
mu = model.parameter("mu", "1", 0.3, "friction", minimum=0)
e = model.parameter("e", "1", 0.0, "restitution", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
f_x = model.parameter("f_x", "m/s^2", 0.0, "force on the mass, to the right")

x = model.coordinate("x", "m", "centre, to the right of the wedge's bottom")
y = model.coordinate("y", "m", "centre, above the wedge's bottom")
theta = model.coordinate("theta", "rad", "turn, counter-clockwise")
model.gravity(g)
model.rigid_body(m, inertia=m * R**2 / 2, position=(x, y), angle=theta)
model.force(x, m * f_x)
for name, side in (("left", 1), ("right", -1)):
    model.contact(name, gap=side * n_x * x + n_y * y - R, slip=n_y * x - side * n_x * y + R * theta, kinetic=mu, restitution=e)
