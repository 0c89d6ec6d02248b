"""python check_certificate.py FILE: checks every claim of a certificate of `verify`, with SymPy alone. Exit status 1: one fails."""
import ast, functools, itertools, json, sys
import sympy as sp
from sympy.simplify.fu import TR8

OPERATORS = {ast.Add: "__add__", ast.Sub: "__sub__", ast.Mult: "__mul__", ast.Div: "__truediv__", ast.Pow: "__pow__"}

def sign_symbol(a):  # a sign is a symbol whose square is 1, and |a| = a sign(a)
    flipped = sp.expand(a).could_extract_minus_sign()
    return (-1 if flipped else 1) * sp.Symbol(f"<{sp.expand(-a if flipped else a)}>")

def rising(f):  # of an interval, that of its ends
    return lambda x: sp.AccumBounds(f(x.min), f(x.max)) if isinstance(x, sp.AccumBounds) else f(x)

class Checker:
    def __init__(self, data):
        moving = [(d + n, "d" + d + n) for n in data["moving"] for d in ("", "d", "dd")]
        self.known = {n: sp.Symbol(n, real=True) for n in [*data["symbols"], *sum(map(list, moving), []), "U_kg", "U_m", "U_s"]}
        k, self.held, self.states = self.known, [self.known[n] for n in data["held"]], [self.known[n] for n in data["states"]]
        put = lambda e, *pairs: e.subs(dict(zip(pairs[::2], pairs[1::2])), simultaneous=True)
        self.functions = {"sin": sp.sin, "cos": sp.cos, "sign": sp.sign, "Abs": sp.Abs, "tan": sp.tan, "sqrt": rising(sp.sqrt),
                          "asin": rising(sp.asin), "atan": rising(sp.atan), "between": sp.AccumBounds, "diff": sp.diff, "put": put,
                          "rate": lambda e: sum(e.diff(k[n]) * k[r] for n, r in moving),
                          "mirror": lambda e: put(e, *[x for n in data["mirror"] for x in (k[n], -k[n])]),
                          "scaled": lambda e: put(e, *[x for n, u in data["units"].items() for x in (k[n], k[n] * self.read(u))])}
        for name, text in data["let"].items(): k[name] = self.read(text)
    @functools.lru_cache(None)
    def read(self, text):  # arithmetic of the declared names and functions: nothing else is evaluated
        def value(x):
            if isinstance(x, ast.BinOp): return getattr(value(x.left), OPERATORS[type(x.op)])(value(x.right))
            if isinstance(x, ast.UnaryOp) and isinstance(x.op, ast.USub): return -value(x.operand)
            if isinstance(x, ast.Call): return self.functions[x.func.id](*map(value, x.args))
            return self.known[x.id] if isinstance(x, ast.Name) else sp.Rational(str(x.value))
        return value(ast.parse(text, mode="eval").body)
    def forms(self, e):  # for each value of the states, what is held at zero
        for values in itertools.product((1, -1), repeat=len(self.states)):
            x = e.subs({**dict.fromkeys(self.held, 0), **dict(zip(self.states, values))})
            x = sp.expand(x.replace(sp.Abs, lambda a: a * sp.sign(a)).replace(sp.sign, sign_symbol))
            yield x.replace(lambda p: p.is_Pow and str(p.base)[0] == "<", lambda p: p.base ** (p.exp % 2))
    def parts(self, x):
        return {t.as_independent(*t.free_symbols, as_Add=False)[1] for t in sp.Add.make_args(sp.expand(TR8(sp.expand(x))))} - {0}
    def holds(self, claim):
        (a, b), what = map(self.read, claim["of"]), claim["is"]
        if what in ("equal", "different"):
            return all(sp.expand(sp.fraction(sp.together(x))[0].rewrite(sp.exp)) == 0 for x in self.forms(a - b)) == (what == "equal")
        if what in ("alike", "apart"):  # whether they have parts in common
            return all(bool(self.parts(x) & self.parts(y)) == (what == "alike") for x, y in zip(self.forms(a), self.forms(b)))
        at = {self.known[n]: sp.Rational(v) for n, v in claim.get("at", {}).items()}  # intervals are greater where all of them is
        return what == "greater" and ((a - b).subs(at).evalf(30) > 0) == True

if __name__ == "__main__":
    checker = Checker(content := json.load(open(sys.argv[1], encoding="utf-8")))
    claims, failed = content["claims"], [claim for claim in content["claims"] if not checker.holds(claim)]
    print(*[f"FAILS: {json.dumps(claim)}" for claim in failed], f"{len(claims) - len(failed)} of {len(claims)} claims hold", sep="\n")
    sys.exit(bool(failed or not claims))
