"""A mass on a spring that an input lifts: what its mode requires depends on the input, and on a quotient."""

from codegen.model import *

model = Model("Slider that is lifted", source="test model: requirements with signals and quotients")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 4.0, "stiffness of the spring", minimum=0)
g = model.parameter("g", "m/s^2", 10.0, "gravity", minimum=0)
strength = model.parameter("strength", "N", 10.0, "most tension of the rope", above=0)
tension = model.parameter("tension", "N", 1.0, "tension of the rope at x = 0", minimum=0)
lift = model.parameter("lift", "1", 1.0, "part of the input that lifts the mass")
length = model.parameter("length", "m", 1.0, "length of the rope at x = 0", above=0)

x = model.coordinate("x", "m", "place on the ground")
y = model.coordinate("y", "m", "height")
pull = model.input("pull", "N", "force upwards")
model.gravity(g)
model.point_mass(m, position=(x, y))
model.potential(k * x**2 / 2)
model.force(y, lift * pull)

slides = model.mode("slides", "on smooth ground", freeze=[(y, 0)])
model.requires(slides, slides.reaction(y), "the slider would leave the ground")
model.requires(slides, strength - tension / (1 + x / length), "the rope would break")
