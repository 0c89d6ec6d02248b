"""Tables of LaTeX: what must be read, and as what; what must be refused, and where."""

import unittest

import sympy

from codegen.verify import Paper
from codegen.verify.errors import LatexError, PaperError
from codegen.verify.input import transcription
from codegen.verify.input.latex import Parser
from codegen.verify.input.namespace import Mathematics, sympy_namespace
from codegen.verify.judgements.subject import Subject
from codegen.verify.normal.algebra import ring_of
from codegen.verify.report import mathml


def paper():
    """Symbols with indices, upright indices and accents."""
    result = Paper("Idioms", "nowhere")
    for name, latex in (("theta", r"\theta"), ("theta_1", r"\theta_1"), ("x", "x"), ("x_I", "x_I")):
        result.coordinate(name, "rad", name, latex)
    for name, latex in (("m", "m"), ("l", "l"), ("g", "g"), ("k", "k"), ("alpha", r"\alpha"), ("M_rb", r"M_{\mathrm{rb}}"),
                        ("xbar", r"\bar{x}"), ("omega", r"\omega"), ("ell", r"\ell"), ("phi", r"\varphi"), ("Re", r"\mathrm{Re}")):
        result.parameter(name, "1", name, latex)
    return result


PAPER = paper()
S, M, RING = sympy_namespace(PAPER), Mathematics(), ring_of(PAPER)
sin, cos = sympy.sin, sympy.cos

READ = [
    # numbers, products, fractions
    (r"\frac{1}{2} m x^2", S.m * S.x**2 / 2), (r"\frac12 m x^2", S.m * S.x**2 / 2), (r"\tfrac12 m", S.m / 2), (r"\dfrac{m}{l} g", S.m * S.g / S.l),
    (r"\frac m l", S.m / S.l), (r"\frac{1}2 m", S.m / 2), (r"0.5 m", S.m / 2), (r".25m", S.m / 4), (r"1.5\,m", S.m * 3 / 2),
    (r"2 \cdot 3 m", 6 * S.m), (r"m \times l", S.m * S.l), (r"m * l", S.m * S.l), (r"mgl", S.m * S.g * S.l), (r"m\,g\;l\!", S.m * S.g * S.l),
    (r"m g/l", S.m * S.g / S.l), (r"x/2", S.x / 2), (r"(m + M_{rb})/l", (S.m + S.M_rb) / S.l), (r"{m}{g}", S.m * S.g), (r"m~g", S.m * S.g),
    (r"\frac{k x}{m l}", S.k * S.x / (S.m * S.l)), (r"m^{2}", S.m**2), (r"m^{-1}", 1 / S.m), (r"(m l)^2", S.m**2 * S.l**2),
    # dots
    (r"\ddot\theta", S.ddtheta), (r"\ddot{\theta}", S.ddtheta), (r"\dot\theta^2", S.dtheta**2), (r"{\dot\theta}^2", S.dtheta**2),
    (r"\dot{\theta}^{2}", S.dtheta**2), (r"\ddot{\theta}_1", S.ddtheta_1), (r"\ddot{\theta_1}", S.ddtheta_1), (r"\ddot\theta_1", S.ddtheta_1),
    (r"\dot{x}_I^2", S.dx_I**2), (r"\dot x_{I}", S.dx_I), (r"\ddot{\theta}(t)", S.ddtheta), (r"\frac{d\theta}{dt}", S.dtheta),
    (r"\frac{\mathrm{d}^2\theta}{\mathrm{d}t^2}", S.ddtheta), (r"\frac{d^{2} x_I}{d t^{2}}", S.ddx_I), (r"\dot\theta\dot x", S.dtheta * S.dx),
    # time derivatives of brackets
    (r"\frac{d}{dt}\left(m x^2 \dot x\right)", 2 * S.m * S.x * S.dx**2 + S.m * S.x**2 * S.ddx),
    (r"m l \frac{\mathrm{d}}{\mathrm{d} t}\{2\dot\theta - \dot x(1 + k^2 x^2)\}",
     S.m * S.l * (2 * S.ddtheta - S.ddx * (1 + S.k**2 * S.x**2) - 2 * S.k**2 * S.x * S.dx**2)),
    (r"\frac{\text{d}}{\text{d}t}\left(\sin^2\theta\,\dot\theta\right)", 2 * sin(S.theta) * cos(S.theta) * S.dtheta**2 + sin(S.theta)**2 * S.ddtheta),
    (r"m\frac{d^2}{dt^2}(x + l\sin\theta)", S.m * (S.ddx + S.l * cos(S.theta) * S.ddtheta - S.l * sin(S.theta) * S.dtheta**2)),
    # as papers and notes print them
    (r"k\csc^2\alpha\,\dot x^2", S.k * S.dx**2 / sin(S.alpha)**2), (r"\sec\theta", 1 / cos(S.theta)), (r"\boxed{m\,\ddot{x}}", S.m * S.ddx),
    (r"\mathcal{M}_{rb}", S.M_rb), (r"m \, l \cos{\left(\theta \right)} \,,", S.m * S.l * cos(S.theta)), (r"m l^2\ \dot\theta^2 \;.", S.m * S.l**2 * S.dtheta**2),
    (r"\begin{split} m \\ &\quad + k \end{split}", S.m + S.k), (r"\begin{aligned} & m + k \end{aligned}", S.m + S.k),
    (r"\frac{m\ell g}{2}(1-\cos\theta)", S.m * S.ell * S.g * (1 - cos(S.theta)) / 2), (r"\sin{\left(2\,\theta\right)}", sin(2 * S.theta)),
    (r"\Big(m + k\Big)\ddot{\theta}_{1}", (S.m + S.k) * S.ddtheta_1), (r"\tfrac{1}{2}\,m\left[\dot{x}^{2}+\left(l\dot{\theta}\right)^{2}\right]",
                                                                  S.m * (S.dx**2 + S.l**2 * S.dtheta**2) / 2),
    # spaces, boxes, colours and braces that do not change what shows
    (r"m\mspace{2mu}l", S.m * S.l), (r"m\hskip 1em l\kern1pt k", S.m * S.l * S.k), (r"m\vphantom{\frac12}l\phantom{m}", S.m * S.l), (r"{\color{red} m}", S.m),
    (r"\textcolor{red}{m + k} l", S.m + S.k * S.l), (r"\ensuremath{m} \smash{l}", S.m * S.l), (r"\mathop{\mathrm{sgn}}\dot x", sympy.sign(S.dx)),
    (r"m\ddot{x} {+} k x", S.m * S.ddx + S.k * S.x), (r"\dot\theta_1{}^2", S.dtheta_1**2), (r"\dot{\theta} {}^2", S.dtheta**2), (r"\frac{l}{\rm m}", S.l / S.m),
    (r"\frac{\rm d}{{\rm d}t}(m\dot{x})", S.m * S.ddx), (r"\frac{\mathrm d^2\theta}{\mathrm dt^2}", S.ddtheta), (r"{\rm sgn}(\dot x)", sympy.sign(S.dx)),
    (r"x\left(t\right) m", S.x * S.m), (r"\nicefrac{1}{2} m \cdotp l", S.m * S.l / 2), (r"\scriptstyle m \enspace l \allowbreak g", S.m * S.l * S.g),
    (r"m l \text{,}", S.m * S.l),
    # functions
    (r"\sin\theta", sin(S.theta)), (r"\sin{\theta}", sin(S.theta)), (r"\sin(\theta)", sin(S.theta)), (r"\sin\left(\theta\right)", sin(S.theta)),
    (r"\sin^2\theta", sin(S.theta)**2), (r"\sin^{2}\theta", sin(S.theta)**2), (r"\sin^2(\alpha-\theta)", sin(S.alpha - S.theta)**2),
    (r"\cos 2\theta", cos(2 * S.theta)), (r"\cos{2\theta}", cos(2 * S.theta)), (r"\sin\frac{\theta}{2}", sin(S.theta / 2)),
    (r"\sin \tfrac12 \theta", sin(S.theta / 2)), (r"\cos 2(\theta - \alpha)", cos(2 * (S.theta - S.alpha))),
    (r"\sin\theta\cos\theta", sin(S.theta) * cos(S.theta)), (r"\sin\theta_1\dot\theta_1^2", sin(S.theta_1) * S.dtheta_1**2),
    (r"\sin \varphi", sin(S.phi)), (r"\tan\theta", sin(S.theta) / cos(S.theta)), (r"\cot\alpha", cos(S.alpha) / sin(S.alpha)),
    (r"\operatorname{sgn}(\dot x)", sympy.sign(S.dx)), (r"\operatorname{sign}\dot{x}", sympy.sign(S.dx)), (r"\mathrm{sgn}(\dot x)", sympy.sign(S.dx)),
    (r"\text{sgn}(\dot x)", sympy.sign(S.dx)), (r"\sgn(\dot x)", sympy.sign(S.dx)), (r"\sin(\alpha\operatorname{sgn}\theta - \theta)",
                                                                                sin(S.alpha * sympy.sign(S.theta) - S.theta)),
    (r"|x|", sympy.Abs(S.x)), (r"\left|x\right|", sympy.Abs(S.x)), (r"\lvert x\rvert", sympy.Abs(S.x)), (r"\vert x \vert", sympy.Abs(S.x)),
    # brackets
    (r"\left( m + k \right) l", (S.m + S.k) * S.l), (r"\bigl(m + k\bigr) l", (S.m + S.k) * S.l), (r"\Big[ m + \left\{ k \right\} \Big]", S.m + S.k),
    (r"\lbrace m + k \rbrace", S.m + S.k), (r"(m + k)(l + g)", (S.m + S.k) * (S.l + S.g)), (r"-(m - k)", S.k - S.m),
    # symbols
    (r"M_{rb}", S.M_rb), (r"M_{\mathrm{rb}}", S.M_rb), (r"M_\mathrm{rb}", S.M_rb), (r"M_{\text{rb}}", S.M_rb), (r"M_{\rm rb}", S.M_rb),
    (r"\bar{x}", S.xbar), (r"\bar x m", S.xbar * S.m), (r"\mathrm{Re}", S.Re), (r"θ", S.theta), (r"m ω", S.m * S.omega), (r"x^2_I", S.x_I**2),
    # what does not show, and what stands around a formula
    (r"m + k,", S.m + S.k), (r"m + k.", S.m + S.k), (r"m + k \, ,", S.m + S.k), (r"\begin{equation} m \label{eq:m} \end{equation}", S.m),
    (r"\[ m \]", S.m), (r"$m$", S.m), (r"$$m$$", S.m), (r"\displaystyle m \nonumber", S.m), (r"m \tag{3.2a}", S.m), ("m % a remark = 0\n + k", S.m + S.k),
    (r"\begin{align*} & m \\[2ex] & + k \end{align*}", S.m + S.k), (r"m − k", S.m - S.k),
]

REFUSED = [
    # text, what is at the caret, what the message says
    (r"\sin(\theta)^2", "^2", "can be read in two ways"), (r"\sin\theta^2", "^2", "can be read in two ways"), (r"\sin^{-1}\theta", r"\sin", "two ways"),
    (r"\sin\theta/2", "/2", "two ways"), (r"g/l \sin\theta", "/l", r"write \\frac"), (r"1/2 m", "/2", r"write \\frac"), (r"m/l/g", "/l", "two ways"),
    (r"\sin{\theta \alpha}", "{", "brackets around its argument"), (r"\sin{\theta + \alpha}", "{", "braces do not show"),
    (r"{m + k} l", "{m", "braces do not show"), (r"{m l}^2", "m l}", "braces do not show"), (r"\sin -\theta", "-", "brackets around the argument"),
    (r"\sin\cos\theta", r"\cos", "brackets around the argument"), (r"\sin 2 \cos\theta", "2", "can be read in two ways"), (r"m^12", "12", "first digit"),
    (r"m_12", "12", "first digit"), (r"m^{1/2}", "/2", "expected"), (r"m^{k}", "{k}", "not a whole number"), (r"m^2^3", "^3", "power of a power"),
    (r"2 3 m", "3", "two numbers side by side"), (r"2,5 m", ",5", "decimals have a point"), (r"m +", None, "term is missing"),
    (r"m \cdot", None, "factor is missing"), (r"m \cdot - l", "-", "factor is missing"), (r"(m + k", None, "expected"), (r"(m + k]", "]", "expected"),
    (r"m + k)", ")", "unexpected"), (r"|x", None, "expected"), (r"\left. m \right|", r"\left", "does not show"), (r"\sqrt{m}", r"\sqrt", "root"),
    (r"m e^{\theta}", r"{\theta}", "not a whole number"), (r"m \pm l", r"\pm", "one for each sign"), (r"m \approx l", r"\approx", "approximation"),
    (r"\frac{d}{dt} m \dot x", r"\frac", "brackets around what d/d t is of"), (r"\frac{d^3}{dt^3}(m x)", r"\frac", "carry other derivatives out"),
    (r"\frac{d^2}{dt}(m x)", r"\frac", "carry other derivatives out"),
    (r"m \Rightarrow l", r"\Rightarrow", "a display"), (r"m \stackrel{!}{=} l", r"\stackrel", "alone"),
    (r"\begin{array}{l} m \end{array}", r"\begin", "equation of its own"), (r"m \sin(\omega t)", "t)", "as an input or a force"),
    (r"F_y^f", "f", "not a whole number"), (r"{}^2 m", "^2", "term is missing"), (r"\frac{m}{} k", "} k", "term is missing"), (r"\frac{m}{}^2", "^2", "braces around the arguments"),
    (r"\sin\theta{}^2", "^2", "can be read in two ways"), (r"\smash{m + k}^2 + {+} l", "+}", "term is missing"),
    (r"\frac{d}{dx}(m x)", r"\frac", "carry other derivatives out"), (r"\frac{\partial m}{\partial x}", r"\partial", "derivative"),
    (r"\frac{d^2 x}{dt}", r"\frac", r"d\^2 over dt\^1"), (r"\dot{m x}", r"\dot", "one symbol"), (r"\dot{\dot{x}}", r"\dot", "another"),
    (r"x'", "'", "prime"), (r"x_1_2", "_2", "second index"), (r"\vec{x}", r"\vec", "components"), (r"\int m", r"\int", "integral"),
    (r"\begin{cases} m \end{cases}", r"\begin", "equation of its own"), (r"m ? k", "?", "cannot be read"), (r"\exp(x)", r"\exp", "exponential"),
    (r"m \\ k", "k", "after the line break"), (r"\frac{m}", None, "braces around the arguments"), (r"\frac1.5", "1.5", "two ways|braces around"),
    (r"\frac{m}{0}", r"\frac", "division by zero"), (r"m/0", "m", "division by zero"), (r"x(t+1)", "t", "not declared"), (r"m q", "q", "'q' is not declared"), (r"m_2", "m_2", "'m_2' is not declared"),
    (r"\dot{m}", r"\dot", "neither a coordinate nor an input"), (r"\dddot{x}", r"\dddot", "3 dots"), (r"", None, "term is missing"), (r"\theta \le", None, "term is missing"),
]


def value(text):
    """The expression that a text is read as, by the way that equations take."""
    tree = Parser(text + " = 0" if "end" not in text and not text.endswith(("]", "$", ".", ",", "{,}")) else text).equation()
    transcription._collect(tree.children[0], 1, [0])
    return sum(transcription.terms(tree, PAPER, S, M, text))


class Idioms(unittest.TestCase):
    def test_what_must_be_read_is_read_as_what_it_says(self):
        for text, expected in READ:
            with self.subTest(text):
                self.assertEqual(RING.read(value(text)), RING.read(expected))

    def test_what_is_read_can_be_shown(self):
        for text, _ in READ:
            with self.subTest(text):
                self.assertIn("<math", mathml.mathml_inline(text))
        self.assertIn("<mn>2</mn><mo>·</mo><mn>3</mn>", mathml.mathml_inline(r"2 \cdot 3"))

    def test_what_must_be_refused_is_refused_at_its_place_with_what_to_write(self):
        for text, place, message in REFUSED:
            with self.subTest(text), self.assertRaisesRegex(LatexError, message) as caught:
                tree = Parser(text).equation()
                transcription._collect(tree.children[0], 1, [0])
                transcription.terms(tree, PAPER, S, M, text)
            with self.subTest(text):
                at = len(text.rstrip()) if place is None else text.index(place)
                self.assertIn(f"line 1, column {at + 1}:", str(caught.exception))
                lines = str(caught.exception).split("\n")
                self.assertEqual(lines[-1], "    " + " " * at + "^")

    def test_the_caret_stands_in_the_line_of_the_error(self):
        with self.assertRaises(LatexError) as caught:
            Parser("m + k\n  + \\sqrt{l}\n = 0").equation()
        self.assertEqual(str(caught.exception).split("\n"), [
            "line 2, column 5: \\sqrt: a root is no trigonometric polynomial: multiply the equation out, or declare the root as a symbol",
            "      + \\sqrt{l}", "        ^"])


class FromLatex(unittest.TestCase):
    def test_the_terms_of_an_equation_follow_from_its_latex(self):
        pendulum = Paper("Pendulum", "any textbook")
        pendulum.coordinate("q", "rad", "angle", mirror=-1)
        for name, unit in (("m", "kg"), ("l", "m"), ("g", "m/s^2")):
            pendulum.parameter(name, unit, name)
        pendulum.motion("1", of="q", latex=r"m l^2 \ddot q = -m g l \sin q")
        subject = Subject(pendulum)
        self.assertEqual(subject.expressions["1"], [subject.s.m * subject.s.l**2 * subject.s.ddq,
                                                    subject.s.m * subject.s.g * subject.s.l * sin(subject.s.q)])
        self.assertEqual(transcription.proved(subject), [])
        with self.assertRaisesRegex(PaperError, r"\(1\) is given twice"):
            pendulum.motion("1", of="q", latex="m = 0")

    def test_fractions_of_sums_are_terms_each(self):
        tree = Parser(r"\frac{m \dot x - k x}{l} + 2(m + k) = 0").equation()
        transcription._collect(tree.children[0], 1, [0])
        terms = transcription.terms(tree, PAPER, S, M)
        self.assertEqual(terms, [S.m * S.dx / S.l, -S.k * S.x / S.l, 2 * S.m, 2 * S.k])


if __name__ == "__main__":
    unittest.main()
