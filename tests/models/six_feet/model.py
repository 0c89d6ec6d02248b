"""A rigid body with up to six feet on rough ground that shakes; a foot that is not wanted is put far up."""

from codegen.model import *

model = Model("Body on six feet", source="test model: random scenes of several contacts")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
I = model.parameter("I", "kg m^2", 0.1, "moment of inertia about the centre", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "centre, to the right")
y = model.coordinate("y", "m", "centre, height over the ground")
theta = model.coordinate("theta", "rad", "tilt, counter-clockwise")
model.ground("x_g", "ground, to the right", input="a_h")
model.gravity(g)
model.rigid_body(m, I, (x, y), theta)

for k in range(1, 7):
    across = model.parameter(f"across_{k}", "m", 0.0, f"foot {k} from the centre, to the right")
    up = model.parameter(f"up_{k}", "m", 100.0, f"foot {k} from the centre, upwards")
    mu = model.parameter(f"mu_{k}", "1", 0.5, f"friction of foot {k}", minimum=0)
    e = model.parameter(f"e_{k}", "1", 0.0, f"restitution of foot {k}", minimum=0, maximum=1)
    place = x + across * cos(theta) - up * sin(theta)
    height = y + across * sin(theta) + up * cos(theta)
    model.contact(f"foot_{k}", gap=height, slip=place, kinetic=mu, restitution=e)

model.limit("fallen", "the body lies on its side", when=theta**2 > (5 * pi / 12) ** 2)
