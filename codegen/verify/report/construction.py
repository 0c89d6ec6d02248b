"""What is constructed from equations, in words and formulas that all forms of the report share."""


def construction_parts(constructed, paper):
    """[(words, form or None)]: T and V, balances, conserved quantities, small motions."""
    if constructed.lagrangian is None:
        return [(f"No Lagrangian: {constructed.why}.", None), *_small(constructed, paper), *_cases(constructed)]
    found, parts = constructed.lagrangian, []
    parts.append((f"A Lagrangian exists (proved: Lagrange's equations of it are ({'), ('.join(found.equations)}), each times a constant, but for "
                  "what is dissipative). Its kinetic energy, up to a function of time, T = ", found.kinetic))
    if found.gyroscopic:
        parts.append(("What is linear in the rates: ", found.gyroscopic))
    parts.append(("Its potential energy, up to a constant, V = ", found.potential))
    energy = constructed.energy
    if energy.rate:
        parts.append(("The energy (the sum of v dL/dv, less L) changes at the rate ", energy.rate))
    else:
        parts.append(("The energy is conserved: ", energy.quantity))
    for balance in constructed.momenta:
        parts.append((f"{balance.name} is cyclic; its momentum is ", balance.quantity))
        parts.append(("and changes at the rate ", balance.rate) if balance.rate else ("and is conserved.", None))
    cyclic = {str(b.quantity) for b in constructed.momenta}
    rest = [c for c in constructed.conserved if str(c.quantity) not in cyclic and not _cyclic(c, constructed)]
    for c in rest:
        parts.append((f"Conserved without dissipation, forces and inputs, of degree {c.degree} in the rates: ", c.quantity))
    if not rest:
        parts.append(("No further conserved quantity of first or second degree in the rates was found with multipliers of low degree.", None))
    return parts + _small(constructed, paper) + _frequencies(constructed.frequencies) + _cases(constructed)


def _small(constructed, paper):
    """Small motions about rest: the equations of first order, and the roots of what is damped."""
    small, parts = constructed.small, []
    if small is None:
        return [("The equations are divided by what is zero at rest: there are no small motions about it.", None)]
    given = {n: 0 for n, x in paper.symbols.items() if x.role == "force"}
    for k, name in enumerate(small.coordinates):
        if small.forces[k].substitute(given):
            parts.append((f"Rest is no equilibrium: there the equation of {paper.shown(name)} leaves ", small.forces[k]))
    if not parts:
        parts = [(f"Small motions about rest, equation of {paper.shown(name)}: 0 = ", form) for k, name in enumerate(small.coordinates)
                 if (form := small.equation(k, small.forces[k].ring))]
    for name, roots in constructed.modes.items():
        parts.append((f"Small motions about rest, with damping and gyroscopic terms: {', '.join(map(_root_text, roots))} ({name})", None))
    return parts


def _root_text(root):
    """A motion exp(s t)."""
    change = "" if root.real == 0 else f"{'decays' if root.real < 0 else 'grows'} with {abs(root.real):.6g} 1/s"
    if root.imag == 0:
        return change or "constant"
    return f"{root.imag:.6g} rad/s" + (f" that {change}" if change else "")


def _cases(constructed):
    """Special cases and limits."""
    return [(f"Where {name}: {'; '.join(said)}.", None) for name, said in constructed.cases]


def _frequencies(found):
    """Small motions about rest, without damping and forces: w is the square of a frequency."""
    if not found:
        return []
    if found.polynomial and not found.polynomial[-1]:
        return [("Small motions about rest have no frequencies: the mass matrix is singular there.", None)]
    parts, about = [], "Small motions about rest, without damping and forces: "
    if len(found.polynomial) == 2:
        # k - w m = 0
        parts.append((f"{about}the square of the frequency is w = ", -found.polynomial[0] * found.polynomial[1].inverse()))
    elif len(found.polynomial) == 3:
        parts += [(f"{about}the squares w of the frequencies solve a w² + b w + c = 0 with a = ", found.polynomial[2]), ("b = ", found.polynomial[1]),
                  ("c = ", found.polynomial[0])]
    for name, roots in found.values.items():
        shown = [f"{root**0.5:.6g} rad/s" if root > 0 else "0" if root == 0 else f"growth with {(-root)**0.5:.6g} 1/s" for root in roots]
        parts.append((f"{about}{', '.join(shown)} ({name})", None))
    return parts


def _cyclic(conserved, constructed):
    """Whether a conserved quantity is the momentum of a cyclic coordinate: its multipliers are constants of one equation."""
    used = [f for f in conserved.factors if f]
    return conserved.degree == 1 and len(used) == 1 and used[0].is_number() and bool(constructed.momenta)
