"""The woodpecker toy: a sleeve that holds on a pole by friction, and a bird on a spring; see README.md."""

from codegen.model import *

model = Model("Woodpecker toy", source="Glocker, Ch. (1995), Dynamik von Starrkörpersystemen mit Reibung und Stößen; Leine, R. I., Van Campen, D. H. and Glocker, Ch. (2003), J. Vib. Control 9(1-2), 25-78")

m_M = model.parameter("m_M", "kg", 0.0003, "mass of the sleeve", above=0)
J_M = model.parameter("J_M", "kg m^2", 5.0e-9, "inertia of the sleeve", above=0)
m_S = model.parameter("m_S", "kg", 0.0045, "mass of the woodpecker", above=0)
J_S = model.parameter("J_S", "kg m^2", 7.0e-7, "inertia of the woodpecker", above=0)
c = model.parameter("c", "N m", 0.0056, "stiffness of the spring over an angle", above=0)
r_0 = model.parameter("r_0", "m", 0.0025, "radius of the pole", above=0)
r_M = model.parameter("r_M", "m", 0.0031, "inner radius of the sleeve", above=0)
h_M = model.parameter("h_M", "m", 0.0058, "half of the height of the sleeve", above=0)
l_M = model.parameter("l_M", "m", 0.0100, "from the axis of the sleeve to the spring", above=0)
l_G = model.parameter("l_G", "m", 0.0150, "from the spring to the centre of the woodpecker", above=0)
h_S = model.parameter("h_S", "m", 0.0200, "height of the beak over the spring", above=0)
l_S = model.parameter("l_S", "m", 0.0201, "from the centre of the woodpecker to its beak", above=0)
mu = model.parameter("mu", "1", 0.3, "friction coefficient", minimum=0)
e_beak = model.parameter("e_beak", "1", 0.5, "restitution of the beak", minimum=0, maximum=1)
e_sleeve = model.parameter("e_sleeve", "1", 0.0, "restitution of the sleeve", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

y = model.coordinate("y", "m", "sleeve, upwards", scale=0.01)
phi_M = model.coordinate("phi_M", "rad", "tilt of the sleeve", scale=0.1, rate_scale=10)
phi_S = model.coordinate("phi_S", "rad", "tilt of the woodpecker", scale=0.1, rate_scale=10)

# Angles are small.
bird = y.rate + l_M * phi_M.rate + l_G * phi_S.rate
model.kinetic(m_M * y.rate**2 / 2 + J_M * phi_M.rate**2 / 2 + m_S * bird**2 / 2 + J_S * phi_S.rate**2 / 2)
model.potential(m_M * g * y + m_S * g * (y + l_M * phi_M + l_G * phi_S) + c * (phi_S - phi_M) ** 2 / 2)

model.contact("beak", gap=l_M + l_G - l_S - r_0 - h_S * phi_S, slip=y + l_M * phi_M + (l_G - l_S) * phi_S, kinetic=mu, restitution=e_beak)
model.contact("bottom", gap=r_M - r_0 + h_M * phi_M, slip=y + r_M * phi_M, kinetic=mu, restitution=e_sleeve)
model.contact("top", gap=r_M - r_0 - h_M * phi_M, slip=y + r_M * phi_M, kinetic=mu, restitution=e_sleeve)

hinge = (l_M, y + l_M * phi_M)
centre = (hinge[0] + l_G, hinge[1] + l_G * phi_S)
beak = (centre[0] - l_S - h_S * phi_S, centre[1] - l_S * phi_S + h_S)
model.draw("pole, left", [(-r_0, 0.05), (-r_0, -0.3)], kind="fixed")
model.draw("pole, right", [(r_0, -0.3), (r_0, 0.05)], kind="fixed")
model.draw("sleeve", [(across - up * phi_M, y + up + across * phi_M) for across, up in ((-r_M, -h_M), (r_M, -h_M), (r_M, h_M), (-r_M, h_M))],
           kind="line")
model.draw("spring", [(r_M, y + r_M * phi_M), hinge], kind="spring")
model.draw("woodpecker", [hinge, centre, beak])
# The pole pushes to the right, and rubs along it.
sleeve = {name: (r_M - up * phi_M, y + up + r_M * phi_M) for name, up in (("bottom", -h_M), ("top", h_M))}
for name, place in {"beak": beak, **sleeve}.items():
    model.draw(name, [place], kind="contact", of=name, along=[(1, 0), (0, 1)])
