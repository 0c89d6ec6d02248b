"""The numbers that the paper prints, each recomputed from the others and from the geometry, and
those that a simulation needs and the paper does not print."""

from codegen.verify.numbers import Number


def _solid_about_edge(mass, inner, outer, height):
    """Moment of inertia of a hollow cylinder about a tangent at the edge of its bottom, across."""
    return mass * ((outer**2 + inner**2) / 4 + height**2 / 12 + outer**2 + height**2 / 4)


def _shell_masses(n, m):
    """Shell and bottom plate, as thin walls on the printed radius."""
    shell = n.rho_a * 2 * m.pi * n.R * n.d * n.H
    plate = n.rho_a * m.pi * n.R**2 * n.d
    return shell, plate


numbers = [
    Number("R", "0.2", "m", "radius, half of the printed 400 mm", exact=True),
    Number("H", "0.4", "m", "height, printed 400 mm", exact=True),
    Number("d", "0.01", "m", "thickness of shell and bottom plate, printed 10 mm", exact=True),
    Number("rho", "998", "kg/m^3", "density of water; the paper gives none", exact=True),
    Number("f", "26", "Hz", "bulging frequency", exact=True),
    Number("zeta", "0.05", "1", "damping ratio", exact=True),
    Number("g", "9.80665", "m/s^2", "standard gravity", exact=True),
    Number("M_0", "50.3", "kg", "water, full plate", lambda n, m: n.rho * m.pi * n.R**2 * n.H,
           note="400 mm are the inner diameter and the depth of the water: the tank is full to the brim"),
    Number("R_0", "0.283", "m", "distance from the centre of the water to the edge", lambda n, m: m.sqrt(n.R**2 + n.H**2 / 4)),
    Number("alpha_0", "0.785", "rad", "its angle with the vertical", lambda n, m: m.atan(2 * n.R / n.H)),
    Number("R_I", "0.258", "m", "distance from the centre of the bulging water to the edge"),
    Number("alpha_I", "0.889", "rad", "its angle with the vertical, from R_I and the radius", lambda n, m: m.asin(n.R / n.R_I)),
    Number("ratio", "0.782", "1", "M_I / M_0, from the code cited", exact=True, note="cannot be recomputed from the paper"),
    Number("M_E", "50.3", "kg", "full plate: all of the water", lambda n, m: n.M_0),
    Number("I_E", "5.198", "kg*m^2", "full plate: a solid cylinder of water about the edge",
           lambda n, m: _solid_about_edge(n.M_0, 0, n.R, n.H), unit_printed="m^4",
           note="the number is the mass moment of inertia in kg m^2"),
    Number("delta", "0.9", "1", "doughnut: inner over outer radius of the plate", exact=True),
    Number("M_E_doughnut", "9.56", "kg", "doughnut: hollow cylinder of water above the plate",
           lambda n, m: n.M_0 * (1 - n.delta**2)),
    Number("I_E_doughnut", "1.065", "kg*m^2", "doughnut: that hollow cylinder about the edge",
           lambda n, m: _solid_about_edge(n.M_E_doughnut, n.delta * n.R, n.R, n.H), unit_printed="m^4",
           note="the number is the mass moment of inertia in kg m^2"),
    Number("ratio_rb", "0.152", "1", "doughnut: M_rb / M_I, from the paper's figure 3", exact=True,
           note="cannot be recomputed from the text"),
    Number("mu", "0.2", "1", "static friction", exact=True),
    Number("e", "0.6", "1", "restitution", exact=True),
    Number("nu", None, "1", "kinetic friction, 95 % of the static", lambda n, m: n.mu * 95 / 100),
    Number("M_I", None, "kg", "bulging water", lambda n, m: n.ratio * n.M_0),
    Number("M_rb_doughnut", None, "kg", "doughnut: bulging water that rocks", lambda n, m: n.ratio_rb * n.M_I),
    Number("H_I", None, "m", "height of the bulging water's centre", lambda n, m: n.R_I * m.cos(n.alpha_I)),
    Number("k", None, "N/m", "M_I (2 pi f)^2", lambda n, m: n.M_I * (2 * m.pi * n.f)**2),
    Number("c", None, "N*s/m", "2 zeta M_I (2 pi f)", lambda n, m: 2 * n.zeta * n.M_I * 2 * m.pi * n.f),
    Number("rho_a", "1190", "kg/m^3", "density of acrylic; the paper gives none", exact=True),
    Number("M_S", None, "kg", "shell and bottom plate", lambda n, m: sum(_shell_masses(n, m))),
    Number("I_S", None, "kg*m^2", "shell and bottom plate about the edge",
           lambda n, m: _shell_masses(n, m)[0] * (n.R**2 * 3 / 2 + n.H**2 / 3) + _shell_masses(n, m)[1] * n.R**2 * 5 / 4),
    Number("M_S/M_E", None, "1", "full plate: what is called relatively small", lambda n, m: n.M_S / n.M_E),
    Number("M_S/M_E_doughnut", None, "1", "doughnut: what is called relatively small", lambda n, m: n.M_S / n.M_E_doughnut),
    Number("I_S/I_E", None, "1", "full plate: what is called relatively small", lambda n, m: n.I_S / n.I_E),
    Number("I_S/I_E_doughnut", None, "1", "doughnut: what is called relatively small", lambda n, m: n.I_S / n.I_E_doughnut),
    Number("e_momentum", None, "1", "full plate: restitution that conservation of angular momentum about the new edge gives "
           "a rigid body, 1 - 2 M_E R_0^2 sin(alpha_0)^2 / I_E",
           lambda n, m: 1 - 2 * n.M_E * (n.R_0 * m.sin(n.alpha_0))**2 / n.I_E,
           note="the assumed 0.6 is not this: equation (10) is a measured law, not conservation of momentum"),
    Number("e_momentum_doughnut", None, "1", "doughnut: the same",
           lambda n, m: 1 - 2 * n.M_E_doughnut * (n.R_0 * m.sin(n.alpha_0))**2 / n.I_E_doughnut),
    Number("amplification", None, "1", "largest |ddx_I| / |ddz_h| at 7 Hz while the tank stands and sticks",
           lambda n, m: _amplification(n, m, 7)),
    Number("a_slip", None, "m/s^2", "full plate: amplitude at 7 Hz from which it slips, M_S neglected",
           lambda n, m: n.mu * n.M_0 * n.g / n.M_I / (1 + _amplification(n, m, 7)),
           note="moduli of ddx_I and ddz_h added: at 7 Hz they are in phase within 0.3 degrees"),
    Number("a_rock_printed", None, "m/s^2", "full plate: amplitude at 7 Hz from which (5) starts rocking, if it sticks",
           lambda n, m: n.M_0 * n.g * n.R_0 * m.sin(n.alpha_0)
           / (n.M_I * n.H_I * _amplification(n, m, 7) + n.M_0 * n.R_0 * m.cos(n.alpha_0))),
    Number("a_rock_bodies", None, "m/s^2", "full plate: the same from the energy-consistent moment, M_S neglected",
           lambda n, m: n.M_0 * n.g * n.R_0 * m.sin(n.alpha_0) / (n.M_I * n.H_I * (1 + _amplification(n, m, 7)))),
]


def _amplification(n, m, frequency):
    """|ddx_I / ddz_h| of the bulging oscillator on a base that sticks."""
    ratio = frequency / n.f
    return ratio**2 / m.sqrt((1 - ratio**2)**2 + (2 * n.zeta * ratio)**2)
