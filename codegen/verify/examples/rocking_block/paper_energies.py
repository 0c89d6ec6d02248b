"""Energies of the rocking and sliding block, with its height y for the normal force."""

from codegen.verify import Energies


def kinetic(s, m):
    across = s.dx + s.dz_h - s.lam * s.R * m.cos(s.alpha - s.theta) * s.dtheta
    up = s.dy + s.R * m.sin(s.alpha - s.theta) * s.dtheta
    return (s.m * (across**2 + up**2) + (s.I - s.m * s.R**2) * s.dtheta**2) / 2


def potential(s, m):
    return s.m * s.g * (s.y + s.R * m.cos(s.alpha - s.theta))


block = Energies("rigid block", "a rigid body on its edge", kinetic, potential, forces={"x": lambda s, m: -s.F})
block.coordinate("y", "m", "height of the edge; held")


@block.reference("3")
def normal(s, m, motion):
    return motion.residual("y")


@block.reference("4")
def friction(s, m, motion):
    return s.nu * m.sign(s.dx) * s.N


energies = [block]
