"""The walking tank for heyoka: the generator's expressions of each mode, translated; its events from tank_events.cpp."""

import ctypes
import os
import pathlib
import sys

import casadi as ca
import heyoka as hy
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT))

from codegen import generate  # noqa: E402: found by the line above

COORDINATES = ("theta", "x_I", "x")
OPERATIONS = {
    ca.OP_ADD: lambda a, b: a + b, ca.OP_SUB: lambda a, b: a - b, ca.OP_MUL: lambda a, b: a * b, ca.OP_DIV: lambda a, b: a / b,
    ca.OP_NEG: lambda a: -a, ca.OP_SQ: lambda a: a * a, ca.OP_TWICE: lambda a: 2.0 * a, ca.OP_INV: lambda a: 1.0 / a,
    ca.OP_SIN: hy.sin, ca.OP_COS: hy.cos, ca.OP_SQRT: hy.sqrt, ca.OP_ASSIGN: lambda a: a,
}


def translated(function, *arguments):
    """A CasADi function of expressions of heyoka, one output."""
    work, outputs = {}, [None] * function.numel_out(0)
    for k in range(function.n_instructions()):
        operation, inputs, [*target] = function.instruction_id(k), function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_INPUT:
            work[target[0]] = arguments[inputs[0]][inputs[1]]
        elif operation == ca.OP_OUTPUT:
            outputs[target[1]] = work[inputs[0]]
        elif operation == ca.OP_CONST:
            work[target[0]] = hy.expression(function.instruction_constant(k))
        else:
            work[target[0]] = OPERATIONS[operation](*(work[i] for i in inputs))
    return outputs


class Tank:
    """A problem as `heyoka_rows.Problem` has it; its side is (mode, side of the pivot, direction of slip)."""

    stop_after = None

    def __init__(self, name):
        self.name, self.free, self.tolerance = name, name == "free", 1.0
        self.end = 0.5 if self.free else 2.0
        self.library = ctypes.CDLL(os.environ["PEERS_TANK"])
        real, whole, array = ctypes.c_double, ctypes.c_int, ctypes.c_void_p
        self.library.tank_start.argtypes = [ctypes.c_bool, array, real, array]
        for function in (self.library.tank_event, self.library.tank_idle):
            function.argtypes = [ctypes.c_bool, real, array, whole, array]
        self.discrete = (real * 2)()
        self.discrete_at, self.addresses = ctypes.addressof(self.discrete), {}
        y = np.zeros(6)
        self.side = self.begun(self.tolerance, y)
        self.start = list(y)
        self.modes = self.expressions()

    def address(self, y):
        """Of an array that lives as long as the problem; looked up once, since that takes a microsecond."""
        found = self.addresses.get(id(y))
        if found is None:
            found, _ = self.addresses[id(y)] = (y.ctypes.data, y)
            return found
        return found[0]

    def begun(self, tolerance, y=np.zeros(6)):
        """The side at the start of a run, for the events of the library."""
        mode = self.library.tank_start(self.free, self.address(y), tolerance, self.discrete_at)
        return (mode, *self.discrete)

    def mode(self, side):
        return side[0]

    def parameters(self, side):
        return side[1:]

    def event(self, t, y, side, which):
        side = (self.library.tank_event(self.free, t, self.address(y), which, self.discrete_at), *self.discrete)
        beyond = 1e-18  # as in heyoka_rows: a guard must not start at zero
        if y[0] == 0:
            y[0] = beyond if y[3] > 0 else 0
        if y[5] == 0:
            y[5] = side[2] * beyond if self.slides[side[0]] else 0
        return side

    def idle(self, t, y, side):
        """The calls of an event without the event."""
        return (self.library.tank_idle(self.free, t, self.address(y), 0, self.discrete_at), *self.discrete)

    def expressions(self):
        variant = generate.derive_variant(generate.load(str(ROOT / "models" / "walking_tank"))[0])
        model = variant.model
        y = hy.make_vars("theta", "x_I", "x", "theta_rate", "x_I_rate", "x_rate")
        zero = hy.expression(0.0)
        ground = zero if self.free else 20 * hy.sin(7 * 2 * np.pi * hy.time)
        signals = ca.vertcat(*[s for i in model.inputs for s in i.signals])
        discretes = ca.vertcat(*[d.symbol for d in model.discretes])
        parameters = ca.vertcat(*[p.symbol for p in model.parameters])
        values = ca.DM([p.default for p in model.parameters])
        modes, self.slides = {}, []
        for index, equations in enumerate(variant.modes):
            free = list(equations.free)
            n = len(free)
            self.slides.append(2 in free)
            system = variant.functions[index, "system"].output
            mass, load = ca.reshape(system[: n * n], n, n), system[n * n:]
            accelerations = -ca.inv_minor(mass) @ load
            inputs = [equations.q, equations.v, discretes, signals, equations.held]
            arguments = [[y[i] for i in free], [y[3 + i] for i in free], [hy.par[0], hy.par[1]], [ground, *[zero] * (signals.numel() - 1)], [*y[:3], zero]]
            # All of the parameters of the full plate are the model's defaults.
            place = lambda e: ca.Function("f", inputs, [ca.densify(ca.cse(ca.substitute(ca.substitute(e, equations.a, accelerations), parameters, values)))])
            a = translated(place(accelerations), *arguments)
            rates = [zero * y[0]] * 6
            for k, i in enumerate(free):
                rates[i], rates[3 + i] = y[3 + i], a[k]
            guards = [translated(place(variant.functions[index, "guard", g].output), *arguments)[0] for g in range(len(equations.guards))]
            modes[index] = (list(zip(y, rates)), guards)
        return modes
