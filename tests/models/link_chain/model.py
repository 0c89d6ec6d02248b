"""Point masses on massless rods that hang one from the other and swing in a plane: as many as are asked for, up to N."""

from codegen.model import *

N = 7

model = Model("Chain of links", source="test model: any number of free coordinates in one mode")

links = int(model.choice("links", [str(n) for n in range(N, 0, -1)], "how many links swing; the others are massless"))
m = model.parameter("m", "kg", 1.0, "mass at the end of each rod", above=0)
l = model.parameter("l", "m", 1.0, "length of each rod", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

angles = [model.coordinate(f"theta_{k}", "rad", f"angle of rod {k} from hanging down") for k in range(1, N + 1)]

model.gravity(g)
place = (0, 0)
for theta in angles[:links]:
    place = (place[0] + l * sin(theta), place[1] - l * cos(theta))
    model.point_mass(m, position=place)

model.mode("swings", "the links swing", freeze=[(theta, 0) for theta in angles[links:]])
