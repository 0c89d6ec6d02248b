"""Emission of C that computes Taylor coefficients: automatic differentiation of the time series.

A column of expressions becomes two C functions. The first gives the coefficients of order 0 of all
nodes of the expression graph; the second appends those of the orders k = 1, 2, … in turn. Each order
is one pass over the graph (Moore 1966; Jorba and Zou 2005, Experiment. Math. 14, section 2).

A product z = x y has z_k = x_0 y_k + x_k y_0 + Σ_{j=1}^{k-1} x_j y_{k-j}. The sum, the interior of
the convolution, is known before order k is begun. So is that of every other node that is not
linear, since each obeys a product rule: an order first computes all interiors (interiors.py), and
then walks the graph once in straight-line code.

Without interiors, and with so few that both halves of their sums fit into a block, the orders are unrolled:
one with its number known is straight-line code. With more the code grows beyond what a processor keeps at
hand.

The arithmetic of the nodes is that of series_graph.py.
"""

import casadi as ca

from .emit_c import MOST_ORDERS, zeros
from .series_graph import ONE, VARIABLE, Graph, Node, walk

__all__ = ["Equations", "Outputs", "Series"]


MOST_UNROLLED = 8
"""Most coordinates whose accelerations are written out, each with all its products: the code grows as their square."""


class Series:
    """The two series functions of a column of expressions.

    `moving` lists (C array, column of symbols) of what varies in time, one row of the array an
    order; `constant` what does not. `drift` maps the index of a held coordinate to the expression of
    its constant rate; the other `held` ones rest.

    `ends`: whether no coefficient of an order beyond 0, or beyond those of the arguments, differs from zero.
    """

    def __init__(self, output, moving, constant, held, drift):
        self.graph = Graph()
        self.gains = []
        """Texts of factors that the beginning of a step gives."""
        place = {}
        for array, symbols in moving:
            width = symbols.numel()
            for i in range(width):
                place[symbols[i].element_hash()] = Node(f"{array}[{i}]", f"{array}[{width} * k + {i}]")
        for array, symbols in constant:
            for i in range(symbols.numel()):
                place[symbols[i].element_hash()] = Node(f"{array}[{i}]")
        for i in range(held.numel()):
            place[held[i].element_hash()] = Node(f"h[{i}]")
        if drift:
            rates = walk(self.graph, place, ca.vertcat(*drift.values()))
            for i, rate in zip(drift, rates):
                next = f"(k == 1 ? {self.graph.first(rate)} : REAL(0.0))"
                place[held[i].element_hash()] = Node(f"h[{i}]", next)
        self.nodes = walk(self.graph, place, output)
        values = {i: node.zeroth for i, node in enumerate(self.nodes)}
        self.graph.start += zeros(values, "0.0")
        for i, value in values.items():
            self.graph.start.append(f"  out[{i}] = REAL({value});")

    def finish(self):
        """Lays out the workspace: coefficients of order 0, then a row an order with the left and the
        right factors of the interiors."""
        graph, interiors = self.graph, self.graph.interiors
        self.row = interiors.row
        self.order = ["  const double order = (double)k, inverse_k = dalembert_inverses[k];", "  (void)order, (void)inverse_k;"]
        stores = interiors.stores() if interiors else []
        needed = set(VARIABLE.findall("\n".join([*stores, *interiors.late.values()])))
        statements = graph.statements(needed)
        self.lead = interiors.lead(graph.slots) if interiors else graph.slots
        self.operations = len(statements)
        self.order += [*(interiors.sums(self.lead) if interiors else []), *statements, *stores]

    def add_to(self, source, name):
        """Adds both functions to a `Source`; returns the names under which they can be called."""
        start = source.add_text(f"{name}_start", _SIGNATURE, _text(self.graph.beginning()))
        interiors = self.graph.interiors
        few, in_pairs = interiors.few and len(interiors), interiors.in_pairs and len(interiors)
        signature = f"const size_t k, {_SIGNATURE}" + (", real *restrict last" if few else "")
        signature += ", const dalembert_block *given" if in_pairs else ""
        signature += ", const real *gains" if self.gains else ""
        order = source.add_text(f"{name}_order", signature, _text(self.order), "DALEMBERT_INLINE")
        gains = ", gains" if self.gains else ""
        call = f"{order}(%s, q, v, a, u, x, w, out{', last' if few else ''}{gains});"
        orders = [f"  for (size_t k = 1; k < n; ++k) {call % 'k'}"]
        if in_pairs:
            pair = source.add_text(f"{name}_pair", "const size_t k, const real *q, const real *v, const real *a, const real *u, const real *w,\n"
                                   "    dalembert_block *out",
                                   "  (void)q, (void)v, (void)a, (void)u;\n" + "\n".join(interiors.pair(self.lead)), "DALEMBERT_INLINE")
            one = f"{order}(%s, q, v, a, u, x, w, out, last, %s{gains});"
            orders = [
                "  size_t k = 1;",
                # None is left over after the last two.
                f"  for (; k < 4 - n % 2 && k < n; ++k) {one % ('k', 'NULL')}",
                "  for (; k + 1 < n; k += 2) {",
                f"    dalembert_block pair[2 * {interiors.blocks}];",
                f"    {pair}(k, q, v, a, u, w, pair);",
                f"    {one % ('k', 'pair')}",
                f"    {one % ('k + 1', f'pair + {interiors.blocks}')}",
                "  }",
            ]
        if interiors.halves == 2:
            unrolled = [f"  if (n <= {k}) return;\n  {call % k}" for k in range(1, MOST_ORDERS)]
            # A vector of eight lanes fills the processor without.
            orders = ["#ifdef LANES", *orders, "#else", *unrolled, "#endif"]
        if few:
            orders.insert(0, f"  real last[{2 * few}] = {{0}};")
        if self.gains:
            orders.insert(0, f"  const real gains[] = {{{', '.join(self.gains)}}};")
        run = source.add_text(f"{name}_run", f"size_t n, {_SIGNATURE}", _text(orders), "DALEMBERT_CLONES")
        return start, run


class Outputs(Series):
    """Series of functions of a motion whose coefficients are all known."""

    def __init__(self, output, **arguments):
        super().__init__(output, **arguments)
        for i, node in enumerate(self.nodes):
            value = "0.0" if node.constant else self.graph.value(node)
            self.graph.state(f"out[{len(self.nodes)} * k + {i}] = REAL({value});")
        self.ends = not self.graph.interiors
        self.finish()


class Equations(Series):
    """The motion of r = M a + b = 0.

    Of order 0 the first function gives M (column-major) and b. Of order k,
    M_0 a_k = −(b_k + Σ_{j=1}^{k} M_j a_{k-j}), which the accelerations up to order k − 1 give: the
    second function takes the inverse of M_0 for `out`, and appends a_k, v_{k+1} and q_{k+2}.
    """

    def __init__(self, free, output, **arguments):
        super().__init__(output, **arguments)
        graph = self.graph
        masses = self.nodes[:free * free]
        self.ends = all(node.constant for node in self.nodes[:free * (free + 1)])
        residuals = []
        for i in range(free):
            load = self.nodes[free * free + i]
            forms = [] if load.constant else [graph.form(load)]
            for j, mass in enumerate(masses[i::free]):
                if not mass.constant:
                    # The acceleration is not known at the start, where factors are multiplied.
                    forms += [self._late(mass, j, free), {f"{graph.value(mass)} * a[{j}]": ONE}]
            residuals.append(graph._merged(graph.sum(*forms)))
        if all(mass.constant for mass in masses) and self._is_cheap_to_solve(residuals):
            self._append_by_gains(residuals)
        else:
            self._append(residuals)
        self.finish()

    @staticmethod
    def _is_cheap_to_solve(residuals):
        """Whether multiplying the inverse into the factors of all terms makes no more products an order."""
        free, terms = len(residuals), sum(map(len, residuals))
        return free * len({term for form in residuals for term in form}) <= terms + free * free + free

    def _append_by_gains(self, residuals):
        """Appends an order where M is constant: rates are a linear form of the terms, with factors that the inverse
        gives at the beginning of a step. So an order waits for one product and a sum."""
        graph, free = self.graph, len(residuals)
        terms = sorted(dict.fromkeys(term for form in residuals for term in form), key=graph._age)
        for i in range(free):
            gains = []
            for term in terms:
                parts = [(f"out[{free * j + i}]", form[term]) for j, form in enumerate(residuals) if term in form]
                products = " + ".join(inverse if factor is ONE else f"{inverse} * {graph.first(factor)}"
                                      for inverse, factor in parts)
                gains.append(f"gains[{len(self.gains)}]")
                self.gains.append(f"-({products})")
            inverse = "dalembert_inverses[k + 1]"
            products = [f"({gain} * {inverse}) * {term}" for gain, term in zip(gains, terms)]
            plain = " + ".join(f"{gain} * {term}" for gain, term in zip(gains, terms))
            # In lanes it is the number of operations that counts, not how many of them wait for each other.
            graph.state(f"""
#ifdef LANES
  const real a{i} = {plain or 'REAL(0.0)'}, v{i} = a{i} * {inverse};
#else
  const real v{i} = {' + '.join(products) or 'REAL(0.0)'}, a{i} = v{i} * (order + 1.0);
#endif""".lstrip(), dict.fromkeys(terms, ONE))
            graph.state(f"a[{free} * k + {i}] = a{i};")
            graph.state(f"v[{free} * (k + 1) + {i}] = v{i};")
            graph.state(f"q[{free} * (k + 2) + {i}] = v{i} * dalembert_inverses[k + 2];")

    def _append(self, residuals):
        """Appends an order."""
        graph, free = self.graph, len(residuals)
        if free > MOST_UNROLLED:
            self._append_in_loops(residuals)
            return
        for i, residual in enumerate(residuals):
            graph.state(f"const real r{i} = REAL(%s);", residual)
        for i in range(free):
            row = "".join(f" - out[{free * j + i}] * r{j}" for j in range(free))[1:].replace("- ", "-", 1)
            graph.state(f"const real a{i} = {row};")
            graph.state(f"a[{free} * k + {i}] = a{i};")
            graph.state(f"v[{free} * (k + 1) + {i}] = a{i} * dalembert_inverses[k + 1];")
            graph.state(f"q[{free} * (k + 2) + {i}] = a{i} * (dalembert_inverses[k + 1] * dalembert_inverses[k + 2]);")

    def _append_in_loops(self, residuals):
        """The same of many coordinates, to the same bits: each sum in the same order, of all coordinates side by side."""
        graph, free = self.graph, len(residuals)
        graph.state(f"real r[{free}], next[{free}];")
        for i, residual in enumerate(residuals):
            graph.state(f"r[{i}] = REAL(%s);", residual)
        each = f"for (size_t i = 0; i < {free}; ++i)"
        graph.state(f"{each} next[i] = -out[i] * r[0];")
        graph.state(f"for (size_t j = 1; j < {free}; ++j) {{")
        graph.state(f"  {each} next[i] -= out[{free} * j + i] * r[j];")
        graph.state("}")
        graph.state("const real by_k = dalembert_inverses[k + 1], by_both = dalembert_inverses[k + 1] * dalembert_inverses[k + 2];")
        graph.state(f"{each} {{")
        graph.state(f"  a[{free} * k + i] = next[i];")
        graph.state(f"  v[{free} * (k + 1) + i] = next[i] * by_k;")
        graph.state(f"  q[{free} * (k + 2) + i] = next[i] * by_both;")
        graph.state("}")

    def _late(self, mass, j, free):
        """Interior of M a. The acceleration of order k is not known at order k."""
        value = self.graph.value(mass)
        return {self.graph.interiors.add_late(value, f"acceleration {j}", f"a[{free} * (k - 1) + {j}]"): ONE}


_SIGNATURE = ("real *restrict q, real *restrict v, real *restrict a, const real *u,\n"
              "    const struct dalembert_context *x, real *restrict w, real *restrict out")


def _text(lines):
    text = "\n".join(lines)
    arrays = "".join(
        f"  const real *const {field} = x->{field};\n"
        for field in ("d", "h", "c") if f" {field}[" in text or f"({field}[" in text
    )
    unused = "".join(f"  (void){name};\n" for name in ("q", "v", "a", "u", "x", "w", "out"))
    return unused + arrays + text
