"""The equations (1) to (10) of the source, exactly as printed, misprints included.

T. Taniguchi, "Governing equations of motion of walking behavior of unanchored flat-bottom
cylindrical shell tanks subjected to horizontal sinusoidal ground motion". Nothing is corrected
here: corrections.py does that, one slip at a time. The LaTeX beside each equation is the printed
line; verification parses it and proves that the function beside it says the same, term by term.
"""

from codegen.verify.printed import Paper, group

paper = Paper(
    title="Walking of an unanchored flat-bottom cylindrical tank",
    source="Taniguchi, Governing equations of motion of walking behavior of unanchored flat-bottom "
           "cylindrical shell tanks subjected to horizontal sinusoidal ground motion",
    translation=("x", "z_h"),
    negligible=("M_S", "I_S"),
    # uplift and bulging well beyond the motions of the scenes (some 0.02 rad and 1 mm)
    special={
        "M_rb = M_I": {"M_rb": "M_I"},
        "M_S = I_S = 0": {"M_S": 0, "I_S": 0},
        "theta = 0": {"theta": 0},
    },
    box={"theta": (0.0, 0.1), "x_I": (-0.01, 0.01)},
)

paper.coordinate("theta", "rad", "uplift angle about the pivot edge", minimum=0.0)
paper.coordinate("x_I", "m", "bulging displacement along the base line of the tank", mirror=-1)
paper.coordinate("x", "m", "slip of the base, to the right", mirror=-1)
paper.input("z_h", "m", "horizontal displacement of the ground, to the right", mirror=-1)
paper.discrete("lam", (1, -1), "pivot: +1 left bottom edge O, -1 right bottom edge O'", r"\lambda", mirror=-1)

paper.parameter("g", "m/s^2", "acceleration of gravity")
paper.parameter("M_I", "kg", "effective mass of liquid for bulging motion")
paper.parameter("M_E", "kg", "effective mass of liquid for rocking motion")
paper.parameter("M_rb", "kg", "effective mass of liquid for rocking-bulging interaction motion")
paper.parameter("M_S", "kg", "mass of the tank itself including the bottom plate uplifted")
paper.parameter("M_T", "kg", "total mass")
paper.parameter("I_E", "kg*m^2", "moment of inertia of the effective mass for rocking motion")
paper.parameter("I_S", "kg*m^2", "moment of inertia of the tank itself including the bottom plate uplifted")
paper.parameter("R_0", "m", "distance from the centre of M_E to the pivoting edge")
paper.parameter("R_I", "m", "distance from the centre of M_rb to the pivoting edge")
paper.parameter("R_S", "m", "distance from the centre of M_S to the pivoting edge")
paper.parameter("alpha_0", "rad", "angle of R_0 with the vertical at rest")
paper.parameter("alpha_I", "rad", "angle of R_I with the vertical at rest")
paper.parameter("alpha_S", "rad", "angle of R_S with the vertical at rest")
paper.parameter("k", "N/m", "stiffness of the bulging motion")
paper.parameter("c", "N*s/m", "damping of the bulging motion", dissipative=True)
paper.parameter("mu", "1", "static friction coefficient")
paper.parameter("nu", "1", "kinetic friction coefficient")
paper.parameter("e", "1", "coefficient of restitution, 0 to 1")
paper.force("F", "N", "friction force", mirror=-1)
paper.force("R_x", "N", "base shear", mirror=-1, dissipative=False)
paper.force("R_y", "N", "normal reaction", dissipative=False)


@paper.undefined("m_E", "kg", "printed in (5) only; read as M_E")
def m_E(s, m):
    return s.M_E


@paper.undefined("m_I", "kg", "printed in (5) only; read as M_I")
def m_I(s, m):
    return s.M_I


@paper.undefined("m_T", "kg", "printed in (5) only; read as M_T")
def m_T(s, m):
    return s.M_T


@paper.undefined("H_I", "m", "printed in (5) only; read as the height of the bulging liquid's centre")
def H_I(s, m):
    return s.R_I * m.cos(s.alpha_I)


@paper.motion("1", of="theta", title="Rotational direction", latex=r"""
& (I_E + I_S)\ddot{\theta} - \{M_I R_I \cos(\alpha_I - \theta) + M_I x_I \sin \theta + \lambda M_S R_S \cos(\alpha_S - \theta)\} \ddot{x} \\
& + g \{M_E R_0 \sin(\alpha_0 - \theta) + M_S R_S \sin(\alpha_S - \theta) + \lambda M_{rb} x_I \cos \theta\} \\
& + 2M_{rb} (x_I + \lambda R_I \sin \alpha_I) \dot{x}_I \dot{\theta} - \lambda M_I R_I \cos \alpha_I \dot{x}_I \\
& - M_I \{x_I \sin \theta + \lambda R_I \cos(\alpha_I - \theta)\} \ddot{z}_h = 0
""")
def equation_1(s, m):
    return [
        *group(s.ddtheta, s.I_E, s.I_S),
        *group(-s.ddx,
               s.M_I * s.R_I * m.cos(s.alpha_I - s.theta),
               s.M_I * s.x_I * m.sin(s.theta),
               s.lam * s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)),
        *group(s.g,
               s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta),
               s.M_S * s.R_S * m.sin(s.alpha_S - s.theta),
               s.lam * s.M_rb * s.x_I * m.cos(s.theta)),
        *group(2 * s.M_rb * s.dx_I * s.dtheta, s.x_I, s.lam * s.R_I * m.sin(s.alpha_I)),
        -s.lam * s.M_I * s.R_I * m.cos(s.alpha_I) * s.dx_I,
        *group(-s.M_I * s.ddz_h, s.x_I * m.sin(s.theta), s.lam * s.R_I * m.cos(s.alpha_I - s.theta)),
    ]


@paper.motion("2", of="x_I", title="Translational direction of the bulging motion", latex=r"""
& M_I \ddot{x}_I + \lambda M_{rb} g \sin \theta - \lambda M_{rb} R_I \sin \alpha_I \dot{\theta}^2 - \lambda M_{rb} R_I \cos \alpha_I \ddot{\theta} \\
& + M_I \cos \theta \ddot{x} - M_{rb} \dot{x} \sin \theta \dot{\theta} - M_{rb} x_I \dot{\theta}^2 + M_I \cos \theta \ddot{z}_h + kx_I + c\dot{x}_I \\
& = 0
""")
def equation_2(s, m):
    return [
        s.M_I * s.ddx_I,
        s.lam * s.M_rb * s.g * m.sin(s.theta),
        -s.lam * s.M_rb * s.R_I * m.sin(s.alpha_I) * s.dtheta**2,
        -s.lam * s.M_rb * s.R_I * m.cos(s.alpha_I) * s.ddtheta,
        s.M_I * m.cos(s.theta) * s.ddx,
        -s.M_rb * s.dx * m.sin(s.theta) * s.dtheta,
        -s.M_rb * s.x_I * s.dtheta**2,
        s.M_I * m.cos(s.theta) * s.ddz_h,
        s.k * s.x_I,
        s.c * s.dx_I,
    ]


@paper.motion("3", of="x", title="Translational direction of the tank slip", latex=r"""
& (M_I + M_S) \ddot{x} + M_I \cos \theta \ddot{x}_I - 2M_{rb} \sin \theta \dot{x}_I \dot{\theta} + (M_I + M_S) \ddot{z}_h \\
& - \{M_{rb} x_I \sin \theta + \lambda M_E R_0 \cos(\alpha_0 - \theta) + \lambda M_S R_S \cos(\alpha_S - \theta)\} \dot{\theta} \\
& - \{M_{rb} x_I \cos \theta + \lambda M_E R_0 \sin(\alpha_0 - \theta) + \lambda M_S R_S \sin(\alpha_S - \theta)\} \dot{\theta}^2 \\
& = -F
""")
def equation_3(s, m):
    return [
        *group(s.ddx, s.M_I, s.M_S),
        s.M_I * m.cos(s.theta) * s.ddx_I,
        -2 * s.M_rb * m.sin(s.theta) * s.dx_I * s.dtheta,
        *group(s.ddz_h, s.M_I, s.M_S),
        *group(-s.dtheta,
               s.M_rb * s.x_I * m.sin(s.theta),
               s.lam * s.M_E * s.R_0 * m.cos(s.alpha_0 - s.theta),
               s.lam * s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)),
        *group(-s.dtheta**2,
               s.M_rb * s.x_I * m.cos(s.theta),
               s.lam * s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta),
               s.lam * s.M_S * s.R_S * m.sin(s.alpha_S - s.theta)),
        s.F,
    ]


@paper.value("4", of="F", title="Friction force", latex=r"""
F = \nu \operatorname{sign}(\dot{x}) [& M_T g - \lambda M_I \sin \theta \ddot{x}_I - M_{rb} x_I \sin \theta \dot{\theta}^2 + M_{rb} x_I \cos \theta \ddot{\theta} \\
& + 2M_{rb} \cos \theta \dot{x}_I \dot{\theta} - \{M_E R_0 \cos(\alpha_0 - \theta) + M_S R_S \cos(\alpha_S - \theta)\} \dot{\theta}^2 \\
& + \{M_E R_0 \sin(\alpha_0 - \theta) + M_S R_S \sin(\alpha_S - \theta)\} \ddot{\theta}]
""")
def equation_4(s, m):
    return group(
        s.nu * m.sign(s.dx),
        s.M_T * s.g,
        -s.lam * s.M_I * m.sin(s.theta) * s.ddx_I,
        -s.M_rb * s.x_I * m.sin(s.theta) * s.dtheta**2,
        s.M_rb * s.x_I * m.cos(s.theta) * s.ddtheta,
        2 * s.M_rb * m.cos(s.theta) * s.dx_I * s.dtheta,
        *group(-s.dtheta**2,
               s.M_E * s.R_0 * m.cos(s.alpha_0 - s.theta),
               s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)),
        *group(s.ddtheta,
               s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta),
               s.M_S * s.R_S * m.sin(s.alpha_S - s.theta)),
    )


@paper.condition("5", of="theta", relation="<", title="Rocking commencement condition", latex=r"""
m_E g R_0 \sin \alpha_0 < m_I | \ddot{x}_I | H_I + m_T | \ddot{x} + \ddot{z}_h | R_0 \cos \alpha_0
""")
def equation_5(s, m):
    left = [s.m_E * s.g * s.R_0 * m.sin(s.alpha_0)]
    right = [
        s.m_I * m.Abs(s.ddx_I) * s.H_I,
        s.m_T * m.Abs(s.ddx + s.ddz_h) * s.R_0 * m.cos(s.alpha_0),
    ]
    return left, right


@paper.rule("6a", of="lam", result=1, relation=">", title="Pivot at the onset of rocking", latex=r"""
\lambda = 1 \quad \text{if} \quad \ddot{x} + \ddot{x}_I + \ddot{z}_h > 0
""")
def equation_6a(s, m):
    return [s.ddx, s.ddx_I, s.ddz_h]


@paper.rule("6b", of="lam", result=-1, relation="<", title="Pivot at the onset of rocking", latex=r"""
\lambda = -1 \quad \text{if} \quad \ddot{x} + \ddot{x}_I + \ddot{z}_h < 0
""")
def equation_6b(s, m):
    return [s.ddx, s.ddx_I, s.ddz_h]


@paper.condition("7", of="x", relation=">", title="Slip commencement condition", latex=r"""
|R_x| > \mu R_y
""")
def equation_7(s, m):
    return [m.Abs(s.R_x)], [s.mu * s.R_y]


@paper.value("8", of="R_x", title="Base shear", latex=r"""
R_x = & M_I \cos \theta \ddot{x}_I - M_{rb} x_I \cos \theta \dot{\theta}^2 - M_{rb} x_I \sin \theta \ddot{\theta} + (M_I + M_S) \ddot{z}_h \\
& - \lambda \{M_E R_0 \sin(\alpha_0 - \theta) + M_S R_S \sin(\alpha_S - \theta)\} \dot{\theta}^2 \\
& - \lambda \{M_E R_0 \cos(\alpha_0 - \theta) + M_S R_S \cos(\alpha_S - \theta)\} \ddot{\theta}
""")
def equation_8(s, m):
    return [
        s.M_I * m.cos(s.theta) * s.ddx_I,
        -s.M_rb * s.x_I * m.cos(s.theta) * s.dtheta**2,
        -s.M_rb * s.x_I * m.sin(s.theta) * s.ddtheta,
        *group(s.ddz_h, s.M_I, s.M_S),
        *group(-s.lam * s.dtheta**2,
               s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta),
               s.M_S * s.R_S * m.sin(s.alpha_S - s.theta)),
        *group(-s.lam * s.ddtheta,
               s.M_E * s.R_0 * m.cos(s.alpha_0 - s.theta),
               s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)),
    ]


@paper.value("9", of="R_y", title="Normal reaction", latex=r"""
R_y = & M_T g - \lambda M_I \sin \theta \ddot{x}_I - M_{rb} x_I \sin \theta \dot{\theta}^2 + M_{rb} x_I \cos \theta \ddot{\theta} \\
& - \{M_E R_0 \cos(\alpha_0 - \theta) + M_S R_S \cos(\alpha_S - \theta)\} \dot{\theta}^2 \\
& + \{M_E R_0 \sin(\alpha_0 - \theta) + M_S R_S \sin(\alpha_S - \theta)\} \ddot{\theta}
""")
def equation_9(s, m):
    return [
        s.M_T * s.g,
        -s.lam * s.M_I * m.sin(s.theta) * s.ddx_I,
        -s.M_rb * s.x_I * m.sin(s.theta) * s.dtheta**2,
        s.M_rb * s.x_I * m.cos(s.theta) * s.ddtheta,
        *group(-s.dtheta**2,
               s.M_E * s.R_0 * m.cos(s.alpha_0 - s.theta),
               s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)),
        *group(s.ddtheta,
               s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta),
               s.M_S * s.R_S * m.sin(s.alpha_S - s.theta)),
    ]


@paper.reset("10", of="theta", title="Landing", latex=r"""
\dot{\theta}(t^+) = e \dot{\theta}(t^-)
""")
def equation_10(s, m):
    return [s.e * s.dtheta]
