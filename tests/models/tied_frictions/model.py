"""Three masses with friction each, whose slips inertia couples: which of several that reach their limits at one instant slip."""

from codegen.model import *

model = Model("Tied frictions", source="test model: tests/engine/ties.rs")

form = model.choice("form", ["reduced", "multipliers"], "how friction is held")

m = model.parameter("m", "kg", 1.0, "each mass", above=0)
k = model.parameter("k", "N/m", 0.0, "stiffness of springs from each mass to the next", minimum=0)
N = model.parameter("N", "N", 1.0, "normal force of each friction", above=0)
F = model.input("F", "N", "load")
P = model.input("P", "N", "added to the normal force of each friction")

names = ["a", "b", "c"]
places = [model.coordinate(f"x_{name}", "m", f"place of the mass {name}") for name in names]
rates = [place.rate for place in places]
model.kinetic(m * (rates[0]**2 + rates[1]**2 + rates[2]**2) / 2)
for i, j in ((0, 1), (1, 2), (0, 2)):
    coupling = model.parameter(f"coupling_{names[i]}{names[j]}", "1", 0.0, "share of the inertia that two of them have together", minimum=-0.4, maximum=0.4)
    model.kinetic(coupling * m * rates[i] * rates[j])
model.potential(k * ((places[0] - places[1])**2 + (places[1] - places[2])**2) / 2)
for name, place in zip(names, places):
    static = model.parameter(f"static_{name}", "1", 3.0, "static friction coefficient", minimum=0)
    kinetic = model.parameter(f"kinetic_{name}", "1", 1.0, "kinetic friction coefficient", minimum=0, at_most=static)
    share = model.parameter(f"share_{name}", "1", 1.0, "share of the load")
    model.force(place, share * F)
    belt = model.parameter(f"belt_{name}", "m/s", 0.0, "speed of the belt under it")
    model.friction(name, slip=place.rate - belt, normal=N + P, static=static, kinetic=kinetic)
if form == "multipliers":
    model.multipliers()
