"""Fuller's switching: a mass that a relay brings to zero by infinitely many switches in finite time, without an impact."""

from codegen.model import *

model = Model(
    "Fuller's switching",
    source="test model: Fuller, A. T. (1963), Study of an optimum non-linear control system, J. Electronics and Control 15, 63-71")

limit = model.choice("limit", ("declared", "missing", "elsewhere"), "the rest at the limit: declared, none, or at a wrong place")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
F = model.parameter("F", "N", 1.0, "force of the relay", above=0)
C = model.parameter("C", "1", 0.3, "curvature of the switching curve x = -C m v |v| / F", above=0, maximum=0.5)

x = model.coordinate("x", "m", "place of the mass")
model.point_mass(m, position=(x, 0))

curve = C * m * x.rate**2 / F
left = model.mode("left", "pushed to the left")
right = model.mode("right", "pushed to the right")
held = model.mode("held", "held", freeze=[(x, 0 if limit != "elsewhere" else 1)])
left.force(x, -F)
right.force(x, F)
# The curve is met on the branch on which the mass moves towards zero too fast.
model.transition("to_right", left, right, when=falls(x - curve), provided=-x.rate)
model.transition("to_left", right, left, when=falls(-x - curve), provided=x.rate)
if limit != "missing":
    for mode in (left, right):
        model.rest(mode, held)
