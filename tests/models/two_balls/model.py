"""Two balls that know nothing of each other: accumulations of one while the other flies."""

from codegen.model import *

model = Model("Two bouncing balls", source="test model: several rests of one mode")

rests = model.choice("rests", ("each", "first_only", "no_second"), "which rests there are: declared of each ball, or of the first alone, and no"
                     " mode in which the second rests while the first flies")
m = model.parameter("m", "kg", 1.0, "mass of each ball", above=0)
e_a = model.parameter("e_a", "1", 0.5, "restitution of the first ball", minimum=0, maximum=1)
e_b = model.parameter("e_b", "1", 0.5, "restitution of the second ball", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

a = model.coordinate("a", "m", "height of the first ball", minimum=0)
b = model.coordinate("b", "m", "height of the second ball", minimum=0)
model.gravity(g)
model.point_mass(m, position=(0, a))
model.point_mass(m, position=(0, b))

both_fly = model.mode("both_fly", "both in the air")
a_rests = model.mode("a_rests", "the first on the floor", freeze=[(a, 0)])
b_rests = model.mode("b_rests", "the second on the floor", freeze=[(b, 0)]) if rests != "no_second" else None
both_rest = model.mode("both_rest", "both on the floor", freeze=[(a, 0), (b, 0)])

for mode, balls in ((both_fly, (a, b)), (a_rests, (b,)), (b_rests, (a,))):
    for ball in balls if mode else ():
        e = e_a if ball is a else e_b
        model.transition(
            f"impact_{ball.name()}", mode, mode, when=falls(ball), impact=True,
            reset=[(ball, 0), (ball.rate, -e * ball.rate)])

model.rest(both_fly, a_rests)
if rests == "each":
    model.rest(both_fly, b_rests)
model.rest(a_rests, both_rest)
if b_rests:
    model.rest(b_rests, both_rest)
