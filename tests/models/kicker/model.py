"""A block that is driven over rough ground by a motor that turns on where it has become slow, with a kick upwards, and off where it
has become fast: modes by hand beside a contact."""

from codegen.model import *

model = Model("Block that is kicked and driven", source="test model: modes and resets by hand beside a contact")

m = model.parameter("m", "kg", 2.0, "mass", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
mu = model.parameter("mu", "1", 0.3, "friction", minimum=0)
pull = model.parameter("pull", "N", 20.0, "force of the motor")
slow = model.parameter("slow", "m/s", 1.0, "rate at which the motor turns on")
fast = model.parameter("fast", "m/s", 3.0, "rate at which it turns off")
kick = model.parameter("kick", "m/s", 0.5, "rate upwards after the kick")
drop = model.parameter("drop", "m", 0.0, "how far the kick moves the block down")

x = model.coordinate("x", "m", "to the right")
y = model.coordinate("y", "m", "height")
model.gravity(g)
model.point_mass(m, position=(x, y))
model.contact("floor", gap=y, slip=x, kinetic=mu)

coasts = model.mode("coasts", "the motor is off")
drives = model.mode("drives", "the motor is on")
drives.force(x, pull)
model.transition("turn_on", coasts, drives, when=falls(x.rate - slow), reset=[(y.rate, kick), (y, y - drop)])
model.transition("turn_off", drives, coasts, when=rises(x.rate - fast))
