"""A folder with a paper's LaTeX and a table of its symbols is judged as it is; what is wrong in it is said
with file, line and column."""

import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from codegen.verify import cli
from codegen.verify.errors import LatexError, PaperError
from codegen.verify.load import load
from codegen.verify.report import gather as report, text, words

TEMPLATE = Path(__file__).resolve().parents[3] / "templates" / "paper"


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("paper.tex", "symbols.csv"):
            shutil.copy(TEMPLATE / name, self.folder)

    def change(self, *pairs, file="paper.tex"):
        path = self.folder / file
        content = path.read_text(encoding="utf-8")
        for old, new in pairs:
            self.assertIn(old, content)
            content = content.replace(old, new, 1)
        path.write_text(content, encoding="utf-8")

    def judged(self):
        return report.verify(load(self.folder, "cart"), thorough=False)

    def refused(self, error, expected):
        with self.assertRaisesRegex(error, expected):
            self.judged()


class Judged(Folder):
    def test_the_template_is_judged_right(self):
        result = self.judged()
        self.assertEqual((result.findings, list(result.unjudged)), ([], ["galilei"]))
        self.assertEqual([(n, e.of) for n, e in result.case.paper.equations.items()], [("5", "x"), ("6", "theta")])
        self.assertIn("(5), (6) are judged from their LaTeX", text.as_text(result))

    def test_a_display_of_several_equations(self):
        path = self.folder / "paper.tex"
        head = path.read_text(encoding="utf-8").split(r"\begin{equation}")[0]
        path.write_text(head + r"""\begin{align}
T &= \tfrac12 M \dot{x}^2 + \tfrac12 m (\dot{x}^2 + 2 l \cos\theta \, \dot{x} \dot{\theta} \nonumber \\
  &\quad + l^2 \dot{\theta}^2 ), \\[1ex]
V &= - m g l \cos\theta, \qquad \\
D &= \tfrac12 c \dot{x}^2, \notag \\ Q_x &= F.
\end{align}
\begin{gather}
% motion of x
(M + m) \ddot{x} + m l \cos\theta \, \ddot{\theta} - m l \sin\theta \, \dot{\theta}^2 + c \dot{x} = F, \\
% motion of \theta
m l^2 \ddot{\theta} + m l \cos\theta \, \ddot{x} \nonumber
\\ + m g l \sin\theta = 0 \tag{A.1}
\end{gather}
""", encoding="utf-8")
        result = self.judged()
        self.assertEqual(result.findings, [])
        self.assertEqual([(n, e.of) for n, e in result.case.paper.equations.items()], [("4", "x"), ("A.1", "theta")])
        # each is judged by itself
        self.change((r"m g l \sin\theta = 0 \tag", r"m g \sin\theta = 0 \tag"))
        self.assertEqual([(f.equation, f.slip, f.proved) for f in self.judged().findings], [("A.1", "factor lost", True)])

    def test_a_sign_inside_a_sine_as_rocking_blocks_are_printed(self):
        block = r"""\[ T = \frac12 I_0 \dot\theta^2 \] \[ V = m g R \cos(\alpha \operatorname{sgn}\theta - \theta) \]
\[ Q_\theta = - m R \ddot u_g \cos(\alpha \operatorname{sgn}\theta - \theta) \]
\[ I_0 \ddot\theta + m g R \sin(\alpha \operatorname{sgn}(\theta) - \theta) = - m R \ddot u_g \cos[\alpha \operatorname{sgn}\theta - \theta] \]
"""
        (self.folder / "paper.tex").write_text(block, encoding="utf-8")
        (self.folder / "symbols.csv").write_text("symbol, kind, unit, meaning, mirror\n\\theta, coordinate, rad, angle, -1\nu_g, input, m, ground, -1\n"
                                                 "I_0, parameter, kg*m^2, inertia,\nm, parameter, kg, mass,\ng, parameter, m/s^2, gravity,\n"
                                                 "R, parameter, m, half diagonal,\n\\alpha, parameter, rad, slenderness,\n", encoding="utf-8")
        result = self.judged()
        self.assertEqual((result.findings, [n for n in result.unjudged if n != "galilei"]), ([], ["definite"]))
        self.change((r"\sin(\alpha \operatorname{sgn}(\theta) - \theta)", r"\sin(\alpha \operatorname{sgn}(\theta) + \theta)"))
        self.assertEqual([(f.slip, f.proved) for f in self.judged().findings], [("sign", True)])

    def test_a_slip_in_it_is_found_and_named(self):
        for old, new, slip in ((r"- m l \sin\theta \, \dot", r"+ m l \sin\theta \, \dot", "sign"), (r"m l \cos\theta \, \ddot{x}", r"m l \sin\theta \, \ddot{x}",
                               "function"), ("+ c \\dot{x} = F", "+ 2 c \\dot{x} = F", "number"), ("+ c \\dot{x} = F", "+ c \\ddot{x} = F", "dot"),
                               (r" + m g l \sin\theta = 0", " = 0", "lost term"), ("= F,\n\\end", "= 0,\n\\end", "lost term")):
            shutil.copy(TEMPLATE / "paper.tex", self.folder)
            self.change((old, new))
            self.assertEqual([(f.slip, f.proved) for f in self.judged().findings], [(slip, True)], new)

    def test_a_lagrangian_does_for_energies(self):
        self.change(("T = ", "L = m g l \\cos\\theta + "), ("V =", "% skip\nV ="))
        self.assertEqual(self.judged().findings, [])

    def test_without_energies_the_equations_are_judged_by_themselves(self):
        self.change(("T =", "% skip\nT ="), ("V =", "% skip\nV ="), ("D =", "% skip\nD ="), ("Q_x =", "% skip\nQ_x ="))
        self.change(("F,         force", "F,         friction"), file="symbols.csv")
        result = self.judged()
        self.assertEqual((result.findings, result.motions), ([], []))
        self.assertIn("difference", result.unjudged)

    def test_time_derivatives_of_brackets(self):
        self.change((r"m l^2 \ddot{\theta} + m l \cos\theta \, \ddot{x}", r"\frac{d}{dt}\left( m l^2 \dot\theta + m l \cos\theta \, \dot x \right) + m l \sin\theta \, \dot x \dot\theta"))
        self.assertEqual(self.judged().findings, [])
        self.change((r"m l \cos\theta \, \dot x \right)", r"m l \sin\theta \, \dot x \right)"))
        self.assertEqual([(f.slip, f.proved) for f in self.judged().findings], [("function", True)])

    def test_a_square_is_defined_and_an_undefined_symbol_is_a_finding(self):
        self.change((r"m g l \sin\theta = 0", r"m l^2 \omega^2 \sin\theta = 0"), ("= F,\n\\end", "= G,\n\\end"))
        path = self.folder / "paper.tex"
        path.write_text(path.read_text(encoding="utf-8") + "\\[ \\omega^2 = g/l \\]\n% reading of G\n\\[ G = F \\]\n", encoding="utf-8")
        table = self.folder / "symbols.csv"
        table.write_text(table.read_text(encoding="utf-8") + "\\omega, defined, 1/s, frequency, ,\nG, undefined, N, not defined, ,\n", encoding="utf-8")
        self.assertEqual([(f.key, f.equation) for f in self.judged().findings], [("undefined-G", "5")])
        self.change(("undefined, N", "defined, N"), file="symbols.csv")
        self.refused(LatexError, "a reading is of a symbol of kind undefined, and G is a defined")

    def test_the_macros_of_a_manuscript(self):
        self.change(("\\begin{document}", "\\newcommand{\\th}{\\theta}\n\\newcommand{\\half}{\\tfrac{1}{2}}\n\\newcommand{\\rate}[1]{\\dot{#1}}\n"
                     "\\def\\sq#1{#1^2}\n\\DeclareMathOperator{\\Cos}{cos}\n\\begin{document}"),
                    (r"T = \frac{1}{2} M \dot{x}^2", r"T = \half M \sq{\rate x}"), (r"\cos\theta,", r"\Cos\th,"), (r"% motion of \theta", r"% motion of \th"))
        self.change((r"\theta,", r"\th,"), file="symbols.csv")
        self.assertEqual(self.judged().findings, [])
        self.change((r"{\dot{#1}}", r"{\vec{#1}}"))
        self.refused(LatexError, r"line 15, column 13: the macro .sq: .vec: a vector cannot be judged")
        self.change((r"{\vec{#1}}", r"{\rate{#1}}"))
        self.refused(LatexError, "the macro .sq: a macro contains itself")

    def test_equations_side_by_side_and_aligned_inside_a_display(self):
        path = self.folder / "paper.tex"
        head = path.read_text(encoding="utf-8").split(r"\begin{equation}")[0]
        path.write_text(head + r"""$$ T = \tfrac12 M \dot{x}^2 + \tfrac12 m (\dot{x}^2 + 2 l \cos\theta \, \dot{x} \dot{\theta} + l^2 \dot{\theta}^2 ) \qquad
V = - m g l \cos\theta, \quad D \equiv \tfrac12 c \dot{x}^2, \quad \boxed{Q_x := F} $$
\begin{equation}
\begin{aligned}
% motion of x
(M + m) \ddot{x} + m l \cos\theta \, \ddot{\theta} - m l \sin\theta \, \dot{\theta}^2 + c \dot{x} &= F, \\
% motion of \theta
m l^2 \ddot{\theta} + m l \cos\theta \, \ddot{x} &+ m g l \sin\theta \\ &= 0
\end{aligned}
\end{equation}
""", encoding="utf-8")
        result = self.judged()
        self.assertEqual(result.findings, [])
        self.assertEqual([(n, e.of) for n, e in result.case.paper.equations.items()], [("1.1", "x"), ("1.2", "theta")])

    def test_an_energy_of_another_dimension_is_found_and_not_compared_with(self):
        self.change(("V = - m g l \\cos", "V = - m g \\cos"))
        result = self.judged()
        self.assertEqual([(f.key, f.equation, f.judgements) for f in result.findings], [("energy-1", "text", ["dimensions"])])
        self.assertEqual(result.unjudged["difference"], "the energies have terms of another dimension")
        # what it must be follows from the equations
        found = result.constructed[0].lagrangian.potential
        s = result.printed.s
        self.assertFalse(found + result.printed.ring.read(s.m * s.g * s.l * result.printed.m.cos(s.theta)))
        self.change(("V = - m g \\cos", "V = - m g l \\cos"), ("Q_x = F", "Q_x = F l"))
        self.assertEqual([f.key for f in self.judged().findings], ["energy-1"])

    def test_rates_of_what_is_defined(self):
        self.change((r"\left( \dot{x}^2 + 2 l \cos\theta \, \dot{x} \dot{\theta} + l^2 \dot{\theta}^2 \right)", r"\left( \dot x_p^2 + \dot{y}_p^2 \right)"))
        positions = r"\begin{align*} x_p &= x + l \sin\theta, & \\ y_p &= - l \cos\theta \end{align*}"
        rates = r"\[ \dot x_p = \dot x + l \cos\theta \dot\theta \] \[ \dot y_p = l \sin\theta \dot\theta \]"
        tex, table = ((self.folder / name).read_text(encoding="utf-8") for name in ("paper.tex", "symbols.csv"))
        for defined, rows in ((positions, "x_p, defined, m, mass, ,\ny_p, defined, m, mass, ,\n"),
                              (rates, "\\dot{x}_p, defined, m/s, mass, ,\n\\dot{y}_p, defined, m/s, mass, ,\n")):
            (self.folder / "paper.tex").write_text(tex.replace("and the force", defined + " and the force"), encoding="utf-8")
            (self.folder / "symbols.csv").write_text(table + rows, encoding="utf-8")
            self.assertEqual(self.judged().findings, [])

    HOOP = r"""\[ T = \frac{1}{2}M\dot{x}^2 + \frac{1}{2}Mr^2 \dot{\theta}^2 \] \[ V = Mg (l - x)\sin \phi \]
% constraint with \lambda
\[ CONSTRAINT \]
% motion of x
\[ M \ddot{x} - Mg\sin \phi + \lambda = 0 \]
% motion of \theta
\[ Mr^2\ddot{\theta} - \lambda r = 0 \]
"""

    def test_constraints_on_coordinates_on_rates_and_on_accelerations(self):
        # a hoop that rolls down an incline, as Goldstein (1950) has it
        table = ("symbol, kind, unit, meaning\nx, coordinate, m, way\n\\theta, coordinate, rad, turn\nM, parameter, kg, mass\nr, parameter, m, radius\n"
                 "g, parameter, m/s^2, gravity\nl, parameter, m, length\n\\phi, parameter, rad, slope\n\\lambda, multiplier, N, friction\n")
        (self.folder / "symbols.csv").write_text(table, encoding="utf-8")
        for written in (r"x - r\theta = 0", r"\dot x = r \dot\theta", r"r\ddot{\theta} = \ddot{x}"):
            (self.folder / "paper.tex").write_text(self.HOOP.replace("CONSTRAINT", written), encoding="utf-8")
            self.assertEqual(self.judged().findings, [], written)
        self.change((r"- \lambda r = 0", r"+ \lambda r = 0"))
        self.assertEqual([(f.slip, f.proved) for f in self.judged().findings], [("sign", True)])
        self.change((r"r\ddot{\theta} = \ddot{x}", r"\dot{x}^2 = r^2 \dot\theta^2"))
        self.refused(LatexError, "linear in what has the most dots")

    def test_a_spring_pendulum_solved_for_its_accelerations_with_a_macro_and_nothing_said(self):
        (self.folder / "paper.tex").write_text(r"""\newcommand{\half}{\frac{1}{2}}
\begin{align}
\mathcal{L} &= \half m\left(\dot{x}^2+(\ell_0+x)^2\dot\theta^2\right) - \half k x^2 + g m (\ell_0+x)\cos\theta \\
\ddot x &= (\ell_0 + x)\dot\theta^2 - \frac{k}{m} x + g \cos \theta \\
\ddot\theta &= -\frac{g}{\ell_0+x}\sin\theta - \frac{2\dot x}{\ell_0+x}\dot\theta
\end{align}""", encoding="utf-8")
        (self.folder / "symbols.csv").write_text("symbol, kind, unit, meaning\nx, coordinate, m, stretch\n\\theta, coordinate, rad, angle\nm, parameter, kg, mass\n"
                                                 "k, parameter, N/m, stiffness\n\\ell_0, parameter, m, length\ng, parameter, m/s^2, gravity\n", encoding="utf-8")
        self.assertEqual(self.judged().findings, [])
        self.change((r"\frac{2\dot x}", r"\frac{\dot x}"))
        self.assertEqual([(f.equation, f.slip, f.proved) for f in self.judged().findings], [("3", "number", True)])
        (self.folder / "figures").mkdir()
        self.assertEqual(load(self.folder / "figures" / "..").name, self.folder.name)

    def test_readings_of_a_paper_are_ranked(self):
        # is theta measured from below or from above? The reading is that with which more terms agree
        self.change(("\\begin{equation}\nV", "% potential energy in reading from above\n\\[ V = m g l \\cos\\theta \\]\n"
                                         "% potential energy in reading from below\n\\begin{equation}\nV"))
        result = self.judged()
        self.assertEqual(([r.name for r in result.readings], result.findings), (["from below", "from above"], []))
        self.change((r"m g l \sin\theta = 0", r"m g l \cos\theta = 0"))
        (finding,) = self.judged().findings
        # wrong in both; of two that are as good the first that is named is judged with, and the other beside it
        self.assertEqual((finding.slip, finding.readings, list(finding.alternatives)), ("sign + function", ["from above", "from below"], ["from below"]))
        self.change(("in reading from above", "from above"))
        self.refused(LatexError, "'from above' says nothing of an energy")
        self.change(("% potential energy from above\n", ""), ("% potential energy in reading from below\n", ""))
        self.refused(LatexError, "V is given twice: where the paper may mean one or the other")

    def test_a_definition_is_put_in(self):
        self.change((r"\left( \dot{x}^2 + 2 l \cos\theta \, \dot{x} \dot{\theta} + l^2 \dot{\theta}^2 \right)", r"\left( v_x^2 + v_y^2 \right)"),
                    ("and the force", "\\[ v_x = \\dot{x} + l \\cos\\theta \\dot\\theta \\]\n\\[ v_y = l \\sin\\theta \\dot\\theta \\] and the force"))
        self.change(("\ng,  ", "\nv_x, defined, m/s, velocity, ,\nv_y, defined, m/s, velocity, ,\ng,  "), file="symbols.csv")
        result = self.judged()
        self.assertEqual((result.findings, words.undefined_symbols(result.case.paper)), ([], []))
        self.change(("l \\sin\\theta \\dot\\theta \\]", "l \\sin\\theta \\]"))
        self.refused(LatexError, r"paper.tex, line \d+, column \d+: v_y is declared in m\*s\^-1 and defined in m")

    def test_a_constraint_with_its_multiplier_in_either_sign(self):
        (self.folder / "symbols.csv").write_text("symbol,kind,unit,meaning\nx,coordinate,m,across\ny,coordinate,m,up\nm,parameter,kg,mass\n"
                                                 "g,parameter,m/s^2,gravity\nl,parameter,m,length\n\\lambda,multiplier,N/m,multiplier\n")
        for sign in "+-":
            (self.folder / "paper.tex").write_text(rf"""
                \[ T = \frac12 m (\dot x^2 + \dot y^2) \] \[ V = m g y \]
                % constraint with \lambda
                \[ x^2 + y^2 = l^2 \]
                \begin{{equation}} m \ddot x {sign} 2 \lambda x = 0 \end{{equation}}
                \begin{{equation}} m \ddot y + m g {sign} 2 \lambda y = 0 \end{{equation}}""")
            result = self.judged()
            self.assertEqual((result.findings, list(result.case.paper.equations)), ([], ["1", "2"]))
            content = (self.folder / "paper.tex").read_text()
            (self.folder / "paper.tex").write_text(content.replace(r"2 \lambda y", r"\lambda y"))
            self.assertEqual([(f.equation, f.slip) for f in self.judged().findings], [("2", "number")])

    def test_values_conditions_rules_and_impacts(self):
        self.change(("The equations of motion", r"""\[ R = (M + m) g + m l \sin\theta \ddot\theta + m l \cos\theta \dot\theta^2 \]
            % condition on x
            \[ |F| > \mu R \tag{8} \]
            \[ s = 1 \quad\text{if}\quad \dot{x} > 0 \tag{9} \]
            \[ \dot{x}^+ = -e \dot{x}^- \tag{10} \] The equations of motion"""))
        self.change(("\ng,  ", "\nR, force, N, normal force, ,\n\\mu, parameter, 1, friction, , 0.1\ns, sign, 1, side, -1,\n"
                     "e, parameter, 1, restitution, , 0.5\ng,  "), file="symbols.csv")
        self.assertEqual([(e.number, e.kind, e.of) for e in self.judged().case.paper.equations.values()],
                         [("value of R", "value", "R"), ("8", "condition", "x"), ("9", "rule", "s"), ("10", "reset", "x"), ("5", "motion", "x"),
                          ("6", "motion", "theta")])

    def test_equations_without_number_have_the_name_of_what_they_are(self):
        self.change(("% motion of x\n\\begin{equation}", "% motion of x\n\\begin{equation*}"), ("= F,\n\\end{equation}", "= F,\n\\end{equation*}"))
        self.assertEqual([e.number for e in self.judged().case.paper.equations.values()], ["motion of x", "5"])


class Command(Folder):
    def unread(self, *arguments):
        """Exit status and errors of the command where nobody reads what it prints."""
        root = Path(__file__).resolve().parents[3]
        reader, writer = os.pipe()
        os.close(reader)  # who writes now is told that nobody reads
        try:
            result = subprocess.run([sys.executable, "-B", "-m", "codegen", "verify", str(self.folder), "--quick", *arguments], cwd=root,
                                    stdout=writer, stderr=subprocess.PIPE, check=False)
        finally:
            os.close(writer)
        return result.returncode, result.stderr.decode()

    def test_a_reader_that_stops_reading_is_no_error(self):
        self.assertEqual(self.unread(), (0, ""))

    def test_what_is_not_read_is_judged_and_written_all_the_same(self):
        self.change((r"- m l \sin\theta \, \dot", r"+ m l \sin\theta \, \dot"))
        page = self.folder / "page.html"
        status, said = self.unread("--fail-on", "misprint", "--html", str(page))
        self.assertEqual(status, 1)
        self.assertIn("--fail-on misprint", said)
        self.assertIn("</html>", page.read_text(encoding="utf-8"))


class Gate(Folder):
    def status(self, *arguments):
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
            return cli.main([str(self.folder), "--quick", *arguments]), said.getvalue()

    def test_the_exit_status_where_one_is_asked_for(self):
        waivers = self.folder / "waivers"
        self.assertEqual(self.status("--fail-on", "finding"), (0, ""))
        self.change((r"- m l \sin\theta \, \dot", r"+ m l \sin\theta \, \dot"))
        self.assertEqual(self.status(), (0, ""))
        for kind in ("misprint", "finding"):
            status, said = self.status("--fail-on", kind)
            self.assertEqual(status, 1)
            self.assertRegex(said, rf"^verify: --fail-on {kind}: 5-1 \(motion of x [0-9a-f]{{8}}\)\n$")
        waivers.write_text("# agreed with the author\n5-1: the next edition has it right\n")
        self.assertEqual(self.status("--fail-on", "misprint", "--waivers", str(waivers)), (0, ""))
        waivers.write_text("5-1: known\n5-2: gone\n")
        status, said = self.status("--fail-on", "misprint", "--waivers", str(waivers))
        self.assertEqual((status, "no finding needs 5-2" in said), (1, True))
        for text, expected in (("5-1\n", "line 1: a waiver is a finding and its reason"), ("5-1:\n", "line 1"), ("5-1: a\n5-1: b\n", "line 2: 5-1 is waived twice")):
            waivers.write_text(text)
            status, said = self.status("--fail-on", "misprint", "--waivers", str(waivers))
            self.assertEqual((status, expected in said), (2, True), said)
        waivers.unlink()
        self.assertEqual(self.status("--fail-on", "misprint", "--waivers", str(waivers))[0], 2)

    def test_a_waiver_by_a_lasting_name_stays_where_equations_are_numbered_anew(self):
        waivers = self.folder / "waivers"
        self.change((r"- m l \sin\theta \, \dot", r"+ m l \sin\theta \, \dot"))
        name = re.search(r"\((motion of .*)\)", self.status("--fail-on", "misprint")[1])[1]
        waivers.write_text(f"{name}: the next edition has it right\n")
        gate = ("--fail-on", "misprint", "--waivers", str(waivers))
        self.assertEqual(self.status(*gate), (0, ""))
        self.change(("T =", "% skip\na = b\n\\end{equation}\n\\begin{equation}\nT ="))
        self.assertIn("6-1", self.status("--fail-on", "misprint")[1])
        self.assertEqual(self.status(*gate), (0, ""))
        # another slip in that term is not excused, and the waiver excuses nothing
        self.change((r"+ m l \sin\theta \, \dot", r"+ m l \cos\theta \, \dot"))
        status, said = self.status(*gate)
        self.assertEqual((status, said.count("\n")), (1, 2), said)

    def test_an_objection_is_a_finding_and_no_misprint(self):
        self.change(("T =", "% skip\nT ="), ("V =", "% skip\nV ="), ("D =", "% skip\nD ="), ("Q_x =", "% skip\nQ_x ="))
        self.assertEqual((self.status("--fail-on", "misprint")[0], self.status("--fail-on", "finding")[0]), (0, 1))


class Refused(Folder):
    def test_errors_of_the_latex_say_where_in_the_file(self):
        self.change((r"m l^2 \ddot{\theta} +", r"m l^2 \ddot{\theta} + \sqrt{m} +"))
        with self.assertRaises(LatexError) as caught:
            self.judged()
        first, line, caret = str(caught.exception).split("\n")
        number = next(k for k, x in enumerate((self.folder / "paper.tex").read_text().split("\n"), 1) if r"\sqrt" in x)
        self.assertIn(f"paper.tex, line {number}, column {line.index('sqrt') - 4}: \\sqrt", first)
        self.assertEqual(caret.index("^"), line.index(r"\sqrt"))

    def test_what_is_not_clear_is_asked_for(self):
        table = [
            ((("% motion of x\n", ""),), LatexError, r"line 24, column 1: it is not clear what this equation is of.*% motion of"),
            ((("% motion of x", "% motion of y"),), LatexError, r"y is not in symbols.csv"),
            ((("% motion of x", "% motion of x\n% motion of \\theta"),), LatexError, r"two comments"),
            ((("V = ", "T = "),), LatexError, "T is given twice"), ((("V = ", "% skip\nV = "),), PaperError, "V is not given; if there is none, write V = 0"),
            ((("V = ", "L = "),), PaperError, "L is given beside T"), ((("Q_x = F", "Q_z = F"),), LatexError, "z is not in symbols.csv"),
            ((("= F,", "= F_2,"),), PaperError, r"equation \(5\): .*paper.tex, line 25, column \d+: the symbol 'F_2' is not declared"),
            ((("T = ", "T + V = "),), LatexError, "not clear"), ((("V = - m", "V < - m"),), LatexError, "not clear|not in"),
        ]
        for pairs, error, expected in table:
            shutil.copy(TEMPLATE / "paper.tex", self.folder)
            self.change(*pairs)
            with self.subTest(expected):
                self.refused(error, expected)

    def test_the_table_of_symbols(self):
        table = [
            ((("m/s^2", "m/min^2"),), r"symbols.csv, line 7: the unit 'm/min\^2'"), ((("damping,    N", "brake,    N"),), r"line 8: 'brake' is no kind"),
            ((("l,         ", "m,         "),), "line 6: the symbol 'm' is declared twice"), ((("symbol,", "name,"),), "line 1: the table lacks the column 'symbol'"),
            (((" 0.5", " ,"),), "line 5: the row has not 6 cells"), (((" 0.5", ""),), "the column 'value' says nothing of m"),
            (((" 0.5", " half"),), "line 5: .*half"), ((("-1,\nM", "-2,\nM"),), "line 3: mirror is 1 or -1, not -2"),
        ]
        for pairs, expected in table:
            shutil.copy(TEMPLATE / "symbols.csv", self.folder)
            self.change(*pairs, file="symbols.csv")
            with self.subTest(expected):
                self.refused(PaperError, expected)
        (self.folder / "symbols.csv").unlink()
        self.refused(PaperError, "needs the table of its symbols")

    def test_one_of_two_papers(self):
        (self.folder / "paper.py").write_text("")
        self.refused(PaperError, "both paper.py and paper.tex")


if __name__ == "__main__":
    unittest.main()
