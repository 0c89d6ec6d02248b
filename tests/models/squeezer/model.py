"""Andrews' squeezing mechanism: seven bodies in a plane, six loops closed by constraints."""

from codegen.model import *

model = Model(
    "Andrews' squeezing mechanism",
    source="Schiehlen, W. (ed.) (1990), Multibody Systems Handbook, section 2.1; Hairer, E. and Wanner, G. (1996), Solving ODEs II, section VII.7",
)

NAMES = ("beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon")
beta, Theta, gamma, Phi, delta, Omega, epsilon = (model.coordinate(name, "rad", f"angle {name} of the handbook") for name in NAMES)


def given(name, unit, value, meaning):
    return model.parameter(name, unit, value, meaning)


masses = [given(f"m{i}", "kg", value, f"mass of body {i}") for i, value in enumerate(
    (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498), 1)]
inertias = [given(f"I{i}", "kg m^2", value, f"inertia of body {i} about its centre") for i, value in enumerate(
    (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5), 1)]
lengths = dict(
    xa=-0.06934, ya=-0.00227, xb=-0.03635, yb=0.03273, xc=0.014, yc=0.072, d=0.028, da=0.0115, e=0.02, ea=0.01421, rr=0.007,
    ra=0.00092, ss=0.035, sa=0.01874, sb=0.01043, sc=0.018, sd=0.02, ta=0.02308, tb=0.00916, u=0.04, ua=0.01228, ub=0.00449,
    zf=0.02, zt=0.04, fa=0.01421, l0=0.07785)
L = {name: given(name, "m", value, f"length {name} of the handbook") for name, value in lengths.items()}
c0 = given("c0", "N/m", 4530.0, "stiffness of the spring")
torque = given("torque", "N m", 0.033, "drive on the crank")


def body(i, x, y, angle):
    model.rigid_body(masses[i - 1], inertia=inertias[i - 1], position=(x, y), angle=angle)


d, da, e, ea, rr, ss, zf, zt, u, fa = (L[name] for name in ("d", "da", "e", "ea", "rr", "ss", "zf", "zt", "u", "fa"))
A, B, C = ((L["x" + p], L["y" + p]) for p in "abc")
coupler = beta + Theta
joint = (rr * cos(beta) - d * cos(coupler), rr * sin(beta) - d * sin(coupler))
body(1, L["ra"] * cos(beta), L["ra"] * sin(beta), beta)
body(2, rr * cos(beta) - da * cos(coupler), rr * sin(beta) - da * sin(coupler), coupler)
body(3, B[0] + L["sa"] * sin(gamma) + L["sb"] * cos(gamma), B[1] - L["sa"] * cos(gamma) + L["sb"] * sin(gamma), gamma)
body(4, A[0] + zt * cos(delta) + (e - ea) * sin(Phi + delta), A[1] + zt * sin(delta) - (e - ea) * cos(Phi + delta), Phi + delta)
body(5, A[0] + L["ta"] * cos(delta) - L["tb"] * sin(delta), A[1] + L["ta"] * sin(delta) + L["tb"] * cos(delta), delta)
body(6, A[0] + u * sin(epsilon) + (zf - fa) * cos(Omega + epsilon), A[1] - u * cos(epsilon) + (zf - fa) * sin(Omega + epsilon), Omega + epsilon)
body(7, A[0] + L["ua"] * sin(epsilon) - L["ub"] * cos(epsilon), A[1] - L["ua"] * cos(epsilon) - L["ub"] * sin(epsilon), epsilon)

end = (B[0] + L["sc"] * sin(gamma) + L["sd"] * cos(gamma), B[1] - L["sc"] * cos(gamma) + L["sd"] * sin(gamma))
model.potential(c0 * (sqrt((end[0] - C[0]) ** 2 + (end[1] - C[1]) ** 2) - L["l0"]) ** 2 / 2)
model.force(beta, torque)

model.constraint("third", (joint[0] - ss * sin(gamma) - B[0], joint[1] + ss * cos(gamma) - B[1]))
model.constraint("fourth", (
    joint[0] - e * sin(Phi + delta) - zt * cos(delta) - A[0],
    joint[1] + e * cos(Phi + delta) - zt * sin(delta) - A[1]))
model.constraint("sixth", (
    joint[0] - zf * cos(Omega + epsilon) - u * sin(epsilon) - A[0],
    joint[1] - zf * sin(Omega + epsilon) + u * cos(epsilon) - A[1]))
