"""A small block on a big block on a shaken table: two friction elements without a gap, one of them along a difference."""

from codegen.model import *

model = Model("Block on block on a shaken table", source="Younis, C. J.; Tadjbakhsh, I. G. (1984), J. Eng. Mech. 110(3), 417-432")

m_1 = model.parameter("m_1", "kg", 3.0, "mass of the big block", above=0)
m_2 = model.parameter("m_2", "kg", 1.0, "mass of the small block", above=0)
mu_table = model.parameter("mu_table", "1", 0.3, "friction on the table", minimum=0)
mu_top = model.parameter("mu_top", "1", 0.2, "friction between the blocks", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x_1 = model.coordinate("x_1", "m", "big block, relative to the table")
x_2 = model.coordinate("x_2", "m", "small block, relative to the table")
model.ground("z", "table", input="a_g")
model.point_mass(m_1, position=(x_1, 0))
model.point_mass(m_2, position=(x_2, 0))
model.friction("table", slip=x_1, normal=(m_1 + m_2) * g, kinetic=mu_table)
model.friction("top", slip=x_2 - x_1, normal=m_2 * g, kinetic=mu_top)
