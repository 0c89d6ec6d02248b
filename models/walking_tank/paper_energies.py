"""Energies in the paper's own symbols, with a height y of the tank whose reaction is the normal
force. The paper prints no energies; these are what its equations can have come from.

Two of the paper's statements leave room: which mass carries the horizontal momentum of bulging
when the tank is tilted (`bulging`), and which first moment carries that of rocking (`rocking`).
All combinations that come from positions (so that Galilei's principle holds) are candidates.
`energies[0]` is the one with which most printed terms agree; tests count them all. `energies[1]`
is the energy-consistent model, a sum over bodies.
"""

from codegen.verify.lagrange import Energies

from .paper import paper

BULGING = ("M_rb", "M_I")
ROCKING = ("M_rb", "M_I", "M_E")


def _references(energies):
    """What the printed forces, conditions and rules must equal, given the energies."""
    energies.coordinate("y", "m", "height of the tank; always held, its reaction is the normal force")

    @energies.reference("4")
    def friction(s, m, motion):
        return motion.ring.read(s.nu * m.sign(s.dx)) * motion.residual("y")

    @energies.reference("5")
    def lift_off(s, m, motion):
        # the moment about the pivot edge that would hold theta = 0 has become negative; (5) sums
        # moduli, which is right at most where all accelerations push towards the pivot: |a| = lambda a
        return -motion.at_rest("theta", "theta")

    for number in ("6a", "6b"):
        energies.reference(number, scale=lambda s, m: s.M_rb * s.R_I * m.cos(s.alpha_I))(_pivot)

    @energies.reference("7")
    def slip(s, m, motion):
        return m.Abs(s.R_x) - s.mu * s.R_y

    @energies.reference("8")
    def shear(s, m, motion):
        # while the base sticks: the slip does not move and its reaction replaces F
        return motion.frozen("x", "x") - motion.ring.read(s.F)

    @energies.reference("9")
    def normal(s, m, motion):
        return motion.residual("y")

    @energies.reference("10")
    def landing(s, m, motion):
        # theta >= 0 is the uplift about whichever edge is the pivot: it closes before, opens after
        return -s.e * s.dtheta

    return energies


def _pivot(s, m, motion):
    # of the two edges, the one whose moment fails: the part of the moment that changes its sign
    # with lambda; the printed sum of accelerations acts on the lever of the bulging liquid
    return -motion.at_rest("theta", "theta").coefficient("lam")


def _potential(s, m):
    weight = s.M_T * s.y + s.M_E * s.R_0 * m.cos(s.alpha_0 - s.theta) + s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)
    return s.g * (weight + s.lam * s.M_rb * s.x_I * m.sin(s.theta)) + s.k * s.x_I**2 / 2


def _dissipation(s, m):
    return s.c * s.dx_I**2 / 2


def candidate(bulging, rocking):
    """The energies whose horizontal momentum has the mass `bulging` moving along the tilted base
    line and the first moment of `rocking`."""

    def kinetic(s, m):
        masses = {"M_rb": (s.M_rb, s.R_I, s.alpha_I), "M_I": (s.M_I, s.R_I, s.alpha_I), "M_E": (s.M_E, s.R_0, s.alpha_0)}
        tilted = masses[bulging][0]
        mass, radius, alpha = masses[rocking]
        sin, cos = m.sin(s.theta), m.cos(s.theta)
        ground = s.dx + s.dz_h
        # rates of the first moments, horizontal and vertical, about the pivot edge
        along = tilted * (s.dx_I * cos - s.x_I * sin * s.dtheta) + (s.M_I - tilted) * s.dx_I
        along -= s.lam * s.dtheta * (mass * radius * m.cos(alpha - s.theta) + s.M_S * s.R_S * m.cos(s.alpha_S - s.theta))
        up = s.dtheta * (s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta) + s.M_S * s.R_S * m.sin(s.alpha_S - s.theta))
        up += s.lam * s.M_rb * (s.dx_I * sin + s.x_I * cos * s.dtheta)
        inertia = s.I_E + s.I_S + s.M_rb * (s.x_I**2 + 2 * s.lam * s.R_I * m.sin(s.alpha_I) * s.x_I)
        energy = inertia * s.dtheta**2 + s.M_I * s.dx_I**2 - 2 * s.lam * s.M_rb * s.R_I * m.cos(s.alpha_I) * s.dtheta * s.dx_I
        energy += (s.M_I + s.M_S) * ground**2 + s.M_T * s.dy**2 + 2 * ground * along + 2 * s.dy * up
        return energy / 2

    return _references(Energies(
        name=f"bulging {bulging}, rocking {rocking}",
        description=f"horizontal momentum of bulging in the tilted tank by {bulging}, of rocking by {rocking}",
        kinetic=kinetic, potential=_potential, dissipation=_dissipation, forces={"x": lambda s, m: -s.F},
    ))


def _velocities(s, m):
    """Velocities of the bodies of the energy-consistent model: bulging liquid that rocks, shell."""
    sin, cos = m.sin(s.theta), m.cos(s.theta)
    ground = s.dx + s.dz_h
    liquid = (ground - s.lam * s.R_I * m.cos(s.alpha_I - s.theta) * s.dtheta + s.dx_I * cos - s.x_I * sin * s.dtheta,
              s.R_I * m.sin(s.alpha_I - s.theta) * s.dtheta + s.lam * (s.dx_I * sin + s.x_I * cos * s.dtheta))
    shell = (ground - s.lam * s.R_S * m.cos(s.alpha_S - s.theta) * s.dtheta, s.R_S * m.sin(s.alpha_S - s.theta) * s.dtheta)
    return ground, liquid, shell


def _squares(s, m):
    ground, liquid, shell = _velocities(s, m)
    return [
        (s.M_rb, liquid[0]), (s.M_rb, liquid[1]), (s.M_I - s.M_rb, ground + s.dx_I),
        (s.M_S, shell[0]), (s.M_S, shell[1]),
        (s.I_S - s.M_S * s.R_S**2, s.dtheta), (s.I_E - s.M_rb * s.R_I**2, s.dtheta),
    ]


def _bodies(s, m):
    _, liquid, shell = _velocities(s, m)
    energy = sum(mass * velocity**2 for mass, velocity in _squares(s, m))
    # the rest of the rocking liquid has weight and vertical momentum, but no horizontal momentum
    rest = (s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta) - s.M_rb * s.R_I * m.sin(s.alpha_I - s.theta)) * s.dtheta
    vertical = s.M_rb * liquid[1] + s.M_S * shell[1] + rest
    return (energy + s.M_T * s.dy**2 + 2 * s.dy * vertical) / 2


candidates = [candidate(bulging, rocking) for bulging in BULGING for rocking in ROCKING]

consistent = _references(Energies(
    name="energy-consistent bodies",
    description="bulging liquid that rocks, bulging liquid that does not, shell, and the rest of the rocking liquid",
    kinetic=_bodies, potential=_potential, dissipation=_dissipation, forces={"x": lambda s, m: -s.F},
    squares=_squares,
))

energies = [candidate("M_I", "M_E"), consistent]
