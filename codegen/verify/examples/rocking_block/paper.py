"""A rigid block that rocks about an edge and slides on a moving floor."""

from codegen.verify import Paper, group

paper = Paper("Rocking and sliding block", "Housner 1963, with slip of the edge", translation=("x", "z_h"),
              sets={"block": {"m": "2", "I": "2.7", "R": "1", "alpha": "0.3", "g": "9.80665", "nu": "0.3"}},
              box={"theta": (0.0, 0.5)})
paper.coordinate("theta", "rad", "uplift about the pivot edge", minimum=0.0)
paper.coordinate("x", "m", "slip of the base, to the right", mirror=-1)
paper.input("z_h", "m", "displacement of the floor, to the right", mirror=-1)
paper.discrete("lam", (1, -1), "pivot: +1 left edge, -1 right edge", r"\lambda", mirror=-1)
paper.parameter("m", "kg", "mass")
paper.parameter("I", "kg*m^2", "moment of inertia about an edge")
paper.parameter("R", "m", "half diagonal")
paper.parameter("alpha", "rad", "angle of the half diagonal with the vertical at rest")
paper.parameter("g", "m/s^2", "acceleration of gravity")
paper.parameter("nu", "1", "kinetic friction coefficient")
paper.force("F", "N", "friction force", mirror=-1)
paper.force("N", "N", "normal force", dissipative=False)


@paper.motion("1", of="theta", title="Rocking", latex=r"""
I \ddot{\theta} - \lambda m R \cos(\alpha - \theta) \ddot{x} - \lambda m R \cos(\alpha - \theta) \ddot{z}_h
+ m g R \sin(\alpha - \theta) = 0
""")
def rocking(s, m):
    return [
        s.I * s.ddtheta,
        -s.lam * s.m * s.R * m.cos(s.alpha - s.theta) * s.ddx,
        -s.lam * s.m * s.R * m.cos(s.alpha - s.theta) * s.ddz_h,
        s.m * s.g * s.R * m.sin(s.alpha - s.theta),
    ]


@paper.motion("2", of="x", title="Sliding", latex=r"""
m \ddot{x} + m \ddot{z}_h - \lambda m R \{\cos(\alpha - \theta) \ddot{\theta} + \sin(\alpha - \theta) \dot{\theta}^2\} = -F
""")
def sliding(s, m):
    return [
        s.m * s.ddx,
        s.m * s.ddz_h,
        *group(-s.lam * s.m * s.R, m.cos(s.alpha - s.theta) * s.ddtheta, m.sin(s.alpha - s.theta) * s.dtheta**2),
        s.F,
    ]


@paper.value("3", of="N", momentum=True, title="Normal force", latex=r"""
N = m g + m R \{\sin(\alpha - \theta) \ddot{\theta} - \cos(\alpha - \theta) \dot{\theta}^2\}
""")
def normal(s, m):
    return [
        s.m * s.g,
        *group(s.m * s.R, m.sin(s.alpha - s.theta) * s.ddtheta, -m.cos(s.alpha - s.theta) * s.dtheta**2),
    ]


@paper.value("4", of="F", title="Friction", latex=r"F = \nu N \operatorname{sign}(\dot{x})")
def friction(s, m):
    return [s.nu * s.N * m.sign(s.dx)]
