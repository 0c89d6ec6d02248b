"""A slider-crank whose three bodies are held by joints alone: nine coordinates, eight multipliers."""

from codegen.model import *

model = Model("Slider-crank with joints as constraints", source="Haug, E. J. (1989), Computer Aided Kinematics and Dynamics of Mechanical Systems, chapter 5")

r = model.parameter("r", "m", 0.3, "length of the crank", above=0)
l = model.parameter("l", "m", 0.8, "length of the rod", above=0)
m_crank = model.parameter("m_crank", "kg", 0.4, "mass of the crank", above=0)
m_rod = model.parameter("m_rod", "kg", 0.7, "mass of the rod", above=0)
m_slider = model.parameter("m_slider", "kg", 0.9, "mass of the slider", above=0)
J_slider = model.parameter("J_slider", "kg m^2", 0.01, "inertia of the slider", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

bodies = []
for name, mass, inertia in (("crank", m_crank, m_crank * r**2 / 12), ("rod", m_rod, m_rod * l**2 / 12), ("slider", m_slider, J_slider)):
    x = model.coordinate(f"{name}_x", "m", f"centre of the {name}, to the right")
    y = model.coordinate(f"{name}_y", "m", f"centre of the {name}, upwards")
    angle = model.coordinate(f"{name}_angle", "rad", f"angle of the {name}, counter-clockwise")
    model.rigid_body(mass, inertia=inertia, position=(x, y), angle=angle)
    bodies.append((x, y, angle))
model.gravity(g)

crank, rod, slider = bodies


def along(body, distance):
    """A point of a body on its axis, at a distance from its centre."""
    x, y, angle = body
    return x + distance * cos(angle), y + distance * sin(angle)


def pin(name, first, second):
    """The first point stays on the second."""
    model.constraint(name, (first[0] - second[0], first[1] - second[1]))


pin("O", along(crank, -r / 2), (0, 0))
pin("A", along(crank, r / 2), along(rod, -l / 2))
pin("B", along(rod, l / 2), slider[:2])
model.constraint("guide", slider[1])
model.constraint("guide_angle", slider[2])
