"""A double pendulum of uniform rods that strikes a wall with its tip."""

from codegen.model import *

model = Model("Double pendulum at a wall", source="Newton's law of restitution and Coulomb's of friction (Moreau 1988)")

m_1 = model.parameter("m_1", "kg", 1.0, "mass of the upper rod", above=0)
m_2 = model.parameter("m_2", "kg", 0.8, "mass of the lower rod", above=0)
l_1 = model.parameter("l_1", "m", 1.0, "length of the upper rod", above=0)
l_2 = model.parameter("l_2", "m", 0.8, "length of the lower rod", above=0)
wall = model.parameter("wall", "m", 0.2, "place of the wall")
mu = model.parameter("mu", "1", 0.3, "friction", minimum=0)
e = model.parameter("e", "1", 0.5, "restitution", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

phi_1 = model.coordinate("phi_1", "rad", "angle of the upper rod from the lower vertical")
phi_2 = model.coordinate("phi_2", "rad", "angle of the lower rod from the lower vertical")
joint = (l_1 * sin(phi_1), -l_1 * cos(phi_1))
tip = (joint[0] + l_2 * sin(phi_2), joint[1] - l_2 * cos(phi_2))
model.gravity(g)
model.rigid_body(m_1, inertia=m_1 * l_1**2 / 12, position=(joint[0] / 2, joint[1] / 2), angle=phi_1)
model.rigid_body(m_2, inertia=m_2 * l_2**2 / 12, position=((joint[0] + tip[0]) / 2, (joint[1] + tip[1]) / 2), angle=phi_2)
model.contact("tip", gap=wall - tip[0], slip=tip[1], kinetic=mu, restitution=e)
