"""Energies of the tank as a sum over bodies."""

from codegen.verify import Energies


def kinetic(s, m):
    sin, cos = m.sin(s.theta), m.cos(s.theta)
    ground = s.dx + s.dz_h
    across = ground - s.lam * s.R_I * m.cos(s.alpha_I - s.theta) * s.dtheta + s.dx_I * cos - s.x_I * sin * s.dtheta
    up = s.R_I * m.sin(s.alpha_I - s.theta) * s.dtheta + s.lam * (s.dx_I * sin + s.x_I * cos * s.dtheta)
    shell_across = ground - s.lam * s.R_S * m.cos(s.alpha_S - s.theta) * s.dtheta
    shell_up = s.R_S * m.sin(s.alpha_S - s.theta) * s.dtheta
    rest_up = (s.M_E * s.R_0 * m.sin(s.alpha_0 - s.theta) - s.M_rb * s.R_I * m.sin(s.alpha_I - s.theta)) * s.dtheta
    twice = s.M_rb * (across**2 + up**2) + (s.M_I - s.M_rb) * (ground + s.dx_I)**2
    twice += s.M_S * (shell_across**2 + shell_up**2) + s.M_T * s.dy**2
    twice += (s.I_S - s.M_S * s.R_S**2 + s.I_E - s.M_rb * s.R_I**2) * s.dtheta**2
    return (twice + 2 * s.dy * (s.M_rb * up + s.M_S * shell_up + rest_up)) / 2


def potential(s, m):
    height = s.M_E * s.R_0 * m.cos(s.alpha_0 - s.theta) + s.M_S * s.R_S * m.cos(s.alpha_S - s.theta)
    return s.g * (s.M_T * s.y + height + s.lam * s.M_rb * s.x_I * m.sin(s.theta)) + s.k * s.x_I**2 / 2


tank = Energies("bodies", "rocking and resting bulging liquid, shell, rest of the rocking liquid", kinetic, potential,
                lambda s, m: s.c * s.dx_I**2 / 2, {"x": lambda s, m: -s.F})
tank.coordinate("y", "m", "height of the tank; held")


@tank.reference("4")
def normal(s, m, motion):
    return motion.residual("y")


@tank.reference("5")
def friction(s, m, motion):
    return s.nu * m.sign(s.dx) * s.N


energies = [tank]
