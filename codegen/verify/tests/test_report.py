"""The report: what is shown is what was judged, links lead somewhere, and LaTeX has balanced groups."""

import hashlib
import os
import re
import unittest
import xml.etree.ElementTree as xml
from dataclasses import replace
from unittest import mock

from codegen import VERSION
from codegen.verify import seeded
from codegen.verify.input.latex import Parser
from codegen.verify.load import load
from codegen.verify.report import gather, html, tex, texmath
from codegen.verify.report.aligned import aligned
from codegen.verify.report.document import ROWS, document
from codegen.verify.report.order import ranked
from codegen.verify.report.show import form_latex
from codegen.verify.tests.cases import ROOT, TANK, report_of

PUBLISHED = sorted(path.parent for path in (ROOT / "codegen/verify/published").glob("*/paper.tex"))


def page_of(report):
    return xml.fromstring(html.as_html(report).replace("<!DOCTYPE html>", "").replace('<meta charset="utf-8">', ""))


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.reports = [report_of(TANK), report_of(TANK, "corrections"), report_of(TANK, "energies"), report_of(seeded.EXAMPLES / "rocking_block")]

    def test_every_link_has_its_place_once(self):
        for report in self.reports:
            page, latex = page_of(report), tex.as_latex(report)
            places = [x.get("id") for x in page.iter() if x.get("id")]
            self.assertEqual(len(places), len(set(places)))
            self.assertLessEqual({x.get("href")[1:] for x in page.iter("a")}, set(places))
            targets = re.findall(r"\\hypertarget\{([^}]*)\}", latex)
            self.assertEqual(len(targets), len(set(targets)))
            self.assertLessEqual(set(re.findall(r"\\hyperlink\{([^}]*)\}", latex)), set(targets))

    def test_the_consistent_terms_are_those_of_the_corrected_equation(self):
        for report in self.reports:
            for number in report.case.paper.equations:
                pairs = aligned(report, number)
                key = lambda form: str(form)
                self.assertEqual([p.printed for p in pairs if p.printed is not None], report.printed.forms[number])
                self.assertEqual(sorted((p.consistent for p in pairs if p.consistent is not None), key=key),
                                 sorted(report.corrected.forms[number], key=key))
                for pair in pairs:
                    self.assertTrue(pair.findings or not pair.changed(), (number, pair))

    def test_findings_of_a_kind_are_ranked(self):
        for report in self.reports:
            for kind in {f.kind for f in report.findings}:
                of_kind = [f for f in report.findings if f.kind == kind and f.equation != "text"]
                degrees = [float("inf") if f.order is None else f.order for f in of_kind]
                self.assertEqual(degrees, sorted(degrees))
        first, second, third = [replace(f, kind="misprint", equation="1", effects={}) for f in self.reports[0].findings[:3]]
        effect = lambda value: {"scene": {"changes": ["t"], "without": {"t": 2.0}, "with": {"t": value}}}
        second.effects, third.effects = effect(2.1), {"scene": {"changes": ["stopped"], "without": {}, "with": {"stopped": "at once"}}}
        self.assertEqual(ranked([first, second, third]), [third, second, first])
        third.effects = effect(1.9)
        self.assertEqual(ranked([first, second, third])[0], third)

    def test_the_summary_fits_on_a_page(self):
        for report in self.reports:
            table = next(block for block in document(report).blocks if type(block).__name__ == "Table")
            self.assertLessEqual(len(table.rows), ROWS)
            # every finding is linked to before the page ends
            linked = re.findall(r'href="#finding-([^"]*)"', html.as_html(report).partition('<div class="break">')[0])
            self.assertEqual(set(linked), {f.key for f in report.findings})

    def test_groups_and_formulas_of_latex_are_closed(self):
        for report in self.reports:
            latex = re.sub(r"\\[\\{}$]", "", tex.as_latex(report))
            self.assertEqual(latex.count("{"), latex.count("}"))
            self.assertEqual(latex.count("$") % 2, 0)
            self.assertNotIn("[U+", latex)
            self.assertTrue(latex.isascii() or not set(latex) - set(re.sub(r"[^\x00-\xff]", "", latex)))

    def test_version_and_date_and_input_are_said(self):
        with mock.patch.dict(os.environ, {"SOURCE_DATE_EPOCH": "86400"}):
            report = gather.verify(load(PUBLISHED[0]), thorough=False)
        self.assertEqual((report.version, report.date), (VERSION, "1970-01-02"))
        self.assertIn(f'version = "{VERSION}"', (ROOT / "Cargo.toml").read_text(encoding="utf-8"))
        files = {name: hashlib.sha256((PUBLISHED[0] / name).read_bytes()).hexdigest() for name in ("paper.tex", "symbols.csv")}
        self.assertEqual(report.files, files)
        self.assertIn(report.digest(), html.as_html(report))
        self.assertEqual(list(report_of(seeded.EXAMPLES / "rocking_block").files), ["paper.py", "paper_energies.py"])

    def test_words_of_a_paper_are_no_markup(self):
        case = load(seeded.EXAMPLES / "rocking_block")
        case = replace(case, paper=replace(case.paper, title=r"<b> & 100 % of \x_1 $", source="Жук"))
        report = gather.verify(case, thorough=False)
        self.assertEqual(page_of(report).find("body/h1").text, case.paper.title)
        latex = tex.as_latex(report)
        self.assertIn(r"$<$b$>$ \& 100 \% of \textbackslash{}x\_1 \$", latex)
        self.assertIn(r"\texttt{[U+0416]}", latex)


class Printed(unittest.TestCase):
    def test_latex_that_is_shown_is_the_tree_that_was_judged(self):
        """What the report prints parses to the same terms again."""
        for folder in [*PUBLISHED, TANK]:
            for equation in load(folder).paper.equations.values():
                if equation.latex and equation.kind != "rule":
                    tree = Parser(equation.latex).equation()
                    again = Parser(" ".join(texmath.lines(tree, {}))).equation()
                    self.assertEqual(self.shape(again), self.shape(tree), equation.number)

    def shape(self, node):
        index = re.sub(r"\\(mathrm|text)|[{}\s]", "", node.index)
        inner = [self.shape(child) for child in node.children]
        if node.kind == "group" and len(inner) == 1 and not node.text:
            return inner[0]
        return (node.kind, node.text.lstrip("\\"), node.dots, index, node.time, node.accent, node.sign, inner)

    def test_forms_are_read_back(self):
        report = report_of(seeded.EXAMPLES / "rocking_block")
        for forms in report.printed.forms.values():
            for form in forms:
                Parser(form_latex(form, report.case.paper)).equation()


if __name__ == "__main__":
    unittest.main()
