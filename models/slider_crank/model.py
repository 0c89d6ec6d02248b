"""A slider-crank of three bodies held by their joints alone, one of which may have clearance; see README.md."""

from codegen.model import *

model = Model("Slider-crank with joints as constraints", source="Haug, E. J. (1989), Computer Aided Kinematics and Dynamics of Mechanical Systems, chapter 5; clearance: Flores, P. et al. (2008), Kinematics and Dynamics of Multibody Systems with Imperfect Joints")

joint = model.choice("joint", ["ideal", "clearance"], "the joint of rod and slider: a pin, or a pin in a wider bearing")

r = model.parameter("r", "m", 0.3, "length of the crank", above=0)
l = model.parameter("l", "m", 0.8, "length of the rod", above=0)
m_crank = model.parameter("m_crank", "kg", 0.4, "mass of the crank", above=0)
m_rod = model.parameter("m_rod", "kg", 0.7, "mass of the rod", above=0)
m_slider = model.parameter("m_slider", "kg", 0.9, "mass of the slider", above=0)
J_slider = model.parameter("J_slider", "kg m^2", 0.01, "inertia of the slider", above=0)
pin_radius = model.parameter("pin_radius", "m", 0.01, "radius of the pin in the slider, with clearance", above=0)
clearance = model.parameter("clearance", "m", 0.0005, "radius of the bearing less that of the pin", above=0)
mu = model.parameter("mu", "1", 0.05, "friction coefficient of the pin in the bearing, with clearance", minimum=0)
e = model.parameter("e", "1", 0.5, "restitution of the pin in the bearing, with clearance", minimum=0, maximum=1)
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
    """A point of a body on its axis, at a distance from its centre, and its velocity."""
    x, y, angle = body
    return (x + distance * cos(angle), y + distance * sin(angle)), (
        x.rate - distance * sin(angle) * angle.rate, y.rate + distance * cos(angle) * angle.rate)


def pin(name, first, second):
    """The first point stays on the second."""
    model.constraint(name, (first[0] - second[0], first[1] - second[1]))


pin("O", along(crank, -r / 2)[0], (0, 0))
pin("A", along(crank, r / 2)[0], along(rod, -l / 2)[0])
end, end_rate = along(rod, l / 2)
if joint == "ideal":
    pin("B", end, slider[:2])
else:
    (dx, dy), (du, dv) = [[s - p for s, p in zip(of, by)] for of, by in ((slider[:2], end), ([q.rate for q in slider[:2]], end_rate))]
    # Smooth where the pin is in the middle of the bearing, and to first order the distance where it touches.
    model.contact("pin", gap=(clearance**2 - dx**2 - dy**2) / (2 * clearance), kinetic=mu, restitution=e,
                  slip=(dx * dv - dy * du) / clearance + pin_radius * slider[2].rate - (pin_radius + clearance) * rod[2].rate)
model.constraint("guide", slider[1])
model.constraint("guide_angle", slider[2])

model.draw("guide", [(-0.2, -0.05), (1.4, -0.05)], kind="fixed")
model.draw("slider", [(slider[0] + across, slider[1] + up) for across, up in ((-0.08, -0.05), (0.08, -0.05), (0.08, 0.05), (-0.08, 0.05))])
model.draw("crank", [along(crank, -r / 2)[0], along(crank, r / 2)[0]], kind="line")
model.draw("rod", [along(rod, -l / 2)[0], end], kind="line")
# The forces on the first of the two bodies that a joint connects.
for name, place in (("O", (0, 0)), ("A", along(crank, r / 2)[0]), *([("B", end)] if joint == "ideal" else [])):
    model.draw(name, [place], kind="contact", of=name)
if joint == "clearance":
    # The bearing on the pin: towards the middle of the bearing, and across, as the pin slips.
    model.draw("pin", [end], kind="contact", of="pin", along=[(dx / clearance, dy / clearance), (dy / clearance, -dx / clearance)])
model.draw("guide", [slider[:2]], kind="contact", of="guide", along=[(0, 1)])
