"""Linear dependence of forms over the field of the parameters.

First with prime numbers for the parameters: what is independent for some values is independent, and a null
space of numbers is found at once. Only the columns that it leaves are solved over the field, which is slow."""

from fractions import Fraction

import sympy
from sympy.polys.matrices import DomainMatrix

from ..normal.algebra import ONE, expression


def null_vectors(forms, quantities, known):
    """Vectors c, of forms in the parameters, with the sum of c times the `forms` zero, while that of c times the
    `quantities` is no combination of one another and of the `known` ones."""
    values = _values([*forms, *quantities, *known])
    candidates = _numeric_null(_numeric_columns(forms, values))
    base, chosen = _numeric_columns(known, values), []
    columns = _numeric_columns(quantities, values)
    for vector in candidates:
        image = {}
        for c, column in zip(vector, columns):
            for key, value in column.items() if c else ():
                image[key] = image.get(key, 0) + c * value
        if not _in_span(image, base):
            base.append(image)
            chosen.append(vector)
    kept = sorted({k for vector in chosen for k, c in enumerate(vector) if c})
    for vector in _field_null([forms[k] for k in kept]) if kept else ():
        whole = [forms[0].ring.number(0)] * len(forms)
        for k, c in zip(kept, vector):
            whole[k] = c
        yield whole


def depends(form, known):
    """Whether a form is a combination of others, with coefficients in the field of the parameters."""
    values = _values([form, *known])
    columns = _numeric_columns([form, *known], values)
    # what no values make dependent is not; what some do is decided over the field
    return _in_span(columns[0], columns[1:]) and any(vector[0] for vector in _field_null([form, *known]))


def _values(forms):
    """A prime for each parameter, from 101."""
    names = sorted({str(n) for form in forms for monomial, _ in form.terms for n, _ in monomial if str(n) in form.ring.first})
    result, prime = {}, 100
    for name in names:
        prime = sympy.nextprime(prime)
        result[name] = int(prime)
    return result


def _parts(form):
    """A form as {(what moves, harmonic): {monomial of the parameters: value}}."""
    result = {}
    for (monomial, harmonic), value in form.terms.items():
        inner = tuple(item for item in monomial if str(item[0]) not in form.ring.first)
        outer = tuple(item for item in monomial if str(item[0]) in form.ring.first)
        result.setdefault((inner, harmonic), {})[outer] = value
    return result


def _numeric_columns(forms, values):
    """The forms as {key: number}, with numbers for the parameters."""
    result = []
    for form in forms:
        column = {}
        for key, parts in _parts(form).items():
            total = Fraction(0)
            for monomial, value in parts.items():
                product = Fraction(value)
                for name, exponent in monomial:
                    product *= Fraction(values[name]) ** exponent
                total += product
            if total:
                column[key] = total
        result.append(column)
    return result


def _matrix(columns, domain, entry):
    keys = list(dict.fromkeys(key for column in columns for key in column))
    rows = [[domain.from_sympy(entry(column[key])) if key in column else domain.zero for column in columns] for key in keys]
    return DomainMatrix(rows or [[domain.zero] * len(columns)], (len(rows) or 1, len(columns)), domain)


def _number(value):
    return sympy.Rational(value.numerator, value.denominator)


def _numeric_null(columns):
    return [[Fraction(int(x.p), int(x.q)) for x in vector]
            for vector in _matrix(columns, sympy.QQ, _number).nullspace().to_Matrix().tolist()] if columns else []


def _in_span(column, others):
    """Whether a column of numbers is a combination of others."""
    if not column:
        return True
    return _matrix([*others, column], sympy.QQ, _number).rank() == _matrix(others, sympy.QQ, _number).rank() if others else False


def _field_null(forms):
    """A basis of the null space over the field, each vector without common factors and denominators."""
    ring = forms[0].ring
    columns = [{key: expression(ring.form({(outer, ONE): value for outer, value in parts.items()})) for key, parts in _parts(form).items()}
               for form in forms]
    names = sorted({s for column in columns for x in column.values() for s in x.free_symbols}, key=str)
    field = sympy.QQ.frac_field(*names) if names else sympy.QQ
    for vector in _matrix(columns, field, lambda x: x).nullspace().to_Matrix().tolist():
        common = sympy.lcm([sympy.fraction(sympy.together(x))[1] for x in vector])
        entries = [sympy.cancel(x * common) for x in vector]
        shared = sympy.gcd_list(entries)
        yield [ring.read(sympy.expand(sympy.cancel(x / shared))) for x in entries]
