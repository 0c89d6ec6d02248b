"""Bodies of one coordinate each, driven through one function each: what every Taylor recurrence is tried on."""

import casadi as ca

from codegen.model import *

model = Model("Functions", source="test model: tests/engine/functions.rs")

h = model.parameter("h", "1", 0.7, "a number")
m = model.parameter("m", "kg m^2", 1.0, "moment of inertia", above=0)
unit = model.parameter("unit", "N m", 1.0, "unit of moment")
z = model.coordinate("z", "rad", "swings")
model.kinetic(m * z.rate**2 / 2)
model.potential(unit * z**2 / 2)

FUNCTIONS = {
    "angle": lambda x: atan2(x + h, 1.5 + z), "angle_over": lambda x: atan2(3 + x, -h), "angle_under": lambda x: atan2(h, x - 3),
    "length": lambda x: ca.hypot(1 + x, z), "length_over": lambda x: ca.hypot(h, x),
    "arc_tangent": lambda x: ca.atan(x * z), "area_tangent": lambda x: ca.atanh(0.5 * x), "area_sine": lambda x: ca.asinh(x + z),
    "area_cosine": lambda x: ca.acosh(3 + x), "arc_sine": lambda x: ca.asin(0.5 * x), "arc_cosine": lambda x: ca.acos(0.5 * z * x),
    "power": lambda x: (2 + x) ** z, "power_of_a_number": lambda x: h**x, "root": lambda x: (2 + x) ** h,
    "less_one": lambda x: ca.expm1(x), "of_one_and": lambda x: ca.log1p(0.5 * x), "error": lambda x: ca.erf(x + z),
    "tangent": lambda x: tan(0.5 * x) + ca.tanh(z), "pair": lambda x: ca.sinh(x) - ca.cosh(z) * cos(x),
    "logarithm": lambda x: ca.log(3 + x) / (2 + x),
}
for name, function in FUNCTIONS.items():
    x = model.coordinate(name, "rad", f"driven through {name}")
    model.kinetic(m * x.rate**2 / 2)
    model.potential(unit * x**2)
    model.force(x, -0.3 * unit * function(x))
