"""A small block on a big one on a table that shakes: two friction elements, one on the other."""

from codegen.model import *

model = Model("Two blocks on a shaking table", source="Coulomb's law, set-valued (Moreau 1988)")

m_1 = model.parameter("m_1", "kg", 3.0, "mass of the big block", above=0)
m_2 = model.parameter("m_2", "kg", 1.0, "mass of the small block", above=0)
bound_1 = model.parameter("bound_1", "N", 11.772, "most that friction holds between table and big block", minimum=0)
bound_2 = model.parameter("bound_2", "N", 1.962, "most that friction holds between the blocks", minimum=0)
k_11 = model.parameter("k_11", "N/m", 0.0, "stiffness between table and big block")
k_12 = model.parameter("k_12", "N/m", 0.0, "stiffness that couples both")
k_22 = model.parameter("k_22", "N/m", 0.0, "stiffness between table and small block")

x_1 = model.coordinate("x_1", "m", "big block, relative to the table")
x_2 = model.coordinate("x_2", "m", "small block, relative to the table")
model.ground("z", "table", input="a_g")
model.point_mass(m_1, position=(x_1, 0))
model.point_mass(m_2, position=(x_2, 0))
model.potential(k_11 * x_1**2 / 2 + k_12 * x_1 * x_2 + k_22 * x_2**2 / 2)
model.friction("table", slip=x_1, normal=bound_1, kinetic=1)
model.friction("blocks", slip=x_2 - x_1, normal=bound_2, kinetic=1)
