"""Energies of the double pendulum."""

from codegen.verify import Energies


def kinetic(s, m):
    across = s.l_1 * m.cos(s.theta_1) * s.dtheta_1, s.l_2 * m.cos(s.theta_2) * s.dtheta_2
    down = s.l_1 * m.sin(s.theta_1) * s.dtheta_1, s.l_2 * m.sin(s.theta_2) * s.dtheta_2
    upper = across[0]**2 + down[0]**2
    lower = sum(across)**2 + sum(down)**2
    return (s.m_1 * upper + s.m_2 * lower) / 2


def potential(s, m):
    first = s.l_1 * m.cos(s.theta_1)
    return -s.g * (s.m_1 * first + s.m_2 * (first + s.l_2 * m.cos(s.theta_2)))


energies = [Energies("point masses", "two point masses on massless rods", kinetic, potential)]
