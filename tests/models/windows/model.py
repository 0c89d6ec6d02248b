"""N windows in a row: N + 1 cranks of equal bars, of which each two next to each other are joined by a coupler (IFToMM problem A02)."""

from codegen.model import *

N = 2

model = Model("Row of four-bar linkages",
              source="González, M., Dopico, D., Lugrís, U. and Cuadrado, J. (2006), Multibody Syst. Dyn. 16(1), 65-82 (problem A02 of the IFToMM library)")

m = model.parameter("m", "kg", 1.0, "mass of a bar", above=0)
l = model.parameter("l", "m", 1.0, "length of a bar", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

cranks = [model.coordinate(f"crank_{k + 1}", "rad", f"angle of crank {k + 1} above the ground line") for k in range(N + 1)]
couplers = [model.coordinate(f"coupler_{k + 1}", "rad", f"angle of coupler {k + 1} above the ground line") for k in range(N)]
model.gravity(g)


def bar(P, angle):
    """A uniform bar from P at an angle; its other end."""
    Q = (P[0] + l * cos(angle), P[1] + l * sin(angle))
    model.rigid_body(m, m * l**2 / 12, ((P[0] + Q[0]) / 2, (P[1] + Q[1]) / 2), angle)
    return Q


tips = [bar((k * l, 0 * l), angle) for k, angle in enumerate(cranks)]
for k, angle in enumerate(couplers):
    end = bar(tips[k], angle)
    model.constraint(f"pin_{k + 1}", (end[0] - tips[k + 1][0], end[1] - tips[k + 1][1]))
