"""Two masses on a table that moves up and down: whatever happens to one happens to the other, too, where both start alike."""

from codegen.model import *

model = Model("Two masses on a table that moves", source="test model: accumulations side by side")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
e = model.parameter("e", "1", 0.25, "coefficient of restitution", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
one = model.coordinate("one", "m", "height of the first mass")
other = model.coordinate("other", "m", "height of the second mass")
table = model.motion("table", "height of the table", input="a")
model.gravity(g)
for name, y in (("first", one), ("second", other)):
    model.point_mass(m, position=(0, y))
    model.contact(name, gap=y - table, restitution=e)
