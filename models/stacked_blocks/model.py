"""A rectangular block on another one on rough ground that shakes; see README.md."""

from codegen.model import *

model = Model("Two stacked blocks", source="Psycharis, I. N. (1990), Earthquake Eng. Struct. Dyn. 19(4), 555-570; Spanos, P. D., Roussis, P. C. and Politis, N. P. A. (2001), Soil Dyn. Earthquake Eng. 21(7), 559-578")

g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
model.gravity(g)
ground = model.ground("x_g", "ground, to the right", input="a_h", optional=True)
model.ground("y_g", "ground, upwards", input="a_v", axis="y", optional=True)


class Block:
    """A uniform rectangle with its coordinates, on ground or on another block."""

    def __init__(self, name, b, h, place):
        self.name = name
        self.b = model.parameter(f"b_{name}", "m", b, f"half of the width of the {place} block", above=0)
        self.h = model.parameter(f"h_{name}", "m", h, f"half of the height of the {place} block", above=0)
        self.m = model.parameter(f"m_{name}", "kg", 1.0, f"mass of the {place} block", above=0)
        self.mu_s = model.parameter(f"mu_s_{name}", "1", 0.6, f"static friction below the {place} block", minimum=0)
        self.mu_k = model.parameter(f"mu_k_{name}", "1", 0.5, f"kinetic friction below the {place} block", minimum=0, at_most=self.mu_s)
        self.e = model.parameter(f"e_{name}", "1", 0.0, f"restitution of the lower corners of the {place} block", minimum=0, maximum=1)
        self.x = model.coordinate(f"x_{name}", "m", f"centre of the {place} block, to the right, relative to the ground")
        self.y = model.coordinate(f"y_{name}", "m", f"centre of the {place} block, height over the ground")
        self.theta = model.coordinate(f"theta_{name}", "rad", f"tilt of the {place} block, counter-clockwise")
        model.rigid_body(self.m, self.m * (self.b**2 + self.h**2) / 3, (self.x, self.y), self.theta)

    def point(self, across, up):
        """A point of the block, from its centre."""
        c, s = cos(self.theta), sin(self.theta)
        return self.x + across * c - up * s, self.y + across * s + up * c

    def seen(self, P):
        """A point as the block sees it, from its centre: across and up."""
        c, s = cos(self.theta), sin(self.theta)
        dx, dy = P[0] - self.x, P[1] - self.y
        return dx * c + dy * s, dy * c - dx * s

    def stands(self, seen):
        """Its lower corners touch what lies below, which sees a point along its surface and above it."""
        for side, across in (("left", -self.b), ("right", self.b)):
            place, height = seen(self.point(across, -self.h))
            model.contact(f"{self.name}_{side}", gap=height, slip=place, static=self.mu_s, kinetic=self.mu_k, restitution=self.e)


lower, upper = Block("lower", 0.25, 0.4, "lower"), Block("upper", 0.2, 0.5, "upper")
lower.stands(lambda P: P)


def above_lower(P):
    along, height = lower.seen(P)
    return along, height - lower.h


upper.stands(above_lower)
for block in (lower, upper):
    model.limit(f"{block.name}_overturned", f"a side of the {block.name} block lies below", when=block.theta**2 > (pi / 2) ** 2)
model.draw("ground", [(-6 * lower.b, 0 * lower.b), (6 * lower.b, 0 * lower.b)], kind="fixed")
for block in (lower, upper):
    b, h = block.b, block.h
    model.draw(block.name, [block.point(-b, -h), block.point(b, -h), block.point(b, h), block.point(-b, h)])
    for side, across in (("left", -b), ("right", b)):
        model.draw(f"{block.name}_{side}", [block.point(across, -h)], kind="contact", of=f"{block.name}_{side}")
