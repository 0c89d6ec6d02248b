"""What is constructed from equations alone: Lagrangians against known energies, conserved quantities against those of
textbooks, impact laws against energies by hand, and what has none."""

import unittest
from fractions import Fraction

from codegen.verify import Paper, seeded
from codegen.verify.construct.antiderivative import antiderivative
from codegen.verify.construct.balance import energy_balance, momentum_balances
from codegen.verify.construct.conserved import conserved
from codegen.verify.construct.impacts import impact
from codegen.verify.construct.lagrangian import construct, equations_of
from codegen.verify.construct.small import small_motion, special_cases
from codegen.verify.errors import NotInClass
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import load
from codegen.verify.normal.algebra import Ring
from codegen.verify.readings.lagrange import Motion

UNITS = {"x": "m", "y": "m", "r": "m", "phi": "rad", "theta": "rad", "m": "kg", "M": "kg", "k": "N/m", "l": "m", "g": "m/s^2", "B": "N*s/m", "c": "N*s/m"}


def paper_of(coordinates, parameters, equations, damping=()):
    """A paper with equations of motion, by coordinate."""
    paper = Paper("Test", "by hand")
    for name in coordinates:
        paper.coordinate(name, UNITS[name], name)
    for name in parameters:
        paper.parameter(name, UNITS[name], name, dissipative=name in damping)
    for k, (name, function) in enumerate(equations.items(), 1):
        paper.motion(str(k), of=name)(function)
    return paper


def read(subject, function):
    return subject.ring.read(function(subject.s, subject.m))


OSCILLATOR = {"x": lambda s, m: [s.m * s.ddx, s.k * s.x], "y": lambda s, m: [s.m * s.ddy, s.k * s.y]}
SPHERICAL = {
    "theta": lambda s, m: [s.m * s.l**2 * s.ddtheta, -s.m * s.l**2 * m.sin(s.theta) * m.cos(s.theta) * s.dphi**2, s.m * s.g * s.l * m.sin(s.theta)],
    "phi": lambda s, m: [s.m * s.l**2 * m.sin(s.theta)**2 * s.ddphi, 2 * s.m * s.l**2 * m.sin(s.theta) * m.cos(s.theta) * s.dtheta * s.dphi]}
CHARGE = {"x": lambda s, m: [s.m * s.ddx, -s.B * s.dy], "y": lambda s, m: [s.m * s.ddy, s.B * s.dx]}


class Antiderivatives(unittest.TestCase):
    def test_its_derivative_is_the_form(self):
        import sympy

        q, a = sympy.symbols("q a", real=True)
        ring = Ring(first=["a"])
        for expression in (q**3, q**2 * sympy.sin(2 * q + a), q * sympy.cos(a - q / 3), a * q**-2, sympy.sin(a)):
            form = ring.read(expression)
            self.assertEqual(antiderivative(form, "q").diff("q"), form, expression)

    def test_a_logarithm_is_refused(self):
        with self.assertRaisesRegex(NotInClass, "logarithm"):
            antiderivative(Ring().symbol("q") ** -1, "q")


class Lagrangians(unittest.TestCase):
    def test_of_correct_equations_is_that_of_their_energies(self):
        folders = [*seeded.EXAMPLES.iterdir(), *seeded.PUBLISHED.iterdir()]
        judged = 0
        for folder in sorted(folders):
            if not (folder / "paper.py").is_file() and not (folder / "paper.tex").is_file():
                continue
            case = load(folder)
            if not case.energies or not case.paper.motions():
                continue
            subject, motion = Subject(case.paper), Motion(case.paper, case.energies[0])
            found, why = construct(subject)
            if found is None:
                self.assertRegex(why, "closed form|Helmholtz|divided by a sum", folder.name)
                continue
            judged += 1
            rates = {"d" + n for n in case.paper.coordinates()}
            # T is determined up to a function of time, V up to a constant; what T has without a rate (a wire that is rotated) belongs to V
            given, still = motion.kinetic.substitute(motion.held), dict.fromkeys(rates, 0)
            kinetic = found.kinetic - (given - given.substitute(still))
            potential = found.potential - (motion.potential.substitute(motion.held) - given.substitute(still))
            self.assertFalse(kinetic.names() & rates, folder.name)
            self.assertFalse(potential.names() & set(case.paper.coordinates()), folder.name)
        self.assertGreaterEqual(judged, 6)

    def test_a_magnetic_force_has_one_that_is_linear_in_the_rates(self):
        subject = Subject(paper_of("xy", "mB", CHARGE))
        found, _ = construct(subject)
        self.assertTrue(found.gyroscopic)
        self.assertEqual(equations_of(found.whole, found.chain, ["x", "y"]), [subject.total("1"), subject.total("2")])
        self.assertFalse(energy_balance(subject, found).rate)

    def test_where_the_conditions_do_not_hold_there_is_none(self):
        wrong = {**OSCILLATOR, "y": lambda s, m: [s.m * s.ddy, s.k * s.y, s.k * s.x]}
        found, why = construct(Subject(paper_of("xy", "mk", wrong)))
        self.assertIsNone(found)
        self.assertIn("Helmholtz", why)
        central = {"x": lambda s, m: [s.m * s.ddx, s.k * s.l**2 / s.x]}
        found, why = construct(Subject(paper_of("x", "mkl", central)))
        self.assertIn("logarithm", why)


class Conserved(unittest.TestCase):
    def quantities(self, paper):
        subject = Subject(paper)
        lagrangian, _ = construct(subject)
        return subject, conserved(subject, lagrangian)

    def test_the_plane_oscillator_has_angular_momentum_and_fradkin_s_tensor(self):
        subject, found = self.quantities(paper_of("xy", "mk", OSCILLATOR))
        self.assertEqual([c.degree for c in found], [1, 2, 2])
        momentum = read(subject, lambda s, m: s.m * (s.x * s.dy - s.y * s.dx))
        self.assertIn(found[0].quantity, (momentum, -momentum))
        mixed = read(subject, lambda s, m: s.m * s.dx * s.dy + s.k * s.x * s.y)
        self.assertIn(mixed, [c.quantity for c in found])

    def test_unequal_springs_leave_the_two_energies_alone(self):
        unequal = {**OSCILLATOR, "y": lambda s, m: [s.m * s.ddy, 9 * s.k * s.y]}
        _, found = self.quantities(paper_of("xy", "mk", unequal))
        self.assertEqual([c.degree for c in found], [2])

    def test_frequencies_of_one_to_two_have_one_more(self):
        twice = {**OSCILLATOR, "y": lambda s, m: [s.m * s.ddy, 4 * s.k * s.y]}
        subject, found = self.quantities(paper_of("xy", "mk", twice))
        known = read(subject, lambda s, m: s.m * s.dx * (s.x * s.dy - s.y * s.dx) + s.k * s.x**2 * s.y)
        self.assertTrue({known, -known} & {c.quantity for c in found}, [str(c.quantity) for c in found])

    def test_spherical_pendulum_charge_and_two_masses(self):
        subject, found = self.quantities(paper_of(["theta", "phi"], "mlg", SPHERICAL))
        self.assertEqual([c.quantity for c in found], [read(subject, lambda s, m: s.l**2 * s.m * m.sin(s.theta)**2 * s.dphi)])
        subject, found = self.quantities(paper_of("xy", "mB", CHARGE))
        self.assertEqual({c.quantity for c in found}, {read(subject, lambda s, m: s.m * s.dy + s.B * s.x), read(subject, lambda s, m: s.B * s.y - s.m * s.dx)})
        pair = {"x": lambda s, m: [s.m * s.ddx, s.k * (s.x - s.y)], "y": lambda s, m: [s.M * s.ddy, s.k * (s.y - s.x)]}
        subject, found = self.quantities(paper_of("xy", "mMk", pair))
        self.assertEqual([c.quantity for c in found], [read(subject, lambda s, m: s.m * s.dx + s.M * s.dy)])

    def test_a_chaotic_pendulum_has_none(self):
        subject = Subject(load(seeded.EXAMPLES / "double_pendulum").paper)
        self.assertEqual(conserved(subject, construct(subject)[0]), [])


class Balances(unittest.TestCase):
    def test_damping_takes_energy_and_a_cyclic_momentum_is_conserved(self):
        damped = {"x": lambda s, m: [s.m * s.ddx, s.k * s.x, s.c * s.dx]}
        subject = Subject(paper_of("x", "mkc", damped, damping="c"))
        lagrangian, _ = construct(subject)
        self.assertEqual(energy_balance(subject, lagrangian).rate, read(subject, lambda s, m: -s.c * s.dx**2))
        subject = Subject(paper_of(["theta", "phi"], "mlg", SPHERICAL))
        momenta = momentum_balances(subject, construct(subject)[0])
        self.assertEqual([(b.name, bool(b.rate)) for b in momenta], [("phi", False)])

    def test_small_motions(self):
        subject = Subject(paper_of(["theta", "phi"], "mlg", SPHERICAL))
        small = small_motion(subject.paper, [subject.total("1"), subject.total("2")], ["theta", "phi"])
        zero = subject.ring.number(0)
        self.assertEqual(small.stiffness, [[read(subject, lambda s, m: s.m * s.g * s.l), zero], [zero, zero]])
        self.assertEqual(small.forces, [zero, zero])
        self.assertEqual(set(special_cases(subject.paper)), {"theta = 0 throughout", "phi = 0 throughout"})


class Impacts(unittest.TestCase):
    def ball(self, law):
        """A ball of mass m with a mass M beside it, coupled in T or not."""
        paper = Paper("Ball", "by hand")
        paper.coordinate("y", "m", "height", minimum=0.0)
        paper.coordinate("x", "m", "aside")
        for name in "mM":
            paper.parameter(name, "kg", name)
        paper.parameter("e", "1", "restitution")
        paper.sets["values"] = {"m": "1", "M": "0.5", "e": "0.9"}
        paper.reset("1", of="y")(lambda s, m: [law(s)])
        return Subject(paper)

    def test_a_rate_that_is_turned_round_and_reduced_loses_energy(self):
        subject = self.ball(lambda s: -s.e * s.dy)
        found = impact(subject, "1", read(subject, lambda s, m: s.m * s.dy**2 / 2 + s.m * s.dx**2 / 2))
        self.assertEqual(found.change, read(subject, lambda s, m: s.m * (s.e**2 - 1) * s.dy**2 / 2))
        self.assertEqual((found.rises, found.impulses, found.penetrates), (None, {}, None))

    def test_one_that_goes_on_leads_through_the_bound(self):
        subject = self.ball(lambda s: s.e * s.dy)
        self.assertEqual(impact(subject, "1", read(subject, lambda s, m: s.m * s.dy**2 / 2)).penetrates, "values")

    def test_a_coupled_rate_that_is_kept_can_gain_energy_and_the_witness_is_one(self):
        subject = self.ball(lambda s: -s.e * s.dy)
        kinetic = read(subject, lambda s, m: (s.m * s.dy**2 + s.m * s.dx**2) / 2 + s.M * s.dx * s.dy)
        found = impact(subject, "1", kinetic)
        self.assertEqual(found.impulses, {"x": read(subject, lambda s, m: -(1 + s.e) * s.M * s.dy)})
        case, rates = found.rises
        v, u, m, big, e = Fraction(str(rates["dy"])), Fraction(str(rates["dx"])), 1, Fraction(1, 2), Fraction(9, 10)
        self.assertLessEqual(v, 0)
        gain = m * (e**2 - 1) * v**2 / 2 - (1 + e) * big * u * v
        self.assertGreater(gain, 0, case)


if __name__ == "__main__":
    unittest.main()
