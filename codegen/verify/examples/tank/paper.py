"""The walking tank's equations written by hand without slips, for the energy-consistent bodies."""

from codegen.verify import Paper, group

paper = Paper(
    "Walking tank, energy-consistent", "written by hand from the bodies of models/walking_tank", translation=("x", "z_h"),
    sets={"doughnut": {
        "g": "9.80665", "M_I": "39.33", "M_rb": "5.98", "M_E": "9.56", "M_S": "7.48", "M_T": "57.78", "I_E": "1.065",
        "I_S": "0.753", "R_0": "0.283", "R_I": "0.258", "R_S": "0.256", "alpha_0": "0.785", "alpha_I": "0.889",
        "alpha_S": "0.896", "k": "1.0497e6", "c": "642.5", "nu": "0.19"}},
    box={"theta": (0.0, 0.1), "x_I": (-0.01, 0.01)})
paper.coordinate("theta", "rad", "uplift angle", minimum=0.0)
paper.coordinate("x_I", "m", "bulging displacement", mirror=-1)
paper.coordinate("x", "m", "slip", mirror=-1)
paper.input("z_h", "m", "displacement of the ground", mirror=-1)
paper.discrete("lam", (1, -1), "pivot", r"\lambda", mirror=-1)
for name, unit, meaning in (
        ("g", "m/s^2", "gravity"), ("M_I", "kg", "bulging mass"), ("M_rb", "kg", "bulging mass that rocks"),
        ("M_E", "kg", "rocking mass"), ("M_S", "kg", "shell"), ("M_T", "kg", "total mass"),
        ("I_E", "kg*m^2", "inertia of the rocking mass"), ("I_S", "kg*m^2", "inertia of the shell"),
        ("R_0", "m", "radius of M_E"), ("R_I", "m", "radius of M_rb"), ("R_S", "m", "radius of M_S"),
        ("alpha_0", "rad", "angle of R_0"), ("alpha_I", "rad", "angle of R_I"), ("alpha_S", "rad", "angle of R_S"),
        ("k", "N/m", "bulging stiffness"), ("nu", "1", "kinetic friction")):
    paper.parameter(name, unit, meaning)
paper.parameter("c", "N*s/m", "bulging damping", dissipative=True)
paper.force("F", "N", "friction", mirror=-1)
paper.force("N", "N", "normal force", dissipative=False)


def coupling(s, m):
    """First moments that couple rotation and slip."""
    return (s.M_rb * s.x_I * m.sin(s.theta), s.lam * s.M_rb * s.R_I * m.cos(s.alpha_I - s.theta),
            s.lam * s.M_S * s.R_S * m.cos(s.alpha_S - s.theta))


def bulging(s, m):
    """Masses that couple bulging and slip: M_rb cos(theta) + M_I - M_rb."""
    return s.M_rb * m.cos(s.theta), s.M_I, -s.M_rb


@paper.motion("1", of="theta", title="Rotation")
def rotation(s, m):
    return [
        *group(s.ddtheta, s.I_E, s.I_S, s.M_rb * s.x_I**2, 2 * s.lam * s.M_rb * s.R_I * m.sin(s.alpha_I) * s.x_I),
        -s.lam * s.M_rb * s.R_I * m.cos(s.alpha_I) * s.ddx_I,
        *group(-s.ddx, *coupling(s, m)),
        *group(-s.ddz_h, *coupling(s, m)),
        *group(2 * s.M_rb * s.dx_I * s.dtheta, s.x_I, s.lam * s.R_I * m.sin(s.alpha_I)),
        *group(s.g, s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta), s.M_S * s.R_S * m.sin(s.alpha_S - s.theta),
               s.lam * s.M_rb * s.x_I * m.cos(s.theta)),
    ]


@paper.motion("2", of="x_I", title="Bulging")
def bulge(s, m):
    return [
        s.M_I * s.ddx_I,
        -s.lam * s.M_rb * s.R_I * m.cos(s.alpha_I) * s.ddtheta,
        *group(s.ddx, *bulging(s, m)),
        *group(s.ddz_h, *bulging(s, m)),
        *group(-s.M_rb * s.dtheta**2, s.x_I, s.lam * s.R_I * m.sin(s.alpha_I)),
        s.lam * s.M_rb * s.g * m.sin(s.theta),
        s.k * s.x_I,
        s.c * s.dx_I,
    ]


@paper.motion("3", of="x", title="Slip")
def slip(s, m):
    return [
        *group(s.ddx, s.M_I, s.M_S),
        *group(s.ddz_h, s.M_I, s.M_S),
        *group(s.ddx_I, *bulging(s, m)),
        -2 * s.M_rb * m.sin(s.theta) * s.dx_I * s.dtheta,
        *group(-s.ddtheta, *coupling(s, m)),
        *group(-s.dtheta**2, s.M_rb * s.x_I * m.cos(s.theta), s.lam * s.M_rb * s.R_I * m.sin(s.alpha_I - s.theta),
               s.lam * s.M_S * s.R_S * m.sin(s.alpha_S - s.theta)),
        s.F,
    ]


@paper.value("4", of="N", momentum=True, title="Normal force")
def normal(s, m):
    return [
        s.M_T * s.g,
        s.lam * s.M_rb * m.sin(s.theta) * s.ddx_I,
        *group(s.lam * s.M_rb * s.x_I, m.cos(s.theta) * s.ddtheta, -m.sin(s.theta) * s.dtheta**2),
        2 * s.lam * s.M_rb * m.cos(s.theta) * s.dx_I * s.dtheta,
        *group(s.ddtheta, s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta), s.M_S * s.R_S * m.sin(s.alpha_S - s.theta)),
        *group(-s.dtheta**2, s.M_E * s.R_0 * m.cos(s.alpha_0 - s.theta), s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)),
    ]


@paper.value("5", of="F", title="Friction")
def friction(s, m):
    return [s.nu * s.N * m.sign(s.dx)]
