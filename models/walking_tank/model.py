"""Walking of an unanchored flat-bottom cylindrical liquid storage tank: rocking, bulging, slipping.

The energy-consistent model after Taniguchi's paper; assumptions, sketch and signs in README.md, the
printed equations in paper.py.
"""

from types import SimpleNamespace

from codegen.model import *
from codegen.verify import apply, without
from .corrections import corrections
from .paper import paper

model = Model("Walking of an unanchored liquid storage tank", source=paper.source)

equations = model.choice(
    "equations", ("derived", "printed", "corrected"),
    "equations of motion and reactions: derived from the energies, (1)-(3) and (9) as the paper prints them,"
    " or the printed ones with all corrections of corrections.py")
rules = model.choice(
    "rules", ("reactions", "paper") if equations == "derived" else ("paper",),
    "what starts rocking and slipping, and the normal force of the kinetic friction: the reactions, or"
    " the paper's conditions (5)-(9) and force (4)")
may_fly = equations == "derived" and rules == "reactions"
landing = model.choice(
    "landing",
    ("momenta", "velocities", "contact") if may_fly else ("momenta", "velocities") if equations == "derived" else ("velocities",),
    "what a landing does: the uplift rate is turned back, and the other motions keep their momenta, or their velocities; or an edge"
    " strikes as any contact does",
    default="momenta" if rules == "reactions" else "velocities")
edges = model.choice(
    "edges", ("contacts",) if landing == "contact" else ("modes", "contacts") if may_fly else ("modes",),
    "how the edges stand on the ground: by modes written by hand, or each by a contact")

# Masses, first moments and inertias of the full plate; the doughnut is a parameter set.
M_0 = model.parameter("M_0", "kg", 50.3, "mass of the contents", above=0)
M_I = model.parameter("M_I", "kg", 0.782 * 50.3, "effective mass of liquid for bulging", above=0, at_most=M_0)
M_E = model.parameter("M_E", "kg", 50.3, "effective mass of liquid for rocking", above=0, at_most=M_0)
M_rb = model.parameter("M_rb", "kg", 0.782 * 50.3, "effective mass of liquid for rocking-bulging interaction", minimum=0, at_most=M_I)
M_S = model.parameter("M_S", "kg", 7.477, "mass of shell and bottom plate", above=0)
I_E = model.parameter("I_E", "kg m^2", 5.198, "moment of inertia of M_E about the pivot edge", above=0)
I_S = model.parameter("I_S", "kg m^2", 0.7527, "moment of inertia of M_S about the pivot edge", above=0)
R_0 = model.parameter("R_0", "m", 0.283, "distance of the centre of M_E from the pivot edge", above=0)
R_I = model.parameter("R_I", "m", 0.258, "distance of the centre of M_rb from the pivot edge", above=0)
R_S = model.parameter("R_S", "m", 0.2561, "distance of the centre of M_S from the pivot edge", above=0)
alpha_0 = model.parameter("alpha_0", "rad", 0.785, "angle of R_0 with the vertical at rest", above=0, maximum=1.5707963267948966)
alpha_I = model.parameter("alpha_I", "rad", 0.889, "angle of R_I with the vertical at rest", above=0, maximum=1.5707963267948966)
alpha_S = model.parameter("alpha_S", "rad", 0.8961, "angle of R_S with the vertical at rest", above=0, maximum=1.5707963267948966)
frequency = model.parameter("frequency", "Hz", 26.0, "natural frequency of bulging", above=0)
damping = model.parameter("damping", "1", 0.05, "damping ratio of bulging", minimum=0)
mu_s = model.parameter("mu_s", "1", 0.2, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.19, "kinetic friction coefficient", minimum=0, at_most=mu_s)
e = model.parameter("e", "1", 0.6, "restitution of the uplift rate at a landing", minimum=0, maximum=1)
e_edge = model.parameter("e_edge", "1", 0, "with landing = contact: restitution of an edge", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
B_plate = model.parameter(
    "B_plate", "N m", 309.0, "flexural rigidity of the bottom plate; tells whether it is rigid and acts on nothing else", above=0)
printed_slip = model.parameter(
    "printed_slip", "1", 0, "with equations = corrected: number of the correction that is left out, in the order of"
    " corrections.py (0: none)", minimum=0, maximum=len(corrections))

model.parameter_set("full_plate", "rigid full bottom plate: the paper's first tank; M_S, R_S, alpha_S, I_S from its dimensions")
model.parameter_set(
    "doughnut", "10 % rigid doughnut plate: the paper's second tank (M_rb/M_I = 0.152); M_S, R_S, alpha_S, I_S from its dimensions",
    M_E=9.56, I_E=1.065, M_rb=0.152 * 0.782 * 50.3, M_S=6.266, I_S=0.6944, R_S=0.2765, alpha_S=0.8086)

theta = model.coordinate("theta", "rad", "uplift angle about the pivot edge", minimum=0, scale=0.01, rate_scale=0.1)
x_I = model.coordinate("x_I", "m", "bulging displacement along the tank's base line", scale=1e-3, rate_scale=0.1)
x = model.coordinate("x", "m", "slip of the base on the ground", scale=0.01, rate_scale=0.1)
y = model.coordinate("y", "m", "height of the base; where a mode holds it, its reaction is the normal force N")
side = model.discrete("side", (+1, -1), "pivot: +1 the left edge O, -1 the right edge O'")
slip = model.discrete("slip", (+1, -1), "direction of slip while sliding")
z_h = model.ground("z_h", "motion of the ground to the right", input="ground_acceleration")
z_v = model.ground(  # the paper's conditions and equations know no other weight than that at rest
    "z_v", "motion of the ground upwards", input="vertical_acceleration", axis="y", optional=True,
    available=rules == "reactions")

model.gravity(g)
model.point_mass(  # bulging liquid that rocks with the tank
    mass=M_rb,
    position=(x + side * R_I * sin(alpha_I - theta) + x_I * cos(theta),
              y + R_I * cos(alpha_I - theta) + side * x_I * sin(theta)))
# Liquid that does not rock stands on the ground. The modes by hand, which hold y, let it move with y, so that the reaction of y is
# the normal force of all.
level = y if edges == "modes" else 0 * y
model.point_mass(mass=M_I - M_rb, position=(x + x_I, level))  # bulging liquid that does not rock
model.rigid_body(  # shell and bottom plate
    mass=M_S, inertia=I_S - M_S * R_S**2, angle=side * theta,
    position=(x + side * R_S * sin(alpha_S - theta), y + R_S * cos(alpha_S - theta)))

# The rest of the liquid rocks without horizontal momentum: inertia, and first moment for weight
# and vertical momentum. It moves with the base, y, and with the ground.
moment = M_E * R_0 * cos(alpha_0 - theta) - M_rb * R_I * cos(alpha_I - theta)
moment_rate = (M_E * R_0 * sin(alpha_0 - theta) - M_rb * R_I * sin(alpha_I - theta)) * theta.rate
rest = M_0 - M_I if edges == "modes" else M_E - M_rb
rise = y.rate + z_v.rate
model.kinetic((I_E - M_rb * R_I**2) * theta.rate**2 / 2 + moment_rate * rise + rest * rise**2 / 2)
model.potential(g * moment + rest * g * (y + z_v))
if edges == "contacts":
    still = M_0 - M_I - rest
    model.kinetic(still * z_v.rate**2 / 2)
    model.potential(still * g * z_v)

omega = 2 * pi * frequency
model.potential(M_I * omega**2 * x_I**2 / 2)
model.dissipation(damping * M_I * omega * x_I.rate**2)


def printed(number, moduli=(), slipped_unit=1):
    """The value of an equation of the paper in the symbols of this model, as printed or, with
    equations = corrected, as corrected but for the correction that `printed_slip` leaves out.

    The modulus of the first argument is replaced by the argument times the first of the signs `moduli`, and so on.
    `slipped_unit` gives the slipped terms the dimension of the corrected ones, where only the sign matters.
    """
    values = dict(
        theta=theta, dtheta=theta.rate, ddtheta=theta.acceleration, x_I=x_I, dx_I=x_I.rate,
        ddx_I=x_I.acceleration, x=x, dx=x.rate, ddx=x.acceleration, ddz_h=z_h.acceleration, lam=side,
        g=g, M_I=M_I, M_E=M_E, M_rb=M_rb, M_S=M_S, M_T=M_0 + M_S, I_E=I_E, I_S=I_S, R_0=R_0, R_I=R_I, R_S=R_S,
        alpha_0=alpha_0, alpha_I=alpha_I, alpha_S=alpha_S, k=M_I * omega**2, c=2 * damping * M_I * omega,
        mu=mu_s, nu=mu_k, e=e, F=0)

    def terms(source):
        signs = {}
        functions = SimpleNamespace(
            sin=sin, cos=cos, sign=lambda _: slip,
            Abs=lambda term: signs.setdefault(structure(term), moduli[min(len(signs), len(moduli) - 1)]) * term)
        return source.equations[number].terms(source.namespace(values, functions), functions)

    if equations != "corrected":
        return sum(terms(paper), 0)
    corrected = terms(apply(paper, corrections))
    total = sum(corrected, 0)
    for place, correction in enumerate(corrections, 1):
        if correction.equation == number:
            slipped = terms(apply(paper, corrections, without(corrections, correction.key)))
            slipped = [slipped_unit * term for term in slipped]
            total += (printed_slip == place) * difference(slipped, corrected)
    return total


def difference(some, others):
    """Sum of some terms less that of others, without the terms that both have."""
    some, others = ([(structure(term), term) for term in terms] for terms in (some, others))
    shared = {key for key, _ in some} & {key for key, _ in others}
    rest = lambda terms: sum((term for key, term in terms if key not in shared), 0)
    return rest(some) - rest(others)


if equations != "derived":
    # The paper's (9) is the reaction of y. Printed terms of the wrong dimension are what is wanted.
    for coordinate, number in ((theta, "1"), (x_I, "2"), (x, "3"), (y, "9")):
        model.by_hand(coordinate, printed(number), check_units=False)


def by_hand():
    """The modes written out: on the whole base or about one edge, sticking or slipping."""
    stands_sticks = model.mode("stands_sticks", "on the whole base, held by friction", freeze=[(theta, 0), x, (y, 0)])
    rocks_sticks = model.mode("rocks_sticks", "about one edge, held by friction", freeze=[x, (y, 0)])
    stands_slides = model.mode("stands_slides", "on the whole base, slipping", freeze=[(theta, 0), (y, 0)])
    rocks_slides = model.mode("rocks_slides", "about one edge, slipping", freeze=[(y, 0)])

    def base_shear(mode):
        return mode.reaction(x) if rules == "reactions" else printed("8")

    def normal_force(mode):
        return mode.reaction(y) if rules == "reactions" else printed("9")

    # Slip and stick. Both directions have a guard of their own, since |R_x| is not smooth.
    for sticks, slides in ((stands_sticks, stands_slides), (rocks_sticks, rocks_slides)):
        if rules == "reactions":
            slides.friction(x, normal=slides.reaction(y), coefficient=mu_k, direction=slip)
        else:
            slides.force(x, -printed("4"))
        held = [mu_s * normal_force(sticks) + base_shear(sticks), mu_s * normal_force(sticks) - base_shear(sticks)]
        stops = falls(slip * x.rate)
        model.transition("stick", slides, sticks, when=stops, provided=held)
        if rules == "reactions":
            for direction, margin in ((+1, held[0]), (-1, held[1])):
                model.transition("slip", sticks, slides, when=falls(margin), reset=[(slip, direction)])
            model.transition("reversal", slides, slides, when=stops, reset=[(slip, -slip), (x.rate, 0)])
        else:
            # Conditions (7) and force (4) come from other sums than the equations of motion: where (7)
            # holds but (4) would stop any slip at once, the tank sticks.
            for direction, margin in ((+1, held[0]), (-1, held[1])):
                model.transition(
                    "slip", sticks, slides, when=falls(margin), reset=[(slip, direction)],
                    provided=direction * x.acceleration)
            model.transition(
                "reversal", slides, slides, when=stops, reset=[(slip, -slip), (x.rate, 0)],
                provided=slip * x.acceleration)
            model.transition("stick", slides, sticks, when=stops)

    # Lift-off about either edge, landing, and rest at the limit of an accumulation of landings.
    for stands, rocks, conserved in (
        (stands_sticks, rocks_sticks, [x_I]),
        (stands_slides, rocks_slides, [x_I, x]),
    ):
        if rules == "reactions":
            for edge in (+1, -1):
                model.transition("lift_off", stands, rocks, reset=[(side, edge)], when=falls(stands.reaction(theta, side=edge)))
        else:
            # Condition (5), one smooth guard for each sign of its moduli; (6) decides the pivot. The
            # condition overstates the overturning moment, so uplift also needs (1) to lift the edge.
            onsets = {structure(onset): onset for onset in (-printed("5", signs) for signs in ((1, 1), (1, -1), (-1, 1), (-1, -1)))}
            for onset in onsets.values():
                for edge, rule in ((+1, printed("6a", (), M_E * R_0)), (-1, -printed("6b", (), M_E * R_0))):
                    model.transition(
                        "lift_off", stands, rocks, when=falls(onset), reset=[(side, edge)],
                        provided=[theta.acceleration, rule])
        rate_after = -e * theta.rate if equations == "derived" else printed("10")
        if landing == "momenta":
            others = model.impact_velocities(
                before=[], after=[(side, -side)], prescribed=[(theta, rate_after)], conserve=conserved)
        else:
            others = [(theta.rate, rate_after)]
        if landing == "momenta" and rocks is rocks_slides:
            # The horizontal momentum that rocking gives up may turn the slip round.
            _, x_rate_after = others[-1]
            others.append((slip, slip * (1 - 2 * (slip * x_rate_after < 0))))
        model.transition("landing", rocks, rocks, when=falls(theta), impact=True, reset=[(theta, 0), (side, -side)] + others)
        model.rest(rocks, stands)

    for mode in model.modes:
        model.requires(mode, mode.reaction(y), "the normal force is not positive: the tank would leave the ground")
    return stands_sticks, rocks_sticks, stands_slides, rocks_slides


def by_contacts():
    """Two edges that touch and slide, and the liquid that does not rock, which stands on the ground and slides with the base."""
    # Half of the width with which the weight of all that rocks turns about either edge by as much, whatever edge the coordinates
    # are about: R sin α is the same for all parts but for the digits that are printed.
    half = (M_E * R_0 * sin(alpha_0) + M_S * R_S * sin(alpha_S)) / (M_E + M_S)
    core = M_0 - M_E
    moves = model.mode("moves", "all that the edges can do")
    for name, edge in (("left", +1), ("right", -1)):
        other = 1 - edge * side
        model.contact(
            name, gap=y + other * half * sin(theta), slip=x - other * side * half * (1 - cos(theta)),
            static=mu_s, kinetic=mu_k, restitution=e_edge)
        if landing != "contact":
            rates = [(theta, e * theta.rate), (y, -other * half * e * theta.rate * cos(theta))]
            law = lambda conserve: model.impact_velocities(
                before=[], after=[], prescribed=rates, conserve=conserve if landing == "momenta" else [])
            model.impact(name, law([x_I, x]), held=law([x_I]))
    model.friction("core", slip=x, normal=core * (g + z_v.acceleration), static=mu_s, kinetic=mu_k)
    # At θ = 0 the other edge becomes that which the coordinates are about.
    model.chart("edge", when=falls(theta), reset=[
        (side, -side), (theta, -theta), (theta.rate, -theta.rate),
        (y, y + 2 * half * sin(theta)), (y.rate, y.rate + 2 * half * cos(theta) * theta.rate)])
    if landing != "contact":
        model.requires(moves, moves.reaction(z_v) - core * (g + z_v.acceleration),
                       "the normal force is not positive: the tank would leave the ground, for which this landing says nothing")


modes = by_hand() if edges == "modes" else by_contacts()

# Width and height of the tank are those that the centre of its contents, R_0 and alpha_0, says; the pivot edge is half a
# width to the left or right of where the centre of the base has slipped to.
half_width, height = R_0 * sin(alpha_0), 2 * R_0 * cos(alpha_0)


def place(along, up):
    """A point of the tank, from the pivot edge along its base and up its shell."""
    return (x + side * (along * cos(theta) - up * sin(theta) - half_width), y + along * sin(theta) + up * cos(theta))


model.output("rotation", "rad", side * theta, "rotation of the tank, counter-clockwise: it leans to the left")
model.output("centre_x", "m", x + side * R_0 * (sin(alpha_0 - theta) - sin(alpha_0)),
             "displacement of the centre of the contents to the right, relative to the ground")
model.output("centre_y", "m", y + R_0 * (cos(alpha_0 - theta) - cos(alpha_0)), "rise of the centre of the contents")
model.output("left_edge", "m", y + (1 - side) * half_width * sin(theta), "height of the left bottom edge")
model.output("right_edge", "m", y + (1 + side) * half_width * sin(theta), "height of the right bottom edge")
model.output("shear_ratio", "1", model.reaction(z_h) / ((M_0 + M_S) * g),
             "base shear, the force of the ground to the right, over the weight")

model.draw("ground", [(-6 * half_width, 0), (6 * half_width, 0)], kind="fixed")
levels = [(part * height, sin(part * pi / 2) * x_I * side) for part in (0, 0.25, 0.5, 0.75, 0.95)]
model.draw("liquid", [place(bulge, up) for up, bulge in levels]
           + [place(2 * half_width + bulge, up) for up, bulge in reversed(levels)], kind="liquid")
model.draw("shell", [place(0, height), place(0, 0), place(2 * half_width, 0), place(2 * half_width, height)], kind="line")
if edges == "modes":
    stands_sticks, rocks_sticks, stands_slides, rocks_slides = modes
    model.draw("pivot", [place(0, 0)], kind="contact", force=(z_h, y),
               states=[(mode, "sticks") for mode in (stands_sticks, rocks_sticks)]
               + [(mode, "slides") for mode in (stands_slides, rocks_slides)])
    model.draw("other edge", [place(2 * half_width, 0)], kind="contact", states=[(stands_sticks, "sticks"), (stands_slides, "slides")])
else:
    for name, edge in (("left", +1), ("right", -1)):
        model.draw(name, [place((1 - edge * side) * half_width, 0)], kind="contact", of=name)

# Where the weight of tank and rocking liquid turns about the pivot edge the other way.
weight_moment = M_E * R_0 * sin(alpha_0 - theta) + M_S * R_S * sin(alpha_S - theta)
model.limit("past_balance", "the centre is beyond the pivot edge: at rest the tank would fall, shaken it may come back",
            when=weight_moment < 0, ends=False)
model.limit("overturned", "the side of the tank reaches the ground", when=theta > pi / 2)

# Where the model ends; README.md has the reasons for the numbers.
radius = half_width
dish = (5 + 0.3) / (1 + 0.3) * M_E * g * radius**2 / (64 * pi * B_plate)
model.valid(dish < radius / 100,
            "the bottom plate is rigid and lifts the liquid with it: held at its rim, the weight of the liquid dishes it by"
            " less than a hundredth of the radius; a thinner plate uplifts in a strip along its edge (API 650, Annex E)")
for bulge in (x_I, -x_I):
    model.valid(bulge < radius / 20,
                "the displacements of the liquid are small: bulging stays below a twentieth of the radius")
model.valid(theta < alpha_0 / 4,
            "the uplift is moderate: the free surface of the liquid, which rocks with the tank, is nearly level")
