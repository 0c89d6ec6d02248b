"""The LaTeX of printed equations: read into terms, typeset as MathML."""

import unittest
import xml.etree.ElementTree as xml
from dataclasses import replace
from pathlib import Path

from codegen.verify.errors import PaperError
from codegen.verify.input import transcription
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import load
from codegen.verify.report import mathml, show

WALKING_TANK = Path(__file__).resolve().parents[3] / "models" / "walking_tank"


class Latex(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = load(WALKING_TANK)
        cls.subject = Subject(cls.case.paper)

    def test_every_printed_equation_is_transcribed_term_by_term(self):
        self.assertEqual(transcription.proved(self.subject), ["1", "2", "3", "4", "5", "6a", "6b", "7", "8", "9", "10"])

    def test_a_slip_of_the_transcription_is_found(self):
        equation = self.case.paper.equations["2"]
        for old, new in (("+ kx_I", "- kx_I"), (r"M_{rb} x_I \dot", r"M_I x_I \dot"), (r"\sin \alpha_I", r"\cos \alpha_I")):
            changed = self.case.paper.with_equations([replace(equation, latex=equation.latex.replace(old, new))])
            with self.assertRaisesRegex(PaperError, r"equation \(2\)"):
                transcription.proved(Subject(changed))

    def test_mathml_is_well_formed_and_marks_the_term(self):
        for number, equation in self.case.paper.equations.items():
            last = len(self.subject.forms[number]) - 1
            text = mathml.mathml(transcription.statement(equation, self.case.paper), {last: "differ"})
            tree = xml.fromstring(text)
            self.assertEqual(len(tree.findall(".//*[@class='differ']")), 1, number)

    def test_forms_survive_their_own_latex(self):
        for number in ("1", "2", "3", "9"):
            for form in self.subject.forms[number]:
                equation = replace(self.case.paper.equations["1"], latex=show.form_latex(form, self.case.paper) + " = 0")
                tree = transcription.statement(equation, self.case.paper)
                back = transcription.terms(tree, self.case.paper, self.subject.s, self.subject.m)
                self.assertEqual(sum((self.subject.ring.read(x) for x in back), self.subject.ring.number(0)), form)

    def test_unknown_latex_is_an_error_that_shows_the_place(self):
        for text, expected in ((r"\bigcup M_I = 0", r"equation \(1\).*line 1, column 1: .*'bigcup'"), (r"M_I + = 0", r"equation \(1\).*term is missing")):
            changed = self.case.paper.with_equations([replace(self.case.paper.equations["1"], latex=text)])
            with self.assertRaisesRegex(PaperError, expected):
                transcription.proved(Subject(changed))

    def test_plain_text_reads_like_the_paper(self):
        self.assertEqual(show.form_text(self.subject.forms["2"][2], self.case.paper), "− λ M_rb R_I sin α_I θ̇²")


if __name__ == "__main__":
    unittest.main()
