"""What a model file passes: each argument is what it should be, or the file is refused with what would be right."""

import keyword
import unicodedata

import casadi as ca

_C = """auto break case char const continue default do double else enum extern float for goto if inline int long register
restrict return short signed sizeof static struct switch typedef union unsigned void volatile while"""
_RUST = """abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen if impl in
let loop macro match mod move mut override priv pub ref return self static struct super trait true try type typeof union unsafe
unsized use virtual where while yield"""
_KEYWORDS = {**dict.fromkeys(_RUST.split(), "Rust"), **dict.fromkeys(_C.split(), "C")}

_COLUMNS = {"t": "the time", "mode": "the mode", "j": "the number of events so far"}
_INITIAL = dict.fromkeys(("project", "at_rest"), "a key of initial states")
RESERVED = {
    "parameter": {"set": "the key that chooses a parameter set", "t": "the time"},
    "coordinate": {**_COLUMNS, **_INITIAL}, "discrete state": {**_COLUMNS, **_INITIAL}, "output": _COLUMNS, "input": _COLUMNS,
    "ground motion": _COLUMNS, "motion": {**_COLUMNS, **_INITIAL},
    "choice": dict.fromkeys(
        ("model", "title", "set", "parameters", "contacts", "inputs", "initial", "freeze", "end", "limits", "outputs", "accuracy", "method",
         "impacts", "record", "format"), "a key of scenes"),
    "transition": {"rest": "the event at the limit of an accumulation", "start": "the start", "end": "the end"},
}
"""Names that stand for something else in scenes and results, by what is named."""


def name(model, what, text):
    """A name of something: an identifier that means nothing else in scenes, results or generated code."""
    if not isinstance(text, str):
        raise model.error(f"the name of a {what} is a text, not {shown(text)}")
    plain = text.replace(".", "_")
    if not (plain.isidentifier() and plain.isascii()) or "__" in text or text.startswith("_"):
        raise model.error(f"`{text}` is not a name for a {what}: names are of letters, digits and single underscores, and begin"
                          " with a letter")
    means = RESERVED.get(what, {}).get(text)
    if means:
        raise model.error(f"a {what} cannot be named `{text}`, which is {means}: choose another name")
    if text in _KEYWORDS:
        raise model.error(f"a {what} cannot be named `{text}`, a word of {_KEYWORDS[text]}: choose another name")
    if what == "discrete state" and keyword.iskeyword(text):
        raise model.error(f"a {what} cannot be named `{text}`, a word of Python: choose another name")


def text(model, what, value):
    """One line of printable characters, as terminals, pages and pictures hold it."""
    if not isinstance(value, str):
        raise model.error(f"{what} is a text, not {shown(value)}")
    for character in value:
        # Controls, halves of surrogate pairs, code points for private use, and those that are no characters.
        if unicodedata.category(character) in ("Cc", "Cs", "Co") or ord(character) & 0xFFFE == 0xFFFE:
            raise model.error(f"{what} holds U+{ord(character):04X}: write one line of printable characters")
    return value


def shown(value):
    """A value as an author wrote it, cut where it is long."""
    text = repr(value) if not isinstance(value, ca.SX) else f"`{value}`"
    if isinstance(value, str):
        text = f"the text {value!r}"
    return text if len(text) < 80 else text[:79] + "…"


def expression(model, what, value):
    """An expression: symbols of the model, numbers, and what is calculated from them."""
    try:
        if isinstance(value, (str, bool)) or value is None:
            raise TypeError
        result = ca.SX(value)
    except (TypeError, NotImplementedError, RuntimeError):
        raise model.error(f"{what}: {shown(value)} is not an expression of the model's symbols") from None
    if not result.is_scalar():
        raise model.error(f"{what}: {shown(value)} is not one expression but {result.shape[0]} by {result.shape[1]} of them")
    return finite(model, what, result)


def finite(model, what, value):
    """An expression without infinite constants or such as are not numbers: `math.sin` makes them of symbols."""
    symbols = ca.symvar(value)
    function = ca.Function("constants", symbols, [value])
    for k in range(function.n_instructions()):
        if function.instruction_id(k) == ca.OP_CONST:
            number = function.instruction_constant(k)
            if number - number != 0:
                raise model.error(f"{what}: it holds the number {number}; functions of symbols are those of this interface (sin,"
                                  " cos, tan, exp, sqrt, atan2), not those of Python's math")
    return value


def mode(model, what, value):
    """A mode of the model."""
    if any(value is known for known in model.modes):
        return value
    right = next((f"give the mode itself, what model.mode({value!r}, …) returned" for m in model.modes if m.name == value),
                 "give what model.mode(…) returned")
    raise model.error(f"{what} is {shown(value)}, not a mode: {right}")


def coordinate(model, what, value, *, motions=False):
    """A coordinate of the model, or, where they are asked for, a prescribed motion."""
    known = {c.symbol.element_hash(): c.symbol for c in model.coordinates + (model.motions if motions else [])}
    if isinstance(value, ca.SX) and value.is_scalar() and value.element_hash() in known:
        return known[value.element_hash()]
    kinds = "a coordinate or a prescribed motion" if motions else "a coordinate"
    names = ", ".join(f"`{symbol.name()}`" for symbol in known.values())
    right = (f"give the coordinate itself, what model.coordinate({value!r}, …) returned"
             if isinstance(value, str) and any(symbol.name() == value for symbol in known.values())
             else f"coordinates are {names}" if names else "declare one first")
    raise model.error(f"{what} is {shown(value)}, not {kinds}: {right}")


def parameter(model, what, value):
    """A parameter of the model."""
    for p in model.parameters:
        if isinstance(value, ca.SX) and value.is_scalar() and value.element_hash() == p.symbol.element_hash():
            return p
    right = (f"give the parameter itself, what model.parameter({value!r}, …) returned"
             if any(p.name == value for p in model.parameters if isinstance(value, str)) else
             "give what model.parameter(…) returned; a limit that is a number is `maximum`")
    raise model.error(f"{what} is {shown(value)}, not a parameter: {right}")


def pairs(model, what, value, form):
    """A list of pairs."""
    if isinstance(value, (list, tuple)) and all(isinstance(entry, (list, tuple)) and len(entry) == 2 for entry in value):
        return list(value)
    raise model.error(f"{what} is {shown(value)}: give a list of pairs, [{form}, …]")
