"""What becomes of equations of motion in special cases and in limits: where a parameter vanishes, a coordinate stays at zero, two masses
are the same. Said is what changes the kind of the problem: an equation that says nothing any more, accelerations that nothing determines,
motions that no longer know of one another."""

from ..errors import NotInClass
from ..normal.matrices import determinant
from .lagrangian import motion_rows
from .small import special_cases

# Coordinates up to which the determinant of the mass matrix is multiplied out.
MOST = 4


def cases(subject):
    """[(name of a case, [what becomes of the equations of motion])], those cases alone of which there is something to say."""
    _, q, rows = motion_rows(subject, conservative=False)
    paper, ring, found = subject.paper, subject.ring, []
    puts = {f"{n} = 0": {n: 0} for n, x in paper.symbols.items() if x.role == "parameter" and n not in paper.definitions}
    puts.update(special_cases(paper))
    before = _apart(q, rows)
    has_mass = len(q) <= MOST and bool(_mass(q, rows))
    for name, values in puts.items():
        put = {n: ring.symbol(v) if isinstance(v, str) else v for n, v in values.items()}
        try:
            after = [row.substitute(put) for row in rows]
        except (NotInClass, ZeroDivisionError):
            found.append((name, ["the equations have no such case: they divide by what is zero there"]))
            continue
        held = [n for n in q if values.get("dd" + n) == 0]
        left = [(n, row) for n, row in zip(q, after) if n not in held]
        said = [f"the equation of {paper.shown(n)} says nothing" for n, row in left if not row]
        moving = [n for n, row in left if row]
        if has_mass and moving and not said and not _mass(moving, [row for n, row in left if row]):
            said.append("the mass matrix is singular: not all accelerations are determined")
        parts = _apart(moving, [row for _, row in left if row])
        if len(parts) > len([part for part in before if set(part) - set(held)]) and not said:
            shown = [", ".join(paper.shown(n) for n in part) for part in parts]
            said.append(f"the motions of {' and of '.join(shown)} know nothing of one another")
        if said:
            found.append((name, said))
    return found


def _mass(q, rows):
    """The determinant of the slopes of the equations by the accelerations."""
    return determinant([[row.diff("dd" + n) for n in q] for row in rows])


def _apart(q, rows):
    """The coordinates in groups that share no equation."""
    groups = []
    for name, row in zip(q, rows):
        names = {name} | {n for n in q if row.names() & {n, "d" + n, "dd" + n}}
        shared = [group for group in groups if group & names]
        groups = [group for group in groups if not group & names] + [names.union(*shared)]
    return [[n for n in q if n in group] for group in groups]
