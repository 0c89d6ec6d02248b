"""Three masses on a line: the first strikes the second, which is coupled to the third by a clutch that overruns."""

from codegen.model import *

model = Model("Masses with an overrunning clutch", source="test model: a ratchet in impacts and in free motion")

masses = [model.parameter(f"m_{k}", "kg", 1.0, f"mass {k}", above=0) for k in range(3)]
e = model.parameter("e", "1", 0.5, "restitution of the impact", minimum=0, maximum=1)
k = model.parameter("k", "N/m", 0.0, "stiffness of the spring between the second mass and the ground", minimum=0)

x = [model.coordinate(f"x_{k}", "m", f"place of mass {k}") for k in range(3)]
for m, place in zip(masses, x):
    model.point_mass(m, position=(place, 0))
model.potential(k * x[1] ** 2 / 2)

model.contact("hit", gap=x[1] - x[0], restitution=e, switch=True)
model.ratchet("clutch", rate=x[2].rate - x[1].rate, switch=True)
