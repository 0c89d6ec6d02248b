"""Two four-bar linkages in a row, which pass through positions where all bars are in line; see README.md."""

from codegen.model import *

model = Model("Double four-bar linkage",
              source="González, M., Dopico, D., Lugrís, U. and Cuadrado, J. (2006), Multibody Syst. Dyn. 16(1), 65-82 (problem A02 of the IFToMM library)")

m = model.parameter("m", "kg", 1.0, "mass of a bar", above=0)
l = model.parameter("l", "m", 1.0, "length of a bar", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

cranks = [model.coordinate(f"crank_{k}", "rad", f"angle of crank {k} above the ground line") for k in (1, 2, 3)]
couplers = [model.coordinate(f"coupler_{k}", "rad", f"angle of coupler {k} above the ground line") for k in (1, 2)]

model.gravity(g)


def bar(name, P, angle):
    """A uniform bar from P at an angle; its other end."""
    Q = (P[0] + l * cos(angle), P[1] + l * sin(angle))
    model.rigid_body(m, m * l**2 / 12, ((P[0] + Q[0]) / 2, (P[1] + Q[1]) / 2), angle)
    model.draw(name, [P, Q], kind="line")
    return Q


tips = [bar(f"crank_{k + 1}", (k * l, 0 * l), angle) for k, angle in enumerate(cranks)]
for k, angle in enumerate(couplers):
    end = bar(f"coupler_{k + 1}", tips[k], angle)
    model.constraint(f"pin_{k + 2}", (end[0] - tips[k + 1][0], end[1] - tips[k + 1][1]))
for k in range(3):
    model.draw("ground", [(k * l - 0.08 * l, -0.02 * l), (k * l + 0.08 * l, -0.02 * l)], kind="fixed")
    model.draw("fixed pin", [(k * l, 0)], kind="point")

model.output("x_B0", "m", tips[0][0], "place of the first moving pin, to the right")
model.output("y_B0", "m", tips[0][1], "the same, upwards")
