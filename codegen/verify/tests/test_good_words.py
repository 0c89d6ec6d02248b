"""Every path to a good word (proved, agrees, consistent, 0 objections, 0 findings), with something
wrong on it: the word must not come."""

import json
import re
import unittest
import xml.etree.ElementTree as xml
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import sympy

from codegen.verify import seeded, Paper
from codegen.verify.errors import PaperError
from codegen.verify.input import transcription
from codegen.verify.input.energies import Energies
from codegen.verify.judgements import unjudged
from codegen.verify.judgements.comparison import compare
from codegen.verify.judgements.definite import prove
from codegen.verify.judgements.numbers import Number, check
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import Case, load
from codegen.verify.readings.lagrange import Motion
from codegen.verify.report import gather as report, html, machine, text, words
from codegen.verify.report.effects import quantity
from codegen.verify.report.findings import judge
from codegen.verify.tests.cases import TANK, WITHOUT, report_of

HEAD = "from codegen.verify import Paper\n"


def oscillator(**options):
    """A paper with the symbols of an oscillator with friction, and no equations."""
    paper = Paper("Oscillator", "nowhere", **options)
    paper.coordinate("q", "m", "displacement", mirror=-1)
    paper.coordinate("h", "m", "height")
    paper.input("z", "m", "displacement of the ground", mirror=-1)
    paper.discrete("lam", (1, -1), "side", r"\lambda", mirror=-1)
    for name, unit in (("m", "kg"), ("m_2", "kg"), ("k", "N/m"), ("g", "m/s^2"), ("alpha", "rad"), ("e", "1"), ("nu", "1")):
        paper.parameter(name, unit, name)
    paper.parameter("c", "N*s/m", "damping", dissipative=True)
    paper.force("F", "N", "force", mirror=-1)
    paper.force("N", "N", "normal force", dissipative=False)
    return paper


def case_of(paper, *energies):
    """A case without a folder."""
    return Case("oscillator", Path("."), paper, list(energies))


def energies(**options):
    """The energies of the oscillator."""
    return Energies("oscillator", "mass and spring", lambda s, m: s.m * s.dq**2 / 2, lambda s, m: s.k * s.q**2 / 2, **options)


class ProvedEqualToItsLatex(unittest.TestCase):
    def proved(self, kind, latex, terms, of="q", **options):
        """Whether the words 'proved equal to their LaTeX' are reached."""
        paper = oscillator()
        getattr(paper, kind)("1", of=of, latex=latex, **options)(terms)
        return transcription.proved(Subject(paper)) == ["1"]

    def refused(self, kind, latex, terms, expected="", of="q", **options):
        with self.assertRaisesRegex(PaperError, r"equation \(1\).*" + expected):
            self.proved(kind, latex, terms, of, **options)

    def test_what_is_right_is_proved(self):
        full = lambda s, m: [s.m * s.ddq, s.k * s.q]
        for latex in (r"m \ddot{q} + k q = 0", r"m \ddot{q} = -k q", r"m\ddot q+kq=0", r"m \cdot \ddot{q} + k \cdot q = 0",
                      r"\begin{aligned} & m \ddot{q} \\ & + k q = 0 \end{aligned}"):
            self.assertTrue(self.proved("motion", latex, full), latex)
        self.assertTrue(self.proved("motion", r"\ddot{q} = -\frac{k}{m} q", lambda s, m: [s.ddq, s.k / s.m * s.q]))
        self.assertTrue(self.proved("motion", r"0.5 m \ddot{q} + \frac{1}{2} k q = 0",
                                    lambda s, m: [s.m * s.ddq / 2, s.k * s.q / 2]))
        self.assertTrue(self.proved("motion", r"m \ddot{q} + k \sin^2 \alpha = 0",
                                    lambda s, m: [s.m * s.ddq, s.k * m.sin(s.alpha)**2]))
        self.assertTrue(self.proved("value", r"F = k q - c \dot{q}", lambda s, m: [s.k * s.q, -s.c * s.dq], of="F"))
        self.assertTrue(self.proved("condition", "F < N", lambda s, m: ([s.F], [s.N]), relation="<"))
        self.assertTrue(self.proved("rule", r"\lambda = -1 \quad \text{if} \quad \ddot{q} < 0", lambda s, m: [s.ddq], of="lam",
                                    result=-1, relation="<"))
        self.assertTrue(self.proved("reset", r"\dot{q}(t^+) = -e \dot{q}(t^-)", lambda s, m: [-s.e * s.dq]))

    def test_a_left_side_is_not_dropped(self):
        right = lambda s, m: [-s.k / s.m * s.q]
        for latex in (r"\ddot{q} = -\frac{k}{m} q", r"q = -\frac{k}{m} q", r"m = -\frac{k}{m} q"):
            self.refused("motion", latex, right, "differ from term 1")
        self.refused("motion", r"\ddot{q} = -\frac{k}{m} q", lambda s, m: [s.k / s.m * s.q], "differ")
        self.refused("motion", r"m \ddot{q} + k q = F", lambda s, m: [s.m * s.ddq, s.k * s.q], "differ from term 3")

    def test_signs_and_sides(self):
        full = lambda s, m: [s.m * s.ddq, s.k * s.q]
        for latex in (r"m \ddot{q} = k q", r"m \ddot{q} - k q = 0", r"-m \ddot{q} + k q = 0", r"k q + m \ddot{q} = 0", r"0 = m \ddot{q} + k q"):
            self.refused("motion", latex, full, "differ")

    def test_dots_indices_symbols_factors_functions_and_powers(self):
        full = lambda s, m: [s.m * s.ddq, s.k * s.q * m.sin(s.alpha), 2 * s.g * s.m**2]
        right = r"m \ddot{q} + k q \sin \alpha + 2 g m^2 = 0"
        self.assertTrue(self.proved("motion", right, full))
        for old, new in ((r"\ddot", r"\dot"), (r"\ddot{q}", "q"), (r"k q", r"k \dot{q}"), (r"m \ddot", r"m_2 \ddot"), (r"\sin", r"\cos"),
                         ("2 g", "3 g"), ("2 g", "g"), ("m^2", "m"), ("m^2", "m^3"), ("k q", "g q"), (r"{q}", "{z}"), ("k q", r"\lambda k q"),
                         (r"\sin \alpha", r"\sin(-\alpha)"), ("k q", "|k q|"), ("k q", "k h")):
            self.refused("motion", right.replace(old, new), full, "differ")

    def test_lost_and_doubled_terms(self):
        full = lambda s, m: [s.m * s.ddq, s.k * s.q]
        for latex in (r"m \ddot{q} = 0", r"m \ddot{q} + k q + k q = 0", r"m \ddot{q} + k q + 0 q^0 = 0", r"m \ddot{q} + k q + q^0 = 0",
                      r"m \ddot{q} + 2 k q - k q = 0"):
            self.refused("motion", latex, full, "differ")
        # what is equal as a sum is not what is printed
        self.refused("motion", r"m \ddot{q} + k q = 0", lambda s, m: [s.m * s.ddq + s.k * s.q], "differ")

    def test_the_whole_statement_is_compared(self):
        full = lambda s, m: [s.m * s.ddq, s.k * s.q]
        for latex in (r"m \ddot{q} + k q", r"m \ddot{q} + k q > 0", r"m \ddot{q} + k q = 0 = 0", r"m \ddot{q} + k q = 0 < F",
                      r"m \ddot{q} \text{and} k q = 0"):
            self.refused("motion", latex, full, "is written as")
        spring = lambda s, m: [s.k * s.q]
        for latex in (r"N = k q", r"\dot{F} = k q", r"-F = k q", r"2 F = k q", r"F^2 = k q", r"F + F = k q", r"|F| = k q", r"k q = F"):
            self.refused("value", latex, spring, "left side", of="F")
        self.refused("value", "F < k q", spring, "is written as", of="F")

    def test_conditions(self):
        sides = lambda s, m: ([s.F], [s.N])
        for latex in ("F > N", "F = N", "F < N < 0"):
            self.refused("condition", latex, sides, "is written as", relation="<")
        self.refused("condition", "N < F", sides, "differ", relation="<")
        self.refused("condition", "F < -N", sides, "differ", relation="<")

    def test_rules(self):
        right = r"\lambda = 1 \text{if} \ddot{q} > 0"
        self.assertTrue(self.proved("rule", right, lambda s, m: [s.ddq], of="lam", result=1, relation=">"))
        for old, new in (("= 1", "= -1"), (r"\lambda", "e"), ("> 0", "< 0"), ("> 0", "> g"), ("if", "unless"), ("= 1", "= e"), ("> 0", "> 1")):
            self.refused("rule", right.replace(old, new), lambda s, m: [s.ddq], of="lam", result=1, relation=">")

    def test_impact_laws(self):
        law = lambda s, m: [-s.e * s.dq]
        for latex in (r"\dot{q}(t^-) = -e \dot{q}(t^+)", r"\dot{q}(t^+) = -e \dot{q}(t^+)", r"\dot{q} = -e \dot{q}", r"\dot{q}(t^+) = -e \dot{q}",
                      r"\dot{h}(t^+) = -e \dot{q}(t^-)", r"\ddot{q}(t^+) = -e \dot{q}(t^-)", r"q(t^+) = -e \dot{q}(t^-)"):
            self.refused("reset", latex, law)
        self.refused("reset", r"\dot{q}(t^+) = e \dot{q}(t^-)", law, "differ")
        self.refused("motion", r"m \ddot{q}(t^-) + k q = 0", lambda s, m: [s.m * s.ddq, s.k * s.q], "instants")

    def test_commands_that_begin_like_others(self):
        for latex, term in ((r"\sinh \alpha = 0", lambda s, m: [m.sin(s.h) * s.alpha]), (r"\cosh \alpha = 0", lambda s, m: [m.cos(s.h) * s.alpha]),
                            (r"\fracm{k} q = 0", lambda s, m: [s.k * s.q])):
            self.refused("motion", latex, term)

    def test_what_can_be_read_in_two_ways_is_refused(self):
        for latex in (r"\sin(\alpha)^2 = 0", r"\sin \alpha^2 = 0", r"\sin^{-1} \alpha = 0", r"q^12 = 0", r"m_12 = 0", r"1 000 q = 0",
                      r"k q \\ k q = 0", r"0 \\ k q = 0", r"(k q] = 0", r"q^{\prime} = 0", r"q^{n} = 0", r"q^{1.5} = 0",
                      r"\begin{cases} k q = 0 \end{cases}", r"\operatorname{sign}(q)^2 = 0"):
            self.refused("motion", latex, lambda s, m: [s.k * s.q])

    def test_dots_on_what_does_not_move(self):
        self.refused("motion", r"\dot{k} q = 0", lambda s, m: [s.k * s.q], "dots")
        self.refused("motion", r"\dddot{q} = 0", lambda s, m: [s.ddq], "dots")

    def test_symbols_that_could_be_taken_for_one_another_are_refused(self):
        for declare, expected in (
                (lambda p: p.parameter("dq", "m", "width"), "told apart"), (lambda p: p.coordinate("dq", "m", "width"), "told apart"),
                (lambda p: p.parameter("mass", "kg", "mass", "m"), "same LaTeX"), (lambda p: p.parameter("m2", "kg", "mass", "m_{2}"), "same LaTeX"),
                (lambda p: p.parameter("a*b", "kg", "mass"), "letters"), (lambda p: p.parameter("_m", "kg", "mass"), "letters"),
                (lambda p: p.coordinate("r", "m", "r", mirror=0), "mirror")):
            with self.assertRaisesRegex(PaperError, expected):
                declare(oscillator())

    def test_an_undefined_symbol_is_not_its_reading(self):
        paper = oscillator()
        paper.undefined("M", "kg", "printed; read as m")(lambda s, m: s.m)
        paper.motion("1", of="q", latex=r"M \ddot{q} + k q = 0")(lambda s, m: [s.m * s.ddq, s.k * s.q])
        with self.assertRaisesRegex(PaperError, "differ from term 1"):
            transcription.proved(Subject(paper))

    def test_what_has_no_latex_is_said(self):
        paper = oscillator()
        paper.motion("1", of="q")(lambda s, m: [s.m * s.ddq, s.k * s.q])
        lines = words.transcription_lines(report.verify(case_of(paper)))
        self.assertEqual(len(lines), 1)
        self.assertIn("(1) have no LaTeX", lines[0])


class Input(unittest.TestCase):
    def test_equations_that_are_none_are_refused(self):
        for terms, expected in ((lambda s, m: [], "no terms"), (lambda s, m: ["m*ddq"], "not an expression"), (lambda s, m: [0.5 * s.q], "exact"),
                                (lambda s, m: [1.5], "not an expression"), (lambda s, m: [[s.q]], r"\*group"), (lambda s, m: [True], "not an expression"),
                                (lambda s, m: [sympy.Symbol("w")], "'w' is not declared"), (lambda s, m: [s.q / (s.m - s.m)], "equation"),
                                (lambda s, m: s.q, "equation"), (lambda s, m: [sympy.oo * s.q], "equation"), (lambda s, m: [m.sin(s.q**2)], "combination of angles")):
            paper = oscillator()
            paper.motion("1", of="q")(terms)
            with self.assertRaisesRegex(Exception, expected) as context:
                Subject(paper)
            self.assertIn(type(context.exception).__name__, ("PaperError", "NotInClass"))

    def test_declarations_that_do_not_fit_are_refused(self):
        spring = lambda s, m: [s.k * s.q]
        for declare, expected in (
                (lambda p: None, "no equations"), (lambda p: p.motion("1", of="k")(spring), "coordinate"), (lambda p: p.value("1", of="q")(spring), "force"),
                (lambda p: p.rule("1", of="lam", result=2, relation=">")(spring), "none of its values"),
                (lambda p: p.condition("1", of="q", relation="=")(lambda s, m: ([s.q], [])), "relation"),
                (lambda p: [p.motion(n, of="q")(spring) for n in "12"], "2 equations of motion"),
                (lambda p: (p.motion("1", of="q")(spring), p.sets.update(a={"kk": "1"})), "'kk'"),
                (lambda p: (p.motion("1", of="q")(spring), p.box.update(qq=(0.0, 1.0))), "'qq'"),
                (lambda p: (p.motion("1", of="q")(spring), p.box.update(q=(1.0, 0.0))), "lower one first"),
                (lambda p: (p.motion("1", of="q")(spring), p.special.update(a={"kk": 0})), "'kk'")):
            paper = oscillator()
            declare(paper)
            with self.assertRaisesRegex(PaperError, expected):
                Subject(paper)

    def test_energies_that_lagrange_would_not_be_right_for_are_refused(self):
        paper = oscillator()
        paper.motion("1", of="q")(lambda s, m: [s.m * s.ddq, s.k * s.q])
        for kinetic, potential, options in ((lambda s, m: s.m * s.ddq**2, lambda s, m: 0, {}), (lambda s, m: s.m * s.dq**2, lambda s, m: s.c * s.dq, {}),
                                            (lambda s, m: s.m * s.dq**2, lambda s, m: 0, {"forces": {"w": lambda s, m: s.F}}),
                                            (lambda s, m: s.m * s.dq**2, lambda s, m: 0, {"references": {"7": lambda s, m, motion: s.F}})):
            with self.assertRaises(PaperError):
                Motion(paper, Energies("wrong", "", kinetic, potential, **options))


class Agrees(unittest.TestCase):
    def verdict(self, terms, kind="motion", of="q", reference=None, scale=None, sets=True, **options):
        """(agreeing, differing, absent) of one equation, and its findings."""
        paper = oscillator(sets={"a": {"m": "1", "m_2": "2", "k": "3", "g": "9.8", "alpha": "0.5", "e": "0.5", "nu": "0.3", "c": "1"}} if sets else {})
        getattr(paper, kind)("1", of=of, **options)(terms)
        given = energies()
        if reference:
            given.reference("1", scale)(reference)
        result = report.verify(case_of(paper, given))
        comparison = result.comparisons["oscillator"].get("1")
        return comparison and (len(comparison.agree), len(comparison.differ), len(comparison.absent)), result

    def test_what_is_wrong_in_one_place_differs(self):
        self.assertEqual(self.verdict(lambda s, m: [s.m * s.ddq, s.k * s.q])[0], (2, 0, 0))
        self.assertEqual(self.verdict(lambda s, m: [-s.m * s.ddq, -s.k * s.q])[0], (2, 0, 0))
        for terms in (lambda s, m: [s.m * s.ddq, -s.k * s.q], lambda s, m: [s.m * s.ddq, 2 * s.k * s.q], lambda s, m: [s.m * s.ddq, s.k * s.h],
                      lambda s, m: [s.m_2 * s.ddq, s.k * s.q], lambda s, m: [s.m * s.ddz, s.k * s.q], lambda s, m: [s.m * s.ddq, s.k * m.sin(s.q)],
                      lambda s, m: [s.m * s.ddq, s.k * s.q, s.k * s.q], lambda s, m: [s.m * s.ddq, m.Abs(s.k * s.q)],
                      lambda s, m: [s.m * s.ddq, s.lam * s.k * s.q], lambda s, m: [s.m * s.ddq, s.k * s.q, s.c * s.dq],
                      lambda s, m: [s.m * s.ddq, s.k * s.q * sympy.Rational(10**15 + 1, 10**15)]):
            counts, result = self.verdict(terms)
            self.assertGreater(counts[1], 0)
            self.assertTrue(result.findings)
        counts, result = self.verdict(lambda s, m: [s.m * s.ddq])
        self.assertEqual(counts, (1, 0, 1))
        self.assertEqual([f.slip for f in result.findings], ["lost term"])

    def test_terms_that_cancel_one_another_agree_with_nothing(self):
        counts, result = self.verdict(lambda s, m: [s.m * s.ddq, s.k * s.z, s.k * s.q, -s.k * s.z, 0 * s.q])
        self.assertEqual((counts, result.findings), ((2, 0, 0), []))
        self.assertIn("2 of 5 printed terms agree, 3 cancel one another or vanish", text.as_text(result))

    def test_a_rule_turned_round_does_not_agree(self):
        reference = lambda s, m, motion: s.ddq
        self.assertEqual(self.verdict(lambda s, m: [s.ddq], "rule", "lam", reference, result=1, relation=">")[0], (1, 0, 0))
        self.assertEqual(self.verdict(lambda s, m: [s.ddq], "rule", "lam", reference, result=-1, relation="<")[0], (1, 0, 0))
        for result, relation in ((1, "<"), (-1, ">")):
            counts, found = self.verdict(lambda s, m: [s.ddq], "rule", "lam", reference, result=result, relation=relation)
            self.assertEqual(counts[0], 0)
            self.assertTrue(found.findings)

    def test_a_factor_of_a_rule_must_be_shown_to_be_positive(self):
        reference = lambda s, m, motion: -s.m * s.ddq
        for scale, sets in ((lambda s, m: -s.m, True), (lambda s, m: s.m - s.m_2, True), (lambda s, m: s.m, False)):
            with self.assertRaisesRegex(PaperError, "positive"):
                self.verdict(lambda s, m: [s.ddq], "rule", "lam", reference, scale, sets, result=1, relation=">")

    def test_a_modulus_is_not_a_signed_value(self):
        for terms in (lambda s, m: ([m.Abs(s.F)], [s.nu * s.N]), lambda s, m: ([s.lam * s.F], [s.nu * s.N])):
            for reference in (lambda s, m, motion: m.Abs(s.F) - s.nu * s.N, lambda s, m, motion: s.lam * s.F - s.nu * s.N):
                counts = self.verdict(terms, "condition", reference=reference, relation=">")[0]
                same = ("Abs" in str(terms(Namespace, sympy))) == ("Abs" in str(reference(Namespace, sympy, None)))
                self.assertEqual(counts == (2, 0, 0), same)

    def test_an_impact_law_has_no_free_sign(self):
        counts, result = self.verdict(lambda s, m: [s.e * s.dq], "reset", reference=lambda s, m, motion: -s.e * s.dq)
        self.assertEqual(counts, (0, 1, 0))
        self.assertEqual([f.slip for f in result.findings], ["sign"])

    def test_what_the_energies_do_not_say_is_not_agreed_to(self):
        counts, result = self.verdict(lambda s, m: [s.k * s.q], "value", "F")
        self.assertIsNone(counts)
        self.assertIn("not judged", words.headline(result))
        for page in (text.as_text(result), html.as_html(result)):
            self.assertIn("not judged", page)
        self.assertEqual(json.loads(machine.as_json(result))["unreferenced_equations"], ["1"])


class Namespace:
    """Symbols for the comparison above."""

    F, N, nu, lam = sympy.symbols("F N nu lam", real=True)


class NoObjections(unittest.TestCase):
    def objections(self, *equations, **options):
        """The names of the judgements that object, and of those that were not made."""
        paper = oscillator(**options)
        for k, (kind, of, terms, more) in enumerate(equations, 1):
            getattr(paper, kind)(str(k), of=of, **more)(terms)
        subject = Subject(paper)
        return {name for name, found in judge(subject, None).items() if found}, set(unjudged(subject, None))

    def test_what_has_no_lagrangian_is_objected_to(self):
        for terms in (lambda s, m: [s.m * s.ddq, s.k * s.q, s.nu * s.m * s.g * m.sign(s.dq)], lambda s, m: [s.m * m.Abs(s.ddq), s.k * s.q],
                      lambda s, m: [s.m * s.ddq, s.nu * s.N], lambda s, m: [s.m * s.ddq, s.k * s.q, s.m * m.Abs(s.dq) * s.g],
                      lambda s, m: [s.m * s.ddq * m.sign(s.ddq), s.k * s.q], lambda s, m: [s.m * s.ddq, s.nu * s.m * s.dq]):
            self.assertIn("lagrangian", self.objections(("motion", "q", terms, {}))[0])
        for terms in (lambda s, m: [s.m * s.ddq, s.k * s.q, s.F, s.c * s.dq], lambda s, m: [s.m * s.ddq, s.k * m.Abs(s.q)]):
            self.assertNotIn("lagrangian", self.objections(("motion", "q", terms, {}))[0])

    def test_terms_that_are_wrong_alike_are_all_wrong(self):
        wrong = lambda s, m: [s.m + s.g, s.m + s.g]
        self.assertIn("dimensions", self.objections(("rule", "lam", wrong, {"result": 1, "relation": ">"}))[0])
        self.assertIn("dimensions", self.objections(("condition", "q", lambda s, m: ([m.sin(s.q)], [m.sin(s.q)]), {"relation": ">"}))[0])

    def test_a_motion_of_the_ground_inside_a_sign_is_seen(self):
        for terms in (lambda s, m: [s.nu * s.N * m.sign(s.dz)], lambda s, m: [s.k * m.Abs(s.z)], lambda s, m: [s.N * m.sign(s.q)]):
            self.assertIn("galilei", self.objections(("value", "N", terms, {}), translation=("q", "z"))[0])
        self.assertNotIn("galilei", self.objections(("value", "F", lambda s, m: [s.nu * s.N * m.sign(s.dq)], {}), translation=("q", "z"))[0])

    def test_a_judgement_without_means_is_not_passed(self):
        spring = ("motion", "q", lambda s, m: [s.m * s.ddq, s.k * s.q], {})
        self.assertEqual(self.objections(spring)[1], {"difference", "galilei", "definite"})
        self.assertEqual(self.objections(("value", "F", lambda s, m: [s.k * s.q], {}))[1], {"lagrangian", "difference", "galilei", "definite"})
        paper = Paper("Plain", "nowhere")
        paper.coordinate("q", "m", "displacement")
        paper.motion("1", of="q")(lambda s, m: [s.ddq])
        result = report.verify(case_of(paper))
        self.assertIn("mirror", result.unjudged)
        for name in result.unjudged:
            self.assertIn("not judged", words.judgement_text(result, name))
            self.assertNotIn("0 objections", words.judgement_text(result, name))
            self.assertFalse(json.loads(machine.as_json(result))["judgements"][name]["judged"])

    def test_a_coordinate_without_equation_is_said(self):
        paper = oscillator()
        paper.motion("1", of="q")(lambda s, m: [s.m * s.ddq, s.k * s.q, s.k * s.h])
        self.assertIn("motion of h, which has no equation", words.judgement_text(report.verify(case_of(paper)), "lagrangian"))


class Positive(unittest.TestCase):
    def test_definite_is_proved_only_where_it_is(self):
        subject = Subject(load(seeded.EXAMPLES / "double_pendulum").paper)
        read, q = subject.ring.read, subject.s.theta_1
        box = {"theta_1": (-1.0, 1.0)}
        self.assertEqual(prove([read(sympy.Abs(q) + 1)], {}, box).status, "undecided")
        self.assertEqual(prove([read(1 - q**2)], {}, box, limit=200).status, "undecided")
        self.assertEqual(prove([read(Fraction(999999, 1000000) - q**2)], {}, {"theta_1": (1.0, 1.0)}).status, "refuted")
        self.assertNotEqual(prove([read(1 / q)], {}, box, limit=50).status, "proved")
        with self.assertRaisesRegex(PaperError, "no value for m_1"):
            prove([read(subject.s.m_1 * q)], {}, box)

    def test_a_sum_that_is_not_the_energy_is_not_called_so(self):
        paper = oscillator()
        paper.motion("1", of="q")(lambda s, m: [s.m * s.ddq, s.k * s.q])
        for squares, good in ((lambda s, m: [(s.m, s.dq)], True), (lambda s, m: [(2 * s.m, s.dq)], False), (lambda s, m: [(s.m, s.dz)], False)):
            result = report.verify(case_of(paper, energies(squares=squares)))
            line = next(line for line in text.as_text(result).splitlines() if "sum of squares" in line)
            self.assertEqual(("NOT" not in line, "proved" in line), (good, good))


class Numbers(unittest.TestCase):
    def test_a_number_agrees_only_with_what_is_bounded(self):
        one = Number("a", "1.0", "1", "a")
        zero = Number("b", "0.0", "1", "may be zero")
        for printed, formula, agrees in (("2.0", lambda n, m: 2 * n.a, True), ("2.3", lambda n, m: 2 * n.a, False), ("2.0", lambda n, m: n.a / n.b, None), ("2.0", lambda n, m: n.a / 0, None),
                                         ("2.0", lambda n, m: m.tan(n.a * m.pi / 2), None)):
            checked = check([one, zero, Number("c", printed, "1", "c", formula)])[-1]
            self.assertIs(checked.agrees, agrees, printed)
            self.assertEqual(": agrees" in "".join(map(str, words.number_parts(checked))), agrees is True)
        for formula in (lambda n, m: m.asin(2 * n.a), lambda n, m: n.later):
            with self.assertRaisesRegex(PaperError, "number 'c'"):
                check([one, Number("c", "1.0", "1", "c", formula)])

    def test_a_quantity_that_is_not_there_is_not_zero(self):
        summary = {"events": {"by_transition": {"slip": 2}}, "peaks": {"q": {"max": 1.5}}}
        self.assertEqual(quantity(summary, ("events", "by_transition", "slip")), 2)
        self.assertEqual(quantity(summary, ("events", "by_transition", "landing")), 0)
        for path in (("peaks", "x", "max"), ("peaks", "q", "mx"), ("event", "by_transition", "slip")):
            with self.assertRaises(PaperError):
                quantity(summary, path)


class Findings(unittest.TestCase):
    def test_an_objection_is_a_finding_with_and_without_energies(self):
        for name in ("double_pendulum", "rocking_block"):
            case = load(seeded.EXAMPLES / name, name)
            subject = Subject(case.paper)
            for seed in list(seeded.seeds(name, case.paper, subject))[::3]:
                equation = case.paper.equations[seed.equation]
                paper = case.paper.with_equations([replace(equation, function=seed.terms, latex="")])
                mutated = Subject(paper, subject)
                objections = sum(map(len, judge(mutated, None).values()))
                result = report.verify(replace(case, paper=paper, energies=[]), thorough=False) if seed.terms(None, None) else None
                if result:
                    self.assertEqual(len(result.findings), objections, seed)
                    self.assertIn("not judged", words.headline(result))

    def test_no_repair_is_called_consistent_unless_it_is(self):
        # two slips at once, in every pair of terms of the pendulum's first equation
        case = load(seeded.EXAMPLES / "double_pendulum", "double_pendulum")
        subject, motion = Subject(case.paper), Motion(case.paper, case.energies[0])
        terms = subject.expressions["1"]
        for i in range(len(terms)):
            for j in range(i + 1, len(terms)):
                wrong = [3 * term * (subject.s.l_2 if k == j else 1) if k in (i, j) else term for k, term in enumerate(terms)]
                paper = case.paper.with_equations([replace(case.paper.equations["1"], function=lambda s, m, w=wrong: w, latex="")])
                result = report.verify(replace(case, paper=paper), thorough=False)
                self.assertTrue(result.findings)
                self.assertTrue(all(f.proved for f in result.findings))
                self.assertFalse(compare(result.corrected, motion, "1").difference)
                self.assertEqual({n for n, v in result.corrected_violations.items() if v}, set())

    def test_corrections_that_do_not_correct_are_said_to_be_none(self):
        from codegen.verify import Correction
        paper = oscillator()
        paper.motion("1", of="q")(lambda s, m: [s.m * s.ddq, 2 * s.k * s.q])
        wrong = Correction("factor", "1", "misprint", "three", {2: lambda s, m, on: 3 * s.k * s.q})
        useless = Correction("nothing", "1", "misprint", "the same", {1: lambda s, m, on: s.m * s.ddq})
        result = report.verify(replace(case_of(paper, energies()), corrections=[wrong, useless]))
        factor, nothing, *objections = result.findings
        self.assertEqual((factor.proved, nothing.proved, nothing.judgements), (False, False, []))
        self.assertEqual([f.kind for f in objections], ["objection"])
        for page in (text.as_text(result), html.as_html(result)):
            self.assertIn("proposed, not proved consistent", page)
            self.assertIn("no judgement: nothing here shows", page)

    def test_text_page_and_json_say_the_same(self):
        for folder in (seeded.EXAMPLES / "rocking_block", TANK):
            for without in WITHOUT:
                result = report_of(folder, without)
                terminal, page, data = text.as_text(result), html.as_html(result), json.loads(machine.as_json(result))
                plain = "".join(xml.fromstring(page.replace("<!DOCTYPE html>", "").replace('<meta charset="utf-8">', "")).itertext())
                for line in (words.headline(result), *words.transcription_lines(result), *(words.judgement_text(result, n) for n in data["judgements"])):
                    self.assertIn(line, terminal)
                    self.assertIn(line, plain)
                self.assertEqual([f["id"] for f in data["findings"]], [f.key for f in result.findings])
                self.assertTrue(words.headline(result).startswith(f"{len(data['findings'])} finding"))
                for finding, written in zip(result.findings, data["findings"]):
                    self.assertIn(f"[{finding.key}]", terminal)
                    self.assertIn(f"{finding.key}: equation", plain)
                    self.assertEqual(written["consistent"] is None, words.consistent_parts(finding) == ["not known"])
                    self.assertEqual(written["proved"], finding.proved)

    def test_the_guide_lists_attacks_that_exist(self):
        tests = Path(__file__).resolve().parent
        guide = (tests.parents[2] / "docs" / "verification.md").read_text(encoding="utf-8")
        listed = guide.split("## What was tried against the good words")[1].split("\n## ")[0]
        written = {(name, file.name) for file in tests.glob("test_*.py") for name in re.findall(r"def (test_\w+)", file.read_text(encoding="utf-8"))}
        named = re.findall(r"`(test_\w+)`(?: in `(test_\w+\.py)`)?", listed)
        self.assertGreater(len(named), 30)
        for name, file in named:
            self.assertIn((name, file or Path(__file__).name), written)


if __name__ == "__main__":
    unittest.main()
